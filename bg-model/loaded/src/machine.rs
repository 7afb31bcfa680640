//! An interpreted model as a run asks for it.
//!
//! In: an [`Interpreted`] model. Out: [`Dynamics`], [`Machine`] and [`Starting`] for it, in any scalar; what studies
//! make of it anew.

use std::cell::RefCell;
use std::ops::Range;
use std::rc::Rc;

use bg_model::assembly::AssemblyError;
use bg_model::capability::{Operations, SeriesSize};
use bg_model::clock::{self, Clock};
use bg_model::delay::{self, Delay};
use bg_model::description::{Description, StateInfo};
use bg_model::drawing;
use bg_model::dynamics::{Dynamics, Machine, Rates, Swept};
use bg_model::failure::Origin;
use bg_model::holding::{Held, Redundancy, Stops};
use bg_model::input::{Input, next_break};
use bg_model::linear::table::{eliminate, substitute};
use bg_model::linear::{Field, Sparsity};
use bg_model::mechanism::{Differentiable, Joinable, Liftable, Reversible, SideBySide};
use bg_model::nalgebra::Complex;
use bg_model::parameters::ParameterError;
use bg_model::scalar::{Gradient, GradientIn, Scalar, Slopes};
use bg_model::start::{StartRoutine, StartTable, Starting, redundant, start};
use bg_model::system::Powers;

use crate::code::{Code, Row};
use crate::interpreted::{Interpreted, Moment, of_parameters};
use crate::series::Expansion;

impl<S: Scalar> Interpreted<S> {
    /// The clocks, those of delays among them.
    fn all_clocks(&self) -> Vec<Clock<S>> {
        let Some(program) = &self.programs().clocks else { return Vec::new() };
        clock::listed(&self.blueprint.clocks, &|times| {
            of_parameters(program, &self.values, &[], Some(&self.decided), times);
        })
    }

    /// Projects the states of the pose.
    pub(crate) fn pose(&self, t: S, negative: &[S::Switch], x: &mut [S]) {
        self.moved((&self.blueprint.projected, &self.programs().project, &self.rows.project), t, negative, x);
    }

    /// Gives the states of a list what a program says.
    fn moved(
        &self,
        (moved, code, row): (&[usize], &Code, &RefCell<Row<S>>),
        t: S,
        negative: &[S::Switch],
        x: &mut [S],
    ) {
        if !moved.is_empty() {
            let projected = self.listed(code, row, Moment::at(t, x, negative));
            moved.iter().zip(projected).for_each(|(&state, value)| x[state] = value);
        }
    }

    /// Solves for `b` with the factors of an elimination.
    fn substituted<T: Scalar, F: Field<T>>(&self, factors: &[F], b: &mut [F]) {
        let of = &self.blueprint.elimination;
        let mut whole = b.to_vec();
        whole.resize(of.rows, F::real(T::from_f64(0.0)));
        substitute::<T, F>(&of.steps, factors, &mut whole);
        b.copy_from_slice(&whole[..b.len()]);
    }
}

impl<S: Scalar> Dynamics<S> for Interpreted<S> {
    fn states(&self) -> usize {
        self.description().states.len()
    }

    fn switches(&self) -> usize {
        self.description().switches.len()
    }

    fn rate(&self, t: S, x: &[S], negative: &[S::Switch], dx: &mut [S]) {
        self.evaluate_at((&self.programs().rate, &self.rows.rate), t, x, negative, dx);
    }

    fn guards(&self, t: S, x: &[S], negative: &[S::Switch], guards: &mut [S]) {
        self.evaluate_at((&self.programs().guards, &self.rows.guards), t, x, negative, guards);
    }

    fn memories(&self) -> Vec<usize> {
        self.blueprint.memories.clone()
    }

    fn clocks(&self) -> Vec<Clock<S>> {
        delay::without(self.all_clocks(), self.blueprint.delays)
    }

    fn delays(&self) -> Vec<Delay<S>> {
        delay::listed(&self.all_clocks(), self.blueprint.delays)
    }

    fn first_branches(&self) -> Vec<bool> {
        self.blueprint.first_branches.clone()
    }

    fn project(&self, t: S, negative: &[S::Switch], x: &mut [S]) {
        self.pose(t, negative, x);
        self.moved((&self.blueprint.settled, &self.programs().settle, &self.rows.settle), t, negative, x);
    }

    fn next_break(&self, t: f64) -> f64 {
        next_break(&self.inputs, t)
    }

    fn state_name(&self, index: usize) -> &'static str {
        self.description().states.get(index).map_or("state", |state| state.name)
    }

    fn switch_name(&self, index: usize) -> Option<&'static str> {
        self.description().switches.get(index).map(|switch| switch.name)
    }

    fn not_finite(&self, t: S, x: &[S], negative: &[S::Switch]) -> Option<Origin> {
        let laws = self.alone_listed(&self.programs().not_finite, &self.rows.not_finite, Moment::at(t, x, negative));
        let laws = self.blueprint.statics.fallible.iter().zip(laws).map(|(&[kind, name], value)| (kind, name, value));
        let inputs = self.description().inputs.iter().zip(&self.inputs);
        let inputs = inputs.map(|(info, input)| ("input", info.name, input.value(t)));
        Origin::first(&inputs.chain(laws).collect::<Vec<_>>())
    }

    fn turning(&self) -> &'static [&'static str] {
        self.blueprint.statics.turning
    }

    fn pivots(&self, t: S, x: &[S], negative: &[S::Switch], pivots: &mut [S]) {
        if let Some(of) = &self.programs().pivots {
            self.alone(of, &self.rows.pivots, Moment::at(t, x, negative), pivots);
        }
    }

    fn sparsity(&self) -> Sparsity {
        self.blueprint.statics.sparsity
    }

    fn jacobian(&self, t: S, x: &[S], negative: &[S::Switch], entries: &mut [S], slope: &mut [S]) {
        let of = &self.programs().derivatives.jacobian;
        let results = self.alone_listed(of, &self.rows.jacobian, Moment::at(t, x, negative));
        let (of_states, of_time) = results.split_at(results.len() - slope.len());
        entries.copy_from_slice(of_states);
        slope.copy_from_slice(of_time);
    }

    fn damping_sparsity(&self) -> Sparsity {
        self.programs().derivatives.damping.as_ref().map_or_else(|| self.sparsity(), |(sparsity, _)| *sparsity)
    }

    fn damping(&self, t: S, x: &[S], negative: &[S::Switch], entries: &mut [S]) {
        match &self.programs().derivatives.damping {
            Some((_, of)) => self.alone(of, &self.rows.damping, Moment::at(t, x, negative), entries),
            None => self.jacobian(t, x, negative, entries, &mut x.to_vec()),
        }
    }

    fn factors(&self) -> Option<usize> {
        Some(self.blueprint.elimination.slots.len())
    }

    fn eliminate(&self, c: S, entries: &[S], factors: &mut [S]) -> bool {
        let of = &self.blueprint.elimination;
        eliminate(&of.slots, &of.products, c, entries, factors)
    }

    fn eliminate_complex(&self, c: Complex<f64>, entries: &[f64], factors: &mut [Complex<f64>]) -> bool {
        let of = &self.blueprint.elimination;
        eliminate(&of.slots, &of.products, c, entries, factors)
    }

    fn substitute(&self, factors: &[S], b: &mut [S]) {
        self.substituted::<S, S>(factors, b);
    }

    fn substitute_complex(&self, factors: &[Complex<f64>], b: &mut [Complex<f64>]) {
        self.substituted::<f64, Complex<f64>>(factors, b);
    }

    fn second(&self) -> Range<usize> {
        self.blueprint.second.clone()
    }

    fn second_derivatives(&self, x: &[S], dx: &mut [S]) {
        let Some(of) = &self.programs().second else { return };
        let row = self.own(&self.rows.derivatives, &of.constants, &of.derivatives);
        let rates = dx.to_vec();
        let moment = Moment { rates: &rates, ..Moment::at(S::from_f64(0.0), x, &[]) };
        self.evaluate(&of.derivatives, row, moment, &mut dx[self.second()]);
    }

    fn forces(&self, t: S, x: &[S], negative: &[S::Switch], dx: &mut [S]) {
        if let Some(of) = &self.programs().second
            && let Some(code) = &of.forces
        {
            let row = self.own(&self.rows.forces, &of.constants, code);
            self.evaluate_at((code, row), t, x, negative, dx);
        } else {
            self.rate(t, x, negative, dx);
            self.second_derivatives(x, dx);
        }
    }

    fn operations_of_forces(&self) -> Option<[u32; 2]> {
        self.programs().second.as_ref().map(|second| second.operations)
    }

    fn series(&self) -> Option<SeriesSize> {
        let bg_compiler::program::SeriesSize { width, rate, order, product_count, sums, .. } =
            self.programs().series.size;
        let small = |count: usize| u32::try_from(count).expect("fewer than 2^32 operations");
        let operations =
            Operations { rate: small(rate), order: small(order), products: small(product_count), sums: small(sums) };
        // None is known where an input changes with time.
        self.inputs.iter().all(Input::is_constant).then_some(SeriesSize { width, operations: Some(operations) })
    }

    fn expand(&self, t: S, h: S, negative: &[S::Switch], rows: &mut [S], series: &mut [S]) {
        let (code, states) = (&self.programs().series, self.states());
        let found = if code.reads_found() { self.found(t, &series[..states], negative) } else { Vec::new() };
        let expansion = Expansion { t, h, negative, states, found };
        let row = self.rows.series.get_or_init(|| RefCell::new(code.row(&self.constants, self.back_end)));
        let input = |symbol| self.symbol(symbol, &Moment::at(t, &[], negative));
        code.expand(expansion, &mut row.borrow_mut(), input, rows, series);
    }

    fn held(&self) -> Option<Held> {
        self.blueprint.statics.held
    }

    fn kept(&self) -> &[f64] {
        &self.decided.kept
    }

    fn hold(&self, t: S, x: &[S], negative: &[S::Switch], entries: &mut [S]) {
        if let Some(of) = &self.programs().holding {
            self.alone(of, &self.rows.holding, Moment::at(t, x, negative), entries);
        }
    }

    fn stops(&self) -> Option<Stops> {
        self.blueprint.statics.stops
    }

    fn kept_of_stops(&self) -> &[f64] {
        &self.decided.kept
    }

    fn impact(&self, t: S, x: &[S], negative: &[S::Switch], entries: &mut [S]) {
        if let Some(of) = &self.programs().impacts {
            self.alone(of, &self.rows.impacts, Moment::at(t, x, negative), entries);
        }
    }

    fn stored(&self) -> Option<&'static [StateInfo]> {
        Some(self.description().states)
    }

    fn energy(&self, t: S, x: &[S], negative: &[S::Switch], curvatures: &mut [S]) -> S {
        let results = self.alone_listed(&self.programs().sizes, &self.rows.sizes, Moment::at(t, x, negative));
        let (energy, of_states) = results.split_first().expect("the energy comes first");
        curvatures.copy_from_slice(of_states);
        *energy
    }
}

impl<S: Scalar> Machine<S> for Interpreted<S> {
    fn description(&self) -> &'static Description {
        self.blueprint.statics.description
    }

    fn start(&self) -> Result<Vec<S>, AssemblyError> {
        let mut x = vec![S::from_f64(0.0); self.states()];
        start(self, self, &mut x)?;
        Ok(x)
    }

    fn redundant(&self) -> Vec<Redundancy> {
        if self.decided.kept.is_empty() { Vec::new() } else { redundant(self, self) }
    }

    fn decided(&self) -> Vec<f64> {
        [&self.decided.kept[..], &self.decided.sides[..]].concat()
    }

    fn impulse_energy(&self) -> Result<S, AssemblyError> {
        if self.held().is_none() {
            Ok(S::from_f64(0.0))
        } else {
            start(self, self, &mut vec![S::from_f64(0.0); self.states()])
        }
    }

    fn outputs(&self, t: S, x: &[S], negative: &[S::Switch], y: &mut [S]) {
        let reactions = self.reactions(t, x, negative);
        let moment = Moment { reactions: &reactions, ..Moment::at(t, x, negative) };
        self.evaluate(&self.programs().outputs, &self.rows.outputs, moment, y);
    }

    fn stored_energy(&self, t: S, x: &[S], negative: &[S::Switch]) -> S {
        self.listed(&self.programs().stored_energy, &self.rows.stored_energy, Moment::at(t, x, negative))[0]
    }

    fn shown(&self, t: f64, x: &[f64], negative: &[bool], shown: &mut Vec<f64>) {
        let states: Vec<S> = x.iter().copied().map(S::from_f64).collect();
        let switches: Vec<S::Switch> = negative.iter().copied().map(S::Switch::from).collect();
        let numbers = |of: Vec<S>| of.into_iter().map(S::to_f64).collect::<Vec<_>>();
        let (reactions, found) = (
            numbers(self.reactions(S::from_f64(t), &states, &switches)),
            numbers(self.found(S::from_f64(t), &states, &switches)),
        );
        let input = |input: &Input| [input.value(t), input.slope(t)];
        self.description().drawing.tape.evaluate(
            &drawing::Moment {
                t,
                states: x,
                parameters: &self.parameters,
                inputs: &self.inputs.iter().map(input).collect::<Vec<_>>(),
                negative,
                reactions: &reactions,
                found: &found,
                sides: &self.decided.sides,
            },
            shown,
        );
    }

    fn powers(&self, t: S, x: &[S], negative: &[S::Switch]) -> Powers<S> {
        let powers = self.listed(&self.programs().powers, &self.rows.powers, Moment::at(t, x, negative));
        Powers { supplied: powers[0], dissipated: powers[1] }
    }

    fn constants(&self) -> &[S] {
        &self.constants
    }
}

impl<S: Scalar> Interpreted<S> {
    /// Writes what a routine of the start gives, for values of the parameters and unknowns.
    fn of_start<T: Scalar>(&self, routine: StartRoutine, values: &[T], unknowns: &[T], to: &mut [T]) {
        let programs = self.programs();
        let program = match routine {
            StartRoutine::Guesses => Some(&programs.guesses),
            StartRoutine::Gaps => Some(&programs.gaps),
            StartRoutine::GapSizes => Some(&programs.gap_sizes),
            StartRoutine::State => Some(&programs.start_state),
            StartRoutine::Sides => programs.sides.as_ref(),
            StartRoutine::Required => programs.required_at_start.as_ref(),
        };
        if let Some(program) = program {
            of_parameters(program, values, unknowns, Some(&self.decided), to);
        }
    }
}

impl<S: Scalar> Starting<S> for Interpreted<S> {
    fn table(&self) -> StartTable {
        self.blueprint.statics.start
    }

    fn in_numbers(&self, routine: StartRoutine, unknowns: &[f64], to: &mut [f64]) {
        self.of_start(routine, &self.parameters, unknowns, to);
    }

    fn in_scalars(&self, routine: StartRoutine, unknowns: &[S], to: &mut [S]) {
        self.of_start(routine, &self.values, unknowns, to);
    }
}

impl Differentiable for Interpreted {
    fn description(&self) -> &'static Description {
        self.blueprint.statics.description
    }

    fn values(&self) -> Vec<f64> {
        self.parameters.clone()
    }

    fn inputs(&self) -> Vec<Input> {
        self.inputs.clone()
    }

    fn machine(&self) -> Rc<dyn Machine> {
        Rc::new(self.in_scalar::<f64>())
    }

    fn tuned(&self, values: &[f64]) -> Result<Rc<dyn Machine>, ParameterError> {
        self.lifted(values)
    }

    fn sloped(&self, inputs: &[Input]) -> Result<Rc<dyn Machine<Gradient>>, ParameterError> {
        Ok(Rc::new(Interpreted::<Gradient>::new(&self.blueprint, &self.parameters, inputs)?))
    }
}

impl<S: Scalar> Liftable<S> for Interpreted {
    fn lifted(&self, values: &[S]) -> Result<Rc<dyn Machine<S>>, ParameterError> {
        Ok(Rc::new(Interpreted::of_values(&self.blueprint, values.to_vec(), &self.inputs)?.by(self.back_end)))
    }
}

impl Reversible for Interpreted {
    fn swept(&self) -> Option<Rc<dyn Swept>> {
        Some(Rc::new(self.in_scalar::<f64>()))
    }
}

impl<V: Slopes> Joinable<V> for Interpreted {
    fn side_by_side(&self, values: &[Vec<Gradient>]) -> Option<Result<SideBySide<V>, ParameterError>> {
        let joined = |place: usize| {
            let of_each: Vec<Gradient> = values.iter().map(|values| values[place]).collect();
            GradientIn::joined(&of_each)
        };
        let all = (0..self.parameters.len()).map(joined).collect();
        let made = || {
            Ok(SideBySide {
                each: values.iter().map(|values| self.lifted(values)).collect::<Result<_, _>>()?,
                all: Box::new(Interpreted::<GradientIn<V>>::of_values(&self.blueprint, all, &self.inputs)?),
            })
        };
        Some(made())
    }
}

impl<V: Slopes> Rates<V> for Interpreted<GradientIn<V>> {
    fn rate(&self, t: f64, x: &[GradientIn<V>], negative: &[bool], dx: &mut [GradientIn<V>]) {
        Dynamics::rate(self, GradientIn::from_f64(t), x, negative, dx);
    }

    fn project(&self, t: f64, negative: &[bool], x: &mut [GradientIn<V>]) {
        Dynamics::project(self, GradientIn::from_f64(t), negative, x);
    }
}
