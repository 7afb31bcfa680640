//! Models of text, interpreted and in machine code, beside the same models compiled by rustc: tables, functions and
//! runs are equal to the bit.

mod criteria;
mod functions;
mod random;
mod studies;
mod texts;

use std::rc::Rc;
use std::sync::Arc;

use bg_loaded::{BackEnd, Blueprint, Counted, Graph, Interpreted, Wanted, load, load_wanted};
use bg_model::dynamics::{Machine, branches};
use bg_model::input::Input;
use bg_model::mechanism::{Differentiable, Mechanism, MechanismVisitor, Scenes};
use bg_model::parameters::{ParameterError, Parameters};
use bg_model::scalar::{Gradient, Scalar};
use bond_graph_tests::each_example;
use functions::{Compared, same_functions, same_runs};

/// The interpreter, and machine code of each program from its first evaluation on.
const BACK_ENDS: [BackEnd; 2] = [BackEnd::Interpreter, BackEnd::MachineCode { after: 0 }];

/// A model of a text with these values and inputs.
fn loaded(
    blueprint: &Arc<Blueprint>,
    values: &[f64],
    inputs: &[Input],
    back_end: BackEnd,
) -> Result<Rc<dyn Machine>, ParameterError> {
    Ok(Rc::new(Interpreted::<f64>::new(blueprint, values, inputs)?.by(back_end)))
}

/// Every model of a mechanism beside that of its text.
fn all_models<Me: Scenes>(call: &str) {
    let graphs = load(&texts::of(call, Me::describe().name)).unwrap_or_else(|faults| panic!("{}", faults[0]));
    let graph = graphs.iter().find(|graph| graph.name == Me::describe().name);
    let graph = graph.expect("the text has the graph");
    assert_eq!((graph.models.len(), graph.is_literal), (Me::MODELS, Me::LITERAL));
    (0..Me::MODELS).for_each(|index| Me::model(index, Beside { graph, index }));
}

struct Beside<'a> {
    graph: &'a Graph,
    index: usize,
}

impl MechanismVisitor for Beside<'_> {
    type Output = ();

    fn visit<Me: Mechanism + 'static>(self) {
        let parameters = Me::Parameters::default();
        let inputs: Vec<Input> = (1..=Me::describe().inputs.len()).map(|k| Input::constant(0.7 * k as f64)).collect();
        let blueprint = self.graph.models[self.index].blueprint.as_ref().expect("all scenes were asked for");
        assert_eq!(*blueprint.description(), *Me::describe());
        let values = parameters.values();
        let model = Me::make(parameters, &inputs).expect("defaults are possible");
        let compiled = Differentiable::machine(&model);
        same_values(&*compiled, &*model.sloped(&inputs).expect("the same values are possible"));
        for back_end in BACK_ENDS {
            let loaded = loaded(blueprint, &values, &inputs, back_end).expect("the compiled model takes these values");
            same_functions(&*compiled, &*loaded, Compared::WithoutSignsOfZeros);
            for method in ["auto", "taylor", "dop853", "radau9", "nystrom"] {
                same_runs(&compiled, &loaded, method.parse().expect("a method"), Compared::WithoutSignsOfZeros);
            }
        }
        let has_back_end = cfg!(any(target_arch = "x86_64", target_arch = "aarch64"));
        assert_eq!(blueprint.translate() > 0, has_back_end, "{}", blueprint.description().name);
    }
}

/// Numbers with slopes, for which long functions are tables, have the values of doubles, for which they are straight
/// code.
fn same_values(compiled: &dyn Machine, sloped: &dyn Machine<Gradient>) {
    let Ok(start) = compiled.start() else { return };
    let name = compiled.description().name;
    let compared = Compared::WithoutSignsOfZeros;
    let (n, g) = (compiled.states(), compiled.switches());
    let mut random = fastrand::Rng::with_seed(11);
    for round in 0..4 {
        let t = 0.1 * f64::from(round);
        let x: Vec<f64> = start.iter().map(|x| x + f64::from(round) * 1e-3 * (random.f64() - 0.5)).collect();
        let negative = branches(compiled, t, &x);
        let lifted = |of: &[f64]| of.iter().copied().map(Gradient::from_f64).collect::<Vec<_>>();
        let (time, states) = (Gradient::from_f64(t), lifted(&x));
        let same = |what: &str, double: &[f64], with_slopes: &[Gradient]| {
            let values: Vec<f64> = with_slopes.iter().map(|number| number.to_f64()).collect();
            assert_eq!(compared.bits(double), compared.bits(&values), "{name}: {what} at {t} s");
        };
        let (mut double, mut with_slopes) = (vec![0.0; n], lifted(&vec![0.0; n]));
        compiled.rate(t, &x, &negative, &mut double);
        sloped.rate(time, &states, &negative, &mut with_slopes);
        same("rate", &double, &with_slopes);
        let (mut double, mut with_slopes) = (vec![0.0; g], lifted(&vec![0.0; g]));
        compiled.guards(t, &x, &negative, &mut double);
        sloped.guards(time, &states, &negative, &mut with_slopes);
        same("guards", &double, &with_slopes);
        let (mut double, mut with_slopes) = (x.clone(), states.clone());
        compiled.project(t, &negative, &mut double);
        sloped.project(time, &negative, &mut with_slopes);
        same("project", &double, &with_slopes);
        let outputs = compiled.description().outputs.len();
        let (mut double, mut with_slopes) = (vec![0.0; outputs], lifted(&vec![0.0; outputs]));
        compiled.outputs(t, &x, &negative, &mut double);
        sloped.outputs(time, &states, &negative, &mut with_slopes);
        same("outputs", &double, &with_slopes);
        let (mut double, mut with_slopes) = (vec![0.0; n], lifted(&vec![0.0; n]));
        let energy = compiled.energy(t, &x, &negative, &mut double);
        same("energy", &[energy], &[sloped.energy(time, &states, &negative, &mut with_slopes)]);
        same("sizes", &double, &with_slopes);
        let (powers, with_slopes) = (compiled.powers(t, &x, &negative), sloped.powers(time, &states, &negative));
        let double = [compiled.stored_energy(t, &x, &negative), powers.supplied, powers.dissipated];
        let stored = sloped.stored_energy(time, &states, &negative);
        same("energies", &double, &[stored, with_slopes.supplied, with_slopes.dissipated]);
        for (what, count) in [
            ("hold", compiled.held().map(|held| held.entries())),
            ("impact", compiled.stops().map(|stops| stops.entries())),
        ] {
            let Some(count) = count else { continue };
            let (mut double, mut with_slopes) = (vec![0.0; count], lifted(&vec![0.0; count]));
            if what == "hold" {
                compiled.hold(t, &x, &negative, &mut double);
                sloped.hold(time, &states, &negative, &mut with_slopes);
            } else {
                compiled.impact(t, &x, &negative, &mut double);
                sloped.impact(time, &states, &negative, &mut with_slopes);
            }
            same(what, &double, &with_slopes);
        }
    }
}

macro_rules! examples {
    // These are made by a macro of their own: there is no text of theirs.
    (@ joints $name:ident $type:ident) => {};
    (@ $module:ident $name:ident $type:ident) => {
        #[test]
        fn $name() {
            all_models::<bond_graph_tests::models::$module::$type>(concat!(stringify!($module), ".rs"));
        }
    };
    ($($name:ident: $module:ident $type:ident ($($rest:tt)*);)*) => {
        $(examples!(@ $module $name $type);)*
    };
}
each_example!(examples);

#[test]
fn hacksaw() {
    all_models::<hacksaw::mechanism::Hacksaw>("hacksaw.bond");
}

#[test]
fn of_a_graph_whose_scene_is_wanted_alone_parameters_and_names_are_known() {
    let text = texts::of("hacksaw.bond", "Hacksaw");
    let loaded = |wanted: &str| {
        let graphs = load_wanted(&text, Wanted { scene: &|name| name == wanted, counted: Counted::Made, most: None });
        graphs.unwrap_or_else(|faults| panic!("{}", faults[0])).remove(0)
    };
    let compiled = |graph: &Graph| -> Vec<&str> {
        let models = graph.models.iter().filter(|model| model.blueprint.is_some());
        models.map(|model| model.description.name).collect()
    };
    let graph = loaded("Motion");
    assert_eq!(compiled(&graph), ["Motion"]);
    let literal = graph.models[0].description;
    let whole = hacksaw::mechanism::Hacksaw::<f64>::describe();
    assert_eq!((literal.name, literal.parameters, literal.inputs), (whole.name, whole.parameters, whole.inputs));
    assert_eq!(graph.models.len(), <hacksaw::mechanism::Hacksaw as Scenes>::MODELS);
    assert_eq!(compiled(&loaded("Nothing")), ["Hacksaw"]);
}
