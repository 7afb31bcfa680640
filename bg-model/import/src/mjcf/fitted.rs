//! Primitives fitted to meshes: a `geom` of another type than mesh that names one.
//!
//! In: a surface, its inertia, the type. Out: the primitive and its frame in the mesh's. Method, as MuJoCo's: the axes
//! are the principal ones of the mesh, the largest moment first. Sizes come from the box with the mesh's moments, or
//! with `fitaabb` from the bounds of its vertices along these axes. Source: MuJoCo's XML reference, `geom/mesh` and
//! `compiler/fitaabb`; checked against MuJoCo 4.0.

use nalgebra::{Matrix3, Vector3};

use crate::geometry::Shape;
use crate::mesh::Mesh;
use crate::robot::{Inertia, Pose};

/// A primitive in a mesh's frame.
pub struct Fitted {
    /// With its sizes, m.
    pub shape: Shape,
    /// Its frame in the mesh's.
    pub frame: Pose,
    /// Whether the mesh says its axes: where moments are equal, MuJoCo may choose others.
    pub is_unique: bool,
}

/// Types that are fitted.
#[derive(Clone, Copy, PartialEq, Eq)]
pub enum FittedShape {
    Sphere,
    Capsule,
    Cylinder,
    Ellipsoid,
    Cuboid,
}

impl FittedShape {
    /// By its word in a file; none where it is not fitted.
    pub fn new(word: &str) -> Option<Self> {
        Some(match word {
            "sphere" => Self::Sphere,
            "capsule" => Self::Capsule,
            "cylinder" => Self::Cylinder,
            "ellipsoid" => Self::Ellipsoid,
            "box" => Self::Cuboid,
            _ => return None,
        })
    }

    fn shape(self, [x, y, z]: [f64; 3]) -> Shape {
        match self {
            Self::Sphere => Shape::Ellipsoid(Vector3::repeat(x)),
            Self::Capsule => Shape::Capsule(x, y),
            Self::Cylinder => Shape::Cylinder(x, y),
            Self::Ellipsoid => Shape::Ellipsoid(Vector3::new(x, y, z)),
            Self::Cuboid => Shape::Cuboid(Vector3::new(x, y, z)),
        }
    }
}

/// Moments nearer to each other than this part of the largest are equal: MuJoCo stores vertices in single precision.
const EQUAL: f64 = 1e-6;

/// To the box of an inertia, sizes times `scale`.
pub fn to_moments(kind: FittedShape, inertia: &Inertia, scale: f64) -> Fitted {
    let (axes, gaps) = principal(inertia);
    let half = inertia.box_edges(&axes) / 2.0;
    let radius = (half.x + half.y) / 2.0;
    let sizes = match kind {
        FittedShape::Sphere => [half.mean(), 0.0, 0.0],
        FittedShape::Capsule => [radius, (half.z - radius / 2.0).max(0.0), 0.0],
        FittedShape::Cylinder => [radius, half.z, 0.0],
        FittedShape::Ellipsoid | FittedShape::Cuboid => half.into(),
    };
    // A box with two equal moments has equal edges across: any turn of it has the same moments.
    let is_round = matches!(kind, FittedShape::Capsule | FittedShape::Cylinder);
    Fitted {
        shape: kind.shape(sizes.map(|size| scale * size)),
        frame: Pose { turned: axes, place: inertia.center },
        is_unique: !is_round || gaps[1] > EQUAL,
    }
}

/// To the bounds of a mesh's vertices along the principal axes of its inertia, sizes times `scale`.
pub fn to_bounds(kind: FittedShape, mesh: &Mesh, inertia: &Inertia, scale: f64) -> Fitted {
    let (axes, gaps) = principal(inertia);
    let vertices: Vec<Vector3<f64>> =
        mesh.0.iter().flatten().map(|vertex| axes.transpose() * (vertex - inertia.center)).collect();
    let infinity = Vector3::repeat(f64::INFINITY);
    let least = vertices.iter().fold(infinity, |least, vertex| least.inf(vertex));
    let most = vertices.iter().fold(-infinity, |most, vertex| most.sup(vertex));
    let (middle, half) = ((least + most) / 2.0, (most - least) / 2.0);
    let radius = half.x.max(half.y);
    let sizes = match kind {
        FittedShape::Sphere => [half.max(), 0.0, 0.0],
        FittedShape::Capsule => [radius, (half.z - radius).max(0.0), 0.0],
        FittedShape::Cylinder => [radius, half.z, 0.0],
        FittedShape::Ellipsoid | FittedShape::Cuboid => half.into(),
    };
    Fitted {
        shape: kind.shape(sizes.map(|size| scale * size)),
        frame: Pose { turned: axes, place: inertia.center + axes * middle },
        is_unique: gaps.min() > EQUAL,
    }
}

/// Principal axes, the largest moment first; how far each moment is from the next, in parts of the largest.
fn principal(inertia: &Inertia) -> (Matrix3<f64>, nalgebra::Vector2<f64>) {
    let found = inertia.tensor.symmetric_eigen();
    let mut order = [0, 1, 2];
    order.sort_by(|&a, &b| found.eigenvalues[b].total_cmp(&found.eigenvalues[a]));
    let column = |k: usize| found.eigenvectors.column(order[k]).into_owned();
    let axes = Matrix3::from_columns(&[column(0), column(1), column(0).cross(&column(1))]);
    let [first, second, third] = order.map(|k| found.eigenvalues[k] / found.eigenvalues.amax());
    (axes, nalgebra::Vector2::new(first - second, second - third))
}
