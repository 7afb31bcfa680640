//! Loops in space in closed form.
//!
//! In: gaps and flows of joints that close loops, by the coordinates of a tree. Out: the coordinates that these joints
//! give, over the others, with their speeds and the rates of these. Method: of a gap g = e + v the part v is that of a
//! link on the last joint of the loop, of a length that does not change, so that |e|^2 = |v|^2 is one equation for one
//! coordinate of e; a hinge or a universal joint then has v = -e. An equation a c + b s + r = 0 in the cosine and the
//! sine of an angle has the pivot w = b c - a s, its slope by the angle, with w^2 = a^2 + b^2 - r^2; one in a travel x,
//! k x^2 + 2 m x + r = 0, has w = k x + m, w^2 = m^2 - k r. A single row is such an equation itself. A universal joint
//! has the cosine of its second angle as a pivot. On which side of zero a pivot is the start says. Bounds over arcs of
//! the other angles prove that it does not vanish, or the scene says so. Source: J. J. Uicker, G. R. Pennock, J. E.
//! Shigley, Theory of Machines and Mechanisms (2011), chapters 2 and 12.

use std::collections::{BTreeMap, BTreeSet};

use super::coordinates::{Coordinate, Coordinates};
use super::reach::Reach;
use crate::expr::{Bounds, Function, Id, Pool, Symbol, derivative, partial, substitute};
use crate::system::equations::{FallibleLaw, StateEquations};
use crate::system::link::{Freedom, Link};

/// A coordinate that a loop gives.
pub(super) struct Dependent {
    pub link: usize,
    /// The joint that closes the loop.
    pub joint: String,
    /// Its speed over those of other links.
    pub speed: Id,
    /// The rate of that over the speeds and their rates.
    pub rate: Id,
}

/// A pivot by which a loop is closed.
struct Root {
    joint: String,
    symbol: Symbol,
    may_vanish: bool,
}

/// Loops that are closed.
#[derive(Default)]
pub(super) struct Closed {
    /// In the order in which they are found: each over those before it and what no loop gives.
    pub dependents: Vec<Dependent>,
    /// What stands for their symbols and the pivots, over what no loop gives.
    pub images: BTreeMap<Symbol, Id>,
    /// What the sides of the pivots are those of at the start.
    sides: Vec<Id>,
    roots: Vec<Root>,
}

/// A joint that closes a loop: its gaps that are not zero identically.
pub(super) struct Closing<'a> {
    pub joint: &'a str,
    pub gaps: Vec<Id>,
}

/// One equation for a coordinate.
#[derive(Clone, Copy)]
enum Scalar {
    /// a c + b s + r = 0.
    Turn { by: [Id; 2], rest: Id },
    /// k x^2 + 2 m x + r = 0, where the pivot's square is at most the last number.
    Slide { square: f64, middle: Id, rest: Id, most: Id },
    /// x + r = 0.
    Straight { rest: Id },
}

/// The last joint of a loop, a hinge or a universal joint: v = p (c P + s Q) + f F, where p and f are 1 and 0 for a
/// hinge.
struct Last {
    links: Vec<usize>,
    /// Q, P.
    across: [Vec<Id>; 2],
    /// Of a universal joint what is along its second axis; whether the pivot is the cosine of its angle, or the sine.
    along: Option<(Vec<Id>, bool)>,
    /// |v|^2.
    square: Id,
    /// e.
    rest: Vec<Id>,
}

/// What loops are closed with.
pub(super) struct Closer<'a> {
    pub links: &'a [Link],
    pub coordinates: &'a Coordinates,
    /// Of each link how well its coordinate is one that others give, the least best.
    pub rank: &'a [usize],
    /// Of each link whether the scene says that loops give it.
    pub is_asked: &'a [bool],
    /// The first of the free numbers of sides.
    pub first_side: usize,
    /// The coordinates at the start.
    pub starts: &'a BTreeMap<Symbol, Id>,
}

impl Closer<'_> {
    /// Closes a loop where it can be; says whether it is.
    pub fn close(&self, equations: &mut StateEquations, closed: &mut Closed, of: &Closing<'_>) -> bool {
        let read = equations.pool.symbols(&of.gaps);
        let is_free = |link: &usize| {
            let is_read = self.coordinates.of(*link).symbols().any(|symbol| read.contains(&symbol));
            is_read && closed.dependents.iter().all(|dependent| dependent.link != *link)
        };
        let mut free: Vec<usize> = (0..self.links.len()).rev().filter(is_free).collect();
        free.sort_by_key(|&link| self.rank[link]);
        if let [gap] = of.gaps[..] {
            return free.iter().any(|&link| {
                let Some(scalar) = self.scalar(&mut equations.pool, gap, link) else { return false };
                self.give(equations, closed, of.joint, (link, gap, scalar), &[link])
            });
        }
        let lasts: Vec<Last> = self.lasts(&mut equations.pool, &free, &of.gaps);
        lasts.iter().any(|last| {
            free.iter().filter(|link| !last.links.contains(link)).any(|&link| {
                let Some((gap, scalar)) = self.distance(&mut equations.pool, last, link) else { return false };
                let all: Vec<usize> = last.links.iter().copied().chain([link]).collect();
                let before = [closed.dependents.len(), closed.roots.len(), closed.sides.len()];
                let is_closed = self.give(equations, closed, of.joint, (link, gap, scalar), &all)
                    && self.follow(equations, closed, of.joint, last);
                if !is_closed {
                    closed.forget(self, before);
                }
                is_closed
            })
        })
    }

    /// What may be the last joint of a loop with these gaps.
    fn lasts(&self, pool: &mut Pool, free: &[usize], gaps: &[Id]) -> Vec<Last> {
        let turns = free.iter().copied().filter(|&link| self.links[link].freedom == Freedom::Turn);
        match gaps.len() {
            2 => turns.filter_map(|link| self.hinge(pool, link, gaps)).collect(),
            3 => turns.filter_map(|link| self.universal(pool, [self.links[link].parent?, link], free, gaps)).collect(),
            _ => Vec::new(),
        }
    }

    /// A hinge as the last joint of a loop that moves in a plane.
    fn hinge(&self, pool: &mut Pool, link: usize, gaps: &[Id]) -> Option<Last> {
        let ([p, q], rest) = affine(pool, gaps, self.coordinates.of(link).angle?)?;
        let square = self.conformal(pool, &p, &q)?;
        Some(Last { links: vec![link], across: [q, p], along: None, square, rest })
    }

    /// A universal joint as the last one.
    fn universal(&self, pool: &mut Pool, links: [usize; 2], free: &[usize], gaps: &[Id]) -> Option<Last> {
        if !free.contains(&links[0]) {
            return None;
        }
        let [first, second] = [self.coordinates.of(links[0]).angle?, self.coordinates.of(links[1]).angle?];
        let all = [first, second].concat();
        let rest = without(pool, gaps, &all);
        let (both, _) = affine(pool, gaps, second)?;
        let still: Vec<Vec<Id>> = both.iter().map(|of| without(pool, of, &first)).collect();
        // The link is across the second axis: what it has along it is by the cosine or by the sine.
        let zero = pool.zero();
        let is_zero = |of: &Vec<Id>| of.iter().all(|&id| id == zero);
        let by_cosine = match [is_zero(&still[0]), is_zero(&still[1])] {
            [true, false] => true,
            [false, true] => false,
            _ => return None,
        };
        let (of_pivot, along) = if by_cosine { (&both[0], &still[1]) } else { (&both[1], &still[0]) };
        let ([p, q], _) = affine(pool, of_pivot, first)?;
        let square = self.conformal(pool, &p, &q)?;
        let other = dot(pool, along, along);
        let apart = [pool.sub(other, square), dot(pool, &p, along), dot(pool, &q, along)];
        if !apart.into_iter().all(|id| self.coordinates.vanishes(pool, id)) {
            return None;
        }
        let of = Last { links: links.to_vec(), across: [q, p], along: Some((along.clone(), by_cosine)), square, rest };
        let whole = self.whole(pool, &of);
        let is_whole = gaps.iter().zip(&whole).all(|(&gap, &whole)| {
            let apart = pool.sub(gap, whole);
            self.coordinates.vanishes(pool, apart)
        });
        is_whole.then_some(of)
    }

    /// e + v of a universal joint.
    fn whole(&self, pool: &mut Pool, of: &Last) -> Vec<Id> {
        let [cosine, sine] = self.coordinates.angle(pool, of.links[0]);
        let ([pivot, value], Some((along, _))) = (self.pivot(pool, of), &of.along) else { return of.rest.clone() };
        (0..of.rest.len())
            .map(|k| {
                let parts = [(sine, of.across[0][k]), (cosine, of.across[1][k])].map(|(a, b)| pool.mul(a, b));
                let across = pool.sum(&parts);
                let parts = [pool.mul(pivot, across), pool.mul(value, along[k]), of.rest[k]];
                pool.sum(&parts)
            })
            .collect()
    }

    /// Of the second angle of a universal joint what the pivot is, and the other of its cosine and sine.
    fn pivot(&self, pool: &mut Pool, of: &Last) -> [Id; 2] {
        let [cosine, sine] = self.coordinates.angle(pool, of.links[of.links.len() - 1]);
        match of.along {
            Some((_, true)) => [cosine, sine],
            Some((_, false)) => [sine, cosine],
            None => [pool.one(), pool.zero()],
        }
    }

    /// The square of both vectors' length, where they are perpendicular and of one constant length.
    fn conformal(&self, pool: &mut Pool, p: &[Id], q: &[Id]) -> Option<Id> {
        let square = self.alike(pool, p, q)?;
        let is_constant = !pool.is_zero(square) && super::is_constant(pool, square);
        is_constant.then_some(square)
    }

    /// The same, where the length may change.
    fn alike(&self, pool: &mut Pool, p: &[Id], q: &[Id]) -> Option<Id> {
        let squares = [dot(pool, p, p), dot(pool, q, q)];
        let [square, other] = self.coordinates.shortened(pool, squares);
        let apart = [pool.sub(square, other), dot(pool, p, q)];
        apart.into_iter().all(|id| self.coordinates.vanishes(pool, id)).then_some(square)
    }

    /// A gap as an equation for the coordinate of a link.
    fn scalar(&self, pool: &mut Pool, gap: Id, link: usize) -> Option<Scalar> {
        let own = self.coordinates.of(link);
        if let Some(angle) = own.angle {
            let (by, rest) = affine(pool, &[gap], angle)?;
            let by = self.coordinates.shortened(pool, [by[0][0], by[1][0]]);
            return by.iter().any(|&id| !pool.is_zero(id)).then_some(Scalar::Turn { by, rest: rest[0] });
        }
        let slope = partial(pool, &[gap], own.place)[0];
        let by = pool.as_number(slope).filter(|&by| by != 0.0)?;
        let rest = without(pool, &[gap], &[own.place])[0];
        Some(Scalar::Straight { rest: pool.scale(1.0 / by, rest) })
    }

    /// Half of |e|^2 - |v|^2, and that as an equation for the coordinate of a link.
    fn distance(&self, pool: &mut Pool, last: &Last, link: usize) -> Option<(Id, Scalar)> {
        let (own, e) = (self.coordinates.of(link), &last.rest);
        let square = dot(pool, e, e);
        let gap = pool.linear(0.0, &[(square, 0.5), (last.square, -0.5)]);
        if let Some(angle) = own.angle {
            let ([p, q], rest) = affine(pool, e, angle)?;
            let length = self.alike(pool, &p, &q)?;
            let (a, b, far) = (dot(pool, &rest, &p), dot(pool, &rest, &q), dot(pool, &rest, &rest));
            let rest = pool.linear(0.0, &[(far, 0.5), (length, 0.5), (last.square, -0.5)]);
            let [a, b, rest] = self.coordinates.shortened(pool, [a, b, rest]);
            return (!pool.is_zero(a) || !pool.is_zero(b)).then_some((gap, Scalar::Turn { by: [a, b], rest }));
        }
        let along = partial(pool, e, own.place);
        if pool.symbols(&along).contains(&own.place) {
            return None;
        }
        let rest = without(pool, e, &[own.place]);
        let (square, middle, far) = (dot(pool, &along, &along), dot(pool, &rest, &along), dot(pool, &rest, &rest));
        let rest = pool.sub(far, last.square);
        let [square, middle, rest] = self.coordinates.shortened(pool, [square, middle, rest]);
        let square = pool.as_number(square).filter(|&square| square > 0.0)?;
        let most = pool.scale(square, last.square);
        Some((gap, Scalar::Slide { square, middle, rest, most }))
    }

    /// Gives the coordinate of a link by an equation, where its pivot does not vanish, or the scene says that loops
    /// give `all` of these links.
    fn give(
        &self,
        equations: &mut StateEquations,
        closed: &mut Closed,
        joint: &str,
        (link, gap, scalar): (usize, Id, Scalar),
        all: &[usize],
    ) -> bool {
        let own = self.coordinates.of(link);
        let pool = &mut equations.pool;
        // Of a turn the square of the pivot is at most a^2 + b^2, by which its cosine and sine are divided, too.
        let (slope, square, most) = match scalar {
            Scalar::Turn { by: [a, b], rest } => {
                let [cosine, sine] = self.coordinates.angle(pool, link);
                let (first, second) = (pool.mul(b, cosine), pool.mul(a, sine));
                let squares = [pool.powi(a, 2), pool.powi(b, 2), pool.powi(rest, 2)];
                let length = pool.sum(&squares[..2]);
                let [length] = self.coordinates.shortened(pool, [length]);
                (pool.sub(first, second), pool.sub(length, squares[2]), length)
            }
            Scalar::Slide { square, middle, rest, most } => {
                let place = pool.symbol(own.place);
                let slope = pool.linear(0.0, &[(place, square), (middle, 1.0)]);
                let root = pool.powi(middle, 2);
                let root = pool.linear(0.0, &[(root, 1.0), (rest, -square)]);
                let [root] = self.coordinates.shortened(pool, [root]);
                (slope, root, most)
            }
            Scalar::Straight { rest } => {
                let (place, one) = (pool.neg(rest), pool.one());
                let own_place = pool.symbol(own.place);
                let gap = pool.add(own_place, rest);
                self.note(pool, closed, joint, (link, gap, one), &[(own.place, place)]);
                return true;
            }
        };
        let Some(pivot) = self.root(equations, closed, joint, (link, slope), (square, most), all) else {
            return false;
        };
        let pool = &mut equations.pool;
        let images = match (scalar, own.angle) {
            (Scalar::Turn { by: [a, b], rest }, Some([cosine, sine])) => {
                let mut part = |x: Id, y: Id, sign: f64| {
                    let (first, second) = (pool.mul(x, pivot), pool.mul(y, rest));
                    let sum = pool.linear(0.0, &[(first, sign), (second, -1.0)]);
                    pool.div(sum, most)
                };
                vec![(cosine, part(b, a, 1.0)), (sine, part(a, b, -1.0))]
            }
            (Scalar::Slide { square, middle, .. }, _) => {
                vec![(own.place, pool.linear(0.0, &[(pivot, 1.0 / square), (middle, -1.0 / square)]))]
            }
            _ => return false,
        };
        self.note(pool, closed, joint, (link, gap, pivot), &images);
        true
    }

    /// Gives the coordinates of the last joint of a loop whose other ones are given.
    fn follow(&self, equations: &mut StateEquations, closed: &mut Closed, joint: &str, last: &Last) -> bool {
        let Last { links, across, along, square, rest } = last;
        let (first, end) = (links[0], links[links.len() - 1]);
        let [pivot, value] = self.pivot(&mut equations.pool, last);
        let mut swing = None;
        if let Some((along, by_cosine)) = along {
            let pool = &mut equations.pool;
            let part = dot(pool, along, rest);
            let [part] = self.coordinates.shortened(pool, [part]);
            let sine = pool.div(part, *square);
            let sine = pool.neg(sine);
            let apart = pool.powi(sine, 2);
            let apart = pool.linear(1.0, &[(apart, -1.0)]);
            let one = pool.one();
            let Some(root) = self.root(equations, closed, joint, (end, pivot), (apart, one), links) else {
                return false;
            };
            let pool = &mut equations.pool;
            let [Some([cosine_of, sine_of])] = [self.coordinates.of(end).angle] else { return false };
            let images =
                if *by_cosine { [(cosine_of, root), (sine_of, sine)] } else { [(cosine_of, sine), (sine_of, root)] };
            // value' = sense pivot u, pivot' = -sense value u.
            let sense = if *by_cosine { 1.0 } else { -1.0 };
            let speed_of = pool.symbol(self.coordinates.of(end).speed);
            let [changed, twice] = self.changes(pool, [part]).map(|of| of[0]);
            let divisor = pool.mul(*square, root);
            let speed = pool.div(changed, divisor);
            let speed = pool.scale(-sense, speed);
            let squared = pool.powi(speed_of, 2);
            let pulled = pool.mul(value, squared);
            let twice = pool.div(twice, *square);
            let rate = pool.linear(0.0, &[(pulled, sense), (twice, -sense)]);
            let rate = pool.div(rate, root);
            self.add(pool, closed, Dependent { link: end, joint: joint.to_owned(), speed, rate }, &images);
            let turned = pool.mul(value, speed_of);
            swing = Some((root, pool.scale(-sense, turned)));
        }
        let pool = &mut equations.pool;
        let [cosine, sine] = self.coordinates.angle(pool, first);
        let parts = [dot(pool, &across[1], rest), dot(pool, &across[0], rest)];
        let parts = self.coordinates.shortened(pool, parts);
        let divisor = match swing {
            Some((root, _)) => pool.mul(*square, root),
            None => *square,
        };
        let images = parts.map(|part| {
            let image = pool.div(part, divisor);
            pool.neg(image)
        });
        let [changed, twice] = self.changes(pool, parts);
        let turned = |pool: &mut Pool, of: &[Id]| {
            let products = [pool.mul(cosine, of[1]), pool.mul(sine, of[0])];
            pool.sub(products[1], products[0])
        };
        let (changed, twice) = (turned(pool, &changed), turned(pool, &twice));
        let speed = pool.div(changed, divisor);
        let rate = pool.div(twice, *square);
        let rate = match swing {
            Some((root, swung)) => {
                let own = pool.symbol(self.coordinates.of(first).speed);
                let beside = pool.mul(swung, own);
                let rate = pool.linear(0.0, &[(rate, 1.0), (beside, -2.0)]);
                pool.div(rate, root)
            }
            None => rate,
        };
        let Some([cosine_of, sine_of]) = self.coordinates.of(first).angle else { return false };
        let dependent = Dependent { link: first, joint: joint.to_owned(), speed, rate };
        self.add(pool, closed, dependent, &[(cosine_of, images[0]), (sine_of, images[1])]);
        true
    }

    /// The first and the second derivative by time.
    fn changes<const N: usize>(&self, pool: &mut Pool, of: [Id; N]) -> [Vec<Id>; 2] {
        let changed = derivative(pool, &of, &self.coordinates.speeds);
        let twice = derivative(pool, &changed, &self.coordinates.rates);
        [changed, twice]
    }

    /// Notes a coordinate that closes a gap with this pivot.
    fn note(
        &self,
        pool: &mut Pool,
        closed: &mut Closed,
        joint: &str,
        (link, gap, pivot): (usize, Id, Id),
        images: &[(Symbol, Id)],
    ) {
        let Coordinate { speed, rate, .. } = *self.coordinates.of(link);
        let [changed, twice] = self.changes(pool, [gap]).map(|of| of[0]);
        let mut rest = |of: Id, own: Symbol| {
            let rest = without(pool, &[of], &[own])[0];
            let part = pool.div(rest, pivot);
            pool.neg(part)
        };
        let (speed, rate) = (rest(changed, speed), rest(twice, rate));
        self.add(pool, closed, Dependent { link, joint: joint.to_owned(), speed, rate }, images);
    }

    /// Adds a coordinate that a loop gives.
    fn add(&self, pool: &mut Pool, closed: &mut Closed, dependent: Dependent, images: &[(Symbol, Id)]) {
        let own = (self.coordinates.of(dependent.link).speed, dependent.speed);
        for &(symbol, id) in images.iter().chain([&own]) {
            let image = substitute(pool, &[id], &|symbol| closed.images.get(&symbol).copied())[0];
            closed.images.insert(symbol, image);
        }
        closed.dependents.push(dependent);
    }

    /// Notes a pivot, which is `slope`, by its square and what that is at most; gives what stands for it. None where it
    /// may vanish, as far as bounds show, and the scene does not say that loops give all of these links.
    fn root(
        &self,
        equations: &mut StateEquations,
        closed: &mut Closed,
        joint: &str,
        (link, slope): (usize, Id),
        (square, most): (Id, Id),
        all: &[usize],
    ) -> Option<Id> {
        let StateEquations { pool, parameters, .. } = equations;
        let of = substitute(pool, &[square, most], &|symbol| closed.images.get(&symbol).copied());
        let ranges = parameters.iter().map(|parameter| {
            let [least, most] = [parameter.lower, parameter.upper].map(|end| end.map(|(end, _)| end));
            Bounds { least: least.unwrap_or(f64::NEG_INFINITY), most: most.unwrap_or(f64::INFINITY) }
        });
        let ranges: Vec<Bounds> = ranges.collect();
        let reach = Reach { coordinates: self.coordinates, parameters: &ranges };
        let may_vanish = !reach.is_apart(pool, of[0], of[1]);
        let is_turn = |link: &&usize| self.links[**link].freedom == Freedom::Turn;
        if may_vanish && !all.iter().filter(is_turn).all(|&link| self.is_asked[link]) {
            return None;
        }
        let start = substitute(pool, &[slope], &|symbol| self.starts.get(&symbol).copied())[0];
        let side = pool.symbol(Symbol::numbered(Symbol::Side, self.first_side + closed.sides.len()));
        closed.sides.push(start);
        let root = pool.call(Function::Sqrt, &[of[0]]);
        let symbol = self.coordinates.of(link).pivot;
        closed.images.insert(symbol, pool.mul(side, root));
        closed.roots.push(Root { joint: joint.to_owned(), symbol, may_vanish });
        Some(pool.symbol(symbol))
    }
}

impl Closed {
    /// Takes back what has been noted since there were so many coordinates, pivots and sides.
    fn forget(&mut self, of: &Closer<'_>, [dependents, roots, sides]: [usize; 3]) {
        for dependent in self.dependents.drain(dependents..) {
            let own = of.coordinates.of(dependent.link);
            for symbol in own.symbols().chain([own.speed]) {
                self.images.remove(&symbol);
            }
        }
        for root in self.roots.drain(roots..) {
            self.images.remove(&root.symbol);
        }
        self.sides.truncate(sides);
    }

    /// What stands for the symbols of all coordinates, where `kept` has those of the states that stay.
    pub fn settled(
        &self,
        pool: &mut Pool,
        coordinates: &Coordinates,
        kept: &BTreeMap<Symbol, Id>,
    ) -> BTreeMap<Symbol, Id> {
        let put = |pool: &mut Pool, of: &BTreeMap<Symbol, Id>, by: &BTreeMap<Symbol, Id>| -> BTreeMap<Symbol, Id> {
            let (symbols, ids): (Vec<Symbol>, Vec<Id>) = of.iter().unzip();
            let after = substitute(pool, &ids, &|symbol| by.get(&symbol).copied());
            symbols.into_iter().zip(after).collect()
        };
        let mut all = kept.clone();
        all.extend(put(pool, &coordinates.calls, kept));
        let images = put(pool, &self.images, &all);
        all.extend(images);
        for Dependent { link, .. } in &self.dependents {
            let own = coordinates.of(*link);
            if let (Some(angle), Some(&turned)) = (own.angle, kept.get(&own.place)) {
                let angle = angle.map(|symbol| all[&symbol]);
                all.insert(own.place, near(pool, turned, angle));
            }
        }
        all
    }

    /// Whether a loop gives the coordinate of a link.
    pub fn gives(&self, link: usize) -> bool {
        self.dependents.iter().any(|dependent| dependent.link == link)
    }

    /// For each link its speed by those of the links that no loop gives, which are listed, and its rate where those
    /// have none.
    pub fn motions(&self, pool: &mut Pool, coordinates: &Coordinates) -> (Vec<usize>, Vec<Vec<Id>>, Vec<Id>) {
        let count = coordinates.count();
        let free: Vec<usize> = (0..count).filter(|&link| !self.gives(link)).collect();
        let (zero, one) = (pool.zero(), pool.one());
        let unit = |link: usize| free.iter().map(|&other| if other == link { one } else { zero }).collect();
        let mut motions: Vec<Vec<Id>> = (0..count).map(unit).collect();
        let mut steady: BTreeMap<Symbol, Id> = free.iter().map(|&link| (coordinates.of(link).rate, zero)).collect();
        for Dependent { link, speed, rate, .. } in &self.dependents {
            let read: BTreeSet<Symbol> = pool.symbols(&[*speed]);
            let others: Vec<usize> = (0..count).filter(|&other| read.contains(&coordinates.of(other).speed)).collect();
            let slopes: Vec<Id> =
                others.iter().map(|&other| partial(pool, &[*speed], coordinates.of(other).speed)[0]).collect();
            motions[*link] = (0..free.len())
                .map(|k| {
                    let parts: Vec<Id> =
                        others.iter().zip(&slopes).map(|(&other, &slope)| pool.mul(slope, motions[other][k])).collect();
                    pool.sum(&parts)
                })
                .collect();
            let still = substitute(pool, &[*rate], &|symbol| steady.get(&symbol).copied())[0];
            steady.insert(coordinates.of(*link).rate, still);
        }
        let steady = (0..count).map(|link| steady[&coordinates.of(link).rate]).collect();
        (free, motions, steady)
    }

    /// Puts the pivots among what can fail, and their sides among what the start gives.
    pub fn put_roots(&self, equations: &mut StateEquations) {
        equations.assembly.sides.extend(&self.sides);
        let laws = self.roots.iter().map(|Root { joint, symbol, may_vanish }| FallibleLaw {
            kind: "closed loop",
            element: joint.clone(),
            value: equations.pool.symbol(*symbol),
            may_vanish: *may_vanish,
        });
        equations.fallible = laws.chain(std::mem::take(&mut equations.fallible)).collect();
    }
}

/// The angle of this cosine and sine that is less than half a turn from another one.
fn near(pool: &mut Pool, turned: Id, [cosine, sine]: [Id; 2]) -> Id {
    let [c, s] = [Function::Cos, Function::Sin].map(|of| pool.call(of, &[turned]));
    let products = [pool.mul(sine, c), pool.mul(cosine, s), pool.mul(cosine, c), pool.mul(sine, s)];
    let (across, along) = (pool.sub(products[0], products[1]), pool.add(products[2], products[3]));
    let apart = pool.call(Function::Atan2, &[across, along]);
    pool.add(turned, apart)
}

/// What expressions have of two symbols in which they are affine, and the rest.
fn affine(pool: &mut Pool, ids: &[Id], of: [Symbol; 2]) -> Option<([Vec<Id>; 2], Vec<Id>)> {
    let by = of.map(|symbol| partial(pool, ids, symbol));
    let read = pool.symbols(&by.concat());
    let rest = without(pool, ids, &of);
    (!of.iter().any(|symbol| read.contains(symbol))).then_some((by, rest))
}

/// Expressions in which these symbols are zero.
fn without(pool: &mut Pool, ids: &[Id], gone: &[Symbol]) -> Vec<Id> {
    let zero = pool.zero();
    substitute(pool, ids, &|symbol| gone.contains(&symbol).then_some(zero))
}

fn dot(pool: &mut Pool, a: &[Id], b: &[Id]) -> Id {
    let parts: Vec<Id> = a.iter().zip(b).map(|(&a, &b)| pool.mul(a, b)).collect();
    pool.sum(&parts)
}
