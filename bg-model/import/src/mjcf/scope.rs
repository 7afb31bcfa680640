//! What each file says of its own elements: how it gives angles, when shapes have mass, its classes, its meshes. A file
//! that is attached keeps these; `option` counts in the first file alone.

use super::compiler::Compiler;
use super::defaults::{Defaults, Element};
use super::expand::Model;
use super::meshes::Meshes;
use crate::ImportError;
use crate::robot::Pose;
use crate::xml::Node;

/// Of one file.
pub struct Scope<'n> {
    /// Its `compiler`.
    pub compiler: Compiler,
    /// Its classes.
    pub defaults: Defaults<'n>,
    /// Its meshes.
    pub meshes: Meshes<'n>,
}

/// Of the first file and all that it attaches.
pub struct Scopes<'n>(Vec<Scope<'n>>);

impl<'n> Scopes<'n> {
    /// Of the models of a file; there is one at least.
    ///
    /// # Errors
    /// Values and classes that cannot be.
    pub fn new(models: &'n [Model]) -> Result<Self, ImportError> {
        let scope = |model: &'n Model| {
            let defaults = Defaults::new(&model.root)?;
            let meshes = Meshes::new(&model.root, model.folder.as_deref(), &defaults)?;
            Ok(Scope { compiler: Compiler::new(&model.root)?, defaults, meshes })
        };
        models.iter().map(scope).collect::<Result<_, _>>().map(Self)
    }

    /// That of the file that an element is from.
    pub fn of(&self, node: &Node) -> &Scope<'n> {
        &self.0[node.model]
    }

    /// An element with its classes.
    ///
    /// # Errors
    /// Its class is not there.
    pub fn element(&self, node: &'n Node, class: Option<&'n str>) -> Result<Element<'n>, ImportError> {
        self.of(node).defaults.element(node, class)
    }

    /// The frame of an element.
    ///
    /// # Errors
    /// Words that are no numbers, axes that are zero.
    pub fn pose(&self, element: &Element) -> Result<Pose, ImportError> {
        self.of(element.node).compiler.angles.pose(element)
    }

    /// The class of what is inside of a body or frame.
    ///
    /// # Errors
    /// It is not there.
    pub fn class_inside(&self, node: &'n Node, around: Option<&'n str>) -> Result<Option<&'n str>, ImportError> {
        let class = node.attribute("childclass").or(around);
        class.map_or(Ok(()), |class| self.of(node).defaults.known(node, class))?;
        Ok(class)
    }
}
