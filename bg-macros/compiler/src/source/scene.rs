//! Scenes: the uses of one mechanism, each a graph of its own.
//!
//! In: one `ast::Graph` with scenes. Out: the literal graph, and for each scene the graph without what it leaves out
//! and with what it watches. No longer occurs: `Item::Scene`, `Item::ScenesOnly`.

use crate::fault::{Explain, Fault, Staged, near_miss};
use crate::source::ast::{ElementKind, Expectation, Graph, Item, Name, Rigid, Scene};
use crate::source::drawing::Drawing;

/// A fault of a scene.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "each variant's message says what it and its fields are")]
pub enum SceneFault {
    NothingToLeaveOut { name: String, near: Option<String> },
    UnknownJoint { name: String, near: Option<String> },
    NothingRigid,
    NoScene,
    AdjustsMore { scene: String, name: String, first: String },
}

use SceneFault as F;

impl Explain for SceneFault {
    fn code(&self) -> &'static str {
        match self {
            F::NothingToLeaveOut { .. } => "BG0602",
            F::UnknownJoint { .. } => "BG0606",
            F::NothingRigid => "BG0608",
            F::NoScene => "BG0609",
            F::AdjustsMore { .. } => "BG0610",
        }
    }

    fn message(&self) -> String {
        match self {
            F::NothingToLeaveOut { name, .. } => format!("there is no `{name}` to leave out"),
            F::UnknownJoint { name, .. } => format!("there is no joint `{name}` to make rigid"),
            F::NothingRigid => "`start impulse` has nothing to act through: no joint is rigid, in no scene".to_owned(),
            F::NoScene => "`scenes only;` leaves nothing to compile: the graph has no scene".to_owned(),
            F::AdjustsMore { scene, name, first } => {
                format!("scene `{scene}` keeps the parameter `{name}` adjustable, the first scene, `{first}`, does not")
            }
        }
    }

    fn help(&self) -> String {
        match self {
            F::NothingToLeaveOut { near: Some(near), .. } | F::UnknownJoint { near: Some(near), .. } => {
                format!("did you mean `{near}`?")
            }
            F::NothingToLeaveOut { .. } => "name a joint, contact, spring, drive, friction, stop or element".to_owned(),
            F::UnknownJoint { .. } => "name a joint of the graph, or write `rigid joints;`".to_owned(),
            F::NothingRigid => "remove it, or make a joint rigid".to_owned(),
            F::NoScene => "remove it, or add a scene: `scene NAME { }`".to_owned(),
            F::AdjustsMore { name, first, .. } => format!(
                "with `scenes only;` the first scene stands for the graph: add `{name}` to `tune` of `{first}`, or put \
                 a scene first that keeps them all"
            ),
        }
    }
}

/// A model to compile: the literal graph, or the graph of a scene.
#[derive(Clone, Debug)]
pub struct Variant {
    /// The graph under the model's name, without scenes.
    pub graph: Graph,
    /// The scene; none for the literal graph.
    pub scene: Option<Scene>,
    /// Whether it stands for the graph: the literal one does, or with `scenes only;` the first scene.
    pub stands_for_graph: bool,
    /// The names of the other models of the graph, where this one stands for the graph.
    pub scenes: Vec<String>,
}

/// Whether the graph has the statement `scenes only;`: no model is made of the literal graph.
#[must_use]
pub fn scenes_only(source: &Graph) -> bool {
    source.items.iter().any(|item| matches!(item, Item::ScenesOnly(_)))
}

/// The literal graph and one variant for each scene.
///
/// # Errors
/// Things to leave out that there are not.
pub fn variants(source: &Graph) -> Staged<Vec<Variant>> {
    let mut faults = Vec::new();
    let is_of_scenes = |item: &Item| matches!(item, Item::Scene(_) | Item::ScenesOnly(_));
    let items: Vec<Item> = source.items.iter().filter(|item| !is_of_scenes(item)).cloned().collect();
    let literal = Graph { items, ..source.clone() };
    let named =
        source.items.iter().filter_map(|item| if let Item::Scene(scene) = item { Some(&scene.name) } else { None });
    let scenes = named.map(|name| name.text.clone()).collect();
    let scenes_only = scenes_only(source);
    let mut variants = vec![Variant { graph: literal.clone(), scene: None, stands_for_graph: !scenes_only, scenes }];
    faults.extend(idle_impulse(source));
    faults.extend(no_scene(source));
    for item in &source.items {
        let Item::Scene(scene) = item else { continue };
        let mut items = left(&literal.items, &scene.without, &mut faults);
        stiffen(&mut items, &scene.rigid, &mut faults);
        let graph = watched(&literal, items, scene);
        variants.push(Variant { graph, scene: Some(scene.clone()), stands_for_graph: false, scenes: Vec::new() });
    }
    if scenes_only && let [_, first, others @ ..] = variants.as_mut_slice() {
        first.stands_for_graph = true;
        first.scenes = others.iter().map(|other| other.graph.name.text.clone()).collect();
    }
    if faults.is_empty() { Ok(variants) } else { Err(faults) }
}

/// The fault of a `scenes only` in a graph without scenes.
fn no_scene(source: &Graph) -> Option<Fault> {
    let span =
        source.items.iter().find_map(|item| if let Item::ScenesOnly(span) = item { Some(*span) } else { None })?;
    (!source.items.iter().any(|item| matches!(item, Item::Scene(_)))).then(|| Fault::new(span, &F::NoScene))
}

/// The fault of a model that keeps a parameter adjustable which the first one does not: each with its name and
/// parameters.
#[must_use]
pub fn adjusts_more((scene, own): &(&Name, Vec<String>), (first, of_first): &(&Name, Vec<String>)) -> Option<Fault> {
    let name = own.iter().find(|name| !of_first.contains(name))?.clone();
    let (own, first) = (scene.text.clone(), first.text.clone());
    Some(Fault::new(scene.span, &F::AdjustsMore { scene: own, name, first }))
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

/// The scene's graph: its observations in place of the graph's, if it has any, and what it expects of the strokes.
fn watched(literal: &Graph, mut items: Vec<Item>, scene: &Scene) -> Graph {
    if !scene.observe.is_empty() {
        items.retain(|item| !matches!(item, Item::Observe(_)));
        items.push(Item::Observe(scene.observe.clone()));
    }
    if scene.expect.iter().any(|expected| matches!(expected, Expectation::IntegralCausality)) {
        items.push(Item::IntegralCausality);
    }
    let docs = if scene.docs.is_empty() { literal.docs.clone() } else { scene.docs.clone() };
    Graph { docs, visibility: literal.visibility.clone(), name: scene.name.clone(), items, drawing: Drawing::default() }
}

/// The items without some parts and the bonds that end at them.
fn left(items: &[Item], without: &[Name], faults: &mut Vec<Fault>) -> Vec<Item> {
    for name in without {
        let parts = || items.iter().filter_map(part_name);
        if parts().all(|part| part.text != name.text) {
            let near = near_miss(&name.text, parts().map(|part| part.text.as_str())).map(str::to_owned);
            faults.push(Fault::new(name.span, &F::NothingToLeaveOut { name: name.text.clone(), near }));
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
        Item::ShapeContact(contact) => Some(&contact.name),
        Item::Spring(spring) => Some(&spring.name),
        Item::Drive(drive) => Some(&drive.name),
        Item::Friction(friction) => Some(&friction.name),
        Item::Stop(stop) => Some(&stop.name),
        Item::Orifice(orifice) => Some(&orifice.name),
        Item::Element(element) => Some(&element.name),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::syntax;
    use crate::source::visibility::Visibility;

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
        assert!(variants.iter().all(|variant| matches!(variant.graph.visibility, Visibility::Public(_))));
    }

    #[test]
    fn with_scenes_only_the_first_scene_has_the_others() {
        let variants = of("scene A {} scenes only; scene B {} scene G {}").unwrap();
        let scenes: Vec<_> = variants.iter().map(|variant| variant.scenes.join(" ")).collect();
        assert_eq!(scenes, ["A B G", "B G", "", ""]);
        let stands = |text: &str| of(text).unwrap().iter().position(|variant| variant.stands_for_graph);
        assert_eq!([stands("scene A {} scenes only;"), stands("scene A {}")], [Some(1), Some(0)]);
        assert!(variants.iter().all(|v| v.graph.items.iter().all(|item| !matches!(item, Item::ScenesOnly(_)))));
        let faults = of("scenes only;").unwrap_err();
        assert_eq!(faults.iter().map(|fault| fault.code).collect::<Vec<_>>(), ["BG0609"]);
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
}
