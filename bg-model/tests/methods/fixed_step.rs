//! Steps of one size at a known greatest cost: the bits of a run with RK4, no allocation, operations counted one by
//! one.

use std::cell::Cell;
use std::cmp::Ordering;
use std::ops::{Add, Div, Mul, Neg, Sub};

use bg_model::bond_graph;
use bg_model::description::OperationCount;
use bg_model::fixed_step::{FixedStep, Unfit, operations};
use bg_model::input::Input;
use bg_model::integrator::{Dop853, Rk4};
use bg_model::nalgebra::SVector;
use bg_model::scalar::{Both, Scalar};
use bg_model::simulation::{Samples, Settings, Span, integrate};
use bg_model::system::Model;

bond_graph! {
    /// A motor whose fan takes a torque that is not linear.
    graph Motor {
        param winding: Ohm = 0.8, above 0;
        param coil: H = 2e-3, above 0;
        input voltage: V;
        Se supply = voltage; 1 armature: electrical; I L = coil; R Ra = winding; GY motor = 0.05;
        1 shaft: rotation; I J = 1e-4; R fan(w) = 1e-3 * w + 0.02 * tanh(w / 0.1);
        supply -> armature -> L; armature -> Ra; armature -> motor -> shaft -> J; shaft -> fan;
        observe { current: A = armature.flow; speed: rad/s = shaft.flow }
    }
    /// A block on a spring between two bumpers.
    graph Block {
        param stiffness: N/m = 50, above 0;
        1 slide: translation; I body = 2; C pull = stiffness start 1;
        MR left = if pull.q < -0.5 { 5 } else { 0.1 }; MR right = if pull.q > 0.5 { 7 } else { 0.2 };
        slide -> body; slide -> pull; slide -> left; slide -> right;
        observe { x: m = pull.q; v: m/s = slide.flow }
    }
    /// A block that sticks.
    graph Sticky {
        1 slide: translation; I body = 2 start 1; R rub(v) = 3 holds 3; slide -> body; slide -> rub;
        observe { v: m/s = slide.flow }
    }
    graph Ball {
        1 fall: translation; I ball = 2; Se load = -20; load -> fall -> ball;
        stop floor on fall { at least 0; start 1; restitution 0.8; }
        observe { y: m = floor.place }
    }
    graph Clipper {
        MSe source = 10 * sin(3 * t); 1 first: electrical; R R1 = 5; 0 left: electrical; 1 third: electrical; R R3 = 1;
        I coil = 0.5;
        R D1(effort u) = 0.01 * (exp(u / 0.5) - 1);
        source -> first -> R1; first -> left -> D1; left -> third -> R3; third -> coil;
        observe { current: A = third.flow }
    }
    /// A rod on a rigid pin: a pose that is moved back after each step.
    graph Pendulum {
        gravity [0, -9.81, 0];
        ground { point O = [0, 0, 0]; }
        body rod { mass 2; inertia [0.05, 0.05, 0.05]; point a = [-0.3, 0, 0]; start a at [0, 0, 0]; }
        joint pin: revolute z (ground.O -> rod.a) { rigid; }
        observe { angle: rad = pin.angle; force: N = norm(pin.force) }
    }
}

/// The motor at 12 V.
fn motor<S: Scalar>() -> Motor<S> {
    Motor::in_scalar(MotorParameters::default(), MotorInputs { voltage: Input::constant(12.0) }).expect("a motor")
}

#[test]
fn bits_are_those_of_a_run_with_rk4() {
    let (model, step) = (motor::<f64>(), 1.0 / 1024.0);
    let start = Model::start(&model).expect("a start");
    let settings = Settings { samples: Samples::Every(1.0), ..Settings::default() };
    let span = Span { t0: 0.0, t_end: 1.0 };
    let finish = integrate(&model, &mut Rk4::new(step), &start, span, &settings, &mut ()).expect("a run");
    let mut run = FixedStep::<f64, 2, 0>::new(&model, &start, 0.0, step).expect("steps");
    (0..1024).for_each(|_| run.advance(&model).expect("a step"));
    assert_eq!(run.time(), 1.0);
    assert!(run.state()[0] > 1e-4);
    assert_eq!(run.state().map(f64::to_bits), finish.x.map(f64::to_bits));
}

#[test]
fn nothing_is_allocated_after_the_start() {
    let mut model = motor::<f64>();
    let start = Model::start(&model).expect("a start");
    let counted = allocation_counter::measure(|| {
        let mut run = FixedStep::<f64, 2, 0>::new(&model, &start, 0.0, 1e-3).expect("steps");
        for sample in 0..1000 {
            model.inputs_mut().voltage = Input::constant(f64::from(sample % 24));
            run.advance(&model).expect("a step");
        }
    });
    assert_eq!(counted.count_total, 0);
    let pendulum = Pendulum::new(PendulumParameters {}).expect("a pendulum");
    let start = pendulum.start().expect("a start");
    let counted = allocation_counter::measure(|| {
        let steps = FixedStep::<f64, { Pendulum::STATES }, { Pendulum::SWITCHES }>::new(&pendulum, &start, 0.0, 1e-3);
        let mut run = steps.expect("steps");
        (0..1000).for_each(|_| run.advance(&pendulum).expect("a step"));
    });
    assert_eq!(counted.count_total, 0);
}

#[test]
fn an_input_counts_from_the_next_step_on() {
    let mut model = motor::<f64>();
    let start = Model::start(&model).expect("a start");
    let mut run = FixedStep::<f64, 2, 0>::new(&model, &start, 0.0, 1e-3).expect("steps");
    (0..2000).for_each(|_| run.advance(&model).expect("a step"));
    let fast = run.state()[1];
    model.inputs_mut().voltage = Input::constant(-12.0);
    (0..2000).for_each(|_| run.advance(&model).expect("a step"));
    assert!((run.state()[1] + fast).abs() < 1e-9 * fast, "{fast} {}", run.state()[1]);
}

#[test]
fn singles_are_near_doubles() {
    let (double, single) = (motor::<f64>(), motor::<f32>());
    let start = Model::<f64, 2, 0, 2>::start(&double).expect("a start");
    let mut exact = FixedStep::new(&double, &start, 0.0, 1e-3).expect("steps");
    let start = Model::<f32, 2, 0, 2>::start(&single).expect("a start");
    let mut near = FixedStep::new(&single, &start, 0.0, 1e-3).expect("steps");
    for _ in 0..500 {
        exact.advance(&double).expect("a step");
        near.advance(&single).expect("a step");
    }
    for (single, double) in near.state().iter().zip(exact.state()) {
        let off = (f64::from(*single) - double).abs() / double.abs();
        assert!(off > 0.0 && off < 1e-5, "{single} {double}");
    }
}

#[test]
fn branches_change_where_the_step_ends_in_which_guards_do() {
    let block = Block::new(BlockParameters::default()).expect("a block");
    let start = block.start().expect("a start");
    let span = Span { t0: 0.0, t_end: 4.0 };
    let exact = integrate(&block, &mut Dop853::new(), &start, span, &Settings::default(), &mut ()).expect("a run");
    let off = |steps: u32| {
        let run =
            FixedStep::<f64, { Block::STATES }, { Block::SWITCHES }>::new(&block, &start, 0.0, 4.0 / f64::from(steps));
        let (mut run, mut y) = (run.expect("steps"), SVector::<f64, { Block::OUTPUTS }>::zeros());
        for _ in 0..steps {
            run.advance(&block).expect("a step");
            block.outputs(run.time(), run.state(), run.negative(), &mut y);
            assert_eq!(*run.negative(), [y[0] < -0.5, y[0] > 0.5], "at {}", y[0]);
        }
        (&exact.x - run.state()).amax()
    };
    // Each of the branches' changes is late by up to a step, in which a damper takes up to 30 N.
    assert!(exact.statistics.events > 4);
    let lateness = 30.0 * exact.statistics.events as f64;
    let (coarse, fine) = (off(4_000), off(400_000));
    assert!(coarse > fine && coarse < lateness * 1e-3 && fine < lateness * 1e-5, "{coarse} {fine} {lateness}");
}

#[test]
fn what_has_no_fixed_cost_is_refused() {
    let ball = Ball::new(BallParameters {}).expect("a ball");
    let start = ball.start().expect("a start");
    let refused = FixedStep::<f64, { Ball::STATES }, { Ball::SWITCHES }>::new(&ball, &start, 0.0, 1e-3).unwrap_err();
    assert_eq!(refused, Unfit::Impacts);
    let block = Sticky::new(StickyParameters {}).expect("a block");
    let start = block.start().expect("a start");
    let refused =
        FixedStep::<f64, { Sticky::STATES }, { Sticky::SWITCHES }>::new(&block, &start, 0.0, 1e-3).unwrap_err();
    assert_eq!(refused, Unfit::Sticking);
    let model = motor::<f64>();
    for (t0, step) in [(0.0, 0.0), (0.0, -1e-3), (0.0, f64::NAN), (0.0, f64::INFINITY), (f64::NAN, 1e-3)] {
        let refused = FixedStep::<f64, 2, 0>::new(&model, &SVector::zeros(), t0, step).unwrap_err();
        assert!(refused.to_string().starts_with("steps of"), "{refused}");
    }
    assert_eq!(
        operations(Model::<f64, 1, 0, 1>::description(&Clipper::new(ClipperParameters {}).expect("a circuit"))),
        None
    );
}

#[test]
fn a_step_that_gives_no_numbers_leaves_the_run_where_it_was() {
    let mut model = motor::<f64>();
    let mut run = FixedStep::<f64, 2, 0>::new(&model, &SVector::from([1e-3, 2e-3]), 0.5, 1e-3).expect("steps");
    model.inputs_mut().voltage = Input::constant(f64::NAN);
    let failure = run.advance(&model).unwrap_err();
    assert_eq!((failure.state, failure.t, run.time(), *run.state()), (0, 0.5, 0.5, SVector::from([1e-3, 2e-3])));
    model.inputs_mut().voltage = Input::constant(1.0);
    run.advance(&model).expect("a step");
    assert_eq!(run.time(), 0.501);
}

thread_local! {
    /// Additions, subtractions and negations; multiplications; divisions; functions.
    static COUNTS: Cell<[usize; 4]> = const { Cell::new([0; 4]) };
}

/// A number that counts what is done with it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Counted(f64);

fn counted(kind: usize, value: f64) -> Counted {
    let mut counts = COUNTS.get();
    counts[kind] += 1;
    COUNTS.set(counts);
    Counted(value)
}

macro_rules! operators {
    ($($trait:ident $method:ident $kind:literal;)*) => { $(
        impl $trait for Counted {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                counted($kind, self.0.$method(other.0))
            }
        }
    )* };
}
operators! { Add add 0; Sub sub 0; Mul mul 1; Div div 2; }

impl Neg for Counted {
    type Output = Self;
    fn neg(self) -> Self {
        counted(0, -self.0)
    }
}
impl PartialOrd for Counted {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        self.0.partial_cmp(&other.0)
    }
}

macro_rules! functions {
    ($($name:ident)*) => { $(
        fn $name(self) -> Self {
            counted(3, Scalar::$name(self.0))
        }
    )* };
}
impl Scalar for Counted {
    type Pair = Both<Self>;
    type Switch = bool;
    fn from_f64(value: f64) -> Self {
        Self(value)
    }
    fn to_f64(self) -> f64 {
        self.0
    }
    fn select(switch: bool, negative: Self, positive: Self) -> Self {
        if switch { negative } else { positive }
    }
    functions! { sqrt sin cos tan asin acos exp ln tanh abs }
    fn atan2(self, x: Self) -> Self {
        counted(3, Scalar::atan2(self.0, x.0))
    }
    fn powf(self, exponent: Self) -> Self {
        counted(3, Scalar::powf(self.0, exponent.0))
    }
}

/// The operations that each of `steps` steps of `model` takes.
fn cost<Mo, const N: usize, const G: usize, const M: usize>(model: &Mo, steps: usize) -> Vec<[usize; 4]>
where
    Mo: Model<Counted, N, G, M>,
{
    let start = model.start().expect("a start");
    let mut run = FixedStep::new(model, &start, 0.0, 1e-3).expect("steps");
    let step = |_| {
        COUNTS.set([0; 4]);
        run.advance(model).expect("a step");
        COUNTS.get()
    };
    (0..steps).map(step).collect()
}

/// What the description says of a step.
fn told<S: Scalar, const N: usize, const G: usize, const M: usize>(model: &impl Model<S, N, G, M>) -> [usize; 4] {
    let OperationCount { additions, multiplications, divisions, functions, .. } =
        operations(model.description()).expect("no iteration");
    [additions, multiplications, divisions, functions]
}

#[test]
fn operations_of_a_step_are_those_that_are_told() {
    let motor = motor::<Counted>();
    let expected = told(&motor);
    assert!(expected.iter().sum::<usize>() > 50 && expected[3] == 4, "{expected:?}");
    assert!(cost(&motor, 50).iter().all(|step| *step == expected), "{expected:?} {:?}", cost(&motor, 1));
    let pendulum = Pendulum::<Counted>::in_scalar(PendulumParameters {}).expect("a pendulum");
    let expected = told(&pendulum);
    assert!(cost(&pendulum, 50).iter().all(|step| *step == expected), "{expected:?} {:?}", cost(&pendulum, 1));
}

#[test]
fn no_step_takes_more_operations_than_are_told() {
    let block = Block::<Counted>::in_scalar(BlockParameters::default()).expect("a block");
    let (expected, steps) = (told(&block), cost(&block, 4000));
    let most: [usize; 4] = std::array::from_fn(|kind| steps.iter().map(|step| step[kind]).max().unwrap_or(0));
    let usual = steps.iter().map(|step| step.iter().sum::<usize>()).min().unwrap_or(0);
    assert!((0..4).all(|kind| most[kind] <= expected[kind]), "{most:?} {expected:?}");
    // Some steps change branches, most do not.
    assert!(most.iter().sum::<usize>() > usual, "{most:?} {usual}");
}
