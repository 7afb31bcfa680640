//! A geared motor, observed: the bond graph has the corrections as sources, which measurements modulate.
//!
//! In: voltage, measured current and measured speed of the rotor, a thousand times a second. Out: all states, among
//! them the twist of the shaft, the speed of the load and the torque that acts on it, which nothing measures. No `std`:
//! the same lines run on a controller and on a desktop.

#![no_std]

mod bench;
#[cfg(target_os = "none")]
pub mod board;
mod estimator;
mod fault;
mod methods;

use core::fmt::Write;

use bg_model::bond_graph;
use bg_model::scalar::Scalar;

pub use bench::{Bench, Measured};
pub use estimator::Estimator;
pub use fault::Fault;
pub use methods::methods;

/// Samples in a second.
pub const RATE: f64 = 1000.0;

bond_graph! {
    /// A direct-current motor that turns a load through a gear and a shaft that twists. The effort of each correction
    /// is a gain times what a measurement differs from the model: a Luenberger observer, written as a bond graph.
    pub graph Drive {
        /// Resistance of the winding.
        param winding: Ohm = 0.8, above 0;
        /// Inductance of the winding.
        param coil: H = 2e-3, above 0;
        /// Torque for one ampere.
        param constant: N*m/A = 0.05, above 0;
        /// Inertia of the rotor.
        param rotor: kg*m^2 = 2e-5, above 0;
        /// Turns of the rotor for one turn of the shaft.
        param ratio: 1 = 20, above 0;
        /// Torque for one radian of twist.
        param stiffness: N*m/rad = 50, above 0;
        /// Damping of the shaft.
        param shaft_damping: N*m*s/rad = 0.1, at least 0;
        /// Inertia of the load.
        param load: kg*m^2 = 0.02, above 0;
        /// Dry friction of the load.
        param dry: N*m = 0.3, at least 0;
        /// Viscous friction of the load.
        param viscous: N*m*s/rad = 0.05, at least 0;
        /// Torque of a weight on the load.
        param weight: N*m = 0;
        /// Volts for one ampere that the measured current differs.
        param current_gain: Ohm = 2, at least 0;
        /// Torque for one rad/s that the measured speed differs.
        param speed_gain: N*m*s/rad = 4e-3, at least 0;
        /// Torque on the load for one radian by which the measured rotor has turned further.
        param torque_gain: N*m/rad = 1, above 0;
        /// Voltage at the terminals.
        input voltage: V;
        /// Measured current.
        input current: A;
        /// Measured speed of the rotor.
        input speed: rad/s;

        1 armature: electrical;
        Se supply = voltage;
        I inductance = coil;
        R resistance = winding;
        MSe current_correction = current_gain * (current - armature.flow);
        GY motor = constant;
        1 shaft_in: rotation;
        I inertia = rotor;
        MSe speed_correction = speed_gain * (speed - shaft_in.flow);
        TF gear = 1 / ratio;
        0 shaft: rotation;
        1 twist: rotation;
        C spring = stiffness;
        R damper = shaft_damping;
        1 wheel: rotation;
        I mass = load;
        Se hanging = -weight;
        R bearing(w) = viscous * w + dry * tanh(w / 0.05);

        MSf difference = speed - shaft_in.flow;
        C unknown = torque_gain;
        MSe torque_correction = unknown.effort;

        supply -> armature -> inductance;
        armature -> resistance;
        current_correction -> armature -> motor -> shaft_in -> inertia;
        speed_correction -> shaft_in -> gear -> shaft -> wheel -> mass;
        shaft -> twist -> spring;
        twist -> damper;
        hanging -> wheel -> bearing;
        difference -> unknown;
        torque_correction -> wheel;

        observe {
            current: A = armature.flow;
            rotor_speed: rad/s = shaft_in.flow;
            twist: rad = spring.q;
            load_speed: rad/s = wheel.flow;
            unknown_torque: N*m = unknown.effort;
        }

        /// The machine itself, which nothing corrects.
        scene Machine {
            without { current_correction, speed_correction, torque_correction, difference, unknown }
            observe {
                current: A = armature.flow;
                rotor_speed: rad/s = shaft_in.flow;
                load_speed: rad/s = wheel.flow;
            }
            tune { weight }
        }
    }
}

/// Runs `samples` samples of the bench with an observer that calculates in `S`. Writes the bits of its states after
/// every tenth part of them: the sample, then each state as the 64 bits of its `f64`. What an observer does with a
/// sample is called through `around`, which may time it.
///
/// # Errors
/// Parameters that cannot be, numbers that are not finite, a place that takes no text.
pub fn report<S: Scalar<Switch = bool>>(
    out: &mut impl Write,
    samples: u32,
    mut around: impl FnMut(&mut dyn FnMut()),
) -> Result<(), Fault> {
    let (mut bench, mut estimator) = (Bench::new()?, Estimator::<S>::new(DriveParameters::default())?);
    for sample in 1..=samples {
        let measured = bench.sample()?;
        let mut outcome = Ok(());
        around(&mut || outcome = estimator.sample(&measured));
        outcome?;
        if sample % (samples / 10).max(1) == 0 {
            write!(out, "{sample:5}")?;
            for state in estimator.state() {
                write!(out, " {:016x}", state.to_f64().to_bits())?;
            }
            writeln!(out)?;
        }
    }
    Ok(())
}
