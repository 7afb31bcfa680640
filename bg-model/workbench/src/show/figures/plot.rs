//! Figures of studies: one number against another, ranked bars, histograms, maps.
//!
//! In: numbers with their names. Out: SVG. What is no number is left out.

use std::ops::Range;

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::FigureError;
use super::canvas::{Area, Rectangle, UNITS, drawing, figure, literally, text, write};
use super::palette::{AXES, AXIS, CURVES, INK, PENCIL};
use super::panel::{Axis, CAPTION, LINE, RIGHT, TIME_LABELS, VALUE_LABELS, chart, extent, widened};
use super::thinning;

/// How points are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mark {
    /// A line through them.
    Line,
    /// A dot at each.
    Dots,
    /// Both.
    Both,
    /// A thin grey line with its name at its end, to read the others by.
    Guide,
}

/// Points that belong together.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Its name in the legend; without one it is not there.
    pub name: String,
    /// The points.
    pub points: Vec<(f64, f64)>,
    /// How they are drawn.
    pub mark: Mark,
}

/// Series in one chart.
#[derive(Clone, Debug, PartialEq)]
pub struct Plot {
    /// What it shows.
    pub heading: String,
    /// The horizontal axis, with its unit.
    pub across: String,
    /// The vertical axis, with its unit.
    pub up: String,
    /// The series.
    pub series: Vec<Series>,
    /// Whether both axes have one scale, as paths in a plane need it.
    pub is_true_to_scale: bool,
    /// Whether the vertical axis is logarithmic: what is not positive is left out.
    pub is_logarithmic: bool,
}

/// The most dots of a series; of more every second, third .. is drawn.
const MOST: usize = 4000;
/// Height of a line of the legend, CSS pixels.
const ENTRY: i32 = 18;
/// The most names in a legend.
const MOST_NAMES: usize = 24;
/// Width of the legend, CSS pixels.
const LEGEND: i32 = 190;

/// A quantity with its unit, as axes and columns are called; a pure number has none.
#[must_use]
pub fn with_unit(text: &str, unit: &str) -> String {
    if matches!(unit, "" | "1") { text.to_owned() } else { format!("{text} in {unit}") }
}

impl Plot {
    /// A chart with linear axes.
    #[must_use]
    pub fn new(heading: &str, across: &str, up: &str, series: Vec<Series>) -> Self {
        let [heading, across, up] = [heading, across, up].map(str::to_owned);
        Self { heading, across, up, series, is_true_to_scale: false, is_logarithmic: false }
    }

    /// The colour of a series: the hues in turn, which guides do not count among.
    fn colour(&self, index: usize) -> RGBColor {
        let is_guide = |series: &Series| series.mark == Mark::Guide;
        if is_guide(&self.series[index]) {
            return AXIS.light;
        }
        colour(self.series[..index].iter().filter(|series| !is_guide(series)).count())
    }

    /// Draws it.
    ///
    /// # Errors
    /// There is no point, or the drawing crate refuses.
    pub fn drawn(&self) -> Result<String, FigureError> {
        let scaled = |&(x, y): &(f64, f64)| (x, if self.is_logarithmic { y.log10() } else { y });
        let kept = |series: &Series| -> Vec<(f64, f64)> {
            series.points.iter().map(scaled).filter(|(x, y)| x.is_finite() && y.is_finite()).collect()
        };
        let all: Vec<Vec<(f64, f64)>> = self.series.iter().map(kept).collect();
        let points = || all.iter().flatten();
        if points().next().is_none() {
            return Err(FigureError::Empty);
        }
        let across = widened(extent(points().map(|point| point.0)), f64::MIN_POSITIVE);
        let up = widened(extent(points().map(|point| point.1)), f64::MIN_POSITIVE);
        let has_legend = self.series.iter().any(|series| !series.name.is_empty());
        figure(&literally(&self.heading), |area| {
            let plot = plot_of(has_legend);
            let (across, up) = if self.is_true_to_scale { to_scale(across, up, plot) } else { (across, up) };
            write(area, &literally(&self.up), (plot.x, plot.y - CAPTION + 3), &text(13, INK.light, HPos::Left))?;
            let horizontal = Axis::over(across, plot.width as usize / 80);
            let ticks = plot.height as usize / 32;
            let vertical = if self.is_logarithmic && up.end - up.start > 1.0 {
                Axis::of_powers(up, ticks)
            } else {
                Axis::over(up, ticks)
            };
            let mut chart = chart(area, plot, horizontal, vertical, Some(&literally(&self.across)))?;
            for (index, (series, points)) in self.series.iter().zip(&all).enumerate() {
                let colour = self.colour(index);
                if series.mark != Mark::Dots {
                    let line = thinned(points, [&chart.x_range(), &chart.y_range()], plot);
                    let width = if series.mark == Mark::Guide { LINE / 2 } else { LINE };
                    chart.draw_series([PathElement::new(line, colour.stroke_width(width))]).map_err(drawing)?;
                }
                if matches!(series.mark, Mark::Dots | Mark::Both) {
                    let every = points.len().div_ceil(MOST).max(1);
                    let dot = |at: &(f64, f64)| Circle::new(*at, 5 * UNITS / 2, colour.mix(0.8).filled());
                    chart.draw_series(points.iter().step_by(every).map(dot)).map_err(drawing)?;
                }
            }
            for (guide, points) in self.series.iter().zip(&all).filter(|(series, _)| series.mark == Mark::Guide) {
                let Some(end) = points.last() else { continue };
                let (x, y) = chart.backend_coord(end);
                let style = text(11, PENCIL.light, HPos::Right);
                write(area, &literally(&guide.name), (x / UNITS - 6, y / UNITS - 15), &style)?;
            }
            if has_legend {
                let entry = |(index, series): (usize, &Series)| (series.name.clone(), self.colour(index));
                let named = self.series.iter().enumerate().filter(|(_, series)| series.mark != Mark::Guide);
                legend(area, named.map(entry), plot)?;
            }
            Ok(())
        })
    }
}

/// The points of a line that are to be told apart where it is drawn.
fn thinned(points: &[(f64, f64)], [across, up]: [&Range<f64>; 2], plot: Rectangle) -> Vec<(f64, f64)> {
    const PIXELS: f64 = 0.25;
    const MOST: usize = 10_000;
    let per_pixel = |range: &Range<f64>, pixels: i32| (range.end - range.start) / f64::from(pixels);
    let (x, y) = (per_pixel(across, plot.width), per_pixel(up, plot.height));
    let in_pixels: Vec<(f64, f64)> = points.iter().map(|point| (point.0 / x, point.1 / y)).collect();
    thinning::along_path(&in_pixels, PIXELS, MOST).into_iter().map(|point| (point.0 * x, point.1 * y)).collect()
}

fn colour(index: usize) -> RGBColor {
    CURVES[index % CURVES.len()].light
}

fn plot_of(has_legend: bool) -> Rectangle {
    let content = Rectangle::CONTENT;
    let right = if has_legend { LEGEND } else { RIGHT };
    Rectangle {
        x: content.x + VALUE_LABELS,
        y: content.y + CAPTION,
        width: content.width - VALUE_LABELS - right,
        height: content.height - CAPTION - TIME_LABELS,
    }
}

/// Both ranges widened so that a unit of one is as long as one of the other.
fn to_scale(across: Range<f64>, up: Range<f64>, plot: Rectangle) -> (Range<f64>, Range<f64>) {
    let per_pixel = |range: &Range<f64>, pixels: i32| (range.end - range.start) / f64::from(pixels);
    let unit = per_pixel(&across, plot.width).max(per_pixel(&up, plot.height));
    let wide = |range: Range<f64>, pixels: i32| {
        let (middle, half) = (0.5 * (range.start + range.end), 0.5 * unit * f64::from(pixels));
        middle - half..middle + half
    };
    (wide(across, plot.width), wide(up, plot.height))
}

/// Names in their colours beside a plot; those that are empty are not there.
fn legend(area: &Area, names: impl Iterator<Item = (String, RGBColor)>, plot: Rectangle) -> Result<(), FigureError> {
    let names = names.filter(|(name, _)| !name.is_empty()).take(MOST_NAMES);
    for (row, (name, colour)) in names.enumerate() {
        let (x, y) = (plot.x + plot.width + 16, plot.y + ENTRY * row as i32);
        let middle = (y + ENTRY / 2) * UNITS;
        let ends = vec![(x * UNITS, middle), ((x + 18) * UNITS, middle)];
        area.draw(&PathElement::new(ends, colour.stroke_width(2 * LINE))).map_err(drawing)?;
        write(area, &literally(&name), (x + 24, y + 2), &text(12, INK.light, HPos::Left))?;
    }
    Ok(())
}

/// A bar with its name and what is written at it.
#[derive(Clone, Debug, PartialEq)]
pub struct Bar {
    /// Its name.
    pub name: String,
    /// Its length.
    pub value: f64,
    /// A second, darker bar inside of it.
    pub inner: Option<f64>,
    /// What is written at its end.
    pub text: String,
}

/// Draws bars below each other, the longest one first; `caption` says what lengths mean.
///
/// # Errors
/// There is no bar with a length, or the drawing crate refuses.
pub fn bars(heading: &str, caption: &str, bars: &[Bar]) -> Result<String, FigureError> {
    const MOST: usize = 20;
    const NAMES: i32 = 170;
    const TEXTS: i32 = 150;
    let mut sorted: Vec<&Bar> = bars.iter().filter(|bar| bar.value.is_finite()).collect();
    sorted.sort_by(|a, b| b.value.abs().total_cmp(&a.value.abs()));
    sorted.truncate(MOST);
    let longest_of = |bar: &Bar| bar.value.abs().max(bar.inner.unwrap_or(0.0));
    let longest = sorted.iter().fold(0.0_f64, |longest, bar| longest.max(longest_of(bar)));
    if longest == 0.0 {
        return Err(FigureError::Empty);
    }
    figure(&literally(heading), |area| {
        let content = Rectangle::CONTENT;
        write(area, &literally(caption), (content.x, content.y), &text(13, PENCIL.light, HPos::Left))?;
        let height = ((content.height - 2 * CAPTION) / sorted.len() as i32).min(64);
        let width = f64::from(content.width - NAMES - TEXTS);
        for (row, bar) in sorted.iter().enumerate() {
            let (x, y) = (content.x + NAMES, content.y + CAPTION + 8 + row as i32 * height);
            let length = |value: f64| ((value.abs() / longest * width).round() as i32).clamp(1, content.width);
            let corners = |length: i32| [(x * UNITS, y * UNITS), ((x + length) * UNITS, (y + height - 6) * UNITS)];
            let rectangle = |value: f64, part: f64| {
                plotters::element::Rectangle::new(corners(length(value)), AXES[0].light.mix(part).filled())
            };
            let name = text(12, INK.light, HPos::Right);
            write(area, &literally(&bar.name), (x - 8, y + height / 2 - 10), &name)?;
            area.draw(&rectangle(bar.value, 0.45)).map_err(drawing)?;
            if let Some(inner) = bar.inner.filter(|inner| *inner > 0.0) {
                area.draw(&rectangle(inner, 0.9)).map_err(drawing)?;
            }
            let end = (x + length(longest_of(bar)) + 8, y + height / 2 - 10);
            write(area, &literally(&bar.text), end, &text(12, PENCIL.light, HPos::Left))?;
        }
        Ok(())
    })
}

/// Draws how values are distributed, with lines at marks that have names. The number of bins is the root of that of the
/// values, between 8 and 60.
///
/// # Errors
/// There is no value, or the drawing crate refuses.
pub fn histogram(heading: &str, across: &str, values: &[f64], marks: &[(String, f64)]) -> Result<String, FigureError> {
    let values: Vec<f64> = values.iter().copied().filter(|value| value.is_finite()).collect();
    if values.is_empty() {
        return Err(FigureError::Empty);
    }
    let range = widened(extent(values.iter().copied()), f64::MIN_POSITIVE);
    let bins = ((values.len() as f64).sqrt() as usize).clamp(8, 60);
    let width = (range.end - range.start) / bins as f64;
    let mut counts = vec![0_u32; bins];
    for value in &values {
        counts[(((value - range.start) / width) as usize).min(bins - 1)] += 1;
    }
    let highest = f64::from(counts.iter().copied().max().unwrap_or(1));
    figure(&literally(heading), |area| {
        let plot = plot_of(!marks.is_empty());
        write(area, "runs", (plot.x, plot.y - CAPTION + 3), &text(13, INK.light, HPos::Left))?;
        let horizontal = Axis::over(range.clone(), plot.width as usize / 80);
        let vertical = Axis::over(0.0..1.08 * highest, plot.height as usize / 32);
        let mut chart = chart(area, plot, horizontal, vertical, Some(&literally(across)))?;
        let bar = |(bin, count): (usize, &u32)| {
            let left = range.start + width * bin as f64;
            let corners = [(left, 0.0), (left + 0.94 * width, f64::from(*count))];
            plotters::element::Rectangle::new(corners, AXES[0].light.mix(0.5).filled())
        };
        chart.draw_series(counts.iter().enumerate().map(bar)).map_err(drawing)?;
        for (index, (_, at)) in marks.iter().enumerate() {
            let line = vec![(*at, 0.0), (*at, 1.08 * highest)];
            chart.draw_series([PathElement::new(line, colour(index + 1).stroke_width(2 * LINE))]).map_err(drawing)?;
        }
        legend(area, marks.iter().enumerate().map(|(index, (name, _))| (name.clone(), colour(index + 1))), plot)
    })
}

/// A number over two others: a field in its colour for each pair.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// What it shows.
    pub heading: String,
    /// Both axes, with their units, and what colours mean.
    pub captions: [String; 3],
    /// The values along the axes, ascending.
    pub across: Vec<f64>,
    /// As above.
    pub up: Vec<f64>,
    /// A number for each pair, those of the first value up first.
    pub values: Vec<f64>,
}

impl Map {
    /// Draws it.
    ///
    /// # Errors
    /// There is no number, or the drawing crate refuses.
    pub fn drawn(&self) -> Result<String, FigureError> {
        let shown = extent(self.values.iter().copied().filter(|value| value.is_finite()));
        if !self.values.iter().any(|value| value.is_finite()) || self.across.is_empty() || self.up.is_empty() {
            return Err(FigureError::Empty);
        }
        let [across, up] = [&self.across, &self.up].map(|values| edges(values));
        let range = |edges: &[f64]| edges[0]..edges[edges.len() - 1];
        figure(&literally(&self.heading), |area| {
            let plot = plot_of(true);
            let caption = text(13, INK.light, HPos::Left);
            write(area, &literally(&self.captions[1]), (plot.x, plot.y - CAPTION + 3), &caption)?;
            let horizontal = Axis::over(range(&across), plot.width as usize / 80);
            let vertical = Axis::over(range(&up), plot.height as usize / 32);
            let mut chart = chart(area, plot, horizontal, vertical, Some(&literally(&self.captions[0])))?;
            let part = |value: f64| (value - shown.start) / (shown.end - shown.start).max(f64::MIN_POSITIVE);
            let fields = self.values.iter().enumerate().filter(|(_, value)| value.is_finite()).map(|(k, &value)| {
                let (row, column) = (k / self.across.len(), k % self.across.len());
                let corners = [(across[column], up[row]), (across[column + 1], up[row + 1])];
                plotters::element::Rectangle::new(corners, shade(part(value)).filled())
            });
            chart.draw_series(fields).map_err(drawing)?;
            self.scale(area, plot, shown.clone())
        })
    }

    /// The scale of colours at the right.
    fn scale(&self, area: &Area, plot: Rectangle, shown: Range<f64>) -> Result<(), FigureError> {
        const FIELDS: i32 = 40;
        let (x, height) = (plot.x + plot.width + 24, plot.height / FIELDS);
        write(area, &literally(&self.captions[2]), (x, plot.y - CAPTION + 3), &text(13, INK.light, HPos::Left))?;
        for field in 0..FIELDS {
            let y = plot.y + (FIELDS - 1 - field) * height;
            let corners = [(x * UNITS, y * UNITS), ((x + 22) * UNITS, (y + height) * UNITS)];
            let colour = shade((f64::from(field) + 0.5) / f64::from(FIELDS));
            area.draw(&plotters::element::Rectangle::new(corners, colour.filled())).map_err(drawing)?;
        }
        let axis = Axis::over(shown.start..shown.end.max(shown.start + f64::MIN_POSITIVE), 5);
        for (value, y) in [(shown.end, plot.y), (shown.start, plot.y + FIELDS * height - 12)] {
            write(area, &axis.tick_label(value), (x + 28, y), &text(12, PENCIL.light, HPos::Left))?;
        }
        let frame = [(x * UNITS, plot.y * UNITS), ((x + 22) * UNITS, (plot.y + FIELDS * height) * UNITS)];
        area.draw(&plotters::element::Rectangle::new(frame, AXIS.light.stroke_width(UNITS as u32))).map_err(drawing)
    }
}

/// The ends of fields about values: halfway between them.
fn edges(values: &[f64]) -> Vec<f64> {
    let last = values.len() - 1;
    let half = |a: f64, b: f64| 0.5 * (a + b);
    if last == 0 {
        let size = if values[0] == 0.0 { 1.0 } else { 0.5 * values[0].abs() };
        return vec![values[0] - size, values[0] + size];
    }
    let inner = values.windows(2).map(|pair| half(pair[0], pair[1]));
    let first = 2.0 * values[0] - half(values[0], values[1]);
    let end = 2.0 * values[last] - half(values[last - 1], values[last]);
    std::iter::once(first).chain(inner).chain([end]).collect()
}

/// A colour from dark blue over green to yellow, of even steps in lightness.
pub(super) fn shade(part: f64) -> RGBColor {
    const STOPS: [[f64; 3]; 5] =
        [[25.0, 36.0, 92.0], [28.0, 92.0, 128.0], [44.0, 143.0, 122.0], [132.0, 190.0, 92.0], [249.0, 226.0, 92.0]];
    let place = part.clamp(0.0, 1.0) * (STOPS.len() - 1) as f64;
    let (low, rest) = ((place as usize).min(STOPS.len() - 2), place - (place as usize).min(STOPS.len() - 2) as f64);
    let [red, green, blue] =
        std::array::from_fn(|k| (STOPS[low][k] + rest * (STOPS[low + 1][k] - STOPS[low][k])).round() as u8);
    RGBColor(red, green, blue)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn series_are_drawn_without_what_is_no_number() {
        let series = |name: &str, mark| Series {
            name: name.to_owned(),
            points: vec![(0.0, 1.0), (1.0, f64::NAN), (2.0, 3.0)],
            mark,
        };
        let plot = Plot::new("How", "x in m", "y in N", vec![series("dots", Mark::Dots), series("line", Mark::Line)]);
        let svg = plot.drawn().unwrap();
        assert_eq!(svg.matches("<circle").count(), 2, "{svg}");
        assert!(["dots", "line", "x in m", "y in N"].iter().all(|text| svg.contains(text)), "{svg}");
        let empty = Plot::new("", "", "", vec![Series { name: String::new(), points: Vec::new(), mark: Mark::Line }]);
        assert!(matches!(empty.drawn(), Err(FigureError::Empty)));
    }

    #[test]
    fn the_longest_bar_is_first() {
        let bar = |name: &str, value| Bar { name: name.to_owned(), value, inner: None, text: format!("{value}") };
        let svg = bars("Parts", "of the whole", &[bar("short", 0.1), bar("long", 0.8)]).unwrap();
        assert!(svg.find("long") < svg.find("short"), "{svg}");
        assert!(matches!(bars("", "", &[bar("none", 0.0)]), Err(FigureError::Empty)));
    }

    #[test]
    fn every_value_is_in_a_bin_and_every_pair_has_a_field() {
        let values: Vec<f64> = (0..100).map(f64::from).collect();
        assert!(histogram("Spread", "x", &values, &[("mean".to_owned(), 49.5)]).unwrap().contains("mean"));
        let captions = ["x", "y", "z"].map(str::to_owned);
        let map = Map { heading: "Map".to_owned(), captions, across: vec![1.0, 2.0], up: vec![0.0, 1.0, 4.0], values };
        let map = Map { values: map.values[..6].to_vec(), ..map };
        // Six fields, forty of the scale, its frame, the paper.
        assert_eq!(map.drawn().unwrap().matches("<rect").count(), 6 + 40 + 2);
        assert_eq!(edges(&[1.0, 2.0, 4.0]), [0.5, 1.5, 3.0, 5.0]);
    }
}
