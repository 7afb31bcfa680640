//! Switching: problems whose events are known in closed form.
//!
//! In: nothing. Out: [`cases`], to be run with any integrator at any tolerance, and the error of the event times that
//! come out of it; [`balls`], whose events accumulate at a known instant. The suites `switching` and `bad_input` use
//! them.

pub mod balls;
pub mod case;
pub mod flow;
pub mod mechanisms;
pub mod oscillators;

use case::Case;

/// All cases with events at known instants.
#[must_use]
pub fn cases() -> Vec<Case> {
    vec![
        oscillators::relay(),
        mechanisms::square_wave(),
        oscillators::bilinear(),
        oscillators::thresholds(),
        mechanisms::dry_slider(),
        mechanisms::hopper(),
        oscillators::stiff_follower(),
    ]
}
