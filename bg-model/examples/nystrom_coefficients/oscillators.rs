//! The errors of one step on linear oscillators that follow a slow motion.
//!
//! In: a method's coefficients. Out: the errors of positions and momenta after a step of length 1 from the exact state.
//! Forces move each oscillator along t^3 / 6: of a slow motion's powers of time the lowest that a stage can miss.

use bg_model::scalar::Scalar;

use crate::STAGES;
use crate::coefficients::Coefficients;
use crate::trees::dot;

/// A unit mass on a spring and a damper, with a state that relaxes: q'' = -z^2 (1 + s t) (q - Q) - 2 d z (1 + w t) (q'
/// - Q')
/// - c z^2 (r - Q) + Q'', r' = -2 (r - Q) + 2 (q - Q) + Q', with the motion Q.
#[derive(Clone, Copy)]
struct Oscillator {
    /// z, the frequency times the step.
    frequency: f64,
    /// d, the damping ratio.
    damping: f64,
    /// s, by which the stiffness grows in the step.
    stiffening: f64,
    /// w, by which the damping grows in the step.
    damping_growth: f64,
    /// c, the force of what relaxes.
    coupling: f64,
}

/// Both damped and not, from soft to as stiff as a step allows.
const FREQUENCIES: [f64; 10] = [0.4, 1.2, 2.0, 2.8, 3.6, 4.4, 5.2, 6.0, 6.8, 7.6];
const DAMPINGS: [f64; 3] = [0.0, 0.05, 0.3];
/// Stiffening, growth of the damping, coupling, and the weight of the errors: what relaxes has errors of a lower order.
const KINDS: [([f64; 3], f64); 4] =
    [([0.0, 0.0, 0.0], 0.07), ([0.5, 0.0, 0.0], 0.07), ([0.0, 1.0, 0.0], 0.07), ([0.0, 0.0, 0.3], 0.007)];

/// The weighted errors on all oscillators. Those of momenta are in parts of the frequency where it is above 1.
pub fn errors<S: Scalar>(method: &Coefficients<S>) -> Vec<S> {
    let mut errors = Vec::new();
    for ([stiffening, damping_growth, coupling], weight) in KINDS {
        for frequency in FREQUENCIES {
            for damping in DAMPINGS {
                let oscillator = Oscillator { frequency, damping, stiffening, damping_growth, coupling };
                let of_step = oscillator.errors(method);
                let counted = if coupling == 0.0 { 2 } else { 3 };
                errors.extend(of_step[..counted].iter().map(|error| S::from_f64(weight) * *error));
            }
        }
    }
    errors
}

impl Oscillator {
    /// The errors of position, momentum and what relaxes.
    fn errors<S: Scalar>(&self, method: &Coefficients<S>) -> [S; 3] {
        let (mut second, mut rates) = (Vec::new(), Vec::new());
        let state = |row: usize, second: &[S], rates: &[S]| {
            [dot(&method.second[row], second), dot(&method.first[row], second), dot(&method.first[row], rates)]
        };
        for (stage, t) in method.instants.iter().enumerate() {
            let [force, rate] = self.rates(*t, state(stage, &second, &rates));
            second.push(force);
            rates.push(rate);
        }
        let [position, momentum, relaxing] = off(S::from_f64(1.0), state(STAGES, &second, &rates));
        [position, momentum / S::from_f64(self.frequency.max(1.0)), relaxing]
    }

    /// q'' and r' at a state.
    fn rates<S: Scalar>(&self, t: S, state: [S; 3]) -> [S; 2] {
        let number = S::from_f64;
        let [q, p, r] = off(t, state);
        let spring = number(self.frequency * self.frequency);
        let damper = number(2.0 * self.damping * self.frequency);
        let stiffness = spring * (number(1.0) + number(self.stiffening) * t);
        let resistance = damper * (number(1.0) + number(self.damping_growth) * t);
        let back = stiffness * q + resistance * p + number(self.coupling) * spring * r;
        [t - back, number(0.5) * t * t + number(2.0) * (q - r)]
    }
}

/// How far a state of position, momentum and what relaxes is from the motion.
fn off<S: Scalar>(t: S, [q, p, r]: [S; 3]) -> [S; 3] {
    let speed = S::from_f64(0.5) * t * t;
    let place = speed * t / S::from_f64(3.0);
    [q - place, p - speed, r - place]
}
