#!/usr/bin/env bash
# scipy 1.17.0 and scikit-sundae 1.2.0 with SUNDIALS 7.9.0 (PyPI, Linux x86-64, Python 3.11).
#
# Guess: an event whose function is zero at the start counts when it becomes zero again: a ball thrown up from the floor ends its run when it lands,
# v^2 / g = 0.2039 s later.
# Seen: `solve_ivp` ends at once, at t = 0. CVODE lands. One rounding below the floor both end at once.
# Output seen:
#   from 0.0: scipy at 0.0000, CVODE at 0.2039
#   from -1e-16: scipy at 0.0000, CVODE at 0.0000
#   from 1e-16: scipy at 0.2039, CVODE at 0.2039
# Fails where scipy lands from an exact zero.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv python
python/bin/pip -q install scipy==1.17.0 scikit-sundae==1.2.0
python/bin/python - <<'END'
from scipy.integrate import solve_ivp
from sksundae.cvode import CVODE
def height(t, y):
    return y[0]
height.terminal = True
def rate(t, y, out):
    out[:] = [y[1], -9.81]
def heights(t, y, out):
    out[0] = y[0]
heights.terminal, heights.direction = [True], [0]
ends = []
for start in (0.0, -1e-16, 1e-16):
    scipy = solve_ivp(lambda t, y: [y[1], -9.81], [0, 1], [start, 1.0], events=height, rtol=1e-9, atol=1e-12).t[-1]
    cvode = CVODE(rate, rtol=1e-9, atol=1e-12, eventsfn=heights, num_events=1).solve([0, 1], [start, 1.0]).t[-1]
    print(f"from {start}: scipy at {scipy:.4f}, CVODE at {cvode:.4f}")
    ends.append((round(scipy, 4), round(cvode, 4)))
assert ends == [(0, 0.2039), (0, 0), (0.2039, 0.2039)], ends
END
