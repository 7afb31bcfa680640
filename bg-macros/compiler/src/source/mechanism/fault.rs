//! What can be wrong with bodies, joints and their like.

use crate::fault::Explain;

/// A fault of the expansion.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "each variant's message says what it and its fields are")]
pub enum MechanismFault {
    UnknownBody { name: String, near: Option<String> },
    UnknownPoint { body: String, point: String, known: Vec<String>, near: Option<String> },
    MissingClause { word: &'static str, name: String, clause: &'static str, why: &'static str },
    SuperfluousClause { word: &'static str, name: String, clause: &'static str, why: &'static str },
    NoMass { name: String },
    MassTwice { name: String },
    Twice { word: &'static str },
    UnknownTarget { name: String, near: Option<String> },
    WrongDrive { drive: &'static str, target: String, takes: Takes },
    SameBody { name: String, body: String },
    SameAxes { name: String },
    NoLaw { name: String },
    NoFreeAxis { word: &'static str, name: String, target: String },
    RestitutionAnd { name: String, clause: &'static str },
    InSpace { word: &'static str, name: String, target: String },
    ShapesApart { name: String, one: &'static str, other: &'static str },
    Thin { name: String, word: &'static str },
    LineAcross { name: String },
    UnknownTable { name: String, near: Option<String> },
    RoughProfile { table: String, contact: String },
    OpenProfile { table: String, contact: String },
}

/// What a drive on a target has to be.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Takes {
    /// A torque.
    Torque,
    /// A force.
    Force,
    /// Nothing drives it.
    Nothing,
}

use MechanismFault as F;

impl Explain for MechanismFault {
    fn code(&self) -> &'static str {
        match self {
            F::UnknownBody { .. } => "BG0201",
            F::UnknownPoint { .. } => "BG0202",
            F::MissingClause { .. } => "BG0203",
            F::SuperfluousClause { .. } => "BG0204",
            F::NoMass { .. } => "BG0205",
            F::MassTwice { .. } => "BG0206",
            F::Twice { .. } => "BG0207",
            F::UnknownTarget { .. } => "BG0208",
            F::WrongDrive { .. } => "BG0209",
            F::SameBody { .. } => "BG0210",
            F::SameAxes { .. } => "BG0211",
            F::NoLaw { .. } => "BG0212",
            F::NoFreeAxis { .. } | F::InSpace { .. } => "BG0213",
            F::RestitutionAnd { .. } => "BG0214",
            F::ShapesApart { .. } | F::Thin { .. } => "BG0231",
            F::LineAcross { .. } => "BG0232",
            F::UnknownTable { .. } => "BG0233",
            F::RoughProfile { .. } | F::OpenProfile { .. } => "BG0234",
        }
    }

    fn message(&self) -> String {
        match self {
            F::UnknownBody { name, .. } => format!("there is no body `{name}`"),
            F::UnknownPoint { body, point, .. } => format!("`{body}` has no point `{point}`"),
            F::MissingClause { word, name, clause, why } => format!("{word} `{name}` has no `{clause}`: {why}"),
            F::SuperfluousClause { word, name, clause, why } => {
                format!("{word} `{name}` cannot have `{clause}`: {why}")
            }
            F::NoMass { name } => format!("body `{name}` has no mass"),
            F::MassTwice { name } => format!("body `{name}` has both solids and given mass properties"),
            F::Twice { word } => format!("`{word}` is given twice"),
            F::UnknownTarget { name, .. } => format!("there is no joint, body or point `{name}` to drive"),
            F::WrongDrive { drive, target, .. } => format!("a {drive} cannot drive `{target}`"),
            F::SameBody { name, body } => format!("both ends of `{name}` are on `{body}`"),
            F::SameAxes { name } => format!("the two axes of joint `{name}` are the same"),
            F::NoLaw { name } => format!("contact `{name}` has no law"),
            F::NoFreeAxis { word, name, target } => {
                format!("{word} `{name}` has no axis to act on: `{target}` leaves none free")
            }
            F::InSpace { word, name, target } => {
                format!("{word} `{name}` cannot act on `{target}`: its shapes slide in two directions in space")
            }
            F::RestitutionAnd { name, clause } => {
                format!("stop `{name}` has both `restitution` and `{clause}`: it is rigid or it gives way")
            }
            F::ShapesApart { name, one, other } => {
                format!("contact `{name}` cannot be of {} and {}", with_article(one), with_article(other))
            }
            F::Thin { name, word } => {
                let word = with_article(word);
                format!(
                    "contact `{name}` cannot be of a point and {word}: both are thin, so neither can be inside the \
                    other"
                )
            }
            F::LineAcross { name } => format!("a line along z stands on the plane of the shapes of contact `{name}`"),
            F::UnknownTable { name, .. } => format!("there is no table `{name}` for the profile"),
            F::RoughProfile { table, contact } => {
                format!("the profile `{table}` of contact `{contact}` has corners: straight lines between its points")
            }
            F::OpenProfile { table, contact } => {
                format!("the profile `{table}` of contact `{contact}` is one of an angle and does not close")
            }
        }
    }

    fn help(&self) -> String {
        match self {
            F::UnknownBody { near: Some(near), .. }
            | F::UnknownPoint { near: Some(near), .. }
            | F::UnknownTarget { near: Some(near), .. } => format!("did you mean `{near}`?"),
            F::UnknownBody { name, .. } => format!("declare `body {name} {{ ... }}`"),
            F::UnknownPoint { point, known, .. } => {
                let known: Vec<String> = known.iter().map(|point| format!("`{point}`")).collect();
                format!("use {}, or add `point {point} = [x, y, z];` to it", known.join(", "))
            }
            F::MissingClause { word: "joint", clause, .. } => {
                format!("add `{clause} ...;`, or `rigid;` for a joint that does not give way")
            }
            F::MissingClause { clause, .. } => format!("add `{clause} ...;`"),
            F::SuperfluousClause { clause, .. } => format!("remove `{clause}`"),
            F::NoMass { .. } => {
                "add a solid such as `cuboid [x, y, z];` with its `density`, or `mass` and `inertia`".to_owned()
            }
            F::MassTwice { .. } => "remove the solids, or `mass`, `center` and `inertia`".to_owned(),
            F::Twice { word: "ground" } => "put the points of both into one `ground`".to_owned(),
            F::Twice { word } => format!("remove one `{word}`"),
            F::UnknownTarget { .. } => "name a joint, a body, or a body's point".to_owned(),
            F::WrongDrive { takes: Takes::Torque, .. } => "write `torque = ...`".to_owned(),
            F::WrongDrive { takes: Takes::Force, .. } => "write `force = ...`".to_owned(),
            F::WrongDrive { takes: Takes::Nothing, .. } => {
                "it has no one axis to turn about or slide along: drive one of its bodies".to_owned()
            }
            F::SameBody { .. } => "join two bodies".to_owned(),
            F::SameAxes { .. } => "give two different axes, such as `universal x y`".to_owned(),
            F::NoLaw { .. } => "add one, such as `y: C = k, R = r;`".to_owned(),
            F::NoFreeAxis { .. } => {
                "name a revolute, prismatic or cylindrical joint, a contact, or a 1-junction".to_owned()
            }
            F::InSpace { .. } => "write `circle` for `sphere` and `line` for `plane` if they meet in a \
                plane"
                .to_owned(),
            F::ShapesApart { .. } => {
                "in the plane a `circle` touches `circle`, `hole`, `line`, `segment`, `slot`, `arc` and `profile`, in \
                 space a `sphere` touches `sphere`, `plane` and `hole`"
                    .to_owned()
            }
            F::Thin { .. } => "give the point a radius, such as `circle 1 mm`".to_owned(),
            F::LineAcross { .. } => "write the axis x or y, as in `line x`, or `plane z` for a sphere".to_owned(),
            F::UnknownTable { near: Some(near), .. } => format!("did you mean `{near}`?"),
            F::UnknownTable { name, .. } => {
                format!("declare `table {name}: deg -> mm = [[0, 30], .., [360, 30]], spline, periodic;`")
            }
            F::RoughProfile { .. } => "write `spline` or `monotone` after the points of the table".to_owned(),
            F::OpenProfile { .. } => {
                "write `periodic` after the points of the table, which end a turn after the first one".to_owned()
            }
            F::RestitutionAnd { clause, .. } => format!("remove `{clause}`, or `restitution`"),
        }
    }
}

/// A noun with its article.
fn with_article(noun: &str) -> String {
    format!("{} {noun}", if noun.starts_with('a') { "an" } else { "a" })
}
