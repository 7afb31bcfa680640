//! Coordinates whose cosines and sines are symbols of their own, so that what loops give of them can be put in.
//!
//! In: links with their moves. Out: the same with symbols, and what these are.

use std::collections::BTreeMap;

use super::joints::Joint;
use crate::expr::{Circles, Id, Node, Pool, Symbol, substitute};
use crate::system::link::{Freedom, Moves};
use crate::system::reduce::zero;

/// The symbols of a coordinate.
#[derive(Clone, Copy, Debug)]
pub(super) struct Coordinate {
    pub place: Symbol,
    pub speed: Symbol,
    /// The rate of the speed.
    pub rate: Symbol,
    /// Of an angle its cosine and its sine.
    pub angle: Option<[Symbol; 2]>,
    /// A pivot by which a loop gives it.
    pub pivot: Symbol,
}

impl Coordinate {
    /// Those of its place.
    pub fn symbols(&self) -> impl Iterator<Item = Symbol> + use<> {
        [self.place].into_iter().chain(self.angle.into_iter().flatten())
    }
}

/// The coordinates of all links.
pub(super) struct Coordinates {
    all: Vec<Coordinate>,
    /// Cosines and sines as functions of the angles.
    pub calls: BTreeMap<Symbol, Id>,
    circles: Circles,
    /// The rates of places, cosines and sines.
    pub speeds: BTreeMap<Symbol, Id>,
    /// With those of the speeds.
    pub rates: BTreeMap<Symbol, Id>,
}

/// So many symbols each coordinate has beside its place and its speed.
const MORE: usize = 4;

impl Coordinates {
    /// Of joints whose links all have one, in whose moves symbols from this number on are put; none where one has not.
    pub fn apart(pool: &mut Pool, next: usize, joints: &[Joint], moves: &mut [Vec<Moves>]) -> Option<Self> {
        let mut of = Self {
            all: Vec::new(),
            calls: BTreeMap::new(),
            circles: Circles::default(),
            speeds: BTreeMap::new(),
            rates: BTreeMap::new(),
        };
        let mut pairs = Vec::new();
        let steps = joints.iter().flat_map(|joint| joint.steps()).zip(moves.iter_mut().flatten());
        for ((step, own), first) in steps.zip((next..).step_by(MORE)) {
            let (Node::Symbol(place), Node::Symbol(speed)) =
                (pool.node(own.place).clone(), pool.node(own.speed).clone())
            else {
                return None;
            };
            let symbol = |k: usize| Symbol::numbered(Symbol::Weight, first + k);
            let angle = match step.freedom {
                Freedom::Turn => {
                    let angle = [symbol(0), symbol(1)];
                    of.calls.extend(angle.into_iter().zip([own.cosine, own.sine]));
                    [own.cosine, own.sine] = angle.map(|symbol| pool.symbol(symbol));
                    pairs.push((own.cosine, own.sine));
                    let (swung, turned) = (pool.mul(own.sine, own.speed), pool.mul(own.cosine, own.speed));
                    of.speeds.extend(angle.into_iter().zip([pool.neg(swung), turned]));
                    Some(angle)
                }
                Freedom::Slide => None,
                Freedom::Ball | Freedom::Free => return None,
            };
            of.speeds.insert(place, own.speed);
            of.rates.insert(speed, pool.symbol(symbol(2)));
            of.all.push(Coordinate { place, speed, rate: symbol(2), angle, pivot: symbol(3) });
        }
        of.circles = Circles::new(pairs);
        let speeds = of.speeds.clone();
        of.rates.extend(speeds);
        Some(of)
    }

    pub fn of(&self, link: usize) -> &Coordinate {
        &self.all[link]
    }

    pub fn count(&self) -> usize {
        self.all.len()
    }

    /// All of them.
    pub fn all(&self) -> &[Coordinate] {
        &self.all
    }

    /// Cosine and sine of a link's angle; of a travel 1 and 0.
    pub fn angle(&self, pool: &mut Pool, link: usize) -> [Id; 2] {
        match self.all[link].angle {
            Some(angle) => angle.map(|symbol| pool.symbol(symbol)),
            None => [pool.one(), pool.zero()],
        }
    }

    /// Whether an expression is zero at all angles.
    pub fn vanishes(&self, pool: &mut Pool, id: Id) -> bool {
        let [shorter] = self.shortened(pool, [id]);
        let of_angles = substitute(pool, &[shorter], &|symbol| self.calls.get(&symbol).copied())[0];
        pool.is_zero(shorter) || zero::vanishes(pool, of_angles)
    }

    /// Expressions, written shorter.
    pub fn shortened<const N: usize>(&self, pool: &mut Pool, ids: [Id; N]) -> [Id; N] {
        let shorter = self.circles.shortened(pool, &ids);
        std::array::from_fn(|k| shorter[k])
    }
}
