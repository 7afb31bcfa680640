//! What the paper says of its figures: of a motion as it describes, and of one with each part of it broken.

use bg_model::simulation::Column;
use bg_model::simulation::Recording;
use hacksaw::checks::{check, reversals};

use hacksaw::columns::reference_columns;

/// A hacksaw as the paper describes it, from simple motions: crank at constant speed after a short start.
fn synthetic(change: impl Fn(f64, &str, f64) -> f64) -> Recording {
    let names = reference_columns();
    let columns = names.iter().map(|name| Column::new(name, "")).collect();
    let mut trajectory = Recording::new(columns);
    for k in 0..=2000 {
        let t = f64::from(k) / 500.0;
        let crank = 20.0 * t;
        let swing = 0.35 * (1.0 - (-2.0 * t).exp());
        let angles = [crank, 0.1 * crank.sin(), swing, swing];
        let value = |name: &str| -> f64 {
            let link = usize::from(name.as_bytes()[1] - b'2');
            let angle = angles[link];
            match (name.as_bytes()[0], &name[3..], link) {
                (b'R', "11" | "22", _) => angle.cos(),
                (b'R', "21", _) => angle.sin(),
                (b'R', "12", _) => -angle.sin(),
                (b'R', "33", _) => 1.0,
                (b'C', "x", 0) => 0.0375 * angle.cos(),
                (b'C', "y", 0) => 0.0375 * angle.sin(),
                (b'C', "x", 1 | 2) => 0.5 + 0.04 * crank.cos(),
                (b'C', "y", 1 | 2) => 0.01 * crank.sin() - 0.1 * swing,
                (b'h', "z", 0) => 0.01 + 0.002 * crank.sin(),
                (b'h', "z", 1) => (1.0 - (-t).exp()) * crank.sin(),
                (b'h', "z", 3) => crank.sin() * (1.0 + (-t).exp()),
                _ => 0.0,
            }
        };
        trajectory.push(t, names.iter().map(|name| change(t, name, value(name))));
    }
    trajectory
}

/// The statements that do not hold.
fn broken(trajectory: &Recording) -> Vec<&'static str> {
    check(trajectory).unwrap().into_iter().filter(|check| !check.holds).map(|check| check.statement).collect()
}

#[test]
fn every_statement_holds_for_a_motion_as_the_paper_describes_it() {
    assert_eq!(broken(&synthetic(|_, _, value| value)), [""; 0]);
    assert_eq!(check(&synthetic(|_, _, value| value)).unwrap().len(), 12);
}

#[test]
fn each_statement_fails_where_its_own_motion_is_broken() {
    // The new value of a column from time and old value.
    type Motion = fn(f64, f64) -> f64;
    let cases: [(&str, &str, Motion); 12] = [
        ("R2_11", "The crank's x and y unit vectors run on circles.", |_, value| 1.001 * value),
        ("R2_13", "The crank's z unit vector stands still.", |t, _| 1e-6 * t),
        ("h2_x", "Only the z component of the crank's angular momentum varies.", |t, _| 1e-6 * t),
        ("C2_x", "C2 runs on a circle.", |_, value| 1.3 * value),
        ("h3_z", "The rod's angular momentum grows at first, from the constant torque.", |t, value| {
            (-5.0 * t).exp() * value
        }),
        ("C3_y", "The rod moves in x and y.", |_, _| 0.3),
        ("R3_21", "The rod oscillates about z.", |_, _| 0.0),
        ("C3_z", "The rod's z does not change.", |t, _| 1e-6 * t),
        ("C4_x", "The frame slides to and fro in x.", |t, _| t),
        ("C4_y", "The frame moves downward with the guide.", |t, _| t),
        ("C4_z", "The frame's z stays.", |t, _| 1e-6 * t),
        ("h5_z", "The guide's angular momentum changes sharply at the start, from the sudden torque.", |t, value| {
            t * value
        }),
    ];
    for (column, statement, motion) in cases {
        let trajectory = synthetic(|t, name, value| if name == column { motion(t, value) } else { value });
        assert_eq!(broken(&trajectory), [statement], "{column}");
    }
}

#[test]
fn a_single_sample_and_none_give_no_panic() {
    let trajectory = synthetic(|_, _, value| value).at(&[0.0]);
    assert!(!broken(&trajectory).is_empty());
    assert_eq!(check(&Recording::default()).unwrap(), []);
}

#[test]
fn a_reversal_is_a_turn_back_beyond_the_threshold() {
    assert_eq!(reversals(&[0.0, 1.0, 2.0, 1.9, 3.0, 0.0, 2.0], 0.5), 2);
    assert_eq!(reversals(&[0.0, 0.1, 0.0, 0.1], 0.5), 0);
}
