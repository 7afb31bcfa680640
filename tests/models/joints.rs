//! Every kind of joint between the ground and a plate that can be pushed and turned in every direction.

use bg_model::bond_graph;

/// One graph: a plate of 2 kg with moments of inertia of 0.1, 0.2 and 0.3 kg m^2 on a joint at its centre of mass.
macro_rules! plate_on {
    ($name:ident: $($kind:ident)+ { $($clause:tt)* }) => {
        bond_graph! {
            /// A plate on a joint at its centre of mass.
            pub graph $name {
                /// Force along x.
                param force_x: N = 0;
                /// Force along y.
                param force_y: N = 0;
                /// Force along z.
                param force_z: N = 0;
                /// Torque about x.
                param torque_x: N*m = 0;
                /// Torque about y.
                param torque_y: N*m = 0;
                /// Torque about z.
                param torque_z: N*m = 0;
                ground { point O = [0.1, 0.2, 0.3]; }
                body plate { mass 2; inertia [0.1, 0.2, 0.3]; start at [0.1, 0.2, 0.3]; }
                joint hold: $($kind)+ (ground.O -> plate) { $($clause)* }
                drive push on plate force = [force_x, force_y, force_z];
                drive turn on plate torque = [torque_x, torque_y, torque_z];
                observe { gap: m = hold.gap; R = plate.orientation; stored: J = stored_energy; }
            }
        }
    };
}

plate_on!(PlateOnRevolute: revolute z { stiffness 1e3; damping 40; tilt stiffness 50; tilt damping 2; });
plate_on!(PlateOnRevoluteInertial: revolute z {
    stiffness 1e3; damping 40; tilt stiffness 50; tilt damping 2; frame inertial;
});
plate_on!(PlateOnRevolutePerAxis: revolute y {
    stiffness [1e3, 1e3, 1e3]; damping [40, 40, 40]; tilt stiffness 50; tilt damping 2;
});
plate_on!(PlateOnPrismatic: prismatic x { stiffness 1e3; damping 40; tilt stiffness 50; tilt damping 2; });
plate_on!(PlateOnPrismaticInertial: prismatic y {
    stiffness 1e3; damping 40; tilt stiffness 50; tilt damping 2; frame inertial;
});
plate_on!(PlateOnSpherical: spherical { stiffness 1e3; damping 40; });
plate_on!(PlateOnCylindrical: cylindrical x { stiffness 1e3; damping 40; tilt stiffness 50; tilt damping 2; });
plate_on!(PlateOnUniversal: universal x y { stiffness 1e3; damping 40; tilt stiffness 50; tilt damping 2; });
plate_on!(PlateOnUniversalZx: universal z x { stiffness 1e3; damping 40; tilt stiffness 50; tilt damping 2; });
plate_on!(PlateOnFixed: fixed { stiffness 1e3; damping 40; tilt stiffness 50; tilt damping 2; });
plate_on!(PlateOnFixedInertial: fixed {
    stiffness 1e3; damping 40; tilt stiffness 50; tilt damping 2; frame inertial;
});
