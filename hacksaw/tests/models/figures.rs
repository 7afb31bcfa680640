//! The paper's figures: which there are, how large their files are, values that are extreme.

use bg_model::simulation::Column;
use bg_model::simulation::Recording;
use bg_workbench::figures::FigureError;
use hacksaw::columns::reference_columns;
use hacksaw::figures::{FIGURES, Quantity};

fn trajectory(samples: usize, value: impl Fn(usize, usize) -> f64) -> Recording {
    let columns: Vec<Column> = reference_columns().into_iter().map(|name| Column::new(name, "")).collect();
    let count = columns.len();
    let mut trajectory = Recording::new(columns);
    for k in 0..samples {
        trajectory.push(k as f64 * 1e-4, (0..count).map(|c| value(k, c)));
    }
    trajectory
}

#[test]
fn the_table_has_every_figure_once_and_every_quantity_of_every_link() {
    assert!(FIGURES.iter().map(|f| f.number).eq(4..=19));
    for link in 2..=5 {
        for quantity in [Quantity::Orientation, Quantity::AngularMomentum, Quantity::Momentum, Quantity::Path] {
            assert_eq!(FIGURES.iter().filter(|f| f.link == link && f.quantity == quantity).count(), 1);
        }
    }
    assert_eq!(FIGURES[1].file_name(), "figure_05_crank_angular_momentum.svg");
}

#[test]
fn a_noisy_run_of_many_samples_stays_below_300_kb() {
    // A linear congruence as noise: the worst case for thinning.
    let noisy = trajectory(50_000, |k, c| ((k * 7919 + c * 104_729) % 10_007) as f64 / 10_007.0);
    for figure in FIGURES {
        let svg = figure.draw(&noisy).unwrap();
        assert!(svg.len() < 300_000, "{} has {} bytes", figure.file_name(), svg.len());
        assert!(svg.contains(&format!("Figure {}.", figure.number)));
    }
}

#[test]
fn a_single_sample_and_huge_values_are_drawn() {
    for figure in FIGURES {
        figure.draw(&trajectory(1, |_, _| 0.0)).unwrap();
        figure.draw(&trajectory(3, |k, _| 1e200 * k as f64)).unwrap();
        assert!(matches!(figure.draw(&trajectory(0, |_, _| 0.0)), Err(FigureError::Empty)));
    }
}

/// Where the orientation figure of the crank writes the names of the inertial axes, from the sphere's centre.
#[test]
fn the_view_is_orthographic() {
    let figure = FIGURES.iter().find(|figure| figure.quantity == Quantity::Orientation).unwrap();
    let svg = figure.draw(&trajectory(2, |_, _| 0.0)).unwrap();
    let document = roxmltree::Document::parse(&svg).unwrap();
    let place = |name: &str| {
        let of_axis = |node: &roxmltree::Node| node.text().is_some_and(|text| text.trim() == name);
        let node = document.descendants().filter(roxmltree::Node::is_element).find(of_axis).expect(name);
        ["x", "y"].map(|key| node.attribute(key).unwrap().parse::<f64>().unwrap())
    };
    let ([x, y], [up_x, up_y], [_, near_y]) = (place("x"), place("y"), place("z"));
    assert!(x > up_x + 50.0 && up_y < y - 50.0, "x to the right, y up");
    assert!(near_y > y, "z comes toward the reader, seen from above");
}
