//! The page of a study: texts, tables and figures in one file that needs nothing else and no script.
//!
//! In: what stands on it, in its order. Out: HTML, light or dark as the reader prefers, in print all of it.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;

use super::figures::compact::compact;
use super::markup::{escaped, with_code, write_into};

/// What stands on a page.
#[derive(Clone, Debug, PartialEq)]
pub enum Item {
    /// A heading.
    Heading(String),
    /// A sentence; what stands between backticks is code.
    Text(String),
    /// A table: its head, its rows.
    Table(Vec<String>, Vec<Vec<String>>),
    /// A figure: what it shows, its SVG.
    Figure(String, String),
}

/// The most rows of a table on a page; the files have all.
pub const MOST_ROWS: usize = 500;

/// The page of this title.
#[must_use]
pub fn sheet(title: &str, items: &[Item]) -> String {
    const STYLE: &str = include_str!("sheet.css");
    let title = escaped(title);
    let mut page = format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{title}</title>\n\
         <style>\n{STYLE}</style>\n</head>\n<body>\n<h1>{title}</h1>\n"
    );
    items.iter().for_each(|item| add(&mut page, item));
    page + "</body>\n</html>\n"
}

fn add(page: &mut String, item: &Item) {
    match item {
        Item::Heading(text) => write_into(page, format_args!("<h2>{}</h2>\n", escaped(text))),
        Item::Text(text) => write_into(page, format_args!("<p>{}</p>\n", with_code(text))),
        Item::Table(head, rows) => table(page, head, rows),
        Item::Figure(caption, svg) => {
            // An image of its own each, so that their styles do not meet.
            let data = STANDARD.encode(compact(svg));
            let caption = escaped(caption);
            write_into(
                page,
                format_args!(
                    "<figure><img src=\"data:image/svg+xml;base64,{data}\" alt=\"{caption}\">\
                     <figcaption>{caption}</figcaption></figure>\n"
                ),
            );
        }
    }
}

fn table(page: &mut String, head: &[String], rows: &[Vec<String>]) {
    let is_number = |cell: &String| cell.parse::<f64>().is_ok();
    *page += "<div class=\"scroll\"><table>\n<tr>";
    head.iter().for_each(|cell| write_into(page, format_args!("<th>{}</th>", escaped(cell))));
    *page += "</tr>\n";
    for row in rows.iter().take(MOST_ROWS) {
        *page += "<tr>";
        for cell in row {
            let class = if is_number(cell) { " class=\"number\"" } else { "" };
            write_into(page, format_args!("<td{class}>{}</td>", escaped(cell)));
        }
        *page += "</tr>\n";
    }
    *page += "</table></div>\n";
    if rows.len() > MOST_ROWS {
        let more = rows.len() - MOST_ROWS;
        write_into(page, format_args!("<p class=\"note\">{more} more rows are in the files.</p>\n"));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_text_is_escaped_and_every_figure_is_inside() {
        let cells = |cells: [&str; 2]| cells.map(str::to_owned).to_vec();
        let rows = vec![cells(["a & b", "1.5"]); MOST_ROWS + 3];
        let items = [
            Item::Heading("x < y".to_owned()),
            Item::Table(cells(["name", "value"]), rows),
            Item::Figure("how".to_owned(), "<svg/>".to_owned()),
        ];
        let page = sheet("max |f| < 3", &items);
        assert!(page.contains("<title>max |f| &lt; 3</title>") && page.contains("x &lt; y"), "{page}");
        assert!(page.contains("a &amp; b") && page.contains("3 more rows") && page.contains("PHN2Zy8+"), "{page}");
    }
}
