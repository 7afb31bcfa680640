//! Whether a model can stand in a state that a run is to start from: one that was saved, edited, or set by a host.
//!
//! In: a model, a time, a state, how large its states have been. Out: the state with what rounding leaves closed, or
//! what is wrong: an orientation that is no rotation, a rigid joint that is open or torn apart, a stop that is passed.
//! Of switches that remember, whether what is known of them can be.
//!
//! What counts as zero is a part of the machine's size: of the sum of what each state, as large as it has been, adds to
//! the gap, the flow or the place concerned. A machine that is scaled has the same verdicts. Beside that counts what
//! the model's own start leaves, which its assembly has accepted.

use alloc::borrow::ToOwned;
use alloc::string::String;
use alloc::vec;
use alloc::vec::Vec;

use thiserror::Error;

use crate::model::description::{StateInfo, StateKind};
use crate::model::dynamics::{Machine, branches};
use crate::model::holding::{Held, Slip, Slipping, Stops};
use crate::model::reactions::{Collision, impacts_of};
use crate::model::scalar::double::worse;
use crate::model::system::decide_by_sign;

/// The part of the machine's size that rounding may leave of what should be zero, where a run starts.
pub const CLOSE: f64 = 1e-9;
/// The same of joints that Baumgarte's terms draw together, or whose pose is near a singular one: no projection closes
/// them at once.
const DRAWN: f64 = 1e-3;
/// What is closer than this part is left as it is: a run leaves as much.
const EXACT: f64 = 1e-13;
/// The part by which something is left beyond a stop that it is moved onto.
const TOUCHES: f64 = 8.0 * f64::EPSILON;
/// How often what is open is closed: Newton's steps.
const ROUNDS: usize = 6;
/// The part of a state's size for a difference.
const ASIDE: f64 = 1e-6;

/// A state that a model cannot stand in.
#[derive(Clone, PartialEq, Error)]
pub enum Misplaced {
    /// An orientation is no rotation.
    #[error(
        "the orientation `{name}` is no rotation: its columns must have length 1 and be at right angles, they are off \
         by {off:.2e} (allowed: {allowed:.0e})"
    )]
    NoRotation {
        /// Its name.
        name: String,
        /// By how much the products of its columns are off.
        off: f64,
        /// By how much they may be.
        allowed: f64,
    },
    /// A rigid joint is open.
    #[error("joint `{}` is open by {size:.2e} {unit}{} (allowed: {allowed:.0e})", .slip.joint, direction(.slip))]
    Open {
        /// What the joint should hold.
        slip: Slip,
        /// The signed gap.
        size: f64,
        /// The gap that rounding may leave.
        allowed: f64,
        /// The unit of both.
        unit: String,
    },
    /// A rigid joint is torn apart.
    #[error("joint {slipping} (allowed: {allowed:.0e})")]
    Torn {
        /// The joint and its speed.
        slipping: Slipping,
        /// The speed that rounding may leave.
        allowed: f64,
    },
    /// An end of a stop is passed.
    #[error("stop `{stop}` is passed by {by:.2e} {unit} (allowed: {allowed:.0e})")]
    Beyond {
        /// The stop.
        stop: &'static str,
        /// How far.
        by: f64,
        /// How far rounding may leave it.
        allowed: f64,
        /// The unit of both.
        unit: String,
    },
}

debug_is_display!(Misplaced);

fn direction(slip: &Slip) -> String {
    if slip.direction.is_empty() { String::new() } else { alloc::format!(" {}", slip.direction) }
}

/// The unit of the integral of a flow: `m` of `m/s`.
fn integrated(unit: &str) -> String {
    unit.strip_suffix("/s")
        .map_or_else(|| alloc::format!("{unit}*s"), |unit| if unit == "1" { String::new() } else { unit.to_owned() })
}

/// A model at a place, with what its sizes are known from.
pub struct Standing<'a> {
    model: &'a dyn Machine,
    /// Time, s.
    t: f64,
    /// How large each state has been; an orientation's component counts as 1, an angle as 1 rad at least.
    sizes: Vec<f64>,
    /// The model's own start, where it has one.
    start: Option<Vec<f64>>,
    /// What may be left, as a part of a size.
    part: f64,
}

/// Numbers that should be zero, each with its size.
struct Rows {
    values: Vec<f64>,
    sizes: Vec<f64>,
}

impl<'a> Standing<'a> {
    /// `model` at time `t` (s), the states of which have been as large as `largest`; of what should be zero `part` of
    /// its size may be left.
    pub fn new(model: &'a dyn Machine, t: f64, largest: &[f64], part: f64) -> Self {
        Self::with_start(model, t, model.start().ok(), largest, part)
    }

    /// The same where the model's own start is known, or that it has none.
    pub fn with_start(model: &'a dyn Machine, t: f64, start: Option<Vec<f64>>, largest: &[f64], part: f64) -> Self {
        let states = model.description().states;
        let size = |index: usize| {
            let known = start.as_ref().map_or(0.0, |start| start[index].abs());
            let floor = match states[index].kind {
                StateKind::Orientation(..) | StateKind::Angle => 1.0,
                _ => 0.0,
            };
            known.max(largest[index].abs()).max(floor)
        };
        let sizes = (0..states.len()).map(size).collect();
        Self { model, t, sizes, start, part }
    }

    /// The state `x` with what rounding has left of gaps, flows and places of stops closed; the same bits where that is
    /// nothing. Where they are known `negative` are the branches of the switches.
    ///
    /// # Errors
    /// [`Misplaced`].
    pub fn closed(&self, x: &[f64], negative: Option<&[bool]>) -> Result<Vec<f64>, Misplaced> {
        let mut x = self.rotated(x)?;
        let negative = negative.map_or_else(|| branches(self.model, self.t, &x), <[bool]>::to_vec);
        if let Some(held) = self.model.held() {
            x = self.fitted(held, x, &negative)?;
        }
        if let Some(stops) = self.model.stops() {
            x = self.cleared(stops, x, &negative)?;
        }
        Ok(x)
    }

    /// The branches `negative` without those that cannot be here: something rests on a stop or sticks in dry friction
    /// only where it is and does not move. Where one cannot be the signs of the guards decide.
    pub fn possible(&self, x: &[f64], mut negative: Vec<bool>) -> Vec<bool> {
        let first = self.model.first_branches();
        let held: Vec<usize> = (0..first.len()).filter(|&k| first[k] && !negative[k]).collect();
        if held.is_empty() {
            return negative;
        }
        // In their first branches the guards of stops are places, those of dry friction flows.
        let rows = self.guards(x, &first);
        let part = self.part.max(CLOSE);
        for &k in &held {
            negative[k] = rows.values[k].is_nan() || rows.values[k].abs() > part * rows.sizes[k];
        }
        if !held.iter().any(|&k| negative[k]) {
            return negative;
        }
        decide_by_sign(&mut negative, &mut vec![0.0; first.len()], |negative, guards| {
            self.model.guards(self.t, x, negative, guards);
        });
        negative
    }

    /// The state `x` with what rounding has left of orientations closed.
    ///
    /// # Errors
    /// [`Misplaced::NoRotation`].
    pub fn rotated(&self, x: &[f64]) -> Result<Vec<f64>, Misplaced> {
        let orientations = orientations(self.model.description().states);
        let turned = if orientations.is_empty() { None } else { self.turned() };
        let kept = |entries| turned.as_ref().map_or_else(Vec::new, |turned| Self::kept(entries, turned));
        let kept: Vec<Vec<Vec<(usize, usize)>>> = orientations.iter().map(kept).collect();
        let worst = |x: &[f64]| {
            let off = orientations.iter().zip(&kept).map(|(entries, kept)| (self.off(entries, kept, x), entries.name));
            off.max_by(|a, b| a.0.total_cmp(&b.0))
        };
        let mut x = x.to_vec();
        for _ in 0..ROUNDS {
            let Some((off, name)) = worst(&x) else { break };
            if off.is_nan() || off > self.part {
                return Err(Misplaced::NoRotation { name: name.to_owned(), off, allowed: self.part });
            }
            if off <= EXACT {
                break;
            }
            let negative = branches(self.model, self.t, &x);
            self.model.project(self.t, &negative, &mut x);
        }
        Ok(x)
    }

    /// A state that has turned from the start, whatever the momenta, with its rates: there no component of an
    /// orientation is 0, nor its rate, but where it stays so.
    fn turned(&self) -> Option<[Vec<f64>; 2]> {
        /// How much the fastest component turns in a step, and how many there are: together a part of a turn, after
        /// which an orientation is still a rotation to far less than [`CLOSE`].
        const STEP: f64 = 0.01;
        const STEPS: usize = 16;
        let mut x = self.start.clone()?;
        let states = self.model.description().states;
        for index in (0..x.len()).filter(|&index| matches!(states[index].kind, StateKind::Momentum(_))) {
            // Of irregular sizes, so that nothing cancels.
            x[index] += (1.0 + self.sizes[index]) * (0.5 + 0.37 * (index % 5) as f64);
        }
        let turning: Vec<usize> =
            (0..x.len()).filter(|&index| matches!(states[index].kind, StateKind::Orientation(..))).collect();
        let negative = branches(self.model, self.t, &x);
        let rates = |x: &[f64]| {
            let mut rates = vec![0.0; x.len()];
            self.model.rate(0.0, x, &negative, &mut rates);
            rates
        };
        let moved = |x: &[f64], rates: &[f64], h: f64| {
            let mut moved = x.to_vec();
            turning.iter().for_each(|&index| moved[index] += h * rates[index]);
            moved
        };
        for _ in 0..STEPS {
            let first = rates(&x);
            let fastest = turning.iter().map(|&index| first[index].abs()).fold(0.0, worse);
            if !(fastest > 0.0 && fastest.is_finite()) {
                break;
            }
            let h = STEP / fastest;
            let second = rates(&moved(&x, &first, 0.5 * h));
            let third = rates(&moved(&x, &second, 0.5 * h));
            let fourth = rates(&moved(&x, &third, h));
            for &index in &turning {
                x[index] += h / 6.0 * (first[index] + 2.0 * (second[index] + third[index]) + fourth[index]);
            }
        }
        let rates = rates(&x);
        Some([x, rates])
    }

    /// The products of an orientation's columns and rows that keep their values in any motion: their rates vanish where
    /// it has turned. Components that are no states are constants, or follow from others.
    fn kept(entries: &Entries, [x, rates]: &[Vec<f64>; 2]) -> Vec<Vec<(usize, usize)>> {
        let is_kept = |product: &Vec<(usize, usize)>| {
            let parts = product.iter().flat_map(|&(a, b)| [x[a] * rates[b], rates[a] * x[b]]);
            let (sum, size) = parts.fold((0.0, 0.0), |(sum, size), part: f64| (sum + part, size + part.abs()));
            f64::abs(sum) <= CLOSE * size
        };
        entries.products().into_iter().filter(is_kept).collect()
    }

    /// By how much an orientation is none: products that should be as at the start, or its determinant.
    fn off(&self, entries: &Entries, kept: &[Vec<(usize, usize)>], x: &[f64]) -> f64 {
        let value = |product: &[(usize, usize)], x: &[f64]| product.iter().map(|&(a, b)| x[a] * x[b]).sum::<f64>();
        let products =
            self.start.iter().flat_map(|start| kept.iter().map(move |kept| value(kept, x) - value(kept, start)));
        let determinant = entries.determinant(x).map(|determinant| determinant - 1.0);
        products.chain(determinant).map(f64::abs).fold(0.0, worse)
    }

    /// Checks what rigid joints hold, and closes it.
    fn fitted(&self, held: Held, mut x: Vec<f64>, negative: &[bool]) -> Result<Vec<f64>, Misplaced> {
        let rigid = held.rigid;
        if rigid.is_empty() {
            return Ok(x);
        }
        let of = |x: &[f64]| self.motions(&held, (self.t, x), negative);
        let Rows { mut values, sizes } = self.rows(&x, of);
        let start = self.start.as_deref();
        let at_start = start.map(|x| self.motions(&held, (0.0, x), &branches(self.model, 0.0, x)));
        let limits = Limits::new(rigid, &sizes, at_start.as_deref(), self.part);
        for _ in 0..ROUNDS {
            if limits.excess(&values) <= 1.0 {
                break;
            }
            let mut closer = x.clone();
            self.model.project(self.t, negative, &mut closer);
            let after = of(&closer);
            limits.check(&values, &after)?;
            if limits.excess(&after) >= limits.excess(&values) || after.iter().any(|value| value.is_nan()) {
                break;
            }
            (x, values) = (closer, after);
        }
        Ok(x)
    }

    /// Checks stops, and moves what is a little beyond one onto it.
    fn cleared(&self, stops: Stops, mut x: Vec<f64>, negative: &[bool]) -> Result<Vec<f64>, Misplaced> {
        let first = self.model.first_branches();
        let mut collision = Collision::<f64>::new(stops, self.model.kept_of_stops());
        let stops = stops.stops;
        for _ in 0..ROUNDS {
            let rows = self.guards(&x, &first);
            let start = self.start.as_ref().map(|start| self.guards(start, &first).values);
            let passed = |switch: usize| rows.values[switch];
            for stop in stops {
                let (by, size) = (passed(stop.switch), rows.sizes[stop.switch]);
                let left = start.as_ref().map_or(0.0, |start| 2.0 * start[stop.switch].max(0.0));
                let allowed = self.part * size + left;
                if by.is_nan() || by > allowed {
                    return Err(Misplaced::Beyond { stop: stop.name, by, allowed, unit: integrated(stop.unit) });
                }
            }
            let is_beyond = |switch: usize| passed(switch) > EXACT * rows.sizes[switch];
            if !stops.iter().any(|stop| is_beyond(stop.switch)) {
                return Ok(x);
            }
            // So that it touches the stop, and rounding does not lift it off.
            let touches = |switch: usize| TOUCHES * rows.sizes[switch];
            let by = |switch: usize| if is_beyond(switch) { passed(switch) - touches(switch) } else { 0.0 };
            let struck = collision.displaced(&impacts_of(self.model), (self.t, &x), negative, by);
            let mut rates = [(); 2].map(|()| vec![0.0; x.len()]);
            self.model.rate(self.t, &x, negative, &mut rates[0]);
            self.model.rate(self.t, &struck, negative, &mut rates[1]);
            let states = self.model.description().states;
            for index in (0..x.len()).filter(|&index| is_of_pose(&states[index])) {
                x[index] += rates[1][index] - rates[0][index];
            }
            self.model.project(self.t, negative, &mut x);
        }
        Ok(x)
    }

    /// The guards in some branches; to those of stops, which are places in their first branches, belongs the size of
    /// the machine.
    fn guards(&self, x: &[f64], negative: &[bool]) -> Rows {
        let mut rows = self.rows(x, |x| self.guards_at(x, negative));
        let stops = self.model.stops().map_or(&[][..], |stops| stops.stops);
        let own = rows.sizes.clone();
        for stop in stops {
            let alike = stops.iter().filter(|other| other.unit == stop.unit).map(|other| own[other.switch]);
            rows.sizes[stop.switch] = alike.fold(self.extent(&integrated(stop.unit)), f64::max);
        }
        rows
    }

    /// The largest of the states that say where something is in this unit; of angles 1 rad at least.
    fn extent(&self, unit: &str) -> f64 {
        let states = self.model.description().states.iter().zip(&self.sizes);
        let alike = states.filter(|(state, _)| is_of_pose(state) && state.unit == unit).map(|(_, &size)| size);
        alike.fold(if unit == "rad" { 1.0 } else { 0.0 }, f64::max)
    }

    fn guards_at(&self, x: &[f64], negative: &[bool]) -> Vec<f64> {
        let mut guards = vec![0.0; negative.len()];
        self.model.guards(self.t, x, negative, &mut guards);
        guards
    }

    /// Numbers at a state with their sizes: how much all states together, as large as they have been, add to each, and
    /// what is left of it without them.
    fn rows(&self, x: &[f64], of: impl Fn(&[f64]) -> Vec<f64>) -> Rows {
        let values = of(x);
        let mut sizes = vec![0.0; values.len()];
        let mut rest = values.clone();
        for index in (0..x.len()).filter(|&index| self.sizes[index] > 0.0) {
            let mut aside = x.to_vec();
            aside[index] += ASIDE * self.sizes[index];
            let moved = aside[index] - x[index];
            for (row, value) in of(&aside).into_iter().enumerate() {
                let slope = (value - values[row]) / moved;
                if slope.is_finite() {
                    sizes[row] += slope.abs() * self.sizes[index];
                    rest[row] -= slope * x[index];
                }
            }
        }
        sizes.iter_mut().zip(&rest).filter(|(_, rest)| rest.is_finite()).for_each(|(size, rest)| *size += rest.abs());
        Rows { values, sizes }
    }

    /// The flows of the rigid motions at a time (s) and state, then their gaps.
    fn motions(&self, held: &Held, (t, x): (f64, &[f64]), negative: &[bool]) -> Vec<f64> {
        let mut entries = vec![0.0; held.entries()];
        self.model.hold(t, x, negative, &mut entries);
        let now = held.read(&entries);
        now.flows[..now.gaps.len()].iter().chain(now.gaps).copied().collect()
    }
}

/// What may be left of flows and gaps of rigid motions.
struct Limits {
    rigid: &'static [Slip],
    /// The size of the machine in the unit of each.
    sizes: Vec<f64>,
    allowed: Vec<f64>,
}

impl Limits {
    fn new(rigid: &'static [Slip], sizes: &[f64], at_start: Option<&[f64]>, part: f64) -> Self {
        let count = rigid.len();
        // Motions of one unit are as large as the largest of them: the machine.
        let largest = |row: usize| {
            let (unit, first) = (rigid[row % count].unit, row / count * count);
            let alike = (first..first + count).filter(|&other| rigid[other % count].unit == unit);
            alike.fold(0.0_f64, |size, other| size.max(sizes[other]))
        };
        let sizes: Vec<f64> = (0..2 * count).map(largest).collect();
        // What the assembly of the start accepts and leaves.
        let of_start = |row: usize| at_start.map_or(0.0, |start| 2.0 * start[row].abs());
        let allowed = sizes.iter().enumerate().map(|(row, size)| part * size + of_start(row)).collect();
        Self { rigid, sizes, allowed }
    }

    /// The largest of these values over what a run leaves of it; above 1 where a projection has something to close.
    fn excess(&self, values: &[f64]) -> f64 {
        let parts = values.iter().zip(&self.sizes).filter(|(value, _)| **value != 0.0);
        let parts = parts.map(|(value, size)| value.abs() / (EXACT * size).max(f64::MIN_POSITIVE));
        parts.fold(0.0, worse)
    }

    /// Refuses values that are more than is allowed; `after` are those that a projection leaves of them.
    fn check(&self, values: &[f64], after: &[f64]) -> Result<(), Misplaced> {
        let count = self.rigid.len();
        for (row, (&value, &allowed)) in values.iter().zip(&self.allowed).enumerate() {
            let is_drawn = after[row].abs() > 0.5 * value.abs();
            let allowed = if is_drawn { allowed.max(DRAWN * self.sizes[row]) } else { allowed };
            if value.abs() <= allowed {
                continue;
            }
            let slip = self.rigid[row % count];
            return Err(if row < count {
                Misplaced::Torn { slipping: Slipping { slip, speed: value, is_rigid: true }, allowed }
            } else {
                Misplaced::Open { slip, size: value, allowed, unit: integrated(slip.unit) }
            });
        }
        Ok(())
    }
}

/// Whether a state says where something is.
fn is_of_pose(state: &StateInfo) -> bool {
    use StateKind as K;
    matches!(state.kind, K::Position(_) | K::Orientation(..) | K::Angle | K::Displacement(_))
}

/// An orientation among the states: the index of each of its components that is one.
struct Entries {
    name: &'static str,
    of: [[Option<usize>; 3]; 3],
}

/// The orientations among the states. Components of one orientation have one name before their place.
fn orientations(states: &'static [StateInfo]) -> Vec<Entries> {
    let mut found: Vec<Entries> = Vec::new();
    for (index, state) in states.iter().enumerate() {
        let StateKind::Orientation(row, column) = state.kind else { continue };
        let name = state.name.rsplit_once('_').map_or(state.name, |(name, _)| name);
        let place = found.iter().position(|entries| entries.name == name).unwrap_or_else(|| {
            found.push(Entries { name, of: [[None; 3]; 3] });
            found.len() - 1
        });
        found[place].of[row][column] = Some(index);
    }
    found
}

impl Entries {
    /// The products of two of its columns, or of two of its rows, as far as their components are states: pairs of
    /// states.
    fn products(&self) -> Vec<Vec<(usize, usize)>> {
        let rows = self.of;
        let columns = core::array::from_fn(|column| rows.map(|row| row[column]));
        let pairs = [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)];
        let product = |lines: &[[Option<usize>; 3]; 3], (a, b): (usize, usize)| {
            let pairs = lines[a].iter().zip(&lines[b]);
            pairs.filter_map(|(&left, &right)| Some((left?, right?))).collect::<Vec<_>>()
        };
        let all = [rows, columns].into_iter().flat_map(|lines| pairs.map(|pair| product(&lines, pair)));
        all.filter(|product| !product.is_empty()).collect()
    }

    /// Its determinant, where all components are states.
    fn determinant(&self, x: &[f64]) -> Option<f64> {
        let mut at = [[0.0; 3]; 3];
        for (row, column) in (0..9).map(|place| (place / 3, place % 3)) {
            at[row][column] = x[self.of[row][column]?];
        }
        let minor = |c: usize, d: usize| at[1][c] * at[2][d] - at[1][d] * at[2][c];
        Some(at[0][0] * minor(1, 2) - at[0][1] * minor(0, 2) + at[0][2] * minor(0, 1))
    }
}
