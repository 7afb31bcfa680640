//! Rigid links of a tree: their mass, how they move, and the wrenches that this takes.
//!
//! In: links with their coordinates. Out: values in the axes of each link. Accelerations are those of the links'
//! origins, so that no velocity of a point is needed; what turning does is linear in the products of an angular
//! velocity's components. A full tensor is written by second moments, of which a wrench takes fewer terms (Khalil and
//! Dombre, Modeling, Identification and Control of Robots, 2002, section 9.5, has the field of accelerations for
//! forces).

use super::link::{Freedom, Link, Moved, down};
use crate::expr::{Id, Pool};
use crate::system::Value;

/// The angular velocity of each link, in its axes.
pub fn spins(pool: &mut Pool, links: &[Link], moved: &[Moved]) -> Vec<Value> {
    let mut spins: Vec<Value> = Vec::new();
    for (link, own) in links.iter().zip(moved) {
        let mut spin = match (&own.own, link.parent) {
            (Some(own), _) => own.spin.clone(),
            (None, Some(parent)) => down(pool, link, own, &spins[parent]),
            (None, None) => Value::zero(pool, 3),
        };
        if link.freedom == Freedom::Turn {
            spin.0[2] = pool.add(spin.0[2], own.moves.speed);
        }
        spins.push(spin);
    }
    spins
}

/// How links are accelerated.
#[derive(Clone, Debug)]
pub struct Accelerated {
    /// Angular acceleration and that of the origin of each link, in its axes.
    pub links: Vec<[Value; 2]>,
    /// The angular velocities.
    spins: Vec<Value>,
}

impl Accelerated {
    /// Of links with these angular velocities, on a ground with this acceleration. `own` has of each link the rate of
    /// its speed, or what is known of its accelerations beside those that carry it.
    pub fn of(
        pool: &mut Pool,
        links: &[Link],
        (moved, spins): (&[Moved], &[Value]),
        ground: &Value,
        own: impl Fn(usize) -> Given,
    ) -> Self {
        let mut all = Self { links: Vec::new(), spins: spins.to_vec() };
        for (k, link) in links.iter().enumerate() {
            let accelerations = match own(k) {
                Given::Accelerations(turning, Some(there)) => [turning, there],
                Given::Accelerations(turning, None) => {
                    let [_, there] = all.carried(pool, link, &moved[k], ground);
                    [turning, there]
                }
                Given::Rate(rate) => {
                    let [mut turning, mut there] = all.carried(pool, link, &moved[k], ground);
                    let along = if link.freedom == Freedom::Turn {
                        let beside = beside_speed(pool, &moved[k], &spins[k]);
                        turning = turning.add(pool, &beside);
                        &mut turning
                    } else {
                        &mut there
                    };
                    along.0[2] = pool.add(along.0[2], rate);
                    [turning, there]
                }
            };
            all.links.push(accelerations);
        }
        all
    }

    /// How a link moves.
    pub fn motion(&self, link: usize) -> LinkMotion<'_> {
        let [turning, there] = &self.links[link];
        LinkMotion { spin: &self.spins[link], turning, there }
    }

    /// What a link has of what carries it.
    fn carried(&self, pool: &mut Pool, link: &Link, own: &Moved, ground: &Value) -> [Value; 2] {
        let Some(parent) = link.parent else { return [Value::zero(pool, 3), down(pool, link, own, ground)] };
        let [turning, there] = &self.links[parent];
        let pull = pull(pool, link, own, (&self.spins[parent], turning));
        let there = there.add(pool, &pull);
        [turning, &there].map(|part| down(pool, link, own, part))
    }
}

/// What is known of a link's accelerations.
pub enum Given {
    /// The rate of its speed.
    Rate(Id),
    /// Its angular acceleration, and that of its origin where what carries it does not give that.
    Accelerations(Value, Option<Value>),
}

/// w x (w x ) as a matrix, w w^T - w^2.
pub fn square(pool: &mut Pool, spin: &Value) -> Value {
    let w = &spin.0;
    let squares: Vec<Id> = w.iter().map(|&part| pool.powi(part, 2)).collect();
    Value(
        (0..9)
            .map(|k| {
                let (row, column) = (k / 3, k % 3);
                if row == column {
                    let others = [squares[(row + 1) % 3], squares[(row + 2) % 3]];
                    let sum = pool.sum(&others);
                    pool.neg(sum)
                } else {
                    pool.mul(w[row], w[column])
                }
            })
            .collect(),
    )
}

/// w x I w by the products of w's components: y I_z - z I_y of the vectors I w w^T.
fn gyroscopic(pool: &mut Pool, about: &Value, square: &Value) -> Value {
    let at = |row: usize, column: usize| about.0[3 * (row % 3) + column % 3];
    let product = |row: usize, column: usize| square.0[3 * (row % 3) + column % 3];
    Value(
        (0..3)
            .map(|i| {
                let (j, k) = (i + 1, i + 2);
                let apart = pool.sub(at(k, k), at(j, j));
                // The diagonal of w w^T - w^2 differs as the squares do.
                let squares = pool.sub(product(j, j), product(k, k));
                let parts = [(apart, product(j, k)), (at(j, k), squares), (at(i, k), product(i, j))];
                let mut terms: Vec<(Id, f64)> = parts.iter().map(|&(a, b)| (pool.mul(a, b), 1.0)).collect();
                terms.push((pool.mul(at(i, j), product(i, k)), -1.0));
                pool.linear(0.0, &terms)
            })
            .collect(),
    )
}

/// The moment J a + w x J w that turning takes, of a body with this tensor, in its axes.
pub fn rate_of_angular(pool: &mut Pool, tensor: &Value, spin: &Value, turning: &Value) -> Value {
    let square = square(pool, spin);
    let beside = gyroscopic(pool, tensor, &square);
    tensor.multiply(pool, turning).add(pool, &beside)
}

/// What takes a place of a link to its acceleration beside that of its origin: a x r + w x (w x r) as a matrix.
fn field(pool: &mut Pool, spin: &Value, turning: &Value) -> Value {
    let swung = turning.skew(pool);
    square(pool, spin).add(pool, &swung)
}

/// Mass, kg, with its moments about a point, in the axes of a link.
#[derive(Clone, Debug)]
pub struct Mass {
    /// The mass, kg.
    pub mass: Id,
    /// The integral of r over the mass, kg m.
    pub first: Value,
    /// The integral of r r^T over it, kg m^2, by rows.
    pub second: Value,
}

/// How a link moves, in its axes.
#[derive(Clone, Copy, Debug)]
pub struct LinkMotion<'a> {
    /// Its angular velocity.
    pub spin: &'a Value,
    /// Its angular acceleration.
    pub turning: &'a Value,
    /// The acceleration of its origin.
    pub there: &'a Value,
}

impl Mass {
    /// No mass.
    pub fn none(pool: &mut Pool) -> Self {
        Self { mass: pool.zero(), first: Value::zero(pool, 3), second: Value::zero(pool, 9) }
    }

    /// A body's mass about its centre, from its tensor there.
    pub fn central(pool: &mut Pool, mass: Id, tensor: &Value) -> Self {
        let trace = pool.sum(&[tensor.0[0], tensor.0[4], tensor.0[8]]);
        let half = pool.scale(0.5, trace);
        let less = tensor.negate(pool);
        let second = Value::diagonal(pool, &[half; 3]).add(pool, &less);
        Self { mass, first: Value::zero(pool, 3), second }
    }

    /// Both together, about one point.
    pub fn add(&self, pool: &mut Pool, other: &Self) -> Self {
        Self {
            mass: pool.add(self.mass, other.mass),
            first: self.first.add(pool, &other.first),
            second: self.second.add(pool, &other.second),
        }
    }

    /// The same about another point, from which this one is at `by`.
    pub fn seen(&self, pool: &mut Pool, by: &Value) -> Self {
        let at_point = by.multiply(pool, &Value::scalar(self.mass));
        let half = at_point.scale(pool, 0.5).add(pool, &self.first).outer(pool, by);
        let second = self.second.add(pool, &half).add(pool, &half.transpose());
        Self { mass: self.mass, first: self.first.add(pool, &at_point), second }
    }

    /// The tensor about the point.
    pub fn tensor(&self, pool: &mut Pool) -> Value {
        let second = &self.second.0;
        let sums = [[4, 8], [0, 8], [0, 4]].map(|[a, b]| pool.add(second[a], second[b]));
        Value((0..9).map(|k| if k % 4 == 0 { sums[k / 4] } else { pool.neg(second[k]) }).collect())
    }

    /// Whether moments take fewer terms by the tensor than by second moments: these are diagonal, and neither of the
    /// first two is zero.
    pub fn is_by_tensor(&self, pool: &Pool) -> bool {
        let zero = |k: usize| pool.is_zero(self.second.0[k]);
        [1, 2, 3, 5, 6, 7].into_iter().all(zero) && ![0, 4].into_iter().any(zero)
    }

    /// Moment about a link's origin and force that its mass takes, by how it moves.
    pub fn wrench(&self, pool: &mut Pool, LinkMotion { spin, turning, there }: LinkMotion<'_>) -> [Value; 2] {
        let lever = self.first.cross(pool, there);
        let field = field(pool, spin, turning);
        let moment = if self.is_by_tensor(pool) {
            let tensor = self.tensor(pool);
            rate_of_angular(pool, &tensor, spin, turning)
        } else {
            turning_of(pool, &field, &self.second)
        };
        let moment = moment.add(pool, &lever);
        let swung = field.multiply(pool, &self.first);
        let force = there.multiply(pool, &Value::scalar(self.mass)).add(pool, &swung);
        [moment, force]
    }
}

/// The integral of r x (F r) over the mass, by its second moments S: the antisymmetric part of F S.
fn turning_of(pool: &mut Pool, field: &Value, second: &Value) -> Value {
    let (f, s) = (|row: usize, column: usize| field.0[3 * (row % 3) + column % 3], &second.0);
    let s = |row: usize, column: usize| s[3 * (row % 3) + column % 3];
    Value(
        (0..3)
            .map(|k| {
                let (x, y) = (k + 1, k + 2);
                let apart = pool.sub(f(y, y), f(x, x));
                let gained = [(f(y, k), s(k, x)), (f(y, x), s(x, x)), (apart, s(x, y))];
                let lost = [(f(x, k), s(k, y)), (f(x, y), s(y, y))];
                let mut terms: Vec<(Id, f64)> = gained.iter().map(|&(a, b)| (pool.mul(a, b), 1.0)).collect();
                terms.extend(lost.iter().map(|&(a, b)| (pool.mul(a, b), -1.0)));
                pool.linear(0.0, &terms)
            })
            .collect(),
    )
}

/// How a link's origin is accelerated beside that of its parent, by the parent's motion and its own
/// sliding.
fn pull(pool: &mut Pool, link: &Link, own: &Moved, (spin, turning): (&Value, &Value)) -> Value {
    let pull = field(pool, spin, turning).multiply(pool, &own.offset);
    if link.freedom != Freedom::Slide {
        return pull;
    }
    let zero = pool.zero();
    let twice = pool.scale(2.0, own.moves.speed);
    let sliding = link.fixed.multiply(pool, &Value(vec![zero, zero, twice]));
    let beside = spin.cross(pool, &sliding);
    pull.add(pool, &beside)
}

/// The accelerations that a link has of its parent's, `under`, where nothing turns.
pub fn brought(pool: &mut Pool, link: &Link, own: &Moved, under: &[Value; 2]) -> [Value; 2] {
    let [turning, there] = under;
    let beside = turning.cross(pool, &own.offset);
    let there = there.add(pool, &beside);
    [turning, &there].map(|part| down(pool, link, own, part))
}

/// The angular acceleration w x z times the speed of a turn.
fn beside_speed(pool: &mut Pool, own: &Moved, spin: &Value) -> Value {
    let (x, y) = (pool.mul(spin.0[1], own.moves.speed), pool.mul(spin.0[0], own.moves.speed));
    Value(vec![x, pool.neg(y), pool.zero()])
}
