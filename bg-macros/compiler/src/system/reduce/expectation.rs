//! What a scene asks of the equations: which parameters it tunes, and what it expects of the states.
//!
//! In: a scene, the parameters, the report of the reduction. Out: what the reduction is to keep, or faults.

use super::{Fate, Kept, Report, Wanted};
use crate::fault::{Explain, Fault, Staged, near_miss};
use crate::graph::Parameter;
use crate::source::ast::{Expectation, Name, Scene};
use crate::system::equations::StateEquations;

/// What the name of a body's orientation has after the body's.
const ORIENTATION: &str = ".orientation";

/// How many states a message lists.
const LISTED: usize = 40;

/// A fault of what a scene asks.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "each variant's message says what it and its fields are")]
pub enum ExpectationFault {
    UnknownParameter { name: String, near: Option<String> },
    NotPlanar { scene: String, states: Vec<String> },
    StateCount { scene: String, expected: usize, states: Vec<String> },
    AllReactions { scene: String, kept: Kept },
    UnknownBody { name: String, near: Option<String> },
    Independent { name: String, kept: Option<Kept> },
}

use ExpectationFault as F;

impl Explain for ExpectationFault {
    fn code(&self) -> &'static str {
        match self {
            F::UnknownParameter { .. } => "BG0603",
            F::NotPlanar { .. } => "BG0604",
            F::StateCount { .. } => "BG0605",
            F::AllReactions { .. } => "BG0611",
            F::UnknownBody { .. } => "BG0612",
            F::Independent { .. } => "BG0613",
        }
    }

    fn message(&self) -> String {
        match self {
            F::UnknownParameter { name, .. } => format!("there is no parameter `{name}` to tune"),
            F::NotPlanar { scene, states } => {
                format!("scene `{scene}` is not planar: these are not proved constant: {}", list(states))
            }
            F::StateCount { scene, expected, states } => {
                format!("scene `{scene}` integrates {} states, not {expected}: {}", states.len(), list(states))
            }
            F::AllReactions { scene, kept } => {
                format!("scene `{scene}` keeps the reactions of all rigid joints: {kept}")
            }
            F::UnknownBody { name, .. } => format!("there is no body `{name}` to be dependent"),
            F::Independent { name, kept: Some(kept) } => {
                format!("no loop gives the orientation of body `{name}`: {kept}")
            }
            F::Independent { name, kept: None } => format!(
                "no loop gives the orientation of body `{name}`: the gap of no rigid joint that closes a loop is \
                 linear in its cosine and its sine"
            ),
        }
    }

    fn help(&self) -> String {
        match self {
            F::UnknownParameter { near: Some(near), .. } => format!("did you mean `{near}`?"),
            F::UnknownParameter { .. } => "name a parameter of the graph".to_owned(),
            F::NotPlanar { .. } => {
                "find what moves them: a tuned parameter out of the plane, a start value, a force".to_owned()
            }
            F::StateCount { .. } => "correct the number, or what the scene watches and tunes".to_owned(),
            F::UnknownBody { near: Some(near), .. } => format!("did you mean `{near}`?"),
            F::UnknownBody { .. } => "name a body of the graph".to_owned(),
            F::Independent { .. } => "name bodies that turn between two others in a closed loop, \
                 all that it gives, as in `dependent coupler, rocker;`. Without it the loop is closed by projection"
                .to_owned(),
            F::AllReactions { kept, .. } => match kept {
                Kept::Asked => "leave out `all reactions;`".to_owned(),
                Kept::NothingRigid => "make joints rigid: `rigid joints;`".to_owned(),
                Kept::Baumgarte => "leave out `baumgarte`: joints are closed by projection then".to_owned(),
                Kept::Start(_) => {
                    "make its start velocities guesses, or give those of both bodies so that they fit".to_owned()
                }
                Kept::Shared => "do not observe forces and moments of rigid joints in this scene".to_owned(),
                _ => "leave out `expect independent speeds;`: results are the same with all reactions".to_owned(),
            },
        }
    }
}

fn list(states: &[String]) -> String {
    let more = states.len().saturating_sub(LISTED);
    let text = states[..states.len().min(LISTED)].join(", ");
    if more == 0 { text } else { format!("{text} and {more} more") }
}

/// What the reduction is to keep for the scene.
///
/// # Errors
/// Names to tune that are no parameters, dependent bodies that there are not.
pub fn wanted(scene: &Scene, equations: &StateEquations) -> Staged<Wanted> {
    let unknown = unknown_bodies(scene, &equations.tracks);
    let tuned = match tuned(scene, &equations.parameters) {
        Ok(tuned) if unknown.is_empty() => tuned,
        others => return Err(others.err().unwrap_or_default().into_iter().chain(unknown).collect()),
    };
    let links = scene.dependent.iter().map(orientation).collect();
    Ok(Wanted { tuned, angles: scene.angles, speeds: !scene.all_reactions, links })
}

/// The name of a body's orientation.
fn orientation(body: &Name) -> String {
    format!("{}{ORIENTATION}", body.text)
}

/// The dependent bodies that have no orientation.
fn unknown_bodies(scene: &Scene, tracks: &[String]) -> Vec<Fault> {
    let bodies = || tracks.iter().filter_map(|track| track.strip_suffix(ORIENTATION));
    let unknown = scene.dependent.iter().filter(|name| bodies().all(|body| body != name.text));
    unknown
        .map(|name| {
            let near = near_miss(&name.text, bodies()).map(str::to_owned);
            Fault::new(name.span, &F::UnknownBody { name: name.text.clone(), near })
        })
        .collect()
}

/// For each parameter whether the scene tunes it.
fn tuned(scene: &Scene, parameters: &[Parameter]) -> Staged<Vec<bool>> {
    let known = || parameters.iter().map(|parameter| parameter.name.text.as_str());
    let named = scene.tune.names().iter();
    let faults: Vec<Fault> = named
        .filter(|name| known().all(|parameter| parameter != name.text))
        .map(|name| {
            let near = near_miss(&name.text, known()).map(str::to_owned);
            Fault::new(name.span, &F::UnknownParameter { name: name.text.clone(), near })
        })
        .collect();
    if faults.is_empty() { Ok(known().map(|parameter| scene.tune.keeps(parameter)).collect()) } else { Err(faults) }
}

/// What the scene asserts of its reduction.
///
/// # Errors
/// An assertion that does not hold, with the states that break it.
pub fn check(scene: &Scene, report: &Report) -> Staged<()> {
    let name = &scene.name.text;
    let mut faults = Vec::new();
    for body in &scene.dependent {
        if !report.closed.contains(&orientation(body)) {
            let fault = F::Independent { name: body.text.clone(), kept: report.kept.clone() };
            faults.push(Fault::new(body.span, &fault));
        }
    }
    for expectation in &scene.expect {
        match expectation {
            // The graph's strokes have been checked.
            Expectation::IntegralCausality => {}
            Expectation::Planar(span) => {
                let states = out_of_plane(report);
                if !states.is_empty() {
                    faults.push(Fault::new(*span, &F::NotPlanar { scene: name.clone(), states }));
                }
            }
            Expectation::IndependentSpeeds(span) => {
                // Without reactions the reduction has not looked.
                let is_expressed = report.fates.iter().any(|(_, fate)| matches!(fate, Fate::Joined(_)));
                if !is_expressed {
                    let kept = report.kept.clone().unwrap_or(Kept::NothingRigid);
                    faults.push(Fault::new(*span, &F::AllReactions { scene: name.clone(), kept }));
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

/// The pose components out of a coordinate plane that are not proved constant: of that for which they are fewest, of
/// several the first of x-y, y-z and z-x.
pub(super) fn out_of_plane(report: &Report) -> Vec<String> {
    let moves = |fate: &Fate| !matches!(fate, Fate::Constant(_));
    let out_of = |normal: usize| -> Vec<String> {
        let fates = report.fates.iter().filter(|(state, fate)| moves(fate) && state.origin.leaves_plane(normal));
        fates.map(|(state, _)| state.name.clone()).collect()
    };
    [2, 0, 1].map(out_of).into_iter().min_by_key(Vec::len).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pipeline;
    use crate::source::scene::{Variant, variants};
    use crate::source::syntax;
    use crate::system::reduce;

    const GRAPH: &str = "graph G {
            param m: kg = 2; param k: N/m = 3; param c: N*s/m = 1;
            1 j: translation; I mass = m start 1; C spring = k; R damper = c;
            0 between: translation; j -> mass; j -> spring; j -> between -> damper;
            observe { v: m/s = j.flow; }
            SCENES
        }";

    /// The literal graph and the scenes.
    fn of(scenes: &str) -> Vec<Variant> {
        let source = syntax::parse(GRAPH.replace("SCENES", scenes).parse().expect("tokens")).expect("a graph");
        variants(&source.graphs[0]).expect("scenes")
    }

    fn scene(variant: &Variant) -> &Scene {
        variant.scene.as_ref().expect("a scene")
    }

    fn report(variant: &Variant) -> Report {
        let equations = pipeline::derive(&variant.graph).expect("equations").equations;
        let wanted = wanted(scene(variant), &equations).expect("parameters");
        reduce::for_scene(equations, &wanted, false, &mut |_| 0).1
    }

    #[test]
    fn without_tune_all_parameters_are_tuned_and_with_an_empty_one_none() {
        let variants = of("scene A {} scene B { tune {} } scene C { tune { c, m } }");
        let parameters = pipeline::derive(&variants[0].graph).expect("equations").equations.parameters;
        let tuned: Vec<_> = variants[1..].iter().map(|variant| tuned(scene(variant), &parameters).unwrap()).collect();
        assert_eq!(tuned, [vec![true; 3], vec![false; 3], vec![true, false, true]]);
    }

    #[test]
    fn expectations_that_hold_are_silent_and_the_others_speak_at_their_own_words() {
        let scenes = "scene A { expect states = 2; expect planar; } scene B { expect states = 3; expect states = 1; }";
        let variants = of(scenes);
        let checked = |variant: &Variant| check(scene(variant), &report(variant));
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

    /// Two bodies of this tensor on hinges about these axes, one below the other in y or z, which gravity pulls aside.
    fn hinges(axes: [&str; 2], gravity: &str, (rigid, inertia): (&str, &str)) -> Vec<Variant> {
        let at = |height: f64| if axes[0] == "z" { format!("[0, {height}, 0]") } else { format!("[0, 0, {height}]") };
        let (top, low, second) = (at(0.5), at(-0.5), at(-1.0));
        let text = format!(
            "graph G {{
                gravity {gravity}; ground {{ point O = [0, 0, 0]; }}
                body a {{ mass 1; inertia {inertia}; point top = {top}; point low = {low}; start top at [0, 0, 0]; }}
                body b {{ mass 1; inertia {inertia}; point top = {top}; start top at {second}; }}
                joint i: revolute {} (ground.O -> a.top) {{ {rigid} }}
                joint j: revolute {} (a.low -> b.top) {{ {rigid} }}
                observe {{ b.position; }}
                scene A {{ tune {{}} expect planar; }}
            }}",
            axes[0], axes[1]
        );
        let source = syntax::parse(text.parse().expect("tokens")).expect("a graph");
        variants(&source.graphs[0]).expect("scenes")
    }

    #[test]
    fn a_plane_may_be_any_of_three() {
        let fault = |axes, gravity, rigid, inertia| {
            let variant = hinges(axes, gravity, (rigid, inertia)).remove(1);
            let equations = pipeline::derive(&variant.graph).expect("equations").equations;
            let wanted = wanted(scene(&variant), &equations).expect("parameters");
            let report = reduce::for_scene(equations, &wanted, false, &mut crate::program::rate_operations).1;
            check(scene(&variant), &report).err().map(|faults| faults[0].message.clone())
        };
        let (axes, uneven) = ("[0.1, 0.2, 0.3]", "[[0.1, 0.01, 0.02], [0.01, 0.2, -0.03], [0.02, -0.03, 0.25]]");
        for rigid in ["rigid;", "stiffness 1e5; tilt stiffness 1e3;"] {
            for (axis, gravity) in [("x", "[0, 2, -9]"), ("y", "[3, 0, -9]"), ("z", "[3, 2, 0]")] {
                assert_eq!(fault([axis, axis], gravity, rigid, axes), None, "{axis} {rigid}");
                // Rigid hinges hold what products of inertia ask for; others give way.
                let is_planar = fault([axis, axis], gravity, rigid, uneven).is_none();
                assert_eq!(is_planar, rigid == "rigid;", "{axis} {rigid}");
            }
            let message = fault(["y", "x"], "[3, 2, -9]", rigid, axes).expect("it moves in space");
            assert!(message.contains("is not planar: these are not proved constant: "), "{message}");
        }
    }

    #[test]
    fn a_long_list_is_cut() {
        let names: Vec<String> = (0..LISTED + 3).map(|k| format!("s{k}")).collect();
        assert!(list(&names).ends_with("s38, s39 and 3 more"));
        assert_eq!(list(&names[..2]), "s0, s1");
    }
}
