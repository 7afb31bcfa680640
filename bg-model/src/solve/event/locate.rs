//! Location: shortens a step so that it ends at the first event.
//!
//! The dense output tells which guard is the first and gives a guess; then real steps of the method are tried until the
//! guard vanishes to rounding, so that the event has the accuracy of the integration and not of the interpolation.

use alloc::vec;
use alloc::vec::Vec;

use super::detect::{Bracket, Course};
use super::guarded::{End, Guarded};
use super::noise::larger;
use super::zero::{Precision, Search, zero};
use super::{Crossing, EventMonitor, clearance};

/// The part of a guard's values around a zero up to which what is left of it there is rounding, of the states that
/// stiff forces lead to, where it stops falling. A guard of which more is left jumps there.
const REMAINDER: f64 = 1e-7;

/// A crossing that the dense output foresees: where the guard of `switch` comes to zero after `guess` (s) of the step.
#[derive(Clone, Copy, Debug)]
struct Foreseen {
    switch: usize,
    guess: f64,
    search: Search,
}

/// A step that is being shortened to its first event: it says which size it is to be tried with, and looks at what that
/// gives.
#[derive(Clone, Debug)]
pub(crate) struct Shortening {
    courses: Vec<Course>,
    /// The end of the whole step, s.
    latest: f64,
    /// The switch whose guard is to vanish.
    switch: usize,
    /// The search for its zero; none once that is found.
    search: Option<Search>,
    /// The size to be tried, s.
    size: f64,
    /// The searches made.
    rounds: usize,
    /// The guards at the end.
    value: Vec<f64>,
}

impl Shortening {
    /// The size that the step is to be tried with, s.
    pub fn size(&self) -> f64 {
        self.size
    }

    /// Looks at the step, which has this size; gives whether it ends at the first event: where the guard that was
    /// foreseen vanishes, or one that turns out to cross before it. Else it is to be tried again, with another size
    /// unless that is the same.
    pub fn take(&mut self, monitor: &EventMonitor, step: &mut dyn Guarded) -> bool {
        step.read_end(End::End, &mut self.value);
        let (guards, t_end) = (self.value.len(), step.point(End::End).t);
        let side = |value: &[f64], step: &dyn Guarded, k: usize| clearance(value[k], step.negative()[k]);
        if let Some(search) = &mut self.search {
            self.size = match search.take(side(&self.value, step, self.switch)) {
                Some((size, _)) => {
                    self.search = None;
                    self.rounds += 1;
                    size
                }
                None => search.at(),
            };
            return false;
        }
        if self.rounds > guards {
            return true;
        }
        let noise = monitor.noise_of(step, End::End, &self.value);
        let is_earlier = |&k: &usize| k != self.switch && side(&self.value, step, k) < -noise[k];
        let Some(earlier) = (0..guards).find(is_earlier) else { return true };
        self.switch = earlier;
        if self.rounds == guards {
            self.rounds += 1;
            return false;
        }
        let (h, behind) = (step.size(), side(&self.value, step, earlier));
        let slope = -(monitor.start.slope[earlier].abs().max(f64::MIN_POSITIVE));
        let size = larger(monitor.start.value[earlier].abs(), behind.abs());
        let precision = precise_to(size, noise[earlier], t_end * slope);
        let search = Search::new(0.0, h, h - behind / slope, slope, precision);
        (self.size, self.search) = (search.at(), Some(search));
        false
    }
}

/// What is to be done about a step in which guards cross.
#[derive(Debug)]
pub(crate) enum Found {
    /// The event is at its start.
    AtStart(Crossing),
    /// It is to be shortened to the first event.
    Inside(Shortening),
}

impl EventMonitor {
    /// The first of the crossings in `courses`, if there is one.
    pub(super) fn first_crossing(&self, step: &mut dyn Guarded, courses: Vec<Course>) -> Option<Found> {
        let switches: Vec<bool> = courses.iter().map(|course| matches!(course, Course::WrongFromStart)).collect();
        if switches.contains(&true) {
            return Some(Found::AtStart(Crossing { switches, is_at_start: true }));
        }
        let crossing = |(k, course): (usize, &Course)| match course {
            Course::Crosses(bracket) => Some(self.foresee(step, k, *bracket)),
            Course::Clear | Course::WrongFromStart => None,
        };
        let crossings = courses.iter().enumerate().filter_map(crossing);
        let Foreseen { switch, search, .. } = crossings.min_by(|a, b| a.guess.total_cmp(&b.guess))?;
        let (latest, size) = (step.point(End::End).t, search.at());
        let (search, value) = (Some(search), vec![0.0; courses.len()]);
        Some(Found::Inside(Shortening { courses, latest, switch, search, size, rounds: 0, value }))
    }

    /// The event at the end of the step that was shortened to it; the rate there is known then.
    pub fn crossing(
        &mut self,
        step: &mut dyn Guarded,
        Shortening { courses, latest, switch, value, .. }: Shortening,
    ) -> Crossing {
        step.close(latest);
        Crossing { switches: self.concerned(step, &courses, switch, &value), is_at_start: false }
    }

    /// Where guard `k` crosses in its bracket by the dense output.
    fn foresee(&self, step: &mut dyn Guarded, k: usize, bracket: Bracket) -> Foreseen {
        // Of the step: enough for the slope, which only speeds up what follows.
        const ASIDE: f64 = 1e-4;
        let (t, h) = (step.point(End::End).t, step.size());
        let Bracket { right, wrong } = bracket;
        let chord = (wrong.1 - right.1) / (wrong.0 - right.0);
        let guess = right.0 - right.1 / chord;
        let mut at = |part: f64| clearance(step.dense_guards(part)[k], step.negative()[k]);
        let size = larger(right.1.abs(), wrong.1.abs());
        let coarse = precise_to(size, 0.0, t * chord / h);
        let (part, _) = zero(Search::new(right.0, wrong.0, guess, chord, coarse), &mut at);
        let slope = (at(part + ASIDE) - at(part - ASIDE)) / (2.0 * ASIDE * h);
        let precision = precise_to(size, self.noise_inside(step, k, part), t * slope);
        let search = Search::new(right.0 * h, wrong.0 * h, part * h, slope, precision);
        Foreseen { switch: k, guess: part * h, search }
    }

    /// All switches whose guards are at zero where the step ends now; takes note of the remainders.
    fn concerned(&mut self, step: &mut dyn Guarded, courses: &[Course], first: usize, value: &[f64]) -> Vec<bool> {
        let noise = self.noise_of(step, End::End, value);
        let is_concerned = |k: usize| {
            let is_on_course = matches!(courses[k], Course::Crosses(_));
            let is_wrong = clearance(value[k], step.negative()[k]) < -noise[k];
            let is_concerned = k == first || is_wrong || (is_on_course && value[k].abs() <= noise[k]);
            let size = larger(self.start.value[k].abs(), self.end.value[k].abs());
            if is_concerned && value[k].abs() <= larger(REMAINDER * size, noise[k]) {
                self.leave(k, value[k]);
            }
            is_concerned
        };
        (0..value.len()).map(is_concerned).collect()
    }
}

/// How exactly the zero of a guard is looked for that has values of this size near it, this noise, and in the time that
/// the run has lasted would change by `drift` at the slope that it has there: an instant is not known better than the
/// time is.
fn precise_to(size: f64, noise: f64, drift: f64) -> Precision {
    let drift = f64::EPSILON * drift.abs();
    Precision {
        zero: larger(larger(f64::EPSILON * size, noise / 16.0), drift / 16.0),
        rounding: larger(larger(REMAINDER * size, noise), 4.0 * drift),
    }
}
