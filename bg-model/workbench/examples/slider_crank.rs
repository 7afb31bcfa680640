//! A slider-crank: crank, connecting rod and slider with compliant pins and slide.
//!
//! A closed loop of three bodies. Look at `slider_x`, and at `slider_y`, by how much the slide gives. The scene
//! `planar-slider-crank` has the same outputs from 20 states in place of 56, the scene `rigid-slider-crank` pins that
//! do not give; `compare literal rigid-slider-crank` says how far they are apart.
//!
//!     cargo run --release --example slider_crank -- --t-end 2 --scene planar-slider-crank

use bg_model::bond_graph;

bond_graph! {
    /// The crank with its flywheel turns about the ground's point O, the slider slides on the x axis through O.
    pub graph SliderCrank {
        /// Torque on the crank about z.
        param torque: N*m = 3;
        /// Crank angle at the start, from the x axis.
        param crank_angle: rad = 0.4;
        /// Length of the crank between its pins.
        param crank_length: m = 0.1, above 0;
        /// Length of the rod between its pins.
        param rod_length: m = 0.35, above 0;
        /// Stiffness of all pins and of the slide.
        param stiffness: N/m = 5e5, above 0;
        /// Damping of all pins and of the slide.
        param damping: N*s/m = 200, at least 0;
        /// Stiffness of the held rotations.
        param tilt_stiffness: N*m/rad = 1e3, above 0;
        /// Damping of the held rotations.
        param tilt_damping: N*m*s/rad = 1, at least 0;

        gravity [0, -9.81, 0];
        ground { point O = [0, 0, 0]; }
        body crank {
            cuboid [crank_length, 0.03, 0.02] density 7850;
            cylinder radius 0.12 length 0.02 along z at [-crank_length / 2, 0, 0] density 7850;
            point O = [-crank_length / 2, 0, 0];
            point A = [crank_length / 2, 0, 0];
            start O at [0, 0, 0];
            start turned rotation_z(crank_angle);
        }
        body rod {
            cuboid [rod_length, 0.02, 0.02] density 2700;
            point A = [-rod_length / 2, 0, 0];
            point B = [rod_length / 2, 0, 0];
            start A at [crank_length * cos(crank_angle), crank_length * sin(crank_angle), 0];
            start turned rotation_z(guess(-0.1));
        }
        body slider {
            cuboid [0.06, 0.05, 0.04] density 7850;
            start at [guess(0.44), 0, 0];
        }
        joint pin_o: revolute z (ground.O -> crank.O) {
            stiffness stiffness; damping damping; tilt stiffness tilt_stiffness; tilt damping tilt_damping;
        }
        joint pin_a: revolute z (crank.A -> rod.A) {
            stiffness stiffness; damping damping; tilt stiffness tilt_stiffness; tilt damping tilt_damping;
        }
        joint pin_b: revolute z (rod.B -> slider) {
            stiffness stiffness; damping damping; tilt stiffness tilt_stiffness; tilt damping tilt_damping;
        }
        joint slide: prismatic x (ground.O -> slider) {
            stiffness stiffness; damping damping; tilt stiffness tilt_stiffness; tilt damping tilt_damping;
        }
        drive motor on pin_o torque = torque;

        observe {
            angle: rad = crank.direction;
            speed: rad/s = pin_o.speed;
            rod_angle: rad = rod.direction;
            slider_x: m = slider.position.x;
            slider_y: m = slider.position.y;
            travel: m = slide.travel;
            stored: J = stored_energy;
            supplied: J = integral(supplied_power);
            dissipated: J = integral(dissipated_power);
        }

        /// The motion in the plane, with all that the three-dimensional description observes.
        scene PlanarSliderCrank {
            expect planar;
            expect states = 18;
        }
        /// Links on pins and a slide that do not give.
        scene RigidSliderCrank {
            rigid joints;
            observe {
                angle: rad = crank.direction;
                speed: rad/s = pin_o.speed;
                rod_angle: rad = rod.direction;
                slider_x: m = slider.position.x;
                slider_y: m = slider.position.y;
                gap_o: m = norm(pin_o.gap);
                gap_a: m = norm(pin_a.gap);
                gap_b: m = norm(pin_b.gap);
                stored: J = stored_energy;
                supplied: J = integral(supplied_power);
            }
            tune { torque, crank_angle, crank_length, rod_length }
            expect planar;
            expect states = 6;
        }
    }
}

fn main() -> std::process::ExitCode {
    bg_workbench::main::<SliderCrank>()
}
