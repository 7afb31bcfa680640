//! A run that stops at a number which is not finite says which input or law it comes from, in the words of the
//! description.

use bg_model::bond_graph;
use bg_model::capability::Named;
use bg_model::failure::Origin;
use bg_model::input::Input;
use bg_model::integrator::{Auto, Dop853, Method, Radau9, Rk4, Rodas5p};
use bg_model::nalgebra::SVector;
use bg_model::simulation::{Settings, Span, integrate};
use bg_model::system::{Model, System};

bond_graph! {
    /// A tank that runs out through an orifice; the level at rest is negative.
    graph Tank {
        param level: m^3 = 1; param capacity: m^3/Pa = 1 / 3;
        input inflow: m^3/s;
        let opening = 2 + 1 / (4 - t / 1);
        Sf pump = inflow; 0 tank: hydraulic; C air = capacity start level;
        MR orifice(effort p) = opening * sqrt(p / 1);
        R leak(effort p) = if p < 0 { 2 * p } else { 1 * p };
        MR seal(effort p) = if p < -0.5 { 1 * ln(p / 1) } else { 0.1 * p };
        pump -> tank -> air; tank -> orifice; tank -> leak; tank -> seal;
        observe { root: 1 = sqrt(-1 - tank.effort / 1) }
        scene Watched { observe { air.q } tune {} }
    }
    /// Nothing of it can fail.
    graph Mass {
        param mass: kg = 2, above 0;
        param power: 1 = 2;
        let drag: N*s^3/m^3 = pow(mass / mass, power) / mass * 1;
        1 j: translation; I m = mass; R r(v) = pow(v, 3) * drag; j -> m; j -> r;
    }
    /// Two sliders on a line: one pulls the other by a spring whose length comes to zero.
    graph Spring {
        param stiffness: N/m = 1; param length: m = 0.5;
        1 a[3]: translation; position x of a start [1, 0, 0]; I m = 1 start [-1, 0, 0];
        let distance: m = norm(x);
        1 s: translation; MTF along(v) = dot(x, v) / distance; C coil = stiffness at distance - length;
        a -> m; a -> along -> s -> coil;
        observe { x }
    }
}

/// How a run of 5 s from the start stops.
fn stopped<Sys, const N: usize, const G: usize>(
    system: &Sys,
    start: &SVector<f64, N>,
    method: &mut impl Method,
) -> String
where
    Sys: System<f64, N, G>,
{
    let span = Span { t0: 0.0, t_end: 5.0 };
    let failure = integrate(system, method, start, span, &Settings::default(), &mut ()).expect_err("it stops");
    failure.to_string()
}

fn tank(inflow: Input) -> Tank {
    Tank::new(TankParameters::default(), TankInputs { inflow }).expect("in range")
}

#[test]
fn an_input_is_named() {
    let tank = tank(Input::function(|t| if t < 0.75 { 3.0 } else { f64::NAN }));
    let start = tank.start().expect("nothing to close");
    for message in [
        stopped(&tank, &start, &mut Dop853::new()),
        stopped(&tank, &start, &mut Radau9::new()),
        stopped(&tank, &start, &mut Auto::new()),
        stopped(&tank, &start, &mut Rk4::new(0.01)),
    ] {
        assert!(message.starts_with("input `inflow` gives NaN in a step of "), "{message}");
        assert!(message.contains(" s, and so the rate of `air.q` is NaN; give it finite numbers there"), "{message}");
    }
    // By the slope that this method asks for first.
    let message = stopped(&tank, &start, &mut Rodas5p::new());
    assert!(
        message.starts_with("input `inflow` gives NaN ") && message.contains("derivative of the rate"),
        "{message}"
    );
    let at_once = stopped(&self::tank(f64::INFINITY.into()), &start, &mut Dop853::new());
    assert!(at_once.starts_with("input `inflow` gives inf at t = 0.0 s, and so the rate of `air.q`"), "{at_once}");
}

#[test]
fn the_law_is_named_that_a_number_is_not_finite_by() {
    // It runs empty: the root is of what comes next below zero.
    let model = tank((-1.0).into());
    let start = model.start().expect("nothing to close");
    for message in [
        stopped(&model, &start, &mut Dop853::new()),
        stopped(&model, &start, &mut Auto::new()),
        stopped(&model, &start, &mut Rk4::new(0.01)),
    ] {
        assert!(message.starts_with("MR `orifice` gives NaN in a step of "), "{message}");
        let action = "keep what its law divides by, or takes a root, power or logarithm of, in range";
        assert!(message.ends_with(&format!(", and so the rate of `air.q` is NaN; {action}")), "{message}");
    }
    let scene = Watched::new(WatchedParameters {}, WatchedInputs { inflow: (-1.0).into() }).expect("in range");
    let message = stopped(&scene, &start, &mut Dop853::new());
    assert!(message.starts_with("MR `orifice` gives NaN"), "{message}");
    // By way of a `let`, at a time.
    let model = tank(30.0.into());
    let origin = origin(&model, 4.0, &start, &[false; Tank::SWITCHES]).expect("a quotient by zero");
    assert_eq!((origin.kind, origin.name, origin.value.is_infinite()), ("MR", "orifice", true));
}

/// What is not finite, as the model names it.
fn origin<const N: usize, const G: usize>(
    of: &impl System<f64, N, G>,
    t: f64,
    x: &SVector<f64, N>,
    negative: &[bool; G],
) -> Option<Origin> {
    of.named()?.not_finite(t, x, negative)
}

#[test]
fn the_first_law_is_named_and_none_in_the_other_branch() {
    let model = tank(1.0.into());
    let empty = SVector::from([-1.0]);
    let name = |negative| origin(&model, 0.0, &empty, &negative).map(|origin| origin.name);
    // A law in its other branch takes no logarithm, and no output counts.
    assert_eq!(name([false, false]), Some("orifice"));
    let full = SVector::from([1.0]);
    for negative in [[false, false], [true, true]] {
        assert_eq!(origin(&model, 0.0, &full, &negative), None);
    }
}

#[test]
fn a_spring_of_no_length_is_named() {
    let model = Spring::new(SpringParameters::default()).expect("in range");
    let start = model.start().expect("nothing to close");
    let at_zero = SVector::from_fn(|k, _| if start[k] == 1.0 { 0.0 } else { start[k] });
    let message = stopped(&model, &at_zero, &mut Dop853::new());
    assert!(message.starts_with("MTF `along` gives NaN at t = 0.0 s, and so the rate of `m.p_x` is NaN"), "{message}");
}

#[test]
fn a_model_without_such_laws_knows_of_none() {
    let model = Mass::new(MassParameters::default()).expect("in range");
    let start = model.start().expect("nothing to close");
    assert_eq!(origin(&model, 0.0, &start.map(|_| f64::NAN), &[]), None);
    let message = stopped(&model, &start.map(|_| f64::MAX), &mut Dop853::new());
    assert!(message.starts_with("the rate of `m.p` is "), "{message}");
}

bond_graph! {
    /// A sign that changes with what it moves: in neither branch the guard keeps its sign.
    graph Relay {
        param level: m/s = 0.5;
        1 j: translation; I m = 1 start 1; let side: N = if j.flow >= level { 1 } else { -1 }; MSe f = -1 * side;
        f -> j -> m;
        R friction(v) = if v > 3 { sqrt(3 - v / 1) * v } else { 1 * v }; j -> friction;
    }
    graph Valve {
        1 j: translation; I m = 1 start 1; R r(v) = if ln(v / 1) < -1 { 2 * v } else { 3 * v }; j -> m; j -> r;
    }
}

#[test]
fn a_switch_is_named_by_its_comparison_and_its_law() {
    let relay = Relay::new(RelayParameters::default()).expect("in range");
    let names: Vec<&str> = relay.description().switches.iter().map(|switch| switch.name).collect();
    let elements: Vec<&str> = relay.description().switches.iter().map(|switch| switch.element).collect();
    let side = elements.iter().position(|element| *element == "side").expect("a switch of the let");
    assert_eq!(names[side], "`if j.flow >= level` of `side`");
    assert_eq!(names[1 - side], "`if v > 3` of `friction`");
    assert_eq!(relay.named().and_then(|named| named.switch_name(side)), Some(names[side]));
    let start = relay.start().expect("nothing to close");
    let message = stopped(&relay, &start, &mut Dop853::new());
    assert!(message.starts_with("`if j.flow >= level` of `side` changes its branch without end at t = "), "{message}");

    let valve = Valve::new(ValveParameters {}).expect("no parameters");
    let message = stopped(&valve, &SVector::from([-1.0]), &mut Dop853::new());
    assert_eq!(message, "the guard of `if ln(v / 1) < -1` of `r` is NaN at t = 0.0 s");
}
