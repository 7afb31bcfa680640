#!/usr/bin/env bash
# mujoco 4.0.0 and pin 4.1.0 (PyPI, Linux x86-64, Python 3.11).
#
# Guess: a second `compiler` section counts for what comes after it; at the end of a file it changes nothing.
# Seen: MuJoCo reads all sections before the bodies, wherever they stand: the last one turns the angles of the whole file into degrees.
# Pinocchio reads the first one. The same file is two machines.
# Output seen:
#   mujoco: range [-0.01745329  0.01745329]
#   pinocchio: range [-1.  1.]
# Fails where the two agree.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv python
python/bin/pip -q install mujoco==4.0.0 pin==4.1.0
cat > arm.xml <<'END'
<mujoco model="arm"><compiler angle="radian"/><worldbody><body name="arm"><joint name="hinge" type="hinge" axis="0 1 0" range="-1 1"/>
<geom type="sphere" size="0.1" pos="0 0 1"/></body></worldbody><compiler angle="degree"/></mujoco>
END
python/bin/python - <<'END'
import mujoco, numpy as np, pinocchio as pin
theirs = mujoco.MjModel.from_xml_path("arm.xml").jnt_range[0]
model = pin.buildModelFromMJCF("arm.xml")
ours = np.array([model.lowerPositionLimit[0], model.upperPositionLimit[0]])
print(f"mujoco: range {theirs}")
print(f"pinocchio: range {ours}")
assert np.allclose(theirs, np.radians([-1, 1])) and np.allclose(ours, [-1, 1])
END
