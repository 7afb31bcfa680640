//! Fits on growing parts of the data, from several starts.
//!
//! In: a model, data, variables with their starts. Out: the fit that leaves least. Method: where a fit of all data
//! leaves no noise it has come to another minimum, or the model is another one. Then the first part of the data is
//! fitted, in which an oscillation is not yet off by half a turn, and from there twice as much each time; after that
//! the same from starts around the given ones, spread evenly (J. H. Halton, Numer. Math. 2 (1960) 84-90), until noise
//! is left.

use bg_model::mechanism::Followed;
use bg_model::run::Request;

use super::{Data, Identified, IdentifyError, Variable, fitted};

/// The parts of the time that are fitted before all of it.
const PARTS: [f64; 4] = [0.0625, 0.125, 0.25, 0.5];
/// The starts beside the given one.
const STARTS: u32 = 8;
/// How far they are away at most, in parts of a variable's size: of one that is fitted by its logarithm a factor of
/// two.
const FAR: f64 = std::f64::consts::LN_2;
/// The bases of the starts' digits.
const BASES: [u32; 8] = [2, 3, 5, 7, 11, 13, 17, 19];

/// Fits the `variables` of `model`, whose other parameters stay, to `data`; `request` says how runs are integrated.
/// `told` is told of each run the parameters' values and the root of the mean square of residuals in parts of the
/// noise. The fit begins at the variables' starts; only where what it leaves is no noise others follow.
///
/// # Errors
/// [`IdentifyError`].
pub fn identify(
    model: &dyn Followed,
    request: &Request,
    data: &Data,
    variables: &[Variable],
    told: &mut dyn FnMut(&[f64], f64),
) -> Result<Identified, IdentifyError> {
    let mut best = fitted(model, request, data, variables, told)?;
    let (mut evaluations, mut derivatives, mut starts) = (best.evaluations, best.derivatives, 1);
    let mut fit = |data: &Data, variables: &[Variable]| {
        let found = fitted(model, request, data, variables, told).ok()?;
        evaluations += found.evaluations;
        derivatives += found.derivatives;
        Some(found)
    };
    for number in 0..=STARTS {
        if best.has_converged && best.leaves_noise() {
            break;
        }
        starts += 1;
        let mut begun: Vec<Variable> =
            variables.iter().enumerate().map(|(k, of)| moved(of, halton(number, BASES[k % BASES.len()]))).collect();
        for part in PARTS {
            let found = fit(&data.until(part), &begun);
            for (variable, estimate) in begun.iter_mut().zip(found.iter().flat_map(|found| &found.estimates)) {
                variable.start = estimate.value;
            }
        }
        best = fit(data, &begun).filter(|found| found.left() < best.left()).unwrap_or(best);
    }
    let estimates = best.estimates.into_iter().zip(variables);
    let estimates = estimates.map(|(estimate, of)| super::Estimate { variable: of.clone(), ..estimate }).collect();
    Ok(Identified { estimates, evaluations, derivatives, starts, ..best })
}

/// A variable that starts elsewhere, by this part of the way, from -1 to 1.
fn moved(variable: &Variable, way: f64) -> Variable {
    let start = variable.outer(variable.inner(variable.start) + FAR * variable.size() * way);
    Variable { start: start.clamp(variable.lower, variable.upper), ..variable.clone() }
}

/// A number between -1 and 1, the first one 0: the digits of `number` in a base, after the point and in reverse, less
/// one half.
pub(crate) fn halton(number: u32, base: u32) -> f64 {
    if number == 0 {
        return 0.0;
    }
    let (mut rest, mut place, mut value) = (number, 1.0, 0.0);
    while rest > 0 {
        place /= f64::from(base);
        value += f64::from(rest % base) * place;
        rest /= base;
    }
    2.0 * value - 1.0
}

#[cfg(test)]
mod tests {
    use super::halton;

    #[test]
    fn starts_are_spread_evenly_about_the_given_one() {
        let all: Vec<f64> = (0..8).map(|number| halton(number, 2)).collect();
        assert_eq!(all, [0.0, 0.0, -0.5, 0.5, -0.75, 0.25, -0.25, 0.75]);
        assert!((1..9).all(|number| halton(number, 3).abs() < 1.0));
    }
}
