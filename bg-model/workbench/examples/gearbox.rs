//! A direct-current motor, a rigid gearbox and two flywheels.
//!
//! The rotor and the flywheel turn at speeds in a fixed ratio, so only one of them has a momentum to integrate. Look at
//! `tooth`, the torque that the gearbox hands on: the compiler solves for it.
//!
//!     cargo run --release --example gearbox -- --t-end 2 --input voltage=12

use bg_model::bond_graph;

bond_graph! {
    /// Electrical and rotational, without any compliance between rotor and flywheel: the flywheel is in derivative
    /// causality.
    pub graph Gearbox {
        /// Resistance of the winding.
        param winding: Ohm = 0.8, above 0;
        /// Inductance of the winding.
        param coil: H = 2e-3, above 0;
        /// Motor constant: torque per current.
        param constant: N*m/A = 0.05, above 0;
        /// Moment of inertia of the rotor.
        param rotor: kg*m^2 = 4e-4, above 0;
        /// Turns of the motor for one turn of the flywheel.
        param ratio: 1 = 4, above 0;
        /// Moment of inertia of the flywheel.
        param flywheel: kg*m^2 = 0.02, above 0;
        /// Viscous resistance of the flywheel's bearing.
        param bearing: N*m*s/rad = 1e-3, at least 0;
        /// Voltage at the motor's terminals.
        input voltage: V;

        Se supply = voltage;
        1 armature: electrical;
        I inductance = coil;
        R resistance = winding;
        GY motor = constant;
        1 shaft: rotation;
        I armature_wheel = rotor;
        TF gear = 1 / ratio;
        1 output: rotation;
        I wheel = flywheel;
        R wheel_bearing = bearing;
        supply -> armature -> motor -> shaft -> gear -> output -> wheel;
        armature -> inductance;
        armature -> resistance;
        shaft -> armature_wheel;
        output -> wheel_bearing;

        observe {
            current: A = armature.flow;
            motor_speed: rad/s = shaft.flow;
            speed: rad/s = output.flow;
            tooth: N*m = wheel.effort;
            momentum: kg*m^2/s = wheel.p;
            stored: J = stored_energy;
            supplied: J = integral(supplied_power);
            dissipated: J = integral(dissipated_power);
        }
    }
}

fn main() -> std::process::ExitCode {
    bg_workbench::main::<Gearbox>()
}
