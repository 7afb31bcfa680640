//! The stages in their order, each named once.
//!
//! In: the tree of a macro call. Out: a [`Compiled`] for every model: the literal graph and each of its scenes. Code is
//! made of it by [`crate::emit`], text by [`crate::stages`]; both only read it, so what is printed is what is emitted.
//!
//! Every stage raises all its faults at once; a later stage sees only what an earlier one accepted.

use crate::fault::{Faults, Staged};
use crate::graph;
use crate::graph::causality::{self, CausalGraph};
use crate::program::elimination::{self, Elimination};
use crate::program::{self, Counts, Deferred, Programs, deferred};
use crate::source::ast::{Graph, Item, Name, Scene, Source};
use crate::source::part::{self, Flattened};
use crate::source::scene::{self, Variant};
use crate::source::{mechanism, names};
use crate::system::equations::stage::{Closed, Ordered, Solved};
use crate::system::equations::{self, StateEquations};
use crate::system::jacobian::{self, Jacobian};
use crate::system::projection;
use crate::system::reduce::{self, Report, expectation};
use crate::system::second_order::{self, SecondOrder};
use crate::system::sizes::{self, Sizes};

/// A graph's results as far as its state equations.
#[derive(Debug)]
pub struct Derived {
    /// The graph in bond-graph words.
    pub expanded: Graph,
    /// The resolved graph with its causal strokes.
    pub causal: CausalGraph,
    /// The state equations of the whole graph.
    pub equations: StateEquations,
}

/// A model's results as far as the state equations that it integrates.
#[derive(Debug)]
pub struct Arranged {
    /// Those of the whole graph.
    pub derived: Derived,
    /// What became of its states; none of a literal graph, which keeps them all.
    pub reduction: Option<Report>,
    /// The state equations that the model integrates.
    pub equations: Ordered,
}

/// Every result of the stages of one model.
#[derive(Debug)]
pub struct Compiled {
    /// The graph as written, with what its scene changes.
    pub source: Graph,
    /// Whether it is a scene.
    pub is_scene: bool,
    /// Whether its structs are those of its graph: it is no scene, or the first one of `scenes only`.
    pub stands_for_graph: bool,
    /// The other models of the graph, where this one stands for the graph.
    pub scenes: Vec<String>,
    /// Its results as far as the state equations of the whole graph.
    pub derived: Derived,
    /// What became of its states; none of a literal graph, which keeps them all.
    pub reduction: Option<Report>,
    /// The state equations that the model integrates.
    pub equations: Closed,
    /// The derivatives of the rates.
    pub jacobian: Jacobian,
    /// The states of second order.
    pub second_order: SecondOrder,
    /// How large the states of storages are beside the energy.
    pub sizes: Sizes,
    /// How I - c J is factored and solved.
    pub elimination: Deferred<Elimination>,
    /// What every generated function evaluates, in order.
    pub programs: Programs,
}

/// What is known of a model of a graph.
#[derive(Debug)]
pub enum Known {
    /// Everything.
    Model(Box<Compiled>),
    /// Of a literal graph that is not wanted, as far as its state equations, and the names of its scenes.
    Graph(Box<Derived>, Vec<String>),
}

/// All models of a macro call. With `scenes only;` the literal graph is none: its stages end with the state equations.
/// A fault of a literal graph is not repeated for its scenes, one of a part not for its uses.
///
/// # Errors
/// The faults of all parts and graphs.
pub fn models(source: &Source) -> Staged<Vec<Compiled>> {
    let known = models_where(source, &|_| true)?.into_iter();
    let compiled = known.filter_map(|known| if let Known::Model(model) = known { Some(*model) } else { None });
    Ok(compiled.collect())
}

/// The same of the models of these names alone, of each graph the first one where none is wanted: scenes that are not
/// wanted are not looked at, the stages of a literal graph that is not wanted end with the state equations. What comes
/// first of a graph has the names of all its scenes.
///
/// # Errors
/// As [`models`].
pub fn models_where(source: &Source, is_wanted: &dyn Fn(&str) -> bool) -> Staged<Vec<Known>> {
    let flattened = part::flatten(source)?;
    let of = |variant: &Variant, is_wanted: bool| {
        if !is_wanted {
            let derived = derive(&variant.graph)?;
            return Ok((Known::Graph(Box::new(derived), variant.scenes.clone()), Vec::new()));
        }
        let model = compile(variant)?;
        let adjustable = adjustable(&model.equations);
        Ok((Known::Model(Box::new(model)), adjustable))
    };
    of_graphs(&flattened, is_wanted, &of).map_err(|faults| flattened.told(faults))
}

/// The graphs of a macro call, each with the number of its models, where none of these has a fault: of each as much is
/// made as may have one.
///
/// # Errors
/// As [`models`].
pub fn check(source: &Source) -> Staged<Vec<(String, usize)>> {
    let flattened = part::flatten(source)?;
    let of = |variant: &Variant, _: bool| {
        let equations = derive(&variant.graph)?.equations;
        // A literal graph has none that come later.
        let Some(scene) = &variant.scene else { return Ok(((), Vec::new())) };
        let (equations, _) = reduced(scene, equations, false)?;
        Ok(((), adjustable(&equations)))
    };
    of_graphs(&flattened, &|_| true, &of).map_err(|faults| flattened.told(faults))?;
    let models = |graph: &Graph| {
        let scenes = graph.items.iter().filter(|item| matches!(item, Item::Scene(_))).count();
        (graph.name.text.clone(), scenes + usize::from(!scene::scenes_only(graph)))
    };
    Ok(flattened.source.graphs.iter().map(models).collect())
}

impl Compiled {
    /// The functions of the running model with their operations.
    #[must_use]
    pub fn costs(&self) -> Vec<(&str, Counts)> {
        let routines = self.programs.costs();
        let factored = ("eliminate", self.elimination.factorisation_counts());
        let solved = ("substitute", self.elimination.substitution_counts());
        routines.chain([factored, solved]).collect()
    }
}

/// The names of the parameters that a model of these equations keeps adjustable.
fn adjustable(equations: &StateEquations) -> Vec<String> {
    equations.parameters.iter().map(|parameter| parameter.name.text.clone()).collect()
}

/// The stages of a model as far as is asked, with what [`adjustable`] gives of it; whether the model is wanted.
type Stages<'a, T> = dyn Fn(&Variant, bool) -> Staged<(T, Vec<String>)> + 'a;

fn of_graphs<T>(flattened: &Flattened, is_wanted: &dyn Fn(&str) -> bool, stages: &Stages<'_, T>) -> Staged<Vec<T>> {
    let mut models = Vec::new();
    let mut faults = names::check(&flattened.source).err().unwrap_or_default();
    flattened.unused.iter().for_each(|part| faults.extend(of_part(part)));
    for graph in &flattened.source.graphs {
        match scene::variants(graph) {
            Ok(variants) => {
                let scenes_only = scene::scenes_only(graph);
                let mut wanted: Vec<bool> = variants.iter().map(|of| is_wanted(&of.graph.name.text)).collect();
                // With `scenes only;` the first scene stands for the graph.
                if scenes_only || !wanted.contains(&true) {
                    wanted[usize::from(scenes_only)] = true;
                }
                let (found, faulty) = each_variant(&variants, &wanted, scenes_only, stages);
                models.extend(found);
                faults.extend(faulty);
            }
            Err(found) => faults.extend(found),
        }
    }
    if faults.is_empty() {
        faults.extend(flattened.unused_parameters.iter().cloned());
    }
    if faults.is_empty() { Ok(models) } else { Err(faults) }
}

/// The faults of names, shapes and units of a part that no graph uses. What its user bonds to it is not there, so that
/// faults of bonds count for nothing.
fn of_part(part: &Graph) -> Faults {
    let resolved = mechanism::expand(part).and_then(|expanded| graph::resolve(&expanded));
    let mut faults = resolved.err().unwrap_or_default();
    faults.retain(|fault| !graph::OF_BONDS.contains(&fault.code));
    faults
}

/// The models of a graph, and their faults. A fault of the literal graph is that of its scenes, too.
fn each_variant<T>(
    variants: &[Variant],
    wanted: &[bool],
    scenes_only: bool,
    stages: &Stages<'_, T>,
) -> (Vec<T>, Faults) {
    let (mut models, mut faults) = (Vec::new(), Faults::new());
    let mut adjustable: Vec<(&Name, Vec<String>)> = Vec::new();
    for (variant, &is_wanted) in variants.iter().zip(wanted) {
        let made = match variant.scene {
            None if scenes_only => derive(&variant.graph).map(|_| None),
            Some(_) if !is_wanted => Ok(None),
            _ => stages(variant, is_wanted).map(Some),
        };
        match made {
            Ok(None) => {}
            Ok(Some((model, parameters))) => {
                models.push(model);
                adjustable.push((&variant.graph.name, parameters));
            }
            Err(found) => {
                faults.extend(found);
                if variant.scene.is_none() {
                    return (models, faults);
                }
            }
        }
    }
    if scenes_only && let Some((first, others)) = adjustable.split_first() {
        faults.extend(others.iter().filter_map(|other| scene::adjusts_more(other, first)));
    }
    (models, faults)
}

/// The stages of one graph without scenes, as far as its state equations.
///
/// # Errors
/// The faults of the first stage that has any.
pub fn derive(graph: &Graph) -> Staged<Derived> {
    let expanded = mechanism::expand(graph)?;
    let causal = causality::assign(graph::resolve(&expanded)?)?;
    let equations = equations::derive(&causal)?;
    Ok(Derived { expanded, causal, equations })
}

/// The stages of one model as far as the state equations that it integrates.
///
/// # Errors
/// The faults of the first stage that has any.
pub fn arrange(variant: &Variant) -> Staged<Arranged> {
    let derived = derive(&variant.graph)?;
    let equations = derived.equations.clone();
    let (solved, reduction) = match &variant.scene {
        Some(scene) => {
            let (solved, report) = reduced(scene, equations, true)?;
            (solved, Some(report))
        }
        None => (reduce::literal(equations), None),
    };
    let equations = second_order::order(projection::complete(solved));
    Ok(Arranged { derived, reduction, equations })
}

/// All stages of one model.
///
/// # Errors
/// The faults of the first stage that has any.
pub fn compile(variant: &Variant) -> Staged<Compiled> {
    let (source, is_scene, scenes) = (variant.graph.clone(), variant.scene.is_some(), variant.scenes.clone());
    let Arranged { derived, reduction, equations } = arrange(variant)?;
    let jacobian = jacobian::differentiate(&equations);
    let mut equations = Ordered::close(equations);
    let second_order = second_order::differentiate(&equations);
    let elimination = {
        let (states, unknowns, late) = (equations.states.len(), jacobian.unknowns.len(), jacobian.late);
        let places = jacobian.places();
        deferred(move || elimination::plan(states, unknowns, late, &places))
    };
    let mut sizes = sizes::differentiate(&equations);
    let programs = program::programs(&mut equations, &jacobian, &second_order, &mut sizes);
    Ok(Compiled {
        source,
        is_scene,
        stands_for_graph: variant.stands_for_graph,
        scenes,
        derived,
        reduction,
        equations,
        jacobian,
        second_order,
        sizes,
        elimination,
        programs,
    })
}

/// The equations reduced to what a scene needs, with the report of it; whether that is to have the operations of a rate
/// after each reduction.
fn reduced(scene: &Scene, equations: StateEquations, is_counted: bool) -> Staged<(Solved, Report)> {
    let wanted = expectation::wanted(scene, &equations)?;
    let (mut solved, report) = reduce::for_scene(equations, &wanted, is_counted, &mut program::rate_operations);
    expectation::check(scene, &report)?;
    solved.decide_requirements()?;
    Ok((solved, report))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::source::syntax;

    const GRAPH: &str = "graph G { param m: kg = 2; param k: N/m = 3;
        1 j: translation; I mass = m start 1; C spring = k; j -> mass; j -> spring;
        observe { v: m/s = j.flow; } ";

    fn source(rest: &str) -> Source {
        syntax::parse(format!("{GRAPH} {rest} }}").parse().expect("tokens")).expect("syntax")
    }

    #[test]
    fn a_check_counts_models() {
        let checked = |rest: &str| check(&source(rest)).expect("no faults");
        assert_eq!(checked(""), [("G".to_owned(), 1)]);
        assert_eq!(checked("scene A {} scene B { tune { m } }"), [("G".to_owned(), 3)]);
        assert_eq!(checked("scenes only; scene A {} scene B { tune { m } }"), [("G".to_owned(), 2)]);
    }

    #[test]
    fn a_check_finds_the_faults_of_a_compilation() {
        let faulty = [
            "scene A { expect states = 5; } scene B { expect states = 1; }",
            "scene A { tune { mm } }",
            "scene A { observe { x: m = spring.effort; } }",
            "scenes only; scene A { tune { m } } scene B {}",
            "scene A {} scene A {}",
            "R broken = 2; scene A { expect states = 5; }",
        ];
        for rest in faulty {
            let text = |faults: Faults| faults.iter().map(ToString::to_string).collect::<Vec<_>>();
            let checked = text(check(&source(rest)).expect_err(rest));
            assert_eq!(checked, text(models(&source(rest)).expect_err(rest)), "{rest}");
        }
    }
}
