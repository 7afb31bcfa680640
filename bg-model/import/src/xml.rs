//! A file's elements, each with its place, and a record of what was read of them.
//!
//! In: the text of a file. Out: a tree of [`Node`]s. Whoever asks for an attribute or an element marks it; what nobody
//! has asked for is found by [`unread`]. Prefixes that the file does not declare, and a DOCTYPE, are read as other
//! programs do.

use std::cell::{Cell, RefCell};
use std::collections::BTreeSet;
use std::fmt;
use std::rc::Rc;

use nalgebra::Vector3;
use roxmltree::{Document, ParsingOptions};

use crate::ImportError;

/// Where an element is.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct FilePlace {
    /// An included file; none is the file itself.
    pub file: Option<Rc<str>>,
    /// From 1.
    pub line: u32,
}

impl fmt::Display for FilePlace {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match &self.file {
            Some(file) => write!(f, "line {} of {file}", self.line),
            None => write!(f, "line {}", self.line),
        }
    }
}

/// An element.
#[derive(Clone, Debug)]
pub struct Node {
    /// With its prefix.
    pub name: String,
    /// Where it is.
    pub place: FilePlace,
    /// Which model it is from: 0 is the file itself, others are attached to it.
    pub model: usize,
    attributes: Vec<(String, String)>,
    /// The elements inside.
    pub children: Vec<Node>,
    is_read: Cell<bool>,
    used: RefCell<BTreeSet<String>>,
    /// What default classes give it: attribute, value and where it stands there.
    inherited: RefCell<Vec<(String, String, FilePlace)>>,
}

/// What nobody has asked for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Unread {
    /// The element.
    pub element: String,
    /// The element around it.
    pub around: String,
    /// None where it is the element itself.
    pub attribute: Option<(String, String)>,
    /// Where it is.
    pub place: FilePlace,
}

impl Node {
    /// The root element of a text; `file` is that of an included one.
    ///
    /// # Errors
    /// It is no XML.
    pub fn parse(text: &str, file: Option<&Rc<str>>) -> Result<Self, ImportError> {
        let mut text = text.to_owned();
        loop {
            let fault = match Self::declared(&text, file) {
                Ok(Some(root)) => return Ok(root),
                Ok(None) => return Err(ImportError::TooDeep { most: DEPTH }),
                Err(fault) => fault,
            };
            let is_declared =
                matches!(&fault, roxmltree::Error::UnknownNamespace(prefix, _) if declare(&mut text, prefix));
            if !is_declared {
                return Err(ImportError::NotXml { file: file.map(ToString::to_string), fault });
            }
        }
    }

    /// The root element of a text that declares its prefixes; none where elements are too deep inside of each other.
    fn declared(text: &str, file: Option<&Rc<str>>) -> Result<Option<Self>, roxmltree::Error> {
        let options = ParsingOptions { allow_dtd: true, ..ParsingOptions::default() };
        let document = Document::parse_with_options(text, options)?;
        let breaks: Vec<usize> = text.match_indices('\n').map(|(at, _)| at).collect();
        if depth(document.root_element()) > DEPTH {
            return Ok(None);
        }
        let root = Self::of(document.root_element(), file, &breaks);
        root.is_read.set(true);
        Ok(Some(root))
    }

    /// The tree below a root, made without a call for each level; `breaks` are the places of line breaks.
    fn of(root: roxmltree::Node, file: Option<&Rc<str>>, breaks: &[usize]) -> Self {
        let close = |open: &mut Vec<(roxmltree::NodeId, Self)>| {
            if open.len() > 1
                && let Some((_, node)) = open.pop()
                && let Some((_, around)) = open.last_mut()
            {
                around.children.push(node);
            }
        };
        let mut open = vec![(root.id(), Self::alone(root, file, breaks))];
        for node in root.descendants().skip(1).filter(roxmltree::Node::is_element) {
            let around = node.parent_element().map(|around| around.id());
            while open.len() > 1 && open.last().map(|(id, _)| *id) != around {
                close(&mut open);
            }
            open.push((node.id(), Self::alone(node, file, breaks)));
        }
        while open.len() > 1 {
            close(&mut open);
        }
        open.swap_remove(0).1
    }

    /// An element without those inside of it.
    fn alone(node: roxmltree::Node, file: Option<&Rc<str>>, breaks: &[usize]) -> Self {
        let prefixed = |namespace: Option<&str>, name: &str| {
            let prefix =
                namespace.and_then(|namespace| node.lookup_prefix(namespace)).filter(|prefix| !prefix.is_empty());
            prefix.map_or_else(|| name.to_owned(), |prefix| format!("{prefix}:{name}"))
        };
        let line = breaks.partition_point(|&at| at < node.range().start) + 1;
        Self {
            name: prefixed(node.tag_name().namespace(), node.tag_name().name()),
            place: FilePlace { file: file.cloned(), line: u32::try_from(line).unwrap_or(u32::MAX) },
            model: 0,
            attributes: node.attributes().map(|a| (prefixed(a.namespace(), a.name()), a.value().to_owned())).collect(),
            children: Vec::new(),
            is_read: Cell::new(false),
            used: RefCell::default(),
            inherited: RefCell::default(),
        }
    }

    /// An element without attributes and content, at the place of another one and of its model.
    #[must_use]
    pub fn beside(&self, name: &str) -> Self {
        Self {
            name: name.to_owned(),
            place: self.place.clone(),
            model: self.model,
            attributes: Vec::new(),
            children: Vec::new(),
            is_read: Cell::new(true),
            used: RefCell::default(),
            inherited: RefCell::default(),
        }
    }

    /// Says of all that is inside which model it is from.
    pub fn set_model(&mut self, model: usize) {
        self.model = model;
        self.children.iter_mut().for_each(|child| child.set_model(model));
    }

    /// Names and values of all attributes, which are only looked at.
    pub fn attributes(&self) -> impl Iterator<Item = (&str, &str)> {
        self.attributes.iter().map(|(name, value)| (name.as_str(), value.as_str()))
    }

    /// An attribute, which is used from now on.
    pub fn attribute(&self, name: &str) -> Option<&str> {
        self.mark(name);
        self.peek(name)
    }

    /// An attribute that is only looked at.
    pub fn peek(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|(own, _)| own == name).map(|(_, value)| value.as_str())
    }

    /// Gives an attribute another value.
    pub fn set(&mut self, name: &str, value: String) {
        match self.attributes.iter_mut().find(|(own, _)| own == name) {
            Some((_, old)) => *old = value,
            None => self.attributes.push((name.to_owned(), value)),
        }
    }

    /// An attribute is used.
    pub fn mark(&self, name: &str) {
        self.is_read.set(true);
        self.used.borrow_mut().insert(name.to_owned());
    }

    /// All attributes are used, also those that classes give.
    pub fn mark_all(&self) {
        self.is_read.set(true);
        self.attributes.iter().for_each(|(name, _)| self.mark(name));
        self.inherited.borrow().iter().for_each(|(name, ..)| self.mark(name));
    }

    /// The element and all that is inside are used.
    pub fn mark_deep(&self) {
        self.mark_all();
        self.children.iter().for_each(Self::mark_deep);
    }

    /// What the classes of this element give it, inner first: attributes that nobody asks for are found.
    pub fn inherit(&self, classes: &[&Self]) {
        let mut inherited = self.inherited.borrow_mut();
        for class in classes {
            for (name, value) in &class.attributes {
                if self.peek(name).is_none() && !inherited.iter().any(|(known, ..)| known == name) {
                    inherited.push((name.clone(), value.clone(), class.place.clone()));
                }
            }
        }
    }

    /// The elements of this name directly inside, which are read from now on.
    pub fn children<'n>(&'n self, name: &'static str) -> impl Iterator<Item = &'n Self> {
        self.children.iter().filter(move |child| child.name == name).inspect(|child| child.is_read.set(true))
    }

    /// All elements directly inside, which are read from now on.
    pub fn all_children(&self) -> impl Iterator<Item = &Self> {
        self.children.iter().inspect(|child| child.is_read.set(true))
    }

    /// The first element of this name directly inside.
    pub fn child(&self, name: &'static str) -> Option<&Self> {
        self.children(name).next()
    }

    /// Itself and all that is inside, outer first.
    pub fn descendants(&self) -> Vec<&Self> {
        let mut all = vec![self];
        let mut next = 0;
        while let Some(&node) = all.get(next) {
            all.extend(&node.children);
            next += 1;
        }
        all
    }

    /// An element that has to be there.
    ///
    /// # Errors
    /// It is not.
    pub fn needed_child(&self, name: &'static str) -> Result<&Self, ImportError> {
        self.child(name).ok_or_else(|| self.missing(name))
    }

    /// An attribute that has to be there.
    ///
    /// # Errors
    /// It is not.
    pub fn needed(&self, name: &'static str) -> Result<&str, ImportError> {
        self.attribute(name).ok_or_else(|| self.missing(name))
    }

    /// What the element lacks.
    pub fn missing(&self, missing: &'static str) -> ImportError {
        ImportError::Missing { place: self.place.clone(), element: self.name.clone(), missing }
    }

    /// A value that is not what it must be.
    pub fn bad(&self, name: &str, value: &str, wanted: &str) -> ImportError {
        ImportError::Value {
            place: self.place.clone(),
            element: self.name.clone(),
            name: name.to_owned(),
            value: value.to_owned(),
            wanted: wanted.to_owned(),
        }
    }

    /// The finite numbers of a text; what is too small for a normal number is 0.
    ///
    /// # Errors
    /// One of its words is none.
    pub fn list(&self, name: &str, text: &str) -> Result<Vec<f64>, ImportError> {
        let flushed = |value: f64| if value.is_subnormal() { 0.0 } else { value };
        let number = |word: &str| word.parse().ok().filter(|value: &f64| value.is_finite()).map(flushed);
        text.split_whitespace().map(|word| number(word).ok_or_else(|| self.bad(name, text, "numbers"))).collect()
    }

    /// So many numbers.
    ///
    /// # Errors
    /// There are fewer, more, or other words.
    pub fn array<const N: usize>(&self, name: &str, text: &str) -> Result<[f64; N], ImportError> {
        let wanted = if N == 1 { "a number".to_owned() } else { format!("{N} numbers") };
        let numbers = self.list(name, text).ok().and_then(|numbers| numbers.try_into().ok());
        numbers.ok_or_else(|| self.bad(name, text, &wanted))
    }

    /// The number in an attribute; none where that is not there.
    ///
    /// # Errors
    /// It is no number.
    pub fn number(&self, name: &str) -> Result<Option<f64>, ImportError> {
        self.attribute(name).map(|text| self.array::<1>(name, text).map(|[value]| value)).transpose()
    }

    /// The vector in an attribute; none where that is not there.
    ///
    /// # Errors
    /// It is no vector.
    pub fn vector(&self, name: &str) -> Result<Option<Vector3<f64>>, ImportError> {
        self.attribute(name).map(|text| self.array::<3>(name, text).map(Vector3::from)).transpose()
    }

    /// A number that is not negative; 0 when left out.
    ///
    /// # Errors
    /// It is no number, or negative.
    pub fn not_negative(&self, name: &str) -> Result<f64, ImportError> {
        let value = self.number(name)?.unwrap_or(0.0);
        if value < 0.0 { Err(self.bad(name, &value.to_string(), "0 or more")) } else { Ok(value) }
    }

    /// One of several words; none where the attribute is not there.
    ///
    /// # Errors
    /// It is another word.
    pub fn word(&self, name: &str, words: &[&str]) -> Result<Option<&str>, ImportError> {
        let Some(text) = self.attribute(name) else { return Ok(None) };
        let wanted = || format!("{} or {}", words[..words.len() - 1].join(", "), words[words.len() - 1]);
        if words.contains(&text) { Ok(Some(text)) } else { Err(self.bad(name, text, &wanted())) }
    }
}

/// How deep elements may be inside of each other: each takes some of the program's stack.
const DEPTH: usize = 2000;

/// How deep elements are inside of an element.
fn depth(root: roxmltree::Node) -> usize {
    let mut level = vec![root];
    let mut depth = 0;
    while !level.is_empty() {
        level = level.iter().flat_map(roxmltree::Node::children).filter(roxmltree::Node::is_element).collect();
        depth += 1;
    }
    depth
}

/// What nobody has asked for in a tree, in its order: of an element that was not read the element alone.
#[must_use]
pub fn unread(root: &Node) -> Vec<Unread> {
    let mut found = Vec::new();
    collect(root, "", &mut found);
    found
}

fn collect(node: &Node, around: &str, found: &mut Vec<Unread>) {
    let unread = |attribute, place: &FilePlace| Unread {
        element: node.name.clone(),
        around: around.to_owned(),
        attribute,
        place: place.clone(),
    };
    if !node.is_read.get() {
        found.push(unread(None, &node.place));
        return;
    }
    let used = node.used.borrow();
    for (name, value) in node.attributes.iter().filter(|(name, _)| !used.contains(name)) {
        found.push(unread(Some((name.clone(), value.clone())), &node.place));
    }
    for (name, value, place) in node.inherited.borrow().iter().filter(|(name, ..)| !used.contains(name)) {
        found.push(unread(Some((name.clone(), value.clone())), place));
    }
    node.children.iter().for_each(|child| collect(child, &node.name, found));
}

/// Declares a prefix in the first element of a text; whether there is one.
fn declare(text: &mut String, prefix: &str) -> bool {
    let Some(at) = after_name_of_root(text) else { return false };
    text.insert_str(at, &format!(" xmlns:{prefix}=\"{prefix}\""));
    true
}

/// Where the name of the first element ends.
fn after_name_of_root(text: &str) -> Option<usize> {
    let mut at = 0;
    loop {
        at += text[at..].find('<')?;
        let rest = &text[at..];
        let end = if rest.starts_with("<!--") {
            "-->"
        } else if rest.starts_with("<?") {
            "?>"
        } else if rest.starts_with("<!") {
            // A document type; what it declares stands in brackets.
            if rest.find('[').is_some_and(|open| rest.find('>').is_some_and(|close| open < close)) { "]>" } else { ">" }
        } else {
            return Some(at + rest.find(|c: char| c.is_whitespace() || c == '>' || c == '/')?);
        };
        at += rest.find(end)? + end.len();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(root: &Node) -> Vec<String> {
        let word = |unread: &Unread| {
            let attribute = unread.attribute.as_ref().map(|(name, _)| format!(" {name}")).unwrap_or_default();
            format!("{}: {}{attribute}", unread.place, unread.element)
        };
        unread(root).iter().map(word).collect()
    }

    #[test]
    fn what_nobody_asks_for_is_found_with_its_line() {
        let root = Node::parse("<a x='1' y='2'>\n<b z='3'><d/></b>\n<c w='4'><e/></c></a>", None).expect("XML");
        assert_eq!(root.number("x").expect("a number"), Some(1.0));
        assert_eq!(root.children("c").count(), 1);
        assert_eq!(told(&root), ["line 1: a y", "line 2: b", "line 3: c w", "line 3: e"]);
    }

    #[test]
    fn what_a_class_gives_is_found_where_it_stands() {
        let root = Node::parse("<a x='1'>\n<b x='2' y='3' z='4'/></a>", None).expect("XML");
        let class = &root.children[0];
        class.mark_all();
        root.inherit(&[class]);
        root.mark("x");
        root.mark("z");
        assert_eq!(told(&root), ["line 2: a y"]);
    }

    #[test]
    fn a_doctype_and_undeclared_prefixes_are_read() {
        let text =
            "<?xml version='1.0'?>\n<!DOCTYPE a [<!ENTITY n 'five'>]>\n<!-- <b> -->\n<a v='&n;'><p:b q:c='1'/></a>";
        let root = Node::parse(text, None).expect("XML");
        assert_eq!((root.peek("v"), root.children[0].name.as_str()), (Some("five"), "p:b"));
        assert_eq!(root.children[0].peek("q:c"), Some("1"));
        assert_eq!(root.children[0].place.line, 4);
    }
}
