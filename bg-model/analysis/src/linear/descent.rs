//! A plant near a state, and the steps from there towards an equilibrium.
//!
//! In: a plant, a state. Out: the steps of Newton's method and of the pseudo-transient, the states after them.
//! Method: Newton's step is -J^+ f, in balanced coordinates, of least length where J is singular; that of the
//! pseudo-transient (I / h - J)^-1 f, an implicit Euler step from rest. Each step goes along the kinematics (see
//! `carry`).

use std::cell::OnceCell;

use bg_model::nalgebra::{DMatrix, DVector};

use super::coordinates::Role;
use super::eigen::Balanced;
use super::error::LinearError;
use super::manifold::Manifold;
use super::plant::Plant;
use super::state_space::checked;

/// Singular values below this part of the largest one are free directions.
const FREE: f64 = 1e-11;
/// A rate that depends on a coordinate by less than this part of the largest derivative does not depend on it.
const IDLE: f64 = 1e-8;

/// The part of the way to where Newton's step leads that counts as the machine's extent where its positions are nearer
/// to zero: one that starts at its origin has no other length.
const AHEAD: f64 = 0.1;

/// A plant near a state.
pub(super) struct Local {
    /// Its coordinates.
    pub manifold: Manifold,
    /// The states' rates.
    pub rates: DVector<f64>,
    /// Of each state's rate, how large the terms are that it is a sum of.
    pub terms: DVector<f64>,
    /// Balanced coordinates times these are the coordinates.
    scales: DVector<f64>,
    jacobian: DMatrix<f64>,
    /// Projects the rates on those that have to vanish: all, or all but those that may go on.
    wanted: Option<DMatrix<f64>>,
    /// The largest position, m.
    position: f64,
    /// See [`Local::inverse`].
    inverse: OnceCell<DMatrix<f64>>,
    /// See [`Local::extent`].
    extent: OnceCell<f64>,
}

/// How a state behaves that is left alone.
pub(super) struct Stability {
    /// The fastest growth, 1/s; 0 where nothing grows.
    pub growth: f64,
    /// The fastest motion, rad/s.
    pub fastest: f64,
}

impl Local {
    /// The plant near the state `x` with momenta that leave all else as it is: none, of a mechanism at rest. Gives that
    /// state, too. In the search for a steady motion idle coordinates may go on changing.
    pub fn settled(plant: &Plant, t: f64, x: &DVector<f64>, steady: bool) -> Result<(Self, DVector<f64>), LinearError> {
        let moving = Self::at(plant, t, x, steady)?;
        let is_momentum = |k: &usize| moving.manifold.coordinates[*k].role == Role::Momentum;
        let (p, q): (Vec<usize>, Vec<usize>) = (0..moving.scales.len()).partition(is_momentum);
        let kinematics = moving.wanted_jacobian().select_rows(&q).select_columns(&p);
        let rates = moving.balanced(&moving.rates).select_rows(&q);
        if rates.iter().all(|&rate| rate == 0.0) {
            return Ok((moving, x.clone()));
        }
        let correction = -(pseudo_inverse(kinematics) * rates);
        let mut step = DVector::zeros(moving.scales.len());
        p.iter().zip(&correction).for_each(|(&k, &correction)| step[k] = correction);
        let x = moving.moved(plant, x, &step);
        Ok((Self::at(plant, t, &x, steady)?, x))
    }

    /// The plant near state `x`.
    pub fn at(plant: &Plant, t: f64, x: &DVector<f64>, steady: bool) -> Result<Self, LinearError> {
        let (here, inputs) = checked(plant, t, x)?;
        let manifold = Manifold::at(plant, x, &here, &inputs);
        let Balanced { matrix: jacobian, scales } =
            Balanced::of(&(&manifold.chart * &here.rates_by_state * &manifold.tangent));
        let wanted = if steady { without_idle(&manifold, &jacobian) } else { None };
        let terms = here.rates_by_state.abs() * manifold.sizes(x);
        let position = manifold.largest_position(x);
        let (rates, inverse, extent) = (here.rates, OnceCell::new(), OnceCell::new());
        Ok(Self { manifold, rates, terms, scales, jacobian, wanted, position, inverse, extent })
    }

    /// The pseudo-inverse of the derivatives of the rates that have to vanish.
    fn inverse(&self) -> &DMatrix<f64> {
        self.inverse.get_or_init(|| pseudo_inverse(self.wanted_jacobian()))
    }

    /// The derivatives of the rates that have to vanish.
    fn wanted_jacobian(&self) -> DMatrix<f64> {
        self.wanted.as_ref().map_or(self.jacobian.clone(), |wanted| wanted * &self.jacobian)
    }

    /// Whether there are coordinates that may go on changing.
    pub fn has_idle(&self) -> bool {
        self.wanted.is_some()
    }

    /// # Errors
    /// No eigenvalues were found.
    pub fn stability(&self) -> Result<Stability, LinearError> {
        let balanced = Balanced { matrix: self.jacobian.clone(), scales: self.scales.clone() };
        let values = balanced.eigenvalues().ok_or(LinearError::NoEigenvalues)?;
        let fastest = values.last().map_or(0.0, |value| value.norm());
        let growth = values.iter().fold(0.0_f64, |growth, value| growth.max(value.re));
        Ok(Stability { growth: if growth > 1e-9 * fastest { growth } else { 0.0 }, fastest })
    }

    /// What of these rates of the states has to vanish, in balanced coordinates.
    pub fn balanced(&self, rates: &DVector<f64>) -> DVector<f64> {
        let rates = (&self.manifold.chart * rates).component_div(&self.scales);
        self.wanted.as_ref().map_or(rates.clone(), |wanted| wanted * rates)
    }

    /// Rates of the coordinates that have to vanish.
    pub fn left(&self) -> DVector<f64> {
        self.balanced(&self.rates).component_mul(&self.scales)
    }

    /// Whether Newton's step makes the rates vanish to first order: not where a force acts along a free direction.
    pub fn reaches(&self) -> bool {
        let (rates, step) = (self.balanced(&self.rates), self.correction(&self.rates));
        let jacobian = self.wanted_jacobian();
        let left = &rates + &jacobian * &step;
        let terms = rates.abs() + jacobian.abs() * step.map(|part| part.abs() + 1e-6 * step.amax());
        left.iter().zip(&terms).all(|(left, terms)| left.abs() <= 1e-6 * terms)
    }

    /// Newton's step from here for rates of the states elsewhere.
    pub fn correction(&self, rates: &DVector<f64>) -> DVector<f64> {
        -(self.inverse() * self.balanced(rates))
    }

    /// The direction of Newton's method, or with `h` (s) that of the pseudo-transient; none where that is singular.
    pub fn direction(&self, h: Option<f64>) -> Option<DVector<f64>> {
        let Some(h) = h else { return Some(self.correction(&self.rates)) };
        let size = self.scales.len();
        (DMatrix::identity(size, size) / h - self.wanted_jacobian()).lu().solve(&self.balanced(&self.rates))
    }

    /// The extent of the machine, m: its largest position, or a part of the way ahead. Of 1 m at least: the steps of a
    /// smaller one are judged by the rates they leave alone, which need no length.
    fn extent(&self) -> f64 {
        *self.extent.get_or_init(|| {
            let ahead = self.correction(&self.rates).component_mul(&self.scales);
            self.position.max(AHEAD * self.manifold.way(&ahead)).max(1.0)
        })
    }

    /// How far a step in balanced coordinates moves the poses: rad, or part of the machine's extent.
    pub fn length(&self, step: &DVector<f64>) -> f64 {
        self.manifold.length(&step.component_mul(&self.scales), self.extent())
    }

    /// The state after a straight step in balanced coordinates.
    pub fn moved(&self, plant: &Plant, x: &DVector<f64>, step: &DVector<f64>) -> DVector<f64> {
        plant.carried(x, &self.manifold.carry(&step.component_mul(&self.scales), self.extent()))
    }
}

/// The pseudo-inverse.
fn pseudo_inverse(matrix: DMatrix<f64>) -> DMatrix<f64> {
    let (rows, columns) = matrix.shape();
    if matrix.is_empty() {
        return DMatrix::zeros(columns, rows);
    }
    let svd = matrix.svd(true, true);
    let smallest = FREE * svd.singular_values.max();
    svd.pseudo_inverse(smallest).unwrap_or_else(|_| DMatrix::zeros(columns, rows))
}

/// The projection of balanced rates that leaves out the directions, of all but momenta, on which no rate depends; none
/// where there is no such direction.
fn without_idle(manifold: &Manifold, jacobian: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let size = jacobian.nrows();
    let others: Vec<usize> = (0..size).filter(|&k| manifold.coordinates[k].role != Role::Momentum).collect();
    if others.is_empty() {
        return None;
    }
    let columns = jacobian.select_columns(&others);
    let svd = columns.svd(false, true);
    let v_t = svd.v_t.as_ref()?;
    let smallest = IDLE * jacobian.amax();
    let idle: Vec<usize> = (0..svd.singular_values.len()).filter(|&k| svd.singular_values[k] <= smallest).collect();
    let mut wanted = DMatrix::identity(size, size);
    for &k in &idle {
        let mut direction = DVector::zeros(size);
        others.iter().enumerate().for_each(|(column, &row)| direction[row] = v_t[(k, column)]);
        wanted -= &direction * direction.transpose();
    }
    (!idle.is_empty()).then_some(wanted)
}
