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
