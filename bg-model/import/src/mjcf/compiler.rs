//! `compiler` of a file, all sections together: a later one counts more.

use nalgebra::Vector3;

use super::orientation::Angles;
use crate::ImportError;
use crate::robot::Inertia;
use crate::xml::Node;

/// When shapes give a body's mass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FromShapes {
    /// Never.
    Never,
    /// Where it has no `inertial`.
    Otherwise,
    /// Wherever it has shapes.
    Always,
}

/// How a file is to be read.
pub struct Compiler {
    /// How it gives angles.
    pub angles: Angles,
    /// A range alone is a limit.
    pub automatic_limits: bool,
    /// When shapes give a mass.
    pub from_shapes: FromShapes,
    /// The groups of shapes that have mass.
    pub groups: (f64, f64),
    /// The mass of all bodies together, kg.
    pub total: Option<f64>,
    /// The least mass of a body, kg.
    least_mass: f64,
    /// The least principal moment of a body, kg m^2.
    least_moment: f64,
    /// Moments that no body has are replaced by their mean.
    balances: bool,
}

impl Compiler {
    /// Of a file.
    ///
    /// # Errors
    /// A value that MuJoCo does not take.
    pub fn new(root: &Node) -> Result<Self, ImportError> {
        let compilers: Vec<&Node> = root.children("compiler").collect();
        let last = |name: &str| {
            compilers.iter().for_each(|node| node.mark(name));
            compilers.iter().rfind(|node| node.peek(name).is_some()).copied()
        };
        let word = |name: &str, words: &[&str]| {
            Ok::<_, ImportError>(
                last(name).map(|node| node.word(name, words)).transpose()?.flatten().map(str::to_owned),
            )
        };
        let truth = |name: &str| word(name, &["true", "false"]).map(|word| word.map(|word| word == "true"));
        let least = |name: &str| last(name).map_or(Ok(0.0), |node| node.not_negative(name));
        if let Some(node) = last("coordinate").filter(|node| node.peek("coordinate") != Some("local")) {
            let wanted = "local: let MuJoCo 2.3.3 or older write the file anew";
            return Err(node.bad("coordinate", node.peek("coordinate").unwrap_or_default(), wanted));
        }
        let sequence = last("eulerseq").and_then(|node| Some((node, node.attribute("eulerseq")?)));
        if let Some((node, text)) = sequence
            && !(text.chars().count() == 3 && text.chars().all(|letter| "xyzXYZ".contains(letter)))
        {
            return Err(node.bad("eulerseq", text, "three of the letters x, y, z, X, Y, Z"));
        }
        let is_degree = word("angle", &["degree", "radian"])?.as_deref() != Some("radian");
        let groups = last("inertiagrouprange")
            .map(|node| node.array::<2>("inertiagrouprange", node.peek("inertiagrouprange").unwrap_or_default()))
            .transpose()?;
        Ok(Self {
            angles: Angles::new(is_degree, sequence.map_or("xyz", |(_, text)| text)),
            automatic_limits: truth("autolimits")? != Some(false),
            from_shapes: match word("inertiafromgeom", &["true", "false", "auto"])?.as_deref() {
                Some("true") => FromShapes::Always,
                Some("false") => FromShapes::Never,
                _ => FromShapes::Otherwise,
            },
            groups: groups.map_or((0.0, 5.0), |[least, most]| (least, most)),
            least_mass: least("boundmass")?,
            least_moment: least("boundinertia")?,
            balances: truth("balanceinertia")? == Some(true),
            total: last("settotalmass")
                .map(|node| node.number("settotalmass"))
                .transpose()?
                .flatten()
                .filter(|total| *total > 0.0),
        })
    }

    /// What the compiler does to a body's inertia: least values, then moments that no body has.
    ///
    /// # Errors
    /// Such moments where they are not to be balanced.
    pub fn bounded(&self, inertia: Option<Inertia>, body: &Node) -> Result<Option<Inertia>, ImportError> {
        let nothing = Inertia { mass: 0.0, center: Vector3::zeros(), tensor: nalgebra::Matrix3::zeros() };
        let has_bounds = self.least_mass > 0.0 || self.least_moment > 0.0;
        let Some(mut inertia) = inertia.or_else(|| has_bounds.then_some(nothing)) else { return Ok(None) };
        inertia.mass = inertia.mass.max(self.least_mass);
        let principal = inertia.tensor.symmetric_eigen();
        let moments = principal.eigenvalues.map(|moment| moment.max(self.least_moment));
        if moments != principal.eigenvalues {
            let axes = principal.eigenvectors;
            inertia.tensor = axes * nalgebra::Matrix3::from_diagonal(&moments) * axes.transpose();
        }
        let excess = 2.0 * moments.max() - moments.sum();
        if excess > ROUNDING * moments.max() {
            if !self.balances {
                let numbers: Vec<String> = moments.iter().map(|&moment| crate::number::number(moment)).collect();
                let what = format!(
                    "no body has the moments of inertia {}, of which one is larger than the others together: correct \
                     them, or let balanceinertia=\"true\" of <compiler> replace them by their mean",
                    numbers.join(", ")
                );
                return Err(ImportError::Wrong { place: body.place.clone(), what });
            }
            inertia.tensor = moments.mean() * nalgebra::Matrix3::identity();
        }
        Ok(Some(inertia))
    }
}

/// By how much of the largest moment the others together may be less than it.
const ROUNDING: f64 = 1e-10;
