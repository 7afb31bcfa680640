//! Location: shortens a step so that it ends at the first event.
//!
//! The dense output tells which guard is the first and gives a guess; then real steps of the method are tried until the
//! guard vanishes to rounding, so that the event has the accuracy of the integration and not of the interpolation.

use nalgebra::SVector;

use super::detect::{Bracket, Course};
use super::guarded::Guarded;
use super::noise::larger;
use super::zero::{Precision, zero};
use super::{Crossing, Watch, clearance};

/// The part of a guard's values around a zero up to which what is left of it there is rounding, of the states that stiff forces
/// lead to, where it stops falling. A guard of which more is left jumps there.
const REMAINDER: f64 = 1e-7;

/// A crossing that the dense output foresees.
#[derive(Clone, Copy, Debug)]
struct Foreseen {
    switch: usize,
    /// Step sizes, s, on the right side and on the wrong side.
    right: f64,
    wrong: f64,
    /// The step size at the crossing, s, and the slope of the clearance there, per s.
    guess: f64,
    slope: f64,
    precision: Precision,
}

impl<const G: usize> Watch<G> {
    /// Shortens the step to the first of the crossings in `courses`, if there is one; the rate at its end is known then.
    pub(super) fn first_crossing<const N: usize>(
        &mut self,
        step: &mut impl Guarded<N, G>,
        courses: &[Course; G],
    ) -> Option<Crossing<G>> {
        let switches = courses.map(|course| matches!(course, Course::WrongFromStart));
        if switches.contains(&true) {
            return Some(Crossing { switches, is_at_start: true });
        }
        let crossing = |(k, course): (usize, &Course)| match course {
            Course::Crosses(bracket) => Some(self.foresee(step, k, *bracket)),
            Course::Clear | Course::WrongFromStart => None,
        };
        let first = courses.iter().enumerate().filter_map(crossing).min_by(|a, b| a.guess.total_cmp(&b.guess))?;
        let latest = step.end().t;
        let (first, value) = self.shorten(step, first);
        step.close(latest);
        Some(Crossing { switches: self.concerned(step, courses, first, &value), is_at_start: false })
    }

    /// Where guard `k` crosses in its bracket by the dense output.
    fn foresee<const N: usize>(&self, step: &mut impl Guarded<N, G>, k: usize, bracket: Bracket) -> Foreseen {
        // Of the step: enough for the slope, which only speeds up what follows.
        const ASIDE: f64 = 1e-4;
        let (t, h) = (step.end().t, step.size());
        let Bracket { right, wrong } = bracket;
        let chord = (wrong.1 - right.1) / (wrong.0 - right.0);
        let guess = right.0 - right.1 / chord;
        let mut at = |part: f64| clearance(step.dense_guards(part)[k], step.negative()[k]);
        let size = larger(right.1.abs(), wrong.1.abs());
        let coarse = precise_to(size, 0.0, t * chord / h);
        let (part, _) = zero(right.0, wrong.0, guess, chord, coarse, &mut at);
        let slope = (at(part + ASIDE) - at(part - ASIDE)) / (2.0 * ASIDE * h);
        let precision = precise_to(size, self.noise_inside(step, k, part), t * slope);
        Foreseen { switch: k, right: right.0 * h, wrong: wrong.0 * h, guess: part * h, slope, precision }
    }

    /// Shortens the step until the guard of `foreseen` vanishes, or one that turns out to cross before it; gives the
    /// switch and the guards at the end.
    fn shorten<const N: usize>(&self, step: &mut impl Guarded<N, G>, foreseen: Foreseen) -> (usize, SVector<f64, G>) {
        let Foreseen { mut switch, mut right, mut wrong, mut guess, mut slope, mut precision } = foreseen;
        for _ in 0..G {
            let (h, _) = zero(right, wrong, guess, slope, precision, |h| {
                clearance(guards_after(step, h)[switch], step.negative()[switch])
            });
            let value = guards_after(step, h);
            let noise = self.noise_after(step, &value);
            let is_earlier = |k: &usize| *k != switch && clearance(value[*k], step.negative()[*k]) < -noise[*k];
            let Some(earlier) = (0..G).find(is_earlier) else { return (switch, value) };
            let behind = clearance(value[earlier], step.negative()[earlier]);
            slope = -(self.start.slope[earlier].abs().max(f64::MIN_POSITIVE));
            (switch, right, wrong, guess) = (earlier, 0.0, h, h - behind / slope);
            let size = larger(self.start.value[earlier].abs(), behind.abs());
            precision = precise_to(size, noise[earlier], step.end().t * slope);
        }
        (switch, guards_after(step, step.size()))
    }

    /// The rounding errors of the guards at the end of the step just tried, where they have this `value`.
    fn noise_after<const N: usize>(&self, step: &mut impl Guarded<N, G>, value: &SVector<f64, G>) -> [f64; G] {
        let end = *step.end();
        self.noise(step, end.t, &end.x, value)
    }

    /// All switches whose guards are at zero where the step ends now; takes note of the remainders.
    fn concerned<const N: usize>(
        &mut self,
        step: &mut impl Guarded<N, G>,
        courses: &[Course; G],
        first: usize,
        value: &SVector<f64, G>,
    ) -> [bool; G] {
        let noise = self.noise_after(step, value);
        core::array::from_fn(|k| {
            let is_on_course = matches!(courses[k], Course::Crosses(_));
            let is_wrong = clearance(value[k], step.negative()[k]) < -noise[k];
            let is_concerned = k == first || is_wrong || (is_on_course && value[k].abs() <= noise[k]);
            let size = larger(self.start.value[k].abs(), self.end.value[k].abs());
            if is_concerned && value[k].abs() <= larger(REMAINDER * size, noise[k]) {
                self.leave(k, value[k]);
            }
            is_concerned
        })
    }
}

/// How exactly the zero of a guard is looked for that has values of this size near it, this noise, and in the time that the
/// run has lasted would change by `drift` at the slope that it has there: an instant is not known better than the time is.
fn precise_to(size: f64, noise: f64, drift: f64) -> Precision {
    let drift = f64::EPSILON * drift.abs();
    Precision {
        zero: larger(larger(f64::EPSILON * size, noise / 16.0), drift / 16.0),
        rounding: larger(larger(REMAINDER * size, noise), 4.0 * drift),
    }
}

/// The guards at the projected end of a step of size `h` (s).
fn guards_after<const N: usize, const G: usize>(step: &mut impl Guarded<N, G>, h: f64) -> SVector<f64, G> {
    // The last attempt may be this one.
    if step.size() != h {
        step.resize(h);
    }
    let end = *step.end();
    step.guards(end.t, &end.x)
}
