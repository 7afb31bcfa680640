#!/usr/bin/env bash
# pybullet 3.2.7, numpy 2.4.6 (PyPI, built from source where there is no wheel; Linux x86-64, Python 3.11).
#
# Guess: `loadURDF` takes the tensor of `<inertia>`, as it takes the mass beside it.
# Seen: it takes the mass, and makes a tensor of its own from the shape for collisions; without a shape, one of a body of some
# millimetres. A rod of 2 kg on a hinge starts to fall at 10 1/s^2 in place of 8.33; with the flag URDF_USE_INERTIA_FROM_FILE at 8.33.
# Output seen:
#   as it is: moment of inertia 1.3e-06, acceleration -10.000
#   with the flag: moment of inertia 0.1, acceleration -8.333
# Fails where both are the same.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv python
python/bin/pip -q install pybullet==3.2.7 numpy==2.4.6
cat > rod.urdf <<'END'
<robot name="rod"><link name="base"/><link name="rod"><inertial><origin xyz="0 0 -0.5"/><mass value="2"/>
<inertia ixx="0.1" iyy="0.1" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="hinge" type="continuous"><parent link="base"/><child link="rod"/><axis xyz="0 1 0"/></joint></robot>
END
python/bin/python - 2> /dev/null <<'END' | grep -v 'build time\|b3Warning\|No inertial\|^$' | sed 's/^.*\(as it\|with\)/\1/'
import math, pybullet as pb
pb.connect(pb.DIRECT)
pb.setGravity(0, 0, -10)
pb.setTimeStep(1e-5)
found = []
for name, flags in (("as it is", 0), ("with the flag", pb.URDF_USE_INERTIA_FROM_FILE)):
    rod = pb.loadURDF("rod.urdf", useFixedBase=True, flags=flags)
    pb.setJointMotorControl2(rod, 0, pb.VELOCITY_CONTROL, force=0)
    pb.changeDynamics(rod, 0, linearDamping=0, angularDamping=0)
    pb.resetJointState(rod, 0, math.pi / 6, 0)
    pb.stepSimulation()
    found.append(pb.getJointState(rod, 0)[1] / 1e-5)
    print(f"\n{name}: moment of inertia {pb.getDynamicsInfo(rod, 0)[2][0]:.2g}, acceleration {found[-1]:.3f}")
    pb.removeBody(rod)
assert abs(found[0] + 10) < 1e-3 and abs(found[1] + 10 * 0.5 / 0.6) < 1e-3, found
END
