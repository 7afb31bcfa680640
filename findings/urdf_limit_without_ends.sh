#!/usr/bin/env bash
# pin 4.1.0, mujoco 4.0.0, drake 1.51.1 (PyPI, Linux x86-64, Python 3.11).
#
# Guess: a revolute joint whose `<limit>` names an effort and a speed but no ends turns freely, as one without limits.
# Seen: in MuJoCo and Drake it does. In Pinocchio both ends are 0, the defaults of the format: the joint has no range at all. No program says a word.
# Output seen:
#   mujoco: is limited [0]
#   drake: [-inf] [inf]
#   pinocchio: [0.] [0.]
# Fails where the three agree.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv python
python/bin/pip -q install pin==4.1.0 mujoco==4.0.0 drake==1.51.1
cat > arm.urdf <<'END'
<robot name="arm"><link name="base"/><link name="arm"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="hinge" type="revolute"><parent link="base"/><child link="arm"/><axis xyz="0 1 0"/><limit effort="5" velocity="2"/></joint></robot>
END
python/bin/python - <<'END'
import mujoco, numpy as np, pinocchio as pin
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant
theirs = mujoco.MjModel.from_xml_path("arm.urdf").jnt_limited
plant = MultibodyPlant(0.0)
Parser(plant).AddModels("arm.urdf")
plant.Finalize()
hinge = plant.GetJointByName("hinge")
model = pin.buildModelFromUrdf("arm.urdf")
print(f"mujoco: is limited {theirs.astype(int)}")
print(f"drake: {hinge.position_lower_limits()} {hinge.position_upper_limits()}")
print(f"pinocchio: {model.lowerPositionLimit} {model.upperPositionLimit}")
assert not theirs[0] and np.isinf(hinge.position_upper_limits()[0])
assert model.lowerPositionLimit[0] == model.upperPositionLimit[0] == 0
END
