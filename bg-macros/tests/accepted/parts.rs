//! Parts of one call in others: by their paths, under other names, in a function, with parts of their own.

#![deny(warnings)]

use bg_model::bond_graph;
use bg_model::system::Model;

/// What is on wheels.
pub mod wheels {
    /// The spring.
    pub mod springs {
        bg_model::bond_graph! {
            /// A spring with a damper beside it.
            pub(crate) part Strut {
                param stiffness: N/m = 100, above 0;
                param damping: N*s/m = 2, at least 0;
                port end: translation;
                C spring = stiffness; R damper = damping;
                end -> spring; end -> damper;
                observe { length: m = spring.q }
            }
        }
    }
    bg_model::bond_graph! {
        /// A mass that a spring carries.
        pub part Wheel {
            /// The wheel's mass.
            param mass: kg = 3, above 0;
            port axle: translation;
            part rim: Rim { mass = mass; }
            part strut: self::springs::Strut { damping = 4; }
            0 between: translation;
            axle -> between -> rim.hub; between -> strut.end;
            observe { all of strut; all of rim }
        }
        part Rim {
            param mass: kg = 1, above 0;
            port hub: translation;
            I inertia = mass; hub -> inertia;
            observe { speed: m/s = hub.flow }
        }
    }
}

use wheels::Wheel as Round;

bond_graph! {
    /// Two wheels, of which one has a stiffer spring.
    pub graph Cart {
        part left: self::Round { mass = 5; }
        part right: crate::parts::wheels::Wheel { strut.stiffness = 300; }
        Sf push = 1 * sin(t / 1);
        1 frame: translation;
        push -> frame; frame -> left.axle; frame -> right.axle;
        observe { all of left; right.strut.length }
        scene Left { observe all of left; tune all but right.mass; }
    }
}

#[test]
fn parts_are_found_by_their_paths() {
    bond_graph! {
        graph Local {
            part wheel: wheels::Wheel;
            Sf push = 1; 1 frame: translation; push -> frame -> wheel.axle;
        }
    }
    let parameters = CartParameters { left_strut_stiffness: 50.0, right_mass: 1.0 };
    let cart = Cart::new(parameters).expect("in range");
    let outputs: Vec<_> = cart.description().outputs.iter().map(|output| output.name).collect();
    assert_eq!(outputs, ["left.strut.length", "left.rim.speed", "right.strut.length"]);
    let names: Vec<_> = cart.description().parameters.iter().map(|parameter| parameter.name).collect();
    assert_eq!(names, ["left.strut.stiffness", "right.mass"]);
    assert_eq!((Cart::STATES, Left::STATES, Local::STATES), (4, 2, 2));
    assert!(Left::new(LeftParameters { left_strut_stiffness: 1.0 }).is_ok());
    assert!(Local::new(LocalParameters { wheel_mass: -1.0, ..LocalParameters::default() }).is_err());
}
