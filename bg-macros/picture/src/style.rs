//! The colours and letters of the picture.
//!
//! In: nothing. Out: attributes of what is drawn, and a style sheet. The attributes alone are the whole picture on
//! light paper, for readers that know no style sheets. The sheet makes each colour a variable of the page around, such
//! as `--bond-graph-ink`, with a value for light and one for dark surroundings where the page sets none. All of it is
//! in `@supports` and `@media`, which a reader that knows no variables skips: a rule with one would be black to it.

/// Name, light, dark. The light ones are all different: by them the style sheet finds what has which colour.
const COLOURS: [(&str, &str, &str); 12] = [
    ("paper", "#ffffff", "#0f1419"),
    ("ink", "#1c2733", "#e3e9ef"),
    ("faint", "#5b6875", "#9aa7b4"),
    ("bond", "#2f3d4a", "#b9c4cf"),
    ("frame", "#f4f6f8", "#171e26"),
    ("line", "#c3ccd5", "#36424e"),
    ("node", "#e6ebf0", "#26313c"),
    ("storage", "#d6e7fa", "#163a5f"),
    ("resistor", "#f1e9d2", "#473c18"),
    ("multiplier", "#f9c98a", "#8a4b00"),
    ("derivative", "#f5b5b5", "#8c2626"),
    ("hover", "#c8401a", "#ff9a5a"),
];

/// The colours of lines; all others but that of what the pointer is on fill.
const LINES: [&str; 2] = ["bond", "line"];

/// What is no picture without variables: its size in a page, letters of the system, what the pointer is on.
const IN_PAGES: &str = "\
.bond-graph{max-width:100%;height:auto;fill:var(--faint)}\
.bond-graph .arrow{stroke-linecap:round}.bond-graph .hit{stroke-width:9px;pointer-events:stroke}\
.bond-graph text{font-family:system-ui,-apple-system,\"Segoe UI\",Roboto,\"Helvetica Neue\",Arial,\"DejaVu \
Sans\",sans-serif}";

const HOVER: &str = "\
.bond-graph .bond:hover .line,.bond-graph .bond:hover .arrow,.bond-graph .bond:hover .stroke,\
.bond-graph .node:hover .box,.bond-graph .part:hover .box{stroke:var(--hover)}";

/// What the parts of the picture have unless they say otherwise: letters as of a name.
pub(crate) fn root() -> String {
    format!(
        "font-family=\"sans-serif\" text-anchor=\"middle\" font-size=\"10\" {} stroke-linejoin=\"round\"",
        fill("faint")
    )
}

/// The attributes of a text that is no name as at the [`root`]: a colour, a size in pixels, whether it is bold. Each
/// after a blank.
pub(crate) fn letters(colour: &str, size: Option<i32>, is_bold: bool) -> String {
    let colour = if colour.is_empty() { String::new() } else { format!(" {}", fill(colour)) };
    let size = size.map_or_else(String::new, |size| format!(" font-size=\"{size}\""));
    format!("{colour}{size}{}", if is_bold { " font-weight=\"bold\"" } else { "" })
}

/// The attribute that fills something with a colour.
pub(crate) fn fill(colour: &str) -> String {
    format!("fill=\"{}\"", light(colour))
}

/// The attribute that draws a line in a colour.
pub(crate) fn stroke(colour: &str) -> String {
    format!("stroke=\"{}\"", light(colour))
}

fn light(colour: &str) -> &'static str {
    COLOURS.iter().find(|(name, ..)| *name == colour).map_or("none", |(_, light, _)| light)
}

/// The style sheet.
pub(crate) fn style() -> String {
    let variables = |of: fn(&(&'static str, &'static str, &'static str)) -> &'static str| -> String {
        COLOURS.iter().map(|colour| format!("--{0}:var(--bond-graph-{0},{1});", colour.0, of(colour))).collect()
    };
    let (light, dark) = (variables(|colour| colour.1), variables(|colour| colour.2));
    let painted = |property: &str, is_of: fn(&str) -> bool| -> String {
        let rule = |(name, light, _): &(&str, &str, &str)| {
            format!(".bond-graph [{property}=\"{light}\"]{{{property}:var(--{name})}}")
        };
        COLOURS.iter().filter(|(name, ..)| is_of(name)).map(rule).collect()
    };
    let of_fills = painted("fill", |name| name != "hover" && !LINES.contains(&name));
    let of_strokes = painted("stroke", |name| LINES.contains(&name));
    format!(
        "@supports (fill:var(--ink)){{{IN_PAGES}.bond-graph{{{light}}}{of_fills}{of_strokes}{HOVER}}}\
         @media (prefers-color-scheme:dark){{.bond-graph{{{dark}}}}}"
    )
}
