//! Bricard's mechanism (IFToMM benchmark A04): five rods, six hinges, one degree of freedom that counting them does not
//! give.

use std::sync::LazyLock;

use bg_loaded::Graph;
use bg_model::dynamics::Machine;
use bg_model::integrator::{Dop853, Tolerances};
use bg_model::simulation::{Settings, Span, drive};

use super::text::{graphs, model, outputs};

const TEXT: &str = "
/// Five rods along the edges of a cube.
graph Bricard {
    gravity [0, -9.81, 0];
    ground { point A = [0, 0, 0]; point F = [0, 0, 1]; }
    body one { mass 1; inertia [0.0016666666666666668, 0.08416666666666667, 0.08416666666666667]; \
    point A = [-0.5, 0, 0]; point B = [0.5, 0, 0];
        start A at [0, 0, 0]; }
    body two { mass 1; inertia [0.08416666666666667, 0.0016666666666666668, 0.08416666666666667]; \
    point B = [0, 0.5, 0]; point C = [0, -0.5, 0];
        start B at [1, 0, 0]; }
    body three { mass 1; inertia [0.08416666666666667, 0.08416666666666667, 0.0016666666666666668]; \
    point C = [0, 0, -0.5]; point D = [0, 0, 0.5];
        start C at [1, -1, 0]; }
    body four { mass 1; inertia [0.0016666666666666668, 0.08416666666666667, 0.08416666666666667]; \
    point D = [0.5, 0, 0]; point E = [-0.5, 0, 0];
        start D at [1, -1, 1]; }
    body five { mass 1; inertia [0.08416666666666667, 0.0016666666666666668, 0.08416666666666667]; \
    point E = [0, -0.5, 0]; point F = [0, 0.5, 0];
        start E at [0, -1, 1]; }
    joint a: revolute y (ground.A -> one.A) { rigid; }
    joint b: revolute z (one.B -> two.B) { rigid; }
    joint c: revolute x (two.C -> three.C) { rigid; }
    joint d: revolute y (three.D -> four.D) { rigid; }
    joint e: revolute z (four.E -> five.E) { rigid; }
    joint f: revolute x (ground.F -> five.F) { rigid; }
    observe {
        third: m = three.D.position;
        a: m = one.position.y; b: m = two.position.y; c: m = three.position.y; d: m = four.position.y; \
        e: m = five.position.y;
        gap: m = f.gap;
    }
}
";

static GRAPHS: LazyLock<Vec<Graph>> = LazyLock::new(|| graphs(TEXT));

/// Energy that comes from gravity: kinetic energy less the work of the weights, 0 from rest.
fn gained(model: &dyn Machine, t: f64, x: &[f64]) -> (f64, Vec<f64>) {
    let y = outputs(model, t, x, &[]);
    let heights = 9.81 * (y[3] + y[4] + y[5] + y[6] + y[7] + 3.0);
    (model.stored_energy(t, x, &[]) + heights, y)
}

/// From rest the mechanism swings there and back; it has one degree of freedom, so its energy says how fast it is.
#[test]
fn bricards_mechanism_keeps_its_energy_and_its_joints() {
    let model = model(&GRAPHS, "Bricard", &[]);
    let redundant = model.redundant();
    assert_eq!(redundant.len(), 1, "{redundant:?}");
    assert_eq!((redundant[0].joint, redundant[0].directions.len()), ("f", 1), "{}", redundant[0]);
    let start = model.start().unwrap();
    let settings = Settings { tolerances: Tolerances::new(1e-10, 1e-11), ..Settings::default() };
    let span = Span { t0: 0.0, t_end: 10.0 };
    let finish = drive(&*model, &mut Dop853::new(), &start, span, &settings, None, &mut ());
    let finish = finish.unwrap_or_else(|failure| panic!("{failure}"));
    let (gained, y) = gained(&*model, finish.t, finish.x.as_slice());
    println!("{} steps, {gained:e} J, {y:?}", finish.statistics.steps);
    assert!(gained.abs() < 1e-7, "{gained:e}");
    // The gaps of the last joint, whose row about z takes no part.
    assert!(y.iter().skip(8).all(|gap| gap.abs() < 1e-12), "{y:?}");
}
