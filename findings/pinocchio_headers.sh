#!/usr/bin/env bash
# pin 4.1.0 (PyPI, Linux x86-64, Python 3.11), with its dependencies libpinocchio 4.1.0 and cmeel-urdfdom 6.0.0.
#
# Guess: its wheels bring the C++ headers of Pinocchio, so that a C++ program that reads a URDF can be compiled with what pip has installed.
# Seen: the headers are there, but not those that they include: neither Eigen/Core (the package cmeel-eigen has it, and is no
# dependency) nor urdf_model/model.h (no package of these has it: urdfdom's are installed without urdfdom_headers).
# Output seen:
#   21:#include <urdf_model/model.h>
#   python/lib/python3.11/site-packages/cmeel.prefix/include/pinocchio/multibody/fwd.hpp:10:#include <Eigen/Core>
#   urdf_model/model.h: not installed
#   Eigen/Core: not installed
# Fails where one of the two is found.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv python
python/bin/pip -q install pin==4.1.0 libpinocchio==4.1.0 cmeel-urdfdom==6.0.0
include=$(echo python/lib/python3*/site-packages/cmeel.prefix/include)
grep -n 'urdf_model/model.h' "$include/pinocchio/parsers/urdf.hpp"
grep -rn --include=fwd.hpp 'Eigen/Core' "$include/pinocchio" | head -1
for header in urdf_model/model.h Eigen/Core; do
    found=$(find "$include" -path "*/$header")
    printf '%s: %s\n' "$header" "${found:-not installed}"
    test -z "$found"
done
