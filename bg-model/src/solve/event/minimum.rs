//! The minimum of a function of one variable inside an interval.
//!
//! In: the interval, and a value that is low enough. Out: the lowest point found, to half of the digits of the
//! argument, as far as rounding lets a minimum be told. Method: parabolas through three points with the golden section
//! where they fail, from R. P. Brent, Algorithms for Minimization without Derivatives, 1973, chapter 5 (procedure
//! localmin).

/// The lowest point of `f` between `low` and `high`, and its value; the first one whose value is below `enough`.
pub(crate) fn minimum(mut low: f64, mut high: f64, enough: f64, mut f: impl FnMut(f64) -> f64) -> (f64, f64) {
    /// (3 - sqrt 5) / 2.
    const GOLDEN: f64 = 0.381_966_011_250_105_1;
    /// Of an argument of size 1.
    const RESOLUTION: f64 = 1e-8;
    const STEPS: usize = 40;
    let at = low + GOLDEN * (high - low);
    let mut best = (at, f(at));
    let (mut second, mut third) = (best, best);
    let (mut step, mut step_before) = (0.0_f64, 0.0_f64);
    for _ in 0..STEPS {
        let middle = 0.5 * (low + high);
        if best.1 < enough || (best.0 - middle).abs() <= 2.0 * RESOLUTION - 0.5 * (high - low) {
            break;
        }
        let parabola = vertex(best, second, third)
            .filter(|vertex| *vertex > low && *vertex < high && (vertex - best.0).abs() < 0.5 * step_before.abs());
        let larger_part = if best.0 < middle { high - best.0 } else { low - best.0 };
        (step_before, step) = match parabola {
            Some(vertex) => (step, vertex - best.0),
            None => (larger_part, GOLDEN * larger_part),
        };
        if step.abs() < RESOLUTION {
            step = if best.0 < middle { RESOLUTION } else { -RESOLUTION };
        }
        let next = best.0 + step;
        let next = (next, f(next));
        let is_better = next.1 <= best.1;
        let (inner, outer) = if is_better { (next.0, best.0) } else { (best.0, next.0) };
        if outer < inner {
            low = outer;
        } else {
            high = outer;
        }
        if is_better {
            (best, second, third) = (next, best, second);
        } else if next.1 <= second.1 || second.0 == best.0 {
            (second, third) = (next, second);
        } else if next.1 <= third.1 || third.0 == best.0 || third.0 == second.0 {
            third = next;
        }
    }
    best
}

/// The argument of the vertex of the parabola through three points; none where they are on a line.
fn vertex(a: (f64, f64), b: (f64, f64), c: (f64, f64)) -> Option<f64> {
    let (to_b, to_c) = ((b.0 - a.0) * (c.1 - a.1), (c.0 - a.0) * (b.1 - a.1));
    let twice = 2.0 * (to_b - to_c);
    let vertex = a.0 + ((b.0 - a.0) * to_b - (c.0 - a.0) * to_c) / twice;
    vertex.is_finite().then_some(vertex)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_vertex_of_a_parabola_takes_few_evaluations() {
        let mut evaluations = 0;
        let (at, value) = minimum(0.0, 1.0, f64::NEG_INFINITY, |x| {
            evaluations += 1;
            (x - 0.7) * (x - 0.7) - 1e-15
        });
        assert!((at - 0.7).abs() < 3e-8 && value < 0.0, "{at} {value}");
        assert!(evaluations <= 8, "{evaluations}");
    }

    #[test]
    fn it_stops_where_it_is_low_enough() {
        let (at, value) = minimum(0.0, 1.0, -0.1, |x| -x);
        assert!(value < -0.1 && at < 0.5, "{at} {value}");
    }

    #[test]
    fn corners_ends_and_plateaus_are_no_obstacle() {
        let at = |f: fn(f64) -> f64| minimum(0.0, 1.0, f64::NEG_INFINITY, f).0;
        assert!((at(|x| (x - 0.123).abs()) - 0.123).abs() < 1e-7);
        assert!((at(|x| libm::pow((x - 0.9).abs(), 0.3)) - 0.9).abs() < 1e-6);
        assert!(at(|x| x) < 1e-7 && at(|x| -x) > 1.0 - 1e-7);
        assert!((0.0..=1.0).contains(&at(|_| 1.0)) && (0.0..=1.0).contains(&at(|_| f64::NAN)));
    }
}
