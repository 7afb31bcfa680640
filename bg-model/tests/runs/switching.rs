//! Random switched oscillators: at every instant the branches agree with the guards, or the run ends in a true chatter.

use crate::problems::*;
use crate::random::random_numbers;
use bg_model::failure::Cause;
use bg_model::integrator::Dop853;
use bg_model::nalgebra::SVector;
use bg_model::simulation::{EachSample, Samples, Settings, Span, integrate};
use bg_model::system::{System, switches, values};

/// Three oscillators with position x_i and velocity x_(3+i), their damping and drive switched by a plane each.
struct Oscillators {
    frequency: [f64; 3],
    strength: f64,
    plane: [[f64; 3]; 2],
    offset: [f64; 2],
}

impl System<f64, 6, 2> for Oscillators {
    fn rate(&self, t: f64, x: &SVector<f64, 6>, negative: &[bool; 2], dx: &mut SVector<f64, 6>) {
        let damping = if negative[0] { self.strength } else { 0.01 };
        let drive = if negative[1] { self.strength * libm::sin(1.3 * t) } else { 0.5 * libm::cos(0.7 * t) };
        for i in 0..3 {
            dx[i] = x[3 + i];
            dx[3 + i] = drive - self.frequency[i] * self.frequency[i] * x[i] - damping * x[3 + i];
        }
    }
    fn guards(&self, _: f64, x: &SVector<f64, 6>, _: &[bool; 2], guards: &mut SVector<f64, 2>) {
        for k in 0..2 {
            guards[k] = (0..3).map(|i| self.plane[k][i] * x[3 * k + i]).sum::<f64>() - self.offset[k];
        }
    }
}

impl Oscillators {
    fn random(next: &mut impl FnMut() -> f64) -> (Self, SVector<f64, 6>) {
        let frequency = [0.5 + 3.0 * next(), 1.0 + 5.0 * next(), 2.0 + 8.0 * next()];
        let plane = std::array::from_fn(|_| std::array::from_fn(|_| next() - 0.5));
        let offset = [0.6 * (next() - 0.5), 2.0 * (next() - 0.5)];
        let system = Self { frequency, strength: 2.0 * next(), plane, offset };
        (system, SVector::from_fn(|_, _| 2.0 * next() - 1.0))
    }

    /// Whether both branches of `switch` push its guard to the other side.
    fn is_chatter(&self, t: f64, x: &SVector<f64, 6>, negative: [bool; 2], switch: usize) -> bool {
        let slope = |branch: bool| {
            let (mut negative, mut dx) = (negative, SVector::zeros());
            negative[switch] = branch;
            self.rate(t, x, &negative, &mut dx);
            (0..3).map(|i| self.plane[switch][i] * dx[3 * switch + i]).sum::<f64>()
        };
        slope(false) <= 0.0 && slope(true) >= 0.0
    }
}

#[test]
fn branches_agree_with_guards_at_every_instant() {
    let mut next = random_numbers(12345);
    let mut counts = [0_u64; 2];
    for case in 0..60 {
        let (system, start) = Oscillators::random(&mut next);
        for tolerance in [1e-3, 1e-6, 1e-10] {
            let mut worst = 0.0_f64;
            let mut guards = SVector::zeros();
            let mut observer = EachSample(|t, x: &[f64], negative: &[bool]| {
                system.guards(t, values(x), switches(negative), &mut guards);
                let wrong = |k: usize| if (guards[k] < 0.0) == negative[k] { 0.0 } else { guards[k].abs() };
                worst = worst.max(wrong(0)).max(wrong(1));
            });
            let settings = Settings { samples: Samples::Every(0.003), ..settings(tolerance) };
            let span = Span { t0: 0.0, t_end: 30.0 };
            match integrate(&system, &mut Dop853::new(), &start, span, &settings, &mut observer) {
                Ok(finish) => counts[0] += finish.statistics.events,
                Err(failure) => {
                    let Cause::EventsAccumulate { switch, t, .. } = failure.cause else { panic!("{case}: {failure}") };
                    let last = &failure.last;
                    assert!(system.is_chatter(t, last.state(), *last.branches(), switch), "{case}: {failure}");
                    counts[1] += 1;
                }
            }
            assert!(worst <= tolerance, "{case} at {tolerance:e}: wrong by {worst:e}");
        }
    }
    assert!(counts[0] > 1000 && counts[1] > 0, "events and chatters were met: {counts:?}");
}
