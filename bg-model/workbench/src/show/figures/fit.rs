//! The figure of a fit: what was measured with the model's course through it, and what is left.
//!
//! In: instants, measured values with gaps, the model's values. Out: SVG of two panels over one time axis.

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::FigureError;
use super::canvas::{Rectangle, UNITS, drawing, figure, literally, text, write};
use super::palette::{AXES, INK};
use super::panel::{Axis, CAPTION, LINE, RIGHT, VALUE_LABELS, chart, extent, row_plot, time_span, widened};
use crate::run::quantities::set_unit;

/// The most dots; of more every second, third .. is drawn.
const MOST: usize = 2000;

/// Draws the figure of an output called `name`, in `unit`.
///
/// # Errors
/// Nothing was measured, or the drawing crate refuses.
pub fn fit(
    name: &str,
    unit: &str,
    times: &[f64],
    measured: &[Option<f64>],
    model: &[f64],
) -> Result<String, FigureError> {
    let dots: Vec<(f64, f64)> = times.iter().zip(measured).filter_map(|(t, value)| Some((*t, (*value)?))).collect();
    let (Some(first), Some(last)) = (times.first(), times.last()) else { return Err(FigureError::Empty) };
    if dots.is_empty() {
        return Err(FigureError::Empty);
    }
    let left: Vec<(f64, f64)> =
        times.iter().zip(measured).zip(model).filter_map(|((t, value), model)| Some((*t, (*value)? - model))).collect();
    let curve: Vec<(f64, f64)> = times.iter().copied().zip(model.iter().copied()).collect();
    let unit = if unit.is_empty() { String::new() } else { format!(" in {}", set_unit(unit)) };
    let values = dots.iter().chain(&curve).map(|dot| dot.1);
    let largest = left.iter().fold(0.0_f64, |largest, dot| largest.max(dot.1.abs()));
    let panels = [
        (format!("measured (dots) and model (line){unit}"), extent(values), dots, Some(curve)),
        (format!("measured less model{unit}"), -largest..largest, left, None),
    ];
    figure(&literally(&format!("{name}: fit and residuals")), |area| {
        for (row, (caption, range, dots, curve)) in panels.into_iter().enumerate() {
            let plot = row_plot(row as i32, 2, VALUE_LABELS, Rectangle::CONTENT.width - VALUE_LABELS - RIGHT);
            write(area, &caption, (plot.x, plot.y - CAPTION + 3), &text(13, INK.light, HPos::Left))?;
            let below = (row == 1).then_some("t in s");
            let time = Axis::over(time_span(*first, *last), plot.width as usize / 70);
            let vertical = Axis::over(widened(range, f64::MIN_POSITIVE), plot.height as usize / 28);
            let mut chart = chart(area, plot, time, vertical, below)?;
            let every = dots.len().div_ceil(MOST).max(1);
            let dot = |at: &(f64, f64)| Circle::new(*at, 2 * UNITS, AXES[1].light.filled());
            chart.draw_series(dots.iter().step_by(every).map(dot)).map_err(drawing)?;
            if let Some(curve) = curve {
                chart.draw_series([PathElement::new(curve, AXES[0].light.stroke_width(LINE))]).map_err(drawing)?;
            }
        }
        Ok(())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_measured_value_is_a_dot_in_both_panels() {
        let svg = fit("speed", "m/s", &[0.0, 1.0, 2.0], &[Some(1.0), None, Some(2.5)], &[1.1, 2.0, 2.4]).unwrap();
        assert_eq!(svg.matches("<circle").count(), 4, "{svg}");
        assert!(svg.contains("speed") && svg.contains("measured less model in m/s"), "{svg}");
        assert!(matches!(fit("speed", "", &[0.0], &[None], &[1.0]), Err(FigureError::Empty)));
    }
}
