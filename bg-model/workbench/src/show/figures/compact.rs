//! A drawing in fewer bytes: its polylines as paths of relative moves, neighbours that look the same as one path; its
//! dots likewise, as the round ends of lines without a length.
//!
//! In: SVG text. Out: the same drawing. The points of a polyline are whole numbers with up to five digits each; the
//! moves between them mostly have two. Where neighbours lie over each other and are seen through, the upper one no
//! longer darkens the lower one.

use std::fmt::Write;

/// The drawing with every polyline and every dot whose places are whole numbers as a path.
#[must_use]
pub fn compact(svg: &str) -> String {
    let mut text = String::with_capacity(svg.len() / 2);
    // The path that is open: what stands before and after its moves.
    let mut open: Option<(String, String)> = None;
    let mut rest = svg;
    while let Some(start) = ["<polyline ", "<circle "].iter().filter_map(|tag| rest.find(tag)).min() {
        let (between, tag) = rest.split_at(start);
        let end = tag.find('>').map_or(tag.len(), |end| end + 1);
        let (tag, after) = tag.split_at(end);
        rest = after;
        let made = path(tag).or_else(|| dot(tag));
        let is_same = open
            .as_ref()
            .zip(made.as_ref())
            .is_some_and(|(open, (before, _, after))| open.0 == *before && open.1 == *after);
        let goes_on = between.trim().is_empty() && is_same;
        if !goes_on {
            text += &open.take().map_or_else(String::new, |(_, after)| format!("\"{after}"));
            text += between;
        }
        match made {
            Some((before, moves, after)) => {
                if !goes_on {
                    text += &format!("{before}d=\"");
                    open = Some((before, after));
                }
                text += &moves;
            }
            None => text += tag,
        }
    }
    text += &open.map_or_else(String::new, |(_, after)| format!("\"{after}"));
    // The style that the figures give their polylines.
    (text + rest).replace("<style>polyline{", "<style>path{")
}

/// A dot's tag as a path: what stands before its moves, they, what stands after them.
fn dot(tag: &str) -> Option<(String, String, String)> {
    let value = |name: &str| Some(tag.split_once(&format!(" {name}=\""))?.1.split_once('"')?.0);
    let whole = |name: &str| value(name)?.parse::<i64>().ok();
    let [x, y, radius] = [whole("cx")?, whole("cy")?, whole("r")?];
    if value("stroke") != Some("none") {
        return None;
    }
    let colour = value("fill")?;
    let opacity = value("fill-opacity").map_or_else(String::new, |part| format!(" stroke-opacity=\"{part}\""));
    let before =
        format!("<path stroke=\"{colour}\"{opacity} stroke-width=\"{}\" stroke-linecap=\"round\" ", 2 * radius);
    Some((before, format!("M{x} {y}h0"), "/>".to_owned()))
}

/// A polyline's tag as that of a path: what stands before its moves, they, what stands after them.
fn path(tag: &str) -> Option<(String, String, String)> {
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
    Some((before, moves.trim_end_matches('l').to_owned(), after.to_owned()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_polyline_becomes_a_path_through_the_same_points() {
        let svg = "<svg><style>polyline{a:b}</style><polyline fill=\"none\" points=\"10,20 13,15 13,16 \" \
            stroke=\"red\"/><polyline points=\"1.5,2\"/></svg>";
        let expected = "<svg><style>path{a:b}</style><path fill=\"none\" d=\"M10 20l3-5 0 1\" \
            stroke=\"red\"/><polyline points=\"1.5,2\"/></svg>";
        assert_eq!(compact(svg), expected);
        assert_eq!(compact("<polyline points=\"7,8\"/>"), "<path d=\"M7 8\"/>");
        assert_eq!(compact("no drawing"), "no drawing");
    }

    #[test]
    fn neighbours_that_look_the_same_are_one_path() {
        let line = |points: &str, colour: &str| format!("<polyline points=\"{points}\" stroke=\"{colour}\"/>\n");
        let svg = [line("1,2 3,4", "red"), line("9,9 8,9", "red"), line("1,1 2,2", "blue")].concat();
        let expected = "<path d=\"M1 2l2 2M9 9l-1 0\" stroke=\"red\"/>\n<path d=\"M1 1l1 1\" stroke=\"blue\"/>\n";
        assert_eq!(compact(&svg), expected);
        let dot = |x: i32| {
            format!("<circle cx=\"{x}\" cy=\"7\" r=\"25\" fill-opacity=\"0.8\" fill=\"#0072B1\" stroke=\"none\"/>\n")
        };
        let expected = "<path stroke=\"#0072B1\" stroke-opacity=\"0.8\" stroke-width=\"50\" stroke-linecap=\"round\" \
                        d=\"M1 7h0M2 7h0\"/>";
        assert_eq!(compact(&(dot(1) + &dot(2))).trim(), expected);
        let ring = "<circle cx=\"1\" cy=\"7\" r=\"25\" fill=\"none\" stroke=\"red\"/>";
        assert_eq!(compact(ring), ring);
    }
}
