//! Switched machines in the macro language, with events in closed form.

use std::f64::consts::PI;

use bg_model::bond_graph;
use bg_model::system::Model;

use super::case::{Case, Switched, started};

bond_graph! {
    /// A mass on a spring that slides with dry friction.
    pub graph DrySlider {
        /// Mass.
        param mass: kg = 1, above 0;
        /// Stiffness of the spring.
        param stiffness: N/m = 1, above 0;
        /// Force of the friction.
        param friction: N = 0.03, at least 0;
        /// Stretch at the start.
        param stretch: m = 1;
        1 motion: translation;
        I inertia = mass;
        C spring = stiffness start stretch;
        R rubbing(v) = if v < 0 { -friction } else { friction };
        motion -> inertia;
        motion -> spring;
        motion -> rubbing;
        observe { x: m = spring.q; v: m/s = motion.flow; }
    }

    /// A mass that falls on a spring and hops.
    pub graph Hopper {
        /// Mass.
        param mass: kg = 2, above 0;
        /// Stiffness of the spring.
        param stiffness: N/m = 200, above 0;
        /// Height at the start.
        param height: m = 0.5, above 0;
        1 motion: translation;
        I inertia = mass;
        Se weight = -9.81 * mass;
        C ground(q) = if q < 0 { stiffness * q } else { 0 * q }
            start height energy if q < 0 { 0.5 * stiffness * q * q } else { 0 * q * q };
        weight -> motion -> inertia;
        motion -> ground;
        observe { height: m = ground.q; stored: J = stored_energy; }
    }

    /// A coil behind a resistor at a square wave.
    pub graph SquareWave {
        /// Angular frequency.
        param frequency: rad/s = 3, above 0;
        /// Amplitude.
        param amplitude: V = 1;
        1 circuit: electrical;
        Se supply = if sin(frequency * t) < 0 { -amplitude } else { amplitude };
        I coil = 1;
        R wire = 1;
        supply -> circuit -> coil;
        circuit -> wire;
        observe { current: A = circuit.flow; }
    }
}

/// The model from its own start.
fn model<Mo, const N: usize, const G: usize, const M: usize>(model: Mo) -> Box<dyn Switched>
where
    Mo: Model<f64, N, G, M> + 'static,
{
    let start = model.start().expect("nothing has to close");
    started(model, start)
}

/// The slider with dry friction and these parameters.
///
/// # Panics
/// A parameter is out of range.
#[must_use]
pub fn slider(parameters: DrySliderParameters) -> Box<dyn Switched> {
    model(DrySlider::new(parameters).expect("parameters in range"))
}

/// The slider while it slides: half turns, after each of which the centre is on the other side.
#[must_use]
pub fn dry_slider() -> Case {
    Case {
        name: "dry-slider",
        source: "half turns about the centres x = +-F/k: every pi s",
        end: 15.5 * PI,
        events: (1..=15).map(|k| PI * f64::from(k)).collect(),
        amplification: 10.0,
        step: 0.1,
        problem: slider(DrySliderParameters::default()),
    }
}

/// The hopping mass: parabolas and arcs in alternation.
///
/// # Panics
/// Does not: the defaults are in range.
#[must_use]
pub fn hopper() -> Case {
    let parameters = HopperParameters::default();
    let frequency = (parameters.stiffness / parameters.mass).sqrt();
    let fall = (2.0 * parameters.height / 9.81).sqrt();
    let speed = 9.81 * fall;
    // x'' = -g - w^2 x from 0 with -v is zero again where tan(w t / 2) = -v w / g.
    let contact = 2.0 / frequency * (PI - libm::atan(speed * frequency / 9.81));
    let pauses = [contact, 2.0 * fall].into_iter().cycle();
    let events = pauses.scan(fall, |t, pause| Some(std::mem::replace(t, *t + pause)));
    Case {
        name: "hopper",
        source: "free fall and arcs of an oscillation about the rest on the spring",
        end: 10.0,
        events: events.take_while(|t| *t < 10.0).collect(),
        amplification: 10.0,
        step: 0.05,
        problem: model(Hopper::new(parameters).expect("the defaults are in range")),
    }
}

/// The square wave, whose guard depends on time only.
///
/// # Panics
/// Does not: the defaults are in range.
#[must_use]
pub fn square_wave() -> Case {
    let parameters = SquareWaveParameters::default();
    let half = PI / parameters.frequency;
    Case {
        name: "square-wave",
        source: "sin(w t) is zero at multiples of pi / w; exactly zero at the start, where it is no event",
        end: 20.0,
        events: (1..).map(|k| half * f64::from(k)).take_while(|t| *t < 20.0).collect(),
        amplification: 0.0,
        step: 0.1,
        problem: model(SquareWave::new(parameters).expect("the defaults are in range")),
    }
}
