#!/usr/bin/env bash
# pybullet 3.2.7, numpy 2.4.6 (PyPI, Linux x86-64, Python 3.11).
#
# Guess: `loadURDF` reads the file that is there.
# Seen: a file that has been read before is taken from memory, though it was written anew: the second robot has the first one's mass.
# Where `enableFileCaching` is 0 it has its own.
# Output seen:
#   first 1.0, changed 1.0, without the cache 5.0
# Fails where the changed file is read at once.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv python
python/bin/pip -q install pybullet==3.2.7 numpy==2.4.6
python/bin/python - 2> /dev/null <<'END' | sed -n 's/^.*first/first/p'
import pybullet as pb
pb.connect(pb.DIRECT)
def mass(kilograms):
    with open("body.urdf", "w") as file:
        file.write(f'<robot name="body"><link name="body"><inertial><mass value="{kilograms}"/>'
                   '<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link></robot>')
    return pb.getDynamicsInfo(pb.loadURDF("body.urdf"), -1)[0]
first, changed = mass(1), mass(5)
pb.setPhysicsEngineParameter(enableFileCaching=0)
fresh = mass(5)
print(f"\nfirst {first}, changed {changed}, without the cache {fresh}")
assert (first, changed, fresh) == (1, 1, 5)
END
