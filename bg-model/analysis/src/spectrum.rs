//! Amplitude spectra of courses, over frequency or over the orders of a shaft.
//!
//! In: values at instants. Out: an amplitude for each frequency (Hz) or order (per turn). Method: values at equal
//! distances in time or angle by straight lines, less their mean, under a Hann window, by the crate `rustfft`; divided by
//! the window's mean, so that a sine of a frequency in the list has its own amplitude (F. J. Harris, Proc. IEEE 66 (1978)
//! 51).

use std::f64::consts::TAU;

use rustfft::FftPlanner;
use rustfft::num_complex::Complex;

/// A spectrum: what it is over, and the amplitude there.
pub type Spectrum = Vec<(f64, f64)>;

/// The amplitudes of `values` at `times` (s, ascending) over frequency above zero, Hz, in the values' unit; nothing of fewer
/// than four values.
#[must_use]
pub fn over_frequency(times: &[f64], values: &[f64]) -> Spectrum {
    spectrum(times, values)
}

/// The same over the orders of a shaft: how often a turn. `angles` are those of the shaft at the values, rad, with its
/// turns; where it turns back, values are left out.
#[must_use]
pub fn over_order(angles: &[f64], values: &[f64]) -> Spectrum {
    let turns = angles.last().zip(angles.first()).map_or(0.0, |(last, first)| last - first);
    let sign = if turns < 0.0 { -1.0 } else { 1.0 };
    let mut onward: Vec<(f64, f64)> = Vec::with_capacity(values.len());
    for (angle, value) in angles.iter().zip(values) {
        let turn = sign * angle / TAU;
        if onward.last().is_none_or(|(last, _)| turn > *last) {
            onward.push((turn, *value));
        }
    }
    let (turns, values): (Vec<f64>, Vec<f64>) = onward.into_iter().unzip();
    spectrum(&turns, &values)
}

fn spectrum(places: &[f64], values: &[f64]) -> Spectrum {
    const FEWEST: usize = 4;
    let (Some(first), Some(last)) = (places.first(), places.last()) else { return Vec::new() };
    let count = values.len();
    if count < FEWEST || last <= first {
        return Vec::new();
    }
    // As many equal distances as there were values: the last one is the first one of the next period.
    let step = (last - first) / (count - 1) as f64;
    let even: Vec<f64> = (0..count).map(|k| at(places, values, first + step * k as f64)).collect();
    let window = |k: usize| 0.5 - 0.5 * (TAU * k as f64 / count as f64).cos();
    let weight = (0..count).fold(0.0, |sum, k| sum + window(k));
    let mean = (0..count).fold(0.0, |sum, k| sum + window(k) * even[k]) / weight;
    let mut numbers: Vec<Complex<f64>> =
        even.iter().enumerate().map(|(k, value)| Complex::new((value - mean) * window(k), 0.0)).collect();
    FftPlanner::new().plan_fft_forward(count).process(&mut numbers);
    let length = step * count as f64;
    (1..=count / 2).map(|k| (k as f64 / length, 2.0 * numbers[k].norm() / weight)).collect()
}

/// The value at `place`, on a straight line between those beside it.
fn at(places: &[f64], values: &[f64], place: f64) -> f64 {
    let next = places.partition_point(|known| *known < place).clamp(1, places.len() - 1);
    let (a, b) = (places[next - 1], places[next]);
    let part = if b > a { ((place - a) / (b - a)).clamp(0.0, 1.0) } else { 1.0 };
    values[next - 1] + part * (values[next] - values[next - 1])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn peak(spectrum: &Spectrum) -> (f64, f64) {
        *spectrum.iter().max_by(|a, b| a.1.total_cmp(&b.1)).unwrap()
    }

    #[test]
    fn a_sine_has_its_frequency_and_its_amplitude() {
        // 1000 values over 10 s, so that 3 Hz is in the list; a mean is no amplitude.
        let times: Vec<f64> = (0..1000).map(|k| 0.01 * f64::from(k)).collect();
        let values: Vec<f64> = times.iter().map(|t| 5.0 + 0.7 * (TAU * 3.0 * t).sin()).collect();
        let found = over_frequency(&times, &values);
        let (frequency, amplitude) = peak(&found);
        assert!((frequency - 3.0).abs() < 1e-9 && (amplitude - 0.7).abs() < 1e-9, "{frequency} {amplitude}");
        assert!(found.iter().all(|(frequency, amplitude)| (frequency - 3.0).abs() < 0.11 || *amplitude < 1e-9));
        assert!(over_frequency(&times[..3], &values[..3]).is_empty());
    }

    #[test]
    fn what_follows_a_shaft_has_its_order_at_any_speed() {
        // A shaft that speeds up; twice a turn.
        let times: Vec<f64> = (0..20_000).map(|k| 1e-3 * f64::from(k)).collect();
        let angles: Vec<f64> = times.iter().map(|t| TAU * (t + 0.2 * t * t)).collect();
        let values: Vec<f64> = angles.iter().map(|angle| 1.5 * (2.0 * angle).cos()).collect();
        let (order, amplitude) = peak(&over_order(&angles, &values));
        assert!((order - 2.0).abs() < 0.01 && (amplitude - 1.5).abs() < 0.03, "{order} {amplitude}");
        let back: Vec<f64> = angles.iter().map(|angle| -angle).collect();
        assert!((peak(&over_order(&back, &values)).0 - 2.0).abs() < 0.01);
    }
}
