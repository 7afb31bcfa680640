//! A block that a spring draws to and fro on a slide, under a contact that resists the two directions differently.
//!
//! Look at `v` and `force_x`: where the velocity changes its sign, the resistance switches between `cut` and `back`,
//! and the force has a kink. Each switching is an event, found to rounding; the summary counts them.
//!
//!     cargo run --release --example contact -- --t-end 3 --set cut=8

use bg_model::bond_graph;

bond_graph! {
    /// All forces act along the slide's axis, so that the motion is that of one mass exactly.
    pub graph SlidingBlock {
        /// Mass of the block.
        param mass: kg = 1, above 0;
        /// Stiffness of the spring.
        param stiffness: N/m = 100, above 0;
        /// Resistance of the contact against the block's motion along -x.
        param cut: N*s/m = 5, at least 0;
        /// Resistance of the contact against the block's motion along +x.
        param back: N*s/m = 1, at least 0;
        /// Stiffness of the contact across the slide.
        param aside: N/m = 50, above 0;
        ground { point O = [0, 0, 0]; point anchor = [-3, 0, 0]; point work = [0.5, 0, 0]; }
        body block { mass mass; inertia [0.01, 0.01, 0.01]; start at [1, 0, 0]; }
        joint slide: prismatic x (ground.O -> block) { stiffness 1e4; tilt stiffness 1e3; damping 10; tilt damping 1; }
        spring band (ground.anchor -> block) { stiffness stiffness; length 3; }
        contact saw (ground.work -> block along x) {
            x: R(v) = if v < 0 { cut * v } else { back * v };
            y: C = aside, R = 3;
            z: C = aside, R = 3;
        }
        observe {
            x: m = block.position.x;
            v: m/s = saw.speed;
            force: N = saw.force;
            across: m = [0, block.position.y, block.position.z];
            stored: J = stored_energy;
            supplied: J = integral(supplied_power);
            dissipated: J = integral(dissipated_power);
        }
    }
}

fn main() -> std::process::ExitCode {
    bg_workbench::main::<SlidingBlock>()
}
