//! Inverse dynamics of a tree of links: the efforts that its accelerations take, and how these change.
//!
//! In: links with their motion. Out: for each freedom how its effort changes with the places, speeds and accelerations
//! of the links that carry it and of those that it carries; of other links it does not. Method: a link with all that it
//! carries is one body whose mass is in motion inside it. A coordinate moves this body as a whole, so that one wrench
//! says what changes before it, and one functional of the motion under it says how its own effort changes
//! (Carpentier and Mansard, Analytical Derivatives of Rigid Body Dynamics Algorithms, Robotics: Science and Systems,
//! 2018; composite bodies: Featherstone, Rigid Body Dynamics Algorithms, 2008, section 6.2). Accelerations are those of
//! the links' origins, so velocities of points take no part.

use crate::expr::{Branch, Id, Pool, Symbol, substitute_switched};
use crate::system::Value;
use crate::system::link::{Freedom, Link, Moved, matrix_up, up};
use crate::system::rigid::{Accelerated, Given, LinkMotion, Mass, square};

/// A tree of links in motion.
#[derive(Clone, Debug)]
pub struct InverseDynamics {
    /// Parents first. What is constant of them has no states.
    pub links: Vec<Link>,
    /// What moves them.
    pub moved: Vec<Moved>,
    /// Their angular velocities, in their axes.
    pub spins: Vec<Value>,
    /// The acceleration of the ground that stands for weights.
    pub ground: Value,
    /// The rates of the speeds; zero of a link that has none of its own.
    pub rates: Vec<Id>,
    /// The angular acceleration of a link and that of its origin, in its axes, where these are known beside the rates:
    /// always those of a link whose body keeps its orientation.
    pub accelerations: Vec<Option<[Value; 2]>>,
    /// The symbol of the first unknown of each link.
    pub unknowns: Vec<usize>,
    /// Rates of momenta: as they are, and by the unknowns.
    pub written: Vec<[Id; 2]>,
}

/// What an effort depends on.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Variable {
    /// The place of a link with a coordinate.
    Place(usize),
    /// Its speed.
    Speed(usize),
    /// An unknown of a link: the rate of its speed; of one whose body keeps its orientation a component of its angular
    /// velocity, its angular acceleration and the acceleration of its origin.
    Unknown(usize, usize),
}

/// The equation of an effort: what the accelerations take less what acts is zero.
#[derive(Clone, Debug)]
pub struct Row {
    /// The unknown that it gives.
    pub of: (usize, usize),
    /// How what the accelerations take changes.
    pub slopes: Vec<(Variable, Id)>,
    /// What acts.
    pub acting: Id,
}

/// How many unknowns a link has: the rate of its speed, or motion and accelerations of a body that keeps its
/// orientation.
const OWN: usize = 9;

impl InverseDynamics {
    /// Whether the derivatives of such a tree are known here: a body on a ball is on the ground.
    pub fn covers(links: &[Link]) -> bool {
        links.iter().all(|link| link.freedom.has_coordinate() || link.parent.is_none())
    }

    /// The first unknown of each link, from this symbol on.
    pub fn numbered(links: &[Link], first: usize) -> Vec<usize> {
        let number = |next: &mut usize, link: &Link| {
            let own = *next;
            *next += unknowns_of(link);
            Some(own)
        };
        links.iter().scan(first, number).collect()
    }

    /// The symbol of an unknown of a link.
    pub fn symbol(&self, (link, unknown): (usize, usize)) -> Symbol {
        Symbol::numbered(Symbol::Weight, self.unknowns[link] + unknown)
    }

    /// All unknowns in the order of the links.
    pub fn all(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let of = |(link, own): (usize, &Link)| (0..unknowns_of(own)).map(move |unknown| (link, unknown));
        self.links.iter().enumerate().flat_map(of)
    }

    /// The value of an unknown by states.
    pub fn value(&self, (link, unknown): (usize, usize)) -> Id {
        match &self.accelerations[link] {
            Some([turning, there]) if !self.links[link].freedom.has_coordinate() => {
                [&self.spins[link], turning, there][unknown / 3].0[unknown % 3]
            }
            _ => self.rates[link],
        }
    }

    /// Replaces symbols and decides switches everywhere.
    pub fn replace(&mut self, pool: &mut Pool, replace: &dyn Fn(Symbol) -> Option<Id>, branch: &dyn Fn(u32) -> Branch) {
        let roots = self.roots();
        let before: Vec<Id> = roots.iter().map(|id| **id).collect();
        let after = substitute_switched(pool, &before, replace, branch);
        roots.into_iter().zip(after).for_each(|(root, id)| *root = id);
    }

    /// Every expression that depends on states.
    fn roots(&mut self) -> Vec<&mut Id> {
        let mut roots: Vec<&mut Id> = Vec::new();
        for Moved { moves, offset, effort, load, locked, own } in &mut self.moved {
            roots.extend([&mut moves.place, &mut moves.cosine, &mut moves.sine, &mut moves.speed, effort]);
            roots.extend(offset.0.iter_mut().chain(load.iter_mut().flat_map(|part| &mut part.0)));
            roots.extend(locked.iter_mut().flat_map(|locked| [&mut locked.acts, &mut locked.rate]));
            if let Some(own) = own {
                let parts = [Some(&mut own.turned), Some(&mut own.spin), own.fast.as_mut()];
                roots.extend(parts.into_iter().flatten().flat_map(|part| &mut part.0));
            }
        }
        roots.extend(self.spins.iter_mut().flat_map(|spin| &mut spin.0));
        roots.extend(&mut self.ground.0);
        roots.extend(&mut self.rates);
        roots.extend(self.accelerations.iter_mut().flatten().flatten().flat_map(|part| &mut part.0));
        roots.extend(self.written.iter_mut().flatten());
        roots
    }

    /// The equations of the efforts, in the order of the unknowns that they give: of a link with a coordinate that
    /// along it, of a body that keeps its orientation those of the moment and, where nothing holds it, of the force.
    pub fn rows(&self, pool: &mut Pool) -> Vec<Row> {
        let accelerated = self.accelerated(pool);
        let composites = self.composites(pool, &accelerated);
        let accelerations = accelerated.links;
        let acting = self.acting(pool);
        let mut rows: Vec<Row> = Vec::new();
        let mut first = Vec::new();
        for (k, link) in self.links.iter().enumerate() {
            first.push(rows.len());
            let efforts = efforts(link);
            let row = |effort: &Effort| Row {
                of: (k, if link.freedom.has_coordinate() { 0 } else { effort.unknown() }),
                slopes: Vec::new(),
                acting: acting[k][effort.block].0[effort.component],
            };
            rows.extend(efforts.iter().map(row));
        }
        for (k, link) in self.links.iter().enumerate() {
            self.columns(pool, k, (&accelerations[k], &composites[k]), &first, &mut rows);
            for (at, effort) in efforts(link).iter().enumerate() {
                let functional = composites[k].functional(pool, &self.spins[k], effort);
                self.carried_by(pool, k, functional, &accelerations, &mut rows[first[k] + at]);
            }
        }
        rows
    }

    /// How the links are accelerated.
    fn accelerated(&self, pool: &mut Pool) -> Accelerated {
        let own = |k: usize| match self.accelerations[k].clone() {
            Some([turning, there]) => Given::Accelerations(turning, Some(there)),
            None => Given::Rate(self.rates[k]),
        };
        Accelerated::of(pool, &self.links, (&self.moved, &self.spins), &self.ground, own)
    }

    /// Each link with all that it carries.
    fn composites(&self, pool: &mut Pool, accelerated: &Accelerated) -> Vec<Composite> {
        let mut all: Vec<Composite> = Vec::new();
        for (k, link) in self.links.iter().enumerate() {
            all.push(Composite::of(pool, link, accelerated.motion(k)));
        }
        for (k, link) in self.links.iter().enumerate().rev() {
            if let Some(parent) = link.parent {
                let carried = all[k].carried(pool, link, &self.moved[k]);
                all[parent] = all[parent].add(pool, &carried);
            }
        }
        all
    }

    /// What acts on each link and on all that it carries: moment about its origin and force in its axes, with what
    /// drives its own freedom.
    fn acting(&self, pool: &mut Pool) -> Vec<[Value; 2]> {
        let mut all: Vec<[Value; 2]> = self.moved.iter().map(|moved| moved.load.clone()).collect();
        for (k, link) in self.links.iter().enumerate().rev() {
            if let Some(parent) = link.parent {
                let [moment, force] = wrench_up(pool, link, &self.moved[k], &all[k]);
                all[parent] = [all[parent][0].add(pool, &moment), all[parent][1].add(pool, &force)];
            }
            if let Some(effort) = efforts(link).first().filter(|_| link.freedom.has_coordinate()) {
                let along = &mut all[k][effort.block].0[effort.component];
                *along = pool.add(*along, self.moved[k].effort);
            }
        }
        all
    }

    /// How the efforts of a link and of those that carry it change with its own variables.
    fn columns(
        &self,
        pool: &mut Pool,
        of: usize,
        (accelerations, composite): (&[Value; 2], &Composite),
        first: &[usize],
        rows: &mut [Row],
    ) {
        let link = &self.links[of];
        for (variable, change) in self.changes(pool, of, accelerations) {
            let mut wrench = composite.response(pool, &self.spins[of], &change);
            if matches!(variable, Variable::Place(_)) {
                let turned = composite.moved_wrench(pool, link.freedom);
                wrench = [0, 1].map(|k| wrench[k].add(pool, &turned[k]));
            }
            for (at, effort) in efforts(link).iter().enumerate() {
                rows[first[of] + at].add(pool, variable, wrench[effort.block].0[effort.component]);
            }
            let mut at = of;
            while let Some(parent) = self.links[at].parent {
                wrench = wrench_up(pool, &self.links[at], &self.moved[at], &wrench);
                for (k, effort) in efforts(&self.links[parent]).iter().enumerate() {
                    rows[first[parent] + k].add(pool, variable, wrench[effort.block].0[effort.component]);
                }
                at = parent;
            }
        }
    }

    /// How an effort of a link changes with the variables of those that carry it.
    fn carried_by(&self, pool: &mut Pool, of: usize, mut by: Motion, accelerations: &[[Value; 2]], row: &mut Row) {
        let mut at = of;
        while let Some(parent) = self.links[at].parent {
            by = self.under(pool, at, parent, &by);
            for (variable, change) in self.changes(pool, parent, &accelerations[parent]) {
                let parts = [0, 1, 2].map(|k| by.0[k].dot(pool, &change.0[k]));
                let slope = pool.sum(&parts);
                row.add(pool, variable, slope);
            }
            at = parent;
        }
    }

    /// A functional of a link's motion as one of its parent's.
    fn under(&self, pool: &mut Pool, of: usize, parent: usize, Motion([spin, turning, there]): &Motion) -> Motion {
        let (link, moved) = (&self.links[of], &self.moved[of]);
        // What a change of the parent's angular velocity does by the link's own speed.
        let (part, factor) = if link.freedom == Freedom::Turn { (turning, 1.0) } else { (there, 2.0) };
        let speed = pool.scale(factor, moved.moves.speed);
        let across = [pool.mul(speed, part.0[1]), pool.mul(speed, part.0[0])];
        let beside = Value(vec![pool.neg(across[0]), across[1], pool.zero()]);
        let spin = spin.add(pool, &beside);
        let [spin, turning, there] = [&spin, turning, there].map(|part| up(pool, link, moved, part));
        let lever = moved.offset.cross(pool, &there);
        let swung = swing(pool, &self.spins[parent], &moved.offset, &there);
        Motion([spin.add(pool, &swung), turning.add(pool, &lever), there])
    }

    /// The variables of a link, each with what of its motion changes with it.
    fn changes(&self, pool: &mut Pool, of: usize, [turning, there]: &[Value; 2]) -> Vec<(Variable, Motion)> {
        let zero = pool.zero();
        let none = Value(vec![zero; 3]);
        let spin = &self.spins[of];
        let across = |pool: &mut Pool, of: &Value| Value(vec![of.0[1], pool.neg(of.0[0]), zero]);
        let unit = |pool: &mut Pool, k: usize| {
            let one = pool.one();
            Value((0..3).map(|other| if other == k { one } else { zero }).collect())
        };
        match self.links[of].freedom {
            Freedom::Turn => {
                let [spun, turned, pulled] = [spin, turning, there].map(|part| across(pool, part));
                let along = unit(pool, 2);
                vec![
                    (Variable::Place(of), Motion([spun.clone(), turned, pulled])),
                    (Variable::Speed(of), Motion([along.clone(), spun, none.clone()])),
                    (Variable::Unknown(of, 0), Motion([none.clone(), along, none])),
                ]
            }
            Freedom::Slide => {
                let along = unit(pool, 2);
                let square = square(pool, spin);
                let carried = across(pool, turning);
                let column = Value(vec![square.0[2], square.0[5], square.0[8]]);
                let pulled = carried.add(pool, &column);
                let twice = across(pool, spin).scale(pool, 2.0);
                vec![
                    (Variable::Place(of), Motion([none.clone(), none.clone(), pulled])),
                    (Variable::Speed(of), Motion([none.clone(), none.clone(), twice])),
                    (Variable::Unknown(of, 0), Motion([none.clone(), none, along])),
                ]
            }
            Freedom::Ball | Freedom::Free => {
                let change = |pool: &mut Pool, unknown: usize| {
                    let mut parts = [none.clone(), none.clone(), none.clone()];
                    parts[unknown / 3] = unit(pool, unknown % 3);
                    (Variable::Unknown(of, unknown), Motion(parts))
                };
                (0..OWN).map(|unknown| change(pool, unknown)).collect()
            }
        }
    }
}

impl Row {
    fn add(&mut self, pool: &Pool, variable: Variable, slope: Id) {
        if !pool.is_zero(slope) {
            self.slopes.push((variable, slope));
        }
    }
}

/// Angular velocity, angular acceleration and acceleration of the origin: a change of these, or the factors by which a
/// functional of them takes each.
#[derive(Clone, Debug)]
struct Motion([Value; 3]);

/// A component of a wrench: moment or force.
#[derive(Clone, Copy, Debug)]
struct Effort {
    block: usize,
    component: usize,
}

impl Effort {
    /// The unknown of a body that keeps its orientation that this gives.
    fn unknown(&self) -> usize {
        3 + 3 * self.block + self.component
    }
}

/// The components of a link's wrench that nothing holds.
fn efforts(link: &Link) -> Vec<Effort> {
    let all = |block: usize| (0..3).map(move |component| Effort { block, component });
    match link.freedom {
        Freedom::Turn => vec![Effort { block: 0, component: 2 }],
        Freedom::Slide => vec![Effort { block: 1, component: 2 }],
        Freedom::Ball => all(0).collect(),
        Freedom::Free => all(0).chain(all(1)).collect(),
    }
}

fn unknowns_of(link: &Link) -> usize {
    if link.freedom.has_coordinate() { 1 } else { OWN }
}

/// A wrench of a link in the axes of its parent, about the parent's origin.
fn wrench_up(pool: &mut Pool, link: &Link, moved: &Moved, wrench: &[Value; 2]) -> [Value; 2] {
    let [moment, force] = [0, 1].map(|k| up(pool, link, moved, &wrench[k]));
    let lever = moved.offset.cross(pool, &force);
    [moment.add(pool, &lever), force]
}

/// How the component along `by` of w x (w x r) changes with w: (by . w) r + (w . r) by - 2 (by . r) w.
fn swing(pool: &mut Pool, spin: &Value, r: &Value, by: &Value) -> Value {
    let [first, second, third] = [by.dot(pool, spin), spin.dot(pool, r), by.dot(pool, r)];
    let third = pool.scale(-2.0, third);
    let parts = [(first, r), (second, by), (third, spin)].map(|(factor, of)| of.multiply(pool, &Value::scalar(factor)));
    parts[0].add(pool, &parts[1]).add(pool, &parts[2])
}

/// A link with all that it carries, whose places are from its origin in its axes.
#[derive(Clone, Debug)]
struct Composite {
    mass: Id,
    /// The first moment.
    first: Value,
    /// The second moments, the integral of r r^T over the mass.
    second: Value,
    /// The momentum that the mass has beside that of the link.
    drift: Value,
    /// The integral of r v^T with that velocity v.
    swirl: Value,
    /// Moment about the origin and force that its accelerations take.
    wrench: [Value; 2],
}

impl Composite {
    /// Of a link that carries nothing.
    fn of(pool: &mut Pool, link: &Link, motion: LinkMotion<'_>) -> Self {
        let (drift, swirl) = (Value::zero(pool, 3), Value::zero(pool, 9));
        let wrench = link.counted.wrench(pool, motion);
        let Mass { mass, first, second } = link.counted.clone();
        Self { mass, first, second, drift, swirl, wrench }
    }

    fn add(&self, pool: &mut Pool, other: &Self) -> Self {
        Self {
            mass: pool.add(self.mass, other.mass),
            first: self.first.add(pool, &other.first),
            second: self.second.add(pool, &other.second),
            drift: self.drift.add(pool, &other.drift),
            swirl: self.swirl.add(pool, &other.swirl),
            wrench: [0, 1].map(|k| self.wrench[k].add(pool, &other.wrench[k])),
        }
    }

    /// As part of the link's parent.
    fn carried(&self, pool: &mut Pool, link: &Link, moved: &Moved) -> Self {
        let r = &moved.offset;
        let (drift, swirl) = self.with_speed(pool, link.freedom, moved.moves.speed);
        let first = up(pool, link, moved, &self.first);
        let at_origin = r.multiply(pool, &Value::scalar(self.mass));
        let half = at_origin.scale(pool, 0.5).add(pool, &first).outer(pool, r);
        let second = matrix_up(pool, link, moved, &self.second).symmetric();
        let second = second.add(pool, &half).add(pool, &half.transpose());
        let drift = up(pool, link, moved, &drift);
        let beside = r.outer(pool, &drift);
        let swirl = matrix_up(pool, link, moved, &swirl).add(pool, &beside);
        let first = first.add(pool, &at_origin);
        let wrench = wrench_up(pool, link, moved, &self.wrench);
        Self { mass: self.mass, first, second, drift, swirl, wrench }
    }

    /// Momentum and the integral of r v^T beside the motion of the parent: with what the link's own speed does.
    fn with_speed(&self, pool: &mut Pool, freedom: Freedom, speed: Id) -> (Value, Value) {
        let speed = Value::scalar(speed);
        let (c, s) = (&self.first.0, &self.second.0);
        let zero = pool.zero();
        let (along, swung) = match freedom {
            Freedom::Turn => {
                let minus = [c[1], s[1], s[4], s[7]].map(|id| pool.neg(id));
                let swung = (0..3).flat_map(|row| [minus[1 + row], s[3 * row], zero]).collect();
                (Value(vec![minus[0], c[0], zero]), Value(swung))
            }
            _ => {
                let swung = (0..3).flat_map(|row| [zero, zero, c[row]]).collect();
                (Value(vec![zero, zero, self.mass]), Value(swung))
            }
        };
        let [along, swung] = [along, swung].map(|of| of.multiply(pool, &speed));
        (self.drift.add(pool, &along), self.swirl.add(pool, &swung))
    }

    /// What a place of the link adds to its wrench, as those that carry it see it: the wrench turns or slides with it.
    fn moved_wrench(&self, pool: &mut Pool, freedom: Freedom) -> [Value; 2] {
        let across = |pool: &mut Pool, of: &Value| Value(vec![pool.neg(of.0[1]), of.0[0], pool.zero()]);
        let [moment, force] = &self.wrench;
        match freedom {
            Freedom::Turn => [moment, force].map(|part| across(pool, part)),
            _ => [across(pool, force), Value::zero(pool, 3)],
        }
    }

    /// The wrench that a change of the link's motion takes.
    fn response(&self, pool: &mut Pool, spin: &Value, Motion([spun, turned, pulled]): &Motion) -> [Value; 2] {
        // How the matrix changes that takes a place to what its acceleration is beside that of the origin.
        let (one, other) = (spun.outer(pool, spin), spin.outer(pool, spun));
        let both = spin.dot(pool, spun);
        let less = pool.scale(-2.0, both);
        let beside = Value::diagonal(pool, &[less; 3]);
        let field = turned.skew(pool).add(pool, &one).add(pool, &other).add(pool, &beside);
        let moments = field.multiply(pool, &self.second);
        let about = Value(
            (0..3)
                .map(|k| {
                    let (x, y) = ((k + 1) % 3, (k + 2) % 3);
                    pool.sub(moments.0[3 * y + x], moments.0[3 * x + y])
                })
                .collect(),
        );
        let lever = self.first.cross(pool, pulled);
        let drifting = Value((0..3).map(|k| self.drifting(pool, k).dot(pool, spun)).collect());
        let moment = about.add(pool, &lever).add(pool, &drifting);
        let twice = spun.scale(pool, 2.0).cross(pool, &self.drift);
        let force = pulled.multiply(pool, &Value::scalar(self.mass));
        let swung = field.multiply(pool, &self.first);
        [moment, force.add(pool, &swung).add(pool, &twice)]
    }

    /// How an effort changes with the link's motion.
    fn functional(&self, pool: &mut Pool, spin: &Value, effort: &Effort) -> Motion {
        let k = effort.component;
        let (x, y) = ((k + 1) % 3, (k + 2) % 3);
        let (w, c) = (&spin.0, &self.first.0);
        let zero = pool.zero();
        // The one by x, the other by y, less by the first: a vector across k.
        let across = |by_x: Id, by_y: Id| {
            let mut parts = vec![zero; 3];
            (parts[x], parts[y]) = (by_x, by_y);
            Value(parts)
        };
        let along = |of: Id| Value((0..3).map(|other| if other == k { of } else { zero }).collect());
        if effort.block == 0 {
            let row = |k: usize| Value(self.second.0[3 * k..3 * k + 3].to_vec());
            let (by_x, by_y) = (row(x), row(y));
            let dots = [spin.dot(pool, &by_x), spin.dot(pool, &by_y)];
            let minus = [pool.neg(dots[1]), pool.neg(w[x]), pool.neg(c[y])];
            let parts = [by_x.multiply(pool, &Value::scalar(w[y])), by_y.multiply(pool, &Value::scalar(minus[1]))];
            let spun = parts[0].add(pool, &parts[1]).add(pool, &across(minus[0], dots[0]));
            let drifting = self.drifting(pool, k);
            let trace = pool.sum(&[self.second.0[0], self.second.0[4], self.second.0[8]]);
            let less = row(k).negate(pool);
            let turned = along(trace).add(pool, &less);
            return Motion([spun.add(pool, &drifting), turned, across(minus[2], c[x])]);
        }
        let pulled = along(self.mass);
        let swung = swing(pool, spin, &self.first, &along(pool.one()));
        let minus = pool.neg(c[x]);
        let drift = [pool.scale(2.0, self.drift.0[y]), pool.scale(-2.0, self.drift.0[x])];
        Motion([swung.add(pool, &across(drift[0], drift[1])), across(c[y], minus), pulled])
    }

    /// How the moment about an axis changes with the angular velocity by what drifts inside: 2 r x (w x v) over the
    /// mass.
    fn drifting(&self, pool: &mut Pool, k: usize) -> Value {
        let (x, y) = ((k + 1) % 3, (k + 2) % 3);
        let twice = |pool: &mut Pool, place: usize| pool.scale(-2.0, self.swirl.0[place]);
        let mut parts = vec![pool.zero(); 3];
        parts[x] = twice(pool, 3 * x + k);
        parts[y] = twice(pool, 3 * y + k);
        parts[k] = pool.linear(0.0, &[(self.swirl.0[4 * x], 2.0), (self.swirl.0[4 * y], 2.0)]);
        Value(parts)
    }
}
