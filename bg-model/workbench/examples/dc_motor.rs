//! A direct-current motor that turns a flywheel through a gear.
//!
//! Look at `current`: it leaps up while the rotor stands still and falls as the motor's own voltage rises with the
//! speed. The voltage is an input and 0 unless it is given.
//!
//!     cargo run --release --example dc_motor -- --t-end 2 --input voltage=12

use bg_model::bond_graph;

bond_graph! {
    /// Electrical and rotational: the gyrator is the motor, the transformer the gear. The rotor's inertia is counted to
    /// the flywheel's (times the square of the ratio), for the rigid gear leaves one speed free.
    pub graph DcMotor {
        /// Resistance of the winding.
        param winding: Ohm = 0.8, above 0;
        /// Inductance of the winding.
        param coil: H = 2e-3, above 0;
        /// Motor constant: torque per current.
        param constant: N*m/A = 0.05, above 0;
        /// Turns of the motor for one turn of the flywheel.
        param ratio: 1 = 4, above 0;
        /// Moment of inertia of the flywheel.
        param flywheel: kg*m^2 = 0.02, above 0;
        /// Viscous resistance of the motor's bearing.
        param motor_bearing: N*m*s/rad = 2e-5, at least 0;
        /// Viscous resistance of the flywheel's bearing.
        param bearing: N*m*s/rad = 1e-3, at least 0;
        /// Voltage at the motor's terminals.
        input voltage: V;

        Se supply = voltage;
        1 armature: electrical;
        I inductance = coil;
        R resistance = winding;
        GY motor = constant;
        1 rotor: rotation;
        R rotor_bearing = motor_bearing;
        TF gear = 1 / ratio;
        1 shaft: rotation;
        I wheel = flywheel;
        R wheel_bearing = bearing;
        supply -> armature -> motor -> rotor -> gear -> shaft -> wheel;
        armature -> inductance;
        armature -> resistance;
        rotor -> rotor_bearing;
        shaft -> wheel_bearing;

        observe {
            current: A = armature.flow;
            motor_speed: rad/s = rotor.flow;
            speed: rad/s = shaft.flow;
            stored: J = stored_energy;
            supplied: J = integral(supplied_power);
            dissipated: J = integral(dissipated_power);
        }
    }
}

fn main() -> std::process::ExitCode {
    bg_workbench::main::<DcMotor>()
}
