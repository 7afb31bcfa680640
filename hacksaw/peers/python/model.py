"""The hand-written planar model of `hacksaw/benches/scenes/planar.rs` over any kind of numbers.

In: the constants by name, a state of 24 expressions, the resistance of the cutting law. Out: the rates of the states, and
the blade's slip velocity whose sign chooses the resistance. Used with heyoka's and CasADi's expressions.
"""


def slip(p, s, sin, cos):
    """The velocity of the blade at the work point along the frame, m/s; negative while cutting."""
    x, y, angle = s[6:9]
    vx, vy, w = s[18:21]
    ex, ey = p["work_point"][0] - x, p["work_point"][1] - y
    return cos(angle) * (vx - w * ey) + sin(angle) * (vy + w * ex)


def rates(p, s, resistance, sin, cos):
    """The 24 rates, the forces pin by pin as in the plain Rust model."""
    links = [Link(s, i, sin, cos) for i in range(4)]
    crank, rod, frame, guide = links
    o, a2 = crank.point(-p["crank"], 0.0), crank.point(p["crank"], 0.0)
    a3, b3 = rod.point(-p["rod"], 0.0), rod.point(p["rod"], 0.0)
    b4 = frame.point(*p["b4"])
    block, pivot = guide.point(0.0, p["block"]), guide.point(0.0, p["pivot"])

    crank.apply(pin(p["pin_o"], (0.0, 0.0, 0.0, 0.0), o), o)
    for k, (one, at), (other, there) in (
        ("pin_a", (crank, a2), (rod, a3)),
        ("pin_b", (rod, b3), (frame, b4)),
    ):
        force = pin(p[k], at, there)
        other.apply(force, there)
        one.apply((-force[0], -force[1]), at)
    guide.apply(pin(p["pin_c"], (*p["o5"], 0.0, 0.0), pivot), pivot)

    _, offset, _, rate = frame.seen(block)
    force = frame.turned(0.0, p["slot"][0] * (offset - p["bar"]) + p["slot"][1] * rate)
    frame.apply(force, block)
    guide.apply((-force[0], -force[1]), block)
    twist = p["twist"][0] * (guide.angle - frame.angle) + p["twist"][1] * (guide.w - frame.w)
    frame.moment += twist
    guide.moment -= twist

    work = (*p["work_point"], 0.0, 0.0)
    _, height, slip_x, slip_y = frame.seen(work)
    across = p["work"][0] * (height - p["blade"]) + p["work"][1] * slip_y
    frame.apply(frame.turned(resistance * slip_x, across), work)
    crank.moment += p["torque"]

    velocities = [v for link in links for v in (link.vx, link.vy, link.w)]
    accelerations = []
    for link, mass, inertia in zip(links, p["masses"], p["inertias"]):
        accelerations += [mass * link.fx, mass * link.fy - p["gravity"], inertia * link.moment]
    return velocities + accelerations


class Link:
    """A link with the forces and the moment about its centre of mass that were applied so far."""

    def __init__(self, s, index, sin, cos):
        self.x, self.y, self.angle = s[3 * index : 3 * index + 3]
        self.vx, self.vy, self.w = s[12 + 3 * index : 15 + 3 * index]
        self.sin, self.cos = sin(self.angle), cos(self.angle)
        self.fx = self.fy = self.moment = 0.0

    def turned(self, x, y):
        """A vector of the link in inertial axes."""
        return self.cos * x - self.sin * y, self.sin * x + self.cos * y

    def point(self, x, y):
        """Place and velocity of a point given from the centre of mass in the link's axes."""
        x, y = self.turned(x, y)
        return self.x + x, self.y + y, self.vx - self.w * y, self.vy + self.w * x

    def seen(self, point):
        """Place and velocity of a point as seen from the link, in its axes."""
        dx, dy = point[0] - self.x, point[1] - self.y
        vx, vy = point[2] - self.vx + self.w * dy, point[3] - self.vy - self.w * dx
        s, c = self.sin, self.cos
        return c * dx + s * dy, c * dy - s * dx, c * vx + s * vy, c * vy - s * vx

    def apply(self, force, at):
        """Applies a force at a point."""
        self.fx += force[0]
        self.fy += force[1]
        self.moment += (at[0] - self.x) * force[1] - (at[1] - self.y) * force[0]


def pin(stiffness_and_damping, a, b):
    """The force of a pin on the link of point `b`."""
    k, r = stiffness_and_damping
    return k * (a[0] - b[0]) + r * (a[2] - b[2]), k * (a[1] - b[1]) + r * (a[3] - b[3])
