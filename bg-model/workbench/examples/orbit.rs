//! A ball that circles a point of the ground on a spring, in three dimensions.
//!
//! Look at `position`: a circle in a plane that is tilted. At another speed the spring stretches and slackens, and the
//! path is a rosette.
//!
//!     cargo run --release --example orbit -- --t-end 10 --set speed=2

use bg_model::bond_graph;

bond_graph! {
    /// The ball starts on a circle in the plane of x and (y + z): the spring's pull is the centripetal force.
    pub graph Orbit {
        /// Radius of the ball.
        param radius: m = 0.05, above 0;
        /// Density of the ball.
        param density: kg/m^3 = 2000, above 0;
        /// Stiffness of the spring.
        param stiffness: N/m = 40, above 0;
        /// Length of the unloaded spring.
        param length: m = 0.5, at least 0;
        /// Distance from the centre at the start.
        param distance: m = 0.8, above 0;
        /// Speed at the start.
        param speed: m/s = 3;
        ground { point O = [0.1, -0.2, 0.3]; }
        body ball {
            sphere radius radius;
            density density;
            start at [0.1 + distance, -0.2, 0.3];
            start velocity [0, 0.6 * speed, 0.8 * speed];
        }
        spring band (ground.O -> ball) { stiffness stiffness; length length; }
        observe { position: m = ball.position; mass: kg = ball.linear.p.y / ball.velocity.y; stored: J = stored_energy;
            force: N = band.force; }
    }
}

fn main() -> std::process::ExitCode {
    bg_workbench::main::<Orbit>()
}
