//! A run that ends at a switching instant, one rounding before it and one after it.
//!
//! In: an integrator and a tolerance. Out: for each of the first switchings and each of the three ends, how far the end
//! is from the same instant of a longer run, and how many switchings were told.

use bg_model::failure::Cause;
use bg_model::integrator::Integrator;
use bg_model::simulation::Samples;

use super::machine::{Scale, planar};
use super::request;
use crate::hardcases::case::larger;
use crate::hardcases::problem::Request;

/// A run that ended near a switching.
#[derive(Clone, Debug, PartialEq)]
pub struct Ending {
    /// The number of the switching, from 0.
    pub switching: usize,
    /// The end, s.
    pub end: f64,
    /// The largest difference of a pose to that of the longer run at the switching; m, and entries of orientations.
    pub difference: f64,
    /// The switchings told.
    pub events: usize,
    /// Why the run stopped before its end.
    pub failure: Option<Cause>,
}

/// Ends near the first `count` switchings of the paper's case within `length` (s).
#[must_use]
pub fn endings(by: Integrator, tolerance: f64, length: f64, count: usize) -> Vec<Ending> {
    let problem = planar(&[], Scale::Fixed(1.0));
    let follow = |end: f64, samples: Vec<f64>| {
        let instants = [end];
        let asked = Request { fixed_step: 2e-5, ..request(tolerance, &instants, 1_000_000) };
        let mut rows = Vec::new();
        let followed = problem.follow(by, &asked, Samples::At(samples), &mut |_, row| rows.push(row));
        (rows, followed)
    };
    let switchings = follow(length, vec![]).1.events;
    let mut endings = Vec::new();
    for (switching, t) in switchings.iter().take(count).enumerate() {
        let whole = follow(length, vec![*t]).0.remove(0);
        for end in [t.next_down(), *t, t.next_up()] {
            let (rows, followed) = follow(end, vec![end]);
            let difference = rows
                .first()
                .map_or(f64::NAN, |row| row.iter().zip(&whole).map(|(a, b)| (a - b).abs()).fold(0.0, larger));
            let events = followed.events.len();
            endings.push(Ending { switching, end, difference, events, failure: followed.failure });
        }
    }
    endings
}
