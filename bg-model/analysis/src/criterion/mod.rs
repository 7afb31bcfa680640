//! Criteria: one number of a run each, written as `max |pin.force|` or `range(speed, 2..) / mean(speed, 2..)`.
//!
//! In: texts, a model's description. Out: what has to be known of a run for all of them ([`Measure`]s of signals),
//! their values, and exact derivatives by parameters ([`of_run`]). All is calculated in coherent SI, and shown in the
//! units that the model's outputs have.
//!
//! A number is made of numbers (with units: `30 rpm`), parameters and measures, by `+ - * / ^`, `abs sqrt sin cos tan
//! exp ln`, `max(a, b, ..)`, `min(a, b, ..)`. A measure is a number of a signal, which is made of outputs, parameters
//! and the time `t` likewise; `|F|` is the length of a vector or the magnitude of a number. Behind a comma stands a
//! window of time, `2..` or `2..5` s.
//!
//! | measure | of a signal |
//! |---|---|
//! | `max`, `min` | its largest and its least value, between the samples as well |
//! | `range` | the one less the other, peak to peak |
//! | `mean`, `rms`, `deviation`, `integral` | over time, by straight lines between samples |
//! | `final`, `at(x, 0.7)` | its value at the end, at a time |
//! | `time_of_max`, `time_of_min` | when it is largest and least, s |
//! | `crossings(x, level)` | how often it passes a level, 0 unless one is given, as seen by the samples |

pub mod of_run;
mod text;
mod tree;
mod units;

use bg_model::description::{Description, ParameterInfo};
use bg_model::scalar::Scalar;
use bg_units::Unit;
use thiserror::Error;

use text::Reader;
pub use text::Relation;
use tree::{Leaves, Node, Parts, Two, unit};
use units::Shown;

/// A criterion that cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum CriterionError {
    /// It is no criterion.
    #[error("`{text}`: expected {wanted}, found {found}")]
    Syntax {
        /// The text.
        text: String,
        /// What should stand there.
        wanted: String,
        /// What stands there.
        found: String,
    },
    /// A name that stands for nothing.
    #[error("there is no output, parameter or measure `{name}`{}", near.as_ref().map_or_else(
        || "; the command `scene` lists the outputs".to_owned(), |near| format!("; did you mean `{near}`?")))]
    Unknown {
        /// The name.
        name: String,
        /// The most similar one.
        near: Option<String>,
    },
    /// A vector where a number has to be.
    #[error("`{name}` is a vector: write |{name}| for its length, or one of {components}")]
    Vector {
        /// Its name.
        name: String,
        /// Those of its components.
        components: String,
    },
    /// A function of time where a number has to be.
    #[error("`{0}` changes with time: say which number of it counts, as in max(..), mean(..) or final(..)")]
    Signal(String),
    /// A number of a whole run where a function of time has to be.
    #[error("`{0}` is one number of a whole run, and here a course over time is wanted: leave its measures out")]
    NoCourse(String),
    /// A number where a function of time has to be.
    #[error("`{name}` is of what changes with time, and here is none: give it an output")]
    NoSignal {
        /// The measure.
        name: String,
    },
    /// Another number of arguments.
    #[error("`{name}` takes {}", arguments(name))]
    Arguments {
        /// The function.
        name: String,
    },
    /// A window that ends before it begins.
    #[error("the window {from}..{to} ends before it begins")]
    Window {
        /// Its start, s.
        from: String,
        /// Its end, s.
        to: String,
    },
    /// Units that do not fit.
    #[error("{} and {} are added or compared, and measure different things", shown(a), shown(b))]
    Units {
        /// One of them.
        a: String,
        /// The other one.
        b: String,
    },
    /// A bare number beside what is not in a coherent unit.
    #[error("a number without a unit is added to what is in {unit}: give its unit")]
    BareNumber {
        /// The unit.
        unit: String,
    },
    /// A function of numbers of what has a unit.
    #[error("this function is of numbers and angles, and what stands in it is in {0}")]
    NotANumber(String),
    /// A root of a unit that has none.
    #[error("what stands in sqrt(..) is in {0}, whose root is no unit")]
    NoRoot(String),
    /// A power of a unit that is not whole.
    #[error("what is in {0} is raised to a power that is not a whole number")]
    NoPower(String),
}

fn arguments(name: &str) -> &'static str {
    match name {
        "at" => "a signal and a time, as in at(x, 0.7)",
        "crossings" => "a signal and a level, as in crossings(x, 0.1)",
        "max" | "min" => "a signal and a window of time at most, as in max(x, 2..5), or several numbers",
        _ => "one argument, and of measures a window of time, as in mean(x, 2..5)",
    }
}

fn shown(unit: &str) -> &str {
    if unit.is_empty() { "a number" } else { unit }
}

/// Which number of a signal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CriterionKind {
    /// Its largest value.
    Max,
    /// Its least value.
    Min,
    /// The one less the other.
    Range,
    /// Its mean over time.
    Mean,
    /// The root of its mean square over time.
    Rms,
    /// The root of the mean square of what it is off its mean.
    Deviation,
    /// Its integral over time.
    Integral,
    /// Its last value.
    Final,
    /// Its value at this time, s.
    At(f64),
    /// When it is largest, s.
    TimeOfMax,
    /// When it is least, s.
    TimeOfMin,
    /// How often it passes this level, in SI.
    Crossings(f64),
}

impl CriterionKind {
    /// Whether it is known from the least and the largest value.
    pub const fn is_of_peaks(self) -> bool {
        matches!(self, Self::Max | Self::Min | Self::Range | Self::TimeOfMax | Self::TimeOfMin)
    }

    /// Whether it is made from all samples of its window.
    pub const fn is_over_time(self) -> bool {
        matches!(self, Self::Mean | Self::Rms | Self::Deviation | Self::Integral | Self::Crossings(_))
    }

    /// Whether it has derivatives by parameters.
    pub const fn has_derivatives(self) -> bool {
        !matches!(self, Self::TimeOfMax | Self::TimeOfMin | Self::Crossings(_))
    }
}

/// A number of a signal.
#[derive(Clone, Debug, PartialEq)]
pub struct Measure {
    /// Which number.
    pub kind: CriterionKind,
    /// The signal.
    signal: Node,
    /// From when to when it is looked at, s; the whole run if none is given.
    window: Option<[f64; 2]>,
}

/// A number of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Criterion {
    /// As it was written.
    pub text: String,
    node: Node,
    unit: Shown,
}

impl Criterion {
    /// The unit that it is shown in.
    #[must_use]
    pub fn unit(&self) -> &str {
        &self.unit.text
    }

    /// Its value in that unit, from that in coherent SI.
    #[must_use]
    pub fn shown(&self, value: f64) -> f64 {
        self.unit.unit.from_si(value)
    }
}

/// A function of time that a run gives.
#[derive(Clone, Debug, PartialEq)]
pub struct Signal {
    /// As it was written.
    pub text: String,
    node: Node,
    unit: Shown,
}

impl Signal {
    /// The unit that it is shown in.
    #[must_use]
    pub fn unit(&self) -> &str {
        &self.unit.text
    }

    /// The outputs that it reads, by their places, ascending.
    #[must_use]
    pub fn outputs(&self) -> Vec<usize> {
        outputs_of(std::iter::once(&self.node))
    }

    /// Its values in that unit at `times` (s), of a model with these values of its parameters; `column` has the values
    /// of an output there, of those that it reads.
    pub fn values<'a>(
        &self,
        model: &Description,
        parameters: &[f64],
        times: &[f64],
        column: impl Fn(usize) -> &'a [f64],
    ) -> Vec<f64> {
        let parameters: Vec<f64> =
            parameters.iter().zip(model.parameters).map(|(value, info)| value * size(info)).collect();
        let read: Vec<(usize, Unit, &[f64])> = self
            .outputs()
            .into_iter()
            .map(|place| {
                (place, Shown::of(model.outputs[place].unit).map_or(Unit::ONE, |shown| shown.unit), column(place))
            })
            .collect();
        let mut outputs = vec![0.0; model.outputs.len()];
        let at = |(row, &t): (usize, &f64)| {
            read.iter().for_each(|(place, unit, values)| outputs[*place] = unit.in_si(values[row]));
            let leaves = Leaves { t, outputs: &outputs, parameters: &parameters, measures: &[], pieces: &[] };
            self.unit.unit.from_si(self.node.value(&leaves))
        };
        times.iter().enumerate().map(at).collect()
    }
}

/// The outputs that these trees read, ascending.
fn outputs_of<'a>(nodes: impl Iterator<Item = &'a Node>) -> Vec<usize> {
    let mut places = Vec::new();
    for node in nodes {
        node.each(&mut |node| places.extend(if let Node::Output(place) = node { Some(*place) } else { None }));
    }
    places.sort_unstable();
    places.dedup();
    places
}

/// What two numbers of a run have to fulfil.
#[derive(Clone, Debug, PartialEq)]
pub struct Requirement {
    /// As it was written.
    pub text: String,
    /// The left side.
    pub left: Criterion,
    /// How both are compared.
    pub relation: Relation,
    /// The right side.
    pub right: Criterion,
}

/// Criteria of one model, with the measures that they have in common.
#[derive(Clone, Debug)]
pub struct Criteria {
    model: &'static Description,
    measures: Vec<Measure>,
}

impl Criteria {
    /// Those of a model that is described so.
    #[must_use]
    pub const fn new(model: &'static Description) -> Self {
        Self { model, measures: Vec::new() }
    }

    /// What has to be known of a run for all criteria so far.
    #[must_use]
    pub fn measures(&self) -> &[Measure] {
        &self.measures
    }

    /// The number that a text asks for.
    ///
    /// # Errors
    /// [`CriterionError`].
    pub fn criterion(&mut self, text: &str) -> Result<Criterion, CriterionError> {
        let node = Reader::new(text, self.model, &mut self.measures)?.number()?;
        self.of_node(text, node)
    }

    /// The function of time that a text asks for.
    ///
    /// # Errors
    /// [`CriterionError`].
    pub fn signal(&mut self, text: &str) -> Result<Signal, CriterionError> {
        let node = Reader::new(text, self.model, &mut self.measures)?.signal()?;
        let unit = self.unit(&node)?.unwrap_or_else(Shown::number);
        Ok(Signal { text: text.trim().to_owned(), node, unit })
    }

    /// The comparison that a text asks for. A bare number is in the unit of the other side.
    ///
    /// # Errors
    /// [`CriterionError`].
    pub fn requirement(&mut self, text: &str) -> Result<Requirement, CriterionError> {
        let (left, relation, right) = Reader::new(text, self.model, &mut self.measures)?.comparison()?;
        let [left_unit, right_unit] = [self.unit(&left)?, self.unit(&right)?];
        let (left, right) = match (left_unit, right_unit) {
            (Some(a), Some(b)) if a.unit.dimension != b.unit.dimension => {
                return Err(CriterionError::Units { a: a.text, b: b.text });
            }
            (None, Some(unit)) => (in_unit(left, &unit), right),
            (Some(unit), None) => (left, in_unit(right, &unit)),
            _ => (left, right),
        };
        // Both sides are shown in the unit of the one that is measured.
        let sides = text.split(['<', '>', '=', '\u{2264}']).map(str::trim).filter(|side| !side.is_empty());
        let sides: Vec<&str> = sides.collect();
        let [left, right] =
            [self.of_node(sides.first().unwrap_or(&text), left)?, self.of_node(sides.last().unwrap_or(&text), right)?];
        Ok(Requirement { text: text.trim().to_owned(), left, relation, right })
    }

    fn of_node(&self, text: &str, node: Node) -> Result<Criterion, CriterionError> {
        let unit = self.unit(&node)?.unwrap_or_else(Shown::number);
        Ok(Criterion { text: text.trim().to_owned(), node, unit })
    }

    fn unit(&self, node: &Node) -> Result<Option<Shown>, CriterionError> {
        unit(node, &|leaf| self.unit_of_leaf(leaf))
    }

    fn unit_of_leaf(&self, leaf: &Node) -> Option<Shown> {
        let of = |text: &str| Some(Shown::of(text).unwrap_or_else(Shown::number));
        match leaf {
            Node::Time => of("s"),
            Node::Output(place) => of(self.model.outputs[*place].unit),
            Node::Parameter(place) => of(self.model.parameters[*place].unit),
            Node::Measure(place) | Node::Piece { measure: place, .. } => {
                let measure = &self.measures[*place];
                let signal = unit(&measure.signal, &|leaf| self.unit_of_leaf(leaf)).ok()?;
                match measure.kind {
                    CriterionKind::TimeOfMax | CriterionKind::TimeOfMin => of("s"),
                    CriterionKind::Crossings(_) => Some(Shown::number()),
                    CriterionKind::Integral => {
                        signal.map(|unit| unit.times(&Shown::of("s").unwrap_or_else(Shown::number)))
                    }
                    _ => signal,
                }
            }
            _ => None,
        }
    }

    /// The outputs that the signals of all measures read, ascending.
    #[must_use]
    pub fn outputs(&self) -> Vec<usize> {
        outputs_of(self.measures.iter().map(|measure| &measure.signal))
    }

    /// The value of a criterion, in coherent SI.
    #[must_use]
    pub fn value<S: Scalar>(&self, criterion: &Criterion, found: &Known<S>) -> S {
        criterion.node.value(&found.leaves())
    }

    /// Several numbers, each smoother than a criterion, the largest of which it is: largest values of parts of the time
    /// in place of those of a window, each of several numbers.
    #[must_use]
    pub fn pieces(&self, criterion: &Criterion) -> Vec<Criterion> {
        let nodes = criterion.node.pieces(&self.measures.as_slice());
        nodes.into_iter().map(|node| Criterion { node, ..criterion.clone() }).collect()
    }

    /// What a requirement wants to be at most zero, or zero: the left side less the right one, or the other way round.
    #[must_use]
    pub fn excess(&self, requirement: &Requirement) -> Criterion {
        let Requirement { left, relation, right, .. } = requirement;
        let less =
            |a: &Criterion, b: &Criterion| Node::Two(Two::Minus, Box::new(a.node.clone()), Box::new(b.node.clone()));
        let node = if *relation == Relation::AtLeast { less(right, left) } else { less(left, right) };
        Criterion { text: requirement.text.clone(), node, unit: left.unit.clone() }
    }

    /// A criterion less a value in coherent SI.
    #[must_use]
    pub fn less(&self, criterion: &Criterion, value: f64) -> Criterion {
        let value = Node::Number(value, Some(criterion.unit.clone()));
        let node = Node::Two(Two::Minus, Box::new(criterion.node.clone()), Box::new(value));
        Criterion { node, ..criterion.clone() }
    }

    /// The criterion with its sign turned.
    #[must_use]
    pub fn negative(&self, criterion: &Criterion) -> Criterion {
        Criterion { node: criterion.node.clone().negative(), ..criterion.clone() }
    }

    /// The first measure of a criterion that has no derivatives, in words.
    #[must_use]
    pub fn without_derivatives(&self, criterion: &Criterion) -> Option<&'static str> {
        let mut found = None;
        criterion.node.each(&mut |node| {
            if let Node::Measure(place) = node {
                found = found.or(match self.measures[*place].kind {
                    CriterionKind::TimeOfMax => Some("time_of_max"),
                    CriterionKind::TimeOfMin => Some("time_of_min"),
                    CriterionKind::Crossings(_) => Some("crossings"),
                    _ => None,
                });
            }
        });
        found
    }
}

/// A number without a unit, in this unit, in coherent SI.
fn in_unit(node: Node, unit: &Shown) -> Node {
    match node.constant() {
        Some(value) => Node::Number(unit.unit.in_si(value), Some(unit.clone())),
        None => node,
    }
}

impl Parts for &[Measure] {
    fn of(&self, measure: usize) -> Option<(bool, usize)> {
        match self[measure].kind {
            CriterionKind::Max => Some((true, of_run::PARTS)),
            CriterionKind::Min => Some((false, of_run::PARTS)),
            _ => None,
        }
    }
}

/// What is known of a run: all measures of its criteria, in coherent SI.
#[derive(Clone, Debug)]
pub struct Known<S> {
    parameters: Vec<S>,
    measures: Vec<S>,
    pieces: Vec<Vec<S>>,
}

impl<S: Scalar> Known<S> {
    fn leaves(&self) -> Leaves<'_, S> {
        let Self { parameters, measures, pieces } = self;
        Leaves { t: S::from_f64(0.0), outputs: &[], parameters, measures, pieces }
    }
}

/// The factor of a parameter from its unit to coherent SI.
fn size(info: &ParameterInfo) -> f64 {
    Shown::of(info.unit).map_or(1.0, |shown| shown.unit.in_si(1.0))
}

/// Values in units as written, in coherent SI.
fn in_si<'a>(units: impl Iterator<Item = &'a str>) -> Vec<Unit> {
    units.map(|text| text.parse().unwrap_or(Unit::ONE)).collect()
}

#[cfg(test)]
mod tests {
    use bg_model::description::{OutputInfo, Range};

    use super::*;

    const fn output(name: &'static str, of: &'static str, observes: &'static str, unit: &'static str) -> OutputInfo {
        OutputInfo { name, of, observes, unit }
    }

    const OUTPUTS: &[OutputInfo] = &[
        output("x", "x", "spring.q", "m"),
        output("speed", "speed", "shaft.flow", "rpm"),
        output("F_x", "F", "pin.force", "N"),
        output("F_y", "F", "pin.force", "N"),
        output("F_z", "F", "pin.force", "N"),
    ];
    const OPEN: Range =
        Range { lower: f64::NEG_INFINITY, lower_included: false, upper: f64::INFINITY, upper_included: false };
    const PARAMETERS: &[ParameterInfo] =
        &[ParameterInfo { name: "length", unit: "mm", default: 1.0, doc: "", range: OPEN }];

    fn model() -> &'static Description {
        Box::leak(Box::new(Description { outputs: OUTPUTS, parameters: PARAMETERS, ..Description::default() }))
    }

    /// What a text is shown as: a tree, and its unit.
    fn read(text: &str) -> (Criteria, Criterion) {
        let mut criteria = Criteria::new(model());
        let criterion = criteria.criterion(text).unwrap_or_else(|fault| panic!("{text}: {fault}"));
        (criteria, criterion)
    }

    fn fault(text: &str) -> String {
        Criteria::new(model()).criterion(text).expect_err(text).to_string()
    }

    #[test]
    fn a_number_is_in_the_unit_of_what_it_is_made_of() {
        for (text, unit) in [
            ("max x", "m"),
            ("mean(speed, 2..)", "rpm"),
            ("max |pin.force|", "N"),
            ("max |F|", "N"),
            ("integral |pin.force.x|", "N*s"),
            ("range(speed) / mean(speed)", ""),
            ("max(F_x * x)", "N*m"),
            ("2 * length", "mm"),
            ("length^2", "m^2"),
            ("sqrt(length * max x)", "m"),
            ("time_of_max x", "s"),
            ("max(max x, 3 mm)", "m"),
        ] {
            let (_, criterion) = read(text);
            assert_eq!(criterion.unit(), unit, "{text}");
        }
    }

    #[test]
    fn operators_bind_as_in_mathematics() {
        for (text, value) in [
            ("2 + 3 * 4", 14.0),
            ("(2 + 3) * 4", 20.0),
            ("-2^2", -4.0),
            ("8 / 4 / 2", 1.0),
            ("2 - 3 - 4", -5.0),
            ("max(1, 3, 2)", 3.0),
            ("min(1, 3, 2) + |-4|", 5.0),
            ("75 mm", 0.075),
            ("30 rpm", std::f64::consts::PI),
            ("2 kN/mm", 2e6),
            ("1e3", 1e3),
            ("norm(3, 4)", 5.0),
        ] {
            let (_, criterion) = read(text);
            let found = criterion.node.constant().unwrap();
            assert!((found - value).abs() <= 1e-15 * value.abs(), "{text}: {found}");
        }
    }

    #[test]
    fn what_cannot_be_read_is_told() {
        for (text, words) in [
            ("max spede", "there is no output, parameter or measure `spede`; did you mean `speed`?"),
            ("speed", "`speed` changes with time: say which number of it counts"),
            ("mean(3)", "`mean` is of what changes with time, and here is none"),
            ("max pin.force", "`pin.force` is a vector: write |pin.force| for its length, or one of F_x, F_y, F_z"),
            ("max x + max speed", "m and rpm are added or compared, and measure different things"),
            ("max(x", "`max(x`: expected `)`, found the end"),
            ("max x max", "`max x max`: expected an end or an operator, found `max`"),
            ("at(x)", "`at` takes a signal and a time, as in at(x, 0.7)"),
            ("mean(x, 5..2)", "the window 5..2 ends before it begins"),
            ("max x # 2", "expected a number, a name or an operator, found `# 2`"),
            ("sin(max x)", "this function is of numbers and angles, and what stands in it is in m"),
            ("max speed + 3", "a number without a unit is added to what is in rpm: give its unit"),
        ] {
            let told = fault(text);
            assert!(told.contains(words), "{text}: {told}");
        }
    }

    #[test]
    fn a_bare_number_is_in_the_unit_of_the_other_side() {
        let mut criteria = Criteria::new(model());
        let subject = criteria.requirement("mean(speed) > 30").unwrap();
        assert_eq!(subject.relation, Relation::AtLeast);
        let is_pi = |node: &Node| node.constant().is_some_and(|value| (value - std::f64::consts::PI).abs() < 1e-15);
        assert!(is_pi(&subject.right.node));
        assert!(subject.right.unit() == "rpm" && (subject.right.shown(std::f64::consts::PI) - 30.0).abs() < 1e-13);
        let same = criteria.requirement("30 <= mean(speed)").unwrap();
        assert!(is_pi(&same.left.node));
        assert_eq!(criteria.measures().len(), 1, "a measure that is asked for twice is one");
        let fault = criteria.requirement("mean(speed) > 3 mm").unwrap_err();
        assert!(fault.to_string().contains("rpm and mm"), "{fault}");
        let fault = criteria.requirement("mean(speed)").unwrap_err();
        assert!(fault.to_string().contains("expected `<`, `>` or `=`"), "{fault}");
    }

    #[test]
    fn largest_values_are_those_of_parts_where_a_number_grows_with_them() {
        for (text, count) in [
            ("max x", of_run::PARTS),
            ("2 * max x + mean(x)", of_run::PARTS),
            ("-min x", of_run::PARTS),
            ("max(max x, mean(x))", of_run::PARTS + 1),
            ("min x", 1),
            ("-max x", 1),
            ("range x", 1),
            ("max x / mean(x)", 1),
            ("-2 * min x", of_run::PARTS),
        ] {
            let (criteria, criterion) = read(text);
            assert_eq!(criteria.pieces(&criterion).len(), count, "{text}");
        }
    }
}
