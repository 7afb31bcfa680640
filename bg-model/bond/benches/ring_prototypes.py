"""Methods for the ring of stiff joints, as prototypes beside `nystrom` and DOP853: rates and errors on the hacksaw in the plane.

    python bg-model/bond/benches/ring_prototypes.py           # from the root of the project; some minutes, needs numpy and scipy

The model is that of hacksaw/planar, in 12 coordinates and their velocities, its stroke always the cutting one, from an unloaded pose at rest.
Steps have one size, so no control of errors plays a part: a row is the rates of a run of 0.25 s and the largest error of a position (m) or
an angle (rad) at its end, beside DOP853 with a fortieth of the longest step. Work beside the rates is named, not counted.

- `impulse` is r-RESPA (Tuckerman, Berne, Martyna 1992) made symmetric: the forces of pin B, which alone ring at the highest frequency, in
  `inner` steps of leapfrog inside of kicks by all others; of order 2, and composed to order 4 (Suzuki). A rate of pin B alone counts a fifth.
- `frozen` is the symmetric splitting with the exact flow of the rate made linear at the start of some steps (Deuflhard's idea), and kicks by
  what that leaves: order 2, composed to order 4. A flow is a matrix of 24 x 24 times the state.
- `exprb43` is the exponential Rosenbrock method of order 4 with an error estimate of order 3 (Hochbruck, Ostermann, Schweitzer 2009), its
  Jacobian new in each step: counted as two rates, as in the generated code; three matrix functions of 24 x 24 a step.
- `gauss6` is implicit, without an error in the energy: Newton's method with the Jacobian of the step's start, three rates an iteration.
"""

import math
import re
import sys
from pathlib import Path

import numpy
from scipy.linalg import expm, lu_factor, lu_solve

END = 0.25
CRANK, ROD = 0.0375, 0.35
O5, WORK = (0.9, 0.745), (0.9, -0.145)


def section(rectangles):
    area = sum(a * b for a, b, _, _ in rectangles)
    height = sum(a * b * y for a, b, _, y in rectangles) / area
    return area, height, sum(a * b * ((a * a + b * b) / 12 + x * x + (y - height) ** 2) for a, b, x, y in rectangles)


SECTIONS = [section(part) for part in (
    [(0.075, 0.04, 0, 0)],
    [(0.7, 0.04, 0, 0)],
    [(0.4, 0.03, 0, 0), (0.03, 0.13, -0.185, -0.08), (0.03, 0.13, 0.185, -0.08)],
    [(0.1, 0.09, 0, 0), (0.09, 0.7, 0, 0.395)],
)]
MASSES = [1 / (7850 * depth * part[0]) for depth, part in zip((0.02, 0.03, 0.03, 0.03), SECTIONS)]
INERTIAS = [1 / (7850 * depth * part[2]) for depth, part in zip((0.02, 0.03, 0.03, 0.03), SECTIONS)]
FRAME, GUIDE = SECTIONS[2][1], SECTIONS[3][1]
B4, BAR, BLADE, BLOCK, PIVOT = (-0.2, -FRAME), -FRAME, -0.145 - FRAME, -GUIDE, 0.745 - GUIDE


def accelerations(q, v, with_b=True, with_others=True):
    """Those of all coordinates by pin B, by everything else, or both."""
    x2, y2, a2, x3, y3, a3, x4, y4, a4, x5, y5, a5 = q
    vx2, vy2, w2, vx3, vy3, w3, vx4, vy4, w4, vx5, vy5, w5 = v
    s3, c3, s4, c4 = math.sin(a3), math.cos(a3), math.sin(a4), math.cos(a4)
    bx, by = ROD * c3, ROD * s3
    px, py = c4 * B4[0] - s4 * B4[1], s4 * B4[0] + c4 * B4[1]
    fbx = fby = 0.0
    if with_b:
        fbx = 1e8 * (x3 + bx - x4 - px) + 0.5 * (vx3 - w3 * by - vx4 + w4 * py)
        fby = 1e8 * (y3 + by - y4 - py) + 0.5 * (vy3 + w3 * bx - vy4 - w4 * px)
    m2, m3, m4, m5 = MASSES
    j2, j3, j4, j5 = INERTIAS
    if not with_others:
        of_rod = [-m3 * fbx, -m3 * fby, j3 * (by * fbx - bx * fby)]
        of_frame = [m4 * fbx, m4 * fby, j4 * (px * fby - py * fbx)]
        return numpy.array([0, 0, 0, *of_rod, *of_frame, 0, 0, 0])
    s2, c2, s5, c5 = math.sin(a2), math.cos(a2), math.sin(a5), math.cos(a5)
    ax, ay = CRANK * c2, CRANK * s2
    fox, foy = -1e7 * (x2 - ax) - 0.5 * (vx2 + w2 * ay), -1e7 * (y2 - ay) - 0.5 * (vy2 - w2 * ax)
    fax = 1e7 * (x2 + ax - x3 + bx) + 100 * (vx2 - w2 * ay - vx3 - w3 * by)
    fay = 1e7 * (y2 + ay - y3 + by) + 100 * (vy2 + w2 * ax - vy3 + w3 * bx)
    qx, qy = -s5 * PIVOT, c5 * PIVOT
    fcx = 1e6 * (O5[0] - x5 - qx) - 10 * (vx5 - w5 * qy)
    fcy = 1e6 * (O5[1] - y5 - qy) - 10 * (vy5 + w5 * qx)
    ux, uy = -s5 * BLOCK, c5 * BLOCK
    dx, dy = x5 + ux - x4, y5 + uy - y4
    vdx, vdy = vx5 - w5 * uy - vx4 + w4 * dy, vy5 + w5 * ux - vy4 - w4 * dx
    slot = 1e7 * (c4 * dy - s4 * dx - BAR) + 100 * (c4 * vdy - s4 * vdx)
    fsx, fsy = s4 * slot, -c4 * slot
    twist = 1e4 * (a5 - a4) + 100 * (w5 - w4)
    ex, ey = WORK[0] - x4, WORK[1] - y4
    vex, vey = vx4 - w4 * ey, vy4 + w4 * ex
    along = -100 * (c4 * vex + s4 * vey)
    across = -100 * (BLADE + s4 * ex - c4 * ey) - 100 * (c4 * vey - s4 * vex)
    fwx, fwy = c4 * along - s4 * across, s4 * along + c4 * across
    g = 9.81
    return numpy.array([
        m2 * (fox - fax), m2 * (foy - fay) - g, j2 * (10 - ax * (foy + fay) + ay * (fox + fax)),
        m3 * (fax - fbx), m3 * (fay - fby) - g, j3 * (by * (fax + fbx) - bx * (fay + fby)),
        m4 * (fbx - fsx + fwx), m4 * (fby - fsy + fwy) - g,
        j4 * (px * fby - py * fbx - dx * fsy + dy * fsx + ex * fwy - ey * fwx + twist),
        m5 * (fcx + fsx), m5 * (fcy + fsy) - g, j5 * (qx * fcy - qy * fcx + ux * fsy - uy * fsx - twist),
    ])


class Counted:
    """The rate, and how often it was asked for."""

    def __init__(self):
        self.rates = 0.0

    def accelerations(self, q, v):
        self.rates += 1
        return accelerations(q, v)

    def __call__(self, s):
        return numpy.concatenate([s[12:], self.accelerations(s[:12], s[12:])])

    def jacobian(self, s):
        """By central differences; counted as two rates."""
        self.rates += 2
        rate = lambda s: numpy.concatenate([s[12:], accelerations(s[:12], s[12:])])
        columns = []
        for i in range(24):
            step = 1e-7 * max(1.0, abs(s[i]))
            up, down = s.copy(), s.copy()
            up[i] += step
            down[i] -= step
            columns.append((rate(up) - rate(down)) / (2 * step))
        return numpy.array(columns).T


def start():
    """Crank and guide upright as drawn, joints unloaded, at rest; settled by a damped search for nothing: the pose is exact."""
    a_x = 2 * CRANK
    guide = (O5[0], O5[1] - PIVOT, 0.0)
    frame_y = guide[1] + BLOCK - BAR
    b_y = frame_y + B4[1]
    angle = math.asin(b_y / (2 * ROD))
    frame_x = a_x + 2 * ROD * math.cos(angle) - B4[0]
    q = [CRANK, 0, 0, a_x + ROD * math.cos(angle), ROD * math.sin(angle), angle, frame_x, frame_y, 0, *guide]
    return numpy.array(q + [0.0] * 12)


def literal(path, name):
    """A constant of a Rust file, lists of numbers and of pairs."""
    text = re.search(rf"const {name}: [^=]*= &?(\[.*?\]);", Path(path).read_text(), re.S).group(1)
    text = re.sub(r"//[^\n]*", "", text).replace("&", "")
    return eval(text)


INTEGRATORS = "bg-model/src/solve/integrator"


def dop853(f, s, h, steps):
    rows = literal(f"{INTEGRATORS}/explicit/dop853.rs", "A")[:13]
    for _ in range(steps):
        k = [f(s)]
        for row in rows[1:12]:
            k.append(f(s + h * sum(weight * k[stage] for stage, weight in row)))
        s = s + h * sum(weight * k[stage] for stage, weight in rows[12])
    return s


def nystrom(f, s, h, steps):
    tableau = f"{INTEGRATORS}/nystrom/tableau.rs"
    first, second, instants = (literal(tableau, name) for name in ("FIRST", "SECOND", "INSTANTS"))
    for _ in range(steps):
        q, v = s[:12], s[12:]
        k = [f.accelerations(q, v)]
        for stage in range(1, 10):
            sums = [sum(weight * k for weight, k in zip(weights[stage], k)) for weights in (first, second)]
            at = (q + h * ((instants[stage] if stage < 9 else 1.0) * v + h * sums[1]), v + h * sums[0])
            if stage < 9:
                k.append(f.accelerations(*at))
        s = numpy.concatenate(at)
    return s


def composed(step, order):
    """A symmetric step of order 2, or Suzuki's composition of five of them."""
    p = 1 / (4 - 4 ** (1 / 3))
    parts = [1.0] if order == 2 else [p, p, 1 - 4 * p, p, p]

    def of(f, s, h, steps):
        for _ in range(steps):
            for part in parts:
                s = step(f, s, part * h)
        return s

    return of


def kick(q, v, h, of):
    """A kick by forces that depend on velocities, weakly: the midpoint rule by two iterations, one of which counts."""
    a = of(q, v)
    return v + h * of(q, v + 0.5 * h * a)


def impulse(inner):
    def step(f, s, h):
        q, v = s[:12], s[12:]
        others = lambda q, v: accelerations(q, v, with_b=False)
        alone = lambda q, v: accelerations(q, v, with_others=False)
        v = kick(q, v, h / 2, others)
        for _ in range(inner):
            q = q + h / inner / 2 * v
            v = kick(q, v, h / inner, alone)
            q = q + h / inner / 2 * v
        v = kick(q, v, h / 2, others)
        f.rates += 2 * 0.8 + inner * 0.2
        return numpy.concatenate([q, v])

    return step


def frozen(renewal):
    memory = {"steps": 0}

    def step(f, s, h):
        if memory["steps"] % renewal == 0:
            jacobian, rate = f.jacobian(s), f(s)
            affine = numpy.zeros((25, 25))
            affine[:24, :24], affine[:24, 24] = jacobian, rate
            memory.update(origin=s, rate=rate, jacobian=jacobian, affine=affine, flows={})
        memory["steps"] += 1
        origin, rate, jacobian, affine, flows = (memory[name] for name in ("origin", "rate", "jacobian", "affine", "flows"))
        if h not in flows:
            flows[h] = expm(h * affine)
        rest = lambda s: f(s) - rate - jacobian @ (s - origin)

        def half(s):
            return s + h / 2 * rest(s + h / 4 * rest(s))

        return half(origin + (flows[h] @ numpy.append(half(s) - origin, 1.0))[:24])

    return step


def phi_of(k, z):
    """phi_k of numbers: (exp z - 1 - z - .. - z^(k-1) / (k-1)!) / z^k."""
    small = sum(z**j / math.factorial(j + k) for j in range(18))
    with numpy.errstate(all="ignore"):
        large = (numpy.exp(z) - sum(z**j / math.factorial(j) for j in range(k))) / z**k
    return numpy.where(numpy.abs(z) < 1.0, small, large)


def exprb43(f, s, h, steps):
    for _ in range(steps):
        jacobian, rate = f.jacobian(s), f(s)
        rest = rate - jacobian @ s
        values, vectors = numpy.linalg.eig(jacobian)
        inverse = numpy.linalg.inv(vectors)
        phi = lambda k, h: (vectors @ numpy.diag(phi_of(k, h * values)) @ inverse).real
        half, one, three, four = phi(1, h / 2), phi(1, h), phi(3, h), phi(4, h)
        u2 = s + h / 2 * half @ rate
        d2 = f(u2) - jacobian @ u2 - rest
        u3 = s + h * one @ (rate + d2)
        d3 = f(u3) - jacobian @ u3 - rest
        s = s + h * (one @ rate + (16 * three - 48 * four) @ d2 + (-2 * three + 12 * four) @ d3)
    return s


def gauss6(f, s, h, steps):
    root = math.sqrt(15)
    a = numpy.array([
        [5 / 36, 2 / 9 - root / 15, 5 / 36 - root / 30],
        [5 / 36 + root / 24, 2 / 9, 5 / 36 - root / 24],
        [5 / 36 + root / 30, 2 / 9 + root / 15, 5 / 36],
    ])
    b = numpy.array([5 / 18, 4 / 9, 5 / 18])
    k = numpy.tile(f(s), 3)
    for _ in range(steps):
        factors = lu_factor(numpy.eye(72) - h * numpy.kron(a, f.jacobian(s)))
        for _ in range(30):
            stages = numpy.concatenate([f(s + h * (a[i] @ k.reshape(3, 24))) for i in range(3)])
            change = lu_solve(factors, stages - k)
            k = k + change
            if h * numpy.abs(change).max() < 1e-13:
                break
        s = s + h * (b @ k.reshape(3, 24))
    return s


METHODS = {
    "dop853": dop853,
    "nystrom": nystrom,
    "impulse 2, inner 4": composed(impulse(4), 2),
    "impulse 4, inner 4": composed(impulse(4), 4),
    "frozen 2, 1 step": composed(frozen(1), 2),
    "frozen 4, 5 steps": composed(frozen(5), 4),
    "exprb43": exprb43,
    "gauss6": gauss6,
}


def main():
    s = start()
    eigenvalues = numpy.linalg.eigvals(Counted().jacobian(s))
    ring = sorted({(round(abs(e)), round(-e.real / abs(e), 4)) for e in eigenvalues if e.imag > 1}, reverse=True)
    print("frequency, rad/s, and damping ratio: " + ", ".join(f"{w} {d}" for w, d in ring))
    exact = dop853(Counted(), s, END / 16000, 16000)
    coarser = dop853(Counted(), s, END / 12000, 12000)
    print(f"reference good to {numpy.abs(exact - coarser)[:12].max():.1e}\n")
    print("| method | rates, error |\n|---|---|")
    for name, method in METHODS.items():
        if len(sys.argv) > 1 and sys.argv[1] not in name:
            continue
        row = []
        for steps in (80, 160, 240, 320, 400, 500, 640, 900, 1280, 1800, 2560, 5120, 10240):
            f = Counted()
            with numpy.errstate(all="ignore"):
                try:
                    end = method(f, s, END / steps, steps)
                except (OverflowError, ValueError):
                    continue
            error = numpy.abs(end - exact)[:12].max()
            if error < 1e-2:
                row.append(f"{f.rates:.0f} {error:.0e}")
            if f.rates > 25000 or error < 3e-11:
                break
        print(f"| {name} | " + "; ".join(row) + " |", flush=True)


if __name__ == "__main__":
    main()
