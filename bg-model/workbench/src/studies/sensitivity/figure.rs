//! The figure of influences: parameters over outputs, a bar in each cell.
//!
//! In: how far each output's course moves with each parameter. Out: SVG. The length of a bar is the change of the
//! course for a change of the parameter by its own size, over the course's size, on a logarithmic scale of four
//! decades.

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::{Influence, Measure};
use crate::show::figures::FigureError;
use crate::show::figures::canvas::{Area, Rectangle, UNITS, drawing, figure, literally, text, write};
use crate::show::figures::palette::{CURVES, GRID, INK, PENCIL};

/// Rows and columns at most; what moves most is shown.
const MOST_ROWS: usize = 20;
const MOST_COLUMNS: usize = 10;
/// Width of the parameters' names, CSS pixels.
const NAMES: i32 = 130;
/// Height of the outputs' names, CSS pixels.
const HEAD: i32 = 22;
/// Height of the line below the bars, CSS pixels.
const FOOT: i32 = 22;
/// What a bar's length means.
const SCALE: &str = "length of a bar: logarithmic, from 0.001 to 10";
/// The decades that bars span: an influence of 10 fills a cell, one of 1e-3 is none.
const LONGEST: f64 = 1.0;
const SHORTEST: f64 = -3.0;

/// Draws the figure of the courses among `influences`.
///
/// # Errors
/// There is none, or the drawing crate refuses.
pub fn influence(heading: &str, influences: &[Influence]) -> Result<String, FigureError> {
    let of_courses: Vec<&Influence> = influences.iter().filter(|of| of.measure == Measure::Course).collect();
    let size = |of: &Influence| of.relative().map_or(0.0, f64::abs);
    let most = |name: &str, by: fn(&Influence) -> &'static str| {
        of_courses.iter().filter(|of| by(of) == name).map(|of| size(of)).fold(0.0, f64::max)
    };
    let names = |by: fn(&Influence) -> &'static str, count: usize| {
        let mut names: Vec<&'static str> = Vec::new();
        of_courses.iter().for_each(|of| {
            if !names.contains(&by(of)) {
                names.push(by(of))
            }
        });
        names.retain(|name| most(name, by) > 0.0);
        names.sort_by(|a, b| most(b, by).total_cmp(&most(a, by)));
        names.truncate(count);
        names
    };
    let (rows, columns) = (names(|of| of.parameter, MOST_ROWS), names(|of| of.name, MOST_COLUMNS));
    if rows.is_empty() || columns.is_empty() {
        return Err(FigureError::Empty);
    }
    figure(heading, |area| {
        let content = Rectangle::CONTENT;
        let width = (content.width - NAMES) / columns.len() as i32;
        let height = ((content.height - HEAD - FOOT) / rows.len() as i32).min(34);
        for (column, name) in columns.iter().enumerate() {
            let x = content.x + NAMES + column as i32 * width;
            write(area, &literally(&shortened(name, width)), (x + 4, content.y), &text(12, INK.light, HPos::Left))?;
        }
        for (row, parameter) in rows.iter().enumerate() {
            let y = content.y + HEAD + row as i32 * height;
            write(area, &literally(parameter), (content.x, y + height / 2 - 7), &text(12, INK.light, HPos::Left))?;
            for (column, name) in columns.iter().enumerate() {
                let found = of_courses.iter().find(|of| of.parameter == *parameter && of.name == *name);
                let relative = found.map_or(0.0, |of| size(of));
                let x = content.x + NAMES + column as i32 * width;
                cell(area, Rectangle { x, y, width, height }, relative)?;
            }
        }
        let below = content.y + HEAD + rows.len() as i32 * height + 6;
        write(area, SCALE, (content.x + NAMES + 4, below), &text(11, PENCIL.light, HPos::Left))
    })
}

/// A name that fits into so many pixels.
fn shortened(name: &str, width: i32) -> String {
    let fits = (width / 7).max(3) as usize;
    if name.chars().count() <= fits {
        name.to_owned()
    } else {
        name.chars().take(fits - 1).chain(['\u{2026}']).collect()
    }
}

/// A cell with its bar and its number.
fn cell(area: &Area, place: Rectangle, relative: f64) -> Result<(), FigureError> {
    let Rectangle { x, y, width, height } = place;
    let corners =
        |x: i32, y: i32, width: i32, height: i32| [(x * UNITS, y * UNITS), ((x + width) * UNITS, (y + height) * UNITS)];
    area.draw(&plotters::element::Rectangle::new(
        corners(x, y, width - 4, height - 4),
        GRID.light.stroke_width(UNITS as u32),
    ))
    .map_err(drawing)?;
    let part = ((relative.log10() - SHORTEST) / (LONGEST - SHORTEST)).clamp(0.0, 1.0);
    if relative > 0.0 && part > 0.0 {
        let length = (part * f64::from(width - 6)).round() as i32;
        let bar = corners(x + 1, y + 1, length.max(1), height - 6);
        area.draw(&plotters::element::Rectangle::new(bar, CURVES[5].light.mix(0.55).filled())).map_err(drawing)?;
    }
    let number = if relative == 0.0 {
        "0".to_owned()
    } else if relative < 1e-3 {
        format!("{relative:.0e}")
    } else {
        format!("{relative:.3}")
    };
    let colour = if relative < 1e-3 { PENCIL.light } else { INK.light };
    write(area, &number, (x + 6, y + height / 2 - 8), &text(11, colour, HPos::Left))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(name: &'static str, parameter: &'static str, derivative: f64) -> Influence {
        let measure = Measure::Course;
        Influence { output: 0, name, unit: "N", measure, value: 2.0, parameter, per: "m", at: 1.0, derivative }
    }

    #[test]
    fn what_moves_most_comes_first_and_what_moves_nothing_is_left_out() {
        let svg = influence("How", &[of("force", "still", 0.0), of("force", "weak", 1e-3), of("force", "strong", 2.0)])
            .unwrap();
        let place = |name: &str| svg.find(name);
        assert!(place("strong") < place("weak") && place("still").is_none(), "{svg}");
        assert!(svg.contains("1.000") && svg.contains("5e-4") && svg.contains(SCALE), "{svg}");
        assert!(matches!(influence("", &[of("force", "still", 0.0)]), Err(FigureError::Empty)));
    }
}
