//! Meshes of `asset`: which there are, and the mass of each, looked for when a shape asks for it.

use std::collections::BTreeMap;
use std::path::Path;

use nalgebra::{Quaternion, UnitQuaternion, Vector3};

use super::defaults::{Defaults, Element};
use super::fitted::{self, Fitted};
use crate::mesh::{Mass, Mesh};
use crate::robot::Inertia;
use crate::xml::Node;
use crate::{Folder, ImportError};

/// The meshes of a file.
pub struct Meshes<'n> {
    meshes: BTreeMap<String, Element<'n>>,
    /// Of the file itself, and of its meshes in it.
    folders: Option<(&'n Path, String)>,
    /// Of a mesh's path its last part counts alone.
    strips_path: bool,
    /// Primitives are fitted to the bounds of meshes, not to their moments.
    fits_bounds: bool,
}

impl<'n> Meshes<'n> {
    /// Of a file.
    ///
    /// # Errors
    /// A class that is not there, or a mesh without a name and a file.
    pub fn new(root: &'n Node, folder: Folder<'n>, defaults: &Defaults<'n>) -> Result<Self, ImportError> {
        let compilers: Vec<&Node> = root.children("compiler").collect();
        let last = |name: &str| compilers.iter().filter_map(|node| node.attribute(name)).next_back();
        let mesh_folder = last("meshdir").or(last("assetdir")).unwrap_or_default().to_owned();
        let mut meshes = BTreeMap::new();
        for node in root.children("asset").flat_map(|asset| asset.children("mesh")) {
            let stem = |file: &str| Path::new(file).file_stem().map(|stem| stem.to_string_lossy().into_owned());
            let named = node.attribute("name").map(str::to_owned).or_else(|| node.attribute("file").and_then(stem));
            meshes.insert(named.ok_or_else(|| node.missing("name"))?, defaults.element(node, None)?);
        }
        let strips_path = last("strippath") == Some("true");
        let fits_bounds = last("fitaabb") == Some("true");
        Ok(Self { meshes, folders: folder.map(|folder| (folder, mesh_folder)), strips_path, fits_bounds })
    }

    /// Mass and moments of a mesh for a density of 1, in its own frame; why not in words.
    pub fn inertia(&self, name: &str, is_shell: bool) -> Result<Inertia, String> {
        self.known(name, is_shell).map(|(_, inertia)| inertia)
    }

    /// A primitive fitted to a mesh, its sizes times `scale`; why not in words.
    pub fn fitted(&self, name: &str, kind: fitted::FittedShape, scale: f64) -> Result<Fitted, String> {
        let (mesh, inertia) = self.known(name, false)?;
        Ok(if self.fits_bounds {
            fitted::to_bounds(kind, &mesh, &inertia, scale)
        } else {
            fitted::to_moments(kind, &inertia, scale)
        })
    }

    /// A mesh with its mass and moments for a density of 1.
    fn known(&self, name: &str, is_shell: bool) -> Result<(Mesh, Inertia), String> {
        let Some(element) = self.meshes.get(name) else { return Err(format!("a mesh `{name}` that is not there")) };
        let mass = match (is_shell, element.text("inertia")) {
            (true, _) | (_, Some("shell")) => Mass::Shell,
            (_, None | Some("legacy")) => Mass::Legacy,
            (_, Some("exact")) => Mass::Exact,
            (_, Some(other)) => return Err(format!("a mesh whose mass is by its {other} hull")),
        };
        let mesh = self.surface(element)?;
        let inertia = mesh.inertia(mass).ok_or_else(|| "a mesh that encloses nothing".to_owned())?;
        Ok((mesh, inertia))
    }

    fn surface(&self, element: &Element) -> Result<Mesh, String> {
        let list = |name: &str| {
            let text = element.text(name);
            text.map(|text| element.node.list(name, text)).transpose().map_err(|fault| format!("a mesh ({fault})"))
        };
        let mesh = match (element.text("file"), list("vertex")?, list("face")?) {
            (Some(file), ..) => self.file(file)?,
            (None, Some(vertices), Some(faces)) => {
                Mesh::of(&vertices, &faces).ok_or_else(|| "a mesh with a face that has no vertex".to_owned())?
            }
            (None, Some(_), None) => return Err("a mesh without faces".to_owned()),
            _ => return Err("a mesh without a file".to_owned()),
        };
        let numbers = |name: &str, plain: &[f64]| list(name).map(|given| given.unwrap_or_else(|| plain.to_vec()));
        let wrong = || "a mesh with an unusable scale or reference".to_owned();
        let [scale, place] = [numbers("scale", &[1.0; 3])?, numbers("refpos", &[0.0; 3])?];
        let &[w, x, y, z] = &numbers("refquat", &[1.0, 0.0, 0.0, 0.0])?[..] else { return Err(wrong()) };
        if scale.len() != 3 || place.len() != 3 {
            return Err(wrong());
        }
        let (scale, place) = (Vector3::from_vec(scale), Vector3::from_vec(place));
        let turned = UnitQuaternion::try_new(Quaternion::new(w, x, y, z), 1e-12).ok_or_else(wrong)?.inverse();
        Ok(mesh.moved(|vertex| (turned * (vertex - place)).component_mul(&scale)))
    }

    fn file(&self, file: &str) -> Result<Mesh, String> {
        let Some((folder, meshes)) = &self.folders else {
            return Err(format!("a mesh (`{file}` is not beside this text)"));
        };
        let file = Path::new(file);
        let file = if self.strips_path { file.file_name().map_or(file, Path::new) } else { file };
        let path = folder.join(meshes).join(file);
        let fault = |fault: String| format!("a mesh ({}: {fault})", file.display());
        let bytes = std::fs::read(&path).map_err(|source| fault(source.to_string()))?;
        let ending = file.extension().map(|ending| ending.to_string_lossy().into_owned()).unwrap_or_default();
        Mesh::read(&bytes, &ending).map_err(fault)
    }
}
