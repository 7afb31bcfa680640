//! Axes: ranges that hold the data, ticks at round numbers, and the panel of one quantity over time.
//!
//! In: values and a rectangle. Out: a drawn panel whose caption names quantity and unit above the axes, so that nothing
//! lies over the data.

use std::ops::Range;

use plotters::coord::ranged1d::{KeyPointHint, Ranged, ValueFormatter};
use plotters::prelude::*;
use plotters::style::RGBColor;
use plotters::style::text_anchor::HPos;

use super::FigureError;
use super::canvas::{Area, Rectangle, UNITS, drawing, label, text, write};
use super::palette::{AXIS, GRID};
use super::thinning;
use crate::run::quantities::superscript;

pub use crate::run::quantities::extent;

/// Height of a caption above its panel, CSS pixels.
pub const CAPTION: i32 = 20;
/// Space for the values' tick labels, CSS pixels.
pub const VALUE_LABELS: i32 = 62;
/// Space for the time's tick labels and description, CSS pixels.
pub const TIME_LABELS: i32 = 40;
/// Space at the right for half a tick label, CSS pixels.
pub const RIGHT: i32 = 14;

/// An axis: its range and the numbers that get a tick.
#[derive(Clone, Debug)]
pub struct Axis {
    /// From the left or lower end to the other.
    pub range: Range<f64>,
    ticks: Vec<f64>,
    step: f64,
    /// For powers of ten by their exponents the sign of those: negative where the axis falls.
    power: Option<f64>,
}

impl Axis {
    /// An axis over exactly `range`, with about `count` ticks at round numbers inside, and with two at least.
    pub fn over(range: Range<f64>, count: usize) -> Self {
        let rough = (range.end - range.start) / count.max(1) as f64;
        // Three steps down the ladder 5, 2, 1 divide by ten at most: one of them has two ticks.
        let mut steps = (0..4).map(|down| round_step(rough, down)).map(|step| (step, ticks(&range, step)));
        let (step, ticks) = steps.find(|(_, ticks)| ticks.len() > 1).unwrap_or((rough, Vec::new()));
        Self { range, ticks, step, power: None }
    }

    /// An axis of powers of ten: `range` are the exponents; about `count` ticks at whole ones.
    pub fn of_powers(range: Range<f64>, count: usize) -> Self {
        let step = ((range.end - range.start) / count.max(1) as f64).ceil().max(1.0);
        Self { ticks: ticks(&range, step), range, step, power: Some(1.0) }
    }

    /// The same axis for negated exponents: large powers at its start.
    pub fn falling(self) -> Self {
        Self { power: self.power.map(|sign| -sign), ..self }
    }

    /// The numbers that get a tick.
    #[must_use]
    pub fn ticks(&self) -> &[f64] {
        &self.ticks
    }

    /// The number at a tick as text: the decimals that the distance of the ticks needs, and true minus signs.
    pub fn tick_label(&self, value: f64) -> String {
        if let Some(sign) = self.power {
            return format!("10{}", superscript(&format!("{:.0}", sign * value + 0.0)));
        }
        let magnitude = self.range.start.abs().max(self.range.end.abs());
        let text = if value.abs() < self.step / 2.0 {
            "0".to_owned()
        } else if (1e-3..1e6).contains(&magnitude) {
            let decimals = (-self.step.log10() - 1e-9).ceil().max(0.0) as usize;
            format!("{value:.decimals$}")
        } else {
            let digits = (magnitude.log10().floor() - self.step.log10().floor()).clamp(0.0, 6.0) as usize;
            let text = format!("{value:.digits$e}");
            let (mantissa, exponent) = text.split_once('e').expect("this format has an exponent");
            format!("{mantissa}\u{B7}10{}", superscript(exponent))
        };
        text.replace('-', "\u{2212}")
    }
}

/// The multiples of `step` inside `range`; none where they are not to be told apart.
fn ticks(range: &Range<f64>, step: f64) -> Vec<f64> {
    // The ends belong to the range in spite of rounding.
    let (first, last) = ((range.start / step - 1e-9).ceil(), (range.end / step + 1e-9).floor());
    let count = last - first + 1.0;
    // No axis here is asked for more than twenty ticks; a hundred is a range beyond the numbers.
    if (1.0..100.0).contains(&count) {
        (0..count as u32).map(|k| (first + f64::from(k)) * step).collect()
    } else {
        Vec::new()
    }
}

impl Ranged for Axis {
    type FormatOption = plotters::coord::ranged1d::NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        let place = (value - self.range.start) / (self.range.end - self.range.start);
        // What is far outside stays outside, within the drawing's integers.
        limit.0 + (place.clamp(-9.0, 10.0) * f64::from(limit.1 - limit.0)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        if hint.weight().allow_light_points() { Vec::new() } else { self.ticks.clone() }
    }

    fn range(&self) -> Range<f64> {
        self.range.clone()
    }
}

impl ValueFormatter<f64> for Axis {
    fn format(value: &f64) -> String {
        value.to_string()
    }

    fn format_ext(&self, value: &f64) -> String {
        self.tick_label(*value)
    }
}

/// 1, 2 or 5 times a power of ten: the first that is not below `rough`, or the one `down` places below that.
fn round_step(rough: f64, down: usize) -> f64 {
    const LADDER: [f64; 7] = [0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0];
    let power = 10f64.powf(rough.log10().floor());
    let first = LADDER.iter().position(|m| m * power >= rough * (1.0 - 1e-9)).unwrap_or(6);
    LADDER[first.saturating_sub(down)] * power
}

/// `range` with a margin at both ends; `smallest` wide at least, so that rounding noise does not fill a panel.
pub fn widened(range: Range<f64>, smallest: f64) -> Range<f64> {
    let middle = range.start / 2.0 + range.end / 2.0;
    let span = (range.end - range.start).max(smallest).max(1e-12 * middle.abs());
    // A twentieth of the span stays free above and below.
    let half = 0.55 * span;
    middle - half..middle + half
}

/// The plot of row `row` of `rows` with one time axis below them; `left` and `width` are those of the plot in the
/// content.
#[must_use]
pub fn row_plot(row: i32, rows: i32, left: i32, width: i32) -> Rectangle {
    let content = Rectangle::CONTENT;
    let height = (content.height - TIME_LABELS) / rows;
    Rectangle { x: content.x + left, y: content.y + row * height + CAPTION, width, height: height - CAPTION }
}

/// The time axis of a run, never empty.
#[must_use]
pub fn time_span(start: f64, end: f64) -> Range<f64> {
    if end > start { start..end } else { start..start + 1.0 }
}

/// The smallest span worth showing of a quantity that does not move, in parts of its size.
pub const STILL: f64 = 1e-6;

/// One quantity over time.
pub struct OverTime<'a> {
    /// What and in which unit, such as `h_x in N m s`.
    pub caption: String,
    /// The curve's and the caption's colour.
    pub colour: RGBColor,
    /// Sample times, s.
    pub times: &'a [f64],
    /// Values at them.
    pub values: &'a [f64],
    /// The part of time shown, s.
    pub span: Range<f64>,
    /// The part of values shown.
    pub range: Range<f64>,
    /// What is written below the time axis; without it the panel has no time labels.
    pub time_description: Option<String>,
}

impl OverTime<'_> {
    /// Draws the panel: caption above, the plot in `plot`, labels outside of it.
    ///
    /// # Errors
    /// The drawing crate refuses.
    pub fn draw(&self, area: &Area, plot: Rectangle) -> Result<(), FigureError> {
        self.draw_with(area, plot, &[])
    }

    /// The same with more curves over the same times.
    ///
    /// # Errors
    /// The drawing crate refuses.
    pub fn draw_with(&self, area: &Area, plot: Rectangle, more: &[(&[f64], RGBColor)]) -> Result<(), FigureError> {
        let style = text(13, self.colour, HPos::Left);
        write(area, &self.caption, (plot.x, plot.y - CAPTION + 3), &style)?;
        let time = Axis::over(self.span.clone(), plot.width as usize / 70);
        let values = Axis::over(self.range.clone(), plot.height as usize / 28);
        let mut chart = chart(area, plot, time, values, self.time_description.as_deref())?;
        for (values, colour) in std::iter::once((self.values, self.colour)).chain(more.iter().copied()) {
            let points = self.times.iter().copied().zip(values.iter().copied());
            let is_in_span = |t: &f64| self.span.contains(t) || *t == self.span.end;
            let is_shown = |(t, value): &(f64, f64)| is_in_span(t) && value.is_finite();
            let shown: Vec<(f64, f64)> = points.filter(is_shown).collect();
            // Two columns a pixel: finer is not seen.
            let thin = thinning::over_time(&shown, 2 * plot.width as usize);
            chart.draw_series([PathElement::new(thin, colour.stroke_width(LINE))]).map_err(drawing)?;
        }
        Ok(())
    }
}

/// Width of a curve, units of drawing: 1.2 CSS pixels.
pub const LINE: u32 = 12;

/// A chart with plain axes.
pub type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<Axis, Axis>>;

/// Axes, grid and labels about `plot`. `below` is written below the horizontal axis; without it that axis has no
/// labels.
pub fn chart<'a, 'b>(
    area: &'a Area<'b>,
    plot: Rectangle,
    horizontal: Axis,
    vertical: Axis,
    below: Option<&str>,
) -> Result<Chart<'a, 'b>, FigureError> {
    let label_height = if below.is_some() { TIME_LABELS } else { 0 };
    let outer = Rectangle {
        x: plot.x - VALUE_LABELS,
        width: plot.width + VALUE_LABELS,
        height: plot.height + label_height,
        ..plot
    };
    let outer = outer.of(area);
    let mut chart = ChartBuilder::on(&outer)
        .set_label_area_size(LabelAreaPosition::Left, VALUE_LABELS * UNITS)
        .set_label_area_size(LabelAreaPosition::Bottom, label_height * UNITS)
        .build_cartesian_2d(horizontal, vertical)
        .map_err(drawing)?;
    let grid = GRID.light.stroke_width(UNITS as u32);
    let mut mesh = chart.configure_mesh();
    mesh.bold_line_style(grid).axis_style(AXIS.light.stroke_width(UNITS as u32)).label_style(label());
    mesh.axis_desc_style(label()).set_all_tick_mark_size(4 * UNITS);
    if let Some(below) = below {
        mesh.x_desc(below);
    }
    mesh.draw().map_err(drawing)?;
    Ok(chart)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let axis = Axis::over(-0.041..0.0385, 4);
        assert_eq!(axis.ticks.len(), 4);
        let labels: Vec<String> = axis.ticks.iter().map(|&tick| axis.tick_label(tick)).collect();
        assert_eq!(labels, ["\u{2212}0.04", "\u{2212}0.02", "0", "0.02"]);
        assert_eq!(Axis::over(0.0..5.0, 5).ticks, [0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
    }

    #[test]
    fn a_quantity_at_rest_gets_a_range() {
        assert_eq!(widened(extent([0.0, 0.0]), 1.0), -0.55..0.55);
        assert_eq!(extent([]), 0.0..0.0);
        assert_eq!(extent([1.0, f64::NAN, 3.0]), 1.0..3.0);
    }
}
