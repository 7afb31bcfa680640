//! The modes of a linear model: how it moves when it is let go.
//!
//! In: the state matrix and its coordinates. Out: for each eigenvalue its frequency and damping, and which bodies and
//! elements take part, in words.
//! Method: eigenvectors and participation factors, see `eigen`.

use bg_model::nalgebra::{Complex, DMatrix};
use serde::Serialize;

use super::coordinates::{Coordinate, Role};
use super::eigen::{EigenPair, eigen_pairs};
use super::error::LinearError;

/// A mode; a pair of complex eigenvalues is one.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Mode {
    /// Real part of the eigenvalue, 1/s: negative where the mode dies out.
    pub real: f64,
    /// Imaginary part of the eigenvalue, rad/s, not negative; its conjugate belongs to the same mode.
    pub imaginary: f64,
    /// The eigenvalue's size, rad/s: the frequency without damping.
    pub natural: f64,
    /// The frequency that is seen, Hz: the imaginary part over 2 pi; 0 where the mode does not swing.
    pub frequency: f64,
    /// Minus the real part over the size: 0 without damping, 1 and more where nothing swings, negative where the mode
    /// grows. None of the eigenvalue 0.
    pub damping: Option<f64>,
    /// What each coordinate does, in the order of the states.
    pub shape: Vec<Participation>,
    /// The bodies, joints and elements that take part most, in words.
    pub words: String,
}

/// What a coordinate does in a mode.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Participation {
    /// The coordinate's name.
    pub name: String,
    /// Its unit.
    pub unit: String,
    /// How much it takes part, 0 to 1, all together 1: its participation factor, which does not depend on units. In an
    /// undamped mode a body's share is its part of the energy.
    pub share: f64,
    /// Its amplitude, in its unit, beside that of the coordinate that takes part most, which is 1. Of coordinates that
    /// are no momenta, where these say what moves.
    pub magnitude: f64,
    /// Its phase beside that coordinate, rad, in -pi..=pi.
    pub phase: f64,
}

/// The modes of the matrix `a` between `coordinates`, the slowest first.
pub(super) fn modes(a: &DMatrix<f64>, coordinates: &[Coordinate]) -> Result<Vec<Mode>, LinearError> {
    let pairs = eigen_pairs(a).ok_or(LinearError::NoEigenvalues)?;
    Ok(pairs.iter().map(|pair| mode(pair, coordinates)).collect())
}

fn mode(pair: &EigenPair, coordinates: &[Coordinate]) -> Mode {
    let natural = pair.value.norm();
    // Momenta say the same as the flows; they speak where there is nothing else, as in the circuit of a motor.
    let is_place = |k: &usize| coordinates[*k].role != Role::Momentum;
    let places: Vec<usize> = (0..coordinates.len()).filter(is_place).collect();
    let in_places: f64 = places.iter().map(|&k| pair.shares[k]).sum();
    let is_shown: Vec<usize> = if in_places > 0.2 { places } else { (0..coordinates.len()).collect() };
    let most =
        is_shown.iter().copied().reduce(|a, b| if pair.shares[b] > pair.shares[a] * (1.0 + 1e-6) { b } else { a });
    let unit = most.map(|most| pair.right[most]).filter(|unit| unit.norm() > 0.0).unwrap_or(Complex::new(1.0, 0.0));
    let part = |k: usize| {
        let component = pair.right[k] / unit;
        Participation {
            name: coordinates[k].name.clone(),
            unit: coordinates[k].unit.to_owned(),
            share: pair.shares[k],
            magnitude: component.norm(),
            phase: if component.norm() > 0.0 { component.arg() } else { 0.0 },
        }
    };
    let shape: Vec<Participation> = (0..coordinates.len()).map(part).collect();
    Mode {
        real: pair.value.re,
        imaginary: pair.value.im,
        natural,
        frequency: pair.value.im / std::f64::consts::TAU,
        damping: (natural > 0.0).then_some(-pair.value.re / natural),
        words: words(&shape, coordinates, in_places > 0.2),
        shape,
    }
}

/// What takes part by 5 % or more, the most first: `rod 100 %: position_x 1 m, rotation_z 3.33 rad`. With `places` the
/// momenta speak only of what has nothing else.
fn words(shape: &[Participation], coordinates: &[Coordinate], places: bool) -> String {
    let mut owners: Vec<(&str, Vec<usize>)> = Vec::new();
    for (k, part) in shape.iter().enumerate() {
        let owner = owner(&part.name).0;
        match owners.iter_mut().find(|(other, _)| *other == owner) {
            Some((_, members)) => members.push(k),
            None => owners.push((owner, vec![k])),
        }
    }
    let share = |members: &[usize]| members.iter().map(|&k| shape[k].share).sum::<f64>();
    owners.sort_by(|a, b| share(&b.1).total_cmp(&share(&a.1)));
    let phrases = owners.iter().map(|(name, members)| (name, share(members), members)).filter(|of| of.1 >= 0.05);
    let phrases = phrases.map(|(name, share, members)| {
        let is_place = |k: &&usize| coordinates[**k].role != Role::Momentum;
        let mut shown: Vec<usize> = members.iter().filter(is_place).copied().collect();
        if !places || shown.is_empty() {
            shown.clone_from(members);
        }
        shown.sort_by(|&a, &b| shape[b].share.total_cmp(&shape[a].share));
        let least = 0.2 * shape[shown[0]].share;
        let parts = shown.iter().map(|&k| &shape[k]).filter(|part| part.share >= least).take(3).map(phrase);
        format!("{name} {:.0} %: {}", 100.0 * share, parts.collect::<Vec<_>>().join(", "))
    });
    phrases.collect::<Vec<_>>().join("; ")
}

/// `rotation_z 0.33 rad at 180 deg`.
fn phrase(part: &Participation) -> String {
    let degrees = part.phase.to_degrees();
    let at = if degrees.abs() < 0.5 || part.magnitude == 0.0 { String::new() } else { format!(" at {degrees:.0} deg") };
    format!("{} {} {}{at}", owner(&part.name).1, significant(part.magnitude), part.unit)
}

/// Whose coordinate it is, and which: `rod` and `position_x`.
fn owner(name: &str) -> (&str, &str) {
    name.split_once('.').unwrap_or((name, name))
}

/// A number to three digits.
fn significant(value: f64) -> String {
    let rounded = format!("{value:.2e}").parse::<f64>().unwrap_or(value);
    if rounded == 0.0 || (1e-3..1e4).contains(&rounded.abs()) { format!("{rounded}") } else { format!("{rounded:e}") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn three_digits() {
        let expected =
            [(0.0, "0"), (1.0, "1"), (4.56789, "4.57"), (12345.0, "1.23e4"), (2.5e-7, "2.5e-7"), (0.0123, "0.0123")];
        for (value, text) in expected {
            assert_eq!(significant(value), text);
        }
    }
}
