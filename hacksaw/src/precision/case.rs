//! What is measured: the scenes, and the rod out of the plane, each with its stored solution.

use bg_model::parameters::Parameters;
use bg_workbench::precision::case::Case;
use bg_workbench::scenes::scenes;

use super::reference::Reference;
use crate::mechanism::Hacksaw;

/// All cases.
#[must_use]
pub fn cases() -> Vec<Case> {
    let mut cases = Case::of_scenes(&scenes::<Hacksaw>(), 5.0);
    for case in &mut cases {
        case.stored = Some(match case.name.as_str() {
            "rigid" => || Reference::Rigid.load(),
            "free-run" => || Reference::FreeRun.load(),
            _ => || Reference::Paper.load(),
        });
    }
    cases.push(Case {
        name: "full-offset".to_owned(),
        about: "The rod 25 mm out of the plane: 3-D and stiff".to_owned(),
        scene: "full".to_owned(),
        set: vec![("rod_offset", Reference::FullOffset.parameters().get("rod_offset").unwrap_or_default())],
        t_end: 5.0,
        stored: Some(|| Reference::FullOffset.load()),
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
