//! What is inside of a body, with `frame` and `replicate` written out.
//!
//! In: a body's element. Out: its joints, shapes and bodies, each with the frame in which its place is given, its class
//! and the ending of its names. The k-th copy of a `replicate` is in the k-th power of its frame; its names end with k,
//! in as many digits as the last one has. Source: MuJoCo's XML reference.

use nalgebra::Vector3;

use super::defaults::Element;
use super::scope::Scopes;
use crate::ImportError;
use crate::robot::Pose;
use crate::xml::Node;

/// Something inside of a body.
#[derive(Clone)]
pub struct Item<'n> {
    /// Its element.
    pub node: &'n Node,
    /// The frame in which its place is given, in the body's.
    pub frame: Pose,
    /// The class of those around it.
    pub class: Option<&'n str>,
    /// What its name ends with.
    pub ending: String,
}

impl<'n> Item<'n> {
    /// A name that the file gives it.
    pub fn name(&self) -> Option<String> {
        self.node.attribute("name").map(|name| format!("{name}{}", self.ending))
    }
}

/// The elements that are looked into.
const READ: [&str; 5] = ["body", "joint", "freejoint", "geom", "inertial"];

/// The most copies of one element: more is a slip of the pen.
const COPIES: f64 = 1e4;

/// All of a body's content.
///
/// # Errors
/// Values that cannot be.
pub fn contents<'n>(around: &Item<'n>, scopes: &Scopes<'n>) -> Result<Vec<Item<'n>>, ImportError> {
    let mut found = Vec::new();
    collect(around, scopes, &mut found)?;
    Ok(found)
}

fn collect<'n>(around: &Item<'n>, scopes: &Scopes<'n>, found: &mut Vec<Item<'n>>) -> Result<(), ImportError> {
    for node in &around.node.children {
        match node.name.as_str() {
            "frame" => {
                node.mark("name");
                let frame = around.frame.then(&scopes.pose(&Element::plain(node))?);
                let class = scopes.class_inside(node, around.class)?;
                collect(&Item { node, frame, class, ending: around.ending.clone() }, scopes, found)?;
            }
            "replicate" => copies(&Item { node, ..around.clone() }, scopes, found)?,
            name if READ.contains(&name) => found.push(Item { node, ..around.clone() }),
            _ => {}
        }
    }
    Ok(())
}

fn copies<'n>(around: &Item<'n>, scopes: &Scopes<'n>, found: &mut Vec<Item<'n>>) -> Result<(), ImportError> {
    let node = around.node;
    let step = Pose {
        place: node.vector("offset")?.unwrap_or_default(),
        turned: scopes.of(node).compiler.angles.euler(&node.vector("euler")?.unwrap_or(Vector3::zeros())),
    };
    let mut frame = around.frame;
    for own in endings(node)? {
        let ending = own + &around.ending;
        collect(&Item { frame, ending, ..around.clone() }, scopes, found)?;
        frame = frame.then(&step);
    }
    Ok(())
}

/// What the names in each copy of a `replicate` end with.
///
/// # Errors
/// It does not say how many there are.
pub fn endings(node: &Node) -> Result<Vec<String>, ImportError> {
    let count = node.number("count")?.ok_or_else(|| node.missing("count"))?;
    if !(0.0..=COPIES).contains(&count) || count.fract() != 0.0 {
        return Err(node.bad("count", node.peek("count").unwrap_or_default(), "a whole number up to 10000"));
    }
    let separator = node.attribute("sep").unwrap_or_default();
    // At most COPIES, so a whole number stays what it is.
    let count = count as usize;
    let width = count.saturating_sub(1).to_string().len();
    Ok((0..count).map(|copy| format!("{separator}{copy:0width$}")).collect())
}
