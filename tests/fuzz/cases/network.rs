//! Random networks of junctions and elements that mostly make a valid graph.
//!
//! In: randomness. Out: a graph's text. Junctions form a tree, neighbours mostly of the other kind, an I at most
//! 1-junctions and a C at most 0-junctions, so that integral causality is the rule; what breaks it is added now and
//! then.

use fastrand::Rng;

use super::draw::{number, one, rarely};
use super::expression::scalar;

/// A domain with the units of a resistance, an inertia, a storage of displacement, an effort and a flow.
const DOMAINS: [[&str; 6]; 4] = [
    ["translation", "N*s/m", "kg", "N/m", "N", "m/s"],
    ["rotation", "N*m*s/rad", "kg*m^2", "N*m/rad", "N*m", "rad/s"],
    ["electrical", "Ohm", "H", "F", "V", "A"],
    ["hydraulic", "Pa*s/m^3", "kg/m^4", "m^3/Pa", "Pa", "m^3/s"],
];

/// A graph under construction.
struct Sketch<'r> {
    rng: &'r mut Rng,
    /// Statements, whose order is free.
    statements: Vec<String>,
    /// Parameters' names.
    parameters: Vec<String>,
    /// Elements' names.
    elements: Vec<String>,
    /// What expressions and `observe` may name.
    signals: Vec<String>,
    /// Each junction: whether it is a 1-junction, its domain, whether it has three components.
    junctions: Vec<(bool, usize, bool)>,
}

/// The text of a network.
pub(super) fn network(rng: &mut Rng) -> String {
    let mut sketch = Sketch {
        rng,
        statements: Vec::new(),
        parameters: Vec::new(),
        elements: Vec::new(),
        signals: vec!["t".to_owned()],
        junctions: Vec::new(),
    };
    let count = 1 + sketch.rng.usize(..6).min(sketch.rng.usize(..6));
    for index in 0..count {
        sketch.junction(index);
    }
    for index in 0..count {
        sketch.elements_at(index);
    }
    sketch.finish()
}

impl Sketch<'_> {
    fn junction(&mut self, index: usize) {
        let parent = (index > 0).then(|| self.rng.usize(..index));
        let (mut is_one, mut domain, mut wide) = (self.rng.bool(), self.rng.usize(..4), rarely(self.rng, 8));
        if let Some(parent) = parent {
            let above = self.junctions[parent];
            is_one = if rarely(self.rng, 6) { above.0 } else { !above.0 };
            (domain, wide) = (above.1, above.2);
            if rarely(self.rng, 4) {
                (is_one, domain) = (self.rng.bool(), self.rng.usize(..4));
                self.two_port(parent, index);
            } else if self.rng.bool() {
                self.statements.push(format!("j{parent} -> j{index};"));
            } else {
                self.statements.push(format!("j{index} -> j{parent};"));
            }
        }
        self.junctions.push((is_one, domain, wide));
        let (kind, size) = (u8::from(is_one), if wide { "[3]" } else { "" });
        self.statements.push(format!("{kind} j{index}{size}: {};", DOMAINS[domain][0]));
        if !wide {
            self.signals.push(format!("j{index}.{}", if is_one { "flow" } else { "effort" }));
        } else if is_one && rarely(self.rng, 2) {
            let track = one(self.rng, &["position", "orientation"]);
            self.statements.push(format!("{track} track{index} of j{index};"));
        }
    }

    fn two_port(&mut self, from: usize, to: usize) {
        let modulus = scalar(self.rng, &self.parameters, 1);
        let (word, name) = (one(self.rng, &["TF", "GY", "MTF", "MGY"]), format!("port{to}"));
        let modulus = if word.starts_with('M') { scalar(self.rng, &self.signals, 2) } else { modulus };
        self.statements.push(format!("{word} {name} = {modulus}; j{from} -> {name} -> j{to};"));
        self.elements.push(name);
    }

    fn elements_at(&mut self, index: usize) {
        let (is_one, ..) = self.junctions[index];
        let likely = |is: bool| if is { 7 } else { 1 };
        let words = [
            ("I", likely(is_one)),
            ("C", likely(!is_one)),
            ("R", if index == 0 { 10 } else { 5 }),
            ("Se", 3 * u32::from(is_one)),
            ("Sf", u32::from(!is_one)),
        ];
        for (word, weight) in words {
            if self.rng.u32(..10) < weight {
                self.element(word, index);
            }
        }
        if rarely(self.rng, 20) {
            let word = one(self.rng, &["I", "C", "R", "rSe", "Sf", "Se"]);
            self.element(word, index);
        }
    }

    fn element(&mut self, word: &str, at: usize) {
        let (_, domain, wide) = self.junctions[at];
        let name = format!("{}{}", word.to_lowercase(), self.elements.len());
        let [_, resistance, inertia, storage, effort, flow] = DOMAINS[domain];
        let unit = match word {
            "I" => inertia,
            "C" => storage,
            "R" => resistance,
            "Sf" | "rSe" => flow,
            _ => effort,
        };
        let law =
            if self.rng.bool() || wide { self.linear(word, &name, unit, wide) } else { self.nonlinear(word, &name) };
        self.statements.push(law);
        let is_source = matches!(word, "Se" | "Sf" | "rSe");
        self.statements.push(if is_source { format!("{name} -> j{at};") } else { format!("j{at} -> {name};") });
        self.signals.push(format!("{name}.power"));
        if matches!(word, "I" | "C") {
            self.signals.push(format!("{name}.energy"));
        }
        self.elements.push(name);
    }

    /// `R r = parameter;`
    fn linear(&mut self, word: &str, name: &str, unit: &str, wide: bool) -> String {
        let parameter = format!("p_{name}");
        let range = one(self.rng, &["", ", above 0", ", at least -1e9", ", above 0, below 1e12", ", at most 1e300"]);
        let value = number(self.rng);
        self.statements.push(format!("param {parameter}: {unit} = {value}{range};"));
        self.signals.push(parameter.clone());
        self.parameters.push(parameter.clone());
        let is_source = matches!(word, "Se" | "Sf" | "rSe");
        let value = if is_source && wide { format!("[{parameter}, 0, 2 * {parameter}]") } else { parameter };
        let start = if matches!(word, "I" | "C") && rarely(self.rng, 3) && !wide { " start 0.1" } else { "" };
        format!("{word} {name} = {value}{start};")
    }

    /// `C c(q) = expression;`
    fn nonlinear(&mut self, word: &str, name: &str) -> String {
        let mut names = if matches!(word, "Se" | "Sf") { vec!["t".to_owned()] } else { Vec::new() };
        names.extend_from_slice(&self.parameters);
        if matches!(word, "Se" | "Sf" | "rSe") {
            let modulated = matches!(word, "Se" | "Sf") && self.rng.bool();
            let names = if modulated { &self.signals } else { &names };
            let (value, sign) = (scalar(self.rng, names, 3), if modulated { "M" } else { "" });
            return format!("{sign}{word} {name} = {value};");
        }
        if word == "R" {
            names = if self.rng.bool() { self.signals.clone() } else { names };
        }
        names.extend(["v", "v", "v"].map(str::to_owned));
        // Of a storage mostly a law that has an integral.
        let law = match self.rng.u32(..if word == "R" { 4 } else { 12 }) {
            4.. => format!("2 * v + {} * v * v * v + 1 * sin(3 * v)", number(self.rng)),
            0 => format!("2 * v + {} * v * v * v", number(self.rng)),
            1 => format!("{} * tanh(3 * v) + 1 * v", number(self.rng)),
            _ => scalar(self.rng, &names, 3),
        };
        let role = if word == "R" { one(self.rng, &["", "", "effort ", "flow "]) } else { "" };
        let energy = if word != "R" && rarely(self.rng, 12) { " energy 1 * v * v" } else { "" };
        format!("{word} {name}({role}v) = {law}{energy};")
    }

    fn finish(mut self) -> String {
        for index in 0..self.rng.usize(..3) {
            let value = scalar(self.rng, &self.signals, 4);
            self.statements.push(format!("let l{index} = {value};"));
            self.signals.push(format!("l{index}"));
        }
        if rarely(self.rng, 12) {
            self.tower();
        }
        if rarely(self.rng, 4) {
            self.statements.push("input drive: 1;".to_owned());
            self.signals.push("drive".to_owned());
        }
        let observe = self.observe();
        self.statements.push(observe);
        self.rng.shuffle(&mut self.statements);
        for index in 0..self.rng.usize(..3).min(self.rng.usize(..3)) {
            let scene = self.scene(index);
            self.statements.push(scene);
        }
        format!("graph Network {{\n    {}\n}}\n", self.statements.join("\n    "))
    }

    /// A chain of `let`s whose text, expanded, is longer than any memory.
    fn tower(&mut self) {
        const STEPS: [&str; 9] = [
            "A * A",
            "A * A + A",
            "pow(A, 16)",
            "pow(A, -16)",
            "1 / A",
            "sin(A) * A",
            "A * A * t + A * A * 2",
            "sqrt(A)",
            "if A < 1 { A } else { A * 2 }",
        ];
        let height = self.rng.usize(1..40);
        let mixed = self.rng.bool();
        let mut step = one(self.rng, &STEPS);
        let mut below = format!("1 * ({})", scalar(self.rng, &self.signals, 2));
        for index in 0..height {
            if mixed {
                step = one(self.rng, &STEPS);
            }
            self.statements.push(format!("let s{index} = 1 * ({});", step.replace('A', &below)));
            below = format!("s{index}");
        }
        self.signals.push(below);
    }

    fn observe(&mut self) -> String {
        let mut outputs = Vec::new();
        for index in 0..self.rng.usize(..4) {
            let value = scalar(self.rng, &self.signals, 3);
            let value = if rarely(self.rng, 3) { format!("integral({value})") } else { value };
            outputs.push(format!("o{index} = {value}"));
        }
        if self.rng.bool() {
            outputs.push("stored_energy; lost: J = integral(dissipated_power)".to_owned());
        }
        format!("observe {{ {} }}", outputs.join("; "))
    }

    fn scene(&mut self, index: usize) -> String {
        let mut clauses = Vec::new();
        if self.rng.bool() {
            clauses.push(self.observe());
        }
        if self.rng.bool() {
            let kept: Vec<String> = self.parameters.iter().filter(|_| self.rng.bool()).cloned().collect();
            clauses.push(format!("tune {{ {} }}", kept.join(", ")));
        }
        if rarely(self.rng, 5)
            && let Some(element) = self.rng.choice(&self.elements)
        {
            clauses.push(format!("without {{ {element} }}"));
        }
        if rarely(self.rng, 6) {
            clauses
                .push(one(self.rng, &["angles;", "expect planar;", "expect states = 1;", "rigid joints;"]).to_owned());
        }
        format!("scene Scene{index} {{ {} }}", clauses.join(" "))
    }
}
