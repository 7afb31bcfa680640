//! Models of text, interpreted, beside the same models compiled by rustc: tables, functions and runs are equal to the
//! bit.

mod studies;
mod texts;

use std::rc::Rc;
use std::sync::Arc;

use bg_loaded::{Blueprint, Graph, Interpreted, load};
use bg_model::dynamics::{Machine, branches};
use bg_model::input::Input;
use bg_model::integrator::Integrator;
use bg_model::mechanism::{Mechanism, MechanismVisitor, Scenes};
use bg_model::nalgebra::Complex;
use bg_model::parameters::Parameters;
use bg_model::run::{Request, RunError, Simulation, Trajectory};
use bg_model::simulation::Samples;
use bond_graph_tests::each_example;

/// A model of a text with the values and inputs of `of`.
fn interpreted(blueprint: &Arc<Blueprint>, values: &[f64], inputs: &[Input]) -> Rc<dyn Machine> {
    Rc::new(Interpreted::<f64>::new(blueprint, values, inputs).expect("the compiled model takes the same values"))
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
        let loaded = interpreted(blueprint, &parameters.values(), &inputs);
        let compiled = Me::make(parameters, &inputs).expect("defaults are possible").machine();
        same_functions(&*compiled, &*loaded);
        for method in [Integrator::default(), "radau9".parse().expect("a method"), "nystrom".parse().expect("a method")]
        {
            same_runs(&compiled, &loaded, method);
        }
    }
}

/// The bits of numbers, of zeros without their signs: where rustc's code takes two operations at once, a sum may begin
/// with the other sign.
fn bits(of: &[f64]) -> Vec<u64> {
    // What is no number has many forms.
    of.iter().map(|value| if value.is_nan() { u64::MAX } else { (value + 0.0).to_bits() }).collect()
}

fn filled(length: usize, fill: impl FnOnce(&mut [f64])) -> Vec<u64> {
    let mut values = vec![0.0; length];
    fill(&mut values);
    bits(&values)
}

/// The functions at the start and at places near it.
fn same_functions(compiled: &dyn Machine, loaded: &dyn Machine) {
    let name = compiled.description().name;
    assert_eq!([compiled.states(), compiled.switches()], [loaded.states(), loaded.switches()], "{name}");
    assert_eq!(bits(&compiled.decided()), bits(&loaded.decided()), "{name}");
    assert_eq!(compiled.redundant(), loaded.redundant(), "{name}");
    let (start, other) = (compiled.start(), loaded.start());
    assert_eq!(start.is_ok(), other.is_ok(), "{name}: {start:?} {other:?}");
    let (Ok(start), Ok(other)) = (start, other) else { return };
    assert_eq!(bits(&start), bits(&other), "{name}");
    let energies = [compiled, loaded].map(|of| of.impulse_energy().map(f64::to_bits));
    assert_eq!(energies[0], energies[1], "{name}");
    let mut random = fastrand::Rng::with_seed(7);
    for round in 0..16 {
        let x: Vec<f64> = start.iter().map(|x| x + f64::from(round) * 1e-3 * (random.f64() - 0.5)).collect();
        same_at(compiled, loaded, 0.1 * f64::from(round), &x);
    }
}

/// Everything that a run asks for, at one moment.
fn same_at(compiled: &dyn Machine, loaded: &dyn Machine, t: f64, x: &[f64]) {
    let name = compiled.description().name;
    let negative = branches(compiled, t, x);
    assert_eq!(negative, branches(loaded, t, x), "{name}");
    let (n, g) = (compiled.states(), compiled.switches());
    let both = |what: &str, of: &dyn Fn(&dyn Machine) -> Vec<u64>| {
        assert_eq!(of(compiled), of(loaded), "{name}: {what} at {t} s");
    };
    both("rate", &|of| filled(n, |dx| of.rate(t, x, &negative, dx)));
    both("guards", &|of| filled(g, |guards| of.guards(t, x, &negative, guards)));
    both("project", &|of| {
        let mut x = x.to_vec();
        of.project(t, &negative, &mut x);
        bits(&x)
    });
    both("outputs", &|of| filled(of.description().outputs.len(), |y| of.outputs(t, x, &negative, y)));
    both("energies", &|of| {
        let powers = of.powers(t, x, &negative);
        bits(&[of.stored_energy(t, x, &negative), powers.supplied, powers.dissipated])
    });
    both("sizes", &|of| {
        let mut curvatures = vec![0.0; n];
        let energy = of.energy(t, x, &negative, &mut curvatures);
        bits(&[&[energy], &curvatures[..]].concat())
    });
    both("shown", &|of| {
        let mut shown = Vec::new();
        of.shown(t, x, &negative, &mut shown);
        bits(&shown)
    });
    assert_eq!(compiled.sparsity(), loaded.sparsity(), "{name}");
    assert_eq!(compiled.damping_sparsity(), loaded.damping_sparsity(), "{name}");
    let entries = compiled.sparsity().len(n);
    both("jacobian", &|of| {
        let mut slope = vec![0.0; n];
        let mut all = filled(entries, |entries| of.jacobian(t, x, &negative, entries, &mut slope));
        all.extend(bits(&slope));
        all
    });
    both("damping", &|of| filled(of.damping_sparsity().len(n), |entries| of.damping(t, x, &negative, entries)));
    both("elimination", &|of| eliminated(of, t, x, &negative));
    assert_eq!(compiled.second(), loaded.second(), "{name}");
    both("forces", &|of| filled(n, |dx| of.forces(t, x, &negative, dx)));
    assert_eq!(compiled.operations_of_forces(), loaded.operations_of_forces(), "{name}");
    assert_eq!(compiled.held(), loaded.held(), "{name}");
    assert_eq!(bits(compiled.kept()), bits(loaded.kept()), "{name}");
    let held = compiled.held().map_or(0, |held| held.entries());
    both("hold", &|of| filled(held, |entries| of.hold(t, x, &negative, entries)));
    assert_eq!(compiled.stops(), loaded.stops(), "{name}");
    let stops = compiled.stops().map_or(0, |stops| stops.entries());
    both("impact", &|of| filled(stops, |entries| of.impact(t, x, &negative, entries)));
    assert_eq!(compiled.next_break(t).to_bits(), loaded.next_break(t).to_bits(), "{name}");
    assert_eq!(compiled.not_finite(t, x, &negative), loaded.not_finite(t, x, &negative), "{name}");
}

/// One right side solved for, by a real and by a complex number.
fn eliminated(of: &dyn Machine, t: f64, x: &[f64], negative: &[bool]) -> Vec<u64> {
    let Some(count) = of.factors() else { return Vec::new() };
    let n = of.states();
    let mut entries = vec![0.0; of.sparsity().len(n)];
    of.jacobian(t, x, negative, &mut entries, &mut vec![0.0; n]);
    let mut factors = vec![0.0; count];
    let is_regular = of.eliminate(1e-4, &entries, &mut factors);
    let mut b: Vec<f64> = (0..n).map(|k| 1.0 + k as f64).collect();
    of.substitute(&factors, &mut b);
    let mut complex = vec![Complex::new(0.0, 0.0); count];
    of.eliminate_complex(Complex::new(1e-4, 2e-4), &entries, &mut complex);
    let mut c: Vec<Complex<f64>> = (0..n).map(|k| Complex::new(1.0, k as f64)).collect();
    of.substitute_complex(&complex, &mut c);
    let parts = c.iter().flat_map(|c| [c.re, c.im]);
    bits(&factors.into_iter().chain(b).chain(parts).chain([f64::from(u8::from(is_regular))]).collect::<Vec<_>>())
}

/// A run of both, as far as it comes.
fn same_runs(compiled: &Rc<dyn Machine>, loaded: &Rc<dyn Machine>, method: Integrator) {
    let request =
        || Request { method, t_end: 0.05, samples: Samples::Every(0.01), step_limit: 400, ..Request::default() };
    let run = |of: &Rc<dyn Machine>| match Simulation::over(Rc::clone(of), request()).run() {
        Ok(run) => told(&run),
        Err(RunError::Stopped(stopped)) => format!("{}\n{}", stopped.cause, told(&stopped.trajectory)),
        Err(fault) => fault.to_string(),
    };
    assert_eq!(run(compiled), run(loaded), "{}: {}", compiled.description().name, method.name());
}

/// Every number of a run.
fn told(run: &Trajectory) -> String {
    let text = format!("{:?}\n{:?}\n{:?}\n{:?}", run.recording, run.statistics, run.last, run.methods);
    ["-0.0,", "-0.0]", "-0.0)"].iter().fold(text, |text, zero| text.replace(zero, &zero[1..]))
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
    all_models::<hacksaw::mechanism::Hacksaw>("mechanism.rs");
}
