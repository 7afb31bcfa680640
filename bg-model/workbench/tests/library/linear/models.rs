//! The models of the tests.

use bg_model::bond_graph;

bond_graph! {
    /// A mass on a spring and a damper, hanging in gravity, pushed by a force.
    pub graph Oscillator {
        param mass: kg = 2, above 0;
        param stiffness: N/m = 200, above 0;
        param damping: N*s/m = 4, at least 0;
        input force: N;
        1 motion: translation;
        I inertia = mass; C spring = stiffness; R damper = damping; Se push = force; Se weight = 9.81 * mass;
        push -> motion -> inertia; weight -> motion; motion -> spring; motion -> damper;
        observe {
            x: m = spring.q; v: m/s = motion.flow; lost: J = integral(dissipated_power);
            rest: N = push.effort - damper.effort;
        }
    }
    /// Two shafts and a clutch that comes to stick; the second one has a brake.
    pub graph Clutch {
        param drag: N*m*s = 1;
        1 first, second: rotation; I rotor = 1.5 start 15; I wheel = 4.6; R brake = drag;
        0 between: rotation; 1 slip: rotation; R rub(w) = 10 holds 12;
        first -> rotor; first -> between -> second; between -> slip -> rub; second -> wheel; second -> brake;
        observe { w: rad/s = first.flow; u: rad/s = second.flow; rub.effort }
    }
    /// A plate on a spring, drawn by another one at a distance of `size` by a force with a pole there.
    pub graph Plates {
        param size: m = 1, above 0;
        param at: 1 = 0;
        param stiffness: N/m = 3, above 0;
        body plate { mass 1; inertia [1, 1, 1]; start at [at * size, 0, 0]; }
        joint guide: prismatic x (ground -> plate) { rigid; }
        R air = 0.2; guide.slide -> air;
        let way: 1 = guide.travel / size;
        drive draw on guide force = size * stiffness * (0.12 / ((1 - way) * (1 - way)) - way);
        observe { way: 1 = way }
    }
    /// A rod that swings about a pin.
    pub graph Rod {
        param angle: rad = 0.5;
        param length: m = 0.6, above 0;
        param stiffness: N/m = 1e6, above 0;
        gravity [0, -9.81, 0];
        ground { point pivot = [0, 1, 0]; }
        body rod {
            mass 2; inertia [1e-4, 2 * length * length / 12, 2 * length * length / 12];
            point end = [-length / 2, 0, 0];
            start end at [0, 1, 0]; start turned rotation_z(angle);
        }
        joint pin: revolute z (ground.pivot -> rod.end) {
            stiffness stiffness; damping 100; tilt stiffness 1e3; tilt damping 1;
        }
        observe { angle: rad = rod.angle; pin.force; pull: N = norm(pin.force); lost: J = integral(dissipated_power) }
        /// In the plane.
        scene Swing {
            observe { angle: rad = rod.angle; force: N = pin.force.y }
            tune { angle, length, stiffness }
            expect planar;
        }
        /// In the plane, the orientation an angle.
        scene SwingAngle { observe { angle: rad = rod.angle } tune { angle, length, stiffness } angles; expect planar; }
        /// On a pin that does not give.
        scene Ideal { rigid joints; observe { angle: rad = rod.angle; force: N = pin.force.y } tune { angle, length } }
        /// Neither does this, in space.
        scene IdealInSpace { rigid joints; }
    }
    /// A rod whose held rotations are states, pushed aside by a spring.
    pub graph Tilted {
        param angle: rad = -1.2;
        gravity [0, -9.81, 0];
        ground { point pivot = [0, 0, 0]; point wall = [0.6, 0.1, 0.4]; }
        body rod {
            mass 2; inertia [0.01, 0.06, 0.06];
            point end = [-0.3, 0, 0]; point tip = [0.3, 0, 0];
            start end at [0, 0, 0]; start turned rotation_z(angle);
        }
        joint pin: revolute z (ground.pivot -> rod.end) {
            stiffness 1e4; damping 10; tilt stiffness 50; tilt damping 1; frame inertial;
        }
        spring aside (ground.wall -> rod.tip) { stiffness 30; }
        observe { rod.position; pin.moment }
    }
    /// A rod on a pin with a torsion spring, whose twist is a state of its own.
    pub graph Twisted {
        param angle: rad = 0.4;
        gravity [0, -9.81, 0];
        ground { point pivot = [0, 0, 0]; }
        body rod {
            mass 2; inertia [1e-3, 0.06, 0.06];
            point end = [-0.3, 0, 0];
            start end at [0, 0, 0]; start turned rotation_z(angle);
        }
        joint pin: revolute z (ground.pivot -> rod.end) { stiffness 1e6; damping 50; tilt stiffness 1e3;
            tilt damping 1; }
        C twist(q) = 9 * q;
        pin.spin -> twist;
        observe { angle: rad = rod.angle; twist: rad = twist.q }
        scene TwistedPlane { expect planar; }
    }
    /// Two rods, one below the other, at angles from the downward vertical.
    pub graph Double {
        param upper_angle: rad = 0.7;
        param lower_angle: rad = -0.4;
        gravity [0, -9.81, 0];
        ground { point O = [0, 0, 0]; }
        body upper {
            mass 1.2; inertia [0.025, 1e-4, 0.025];
            point top = [0, 0.25, 0]; point bottom = [0, -0.25, 0];
            start top at [0, 0, 0]; start turned rotation_z(upper_angle);
        }
        body lower {
            mass 0.8; inertia [0.032666666666666667, 1e-4, 0.032666666666666667];
            point top = [0, 0.35, 0];
            start top at [0.5 * sin(upper_angle), -0.5 * cos(upper_angle), 0]; start turned rotation_z(lower_angle);
        }
        joint shoulder: revolute z (ground.O -> upper.top) { stiffness 1e7; tilt stiffness 1e3; }
        joint elbow: revolute z (upper.bottom -> lower.top) { stiffness 1e7; tilt stiffness 1e3; }
        observe { upper: rad = shoulder.angle; elbow: rad = elbow.angle }
        scenes only;
        scene DoubleIdeal { rigid joints; expect planar; expect independent speeds; }
        scene DoubleWithAll { rigid joints; all reactions; expect planar; }
        scene DoublePlane { expect planar; }
    }
    /// A motor with a flywheel.
    pub graph Motor {
        param winding: Ohm = 0.8, above 0;
        param coil: H = 2e-3, above 0;
        param constant: N*m/A = 0.05;
        param rotor: kg*m^2 = 1e-3, above 0;
        param bearing: N*m*s/rad = 1e-3;
        input voltage: V;
        Se supply = voltage;
        1 armature; I L = coil; R Ra = winding; GY motor = constant;
        1 shaft; I J = rotor; R friction = bearing;
        supply -> armature -> L; armature -> Ra; armature -> motor -> shaft -> J; shaft -> friction;
        observe { current: A = armature.flow; speed: rad/s = shaft.flow }
    }
    /// A motor on a disc in a bearing, in space.
    pub graph Turntable {
        input voltage: V;
        gravity [0, -9.81, 0];
        ground { point O = [0, 0, 0]; }
        body disc { mass 3; inertia [0.01, 0.01, 0.02]; }
        joint pin: revolute z (ground.O -> disc) { stiffness 1e5; damping 200; tilt stiffness 1e3; tilt damping 5; }
        Se supply = voltage; 1 armature; R Ra = 2; I coil = 1e-3; GY motor = 0.2; R bearing = 0.01;
        supply -> armature -> Ra; armature -> coil; armature -> motor -> pin.spin -> bearing;
        observe { current: A = armature.flow; speed: rad/s = pin.speed; shift: m/s = norm(disc.velocity) }
        scene Flat { observe { speed: rad/s = pin.speed } expect planar; }
    }
    /// A series circuit of resistor, coil and capacitor.
    pub graph Circuit {
        param resistance: Ohm = 10;
        param inductance: H = 0.05, above 0;
        param capacitance: F = 2e-5, above 0;
        input voltage: V;
        Se source = voltage; 1 circuit: electrical; R r = resistance; I coil = inductance; C capacitor = capacitance;
        source -> circuit -> r; circuit -> coil; circuit -> capacitor;
        observe { current: A = circuit.flow; capacitor_voltage: V = capacitor.effort; coil_voltage: V = coil.effort }
    }
    /// A resistor and a capacitor: of first order, without a momentum.
    pub graph Filter {
        input voltage: V;
        Se source = voltage; 1 wire: electrical; R r = 1e3;
        0 node: electrical; C c(q) = q / 1e-6; R leak(effort e) = e / 4e3;
        source -> wire -> r; wire -> node -> c; node -> leak;
        observe { voltage: V = node.effort }
    }
    /// Two masses between three springs, with a force on each.
    pub graph Pair {
        input first: N;
        input second: N;
        param changing: N = 0;
        1 left: translation; 1 right: translation; 0 between: translation; 1 stretch: translation;
        I m1 = 1; I m2 = 3; C wall(q) = 100 * q; C link(q) = 50 * q; C end(q) = 200 * q; R damper = 2;
        Se f1 = first + changing * sin(t / 1); Se f2 = 2 * second;
        f1 -> left -> m1; f2 -> right -> m2; left -> wall; right -> end;
        left -> between -> right; between -> stretch -> link; stretch -> damper;
        observe { x1: m = wall.q; force: N = damper.effort + first }
    }
    /// A mass whose place is stored three times: in two springs, and as a position.
    pub graph Thrice {
        1 motion[3]: translation;
        I m = 2; C a(q) = 30 * q start [0.1, 0, 0] energy 15 * dot(q, q);
        C b(q) = 42 * q energy 21 * dot(q, q); Se pull = [5, 0, 0];
        pull -> motion -> m; motion -> a; motion -> b;
        position place of motion;
        observe { place }
    }
    /// A mass drawn through oil by a spring whose end moves at a given speed.
    pub graph Drawn {
        input speed: m/s;
        1 hand: translation; Sf pull = speed; 0 tie: translation; C spring(q) = 80 * q;
        1 mass: translation; I m = 2; R oil = 16;
        pull -> hand -> tie -> spring; tie -> mass -> m; mass -> oil;
        observe { force: N = spring.effort; v: m/s = mass.flow }
    }
    /// A gear that is a residual sink without a gap, between a shaft on a spring and a wheel on another, under a
    /// torque.
    pub graph Geared {
        1 shaft: rotation; I J1 = 0.1; C s1(q) = 20 * q start 0.3; Se torque = 4;
        TF gear = 2; 0 tie: rotation; rSe rigid = 0; 1 wheel: rotation; I J2 = 0.5; C s2(q) = 7 * q; R r = 0.1;
        torque -> shaft -> J1; shaft -> s1; shaft -> gear -> tie -> wheel; rigid -> tie;
        wheel -> J2; wheel -> s2; wheel -> r;
        observe { angle: rad = s1.q; other: rad = s2.q }
    }
    /// A body that nothing holds.
    pub graph Falling {
        gravity [0, -9.81, 0];
        body stone { mass 2; inertia [0.1, 0.2, 0.3]; }
        observe { stone.position }
    }
    /// A tank that is filled and has no outlet.
    pub graph Filled {
        Sf pump = 2e-4; 0 node: hydraulic; C tank(q) = 1e9 * q; pump -> node -> tank;
        observe { pressure: Pa = node.effort }
    }
    /// A tank that is filled, whose pressure opens a valve elsewhere.
    pub graph Overflowing {
        Sf pump = 2e-4; 0 node: hydraulic; C tank(q) = 1e9 * q; pump -> node -> tank;
        Se supply = 1e5; 1 pipe: hydraulic; R valve = 1e9; I oil = 1e7; Se back = 1;
        MTF opening = 1 + node.effort / 1e6;
        supply -> pipe -> oil; pipe -> valve; pipe -> opening -> end; 1 end: hydraulic; back -> end;
        observe { pressure: Pa = node.effort }
    }
    /// A tank that empties through a sharp orifice.
    pub graph Sharp {
        0 node: hydraulic; C tank(q) = 1e9 * q; R orifice(effort p) = 1e-6 * sqrt(p); node -> tank; node -> orifice;
        observe { pressure: Pa = node.effort }
    }
    /// A slider-crank that its own weight moves, with rigid joints in a scene.
    pub graph Crank {
        param load: N = 0;
        gravity [0, -9.81, 0];
        ground { point O = [0, 0, 0]; }
        body crank { mass 1; inertia [1e-3, 1e-3, 2e-3]; point A = [0.1, 0, 0]; start turned rotation_z(2.1); }
        body rod {
            mass 0.5; inertia [1e-4, 4e-3, 4e-3]; point A = [-0.15, 0, 0]; point B = [0.15, 0, 0];
            start A at [0.1 * cos(2.1), 0.1 * sin(2.1), 0]; start turned rotation_z(guess(-0.3));
        }
        body slider { mass 0.8; inertia [1e-3, 1e-3, 1e-3]; start at [guess(0.25), 0, 0]; }
        joint pin_o: revolute z (ground.O -> crank) { stiffness 1e6; damping 1e3; tilt stiffness 1e4; tilt damping 10; }
        joint pin_a: revolute z (crank.A -> rod.A) { stiffness 1e6; damping 1e3; tilt stiffness 1e4; tilt damping 10; }
        joint pin_b: revolute z (rod.B -> slider) { stiffness 1e6; damping 1e3; tilt stiffness 1e4; tilt damping 10; }
        joint slide: prismatic x (ground.O -> slider) {
            stiffness 1e6; damping 1e3; tilt stiffness 1e4; tilt damping 10;
        }
        drive push on slider force = [load, 0, 0];
        observe { angle: rad = crank.angle; x: m = slider.position.x }
        scenes only;
        scene CrankIdeal { rigid joints; tune { load } expect planar; expect independent speeds; }
        scene CrankWithAll { rigid joints; all reactions; tune { load } expect planar; }
    }
}
