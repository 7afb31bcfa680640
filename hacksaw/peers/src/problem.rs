//! The problem that every solver gets: 5 s of the paper's hacksaw in the plane, as body poses and velocities.
//!
//! In: the paper's parameters. Out: the start, the rate, the blade's slip velocity whose sign chooses the branch of the
//! cutting law, the instants of the samples, and the model's constants for solvers outside of Rust.
//!
//! The rate is the plain one of `hacksaw/planar`, which `cargo bench -p hacksaw` compares with the
//! generated scene.

use std::cell::Cell;

use hacksaw::mechanism::{Paper, PaperParameters};
use serde_json::json;

use bg_model::nalgebra::SVector;
use bg_model::system::Model;

use hacksaw_planar::{CRANK, O5, Planar, ROD, State, WORK};

/// The end of the run, s.
pub const T_END: f64 = 5.0;
/// The interval of the samples, s.
pub const INTERVAL: f64 = 0.01;
/// The samples: at 0, 0.01, .. 5 s.
pub const SAMPLES: usize = 501;

/// The absolute tolerance of every solver over its relative one: poses are of the order of 0.1 m and 1 rad, velocities
/// of 1 m/s and 30 rad/s.
pub const ABSOLUTE: f64 = 1e-2;

/// An instant that is a hundred times shorter than the shortest step of any solver here, s.
const MOMENT: f64 = 1e-7;

/// The instants of the samples, s.
pub fn instants() -> Vec<f64> {
    (0..SAMPLES).map(instant).collect()
}

/// The instant of sample `k`, s: the floating-point number next to k/100.
pub fn instant(k: usize) -> f64 {
    k as f64 / 100.0
}

/// The hand-written model with its start.
pub struct Problem {
    /// The model.
    pub planar: Planar,
    /// The state at t = 0.
    pub start: State,
}

impl Problem {
    /// The paper's case.
    pub fn paper() -> Self {
        let model = Paper::new(PaperParameters::default()).expect("defaults are in their ranges");
        let start: SVector<f64, { Paper::STATES }> = model.start().expect("the paper's mechanism closes");
        let names = model.description().states;
        let planar = Planar::new(model.parameters());
        let start = planar.state(|name| {
            let index = names.iter().position(|state| state.name == name);
            start[index.expect("a state of the paper's scene")]
        });
        Self { planar, start }
    }

    /// The rate of `s`, the branch chosen by the slip velocity there. For solvers that locate no events.
    #[inline(always)]
    pub fn rate(&self, s: &State) -> State {
        self.planar.rate_where(s, |slip| slip < 0.0)
    }

    /// Whether the blade is cutting from `s` on: the sign of the slip velocity a moment later. The law is continuous
    /// where that is zero, so either branch gives the same rate there.
    pub fn cuts_after(&self, s: &State) -> bool {
        let rate = self.planar.rate(s, true);
        slip(&std::array::from_fn(|i| s[i] + MOMENT * rate[i])) < 0.0
    }

    /// The model's constants by name, SI units.
    pub fn constants(&self) -> serde_json::Value {
        let p = &self.planar;
        let pin = |pin: hacksaw_planar::Pin| json!([pin.k, pin.r]);
        json!({
            "torque": p.torque, "gravity": p.gravity, "masses": p.masses, "inertias": p.inertias,
            "pin_o": pin(p.pin_o), "pin_a": pin(p.pin_a), "pin_b": pin(p.pin_b), "pin_c": pin(p.pin_c),
            "slot": pin(p.slot), "twist": pin(p.twist), "work": pin(p.work),
            "r_cut": p.r_cut, "r_return": p.r_return,
            "b4": p.b4, "bar": p.bar, "blade": p.blade, "block": p.block, "pivot": p.pivot,
            "crank": CRANK, "rod": ROD, "o5": O5, "work_point": WORK,
        })
    }
}

/// The velocity of the blade at the work point along the frame, m/s; negative while cutting.
#[inline(always)]
pub fn slip(s: &State) -> f64 {
    let (sine, cosine) = s[8].sin_cos();
    let (ex, ey) = (WORK[0] - s[6], WORK[1] - s[7]);
    cosine * (s[18] - s[20] * ey) + sine * (s[19] + s[20] * ex)
}

/// The branch of a solver that locates events and starts again from each: the law's branch between two events, and the
/// guard whose zeros they are.
pub struct Branch<'a> {
    problem: &'a Problem,
    cutting: Cell<bool>,
    since: Cell<f64>,
}

impl<'a> Branch<'a> {
    /// The branch from the start on.
    pub fn new(problem: &'a Problem) -> Self {
        Self { problem, cutting: Cell::new(problem.cuts_after(&problem.start)), since: Cell::new(0.0) }
    }

    /// The rate in this branch.
    #[inline(always)]
    pub fn rate(&self, s: &State) -> State {
        self.problem.planar.rate(s, self.cutting.get())
    }

    /// The slip velocity; at the beginning of the branch only its sign a moment later, so that the event which began
    /// the branch is not found once more. That is +-1: beside a tiny number a secant would take the beginning for a
    /// zero.
    #[inline(always)]
    pub fn guard(&self, t: f64, s: &State) -> f64 {
        if t > self.since.get() + MOMENT {
            slip(s)
        } else if self.cutting.get() {
            -1.0
        } else {
            1.0
        }
    }

    /// Begins the branch that follows an event at `t` (s) and `s`.
    pub fn switch(&self, t: f64, s: &State) {
        self.cutting.set(self.problem.cuts_after(s));
        self.since.set(t);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_slip_is_the_one_that_the_rate_sees() {
        let problem = Problem::paper();
        let mut s = problem.start;
        for (index, value) in s.iter_mut().enumerate() {
            *value += 0.1 * (index as f64).sin();
        }
        let seen = Cell::new(f64::NAN);
        problem.planar.rate_where(&s, |slip| {
            seen.set(slip);
            true
        });
        assert!((seen.get() - slip(&s)).abs() < 1e-15, "{} and {}", seen.get(), slip(&s));
    }

    #[test]
    fn the_first_stroke_cuts() {
        let problem = Problem::paper();
        assert_eq!(slip(&problem.start), 0.0);
        assert!(problem.cuts_after(&problem.start));
    }
}
