//! Loops closed in closed form.
//!
//! In: the rows of a joint that closes a loop, the states that stay. Out: the momentum of a link of the loop over those
//! of the others, and its orientation over theirs; of two links where a pin closes the loop.
//! Method: the gap of a row is affine in the cosine c and the sine s of a link that turns in the plane, a c + b s + e.
//! Its slope by the link's angle is the pivot with which the row's flow gives the link's momentum, w = b c - a s, and
//! it is a root: w^2 = a^2 + b^2 - e^2. From w and e follow c and s. On which side of zero w is the start pose says:
//! that changes nowhere but at zero. A pin has two rows, A u + B v + e with the cosine and the sine of one link in u,
//! of another in v. The length of B v does not change, so |A u + e|^2 - |B|^2 is a gap as above, and v follows from u.
//! Along B v the rows give the momentum of the first link, along A u that of the other one, both with the pivot
//! (A u) x (B v).
//! Until all equations are made, c and s stay for what they are: sums with them become short. What they are is put in
//! last. A pivot that may vanish is none: links go where bounds prove that it does not, or where the scene says that
//! they go. Source: closed forms of dyads, J. J. Uicker, G. R. Pennock, J. E. Shigley, Theory of Machines and
//! Mechanisms (2011), chapter 2.

use std::collections::BTreeMap;

use super::joined::{Choice, Images, Row, applied};
use super::report::Fate;
use super::{angle, closing, is_constant, speeds};
use crate::expr::{Bounds, Function, Id, Pool, Symbol, bounds, derivative, partial, same_polynomial, substitute};
use crate::graph::Parameter;
use crate::system::equations::{Assembly, FallibleLaw, Kind, StateEquations};

/// The largest part of a link's length that the rest of a gap may be proved to have.
pub(super) const FAR: f64 = 0.999;

/// The root by which a loop is closed.
pub(super) struct Root {
    /// The joint that closes the loop.
    joint: String,
    /// What stands for it until all equations are made.
    symbol: Symbol,
    /// What it is as a slope of the gap.
    pub slope: Id,
    /// What it is over the states that stay.
    value: Id,
    /// Whether nothing shows that it keeps away from zero.
    may_vanish: bool,
}

/// The two rows of a pin that closes a loop, and the vector along which their reaction acts on one link alone.
pub(super) struct Turned {
    pub rows: [usize; 2],
    pub by: [Id; 2],
}

/// A link that may go.
struct Link {
    track: usize,
    /// The states of its cosine and its sine.
    places: [usize; 2],
    momentum: usize,
    /// Its speed by one unit of the momentum.
    factor: Id,
}

/// A gap that is affine in the cosine and the sine of a link: what it has of these, and the rest.
struct Affine {
    by: [Id; 2],
    rest: Id,
}

/// What both rows of a pin have of a link: a rotation or a reflection, times a length.
struct Conformal {
    rows: [[Id; 2]; 2],
    /// The length, squared.
    square: Id,
    /// 1 for a rotation, -1 for a reflection.
    sense: f64,
}

impl Choice {
    /// The rows that close loops and are left, solved where they can be; for the links `asked` without a proof.
    pub(super) fn close_loops(&mut self, equations: &mut StateEquations, asked: &[String]) {
        let left: Vec<usize> = (0..self.rigid).filter(|&row| !self.is_solved(row)).collect();
        for numbers in closing::of_joints(&equations.reactions, left.into_iter()) {
            let rows: Option<Vec<Row>> = numbers.iter().map(|&row| self.closing(equations, row)).collect();
            let Some(rows) = rows else { continue };
            let links = self.links(equations);
            let is_asked = |link: &Link| asked.contains(&equations.tracks[link.track]);
            let is_asked: Vec<bool> = links.iter().map(is_asked).collect();
            let all = 0..links.len();
            match (&numbers[..], &rows[..]) {
                (&[number], [row]) => {
                    all.into_iter().any(|k| self.slide(equations, (number, row), &links[k], is_asked[k]));
                }
                (&[first, second], [one, other]) => {
                    let mut pairs = all.clone().flat_map(|k| all.clone().map(move |l| (k, l))).filter(|(k, l)| k != l);
                    pairs.any(|(k, l)| {
                        let rows = [(first, one), (second, other)];
                        self.pin(equations, rows, [&links[k], &links[l]], is_asked[k] && is_asked[l])
                    });
                }
                _ => {}
            }
        }
    }

    /// A row that may close a loop in closed form: whose gap is closed at the start, and does not open there.
    fn closing(&self, equations: &mut StateEquations, number: usize) -> Option<Row> {
        if !Self::is_closed(equations, number) || !speeds::starts_at_rest(equations, number) {
            return None;
        }
        let Row { flow, gap, mut slopes } = self.row(equations, number)?;
        let pool = &mut equations.pool;
        let [flow, gap] = self.shorter(pool, [flow, gap]);
        slopes.values_mut().for_each(|slope| [*slope] = self.shorter(pool, [*slope]));
        Some(Row { flow, gap, slopes })
    }

    /// The links that turn in the plane, each by a momentum of its own, and that no loop gives or is closed by.
    fn links(&self, equations: &mut StateEquations) -> Vec<Link> {
        let mut links = Vec::new();
        for turn in angle::turns(equations) {
            let places = [turn.cosine, turn.sine];
            let pool = &mut equations.pool;
            let used = self.roots.iter().flat_map(|root| pool.symbols(&[root.value, root.slope]));
            let used = used.filter_map(Symbol::as_state).chain(self.images.keys().chain(self.given.keys()).copied());
            if used.into_iter().any(|state| places.contains(&state)) {
                continue;
            }
            let speed = self.applied(pool, &[turn.rate])[0];
            let by: Vec<usize> = pool.symbols(&[speed]).into_iter().filter_map(Symbol::as_state).collect();
            let [momentum] = by[..] else { continue };
            let factor = partial(pool, &[speed], Symbol::state(momentum))[0];
            if is_constant(pool, factor) && !pool.is_zero(factor) && self.velocities.contains_key(&momentum) {
                links.push(Link { track: turn.track, places, momentum, factor });
            }
        }
        links
    }

    /// One row, solved for a link where it can be; says whether it was.
    fn slide(
        &mut self,
        equations: &mut StateEquations,
        (number, row): (usize, &Row),
        link: &Link,
        is_asked: bool,
    ) -> bool {
        let pool = &mut equations.pool;
        let Some(Affine { by: [a, b], rest }) = link.affine(pool, row) else { return false };
        let square = sum_of_squares(pool, &[a, b]);
        let [a, b, rest, square] = self.shorter(pool, [a, b, rest, square]);
        let length = pool.call(Function::Sqrt, &[square]);
        let part = pool.div(rest, length);
        // A link that cannot move is held, which is for the start to find.
        if !moves(pool, &[a, b, rest]) {
            return false;
        }
        let may_vanish = !is_apart(equations, part, square);
        if !is_asked && may_vanish {
            return false;
        }
        let pool = &mut equations.pool;
        let slope = link.slope(pool, [a, b]);
        let by = (Affine { by: [a, b], rest }, length);
        let pivot = self.root(equations, number, link, by, (slope, length), may_vanish);
        let pool = &mut equations.pool;
        let flow = without(pool, row.flow, &[link.momentum]);
        let momentum = link.momentum_of(pool, flow, pivot, -1.0);
        self.settle(equations, number, link, momentum);
        true
    }

    /// The two rows of a pin, solved for two links where they can be; says whether they were.
    fn pin(
        &mut self,
        equations: &mut StateEquations,
        [(first, one), (second, other)]: [(usize, &Row); 2],
        [link, last]: [&Link; 2],
        is_asked: bool,
    ) -> bool {
        let pool = &mut equations.pool;
        let parts = [link, last].map(|link| link.conformal(pool, [one, other]));
        let [Some(of_link), Some(of_last)] = parts else { return false };
        let rests = [one.gap, other.gap].map(|gap| without(pool, gap, [link.places, last.places].as_flattened()));
        let distance = sum_of_squares(pool, &rests);
        let [x, y, distance] = self.shorter(pool, [rests[0], rests[1], distance]);
        if !moves(pool, &rests) {
            return false;
        }
        let may_vanish = !is_between(equations, distance, [of_link.square, of_last.square]);
        if !is_asked && may_vanish {
            return false;
        }
        let rests = [x, y];
        let pool = &mut equations.pool;
        let vectors = [(link, &of_link), (last, &of_last)].map(|(link, of)| {
            let places = link.symbols(pool);
            of.rows.map(|row| dot(pool, row, places))
        });
        // The gap |A u + e|^2 - |B|^2, half of it.
        let columns = [0, 1].map(|place| of_link.rows.map(|row| row[place]));
        let by = columns.map(|column| dot(pool, column, rests));
        let by = self.shorter(pool, by);
        let rest = pool.linear(0.0, &[(of_link.square, 0.5), (distance, 0.5), (of_last.square, -0.5)]);
        let square = pool.mul(of_link.square, distance);
        let length = pool.call(Function::Sqrt, &[square]);
        let [[a, b], [c, d]] = vectors;
        let (left, right) = (pool.mul(b, c), pool.mul(a, d));
        let across = pool.linear(0.0, &[(left, of_link.sense), (right, -of_link.sense)]);
        let [across] = self.shorter(pool, [across]);
        let by = (Affine { by, rest }, length);
        let pivot = self.root(equations, first, link, by, (across, length), may_vanish);
        let pool = &mut equations.pool;
        self.give(pool, link, (last, &of_last), (&of_link, rests));
        let flows = [one.flow, other.flow].map(|flow| without(pool, flow, &[link.momentum, last.momentum]));
        let flows = [vectors[1], vectors[0]].map(|vector| dot(pool, vector, flows));
        let [along_last, along_link] = self.shorter(pool, flows);
        let own = link.momentum_of(pool, along_last, pivot, 1.0);
        let others = last.momentum_of(pool, along_link, pivot, -of_link.sense * of_last.sense);
        self.turned.push(Turned { rows: [first, second], by: vectors[1] });
        self.settle(equations, first, link, own);
        self.settle(equations, second, last, others);
        true
    }

    /// Notes a root, which is `slope`, by the gap's parts and the length that these have; gives what stands for it. The
    /// link's orientation follows.
    fn root(
        &mut self,
        equations: &mut StateEquations,
        number: usize,
        link: &Link,
        (Affine { by, rest }, length): (Affine, Id),
        (slope, size): (Id, Id),
        may_vanish: bool,
    ) -> Id {
        let joint = equations.reactions[number].slip.joint.clone();
        let StateEquations { pool, states, assembly: Assembly { sides, .. }, .. } = equations;
        let start = substitute(pool, &[slope], &|symbol| symbol.as_state().map(|state| states[state].start))[0];
        let side = pool.symbol(Symbol::numbered(Symbol::Side, sides.len()));
        sides.push(start);
        let parts = [by[0], by[1], rest].map(|id| pool.div(id, length));
        let parts = applied(pool, &parts, &self.given);
        let (a, b, sine) = (parts[0], parts[1], parts[2]);
        let square = pool.powi(sine, 2);
        let radicand = pool.linear(1.0, &[(square, -1.0)]);
        let root = pool.call(Function::Sqrt, &[radicand]);
        let cosine = pool.mul(side, root);
        let mut place = |of_cosine: Id, of_sine: Id, sense: f64| {
            let (first, second) = (pool.mul(of_cosine, cosine), pool.mul(of_sine, sine));
            pool.linear(0.0, &[(first, sense), (second, -1.0)])
        };
        let places = [place(b, a, 1.0), place(a, b, -1.0)];
        self.given.extend(link.places.into_iter().zip(places));
        let symbol = Symbol::numbered(Symbol::Unsolved, self.roots.len());
        let size = applied(pool, &[size], &self.given)[0];
        let value = pool.mul(size, cosine);
        self.roots.push(Root { joint, symbol, slope, value, may_vanish });
        pool.symbol(symbol)
    }

    /// The orientation of the last link of a pin, from that of the other one: v = -B^T (A u + e) / |B|^2.
    fn give(&mut self, pool: &mut Pool, link: &Link, (last, of_last): (&Link, &Conformal), of: (&Conformal, [Id; 2])) {
        let (of_link, rests) = of;
        let rests = applied(pool, &rests, &self.given);
        let places = link.places.map(|place| self.given[&place]);
        let vector = [0, 1].map(|row| {
            let own = dot(pool, of_link.rows[row], places);
            pool.add(own, rests[row])
        });
        for place in [0, 1] {
            let part = dot(pool, of_last.rows.map(|row| row[place]), vector);
            let part = pool.div(part, of_last.square);
            let part = pool.neg(part);
            self.given.insert(last.places[place], part);
        }
    }

    /// What a row gives: the momentum and the orientation of a link.
    fn settle(&mut self, equations: &mut StateEquations, number: usize, link: &Link, momentum: Id) {
        let joint = equations.reactions[number].slip.joint.clone();
        self.rows.push((number, link.momentum));
        self.add(equations, number, Images::from([(link.momentum, momentum)]));
        let states = [link.momentum].into_iter().chain(link.places);
        self.fates.extend(states.map(|state| (state, Fate::Closed(joint.clone()))));
    }

    /// Expressions, written shorter.
    fn shorter<const K: usize>(&self, pool: &mut Pool, ids: [Id; K]) -> [Id; K] {
        let shorter = self.circles.shortened(pool, &ids);
        std::array::from_fn(|k| shorter[k])
    }

    /// Adds the rates of the roots to those of a pose.
    pub(super) fn seed_roots(&self, pool: &mut Pool, pose: &mut BTreeMap<Symbol, Id>) {
        let slopes: Vec<Id> = self.roots.iter().map(|root| root.slope).collect();
        let rates = derivative(pool, &slopes, pose);
        pose.extend(self.roots.iter().map(|root| root.symbol).zip(rates));
    }

    /// Puts the roots, and the orientations that loops give, into all equations.
    pub(super) fn put_roots(&self, equations: &mut StateEquations) {
        let laws = self.roots.iter().map(|Root { joint, symbol, may_vanish, .. }| FallibleLaw {
            kind: "closed loop",
            element: joint.clone(),
            value: equations.pool.symbol(*symbol),
            may_vanish: *may_vanish,
        });
        equations.fallible = laws.chain(std::mem::take(&mut equations.fallible)).collect();
        equations.replace(&|symbol| match symbol.as_state() {
            Some(state) => self.given.get(&state).copied(),
            None => self.roots.iter().find(|root| root.symbol == symbol).map(|root| root.value),
        });
    }
}

impl Link {
    fn symbols(&self, pool: &mut Pool) -> [Id; 2] {
        self.places.map(|place| pool.symbol(Symbol::state(place)))
    }

    /// The slope by the link's angle of what has these parts of its cosine and its sine.
    fn slope(&self, pool: &mut Pool, [a, b]: [Id; 2]) -> Id {
        let [c, s] = self.symbols(pool);
        let (first, second) = (pool.mul(b, c), pool.mul(a, s));
        pool.sub(first, second)
    }

    /// The gap of a row, where it is affine in the link's cosine and sine, and the flow is its rate by the link's
    /// speed.
    fn affine(&self, pool: &mut Pool, row: &Row) -> Option<Affine> {
        let slope = *row.slopes.get(&self.momentum)?;
        let symbols = self.places.map(Symbol::state);
        let by = symbols.map(|symbol| partial(pool, &[row.gap], symbol)[0]);
        if pool.symbols(&by).iter().any(|symbol| symbols.contains(symbol)) {
            return None;
        }
        let rest = without(pool, row.gap, &self.places);
        let turned = self.slope(pool, by);
        let expected = pool.mul(self.factor, turned);
        same_polynomial(pool, slope, expected).then_some(Affine { by, rest })
    }

    /// What both rows of a pin have of the link, where that does not change and turns its vector.
    fn conformal(&self, pool: &mut Pool, rows: [&Row; 2]) -> Option<Conformal> {
        let [one, other] = rows.map(|row| self.affine(pool, row));
        let [[a, b], [c, d]] = [one?.by, other?.by];
        if ![a, b, c, d].iter().all(|&id| is_constant(pool, id)) {
            return None;
        }
        let square = sum_of_squares(pool, &[a, b]);
        let sense = [1.0, -1.0].into_iter().find(|&sense| {
            let (turned, opposed) = (pool.scale(sense, a), pool.scale(-sense, b));
            same_polynomial(pool, turned, d) && same_polynomial(pool, opposed, c)
        })?;
        (!pool.is_zero(square)).then_some(Conformal { rows: [[a, b], [c, d]], square, sense })
    }

    /// The link's momentum where `sense` times a flow over the pivot is its speed.
    fn momentum_of(&self, pool: &mut Pool, flow: Id, pivot: Id, sense: f64) -> Id {
        let speed = pool.div(flow, pivot);
        let momentum = pool.div(speed, self.factor);
        pool.scale(sense, momentum)
    }
}

fn dot(pool: &mut Pool, a: [Id; 2], b: [Id; 2]) -> Id {
    let (first, second) = (pool.mul(a[0], b[0]), pool.mul(a[1], b[1]));
    pool.add(first, second)
}

fn sum_of_squares(pool: &mut Pool, of: &[Id; 2]) -> Id {
    dot(pool, *of, *of)
}

/// Whether some of these change with the pose.
fn moves(pool: &Pool, of: &[Id]) -> bool {
    pool.symbols(of).into_iter().any(|symbol| symbol.as_state().is_some())
}

/// An expression in which these states are zero.
fn without(pool: &mut Pool, of: Id, gone: &[usize]) -> Id {
    let zero = pool.zero();
    substitute(pool, &[of], &|symbol| symbol.as_state().filter(|state| gone.contains(state)).map(|_| zero))[0]
}

/// Whether this part of a link's length keeps away from 1 and -1, and the length, squared, from 0, in all poses, for
/// all values that parameters may have.
fn is_apart(equations: &mut StateEquations, part: Id, square: Id) -> bool {
    let Bounds { least, most } = bounds_of(equations, part);
    least.abs().max(most.abs()) < FAR && bounds_of(equations, square).least > 0.0
}

/// Whether two links keep away from being stretched and folded in all poses: the distance of their outer ends between
/// the difference and the sum of their lengths. All squared.
fn is_between(equations: &mut StateEquations, distance: Id, lengths: [Id; 2]) -> bool {
    let [own, other, distance] = [lengths[0], lengths[1], distance]
        .map(|id| bounds_of(equations, id))
        .map(|Bounds { least, most }| [least, most]);
    let is_known = [own, other, distance].iter().all(|[least, most]| *least > 0.0 && most.is_finite());
    // The cosine of the angle at the first link has its extremes at the ends of the ranges: between them at most a
    // least value, above 0.
    let mut ends = own.into_iter().flat_map(|a| other.into_iter().flat_map(move |b| distance.map(|d| (a, b, d))));
    is_known && ends.all(|(a, b, d)| ((a + d - b) / (2.0 * (a * d).sqrt())).abs() < FAR)
}

/// The bounds of an expression in all poses. What it has of the cosine and the sine of one link is a cosine of its
/// angle, too.
fn bounds_of(equations: &mut StateEquations, id: Id) -> Bounds {
    let turns = angle::turns(equations);
    let StateEquations { pool, parameters, states, .. } = equations;
    let (mut rest, mut swing) = (id, 0.0);
    for turn in turns {
        let places = [turn.cosine, turn.sine];
        let by = places.map(|place| partial(pool, &[rest], Symbol::state(place))[0]);
        if let [Some(a), Some(b)] = by.map(|id| pool.as_number(id)) {
            swing += a.hypot(b);
            rest = without(pool, rest, &places);
        }
    }
    let of = |symbol: Symbol| match symbol {
        Symbol::Parameter(index) => {
            let Parameter { lower, upper, .. } = &parameters[index as usize];
            let [least, most] = [lower, upper].map(|end| end.map(|(end, _)| end));
            Bounds { least: least.unwrap_or(f64::NEG_INFINITY), most: most.unwrap_or(f64::INFINITY) }
        }
        Symbol::State(state) if states[state as usize].origin.kind() == Kind::Orientation => {
            Bounds { least: -1.0, most: 1.0 }
        }
        _ => Bounds::ANY,
    };
    let Bounds { least, most } = bounds(pool, rest, &of);
    Bounds { least: least - swing, most: most + swing }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::reduce::tests::scene;

    /// Equations in the plane with one link, and two lengths, squared, in ranges.
    fn link() -> StateEquations {
        let graph = "param a: m^2 = 1.5, at least 1, at most 2; param b: m^2 = 4, at least 3.5; \
            ground { point O = [0, 0, 0]; }
            body bob { mass 2; inertia [0.1, 0.2, 0.3]; point top = [0, 0.5, 0]; start top at [0, 0, 0]; \
            start turned rotation_z(0.3); }
            joint pin: revolute z (ground.O -> bob.top) { stiffness 1e4; damping 10; tilt stiffness 10; \
            tilt damping 1; }
            observe { angle: rad = bob.angle; size: m^2 = a + b; }";
        scene(graph, "expect planar;").reduced
    }

    /// The cosine and the sine of the link, then the lengths.
    fn symbols(of: &mut StateEquations) -> [Id; 4] {
        let [turn] = &angle::turns(of)[..] else { panic!("one link") };
        [turn.cosine, turn.sine]
            .map(Symbol::state)
            .into_iter()
            .chain([0, 1].map(Symbol::Parameter))
            .map(|symbol| of.pool.symbol(symbol))
            .collect::<Vec<_>>()
            .try_into()
            .expect("four symbols")
    }

    #[test]
    fn bounds_have_the_swing_of_a_link_once() {
        let mut of = link();
        let [cosine, sine, a, b] = symbols(&mut of);
        let pool = &mut of.pool;
        let swings = pool.linear(2.0, &[(cosine, 3.0), (sine, -4.0), (a, 1.0)]);
        // What stands before the cosine is in a range itself: no more is known than that a cosine is none above 1.
        let stretched = pool.mul(a, cosine);
        let of_both = pool.linear(0.0, &[(stretched, 1.0), (sine, 1.0)]);
        for (id, least, most) in [(swings, -2.0, 9.0), (of_both, -3.0, 3.0), (b, 3.5, f64::INFINITY)] {
            let found = bounds_of(&mut of, id);
            assert_eq!((found.least, found.most), (least, most));
        }
    }

    #[test]
    fn two_links_are_apart_from_being_stretched_and_folded_or_not() {
        let mut of = link();
        let [_, _, a, b] = symbols(&mut of);
        let mut is_between = |distance: f64, lengths: [f64; 2]| {
            let [distance, own, other] =
                [distance, lengths[0], lengths[1]].map(|length| of.pool.number(length * length));
            super::is_between(&mut of, distance, [own, other])
        };
        assert!(is_between(1.0, [1.0, 1.0]) && is_between(2.0, [2.0, 1.0]));
        assert!(!is_between(2.0, [1.0, 1.0]) && !is_between(1.0, [2.0, 1.0]) && !is_between(1.0, [1.0, 2.0]));
        assert!(!is_between(3.0, [1.0, 1.0]) && !is_between(0.0, [1.0, 1.0]));
        // Squares from 1 to 2 beside 1 and 1: stretched at 4, folded at 0. Without an end nothing is known.
        let one = of.pool.number(1.0);
        assert!(super::is_between(&mut of, a, [one, one]) && !super::is_between(&mut of, b, [one, one]));
        // A link of 1 to sqrt(2) and one of 1 are stretched at a distance of 2 if the first is the shortest that it may
        // be.
        let four = of.pool.number(4.0);
        assert!(!super::is_between(&mut of, four, [a, one]));
    }

    #[test]
    fn the_rest_of_a_gap_is_shorter_than_the_link_or_not() {
        let mut of = link();
        let [cosine, _, a, b] = symbols(&mut of);
        let mut is_apart = |factor: f64, square: Id| {
            let part = of.pool.scale(factor, cosine);
            super::is_apart(&mut of, part, square)
        };
        assert!(is_apart(0.99, a) && is_apart(-0.99, b) && !is_apart(1.0, a) && !is_apart(-1.0, a));
        let zero = of.pool.zero();
        let half = of.pool.number(0.5);
        assert!(!super::is_apart(&mut of, half, zero), "no link at all");
    }
}
