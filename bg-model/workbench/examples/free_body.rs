//! A rigid body in free rotation, in bond-graph words: a multibond junction, a tensor that turns with the body.
//!
//! Look at `w` and `h`: the angular velocity changes, the angular momentum does not, for the tensor of inertia turns
//! with the body. `R` is the rotation matrix; its columns are the body's axes.
//!
//!     cargo run --release --example free_body -- --t-end 30

use bg_model::bond_graph;

bond_graph! {
    /// No torque acts: the angular momentum stays where it is while the body tumbles around it.
    pub graph FreeBody {
        /// Least principal moment of inertia.
        param least: kg*m^2 = 1, above 0;
        /// Middle principal moment of inertia.
        param middle: kg*m^2 = 2, above 0;
        /// Greatest principal moment of inertia.
        param greatest: kg*m^2 = 2.5, above 0;
        1 rotation[3]: rotation;
        orientation attitude of rotation start rotation_x(0.3) * rotation_z(0.2);
        I tensor = diagonal([least, middle, greatest]) in attitude start [1.2, 2.9, 0.4];
        rotation -> tensor;
        observe { R = attitude; w: rad/s = rotation.flow; h: kg*m^2/s = tensor.p; stored: J = stored_energy; }
    }
}

fn main() -> std::process::ExitCode {
    bg_workbench::main::<FreeBody>()
}
