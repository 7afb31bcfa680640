//! Volume, centre and moments of a body whose surface is a mesh of triangles.
//!
//! In: a file, STL, OBJ or MSH, or lists of vertices and faces. Out: its mass for a density of 1. Method: the sum over
//! the tetrahedra between each triangle and a point. Exactly, they count with the sign of their side; in MuJoCo's older
//! way, its default, each counts as positive, first from the centre of the surface, then from the centre of mass found
//! so. A shell has its mass on the triangles. Source: MuJoCo's XML reference, `asset/mesh/inertia`; M. Tonon 2004,
//! Explicit exact formulas for the 3-D tetrahedron inertia tensor; checked against MuJoCo 4.0.

use std::io::Cursor;

use nalgebra::{Matrix3, Vector3};

use crate::robot::Inertia;

/// A surface.
#[derive(Clone, Debug, Default)]
pub struct Mesh(pub Vec<[Vector3<f64>; 3]>);

/// How a mesh gets its mass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mass {
    /// By the volume inside.
    Exact,
    /// By volumes that all count as positive.
    Legacy,
    /// By the area.
    Shell,
}

impl Mesh {
    /// Of a file's bytes; the ending of its name says which format it has.
    ///
    /// # Errors
    /// It is none of this format, in words.
    pub fn read(bytes: &[u8], ending: &str) -> Result<Self, String> {
        match ending.to_ascii_lowercase().as_str() {
            "stl" => stl(bytes),
            "obj" => obj(bytes),
            "msh" => msh(bytes).ok_or_else(|| "it is no MSH file".to_owned()),
            other => Err(format!("`.{other}` is no format that is read: STL, OBJ or MSH")),
        }
    }

    /// Of vertices and the indices of three of them for each face; none where one is not there.
    pub fn of(vertices: &[f64], faces: &[f64]) -> Option<Self> {
        let corner = |index: f64| {
            let is_index = index >= 0.0 && index.fract() == 0.0 && index < 1e9;
            // A small whole number.
            let at = if is_index { 3 * index as usize } else { return None };
            vertices.get(at..at + 3).map(Vector3::from_column_slice)
        };
        let face = |corners: &[f64]| Some([corner(corners[0])?, corner(corners[1])?, corner(corners[2])?]);
        faces.len().is_multiple_of(3).then(|| faces.chunks(3).map(face).collect::<Option<_>>().map(Self))?
    }

    /// The same with each vertex moved.
    pub fn moved(mut self, to: impl Fn(Vector3<f64>) -> Vector3<f64>) -> Self {
        self.0.iter_mut().flatten().for_each(|vertex| *vertex = to(*vertex));
        self
    }

    /// Mass and moments for a density of 1, kg for each m^3 or m^2; none of a surface that encloses nothing.
    pub fn inertia(&self, mass: Mass) -> Option<Inertia> {
        let total_area: f64 = self.0.iter().map(area).sum();
        let surface = self.0.iter().map(|face| area(face) * middle(face)).sum::<Vector3<f64>>() / total_area;
        let center = if mass == Mass::Shell {
            surface
        } else {
            let from = if mass == Mass::Legacy { surface } else { Vector3::zeros() };
            let weighted = |face: &[Vector3<f64>; 3]| {
                let volume = volume(face, &from, mass);
                (volume, volume * (0.75 * middle(face) + 0.25 * from))
            };
            let (total, sum) =
                self.0.iter().map(weighted).fold((0.0, Vector3::zeros()), |(v, s), (w, t)| (v + w, s + t));
            sum / total
        };
        let mut total = 0.0;
        let mut squares = Matrix3::zeros();
        for face in &self.0 {
            let weight = if mass == Mass::Shell { area(face) } else { volume(face, &center, mass) };
            let arms = face.map(|corner| corner - center);
            let sum = arms[0] + arms[1] + arms[2];
            let own: Matrix3<f64> = arms.iter().map(|arm| arm * arm.transpose()).sum();
            total += weight;
            squares += weight / if mass == Mass::Shell { 12.0 } else { 20.0 } * (sum * sum.transpose() + own);
        }
        // A surface whose faces look inwards has a negative volume.
        let sign = total.signum();
        let tensor = sign * (squares.trace() * Matrix3::identity() - squares);
        (total.abs() > 0.0 && center.iter().all(|part| part.is_finite())).then_some(Inertia {
            mass: sign * total,
            center,
            tensor,
        })
    }
}

fn area(face: &[Vector3<f64>; 3]) -> f64 {
    (face[1] - face[0]).cross(&(face[2] - face[0])).norm() / 2.0
}

fn middle(face: &[Vector3<f64>; 3]) -> Vector3<f64> {
    (face[0] + face[1] + face[2]) / 3.0
}

/// Of the tetrahedron between a face and a point.
fn volume(face: &[Vector3<f64>; 3], from: &Vector3<f64>, mass: Mass) -> f64 {
    let arms = face.map(|corner| corner - from);
    let signed = arms[0].dot(&arms[1].cross(&arms[2])) / 6.0;
    if mass == Mass::Legacy { signed.abs() } else { signed }
}

fn stl(bytes: &[u8]) -> Result<Mesh, String> {
    let mut cursor = Cursor::new(bytes);
    let reader = stl_io::create_stl_reader(&mut cursor).map_err(|fault| fault.to_string())?;
    let face = |triangle: std::io::Result<stl_io::Triangle>| {
        let triangle = triangle.map_err(|fault| fault.to_string())?;
        let corner = |k: usize| {
            let vertex: [f32; 3] = triangle.vertices[k].into();
            Vector3::from(vertex.map(f64::from))
        };
        Ok([corner(0), corner(1), corner(2)])
    };
    reader.map(face).collect::<Result<_, String>>().map(Mesh)
}

fn obj(bytes: &[u8]) -> Result<Mesh, String> {
    let options =
        tobj::LoadOptions { triangulate: true, ignore_lines: true, ignore_points: true, ..Default::default() };
    let no_materials = |_: &std::path::Path| Ok(Default::default());
    let (models, _) =
        tobj::load_obj_buf(&mut Cursor::new(bytes), &options, no_materials).map_err(|fault| fault.to_string())?;
    let of = |model: &tobj::Model| {
        let vertices: Vec<f64> = model.mesh.positions.iter().map(|&part| f64::from(part)).collect();
        let faces: Vec<f64> = model.mesh.indices.iter().map(|&index| f64::from(index)).collect();
        Mesh::of(&vertices, &faces).map(|mesh| mesh.0)
    };
    models
        .iter()
        .map(of)
        .collect::<Option<Vec<_>>>()
        .map(|parts| Mesh(parts.concat()))
        .ok_or_else(|| "a face has no vertex".to_owned())
}

/// MuJoCo's own format: numbers of vertices, normals, texture coordinates and faces, then these in a row, four bytes
/// each number.
fn msh(bytes: &[u8]) -> Option<Mesh> {
    let words: Vec<[u8; 4]> = bytes.chunks(4).map(|word| word.try_into().ok()).collect::<Option<_>>()?;
    let count = |k: usize| usize::try_from(i32::from_le_bytes(*words.get(k)?)).ok();
    let (vertices, normals, places, faces) = (count(0)?, count(1)?, count(2)?, count(3)?);
    let after = 4 + 3 * vertices + 3 * normals + 2 * places;
    let numbers: Vec<f64> =
        words.get(4..4 + 3 * vertices)?.iter().map(|word| f64::from(f32::from_le_bytes(*word))).collect();
    let indices: Vec<f64> =
        words.get(after..after + 3 * faces)?.iter().map(|word| f64::from(i32::from_le_bytes(*word))).collect();
    Mesh::of(&numbers, &indices)
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [f64; 12] = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
    const FACES: [f64; 12] = [0.0, 2.0, 1.0, 0.0, 1.0, 3.0, 0.0, 3.0, 2.0, 1.0, 2.0, 3.0];

    fn is_near(inertia: &Inertia, mass: f64, center: [f64; 3], moments: [f64; 3]) {
        let principal = inertia.tensor.symmetric_eigenvalues();
        let mut found: Vec<f64> = principal.iter().copied().collect();
        found.sort_by(f64::total_cmp);
        let close = |a: f64, b: f64| (a - b).abs() < 1e-6 * b.abs().max(1e-3);
        assert!(close(inertia.mass, mass), "{inertia:?}");
        assert!(inertia.center.iter().zip(center).all(|(a, b)| close(*a, b)), "{inertia:?}");
        assert!(found.iter().zip(moments).all(|(a, b)| close(*a, b)), "{found:?}");
    }

    #[test]
    fn a_tetrahedron_has_mujocos_mass_and_moments() {
        let mesh = Mesh::of(&CORNERS, &FACES).expect("faces");
        let moments = [10.416_666_67e-3, 10.416_666_67e-3, 16.666_666_67e-3];
        for mass in [Mass::Exact, Mass::Legacy] {
            is_near(&mesh.inertia(mass).expect("a body"), 1.0 / 6.0, [0.25; 3], moments);
        }
        let inside_out = mesh.clone().moved(|vertex| Vector3::new(-vertex.x, vertex.y, vertex.z));
        is_near(&inside_out.inertia(Mass::Exact).expect("a body"), 1.0 / 6.0, [-0.25, 0.25, 0.25], moments);
        let shell = mesh.inertia(Mass::Shell).expect("a shell");
        is_near(&shell, 2.366_025_403_8, [shell.center.x; 3], [0.245_281_31, 0.245_281_31, 0.394_337_57]);
        assert!(Mesh::of(&CORNERS, &[0.0, 1.0, 4.0]).is_none() && Mesh::default().inertia(Mass::Exact).is_none());
    }

    #[test]
    fn files_of_all_formats_are_one_mesh() {
        let corner = |k: f64| {
            format!(
                "vertex {}",
                CORNERS[3 * k as usize..3 * k as usize + 3].iter().map(f64::to_string).collect::<Vec<_>>().join(" ")
            )
        };
        let faces = FACES.chunks(3).map(|face| {
            let corners: Vec<String> = face.iter().map(|&k| corner(k)).collect();
            format!("facet normal 0 0 0\nouter loop\n{}\nendloop\nendfacet\n", corners.join("\n"))
        });
        let stl = format!("solid t\n{}endsolid t\n", faces.collect::<String>());
        let lines = |word: &str, numbers: &[f64], more: f64| {
            numbers
                .chunks(3)
                .map(|row| format!("{word} {} {} {}\n", row[0] + more, row[1] + more, row[2] + more))
                .collect::<String>()
        };
        let obj = lines("v", &CORNERS, 0.0) + &lines("f", &FACES, 1.0);
        let mut msh: Vec<u8> = [4_i32, 0, 0, 4].iter().flat_map(|count| count.to_le_bytes()).collect();
        msh.extend(CORNERS.iter().flat_map(|&part| (part as f32).to_le_bytes()));
        msh.extend(FACES.iter().flat_map(|&index| (index as i32).to_le_bytes()));
        for (bytes, ending) in [(stl.as_bytes(), "STL"), (obj.as_bytes(), "obj"), (&msh[..], "msh")] {
            let inertia = Mesh::read(bytes, ending).expect(ending).inertia(Mass::Exact).expect("a body");
            assert!((inertia.mass - 1.0 / 6.0).abs() < 1e-12, "{ending}: {inertia:?}");
        }
        assert!(Mesh::read(&msh[..40], "msh").is_err() && Mesh::read(b"", "dae").is_err());
    }
}
