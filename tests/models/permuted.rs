//! Two graphs, each written twice with its statements in another order.

use bg_model::bond_graph;

bond_graph! {
    /// Two masses, springs and a nonlinear damper.
    pub graph Forward {
        param mass: kg = 1.5;
        param stiffness: N/m = 90;
        Se push = 3;
        1 left: translation;
        1 right: translation;
        0 between: translation;
        1 stretch: translation;
        I a = mass;
        I b = 2 * mass start 1;
        C wall = stiffness start 0.1;
        C spring(q) = 2 * stiffness * q;
        R damper(v) = if v < 0 { 2 * v } else { 3 * v };
        push -> left -> a;
        left -> wall;
        left -> between -> right -> b;
        between -> stretch -> spring;
        stretch -> damper;
        observe { a: kg*m/s = a.p; b: kg*m/s = b.p; wall: m = wall.q; spring: m = spring.q; stored: J = stored_energy; }
    }
    /// The same, backward.
    pub graph Backward {
        observe { stored: J = stored_energy; spring: m = spring.q; wall: m = wall.q; b: kg*m/s = b.p; a: kg*m/s = a.p; }
        stretch -> damper;
        between -> stretch -> spring;
        left -> between;
        left -> wall;
        between -> right -> b;
        push -> left -> a;
        R damper(v) = if v < 0 { 2 * v } else { 3 * v };
        C spring(q) = 2 * stiffness * q;
        C wall = stiffness start 0.1;
        I b = 2 * mass start 1;
        I a = mass;
        1 stretch: translation;
        0 between: translation;
        1 right: translation;
        1 left: translation;
        Se push = 3;
        param stiffness: N/m = 90;
        param mass: kg = 1.5;
    }

    /// A pendulum of two balls, mechanism words.
    pub graph Chain {
        param stiffness: N/m = 2e3;
        gravity [0, -9.81, 0];
        ground { point O = [0, 0, 0]; }
        body first { mass 1; inertia [0.1, 0.1, 0.1]; point up = [0, 0.2, 0]; point down = [0, -0.2, 0];
            start up at [0, 0, 0]; }
        body second { mass 2; inertia [0.1, 0.2, 0.3]; point up = [0, 0.3, 0]; start up at [0, -0.4, 0];
            start velocity [1, 0, 0.3]; }
        joint upper: spherical (ground.O -> first.up) { stiffness stiffness; damping 5; }
        joint lower: revolute z (first.down -> second.up) { stiffness stiffness; damping 5; tilt stiffness 100; }
        observe { first = first.position; second = second.position; h = second.h; stored: J = stored_energy; }
    }
    /// The same, backward.
    pub graph ChainBackward {
        observe { stored: J = stored_energy; h = second.h; second = second.position; first = first.position; }
        joint lower: revolute z (first.down -> second.up) { tilt stiffness 100; damping 5; stiffness stiffness; }
        joint upper: spherical (ground.O -> first.up) { damping 5; stiffness stiffness; }
        body second { start velocity [1, 0, 0.3]; start up at [0, -0.4, 0]; point up = [0, 0.3, 0];
            inertia [0.1, 0.2, 0.3]; mass 2; }
        body first { start up at [0, 0, 0]; point down = [0, -0.2, 0]; point up = [0, 0.2, 0]; inertia [0.1, 0.1, 0.1];
            mass 1; }
        ground { point O = [0, 0, 0]; }
        gravity [0, -9.81, 0];
        param stiffness: N/m = 2e3;
    }
}
