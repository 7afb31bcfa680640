//! The page put together: its sections, and the texts that its script reads.

use bg_model::description::Description;
use bg_model::simulation::Recording;

use super::charts::Balance;
use super::data::{Bonds, Data};
use super::html::{self, Drawing};
use super::modes::Modes;
use super::packed::packed;
use super::settings;
use super::{Parameter, Views};
use crate::extras::Page as Texts;
use crate::figures::Figure;
use crate::figures::compact::compact;
use crate::live::Live;
use crate::markup::{escaped, write_into};
use crate::summary::Summary;

const LOADER: &str = include_str!("../../page/loader.js");
const SCRIPT: &str = include_str!("../../page/dist/report.js");
/// What runs the model of a live page.
const WORKER: &str = include_str!("../../page/dist/worker.js");
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
    /// The model inside, where the page is to run it again.
    pub live: Option<&'a Live>,
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
        (report.live.is_some(), "controls", "Try other values"),
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
    html::stage(
        &mut page,
        animation.is_some(),
        report.live.is_some(),
        &data.note(report.run.times.len(), report.rows.len()),
    );
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
    if let Some(live) = report.live {
        let settings = settings::json(&live.order, report);
        write_into(&mut page, format_args!("<script type=\"application/json\" id=\"live\">{settings}</script>\n"));
    }
    let svgs: Vec<String> = drawings.iter().map(|drawing| compact(drawing.svg)).collect();
    let svgs = serde_json::to_string(&svgs).expect("texts are JSON");
    let bonds = picture.as_ref().and_then(|picture| Bonds::new(report.description.bonds, picture));
    let bonds = bonds.map_or_else(|| "null".to_owned(), |bonds| bonds.json());
    let texts = [("bonds", bonds.as_bytes()), ("drawings", svgs.as_bytes()), ("script", SCRIPT.as_bytes())];
    let live = report.live.map(|live| [("worker", WORKER.as_bytes()), ("module", &live.module[..])]);
    for (id, bytes) in texts.into_iter().chain(live.into_iter().flatten()) {
        write_into(&mut page, format_args!("<script type=\"text/plain\" id=\"{id}\">{}</script>\n", packed(bytes)));
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
