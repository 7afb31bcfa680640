//! The equilibrium near a state.
//!
//! In: a mechanism, a time at which its inputs are held, a first guess. Out: the state at which the rates of all states
//! vanish, but of integrals that only outputs ask for: a mechanism at rest with loaded springs, a circuit with steady
//! currents. Where there is none, a steady motion: what may go on changing then are coordinates on which no rate
//! depends, such as the angle of a flywheel. Damping and what rigid joints hold are those of the model; free directions
//! stay where they are.
//! Method: Newton's method with exact derivatives, damped by following its flow (see `descent`). A step is accepted by
//! the natural level function (Deuflhard, Newton Methods for Nonlinear Problems, 2004, section 3.3). Where the state is
//! unstable, or a force acts along a free direction, pseudo-transient continuation with steps too short to be drawn to
//! an unstable equilibrium (Kelley and Keyes, SIAM Journal on Numerical Analysis 35, 1998).

use bg_model::mechanism::Differentiable;
use bg_model::nalgebra::DVector;

use super::coordinates::{Coordinate, Role};
use super::descent::{Local, Stability};
use super::error::LinearError;
use super::manifold::Drift;
use super::plant::Plant;
use super::text::{counted, short};

/// How many steps are made before the search ends.
const ITERATIONS: usize = 600;
/// Steps along a free direction on which a force acts: a search that makes so many follows a motion without an end.
const WITHOUT_REACH: usize = 150;
/// How far a pose may change in a step of the pseudo-transient: rad, or part of the mechanism's extent.
const LONGEST: f64 = 0.1;
/// Newton's steps are tried where they are shorter than this.
const NEAR: f64 = 0.02;

/// An equilibrium.
#[derive(Clone, Debug, PartialEq, serde::Serialize)]
pub struct Equilibrium {
    /// Time at which the inputs are held, s.
    pub t: f64,
    /// All states; integrals that only outputs ask for as they were guessed.
    pub x: Vec<f64>,
    /// The coordinates that go on changing, with their rates per s: none at rest.
    pub turning: Vec<(String, f64)>,
    /// The number of steps that it took.
    pub steps: usize,
}

impl Equilibrium {
    /// How it was found, and what goes on: `equilibrium after 12 steps, with inputs as at t = 0.0 s`.
    #[must_use]
    pub fn sentence(&self) -> String {
        let Self { t, turning, steps, .. } = self;
        let word = if turning.is_empty() { "equilibrium" } else { "steady motion" };
        let mut text = format!("{word} after {}, with inputs as at t = {t:?} s", counted(*steps, "step"));
        for (name, rate) in turning {
            text.push_str(&format!("; `{name}` goes on by {} per s", short(*rate)));
        }
        text
    }
}

/// The equilibrium of `mechanism` near the state `guess`, with its inputs held as they are at time `t` (s).
///
/// # Errors
/// [`LinearError::NoEquilibrium`] names what still changes; [`LinearError::NotFinite`] and [`LinearError::BadRate`] a
/// rate that has no derivative or no value on the way.
pub fn equilibrium(mechanism: &dyn Differentiable, t: f64, guess: &[f64]) -> Result<Equilibrium, LinearError> {
    found(&Plant::at(mechanism, t, None)?, t, &DVector::from_column_slice(guess))
}

fn found(plant: &Plant, t: f64, guess: &DVector<f64>) -> Result<Equilibrium, LinearError> {
    let rest = search(plant, t, guess, false);
    match rest {
        Err(LinearError::NoEquilibrium { .. }) => search(plant, t, guess, true).or(rest),
        _ => rest,
    }
}

/// The search from `guess`: for rest, or for a steady motion.
fn search(plant: &Plant, t: f64, guess: &DVector<f64>, steady: bool) -> Result<Equilibrium, LinearError> {
    let mut x = guess.clone();
    let mut seen = Seen::default();
    let mut strides = StrideController::default();
    let mut without_reach = 0;
    for steps in 0..ITERATIONS {
        let (local, settled) = Local::settled(plant, t, &x, steady)?;
        x = settled;
        let drift = local.manifold.drifts.iter().find(|drift| drift.matters || !steady);
        if let Some(Drift { coordinate, rate, .. }) = drift {
            return Err(no_equilibrium(coordinate, *rate));
        }
        if steady && !local.has_idle() && local.manifold.drifts.is_empty() {
            return Err(seen.failure(&local));
        }
        seen.look(&local);
        if seen.is_small(&local) {
            let (x, local) = polished(plant, t, x, local, steady)?;
            return Ok(Equilibrium { t, turning: turning(&local, steady), x: x.as_slice().to_vec(), steps });
        }
        let stability = local.stability()?;
        let reaches = local.reaches();
        without_reach += usize::from(!reaches);
        let newton = if stability.growth == 0.0 && reaches { newton(plant, &local, &x) } else { None };
        let h = strides.next(&local, &stability);
        let transient = || {
            let steps = (0..60).map(|k| h * 0.5_f64.powi(k)).filter_map(|h| Some((h, local.direction(Some(h))?)));
            let (h, step) = { steps }.find(|(_, step)| local.length(step) <= LONGEST)?;
            strides.made(h);
            let next = local.moved(plant, &x, &step);
            next.iter().all(|value| value.is_finite()).then_some(next)
        };
        match newton.or_else(transient).filter(|_| without_reach < WITHOUT_REACH) {
            Some(next) => x = next,
            None => return Err(seen.failure(&local)),
        }
    }
    Err(seen.failure(&Local::at(plant, t, &x, steady)?))
}

/// The lengths of the pseudo-transient's steps, s. A stride moves soft directions and stretches stiff joints by the
/// curve of their ways; short steps let these come to rest before the next one.
#[derive(Default)]
struct StrideController {
    stride: f64,
    rest: f64,
    /// The rates at the last stride.
    level: f64,
}

impl StrideController {
    fn next(&mut self, local: &Local, stability: &Stability) -> f64 {
        let shortest = 5.0 / stability.fastest.max(f64::MIN_POSITIVE);
        let rates = local.balanced(&local.rates).norm();
        let is_stretched = self.stride > 0.0 && rates > 2.0 * self.level && self.rest < self.stride;
        let h = if is_stretched {
            self.rest = if self.rest > 0.0 { 4.0 * self.rest } else { shortest };
            self.rest
        } else {
            (self.rest, self.level) = (0.0, rates);
            self.stride = if self.stride > 0.0 { 4.0 * self.stride } else { shortest };
            self.stride
        };
        if stability.growth > 0.0 { h.min(0.25 / stability.growth) } else { h }
    }

    /// Takes note of the length that was made, at most that of [`StrideController::next`].
    fn made(&mut self, h: f64) {
        if self.rest == 0.0 {
            self.stride = h;
        }
    }
}

/// The state after Newton's step, where that is short and brings the equilibrium nearer: the simplified correction
/// after it is smaller than the step, in the measure of poses or of all balanced coordinates.
fn newton(plant: &Plant, local: &Local, x: &DVector<f64>) -> Option<DVector<f64>> {
    let step = local.direction(None)?;
    let length = local.length(&step);
    if length > NEAR {
        return None;
    }
    let next = local.moved(plant, x, &step);
    let after = local.correction(&plant.derivatives(&next).rates);
    let is_nearer = local.length(&after) < 0.75 * length || after.norm() < 0.75 * step.norm();
    is_nearer.then_some(next)
}

/// The same equilibrium to rounding: Newton steps while each halves the rates.
fn polished(
    plant: &Plant,
    t: f64,
    mut x: DVector<f64>,
    mut local: Local,
    steady: bool,
) -> Result<(DVector<f64>, Local), LinearError> {
    for _ in 0..5 {
        let Some(step) = local.direction(None) else { break };
        let next = local.moved(plant, &x, &step);
        let left = |rates: &DVector<f64>| local.balanced(rates).norm();
        // A rate that is not a number is no improvement either.
        let is_better = left(&plant.derivatives(&next).rates) < 0.5 * left(&local.rates);
        if !is_better {
            break;
        }
        local = Local::at(plant, t, &next, steady)?;
        x = next;
    }
    Ok((x, local))
}

/// The largest rates of the search, by the unit of the state.
#[derive(Default)]
struct Seen {
    by_unit: Vec<(&'static str, f64)>,
}

impl Seen {
    fn look(&mut self, local: &Local) {
        for (coordinate, rate) in local.manifold.coordinates.iter().zip(&local.left()) {
            match self.by_unit.iter_mut().find(|(unit, _)| *unit == coordinate.unit) {
                Some((_, largest)) => *largest = largest.max(rate.abs()),
                None => self.by_unit.push((coordinate.unit, rate.abs())),
            }
        }
    }

    /// What counts as zero of each coordinate's rate: 1e-9 of the largest of its unit, or the rounding of its terms.
    fn zeros(&self, local: &Local) -> DVector<f64> {
        let rounding = local.manifold.chart.abs() * &local.terms;
        let largest = |unit| self.by_unit.iter().find(|(other, _)| *other == unit).map_or(0.0, |(_, largest)| *largest);
        let units = local.manifold.coordinates.iter().map(|coordinate| largest(coordinate.unit));
        DVector::from_iterator(rounding.len(), units.zip(&rounding).map(|(seen, terms)| 1e-9 * seen + 1e-12 * terms))
    }

    fn is_small(&self, local: &Local) -> bool {
        local.left().iter().zip(&self.zeros(local)).all(|(rate, zero)| rate.abs() <= *zero)
    }

    /// What still changes most.
    fn failure(&self, local: &Local) -> LinearError {
        let zeros = self.zeros(local);
        let left = local.left();
        let excess = |k: &usize| left[*k].abs() / zeros[*k].max(f64::MIN_POSITIVE);
        let worst = (0..left.len()).max_by(|a, b| excess(a).total_cmp(&excess(b)));
        let Some(worst) = worst else { unreachable!("a model whose rates do not vanish has states") };
        no_equilibrium(&local.manifold.coordinates[worst], left[worst])
    }
}

fn no_equilibrium(coordinate: &Coordinate, rate: f64) -> LinearError {
    let action = match coordinate.role {
        Role::Momentum => "hold it by a joint, a spring or an opposite force, or start from another pose",
        _ => "a source keeps changing it: take another value of the source or input, or linearise at a time instead",
    };
    let unit = match coordinate.unit {
        "kg*m/s" => "N".to_owned(),
        "kg*m^2/s" => "N*m".to_owned(),
        unit => format!("{unit}/s"),
    };
    LinearError::NoEquilibrium { what: coordinate.name.clone(), rate, unit, action }
}

/// The coordinates whose rates do not vanish: none but in a steady motion.
fn turning(local: &Local, steady: bool) -> Vec<(String, f64)> {
    let rates = &local.manifold.chart * &local.rates;
    let coordinates = local.manifold.coordinates.iter().zip(&rates);
    let largest = coordinates.clone().fold(0.0_f64, |largest, (_, rate)| largest.max(rate.abs()));
    let moving = coordinates.filter(|(_, rate)| steady && rate.abs() > 1e-9 * largest);
    let moving = moving.map(|(coordinate, rate)| (coordinate.name.clone(), *rate));
    moving.chain(local.manifold.drifts.iter().map(|drift| (drift.coordinate.name.clone(), drift.rate))).collect()
}
