//! The machines of the example, which the tests use as well.

use bg_model::bond_graph;

bond_graph! {
    /// A rod on a rigid pin: its orientation and the pin are held by the projection.
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
        joint pin: revolute z (ground.pivot -> rod.end) { rigid; }

        observe {
            angle: rad = rod.angle;
            force_x: N = pin.force.x;
            force_y: N = pin.force.y;
            stored: J = stored_energy;
        }
    }
}

bond_graph! {
    /// A ball that is dropped on a floor and pushed by a given force.
    pub graph Ball {
        /// Height at the start.
        param height: m = 1.25, above 0;
        /// Part of the speed that the floor gives back.
        param bounce: 1 = 0.5, at least 0, at most 1;
        /// Force upwards.
        input force: N;

        1 fall: translation;
        I ball = 2;
        Se weight = force - 19.62;
        weight -> fall -> ball;
        stop floor on fall { at least 0; start height; restitution bounce; }

        observe { height: m = floor.place; v: m/s = fall.flow; lost: J = integral(dissipated_power); }
    }
}

bond_graph! {
    /// A mass on a spring and a valve that resists more one way than the other, pushed by a given force.
    pub graph Shaker {
        /// Mass.
        param mass: kg = 2, above 0;
        /// Stiffness of the spring.
        param stiffness: N/m = 200, above 0;
        /// Stretch of the spring at the start.
        param stretch: m = 0.05;
        /// Force along the stretch.
        input force: N;

        Se push = force;
        1 motion: translation;
        I inertia = mass;
        C spring = stiffness start stretch;
        R valve(v) = if v < 0 { 12 * v } else { 4 * v + 0.3 * v * abs(v) };
        push -> motion -> inertia;
        motion -> spring;
        motion -> valve;

        observe { x: m = spring.q; v: m/s = motion.flow; stored: J = stored_energy; valve: N = valve.effort; }
    }
}
