//! The colours of the picture.
//!
//! In: nothing. Out: a style sheet. Each colour is a variable of the page, such as `--bond-graph-ink`, with a value
//! for light and one for dark surroundings where the page sets none. Readers that know no variables take the line
//! before.

/// Name, light, dark.
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

/// What has which colour: selector, property, colour.
const RULES: [(&str, &str, &str); 21] = [
    (".paper", "fill", "paper"),
    ("text", "fill", "ink"),
    (".name,.word", "fill", "faint"),
    (".frame", "fill", "frame"),
    (".frame", "stroke", "line"),
    (".box", "fill", "node"),
    (".storage .box", "fill", "storage"),
    (".resistor .box", "fill", "resistor"),
    (".part .box", "fill", "frame"),
    (".part .box", "stroke", "line"),
    (".multiplier .box", "fill", "multiplier"),
    (".derivative .box", "fill", "derivative"),
    (".part .kind", "fill", "faint"),
    (".part .name", "fill", "ink"),
    (".multiplier .name", "fill", "ink"),
    (".derivative .name", "fill", "ink"),
    (".line", "stroke", "bond"),
    (".arrow", "stroke", "bond"),
    (".stroke", "stroke", "bond"),
    (".bond:hover .line,.bond:hover .arrow,.bond:hover .stroke", "stroke", "hover"),
    (".node:hover .box,.part:hover .box", "stroke", "hover"),
];

/// What has no colour.
const SHAPES: &str = "\
.bond-graph{max-width:100%;height:auto}\
.bond-graph text{text-anchor:middle;\
font-family:system-ui,-apple-system,\"Segoe UI\",Roboto,\"Helvetica Neue\",Arial,\"DejaVu Sans\",sans-serif}\
.bond-graph .kind{font-size:13px;font-weight:bold}\
.bond-graph .name,.bond-graph .key{font-size:10px}\
.bond-graph .part .name{font-size:13px;font-weight:bold}\
.bond-graph .part .kind{font-size:10px;font-weight:normal}\
.bond-graph .title{font-size:12px;font-weight:bold;text-anchor:start}\
.bond-graph .word{font-weight:normal}\
.bond-graph .key{text-anchor:start}\
.bond-graph .line,.bond-graph .arrow,.bond-graph .stroke,.bond-graph .hit{fill:none}\
.bond-graph .line{stroke-width:1.3;stroke-linejoin:round}\
.bond-graph .arrow{stroke-width:1.3;stroke-linecap:round}\
.bond-graph .stroke{stroke-width:2}\
.bond-graph .multi .line{stroke-width:3.2}\
.bond-graph .multi .arrow{stroke-width:2.2}\
.bond-graph .multi .stroke{stroke-width:2.6}\
.bond-graph .hit{stroke:#000;stroke-opacity:0;stroke-width:9;pointer-events:stroke}\
";

/// The style sheet.
pub(crate) fn style() -> String {
    let mut text = String::from(SHAPES);
    for (selectors, property, colour) in RULES {
        let selector = selectors.split(',').map(|one| format!(".bond-graph {one}")).collect::<Vec<_>>().join(",");
        let light = COLOURS.iter().find(|(name, ..)| *name == colour).map_or("", |(_, light, _)| light);
        text += &format!("{selector}{{{property}:{light};{property}:var(--{colour})}}");
    }
    let variables = |of: fn(&(&'static str, &'static str, &'static str)) -> &'static str| -> String {
        COLOURS.iter().map(|colour| format!("--{0}:var(--bond-graph-{0},{1});", colour.0, of(colour))).collect()
    };
    let (light, dark) = (variables(|colour| colour.1), variables(|colour| colour.2));
    text + &format!(".bond-graph{{{light}}}@media (prefers-color-scheme:dark){{.bond-graph{{{dark}}}}}")
}
