//! Every parameter of the paper's case at extremes: a right answer or an error that names its reason.

use std::fmt::Write;

use bond_graph_tests::hard_hacksaw::extremes::{Answer, extremes};

#[test]
fn every_parameter_gives_a_right_answer_or_a_named_error() {
    let mut text = String::new();
    for of in extremes(2e-3, 400, |_| {}) {
        println!("{of:?}");
        let answer = match &of.answer {
            Answer::Right => "right".to_owned(),
            // Times and steps in the messages are left out.
            Answer::Unchecked(why) => format!("unchecked: {}", why.split(" at t = ").next().unwrap_or(why)),
            Answer::Refused(why) => format!("refused: {}", why.split(" at t = ").next().unwrap_or(why)),
            Answer::Wrong => panic!("{of:?}"),
        };
        writeln!(text, "{:<11} {:>7e} {answer}", of.name, of.value).expect("a string");
    }
    super::snapshot("extremes", &text);
}
