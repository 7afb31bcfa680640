//! The hacksaw as an engineer writes it by hand for the plane: body poses (x, y, angle of each link) and their velocities,
//! 24 states, the laws of the specification spelled out. What the generated scene is measured against.
//!
//! In: the parameters, a state, the stroke. Out: the state's rate. About 310 operations and four sine and cosine pairs.

use bg_model::parameters::Parameters;

/// Poses and velocities of crank, rod, frame and guide: `[x, y, angle]` of each, m and rad, then their rates.
pub type State = [f64; 24];

/// A pin's stiffness, N/m, and damping, N s/m.
#[derive(Clone, Copy)]
struct Pin {
    k: f64,
    r: f64,
}

/// What depends on the parameters only.
pub struct Planar {
    torque: f64,
    gravity: f64,
    /// Reciprocal masses, 1/kg, and moments of inertia about the centres of mass, 1/(kg m^2).
    masses: [f64; 4],
    inertias: [f64; 4],
    pin_o: Pin,
    pin_a: Pin,
    pin_b: Pin,
    pin_c: Pin,
    slot: Pin,
    twist: Pin,
    work: Pin,
    r_cut: f64,
    r_return: f64,
    /// Points in their links, from the centre of mass, m: pin B and bar and blade line in the frame, block and pivot in the
    /// guide.
    b4: [f64; 2],
    bar: f64,
    blade: f64,
    block: f64,
    pivot: f64,
}

/// Half the lengths of crank and rod, m: their pins are this far from their centres of mass.
const CRANK: f64 = 0.0375;
const ROD: f64 = 0.35;
/// Pivot of the guide and the point on the work piece, m.
const O5: [f64; 2] = [0.9, 0.745];
const WORK: [f64; 2] = [0.9, -0.145];

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
        let [x2, y2, a2, x3, y3, a3, x4, y4, a4, x5, y5, a5, vx2, vy2, w2, vx3, vy3, w3, vx4, vy4, w4, vx5, vy5, w5] = *s;
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

    /// The pose state of a scene's state vector and what its rates are here: both by the names of the scene's states.
    ///
    /// The scene's slot spring, whose displacement is a state of its own there, has to be at the difference of the angles.
    pub fn state(&self, get: impl Fn(&str) -> f64) -> State {
        let mut state = [0.0; 24];
        for (link, name) in LINKS.iter().enumerate() {
            state[3 * link] = get(&format!("{name}.position_x"));
            state[3 * link + 1] = get(&format!("{name}.position_y"));
            state[3 * link + 2] = (-get(&format!("{name}.orientation_12"))).atan2(get(&format!("{name}.orientation_11")));
            state[12 + 3 * link] = self.masses[link] * get(&format!("{name}.linear.p_x"));
            state[13 + 3 * link] = self.masses[link] * get(&format!("{name}.linear.p_y"));
            state[14 + 3 * link] = self.inertias[link] * get(&format!("{name}.angular.p_z"));
        }
        state
    }

    /// The largest difference between the accelerations of `rate` and those that the scene's rates of momenta give, over the
    /// largest acceleration of the same kind (translation, rotation).
    pub fn disagreement(&self, rate: &State, scene_rate: impl Fn(&str) -> f64) -> f64 {
        let (mut difference, mut largest) = ([0.0_f64; 2], [0.0_f64; 2]);
        for (link, name) in LINKS.iter().enumerate() {
            let theirs = [
                self.masses[link] * scene_rate(&format!("{name}.linear.p_x")),
                self.masses[link] * scene_rate(&format!("{name}.linear.p_y")),
                self.inertias[link] * scene_rate(&format!("{name}.angular.p_z")),
            ];
            for (axis, theirs) in theirs.into_iter().enumerate() {
                let (ours, kind) = (rate[12 + 3 * link + axis], axis / 2);
                difference[kind] = difference[kind].max((ours - theirs).abs());
                largest[kind] = largest[kind].max(ours.abs());
            }
        }
        (difference[0] / largest[0]).max(difference[1] / largest[1])
    }
}

/// The links' names in the mechanism.
pub const LINKS: [&str; 4] = ["crank", "rod", "frame", "guide"];
