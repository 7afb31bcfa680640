//! Instants of samples that print as they are meant.

/// The instants `from`, the multiples of `step` after it, and `to`, s.
///
/// Where `step` is the reciprocal of a whole number n, the multiples are the quotients k / n, so that they print as
/// `0.3` and not as `0.30000000000000004`. `to` is the last instant even where it is no multiple of `step`.
#[must_use]
pub fn sample_times(from: f64, step: f64, to: f64) -> Vec<f64> {
    // Rounding of a decimal step is below 1e-16 relative; anything nearer than this is meant to be the reciprocal.
    const RECIPROCAL: f64 = 1e-12;
    let per_second = (1.0 / step).round();
    let is_reciprocal = per_second >= 1.0 && (per_second * step - 1.0).abs() < RECIPROCAL;
    let time = |k: u64| if is_reciprocal { k as f64 / per_second } else { k as f64 * step };
    // A multiple that all but equals an end is that end.
    let margin = 1e-9 * step;
    let first = (from / step).floor().max(0.0) as u64;
    let inside = (first..).map(time).skip_while(|&t| t < from + margin).take_while(|&t| t < to - margin);
    let start = (from < to).then_some(from);
    start.into_iter().chain(inside).chain(std::iter::once(to)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn multiples_print_as_they_are_meant() {
        assert_eq!(sample_times(0.0, 0.1, 0.5), [0.0, 0.1, 0.2, 0.3, 0.4, 0.5]);
        assert_eq!(sample_times(0.0, 0.3, 1.0), [0.0, 0.3, 0.6, 3.0 * 0.3, 1.0]);
        assert_eq!(sample_times(0.0, 2.0, 5.0), [0.0, 2.0, 4.0, 5.0]);
        assert_eq!(sample_times(0.0, 0.01, 5.0).len(), 501);
    }

    #[test]
    fn a_run_that_goes_on_has_the_same_multiples() {
        assert_eq!(sample_times(0.25, 0.1, 0.5), [0.25, 0.3, 0.4, 0.5]);
        assert_eq!(sample_times(0.3, 0.1, 0.5), [0.3, 0.4, 0.5]);
        assert_eq!(sample_times(1.0, 0.1, 1.0), [1.0]);
    }
}
