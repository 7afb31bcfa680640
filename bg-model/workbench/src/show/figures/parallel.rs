//! Parallel axes: a line for each run through its parameters and what they result in (Inselberg 1985).
//!
//! In: columns of the runs. Out: SVG, an axis for each column, lines in the colour of what stands on the last one. A
//! run that lacks a number has no line.

use std::ops::Range;

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::FigureError;
use super::canvas::{Rectangle, UNITS, drawing, figure, literally, text, write};
use super::palette::{AXIS, INK, PAPER, PENCIL};
use super::panel::{Axis, LINE, extent};
use super::plot::shade;

/// A column of runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Column<'a> {
    /// Its name.
    pub name: &'a str,
    /// Its unit.
    pub unit: &'a str,
    /// Its value in each run.
    pub values: &'a [f64],
}

/// The most lines: of more runs every second, third .. has one.
const MOST: usize = 500;
/// The steps of colour.
const SHADES: usize = 24;
/// Width of a letter of 12 pixels, CSS pixels.
const LETTER: i32 = 7;
/// Space above the axes for names and units, below them for the least values, at both sides, CSS pixels.
const ABOVE: i32 = 56;
const BELOW: i32 = 22;
const BESIDE: i32 = 70;
/// The space between two steps of an axis, CSS pixels.
const STEP: usize = 60;

/// Draws runs through `columns`, the last of which gives the colour.
///
/// # Errors
/// There are fewer than two columns or no run with all numbers, or the drawing crate refuses.
pub fn parallel(heading: &str, columns: &[Column<'_>]) -> Result<String, FigureError> {
    let Some((last, swept)) = columns.split_last().filter(|(_, swept)| !swept.is_empty()) else {
        return Err(FigureError::Empty);
    };
    let all: Vec<usize> =
        (0..last.values.len()).filter(|&run| columns.iter().all(|column| column.values[run].is_finite())).collect();
    if all.is_empty() {
        return Err(FigureError::Empty);
    }
    let mut runs: Vec<usize> = all.iter().copied().step_by(all.len().div_ceil(MOST)).collect();
    // Lines of one colour together, the largest values on top.
    runs.sort_by(|&a, &b| last.values[a].total_cmp(&last.values[b]));
    let ranges: Vec<Range<f64>> =
        columns.iter().map(|column| extent(all.iter().map(|&run| column.values[run]))).collect();
    let content = Rectangle::CONTENT;
    let (top, height) = (content.y + ABOVE, content.height - ABOVE - BELOW);
    let gap = (content.width - 2 * BESIDE) / swept.len() as i32;
    let left = |place: usize| content.x + BESIDE + place as i32 * gap;
    let part = |place: usize, value: f64| {
        let Range { start, end } = ranges[place];
        if end > start { (value - start) / (end - start) } else { 0.5 }
    };
    let at = |place: usize, value: f64| {
        let y = f64::from(top * UNITS) + (1.0 - part(place, value)) * f64::from(height * UNITS);
        (left(place) * UNITS, y.round() as i32)
    };
    figure(&literally(heading), |area| {
        for &run in &runs {
            let step = (part(swept.len(), last.values[run]) * SHADES as f64).min(SHADES as f64 - 1.0).floor();
            let colour = shade((step + 0.5) / SHADES as f64).mix(0.6).stroke_width(LINE);
            let line = columns.iter().enumerate().map(|(place, column)| at(place, column.values[run]));
            area.draw(&PathElement::new(line.collect::<Vec<_>>(), colour)).map_err(drawing)?;
        }
        for (place, column) in columns.iter().enumerate() {
            let ends = [ranges[place].start, ranges[place].end].map(|value| at(place, value));
            let axis = vec![(ends[0].0, (top + height) * UNITS), (ends[0].0, top * UNITS)];
            area.draw(&PathElement::new(axis, AXIS.light.stroke_width(2 * LINE))).map_err(drawing)?;
            let letters = (gap / LETTER).max(4) as usize;
            let [name, unit] = [text(12, INK.light, HPos::Center), text(12, PENCIL.light, HPos::Center)];
            write(area, &literally(&shortened(column.name, letters)), (left(place), content.y), &name)?;
            if !matches!(column.unit, "" | "1") {
                write(area, &literally(&shortened(column.unit, letters)), (left(place), content.y + 16), &unit)?;
            }
            // Beside the last axis there are no lines; elsewhere a label has a ground of its own.
            let is_last = place == swept.len();
            let side = if is_last { 1 } else { -1 };
            let label = |words: &str, y: i32| {
                let wide = 7 * words.chars().count() as i32 + 4;
                let x = left(place) + 7 * side;
                if !is_last {
                    let corners = [((x - wide) * UNITS, y - 7 * UNITS), ((x + 2) * UNITS, y + 7 * UNITS)];
                    area.draw(&plotters::element::Rectangle::new(corners, PAPER.light.mix(0.8).filled()))
                        .map_err(drawing)?;
                }
                let style = text(11, INK.light, if is_last { HPos::Left } else { HPos::Right });
                write(area, words, (x, y / UNITS - 7), &style)
            };
            let Range { start, end } = ranges[place];
            if end > start {
                let scale = Axis::over(start..end, height as usize / STEP);
                for value in scale.ticks() {
                    let (x, y) = at(place, *value);
                    let tick = vec![(x, y), (x + 5 * UNITS * side, y)];
                    area.draw(&PathElement::new(tick, AXIS.light.stroke_width(LINE))).map_err(drawing)?;
                    label(&scale.tick_label(*value), y)?;
                }
            } else {
                label(&start.to_string(), (top + height / 2) * UNITS)?;
            }
        }
        Ok(())
    })
}

/// A text of at most so many letters.
fn shortened(text: &str, letters: usize) -> String {
    if text.chars().count() <= letters {
        return text.to_owned();
    }
    text.chars().take(letters - 1).chain(['\u{2026}']).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn column<'a>(name: &'a str, values: &'a [f64]) -> Column<'a> {
        Column { name, unit: "m", values }
    }

    #[test]
    fn a_run_with_all_numbers_has_a_line_through_every_axis() {
        let [a, b, c] = [[1.0, 2.0, 3.0], [0.5, 0.5, 0.5], [7.0, f64::NAN, 9.0]];
        let columns = [column("a", &a), column("b_1", &b), column("what results in the end of it all", &c)];
        let svg = parallel("Runs", &columns).unwrap();
        let lines: Vec<&str> = svg.lines().filter(|line| line.contains("stroke-opacity=\"0.6\"")).collect();
        assert_eq!(lines.len(), 2, "{svg}");
        let points = |line: &str| line.split("points=\"").nth(1).unwrap().split('"').next().unwrap().trim().to_owned();
        let [first, last] = [0, 1].map(|k: usize| points(lines[k]));
        // From the foot of the first axis to that of the last, by the middle of what is the same in all runs.
        let places = |text: &str| -> Vec<i32> {
            text.split_whitespace().map(|point| point.split_once(',').unwrap().1.parse().unwrap()).collect()
        };
        let ([low, middle, foot], [high, same, head]) =
            (<[i32; 3]>::try_from(places(&first)).unwrap(), <[i32; 3]>::try_from(places(&last)).unwrap());
        assert!(low == foot && high == head && high < middle && middle == same && middle < low, "{first} {last}");
        assert!(svg.contains("b_1") && svg.contains("what results"), "{svg}");
    }

    #[test]
    fn without_a_whole_run_there_is_no_figure() {
        let none = [f64::NAN];
        assert!(matches!(parallel("", &[column("a", &[1.0]), column("b", &none)]), Err(FigureError::Empty)));
        assert!(matches!(parallel("", &[column("a", &[1.0])]), Err(FigureError::Empty)));
    }

    #[test]
    fn a_long_name_is_cut() {
        assert_eq!([shortened("speed", 5), shortened("speed_mean", 5)], ["speed", "spee\u{2026}"]);
    }
}
