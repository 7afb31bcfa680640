#!/usr/bin/env bash
# pin 4.1.0 and mujoco 4.0.0 (PyPI, Linux x86-64, Python 3.11).
#
# Guess: Pinocchio reads an MJCF hinge with `ref` as MuJoCo does: its angle in the file's pose is `ref`, and `range` are ends of that angle.
# Seen: the angle is MuJoCo's, the ends are not: Pinocchio has them lower by `ref`. The pose at the end of the range is another one.
# Output seen:
#   mujoco: angle in the file's pose [0.3], range [[-1.0, 1.0]]
#   pinocchio: angle in the file's pose [0.3], range [-1.3] [0.7]
# Fails where the ends of the two agree, or the angles do not.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv python
python/bin/pip -q install pin==4.1.0 mujoco==4.0.0
cat > arm.xml <<'END'
<mujoco model="arm"><compiler angle="radian"/><worldbody><body name="arm"><joint name="hinge" type="hinge" axis="0 1 0" ref="0.3" range="-1 1"/>
<geom type="sphere" size="0.1" pos="0 0 1"/></body></worldbody></mujoco>
END
python/bin/python - <<'END'
import mujoco, numpy as np, pinocchio as pin
theirs = mujoco.MjModel.from_xml_path("arm.xml")
model = pin.buildModelFromMJCF("arm.xml")
at = model.referenceConfigurations["qpos0"]
data = model.createData()
pin.framesForwardKinematics(model, data, at)
assert np.allclose(data.oMf[model.getFrameId("arm")].rotation, np.eye(3)), "not the file's pose"
ends = model.lowerPositionLimit, model.upperPositionLimit
print(f"mujoco: angle in the file's pose {theirs.qpos0}, range {theirs.jnt_range.tolist()}")
print(f"pinocchio: angle in the file's pose {at}, range {ends[0].round(9)} {ends[1].round(9)}")
assert np.allclose(at, theirs.qpos0)
assert np.allclose([end[0] for end in ends], theirs.jnt_range[0] - 0.3)
END
