//! Figures of orientations: the paths of the tips of a link's unit vectors on the unit sphere, and its rotation over
//! time.
//!
//! The sphere is seen from the front, a little from the right and from above (orthographic projection): x to the right,
//! y up, z toward the reader. Beside it the angle about z and the tilt of the link's z axis away from the inertial one.

use std::f64::consts::TAU;

use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::key_of_ends;
use crate::columns::{AXES, continued};
use bg_model::simulation::Recording;
use bg_workbench::figures::FigureError;
use bg_workbench::figures::canvas::{Area, Rectangle, UNITS, drawing, figure, text, write};
use bg_workbench::figures::palette::{AXES as COLOURS, AXIS, GRID, INK, PENCIL};
use bg_workbench::figures::panel::{Axis, CAPTION, OverTime, RIGHT, STILL, VALUE_LABELS, extent, widened};
use bg_workbench::figures::panel::{row_plot, time_span};
use bg_workbench::figures::thinning::along_path;

/// The side of the square that shows the sphere, CSS pixels.
const SIDE: i32 = 410;
/// Half the width of the view, in radii of the sphere: the axes end at 1.25.
const VIEW: f64 = 1.35;
/// The view from the right and from above, rad.
const FROM_RIGHT: f64 = 0.5;
const FROM_ABOVE: f64 = 0.4;

/// The most points of one tip's path: it keeps a run of any length small.
const MOST: usize = 4_000;

/// Draws the orientation of a link.
pub fn draw(heading: &str, trajectory: &Recording, link: u8) -> Result<String, FigureError> {
    let element = |row: usize, column: usize| trajectory.values(&format!("R{link}_{row}{column}"));
    let tips =
        [1, 2, 3].map(|column| Ok::<_, FigureError>([element(1, column)?, element(2, column)?, element(3, column)?]));
    let tips = tips.into_iter().collect::<Result<Vec<_>, _>>()?;
    let angle = continued(tips[0][1].iter().zip(tips[0][0]).map(|(sine, cosine)| sine.atan2(*cosine)));
    let [z_x, z_y, z_z] = &tips[2];
    let tilt: Vec<f64> = (0..z_z.len()).map(|k| z_x[k].hypot(z_y[k]).atan2(z_z[k])).collect();
    let times = &trajectory.times;

    figure(heading, |area| {
        sphere(area, &tips)?;
        let left = SIDE + 30 + VALUE_LABELS;
        for (row, (caption, values)) in
            [("angle about z in rad", angle), ("tilt of the z axis in rad", tilt)].iter().enumerate()
        {
            OverTime {
                caption: (*caption).to_owned(),
                colour: INK.light,
                times,
                values,
                span: time_span(times[0], times[times.len() - 1]),
                range: widened(extent(values.iter().copied()), STILL),
                time_description: (row == 1).then(|| "t in s".to_owned()),
            }
            .draw(area, row_plot(row as i32, 2, left, Rectangle::CONTENT.width - left - RIGHT))?;
        }
        Ok(())
    })
}

/// Where a point of space is seen: to the right and up.
fn seen([x, y, z]: [f64; 3]) -> (f64, f64) {
    let (right, depth) = (x * FROM_RIGHT.cos() - z * FROM_RIGHT.sin(), x * FROM_RIGHT.sin() + z * FROM_RIGHT.cos());
    (right, y * FROM_ABOVE.cos() - depth * FROM_ABOVE.sin())
}

fn sphere(area: &Area, tips: &[[&[f64]; 3]]) -> Result<(), FigureError> {
    let content = Rectangle::CONTENT;
    for (axis, name) in AXES.iter().enumerate() {
        let style = text(13, COLOURS[axis].light, HPos::Left);
        write(area, &format!("tip of {name}\u{2032}"), (content.x + 90 * axis as i32, content.y + 3), &style)?;
    }
    key_of_ends(area, (content.x + 290, content.y + 3))?;

    let square = Rectangle { x: content.x, y: content.y + CAPTION, width: SIDE, height: SIDE }.of(area);
    let view = || Axis::over(-VIEW..VIEW, 1);
    let mut chart = ChartBuilder::on(&square).build_cartesian_2d(view(), view()).map_err(drawing)?;
    let mut line = |points: Vec<(f64, f64)>, style: ShapeStyle| -> Result<(), FigureError> {
        chart.draw_series([PathElement::new(points, style)]).map_err(drawing)?;
        Ok(())
    };
    let thin = UNITS as u32;
    let circle = |place: fn(f64, f64) -> [f64; 3]| -> Vec<(f64, f64)> {
        // 120 chords: 3 degrees each, nearer than half a pixel to the circle.
        (0..=120).map(|k| f64::from(k) * TAU / 120.0).map(|a| seen(place(a.cos(), a.sin()))).collect()
    };
    line(circle(|c, s| [c, s, 0.0]), GRID.light.stroke_width(thin))?;
    line(circle(|c, s| [c, 0.0, s]), GRID.light.stroke_width(thin))?;
    line(circle(|c, s| [0.0, c, s]), GRID.light.stroke_width(thin))?;
    line((0..=120).map(|k| f64::from(k) * TAU / 120.0).map(f64::sin_cos).collect(), AXIS.light.stroke_width(thin))?;
    for axis in 0..3 {
        line(vec![(0.0, 0.0), seen(along(axis, 1.25))], AXIS.light.stroke_width(thin))?;
    }
    for (axis, tip) in tips.iter().enumerate() {
        let points: Vec<(f64, f64)> = (0..tip[0].len()).map(|k| seen([tip[0][k], tip[1][k], tip[2][k]])).collect();
        let (start, end) = (points[0], points[points.len() - 1]);
        let half_pixel = VIEW / f64::from(SIDE);
        // x and y of a link in the plane run on the same circle: y is drawn inside x's wider line.
        let width = [6.0, 1.5, 2.0][axis];
        let colour = COLOURS[axis].light;
        chart
            .draw_series([PathElement::new(
                along_path(&points, half_pixel, MOST),
                colour.stroke_width((width * f64::from(UNITS)) as u32),
            )])
            .map_err(drawing)?;
        chart.draw_series([Circle::new(start, 6 * UNITS, colour.stroke_width(3 * thin / 2))]).map_err(drawing)?;
        chart.draw_series([Circle::new(end, 4 * UNITS, colour.filled())]).map_err(drawing)?;
        let style = text(13, PENCIL.light, HPos::Center).pos(Pos::new(HPos::Center, VPos::Center));
        chart.draw_series([Text::new(AXES[axis].to_owned(), seen(along(axis, 1.32)), style)]).map_err(drawing)?;
    }
    Ok(())
}

/// The point at `length` on an inertial axis.
fn along(axis: usize, length: f64) -> [f64; 3] {
    let mut point = [0.0; 3];
    point[axis] = length;
    point
}
