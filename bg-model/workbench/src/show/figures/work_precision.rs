//! The work-precision diagram: what an error costs, one curve for each integrator.
//!
//! In: for each integrator its points, error and cost. Out: SVG with both axes logarithmic, small errors at the right,
//! as in the SciML benchmarks; lower and further right is better. The legend stands beside the diagram, in the order of
//! the cost at the smallest common error as far as there is one.

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::FigureError;
use super::canvas::{Area, Rectangle, UNITS, drawing, figure, text, write};
use super::palette::{CURVES, INK};
use super::panel::{Axis, CAPTION, Chart, LINE, TIME_LABELS, VALUE_LABELS, chart, extent};

/// The points of one integrator.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Its name in the legend.
    pub name: String,
    /// Error and cost, both positive, in the order of the tolerances; others are left out.
    pub points: Vec<(f64, f64)>,
}

/// Width of the legend, CSS pixels.
const LEGEND: i32 = 210;
/// Height of a line of the legend, CSS pixels.
const ENTRY: i32 = 19;
/// Half the size of a marker, units of drawing.
const MARKER: i32 = 4 * UNITS;

/// Draws the diagram. `error` and `cost` say what the axes are, with units.
///
/// # Errors
/// There is no point to draw, or the drawing crate refuses.
pub fn work_precision(heading: &str, error: &str, cost: &str, curves: &[Curve]) -> Result<String, FigureError> {
    let logarithms = |curve: &Curve| -> Vec<(f64, f64)> {
        let positive = curve.points.iter().filter(|(error, cost)| *error > 0.0 && *cost > 0.0);
        // Small errors at the right.
        positive.map(|(error, cost)| (-error.log10(), cost.log10())).filter(|(x, y)| (x + y).is_finite()).collect()
    };
    let curves: Vec<(&str, Vec<(f64, f64)>)> =
        curves.iter().map(|curve| (curve.name.as_str(), logarithms(curve))).collect();
    let all = || curves.iter().flat_map(|(_, points)| points.iter().copied());
    if all().next().is_none() {
        return Err(FigureError::Empty);
    }
    let whole = |values: std::ops::Range<f64>| (values.start - 0.1).floor()..(values.end + 0.1).ceil();
    let (errors, costs) = (whole(extent(all().map(|point| point.0))), whole(extent(all().map(|point| point.1))));
    figure(heading, |area| {
        let content = Rectangle::CONTENT;
        let plot = Rectangle {
            x: content.x + VALUE_LABELS,
            y: content.y + CAPTION,
            width: content.width - VALUE_LABELS - LEGEND,
            height: content.height - CAPTION - TIME_LABELS,
        };
        write(area, cost, (plot.x, content.y), &text(13, INK.light, HPos::Left))?;
        let horizontal = Axis::of_powers(errors, 14).falling();
        let mut chart = chart(area, plot, horizontal, Axis::of_powers(costs, 8), Some(error))?;
        for (index, (name, points)) in curves.iter().enumerate() {
            draw_curve(&mut chart, index, points)?;
            entry(area, index, name, (plot.x + plot.width + 24, plot.y + ENTRY * index as i32))?;
        }
        Ok(())
    })
}

fn colour(index: usize) -> RGBColor {
    CURVES[index % CURVES.len()].light
}

/// Squares and open circles take turns with each round through the colours.
fn is_open(index: usize) -> bool {
    (index / CURVES.len()) % 2 == 1
}

fn draw_curve(chart: &mut Chart, index: usize, points: &[(f64, f64)]) -> Result<(), FigureError> {
    let colour = colour(index);
    chart.draw_series([PathElement::new(points.to_vec(), colour.stroke_width(LINE))]).map_err(drawing)?;
    let markers = points.iter().map(|point| marker(*point, index));
    chart.draw_series(markers).map_err(drawing)?;
    Ok(())
}

fn marker<C>(at: C, index: usize) -> Circle<C, i32> {
    let style: ShapeStyle = if is_open(index) { colour(index).stroke_width(LINE) } else { colour(index).filled() };
    Circle::new(at, MARKER, style)
}

/// A line of the legend with its left end at `at` (CSS pixels).
fn entry(area: &Area, index: usize, name: &str, at: (i32, i32)) -> Result<(), FigureError> {
    let middle = ((at.0 + 12) * UNITS, (at.1 + ENTRY / 2) * UNITS);
    let ends = [(at.0 * UNITS, middle.1), ((at.0 + 24) * UNITS, middle.1)];
    area.draw(&PathElement::new(ends.to_vec(), colour(index).stroke_width(LINE))).map_err(drawing)?;
    area.draw(&marker(middle, index)).map_err(drawing)?;
    write(area, name, (at.0 + 32, at.1 + 3), &text(12, INK.light, HPos::Left))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_and_legend_are_drawn() {
        let curve = |name: &str, points: &[(f64, f64)]| Curve { name: name.to_owned(), points: points.to_vec() };
        let curves = [
            curve("one", &[(1e-3, 2.0), (1e-6, 5.0), (1e-9, 20.0)]),
            curve("two", &[(1e-4, 30.0), (0.0, 1.0), (f64::NAN, 1.0)]),
        ];
        let svg = work_precision("A diagram", "error in m", "time in ms", &curves).unwrap();
        assert_eq!(svg.matches("<circle").count(), 4 + 2, "a point that is no number has no place");
        for text in ["one", "two", "A diagram", "10\u{207B}\u{2076}"] {
            assert!(svg.contains(text), "{text}");
        }
        assert!(matches!(work_precision("", "", "", &[]), Err(FigureError::Empty)));
    }
}
