//! Default classes: what an element's attribute is where the element does not say.
//!
//! Order: the element, its class, or else the `childclass` of the nearest body, or else the outermost class; each class after
//! it the one around it.

use std::collections::BTreeMap;

use nalgebra::Vector3;
use roxmltree::Node;

use crate::ImportError;
use crate::xml::{array, children};

/// The classes of a file by name.
pub struct Defaults<'a, 'i> {
    /// A class's own node and those around it, inner first.
    classes: BTreeMap<&'a str, Vec<Node<'a, 'i>>>,
}

/// The outermost class.
const MAIN: &str = "main";

/// An element with its defaults.
pub struct Element<'a, 'i> {
    /// Itself.
    pub node: Node<'a, 'i>,
    /// The same element in its classes, inner first.
    defaults: Vec<Node<'a, 'i>>,
}

impl<'a, 'i> Defaults<'a, 'i> {
    /// Of all `default` elements.
    pub fn new(root: Node<'a, 'i>) -> Self {
        let mut defaults = Self { classes: BTreeMap::new() };
        for node in children(root, "default") {
            defaults.class(node, node.attribute("class").unwrap_or(MAIN), &[]);
        }
        defaults
    }

    fn class(&mut self, node: Node<'a, 'i>, name: &'a str, around: &[Node<'a, 'i>]) {
        let own: Vec<Node> = [node].into_iter().chain(around.iter().copied()).collect();
        for inner in children(node, "default") {
            self.class(inner, inner.attribute("class").unwrap_or_default(), &own);
        }
        if around.is_empty() && name != MAIN {
            self.classes.entry(MAIN).or_default().extend(own.iter().copied());
        }
        self.classes.entry(name).or_default().extend(own);
    }

    /// An element under a `childclass`.
    pub fn element(&self, node: Node<'a, 'i>, class: Option<&'a str>) -> Element<'a, 'i> {
        let class = node.attribute("class").or(class).unwrap_or(MAIN);
        let classes = self.classes.get(class).into_iter().flatten();
        let same = |class: &Node<'a, 'i>| class.children().find(|child| child.tag_name() == node.tag_name());
        Element { node, defaults: classes.filter_map(same).collect() }
    }
}

impl<'a, 'i> Element<'a, 'i> {
    /// An element that has no defaults.
    pub fn plain(node: Node<'a, 'i>) -> Self {
        Self { node, defaults: Vec::new() }
    }

    /// An attribute.
    pub fn text(&self, name: &str) -> Option<&'a str> {
        [&self.node].into_iter().chain(&self.defaults).find_map(|node| node.attribute(name))
    }

    /// A number.
    ///
    /// # Errors
    /// It is none.
    pub fn number(&self, name: &str) -> Result<Option<f64>, ImportError> {
        self.text(name).map(|text| array::<1>(self.node, name, text).map(|[value]| value)).transpose()
    }

    /// A vector.
    ///
    /// # Errors
    /// It is none.
    pub fn vector(&self, name: &str) -> Result<Option<Vector3<f64>>, ImportError> {
        self.text(name).map(|text| array::<3>(self.node, name, text).map(Vector3::from)).transpose()
    }
}
