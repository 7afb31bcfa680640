//! The mass of a `geom`.

use nalgebra::{Matrix3, Vector3};

use super::defaults::Element;
use super::fitted::{self, Fitted};
use super::scope::Scopes;
use crate::ImportError;
use crate::geometry::Shape;
use crate::robot::{Inertia, Pose, with_z};
use crate::xml::Node;

/// What is known of a shape's mass.
pub struct Massive {
    /// In its body's frame; none where it has no mass.
    pub inertia: Option<Inertia>,
    /// Its principal axes in its body's frame, where its kind says them.
    pub axes: Option<Matrix3<f64>>,
    /// That its mass is not known.
    pub note: Option<String>,
}

/// Density where the file says none, kg/m^3.
const WATER: f64 = 1000.0;

/// Of an element; a note is made where its mass is wanted and not known.
///
/// # Errors
/// Sizes, mass or density that MuJoCo refuses.
pub fn read(element: &Element, scopes: &Scopes, is_wanted: bool) -> Result<Massive, ImportError> {
    let node = element.node;
    let meshes = &scopes.of(node).meshes;
    let mut frame = scopes.pose(element)?;
    let sizes = element.text("size").map(|text| node.list("size", text)).transpose()?.unwrap_or_default();
    let ends = element.text("fromto").map(|text| node.array::<6>("fromto", text)).transpose()?;
    let mass = element.number("mass")?;
    let density = element.number("density")?;
    let is_shell = element.truth("shellinertia")? == Some(true);
    for (name, value) in [("mass", mass), ("density", density)] {
        if let Some(value) = value.filter(|value| *value < 0.0) {
            return Err(node.bad(name, &value.to_string(), "0 or more"));
        }
    }
    let size = |k: usize| sizes.get(k).copied().unwrap_or(0.0);
    let mut half = size(1);
    let mut sides = Vector3::new(size(0), size(1), size(2));
    let kind = element.text("type").unwrap_or(if element.node.peek("mesh").is_some() { "mesh" } else { "sphere" });
    if let Some([a, b, c, d, e, f]) = ends {
        let (from, to) = (Vector3::new(a, b, c), Vector3::new(d, e, f));
        half = (to - from).norm() / 2.0;
        if half < 1e-15 {
            return Err(node.bad("fromto", node.peek("fromto").unwrap_or_default(), "two places that differ"));
        }
        sides = Vector3::new(size(0), size(0), half);
        frame = Pose { turned: with_z(&(from - to)), place: (from + to) / 2.0 };
    }
    let is_massless = mass == Some(0.0) || (mass.is_none() && density == Some(0.0));
    let unknown = |what: &str| {
        let name = named(node);
        let note = format!("{}: shape{name} is {what}: its mass is not known and left out.", node.place);
        Massive { inertia: None, axes: None, note: (is_wanted && !is_massless).then_some(note) }
    };
    let inertia_of = |shape: &Shape| {
        let density = density.unwrap_or(WATER);
        if is_shell { shape.shell(mass, density) } else { Some(shape.inertia(mass, density)) }
    };
    if let Some(name) = element.text("mesh") {
        if ends.is_some() {
            return Err(node.bad("fromto", node.peek("fromto").unwrap_or_default(), "left out where a mesh is given"));
        }
        if is_massless || !is_wanted {
            return Ok(Massive { inertia: None, axes: None, note: None });
        }
        if kind != "mesh" {
            let Some(fitted_kind) = fitted::FittedShape::new(kind) else {
                return Ok(unknown(&format!("a {kind} fitted to a mesh")));
            };
            let scale = element.number("fitscale")?.unwrap_or(1.0);
            if scale <= 0.0 {
                return Err(node.bad("fitscale", &scale.to_string(), "above 0"));
            }
            let Fitted { shape, frame: within, is_unique } = match meshes.fitted(name, fitted_kind, scale) {
                Ok(fitted) => fitted,
                Err(what) => return Ok(unknown(&format!("a {kind} fitted to {what}"))),
            };
            let frame = frame.then(&within);
            let Some(inertia) = inertia_of(&shape) else { return Ok(unknown("a shell of an ellipsoid")) };
            let axes = is_unique.then_some(frame.turned);
            let note = (!is_unique).then(|| {
                let what = "fitted to a mesh with equal moments of inertia: MuJoCo may turn it otherwise";
                format!("{}: shape{} is a {kind} {what}.", node.place, named(node))
            });
            return Ok(Massive { inertia: inertia.map(|inertia| inertia.seen_from(&frame)), axes, note });
        }
        return Ok(match meshes.inertia(name, is_shell) {
            Ok(unit) => {
                let factor = mass.map_or_else(|| density.unwrap_or(WATER), |mass| mass / unit.mass);
                let inertia = Inertia { mass: factor * unit.mass, tensor: factor * unit.tensor, ..unit };
                Massive { inertia: Some(inertia.seen_from(&frame)), axes: None, note: None }
            }
            Err(what) => unknown(&what),
        });
    }
    let (shape, needed) = match kind {
        "sphere" => (Shape::Ellipsoid(Vector3::repeat(size(0))), 1),
        "ellipsoid" => (Shape::Ellipsoid(sides), 3),
        "box" => (Shape::Cuboid(sides), 3),
        "cylinder" => (Shape::Cylinder(size(0), half), 2),
        "capsule" => (Shape::Capsule(size(0), half), 2),
        "plane" | "hfield" => return Ok(Massive { inertia: None, axes: None, note: None }),
        "mesh" | "sdf" => return Ok(unknown(&format!("a {kind}"))),
        other => {
            return Err(node.bad(
                "type",
                other,
                "plane, hfield, sphere, capsule, ellipsoid, cylinder, box, mesh or sdf",
            ));
        }
    };
    let needed = if ends.is_some() { 1 } else { needed };
    if (0..needed).any(|k| size(k) <= 0.0) {
        let wanted = if needed == 1 { "above 0".to_owned() } else { format!("{needed} numbers above 0") };
        return Err(node.bad("size", element.text("size").unwrap_or_default(), &wanted));
    }
    let Some(inertia) = inertia_of(&shape) else { return Ok(unknown("a shell of an ellipsoid")) };
    Ok(Massive { inertia: inertia.map(|inertia| inertia.seen_from(&frame)), axes: Some(frame.turned), note: None })
}

/// A name as it follows a word; nothing where there is none.
fn named(node: &Node) -> String {
    node.peek("name").map(|name| format!(" `{name}`")).unwrap_or_default()
}
