//! Linear bond graphs drawn at random.
//!
//! In: randomness. Out: a [`Network`]. Junctions form a tree with some links more, neighbours by half arrows of either
//! direction or by two-ports; elements in every form that the language has for a linear law.

use bg_model::nalgebra::{DMatrix, DVector};
use fastrand::Rng;

use super::network::{Law, Network, Role, TIME};

/// What is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Style {
    /// Junctions at most.
    pub junctions: usize,
    /// Links at most, beyond those of a tree.
    pub extra: usize,
    /// How many percent of the elements that a junction could have are there.
    pub elements: u32,
    /// How many percent of the junctions have three components: between one of these and another junction there is a
    /// transformer to a vector.
    pub vectors: u32,
}

/// Graphs whose strokes have much to choose: few elements, many circles.
pub const LOOSE: Style = Style { junctions: 5, extra: 4, elements: 20, vectors: 20 };

/// Graphs of which many have equations.
pub const FULL: Style = Style { junctions: 6, extra: 1, elements: 50, vectors: 20 };

/// Graphs with many resistors and storages: circles of resistors, storages that determine each other.
pub const CROWDED: Style = Style { junctions: 5, extra: 2, elements: 85, vectors: 20 };

/// Graphs with transformers between scalars and vectors: of a storage some components determine the others.
pub const VECTORS: Style = Style { junctions: 6, extra: 2, elements: 60, vectors: 50 };

/// A graph.
#[must_use]
pub fn network(seed: u64, style: Style) -> Network {
    let mut sketch = Sketch { rng: Rng::with_seed(seed), network: Network::default(), junctions: Vec::new() };
    let count = 1 + sketch.rng.usize(..style.junctions);
    for index in 0..count {
        sketch.junction(style.vectors);
        if index > 0 {
            let other = sketch.rng.usize(..index);
            sketch.link(other, index);
        }
    }
    for _ in 0..sketch.rng.usize(..=style.extra) {
        let (one, other) = (sketch.rng.usize(..count), sketch.rng.usize(..count));
        if one != other {
            sketch.link(one, other);
        }
    }
    for junction in 0..count {
        sketch.elements(junction, style.elements);
    }
    sketch.network
}

/// A junction: its node, whether it is a 1-junction, its number of components.
type Junction = (usize, bool, usize);

struct Sketch {
    rng: Rng,
    network: Network,
    junctions: Vec<Junction>,
}

impl Sketch {
    /// A number of two digits, from a tenth to ten times another.
    fn number(&mut self) -> f64 {
        f64::from(self.rng.u32(4..40)) / 10.0
    }

    fn signed(&mut self) -> f64 {
        let number = self.number();
        if self.rng.bool() { number } else { -number }
    }

    fn name(&self, word: &str) -> String {
        format!("{word}{}", self.network.nodes.len())
    }

    fn junction(&mut self, vectors: u32) {
        let (is_one, size) = (self.rng.bool(), if self.rng.u32(..100) < vectors { 3 } else { 1 });
        let name = self.name("j");
        let brackets = if size == 1 { "" } else { "[3]" };
        let text = format!("{} {name}{brackets}: translation;", u8::from(is_one));
        let node = self.network.node(name, text, if is_one { Law::One } else { Law::Zero });
        self.junctions.push((node, is_one, size));
    }

    /// Half arrow of either direction.
    fn bond(&mut self, one: usize, other: usize, size: usize) {
        let (from, to) = if self.rng.bool() { (one, other) } else { (other, one) };
        self.network.bonds.push((from, to, size));
    }

    /// A bond between two junctions, or a chain with one or two two-ports.
    fn link(&mut self, one: usize, other: usize) {
        let (one, other) = if self.rng.bool() { (one, other) } else { (other, one) };
        let ((from, _, size), (to, _, last)) = (self.junctions[one], self.junctions[other]);
        if size != last {
            let node = self.transformer(size, last);
            self.network.bonds.extend([(from, node, size), (node, to, last)]);
            return;
        }
        let mut before = from;
        for place in 0..[0, 0, 0, 1, 1, 2][self.rng.usize(..6)] {
            // A law of a variable does not hand the number of components on, so only one of two in a chain may have
            // one.
            let may_be_of = place == 0;
            let node = match self.rng.u32(..3) {
                0 => self.gyrator(),
                1 if size == 3 && may_be_of => self.transformer(3, 3),
                _ => self.modulus(size, may_be_of),
            };
            self.network.bonds.push((before, node, size));
            before = node;
        }
        if before == from { self.bond(from, to, size) } else { self.network.bonds.push((before, to, size)) }
    }

    fn gyrator(&mut self) -> usize {
        let (name, ratio) = (self.name("g"), self.signed());
        let text = format!("param p{name}: N*s/m = {ratio}; GY {name} = p{name};");
        self.network.node(name, text, Law::Gyrator(ratio))
    }

    /// A transformer with a number, which works both ways; as a law of a variable it works one way.
    fn modulus(&mut self, size: usize, may_be_of: bool) -> usize {
        let (name, ratio) = (self.name("t"), self.signed());
        let of = [None, None, Some(Role::Flow), Some(Role::Effort)][self.rng.usize(..4)].filter(|_| may_be_of);
        let text = match of {
            None => format!("param p{name}: 1 = {ratio}; TF {name} = p{name};"),
            Some(role) => format!("TF {name}({} v) = {ratio} * v;", word(role)),
        };
        let matrix = DMatrix::from_diagonal_element(size, size, ratio);
        self.network.node(name, text, Law::Transformer { matrix, of })
    }

    /// A transformer with a matrix: it works one way.
    fn transformer(&mut self, size: usize, last: usize) -> usize {
        let name = self.name("t");
        // A square one is inverted where it stands between storages that determine each other.
        let matrix = if size == last && size > 1 {
            self.dominant(size, false)
        } else {
            DMatrix::from_fn(last, size, |_, _| f64::from(self.rng.i32(-20..20)) / 10.0)
        };
        let of = if self.rng.bool() { Role::Flow } else { Role::Effort };
        let value = match (size, last) {
            (3, 1) => format!("dot({}, v)", row(&matrix.row(0).transpose())),
            (1, 3) => format!("{} * v", row(&matrix.column(0).into_owned())),
            (1, 1) => format!("{} * v", matrix[(0, 0)]),
            _ => format!("{} * v", rows(&matrix)),
        };
        let text = format!("TF {name}({} v) = {value};", word(of));
        self.network.node(name, text, Law::Transformer { matrix, of: Some(of) })
    }

    fn elements(&mut self, junction: usize, percent: u32) {
        let (_, is_one, _) = self.junctions[junction];
        // An I where flows are common and a C where efforts are: there they have integral causality.
        let likely = |is: bool| if is { percent } else { percent / 8 };
        let wanted = [
            (0, likely(is_one)),
            (1, likely(!is_one)),
            (2, percent),
            (2, percent / 2),
            (3, likely(is_one) / 2),
            (4, likely(!is_one) / 2),
        ];
        for (kind, weight) in wanted {
            if self.rng.u32(..100) < weight {
                self.element(kind, junction);
            }
        }
        if self.network.bonds.is_empty() {
            self.element(2, junction);
        }
    }

    fn element(&mut self, kind: u32, junction: usize) {
        let (at, _, size) = self.junctions[junction];
        let name = self.name("e");
        let (text, law) = match kind {
            0 => self.inertia(&name, size),
            1 => self.stiffness(&name, size),
            2 => self.resistance(&name, size),
            _ => self.source(&name, size, kind == 3),
        };
        let node = self.network.node(name, text, law);
        self.bond(at, node, size);
    }

    /// A number, or one that grows with time.
    fn source(&mut self, name: &str, size: usize, is_effort: bool) -> (String, Law) {
        let value = DVector::from_fn(size, |_, _| self.signed());
        let word = if is_effort { "Se" } else { "Sf" };
        let of = |value: [DVector<f64>; 2]| if is_effort { Law::Effort(value) } else { Law::Flow(value) };
        if self.rng.u32(..3) > 0 {
            let rest = DVector::zeros(size);
            return (format!("{word} {name} = {};", row(&value)), of([value, rest]));
        }
        let rate = DVector::from_fn(size, |_, _| self.signed());
        let unit = if is_effort { "N" } else { "m/s" };
        let text = format!(
            "param u{name}: {unit} = 1; param s{name}: 1/s = 1; {word} {name} = u{name} * ({} + {} * (s{name} * t));",
            row(&value),
            row(&rate)
        );
        (text, of([value + TIME * &rate, rate]))
    }

    /// A number, one number an axis or a symmetric matrix, all positive; as text with `unit` after each number.
    fn positive(&mut self, size: usize, unit: &str) -> (String, DMatrix<f64>) {
        if size == 1 || self.rng.u32(..3) == 0 {
            let number = self.number();
            return (format!("{number}{unit}"), DMatrix::from_diagonal_element(size, size, number));
        }
        let mut matrix = DMatrix::from_diagonal(&DVector::from_fn(size, |_, _| 2.0 + self.number()));
        if self.rng.bool() {
            let diagonal = matrix.diagonal().map(|number| format!("{number}{unit}"));
            return (format!("[{}]", diagonal.as_slice().join(", ")), matrix);
        }
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            let beside = f64::from(self.rng.i32(-9..10)) / 10.0;
            (matrix[(i, j)], matrix[(j, i)]) = (beside, beside);
        }
        let lines: Vec<String> = matrix
            .row_iter()
            .map(|line| format!("[{}]", line.iter().map(|x| format!("{x}{unit}")).collect::<Vec<_>>().join(", ")))
            .collect();
        (format!("[{}]", lines.join(", ")), matrix)
    }

    fn inverse(matrix: &DMatrix<f64>) -> DMatrix<f64> {
        matrix.clone().try_inverse().expect("a matrix with a dominant diagonal has an inverse")
    }

    fn inertia(&mut self, name: &str, size: usize) -> (String, Law) {
        if self.rng.u32(..3) == 0 {
            let matrix = self.dominant(size, true);
            return (format!("I {name}(p) = {};", law(&matrix, "p")), Law::Inertia(matrix));
        }
        let (value, matrix) = self.positive(size, "");
        (format!("I {name} = {value};"), Law::Inertia(Self::inverse(&matrix)))
    }

    fn stiffness(&mut self, name: &str, size: usize) -> (String, Law) {
        match self.rng.u32(..3) {
            0 => {
                let matrix = self.dominant(size, true);
                (format!("C {name}(q) = {};", law(&matrix, "q")), Law::Stiffness(matrix))
            }
            1 => {
                let (value, matrix) = self.positive(size, " * k");
                (format!("C {name} = {value};"), Law::Stiffness(matrix))
            }
            _ => {
                let (value, matrix) = self.positive(size, " * n");
                (format!("C {name} = {value};"), Law::Stiffness(Self::inverse(&matrix)))
            }
        }
    }

    fn resistance(&mut self, name: &str, size: usize) -> (String, Law) {
        if self.rng.u32(..3) > 0 {
            let (value, matrix) = self.positive(size, "");
            return (format!("R {name} = {value};"), Law::Resistance { matrix, of: None });
        }
        let of = if self.rng.bool() { Role::Flow } else { Role::Effort };
        let matrix = self.dominant(size, false);
        let text = format!("R {name}({} v) = {};", word(of), law_without_energy(&matrix, "v"));
        (text, Law::Resistance { matrix, of: Some(of) })
    }

    /// A matrix with a dominant positive diagonal.
    fn dominant(&mut self, size: usize, is_symmetric: bool) -> DMatrix<f64> {
        let mut matrix = DMatrix::from_fn(size, size, |i, j| {
            if i == j { 2.0 + f64::from(self.rng.u32(1..30)) / 10.0 } else { f64::from(self.rng.i32(-9..10)) / 10.0 }
        });
        if is_symmetric {
            matrix.fill_upper_triangle_with_lower_triangle();
        }
        matrix
    }
}

fn word(role: Role) -> &'static str {
    match role {
        Role::Effort => "effort",
        Role::Flow => "flow",
    }
}

/// `[1, 2, 3]`, or the only number.
fn row(vector: &DVector<f64>) -> String {
    let numbers: Vec<String> = vector.iter().map(f64::to_string).collect();
    if numbers.len() == 1 { numbers.concat() } else { format!("[{}]", numbers.join(", ")) }
}

fn rows(matrix: &DMatrix<f64>) -> String {
    let lines: Vec<String> = matrix.row_iter().map(|line| row(&line.transpose())).collect();
    format!("[{}]", lines.join(", "))
}

fn law_without_energy(matrix: &DMatrix<f64>, variable: &str) -> String {
    if matrix.len() == 1 {
        format!("{} * {variable}", matrix[(0, 0)])
    } else {
        format!("{} * {variable}", rows(matrix))
    }
}

/// The law of a storage; the compiler integrates a scalar one.
fn law(matrix: &DMatrix<f64>, variable: &str) -> String {
    let law = law_without_energy(matrix, variable);
    if matrix.len() == 1 { law } else { format!("{law} energy 0.5 * dot({variable}, {law})") }
}
