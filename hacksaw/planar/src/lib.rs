//! The hacksaw's hand-written model for the plane: body poses (x, y, angle of each link) and their
//! velocities, 24 states, the laws of the specification spelled out. What the generated scene is measured against.
//!
//! In: the parameters, a state, the stroke. Out: the state's rate, twice: [`Planar::rate`] plainly, point by point and
//! force by force, and [`Planar::tuned_rate`] with every known zero and common factor taken out by hand. The benchmark
//! of the scenes, the comparison with other solvers (`hacksaw/peers`) and the suite of the scenes use it.

use bg_model::nalgebra::SVector;
use bg_model::parameters::Parameters;
use bg_model::system::Model;

/// Poses and velocities of crank, rod, frame and guide: `[x, y, angle]` of each, m and rad, then their rates.
pub type State = [f64; 24];

/// What a pin does against being pulled apart.
#[derive(Clone, Copy)]
pub struct Pin {
    /// Stiffness, N/m.
    pub k: f64,
    /// Damping, N s/m.
    pub r: f64,
}

impl Pin {
    /// The force on the link of `b`.
    #[inline(always)]
    fn force(self, a: &Point, b: &Point) -> [f64; 2] {
        [self.k * (a.x - b.x) + self.r * (a.vx - b.vx), self.k * (a.y - b.y) + self.r * (a.vy - b.vy)]
    }
}

/// A place and its velocity, m and m/s.
struct Point {
    x: f64,
    y: f64,
    vx: f64,
    vy: f64,
}

/// A link with the forces and the moment about its centre of mass that were applied so far.
struct Link {
    x: f64,
    y: f64,
    angle: f64,
    vx: f64,
    vy: f64,
    w: f64,
    sine: f64,
    cosine: f64,
    fx: f64,
    fy: f64,
    moment: f64,
}

impl Link {
    #[inline(always)]
    fn of(s: &State, link: usize) -> Self {
        let [x, y, angle] = [s[3 * link], s[3 * link + 1], s[3 * link + 2]];
        let [vx, vy, w] = [s[12 + 3 * link], s[13 + 3 * link], s[14 + 3 * link]];
        let (sine, cosine) = angle.sin_cos();
        Self { x, y, angle, vx, vy, w, sine, cosine, fx: 0.0, fy: 0.0, moment: 0.0 }
    }

    /// A vector of the link in inertial axes.
    #[inline(always)]
    fn turned(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        [self.cosine * x - self.sine * y, self.sine * x + self.cosine * y]
    }

    /// A point given from the centre of mass in the link's axes.
    #[inline(always)]
    fn point(&self, place: [f64; 2]) -> Point {
        let [x, y] = self.turned(place);
        Point { x: self.x + x, y: self.y + y, vx: self.vx - self.w * y, vy: self.vy + self.w * x }
    }

    /// Place and velocity of a point as seen from the link, in its axes.
    #[inline(always)]
    fn seen(&self, point: &Point) -> [f64; 4] {
        let (dx, dy) = (point.x - self.x, point.y - self.y);
        let (vx, vy) = (point.vx - self.vx + self.w * dy, point.vy - self.vy - self.w * dx);
        let (sine, cosine) = (self.sine, self.cosine);
        [cosine * dx + sine * dy, cosine * dy - sine * dx, cosine * vx + sine * vy, cosine * vy - sine * vx]
    }

    #[inline(always)]
    fn apply(&mut self, [fx, fy]: [f64; 2], at: &Point) {
        self.fx += fx;
        self.fy += fy;
        self.moment += (at.x - self.x) * fy - (at.y - self.y) * fx;
    }
}

/// What depends on the parameters only.
pub struct Planar {
    /// Torque at the crank, N m.
    pub torque: f64,
    /// Gravitational acceleration downward, m/s^2.
    pub gravity: f64,
    /// Reciprocal masses, 1/kg.
    pub masses: [f64; 4],
    /// Reciprocal moments of inertia about the centres of mass, 1/(kg m^2).
    pub inertias: [f64; 4],
    /// Pin O2 between ground and crank.
    pub pin_o: Pin,
    /// Pin A between crank and rod.
    pub pin_a: Pin,
    /// Pin B between rod and frame.
    pub pin_b: Pin,
    /// Pin O5 between ground and guide.
    pub pin_c: Pin,
    /// The slot of the guide across its line.
    pub slot: Pin,
    /// The slot against rotation, N m/rad and N m s/rad.
    pub twist: Pin,
    /// The work piece below the blade.
    pub work: Pin,
    /// Resistance of the cutting stroke, N s/m.
    pub r_cut: f64,
    /// Resistance of the return stroke, N s/m.
    pub r_return: f64,
    /// Pin B in the frame, from the centre of mass like the next four, m.
    pub b4: [f64; 2],
    /// Height of the bar in the frame, m.
    pub bar: f64,
    /// Height of the blade line in the frame, m.
    pub blade: f64,
    /// Height of the sliding block in the guide, m.
    pub block: f64,
    /// Height of the pivot in the guide, m.
    pub pivot: f64,
}

/// Half the length of the crank, m: its pins are this far from its centre of mass.
pub const CRANK: f64 = 0.0375;
/// Half the length of the rod, m.
pub const ROD: f64 = 0.35;
/// Pivot of the guide, m.
pub const O5: [f64; 2] = [0.9, 0.745];
/// The point on the work piece, m.
pub const WORK: [f64; 2] = [0.9, -0.145];

/// Area in the plane, height of the centre of mass and moment of inertia about it over density and depth, of rectangles
/// `[a, b, x, y]`: edges a and b, centre (x, y) with all x symmetric about 0.
fn section(rectangles: &[[f64; 4]]) -> (f64, f64, f64) {
    let area: f64 = rectangles.iter().map(|[a, b, ..]| a * b).sum();
    let height = rectangles.iter().map(|[a, b, _, y]| a * b * y).sum::<f64>() / area;
    let inertia = rectangles.iter().map(|[a, b, x, y]| {
        let shift = y - height;
        a * b * ((a * a + b * b) / 12.0 + x * x + shift * shift)
    });
    (area, height, inertia.sum())
}

impl Planar {
    /// The model with these parameters of the hacksaw, by name.
    pub fn new(parameters: &impl Parameters) -> Self {
        let get = |name: &str| parameters.get(name).expect("a parameter of the hacksaw");
        let pin = |k: &str, r: &str| Pin { k: get(k), r: get(r) };
        let density = get("density");
        let crank = section(&[[0.075, 0.04, 0.0, 0.0]]);
        let rod = section(&[[0.7, 0.04, 0.0, 0.0]]);
        let frame = section(&[[0.4, 0.03, 0.0, 0.0], [0.03, 0.13, -0.185, -0.08], [0.03, 0.13, 0.185, -0.08]]);
        let guide = section(&[[0.1, 0.09, 0.0, 0.0], [0.09, 0.7, 0.0, 0.395]]);
        let depths = [0.02, 0.03, 0.03, 0.03];
        let sections = [crank, rod, frame, guide];
        Self {
            torque: get("torque"),
            gravity: get("gravity"),
            masses: std::array::from_fn(|i| 1.0 / (density * depths[i] * sections[i].0)),
            inertias: std::array::from_fn(|i| 1.0 / (density * depths[i] * sections[i].2)),
            pin_o: pin("k_2", "r_2"),
            pin_a: pin("k_23", "r_23"),
            pin_b: pin("k_34", "r_34"),
            pin_c: pin("k_15", "r_15"),
            slot: pin("k_45", "r_45"),
            twist: pin("k_45r", "r_45r"),
            work: pin("k_work", "r_work"),
            r_cut: get("r_cut"),
            r_return: get("r_return"),
            b4: [-0.2, -frame.1],
            bar: -frame.1,
            blade: -0.145 - frame.1,
            block: -guide.1,
            pivot: 0.745 - guide.1,
        }
    }

    /// The rate of `s`; `cutting` says that the blade moves toward the crank.
    #[inline(always)]
    pub fn rate(&self, s: &State, cutting: bool) -> State {
        self.rate_where(s, |_| cutting)
    }

    /// The rate of `s` where the blade's slip velocity along the frame, m/s, decides whether it is cutting.
    #[inline(always)]
    pub fn rate_where(&self, s: &State, cutting: impl FnOnce(f64) -> bool) -> State {
        let [mut crank, mut rod, mut frame, mut guide] = std::array::from_fn(|link| Link::of(s, link));
        let ground = |[x, y]: [f64; 2]| Point { x, y, vx: 0.0, vy: 0.0 };

        let (o, a2) = (crank.point([-CRANK, 0.0]), crank.point([CRANK, 0.0]));
        let (a3, b3) = (rod.point([-ROD, 0.0]), rod.point([ROD, 0.0]));
        let b4 = frame.point(self.b4);
        let (block, pivot) = (guide.point([0.0, self.block]), guide.point([0.0, self.pivot]));

        let force = self.pin_o.force(&ground([0.0, 0.0]), &o);
        crank.apply(force, &o);
        let [fx, fy] = self.pin_a.force(&a2, &a3);
        rod.apply([fx, fy], &a3);
        crank.apply([-fx, -fy], &a2);
        let [fx, fy] = self.pin_b.force(&b3, &b4);
        frame.apply([fx, fy], &b4);
        rod.apply([-fx, -fy], &b3);
        let force = self.pin_c.force(&ground(O5), &pivot);
        guide.apply(force, &pivot);

        let [_, offset, _, rate] = frame.seen(&block);
        let slot = self.slot.k * (offset - self.bar) + self.slot.r * rate;
        let [fx, fy] = frame.turned([0.0, slot]);
        frame.apply([fx, fy], &block);
        guide.apply([-fx, -fy], &block);
        let twist = self.twist.k * (guide.angle - frame.angle) + self.twist.r * (guide.w - frame.w);
        frame.moment += twist;
        guide.moment -= twist;

        let work = ground(WORK);
        let [_, height, slip_x, slip_y] = frame.seen(&work);
        let resistance = if cutting(-slip_x) { self.r_cut } else { self.r_return };
        let force = frame.turned([resistance * slip_x, self.work.k * (height - self.blade) + self.work.r * slip_y]);
        frame.apply(force, &work);
        crank.moment += self.torque;

        let mut rate = [0.0; 24];
        for (index, link) in [crank, rod, frame, guide].into_iter().enumerate() {
            rate[3 * index] = link.vx;
            rate[3 * index + 1] = link.vy;
            rate[3 * index + 2] = link.w;
            rate[12 + 3 * index] = self.masses[index] * link.fx;
            rate[13 + 3 * index] = self.masses[index] * link.fy - self.gravity;
            rate[14 + 3 * index] = self.inertias[index] * link.moment;
        }
        rate
    }

    /// The same with what a patient engineer saves.
    #[inline(always)]
    pub fn tuned_rate(&self, s: &State, cutting: bool) -> State {
        let [x2, y2, a2, x3, y3, a3, x4, y4, a4, x5, y5, a5, vx2, vy2, w2, vx3, vy3, w3, vx4, vy4, w4, vx5, vy5, w5] =
            *s;
        let ((s2, c2), (s3, c3)) = (a2.sin_cos(), a3.sin_cos());
        let ((s4, c4), (s5, c5)) = (a4.sin_cos(), a5.sin_cos());

        // Pin 1-2: O is at -CRANK, A at +CRANK on the crank's axis. Forces on the crank.
        let (ax, ay) = (CRANK * c2, CRANK * s2);
        let fox = -self.pin_o.k * (x2 - ax) - self.pin_o.r * (vx2 + w2 * ay);
        let foy = -self.pin_o.k * (y2 - ay) - self.pin_o.r * (vy2 - w2 * ax);

        // Pin 2-3: forces on the rod at A.
        let (bx, by) = (ROD * c3, ROD * s3);
        let fax = self.pin_a.k * (x2 + ax - x3 + bx) + self.pin_a.r * (vx2 - w2 * ay - vx3 - w3 * by);
        let fay = self.pin_a.k * (y2 + ay - y3 + by) + self.pin_a.r * (vy2 + w2 * ax - vy3 + w3 * bx);

        // Pin 3-4: forces on the frame at B.
        let (px, py) = (c4 * self.b4[0] - s4 * self.b4[1], s4 * self.b4[0] + c4 * self.b4[1]);
        let fbx = self.pin_b.k * (x3 + bx - x4 - px) + self.pin_b.r * (vx3 - w3 * by - vx4 + w4 * py);
        let fby = self.pin_b.k * (y3 + by - y4 - py) + self.pin_b.r * (vy3 + w3 * bx - vy4 - w4 * px);

        // Pin 1-5: forces on the guide at its pivot.
        let (qx, qy) = (-s5 * self.pivot, c5 * self.pivot);
        let fcx = self.pin_c.k * (O5[0] - x5 - qx) - self.pin_c.r * (vx5 - w5 * qy);
        let fcy = self.pin_c.k * (O5[1] - y5 - qy) - self.pin_c.r * (vy5 + w5 * qx);

        // Slot: the block's centre on the bar's centre line; force on the guide along the frame's y.
        let (ux, uy) = (-s5 * self.block, c5 * self.block);
        let (dx, dy) = (x5 + ux - x4, y5 + uy - y4);
        let (vdx, vdy) = (vx5 - w5 * uy - vx4 + w4 * dy, vy5 + w5 * ux - vy4 - w4 * dx);
        let slot = self.slot.k * (c4 * dy - s4 * dx - self.bar) + self.slot.r * (c4 * vdy - s4 * vdx);
        let (fsx, fsy) = (s4 * slot, -c4 * slot);
        let twist = self.twist.k * (a5 - a4) + self.twist.r * (w5 - w4);

        // Blade on work: forces on the frame at the fixed point of the work.
        let (ex, ey) = (WORK[0] - x4, WORK[1] - y4);
        let (vex, vey) = (vx4 - w4 * ey, vy4 + w4 * ex);
        let resistance = if cutting { self.r_cut } else { self.r_return };
        let along = -resistance * (c4 * vex + s4 * vey);
        let across = -self.work.k * (self.blade + s4 * ex - c4 * ey) - self.work.r * (c4 * vey - s4 * vex);
        let (fwx, fwy) = (c4 * along - s4 * across, s4 * along + c4 * across);

        let [m2, m3, m4, m5] = self.masses;
        let [j2, j3, j4, j5] = self.inertias;
        let g = self.gravity;
        [
            vx2,
            vy2,
            w2,
            vx3,
            vy3,
            w3,
            vx4,
            vy4,
            w4,
            vx5,
            vy5,
            w5,
            m2 * (fox - fax),
            m2 * (foy - fay) - g,
            j2 * (self.torque - ax * (foy + fay) + ay * (fox + fax)),
            m3 * (fax - fbx),
            m3 * (fay - fby) - g,
            j3 * (by * (fax + fbx) - bx * (fay + fby)),
            m4 * (fbx - fsx + fwx),
            m4 * (fby - fsy + fwy) - g,
            j4 * (px * fby - py * fbx - dx * fsy + dy * fsx + ex * fwy - ey * fwx + twist),
            m5 * (fcx + fsx),
            m5 * (fcy + fsy) - g,
            j5 * (qx * fcy - qy * fcx + ux * fsy - uy * fsx - twist),
        ]
    }

    /// The pose state of a scene's state, which `get` gives by name.
    ///
    /// The scene's slot spring, whose displacement is a state of its own there, has to be at the difference of the
    /// angles.
    pub fn state(&self, get: impl Fn(&str) -> f64) -> State {
        let mut state = [0.0; 24];
        for (link, name) in LINKS.iter().enumerate() {
            state[3 * link] = get(&format!("{name}.position_x"));
            state[3 * link + 1] = get(&format!("{name}.position_y"));
            state[3 * link + 2] =
                (-get(&format!("{name}.orientation_12"))).atan2(get(&format!("{name}.orientation_11")));
            state[12 + 3 * link] = self.masses[link] * get(&format!("{name}.linear.p_x"));
            state[13 + 3 * link] = self.masses[link] * get(&format!("{name}.linear.p_y"));
            state[14 + 3 * link] = self.inertias[link] * get(&format!("{name}.angular.p_z"));
        }
        state
    }

    /// Adds the accelerations of `rate` and those that the scene's rates of momenta give to `comparison`.
    pub fn compare(&self, rate: &State, scene_rate: impl Fn(&str) -> f64, comparison: &mut Comparison) {
        for (link, name) in LINKS.iter().enumerate() {
            let theirs = [
                self.masses[link] * scene_rate(&format!("{name}.linear.p_x")),
                self.masses[link] * scene_rate(&format!("{name}.linear.p_y")),
                self.inertias[link] * scene_rate(&format!("{name}.angular.p_z")),
            ];
            for (axis, theirs) in theirs.into_iter().enumerate() {
                let (ours, kind) = (rate[12 + 3 * link + axis], axis / 2);
                comparison.difference[kind] = comparison.difference[kind].max((ours - theirs).abs());
                comparison.largest[kind] = comparison.largest[kind].max(ours.abs());
            }
        }
    }
}

/// Accelerations of two models, of translation (m/s^2) and of rotation (rad/s^2).
#[derive(Default)]
pub struct Comparison {
    difference: [f64; 2],
    largest: [f64; 2],
}

impl Comparison {
    /// The largest difference over the largest acceleration of its kind.
    pub fn relative(&self) -> f64 {
        (self.difference[0] / self.largest[0]).max(self.difference[1] / self.largest[1])
    }
}

/// The links' names in the mechanism.
pub const LINKS: [&str; 4] = ["crank", "rod", "frame", "guide"];

/// A state of the paper's scene as poses with the stroke; both hand-written rates there are compared with the scene's.
///
/// The slot's twist is a state of its own in the scene, which the integrator keeps near the difference of the two
/// angles to its tolerance; here it is put there.
pub fn beside<M: Model<f64, N, 1, O>, const N: usize, const O: usize>(
    model: &M,
    parameters: &impl Parameters,
    mut x: SVector<f64, N>,
    negative: [bool; 1],
    comparison: &mut Comparison,
) -> (State, bool) {
    let names = model.description().states;
    let index = |name: &str| names.iter().position(|state| state.name == name).expect("a state of the paper's scene");
    let planar = Planar::new(parameters);
    let state = planar.state(|name| x[index(name)]);
    x[index("slot.tilt_spring.q_z")] = state[11] - state[8];
    let mut rate = SVector::zeros();
    model.rate(0.0, &x, &negative, &mut rate);
    for ours in [planar.rate(&state, negative[0]), planar.tuned_rate(&state, negative[0])] {
        planar.compare(&ours, |name| rate[index(name)], comparison);
    }
    (state, negative[0])
}
