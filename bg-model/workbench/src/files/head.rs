//! The first line of a CSV file: names of columns, or numbers already.

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

/// Whether the first line is a row, where it has to be names.
pub fn is_row(first: &StringRecord) -> bool {
    matches!(head(first), Head::Numbers)
}
