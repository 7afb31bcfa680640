//! Bad input: what every integrator says to input that cannot be, and to rates and guards that break.
//!
//! Each trial holds: a typed error or a right result, no panic, no more attempted steps than the limit; the last good
//! state is finite if the start was, inside the span, and where the trial says. `bad_input/messages.snap` has all
//! messages together.

mod models;
mod rates;
mod requests;
mod support;

use std::fmt::Write;

#[test]
fn all_messages() {
    let mut text = String::new();
    for trial in requests::trials().into_iter().chain(rates::trials()) {
        writeln!(text, "{}", trial.name).expect("a string");
        for (message, names) in trial.messages() {
            writeln!(text, "    [{}] {message}", names.join(" ")).expect("a string");
        }
    }
    for (name, message) in models::messages() {
        writeln!(text, "{name}\n    {message}").expect("a string");
    }
    let mut settings = insta::Settings::clone_current();
    settings.set_snapshot_path(".");
    settings.set_prepend_module_to_snapshot(false);
    settings.set_omit_expression(true);
    settings.bind(|| insta::assert_snapshot!("messages", text));
}
