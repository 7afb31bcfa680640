//! Emitted code equals the interpreter; power is balanced at every junction; no input makes the compiler panic.
//!
//! The expanded graph in a model's description is valid source. So each model's own text is compiled once more with the
//! library, as far as its state equations, and these are evaluated by `expr::evaluate` at random states and parameters.

use bg_compiler::expr::{Environment, Id, Symbol, derivative, evaluate, sized};
use bg_compiler::fault::Staged;
use bg_compiler::graph::causality::CausalGraph;
use bg_compiler::graph::{BondGraph, NodeId, NodeKind};
use bg_compiler::pipeline::{self, Arranged};
use bg_compiler::source::ast::TrackKind;
use bg_compiler::source::{part, scene, syntax};
use bg_compiler::system::equations::stage::Closed;
use bg_compiler::system::equations::{Kind, StateEquations};
use bg_model::bond_graph;
use bg_model::input::Input;
use bg_model::nalgebra::SVector;
use bg_model::parameters::Parameters;
use bg_model::system::Model;
use bond_graph_tests::fuzz;
use bond_graph_tests::models::long::{Rope, RopeParameters};
use hacksaw::mechanism::{Hacksaw, HacksawParameters};
use proc_macro2::TokenStream;
use rayon::iter::{IntoParallelRefIterator, ParallelIterator};
use std::collections::BTreeMap;
use std::path::Path;

bond_graph! {
    graph Motor {
        param winding: Ohm = 0.8, above 0;
        param coil: H = 2e-3, above 0;
        param constant: N*m/A = 0.05;
        param rotor: kg*m^2 = 1e-3, above 0;
        input voltage: V;
        Se supply = voltage;
        1 armature;
        I L = coil;
        R Ra = winding;
        GY motor = constant;
        1 shaft;
        I J = rotor;
        R bearing(w) = 1e-3 * w + 0.02 * tanh(w / 0.1);
        R stop(w) = if w > 0.2 { 3 * w } else if w < -0.2 { 2 * w } else { 0 };
        supply -> armature -> L;
        armature -> Ra;
        armature -> motor -> shaft -> J;
        shaft -> bearing;
        shaft -> stop;
        observe { current: A = armature.flow; speed: rad/s = shaft.flow; loss: J = integral(dissipated_power) }
    }
}

bond_graph! {
    graph Pendulum {
        param angle: rad = 0.5;
        param stiffness: N/m = 1e5, above 0;
        param damping: N*s/m = 10, at least 0;
        gravity [0, -9.81, 0];
        ground { point pivot = [0, 1, 0]; point hook = [0.3, 2, 0.4]; }
        body rod {
            cuboid [1, 0.1, 0.05];
            sphere radius 0.1 at [0.5, 0, 0.02];
            density 2700;
            point end = [-0.5, 0, 0];
            point tip = [0.5, 0, 0.1];
            start end at [0, 1, 0];
            start turned rotation_z(angle);
        }
        joint pin: revolute z (ground.pivot -> rod.end) {
            stiffness stiffness; damping damping; tilt stiffness 1e3; tilt damping 1;
        }
        spring coil (ground.hook -> rod.tip) { stiffness 40; damping 0.3; length 0.5; }
        drive motor on pin torque = if pin.speed < 0 { 2 } else { -1 };
        observe { rod.angle; pin.force; rod.orientation; coil.distance }
    }
}

/// Knuth's linear congruential generator MMIX (The Art of Computer Programming, volume 2, section 3.3.4).
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.0 >> 33
    }

    /// A number below `bound`.
    fn below(&mut self, bound: usize) -> usize {
        usize::try_from(self.next()).expect("31 bits fit") % bound.max(1)
    }

    /// A number between -1 and 1.
    fn real(&mut self) -> f64 {
        self.next() as f64 / (1_u64 << 30) as f64 - 1.0
    }
}

fn compiled(text: &str) -> (CausalGraph, Closed) {
    attempt(text).unwrap_or_else(|faults| {
        panic!(
            "{}\n{text}",
            faults.iter().map(|fault| format!("{:?} {fault}\n", fault.span.start())).collect::<String>()
        )
    })
}

fn attempt(text: &str) -> Staged<(CausalGraph, Closed)> {
    let source = part::flatten(&syntax::parse(text.parse().expect("tokens"))?)?.source;
    let Arranged { derived, equations, .. } = pipeline::arrange(&scene::variants(&source.graphs[0])?[0])?;
    Ok((derived.causal, equations.close()))
}

/// A point at which expressions are evaluated.
struct Sample {
    time: f64,
    states: Vec<f64>,
    parameters: Vec<f64>,
    inputs: Vec<f64>,
    negative: Vec<bool>,
}

impl Sample {
    /// Irregular states, orientations orthogonal, parameters near their defaults.
    fn random(graph: &BondGraph, equations: &StateEquations, random: &mut Random) -> Self {
        let mut states: Vec<f64> = equations.states.iter().map(|_| random.real()).collect();
        let mut first = 0;
        while first < states.len() {
            if equations.states[first].origin.kind() == Kind::Orientation {
                let angles = [(); 3].map(|()| 3.0 * random.real());
                let turn = bg_model::nalgebra::Rotation3::from_euler_angles(angles[0], angles[1], angles[2]);
                for k in 0..9 {
                    states[first + k] = turn[(k / 3, k % 3)];
                }
                first += 9;
            } else {
                first += 1;
            }
        }
        assert!(graph.tracks.iter().all(|track| matches!(track.kind, TrackKind::Position | TrackKind::Orientation)));
        let parameters = equations.parameters.iter().map(|p| p.default * (1.2 + 0.3 * random.real())).collect();
        let inputs = equations.inputs.iter().map(|_| 10.0 * random.real()).collect();
        let mut sample = Self { time: 1.0 + random.real(), states, parameters, inputs, negative: Vec::new() };
        sample.negative = vec![false; equations.switches.len()];
        for k in 0..equations.switches.len() {
            sample.negative[k] = random.below(2) == 0;
        }
        sample
    }

    /// What a value is added up from.
    fn size(&self, equations: &StateEquations, root: Id) -> f64 {
        let of = |symbol: Symbol| match symbol {
            Symbol::Time => self.time,
            Symbol::State(index) => self.states[index as usize],
            Symbol::Parameter(index) => self.parameters[index as usize],
            Symbol::Input(index) => self.inputs[index as usize],
            _ => 0.0,
        };
        sized(&equations.pool, &[root], &of, &|switch| self.negative[switch as usize])[0].size
    }

    fn values(&self, equations: &StateEquations, roots: &[Id]) -> Vec<f64> {
        let unknowns = vec![0.0; equations.assembly.guesses.len()];
        let environment = Environment {
            time: self.time,
            states: &self.states,
            parameters: &self.parameters,
            inputs: &self.inputs,
            unknowns: &unknowns,
            negative: &self.negative,
            ..Environment::default()
        };
        // Reactions that joints share are symbols in what is shown.
        let mut pool = equations.pool.clone();
        let roots = equations.solution.closed(&mut pool, roots);
        evaluate(&pool, &roots, &environment)
    }
}

/// Rounding of some hundred operations on numbers of this magnitude.
fn assert_close(what: &str, found: &[f64], expected: &[f64]) -> f64 {
    assert_eq!(found.len(), expected.len(), "{what}");
    let magnitude = expected.iter().fold(1e-3, |largest: f64, value| largest.max(value.abs()));
    let mut largest: f64 = 0.0;
    for (k, (found, expected)) in found.iter().zip(expected).enumerate() {
        let error = (found - expected).abs() / magnitude;
        assert!(error < 1e-12, "{what} {k}: {found:e}, interpreter {expected:e}");
        largest = largest.max(error);
    }
    largest
}

/// The model with these parameters at many samples, against the interpreter; the largest relative deviation.
fn compare<Mo, const N: usize, const G: usize, const M: usize>(
    text: &str,
    model: impl Fn(&Sample) -> Mo,
    seed: u64,
) -> f64
where
    Mo: Model<f64, N, G, M>,
{
    let (causal, equations) = compiled(text);
    assert_eq!((equations.states.len(), equations.switches.len(), equations.outputs.len()), (N, G, M));
    let mut random = Random(seed);
    let mut largest: f64 = 0.0;
    for _ in 0..50 {
        let sample = Sample::random(&causal.graph, &equations, &mut random);
        let model = model(&sample);
        let x = SVector::<f64, N>::from_column_slice(&sample.states);
        let negative: [bool; G] = sample.negative.clone().try_into().expect("a flag each");
        let of = |roots: Vec<Id>| sample.values(&equations, &roots);
        let mut check = |what, found: &[f64], roots: Vec<Id>| {
            largest = largest.max(assert_close(what, found, &of(roots)));
        };
        let mut rate = SVector::zeros();
        model.rate(sample.time, &x, &negative, &mut rate);
        check("rate", rate.as_slice(), equations.states.iter().map(|state| state.rate).collect());
        let mut outputs = SVector::zeros();
        model.outputs(sample.time, &x, &negative, &mut outputs);
        check("output", outputs.as_slice(), equations.outputs.iter().map(|output| output.value).collect());
        let mut guards = SVector::zeros();
        model.guards(sample.time, &x, &negative, &mut guards);
        check("guard", guards.as_slice(), equations.switches.iter().map(|switch| switch.guard).collect());
        let powers = model.powers(sample.time, &x, &negative);
        let found = [powers.supplied, powers.dissipated, model.stored_energy(sample.time, &x, &negative)];
        check(
            "energy",
            &found,
            vec![equations.balance.supplied, equations.balance.dissipated, equations.balance.stored],
        );
        let mut projected = x;
        model.project(sample.time, &negative, &mut projected);
        let (indices, roots): (Vec<usize>, Vec<Id>) = equations.projections.iter().copied().unzip();
        let found: Vec<f64> = indices.iter().map(|&index| projected[index]).collect();
        check("projection", &found, roots);
    }
    largest
}

fn set<P: Parameters>(values: &[f64]) -> P {
    let mut parameters = P::default();
    values.iter().enumerate().for_each(|(index, &value)| parameters.set_value(index, value));
    parameters
}

fn motor(parameters: MotorParameters, voltage: f64) -> Motor {
    Motor::new(parameters, MotorInputs { voltage: Input::constant(voltage) }).expect("in range")
}

#[test]
fn the_motor_equals_its_interpretation() {
    let text = motor(MotorParameters::default(), 0.0).description().graph;
    let error = compare(text, |sample| motor(set(&sample.parameters), sample.inputs[0]), 1);
    println!("motor {error:e}");
}

#[test]
fn the_pendulum_equals_its_interpretation() {
    let text = Pendulum::new(PendulumParameters::default()).expect("in range").description().graph;
    let error = compare(text, |sample| Pendulum::new(set(&sample.parameters)).expect("in range"), 2);
    println!("pendulum {error:e}");
}

#[test]
fn the_hacksaw_equals_its_interpretation() {
    let text = Hacksaw::new(HacksawParameters::default()).expect("in range").description().graph;
    let error = compare(text, |sample| Hacksaw::new(set(&sample.parameters)).expect("in range"), 3);
    println!("hacksaw {error:e}");
}

/// Its functions have loops.
#[test]
fn a_rope_in_loops_equals_its_interpretation() {
    let text = Rope::new(RopeParameters::default()).expect("in range").description().graph;
    let error = compare(text, |sample| Rope::new(set(&sample.parameters)).expect("in range"), 3);
    println!("hacksaw {error:e}");
}

/// The models of the stages suite, and the three above.
fn texts() -> Vec<(String, String)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("stages");
    let mut texts: Vec<(String, String)> = std::fs::read_dir(folder)
        .expect("the folder is there")
        .map(|entry| entry.expect("a readable folder").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "bond"))
        .map(|path| (path.display().to_string(), std::fs::read_to_string(&path).expect("a model is text")))
        .collect();
    texts.sort_unstable();
    let hacksaw = Hacksaw::new(HacksawParameters::default()).expect("in range").description().graph;
    texts.push(("hacksaw".to_owned(), hacksaw.to_owned()));
    texts
}

/// Effort and flow of every bond.
fn bonds(equations: &StateEquations) -> impl Iterator<Item = (&[Id], &[Id])> {
    fn known(variable: &Option<Vec<Id>>) -> &[Id] {
        variable.as_deref().expect("all is known of a whole graph")
    }
    equations.shown.bonds.iter().map(|[effort, flow]| (known(effort), known(flow)))
}

#[test]
fn power_is_balanced_at_every_junction_and_two_port() {
    let mut nodes = 0;
    for (model, text) in texts() {
        let (causal, equations) = compiled(&text);
        let graph = &causal.graph;
        let mut random = Random(4);
        for _ in 0..5 {
            let sample = Sample::random(graph, &equations, &mut random);
            let powers: Vec<f64> = bonds(&equations)
                .map(|(effort, flow)| {
                    let (effort, flow) = (sample.values(&equations, effort), sample.values(&equations, flow));
                    effort.iter().zip(&flow).map(|(effort, flow)| effort * flow).sum()
                })
                .collect();
            for (index, node) in graph.nodes.iter().enumerate() {
                let conserves = match &node.kind {
                    NodeKind::Zero | NodeKind::One => true,
                    NodeKind::Element(element) => element.kind.is_two_port(),
                };
                if !conserves {
                    continue;
                }
                let signed = node.bonds.iter().map(|&bond| graph.sign(bond, NodeId(index)) * powers[bond.0]);
                let (sum, magnitude) =
                    signed.fold((0.0, 0.0), |(sum, all), power: f64| (sum + power, all + power.abs()));
                assert!(sum.abs() <= 1e-11 * magnitude, "{model}: `{}` {sum:e} of {magnitude:e}", node.name.text);
                nodes += 1;
            }
        }
    }
    println!("{nodes} balances");
    assert!(nodes > 1000);
}

#[test]
fn stored_energy_changes_by_what_is_supplied_less_what_is_dissipated() {
    let mut balanced = 0;
    for (model, text) in texts() {
        let (causal, mut equations) = compiled(&text);
        // At a state in which rigid joints do not hold their motions, reactions do work.
        if equations.holding.rigid.iter().any(|slip| !equations.pool.is_zero(slip.flow)) {
            continue;
        }
        balanced += 1;
        let mut random = Random(5);
        for _ in 0..20 {
            assert!(is_balanced(&model, &causal, &mut equations, &mut random), "{model}: not finite");
        }
    }
    assert!(balanced > 20, "{balanced} models");
}

/// Whether the values at a sample are finite; the energy balance then must hold.
fn is_balanced(model: &str, causal: &CausalGraph, equations: &mut StateEquations, random: &mut Random) -> bool {
    let mut seeds = BTreeMap::from([(Symbol::Time, equations.pool.one())]);
    for (index, state) in equations.states.iter().enumerate() {
        seeds.insert(Symbol::State(u32::try_from(index).expect("few states")), state.rate);
    }
    let stored = equations.balance.stored;
    let change = derivative(&mut equations.pool, &[stored], &seeds)[0];
    let mut sample = Sample::random(&causal.graph, equations, random);
    // The energy of a switched storage is that of the branch in which its state is.
    let guards: Vec<Id> = equations.switches.iter().map(|switch| switch.guard).collect();
    sample.negative = sample.values(equations, &guards).iter().map(|&guard| guard < 0.0).collect();
    let roots = [change, equations.balance.supplied, equations.balance.dissipated];
    let values = sample.values(equations, &roots);
    let [change, supplied, dissipated] = values[..] else { panic!("three values") };
    // The flow through a stiff spring and the power it carries cancel, so the scale is that of all bonds.
    // A body that turns freely has none: then it is its energy per second.
    let scale: f64 = bonds(equations)
        .flat_map(|(effort, flow)| {
            let (effort, flow) = (sample.values(equations, effort), sample.values(equations, flow));
            effort.into_iter().zip(flow).map(|(effort, flow)| (effort * flow).abs()).collect::<Vec<_>>()
        })
        .sum();
    let error = (change - supplied + dissipated).abs();
    let scale = scale + sample.values(equations, &[equations.balance.stored])[0].abs();
    // A transformer of 1e-45 makes powers of 1e255: what was added up to them is out of reach of their rounding.
    if !(error + scale).is_finite() || error.max(scale) > 1e100 {
        return false;
    }
    // In a loop of laws with large parts that cancel, rounding is that of the parts.
    let rounding: f64 = roots.iter().map(|&root| f64::EPSILON * sample.size(equations, root)).sum();
    assert!(
        error <= 1e-11 * scale + rounding,
        "{model}: {change:e} {supplied:e} {dissipated:e}, {error:e} of {scale:e}"
    );
    true
}

#[test]
fn random_networks_conserve_power() {
    let mut random = Random(6);
    let mut checked = 0;
    for number in 0..1500 {
        let text = fuzz::Kind::Network.input(&[], 6, number).text();
        let Ok((causal, mut equations)) = attempt(&text) else { continue };
        // What is held at zero is so in states that fit; a state drawn at random does not. Dependent storages have the
        // suite `linear`: the laws here have parts of 1e25 that cancel where a law is solved for its flow.
        if equations.holding.rigid.is_empty() && causal.derivative.is_empty() && equations.iterations.is_empty() {
            checked += usize::from(is_balanced(&text, &causal, &mut equations, &mut random));
        }
    }
    println!("{checked} networks");
    assert!(checked > 100, "{checked}");
}

#[test]
fn tokens_in_disorder_never_panic() {
    let mut random = Random(7);
    let texts: Vec<Vec<String>> =
        texts().iter().map(|(_, text)| text.split_inclusive([' ', '\n', ';']).map(str::to_owned).collect()).collect();
    let mut disordered = Vec::new();
    while disordered.len() < 2000 {
        // The hacksaw, the last one, is too long for this.
        let mut words = texts[random.below(texts.len() - 1)].clone();
        for _ in 0..1 + random.below(3) {
            let (at, other) = (random.below(words.len()), random.below(words.len()));
            match random.below(3) {
                0 => {
                    words.remove(at);
                }
                1 => words[at] = words[other].clone(),
                _ => words.swap(at, other),
            }
        }
        let text = words.concat();
        if text.parse::<TokenStream>().is_ok() {
            disordered.push(text);
        }
    }
    let is_valid =
        |text: &&String| !bg_compiler::compile(text.parse().expect("tokens")).to_string().contains("compile_error");
    let valid = disordered.par_iter().filter(is_valid).count();
    println!("{valid} valid of {}", disordered.len());
    assert!(valid > 20 && valid < disordered.len(), "{valid}");
}

bond_graph! {
    graph Alike {
        1 j: translation;
        1 k: translation;
        I a.b = 2 start 1;
        I a_b = 3 start 5;
        R r = 1;
        R s = 1;
        j -> a.b;
        k -> a_b;
        j -> r;
        k -> s;
    }
}

#[test]
fn names_that_differ_by_a_dot_stay_apart() {
    let text = Alike::new(AlikeParameters::default()).expect("in range").description().graph;
    compare(text, |sample| Alike::new(set(&sample.parameters)).expect("in range"), 8);
}

#[test]
fn a_storage_that_switches_has_an_energy_that_switches() {
    let text = "graph G { 1 j: translation; I m = 2; j -> m; j -> s;
        C s(q) = if q > 0.1 { 3 * q - 0.3 } else { 0 } energy if q > 0.1 { 1.5 * (q - 0.1) * (q - 0.1) } else { 0 }; }";
    let items = bg_compiler::compile(text.parse().expect("tokens")).to_string();
    assert!(!items.contains("atom_"), "the generated code does not compile");
    assert_eq!(compiled(text).1.switches.len(), 1);
}

/// As sums from tables and from programs are: the length of a sum is no nesting.
#[test]
fn a_law_of_a_thousand_terms_compiles() {
    let terms = |form: fn(usize) -> String| (1..=1000).map(form).collect::<Vec<_>>();
    let functions = terms(|k| format!("2 * tanh(v / {k})")).join(" + ");
    let powers = terms(|k| format!("{k} * v")).join(" - ");
    for law in [functions, powers] {
        let text = format!("graph G {{ 1 j: translation; I m = 2; R r(v) = {law}; j -> m; j -> r; }}");
        let items = bg_compiler::compile(text.parse().expect("tokens")).to_string();
        assert!(!items.contains("compile_error"), "{}", &items[..400]);
    }
}
