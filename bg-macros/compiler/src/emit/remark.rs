//! What a build could do without, as a warning of rustc.
//!
//! In: the models of a call. Out: a warning at the name of each graph whose literal model solves for many reactions of
//! rigid joints, where a scene has their bodies in the coordinates of joints. Method: the use of a deprecated constant,
//! the only warning that a macro of stable Rust can give.

use proc_macro2::TokenStream;
use quote::{quote, quote_spanned};

use crate::pipeline::Compiled;
use crate::system::equations::Origin;

/// So many reactions are those of four hinges in space: from there on their matrix, and code for it, take most of a
/// build.
const MANY: usize = 20;

/// The warnings.
#[must_use]
pub fn remarks(models: &[Compiled]) -> TokenStream {
    of_large(models, MANY)
}

/// The warnings of graphs that solve for so many reactions or more.
fn of_large(models: &[Compiled], many: usize) -> TokenStream {
    let with_scenes = models.iter().filter(|model| !model.is_scene && reactions(model) >= many);
    let has_short_one = |model: &&Compiled| {
        let is_of = |scene: &&Compiled| scene.is_scene && model.scenes.contains(&scene.source.name.text);
        models.iter().filter(is_of).any(in_joint_coordinates)
    };
    with_scenes.filter(has_short_one).map(remark).collect()
}

fn reactions(model: &Compiled) -> usize {
    model.equations.solution.multipliers.len()
}

fn in_joint_coordinates(scene: &Compiled) -> bool {
    scene.equations.states.iter().any(|state| matches!(state.origin, Origin::Speed(..)))
}

fn remark(model: &Compiled) -> TokenStream {
    let name = &model.source.name;
    let note = format!(
        "beside its scenes the whole graph `{}` is compiled, with {} reactions of rigid joints in each rate, which \
         takes most of this build; if nobody runs it as it is, write `scenes only;` in the graph",
        name.text,
        reactions(model),
    );
    let used = quote_spanned!(name.span => WHOLE_GRAPH);
    quote! {
        const _: () = {
            #[deprecated(note = #note)]
            const WHOLE_GRAPH: () = ();
            #used
        };
    }
}

#[cfg(test)]
mod tests {
    use std::fmt::Write;

    use super::of_large;

    /// Whether ten reactions are many. A chain of hinges about y and z by turns, in space.
    fn warns(hinges: usize, others: &str) -> bool {
        let mut text = "graph G { gravity [3, -9, 2]; ground { point O = [0, 0, 0]; }".to_owned();
        for k in 0..hinges {
            let upper = if k == 0 { "ground.O".to_owned() } else { format!("b{}.low", k - 1) };
            let axis = ["y", "z"][k % 2];
            let _ = write!(
                text,
                "body b{k} {{ mass 1; inertia [0.1, 0.2, 0.15]; point top = [0, 0, 0.5]; point low = [0.2, 0, -0.5];
                     start top at [{}, 0, {}]; }}
                 joint j{k}: revolute {axis} ({upper} -> b{k}.top) {{ rigid; }}",
                0.2 * k as f64,
                -(k as i64)
            );
        }
        let text = format!("{text} observe {{ a: rad = j0.angle; }} {others} }}");
        let source = crate::source::syntax::parse(text.parse().expect("tokens")).expect("a graph");
        let models = crate::pipeline::models(&source).unwrap_or_else(|_| panic!("{text}"));
        of_large(&models, 10).to_string().contains("write `scenes only;` in the graph")
    }

    #[test]
    fn a_large_graph_beside_its_scene_is_told_of() {
        assert!(warns(2, "scene S {}"));
        assert!(!warns(2, "scenes only; scene S {}"));
        assert!(!warns(2, ""));
        assert!(!warns(1, "scene S {}"));
    }
}
