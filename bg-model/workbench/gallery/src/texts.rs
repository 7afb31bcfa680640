//! The gallery as Markdown for the repository, and as HTML for a folder of pages.
//!
//! In: examples, and which pictures each has. Out: text. Files of pictures are named after the example.

use bg_workbench::markup::{escaped, with_code};

use bg_gallery::example::Example;

/// Files of an example's pictures, without the folder.
pub fn graph(example: &Example) -> String {
    format!("{}_graph.svg", example.name)
}

/// The machine.
pub fn machine(example: &Example) -> String {
    format!("{}_machine.png", example.name)
}

/// An output over time.
pub fn chart(example: &Example) -> String {
    format!("{}_chart.svg", example.name)
}

/// `docs/gallery.md`, whose pictures are in the folder `gallery` beside it. `has` says whether there is a picture.
pub fn markdown(examples: &[Example], has: impl Fn(&str) -> bool) -> String {
    let mut page = String::from(
        "# Gallery\n\nThe examples of `bg-model/workbench/examples`, each a complete program: the bond graph, the \
         machine, one of its outputs.\nMade by `cargo run --release -p bg-gallery` from their head comments; \
         the machines need Chromium. A folder of pages in which they\nmove: `cargo run --release -p bg-gallery -- \
         --out site`.\n",
    );
    for example in examples {
        let Example { name, title, text, output, .. } = example;
        page += &format!("\n## {title}\n\n{text}\n\n");
        page += &format!("```\n{}\n```\n\n", example.command());
        page += &format!("[Source](../bg-model/workbench/examples/{name}.rs)\n\n");
        let image = |file: String, what: &str| format!("<img src=\"gallery/{file}\" alt=\"{what}\" width=\"400\">\n");
        if has(&machine(example)) {
            page += &image(machine(example), "the machine");
        }
        page += &image(graph(example), "the bond graph");
        page += &image(chart(example), &format!("{output} over time"));
    }
    page
}

const STYLE: &str = "\
:root { color-scheme: light dark; }\n\
body { font: 16px/1.5 system-ui, sans-serif; max-width: 76rem; margin: 2rem auto; padding: 0 1rem; \
background: light-dark(#f6f7f9, #0d1017); color: light-dark(#1f2328, #e6e8eb); }\n\
main { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 20rem), 1fr)); gap: 1rem; }\n\
a { color: inherit; text-decoration: none; border: 1px solid light-dark(#d9dde3, #30363d); border-radius: 10px; \
padding: 1rem; background: light-dark(#fff, #161b22); display: flex; flex-direction: column; }\n\
a:hover, a:focus-visible { border-color: light-dark(#0072b2, #56b4e9); }\n\
img { width: 100%; height: 11rem; object-fit: contain; }\n\
h2 { font-size: 1.05rem; margin: .6rem 0 .3rem; }\n\
p { margin: 0; font-size: .92rem; color: light-dark(#57606a, #9aa4af); }\n\
code { font-size: .95em; }\n";

/// `index.html` of a folder with a page NAME.html for each example; `has` says whether there is a picture.
pub fn index(examples: &[Example], has: impl Fn(&str) -> bool) -> String {
    let mut page = format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" \
         content=\"width=device-width, initial-scale=1\">\n<link rel=\"icon\" \
         href=\"data:,\">\n<title>Gallery</title>\n\
         <style>\n{STYLE}</style>\n</head>\n<body>\n<h1>Gallery</h1>\n<p>Machines as bond graphs. Each page runs its \
         model in the browser.</p>\n<br>\n<main>\n"
    );
    for example in examples {
        let machine = machine(example);
        let picture = if has(&machine) { machine } else { chart(example) };
        let text = with_code(&example.text);
        page += &format!(
            "<a href=\"{}.html\"><img src=\"{picture}\" alt=\"\" loading=\"lazy\"><h2>{}</h2><p>{text}</p></a>\n",
            example.name,
            escaped(&example.title)
        );
    }
    page + "</main>\n</body>\n</html>\n"
}
