//! The sections of the page as HTML.
//!
//! In: texts and tables. Out: HTML in which every text is escaped; what moves is added by the page's script.

use super::charts::Balance;
use super::report::Report;
use super::{Linearised, Parameter};
use crate::ask::parameters::{number, one_line};
use crate::run::summary::Summary;
use crate::show::markup::{escaped, with_code, write_into};
use bg_analysis::samples::rounded;

/// What stands of the summary at the head of the page.
const FACTS: [&str; 6] = ["scene", "simulated time", "integrator", "states", "steps", "wall time"];

/// Title, documentation, settings, links to the sections.
pub fn head(page: &mut String, report: &Report<'_>, sections: &[(&str, &str)]) {
    let title = escaped(&report.texts.title);
    let introduction = &report.texts.introduction;
    write_into(page, format_args!("<header>\n<h1>{title}</h1>\n<p>{}</p>\n", with_code(introduction)));
    if !introduction.starts_with(report.scene) {
        write_into(page, format_args!("<p>{}</p>\n", with_code(report.scene)));
    }
    if let Some(failure) = &report.summary.failure {
        let reached = report.summary.reached_s;
        let line = format!("The run failed: {failure}. What follows shows it up to t = {reached} s.");
        write_into(page, format_args!("<p class=\"failure\">{}</p>\n", escaped(&line)));
    }
    *page += "<ul class=\"facts\">\n";
    for (name, text) in report.summary.lines().into_iter().filter(|(name, _)| FACTS.contains(name)) {
        write_into(page, format_args!("<li><b>{}</b>{}</li>\n", escaped(name), escaped(&text)));
    }
    *page += "</ul>\n<nav>";
    for (anchor, name) in sections {
        write_into(page, format_args!("<a href=\"#{anchor}\">{name}</a>\n"));
    }
    *page += "</nav>\n</header>\n";
}

/// The machine, what sets its parameters where the page can run it, and the charts: the script fills them.
pub fn stage(page: &mut String, is_moving: bool, is_live: bool, note: &str) {
    *page += "<div class=\"stage\">\n<div class=\"aside\">\n";
    if is_moving {
        *page += "<section id=\"machine\"></section>\n";
    }
    if is_live {
        *page += "<section id=\"controls\"></section>\n";
    }
    *page += "</div>\n";
    write_into(
        page,
        format_args!(
            "<section id=\"charts\"><h2>Outputs <small>over t in s</small></h2><div class=\"charts\" \
             id=\"chart-list\"></div><p class=\"note\" id=\"samples\">{}</p></section>\n</div>\n",
            escaped(note)
        ),
    );
}

/// One output against another, which the script draws.
pub fn against(page: &mut String) {
    *page += "<section id=\"against\"><h2>Output against output</h2></section>\n";
}

/// The energy balance, whose chart the script draws.
pub fn balance(page: &mut String, balance: &Balance) {
    let sentence = escaped(&balance.sentence());
    let section = "<section id=\"balance\"><h2>Energy balance <small>from the start</small></h2><p>";
    write_into(
        page,
        format_args!("{section}{sentence}</p><div class=\"charts\" id=\"balance-charts\"></div></section>\n"),
    );
}

/// The bond-graph picture; `svg` is trusted.
pub fn picture(page: &mut String, svg: &str) {
    let section = "<section id=\"picture\"><h2>Bond graph</h2><div class=\"picture\">";
    write_into(page, format_args!("{section}{svg}</div></section>\n"));
}

/// Why there are no modes.
pub fn no_modes(page: &mut String, why: &str) {
    let sentence = escaped(why);
    write_into(
        page,
        format_args!("<section id=\"modes\"><h2>Modes</h2><p>There are none: {sentence}.</p></section>\n"),
    );
}

/// The modes, each with the button that lets the machine swing in it where there is a machine.
pub fn modes(page: &mut String, Linearised { modes, place, .. }: &Linearised, can_swing: bool) {
    let place = escaped(place);
    write_into(page, format_args!("<section id=\"modes\" class=\"modes\"><h2>Modes <small>{place}</small></h2>\n"));
    *page += "<div class=\"scroll\"><table>\n";
    *page +=
        "<tr><th></th><th>frequency in Hz</th><th>damping</th><th>eigenvalue in 1/s</th><th>what moves</th></tr>\n";
    for (index, mode) in modes.iter().enumerate() {
        let button = if can_swing {
            format!("<button type=\"button\" data-mode=\"{index}\">swing</button>")
        } else {
            String::new()
        };
        let damping = mode.damping.map_or_else(|| "\u{2013}".to_owned(), short);
        let (frequency, real, imaginary) = (short(mode.frequency), short(mode.real), short(mode.imaginary));
        let value = if mode.imaginary == 0.0 { real } else { format!("{real} \u{B1} {imaginary} i") };
        let words = escaped(&mode.words);
        write_into(
            page,
            format_args!(
                "<tr><td>{button}</td><td class=\"number\">{frequency}</td><td class=\"number\">{damping}</td>\
                 <td class=\"number\">{value}</td><td>{words}</td></tr>\n"
            ),
        );
    }
    *page += "</table></div></section>\n";
}

/// Five digits.
fn short(value: f64) -> String {
    number(rounded(value, 5)).replace('-', "\u{2212}")
}

/// The statements with what was measured, as a table below its heading.
fn checks(page: &mut String, summary: &Summary) {
    write_into(page, format_args!("<h2>{}</h2>\n<table>\n", escaped(summary.heading())));
    *page += "<tr><th>Figure</th><th>Statement</th><th>Measured</th><th></th></tr>\n";
    for check in &summary.checks {
        let (class, verdict) =
            if check.holds { ("holds", "\u{2713} holds") } else { ("fails", "\u{2717} does not hold") };
        write_into(
            page,
            format_args!(
                "<tr><td>{}</td><td>{}</td><td>{}</td><td class=\"{class}\">{verdict}</td></tr>\n",
                escaped(check.figure),
                escaped(check.statement),
                escaped(&check.measured)
            ),
        );
    }
    *page += "</table>\n";
}

/// The program's own statements about the run.
pub fn statements(page: &mut String, summary: &Summary) {
    *page += "<section id=\"statements\"><div class=\"scroll\">";
    checks(page, summary);
    *page += "</div></section>\n";
}

/// A drawing of the page: title, caption, SVG.
pub struct Drawing<'a> {
    /// What it shows.
    pub title: &'a str,
    /// What is said below it; may be empty.
    pub caption: &'a str,
    /// The SVG text.
    pub svg: &'a str,
}

/// Drawings, each an image of its own, so that their styles do not meet. The script hands them their SVG texts.
pub fn drawings(page: &mut String, heading: &str, about: &str, drawings: &[Drawing<'_>]) {
    write_into(page, format_args!("<section id=\"figures\"><h2>{}</h2>\n", escaped(heading)));
    if !about.is_empty() {
        write_into(page, format_args!("<p>{}</p>\n", escaped(about)));
    }
    *page += "<div class=\"figures\">\n";
    for (index, Drawing { title, caption, .. }) in drawings.iter().enumerate() {
        let caption = match *caption {
            "" => String::new(),
            caption => format!("<figcaption>{}</figcaption>", escaped(caption)),
        };
        let title = escaped(title);
        write_into(page, format_args!("<figure><img data-drawing=\"{index}\" alt=\"{title}\">{caption}</figure>\n"));
    }
    *page += "</div></section>\n";
}

/// The numbers of the run, all of them.
pub fn statistics(page: &mut String, summary: &Summary) {
    *page += "<section id=\"statistics\"><h2>Statistics</h2><dl>\n";
    for (name, text) in summary.lines() {
        write_into(page, format_args!("<dt>{}</dt><dd>{}</dd>\n", escaped(name), escaped(&text)));
    }
    *page += "</dl></section>\n";
}

/// The parameters; those that differ from their defaults are marked.
pub fn parameters(page: &mut String, report: &Report<'_>) {
    let has_sources = report.parameters.iter().any(|parameter| !parameter.source.is_empty());
    let sources = if has_sources { "<th>from</th>" } else { "" };
    *page += "<section id=\"parameters\"><h2>Parameters</h2><div class=\"scroll\"><table>\n";
    write_into(page, format_args!("<tr><th>name</th><th>value</th><th>unit</th>{sources}<th>meaning</th></tr>\n"));
    for parameter in report.parameters {
        let Parameter { info, value, source } = parameter;
        let (class, default) = match parameter.is_changed() {
            true => (" class=\"changed\"", format!(" (default {})", number(info.default))),
            false => ("", String::new()),
        };
        let source = if has_sources { format!("<td>{}</td>", escaped(source)) } else { String::new() };
        let meaning = with_code(&(one_line(info.doc) + &default));
        let (name, value, unit) = (escaped(info.name), number(*value), escaped(&super::charts::unit(info.unit)));
        write_into(
            page,
            format_args!(
                "<tr{class}><td><code>{name}</code></td><td class=\"number\">{value}</td><td>{unit}</td>{source}\
                 <td>{meaning}</td></tr>\n"
            ),
        );
    }
    *page += "</table></div></section>\n";
}

/// The equations, folded.
pub fn equations(page: &mut String, equations: &[&str]) {
    let count = equations.len();
    let section = "<section id=\"equations\"><details><summary><h2>Equations</h2>";
    write_into(
        page,
        format_args!("{section} <span class=\"note\">{count}, in the order of evaluation</span></summary>\n"),
    );
    write_into(
        page,
        format_args!("<pre class=\"equations\">{}</pre></details></section>\n", escaped(&equations.join("\n"))),
    );
}

/// What the page is made with, and the bar that the script fills.
pub fn foot(page: &mut String, licences: &str) {
    *page +=
        "<footer><details><summary>Made by bg-workbench, with three.js where there is a machine, and uPlot</summary>";
    write_into(page, format_args!("<pre>{}</pre></details></footer>\n<div id=\"player\"></div>\n", escaped(licences)));
}
