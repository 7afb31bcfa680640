//! Links of a tree of joints: what moves each, and vectors and matrices between its axes and those of its parent.
//!
//! In: a link with its coordinate. Out: values of one in the axes of the other. A link's own freedom is about or along
//! its third axis.

use crate::expr::{Id, Pool};
use crate::system::Value;
use crate::system::rigid::Mass;

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
    /// What the recursion counts to it, about its origin.
    pub counted: Mass,
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
    /// Where dry friction or stops may hold it.
    pub locked: Option<Locked>,
    /// Of a link whose body keeps its orientation.
    pub own: Option<Own>,
}

/// A link that dry friction or stops may hold.
#[derive(Clone, Copy, Debug)]
pub struct Locked {
    /// 1 where it sticks or rests, else 0.
    pub acts: Id,
    /// The rate of its speed there.
    pub rate: Id,
}

impl Locked {
    /// 1 where nothing holds it, else 0.
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
