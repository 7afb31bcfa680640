//! Texts that every reader of SVG sets in the same place.
//!
//! In: SVG of the drawing crate. Out: the same with all of a text's places and sizes as plain numbers, and with the
//! index of `h_2x`, `C_4y` and the like as a subscript. Of what the drawing crate writes, LibreOffice passes over a
//! `dy` in em. Of subscripts, CairoSVG takes a size in percent to be one of the whole picture, rsvg leaves out a blank
//! after one, and CairoSVG and LibreOffice set those of a centred line over what comes after them.

/// What a subscript is lowered by and how large it is, in parts of the letters before it.
const LOWERED: f64 = 0.25;
const SMALLER: f64 = 0.75;
/// A blank, and the mean width of a letter, in the same parts.
const BLANK: f64 = 0.3;
const LETTER: f64 = 0.55;

/// Sets all texts of `body`.
pub fn set(body: &str) -> String {
    const OPENING: &str = "<text ";
    const CLOSING: &str = "</text>";
    let mut parts = body.split(OPENING);
    let mut set = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let placed = part.split_once('>').and_then(|(attributes, rest)| {
            let (line, after) = rest.split_once(CLOSING)?;
            let size = attribute(attributes, "font-size")?.parse().ok()?;
            let (line, placed) = (line.trim(), placed(attributes, size));
            let placed = if line.contains('_') { from_left(&placed, width(line, size)) } else { placed };
            Some(format!("{OPENING}{placed}>{}{CLOSING}{after}", subscripts(line, size)))
        });
        set += &placed.unwrap_or_else(|| format!("{OPENING}{part}"));
    }
    set
}

/// The value of an attribute.
fn attribute<'a>(attributes: &'a str, name: &str) -> Option<&'a str> {
    let opening = format!("{name}=\"");
    // Not the end of another name.
    let is_whole = |at: &usize| *at == 0 || attributes[..*at].ends_with(' ');
    let at = attributes.match_indices(&opening).map(|(at, _)| at).find(is_whole)?;
    attributes[at + opening.len()..].split_once('"').map(|(value, _)| value)
}

/// The attributes of a text of this size with its base line in `y` alone.
fn placed(attributes: &str, size: f64) -> String {
    // The upper edge of capitals, or the middle or the foot of small letters, is to be at `y`: below the base line by
    // this part of the size. Half of an x height is a quarter of the size of common letters.
    const PLACES: [(&str, f64); 3] = [("0.76em", 0.76), ("0.5ex", 0.26), ("-0.5ex", -0.26)];
    let by = |shift: &str| PLACES.iter().find(|(name, _)| *name == shift).map(|(_, part)| part * size);
    let moved = || {
        let (y, shift) = (attribute(attributes, "y")?, attribute(attributes, "dy")?);
        let to = y.parse::<f64>().ok()? + by(shift)?;
        Some(
            attributes
                .replace(&format!(" dy=\"{shift}\""), "")
                .replace(&format!(" y=\"{y}\""), &format!(" y=\"{to:.0}\"")),
        )
    };
    let attributes = moved().unwrap_or_else(|| attributes.to_owned());
    let written = attribute(&attributes, "font-size").unwrap_or_default();
    attributes.replace(&format!("font-size=\"{written}\""), &format!("font-size=\"{size:.0}\""))
}

/// The attributes of the same text, so wide, from its left end.
fn from_left(attributes: &str, width: f64) -> String {
    let part = match attribute(attributes, "text-anchor") {
        Some("middle") => 0.5,
        Some("end") => 1.0,
        _ => return attributes.to_owned(),
    };
    let moved = || {
        let x = attribute(attributes, "x")?;
        let to = x.parse::<f64>().ok()? - part * width;
        let start = ["middle", "end"].iter().fold(attributes.to_owned(), |text, anchor| {
            text.replace(&format!("text-anchor=\"{anchor}\""), "text-anchor=\"start\"")
        });
        Some(start.replacen(&format!("x=\"{x}\""), &format!("x=\"{to:.0}\""), 1))
    };
    moved().unwrap_or_else(|| attributes.to_owned())
}

/// About how wide a line with subscripts is.
fn width(line: &str, size: f64) -> f64 {
    let is_index = |before: &mut bool, c: char| {
        *before = c == '_' || *before && c.is_ascii_alphanumeric();
        Some(if c == '_' {
            0.0
        } else if *before {
            SMALLER
        } else {
            1.0
        })
    };
    LETTER * size * line.chars().scan(false, is_index).sum::<f64>()
}

/// A line of letters of this size: what comes after an underline is lowered and smaller up to the end of the word.
fn subscripts(line: &str, size: f64) -> String {
    let (lower, small) = ((LOWERED * size).round(), (SMALLER * size).round());
    let mut parts = line.split('_');
    let mut set = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let (index, rest) = part.split_at(part.find(|c: char| !c.is_ascii_alphanumeric()).unwrap_or(part.len()));
        set += &format!("<tspan dy=\"{lower}\" font-size=\"{small}\">{index}</tspan>");
        if !rest.is_empty() {
            let step =
                if rest.starts_with(' ') { format!(" dx=\"{}\"", (BLANK * size).round()) } else { String::new() };
            set += &format!("<tspan{step} dy=\"-{lower}\">{}</tspan>", rest.trim_start());
        }
    }
    set
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_index_becomes_a_subscript() {
        let set = set(
            "<text x=\"1\" y=\"20\" font-size=\"120\">\nh_2x in N m s\n</text><text font-size=\"120\">t in s</text>",
        );
        let tspans = "<tspan dy=\"30\" font-size=\"90\">2x</tspan><tspan dx=\"36\" dy=\"-30\">in N m s</tspan>";
        let (first, second) = ("<text x=\"1\" y=\"20\" font-size=\"120\">", "<text font-size=\"120\">");
        assert_eq!(set, format!("{first}h{tspans}</text>{second}t in s</text>"));
        assert_eq!(subscripts("C_4x", 100.0), "C<tspan dy=\"25\" font-size=\"75\">4x</tspan>");
    }

    #[test]
    fn places_and_sizes_are_plain_numbers() {
        let set_at =
            |dy: &str| set(&format!("<text x=\"7\" y=\"1000\" dy=\"{dy}\" font-size=\"120.00000000000001\">a</text>"));
        for (dy, y) in [("0.76em", 1091), ("0.5ex", 1031), ("-0.5ex", 969)] {
            assert_eq!(set_at(dy), format!("<text x=\"7\" y=\"{y}\" font-size=\"120\">a</text>"));
        }
    }

    #[test]
    fn a_centred_line_with_a_subscript_begins_at_its_left() {
        let of = |anchor: &str, line: &str| {
            set(&format!("<text x=\"1000\" y=\"20\" text-anchor=\"{anchor}\" font-size=\"100\">{line}</text>"))
        };
        // A small letter and three others, one of them a blank: 3.75 letters of 55 units.
        assert!(
            of("middle", "C_4 m").starts_with("<text x=\"897\" y=\"20\" text-anchor=\"start\""),
            "{}",
            of("middle", "C_4 m")
        );
        assert!(
            of("end", "C_4 m").starts_with("<text x=\"794\" y=\"20\" text-anchor=\"start\""),
            "{}",
            of("end", "C_4 m")
        );
        assert!(of("middle", "t in s").starts_with("<text x=\"1000\" y=\"20\" text-anchor=\"middle\""));
    }
}
