//! A model where it stands, without the numbers of its states in its type.
//!
//! In: a model with its parameters. Out: rates, outputs, guards at a time and state; what an event makes of branches
//! and state; the state a piece of time later, by a run that goes on from piece to piece.

use bg_model::failure::Origin;
use bg_model::integrator::{AnyMethod, Integrator, Tolerances};
use bg_model::mechanism::ModelVisitor;
use bg_model::nalgebra::SVector;
use bg_model::run::Request;
use bg_model::simulation::{Ongoing, Settings, sizes};
use bg_model::standing::{CLOSE, Misplaced, Standing};
use bg_model::statistics::Statistics;
use bg_model::system::Model;

use super::Fault;
use super::saved::Place;

/// The part of the machine's size by which a host's steps may have left joints, orientations and stops: it may have
/// located an event no better.
const DRIFT: f64 = 1e-3;

/// A model at a time, in a state, its switches in branches.
pub(crate) trait Machine {
    /// Time, s.
    fn time(&self) -> f64;
    fn set_time(&mut self, t: f64);
    fn states(&self) -> &[f64];
    /// Stands in another state; none of it but that its numbers are finite is checked before the next event, since a
    /// host's steps drift.
    fn set_states(&mut self, x: &[f64]);
    /// How large each state has been.
    fn largest(&self) -> &[f64];
    /// Whether each switch is in the branch of its negative guard; none before an event or a step has found the
    /// branches.
    fn branches(&self) -> &[bool];
    /// Whether the branches are found.
    fn knows_branches(&self) -> bool;
    /// How large each state is to be taken for, in its unit, above zero: what a host measures its errors by.
    fn nominals(&self) -> Vec<f64>;
    /// Writes dx/dt.
    fn rates(&self, rates: &mut [f64]);
    fn outputs(&self, outputs: &mut [f64]);
    fn guards(&self, guards: &mut [f64]);
    /// The input or law that something which is not finite comes from, as far as that is known.
    fn origin(&self) -> Option<Origin>;
    /// Whether the state has drifted off the invariants: whether the projection changes a state by more than the part
    /// `rtol` of what is larger, the state or its size ([`Machine::nominals`]) at the start.
    ///
    /// # Errors
    /// It is so far off that no step leads there.
    fn drifts(&self, rtol: f64) -> Result<bool, Fault>;
    /// An event: projects the state, lets it jump where something hits a stop, finds the branches that hold from here
    /// on. Gives whether the state has changed.
    fn settle(&mut self, rtol: f64) -> Result<bool, Fault>;
    /// The first instant after the time at which a step must end, s; infinity where there is none.
    fn next_break(&self) -> f64;
    /// Goes on to time `to` (s), over all events. On failure it stands where the run has come to.
    fn advance(&mut self, to: f64, rtol: f64) -> Result<(), Fault>;
    /// What the rate reads from outside has changed.
    fn disturb(&mut self);
    /// The size that the next step of the run is to have, s, where that is known.
    fn next_step(&self) -> Option<f64>;
    /// What the run has cost, where there is one.
    fn statistics(&self) -> Option<Statistics>;
    /// Stands at another place, where the switches are in these branches; the next step of the run is tried with `step`
    /// (s).
    ///
    /// # Errors
    /// The model cannot stand there.
    fn place(&mut self, place: &Place) -> Result<(), Fault>;
    /// Another one at the same place, whose run goes on with the same steps.
    fn twin(&self) -> Box<dyn Machine>;
}

/// Makes a machine of a model, at its start.
pub(crate) struct AtStart {
    /// The time of the start, s.
    pub t: f64,
}

impl ModelVisitor<f64> for AtStart {
    type Output = Result<Box<dyn Machine>, Fault>;

    fn visit<Mo, const N: usize, const G: usize, const M: usize>(self, model: &Mo) -> Self::Output
    where
        Mo: Model<f64, N, G, M> + Clone + 'static,
    {
        let x = model.start().map_err(|fault| Fault::Start(fault.to_string()))?;
        let (model, t, largest, size) = (model.clone(), self.t, x.abs(), above_zero(&sizes(model, self.t, &x)));
        Ok(Box::new(Stood::<Mo, N, G, M> { model, t, start: x, x, size, largest, negative: None, run: None }))
    }
}

/// A model where it stands.
#[derive(Clone)]
struct Stood<Mo, const N: usize, const G: usize, const M: usize> {
    model: Mo,
    t: f64,
    /// The model's own start.
    start: SVector<f64, N>,
    x: SVector<f64, N>,
    /// How large each state is to be taken for at the start, in its unit.
    size: SVector<f64, N>,
    /// How large each state has been.
    largest: SVector<f64, N>,
    /// The branches of the switches, once an event or a step has found them.
    negative: Option<[bool; G]>,
    /// The run from here on, once there is one.
    run: Option<Run<N, G>>,
}

#[derive(Clone)]
struct Run<const N: usize, const G: usize> {
    method: AnyMethod,
    ongoing: Ongoing<N, G>,
}

impl<const N: usize, const G: usize> Run<N, G> {
    fn at(t: f64, x: SVector<f64, N>, largest: &SVector<f64, N>, negative: Option<[bool; G]>) -> Self {
        let ongoing = match negative {
            Some(negative) => Ongoing::standing(t, x, negative),
            None => Ongoing::at(t, x),
        };
        let method = Integrator::default().method(Request::default().fixed_step);
        Self { method, ongoing: ongoing.grown(largest) }
    }
}

fn settings<const N: usize>(rtol: f64) -> Settings<N> {
    Settings { tolerances: Tolerances::relative(rtol), ..Settings::default() }
}

/// Nominal values of these sizes: 1 SI unit, as the standard has it, where nothing is known.
fn above_zero<const N: usize>(sizes: &SVector<f64, N>) -> SVector<f64, N> {
    sizes.map(|size| if size > 0.0 && size.is_finite() { size } else { 1.0 })
}

/// The nominal values of a model's states at its start.
pub(crate) struct Nominals;

impl ModelVisitor<f64> for Nominals {
    type Output = Option<Vec<f64>>;

    fn visit<Mo, const N: usize, const G: usize, const M: usize>(self, model: &Mo) -> Self::Output
    where
        Mo: Model<f64, N, G, M>,
    {
        Some(above_zero(&sizes(model, 0.0, &model.start().ok()?)).as_slice().to_vec())
    }
}

fn misplaced(fault: Misplaced) -> Fault {
    Fault::Misplaced(fault.to_string())
}

impl<Mo, const N: usize, const G: usize, const M: usize> Stood<Mo, N, G, M> {
    /// The branches; all positive before they are found.
    const NONE: [bool; G] = [false; G];

    fn negative(&self) -> &[bool; G] {
        self.negative.as_ref().unwrap_or(&Self::NONE)
    }

    /// Closes what rounding or a host's steps have left of what the model holds: up to `part` of its size.
    fn stand(&mut self, part: f64) -> Result<(), Fault>
    where
        Mo: Model<f64, N, G, M>,
    {
        let standing = self.standing(part);
        let negative = self.negative.map(|negative| standing.possible(&self.x, negative));
        let x = standing.closed(&self.x, negative.as_ref()).map_err(misplaced)?;
        (self.x, self.negative) = (x, negative);
        Ok(())
    }

    fn standing(&self, part: f64) -> Standing<'_, Mo, N>
    where
        Mo: Model<f64, N, G, M>,
    {
        Standing::with_start(&self.model, self.t, Some(self.start), &self.largest, part)
    }
}

impl<Mo, const N: usize, const G: usize, const M: usize> Machine for Stood<Mo, N, G, M>
where
    Mo: Model<f64, N, G, M> + Clone + 'static,
{
    fn time(&self) -> f64 {
        self.t
    }

    fn set_time(&mut self, t: f64) {
        self.t = t;
    }

    fn states(&self) -> &[f64] {
        self.x.as_slice()
    }

    fn set_states(&mut self, x: &[f64]) {
        self.x.as_mut_slice().copy_from_slice(x);
        self.largest = self.largest.sup(&self.x.abs());
    }

    fn largest(&self) -> &[f64] {
        self.largest.as_slice()
    }

    fn branches(&self) -> &[bool] {
        self.negative()
    }

    fn knows_branches(&self) -> bool {
        self.negative.is_some()
    }

    fn nominals(&self) -> Vec<f64> {
        above_zero(&sizes(&self.model, self.t, &self.x).sup(&self.largest)).as_slice().to_vec()
    }

    fn rates(&self, rates: &mut [f64]) {
        let mut dx = SVector::zeros();
        self.model.rate(self.t, &self.x, self.negative(), &mut dx);
        rates.copy_from_slice(dx.as_slice());
    }

    fn outputs(&self, outputs: &mut [f64]) {
        let mut y = SVector::<f64, M>::zeros();
        self.model.outputs(self.t, &self.x, self.negative(), &mut y);
        outputs.copy_from_slice(y.as_slice());
    }

    fn origin(&self) -> Option<Origin> {
        self.model.not_finite(self.t, &self.x, self.negative())
    }

    fn guards(&self, guards: &mut [f64]) {
        let mut values = SVector::<f64, G>::zeros();
        self.model.guards(self.t, &self.x, self.negative(), &mut values);
        guards.copy_from_slice(values.as_slice());
    }

    fn drifts(&self, rtol: f64) -> Result<bool, Fault> {
        let mut x = self.x;
        self.model.project(self.t, self.negative(), &mut x);
        let drift = (x - self.x).component_div(&self.x.abs().sup(&self.size)).amax();
        // What no projection moves, such as an orientation of zeros, is off as well.
        self.standing(DRIFT).rotated(&self.x).map_err(misplaced)?;
        if drift > rtol {
            self.standing(DRIFT).closed(&self.x, self.negative.as_ref()).map_err(misplaced)?;
        }
        Ok(drift > rtol)
    }

    fn settle(&mut self, rtol: f64) -> Result<bool, Fault> {
        let before = self.x;
        self.stand(DRIFT)?;
        if G > 0 {
            // A run of no length finds branches and impacts.
            let Run { mut method, mut ongoing } = Run::<N, G>::at(self.t, self.x, &self.largest, self.negative);
            let settled = ongoing.advance(&self.model, &mut method, self.t, &settings(rtol), &mut ());
            settled.map_err(|failure| Fault::Stopped(failure.to_string()))?;
            (self.x, self.negative) = (*ongoing.state(), Some(*ongoing.negative()));
        }
        Ok(self.x != before)
    }

    fn next_break(&self) -> f64 {
        self.model.next_break(self.t)
    }

    fn advance(&mut self, to: f64, rtol: f64) -> Result<(), Fault> {
        let run = self.run.get_or_insert_with(|| Run::at(self.t, self.x, &self.largest, self.negative));
        let outcome = run.ongoing.advance(&self.model, &mut run.method, to, &settings(rtol), &mut ());
        (self.t, self.x) = (run.ongoing.time(), *run.ongoing.state());
        self.negative = Some(*run.ongoing.negative());
        self.largest = self.largest.sup(&self.x.abs());
        outcome.map(|_| ()).map_err(|failure| Fault::Stopped(failure.to_string()))
    }

    fn disturb(&mut self) {
        if let Some(run) = &mut self.run {
            run.ongoing.renew(None);
        }
    }

    fn next_step(&self) -> Option<f64> {
        self.run.as_ref().and_then(|run| run.ongoing.next_step())
    }

    fn statistics(&self) -> Option<Statistics> {
        self.run.as_ref().map(|run| *run.ongoing.statistics())
    }

    fn place(&mut self, Place { t, x, largest, negative, step }: &Place) -> Result<(), Fault> {
        self.t = *t;
        self.set_states(x);
        self.largest = self.largest.sup(&SVector::<f64, N>::from_column_slice(largest).abs());
        self.negative = negative.as_ref().map(|negative| std::array::from_fn(|index| negative[index]));
        self.stand(CLOSE)?;
        self.run = step.map(|step| {
            let mut run = Run::at(*t, self.x, &self.largest, self.negative);
            run.ongoing.renew(Some(step));
            run
        });
        Ok(())
    }

    fn twin(&self) -> Box<dyn Machine> {
        Box::new(self.clone())
    }
}
