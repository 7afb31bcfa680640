#!/usr/bin/env bash
# ddeint 0.3.0 and jitcdde 1.8.3 with scipy 1.17.1 (PyPI, Linux x86-64, Python 3.11).
#
# Guess: x' = -x(t - 1), x = 1 before, is solved to about 1e-5 at t = 10 by either, however few rows are asked for.
# Seen: ddeint takes delayed values from straight lines between the rows that are asked for. With a row each second it gives another sign; the
# error falls with the rows, and nothing is said. jitcdde's is that of its tolerances. Exact, by the method of steps in fractions: 0.0202411.
# Output seen:
#   exact      0.0202411
#   ddeint, 11 rows     -0.1009770
#   ddeint, 101 rows    0.0205720
#   ddeint, 10001 rows  0.0202413
#   jitcdde    0.0202424
# Fails where eleven rows come within 1e-3, or jitcdde does not within 1e-5.
set -euo pipefail
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
python3 -m venv python
# jitcdde needs sympy, too, and does not ask for it.
python/bin/pip -q install ddeint==0.3.0 jitcdde==1.8.3 scipy==1.17.1 sympy==1.14.0
python/bin/python - 2>/dev/null <<'END'
from fractions import Fraction
import numpy as np
from ddeint import ddeint
from jitcdde import jitcdde, t, y

# Coefficients in the time since the begin of each second.
x = [Fraction(1)]
for _ in range(10):
    x = [sum(x)] + [-c / (k + 1) for k, c in enumerate(x)]
exact = float(sum(x))
print(f"exact      {exact:.7f}")
found = {}
for rows in (11, 101, 10001):
    solved = ddeint(lambda Y, t: -Y(t - 1), lambda t: 1.0, np.linspace(0, 10, rows))
    found[rows] = float(np.ravel(solved[-1])[0])
    print(f"ddeint, {rows} rows  {found[rows]:.7f}")
dde = jitcdde([-y(0, t - 1)], verbose=False)
dde.constant_past([1.0])
dde.generate_lambdas()
dde.step_on_discontinuities()
other = float(dde.integrate(10.0)[0])
print(f"jitcdde    {other:.7f}")
assert abs(found[11] - exact) > 1e-3 and abs(found[10001] - exact) < 1e-6, found
assert abs(other - exact) < 1e-5, other
END
