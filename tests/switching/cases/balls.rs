//! Accumulation: problems with infinitely many events up to a known instant.

use super::case::{Switched, started};
use super::flow::Flow;

/// A problem whose events accumulate.
pub struct Zeno {
    /// The name, one word.
    pub name: &'static str,
    /// The instant at which the events accumulate, s.
    pub end: f64,
    /// What is run.
    pub problem: Box<dyn Switched>,
}

/// All of them.
#[must_use]
pub fn balls() -> Vec<Zeno> {
    vec![bouncing_ball(), spiral(), fuller()]
}

/// A ball with the coefficient of restitution e = 1/2 that falls from 1 m under g = 2 m/s^2: it hits the ground first
/// after 1 s with 2 m/s, and bounces 2 v e^n / g long.
///
/// Written without jumps by Ivanov's substitution for Zhuravlev's: height |s|, velocity R y sgn s with
/// R = 1 - k sgn(s y), k = (1 - e) / (1 + e); s' = R y, y' = -g sgn(s) / R. Source: A. P. Ivanov, Analytical methods in
/// the theory of vibro-impact systems, J. Appl. Maths Mechs 57 (1993) 221.
#[must_use]
pub fn bouncing_ball() -> Zeno {
    let rate = |_: f64, x: &[f64; 2], negative: &[bool; 2]| {
        let side = if negative[0] { -1.0 } else { 1.0 };
        let ratio = if negative[0] == negative[1] { 1.0 - 1.0 / 3.0 } else { 1.0 + 1.0 / 3.0 };
        [ratio * x[1], -2.0 * side / ratio]
    };
    let problem = started(Flow::new(["height", "velocity"], [|_, x| x[0], |_, x| x[1]], rate), [1.0, 0.0]);
    Zeno { name: "ball", end: 3.0, problem }
}

/// The exact times of the first `count` events of the ball, s: impacts and apexes in alternation.
#[must_use]
pub fn bounces(count: usize) -> Vec<f64> {
    let mut times = vec![1.0];
    let mut half = 0.5;
    while times.len() < count {
        let impact = times[times.len() - 1];
        times.extend([impact + half, impact + 2.0 * half]);
        half *= 0.5;
    }
    times.truncate(count);
    times
}

/// x' = -sgn x + 2 sgn y, y' = -2 sgn x - sgn y: |x| + |y| falls by 2 each second, each quarter turn takes a third of
/// the one before. Source: A. F. Filippov, Differential Equations with Discontinuous Righthand Sides, 1988, section 12.
#[must_use]
pub fn spiral() -> Zeno {
    let rate = |_: f64, _: &[f64; 2], negative: &[bool; 2]| {
        let [x, y] = negative.map(|negative| if negative { -1.0 } else { 1.0 });
        [-x + 2.0 * y, -2.0 * x - y]
    };
    let problem = started(Flow::new(["x", "y"], [|_, x| x[0], |_, x| x[1]], rate), [0.7, 0.3]);
    Zeno { name: "spiral", end: 0.5, problem }
}

/// x'' = -sgn(x + c v |v|) with c = 0.3, between the spiral (c = 0) and the sliding along a parabola (c = 1/2): the
/// switchings come in geometric progression (Fuller's phenomenon). On the curve x = -c v |v|, v goes over into -q v
/// with q^2 = (1/2 - c) / (1/2 + c) while the acceleration is 1, which takes (1 + q) |v|.
#[must_use]
pub fn fuller() -> Zeno {
    const C: f64 = 0.3;
    let ratio = ((0.5 - C) / (0.5 + C)).sqrt();
    let rate = |_: f64, x: &[f64; 2], negative: &[bool; 1]| [x[1], if negative[0] { 1.0 } else { -1.0 }];
    let problem = started(Flow::new(["x", "v"], [|_, x| x[0] + C * x[1] * x[1].abs()], rate), [-C, 1.0]);
    Zeno { name: "fuller", end: (1.0 + ratio) / (1.0 - ratio), problem }
}
