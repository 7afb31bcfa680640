"""A Nystrom method with a longer stability interval, found from four digits, beside `nystrom` on the ring of joints.

    python bg-model/bond/benches/ring_nystrom.py           # from the root of the project; some minutes
    python bg-model/bond/benches/ring_nystrom.py search    # the coefficients, what they violate, their stability

Both need numpy and scipy. Nine stages, order 5, and 6 where no force depends on momenta, as `nystrom`. In: four digits
of each coefficient, below. Out: all others, by the least sum of squares of
- the order conditions' violations (Hairer, Norsett, Wanner I, section II.14; the trees of nystrom/trees.rs),
- the growth of oscillations with damping ratios from 0 to 0.15, up to REACH in frequency times step, of 0.3 up to two
  thirds of it,
- drag: a stiff joint that follows t^3/6, t^4/24 or t^5/120 deviates by the same amount after each step, once its ring
  has died away. Where the joint turns meanwhile, the forces on the stages' deviations, weighted by time, push along the
  free direction, step after step,
- the errors of slow oscillations.
The weights at the end of the step then move as little as possible for quadrature to be exact to order 6. Derivatives
are exact: a number is an array whose first entry is the value, the others its slopes by the unknowns.

The four digits are what a longer search left, whose program was not kept. It began with the tableau of `nystrom` and
asked for stability to 8.6, 9.0 and 9.4, with a fifth of the weight of growth and no loss of an undamped oscillation,
then to 9.4 with all of it, the damping ratio of 0.3 first up to half of it. Where these 3000 steps end depends on
rounding. From the four digits on the squares fall by a fortieth.
"""

import sys
from math import factorial

import numpy
import ring_prototypes as ring

STAGES = 9
ORDER = 6
REACH = 9.4
# Weights: violations by order, growth, drag, slow oscillations, the unknowns themselves.
TREES = (1e6, 3e5, 1e5, 3e4, 1e4, 1e4)
GROWTH, DRAG, SLOW, SIZE = 5e3, 1e3, 10.0, 1e-3
# Steps of the search: the squares fall by a fortieth, and go on falling slowly.
STEPS = 40

# Four digits: the weights of rates from the second stage on, the last row that of the end of the step; those of second
# derivatives from the third stage on, without a stage's first one.
FIRST = [
    [0.009365],
    [-0.579, 0.6927],
    [-0.1772, 0.1769, 0.2411],
    [-0.2664, -0.01501, 0.5501, 0.2017],
    [0.3543, -0.05269, -0.07009, -0.03613, 0.3374],
    [-0.0618, 0.05683, 0.171, 0.2252, -0.009991, 0.2801],
    [-0.1922, 0.08119, 0.2519, 0.2532, 0.0304, 0.1128, 0.36],
    [0.1886, 0.09013, 0.02084, 0.1234, -0.01514, 0.1123, 0.08755, 0.3456],
    [-0.06726, 0.1362, 0.06269, 0.25, 0.0634, 0.1394, 0.2059, 0.1562, 0.05348],
]
SECOND = [
    [0.02643],
    [-0.02062, 0.02218],
    [0.4675, -0.07727, 0.0901],
    [0.1302, 0.08781, 0.02216, 0.01853],
    [0.06423, 0.026, 0.1109, 0.01351, 0.02174],
    [0.1927, -0.05658, 0.2344, 0.006387, 0.04377, 0.06379],
    [0.2401, 0.2972, -0.02433, 0.1138, 0.06918, 0.009302, 0.0199],
    [-0.06802, 0.1353, 0.05648, 0.1894, 0.03311, 0.06528, 0.06997, 0.01612, 0.002385],
]


def product(a, b):
    c = a[..., :1] * b + b[..., :1] * a
    c[..., 0] -= a[..., 0] * b[..., 0]
    return c


def sums(row, numbers):
    """The sum of products of a row with numbers along their first axis."""
    c = numpy.tensordot(row[:, 0], numbers, 1) + numpy.tensordot(numbers[..., 0], row, ((0,), (0,)))
    c[..., 0] /= 2
    return c


def plus(a, constant):
    c = a.copy()
    c[..., 0] += constant
    return c


def function(a, value, slope):
    """A function of numbers, from its values and slopes."""
    c = a * slope[..., None]
    c[..., 0] = value
    return c


def coefficients(unknowns):
    """Instants, weights of rates, weights of second derivatives; the last rows are those of the end."""
    count = len(unknowns)
    numbers = numpy.hstack([unknowns[:, None], numpy.eye(count)])
    first, second = (numpy.zeros((STAGES + 1, STAGES, 1 + count)) for _ in range(2))
    instants = numpy.zeros((STAGES, 1 + count))
    k = 0
    for stage in range(1, STAGES + 1):
        first[stage, :stage], k = numbers[k : k + stage], k + stage
        if stage < STAGES:
            instants[stage] = first[stage].sum(axis=0)
    for stage in range(1, STAGES):
        second[stage, 1:stage], k = numbers[k : k + stage - 1], k + stage - 1
        second[stage, 0] = product(instants[stage], instants[stage]) / 2 - second[stage].sum(axis=0)
    second[STAGES] = numbers[k:]
    return instants, first, second


def trees():
    """Order, forces by momenta, exact value, rates, branches (tree, whether by momenta)."""
    found = []

    def tree(rates, branches):
        order, by_momenta, exact = 1 + rates, 0, 1.0
        for index, momenta in branches:
            of = found[index]
            order += of[0] + (not momenta)
            by_momenta += of[1] + momenta
            exact *= of[2] / (of[0] if momenta else of[0] * (of[0] + 1))
        return order, by_momenta, exact, rates, tuple(branches)

    def collect(left, start, branches):
        yield tree(left, branches)
        for index in range(start[0], len(found)):
            for momenta in (False, True):
                orders = found[index][0] + (not momenta)
                if (index, momenta) >= start and orders <= left:
                    yield from collect(left - orders, (index, momenta), branches + [(index, momenta)])

    for order in range(1, ORDER + 1):
        found += list(collect(order - 1, (0, False), []))
    return found


ALL_TREES = trees()


def violations(instants, first, second):
    """For each tree the violations in parts of the exact value, for the momenta and for the positions."""
    powers = [plus(numpy.zeros_like(instants), 1.0)]
    for _ in range(ORDER):
        powers.append(product(powers[-1], instants))
    reached, of_trees = [], []
    for order, by_momenta, exact, rates, branches in ALL_TREES:
        weight = powers[rates]
        for index, momenta in branches:
            weight = product(weight, reached[index][momenta])
        by_positions, by_momentum = (numpy.stack([sums(row, weight) for row in rows]) for rows in (second, first))
        reached.append((by_positions[:STAGES], by_momentum[:STAGES]))
        momentum = plus(by_momentum[STAGES] * (order / exact), -1.0)
        position = plus(by_positions[STAGES] * (order * (order + 1) / exact), -1.0)
        of_trees.append((order, by_momenta, momentum, position))
    return of_trees


def oscillations(method, z, damping, q, v, power):
    """Steps of q'' = Q'' - z^2 (q - Q) - 2 d z (q' - Q') with Q = t^power / power!, power 0 for none, from deviations q
    of the position and v of the velocity in parts of z: those at the end, and the forces on those of the stages."""
    instants, first, second = method
    count = instants.shape[-1]
    one = plus(numpy.zeros(count), 1.0)
    forces, accelerations = (numpy.zeros((STAGES, len(z), count)) for _ in range(2))
    for stage in range(STAGES + 1):
        t = instants[stage] if stage < STAGES else one
        position = plus((v * z)[:, None] * t + sums(second[stage], accelerations), q)
        velocity = plus(sums(first[stage], accelerations), v * z)
        motion = [one]
        for _ in range(5):
            motion.append(product(motion[-1], t))
        for k in (3, 4, 5):
            position[power == k] -= motion[k] / factorial(k)
            velocity[power == k] -= motion[k - 1] / factorial(k - 1)
        if stage < STAGES:
            forces[stage] = -(z * z)[:, None] * position - (2 * damping * z)[:, None] * velocity
            accelerations[stage] = forces[stage]
            for k in (3, 4, 5):
                accelerations[stage, power == k] += motion[k - 2] / factorial(k - 2)
    return position, velocity / z[:, None], forces


def matrix(method, z, damping):
    """The steps from a unit of position and from one of velocity."""
    none = numpy.zeros_like(z)
    return (oscillations(method, z, damping, *start, none) for start in ((none + 1, none), (none, none + 1)))


def growth(method):
    parts = numpy.arange(1, 64) / 63
    cases = [(part, damping) for damping in (0.0, 0.004, 0.02, 0.045) for part in parts]
    cases += [(part, damping) for damping in (0.08, 0.15) for part in parts[::2]]
    cases += [(part, 0.3) for part in parts[:42:2]]
    z, damping = numpy.array(cases).T * [[REACH], [1.0]]
    (a, c, _), (b, d, _) = matrix(method, z, damping)
    determinant, trace = product(a, d) - product(b, c), a + d
    allowed = numpy.maximum(numpy.exp(-0.25 * damping * z), 0.6) * (1 - 2e-5 * numpy.clip((z - 0.6) / 2, 0, 1))
    sign = numpy.sign(trace[:, :1])
    beyond = [plus(determinant, -allowed**2), plus(sign * trace - determinant / allowed[:, None], -allowed)]
    beyond = numpy.concatenate(beyond)
    over = numpy.maximum(beyond[:, 0], 0.0)
    return GROWTH * function(beyond, numpy.log1p(over), (beyond[:, 0] > 0) / (1 + over))


def drag(method):
    parts = numpy.linspace(0.04, 0.97, 22)
    cases = [(part, damping) for damping, most in ((0.03, 1.0), (0.15, 0.55)) for part in parts if part <= most]
    part, damping = numpy.array(cases).T
    z, none = part * REACH, numpy.zeros(len(part))
    (a, c, of_unit), (b, d, of_speed) = matrix(method, z, damping)
    a, d = plus(-a, 1.0), plus(-d, 1.0)
    determinant = product(a, d) - product(b, c)
    # The inverse, kept finite where a step is a whole turn.
    value = determinant[:, 0]
    inverse = function(determinant, value / (value**2 + 1e-4), (1e-4 - value**2) / (value**2 + 1e-4) ** 2)
    # Low frequencies count for more: every mechanism has them.
    by_frequency = 1 + numpy.minimum((0.7 / part) ** 3, 30)
    instants, first, second = method
    residuals = []
    for power, by in ((3, 1.0), (4, 1.0), (5, 0.3)):
        q, v, forces = oscillations(method, z, damping, none, none, none + power)
        stays = product(product(d, q) + product(b, v), inverse), product(product(a, v) + product(c, q), inverse)
        forces = forces + product(of_unit, stays[0][None]) + product(of_speed, stays[1][None])
        pushes = [sums(product(row[STAGES], instants), forces) for row in (first, second)]
        residuals += [by * by_frequency[:, None] * error for error in (*stays, *pushes)]
    residuals = DRAG * numpy.concatenate(residuals)
    value = residuals[:, 0]
    return function(residuals, numpy.arcsinh(value), 1 / numpy.sqrt(1 + value**2))


def slow(method):
    cases = [(z, damping) for damping in (0.0, 0.03, 0.3) for z in numpy.linspace(0.2, 2.5, 7)]
    z, damping = numpy.array(cases).T
    (a, c, _), (b, d, _) = matrix(method, z, damping)
    root = numpy.sqrt(1 - damping**2)
    sin, cos, decay = numpy.sin(root * z) / root, numpy.cos(root * z), numpy.exp(-damping * z)
    exact = decay * (cos + damping * sin), decay * sin, -decay * sin, decay * (cos - damping * sin)
    weight = SLOW / (0.02 + (z / 2.5) ** 5)
    return numpy.concatenate([plus(of, -value) * weight[:, None] for of, value in zip((a, b, c, d), exact)])


def residuals(unknowns):
    method = coefficients(unknowns)
    of_trees = []
    for order, by_momenta, momentum, position in violations(*method):
        if order < ORDER or by_momenta == 0:
            of_trees.append(TREES[order - 1] * momentum)
        if order < ORDER:
            of_trees.append(TREES[order - 1] * position)
    sizes = SIZE * numpy.hstack([unknowns[:, None], numpy.eye(len(unknowns))])
    return numpy.concatenate([of_trees, growth(method), drag(method), slow(method), sizes])


def search(unknowns):
    """Levenberg and Marquardt, damped in parts of the diagonal."""
    found, damping = residuals(unknowns), 1e-3
    for step in range(STEPS):
        values, slopes = found[:, 0], found[:, 1:]
        normal, gradient = slopes.T @ slopes, slopes.T @ values
        for _ in range(12):
            change = numpy.linalg.solve(normal + damping * numpy.diag(numpy.diag(normal)), gradient)
            trial = residuals(unknowns - change)
            if trial[:, 0] @ trial[:, 0] < values @ values:
                break
            damping *= 5
        else:
            break
        unknowns, found, damping = unknowns - change, trial, damping / 5
        if step % 5 == 4:
            print(f"step {step + 1}: squares {found[:, 0] @ found[:, 0]:.4f}", flush=True)
    return unknowns


def exact_quadrature(method):
    """The weights at the end, moved as little as possible."""
    instants, first, second = (number[..., 0].copy() for number in method)
    for rows, orders, exact in ((first, 6, lambda k: 1 / k), (second, 5, lambda k: 1 / (k * (k + 1)))):
        powers = numpy.array([instants**k for k in range(orders)])
        inverse = numpy.linalg.pinv(powers)
        for _ in range(3):
            rows[STAGES] -= inverse @ (powers @ rows[STAGES] - [exact(k + 1) for k in range(orders)])
    return instants, first, second


def limit(method, damping):
    """From where on an oscillation grows in a step by a thousandth, and by a hundredth."""
    z = numpy.arange(1, 1500) / 100
    (a, c, _), (b, d, _) = matrix([number[..., None] for number in method], z, damping + 0 * z)
    determinant, half = (a * d - b * c)[:, 0], (a + d)[:, 0] / 2
    factor = numpy.abs(half) + numpy.sqrt(numpy.maximum(half**2 - determinant, 0))
    factor = numpy.where(half**2 < determinant, numpy.sqrt(numpy.abs(determinant)), factor)
    grows = z[factor > 1 + 1e-3]
    return grows[0], z[factor > 1.01][0]


def report(method):
    wide = [number[..., None] for number in method]
    groups = {}
    for order, by_momenta, momentum, position in violations(*wide):
        largest = max(abs(momentum[0]), abs(position[0]) if order < ORDER else 0)
        key = order, "by momenta" if by_momenta else "none by momenta"
        groups[key] = max(groups.get(key, 0), largest)
    for (order, name), largest in sorted(groups.items()):
        print(f"trees of order {order}, {name}: {largest:.0e}")
    for damping in (0.0, 0.003, 0.01, 0.02, 0.03, 0.05, 0.1, 0.3):
        thousandth, hundredth = limit(method, damping)
        print(f"damping ratio {damping}: grows by 0.001 from {thousandth:.2f}, by 0.01 from {hundredth:.2f}")


def run(method, state, time, steps, instants):
    """The coordinates at these instants, evenly spaced, after steps of one size; the state at the end."""
    times, first, second = method
    q, v, h = state[:12].copy(), state[12:].copy(), time / steps
    seen, forces = [], numpy.zeros((STAGES, 12))
    for step in range(steps):
        for stage in range(STAGES + 1):
            t = times[stage] if stage < STAGES else 1.0
            to = q + h * (t * v + h * (second[stage] @ forces)), v + h * (first[stage] @ forces)
            if stage < STAGES:
                forces[stage] = ring.accelerations(*to)
                forces[stage + 1 :] = 0
        q, v = to
        if (step + 1) % (steps // instants) == 0:
            seen.append(q)
    return numpy.array(seen), numpy.concatenate([q, v])


def compare(methods, instants=25, time=0.5):
    """Rates for a quarter of a second and the largest error at the instants of half a second."""
    state = ring.start()
    for name in ("from rest", "after half a second"):
        reference, end = run(methods["nystrom"], state, time, 8000, instants)
        for of, method in methods.items():
            row = []
            for steps in range(550, 1150, 25):
                try:
                    with numpy.errstate(all="ignore"):
                        error = numpy.abs(run(method, state, time, steps, instants)[0] - reference).max()
                except (OverflowError, ValueError):
                    continue
                if error < 1e-3:
                    row.append(f"{STAGES * steps * 0.25 / time:.0f} {error:.0e}")
            print(f"| {name}, {of} | " + "; ".join(row) + " |", flush=True)
        state = end


def present():
    tableau = f"{ring.INTEGRATORS}/nystrom/tableau.rs"
    rows = [ring.literal(tableau, name)[: STAGES + 1] for name in ("FIRST", "SECOND")]
    first, second = (numpy.array([row + [0.0] * (STAGES - len(row)) for row in of]) for of in rows)
    return numpy.array(ring.literal(tableau, "INSTANTS")), first, second


def main():
    unknowns = search(numpy.array([weight for row in FIRST + SECOND for weight in row]))
    longer = exact_quadrature(coefficients(unknowns))
    for name, numbers in zip(("INSTANTS", "FIRST", "SECOND"), longer):
        print(name, numbers.tolist())
    for name, method in (("nystrom", present()), ("longer", longer)):
        print(f"\n{name}")
        report(method)
    if "search" not in sys.argv:
        print()
        compare({"nystrom": present(), "longer": longer})


if __name__ == "__main__":
    main()
