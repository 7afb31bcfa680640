//! `option` of a file, all sections together: a later one counts more.

use nalgebra::Vector3;

use crate::ImportError;
use crate::xml::Node;

/// What a file sets for all of it.
pub struct Settings {
    /// m/s^2; 0 where its flag is off.
    pub gravity: Vector3<f64>,
    /// Springs act.
    pub springs: bool,
    /// Dampers act.
    pub dampers: bool,
    /// Limits act.
    pub limits: bool,
    /// Equalities act.
    pub equalities: bool,
    /// Dry friction acts.
    pub friction: bool,
    /// Shapes touch.
    pub contacts: bool,
    /// Actuators act.
    pub actuators: bool,
    /// Controls stay in their ranges.
    pub clamps: bool,
    /// The groups of actuators that do not act.
    pub idle_groups: Vec<f64>,
}

impl Settings {
    /// Of a file.
    ///
    /// # Errors
    /// A value that MuJoCo does not take.
    pub fn new(root: &Node) -> Result<Self, ImportError> {
        let flags = Flags::new(root)?;
        let gravity = last_option(root, "gravity").map(|node| node.vector("gravity")).transpose()?.flatten();
        let idle_groups = last_option(root, "actuatorgroupdisable")
            .and_then(|node| Some(node.list("actuatorgroupdisable", node.peek("actuatorgroupdisable")?)))
            .transpose()?;
        Ok(Self {
            gravity: if flags.is_on("gravity") {
                gravity.unwrap_or(Vector3::new(0.0, 0.0, -9.81))
            } else {
                Vector3::zeros()
            },
            springs: flags.is_on("spring"),
            dampers: flags.is_on("damper"),
            limits: flags.is_on("limit") && flags.is_on("constraint"),
            equalities: flags.is_on("equality") && flags.is_on("constraint"),
            friction: flags.is_on("frictionloss") && flags.is_on("constraint"),
            contacts: flags.is_on("contact") && flags.is_on("constraint"),
            actuators: flags.is_on("actuation"),
            clamps: flags.is_on("clampctrl"),
            idle_groups: idle_groups.unwrap_or_default(),
        })
    }
}

/// The last `option` that sets an attribute.
fn last_option<'n>(root: &'n Node, name: &str) -> Option<&'n Node> {
    root.children("option").filter(|node| node.attribute(name).is_some()).last()
}

/// The flags that are given; a later one counts more.
struct Flags<'n>(Vec<&'n Node>);

/// Those that are looked at here.
const FLAGS: [&str; 10] = [
    "gravity",
    "spring",
    "damper",
    "limit",
    "constraint",
    "equality",
    "frictionloss",
    "contact",
    "actuation",
    "clampctrl",
];

impl<'n> Flags<'n> {
    fn new(root: &'n Node) -> Result<Self, ImportError> {
        let nodes: Vec<&Node> = root.children("option").flat_map(|option| option.children("flag")).collect();
        for (node, name) in nodes.iter().flat_map(|node| FLAGS.map(|name| (node, name))) {
            node.word(name, &["enable", "disable"])?;
        }
        Ok(Self(nodes))
    }

    fn is_on(&self, name: &str) -> bool {
        self.0.iter().filter_map(|node| node.peek(name)).next_back() != Some("disable")
    }
}
