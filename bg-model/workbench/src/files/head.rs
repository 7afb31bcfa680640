//! The first line of a CSV file: names of columns, perhaps with units, or numbers already.

use csv::StringRecord;

/// What the first line of a file is.
pub enum Head {
    /// The names of the columns.
    Names,
    /// A row.
    Numbers,
    /// Neither: it has both of them.
    Mixed {
        /// Its first field that is no number.
        name: String,
        /// Its first one that is.
        number: String,
    },
}

/// What the first line is. An empty field is neither a name nor a number: a head may lack a name, and a row a value.
pub fn head(first: &StringRecord) -> Head {
    let filled = || first.iter().filter(|field| !field.trim().is_empty());
    let is_number = |field: &&str| field.trim().parse::<f64>().is_ok();
    match (filled().find(|field| !is_number(field)), filled().find(is_number)) {
        (Some(name), Some(number)) => Head::Mixed { name: name.to_owned(), number: number.to_owned() },
        (None, Some(_)) => Head::Numbers,
        (_, None) => Head::Names,
    }
}

/// The name of a column and, where its head has one in brackets, the unit of its values: `speed [rpm]`. Brackets that
/// stand at a name without a blank are part of it, as in `wagon[0].x`.
pub fn name_and_unit(head: &str) -> (&str, Option<&str>) {
    let inside = head.trim_end().strip_suffix(']').and_then(|head| head.rsplit_once('['));
    match inside {
        Some((name, unit)) if name.ends_with(char::is_whitespace) => (name.trim(), Some(unit.trim())),
        _ => (head.trim(), None),
    }
}

/// Whether the first line is a row, where it has to be names.
pub fn is_row(first: &StringRecord) -> bool {
    matches!(head(first), Head::Numbers)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_head_may_have_a_unit() {
        for (head, expected) in [
            ("speed [rpm]", ("speed", Some("rpm"))),
            (" t [ s ] ", ("t", Some("s"))),
            ("count []", ("count", Some(""))),
            ("wagon[0].x [mm]", ("wagon[0].x", Some("mm"))),
            ("wagon[0]", ("wagon[0]", None)),
            ("load", ("load", None)),
        ] {
            assert_eq!(name_and_unit(head), expected);
        }
    }
}
