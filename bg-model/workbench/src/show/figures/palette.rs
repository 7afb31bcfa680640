//! The colours of the figures, each for light and dark surroundings.
//!
//! In: nothing. Out: colours for the drawing crate (the light ones), and the style sheet that replaces them where the
//! reader prefers dark. The three axis colours are those of Okabe and Ito (2008), which colour-blind readers can tell
//! apart; the dark ones are lighter shades of the same hues.

use plotters::style::RGBColor;

/// A colour in light and in dark surroundings.
pub struct Shade {
    /// The colour that is drawn.
    pub light: RGBColor,
    dark: RGBColor,
}

/// Background.
pub const PAPER: Shade = Shade { light: RGBColor(255, 255, 255), dark: RGBColor(22, 27, 34) };
/// Text.
pub const INK: Shade = Shade { light: RGBColor(31, 35, 40), dark: RGBColor(230, 237, 243) };
/// Secondary text: tick labels.
pub const PENCIL: Shade = Shade { light: RGBColor(89, 99, 110), dark: RGBColor(145, 152, 161) };
/// Axes and outlines.
pub const AXIS: Shade = Shade { light: RGBColor(140, 149, 159), dark: RGBColor(101, 108, 118) };
/// Grid lines.
pub const GRID: Shade = Shade { light: RGBColor(229, 232, 235), dark: RGBColor(48, 54, 61) };
/// Blue, vermillion and bluish green for x, y and z.
pub const AXES: [Shade; 3] = [
    Shade { light: RGBColor(0, 114, 178), dark: RGBColor(86, 180, 233) },
    Shade { light: RGBColor(213, 94, 0), dark: RGBColor(247, 144, 61) },
    Shade { light: RGBColor(0, 158, 115), dark: RGBColor(63, 207, 162) },
];

/// Seven hues of Okabe and Ito for curves that are told apart by their colour.
pub const CURVES: [Shade; 7] = [
    Shade { light: RGBColor(0, 114, 177), dark: RGBColor(86, 180, 233) },
    Shade { light: RGBColor(213, 94, 1), dark: RGBColor(247, 144, 61) },
    Shade { light: RGBColor(0, 158, 116), dark: RGBColor(63, 207, 162) },
    Shade { light: RGBColor(176, 80, 138), dark: RGBColor(221, 149, 193) },
    Shade { light: RGBColor(176, 122, 0), dark: RGBColor(240, 190, 80) },
    Shade { light: RGBColor(60, 150, 200), dark: RGBColor(130, 200, 240) },
    Shade { light: RGBColor(90, 90, 90), dark: RGBColor(190, 190, 190) },
];

/// The style sheet for dark surroundings.
pub fn dark_style() -> String {
    let rules: String = [&PAPER, &INK, &PENCIL, &AXIS, &GRID]
        .into_iter()
        .chain(&AXES)
        .chain(&CURVES)
        .map(|shade| {
            let (light, dark) = (hexadecimal(shade.light), hexadecimal(shade.dark));
            format!("[fill=\"{light}\"]{{fill:{dark}}}[stroke=\"{light}\"]{{stroke:{dark}}}")
        })
        .collect();
    format!("<style>@media (prefers-color-scheme:dark){{{rules}}}</style>")
}

fn hexadecimal(RGBColor(red, green, blue): RGBColor) -> String {
    format!("#{red:02X}{green:02X}{blue:02X}")
}
