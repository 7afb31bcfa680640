//! Joints by what they let go.
//!
//! In: where a joint is on both ends. Out: the motion of the child by that of the parent and the joint's coordinates.
//! Method: a joint is a row of steps from the parent on, each a turn or a slide about or along the third of its own
//! axes; the rotation between both ends is a sum of constant matrices, each by a product of cosines and sines, so that
//! no rounding stays beside symbols.

use std::collections::BTreeMap;

use super::bodies::{Body, symbols, velocity};
use super::numbers::{self, Matrix, UNIT};
use crate::expr::{Id, Pool, Symbol};
use crate::system::Value;
use crate::system::link::{Freedom, Moves};

/// One freedom of a joint.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Step {
    /// From its axes to those of the step before it.
    pub before: Matrix,
    pub freedom: Freedom,
}

/// What a joint holds and lets go.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Kind {
    Revolute,
    Prismatic,
    Cylindrical,
    Universal,
    Spherical,
    /// A ball by three angles.
    Angles,
    Fixed,
    /// Of a body on no joint, which carries others.
    Floating,
}

/// The third axis along the first one before.
const ACROSS: Matrix = [0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
const TURN: Step = Step { before: UNIT, freedom: Freedom::Turn };
const SLIDE: Step = Step { before: UNIT, freedom: Freedom::Slide };
const BALL: Step = Step { before: UNIT, freedom: Freedom::Ball };
const FREE: Step = Step { before: UNIT, freedom: Freedom::Free };
const TURN_ACROSS: Step = Step { before: ACROSS, freedom: Freedom::Turn };

/// The steps at most of a joint that is recognised.
pub(super) const STEPS: usize = 2;

impl Kind {
    /// The joint that holds so many directions of motion and of turning; none where it is not known.
    pub fn of(translations: usize, rotations: usize) -> Option<Self> {
        match (translations, rotations) {
            (3, 2) => Some(Self::Revolute),
            (2, 3) => Some(Self::Prismatic),
            (2, 2) => Some(Self::Cylindrical),
            (3, 1) => Some(Self::Universal),
            (3, 0) => Some(Self::Spherical),
            (3, 3) => Some(Self::Fixed),
            _ => None,
        }
    }

    pub fn steps(self) -> &'static [Step] {
        match self {
            Self::Revolute => &[TURN],
            Self::Prismatic => &[SLIDE],
            Self::Cylindrical => &[SLIDE, TURN],
            Self::Universal => &[TURN, TURN_ACROSS],
            Self::Spherical => &[BALL],
            Self::Angles => &[TURN, TURN_ACROSS, TURN_ACROSS],
            Self::Fixed => &[],
            Self::Floating => &[FREE],
        }
    }
}

/// A joint from the parent, the ground where it is none, to the child.
#[derive(Clone, Debug)]
pub(super) struct Joint {
    pub name: String,
    pub rows: Vec<usize>,
    pub parent: Option<usize>,
    pub child: usize,
    pub kind: Kind,
    /// Constant rotations to the parent's axes from those before the first step, to the child's from the last step's.
    pub frames: [Matrix; 2],
    /// Where the joint is, in the axes of both, from their centres.
    pub at: [Value; 2],
    /// The state that counts the turns of its angle, where that is the coordinate.
    pub angle: Option<usize>,
    /// Whether the start looks for its speeds.
    pub is_sought: bool,
}

/// How many symbols a probe has.
pub(super) const PROBES: usize = 4 + 4 * STEPS;

/// Symbols for proofs: a rotation of the parent, the moves of each step.
pub(super) struct Probe {
    pub rotation: Value,
    /// Place, cosine, sine and speed of each step.
    pub symbols: [[Symbol; 4]; STEPS],
    pub moves: [Moves; STEPS],
}

impl Probe {
    /// A rotation by four numbers that are not all zero, whatever they are (Euler, Rodrigues).
    pub fn new(pool: &mut Pool, first: usize) -> Self {
        let symbol = |k: usize| Symbol::numbered(Symbol::Weight, first + k);
        let [w, x, y, z] = [0, 1, 2, 3].map(|k| pool.symbol(symbol(k)));
        let parts = [w, x, y, z];
        let squares: Vec<Id> = parts.iter().map(|&part| pool.powi(part, 2)).collect();
        let norm = pool.sum(&squares);
        let vector = [x, y, z];
        let mut entries = Vec::new();
        for row in 0..3 {
            for column in 0..3 {
                let product = pool.mul(vector[row], vector[column]);
                let entry = if row == column {
                    let all: Vec<(Id, f64)> = (1..4)
                        .map(|k| (squares[k], if k == row + 1 { 1.0 } else { -1.0 }))
                        .chain([(squares[0], 1.0)])
                        .collect();
                    pool.linear(0.0, &all)
                } else {
                    let third = 3 - row - column;
                    let sign = if (row + 1) % 3 == column { -2.0 } else { 2.0 };
                    let side = pool.mul(w, vector[third]);
                    pool.linear(0.0, &[(product, 2.0), (side, sign)])
                };
                entries.push(pool.div(entry, norm));
            }
        }
        let symbols: [[Symbol; 4]; STEPS] =
            std::array::from_fn(|step| std::array::from_fn(|k| symbol(4 + 4 * step + k)));
        let moves = symbols.map(|of| {
            let [place, cosine, sine, speed] = of.map(|symbol| pool.symbol(symbol));
            Moves { place, cosine, sine, speed }
        });
        Self { rotation: Value(entries), symbols, moves }
    }
}

impl Joint {
    /// A body that moves freely, with what it carries.
    pub fn floating(pool: &mut Pool, body: usize) -> Self {
        Self {
            name: String::new(),
            rows: Vec::new(),
            parent: None,
            child: body,
            kind: Kind::Floating,
            frames: [UNIT; 2],
            at: [Value::zero(pool, 3), Value::zero(pool, 3)],
            angle: None,
            is_sought: false,
        }
    }

    pub fn steps(&self) -> &'static [Step] {
        self.kind.steps()
    }

    /// The states of its child that it gives.
    pub fn given(&self, bodies: &[Body]) -> Vec<usize> {
        let body = &bodies[self.child];
        match self.kind {
            Kind::Floating => Vec::new(),
            Kind::Spherical => body.place.iter().chain(&body.linear).copied().collect(),
            _ => body.states().collect(),
        }
    }

    /// Each state and velocity of the child by those of the parent and the joint; with `turned` the parent's axes are
    /// these, and among what is returned.
    pub fn motion(
        &self,
        pool: &mut Pool,
        bodies: &[Body],
        moves: &[Moves],
        turned: Option<&Value>,
    ) -> BTreeMap<Symbol, Id> {
        let mut images = BTreeMap::new();
        let own = |pool: &mut Pool, body: usize, first: usize| {
            Value((first..first + 3).map(|k| pool.symbol(velocity(body, k))).collect())
        };
        let (axes, place, fast, before) = match self.parent {
            None => (Value::identity(pool), Value::zero(pool, 3), Value::zero(pool, 3), Value::zero(pool, 3)),
            Some(parent) => {
                let states = symbols(pool, &bodies[parent].axes);
                if let Some(turned) = turned {
                    let states = bodies[parent].axes.iter().map(|&state| Symbol::state(state));
                    images.extend(states.zip(turned.0.iter().copied()));
                }
                (
                    turned.cloned().unwrap_or(states),
                    symbols(pool, &bodies[parent].place),
                    own(pool, parent, 0),
                    own(pool, parent, 3),
                )
            }
        };
        let mut arm = axes.multiply(pool, &self.at[0]);
        let (mut slid, mut spin) = (Value::zero(pool, 3), before.clone());
        let mut turn = Turned::by(&self.frames[0]);
        for (step, moves) in self.steps().iter().zip(moves) {
            turn = turn.times(&step.before);
            let turned = turn.value(pool).0;
            let third = axes.multiply(pool, &Value(vec![turned[2], turned[5], turned[8]]));
            let along = third.multiply(pool, &Value::scalar(moves.speed));
            match step.freedom {
                Freedom::Turn => {
                    spin = spin.add(pool, &along);
                    turn = turn.about_third(pool, moves);
                }
                Freedom::Ball | Freedom::Free => {}
                Freedom::Slide => {
                    let by = third.multiply(pool, &Value::scalar(moves.place));
                    arm = arm.add(pool, &by);
                    slid = slid.add(pool, &along);
                }
            }
        }
        let body = &bodies[self.child];
        let child = if self.kind == Kind::Spherical {
            spin = own(pool, self.child, 3);
            symbols(pool, &body.axes)
        } else {
            let relative = turn.times(&numbers::transposed(&self.frames[1])).value(pool);
            axes.multiply(pool, &relative)
        };
        let back = child.multiply(pool, &self.at[1]).negate(pool);
        let there = place.add(pool, &arm).add(pool, &back);
        let (first, second) = (before.cross(pool, &arm), spin.cross(pool, &back));
        let moved = fast.add(pool, &first).add(pool, &slid).add(pool, &second);
        let states = body.axes.iter().chain(&body.place).map(|&state| Symbol::state(state));
        images.extend(states.zip(child.0.into_iter().chain(there.0)));
        images.extend((0..6).map(|k| velocity(self.child, k)).zip(moved.0.into_iter().chain(spin.0)));
        images
    }
}

/// A rotation as a sum of constant matrices, each by a product of cosines and sines.
struct Turned(Vec<(Option<Id>, Matrix)>);

impl Turned {
    fn by(matrix: &Matrix) -> Self {
        Self(vec![(None, *matrix)])
    }

    fn times(&self, matrix: &Matrix) -> Self {
        Self(self.0.iter().map(|(by, part)| (*by, numbers::product(part, matrix))).collect())
    }

    fn about_third(&self, pool: &mut Pool, moves: &Moves) -> Self {
        const PARTS: [Matrix; 3] = [
            [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0],
            [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        ];
        let mut all = Vec::new();
        for (by, part) in &self.0 {
            for (factor, of) in [None, Some(moves.cosine), Some(moves.sine)].into_iter().zip(&PARTS) {
                let by = match (*by, factor) {
                    (Some(by), Some(factor)) => Some(pool.mul(by, factor)),
                    (by, factor) => by.or(factor),
                };
                all.push((by, numbers::product(part, of)));
            }
        }
        Self(all)
    }

    fn value(&self, pool: &mut Pool) -> Value {
        let entry = |k: usize| {
            let constant = self.0.iter().filter(|(by, _)| by.is_none()).map(|(_, part)| part[k]).sum();
            let terms: Vec<(Id, f64)> = self.0.iter().filter_map(|(by, part)| Some(((*by)?, part[k]))).collect();
            pool.linear(constant, &terms)
        };
        Value((0..9).map(entry).collect())
    }
}
