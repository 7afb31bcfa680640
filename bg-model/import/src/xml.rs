//! Attributes of an element as numbers and vectors, with the line in each error.

use nalgebra::Vector3;
use roxmltree::Node;

use crate::ImportError;

/// The line of an element, from 1.
pub fn line(node: Node) -> u32 {
    node.document().text_pos_at(node.range().start).row
}

/// The elements of this name directly inside.
pub fn children<'a, 'i>(node: Node<'a, 'i>, name: &'static str) -> impl Iterator<Item = Node<'a, 'i>> {
    node.children().filter(move |child| child.has_tag_name(name))
}

/// The first element of this name directly inside.
pub fn child<'a, 'i>(node: Node<'a, 'i>, name: &'static str) -> Option<Node<'a, 'i>> {
    children(node, name).next()
}

/// An element that has to be there.
///
/// # Errors
/// It is not.
pub fn needed_child<'a, 'i>(node: Node<'a, 'i>, name: &'static str) -> Result<Node<'a, 'i>, ImportError> {
    child(node, name).ok_or_else(|| missing(node, name))
}

/// An attribute that has to be there.
///
/// # Errors
/// It is not.
pub fn needed<'a>(node: Node<'a, '_>, name: &'static str) -> Result<&'a str, ImportError> {
    node.attribute(name).ok_or_else(|| missing(node, name))
}

/// What an element lacks.
pub fn missing(node: Node, missing: &'static str) -> ImportError {
    ImportError::Missing { line: line(node), element: node.tag_name().name().to_owned(), missing }
}

/// A value that is not what it must be.
pub fn bad(node: Node, name: &str, value: &str, wanted: &str) -> ImportError {
    ImportError::Value {
        line: line(node),
        element: node.tag_name().name().to_owned(),
        name: name.to_owned(),
        value: value.to_owned(),
        wanted: wanted.to_owned(),
    }
}

/// The finite numbers of a text.
///
/// # Errors
/// One of its words is none.
pub fn list(node: Node, name: &str, text: &str) -> Result<Vec<f64>, ImportError> {
    let number = |word: &str| word.parse().ok().filter(|value: &f64| value.is_finite());
    text.split_whitespace().map(|word| number(word).ok_or_else(|| bad(node, name, text, "numbers"))).collect()
}

/// So many numbers.
///
/// # Errors
/// There are fewer, more, or other words.
pub fn array<const N: usize>(node: Node, name: &str, text: &str) -> Result<[f64; N], ImportError> {
    let wanted = if N == 1 { "a number".to_owned() } else { format!("{N} numbers") };
    let numbers = list(node, name, text).ok().and_then(|numbers| numbers.try_into().ok());
    numbers.ok_or_else(|| bad(node, name, text, &wanted))
}

/// The number in an attribute; none where that is not there.
///
/// # Errors
/// It is no number.
pub fn number(node: Node, name: &str) -> Result<Option<f64>, ImportError> {
    node.attribute(name).map(|text| array::<1>(node, name, text).map(|[value]| value)).transpose()
}

/// The vector in an attribute; none where that is not there.
///
/// # Errors
/// It is no vector.
pub fn vector(node: Node, name: &str) -> Result<Option<Vector3<f64>>, ImportError> {
    node.attribute(name).map(|text| array::<3>(node, name, text).map(Vector3::from)).transpose()
}
