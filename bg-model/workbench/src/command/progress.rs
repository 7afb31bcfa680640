//! Bars on a terminal, nothing in a pipe.

use std::io::{IsTerminal, stderr};

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::files::console;

/// A bar over simulated time until `t_end`, s.
pub fn over_time(t_end: f64) -> ProgressBar {
    let bar = bar(ticks(t_end).max(1), "simulating {bar:40} {percent:>3} % of {msg}, {eta} to go");
    bar.set_message(format!("{t_end} s"));
    bar
}

/// A thousand ticks a second of simulated time.
pub fn ticks(t: f64) -> u64 {
    (t * 1e3) as u64
}

/// A bar of this template.
pub fn bar(length: u64, template: &str) -> ProgressBar {
    // Ten times a second is steady to the eye and costs nothing.
    let is_shown = stderr().is_terminal() && !console::is_quiet();
    let target = if is_shown { ProgressDrawTarget::stderr_with_hz(10) } else { ProgressDrawTarget::hidden() };
    let bar = ProgressBar::with_draw_target(Some(length), target);
    let style = ProgressStyle::with_template(template);
    bar.set_style(style.expect("the template is well formed").progress_chars("\u{2501}\u{2578}\u{2500}"));
    bar
}
