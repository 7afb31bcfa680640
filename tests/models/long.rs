//! Models whose functions are long, so that generated code has them in parts: one with branches, one whose parts repeat
//! themselves.

use bg_model::bond_graph;

bond_graph! {
    /// A rod of 1 m.
    part Rod {
        param place: m = 0;
        /// Speed at which all rods turn about the y axis at the start.
        param spin: rad/s = 2;
        body rod {
            mass 1; inertia [0.05, 0.1, 0.1]; point foot = [-0.5, 0, 0]; point head = [0.5, 0, 0];
            start foot at [place, 0, 0]; start spin [0, spin, 0]; start velocity [0, 0, -spin * (place + 0.5)];
        }
    }

    /// Three rods on rigid hinges, two about y and one about z: a motor that reverses turns the first one, a brake
    /// holds the last one.
    pub graph Whip {
        param torque: N*m = 20;
        param grip: N*m = 0.2, at least 0;
        gravity [0, -9.81, 0];
        ground { point O = [0, 0, 0]; }
        part link[i in 0..3]: Rod { place = i; }
        joint shoulder: revolute y (ground.O -> link[0].rod.foot) { rigid; }
        joint second: revolute z (link[0].rod.head -> link[1].rod.foot) { rigid; }
        joint last: revolute y (link[1].rod.head -> link[2].rod.foot) { rigid; }
        drive motor on shoulder torque = if shoulder.angle > 0.3 { -torque } else { torque };
        friction brake on last { coulomb grip; }
        observe {
            tip: m = link[2].rod.head.position; gap: m = last.gap;
            stored: J = stored_energy; supplied: J = integral(supplied_power);
            dissipated: J = integral(dissipated_power)
        }
    }
}

bond_graph! {
    /// A rod of 1 m in a rope.
    part Strand {
        param place: m = 0;
        body rod {
            mass 1; inertia [0.05, 0.1, 0.1]; point foot = [-0.5, 0, 0]; point head = [0.5, 0, 0];
            start foot at [place, 0, 0]; start spin [0.5, 0.2 * place, 0.3];
        }
    }

    /// Twelve rods on compliant hinges.
    pub graph Rope {
        param stiffness: N/m = 1e4, above 0;
        gravity [0, -9.81, 0];
        ground { point O = [0, 0, 0]; }
        part link[i in 0..12]: Strand { place = i; }
        joint first: revolute z (ground.O -> link[0].rod.foot) { stiffness stiffness; damping 10; tilt stiffness 1e3;
            tilt damping 1; }
        joint pin[i in 1..12]: revolute z (link[i - 1].rod.head -> link[i].rod.foot) {
            stiffness stiffness; damping 10; tilt stiffness 1e3; tilt damping 1;
        }
        observe {
            tip: m = link[11].rod.head.position;
            stored: J = stored_energy; supplied: J = integral(supplied_power);
            dissipated: J = integral(dissipated_power)
        }
    }
}
