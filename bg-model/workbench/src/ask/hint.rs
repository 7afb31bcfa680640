//! What `auto` is to begin with: a method, by its name or by what a run before was made by.
//!
//! In: a name, or the path of a `summary.json`. Out: the method, or what is wrong, as a sentence.

use std::path::Path;

use bg_model::integrator::Integrator;

/// The method that is named, or that made the longest part of the run of the `summary.json` at this path.
///
/// # Errors
/// It is none that `auto` chooses among, or the file cannot be read or tells of none.
pub fn read(text: &str) -> Result<Integrator, String> {
    let them = || Integrator::OF_AUTO.map(Integrator::name).join(", ");
    let of_auto = |method: Integrator| Integrator::OF_AUTO.contains(&method).then_some(method);
    if let Ok(method) = text.parse() {
        return of_auto(method).ok_or_else(|| format!("auto does not choose it; give one of {}", them()));
    }
    if !Path::new(text).extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json")) {
        return Err(format!("give one of {}, or the summary.json of a run by auto", them()));
    }
    let json = std::fs::read_to_string(text).map_err(|fault| format!("cannot be read: {fault}"))?;
    let json: serde_json::Value =
        serde_json::from_str(&json).map_err(|fault| format!("is no JSON: {fault}; give the summary.json of a run"))?;
    let hint = json.get("hint").and_then(|hint| hint.as_str()?.parse().ok()).and_then(of_auto);
    hint.ok_or_else(|| "has no `hint`; give the summary.json of a run by auto".to_owned())
}
