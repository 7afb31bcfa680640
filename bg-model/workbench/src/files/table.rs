//! Cells as a text in columns.

/// Rows with their columns aligned: numbers under their heading to the right, everything else to the left.
#[must_use]
pub fn table<const K: usize>(rows: &[[String; K]]) -> String {
    let widths: [usize; K] =
        std::array::from_fn(|column| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0));
    let below = rows.get(1..).unwrap_or_default();
    let is_number: [bool; K] = std::array::from_fn(|column| {
        below.iter().map(|row| &row[column]).all(|cell| cell.is_empty() || cell.parse::<f64>().is_ok())
    });
    let mut text = String::new();
    for row in rows {
        let mut line = String::new();
        for (column, (cell, width)) in row.iter().zip(widths).enumerate() {
            line += &if is_number[column] { format!("  {cell:>width$}") } else { format!("  {cell:width$}") };
        }
        text += line.trim_end();
        text += "\n";
    }
    text
}

/// Rows with their columns aligned to the left, for a number of columns that is not known.
#[must_use]
pub fn aligned(rows: &[Vec<String>]) -> String {
    let widths: Vec<usize> =
        (0..rows[0].len()).map(|k| rows.iter().map(|row| row[k].chars().count()).max().unwrap_or(0)).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths).map(|(cell, &width)| format!("{cell:<width$}"));
        format!("  {}", cells.collect::<Vec<_>>().join("  ")).trim_end().to_owned() + "\n"
    };
    rows.iter().map(line).collect()
}
