//! Figures of a model's outputs: for each observed quantity its components over time, one panel each.
//!
//! In: a description. Out: the figures. The components of a vector share one scale, and so do those of a matrix, which
//! has a panel for each row: there the colour says the column.

use std::ops::Range;
use std::sync::Arc;

use bg_model::description::{Description, OutputInfo};
use bg_model::simulation::Recording;
use plotters::style::RGBColor;
use plotters::style::text_anchor::HPos;

use super::canvas::{Rectangle, figure, literally, text, write};
use super::palette::{AXES, INK};
use super::panel::{CAPTION, OverTime, RIGHT, STILL, VALUE_LABELS, row_plot, time_span, widened};
use super::{Figure, FigureError};
use crate::run::quantities::{extent, quantities, set_unit};

/// The most outputs that get figures of their own; a run with more has them in its CSV file.
const MOST: usize = 60;

/// A figure for each observed quantity.
#[must_use]
pub fn figures(description: &'static Description) -> Vec<Figure> {
    quantities(description).take(MOST).map(quantity).collect()
}

/// The figure of one quantity, given its components.
fn quantity(components: &'static [OutputInfo]) -> Figure {
    let (of, unit) = (components[0].of, components[0].unit);
    let title = if matches!(unit, "" | "1") { of.to_owned() } else { format!("{of} in {}", set_unit(unit)) };
    let heading = title.clone();
    Figure {
        file: format!("{of}.svg"),
        anchor: format!("figure-{of}"),
        title,
        caption: String::new(),
        draw: Arc::new(move |recording| draw(&heading, recording, components)),
    }
}

/// Each panel's curves: of a scalar and a vector one each, of a matrix the entries of a row.
fn draw(heading: &str, recording: &Recording, components: &[OutputInfo]) -> Result<String, FigureError> {
    let curves = components.iter().map(|output| recording.values(output.name)).collect::<Result<Vec<_>, _>>()?;
    let times = &recording.times;
    let (Some(start), Some(end)) = (times.first(), times.last()) else { return Err(FigureError::Empty) };
    let range = extent(curves.iter().flat_map(|values| values.iter().copied()));
    let alike = recording.columns.iter().filter(|column| column.unit == components[0].unit);
    let beside = extent(alike.flat_map(|column| column.values.iter().copied()));
    let range = widened(range.clone(), least_span(&range, &beside));
    let in_panel = if components.len() > 3 { 3 } else { 1 };
    let panels = components.len() / in_panel;
    figure(&literally(heading), |area| {
        for (row, (outputs, values)) in components.chunks(in_panel).zip(curves.chunks(in_panel)).enumerate() {
            let plot =
                row_plot(row as i32, panels as i32, VALUE_LABELS, Rectangle::CONTENT.width - VALUE_LABELS - RIGHT);
            let colour = |column: usize| match (components.len(), in_panel) {
                (1, _) => INK.light,
                (_, 1) => AXES[row % AXES.len()].light,
                _ => AXES[column % AXES.len()].light,
            };
            // Of several curves each has its name in its colour.
            for (column, output) in outputs.iter().enumerate().skip(1) {
                let left = plot.x + column as i32 * name_width(outputs);
                write(
                    area,
                    &literally(output.name),
                    (left, plot.y - CAPTION + 3),
                    &text(13, colour(column), HPos::Left),
                )?;
            }
            let panel = OverTime {
                caption: literally(outputs[0].name),
                colour: colour(0),
                times,
                values: values[0],
                span: time_span(*start, *end),
                range: range.clone(),
                time_description: (row + 1 == panels).then(|| "t in s".to_owned()),
            };
            let more: Vec<(&[f64], RGBColor)> =
                values.iter().enumerate().skip(1).map(|(column, values)| (*values, colour(column))).collect();
            panel.draw_with(area, plot, &more)?;
        }
        Ok(())
    })
}

/// Space for the longest of these names with a gap after it, CSS pixels.
fn name_width(outputs: &[OutputInfo]) -> i32 {
    let longest = outputs.iter().map(|output| output.name.chars().count()).max();
    8 * longest.unwrap_or(0) as i32 + 16
}

/// The smallest span that a panel of values in `range` shows, so that rounding noise does not fill it: that of zeros
/// beside other values of the unit, which are in `beside`.
fn least_span(range: &Range<f64>, beside: &Range<f64>) -> f64 {
    const NOTHING: f64 = 1e-12;
    let magnitude = |of: &Range<f64>| of.start.abs().max(of.end.abs());
    let size = if magnitude(range) > NOTHING * magnitude(beside) { magnitude(range) } else { magnitude(beside) };
    if size > 0.0 { STILL * size } else { STILL }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_quantity_fills_its_panel_and_noise_does_not() {
        let alone = |range: Range<f64>| least_span(&range, &range);
        assert_eq!([2e-9, 2e-18, 0.0].map(|size| alone(0.0..size)), [STILL * 2e-9, STILL * 2e-18, STILL]);
        assert_eq!(least_span(&(-1e-15..1e-15), &(-1.0..0.5)), STILL);
        assert!(alone(1.0..1.0 + 1e-15) > 1e-9);
    }
}
