//! Reads a picture back from its SVG and finds what a reader would stumble over.
//!
//! In: the SVG, the graph that it should show. Out: faults as lines of text. Widths of labels are estimated here
//! anew, not taken from the drawing: 0.58 of the font's size for a letter, 0.66 for a bold one.

use std::collections::BTreeMap;

use bg_picture::{Bond, End, Graph, Node as GraphNode};
use roxmltree::{Document, Node};

/// A rectangle in pixels.
#[derive(Clone, Copy, Debug)]
pub struct Area {
    left: f64,
    top: f64,
    right: f64,
    bottom: f64,
}

type Point = (f64, f64);

/// A label and the rectangle that it takes.
struct Label {
    text: String,
    area: Area,
}

/// A drawn bond: its indices, its corners, the half arrow's tip, the middle of the stroke.
struct Line {
    bonds: Vec<usize>,
    corners: Vec<Point>,
    arrow: Option<Point>,
    stroke: Option<Point>,
    is_thick: bool,
}

/// What an SVG shows.
pub struct Picture {
    labels: Vec<Label>,
    /// The box of each element or part, by index or name.
    boxes: BTreeMap<String, Area>,
    lines: Vec<Line>,
}

/// How much there is to see.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Counts {
    pub bonds: usize,
    pub bends: usize,
    pub crossings: usize,
}

impl Area {
    fn overlaps(&self, other: &Self) -> bool {
        self.left < other.right && other.left < self.right && self.top < other.bottom && other.top < self.bottom
    }

    /// Distance of a point, 0 inside.
    fn distance(&self, (x, y): Point) -> f64 {
        let dx = (self.left - x).max(x - self.right).max(0.0);
        let dy = (self.top - y).max(y - self.bottom).max(0.0);
        dx.max(dy)
    }

    fn of_segment(a: Point, b: Point) -> Self {
        Self { left: a.0.min(b.0), top: a.1.min(b.1), right: a.0.max(b.0), bottom: a.1.max(b.1) }
    }
}

/// Nodes and bonds as the tables of `graph --part elements` and `graph --part bonds` have them.
#[allow(dead_code, reason = "for the suites that run programs")]
pub fn tables(elements: &str, bonds: &str) -> Graph {
    let mut graph = Graph::default();
    for row in elements.lines() {
        let mut words = row.split_whitespace();
        let [kind, name] = [words.next(), words.next()].map(|word| word.expect("a kind and a name").to_owned());
        graph.nodes.push(GraphNode { kind, name, ..GraphNode::default() });
    }
    for row in bonds.lines() {
        let words: Vec<&str> = row.split_whitespace().collect();
        let node = |name: &str| graph.nodes.iter().position(|node| node.name == name).expect("a node");
        graph.bonds.push(Bond {
            from: node(words[0]),
            to: node(words[2]),
            cardinality: if words[3] == "[3]" { 3 } else { 1 },
            stroke: if words[1] == "->|" { End::To } else { End::From },
            effort: String::new(),
            flow: String::new(),
        });
    }
    assert!(!graph.bonds.is_empty(), "{bonds}");
    graph
}

/// All faults of the picture of `graph` at the full level.
pub fn faults(graph: &Graph, svg: &str) -> Vec<String> {
    let picture = Picture::read(svg);
    let mut faults = picture.collisions();
    faults.extend(picture.differences(graph));
    faults
}

/// Faults of the picture in words: what collides.
pub fn faults_in_words(graph: &Graph, svg: &str) -> Vec<String> {
    let picture = Picture::read(svg);
    let mut faults = picture.collisions();
    let parts = graph.parts.iter().filter(|part| !picture.boxes.contains_key(&part.name));
    faults.extend(parts.map(|part| format!("no box for {}", part.name)));
    faults
}

impl Picture {
    /// Reads an SVG of ours.
    pub fn read(svg: &str) -> Self {
        let document = Document::parse(svg).expect("the picture is XML");
        let groups = |class: &str| -> Vec<Node<'_, '_>> {
            let is_of =
                |node: &Node| node.attribute("class").is_some_and(|text| text.split(' ').any(|one| one == class));
            document.descendants().filter(|node| node.has_tag_name("g") && is_of(node)).collect()
        };
        let labels = document.descendants().filter(|node| node.has_tag_name("text")).map(label).collect();
        let nodes = groups("node").into_iter().chain(groups("part"));
        let boxes = nodes.map(|node| {
            let name = node.attribute("data-element").or(node.attribute("data-group")).expect("an index or a name");
            (name.to_owned(), area(child(node, "box").expect("a node has a box")))
        });
        Self { labels, boxes: boxes.collect(), lines: groups("bond").into_iter().map(line).collect() }
    }

    /// Bends and crossings.
    pub fn counts(&self) -> Counts {
        let bends = self.lines.iter().map(|line| line.corners.len() - 2).sum();
        let mut crossings = 0;
        for (index, line) in self.lines.iter().enumerate() {
            for other in &self.lines[..index] {
                crossings += line.segments().flat_map(|a| other.segments().map(move |b| (a, b))).filter(cross).count();
            }
        }
        Counts { bonds: self.lines.len(), bends, crossings }
    }

    /// What overlaps or runs over something.
    fn collisions(&self) -> Vec<String> {
        let mut faults = Vec::new();
        for (index, label) in self.labels.iter().enumerate() {
            for other in self.labels[..index].iter().filter(|other| other.area.overlaps(&label.area)) {
                faults.push(format!("label `{}` overlaps label `{}`", label.text, other.text));
            }
        }
        let boxes: Vec<_> = self.boxes.iter().collect();
        for (index, (name, area)) in boxes.iter().enumerate() {
            for (other, _) in boxes[..index].iter().filter(|(_, other)| other.overlaps(area)) {
                faults.push(format!("box {name} overlaps box {other}"));
            }
        }
        for (index, line) in self.lines.iter().enumerate() {
            let bond = &line.bonds;
            for (a, b) in line.segments() {
                let run = Area::of_segment(a, b);
                for label in self.labels.iter().filter(|label| touches(&label.area, &run)) {
                    faults.push(format!("bond {bond:?} runs through label `{}`", label.text));
                }
                for (name, _) in boxes.iter().filter(|(_, area)| touches(area, &run)) {
                    faults.push(format!("bond {bond:?} runs through box {name}"));
                }
            }
            for other in &self.lines[..index] {
                let pairs = line.segments().flat_map(|a| other.segments().map(move |b| (a, b)));
                if pairs.clone().any(|pair| overlap(&pair) > 0.0) {
                    faults.push(format!("bond {bond:?} lies on bond {:?}", other.bonds));
                }
            }
        }
        faults
    }

    /// Where the picture says other things than the graph's tables.
    fn differences(&self, graph: &Graph) -> Vec<String> {
        let mut faults = Vec::new();
        let mut drawn: Vec<usize> = self.lines.iter().flat_map(|line| line.bonds.clone()).collect();
        drawn.sort_unstable();
        if drawn != (0..graph.bonds.len()).collect::<Vec<_>>() || self.boxes.len() != graph.nodes.len() {
            faults.push(format!("{} boxes and the bonds {drawn:?}", self.boxes.len()));
        }
        for line in &self.lines {
            let bond = &graph.bonds[line.bonds[0]];
            let (first, last) = (line.corners[0], line.corners[line.corners.len() - 1]);
            for (node, end) in [(bond.from, first), (bond.to, last)] {
                let distance = self.boxes.get(&node.to_string()).map_or(f64::INFINITY, |area| area.distance(end));
                if !(0.1..4.0).contains(&distance) {
                    faults.push(format!("bond {:?} ends {distance} from {}", line.bonds, graph.nodes[node].name));
                }
            }
            if line.arrow != Some(last) {
                faults.push(format!("bond {:?} has its half arrow at {:?}", line.bonds, line.arrow));
            }
            let stroke = if bond.stroke == End::From { first } else { last };
            if line.stroke != Some(stroke) {
                faults.push(format!("bond {:?} has its stroke at {:?}, not at {stroke:?}", line.bonds, line.stroke));
            }
            if line.is_thick != (bond.cardinality > 1) {
                faults.push(format!("bond {:?} is thick: {}", line.bonds, line.is_thick));
            }
        }
        faults
    }
}

impl Line {
    fn segments(&self) -> impl Iterator<Item = (Point, Point)> + Clone + '_ {
        self.corners.windows(2).map(|pair| (pair[0], pair[1]))
    }
}

fn child<'a, 'i>(node: Node<'a, 'i>, class: &str) -> Option<Node<'a, 'i>> {
    node.children().find(|child| child.attribute("class") == Some(class))
}

fn number(node: Node, name: &str) -> f64 {
    node.attribute(name).unwrap_or("0").parse().expect("a number")
}

fn area(rect: Node) -> Area {
    let [left, top, width, height] = ["x", "y", "width", "height"].map(|name| number(rect, name));
    Area { left, top, right: left + width, bottom: top + height }
}

fn label(node: Node) -> Label {
    let text: String = node.descendants().filter(Node::is_text).filter_map(|part| part.text()).collect();
    let class = node.attribute("class").unwrap_or_default();
    let is_part = node.parent().and_then(|parent| parent.attribute("class")).is_some_and(|of| of.starts_with("part"));
    let (size, is_bold) = match (class, is_part) {
        ("kind", false) | ("name", true) => (13.0, true),
        ("title", _) => (12.0, true),
        _ => (10.0, false),
    };
    let (x, y) = (number(node, "x"), number(node, "y"));
    let width = text.chars().count() as f64 * size * if is_bold { 0.66 } else { 0.58 };
    let left = if ["title", "key"].contains(&class) { x } else { x - width / 2.0 };
    Label { text, area: Area { left, top: y - 0.75 * size, right: left + width, bottom: y + 0.2 * size } }
}

fn line(node: Node) -> Line {
    let path = |class: &str| child(node, class).and_then(|path| path.attribute("d")).map(points);
    let indices = node.attribute("data-bond").expect("indices").split(' ').map(|one| one.parse().expect("an index"));
    let middle = |points: Vec<Point>| (points[0].0.midpoint(points[1].0), points[0].1.midpoint(points[1].1));
    let class = node.attribute("class").expect("a class");
    Line {
        bonds: indices.collect(),
        corners: path("line").expect("a bond has a line"),
        arrow: path("arrow").map(|points| points[0]),
        stroke: path("stroke").map(middle),
        is_thick: class.split(' ').any(|one| one == "multi"),
    }
}

/// The points of a path of `M`, `L`, `H` and `V`.
fn points(path: &str) -> Vec<Point> {
    let mut points: Vec<Point> = Vec::new();
    let starts: Vec<usize> = path.match_indices(|letter: char| letter.is_alphabetic()).map(|(at, _)| at).collect();
    for (index, &start) in starts.iter().enumerate() {
        let end = starts.get(index + 1).copied().unwrap_or(path.len());
        let numbers: Vec<f64> = path[start + 1..end].split(' ').map(|one| one.parse().expect("a number")).collect();
        let last = points.last().copied().unwrap_or_default();
        points.push(match &path[start..=start] {
            "H" => (numbers[0], last.1),
            "V" => (last.0, numbers[0]),
            _ => (numbers[0], numbers[1]),
        });
    }
    points
}

/// Whether a segment of no width touches the inside of an area.
fn touches(area: &Area, run: &Area) -> bool {
    run.left < area.right
        && area.left < run.right.max(run.left + 1e-9)
        && run.top < area.bottom
        && area.top < run.bottom.max(run.top + 1e-9)
}

type Segment = (Point, Point);

fn is_across(segment: &Segment) -> bool {
    segment.0.1 == segment.1.1
}

/// The length that two segments have in common.
fn overlap((one, two): &(Segment, Segment)) -> f64 {
    let (a, b) = (Area::of_segment(one.0, one.1), Area::of_segment(two.0, two.1));
    if is_across(one) != is_across(two) {
        0.0
    } else if is_across(one) && a.top == b.top {
        a.right.min(b.right) - a.left.max(b.left)
    } else if !is_across(one) && a.left == b.left {
        a.bottom.min(b.bottom) - a.top.max(b.top)
    } else {
        0.0
    }
}

/// Whether two segments cross inside both.
fn cross((one, two): &(Segment, Segment)) -> bool {
    let (a, b) = (Area::of_segment(one.0, one.1), Area::of_segment(two.0, two.1));
    let (flat, steep) = if is_across(one) { (a, b) } else { (b, a) };
    is_across(one) != is_across(two)
        && flat.left < steep.left
        && steep.left < flat.right
        && steep.top < flat.top
        && flat.top < steep.bottom
}
