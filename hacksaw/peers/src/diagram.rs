//! The work-precision diagram: error to the right, time upwards, both logarithmic; one line for each solver, the better
//! the nearer to the lower left.
//!
//! In: the series. Out: SVG text. Colours say where a solver comes from, marks which of its methods it is.

use std::ops::Range;

use plotters::coord::Shift;
use plotters::element::{Drawable, PointCollection};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use plotters_backend::{BackendCoord, DrawingErrorKind};

use crate::measure::Series;
use crate::solvers::Source;

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// Units of drawing for one CSS pixel: the drawing crate places points at whole units.
const UNITS: i32 = 10;
/// The sheet and its legend, CSS pixels.
const WIDTH: i32 = 1080;
const HEIGHT: i32 = 640;
const LEGEND: i32 = 270;

const INK: RGBColor = RGBColor(31, 35, 40);
const PENCIL: RGBColor = RGBColor(89, 99, 110);
const GRID: RGBColor = RGBColor(229, 232, 235);

/// The colours, after Okabe and Ito (2008); of the same methods on fewer states a darker one.
fn colour(source: Source) -> RGBColor {
    match source {
        Source::Ours => RGBColor(213, 94, 0),
        Source::Motion => RGBColor(140, 45, 4),
        Source::ByHand => RGBColor(230, 159, 0),
        Source::Diffsol => RGBColor(0, 114, 178),
        Source::OdeSolvers => RGBColor(86, 180, 233),
        Source::DifferentialEquations => RGBColor(0, 158, 115),
        Source::Heyoka => RGBColor(0, 0, 0),
        Source::Cvode => RGBColor(204, 121, 167),
        Source::Casadi => RGBColor(140, 90, 160),
    }
}

/// A drawn line: a solver's points with its colour and mark.
struct Drawn<'a> {
    name: &'a str,
    colour: RGBColor,
    /// The place among those of the same source.
    mark: usize,
    heavy: bool,
    points: Vec<(f64, f64)>,
}

/// Draws the diagram.
pub fn draw(series: &[Series]) -> Result<String, String> {
    let lines = lines(series);
    let mut svg = String::new();
    {
        let size = ((WIDTH * UNITS) as u32, (HEIGHT * UNITS) as u32);
        let sheet = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        sheet.fill(&WHITE).map_err(text_of)?;
        let title = "5 s of the paper's hacksaw: largest pose error against time";
        sheet.draw(&Text::new(title, (20 * UNITS, 16 * UNITS), style(18, INK, HPos::Left))).map_err(text_of)?;
        let (plot, legend) =
            sheet.margin(44 * UNITS, 10 * UNITS, 10 * UNITS, 10 * UNITS).split_horizontally((WIDTH - LEGEND) * UNITS);
        chart(&plot, &lines)?;
        key(&legend, &lines)?;
        sheet.present().map_err(text_of)?;
    }
    let (_, body) = svg.split_once('>').ok_or("no SVG")?;
    let (width, height) = (WIDTH * UNITS, HEIGHT * UNITS);
    Ok(format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{HEIGHT}\" viewBox=\"0 0 {width} \
         {height}\" role=\"img\" aria-label=\"Work-precision diagram\">{body}"
    ))
}

fn lines(series: &[Series]) -> Vec<Drawn<'_>> {
    let mut lines: Vec<Drawn> = Vec::new();
    for series in series {
        let colour = colour(series.line.source);
        let points = series.points.iter().map(|point| (point.error, point.least()));
        lines.push(Drawn {
            name: &series.line.name,
            colour,
            mark: lines.iter().filter(|line| line.colour == colour).count(),
            heavy: series.line.source == Source::Ours,
            points: points.filter(|(error, _)| error.is_finite() && *error > 0.0).collect(),
        });
    }
    lines
}

fn chart(area: &Area, lines: &[Drawn]) -> Result<(), String> {
    let all = || lines.iter().flat_map(|line| &line.points);
    let errors = decades(all().map(|point| point.0), 1e-12..1e-3);
    let times = decades(all().map(|point| point.1), 10.0..1000.0);
    let mut chart = ChartBuilder::on(area)
        .set_label_area_size(LabelAreaPosition::Left, 64 * UNITS)
        .set_label_area_size(LabelAreaPosition::Bottom, 46 * UNITS)
        .build_cartesian_2d(errors.log_scale(), times.log_scale())
        .map_err(text_of)?;
    chart
        .configure_mesh()
        .bold_line_style(GRID.stroke_width(UNITS as u32))
        .light_line_style(GRID.mix(0.4).stroke_width(UNITS as u32 / 2))
        .axis_style(PENCIL.stroke_width(UNITS as u32))
        .label_style(style(12, PENCIL, HPos::Center))
        .axis_desc_style(style(13, INK, HPos::Center))
        .x_label_formatter(&|value| power(*value))
        .y_label_formatter(&|value| format!("{value:.0}"))
        .x_desc("largest error of a pose at 501 instants, m or rad")
        .y_desc("wall time, ms, least of the runs")
        .set_all_tick_mark_size(4 * UNITS)
        .draw()
        .map_err(text_of)?;
    for line in lines {
        let points = line.points.clone();
        chart.draw_series([PathElement::new(points, stroke(line))]).map_err(text_of)?;
        chart.draw_series(line.points.iter().map(|&point| mark(line, point))).map_err(text_of)?;
    }
    Ok(())
}

/// The legend, a row for each line.
fn key(area: &Area, lines: &[Drawn]) -> Result<(), String> {
    let row = (22).min((HEIGHT - 80) / lines.len().max(1) as i32) * UNITS;
    for (index, line) in lines.iter().enumerate() {
        let y = 12 * UNITS + row * index as i32;
        area.draw(&PathElement::new(vec![(14 * UNITS, y), (44 * UNITS, y)], stroke(line))).map_err(text_of)?;
        area.draw(&mark(line, (29 * UNITS, y))).map_err(text_of)?;
        let label = style(12, INK, HPos::Left).pos(Pos::new(HPos::Left, VPos::Center));
        area.draw(&Text::new(line.name.to_owned(), (52 * UNITS, y), label)).map_err(text_of)?;
    }
    Ok(())
}

/// A mark: a disc, a triangle, a cross, a ring, a small disc, a large ring, a square, an open square, a diamond, in
/// that order.
fn mark<'a, C: Clone + 'static>(line: &Drawn, at: C) -> DynElement<'static, SVGBackend<'a>, C> {
    let (size, thin, filled) = (5 * UNITS, line.colour.stroke_width(13), line.colour.filled());
    let square = vec![(-size, -size), (size, -size), (size, size), (-size, size)];
    let diamond = vec![(0, -3 * size / 2), (3 * size / 2, 0), (0, 3 * size / 2), (-3 * size / 2, 0)];
    match line.mark {
        0 => Circle::new(at, size, filled).into_dyn(),
        1 => TriangleMarker::new(at, size, filled).into_dyn(),
        2 => Cross::new(at, size, thin).into_dyn(),
        3 => Circle::new(at, size, thin).into_dyn(),
        4 => Circle::new(at, size / 2, filled).into_dyn(),
        5 => Circle::new(at, 3 * size / 2, thin).into_dyn(),
        6 => Shape { at, corners: square, style: filled }.into_dyn(),
        7 => Shape { at, corners: square, style: thin }.into_dyn(),
        _ => Shape { at, corners: diamond, style: filled }.into_dyn(),
    }
}

/// A polygon about a point, its corners in units of drawing from there.
struct Shape<C> {
    at: C,
    corners: Vec<BackendCoord>,
    style: ShapeStyle,
}

impl<'a, C> PointCollection<'a, C> for &'a Shape<C> {
    type Point = &'a C;
    type IntoIter = std::iter::Once<&'a C>;

    fn point_iter(self) -> Self::IntoIter {
        std::iter::once(&self.at)
    }
}

impl<C, B: DrawingBackend> Drawable<B> for Shape<C> {
    fn draw<I: Iterator<Item = BackendCoord>>(
        &self,
        points: I,
        backend: &mut B,
        _: (u32, u32),
    ) -> Result<(), DrawingErrorKind<B::ErrorType>> {
        for (x, y) in points {
            let corners = self.corners.iter().map(|corner| (x + corner.0, y + corner.1));
            if self.style.filled {
                backend.fill_polygon(corners, &self.style)?;
            } else {
                let first = self.corners[0];
                backend.draw_path(corners.chain([(x + first.0, y + first.1)]), &self.style)?;
            }
        }
        Ok(())
    }
}

fn stroke(line: &Drawn) -> ShapeStyle {
    line.colour.stroke_width(if line.heavy { 28 } else { 13 })
}

/// Whole decades about the values that lie within a sane range.
fn decades(values: impl Iterator<Item = f64>, otherwise: Range<f64>) -> Range<f64> {
    let (low, high) = values.fold((f64::INFINITY, 0.0_f64), |(low, high), value| (low.min(value), high.max(value)));
    if low > high {
        return otherwise;
    }
    // An axis that begins with a full decade below the least value would waste it.
    let round = |value: f64, up: bool| {
        let power = 10f64.powf(value.log10().floor());
        let steps = [1.0, 2.0, 5.0, 10.0].map(|step| step * power);
        let inside = |step: &&f64| if up { **step >= value } else { **step <= value };
        let found = if up { steps.iter().find(inside) } else { steps.iter().rev().find(inside) };
        found.copied().unwrap_or(value)
    };
    round(low, false)..round(high, true)
}

/// A power of ten with a raised exponent.
fn power(value: f64) -> String {
    const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    // Adding 0 takes the sign from a zero.
    let exponent = format!("{:.0}", value.log10().round() + 0.0);
    let raised = exponent.chars().map(|c| c.to_digit(10).map_or('⁻', |digit| RAISED[digit as usize]));
    format!("10{}", raised.collect::<String>())
}

fn style(pixels: i32, colour: RGBColor, horizontal: HPos) -> TextStyle<'static> {
    // The drawing crate divides the size by 1.24 on its way to SVG.
    let size = f64::from(pixels * UNITS) * 1.24;
    ("sans-serif", size).into_font().color(&colour).pos(Pos::new(horizontal, VPos::Top))
}

fn text_of(fault: impl std::fmt::Display) -> String {
    fault.to_string()
}
