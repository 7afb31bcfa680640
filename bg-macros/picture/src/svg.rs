//! The picture as SVG.
//!
//! In: a [`Graph`], a [`Level`]. Out: SVG text. Each bond is a `<g class="bond" data-bond="INDEX">` with a wide line
//! that cannot be seen, for the pointer; each node a `<g class="node" data-element="INDEX">`; indices are those of
//! the graph's tables. At the level of words a part is a `<g class="part" data-group="NAME">`, and a link's
//! `data-bond` lists all its bonds. The half arrow's barb is on the side of the flow, below or to the right of the
//! bond (Karnopp's convention).

use std::fmt::Write;

use crate::graph::{End, Graph, Level};
use crate::layout::{Frame, Layout, PITCH};
use crate::marks::Mark;
use crate::route::Rect;
use crate::sheet::{Block, Link, Of, Sheet};
use crate::shelves::Point;
use crate::style::{fill, letters, root, stroke, style};
use crate::text::{self, xml};

/// Pixels between a block's border and its box.
const INSET: i32 = 2;
/// The height of the line that explains the colours, in pixels.
const KEY: i32 = 26;

/// The picture of `graph` as SVG.
#[must_use]
pub fn svg(graph: &Graph, level: Level) -> String {
    let sheet = Sheet::new(graph, level);
    let layout = Layout::new(graph, &sheet);
    let key = key(&sheet);
    let key_width = key.iter().map(|(_, text)| key_width(text)).sum::<i32>() + 4 * PITCH;
    let width = (layout.width * PITCH).max(if key.is_empty() { 0 } else { key_width });
    let height = layout.height * PITCH + if key.is_empty() { 0 } else { KEY };
    let name = xml(&graph.name);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" class=\"bond-graph\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\" {} role=\"img\" aria-label=\"Bond graph of {name}\">\n\
         <style>{}</style>\n<rect class=\"paper\" width=\"{width}\" height=\"{height}\" {}/>\n",
        root(),
        style(),
        fill("paper")
    );
    layout.frames.iter().for_each(|frame| draw_frame(&mut out, graph, frame));
    for (link, path) in sheet.links.iter().zip(&layout.paths) {
        draw_link(&mut out, graph, &sheet, link, path);
    }
    for (block, rect) in sheet.blocks.iter().zip(&layout.blocks) {
        draw_block(&mut out, graph, block, *rect);
    }
    draw_key(&mut out, &key, layout.height * PITCH);
    out.push_str("</svg>\n");
    out
}

/// Adds a line. Writing to a string cannot fail.
macro_rules! line {
    ($out:expr, $($text:tt)*) => { let _ = writeln!($out, $($text)*); };
}

fn draw_frame(out: &mut String, graph: &Graph, frame: &Frame) {
    let part = &graph.parts[frame.part];
    let Rect { left, top, right, bottom } = frame.rect;
    let (x, y) = (left * PITCH + PITCH / 2, top * PITCH + PITCH / 2);
    let (width, height) = ((right - left - 1) * PITCH, (bottom - top - 1) * PITCH);
    let name = xml(&part.name);
    let rest = xml(part.title()[part.name.len()..].trim());
    line!(out, "<g class=\"group\" data-group=\"{name}\">");
    line!(
        out,
        "<rect class=\"frame\" x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" rx=\"6\" {} {}/>",
        fill("frame"),
        stroke("line")
    );
    let title = frame.title(graph);
    let (x, y) = (title.left * PITCH, title.top * PITCH + PITCH);
    let letters = letters("ink", Some(12), true);
    // Readers that leave out the blank keep the step.
    let word = format!("<tspan class=\"word\" dx=\"2\" {} font-weight=\"normal\">{rest}</tspan>", fill("faint"));
    line!(out, "<text class=\"title\" x=\"{x}\" y=\"{y}\" text-anchor=\"start\"{letters}>{name} {word}</text>\n</g>");
}

fn draw_link(out: &mut String, graph: &Graph, sheet: &Sheet, link: &Link, path: &[Point]) {
    if path.is_empty() {
        return;
    }
    let bonds: Vec<_> = link.bonds.iter().map(|&bond| &graph.bonds[bond]).collect();
    let is_multi = link.is_thick(graph, sheet);
    let class = if is_multi { "bond multi" } else { "bond" };
    let indices = link.bonds.iter().map(usize::to_string).collect::<Vec<_>>().join(" ");
    let title = bonds.iter().map(|bond| bond_title(graph, bond)).collect::<Vec<_>>().join("\n");
    let route = corners(path);
    // What the parts of a bond share stands at their group.
    let [width, arrow, stroke_width] =
        if is_multi { ["3.2", " stroke-width=\"2.2\"", "2.6"] } else { ["1.3", "", "2"] };
    let shared = format!("fill=\"none\" {} stroke-width=\"{width}\"", stroke("bond"));
    line!(out, "<g class=\"{class}\" data-bond=\"{indices}\" {shared}>\n<title>{}</title>", xml(&title));
    line!(out, "<path class=\"hit\" d=\"{route}\" stroke=\"none\"/>\n<path class=\"line\" d=\"{route}\"/>");
    if link.has_arrow {
        line!(out, "<path class=\"arrow\" d=\"{}\"{arrow}/>", half_arrow(path, is_multi));
    }
    if let Some(end) = link.stroke {
        line!(out, "<path class=\"stroke\" d=\"{}\" stroke-width=\"{stroke_width}\"/>", causal_stroke(path, end));
    }
    out.push_str("</g>\n");
}

/// What a bond carries.
fn bond_title(graph: &Graph, bond: &crate::graph::Bond) -> String {
    let (from, to) = (&graph.nodes[bond.from].name, &graph.nodes[bond.to].name);
    let stroke = if bond.stroke == End::From { from } else { to };
    let times = if bond.cardinality > 1 { format!(", {} components", bond.cardinality) } else { String::new() };
    format!("{from} \u{2192} {to}: effort {}, flow {}{times}; stroke at {stroke}", bond.effort, bond.flow)
}

/// The path through its corners only.
fn corners(path: &[Point]) -> String {
    let pixels = |(x, y): Point| (x * PITCH, y * PITCH);
    let (x, y) = pixels(path[0]);
    let mut text = format!("M{x} {y}");
    for index in 1..path.len() {
        let is_row = |a: Point, b: Point| a.1 == b.1;
        let is_corner =
            path.get(index + 1).is_none_or(|&next| is_row(path[index - 1], path[index]) != is_row(path[index], next));
        if is_corner {
            let (x, y) = pixels(path[index]);
            let step = if is_row(path[index - 1], path[index]) { format!("H{x}") } else { format!("V{y}") };
            text.push_str(&step);
        }
    }
    text
}

/// The end of a path in pixels, and the direction in which it leads there.
fn tip(path: &[Point], end: End) -> (Point, Point) {
    let (last, before) = match end {
        End::To => (path[path.len() - 1], path[path.len() - 2]),
        End::From => (path[0], path[1]),
    };
    ((last.0 * PITCH, last.1 * PITCH), (last.0 - before.0, last.1 - before.1))
}

fn half_arrow(path: &[Point], is_multi: bool) -> String {
    let ((x, y), (dx, dy)) = tip(path, End::To);
    let (back, aside) = if is_multi { (12, 7) } else { (10, 5) };
    let barb = if dx == 0 { (x + aside, y - dy * back) } else { (x - dx * back, y + aside) };
    format!("M{x} {y}L{} {}", barb.0, barb.1)
}

fn causal_stroke(path: &[Point], end: End) -> String {
    const HALF: i32 = 5;
    let ((x, y), (dx, _)) = tip(path, end);
    if dx == 0 { format!("M{} {y}H{}", x - HALF, x + HALF) } else { format!("M{x} {}V{}", y - HALF, y + HALF) }
}

fn draw_block(out: &mut String, graph: &Graph, block: &Block, rect: Rect) {
    let (opening, title) = match block.of {
        Of::Node(node) => {
            (format!("class=\"{}\" data-element=\"{node}\"", classes(block)), node_title(graph, node, block.mark))
        }
        Of::Part(part) => {
            let part = &graph.parts[part];
            (format!("class=\"{}\" data-group=\"{}\"", classes(block), xml(&part.name)), part.title())
        }
    };
    let (x, y) = (rect.left * PITCH + INSET, rect.top * PITCH + INSET);
    let (width, height) = ((rect.right - rect.left) * PITCH - 2 * INSET, (rect.bottom - rect.top) * PITCH - 2 * INSET);
    let middle = x + width / 2;
    let is_part = matches!(block.of, Of::Part(_));
    let [first, second] = if is_part { [14, 28] } else { [16, 29] };
    let border = if is_part { format!(" {}", stroke("line")) } else { String::new() };
    let colours = format!("{}{border}", fill(colour(block)));
    let large = letters("ink", Some(13), true);
    let small = letters(if block.mark == Mark::None { "" } else { "ink" }, None, false);
    let [kind, name] = if is_part { [small, large] } else { [large, small] };
    line!(out, "<g {opening}>\n<title>{}</title>", xml(&title));
    line!(out, "<rect class=\"box\" x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" rx=\"5\" {colours}/>");
    line!(out, "<text class=\"kind\" x=\"{middle}\" y=\"{}\"{kind}>{}</text>", y + first, xml(&block.head));
    line!(out, "<text class=\"name\" x=\"{middle}\" y=\"{}\"{name}>{}</text>\n</g>", y + second, xml(&block.name));
}

/// The classes of a block: what it is, and what is special about it.
fn classes(block: &Block) -> String {
    let kind = match (block.of, block.head.as_str()) {
        (Of::Part(_), _) => "part",
        (_, "0" | "1") => "node junction",
        (_, "I" | "C") => "node storage",
        (_, "R" | "MR") => "node resistor",
        (_, "Se" | "Sf" | "MSe" | "MSf" | "rSe") => "node source",
        _ => "node two-port",
    };
    match block.mark {
        Mark::None => kind.to_owned(),
        Mark::Multiplier => format!("{kind} multiplier"),
        Mark::Derivative => format!("{kind} derivative"),
    }
}

/// The colour of a block.
fn colour(block: &Block) -> &'static str {
    match (block.mark, block.of, block.head.as_str()) {
        (Mark::Multiplier, ..) => "multiplier",
        (Mark::Derivative, ..) => "derivative",
        (_, Of::Part(_), _) => "frame",
        (_, _, "I" | "C") => "storage",
        (_, _, "R" | "MR") => "resistor",
        _ => "node",
    }
}

fn node_title(graph: &Graph, node: usize, mark: Mark) -> String {
    let node = &graph.nodes[node];
    let mut title = format!("{} {}", node.kind, node.name);
    if !node.law.is_empty() {
        title += &format!("\nlaw: {}", node.law.split_whitespace().collect::<Vec<_>>().join(" "));
    }
    if !node.states.is_empty() {
        title += &format!("\nstates: {}", node.states.join(", "));
    }
    let words = meaning(mark);
    if words.is_empty() { title } else { format!("{title}\n{words}") }
}

/// What a mark says.
fn meaning(mark: Mark) -> &'static str {
    match mark {
        Mark::None => "",
        Mark::Multiplier => "held by a rigid joint, under a multiplier",
        Mark::Derivative => "storage in derivative causality",
    }
}

/// The marks that occur, with their meaning.
fn key(sheet: &Sheet) -> Vec<(&'static str, &'static str)> {
    let marks = [(Mark::Multiplier, "multiplier"), (Mark::Derivative, "derivative")];
    let occurring = marks.into_iter().filter(|(mark, _)| sheet.blocks.iter().any(|block| block.mark == *mark));
    occurring.map(|(mark, class)| (class, meaning(mark))).collect()
}

fn key_width(text: &str) -> i32 {
    text::width(text, 10, false) / 10 + 40
}

fn draw_key(out: &mut String, key: &[(&str, &str)], top: i32) {
    let mut x = 2 * PITCH;
    for (class, text) in key {
        line!(
            out,
            "<g class=\"{class}\"><rect class=\"box\" x=\"{x}\" y=\"{}\" width=\"16\" height=\"12\" rx=\"3\" {}/>",
            top + 2,
            fill(class)
        );
        let letters = letters("ink", None, false);
        let (left, y) = (x + 22, top + 12);
        line!(
            out,
            "<text class=\"key\" x=\"{left}\" y=\"{y}\" text-anchor=\"start\"{letters}>{}</text></g>",
            xml(text)
        );
        x += key_width(text);
    }
}
