"""How far an explicit Nystrom step can be stable: the longest interval of any method of s stages and order p, on an undamped oscillation.

    python bg-model/bond/benches/ring_polynomials.py          # some minutes, needs numpy and scipy

A step of y'' = -w^2 y multiplies (y, h y') by a matrix whose half trace is a polynomial P of degree s in x = (h w)^2. Order p asks that it be
cos(sqrt x) through x^(p/2), stability that |P| <= 1 (or less where the determinant is below 1). So the largest Z with |P| <= 1 on [0, Z^2] bounds
every method: a linear program for each Z, in Chebyshev's polynomials on that interval. What is told: Z in radians, and Z for each stage.
"""

from math import factorial

import numpy
from numpy.polynomial import chebyshev
from scipy.optimize import linprog

ORDERS = (2, 4, 6, 8, 10)
STEP = 0.1


def exists(stages, order, z):
    """Whether there is such a polynomial."""
    end, known = z * z, order // 2 + 1
    points = (1 - numpy.cos(numpy.linspace(0, numpy.pi, 40 * stages))) / 2
    values = chebyshev.chebvander(2 * points - 1, stages)
    # Taylor coefficients at x = 0 of each of Chebyshev's polynomials, times (end / 2)^k.
    taylor = numpy.zeros((known, stages + 1))
    for j in range(stages + 1):
        polynomial = numpy.eye(stages + 1)[j]
        for k in range(known):
            taylor[k, j] = chebyshev.chebval(-1.0, polynomial) / factorial(k)
            polynomial = chebyshev.chebder(polynomial) if len(polynomial) > 1 else numpy.zeros(1)
    wanted = numpy.array([(-end / 2) ** k / factorial(2 * k) for k in range(known)])
    scale = numpy.abs(taylor).max(axis=1)
    equal = numpy.hstack([taylor / scale[:, None], numpy.zeros((known, 1))])
    ones = numpy.ones((len(points), 1))
    below = numpy.vstack([numpy.hstack([values, -ones]), numpy.hstack([-values, -ones])])
    bounds = [(None, None)] * (stages + 1) + [(0, None)]
    cost = [0] * (stages + 1) + [1]
    found = linprog(cost, A_ub=below, b_ub=numpy.zeros(len(below)), A_eq=equal, b_eq=wanted / scale, bounds=bounds, method="highs")
    return found.status == 0 and found.fun <= 1 + 1e-7


def main():
    print("| stages | " + " | ".join(f"order {order}" for order in ORDERS) + " |\n|---|" + "---|" * len(ORDERS))
    for stages in range(1, 13):
        row = []
        for order in ORDERS:
            candidates = numpy.arange(2.2 * stages + 1, 0.3, -STEP) if stages >= order // 2 else []
            z = next((z for z in candidates if exists(stages, order, z)), None)
            row.append(f"{z:.1f}, {z / stages:.2f}" if z else "")
        print(f"| {stages} | " + " | ".join(row) + " |", flush=True)


main()
