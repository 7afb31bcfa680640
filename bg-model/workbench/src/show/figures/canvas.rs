//! The sheet a figure is drawn on, and the finished SVG text.
//!
//! In: a heading and what draws below it. Out: SVG of 960 x 540 CSS pixels that scales with the page. The drawing crate
//! places every point at whole units, so the sheet is drawn ten times as large and shown at a tenth ([`UNITS`]): curves
//! are then smooth to a tenth of a pixel.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::FontStyle;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::FigureError;
use super::lettering::set;
use super::palette::{INK, PAPER, PENCIL, dark_style};

/// Units of drawing for one CSS pixel.
pub const UNITS: i32 = 10;
/// Width of a figure, CSS pixels.
const WIDTH: i32 = 960;
/// Height of a figure, CSS pixels.
const HEIGHT: i32 = 540;
/// Margin about everything, CSS pixels.
const MARGIN: i32 = 20;
/// Height of the heading with the space below it, CSS pixels.
const HEADING: i32 = 42;

/// A rectangle of the sheet.
pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;

/// A rectangle in CSS pixels, relative to its area.
#[derive(Clone, Copy, Debug)]
pub struct Rectangle {
    /// Left edge.
    pub x: i32,
    /// Upper edge.
    pub y: i32,
    /// Width.
    pub width: i32,
    /// Height.
    pub height: i32,
}

impl Rectangle {
    /// What is below the heading.
    pub const CONTENT: Self =
        Self { x: MARGIN, y: MARGIN + HEADING, width: WIDTH - 2 * MARGIN, height: HEIGHT - 2 * MARGIN - HEADING };

    /// The part of `area` that this covers.
    pub fn of<'a>(self, area: &Area<'a>) -> Area<'a> {
        area.clone().shrink((self.x * UNITS, self.y * UNITS), (self.width * UNITS, self.height * UNITS))
    }
}

/// Draws a figure: its heading, and below it what `draw` puts into [`Rectangle::CONTENT`].
pub fn figure(heading: &str, draw: impl FnOnce(&Area) -> Result<(), FigureError>) -> Result<String, FigureError> {
    let mut svg = String::new();
    {
        let size = ((WIDTH * UNITS) as u32, (HEIGHT * UNITS) as u32);
        let area = SVGBackend::with_string(&mut svg, size).into_drawing_area();
        area.fill(&PAPER.light).map_err(drawing)?;
        let mut style = text(18, INK.light, HPos::Left);
        style.font = style.font.style(FontStyle::Bold);
        write(&area, heading, (MARGIN, MARGIN), &style)?;
        draw(&area)?;
        area.present().map_err(drawing)?;
    }
    Ok(finish(&svg, heading))
}

/// A text style: size in CSS pixels, hanging from its position.
pub fn text(pixels: i32, colour: RGBColor, horizontal: HPos) -> TextStyle<'static> {
    // The drawing crate divides the size by 1.24 on its way to SVG.
    let size = f64::from(pixels * UNITS) * 1.24;
    ("sans-serif", size).into_font().color(&colour).pos(Pos::new(horizontal, VPos::Top))
}

/// The style of tick labels and axis descriptions.
pub fn label() -> TextStyle<'static> {
    text(12, PENCIL.light, HPos::Center)
}

/// Writes one line with its upper left, middle or right at `at` (CSS pixels).
pub fn write(area: &Area, line: &str, at: (i32, i32), style: &TextStyle<'static>) -> Result<(), FigureError> {
    area.draw(&Text::new(line.to_owned(), (at.0 * UNITS, at.1 * UNITS), style.clone())).map_err(drawing)
}

/// A blank that stands for an underline which is to be drawn as one.
const UNDERLINE: char = '\u{E000}';

/// `text` with its underlines as they are: what comes after one is else set as a subscript.
#[must_use]
pub fn literally(text: &str) -> String {
    text.replace('_', &UNDERLINE.to_string())
}

/// The drawing crate's fault as ours.
pub fn drawing(fault: impl std::fmt::Display) -> FigureError {
    FigureError::Drawing(fault.to_string())
}

/// The body with the opacity of each shape as that of its fill and line, which every reader knows; not where it is
/// whole.
fn opacity(body: &str) -> String {
    let mut parts = body.replace(" opacity=\"1\"", "");
    while let Some((before, after)) = parts.split_once(" opacity=\"") {
        let (value, rest) = after.split_once('"').unwrap_or((after, ""));
        parts = format!("{before} fill-opacity=\"{value}\" stroke-opacity=\"{value}\"{rest}");
    }
    parts
}

/// Shows the sheet at a tenth, adds the dark colours, sets the texts.
fn finish(svg: &str, heading: &str) -> String {
    let (_, body) = svg.split_once('>').expect("the backend starts with the svg tag");
    let (width, height) = (WIDTH * UNITS, HEIGHT * UNITS);
    let opening = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{WIDTH}\" height=\"{HEIGHT}\" viewBox=\"0 0 {width} \
         {height}\" role=\"img\" aria-label=\"{heading}\">"
    );
    let joins = "<style>polyline{stroke-linejoin:round;stroke-linecap:round}</style>";
    format!("{opening}\n{}{joins}\n{}", dark_style(), set(&opacity(body))).replace(UNDERLINE, "_")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_keeps_its_underline_in_text_and_heading() {
        let name = literally("upper_angle");
        let set = finish(&format!("<svg><text>{name}</text>"), &name);
        assert!(set.contains("aria-label=\"upper_angle\"") && set.contains("<text>upper_angle</text>"), "{set}");
    }

    #[test]
    fn an_opacity_is_that_of_fill_and_line() {
        let set = opacity("<rect opacity=\"1\"/><rect opacity=\"0.4\" fill=\"#FFFFFF\"/>");
        assert_eq!(set, "<rect/><rect fill-opacity=\"0.4\" stroke-opacity=\"0.4\" fill=\"#FFFFFF\"/>");
    }
}
