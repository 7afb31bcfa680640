//! Closed solutions that several tests use.

use std::f64::consts::PI;

/// The solution of m x'' + c x' + k x = 0 from `x0`, `v0` at time `t`: position and velocity. Under- or overdamped.
pub fn oscillator(m: f64, c: f64, k: f64, (x0, v0): (f64, f64), t: f64) -> (f64, f64) {
    let decay = c / (2.0 * m);
    let square = k / m - decay * decay;
    let (cosine, sine) = if square > 0.0 {
        let w = square.sqrt();
        ((w * t).cos(), (w * t).sin() / w)
    } else {
        let w = (-square).sqrt();
        ((w * t).cosh(), (w * t).sinh() / w)
    };
    let shrink = (-decay * t).exp();
    let slope = v0 + decay * x0;
    (shrink * (x0 * cosine + slope * sine), shrink * (v0 * cosine - (decay * slope + square * x0) * sine))
}

/// The complete elliptic integral of the first kind of modulus `k`, by the arithmetic-geometric mean.
pub fn elliptic(k: f64) -> f64 {
    let (mut a, mut b) = (1.0_f64, (1.0 - k * k).sqrt());
    while (a - b).abs() > 1e-15 * a {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    PI / (2.0 * a)
}

/// The zero of a function that changes its sign between `low` and `high`.
pub fn root(f: impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> f64 {
    assert!(f(low) * f(high) < 0.0, "the sign must change");
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        if f(low) * f(middle) <= 0.0 { high = middle } else { low = middle }
    }
    0.5 * (low + high)
}

/// The motion of a mass on a spring with another damping in each direction, from stretch `x0` at rest: the k-th turning
/// point's time and stretch.
pub fn turning_point(m: f64, k: f64, back: f64, forth: f64, x0: f64, count: u32) -> (f64, f64) {
    (0..count).fold((0.0, x0), |(t, x), _| {
        let c = if x > 0.0 { back } else { forth };
        let half = PI / (k / m - (c / (2.0 * m)).powi(2)).sqrt();
        (t + half, oscillator(m, c, k, (x, 0.0), half).0)
    })
}

/// The dot product.
pub fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The cross product.
pub fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// The largest distance of two sequences of vectors.
pub fn apart(a: &[[f64; 3]], b: impl Iterator<Item = [f64; 3]>) -> f64 {
    a.iter().zip(b).flat_map(|(a, b)| (0..3).map(move |k| (a[k] - b[k]).abs())).fold(0.0, f64::max)
}

/// Says what was measured (with `--nocapture`) and fails where it is above the limit or not a number.
#[track_caller]
pub fn within(what: &str, measured: f64, limit: f64) {
    println!("{what}: {measured:.2e} (limit {limit:.0e})");
    assert!(measured <= limit, "{what}: {measured:e} is above {limit:e}");
}
