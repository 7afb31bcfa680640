//! A pendulum on a compliant pin, and the force in the pin.
//!
//! Look at `force_y`: at the lowest place the pin bears more than three times what the rod weighs. `lost` is what the
//! pin's damping takes.
//!
//!     cargo run --release --example pendulum -- --t-end 2 --set length=0.8

use bg_model::bond_graph;

bond_graph! {
    /// A steel rod that swings about a pin.
    pub graph Pendulum {
        /// Angle at the start, from the horizontal.
        param angle: rad = 0.5;
        /// Length of the rod.
        param length: m = 0.6, above 0;

        gravity [0, -9.81, 0];
        ground { point pivot = [0, 1, 0]; }

        body rod {
            cuboid [length, 0.03, 0.03] density 7850;
            point end = [-length / 2, 0, 0];
            start end at [0, 1, 0];
            start turned rotation_z(angle);
        }

        joint pin: revolute z (ground.pivot -> rod.end) {
            stiffness 1e6; damping 100; tilt stiffness 1e3; tilt damping 1;
        }

        observe {
            angle: rad = rod.angle;
            force_x: N = pin.force.x;
            force_y: N = pin.force.y;
            stored: J = stored_energy;
            lost: J = integral(dissipated_power);
        }
    }
}

fn main() -> std::process::ExitCode {
    bg_workbench::main::<Pendulum>()
}
