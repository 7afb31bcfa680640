//! The rates of the speeds that loops leave.
//!
//! In: links, what moves them, the speeds of all by those of the ones that no loop gives. Out: the rates of these.
//! Method: the wrenches that links take, projected on the motions that the loops allow (Kane and Levinson, Dynamics:
//! Theory and Applications, 1985, section 6.1); what closes the loops does no work on these. Wrenches are linear in the
//! rates: S q' = r, S by the accelerations that a unit of one rate gives to links at rest, r by those that all have
//! while the independent speeds stay as they are.

use super::closed::Closed;
use super::coordinates::Coordinates;
use crate::expr::{Id, Pool};
use crate::system::Value;
use crate::system::link::{Link, Moved};
use crate::system::reduce::inverse::Inverse;
use crate::system::rigid::{Accelerated, Given};

/// The rate of each link's speed; zero of one that a loop gives.
pub(super) fn rates(
    pool: &mut Pool,
    links: &[Link],
    (moved, spins): (&[Moved], &[Value]),
    ground: &Value,
    (closed, coordinates): (&Closed, &Coordinates),
) -> Vec<Id> {
    let (free, motions, steady) = closed.motions(pool, coordinates);
    let still = Value::zero(pool, 3);
    let at_rest = vec![still.clone(); links.len()];
    let units: Vec<Accelerated> = (0..free.len())
        .map(|j| Accelerated::of(pool, links, (moved, &at_rest), &still, |link| Given::Rate(motions[link][j])))
        .collect();
    let steady = Accelerated::of(pool, links, (moved, spins), ground, |link| Given::Rate(steady[link]));
    let mut right: Vec<Vec<Id>> = (0..free.len())
        .map(|j| moved.iter().zip(&motions).map(|(own, motion)| pool.mul(own.effort, motion[j])).collect())
        .collect();
    let mut matrix: Vec<Vec<Vec<Id>>> = (0..free.len()).map(|i| vec![Vec::new(); i + 1]).collect();
    for (k, link) in links.iter().enumerate() {
        let needed = link.counted.wrench(pool, steady.motion(k));
        let net = [0, 1].map(|part| {
            let back = needed[part].negate(pool);
            moved[k].load[part].add(pool, &back)
        });
        for (i, unit) in units.iter().enumerate() {
            let motion = &unit.links[k];
            right[i].extend([0, 1].map(|part| motion[part].dot(pool, &net[part])));
            for (j, other) in units[..=i].iter().enumerate() {
                let taken = link.counted.wrench(pool, other.motion(k));
                matrix[i][j].extend([0, 1].map(|part| motion[part].dot(pool, &taken[part])));
            }
        }
    }
    let right: Vec<Id> = right.iter().map(|parts| pool.sum(parts)).collect();
    let matrix: Vec<Vec<Id>> = matrix.iter().map(|row| row.iter().map(|parts| pool.sum(parts)).collect()).collect();
    let solved = Inverse::of(pool, &matrix).times(pool, &right, &[]);
    let mut rates = vec![pool.zero(); links.len()];
    free.into_iter().zip(solved).for_each(|(link, rate)| rates[link] = rate);
    rates
}
