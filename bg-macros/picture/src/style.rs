//! The colours and letters of the picture.
//!
//! In: nothing. Out: attributes of what is drawn, and a style sheet. The attributes alone are the whole picture on light
//! paper, for readers that know no style sheets. The sheet makes each colour a variable of the page around, such as
//! `--bond-graph-ink`, with a value for light and one for dark surroundings where the page sets none. All of it is in
//! `@supports` and `@media`, which a reader that knows no variables skips: a rule with one would be black to it.

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

/// The letters of the whole picture, for its root.
pub(crate) const LETTERS: &str = "font-family=\"sans-serif\" text-anchor=\"middle\"";

/// What is no picture without variables: its size in a page, letters of the system, what the pointer is on.
const IN_PAGES: &str = "\
.bond-graph{max-width:100%;height:auto}\
.bond-graph text{font-family:system-ui,-apple-system,\"Segoe UI\",Roboto,\"Helvetica Neue\",Arial,\"DejaVu Sans\",sans-serif}";

const HOVER: &str = "\
.bond-graph .bond:hover .line,.bond-graph .bond:hover .arrow,.bond-graph .bond:hover .stroke,\
.bond-graph .node:hover .box,.bond-graph .part:hover .box{stroke:var(--hover)}";

/// A text: its colour, its size in pixels, whether it is bold.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Letters {
    pub colour: &'static str,
    pub size: i32,
    pub is_bold: bool,
}

impl Letters {
    /// The attributes.
    pub fn attributes(self) -> String {
        let weight = if self.is_bold { " font-weight=\"bold\"" } else { "" };
        format!("{} font-size=\"{}\"{weight}", fill(self.colour), self.size)
    }
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
    let painted = |property: &str| -> String {
        let rule = |(name, light, _): &(&str, &str, &str)| {
            format!(".bond-graph [{property}=\"{light}\"]{{{property}:var(--{name})}}")
        };
        COLOURS.iter().map(rule).collect()
    };
    format!(
        "@supports (fill:var(--ink)){{{IN_PAGES}.bond-graph{{{light}}}{}{}{HOVER}}}\
         @media (prefers-color-scheme:dark){{.bond-graph{{{dark}}}}}",
        painted("fill"),
        painted("stroke")
    )
}
