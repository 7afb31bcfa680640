//! Published mechanisms with rigid joints against published and closed solutions.

use bond_graph_tests::hardcases::pendulums::{RigidPendulum, RigidPendulumParameters};
use bond_graph_tests::models::mechanisms::{
    DoubleFourBar, DoubleFourBarParameters, FlyballGovernor, FlyballGovernorParameters, FourBarsBySpeeds,
    FourBarsBySpeedsParameters,
};
use bond_graph_tests::models::slider_crank::{RigidSliderCrank, RigidSliderCrankParameters};
use bond_graph_tests::support::record::{Record, instants, record};

use super::truth::within;

/// The parts of the double four-bar that have an energy and a gap.
pub const PARTS: [&str; 5] = ["first", "square[0]", "square[0].post", "square[1]", "square[1].post"];

/// The sum of an output of all parts at every sample.
fn sums(run: &Record, what: &str) -> Vec<f64> {
    let parts = PARTS.map(|part| run.series(&format!("{part}.{what}")));
    (0..run.times.len()).map(|k| parts.iter().map(|part| part[k]).sum()).collect()
}

/// The largest relative departure of these energies, J, from the first.
fn drift(energies: &[f64]) -> f64 {
    energies.iter().fold(0.0, |most, energy| f64::max(most, (energy / energies[0] - 1.0).abs()))
}

/// Runs with the reactions of all joints, and with those alone that close the loops.
fn double_four_bars(end: f64, samples: u32) -> [Record; 2] {
    let all = DoubleFourBar::new(DoubleFourBarParameters::default()).unwrap();
    let closing = FourBarsBySpeeds::new(FourBarsBySpeedsParameters::default()).unwrap();
    let times = instants(end, samples);
    [record(&all, &times, 1e-10), record(&closing, &times, 1e-10)]
}

/// IFToMM A02 for 10 s: ten flat poses, in each of which two loops could go another way. All posts turn alike, so the
/// first one is a pendulum, theta'' = -11.445 cos(theta); position and velocity of its upper end at 5 and 10 s by
/// Jacobi's elliptic functions to 34 digits. EXUDYN's published 0.3284573768, 0.9445187937 for 10 s are of steps of
/// 1.25e-4 s.
#[test]
fn the_double_four_bar_passes_its_flat_poses() {
    let truth = [
        (200, [-0.811_310_461_005_107_4, -0.584_615_545_348_975_5, -3.569_117_397_193_209, 4.953_105_171_312_673]),
        (400, [0.328_458_111_540_815_4, 0.944_518_538_178_600_9, 1.423_051_470_206_944, -0.494_868_845_487_043]),
    ];
    // Where steps happen to come down beside the flat poses decides about the second one: at tolerances from 0.8 to 1.2
    // of this one v0_x errs by 5e-11 to 3e-7.
    for (run, limit) in double_four_bars(10.0, 400).into_iter().zip([1e-8, 1e-6]) {
        for (sample, values) in truth {
            for (name, value) in ["B0_x", "B0_y", "v0_x", "v0_y"].into_iter().zip(values) {
                within(name, (run.series(name)[sample] - value).abs(), limit);
            }
        }
        let crossings = run.series("B0_y").windows(2).filter(|pair| pair[0] * pair[1] < 0.0).count();
        assert_eq!(crossings, 10);
        // Samples beside flat poses err more than steps do, since the projection makes of it what it can: by 7e-11 to
        // 1.2e-6 at tolerances from 0.8 to 1.24 of this one.
        let energies = sums(&run, "energy");
        within("energy at the end", drift(&[energies[0], energies[400]]), limit);
        within("energy", drift(&energies), 1e-5);
    }
}

/// How far the joints of the closed loops have come apart after 5 s, and after 1000 s; a debug build ends at 50 s.
#[test]
fn gaps_of_closed_loops_stay_at_rounding() {
    let end = if cfg!(debug_assertions) { 50.0 } else { 1000.0 };
    for (run, short) in double_four_bars(end, 200).into_iter().zip(double_four_bars(5.0, 1)) {
        let gaps = sums(&run, "gap");
        within("gap after 5 s", sums(&short, "gap")[1], 1e-12);
        within("gap at the end", gaps[200], 1e-12);
        println!("largest gap {:e}", gaps.iter().fold(0.0, |most, gap| f64::max(most, *gap)));
    }
}

/// IFToMM A01 for 10 s, and on to 1000 s, of which a debug build runs 50: energy from the end, which moves as a point
/// mass does, and its distance from the pin. Reference by Jacobi's elliptic functions.
#[test]
fn a_rigid_pendulum_keeps_its_energy_and_its_length() {
    let model = RigidPendulum::new(RigidPendulumParameters::default()).unwrap();
    let run = record(&model, &instants(10.0, 400), 1e-10);
    let [x, y, u, v] = ["x", "y", "u", "v"].map(|name| run.series(name));
    let end = [x[400], y[400], u[400], v[400]];
    let truth = [-0.275_087_462_576_116_9, -0.961_419_205_099_125, 4.175_598_101_950_832, -1.194_749_054_560_475_3];
    let error = end.iter().zip(truth).fold(0.0, |most, (a, b)| f64::max(most, (a - b).abs()));
    within("the end at 10 s", error, 1e-8);
    // In parts of the 9.81 J that it gains on the way down.
    let energy = |k: usize| 0.5 * (u[k] * u[k] + v[k] * v[k]) + 9.81 * y[k];
    within("energy", (0..=400).fold(0.0, |most, k| f64::max(most, (energy(k) - energy(0)).abs())) / 9.81, 1e-8);
    let gap = |x: f64, y: f64| (x.hypot(y) - 1.0).abs();
    within("gap after 5 s", gap(x[200], y[200]), 1e-12);
    let long = record(&model, &[0.0, if cfg!(debug_assertions) { 50.0 } else { 1000.0 }], 1e-10);
    within("gap at the end", gap(long.last("x"), long.last("y")), 1e-12);
}

/// Radau IIA of orders 13 and 17 in quad precision, github RehabEngGroup/MBSbenchmarksInOpenSim (c76fa61), A05. The
/// dampers make it stiff; a debug build ends at 1 s.
#[test]
fn the_flyball_governor_sinks_as_published() {
    let seconds = if cfg!(debug_assertions) { 1 } else { 5 };
    let model = FlyballGovernor::new(FlyballGovernorParameters::default()).unwrap();
    let run = record(&model, &instants(f64::from(seconds), 10 * seconds), 1e-10);
    let names = ["turned", "height", "right", "left", "speed", "climb", "right_speed", "left_speed"];
    let truth: [(usize, [f64; 8]); 3] = [
        (
            1,
            [
                0.622_106_681_402_675_7,
                0.523_836_475_569_575_7,
                0.496_173_869_075_900_2,
                0.496_173_869_075_900_2,
                6.103_717_808_830_863,
                0.459_271_810_436_133_9,
                -0.522_673_929_753_980_2,
                -0.522_673_929_753_980_2,
            ],
        ),
        (
            10,
            [
                5.586_346_965_869_006,
                0.501_420_922_379_567_7,
                0.521_833_301_625_546_2,
                0.521_833_301_625_546_2,
                6.271_125_741_876_555,
                -0.122_151_492_897_728_9,
                0.140_885_579_479_526_7,
                0.140_885_579_479_526_7,
            ],
        ),
        (
            50,
            [
                27.942_531_991_042_956,
                0.535_563_103_721_643_4,
                0.482_874_576_586_939_8,
                0.482_874_576_586_939_8,
                6.022_496_499_758_459,
                -0.543_682_690_277_873,
                0.613_917_046_788_889_5,
                0.613_917_046_788_889_5,
            ],
        ),
    ];
    for (sample, values) in truth.into_iter().filter(|(sample, _)| *sample < run.times.len()) {
        for (name, value) in names.into_iter().zip(values) {
            let found = run.series(name)[sample];
            within(&format!("{name} at {} s", run.times[sample]), (found - value).abs(), 1e-8);
        }
    }
    within("gap", run.largest("gap"), 1e-12);
    within("energy", run.imbalance() / run.largest("stored"), 1e-8);
}

/// What a slider-crank does by hand: crank and rod lengths, torque.
struct Crank {
    crank: f64,
    rod: f64,
    torque: f64,
}

impl Crank {
    /// The rod's angle and the slider's place at a crank angle, with their derivatives by it.
    fn pose(&self, angle: f64) -> [f64; 4] {
        let (sine, cosine) = angle.sin_cos();
        // With equal lengths the rod mirrors the crank, on beyond the pose in which both stand upright.
        let (rod, turn) = if self.crank == self.rod {
            (-angle, -1.0)
        } else {
            let rod = (-self.crank * sine / self.rod).asin();
            (rod, -self.crank * cosine / (self.rod * rod.cos()))
        };
        let x = self.crank * cosine + self.rod * rod.cos();
        [rod, x, turn, -self.crank * sine - self.rod * rod.sin() * turn]
    }

    /// The crank's speed at an angle, from rest at `from`: energy, with all parts as solids.
    fn speed(&self, angle: f64, from: f64) -> f64 {
        let box_inertia = |mass: f64, a: f64, b: f64| mass / 12.0 * (a * a + b * b);
        let crank_mass = 7850.0 * self.crank * 0.03 * 0.02;
        let wheel_mass = 7850.0 * std::f64::consts::PI * 0.12 * 0.12 * 0.02;
        let rod_mass = 2700.0 * self.rod * 0.02 * 0.02;
        let slider_mass = 7850.0 * 0.06 * 0.05 * 0.04;
        let turning = box_inertia(crank_mass, self.crank, 0.03)
            + crank_mass * self.crank * self.crank / 4.0
            + wheel_mass * 0.12 * 0.12 / 2.0;
        let [rod, _, turn, slide] = self.pose(angle);
        let (sine, cosine) = angle.sin_cos();
        let middle = [
            -self.crank * sine - 0.5 * self.rod * rod.sin() * turn,
            self.crank * cosine + 0.5 * self.rod * rod.cos() * turn,
        ];
        let inertia = turning
            + rod_mass * (middle[0] * middle[0] + middle[1] * middle[1])
            + box_inertia(rod_mass, self.rod, 0.02) * turn * turn
            + slider_mass * slide * slide;
        // Crank and rod have their centres at half of the crank pin's height.
        let height = |angle: f64| 0.5 * self.crank * angle.sin() * (crank_mass + rod_mass);
        let work = self.torque * (angle - from) - 9.81 * (height(angle) - height(from));
        (2.0 * work / inertia).sqrt()
    }
}

/// Through both dead centres several times; with a rod as long as the crank also through the pose in which the slider
/// is over the crank's axis, where rod and crank could go on as one piece.
#[test]
fn the_slider_crank_turns_through_its_dead_centres() {
    for (crank, rod) in [(0.1, 0.35), (0.12, 0.3), (0.2, 0.2)] {
        let hand = Crank { crank, rod, torque: 5.0 };
        let p =
            RigidSliderCrankParameters { torque: hand.torque, crank_angle: 0.4, crank_length: crank, rod_length: rod };
        let run = record(&RigidSliderCrank::new(p).unwrap(), &instants(3.0, 300), 1e-10);
        let [angles, rods, sliders, speeds] = ["angle", "rod_angle", "slider_x", "speed"].map(|name| run.series(name));
        let mut angle = 0.4;
        let apart = |a: f64, b: f64| (a - b).sin().abs() + (1.0 - (a - b).cos());
        let mut largest = [0.0_f64; 3];
        for k in 0..angles.len() {
            angle +=
                (angles[k] - angle + std::f64::consts::PI).rem_euclid(std::f64::consts::TAU) - std::f64::consts::PI;
            let [rod_angle, x, ..] = hand.pose(angle);
            let found = [apart(rods[k], rod_angle), (sliders[k] - x).abs(), (speeds[k] - hand.speed(angle, 0.4)).abs()];
            largest = std::array::from_fn(|i| largest[i].max(found[i]));
        }
        println!("{crank} {rod}: {:.1} turns", angle / std::f64::consts::TAU);
        assert!(angle > 4.0 * std::f64::consts::TAU, "{angle}");
        within("rod", largest[0], 1e-8);
        within("slider", largest[1], 1e-9);
        if crank == rod {
            // Each passage of a singular pose leaves something: of the energy, twice the speed's part.
            let fastest = speeds.iter().fold(0.0, |most, speed| f64::max(most, speed.abs()));
            within("energy by the speed", 2.0 * largest[2] / fastest, 1e-8);
        } else {
            within("speed", largest[2], 1e-7);
        }
    }
}
