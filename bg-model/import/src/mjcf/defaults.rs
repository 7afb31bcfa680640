//! Default classes: what an element's attribute is where the element does not say.
//!
//! Order: the element, its class, or else the `childclass` of the nearest body, or else the outermost class; each class
//! after it the one around it. A class has of the one around it what stood there when it began: first what is beside
//! it, then, section by section, what follows.

use std::collections::BTreeMap;

use nalgebra::Vector3;

use crate::ImportError;
use crate::xml::Node;

/// The classes of a file by name.
pub struct Defaults<'n> {
    /// A class's own node and those around it, inner first.
    classes: BTreeMap<&'n str, Vec<&'n Node>>,
}

/// Kinds of actuators.
const ACTUATORS: [&str; 12] = [
    "general",
    "motor",
    "position",
    "velocity",
    "intvelocity",
    "damper",
    "cylinder",
    "muscle",
    "adhesion",
    "pid",
    "dcmotor",
    "orientation",
];

/// Kinds of tendons, of which a class speaks as `tendon`.
const TENDONS: [&str; 2] = ["fixed", "spatial"];

/// The outermost class.
pub const MAIN: &str = "main";

/// An element with its defaults.
pub struct Element<'n> {
    /// Itself.
    pub node: &'n Node,
    /// The same element in its classes, inner first.
    defaults: Vec<&'n Node>,
}

impl<'n> Defaults<'n> {
    /// Of all `default` elements.
    ///
    /// # Errors
    /// A class without a name, or a second one of a name.
    pub fn new(root: &'n Node) -> Result<Self, ImportError> {
        let mut defaults = Self { classes: BTreeMap::from([(MAIN, Vec::new())]) };
        for node in root.children("default") {
            node.mark_deep();
            let name = node.attribute("class").unwrap_or(MAIN);
            if name != MAIN {
                return Err(node.bad("class", name, "main: other classes stand inside of it"));
            }
            // Later sections count more.
            defaults.classes.entry(MAIN).or_default().insert(0, node);
            defaults.inner(node, MAIN)?;
        }
        Ok(defaults)
    }

    fn inner(&mut self, node: &'n Node, name: &str) -> Result<(), ImportError> {
        for inner in node.children("default") {
            let class = inner.needed("class")?;
            let around = self.classes.get(name).cloned().unwrap_or_default();
            let own = [inner].into_iter().chain(around).collect();
            if self.classes.insert(class, own).is_some() {
                return Err(ImportError::Twice { place: inner.place.clone(), what: "class", name: class.to_owned() });
            }
            self.inner(inner, class)?;
        }
        Ok(())
    }

    /// Whether there is such a class.
    ///
    /// # Errors
    /// There is none.
    pub fn known(&self, node: &Node, class: &str) -> Result<(), ImportError> {
        let unknown = || ImportError::Unknown { place: node.place.clone(), what: "class", name: class.to_owned() };
        self.classes.get(class).map(|_| ()).ok_or_else(unknown)
    }

    /// An element under a `childclass`.
    ///
    /// # Errors
    /// Its class is not there.
    pub fn element(&self, node: &'n Node, class: Option<&'n str>) -> Result<Element<'n>, ImportError> {
        let class = node.attribute("class").or(class).unwrap_or(MAIN);
        self.known(node, class)?;
        // All actuators of a class share what it says of any.
        let is_same = |child: &&'n Node| {
            let are_actuators = [&child.name, &node.name].iter().all(|name| ACTUATORS.contains(&name.as_str()));
            let is_tendon = child.name == "tendon" && TENDONS.contains(&node.name.as_str());
            child.name == node.name || are_actuators || is_tendon
        };
        let same = |class: &'n Node| class.children.iter().rev().filter(is_same);
        let defaults: Vec<&Node> = self.classes.get(class).into_iter().flatten().copied().flat_map(same).collect();
        node.inherit(&defaults);
        Ok(Element { node, defaults })
    }
}

impl<'n> Element<'n> {
    /// An element that has no defaults.
    pub fn plain(node: &'n Node) -> Self {
        Self { node, defaults: Vec::new() }
    }

    /// An attribute, which is used from now on.
    pub fn text(&self, name: &str) -> Option<&'n str> {
        self.node.mark(name);
        [&self.node].into_iter().chain(&self.defaults).find_map(|node| node.peek(name))
    }

    /// A number.
    ///
    /// # Errors
    /// It is none.
    pub fn number(&self, name: &str) -> Result<Option<f64>, ImportError> {
        self.text(name).map(|text| self.node.array::<1>(name, text).map(|[value]| value)).transpose()
    }

    /// A number that is not negative; 0 when left out.
    ///
    /// # Errors
    /// It is none, or negative.
    pub fn not_negative(&self, name: &str) -> Result<f64, ImportError> {
        let value = self.number(name)?.unwrap_or(0.0);
        if value < 0.0 { Err(self.node.bad(name, &value.to_string(), "0 or more")) } else { Ok(value) }
    }

    /// A vector.
    ///
    /// # Errors
    /// It is none.
    pub fn vector(&self, name: &str) -> Result<Option<Vector3<f64>>, ImportError> {
        self.text(name).map(|text| self.node.array::<3>(name, text).map(Vector3::from)).transpose()
    }

    /// Some numbers, at least one and at most so many; those that are left out are 0.
    ///
    /// # Errors
    /// There are none, more, or other words.
    pub fn up_to<const N: usize>(&self, name: &str) -> Result<[f64; N], ImportError> {
        let mut values = [0.0; N];
        let Some(text) = self.text(name) else { return Ok(values) };
        let given = self.node.list(name, text)?;
        if given.is_empty() || given.len() > N {
            return Err(self.node.bad(name, text, &format!("1 to {N} numbers")));
        }
        values[..given.len()].copy_from_slice(&given);
        Ok(values)
    }

    /// Whether it says `true`; none where it says neither.
    ///
    /// # Errors
    /// It says something else.
    pub fn truth(&self, name: &str) -> Result<Option<bool>, ImportError> {
        match self.text(name) {
            None | Some("auto") => Ok(None),
            Some("true") => Ok(Some(true)),
            Some("false") => Ok(Some(false)),
            Some(other) => Err(self.node.bad(name, other, "true, false or auto")),
        }
    }
}
