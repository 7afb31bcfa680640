//! Links of a tree of joints: what moves each, and vectors and matrices between its axes and those of its parent.
//!
//! In: a link with its coordinate. Out: values of one in the axes of the other. A link's own freedom is about or along its
//! third axis.

use crate::expr::{Id, Pool};
use crate::system::Value;

/// What a step lets go, with its coordinate about or along the third axis.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Freedom {
    /// An angle, rad, and its speed, rad/s.
    Turn,
    /// A travel, m, and its speed, m/s.
    Slide,
    /// All turning: the body keeps its orientation and its angular momentum.
    Ball,
    /// All motion: the body keeps all its states.
    Free,
}

impl Freedom {
    /// Whether it has a coordinate of its own.
    pub fn has_coordinate(self) -> bool {
        matches!(self, Self::Turn | Self::Slide)
    }
}

/// The place and the speed of a step, with the cosine and the sine of an angle.
#[derive(Clone, Copy, Debug)]
pub struct Moves {
    /// An angle, rad, or a travel, m.
    pub place: Id,
    /// Its cosine; 1 of a travel.
    pub cosine: Id,
    /// Its sine; 0 of a travel.
    pub sine: Id,
    /// Its speed, rad/s or m/s.
    pub speed: Id,
}

/// What one step of a joint moves.
#[derive(Clone, Debug)]
pub struct Link {
    /// The joint's place in their list, and the step's in the joint.
    pub step: (usize, usize),
    /// What it lets go.
    pub freedom: Freedom,
    /// The link that carries it; none on the ground.
    pub parent: Option<usize>,
    /// From the axes of its freedom to those of its parent.
    pub fixed: Value,
    /// Its origin, from its parent's, in the parent's axes, where it has not slid.
    pub offset: Value,
    /// What the recursion counts to it: mass, first moment, tensor about the origin.
    pub counted: (Id, Value, Value),
}

/// What moves a link.
#[derive(Clone, Debug)]
pub struct Moved {
    /// Its coordinate.
    pub moves: Moves,
    /// Its origin, from its parent's, in the parent's axes.
    pub offset: Value,
    /// The torque about its hinge, or the force along its slide.
    pub effort: Id,
    /// Moment about its origin and force, in its axes.
    pub load: [Value; 2],
    /// Where dry friction may hold it.
    pub locked: Option<Locked>,
    /// Of a link whose body keeps its orientation.
    pub own: Option<Own>,
}

/// A link that dry friction may hold.
#[derive(Clone, Copy, Debug)]
pub struct Locked {
    /// 1 where it sticks, else 0.
    pub acts: Id,
    /// The rate of its speed where it sticks.
    pub rate: Id,
}

impl Locked {
    /// 1 where it slides, else 0.
    pub fn slides(&self, pool: &mut Pool) -> Id {
        pool.linear(1.0, &[(self.acts, -1.0)])
    }
}

/// What the states of a body say of its link.
#[derive(Clone, Debug)]
pub struct Own {
    /// From its axes to its parent's.
    pub turned: Value,
    /// Its angular velocity, in its axes.
    pub spin: Value,
    /// Of one that moves freely the velocity of its origin, in its axes.
    pub fast: Option<Value>,
}

impl Moved {
    /// What moves a link without a load.
    pub fn new(pool: &mut Pool, link: &Link, moves: Moves, own: Option<Own>) -> Self {
        let (zero, still) = (pool.zero(), Value::zero(pool, 3));
        let mut offset = link.offset.clone();
        if link.freedom == Freedom::Slide {
            let by = link.fixed.multiply(pool, &Value(vec![zero, zero, moves.place]));
            offset = offset.add(pool, &by);
        }
        Self { moves, offset, effort: zero, load: [still.clone(), still], locked: None, own }
    }
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
pub fn gyroscopic(pool: &mut Pool, about: &Value, square: &Value) -> Value {
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

/// What a tensor about a point gains seen from elsewhere: the point is at `by`, where the first moment about it is
/// `first`.
pub fn steiner(pool: &mut Pool, mass: Id, first: &Value, by: &Value) -> Value {
    let moment = by.multiply(pool, &Value::scalar(mass));
    let twice = first.scale(pool, 2.0);
    let size = moment.add(pool, &twice).dot(pool, by);
    let size = Value::diagonal(pool, &[size; 3]);
    let half = moment.add(pool, first);
    let (one, other) = (half.outer(pool, by), by.outer(pool, first));
    let sum = one.add(pool, &other).negate(pool);
    size.add(pool, &sum).symmetric()
}

/// R of a matrix R A R^T turned about the third axis, where A's parts that are equal are one.
fn about_third(pool: &mut Pool, own: &Moved, of: &Value) -> Value {
    if pool.is_zero(own.moves.sine) {
        return of.clone();
    }
    let (c, s) = (own.moves.cosine, own.moves.sine);
    let a = &of.0;
    let difference = pool.sub(a[0], a[4]);
    let sides = pool.add(a[1], a[3]);
    let products = [pool.mul(s, difference), pool.mul(c, sides)];
    let mixed = pool.sum(&products);
    let (sine, cosine) = (pool.mul(s, mixed), pool.mul(c, mixed));
    let mut turned = a.clone();
    turned[0] = pool.sub(a[0], sine);
    turned[4] = pool.add(a[4], sine);
    turned[1] = pool.sub(cosine, a[3]);
    turned[3] = pool.sub(cosine, a[1]);
    for [x, y] in [[2, 5], [6, 7]] {
        let [first, second] = rotated(pool, [c, s], [a[x], a[y]]);
        (turned[x], turned[y]) = (first, second);
    }
    Value(turned)
}

fn rotated(pool: &mut Pool, [c, s]: [Id; 2], [x, y]: [Id; 2]) -> [Id; 2] {
    let products = [pool.mul(c, x), pool.mul(s, y), pool.mul(s, x), pool.mul(c, y)];
    [pool.sub(products[0], products[1]), pool.add(products[2], products[3])]
}

/// A matrix of a link in its parent's axes.
pub fn matrix_up(pool: &mut Pool, link: &Link, own: &Moved, of: &Value) -> Value {
    if let Some(own) = &own.own {
        return own.turned.multiply(pool, of).multiply(pool, &own.turned.transpose());
    }
    let about = about_third(pool, own, of);
    link.fixed.multiply(pool, &about).multiply(pool, &link.fixed.transpose())
}

/// A vector of a link in its parent's axes.
pub fn up(pool: &mut Pool, link: &Link, own: &Moved, of: &Value) -> Value {
    if let Some(own) = &own.own {
        return own.turned.multiply(pool, of);
    }
    let [x, y] = rotated(pool, [own.moves.cosine, own.moves.sine], [of.0[0], of.0[1]]);
    link.fixed.multiply(pool, &Value(vec![x, y, of.0[2]]))
}

/// A vector of a link's parent in the link's axes.
pub fn down(pool: &mut Pool, link: &Link, own: &Moved, of: &Value) -> Value {
    if let Some(own) = &own.own {
        return own.turned.transpose().multiply(pool, of);
    }
    let inside = link.fixed.transpose().multiply(pool, of);
    let minus = pool.neg(own.moves.sine);
    let [x, y] = rotated(pool, [own.moves.cosine, minus], [inside.0[0], inside.0[1]]);
    Value(vec![x, y, inside.0[2]])
}

/// How a link's origin is accelerated by the turning of its parent and its own sliding.
pub fn pull(pool: &mut Pool, link: &Link, own: &Moved, (squares, spins): (&[Value], &[Value])) -> Value {
    let Some(parent) = link.parent else { return Value::zero(pool, 3) };
    let pull = squares[parent].multiply(pool, &own.offset);
    if link.freedom != Freedom::Slide {
        return pull;
    }
    let zero = pool.zero();
    let twice = pool.scale(2.0, own.moves.speed);
    let sliding = link.fixed.multiply(pool, &Value(vec![zero, zero, twice]));
    let beside = spins[parent].cross(pool, &sliding);
    pull.add(pool, &beside)
}

/// The accelerations that a link has of its parent's, `under`, before what its own speed does; `pull` is that of [`pull`].
pub fn brought(pool: &mut Pool, link: &Link, own: &Moved, under: &[Value; 2], pull: &Value) -> [Value; 2] {
    let [turning, there] = under;
    let beside = turning.cross(pool, &own.offset);
    let there = there.add(pool, &beside).add(pool, pull);
    [turning, &there].map(|part| down(pool, link, own, part))
}

/// The angular acceleration w x z times the speed of a turn.
pub fn beside_speed(pool: &mut Pool, freedom: Freedom, own: &Moved, spin: &Value) -> Value {
    if freedom != Freedom::Turn {
        return Value::zero(pool, 3);
    }
    let (x, y) = (pool.mul(spin.0[1], own.moves.speed), pool.mul(spin.0[0], own.moves.speed));
    Value(vec![x, pool.neg(y), pool.zero()])
}
