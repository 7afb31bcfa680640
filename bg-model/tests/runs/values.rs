//! What `new` and `start` say of values that parameters give and that cannot be, and what they let pass.

use bg_model::bond_graph;
use bg_model::nalgebra::SVector;
use bg_model::system::Model;

bond_graph! {
    /// A body of solids on a pin, with all that parameters can make wrong.
    graph Rod {
        param length: m = 0.6;
        param hole: m = 0.1, at least 0;
        param density: kg/m^3 = 7850, at least 0;
        param stiffness: N/m = 1e6;
        param damping: N*s/m = 100, at least 0;
        param stretch: 1 = 1;
        ground { point pivot = [0, 1, 0]; }
        body rod {
            cuboid [length - hole, 0.03, 0.03] density density;
            point end = [-0.25, 0, 0];
            start end at [0, 1, 0];
            start turned [[stretch, 0, 0], [0, 1, 0], [0, 0, 1]];
        }
        joint pin: revolute z (ground.pivot -> rod.end) { stiffness stiffness; damping damping; tilt stiffness 1e3; }
        observe { rod.angle }
    }

    /// A body of given inertia that starts turned by what the assembly finds.
    graph Plate {
        param third: kg*m^2 = 2;
        param across: kg*m^2 = 0;
        param width: 1 = 1;
        ground { point O = [0, 0, 0]; }
        body plate {
            mass 1; inertia [[1, across, 0], [0, 1, 0], [0, 0, third]];
            point corner = [1, 0, 0];
            start at [0, 0, 0];
            start turned [[width * cos(guess(0)), 0, 0], [0, 1, 0], [0, 0, 1]];
        }
        joint pin: spherical (ground.O -> plate) { stiffness 1; }
        observe { plate.angle }
        /// Nothing of it can be set.
        scene Fixed { tune {} observe { plate.angle } }
    }

    /// Point on a line: nothing holds it along x, where it starts 0.3 m away.
    graph Bead {
        param k: N/m = 1e4, at least 0;
        param away: m = 0.3;
        ground { point O = [0, 0, 0]; }
        body bead { mass 1; inertia [1e-3, 1e-3, 1e-3]; start at [away, guess(0.2), guess(-0.1)]; }
        joint line: spherical (ground.O -> bead) { stiffness [0, k, k]; damping 1; }
        observe { bead.position; line.force; line.x_offset }
    }
}

fn rod(change: impl Fn(&mut RodParameters)) -> String {
    let mut parameters = RodParameters::default();
    change(&mut parameters);
    match Rod::<f64>::new(parameters) {
        Ok(_) => String::new(),
        Err(error) => error.to_string(),
    }
}

fn plate(change: impl Fn(&mut PlateParameters)) -> Result<(), String> {
    let mut parameters = PlateParameters::default();
    change(&mut parameters);
    let model: Plate = Plate::new(parameters).map_err(|error| error.to_string())?;
    model.start().map(|_| ()).map_err(|error| error.to_string())
}

#[test]
fn values_of_parameters_are_refused_in_the_words_of_the_description() {
    assert_eq!(rod(|_| {}), "");
    assert_eq!(
        rod(|p| p.length = 0.05),
        "the x component of the edges of part 1 of body `rod` is -0.05 m; it must not be negative; \
         it depends on `length`, `hole`"
    );
    assert_eq!(
        rod(|p| p.density = 0.0),
        "the mass of body `rod` is 0 kg; it must be above 0; it depends on `length`, `hole`, `density`"
    );
    assert_eq!(
        rod(|p| p.stiffness = -1.0),
        "the stiffness of joint `pin` is -1 N/m; it must not be negative; it depends on `stiffness`"
    );
    assert_eq!(
        rod(|p| p.stretch = 2.0),
        "the start orientation of body `rod` must be a rotation: its columns are not perpendicular to each other and \
         of length 1; it depends on `stretch`"
    );
    assert_eq!(
        rod(|p| p.stretch = -1.0),
        "the start orientation of body `rod` must be a rotation, not a mirror image; it depends on `stretch`"
    );
    // Nothing there is nothing wrong.
    assert_eq!(rod(|p| (p.stiffness, p.damping) = (0.0, 0.0)), "");
    // What is in its range comes after what is not.
    assert!(rod(|p| p.damping = -1.0).starts_with("parameter `damping` = -1 N*s/m is out of range"));
}

#[test]
fn inertias_of_parameters_are_refused() {
    assert_eq!(plate(|_| {}), Ok(()));
    let said = |change: fn(&mut PlateParameters)| plate(change).unwrap_err();
    assert_eq!(
        said(|p| p.across = 0.5),
        "the inertia of body `plate` must be symmetric; it depends on `third`, `across`"
    );
    assert_eq!(
        said(|p| p.third = 2.1),
        "the inertia of body `plate` must have no principal moment larger than the other two together; \
        it depends on `third`"
    );
    assert_eq!(said(|p| p.third = 0.0), "the inertia of body `plate` must be positive definite; it depends on `third`");
}

#[test]
fn what_the_assembly_decides_is_refused_by_start() {
    let said = plate(|p| p.width = 1.5).unwrap_err();
    assert!(said.starts_with("the start orientation of body `plate` must be a rotation: "), "{said}");
    let parameters = PlateParameters { width: 1.5, ..PlateParameters::default() };
    assert!(Plate::<f64>::new(parameters).is_ok(), "the assembly is not part of `new`");
    assert!(Fixed::<f64>::new(FixedParameters::default()).is_ok());
}

/// The gap along a direction of no stiffness is none to close; the others are, and a stiffness that happens to be 0
/// closes as any.
#[test]
fn a_point_on_a_line_starts_anywhere_on_it() {
    for k in [1e4, 0.0] {
        let model: Bead = Bead::new(BeadParameters { k, ..BeadParameters::default() }).expect("parameters in range");
        let start: SVector<f64, { Bead::STATES }> = model.start().expect("it closes across the line");
        let mut outputs = SVector::<f64, { Bead::OUTPUTS }>::zeros();
        model.outputs(0.0, &start, &[], &mut outputs);
        let [x, y, z] = [0, 1, 2].map(|k| outputs[k]);
        assert!(x == 0.3 && y.abs() < 1e-10 && z.abs() < 1e-10, "{outputs:?}");
        assert_eq!(outputs[3], 0.0, "no force along the line");
    }
}
