//! Figures of momenta: the three components over time, one panel each, with one scale.
//!
//! At the left the whole run; at the right the last part of it, where single strokes can be told apart.

use crate::columns::AXES;
use bg_model::simulation::Recording;
use bg_workbench::figures::FigureError;
use bg_workbench::figures::canvas::{Rectangle, figure};
use bg_workbench::figures::palette::AXES as COLOURS;
use bg_workbench::figures::panel::{OverTime, RIGHT, STILL, VALUE_LABELS, extent, row_plot, time_span, widened};

/// The time shown at the right, s: about five strokes of the paper's case.
const CLOSE: f64 = 0.4;
/// The width of the left panels where there are right ones, CSS pixels.
const WHOLE: i32 = 500;

/// Draws `p` or `h` of a link.
pub fn draw(heading: &str, trajectory: &Recording, symbol: char, link: u8) -> Result<String, FigureError> {
    let unit = if symbol == 'h' { "N m s" } else { "kg m/s" };
    let names = AXES.map(|axis| format!("{symbol}{link}_{axis}"));
    let components = names.iter().map(|name| trajectory.values(name)).collect::<Result<Vec<_>, _>>()?;
    let range = widened(extent(components.iter().flat_map(|values| values.iter().copied())), STILL);
    let times = &trajectory.times;
    let (start, end) = (times[0], times[times.len() - 1]);
    // A run that is shorter than three times the close view is seen well enough as a whole.
    let close = end - start > 3.0 * CLOSE;
    let whole_width = if close { WHOLE } else { Rectangle::CONTENT.width - VALUE_LABELS - RIGHT };

    figure(heading, |area| {
        for (row, values) in components.iter().enumerate() {
            let plot = row_plot(row as i32, 3, VALUE_LABELS, whole_width);
            let last = row == 2;
            let panel = |span, description: &str, caption| OverTime {
                caption,
                colour: COLOURS[row].light,
                times,
                values,
                span,
                range: range.clone(),
                time_description: last.then(|| description.to_owned()),
            };
            panel(time_span(start, end), "t in s", format!("{symbol}_{link}{} in {unit}", AXES[row]))
                .draw(area, plot)?;
            if close {
                let left = VALUE_LABELS + whole_width + RIGHT + VALUE_LABELS;
                let plot = row_plot(row as i32, 3, left, Rectangle::CONTENT.width - left - RIGHT);
                let description = format!("t in s, the last {CLOSE} s");
                panel(end - CLOSE..end, &description, String::new()).draw(area, plot)?;
            }
        }
        Ok(())
    })
}
