//! Hand-written equations of motion of mechanisms, without anything of the compiler: Kane's equations for poses that
//! are functions of independent coordinates.
//!
//! In: masses, tensors, poses by coordinates. Out: a system whose states are the coordinates and their rates. Method:
//! the partial velocities and what accelerations have beside the coordinates' second derivatives are derivatives of the
//! poses, by jets of the second order (T. R. Kane, D. A. Levinson, Dynamics: Theory and Applications, 1985, sections
//! 6.1, 6.3).

use std::ops::{Add, Mul, Neg, Sub};

use bg_model::dynamics::Dynamics;
use bg_model::integrator::{Dop853, Tolerances};
use bg_model::nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use bg_model::simulation::{Finish, Settings, Span, drive};

/// A number with its first and second derivative along a line of coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Jet([f64; 3]);

impl Jet {
    fn through(self, [value, first, second]: [f64; 3]) -> Self {
        let [_, along, bent] = self.0;
        Self([value, first * along, second * along * along + first * bent])
    }

    /// With this slope along a line.
    pub fn along(value: f64, slope: f64) -> Self {
        Self([value, slope, 0.0])
    }

    pub fn value(self) -> f64 {
        self.0[0]
    }

    pub fn slope(self) -> f64 {
        self.0[1]
    }

    pub fn sin(self) -> Self {
        let (sin, cos) = self.0[0].sin_cos();
        self.through([sin, cos, -sin])
    }

    pub fn cos(self) -> Self {
        let (sin, cos) = self.0[0].sin_cos();
        self.through([cos, -sin, -cos])
    }

    pub fn sqrt(self) -> Self {
        let root = self.0[0].sqrt();
        self.through([root, 0.5 / root, -0.25 / root.powi(3)])
    }

    pub fn inverse(self) -> Self {
        let inverse = 1.0 / self.0[0];
        self.through([inverse, -inverse.powi(2), 2.0 * inverse.powi(3)])
    }
}

impl From<f64> for Jet {
    fn from(value: f64) -> Self {
        Self([value, 0.0, 0.0])
    }
}

impl Add for Jet {
    type Output = Self;
    fn add(self, other: Self) -> Self {
        Self(std::array::from_fn(|k| self.0[k] + other.0[k]))
    }
}

impl Sub for Jet {
    type Output = Self;
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Neg for Jet {
    type Output = Self;
    fn neg(self) -> Self {
        Self(self.0.map(|part| -part))
    }
}

impl Mul for Jet {
    type Output = Self;
    fn mul(self, other: Self) -> Self {
        let (a, b) = (self.0, other.0);
        Self([a[0] * b[0], a[1] * b[0] + a[0] * b[1], a[2] * b[0] + 2.0 * a[1] * b[1] + a[0] * b[2]])
    }
}

/// A vector.
pub type Place = [Jet; 3];
/// A rotation, by rows.
pub type Turn = [[Jet; 3]; 3];

pub fn place(of: [f64; 3]) -> Place {
    of.map(Jet::from)
}

pub fn plus(a: Place, b: Place) -> Place {
    std::array::from_fn(|k| a[k] + b[k])
}

pub fn minus(a: Place, b: Place) -> Place {
    std::array::from_fn(|k| a[k] - b[k])
}

pub fn times(a: Place, by: Jet) -> Place {
    a.map(|part| part * by)
}

pub fn dot(a: Place, b: Place) -> Jet {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: Place, b: Place) -> Place {
    std::array::from_fn(|k| a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3])
}

pub fn unit(a: Place) -> Place {
    times(a, dot(a, a).sqrt().inverse())
}

/// The rotation whose columns are these.
pub fn columns(x: Place, y: Place, z: Place) -> Turn {
    std::array::from_fn(|row| [x[row], y[row], z[row]])
}

pub fn turned(turn: &Turn, of: Place) -> Place {
    turn.map(|row| dot(row, of))
}

pub fn product(a: &Turn, b: &Turn) -> Turn {
    std::array::from_fn(|row| std::array::from_fn(|column| dot(a[row], [b[0][column], b[1][column], b[2][column]])))
}

pub fn transposed(of: &Turn) -> Turn {
    std::array::from_fn(|row| std::array::from_fn(|column| of[column][row]))
}

/// The rotation about a coordinate axis by the angle of this cosine and sine.
pub fn about_by(axis: usize, [cos, sin]: [Jet; 2]) -> Turn {
    let mut turn = [[Jet::from(0.0); 3]; 3];
    let (second, third) = ((axis + 1) % 3, (axis + 2) % 3);
    turn[axis][axis] = Jet::from(1.0);
    (turn[second][second], turn[second][third]) = (cos, -sin);
    (turn[third][second], turn[third][third]) = (sin, cos);
    turn
}

pub fn about(axis: usize, angle: Jet) -> Turn {
    about_by(axis, [angle.cos(), angle.sin()])
}

/// A body: its mass, kg, and principal moments about its centre, kg*m^2.
#[derive(Clone, Copy, Debug)]
pub struct Body {
    pub mass: f64,
    pub inertia: [f64; 3],
}

/// Where bodies are by the coordinates: their centres, m, and their axes.
pub type Poses = fn(&[Jet]) -> Vec<(Place, Turn)>;

/// A mechanism of bodies whose poses are known by independent coordinates.
#[derive(Debug)]
pub struct Hand {
    pub bodies: Vec<Body>,
    pub coordinates: usize,
    pub poses: Poses,
    /// m/s^2.
    pub gravity: [f64; 3],
    /// What else acts along each coordinate, by these and their rates.
    pub forces: fn(&[f64], &[f64]) -> Vec<f64>,
}

fn part(of: &Place, order: usize) -> Vector3<f64> {
    Vector3::from_fn(|k, _| of[k].0[order])
}

fn matrix(of: &Turn, order: usize) -> Matrix3<f64> {
    Matrix3::from_fn(|row, column| of[row][column].0[order])
}

/// The vector of the skew part.
fn vector(of: &Matrix3<f64>) -> Vector3<f64> {
    0.5 * Vector3::new(of[(2, 1)] - of[(1, 2)], of[(0, 2)] - of[(2, 0)], of[(1, 0)] - of[(0, 1)])
}

impl Hand {
    /// The poses with their derivatives along a line from `q`.
    fn along(&self, q: &[f64], line: &[f64]) -> Vec<(Place, Turn)> {
        (self.poses)(&q.iter().zip(line).map(|(&q, &along)| Jet::along(q, along)).collect::<Vec<_>>())
    }

    fn accelerations(&self, q: &[f64], u: &[f64]) -> DVector<f64> {
        let n = self.coordinates;
        let unit = |i: usize| (0..n).map(|k| f64::from(u8::from(k == i))).collect::<Vec<_>>();
        let partial: Vec<Vec<(Place, Turn)>> = (0..n).map(|i| self.along(q, &unit(i))).collect();
        let moving = self.along(q, u);
        let gravity = Vector3::from(self.gravity);
        let mut inertia = DMatrix::zeros(n, n);
        let mut forces = DVector::from_vec((self.forces)(q, u));
        for (number, body) in self.bodies.iter().enumerate() {
            let (at, turn) = &moving[number];
            let axes = matrix(turn, 0);
            let tensor = axes * Matrix3::from_diagonal(&Vector3::from(body.inertia)) * axes.transpose();
            let spin = vector(&(matrix(turn, 1) * axes.transpose()));
            let bent = vector(&(matrix(turn, 2) * axes.transpose()));
            let moment = tensor * bent + spin.cross(&(tensor * spin));
            let force = body.mass * (part(at, 2) - gravity);
            let by = |i: usize| {
                let (at, turn) = &partial[i][number];
                (part(at, 1), vector(&(matrix(turn, 1) * axes.transpose())))
            };
            for i in 0..n {
                let (velocity, turning) = by(i);
                forces[i] -= velocity.dot(&force) + turning.dot(&moment);
                for j in 0..n {
                    let (other, also) = by(j);
                    inertia[(i, j)] += body.mass * velocity.dot(&other) + turning.dot(&(tensor * also));
                }
            }
        }
        inertia.cholesky().expect("coordinates are independent").solve(&forces)
    }
}

impl Dynamics for Hand {
    fn states(&self) -> usize {
        2 * self.coordinates
    }

    fn switches(&self) -> usize {
        0
    }

    fn rate(&self, _: f64, x: &[f64], _: &[bool], dx: &mut [f64]) {
        let (q, u) = x.split_at(self.coordinates);
        dx[..u.len()].copy_from_slice(u);
        dx[u.len()..].copy_from_slice(self.accelerations(q, u).as_slice());
    }
}

/// A run by DOP853 at tight tolerances.
pub fn run(model: &dyn Dynamics, start: &[f64], t_end: f64) -> Finish {
    let settings = Settings { tolerances: Tolerances::new(1e-11, 1e-12), ..Settings::default() };
    let span = Span { t0: 0.0, t_end };
    let finish = drive(model, &mut Dop853::new(), start, span, &settings, None, &mut ());
    finish.unwrap_or_else(|failure| panic!("{failure}"))
}
