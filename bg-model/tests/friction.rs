//! Dry friction that sticks: known motions, by every integrator; rest, reversal, many at once.

use bg_model::bond_graph;
use bg_model::integrator::{AnyMethod, Integrator, Tolerances};
use bg_model::nalgebra::SVector;
use bg_model::simulation::{Finish, Observer, Settings, Span, integrate};
use bg_model::system::Model;

bond_graph! {
    /// A block on an incline, thrown up it at the start.
    graph Block {
        param mass: kg = 2, above 0;
        param slope: rad = 0.6;
        param grip: 1 = 0.5, at least 0;
        param speed: m/s = 0;
        let normal: N = mass * 9.81 * cos(slope);
        1 slide: translation; I body = mass start -mass * speed;
        Se weight = mass * 9.81 * sin(slope); R rub(v) = grip * normal holds grip * normal;
        C travel(q) = 0 * q energy 0 * q * q;
        weight -> slide -> body; slide -> rub; slide -> travel;
        observe { v: m/s = slide.flow; x: m = travel.q; rub.effort; lost: J = integral(rub.power) }
    }
    /// A mass on a belt, drawn back by a spring.
    graph Belt {
        param mass: kg = 2, above 0;
        param spring: N/m = 50, above 0;
        param belt: m/s = 0.1;
        param kinetic: N = 4;
        param still: N = 6;
        1 slide: translation; I body = mass start mass * belt; C pull = spring; Sf drum = belt;
        0 between: translation; 1 rubbing: translation; R rub(v) = kinetic holds still;
        drum -> between -> slide -> body; slide -> pull; between -> rubbing -> rub;
        observe { x: m = pull.q; v: m/s = slide.flow; rub.effort }
    }
    /// A mass on a spring on a rough floor.
    graph Oscillator {
        param mass: kg = 2, above 0;
        param spring: N/m = 50, above 0;
        param rough: N = 3;
        param stretch: m = 1;
        1 slide: translation; I body = mass; C pull = spring start stretch; R rub(v) = rough holds rough;
        slide -> body; slide -> pull; slide -> rub;
        observe { x: m = pull.q; v: m/s = slide.flow; rub.effort }
    }
}

/// The changes of branches.
#[derive(Default)]
struct Events(Vec<(f64, usize, bool)>);

impl<const N: usize, const G: usize> Observer<N, G> for Events {
    fn event(&mut self, t: f64, _: &SVector<f64, N>, switch: usize, negative: &[bool; G]) {
        self.0.push((t, switch, negative[switch]));
    }
}

/// Where a run comes to until `end` (s), and its events.
fn run<Mo, const N: usize, const G: usize, const M: usize>(
    model: &Mo,
    integrator: Integrator,
    end: f64,
) -> (Finish<N, G>, Vec<(f64, usize, bool)>)
where
    Mo: Model<f64, N, G, M>,
{
    let settings = Settings { tolerances: Tolerances::new(1e-10, 1e-11), ..Settings::default() };
    let (mut method, mut events): (AnyMethod<N>, _) = (integrator.method(1e-3), Events::default());
    let start = model.start().expect("a start");
    let span = Span { t0: 0.0, t_end: end };
    let finish = integrate(model, &mut method, &start, span, &settings, &mut events);
    let finish = finish.unwrap_or_else(|failure| panic!("{}: {failure} {:?}", integrator.name(), events.0));
    (finish, events.0)
}

fn block(slope: f64, grip: f64, speed: f64) -> Block {
    Block::new(BlockParameters { slope, grip, speed, ..BlockParameters::default() }).expect("in range")
}

#[test]
fn a_block_sticks_below_the_angle_of_friction() {
    for integrator in Integrator::ALL {
        for slope in [0.4, -0.4, 0.5_f64.atan(), 0.0] {
            let (finish, events) = run(&block(slope, 0.5, 0.0), integrator, 1000.0);
            assert!(events.is_empty(), "{} {slope}: {events:?}", integrator.name());
            assert!(finish.x.amax() < 1e-12, "{} {slope}: {}", integrator.name(), finish.x);
        }
    }
}
