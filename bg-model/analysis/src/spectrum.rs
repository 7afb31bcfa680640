//! Amplitude spectra of courses, over frequency or over the orders of a shaft.
//!
//! In: values at instants. Out: an amplitude for each frequency (Hz) or order (per turn). Method: values at equal
//! distances in time or angle by straight lines, less their mean, under a Hann window, by the crate `rustfft`; divided
//! by the window's mean, so that a sine of a frequency in the list has its own amplitude (F. J. Harris, Proc. IEEE 66
//! (1978) 51).

use std::f64::consts::TAU;
use std::sync::Arc;

use rustfft::algorithm::butterflies::{Butterfly4, Butterfly8};
use rustfft::algorithm::{BluesteinsAlgorithm, Radix4};
use rustfft::num_complex::Complex;
use rustfft::{Fft, FftDirection};

/// A spectrum: what it is over, and the amplitude there.
pub type Spectrum = Vec<(f64, f64)>;

/// The amplitudes of `values` at `times` (s, ascending) over frequency above zero, Hz, in the values' unit; nothing of
/// fewer than four values.
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
    transform(count).process(&mut numbers);
    let length = step * count as f64;
    (1..=count / 2).map(|k| (k as f64 / length, 2.0 * numbers[k].norm() / weight)).collect()
}

/// The transform of `count` numbers, four or more: by Bluestein's algorithm (L. I. Bluestein, IEEE Trans. Audio
/// Electroacoustics 18 (1970) 451) over one whose length is a power of two. The crate's planner would choose among all
/// its algorithms, which are a fifth of the code of this package then.
fn transform(count: usize) -> BluesteinsAlgorithm<f64> {
    let exponent = (2 * count - 1).next_power_of_two().ilog2();
    let inner = if exponent.is_multiple_of(2) {
        Radix4::new_with_base((exponent - 2) / 2, Arc::new(Butterfly4::new(FftDirection::Forward)))
    } else {
        Radix4::new_with_base((exponent - 3) / 2, Arc::new(Butterfly8::new(FftDirection::Forward)))
    };
    BluesteinsAlgorithm::new(count, Arc::new(inner))
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

    #[test]
    fn transforms_of_any_length_are_those_by_definition() {
        for count in [4, 5, 8, 12, 31, 37, 64, 100] {
            let numbers: Vec<Complex<f64>> =
                (0..count).map(|k| Complex::new((0.7 * k as f64).sin(), (1.3 * k as f64).cos())).collect();
            let mut found = numbers.clone();
            transform(count).process(&mut found);
            for (k, found) in found.iter().enumerate() {
                let turn = |j: usize| Complex::from_polar(1.0, -TAU * ((j * k) % count) as f64 / count as f64);
                let sum: Complex<f64> = numbers.iter().enumerate().map(|(j, number)| number * turn(j)).sum();
                assert!((sum - found).norm() < 1e-13 * count as f64, "{count} {k} {sum} {found}");
            }
        }
    }

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
