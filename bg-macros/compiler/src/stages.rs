//! Every stage's result as text, for snapshots, for programs that show a model, for the curious.
//!
//! In: tokens. Out: for each graph its stages in their order; faults where a stage raises them.

use std::fmt::Write;

use proc_macro2::TokenStream;

use crate::expr::{Id, Symbol};
use crate::fault::Staged;
use crate::graph::causality::{CausalGraph, End};
use crate::graph::{BondGraph, NodeKind, Storage};
use crate::pipeline::{self, Compiled};
use crate::program::elimination::Elimination;
use crate::program::pairs::{Half, Paired, Step, Value};
use crate::program::{Assignment, Counts, Operand, Operation, Reverse, Reversed, Routine, Running};
use crate::source::ast::TrackKind;
use crate::source::syntax;
use crate::system::equations::StateEquations;
use crate::system::jacobian::Jacobian;
use crate::system::second_order::SecondOrder;
use crate::system::sizes::Sizes;

/// The names of the stages, in their order. `reduction` and `reduced` are of scenes only, `pairs` is there where it
/// pays.
pub const NAMES: [&str; 15] = [
    "source",
    "expanded",
    "resolved",
    "causal",
    "equations",
    "reduction",
    "reduced",
    "projection",
    "program",
    "pairs",
    "reversed",
    "jacobian",
    "second",
    "sizes",
    "elimination",
];

/// One stage of one graph.
#[derive(Clone, Debug)]
pub struct Stage {
    /// The graph's name.
    pub graph: String,
    /// One of [`NAMES`].
    pub name: &'static str,
    /// The stage's result.
    pub text: String,
}

/// The stages of every model of a macro call.
///
/// # Errors
/// The faults of all graphs.
pub fn stages(tokens: TokenStream) -> Staged<Vec<Stage>> {
    let models = pipeline::models(&syntax::parse(tokens)?)?;
    Ok(models.iter().flat_map(of_model).collect())
}

fn of_model(model: &Compiled) -> Vec<Stage> {
    let Compiled {
        source,
        is_scene: _,
        stands_for_graph: _,
        scenes: _,
        derived,
        reduction,
        equations,
        jacobian,
        second_order,
        sizes,
        elimination,
        programs,
    } = model;
    let mut stages = Vec::new();
    let mut push = |name, text| stages.push(Stage { graph: source.name.text.clone(), name, text });
    push("source", source.to_string());
    push("expanded", derived.expanded.to_string());
    push("resolved", resolved_text(&derived.causal.graph));
    push("causal", causal_text(&derived.causal));
    push("equations", equations_text(&derived.equations));
    if let Some(report) = reduction {
        push("reduction", report.to_string());
        push("reduced", equations_text(equations));
    }
    push("projection", projection_text(equations));
    push("program", program_text(equations, &programs.running));
    if let Some(paired) = &programs.pairs().rate {
        push("pairs", paired_text(equations, paired));
    }
    push("reversed", programs.reversed().map_or_else(|| "none: the rate is too long\n".to_owned(), reversed_text));
    push("jacobian", jacobian_text(equations, jacobian));
    push("second", second_text(equations, second_order));
    push("sizes", sizes_text(equations, sizes));
    push("elimination", elimination_text(equations, elimination));
    stages
}

/// Nodes, bonds with cardinality and units, states.
fn resolved_text(graph: &BondGraph) -> String {
    let mut out = String::new();
    for node in &graph.nodes {
        let _ = write!(out, "{} {}", node.kind.symbol(), node.name.text);
        if let NodeKind::Element(element) = &node.kind {
            let _ = write!(out, ": {}", element.text);
        }
        out.push('\n');
    }
    for bond in &graph.bonds {
        let (from, to) = (&graph.node(bond.from).name.text, &graph.node(bond.to).name.text);
        let _ = writeln!(
            out,
            "{from} -> {to} [{}] effort {} flow {}",
            bond.cardinality,
            bond.effort_unit(),
            bond.flow_unit()
        );
    }
    for storage in &graph.storages {
        if let Storage::Track(index) = storage {
            let track = &graph.tracks[*index];
            let kind = if track.kind == TrackKind::Position { "position" } else { "orientation" };
            let _ = writeln!(out, "{kind} {} of {}", track.name.text, graph.node(track.junction).name.text);
        }
    }
    out
}

/// Bonds with their strokes: the bar is at the end that receives the effort.
fn causal_text(causal: &CausalGraph) -> String {
    let graph = &causal.graph;
    let mut out = String::new();
    for (bond, stroke) in graph.bonds.iter().zip(&causal.strokes) {
        let (from, to) = (&graph.node(bond.from).name.text, &graph.node(bond.to).name.text);
        let arrow = match stroke {
            End::From => "|->",
            End::To => "->|",
        };
        let _ = writeln!(out, "{from} {arrow} {to}");
    }
    out
}

/// Causal equations as text, then every state's start and rate, every output, every guard.
fn equations_text(equations: &StateEquations) -> String {
    let mut out = String::new();
    for line in &equations.texts {
        let _ = writeln!(out, "{line}");
    }
    let show = |id: Id| equations.shown(&equations.pool, id);
    out.push('\n');
    for state in &equations.states {
        let (name, unit, storage) = (&state.name, &state.unit, state.origin.kind().storage());
        let _ = writeln!(out, "{name} [{unit}] of {storage}, start {}", show(state.start));
        let _ = writeln!(out, "    {name}' = {}", show(state.rate));
    }
    for (index, switch) in equations.switches.iter().enumerate() {
        let _ = writeln!(out, "guard_{index} of {}: {}", switch.element, show(switch.guard));
    }
    for output in &equations.outputs {
        let _ = writeln!(out, "output {} [{}] = {}", output.name, output.unit, show(output.value));
    }
    for gap in &equations.assembly.gaps {
        let _ = writeln!(out, "gap of {} {} [{}] = {}", gap.joint, gap.component, gap.unit, show(gap.value));
    }
    let _ = writeln!(out, "stored = {}", show(equations.balance.stored));
    let _ = writeln!(out, "supplied = {}", show(equations.balance.supplied));
    let _ = writeln!(out, "dissipated = {}", show(equations.balance.dissipated));
    out
}

/// What a step's end is moved to: the states of the pose, then the momenta. What is long stands in the program alone.
fn projection_text(equations: &StateEquations) -> String {
    const LONGEST: usize = 60;
    let mut out = String::new();
    let StateEquations { projections, settled, pool, .. } = equations;
    for (what, moved) in [("pose", projections), ("momenta", settled)] {
        let _ = writeln!(out, "{what}: {} states", moved.len());
        for &(state, value) in moved {
            let parts = pool.reachable(&[value]).len();
            let text = if parts > LONGEST { format!("{parts} terms") } else { equations.shown(pool, value) };
            let _ = writeln!(out, "    {} -> {text}", equations.states[state].name);
        }
    }
    out
}

/// Every entry of the Jacobian and every df/dt that is not identically zero.
fn jacobian_text(equations: &StateEquations, jacobian: &Jacobian) -> String {
    let name = |index: usize| equations.states[index].name.as_str();
    let mut out = format!("{} entries\n", jacobian.entries.len());
    let n = equations.states.len();
    for entry in &jacobian.entries {
        let value = equations.shown(&jacobian.pool, entry.value);
        let of = if entry.row < n { format!("{}'", name(entry.row)) } else { format!("equation {}", entry.row - n) };
        let by =
            if entry.column < n { name(entry.column).to_owned() } else { format!("reaction {}", entry.column - n) };
        let _ = writeln!(out, "    d {of} / d {by} = {value}");
    }
    let slopes = jacobian.slopes.iter().enumerate().filter(|(_, slope)| !jacobian.pool.is_zero(**slope));
    for (index, &slope) in slopes {
        let _ = writeln!(out, "    d {}' / d t = {}", name(index), equations.shown(&jacobian.pool, slope));
    }
    out
}

/// The states of second order with their second derivatives.
fn second_text(equations: &StateEquations, second: &SecondOrder) -> String {
    let mut out = format!("{} states\n", second.states.len());
    for (index, &derivative) in second.states.clone().zip(&second.derivatives) {
        let _ = writeln!(out, "    {}'' = {}", equations.states[index].name, equations.shown(&second.pool, derivative));
    }
    out
}

/// The second derivatives of the stored energy.
fn sizes_text(equations: &StateEquations, sizes: &Sizes) -> String {
    let mut out = String::new();
    for (state, &curvature) in equations.states.iter().zip(&sizes.curvatures) {
        if !sizes.pool.is_zero(curvature) {
            let _ = writeln!(out, "d2 stored / d {0}2 = {1}", state.name, equations.shown(&sizes.pool, curvature));
        }
    }
    out
}

/// The order of the pivots, the fill and the operations.
fn elimination_text(equations: &StateEquations, elimination: &Elimination) -> String {
    let name = |&row: &usize| match equations.states.get(row) {
        Some(state) => state.name.clone(),
        None => format!("reaction {}", row - equations.states.len()),
    };
    let pivots: Vec<String> = elimination.order.iter().map(name).collect();
    let count = |counts: Counts| {
        let Counts { additions, multiplications, divisions, .. } = counts;
        format!("{additions} additions, {multiplications} multiplications, {divisions} divisions")
    };
    format!(
        "pivots: {}\nfill: {}\nfactors: {}\neliminate: {}\nsubstitute: {}\n",
        pivots.join(", "),
        elimination.fill,
        elimination.slots,
        count(elimination.factorisation_counts()),
        count(elimination.substitution_counts())
    )
}

/// The flat single assignments of the running model.
fn program_text(equations: &StateEquations, running: &Running) -> String {
    let mut out = String::new();
    routine_text(equations, &running.constants, &mut out);
    for routine in running.routines() {
        routine_text(equations, routine, &mut out);
    }
    out
}

fn routine_text(equations: &StateEquations, routine: &Routine, out: &mut String) {
    let _ = writeln!(out, "{}: {} operations", routine.name, routine.counts.total());
    for assignment in &routine.assignments {
        let _ = writeln!(out, "    {}", assignment_text(equations, assignment));
    }
    let results: Vec<String> = routine.results.iter().map(|result| operand_text(equations, result)).collect();
    let _ = writeln!(out, "    -> {}", results.join(", "));
}

fn operand_text(equations: &StateEquations, operand: &Operand) -> String {
    match operand {
        Operand::Number(value) => value.to_string(),
        Operand::Symbol(symbol) => equations.symbol_name(*symbol),
        Operand::Constant(index) => format!("c{index}"),
        Operand::Temporary(index) => format!("v{index}"),
    }
}

fn assignment_text(equations: &StateEquations, assignment: &Assignment) -> String {
    let operand = |operand| operand_text(equations, operand);
    let text = match &assignment.operation {
        Operation::Add(a, b) => format!("{} + {}", operand(a), operand(b)),
        Operation::Subtract(a, b) => format!("{} - {}", operand(a), operand(b)),
        Operation::Multiply(a, b) => format!("{} * {}", operand(a), operand(b)),
        Operation::Divide(a, b) => format!("{} / {}", operand(a), operand(b)),
        Operation::Negate(a) => format!("-{}", operand(a)),
        Operation::Call(function, arguments) => {
            let arguments: Vec<String> = arguments.iter().map(operand).collect();
            format!("{}({})", function.name(), arguments.join(", "))
        }
        Operation::Select { switch, negative, positive } => {
            format!("if guard_{switch} < 0 {{ {} }} else {{ {} }}", operand(negative), operand(positive))
        }
    };
    format!("v{} = {text}", assignment.target)
}

/// What the reverse sweeps cost, and by what they differentiate.
fn reversed_text(reversed: &Reversed) -> String {
    let mut out = String::new();
    for Reverse { routine, leaves } in reversed.sweeps().filter(|sweep| !sweep.leaves.is_empty()) {
        let states = leaves.iter().filter(|leaf| matches!(leaf, Operand::Symbol(_))).count();
        let (name, constants) = (&routine.name, leaves.len() - states);
        let operations = routine.counts.total();
        let _ = writeln!(out, "{name}: {operations} operations, by {states} states and {constants} constants");
    }
    out
}

/// The steps of the rate with pairs.
fn paired_text(equations: &StateEquations, paired: &Paired) -> String {
    let half = |half: &Half| match half {
        Half::Of(value) => operand_text(equations, value),
        Half::In(pair, at) => format!("w{pair}.{at}"),
    };
    let sign = |is_negative: bool| if is_negative { "-" } else { "" };
    let mut out = format!("rate: {} operations\n", paired.operations());
    for step in &paired.steps {
        let text = match step {
            Step::Single(assignment) => assignment_text(equations, assignment),
            Step::Half { target, pair, half: at } => format!("v{target} = {}", half(&Half::In(*pair, *at))),
            Step::Pair(index, value) => {
                let value = match value {
                    Value::States(index) => {
                        let [first, second] =
                            [*index, index + 1].map(|index| equations.symbol_name(Symbol::State(index)));
                        format!("[{first}, {second}]")
                    }
                    Value::Numbers([first, second]) => format!("[{first}, {second}]"),
                    Value::Constants(index) => {
                        let [first, second] = paired.constants[*index as usize].map(|(constant, is_negative)| {
                            format!("{}{}", sign(is_negative), operand_text(equations, &constant))
                        });
                        format!("[{first}, {second}]")
                    }
                    Value::Gather([first, second]) => format!("[{}, {}]", half(first), half(second)),
                    Value::Add(a, b) => format!("w{a} + w{b}"),
                    Value::Subtract(a, b) => format!("w{a} - w{b}"),
                    Value::Multiply(a, b) => format!("w{a} * w{b}"),
                    Value::Divide(a, b) => format!("w{a} / w{b}"),
                    Value::Turn(of, [first, second]) => format!("[{}w{of}.0, {}w{of}.1]", sign(*first), sign(*second)),
                };
                format!("w{index} = {value}")
            }
        };
        let _ = writeln!(out, "    {text}");
    }
    let results: Vec<String> = paired.results.iter().map(half).collect();
    let _ = writeln!(out, "    -> {}", results.join(", "));
    out
}
