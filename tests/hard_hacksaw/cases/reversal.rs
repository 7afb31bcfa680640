//! The hacksaw with another drive: one that turns round in the middle of a run, and none at all.

/// The hacksaw with a torque that changes its sign at an instant, for a scene.
macro_rules! reversible {
    ($name:ident: $($scene:tt)*) => {
        bg_model::bond_graph! {
            /// A torque that changes its sign at an instant: by a choice in its law, which is a switch, or by an input,
            /// which is not.
            pub graph $name {
                part hacksaw::Mechanism;
                /// Drive torque on the crank about z, up to the reversal.
                param torque: N*m = 10;
                /// The instant of the reversal.
                param reversal: s = 0.5;
                /// Torque that comes on top.
                input extra: N*m;
                drive motor on pin_o torque = (if t < reversal { torque } else { -torque }) + extra;

                observe {
                    C2: m = crank.position; R2 = crank.orientation; C3: m = rod.position; R3 = rod.orientation;
                    C4: m = frame.position; R4 = frame.orientation; C5: m = guide.position; R5 = guide.orientation;
                    stored_energy: J = stored_energy;
                    supplied_energy: J = integral(supplied_power);
                    dissipated_energy: J = integral(dissipated_power);
                }
                scenes only;
                $($scene)*
            }
        }
    };
}

reversible!(ReversibleHacksaw:
    /// In the plane.
    scene Reversal { tune { reversal } expect planar; }
);
reversible!(CoastingHacksaw:
    /// In the plane, the blade off the work, no drive: with dampings of 0 energy is conserved.
    scene Coasting {
        without { cut, motor }
        tune { crank_angle, r_2, r_2r, r_23, r_23r, r_34, r_34r, r_15, r_15r, r_45, r_45r }
        expect planar;
    }
);
