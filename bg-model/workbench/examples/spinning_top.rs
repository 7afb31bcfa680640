//! A heavy symmetric top in three dimensions, its tip on a stiff spherical joint.
//!
//! Look at `axis`: it circles the vertical and nods a little. A slower top nods more.
//!
//!     cargo run --release --example spinning_top -- --t-end 2 --set spin=80

use bg_model::bond_graph;

bond_graph! {
    /// The top's axis is its z axis, the tip is `arm` below its centre of mass. It starts with its axis tilted from the
    /// vertical towards x, with the centre of mass circling at `precession` about the vertical and the top turning at
    /// `spin` about its own axis besides.
    pub graph SpinningTop {
        /// Mass.
        param mass: kg = 0.5, above 0;
        /// Distance of the centre of mass from the tip.
        param arm: m = 0.06, above 0;
        /// Moment of inertia about the top's axis.
        param axial: kg*m^2 = 6e-4, above 0;
        /// Moment of inertia across the axis, about the centre of mass.
        param across: kg*m^2 = 4e-4, above 0;
        /// Tilt of the axis from the vertical at the start.
        param tilt: rad = 0.5;
        /// Angular velocity about the vertical at the start.
        param precession: rad/s = 3;
        /// Angular velocity about the top's axis at the start, without the part of the precession.
        param spin: rad/s = 150;
        /// Stiffness of the tip's joint.
        param stiffness: N/m = 1e5, above 0;
        /// Gravitational acceleration, along -z.
        param gravity: m/s^2 = 9.81;

        gravity [0, 0, -gravity];
        ground { point O = [0, 0, 0]; }
        body top {
            mass mass;
            inertia [across, across, axial];
            point tip = [0, 0, -arm];
            start tip at [0, 0, 0];
            start turned rotation_y(tilt);
            start velocity [0, precession * arm * sin(tilt), 0];
            start spin [spin * sin(tilt), 0, precession + spin * cos(tilt)];
        }
        joint tip: spherical (ground.O -> top.tip) { stiffness stiffness; }

        observe {
            axis = top.z_axis;
            center: m = top.position;
            velocity: m/s = top.velocity;
            p: kg*m/s = top.momentum;
            h: kg*m^2/s = top.angular_momentum;
            w: rad/s = top.angular_velocity;
            gap: m = tip.gap;
            force: N = tip.force;
            stored: J = stored_energy;
            supplied: J = integral(supplied_power);
        }

        /// The nutation: only how upright the axis is.
        scene Nutation {
            observe { upright = top.z_axis.z; }
            tune { mass, tilt, precession, spin, gravity }
        }
        /// The top about a fixed point.
        scene FixedTip {
            rigid joints;
            observe {
                axis = top.z_axis;
                center: m = top.position;
                w: rad/s = top.angular_velocity;
                gap: m = tip.gap;
                stored: J = stored_energy;
                supplied: J = integral(supplied_power);
            }
        }
    }
}

fn main() -> std::process::ExitCode {
    bg_workbench::main::<SpinningTop>()
}
