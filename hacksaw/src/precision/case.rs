//! What is measured: the scenes, and the rod out of the plane, each with its stored solution.

use bg_model::parameters::Parameters;
use bg_workbench::Compiled;
use bg_workbench::precision::case::{Case, CaseSolution};
use bg_workbench::scenes::scenes;

use super::reference::Reference;
use crate::mechanism::Hacksaw;

/// All cases.
#[must_use]
pub fn cases() -> Vec<Case> {
    let paper = CaseSolution::Stored(|| Reference::Paper.load());
    let mut cases = Case::of_scenes(&scenes(&Compiled::<Hacksaw>::new()), 5.0, paper);
    for case in &mut cases {
        match case.name.as_str() {
            "rigid" => case.solution = CaseSolution::Stored(|| Reference::Rigid.load()),
            "free-run" => case.solution = CaseSolution::Stored(|| Reference::FreeRun.load()),
            _ => {}
        }
    }
    cases.push(Case {
        name: "full-offset".to_owned(),
        about: "The rod 25 mm out of the plane: 3-D and stiff".to_owned(),
        scene: "full".to_owned(),
        set: vec![("rod_offset", Reference::FullOffset.parameters().get("rod_offset").unwrap_or_default())],
        t_end: 5.0,
        solution: CaseSolution::Stored(|| Reference::FullOffset.load()),
    });
    cases
}

/// The case called `name`.
///
/// # Panics
/// There is none.
#[must_use]
pub fn case(name: &str) -> Case {
    cases().into_iter().find(|case| case.name == name).unwrap_or_else(|| panic!("there is no case `{name}`"))
}
