//! The page put together: its sections, and the texts that its script reads.

use bg_model::description::Description;
use bg_model::simulation::Recording;

use super::animation::Animation;
use super::charts::Balance;
use super::data::{Bonds, Data};
use super::html::{self, Drawing};
use super::modes::Modes;
#[cfg(not(target_arch = "wasm32"))]
use super::packed::packed;
use super::settings;
use super::{Parameter, Views};
use crate::run::summary::Summary;
use crate::show::extras::Page as Texts;
use crate::show::figures::Figure;
use crate::show::figures::compact::compact;
use crate::show::markup::{escaped, write_into};
use crate::show::page::order::{Live, Order};

#[cfg(not(target_arch = "wasm32"))]
const LOADER: &str = include_str!("../../../page/loader.js");
#[cfg(not(target_arch = "wasm32"))]
const SCRIPT: &str = include_str!("../../../page/dist/report.js");
/// The same packed, as `build.rs` makes it.
#[cfg(not(target_arch = "wasm32"))]
const PACKED: &str = include_str!(concat!(env!("OUT_DIR"), "/report.packed"));
/// That of a page without a machine, packed.
#[cfg(not(target_arch = "wasm32"))]
const PLAIN: &str = include_str!(concat!(env!("OUT_DIR"), "/plain.packed"));
/// What runs the model of a live page, packed.
#[cfg(not(target_arch = "wasm32"))]
const WORKER: &str = include_str!(concat!(env!("OUT_DIR"), "/worker.packed"));
const LICENCES: &str = include_str!("../../../page/dist/THIRD-PARTY.txt");
#[cfg(not(target_arch = "wasm32"))]
const STYLE: &str = include_str!("../../../page/dist/report.css");

/// The files that a page has beside it which shows reports in a frame: names and texts.
#[cfg(not(target_arch = "wasm32"))]
pub const BESIDE: [(&str, &str); 3] =
    [("report.css", STYLE), ("report.js", SCRIPT), ("beside.js", include_str!("../../../page/beside.js"))];

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
    /// Other runs and measurements in the same charts, each with its name.
    pub others: &'a [(String, Recording)],
    /// More drawings, each with its title: SVG texts.
    pub drawings: &'a [(String, String)],
    /// What is known beyond the run.
    pub views: &'a Views,
    /// The model inside, where the page is to run it again.
    pub live: Option<&'a Live>,
}

/// The page, in one file with all that it needs. In WebAssembly there is no such page.
#[cfg(not(target_arch = "wasm32"))]
#[must_use]
pub fn page(report: &Report<'_>) -> String {
    let live = report.live;
    let script = if moving(report.views).is_some() { PACKED } else { PLAIN };
    let texts = |texts: &[(&'static str, String)]| {
        let mut all: Vec<(&str, String)> = texts.iter().map(|(id, text)| (*id, packed(text.as_bytes()))).collect();
        all.push(("script", script.to_owned()));
        if let Some(live) = live {
            all.extend([("worker", WORKER.to_owned()), ("module", packed(&live.module))]);
        }
        let text = |(id, packed)| format!("<script type=\"text/plain\" id=\"{id}\">{packed}</script>\n");
        all.into_iter().map(text).collect()
    };
    let (style, start) = (format!("<style>{STYLE}</style>\n"), format!("<script>\n{LOADER}</script>\n"));
    put_together(report, live.map(|live| &live.order), &style, &start, texts)
}

/// The page of a run that another page shows in a frame: that page's folder has style and script, `report.css`,
/// `beside.js` and `report.js`. Where there is an `order`, which made the run, that page itself runs the model again,
/// and the machine moves at once.
#[must_use]
pub fn page_beside(report: &Report<'_>, order: Option<&Order>) -> String {
    let text = |(id, json): &(&str, String)| {
        let json = json.replace('<', "\\u003c");
        format!("<script type=\"application/json\" id=\"{id}\">{json}</script>\n")
    };
    let style = "<link rel=\"stylesheet\" href=\"report.css\">\n";
    let plays = if order.is_some() { " data-plays" } else { "" };
    let start = format!("<script src=\"beside.js\"{plays}></script>\n<script src=\"report.js\"></script>\n");
    put_together(report, order, style, &start, |texts| texts.iter().map(text).collect())
}

/// The page with this style, these scripts that start it, and the JSON texts that it reads, as `texts` writes them;
/// `order` is what made the run, where the page can run its model again.
fn put_together(
    report: &Report<'_>,
    order: Option<&Order>,
    style: &str,
    start: &str,
    texts: impl FnOnce(&[(&'static str, String)]) -> String,
) -> String {
    let Views { picture, modes, .. } = report.views;
    let (animation, modes) = (moving(report.views), modes.as_ref());
    let (modes, no_modes) = (modes.and_then(|of| of.as_ref().ok()), modes.and_then(|of| of.as_ref().err()));
    let at_rest = modes.zip(animation).and_then(|(modes, _)| Some((modes, modes.rest.as_ref()?)));
    let swings = at_rest.map(|(modes, rest)| Modes::new(&modes.modes, rest));
    let can_swing = swings.is_some();
    let data = Data::new(report.description, report.run, report.rows, animation, swings).with(report.others);
    let has_pairs = data.charts.iter().map(|chart| chart.curves.len()).sum::<usize>() > 1;
    let balance = Balance::of(report.description, report.run);
    let drawings = drawings(report);
    let heading = if report.figures.is_empty() { "Drawings" } else { &report.texts.gallery };
    let has_checks = !report.summary.checks.is_empty();
    let sections = [
        (animation.is_some(), "machine", "Machine"),
        (order.is_some(), "controls", "Try other values"),
        (true, "charts", "Outputs"),
        (has_pairs, "against", "Output against output"),
        (picture.is_some(), "picture", "Bond graph"),
        (balance.is_some(), "balance", "Energy balance"),
        (modes.is_some() || no_modes.is_some(), "modes", "Modes"),
        (has_checks, "statements", "Statements"),
        (!drawings.is_empty(), "figures", heading),
        (true, "parameters", "Parameters"),
        (true, "statistics", "Statistics"),
        (true, "equations", "Equations"),
    ];
    let links: Vec<(&str, &str)> =
        sections.into_iter().filter(|(is_there, ..)| *is_there).map(|(_, anchor, name)| (anchor, name)).collect();

    let mut page = String::from("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n");
    page += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<link rel=\"icon\" \
        href=\"data:,\">\n";
    write_into(&mut page, format_args!("<title>{}</title>\n", escaped(&report.texts.title)));
    write_into(&mut page, format_args!("{style}</head>\n<body>\n"));
    html::head(&mut page, report, &links);
    page += "<main>\n";
    html::stage(&mut page, animation.is_some(), order.is_some(), &data.note(report.run.times.len(), report.rows.len()));
    if has_pairs {
        html::against(&mut page);
    }
    if let Some(picture) = picture {
        html::picture(&mut page, &picture.svg);
    }
    if let Some(balance) = &balance {
        html::balance(&mut page, balance);
    }
    if let Some(linearised) = modes {
        html::modes(&mut page, linearised, can_swing);
    }
    if let Some(why) = no_modes {
        html::no_modes(&mut page, why);
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
    if let Some(order) = order {
        let settings = settings::json(order, report);
        write_into(&mut page, format_args!("<script type=\"application/json\" id=\"live\">{settings}</script>\n"));
    }
    let svgs: Vec<String> = drawings.iter().map(|drawing| compact(drawing.svg)).collect();
    let svgs = serde_json::to_string(&svgs).expect("texts are JSON");
    let bonds = picture.as_ref().and_then(|picture| Bonds::new(report.description.bonds, picture));
    let bonds = bonds.map_or_else(|| "null".to_owned(), |bonds| bonds.json());
    page += &texts(&[("bonds", bonds), ("drawings", svgs)]);
    write_into(&mut page, format_args!("{start}</body>\n</html>\n"));
    page
}

/// The machine in motion, where there is one.
fn moving(views: &Views) -> Option<&Animation> {
    views.animation.as_ref().filter(|animation| !animation.bodies.is_empty() && !animation.times.is_empty())
}

/// The program's figures, then the other drawings.
fn drawings<'a>(report: &Report<'a>) -> Vec<Drawing<'a>> {
    let own = report.figures.iter();
    let own = own.map(|(figure, svg)| Drawing { title: &figure.title, caption: &figure.caption, svg });
    let more = report.drawings.iter().map(|(title, svg)| Drawing { title, caption: title, svg });
    own.chain(more).collect()
}
