//! Bricard's mechanism (IFToMM benchmark A04): five rods, six hinges, one degree of freedom that counting them does not give.

use bg_model::bond_graph;
use bg_model::integrator::{Dop853, Tolerances};
use bg_model::nalgebra::SVector;
use bg_model::simulation::{Settings, Span, integrate};
use bg_model::system::Model;

bond_graph! {
    /// Five rods along the edges of a cube.
    graph Bricard {
        gravity [0, -9.81, 0];
        ground { point A = [0, 0, 0]; point F = [0, 0, 1]; }
        body one { mass 1; inertia [1e-6, 0.08333333333333333, 0.08333333333333333]; point A = [-0.5, 0, 0]; point B = [0.5, 0, 0];
            start A at [0, 0, 0]; }
        body two { mass 1; inertia [0.08333333333333333, 1e-6, 0.08333333333333333]; point B = [0, 0.5, 0]; point C = [0, -0.5, 0];
            start B at [1, 0, 0]; }
        body three { mass 1; inertia [0.08333333333333333, 0.08333333333333333, 1e-6]; point C = [0, 0, -0.5]; point D = [0, 0, 0.5];
            start C at [1, -1, 0]; }
        body four { mass 1; inertia [1e-6, 0.08333333333333333, 0.08333333333333333]; point D = [0.5, 0, 0]; point E = [-0.5, 0, 0];
            start D at [1, -1, 1]; }
        body five { mass 1; inertia [0.08333333333333333, 1e-6, 0.08333333333333333]; point E = [0, -0.5, 0]; point F = [0, 0.5, 0];
            start E at [0, -1, 1]; }
        joint a: revolute y (ground.A -> one.A) { rigid; }
        joint b: revolute z (one.B -> two.B) { rigid; }
        joint c: revolute x (two.C -> three.C) { rigid; }
        joint d: revolute y (three.D -> four.D) { rigid; }
        joint e: revolute z (four.E -> five.E) { rigid; }
        joint f: revolute x (ground.F -> five.F) { rigid; }
        observe { third: m = three.D.position; f.force; }
    }
}

#[test]
fn bricards_mechanism_keeps_its_energy() {
    let model: Bricard = Bricard::new(BricardParameters::default()).unwrap();
    println!("{:?}", model.redundant().iter().map(ToString::to_string).collect::<Vec<_>>());
    let start = model.start().unwrap();
    let settings = Settings { tolerances: Tolerances::new(1e-10, 1e-11), ..Settings::default() };
    let finish = integrate(&model, &mut Dop853::new(), &start, Span { t0: 0.0, t_end: 10.0 }, &settings, &mut ());
    let finish = finish.unwrap_or_else(|failure| panic!("{failure}"));
    println!("{} steps", finish.statistics.steps);
    let energy = |t: f64, x| model.stored_energy(t, x, &[]);
    println!("{:e}", energy(finish.t, &finish.x) - energy(0.0, &start));
    let mut y = SVector::<f64, { Bricard::OUTPUTS }>::zeros();
    model.outputs(finish.t, &finish.x, &[], &mut y);
    println!("{y}");
}
