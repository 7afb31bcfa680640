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
        body one { mass 1; inertia [0.0016666666666666668, 0.08416666666666667, 0.08416666666666667]; point A = [-0.5, 0, 0]; point B = [0.5, 0, 0];
            start A at [0, 0, 0]; }
        body two { mass 1; inertia [0.08416666666666667, 0.0016666666666666668, 0.08416666666666667]; point B = [0, 0.5, 0]; point C = [0, -0.5, 0];
            start B at [1, 0, 0]; }
        body three { mass 1; inertia [0.08416666666666667, 0.08416666666666667, 0.0016666666666666668]; point C = [0, 0, -0.5]; point D = [0, 0, 0.5];
            start C at [1, -1, 0]; }
        body four { mass 1; inertia [0.0016666666666666668, 0.08416666666666667, 0.08416666666666667]; point D = [0.5, 0, 0]; point E = [-0.5, 0, 0];
            start D at [1, -1, 1]; }
        body five { mass 1; inertia [0.08416666666666667, 0.0016666666666666668, 0.08416666666666667]; point E = [0, -0.5, 0]; point F = [0, 0.5, 0];
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
    struct Print<'a>(&'a Bricard, f64, u32, f64);
    impl bg_model::simulation::Observer<{ Bricard::STATES }, 0> for Print<'_> {
        fn sample(&mut self, t: f64, x: &SVector<f64, { Bricard::STATES }>, n: &[bool; 0]) {
            self.2 += 1;
            if t >= self.1 {
                let mut y = SVector::<f64, { Bricard::OUTPUTS }>::zeros();
                self.0.outputs(t, x, n, &mut y);
                println!(
                    "t {t:.6} steps {} third {:.6} {:.6} {:.6} force {:.3} {:.3} {:.3} energy {:.3e}",
                    self.2,
                    y[0],
                    y[1],
                    y[2],
                    y[3],
                    y[4],
                    y[5],
                    self.0.stored_energy(t, x, n) - self.3
                );
                self.1 += 0.1;
            }
        }
    }
    let e0 = model.stored_energy(0.0, &start, &[]);
    for rtol in [1e-6, 1e-10] {
        let settings = Settings {
            tolerances: Tolerances::new(rtol, 0.1 * rtol),
            samples: bg_model::simulation::Samples::Steps,
            ..Settings::default()
        };
        let _ = integrate(
            &model,
            &mut Dop853::new(),
            &start,
            Span { t0: 0.0, t_end: 3.0 },
            &settings,
            &mut Print(&model, 0.0, 0, e0),
        );
    }
}
