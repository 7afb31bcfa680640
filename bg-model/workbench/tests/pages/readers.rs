//! Pictures as readers of SVG that are no browsers draw them: those that are installed.
//!
//! In: a graph's picture and a figure with subscripts. Out: pixels. Ink is looked for where the SVG has it: a box in
//! its colour, its texts centred in it, a stroke at its place, and little elsewhere.

use std::path::Path;
use std::process::Command;

use bg_picture::{Bond, End, Graph, Level, Node as GraphNode};
use bg_workbench::figures::canvas::{Rectangle, figure};
use bg_workbench::figures::palette::INK;
use bg_workbench::figures::panel::{OverTime, VALUE_LABELS};
use roxmltree::{Document, Node};

use crate::browser;

type Reader = (&'static str, fn(&Path, &Path) -> Command);

/// How each makes a PNG file of an SVG file, at a pixel for a pixel.
const READERS: [Reader; 5] = [
    ("rsvg-convert", |svg, png| command("rsvg-convert", &[&"-o", &png, &svg])),
    ("CairoSVG", |svg, png| command("python3", &[&"-m", &"cairosvg", &svg, &"-o", &png])),
    ("resvg", |svg, png| command("resvg", &[&svg, &png])),
    ("Inkscape", |svg, png| command("inkscape", &[&"--export-type=png", &"-o", &png, &svg])),
    ("Chromium", |svg, png| {
        let shot = format!("--screenshot={}", png.display());
        let page = format!("file://{}", svg.display());
        command(
            browser::browser().unwrap_or("chromium"),
            &[&"--headless", &"--no-sandbox", &"--hide-scrollbars", &shot, &page],
        )
    }),
];

fn command(name: &str, arguments: &[&dyn AsRef<std::ffi::OsStr>]) -> Command {
    let mut command = Command::new(name);
    arguments.iter().for_each(|argument| {
        command.arg(argument);
    });
    command
}

/// Pixels with red, green and blue.
struct Pixels {
    width: usize,
    height: usize,
    of: Vec<[u8; 3]>,
}

impl Pixels {
    /// Of a PNG file, on white paper.
    fn read(file: &Path) -> Self {
        let file = std::io::BufReader::new(std::fs::File::open(file).expect("a file"));
        let mut decoder = png::Decoder::new(file);
        decoder.set_transformations(png::Transformations::normalize_to_color8() | png::Transformations::ALPHA);
        let mut reader = decoder.read_info().expect("a PNG file");
        let mut bytes = vec![0; reader.output_buffer_size().expect("a size")];
        let info = reader.next_frame(&mut bytes).expect("pixels");
        let samples = info.color_type.samples();
        let on_white = |pixel: &[u8]| {
            let alpha = u32::from(pixel[samples - 1]);
            let channel = |k: usize| (u32::from(pixel[k]) * alpha / 255 + 255 - alpha) as u8;
            if samples == 4 { [channel(0), channel(1), channel(2)] } else { [channel(0); 3] }
        };
        let of = bytes[..info.buffer_size()].chunks(samples).map(on_white).collect();
        Self { width: info.width as usize, height: info.height as usize, of }
    }

    fn at(&self, x: f64, y: f64) -> [u8; 3] {
        self.of[(y as usize).min(self.height - 1) * self.width + (x as usize).min(self.width - 1)]
    }

    /// The places in a rectangle that are much darker than paper and boxes.
    fn ink(&self, [left, top, right, bottom]: [f64; 4]) -> Vec<(f64, f64)> {
        let is_dark = |pixel: [u8; 3]| pixel.iter().map(|channel| u32::from(*channel)).sum::<u32>() < 3 * 150;
        let places = (top as usize..bottom as usize).flat_map(|y| (left as usize..right as usize).map(move |x| (x, y)));
        let places = places.map(|(x, y)| (x as f64, y as f64));
        places.filter(|&(x, y)| is_dark(self.at(x, y))).collect()
    }
}

fn number(node: Node<'_, '_>, name: &str) -> f64 {
    node.attribute(name).and_then(|text| text.parse().ok()).unwrap_or_else(|| panic!("{name} of {node:?}"))
}

/// Shows an SVG to each reader that is installed; gives how many those are.
fn by_each(svg: &str, looked_at: impl Fn(&str, &Pixels)) -> usize {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("picture.svg");
    std::fs::write(&file, svg).expect("a file");
    let mut count = 0;
    for (name, drawn_by) in READERS {
        let png = folder.path().join(format!("{name}.png"));
        if drawn_by(&file, &png).output().is_ok_and(|output| output.status.success()) && png.exists() {
            println!("drawn by {name}");
            looked_at(name, &Pixels::read(&png));
            count += 1;
        }
    }
    if count == 0 {
        println!("skipped: no reader of SVG is installed");
    }
    count
}

/// A mass on a spring and a damper, with a source.
fn oscillator() -> Graph {
    let node = |(kind, name): (&str, &str)| GraphNode { kind: kind.into(), name: name.into(), ..GraphNode::default() };
    let nodes = [("1", "slide"), ("I", "block"), ("C", "spring_of_steel"), ("R", "damper"), ("Se", "push")].map(node);
    let bond = |(from, to, stroke): (usize, usize, End)| Bond {
        from,
        to,
        cardinality: 1,
        stroke,
        effort: "N".into(),
        flow: "m/s".into(),
    };
    let bonds = [(0, 1, End::To), (0, 2, End::From), (0, 3, End::From), (4, 0, End::To)].map(bond);
    Graph { name: "Oscillator".into(), nodes: nodes.into(), bonds: bonds.into(), ..Graph::default() }
}

#[test]
fn a_graph_has_its_boxes_names_and_strokes_in_every_reader() {
    let svg = bg_picture::svg(&oscillator(), Level::Full);
    let document = Document::parse(&svg).expect("SVG");
    let of_class =
        |class: &'static str| document.descendants().filter(move |node| node.attribute("class") == Some(class));
    by_each(&svg, |reader, pixels| {
        assert_eq!(pixels.at(1.0, 1.0), [255; 3], "{reader}: the paper");
        for one in of_class("box") {
            let [x, y, width, height] = ["x", "y", "width", "height"].map(|name| number(one, name));
            let colour = one.attribute("fill").expect("a colour");
            let channel = |k: usize| u8::from_str_radix(&colour[1 + 2 * k..3 + 2 * k], 16).expect("a colour");
            let (expected, found) = ([0, 1, 2].map(channel), pixels.at(x + 3.0, y + height - 6.0));
            let is_near = (0..3).all(|k| expected[k].abs_diff(found[k]) <= 4);
            assert!(is_near, "{reader}: {found:?} for {colour}");
            // The two texts, but not the bonds that come from above and below.
            let ink = pixels.ink([x + 1.0, y + 4.0, x + width - 1.0, y + height - 2.0]);
            let middle = ink.iter().map(|(x, _)| x).sum::<f64>() / ink.len() as f64 - x;
            assert!(ink.len() > 15, "{reader}: {} dark pixels in a box", ink.len());
            assert!((middle / width - 0.5).abs() < 0.12, "{reader}: texts about {middle} of {width}");
        }
        for stroke in of_class("stroke") {
            let path = stroke.attribute("d").expect("a path").replace(['M', 'H', 'V'], " ");
            let [x, y, end] =
                path.split_whitespace().map(|word| word.parse().expect("a number")).collect::<Vec<f64>>()[..]
            else {
                panic!("{path}")
            };
            let is_level = stroke.attribute("d").is_some_and(|path| path.contains('H'));
            let (to_x, to_y) = if is_level { (end, y) } else { (x, end) };
            let ink = pixels.ink([x.min(to_x) - 1.0, y.min(to_y) - 1.0, x.max(to_x) + 2.0, y.max(to_y) + 2.0]);
            assert!(ink.len() >= 8, "{reader}: {} dark pixels at the stroke {path}", ink.len());
        }
    });
}

#[test]
fn a_figure_has_its_subscripts_at_their_places_in_every_reader() {
    let (times, values) = ([0.0, 1.0], [0.0, 1.0]);
    let plot = Rectangle { x: 20 + VALUE_LABELS, y: 100, width: 800, height: 380 };
    let svg = figure("A line", |area| {
        let line = OverTime {
            caption: "C_4y in m".into(),
            colour: INK.light,
            times: &times,
            values: &values,
            span: 0.0..1.0,
            range: 0.0..1.0,
            time_description: Some("h_2x in N".into()),
        };
        line.draw(area, plot)
    });
    by_each(&svg.expect("a figure"), |reader, pixels| {
        let [x, y] = [plot.x, plot.y].map(f64::from);
        let whole = [0.0, 0.0, pixels.width as f64, pixels.height as f64];
        let all = pixels.ink(whole).len() as f64 / (whole[2] * whole[3]);
        assert!(all < 0.02, "{reader}: a part of {all} is dark");
        let caption = pixels.ink([x, y - 20.0, x + 90.0, y - 2.0]);
        let [first, last] = [0, caption.len() - 1].map(|k| caption.iter().map(|(x, _)| *x).nth(k));
        assert!(caption.len() > 60, "{reader}: {} dark pixels in the caption, {first:?} to {last:?}", caption.len());
        // The letters of the index, and then the unit, each in its place: nothing is set over anything.
        let columns = |from: f64, to: f64| {
            (from as usize..to as usize).filter(|&column| caption.iter().any(|(x, _)| *x as usize == column)).count()
        };
        let [letter, index, rest] = [(0.0, 10.0), (10.0, 24.0), (26.0, 70.0)].map(|(a, b)| columns(x + a, x + b));
        assert!(letter > 4 && index > 6 && rest > 10, "{reader}: {letter}, {index} and {rest} columns with ink");
        let below = pixels.ink([x + 340.0, y + 400.0, x + 460.0, y + 430.0]);
        assert!(below.len() > 60, "{reader}: {} dark pixels below the axis", below.len());
    });
}
