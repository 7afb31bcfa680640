//! A drawing in fewer bytes: its polylines as paths of relative moves.
//!
//! In: SVG text. Out: the same drawing. The points of a polyline are whole numbers with up to five digits each; the
//! moves between them mostly have two.

use std::fmt::Write;

/// The drawing with every polyline whose points are whole numbers as a path.
#[must_use]
pub fn compact(svg: &str) -> String {
    let mut text = String::with_capacity(svg.len() / 2);
    let mut rest = svg;
    while let Some(start) = rest.find("<polyline ") {
        let (before, tag) = rest.split_at(start);
        let end = tag.find('>').map_or(tag.len(), |end| end + 1);
        let (tag, after) = tag.split_at(end);
        text += before;
        text += &path(tag).unwrap_or_else(|| tag.to_owned());
        rest = after;
    }
    // The style that the figures give their polylines.
    (text + rest).replace("<style>polyline{", "<style>path{")
}

/// A polyline's tag as that of a path.
fn path(tag: &str) -> Option<String> {
    let (before, list) = tag.split_once("points=\"")?;
    let (list, after) = list.split_once('"')?;
    let point = |text: &str| {
        let (x, y) = text.split_once(',')?;
        Some((x.parse::<i64>().ok()?, y.parse::<i64>().ok()?))
    };
    let points = list.split_ascii_whitespace().map(point).collect::<Option<Vec<_>>>()?;
    let (first, _) = points.split_first()?;
    let mut moves = format!("M{} {}l", first.0, first.1);
    for (k, pair) in points.windows(2).enumerate() {
        let [x, y] = [pair[1].0 - pair[0].0, pair[1].1 - pair[0].1];
        // A sign parts two numbers as well as a blank does.
        let blank = |value: i64| if value < 0 { "" } else { " " };
        let gap = if k == 0 { "" } else { blank(x) };
        write!(moves, "{gap}{x}{}{y}", blank(y)).expect("writing to a string cannot fail");
    }
    let before = before.replacen("<polyline", "<path", 1);
    Some(format!("{before}d=\"{}\"{after}", moves.trim_end_matches('l')))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polyline_becomes_a_path_through_the_same_points() {
        let svg = "<svg><style>polyline{a:b}</style><polyline fill=\"none\" points=\"10,20 13,15 13,16 \" stroke=\"red\"/><polyline points=\"1.5,2\"/></svg>";
        let expected = "<svg><style>path{a:b}</style><path fill=\"none\" d=\"M10 20l3-5 0 1\" stroke=\"red\"/><polyline points=\"1.5,2\"/></svg>";
        assert_eq!(compact(svg), expected);
        assert_eq!(compact("<polyline points=\"7,8\"/>"), "<path d=\"M7 8\"/>");
        assert_eq!(compact("no drawing"), "no drawing");
    }
}
