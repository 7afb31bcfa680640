//! An instance through its safe layer: trajectories, events, derivatives, saved states, refusals.

use crate::machines::{Ball, Pendulum, Shaker};
use bg_fmi::variables::VariableKind;
use bg_fmi::{Exported, Instance, Interface, Of, Packing, Version, model_description, token};
use bg_model::bond_graph;
use bg_model::input::Input;
use bg_model::mechanism::{Mechanism, ModelVisitor};
use bg_model::nalgebra::SVector;
use bg_model::run::Simulation;
use bg_model::scalar::{DoubleDouble, Scalar};
use bg_model::system::{Model, branches_by_sign};

static PENDULUM: Of<Pendulum> = Of::NEW;
static BALL: Of<Ball> = Of::NEW;
static SHAKER: Of<Shaker> = Of::NEW;
static TIMED: Of<Timed> = Of::NEW;
static SAMPLED: Of<Sampled> = Of::NEW;
static LATE: Of<Late> = Of::NEW;

bond_graph! {
    /// A mass whose force depends on an input, on a state and on the time.
    graph Timed {
        param stiffness: N/m = 200, above 0;
        param unit: N = 1;
        input force: N;
        1 motion: translation; I inertia = 2; C spring = stiffness start 0.1;
        MSe push = force * (2 + sin(7 * t)) + 1e3 * cos(5 * t) + force * force * tanh(3 * motion.flow) / unit;
        push -> motion -> inertia; motion -> spring;
        observe { x: m = spring.q; power: W = force * motion.flow; push: N = push.effort }
    }
}

bond_graph! {
    /// A wheel whose speed a computer keeps.
    graph Sampled {
        every 30 ms offset 10 ms {
            sample error: rad/s = 10 - shaft.flow;
            sample sum: rad = sum.last + 30 ms * error;
            sample torque: N*m = 3 * error + 9 * sum;
        }
        MSe motor = torque; 1 shaft: rotation; I wheel = 0.5; R rub = 0.4; motor -> shaft -> wheel; shaft -> rub;
        observe { speed: rad/s = shaft.flow; torque: N*m = torque }
    }
}

bond_graph! {
    /// A speed that is turned up by what is seen 0.2 s late.
    graph Late {
        param late: ms = 200, above 0;
        state speed: rpm = -delay(speed, late) / 0.1 s start 300;
        1 shaft: rotation; MSf seen = speed; R rub = 0.4; seen -> shaft -> rub;
        observe { speed: rpm = speed }
    }
}

/// The value reference of a variable: they count through time, parameters, inputs, outputs, states, derivatives.
fn reference(model: &dyn Exported, kind: VariableKind) -> u32 {
    let d = model.description();
    let sizes = [1, d.parameters.len(), d.inputs.len(), d.outputs.len(), d.states.len(), d.states.len()];
    let first = |row: usize| sizes[..row].iter().sum::<usize>();
    let place = match kind {
        VariableKind::Time => 0,
        VariableKind::Parameter(k) => first(1) + k,
        VariableKind::Input(k) => first(2) + k,
        VariableKind::Output(k) => first(3) + k,
        VariableKind::State(k) => first(4) + k,
        VariableKind::Derivative(k) => first(5) + k,
        VariableKind::Guard(k) => first(6) + k,
    };
    u32::try_from(place).unwrap()
}

fn get(instance: &mut Instance, model: &dyn Exported, kind: VariableKind) -> f64 {
    let mut value = [f64::NAN];
    instance.get(&[reference(model, kind)], &mut value).unwrap();
    value[0]
}

fn set(instance: &mut Instance, model: &dyn Exported, kind: VariableKind, value: f64) {
    instance.set(&[reference(model, kind)], &[value]).unwrap();
}

fn begun(model: &'static dyn Exported, interface: Interface, tolerance: f64) -> Instance {
    let mut instance = Instance::new(model, interface);
    instance.enter_initialization(0.0, Some(tolerance)).unwrap();
    instance.exit_initialization().unwrap();
    instance
}

/// The last value of an output of our own run.
fn own<Me: Mechanism>(model: &Me, t: f64, rtol: f64, output: &str) -> f64 {
    let run = Simulation::new(model).rtol(rtol).at(&[t]).until(t).run().unwrap();
    run[output][0]
}

/// Model Exchange as a host does it, in steps `h` of the fourth-order method of Runge and Kutta; events are met by
/// halving.
fn exchanged(instance: &mut Instance, t_end: f64, h: f64) -> u32 {
    let (n, g) = (instance.state_count(), instance.guard_count());
    let (mut t, mut x, mut guards, mut before) = (0.0, vec![0.0; n], vec![0.0; g], vec![0.0; g]);
    let mut events = 0;
    let mut next_event = instance.update().unwrap().next_event.unwrap_or(f64::INFINITY);
    instance.enter_continuous().unwrap();
    instance.states(&mut x).unwrap();
    instance.guards(&mut before).unwrap();
    let to = |instance: &mut Instance, t: f64, x: &[f64], h: f64| {
        let mut sum = x.to_vec();
        let (mut dx, mut at) = (vec![0.0; n], x.to_vec());
        for (part, weight) in [(0.0, 1.0), (0.5, 2.0), (0.5, 2.0), (1.0, 1.0)] {
            at.iter_mut().zip(x).zip(&dx).for_each(|((at, x), dx)| *at = x + part * h * dx);
            instance.set_time(t + part * h).unwrap();
            instance.set_states(&at).unwrap();
            instance.derivatives(&mut dx).unwrap();
            sum.iter_mut().zip(&dx).for_each(|(sum, dx)| *sum += h / 6.0 * weight * dx);
        }
        instance.set_time(t + h).unwrap();
        instance.set_states(&sum).unwrap();
        sum
    };
    while t < t_end {
        let (mut low, mut high) = (0.0, h.min(t_end - t).min(next_event - t));
        let is_timed = t + high >= next_event;
        let mut end = to(instance, t, &x, high);
        instance.guards(&mut guards).unwrap();
        let crossed = |now: &[f64], before: &[f64]| now.iter().zip(before).any(|(a, b)| a * b < 0.0);
        let is_event = crossed(&guards, &before);
        while is_event && high - low > 1e-13 {
            let middle = 0.5 * (low + high);
            end = to(instance, t, &x, middle);
            instance.guards(&mut guards).unwrap();
            if crossed(&guards, &before) { high = middle } else { low = middle }
        }
        if is_event {
            end = to(instance, t, &x, high);
        }
        (t, x) = (t + high, end);
        let needed = instance.completed_step().unwrap();
        let is_timed = is_timed && !is_event;
        if needed || is_event || is_timed {
            events += u32::from(is_event);
            instance.enter_event().unwrap();
            if is_timed {
                t = next_event;
                instance.set_time(t).unwrap();
            }
            let update = instance.update().unwrap();
            // What an instant computes it computes once.
            assert!(!is_timed || update.states_changed && !instance.update().unwrap().states_changed);
            next_event = update.next_event.unwrap_or(f64::INFINITY);
            instance.enter_continuous().unwrap();
            instance.states(&mut x).unwrap();
        }
        instance.guards(&mut before).unwrap();
    }
    events
}

#[test]
fn model_exchange_leads_where_our_run_does() {
    let mut instance = begun(&PENDULUM, Interface::ModelExchange, 1e-9);
    exchanged(&mut instance, 1.0, 1e-3);
    let angle = get(&mut instance, &PENDULUM, VariableKind::Output(0));
    let wanted = own(&Pendulum::new(Default::default()).unwrap(), 1.0, 1e-10, "angle");
    assert!((angle - wanted).abs() < 1e-8, "{angle} {wanted}");
}

/// A host steps to the instants that the unit names as its next events; in Co-Simulation the unit does.
#[test]
fn samples_are_computed_at_the_instants_of_their_clock() {
    let model = Sampled::new(Default::default()).unwrap();
    let [speed, torque] = ["speed", "torque"].map(|output| own(&model, 0.97, 1e-11, output));
    let mut exchange = begun(&SAMPLED, Interface::ModelExchange, 1e-9);
    exchanged(&mut exchange, 0.97, 7e-3);
    let mut simulation = begun(&SAMPLED, Interface::CoSimulation, 1e-11);
    for k in 0..97 {
        simulation.step(f64::from(k) * 0.01, 0.01).unwrap();
    }
    for instance in [&mut exchange, &mut simulation] {
        assert!((get(instance, &SAMPLED, VariableKind::Output(0)) - speed).abs() < 1e-9);
        // 0.97 s is an instant: what is held is that of it.
        assert!((get(instance, &SAMPLED, VariableKind::Output(1)) - torque).abs() < 1e-8);
    }
}

#[test]
fn events_of_model_exchange_switch_and_jump() {
    let mut shaker = begun(&SHAKER, Interface::ModelExchange, 1e-9);
    let events = exchanged(&mut shaker, 1.0, 1e-3);
    let x = get(&mut shaker, &SHAKER, VariableKind::Output(0));
    let wanted = own(&Shaker::make(Default::default(), &[]).unwrap(), 1.0, 1e-11, "x");
    assert!(events == 3 && (x - wanted).abs() < 1e-8, "{events} {x} {wanted}");

    // Dropped from 1.25 m it hits at sqrt(2 h / g) and rises to a quarter of that.
    let mut ball = begun(&BALL, Interface::ModelExchange, 1e-9);
    let events = exchanged(&mut ball, 1.0, 1e-2);
    let fall = (2.0 * 1.25 / 9.81_f64).sqrt();
    let rise = 1.0 - fall;
    let wanted = 0.5 * 9.81 * fall * rise - 0.5 * 9.81 * rise * rise;
    let height = get(&mut ball, &BALL, VariableKind::Output(0));
    assert!(events >= 1 && (height - wanted).abs() < 1e-9, "{events} {height} {wanted}");
}

#[test]
fn co_simulation_goes_on_from_step_to_step() {
    let mut instance = begun(&PENDULUM, Interface::CoSimulation, 1e-10);
    for k in 0..1000 {
        instance.step(f64::from(k) * 1e-3, 1e-3).unwrap();
    }
    let angle = get(&mut instance, &PENDULUM, VariableKind::Output(0));
    let wanted = own(&Pendulum::new(Default::default()).unwrap(), 1.0, 1e-10, "angle");
    assert!((instance.time().unwrap() - 1.0).abs() < 1e-12 && (angle - wanted).abs() < 1e-9, "{angle} {wanted}");
    // A step of DOP853 takes twelve rates; one that began anew would take two more.
    let cost = instance.statistics();
    assert!(cost.steps < 1010 && cost.rate_evaluations < 13 * cost.steps + 100, "{cost:?}");
}

#[test]
fn events_inside_a_step_of_co_simulation_are_handled() {
    for h in [0.07, 0.5, 2.0] {
        let mut ball = begun(&BALL, Interface::CoSimulation, 1e-8);
        let steps = (2.0_f64 / h).ceil() as u32;
        for k in 0..steps {
            let t = f64::from(k) * h;
            ball.step(t, h.min(2.0 - t)).unwrap();
        }
        let (height, lost) =
            (get(&mut ball, &BALL, VariableKind::Output(0)), get(&mut ball, &BALL, VariableKind::Output(2)));
        assert!(height.abs() < 1e-8 && (lost - 2.0 * 9.81 * 1.25).abs() < 1e-6, "{h}: {height} {lost}");
    }
}

#[test]
fn an_input_holds_from_one_step_to_the_next() {
    // A force of steps: ours as a table that jumps is the sum of its pieces.
    let mut shaker = Instance::new(&SHAKER, Interface::CoSimulation);
    set(&mut shaker, &SHAKER, VariableKind::Parameter(2), 0.0);
    shaker.enter_initialization(0.0, Some(1e-10)).unwrap();
    shaker.exit_initialization().unwrap();
    let parameters = crate::machines::ShakerParameters { stretch: 0.0, ..Default::default() };
    let force = |t: f64| (3.0 * t).sin() * 5.0;
    let mut state = None;
    for k in 0..50 {
        let t = f64::from(k) * 0.02;
        set(&mut shaker, &SHAKER, VariableKind::Input(0), force(t));
        shaker.step(t, 0.02).unwrap();
        let model = Shaker::make(parameters.clone(), &[Input::constant(force(t))]).unwrap();
        let piece = Simulation::new(&model).rtol(1e-10).until(t + 0.02);
        let piece = match &state {
            Some(state) => piece.from(state),
            None => piece,
        };
        state = Some(piece.run().unwrap().last.clone());
    }
    let (x, wanted) = (get(&mut shaker, &SHAKER, VariableKind::State(0)), state.unwrap().states[0].1);
    assert!(wanted.abs() > 1e-3 && (x - wanted).abs() < 1e-8, "{x} {wanted}");
    // The rate at the start of a step is that of the new force: with that of the old one steps would be rejected.
    let cost = shaker.statistics();
    assert!(cost.rejected <= 10 && cost.steps < 200, "{cost:?}");
}

#[test]
fn derivatives_are_those_of_differences() {
    for model in [&PENDULUM as &'static dyn Exported, &BALL, &SHAKER] {
        let mut instance = begun(model, Interface::ModelExchange, 1e-9);
        exchanged(&mut instance, 0.21, 1e-3);
        let (n, d) = (instance.state_count(), model.description());
        let unknowns: Vec<VariableKind> =
            (0..n).map(VariableKind::Derivative).chain((0..d.outputs.len()).map(VariableKind::Output)).collect();
        let unknowns: Vec<u32> = unknowns.into_iter().map(|kind| reference(model, kind)).collect();
        let knowns = (0..n).map(VariableKind::State).chain((0..d.inputs.len()).map(VariableKind::Input));
        let mut x = vec![0.0; n];
        instance.states(&mut x).unwrap();
        let adjoint_seed: Vec<f64> = (0..unknowns.len()).map(|k| 0.3 + 0.1 * k as f64).collect();
        for known in knowns {
            let (mut column, mut back) = (vec![0.0; unknowns.len()], [0.0]);
            let known_reference = [reference(model, known)];
            instance.directional(&unknowns, &known_reference, &[2.0], &mut column).unwrap();
            instance.adjoint(&unknowns, &known_reference, &adjoint_seed, &mut back).unwrap();
            let expected: f64 = column.iter().zip(&adjoint_seed).map(|(entry, seed)| 0.5 * entry * seed).sum();
            assert!((back[0] - expected).abs() <= 1e-12 * expected.abs().max(1.0), "{known:?}");
            // Sixth order, so that the step is large beside rounding.
            let mut at = |by: f64| {
                let mut values = vec![0.0; unknowns.len()];
                let mut moved = x.clone();
                if let VariableKind::State(k) = known {
                    moved[k] += by;
                } else {
                    set(&mut instance, model, known, by);
                }
                instance.set_states(&moved).unwrap();
                instance.get(&unknowns, &mut values).unwrap();
                values
            };
            let h = 4e-3;
            let differences = [(1.0, 0.75), (2.0, -0.15), (3.0, 1.0 / 60.0)].map(|(k, weight)| {
                let (ahead, behind) = (at(k * h), at(-k * h));
                ahead.iter().zip(behind).map(|(a, b)| weight * (a - b) / h).collect::<Vec<_>>()
            });
            at(0.0);
            for (row, exact) in column.iter().enumerate() {
                let difference: f64 = differences.iter().map(|column| column[row]).sum();
                let size = exact.abs().max(difference.abs()).max(1e3);
                assert!((2.0 * difference - exact).abs() < 1e-10 * size, "{known:?} {row}: {difference} {exact}");
            }
        }
    }
}

/// Rates and outputs at time `t` (s) and state `x`, state `moved` of them by so much more.
struct Values<'a> {
    t: f64,
    x: &'a [f64],
    moved: Option<(usize, f64)>,
}

impl ModelVisitor<DoubleDouble> for Values<'_> {
    type Output = Vec<DoubleDouble>;

    fn visit<Mo, const N: usize, const G: usize, const M: usize>(self, model: &Mo) -> Self::Output
    where
        Mo: Model<DoubleDouble, N, G, M> + Clone + 'static,
    {
        let (t, zero) = (DoubleDouble::from_f64(self.t), DoubleDouble::from_f64(0.0));
        let mut x = SVector::<DoubleDouble, N>::from_fn(|row, _| DoubleDouble::from_f64(self.x[row]));
        let guards = |negative: &[bool; G]| {
            let mut guards = SVector::repeat(zero);
            model.guards(t, &x, negative, &mut guards);
            guards
        };
        let (negative, _) = branches_by_sign(model.first_branches(), guards);
        if let Some((row, by)) = self.moved {
            x[row] = x[row] + DoubleDouble::from_f64(by);
        }
        let (mut rates, mut outputs) = (SVector::<_, N>::repeat(zero), SVector::<_, M>::repeat(zero));
        model.rate(t, &x, &negative, &mut rates);
        model.outputs(t, &x, &negative, &mut outputs);
        rates.iter().chain(outputs.iter()).copied().collect()
    }
}

/// Holds all derivatives of a unit that was driven by `force` against central differences in double-double arithmetic.
fn derivatives_to_ten_digits<Me: Mechanism>(model: &'static dyn Exported, force: f64) {
    let mut instance = begun(model, Interface::ModelExchange, 1e-9);
    let (n, d) = (instance.state_count(), model.description());
    (0..d.inputs.len()).for_each(|input| set(&mut instance, model, VariableKind::Input(input), force));
    exchanged(&mut instance, 0.21, 1e-3);
    let (t, mut x) = (get(&mut instance, model, VariableKind::Time), vec![0.0; n]);
    instance.states(&mut x).unwrap();
    let unknowns = (0..n).map(VariableKind::Derivative).chain((0..d.outputs.len()).map(VariableKind::Output));
    let unknowns: Vec<u32> = unknowns.map(|kind| reference(model, kind)).collect();
    let values = |moved: Option<(usize, f64)>, force: f64| {
        let inputs = vec![Input::constant(force); d.inputs.len()];
        Me::make(Me::Parameters::default(), &inputs).unwrap().visit(Values { t, x: &x, moved })
    };
    let mut largest: f64 = 0.0;
    for known in (0..n).map(VariableKind::State).chain((0..d.inputs.len()).map(VariableKind::Input)) {
        let mut column = vec![0.0; unknowns.len()];
        instance.directional(&unknowns, &[reference(model, known)], &[1.0], &mut column).unwrap();
        // Of a state a step whose square is beyond doubles; what depends on an input is a parabola, whose differences
        // are exact.
        let (h, [ahead, behind]) = match known {
            VariableKind::State(row) => (1e-10, [1e-10, -1e-10].map(|by| values(Some((row, by)), force))),
            _ => (0.5, [0.5, -0.5].map(|by| values(None, force + by))),
        };
        let differences: Vec<f64> =
            ahead.iter().zip(&behind).map(|(&a, &b)| ((a - b) / DoubleDouble::from_f64(2.0 * h)).to_f64()).collect();
        let size = differences.iter().fold(0.0, |size: f64, entry| size.max(entry.abs()));
        largest = largest.max(size);
        for (row, (exact, difference)) in column.iter().zip(&differences).enumerate() {
            // What rounding in double-double leaves of a difference that is zero.
            let rounding = 1e-31 / h;
            let allowed = 1e-10 * difference.abs().max(1e-4 * size) + rounding;
            assert!((exact - difference).abs() <= allowed, "{known:?} {row}: {exact} {difference} {size}");
        }
    }
    assert!(largest >= 1.0, "{largest}");
}

#[test]
fn derivatives_have_ten_digits() {
    derivatives_to_ten_digits::<Pendulum>(&PENDULUM, 0.0);
    derivatives_to_ten_digits::<Ball>(&BALL, 3.0);
    derivatives_to_ten_digits::<Shaker>(&SHAKER, 30.0);
    derivatives_to_ten_digits::<Timed>(&TIMED, 30.0);
}

#[test]
fn a_saved_state_goes_on_with_the_same_bits_and_its_bytes_nearly_so() {
    let mut instance = begun(&BALL, Interface::CoSimulation, 1e-9);
    set(&mut instance, &BALL, VariableKind::Input(0), 1.0);
    for k in 0..7 {
        instance.step(f64::from(k) * 0.1, 0.1).unwrap();
    }
    let saved = instance.save();
    let bytes = instance.serialize(&saved).unwrap();
    let on = |instance: &mut Instance| {
        set(instance, &BALL, VariableKind::Input(0), 2.0);
        for k in 7..12 {
            instance.step(f64::from(k) * 0.1, 0.1).unwrap();
        }
        [0, 1, 2].map(|output| get(instance, &BALL, VariableKind::Output(output)))
    };
    let first = on(&mut instance);
    instance.restore(&saved).unwrap();
    assert_eq!(on(&mut instance).map(f64::to_bits), first.map(f64::to_bits));

    let mut other = Instance::new(&BALL, Interface::CoSimulation);
    let read = other.deserialize(&bytes).unwrap();
    other.restore(&read).unwrap();
    let again = on(&mut other);
    assert!(first.iter().zip(again).all(|(a, b)| (a - b).abs() < 1e-8), "{first:?} {again:?}");
    assert!(Instance::new(&SHAKER, Interface::CoSimulation).deserialize(&bytes).is_err());
    assert!(other.deserialize(&bytes[1..]).is_err());
}

/// Parameters, inputs, place, branches, sizes, the next step: all that the bytes have.
#[test]
fn a_restored_instance_has_all_that_was_saved() {
    let bounce = |value: f64| {
        let mut instance = Instance::new(&BALL, Interface::CoSimulation);
        set(&mut instance, &BALL, VariableKind::Parameter(1), value);
        instance.enter_initialization(0.0, Some(1e-7)).unwrap();
        instance.exit_initialization().unwrap();
        instance
    };
    let mut instance = bounce(0.25);
    set(&mut instance, &BALL, VariableKind::Input(0), 1.0);
    (0..7).for_each(|k| instance.step(f64::from(k) * 0.1, 0.1).unwrap());
    let saved = instance.save();
    let bytes = instance.serialize(&saved).unwrap();
    let mut other = bounce(0.75);
    set(&mut other, &BALL, VariableKind::Input(0), 3.0);
    for snapshot in [saved, other.deserialize(&bytes).unwrap()] {
        other.restore(&snapshot).unwrap();
        assert_eq!(get(&mut other, &BALL, VariableKind::Parameter(1)), 0.25);
        assert_eq!(get(&mut other, &BALL, VariableKind::Input(0)), 1.0);
        let again = other.serialize(&other.save()).unwrap();
        assert_eq!(String::from_utf8(again), String::from_utf8(bytes.clone()));
        other.step(0.7, 0.1).unwrap();
        set(&mut other, &BALL, VariableKind::Input(0), 3.0);
    }
}

#[test]
fn a_parameter_that_is_set_once_more_makes_the_model_anew() {
    let mut instance = Instance::new(&BALL, Interface::CoSimulation);
    instance.enter_initialization(0.0, None).unwrap();
    for height in [1.25, 0.5] {
        set(&mut instance, &BALL, VariableKind::Parameter(0), height);
        assert_eq!(get(&mut instance, &BALL, VariableKind::Output(0)), height);
    }
}

/// What fell and lies still is no smaller than it was.
#[test]
fn nominal_values_are_those_of_the_whole_run() {
    let mut ball = begun(&BALL, Interface::CoSimulation, 1e-8);
    let nominal = |ball: &mut Instance| {
        let mut nominals = vec![0.0; ball.state_count()];
        ball.nominals(&mut nominals).unwrap();
        nominals[ball.description().states.iter().position(|state| state.name == "ball.p").unwrap()]
    };
    ball.step(0.0, 0.4).unwrap();
    // 2 kg after 0.4 s.
    let fallen = 2.0 * 9.81 * 0.4;
    assert!(nominal(&mut ball) >= fallen);
    ball.step(0.4, 4.0).unwrap();
    assert!(get(&mut ball, &BALL, VariableKind::Output(1)).abs() < 1e-9 && nominal(&mut ball) >= fallen);
}

#[test]
fn what_cannot_be_is_refused_in_words() {
    let mut instance = Instance::new(&PENDULUM, Interface::CoSimulation);
    let length = reference(&PENDULUM, VariableKind::Parameter(1));
    let refused = instance.set(&[length], &[-1.0]).unwrap_err().to_string();
    assert_eq!(refused, "parameter `length` = -1 m is out of range: it must be a finite number, above 0");
    let mut value = [0.0];
    assert!(instance.get(&[reference(&PENDULUM, VariableKind::Output(0))], &mut value).is_err());
    let mut instance = begun(&PENDULUM, Interface::CoSimulation, 1e-8);
    let late = instance.set(&[length], &[1.0]).unwrap_err().to_string();
    assert_eq!(late, "to set a parameter is not possible in Step Mode");
    assert!(instance.step(0.5, 0.1).unwrap_err().to_string().starts_with("the step is to begin at 0.5 s"));
    // A communication point is met to a part of the step.
    assert!(instance.step(1e-10, 1e-9).is_err());
    assert!(instance.step(0.0, f64::NAN).is_err() && instance.step(0.0, -0.1).is_err());
    assert!(instance.set_states(&[0.0]).is_err());
    assert_eq!(
        instance.get(&[9999], &mut value).unwrap_err().to_string(),
        "there is no variable with the value reference 9999"
    );
    instance.step(0.0, 0.1).unwrap();
    instance.reset();
    instance.set(&[length], &[1.0]).unwrap();
}

/// Of FMI 3.0 a clock that the unit activates tells at which events samples are computed: from the start of the event
/// to its update.
#[test]
fn clocks_tick_where_samples_are_computed() {
    let text = model_description(&SAMPLED, &Packing::default());
    let all = text.matches("valueReference=").count()
        - text.split("<ModelStructure>").nth(1).unwrap().matches("valueReference=").count();
    let clock = u32::try_from(all - 1).unwrap();
    let written = format!(
        "<Clock name=\"clock[1]\" valueReference=\"{clock}\" description=\"an instant of `every 30 ms offset 10 ms`\" \
         causality=\"output\" intervalVariability=\"triggered\"/>"
    );
    assert!(text.contains(&written) && text.contains(&format!("<Output valueReference=\"{clock}\"/>")), "{text}");
    assert!(!model_description(&SAMPLED, &Packing { version: Version::Two, ..Packing::default() }).contains("Clock"));
    let mut instance = begun(&SAMPLED, Interface::ModelExchange, 1e-9);
    let ticks = |instance: &mut Instance| {
        let mut tick = [true];
        instance.ticks(&[clock], &mut tick).map(|()| tick[0])
    };
    let mut found = Vec::new();
    for _ in 0..4 {
        found.push(ticks(&mut instance).unwrap());
        let next = instance.update().unwrap().next_event.unwrap();
        assert!(!ticks(&mut instance).unwrap());
        instance.enter_continuous().unwrap();
        assert!(ticks(&mut instance).is_err());
        instance.set_time(next).unwrap();
        instance.enter_event().unwrap();
    }
    assert_eq!(found, [false, true, true, true]);
    assert!(instance.ticks(&[clock + 1], &mut [false]).is_err());
}

#[test]
fn a_delay_is_for_co_simulation() {
    let mut instance = begun(&LATE, Interface::CoSimulation, 1e-10);
    for k in 0..10 {
        instance.step(0.1 * f64::from(k), 0.1).unwrap();
    }
    let found = get(&mut instance, &LATE, VariableKind::Output(0));
    let run = own(&Late::new(Default::default()).unwrap(), 1.0, 1e-11, "speed");
    assert!((found - run).abs() < 1e-6 && run.abs() > 1.0, "{found} {run}");
    let kept = instance.save();
    instance.step(1.0, 0.3).unwrap();
    let first = get(&mut instance, &LATE, VariableKind::Output(0));
    instance.restore(&kept).unwrap();
    instance.step(1.0, 0.3).unwrap();
    assert_eq!(get(&mut instance, &LATE, VariableKind::Output(0)), first);
    let refused = instance.serialize(&kept).unwrap_err().to_string();
    assert!(refused.contains("`Late` delays a signal") && refused.contains("from a state in memory"), "{refused}");
    let mut exchanged = Instance::new(&LATE, Interface::ModelExchange);
    exchanged.enter_initialization(0.0, None).unwrap();
    assert!(exchanged.exit_initialization().unwrap_err().to_string().contains("load the unit for Co-Simulation"));
    for version in [Version::Three, Version::Two] {
        let text = model_description(&LATE, &Packing { version, ..Packing::default() });
        assert!(text.contains("<CoSimulation") && !text.contains("<ModelExchange"), "{text}");
        assert!(
            text.contains("<DisplayUnit name=\"rpm\"/>") && text.contains("unit=\"rpm\" displayUnit=\"rpm\""),
            "{text}"
        );
    }
}

#[test]
fn the_description_names_every_variable_once() {
    let text =
        |version| model_description(&PENDULUM, &Packing { version, identifier: "pendulum".to_owned(), stop_time: 5.0 });
    let two = text(Version::Two);
    assert!(two.contains(&token(&PENDULUM)) && two.contains("<Real unit=\"m\" min=\"0.0\" start="), "{two}");
    let text = text(Version::Three);
    assert_eq!(text.matches("name=\"angle\"").count(), 1);
    assert!(
        text.contains("name=\"angle_parameter\"") && text.contains("<BaseUnit kg=\"1\" m=\"1\" s=\"-2\"/>"),
        "{text}"
    );
    assert!(text.contains("name=\"length\" valueReference=\"2\" description=\"Length of the rod.\""), "{text}");
    assert!(text.contains(&token(&PENDULUM)) && token(&PENDULUM) != token(&BALL));
}
