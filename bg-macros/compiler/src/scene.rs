//! Scenes: the uses of one mechanism, each a graph of its own.
//!
//! In: one `ast::Graph` with scenes. Out: the literal graph, and for each scene the graph without what it leaves out and
//! with what it watches. No longer occurs: `Item::Scene`.

use std::collections::BTreeSet;

use crate::ast::{ElementKind, Expectation, Graph, Item, Name, Rigid, Scene};
use crate::equations::StateEquations;
use crate::fault::{Explain, Fault, Staged, near_miss};
use crate::graph::Parameter;
use crate::reduce::{self, Fate, Report};
use crate::second;

/// A fault of a scene.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "each variant's message says what it and its fields are")]
pub enum SceneFault {
    SameName { name: String },
    UnknownPart { name: String, near: Option<String> },
    UnknownParameter { name: String, near: Option<String> },
    NotPlanar { scene: String, states: Vec<String> },
    StateCount { scene: String, expected: usize, states: Vec<String> },
    UnknownJoint { name: String, near: Option<String> },
    Reserved { name: String },
    NothingRigid,
}

use SceneFault as F;

/// Types that the generated code uses without a path.
const OWN: [&str; 3] = ["S", "Scalar", "SVector"];

/// How many states a message lists.
const LISTED: usize = 40;

impl Explain for SceneFault {
    fn code(&self) -> &'static str {
        match self {
            F::SameName { .. } => "BG0601",
            F::UnknownPart { .. } => "BG0602",
            F::UnknownParameter { .. } => "BG0603",
            F::NotPlanar { .. } => "BG0604",
            F::StateCount { .. } => "BG0605",
            F::UnknownJoint { .. } => "BG0606",
            F::Reserved { .. } => "BG0607",
            F::NothingRigid => "BG0608",
        }
    }

    fn message(&self) -> String {
        match self {
            F::SameName { name } => format!("there are two models called `{name}`"),
            F::UnknownPart { name, .. } => format!("the mechanism has no part `{name}` to leave out"),
            F::UnknownParameter { name, .. } => format!("there is no parameter `{name}` to tune"),
            F::NotPlanar { scene, states } => {
                format!("scene `{scene}` is not planar: these are not proved constant: {}", list(states))
            }
            F::StateCount { scene, expected, states } => {
                format!("scene `{scene}` integrates {} states, not {expected}: {}", states.len(), list(states))
            }
            F::Reserved { name } => format!("`{name}` is a name of the generated code's own"),
            F::UnknownJoint { name, .. } => format!("there is no joint `{name}` to make rigid"),
            F::NothingRigid => "`start impulse` has nothing to act through: no joint is rigid, in no scene".to_owned(),
        }
    }

    fn help(&self) -> String {
        match self {
            F::SameName { .. } => "give one of them another name".to_owned(),
            F::Reserved { .. } => "give the model another name".to_owned(),
            F::UnknownPart { near: Some(near), .. }
            | F::UnknownParameter { near: Some(near), .. }
            | F::UnknownJoint { near: Some(near), .. } => format!("did you mean `{near}`?"),
            F::UnknownPart { .. } => "name a joint, contact, spring, drive or element".to_owned(),
            F::UnknownParameter { .. } => "name a parameter of the graph".to_owned(),
            F::NotPlanar { .. } => {
                "find what moves them: a tuned parameter out of the plane, a start value, a force".to_owned()
            }
            F::StateCount { .. } => "correct the number, or what the scene watches and tunes".to_owned(),
            F::UnknownJoint { .. } => "name a joint of the graph, or write `rigid joints;`".to_owned(),
            F::NothingRigid => "remove it, or make a joint rigid".to_owned(),
        }
    }
}

fn list(states: &[String]) -> String {
    let more = states.len().saturating_sub(LISTED);
    let text = states[..states.len().min(LISTED)].join(", ");
    if more == 0 { text } else { format!("{text} and {more} more") }
}

/// A model to compile: the literal graph, or the graph of a scene.
#[derive(Clone, Debug)]
pub struct Variant {
    /// The graph under the model's name, without scenes.
    pub graph: Graph,
    /// The scene; none for the literal graph.
    pub scene: Option<Scene>,
}

impl Variant {
    /// The equations of the variant's graph as its model needs them, their states arranged: those of a scene reduced, with the
    /// report of it.
    ///
    /// # Errors
    /// Tuned parameters that there are not, expectations that do not hold.
    pub fn reduce(&self, mut equations: StateEquations) -> Staged<(StateEquations, Option<Report>)> {
        let Some(scene) = &self.scene else {
            reduce::solve_reactions(&mut equations);
            second::arrange(&mut equations);
            return Ok((equations, None));
        };
        let tuned = tuned(scene, &equations.parameters)?;
        let (mut equations, report) = reduce::for_scene(equations, &tuned, scene.angles);
        check(scene, &report)?;
        second::arrange(&mut equations);
        Ok((equations, Some(report)))
    }
}

/// The literal graph and one variant for each scene.
///
/// # Errors
/// Two models of one name, parts to leave out that there are not.
pub fn variants(source: &Graph) -> Staged<Vec<Variant>> {
    let mut faults = Vec::new();
    let items: Vec<Item> = source.items.iter().filter(|item| !matches!(item, Item::Scene(_))).cloned().collect();
    let literal = Graph { items, ..source.clone() };
    let mut names = BTreeSet::from([source.name.text.clone()]);
    let mut variants = vec![Variant { graph: literal.clone(), scene: None }];
    let scenes =
        source.items.iter().filter_map(|item| if let Item::Scene(scene) = item { Some(&scene.name) } else { None });
    for name in scenes.chain([&source.name]).filter(|name| OWN.contains(&name.text.as_str())) {
        faults.push(Fault::new(name.span, &F::Reserved { name: name.text.clone() }));
    }
    faults.extend(idle_impulse(source));
    for item in &source.items {
        let Item::Scene(scene) = item else { continue };
        if !names.insert(scene.name.text.clone()) {
            let name = scene.name.text.clone();
            faults.push(Fault::new(scene.name.span, &F::SameName { name }));
        }
        let mut items = left(&literal.items, &scene.without, &mut faults);
        stiffen(&mut items, &scene.rigid, &mut faults);
        variants.push(Variant { graph: watched(&literal, items, scene), scene: Some(scene.clone()) });
    }
    if faults.is_empty() { Ok(variants) } else { Err(faults) }
}

/// The fault of a `start impulse` in a graph that has no rigid joint, neither itself nor in a scene.
fn idle_impulse(source: &Graph) -> Option<Fault> {
    let is_rigid = |item: &Item| match item {
        Item::Joint(joint) => joint.rigid,
        Item::Element(element) => element.kind == ElementKind::RSe,
        Item::Scene(scene) => !matches!(scene.rigid, Rigid::None),
        _ => false,
    };
    let span = source.items.iter().find_map(|item| if let Item::Impulse(span) = item { Some(*span) } else { None })?;
    (!source.items.iter().any(is_rigid)).then(|| Fault::new(span, &F::NothingRigid))
}

/// The scene's graph: its observations in place of the graph's, if it has any.
fn watched(literal: &Graph, mut items: Vec<Item>, scene: &Scene) -> Graph {
    if !scene.observe.is_empty() {
        items.retain(|item| !matches!(item, Item::Observe(_)));
        items.push(Item::Observe(scene.observe.clone()));
    }
    let docs = if scene.docs.is_empty() { literal.docs.clone() } else { scene.docs.clone() };
    Graph { docs, visibility: literal.visibility.clone(), name: scene.name.clone(), items }
}

/// The items without some parts and the bonds that end at them.
fn left(items: &[Item], without: &[Name], faults: &mut Vec<Fault>) -> Vec<Item> {
    for name in without {
        let parts = || items.iter().filter_map(part_name);
        if parts().all(|part| part.text != name.text) {
            let near = near_miss(&name.text, parts().map(|part| part.text.as_str())).map(str::to_owned);
            faults.push(Fault::new(name.span, &F::UnknownPart { name: name.text.clone(), near }));
        }
    }
    let goes = |name: &Name| without.iter().any(|gone| gone.text == name.text);
    let mut left = Vec::new();
    for item in items {
        match item {
            Item::Chain(chain) => {
                let pieces = chain.split(goes).filter(|piece| piece.len() > 1);
                left.extend(pieces.map(|piece| Item::Chain(piece.to_vec())));
            }
            _ if part_name(item).is_some_and(goes) => {}
            _ => left.push(item.clone()),
        }
    }
    left
}

/// Makes the joints rigid that the scene wants so.
fn stiffen(items: &mut [Item], rigid: &Rigid, faults: &mut Vec<Fault>) {
    if let Rigid::Some(names) = rigid {
        let joints =
            || items.iter().filter_map(|item| if let Item::Joint(joint) = item { Some(&joint.name) } else { None });
        for name in names.iter().filter(|name| joints().all(|joint| joint.text != name.text)) {
            let near = near_miss(&name.text, joints().map(|joint| joint.text.as_str())).map(str::to_owned);
            faults.push(Fault::new(name.span, &F::UnknownJoint { name: name.text.clone(), near }));
        }
    }
    for item in items {
        if let Item::Joint(joint) = item {
            joint.rigid |= match rigid {
                Rigid::None => false,
                Rigid::All(_) => true,
                Rigid::Some(names) => names.iter().any(|name| name.text == joint.name.text),
            };
        }
    }
}

/// The name of a part that a scene can leave out.
fn part_name(item: &Item) -> Option<&Name> {
    match item {
        Item::Joint(joint) => Some(&joint.name),
        Item::Contact(contact) => Some(&contact.name),
        Item::Spring(spring) => Some(&spring.name),
        Item::Drive(drive) => Some(&drive.name),
        Item::Element(element) => Some(&element.name),
        _ => None,
    }
}

/// For each parameter whether the scene tunes it.
///
/// # Errors
/// Names that are no parameters.
pub fn tuned(scene: &Scene, parameters: &[Parameter]) -> Staged<Vec<bool>> {
    let Some(tune) = &scene.tune else { return Ok(vec![true; parameters.len()]) };
    let known = || parameters.iter().map(|parameter| parameter.name.text.as_str());
    let faults: Vec<Fault> = tune
        .iter()
        .filter(|name| known().all(|parameter| parameter != name.text))
        .map(|name| {
            let near = near_miss(&name.text, known()).map(str::to_owned);
            Fault::new(name.span, &F::UnknownParameter { name: name.text.clone(), near })
        })
        .collect();
    if faults.is_empty() {
        Ok(known().map(|parameter| tune.iter().any(|name| name.text == parameter)).collect())
    } else {
        Err(faults)
    }
}

/// What the scene asserts of its reduction.
///
/// # Errors
/// An assertion that does not hold, with the states that break it.
pub fn check(scene: &Scene, report: &Report) -> Staged<()> {
    let name = &scene.name.text;
    let mut faults = Vec::new();
    for expectation in &scene.expect {
        match expectation {
            Expectation::Planar(span) => {
                let states = out_of_plane(report);
                if !states.is_empty() {
                    faults.push(Fault::new(*span, &F::NotPlanar { scene: name.clone(), states }));
                }
            }
            Expectation::States(expected, span) => {
                let states = integrated(report);
                if states.len() != *expected {
                    let fault = F::StateCount { scene: name.clone(), expected: *expected, states };
                    faults.push(Fault::new(*span, &fault));
                }
            }
        }
    }
    if faults.is_empty() { Ok(()) } else { Err(faults) }
}

fn integrated(report: &Report) -> Vec<String> {
    let fates = report.fates.iter().filter(|(_, fate)| *fate == Fate::Integrated);
    fates.map(|(state, _)| state.name.clone()).collect()
}

/// The pose components out of the x-y plane that are not proved constant.
fn out_of_plane(report: &Report) -> Vec<String> {
    let leaves_plane = |storage: &str, name: &str| match storage {
        "position" => name.ends_with("_z"),
        "orientation" => ["_13", "_23", "_31", "_32", "_33"].iter().any(|suffix| name.ends_with(suffix)),
        _ => false,
    };
    let moves = |fate: &Fate| !matches!(fate, Fate::Constant(_));
    let fates = report.fates.iter();
    fates
        .filter(|(state, fate)| moves(fate) && leaves_plane(state.storage, &state.name))
        .map(|(state, _)| state.name.clone())
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{causality, equations, mechanism, reduce, syntax};

    const GRAPH: &str = "/// The whole.
        pub graph G {
            param m: kg = 2; param k: N/m = 3; param c: N*s/m = 1;
            1 j: translation; I mass = m start 1; C spring = k; R damper = c;
            0 between: translation; j -> mass; j -> spring; j -> between -> damper;
            observe { v: m/s = j.flow; }
            SCENES
        }";

    fn of(scenes: &str) -> Staged<Vec<Variant>> {
        variants(&syntax::parse(GRAPH.replace("SCENES", scenes).parse().expect("tokens"))?.graphs[0])
    }

    fn report(variant: &Variant) -> Staged<Report> {
        let expanded = mechanism::expand(&variant.graph)?;
        let equations = equations::derive(&causality::assign(crate::graph::resolve(&expanded)?)?)?;
        let tuned = tuned(variant.scene.as_ref().expect("a scene"), &equations.parameters)?;
        Ok(reduce::for_scene(equations, &tuned, false).1)
    }

    fn outputs(graph: &Graph) -> usize {
        graph.items.iter().map(|item| if let Item::Observe(observed) = item { observed.len() } else { 0 }).sum()
    }

    #[test]
    fn the_literal_graph_comes_first_and_has_no_scenes() {
        let variants = of("scene A {} /// Another.\n scene B { observe { j.flow, j.effort } }").unwrap();
        let names: Vec<_> = variants.iter().map(|variant| variant.graph.name.text.as_str()).collect();
        assert_eq!(names, ["G", "A", "B"]);
        assert!(variants[0].scene.is_none());
        assert!(variants.iter().all(|v| v.graph.items.iter().all(|item| !matches!(item, Item::Scene(_)))));
        let docs: Vec<_> = variants.iter().map(|variant| variant.graph.docs.trim()).collect();
        assert_eq!(docs, ["The whole.", "The whole.", "Another."]);
        assert_eq!(variants.iter().map(|variant| outputs(&variant.graph)).collect::<Vec<_>>(), [1, 1, 2]);
        assert!(variants.iter().all(|variant| matches!(variant.graph.visibility, syn::Visibility::Public(_))));
    }

    #[test]
    fn what_is_left_out_goes_with_its_bonds_and_nothing_else() {
        let chains = |graph: &Graph| {
            let chains =
                graph.items.iter().filter_map(|item| if let Item::Chain(chain) = item { Some(chain) } else { None });
            chains
                .map(|chain| chain.iter().map(|name| name.text.clone()).collect::<Vec<_>>().join(" "))
                .collect::<Vec<_>>()
        };
        let variants = of("scene A { without { damper } } scene B { without spring; }").unwrap();
        assert_eq!(chains(&variants[0].graph), ["j mass", "j spring", "j between damper"]);
        assert_eq!(chains(&variants[1].graph), ["j mass", "j spring", "j between"]);
        assert_eq!(chains(&variants[2].graph), ["j mass", "j between damper"]);
        assert_eq!(variants[2].graph.items.len(), variants[0].graph.items.len() - 2);
    }

    #[test]
    fn without_tune_all_parameters_are_tuned_and_with_an_empty_one_none() {
        let variants = of("scene A {} scene B { tune {} } scene C { tune { c, m } }").unwrap();
        let resolved = crate::graph::resolve(&mechanism::expand(&variants[0].graph).unwrap()).unwrap();
        let tuned: Vec<_> = variants[1..]
            .iter()
            .map(|variant| tuned(variant.scene.as_ref().unwrap(), &resolved.parameters).unwrap())
            .collect();
        assert_eq!(tuned, [vec![true; 3], vec![false; 3], vec![true, false, true]]);
    }

    #[test]
    fn only_the_joints_that_a_scene_names_become_rigid() {
        let text = "graph G { ground { point O = [0, 0, 0]; } body a { mass 1; inertia [1, 1, 1]; }
            joint p: spherical (ground.O -> a) { stiffness 1; } joint q: spherical (ground.O -> a) { rigid; }
            scene A { rigid { p } } scene B { rigid joints; } scene C {} }";
        let source = syntax::parse(text.parse().unwrap()).unwrap();
        let rigid: Vec<Vec<bool>> = variants(&source.graphs[0])
            .unwrap()
            .iter()
            .map(|variant| {
                let joints = variant.graph.items.iter();
                joints.filter_map(|item| if let Item::Joint(joint) = item { Some(joint.rigid) } else { None }).collect()
            })
            .collect();
        assert_eq!(rigid, [[false, true], [true, true], [true, true], [false, true]]);
    }

    #[test]
    fn expectations_that_hold_are_silent_and_the_others_speak_at_their_own_words() {
        let scenes = "scene A { expect states = 2; expect planar; } scene B { expect states = 3; expect states = 1; }";
        let variants = of(scenes).unwrap();
        let checked = |variant: &Variant| check(variant.scene.as_ref().unwrap(), &report(variant).unwrap());
        assert!(checked(&variants[1]).is_ok());
        let faults = checked(&variants[2]).unwrap_err();
        let messages: Vec<_> = faults.iter().map(|fault| fault.message.as_str()).collect();
        assert_eq!(
            messages,
            [
                "scene `B` integrates 2 states, not 3: mass.p, spring.q",
                "scene `B` integrates 2 states, not 1: mass.p, spring.q"
            ]
        );
        assert!(faults[0].span.start().column < faults[1].span.start().column);
    }

    #[test]
    fn a_long_list_is_cut() {
        let names: Vec<String> = (0..LISTED + 3).map(|k| format!("s{k}")).collect();
        assert!(list(&names).ends_with("s38, s39 and 3 more"));
        assert_eq!(list(&names[..2]), "s0, s1");
    }
}
