//! Whether a pivot keeps away from zero in all poses.
//!
//! In: its square, over parameters and coordinates. Out: whether bounds show that it does not vanish. Method: interval
//! arithmetic over arcs of the angles, on both sides of the roots that are in it.

use super::coordinates::Coordinates;
use crate::expr::{Bounds, Id, Pool, Symbol, bounds, substitute};
use crate::system::reduce::dyad::FAR;

/// So many arcs each angle has, where there is one of them, or two.
const ARCS: [usize; 2] = [256, 48];
/// More roots are not looked at on both sides.
const SIDES: usize = 4;

/// Where coordinates are.
pub(super) struct Reach<'a> {
    pub coordinates: &'a Coordinates,
    /// The ranges of the parameters.
    pub parameters: &'a [Bounds],
}

impl Reach<'_> {
    /// Whether a square is at least a part of what it is at most.
    pub fn is_apart(&self, pool: &mut Pool, square: Id, most: Id) -> bool {
        let least = pool.linear(0.0, &[(square, 1.0), (most, FAR * FAR - 1.0)]);
        let symbols = pool.symbols(&[least]);
        let sides: Vec<Symbol> = symbols.iter().copied().filter(|symbol| matches!(symbol, Symbol::Side(_))).collect();
        let angles: Vec<[Symbol; 2]> = self.coordinates.all().iter().filter_map(|own| own.angle).collect();
        let angles: Vec<[Symbol; 2]> =
            angles.into_iter().filter(|angle| angle.iter().any(|symbol| symbols.contains(symbol))).collect();
        if sides.len() > SIDES {
            return false;
        }
        (0..1 << sides.len()).all(|choice: usize| {
            let side = |symbol: Symbol| sides.iter().position(|&side| side == symbol);
            let signs = [1.0, -1.0].map(|sign| pool.number(sign));
            let at = substitute(pool, &[least], &|symbol| side(symbol).map(|k| signs[choice >> k & 1]))[0];
            self.is_positive(pool, at, &angles)
        })
    }

    fn is_positive(&self, pool: &Pool, id: Id, angles: &[[Symbol; 2]]) -> bool {
        let arcs = angles.len().checked_sub(1).map_or(Some(1), |k| ARCS.get(k).copied());
        let Some(arcs) = arcs else { return self.least(pool, id, &[]) > 0.0 };
        let count = u32::try_from(angles.len()).unwrap_or(0);
        (0..arcs.pow(count)).all(|number| {
            let box_of = |(k, angle): (usize, &[Symbol; 2])| {
                let place = number / arcs.pow(u32::try_from(k).unwrap_or(0)) % arcs;
                angle.iter().copied().zip(arc(place, arcs)).collect::<Vec<_>>()
            };
            let known: Vec<(Symbol, Bounds)> = angles.iter().enumerate().flat_map(box_of).collect();
            self.least(pool, id, &known) > 0.0
        })
    }

    fn least(&self, pool: &Pool, id: Id, known: &[(Symbol, Bounds)]) -> f64 {
        let is_part = |symbol: Symbol| {
            self.coordinates.all().iter().filter_map(|own| own.angle).any(|angle| angle.contains(&symbol))
        };
        let of = |symbol: Symbol| match symbol {
            Symbol::Parameter(index) => self.parameters[index as usize],
            _ => match known.iter().find(|(own, _)| *own == symbol) {
                Some((_, bounds)) => *bounds,
                None if is_part(symbol) => Bounds { least: -1.0, most: 1.0 },
                None => Bounds::ANY,
            },
        };
        let least = bounds(pool, id, &of).least;
        if least.is_nan() { f64::NEG_INFINITY } else { least }
    }
}

/// The bounds of the cosine and the sine on one of so many arcs, of which quarter turns are ends.
fn arc(place: usize, arcs: usize) -> [Bounds; 2] {
    let at = |place: usize| std::f64::consts::TAU * place as f64 / arcs as f64;
    let [start, end] = [at(place), at(place + 1)];
    [f64::cos, f64::sin].map(|of| {
        let [a, b] = [of(start), of(end)];
        Bounds { least: a.min(b), most: a.max(b) }
    })
}
