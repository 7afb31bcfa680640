//! The overview page: one HTML file with all figures, the summary and the checks.
//!
//! In: the summary and the figures that were drawn. Out: HTML text. It links the figures' files beside it, so every
//! image follows the reader's light or dark colour scheme, and needs nothing from elsewhere.

use std::path::Path;

use crate::extras::Page;
use crate::figures::Figure;
use crate::markup::{escaped, write_into};
use crate::summary::Summary;

/// The page's colours and layout; light and dark as the reader prefers.
const STYLE: &str = "
:root { color-scheme: light dark; --paper: #ffffff; --sheet: #f6f8fa; --ink: #1f2328; --pencil: #59636e; --line: #d1d9e0;
  --holds: #1a7f37; --fails: #b35900; }
@media (prefers-color-scheme: dark) { :root { --paper: #0d1117; --sheet: #161b22; --ink: #e6edf3; --pencil: #9198a1;
  --line: #3d444d; --holds: #3fb950; --fails: #f0883e; } }
* { box-sizing: border-box; }
body { margin: 0 auto; padding: 2rem 1.5rem 4rem; max-width: 1500px; background: var(--paper); color: var(--ink);
  font: 16px/1.5 system-ui, sans-serif; }
h1 { font-size: 1.8rem; margin: 0 0 .3rem; } h2 { font-size: 1.25rem; margin: 2.5rem 0 .8rem; }
p { max-width: 75ch; margin: .3rem 0; color: var(--pencil); }
p.failure { color: var(--fails); font-weight: 600; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .25rem 1.5rem; margin: 0; }
dt { color: var(--pencil); } dd { margin: 0; font-variant-numeric: tabular-nums; overflow-wrap: anywhere; }
table { border-collapse: collapse; width: 100%; } th { text-align: left; color: var(--pencil); font-weight: 500; }
th, td { padding: .4rem .8rem .4rem 0; border-bottom: 1px solid var(--line); vertical-align: top; }
td:first-child, td:last-child { white-space: nowrap; }
.holds { color: var(--holds); } .fails { color: var(--fails); }
.figures { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 620px), 1fr)); gap: 1.2rem; }
figure { margin: 0; border: 1px solid var(--line); border-radius: 8px; overflow: hidden; background: var(--sheet); }
figure img { display: block; width: 100%; height: auto; }
figcaption { padding: .3rem 1.2rem .6rem; color: var(--pencil); font-size: .85rem; }
a { color: inherit; }
";

/// The page. `figures` are those that were drawn; `data` is where the CSV file is, as seen from the page.
#[must_use]
pub fn page(texts: &Page, summary: &Summary, figures: &[Figure], data: Option<&Path>) -> String {
    let mut page = String::from("<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n");
    page += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
    let (title, introduction) = (escaped(&texts.title), escaped(&texts.introduction));
    write_into(&mut page, format_args!("<title>{title}</title>\n"));
    write_into(&mut page, format_args!("<style>{STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>\n"));
    write_into(&mut page, format_args!("<p>{introduction}</p>\n"));
    if let Some(failure) = &summary.failure {
        let reached = summary.reached_s;
        let line = format!("The run failed: {failure}. What follows shows it up to t = {reached} s.");
        write_into(&mut page, format_args!("<p class=\"failure\">{}</p>\n", escaped(&line)));
    }
    page += "<h2>Summary</h2>\n<dl>\n";
    for (name, text) in summary.lines() {
        write_into(&mut page, format_args!("<dt>{name}</dt><dd>{}</dd>\n", escaped(&text)));
    }
    if let Some(data) = data {
        let (link, name) = (address(data), escaped(&data.display().to_string()));
        write_into(&mut page, format_args!("<dt>trajectory</dt><dd><a href=\"{link}\">{name}</a></dd>\n"));
    }
    page += "</dl>\n";
    if !summary.checks.is_empty() {
        checks(&mut page, summary);
    }
    gallery(&mut page, texts, figures);
    page += "</body>\n</html>\n";
    page
}

/// The statements with what was measured, as a table below its heading.
pub(crate) fn checks(page: &mut String, summary: &Summary) {
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

fn gallery(page: &mut String, texts: &Page, figures: &[Figure]) {
    let (heading, text) = (escaped(&texts.gallery), escaped(&texts.about_gallery));
    write_into(page, format_args!("<h2>{heading}</h2>\n"));
    if !text.is_empty() {
        write_into(page, format_args!("<p>{text}</p>\n"));
    }
    *page += "<div class=\"figures\">\n";
    for Figure { file, anchor, title, caption, .. } in figures {
        let title = escaped(title);
        let caption =
            if caption.is_empty() { String::new() } else { format!("<figcaption>{}</figcaption>", escaped(caption)) };
        write_into(
            page,
            format_args!(
                "<figure id=\"{anchor}\"><a href=\"{file}\"><img src=\"{file}\" alt=\"{title}\" width=\"960\" \
                 height=\"540\"></a>{caption}</figure>\n"
            ),
        );
    }
    *page += "</div>\n";
}

/// A relative path as the address of a link: every byte that is not plain as `%XX`, whatever the file's name is made
/// of.
fn address(path: &Path) -> String {
    let plain = |byte: u8| byte.is_ascii_alphanumeric() || b"-._~/".contains(&byte);
    let bytes = path.as_os_str().as_encoded_bytes().iter();
    bytes.map(|&byte| if plain(byte) { char::from(byte).to_string() } else { format!("%{byte:02X}") }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_link_leads_to_the_file_whatever_its_name() {
        assert_eq!(address(Path::new("runs/a b#1?.csv")), "runs/a%20b%231%3F.csv");
        #[cfg(unix)]
        {
            let name: &std::ffi::OsStr = std::os::unix::ffi::OsStrExt::from_bytes(b"o\xff.csv");
            assert_eq!(address(Path::new(name)), "o%FF.csv");
        }
    }
}
