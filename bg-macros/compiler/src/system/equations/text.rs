//! The equations of the causal graph as text: who gives what to whom.
//!
//! In: the derivation's graph. Out: one line for every bond variable, one for every state, one for what was solved.

use super::dependent::Way;
use super::signals::{Layout, Signals};
use super::unknowns::Unknown;
use crate::expr::{Id, Symbol, text as expression_text};
use crate::graph::{BondId, ElementKind, End, Law, NodeId, NodeKind, Role, Storage, TrackKind};

/// Of an expression longer than this a message says what it depends on.
const LONGEST: usize = 300;

/// All lines: for every bond its effort and its flow, then the rates, then what has been solved for.
pub(super) fn equations(signals: &Signals<'_>) -> Vec<String> {
    let bonds = signals.graph.bonds.len();
    let mut lines = Vec::new();
    for bond in (0..bonds).map(BondId) {
        let ends = signals.graph.bond(bond);
        let (receives, gives) = match signals.causal.strokes[bond.0] {
            End::From => (ends.from, ends.to),
            End::To => (ends.to, ends.from),
        };
        lines.push(format!(
            "{} = {}",
            variable(signals, Role::Effort, bond),
            given(signals, gives, bond, Role::Effort)
        ));
        lines.push(format!("{} = {}", variable(signals, Role::Flow, bond), given(signals, receives, bond, Role::Flow)));
    }
    lines.extend(signals.layout.iter().map(|place| rate(signals, place)));
    for (index, state) in
        signals.turns.values().chain(signals.ways.values()).map(|&index| (index, &signals.states[index]))
    {
        lines.push(format!("d({})/dt = {}", state.name, shown(signals, &[signals.states[index].rate])));
    }
    lines.extend(loops(signals));
    lines.extend(states(signals));
    lines
}

/// The variables at which algebraic loops were opened.
fn loops(signals: &Signals<'_>) -> Vec<String> {
    let mut lines = Vec::new();
    for (k, unknown) in signals.unknowns.all.iter().enumerate() {
        let Unknown::Variable(role, bond, _) = *unknown else { continue };
        let first = k == 0 || signals.unknowns.all[k - 1] != *unknown;
        if signals.loops.iter().any(|nonlinear| nonlinear.unknowns.contains(&(k as u32))) {
            continue;
        }
        if let Some(value) = signals.known(role, bond).filter(|_| first) {
            lines.push(format!(
                "{} = {}, from an algebraic loop",
                variable(signals, role, bond),
                shown(signals, &value.0)
            ));
        }
    }
    for nonlinear in &signals.loops {
        for residual in &nonlinear.residuals {
            lines.push(format!("0 = {}, by Newton's iteration", shown(signals, &[*residual])));
        }
    }
    lines
}

/// The states that others determine.
fn states(signals: &Signals<'_>) -> Vec<String> {
    let line = |(&node, dependent): (&NodeId, &super::dependent::Dependent)| {
        let letter = if signals.graph.element(node)?.kind == ElementKind::C { "q" } else { "p" };
        let replaced: Vec<(usize, Id)> =
            dependent.replaced.iter().enumerate().filter_map(|(k, id)| Some((k, (*id)?))).collect();
        let (of, ids): (Vec<usize>, Vec<Id>) = replaced.into_iter().unzip();
        let of = components(&of, dependent.replaced.len());
        let value = shown(signals, &ids);
        (!ids.is_empty()).then(|| format!("{}.{letter}{of} = {value}, derivative causality", name(signals, node)))
    };
    signals.dependent.iter().filter_map(line).collect()
}

/// Those of `all` components that are meant, as a suffix: nothing where all are.
fn components(of: &[usize], all: usize) -> String {
    if of.len() == all {
        return String::new();
    }
    let letters: String = of.iter().map(|&k| ["x", "y", "z"][k]).collect::<Vec<_>>().join(", ");
    if of.len() == 1 { format!("_{letters}") } else { format!("_[{letters}]") }
}

/// Components as text.
fn shown(signals: &Signals<'_>, ids: &[Id]) -> String {
    let guard = |switch: u32| format!("guard_{switch}");
    let show = |&id: &Id| expression_text(&signals.pool, id, &|symbol| signals.symbol_name(symbol), &guard);
    let parts: Vec<String> = ids.iter().map(show).collect();
    let text = if parts.len() == 1 { parts.concat() } else { format!("[{}]", parts.join(", ")) };
    if text.len() <= LONGEST {
        return text;
    }
    let symbols = signals.pool.symbols(ids).into_iter().filter(|symbol| !matches!(symbol, Symbol::Parameter(_)));
    let names: Vec<String> = symbols.map(|symbol| signals.symbol_name(symbol)).collect();
    format!("a function of {}", names.join(", "))
}

fn name(signals: &Signals<'_>, node: NodeId) -> String {
    signals.graph.node(node).name.text.clone()
}

fn letter(role: Role) -> char {
    match role {
        Role::Effort => 'e',
        Role::Flow => 'f',
    }
}

/// `e[a -> b]` or `f[a -> b]`.
pub(super) fn variable(signals: &Signals<'_>, role: Role, bond: BondId) -> String {
    let ends = signals.graph.bond(bond);
    format!("{}[{} -> {}]", letter(role), name(signals, ends.from), name(signals, ends.to))
}

fn given(signals: &Signals<'_>, node: NodeId, bond: BondId, role: Role) -> String {
    let definition = signals.graph.node(node);
    match &definition.kind {
        NodeKind::Zero | NodeKind::One => {
            let common = if matches!(definition.kind, NodeKind::Zero) { Role::Effort } else { Role::Flow };
            if role == common {
                return signals
                    .causal
                    .strong_bond(node)
                    .map_or_else(|| "0".to_owned(), |strong| variable(signals, role, strong));
            }
            balance(signals, node, bond, role)
        }
        NodeKind::Element(element) => {
            let others: Vec<String> = definition
                .bonds
                .iter()
                .filter(|&&other| other != bond)
                .map(|&other| signals.graph.bond(other))
                .map(|ends| format!("[{} -> {}]", name(signals, ends.from), name(signals, ends.to)))
                .collect();
            let of = match element.kind {
                ElementKind::Se | ElementKind::MSe | ElementKind::Sf | ElementKind::MSf => String::new(),
                ElementKind::RSe if signals.is_stop(node) => " of what rests on it".to_owned(),
                ElementKind::RSe => " kept by its reaction".to_owned(),
                ElementKind::R | ElementKind::Mr if element.sticking.is_some() => {
                    format!(" of {}, or what keeps it at zero", variable(signals, role.other(), bond))
                }
                ElementKind::C | ElementKind::I if signals.dependent.contains_key(&node) => {
                    let letter = if element.kind == ElementKind::C { "q" } else { "p" };
                    if signals.dependent[&node].ways.contains(&Way::Replaced) {
                        format!(" by the change of {}.{letter}", definition.name.text)
                    } else {
                        format!(" that keeps {}.{letter} in step", definition.name.text)
                    }
                }
                ElementKind::C if element.displacement.is_some() => " of its displacement in the poses".to_owned(),
                ElementKind::C => format!(" of {}.q", definition.name.text),
                ElementKind::I => format!(" of {}.p", definition.name.text),
                ElementKind::R | ElementKind::Mr => {
                    format!(" of {}", variable(signals, role.other(), bond))
                }
                ElementKind::Gy | ElementKind::Mgy => {
                    format!(" of {}{}", letter(role.other()), others.concat())
                }
                ElementKind::Tf | ElementKind::Mtf => format!(" of {}{}", letter(role), others.concat()),
            };
            let form = match &element.law {
                Law::Stiffness(_) => "stiffness ",
                Law::Compliance(_) => "compliance ",
                _ => "",
            };
            format!("{} `{}`: {form}{}{of}", element.kind.symbol(), definition.name.text, element.text)
        }
    }
}

/// The signed sum of the other bonds' variables.
fn balance(signals: &Signals<'_>, node: NodeId, bond: BondId, role: Role) -> String {
    let own = signals.graph.sign(bond, node);
    let mut text = String::new();
    for &other in signals.graph.node(node).bonds.iter().filter(|&&other| other != bond) {
        let positive = -own * signals.graph.sign(other, node) > 0.0;
        text.push_str(match (text.is_empty(), positive) {
            (true, true) => "",
            (true, false) => "-",
            (false, true) => " + ",
            (false, false) => " - ",
        });
        text.push_str(&variable(signals, role, other));
    }
    if text.is_empty() { "0".to_owned() } else { text }
}

fn rate(signals: &Signals<'_>, place: &Layout) -> String {
    match place.storage {
        Storage::Element(node) => {
            let definition = signals.graph.node(node);
            let bond = definition.bonds[0];
            let compliance = signals.graph.element(node).is_some_and(|element| element.kind == ElementKind::C);
            let (state, role) = if compliance { ("q", Role::Flow) } else { ("p", Role::Effort) };
            let sign = if compliance && signals.graph.sign(bond, node) < 0.0 { "-" } else { "" };
            let of: Vec<usize> = place.components.iter().map(|(k, _)| *k).collect();
            let of = components(&of, place.shape.suffixes().len());
            format!("d({}.{state}{of})/dt = {sign}{}{of}", definition.name.text, variable(signals, role, bond))
        }
        Storage::Track(index) => {
            let track = &signals.graph.tracks[index];
            let junction = name(signals, track.junction);
            match track.kind {
                TrackKind::Position => format!("d({})/dt = f({junction})", track.name.text),
                TrackKind::Orientation => format!("d({0})/dt = skew(f({junction})) * {0}", track.name.text),
            }
        }
    }
}
