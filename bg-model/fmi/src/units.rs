//! Units as FMI has them: powers of the SI base units.
//!
//! In: a unit as a model's description writes it. Out: its exponents. Only coherent SI units exist there, so none has a
//! factor. Source: the SI Brochure, 9th edition, tables 2 and 4; of FMI 3.0 section 2.4.3, which counts rad among the
//! bases.

/// The symbols of the bases, in the order of the exponents: the names of the attributes of `BaseUnit`.
pub(crate) const BASES: [&str; 8] = ["kg", "m", "s", "A", "K", "mol", "cd", "rad"];

/// Symbols of derived units and their exponents.
const DERIVED: [(&str, [i32; 8]); 17] = [
    ("Hz", [0, 0, -1, 0, 0, 0, 0, 0]),
    ("N", [1, 1, -2, 0, 0, 0, 0, 0]),
    ("Pa", [1, -1, -2, 0, 0, 0, 0, 0]),
    ("J", [1, 2, -2, 0, 0, 0, 0, 0]),
    ("W", [1, 2, -3, 0, 0, 0, 0, 0]),
    ("C", [0, 0, 1, 1, 0, 0, 0, 0]),
    ("V", [1, 2, -3, -1, 0, 0, 0, 0]),
    ("F", [-1, -2, 4, 2, 0, 0, 0, 0]),
    ("Ohm", [1, 2, -3, -2, 0, 0, 0, 0]),
    ("S", [-1, -2, 3, 2, 0, 0, 0, 0]),
    ("Wb", [1, 2, -2, -1, 0, 0, 0, 0]),
    ("T", [1, 0, -2, -1, 0, 0, 0, 0]),
    ("H", [1, 2, -2, -2, 0, 0, 0, 0]),
    ("sr", [0; 8]),
    ("lm", [0, 0, 0, 0, 0, 0, 1, 0]),
    ("kat", [0, 0, -1, 0, 0, 1, 0, 0]),
    ("1", [0; 8]),
];

/// The exponents of a unit; none where they are not whole numbers or a symbol is not known.
pub(crate) fn exponents(unit: &str) -> Option<[i32; 8]> {
    let mut sum = [0; 8];
    for (index, part) in unit.split('/').enumerate() {
        let sign = if index == 0 { 1 } else { -1 };
        for factor in part.split('*') {
            let (symbol, power) = factor.trim().split_once('^').unwrap_or((factor.trim(), "1"));
            let power: i32 = power.trim().parse().ok()?;
            let of_symbol = of_symbol(symbol.trim())?;
            sum = std::array::from_fn(|base| sum[base] + sign * power * of_symbol[base]);
        }
    }
    Some(sum)
}

fn of_symbol(symbol: &str) -> Option<[i32; 8]> {
    let base = BASES.iter().position(|&known| known == symbol);
    let base = base.map(|base| std::array::from_fn(|index| i32::from(index == base)));
    base.or_else(|| DERIVED.iter().find(|(known, _)| *known == symbol).map(|(_, exponents)| *exponents))
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

    #[test]
    fn powers_products_and_quotients_are_counted() {
        assert_eq!(exponents("N*s/m"), Some([1, 0, -1, 0, 0, 0, 0, 0]));
        assert_eq!(exponents("kg*m^2/s"), Some([1, 2, -1, 0, 0, 0, 0, 0]));
        assert_eq!(exponents("rad/s^2"), Some([0, 0, -2, 0, 0, 0, 0, 1]));
        assert_eq!(exponents("1"), Some([0; 8]));
        assert_eq!((exponents("m^(1/2)"), exponents("inch")), (None, None));
    }

    #[test]
    fn a_derivative_has_a_second_less() {
        for unit in ["m", "m/s", "kg*m^2/s", "1", "Pa*s", "rad"] {
            let [of, per] = [unit, &per_second(unit)].map(|unit| exponents(unit).unwrap());
            assert_eq!(per, std::array::from_fn(|base| of[base] - i32::from(base == 2)), "{unit}");
        }
    }
}
