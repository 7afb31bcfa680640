//! Friction and stops as words: a swing that comes to rest in its journal, a carriage between the ends of its guide.

use bg_model::bond_graph;

bond_graph! {
    /// A rod on a compliant pin, whose force presses on the journal.
    pub graph Journal {
        param angle: rad = -0.4;
        /// Coefficient of friction while it slides, and at rest.
        param grip: 1 = 0.2, at least 0;
        param still: 1 = 0.3, at least 0;
        gravity [0, -9.81, 0];
        ground { point pivot = [0, 0, 0]; }
        body rod {
            mass 2; inertia [0.1, 0.1, 0.1]; point end = [-0.5, 0, 0];
            start end at [0, 0, 0]; start turned rotation_z(angle);
        }
        joint pin: revolute z (ground.pivot -> rod.end) { stiffness 3e3; damping 20; tilt stiffness 1e3;
            tilt damping 1; }
        friction seat on pin { coulomb grip; static still; viscous 1e-3; radius 0.1; }
        observe {
            angle: rad = pin.angle; speed: rad/s = pin.speed; seat.effort; force: N = norm(pin.force);
            stored: J = stored_energy; supplied: J = integral(supplied_power);
            dissipated: J = integral(dissipated_power)
        }
    }
    /// A carriage with a load that rubs on it, on a guide with ends.
    pub graph Carriage {
        param speed: m/s = 2;
        param grip: N = 3, at least 0;
        ground { point middle = [0, 0, 0]; }
        body carriage { mass 3; inertia [0.1, 0.1, 0.1]; start velocity [speed, 0, 0]; }
        body load { mass 1; inertia [0.1, 0.1, 0.1]; }
        joint guide: prismatic x (ground.middle -> carriage) { stiffness 100; damping 10; tilt stiffness 10;
            tilt damping 1; }
        joint rail: prismatic x (carriage -> load) { stiffness 100; damping 10; tilt stiffness 10; tilt damping 1; }
        friction rub on guide { coulomb 1; }
        friction hold on rail { coulomb grip; }
        stop end on guide { at most 0.2; at least -0.1; stiffness 200; damping 5; }
        observe {
            x: m = guide.travel; v: m/s = carriage.velocity.x; u: m/s = load.velocity.x; end.effort; hold.effort;
            stored: J = stored_energy; supplied: J = integral(supplied_power);
            dissipated: J = integral(dissipated_power)
        }
    }
}
