//! Units as FMI has them: powers of the SI base units.
//!
//! In: a unit as a model's description writes it. Out: its exponents and its size. Source: of FMI 3.0 section 2.4.3,
//! which counts rad among the bases.

use bg_units::Unit;

/// The symbols of the bases, in the order of the exponents: the names of the attributes of `BaseUnit`.
pub(crate) const BASES: [&str; 8] = ["kg", "m", "s", "A", "K", "mol", "cd", "rad"];

/// What a unit is in the bases: its exponents, and its size; none where they are not whole numbers or a symbol is not
/// known.
pub(crate) fn in_bases(unit: &str) -> Option<([i32; 8], f64)> {
    let unit: Unit = unit.parse().ok()?;
    let powers = unit.dimension.bases()?;
    let exponents = std::array::from_fn(|base| powers.get(base).map_or(unit.angle, |&power| power.into()));
    Some((exponents, unit.size()))
}

/// The unit of a derivative with respect to time.
pub(crate) fn per_second(unit: &str) -> String {
    let unit = unit.trim();
    match unit {
        "" => "1/s".to_owned(),
        // Not `m*s/s`, where that is easily seen.
        _ if unit.ends_with("*s") => unit[..unit.len() - 2].to_owned(),
        _ if unit.ends_with("/s") => format!("{unit}^2"),
        _ => format!("{unit}/s"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn exponents(unit: &str) -> Option<[i32; 8]> {
        in_bases(unit).map(|(exponents, _)| exponents)
    }

    #[test]
    fn powers_products_and_quotients_are_counted() {
        assert_eq!(exponents("N*s/m"), Some([1, 0, -1, 0, 0, 0, 0, 0]));
        assert_eq!(exponents("kg*m^2/s"), Some([1, 2, -1, 0, 0, 0, 0, 0]));
        assert_eq!(exponents("rad/s^2"), Some([0, 0, -2, 0, 0, 0, 0, 1]));
        assert_eq!(exponents("1"), Some([0; 8]));
        assert_eq!((exponents("m^(1/2)"), exponents("furlong")), (None, None));
        assert_eq!(in_bases("kN"), Some(([1, 1, -2, 0, 0, 0, 0, 0], 1e3)));
        assert_eq!(in_bases("rpm"), Some(([0, 0, -1, 0, 0, 0, 0, 1], std::f64::consts::PI / 30.0)));
    }

    #[test]
    fn a_derivative_has_a_second_less() {
        for unit in ["m", "m/s", "kg*m^2/s", "1", "Pa*s", "rad"] {
            let [of, per] = [unit, &per_second(unit)].map(|unit| exponents(unit).unwrap());
            assert_eq!(per, std::array::from_fn(|base| of[base] - i32::from(base == 2)), "{unit}");
        }
    }
}
