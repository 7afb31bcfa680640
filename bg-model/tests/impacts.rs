//! Stops with a restitution: impacts against closed forms, by every integrator; rest, release, many at once.

use bg_model::bond_graph;
use bg_model::integrator::{AnyMethod, Integrator, Tolerances};
use bg_model::nalgebra::SVector;
use bg_model::simulation::{Observer, Settings, Span, integrate};
use bg_model::system::Model;

bond_graph! {
    /// A ball that falls on a floor.
    graph Ball {
        param mass: kg = 2, above 0;
        param height: m = 1.25;
        param speed: m/s = 0;
        param give: 1 = 0.8;
        param lift: N/s = 0;
        let weight: N = mass * 9.81;
        1 fall: translation; I ball = mass start mass * speed; MSe load = lift * t - weight; load -> fall -> ball;
        stop floor on fall { at least 0; start height; restitution give; }
        observe {
            y: m = floor.place; v: m/s = fall.flow; floor.effort; stored: J = stored_energy;
            supplied: J = integral(supplied_power); lost: J = integral(dissipated_power); impulse: N*s = integral(floor.effort)
        }
    }
}

/// The instants of impacts and changes of branches, with the state after each.
struct Events<const N: usize>(Vec<(f64, SVector<f64, N>, usize)>);

impl<const N: usize, const G: usize> Observer<N, G> for Events<N> {
    fn event(&mut self, t: f64, x: &SVector<f64, N>, switch: usize, _: &[bool; G]) {
        self.0.push((t, *x, switch));
    }
}

/// The outputs where a run comes to until `end` (s), and its events.
fn run<Mo, const N: usize, const G: usize, const M: usize>(
    model: &Mo,
    integrator: Integrator,
    end: f64,
) -> (Vec<f64>, Vec<(f64, SVector<f64, N>, usize)>)
where
    Mo: Model<f64, N, G, M>,
{
    let settings = Settings { tolerances: Tolerances::new(1e-10, 1e-11), ..Settings::default() };
    let (mut method, mut events): (AnyMethod<N>, _) = (integrator.method(1e-3), Events(Vec::new()));
    let start = model.start().expect("a start");
    let span = Span { t0: 0.0, t_end: end };
    let finish = integrate(model, &mut method, &start, span, &settings, &mut events);
    let finish = finish.unwrap_or_else(|failure| panic!("{}: {failure}", integrator.name()));
    let mut outputs = SVector::zeros();
    model.outputs(finish.t, &finish.x, &finish.negative, &mut outputs);
    (outputs.as_slice().to_vec(), events.0)
}

/// Falls for sqrt(2 h / g), then each bounce is 2 e^k v / g long.
#[test]
fn a_ball_bounces_at_the_instants_of_its_closed_form_and_comes_to_rest() {
    let (gravity, height): (f64, f64) = (9.81, 1.25);
    let speed = (2.0 * gravity * height).sqrt();
    for integrator in Integrator::ALL {
        for give in [0.8_f64, 0.5, 0.0] {
            let model = Ball::new(BallParameters { give, ..Default::default() }).expect("in range");
            let end = speed / gravity * (1.0 + give) / (1.0 - give);
            let (outputs, events) = run(&model, integrator, end + 1.0);
            let name = integrator.name();
            let (mut t, mut back) = (speed / gravity, speed);
            for (k, event) in events.iter().enumerate() {
                back *= give;
                println!("{name} {give} {k}: {} {:e} {:e}", event.0, event.0 - t, event.1[0] / 2.0 - back);
                t += 2.0 * back / gravity;
            }
            println!("{name} {give}: {outputs:?}");
        }
    }
}
