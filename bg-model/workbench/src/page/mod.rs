//! The report: one HTML file of a run that needs nothing else to be opened.
//!
//! In: a run, what is known of its model, and where they are there what the machine looks like, the picture of its graph and its
//! modes. Out: HTML with style, script and data in it; the same as binary glTF. The script moves the machine, draws the charts
//! and links both by one time. It is bundled from `page/` of this package (`npm ci && npm run build`), with three.js and uPlot
//! inside; their licence stands at the foot of the page. Script and drawings are packed, the data are plain JSON.

pub mod animation;
mod charts;
mod data;
pub(crate) mod film;
pub mod glb;
mod html;
mod mesh;
mod modes;
mod packed;
mod picture;
mod samples;

use bg_model::description::{Description, ParameterInfo};
use bg_model::simulation::Recording;

use crate::extras::Page as Texts;
use crate::figures::Figure;
use crate::figures::compact::compact;
use crate::linear::Mode;
use crate::overview::{escaped, write_into};
use crate::summary::Summary;
use animation::Animation;
use charts::Balance;
use data::{Bonds, Data};
use html::Drawing;
use modes::Modes;
use packed::packed;

pub use picture::{BondSeries, Picture};

const LOADER: &str = include_str!("../../page/loader.js");
const SCRIPT: &str = include_str!("../../page/dist/report.js");
const LICENCES: &str = include_str!("../../page/dist/THIRD-PARTY.txt");
const STYLE: &str = include_str!("../../page/dist/report.css");

/// What a report is about.
#[derive(Clone, Copy, Debug)]
pub struct Report<'a> {
    /// Title and introduction; heading of the program's own figures.
    pub texts: &'a Texts,
    /// The model.
    pub description: &'static Description,
    /// What the scene is, in words; may be empty.
    pub scene: &'a str,
    /// The parameters of the mechanism with their values.
    pub parameters: &'a [Parameter],
    /// The numbers of the run.
    pub summary: &'a Summary,
    /// The samples of the run.
    pub run: &'a Recording,
    /// The instants of the rows of its CSV file, s.
    pub rows: &'a [f64],
    /// The program's own figures, drawn: what they show is not in the charts.
    pub figures: &'a [(Figure, String)],
    /// More drawings, each with its title: SVG texts.
    pub drawings: &'a [(String, String)],
    /// What is known beyond the run.
    pub views: &'a Views,
}

/// A parameter of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Name, unit, default, meaning.
    pub info: ParameterInfo,
    /// Its value in the run.
    pub value: f64,
    /// Where the default is from, such as `paper`; empty where nothing is said.
    pub source: &'static str,
}

impl Parameter {
    /// Whether the run has another value than the default.
    #[must_use]
    pub fn is_changed(&self) -> bool {
        self.value != self.info.default
    }
}

/// What a report shows beside a run, as far as it is there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Views {
    /// The machine in motion.
    pub animation: Option<Animation>,
    /// The picture of the graph.
    pub picture: Option<Picture>,
    /// The modes of the linearised machine.
    pub modes: Option<Linearised>,
}

/// The modes, and the machine where it was linearised.
#[derive(Clone, Debug, PartialEq)]
pub struct Linearised {
    /// The modes.
    pub modes: Vec<Mode>,
    /// Where it was linearised, in words.
    pub place: String,
    /// The machine there, one sample; `None` of one without bodies.
    pub rest: Option<Animation>,
}

/// The page.
#[must_use]
pub fn page(report: &Report<'_>) -> String {
    let Views { animation, picture, modes } = report.views;
    let animation = animation.as_ref().filter(|animation| !animation.bodies.is_empty() && !animation.times.is_empty());
    let at_rest = modes.as_ref().zip(animation).and_then(|(modes, _)| Some((modes, modes.rest.as_ref()?)));
    let swings = at_rest.map(|(modes, rest)| Modes::new(&modes.modes, rest));
    let can_swing = swings.is_some();
    let data = Data::new(report.description, report.run, report.rows, animation, swings);
    let balance = Balance::of(report.description, report.run);
    let drawings = drawings(report);
    let heading = if report.figures.is_empty() { "Drawings" } else { &report.texts.gallery };
    let has_checks = !report.summary.checks.is_empty();
    let sections = [
        (animation.is_some(), "machine", "Machine"),
        (true, "charts", "Outputs"),
        (picture.is_some(), "picture", "Bond graph"),
        (balance.is_some(), "balance", "Energy balance"),
        (modes.is_some(), "modes", "Modes"),
        (has_checks, "statements", "Statements"),
        (!drawings.is_empty(), "figures", heading),
        (true, "parameters", "Parameters"),
        (true, "statistics", "Statistics"),
        (true, "equations", "Equations"),
    ];
    let links: Vec<(&str, &str)> =
        sections.into_iter().filter(|(is_there, ..)| *is_there).map(|(_, anchor, name)| (anchor, name)).collect();

    let mut page = String::from("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n");
    page += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<link rel=\"icon\" href=\"data:,\">\n";
    write_into(&mut page, format_args!("<title>{}</title>\n", escaped(&report.texts.title)));
    write_into(&mut page, format_args!("<style>{STYLE}</style>\n</head>\n<body>\n"));
    html::head(&mut page, report, &links);
    page += "<main>\n";
    html::stage(&mut page, animation.is_some(), &note(&data, report));
    if let Some(picture) = picture {
        html::picture(&mut page, &picture.svg);
    }
    if let Some(balance) = &balance {
        html::balance(&mut page, balance);
    }
    if let Some(linearised) = modes {
        html::modes(&mut page, linearised, can_swing);
    }
    if has_checks {
        html::statements(&mut page, report.summary);
    }
    if !drawings.is_empty() {
        let about = if report.figures.is_empty() { "" } else { &report.texts.about_gallery };
        html::drawings(&mut page, heading, about, &drawings);
    }
    page += "<div class=\"pair\">\n";
    html::parameters(&mut page, report);
    html::statistics(&mut page, report.summary);
    page += "</div>\n";
    html::equations(&mut page, report.description.equations);
    page += "</main>\n";
    html::foot(&mut page, LICENCES);
    write_into(&mut page, format_args!("<script type=\"application/json\" id=\"data\">{}</script>\n", data.json()));
    let svgs: Vec<String> = drawings.iter().map(|drawing| compact(drawing.svg)).collect();
    let svgs = serde_json::to_string(&svgs).expect("texts are JSON");
    let bonds = picture.as_ref().and_then(|picture| Bonds::new(report.description.bonds, picture));
    let bonds = bonds.map_or_else(|| "null".to_owned(), |bonds| bonds.json());
    for (id, text) in [("bonds", bonds.as_str()), ("drawings", &svgs), ("script", SCRIPT)] {
        write_into(&mut page, format_args!("<script type=\"text/plain\" id=\"{id}\">{}</script>\n", packed(text)));
    }
    write_into(&mut page, format_args!("<script>\n{LOADER}</script>\n</body>\n</html>\n"));
    page
}

/// The program's figures, then the other drawings.
fn drawings<'a>(report: &Report<'a>) -> Vec<Drawing<'a>> {
    let own = report.figures.iter();
    let own = own.map(|(figure, svg)| Drawing { title: &figure.title, caption: &figure.caption, svg });
    let more = report.drawings.iter().map(|(title, svg)| Drawing { title, caption: title, svg });
    own.chain(more).collect()
}

/// Which samples the charts show.
fn note(data: &Data, report: &Report<'_>) -> String {
    let (shown, all) = (data.times.len(), report.run.times.len());
    let (rows, of_csv) = (data.rows.len(), report.rows.len());
    let thinned = if shown < all { format!("{shown} of {all} samples are shown") } else { format!("{shown} samples") };
    let of_rows = if rows < of_csv { format!("{rows} of {of_csv} rows") } else { format!("all {rows} rows") };
    format!(
        "{thinned}, among them {of_rows} of the CSV file. Press or drag in a chart to set the time; Ctrl and the wheel zoom, a \
         double click shows all."
    )
}
