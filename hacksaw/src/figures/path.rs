//! Figures of paths: the centre of mass in the plane of motion, and its coordinates over time.
//!
//! The plane has the same scale in x and y, so a circle looks like one. The three coordinates share one span.

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::{KEY, key_of_ends};
use crate::columns::AXES;
use bg_model::simulation::Recording;
use bg_workbench::figures::FigureError;
use bg_workbench::figures::canvas::{Area, Rectangle, UNITS, drawing, figure, text, write};
use bg_workbench::figures::palette::{AXES as COLOURS, INK, PAPER, PENCIL};
use bg_workbench::figures::panel::{
    Axis, CAPTION, LINE, OverTime, RIGHT, STILL, TIME_LABELS, VALUE_LABELS, chart, extent, widened,
};
use bg_workbench::figures::panel::{row_plot, time_span};
use bg_workbench::figures::thinning::along_path;

/// The side of the square that shows the plane, CSS pixels.
const SIDE: i32 = 370;

/// Draws the path of a link's centre of mass.
pub fn draw(heading: &str, trajectory: &Recording, link: u8) -> Result<String, FigureError> {
    let names = AXES.map(|axis| format!("C{link}_{axis}"));
    let coordinates = names.iter().map(|name| trajectory.values(name)).collect::<Result<Vec<_>, _>>()?;
    let extents: Vec<_> = coordinates.iter().map(|values| extent(values.iter().copied())).collect();
    let span = extents.iter().map(|range| range.end - range.start).fold(STILL, f64::max);
    let captions = AXES.map(|axis| format!("C_{link}{axis} in m"));
    let times = &trajectory.times;

    figure(heading, |area| {
        let [x, y] = [0, 1].map(|axis: usize| widened(extents[axis].clone(), span));
        let points: Vec<(f64, f64)> = coordinates[0].iter().copied().zip(coordinates[1].iter().copied()).collect();
        plane(area, &captions, x, y, &points)?;
        for (row, values) in coordinates.iter().enumerate() {
            let left = VALUE_LABELS + SIDE + RIGHT + VALUE_LABELS;
            OverTime {
                caption: captions[row].clone(),
                colour: COLOURS[row].light,
                times,
                values,
                span: time_span(times[0], times[times.len() - 1]),
                range: widened(extents[row].clone(), span),
                time_description: (row == 2).then(|| "t in s".to_owned()),
            }
            .draw(area, row_plot(row as i32, 3, left, Rectangle::CONTENT.width - left - RIGHT))?;
        }
        Ok(())
    })
}

/// The x-y plane with the path, its start and its end.
fn plane(
    area: &Area,
    captions: &[String; 3],
    x: std::ops::Range<f64>,
    y: std::ops::Range<f64>,
    points: &[(f64, f64)],
) -> Result<(), FigureError> {
    let content = Rectangle::CONTENT;
    let plot = Rectangle { x: content.x + VALUE_LABELS, y: content.y + CAPTION, width: SIDE, height: SIDE };
    debug_assert!(CAPTION + SIDE + TIME_LABELS <= content.height);
    write(area, &captions[1], (plot.x, plot.y - CAPTION + 3), &text(13, PENCIL.light, HPos::Left))?;
    key_of_ends(area, (plot.x + SIDE - KEY, plot.y - CAPTION + 3))?;

    // Half a pixel is the nearest that two points are told apart; the most keeps a path of any length small.
    let half_pixel = 0.5 * (x.end - x.start) / f64::from(SIDE);
    let thin = along_path(points, half_pixel, 12_000);
    let mut chart = chart(area, plot, Axis::over(x, 5), Axis::over(y, 5), Some(&captions[0]))?;
    chart.draw_series([PathElement::new(thin, COLOURS[0].light.stroke_width(LINE * 3 / 4))]).map_err(drawing)?;
    let (start, end) = (points[0], points[points.len() - 1]);
    let radius = 5 * UNITS;
    let outline = INK.light.stroke_width(3 * UNITS as u32 / 2);
    chart.draw_series([Circle::new(start, radius, PAPER.light.filled())]).map_err(drawing)?;
    chart.draw_series([Circle::new(start, radius, outline)]).map_err(drawing)?;
    chart.draw_series([Circle::new(end, radius - UNITS, INK.light.filled())]).map_err(drawing)?;
    Ok(())
}
