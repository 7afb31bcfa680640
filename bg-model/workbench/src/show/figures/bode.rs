//! The Bode diagram: magnitude and phase of an output's answer to an input over the frequency.
//!
//! In: a frequency response. Out: SVG, the magnitude above with both axes logarithmic, the phase in degrees below.

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::FigureError;
use super::canvas::{Area, Rectangle, drawing, figure, literally, text, write};
use super::palette::{AXES, INK};
use super::panel::{Axis, CAPTION, LINE, RIGHT, VALUE_LABELS, chart, extent, row_plot, widened};
use bg_analysis::linear::Response;

/// Draws the diagram.
///
/// # Errors
/// There is no finite point to draw, or the drawing crate refuses.
pub fn bode(response: &Response) -> Result<String, FigureError> {
    let Response { input, output, frequency, magnitude, phase } = response;
    let hertz = frequency.iter().map(|frequency| (frequency / std::f64::consts::TAU).log10());
    let magnitudes = points(hertz.clone(), magnitude.iter().map(|magnitude| magnitude.log10()));
    let phases = points(hertz, phase.iter().map(|phase| phase.to_degrees()));
    if magnitudes.is_empty() {
        return Err(FigureError::Empty);
    }
    let span = extent(magnitudes.iter().map(|point| point.0));
    let heading = format!("{} over {}", output.name, input.name);
    let unit = format!("magnitude in ({})/({})", output.unit, input.unit);
    // Half a decade is the least that is worth an axis of powers, a degree the least of an angle.
    let powers = Axis::of_powers(widened(extent(magnitudes.iter().map(|point| point.1)), 0.5), 6);
    let degrees = Axis::over(widened(extent(phases.iter().map(|point| point.1)), 1.0), 6);
    figure(&heading, |area| {
        let frequencies = || Axis::of_powers(span.clone(), 10);
        panel(area, 0, &unit, frequencies(), powers, &magnitudes, AXES[0].light)?;
        panel(area, 1, "phase in degrees", frequencies(), degrees, &phases, AXES[1].light)
    })
}

/// The points with finite coordinates.
fn points(x: impl Iterator<Item = f64>, y: impl Iterator<Item = f64>) -> Vec<(f64, f64)> {
    x.zip(y).filter(|(x, y)| x.is_finite() && y.is_finite()).collect()
}

fn panel(
    area: &Area,
    row: i32,
    caption: &str,
    horizontal: Axis,
    vertical: Axis,
    points: &[(f64, f64)],
    colour: RGBColor,
) -> Result<(), FigureError> {
    let plot = row_plot(row, 2, VALUE_LABELS, Rectangle::CONTENT.width - VALUE_LABELS - RIGHT);
    write(area, &literally(caption), (plot.x, plot.y - CAPTION + 3), &text(13, INK.light, HPos::Left))?;
    let below = (row == 1).then_some("frequency in Hz");
    let mut chart = chart(area, plot, horizontal, vertical, below)?;
    chart.draw_series([PathElement::new(points.to_vec(), colour.stroke_width(LINE))]).map_err(drawing)?;
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use bg_analysis::linear::Named;

    fn response(frequency: Vec<f64>, magnitude: Vec<f64>) -> Response {
        let named = |name: &str, unit: &str| Named { name: name.to_owned(), unit: unit.to_owned() };
        let phase = vec![-0.5; frequency.len()];
        Response { input: named("force", "N"), output: named("pin_x", "m"), frequency, magnitude, phase }
    }

    #[test]
    fn a_response_is_drawn_with_its_names_and_units() {
        let svg = bode(&response(vec![1.0, 10.0, 100.0], vec![1.0, f64::INFINITY, 1e-4])).unwrap();
        assert!(svg.contains("pin_x over force") || svg.contains("aria-label=\"pin_x over force\""), "{svg}");
        assert!(svg.contains("magnitude in (m)/(N)") && svg.contains("frequency in Hz"), "{svg}");
    }

    #[test]
    fn a_response_without_a_number_is_not_drawn() {
        assert!(matches!(bode(&response(vec![1.0], vec![0.0])), Err(FigureError::Empty)));
    }
}
