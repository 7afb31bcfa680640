//! Figures of a model's outputs: for each observed quantity its components over time, one panel each.
//!
//! In: a description. Out: the figures. The components of a vector share one scale, and so do those of a matrix, which has a
//! panel for each row.

use std::sync::Arc;

use bg_model::description::{Description, OutputInfo};
use bg_model::simulation::Recording;
use plotters::style::RGBColor;

use super::canvas::{Rectangle, figure, literally};
use super::palette::{AXES, INK};
use super::panel::{OverTime, RIGHT, STILL, VALUE_LABELS, extent, row_plot, time_span, widened};
use super::{Figure, FigureError};

/// The most outputs that get figures of their own; a run with more has them in its CSV file.
const MOST: usize = 60;

/// A figure for each observed quantity.
#[must_use]
pub fn figures(description: &'static Description) -> Vec<Figure> {
    let quantities = description.outputs.chunk_by(|a, b| a.of == b.of).take(MOST);
    quantities.map(quantity).collect()
}

/// The figure of one quantity, given its components.
fn quantity(components: &'static [OutputInfo]) -> Figure {
    let (of, unit) = (components[0].of, components[0].unit);
    let title = if matches!(unit, "" | "1") { of.to_owned() } else { format!("{of} in {unit}") };
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
    let range = widened(extent(curves.iter().flat_map(|values| values.iter().copied())), STILL);
    let in_panel = if components.len() > 3 { 3 } else { 1 };
    let panels = components.len() / in_panel;
    figure(heading, |area| {
        for (row, (outputs, values)) in components.chunks(in_panel).zip(curves.chunks(in_panel)).enumerate() {
            let plot =
                row_plot(row as i32, panels as i32, VALUE_LABELS, Rectangle::CONTENT.width - VALUE_LABELS - RIGHT);
            let names: Vec<&str> = outputs.iter().map(|output| output.name).collect();
            let panel = OverTime {
                caption: literally(&names.join(", ")),
                colour: if components.len() == 1 { INK.light } else { colour(row) },
                times,
                values: values[0],
                span: time_span(*start, *end),
                range: range.clone(),
                time_description: (row + 1 == panels).then(|| "t in s".to_owned()),
            };
            let more: Vec<(&[f64], RGBColor)> =
                values.iter().enumerate().skip(1).map(|(k, values)| (*values, colour(row + k))).collect();
            panel.draw_with(area, plot, &more)?;
        }
        Ok(())
    })
}

fn colour(index: usize) -> RGBColor {
    AXES[index % AXES.len()].light
}
