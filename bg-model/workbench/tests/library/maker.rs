//! Models that no macro compiled: a program has of them what they give, and says what they do not.

use std::process::ExitCode;
use std::rc::Rc;

use bg_model::bond_graph;
use bg_model::description::Description;
use bg_model::dynamics;
use bg_model::input::Input;
use bg_model::mechanism::Mechanism;
use bg_model::parameters::{ParameterError, Parameters};
use bg_model::sensitivity::Objective;
use bg_workbench::calls::{self, Asked};
use bg_workbench::machine::Machine;
use bg_workbench::maker::Maker;
use bg_workbench::{Compiled, Program, live};

bond_graph! {
    /// A mass on a spring that a force pushes.
    pub graph Slide {
        param mass: kg = 2, above 0; param k: N/m = 50; param start: m = 0.1;
        input force: N;
        1 slide: translation; I body = mass; C spring = k start start; Se push = force;
        push -> slide -> body; slide -> spring;
        observe { x: m = spring.q; v: m/s = slide.flow }
        /// The place only.
        scene Place { observe { x: m = spring.q } tune { mass } }
    }
}

/// What only knows how its models run.
struct Bare;

struct BareMachine(Rc<dyn dynamics::Machine>);

impl Machine for BareMachine {
    fn model(&self) -> Rc<dyn dynamics::Machine> {
        Rc::clone(&self.0)
    }
}

impl Maker for Bare {
    fn models(&self) -> Vec<&'static Description> {
        vec![Slide::<f64>::describe(), Place::<f64>::describe()]
    }

    fn is_literal(&self) -> bool {
        true
    }

    fn make(&self, model: usize, own: &[f64], inputs: &[Input]) -> Result<Box<dyn Machine>, ParameterError> {
        let over_slices = match model {
            0 => Slide::<f64>::make(SlideParameters::of_values(own), inputs)?.machine(),
            _ => Place::<f64>::make(PlaceParameters::of_values(own), inputs)?.machine(),
        };
        Ok(Box::new(BareMachine(over_slices)))
    }
}

fn asked(scene: &str) -> Asked {
    let set = [("mass".to_owned(), 3.0)].into_iter().collect();
    Asked { scene: Some(scene.to_owned()), set, inputs: vec!["force=2".to_owned()], ..Asked::default() }
}

#[test]
fn runs_and_tables_are_those_of_the_compiled_mechanism() {
    let (bare, compiled) = (Program::with(Bare), Program::of::<Slide>());
    assert_eq!(calls::scenes(&bare), calls::scenes(&compiled));
    assert_eq!(calls::parameters(&bare, Some("place")), calls::parameters(&compiled, Some("place")));
    for scene in ["literal", "place"] {
        let [ours, theirs] =
            [&bare, &compiled].map(|program| calls::run(program, &asked(scene), &|_| true).unwrap().run);
        assert_eq!((ours.recording, ours.last), (theirs.recording, theirs.last), "{scene}");
    }
    let order = r#"{ "scene": "literal", "parameters": { "mass": 3.0 }, "inputs": [], "begin": "model", "integration":
        { "t_end": 1.0, "step": 0.1, "method": "auto", "rtol": 1e-8, "atol": null, "fixed_step": 1e-4 } }"#;
    assert_eq!(live::answer(&bare, order), live::answer(&compiled, order));
    let range =
        calls::run(&bare, &Asked { set: [("mass".to_owned(), -1.0)].into_iter().collect(), ..asked("place") }, &|_| {
            true
        });
    assert!(range.unwrap_err().to_string().contains("parameter `mass` = -1 kg is out of range"));
    let fixed =
        calls::run(&bare, &Asked { set: [("k".to_owned(), 1.0)].into_iter().collect(), ..asked("place") }, &|_| true);
    assert_eq!(fixed.unwrap_err().to_string(), "scene `place` keeps `k` fixed at 50 N/m; use --scene literal");
}

#[test]
fn what_a_model_has_not_got_is_told_in_a_sentence() {
    let bare = Program::with(Bare);
    let told =
        |what: &str| format!("`Slide` was made without {what}; a program that is compiled with `bond_graph!` has them");
    let fault = calls::linearize(&bare, &asked("literal"), Some(1.0)).map(drop).unwrap_err();
    assert_eq!(fault.to_string(), told("linear models"));
    let fault = calls::linearize(&bare, &asked("literal"), None).map(drop).unwrap_err();
    assert_eq!(fault.to_string(), told("equilibria"));
    let fault = calls::sensitivity(&bare, &asked("literal"), &[], &[]).map(drop).unwrap_err();
    assert_eq!(fault.to_string(), told("derivatives by parameters"));
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out").display().to_string();
    for command in ["sensitivity --of x", "precision --rtol 1e-6"] {
        let words = ["slide"].into_iter().chain(command.split(' ')).chain(["--out", &out]).map(Into::into);
        assert_eq!(Program::with(Bare).main(words.collect::<Vec<_>>()), ExitCode::from(2), "{command}");
    }
}

#[test]
fn a_compiled_model_has_all_that_is_asked() {
    let made = Compiled::<Slide>::new().make(1, &[2.0], &[]).unwrap();
    let accuracy = bg_model::extended::Accuracy { columns: 4, tolerance: 1e-12 };
    let request = bg_model::run::Request { t_end: 0.1, ..Default::default() };
    assert!(made.solution(accuracy, &[0.0, 0.1]).is_some_and(|solution| solution.is_ok()));
    assert_eq!(made.in_lanes(&request, &[vec![2.0], vec![3.0]]).map(|runs| runs.len()), Some(2));
    assert!(made.gradient(&request, &Objective::last(0), &[]).is_some_and(|gradient| gradient.is_ok()));
}
