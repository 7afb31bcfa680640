//! Scalars, vectors and matrices of expressions.
//!
//! In: component expressions. Out: component expressions; matrices are stored by rows.

use crate::expr::{Function, Id, Pool};
use crate::graph::Shape;

/// A value of 1, 3 or 9 components.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Value(pub Vec<Id>);

impl Value {
    /// A scalar.
    pub fn scalar(id: Id) -> Self {
        Self(vec![id])
    }

    /// Its shape.
    pub fn shape(&self) -> Shape {
        Shape::of_components(self.0.len())
    }

    /// Zero of this many components.
    pub fn zero(pool: &mut Pool, components: usize) -> Self {
        Self(vec![pool.zero(); components])
    }

    /// The diagonal matrix of a vector.
    pub fn diagonal(pool: &mut Pool, of: &[Id]) -> Self {
        let zero = pool.zero();
        Self((0..9).map(|k| if k % 4 == 0 { of[k / 4] } else { zero }).collect())
    }

    /// The unit matrix.
    pub fn identity(pool: &mut Pool) -> Self {
        let one = pool.one();
        Self::diagonal(pool, &[one; 3])
    }

    /// The matrix of the cross product: `skew(a) b = a x b`.
    pub fn skew(&self, pool: &mut Pool) -> Self {
        let (x, y, z) = (self.0[0], self.0[1], self.0[2]);
        let zero = pool.zero();
        let (nx, ny, nz) = (pool.neg(x), pool.neg(y), pool.neg(z));
        Self(vec![zero, nz, y, z, zero, nx, ny, x, zero])
    }

    /// The transposed matrix.
    pub fn transpose(&self) -> Self {
        Self((0..9).map(|k| self.0[3 * (k % 3) + k / 3]).collect())
    }

    /// The matrix whose lower half is the upper one, as it is but for rounding.
    pub fn symmetric(&self) -> Self {
        Self((0..9).map(|k| self.0[3 * (k / 3).min(k % 3) + (k / 3).max(k % 3)]).collect())
    }

    /// The sum; a zero scalar fits any shape.
    pub fn add(&self, pool: &mut Pool, other: &Self) -> Self {
        match (self.0.len(), other.0.len()) {
            (a, b) if a == b => Self(self.0.iter().zip(&other.0).map(|(&a, &b)| pool.add(a, b)).collect()),
            (1, _) => other.clone(),
            _ => self.clone(),
        }
    }

    /// The negative.
    pub fn negate(&self, pool: &mut Pool) -> Self {
        Self(self.0.iter().map(|&a| pool.neg(a)).collect())
    }

    /// A numeric multiple.
    pub fn scale(&self, pool: &mut Pool, factor: f64) -> Self {
        Self(self.0.iter().map(|&a| pool.scale(factor, a)).collect())
    }

    /// The product: a scalar scales, a matrix maps.
    pub fn multiply(&self, pool: &mut Pool, other: &Self) -> Self {
        match (self.0.len(), other.0.len()) {
            (1, _) => Self(other.0.iter().map(|&b| pool.mul(self.0[0], b)).collect()),
            (_, 1) => Self(self.0.iter().map(|&a| pool.mul(a, other.0[0])).collect()),
            (9, columns) => {
                let width = columns / 3;
                Self((0..columns).map(|k| row_times_column(pool, self, k / width, other, k % width, width)).collect())
            }
            _ => self.clone(),
        }
    }

    /// The quotient by a scalar.
    pub fn divide(&self, pool: &mut Pool, divisor: Id) -> Self {
        Self(self.0.iter().map(|&a| pool.div(a, divisor)).collect())
    }

    /// The scalar product.
    pub fn dot(&self, pool: &mut Pool, other: &Self) -> Id {
        let products: Vec<Id> = self.0.iter().zip(&other.0).map(|(&a, &b)| pool.mul(a, b)).collect();
        pool.sum(&products)
    }

    /// The vector product.
    pub fn cross(&self, pool: &mut Pool, other: &Self) -> Self {
        self.skew(pool).multiply(pool, other)
    }

    /// The dyadic product.
    pub fn outer(&self, pool: &mut Pool, other: &Self) -> Self {
        Self((0..9).map(|k| pool.mul(self.0[k / 3], other.0[k % 3])).collect())
    }

    /// The Euclidean norm.
    pub fn norm(&self, pool: &mut Pool) -> Id {
        let square = self.dot(pool, self);
        pool.call(Function::Sqrt, &[square])
    }

    /// The inverse matrix, by cofactors.
    pub fn inverse(&self, pool: &mut Pool) -> Self {
        let cofactor = |pool: &mut Pool, i: usize, j: usize| {
            let at = |row: usize, column: usize| self.0[3 * (row % 3) + column % 3];
            let main = pool.mul(at(i + 1, j + 1), at(i + 2, j + 2));
            let side = pool.mul(at(i + 1, j + 2), at(i + 2, j + 1));
            pool.sub(main, side)
        };
        let first: Vec<Id> = (0..3).map(|j| cofactor(pool, 0, j)).collect();
        let determinant = Self(self.0[..3].to_vec()).dot(pool, &Self(first));
        Self(
            (0..9)
                .map(|k| {
                    let entry = cofactor(pool, k % 3, k / 3);
                    pool.div(entry, determinant)
                })
                .collect(),
        )
    }

    /// The rotation matrix about axis 0, 1 or 2.
    pub fn rotation(pool: &mut Pool, axis: usize, angle: Id) -> Self {
        let (sine, cosine) = (pool.call(Function::Sin, &[angle]), pool.call(Function::Cos, &[angle]));
        let (zero, one, minus) = (pool.zero(), pool.one(), pool.neg(sine));
        let mut entries = vec![zero; 9];
        let (second, third) = ((axis + 1) % 3, (axis + 2) % 3);
        entries[4 * axis] = one;
        entries[4 * second] = cosine;
        entries[4 * third] = cosine;
        entries[3 * second + third] = minus;
        entries[3 * third + second] = sine;
        Self(entries)
    }

    /// `self` acting on a bond's variables: a number or one number an axis multiply, a tensor maps.
    pub fn act(&self, pool: &mut Pool, on: &Self) -> Self {
        if self.0.len() == 3 && on.0.len() == 3 {
            return Self(self.0.iter().zip(&on.0).map(|(&a, &b)| pool.mul(a, b)).collect());
        }
        self.multiply(pool, on)
    }

    /// The value that acts as the inverse of [`Value::act`].
    pub fn reciprocal(&self, pool: &mut Pool) -> Self {
        if self.0.len() == 9 {
            return self.inverse(pool);
        }
        Self(self.0.iter().map(|&a| pool.powi(a, -1)).collect())
    }
}

/// Row `row` of `a` times column `column` of `b`, which has `width` columns.
fn row_times_column(pool: &mut Pool, a: &Value, row: usize, b: &Value, column: usize, width: usize) -> Id {
    let products: Vec<Id> = (0..3).map(|k| pool.mul(a.0[3 * row + k], b.0[width * k + column])).collect();
    pool.sum(&products)
}
