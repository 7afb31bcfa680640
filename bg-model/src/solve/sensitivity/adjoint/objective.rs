//! What is differentiated: one number that the outputs of a run give.
//!
//! In: functions of the outputs at instants, integrals over the run. Out: an [`Objective`], their sum.

/// A number that the outputs of a run give: a sum of functions of the outputs at some instants and of integrals over
/// the run.
///
/// ```
/// use bg_model::sensitivity::Objective;
///
/// // Twice the last value of output 0, and its integral over the run.
/// let objective = Objective::last(0).times(2.0).plus(Objective::integral(0));
/// # drop(objective);
/// ```
#[must_use]
#[derive(Default)]
pub struct Objective<'a> {
    pub(super) terms: Vec<Term<'a>>,
    /// Outputs with their factors, whose integrals over the run are added.
    pub(super) integrals: Vec<(usize, f64)>,
}

/// A function of the outputs at instants.
pub(super) struct Term<'a> {
    pub instants: Instants,
    pub factor: f64,
    pub value: Value<'a>,
}

/// When a function is evaluated.
pub(super) enum Instants {
    /// At the end of the run.
    End,
    /// At these instants, s.
    At(Vec<f64>),
}

/// Is handed the number of the instant and the outputs there; adds its derivatives by these to the last argument, and
/// gives the value.
type Value<'a> = Box<dyn Fn(usize, &[f64], &mut [f64]) -> f64 + 'a>;

/// Values of an output that were measured.
#[derive(Clone, Debug, PartialEq)]
pub struct Measured {
    /// The output.
    pub output: usize,
    /// Instants, s, each with the value there, in the output's unit.
    pub values: Vec<(f64, f64)>,
    /// The noise of a value, in the output's unit, above 0.
    pub noise: f64,
}

impl<'a> Objective<'a> {
    /// The last value of an output, in its unit.
    pub fn last(output: usize) -> Self {
        Self::of(Instants::End, move |_, outputs, by| {
            by[output] += 1.0;
            outputs[output]
        })
    }

    /// The value of an output at time `t` (s), in its unit.
    pub fn at(output: usize, t: f64) -> Self {
        Self::of(Instants::At(vec![t]), move |_, outputs, by| {
            by[output] += 1.0;
            outputs[output]
        })
    }

    /// The integral of an output over the run, in its unit times s.
    pub fn integral(output: usize) -> Self {
        Self { terms: Vec::new(), integrals: vec![(output, 1.0)] }
    }

    /// The sum of the squares of what columns leave, each in parts of its noise: ((value - measured) / noise)^2.
    /// Without unit.
    pub fn squares(columns: &'a [Measured]) -> Self {
        let of = |column: &'a Measured| {
            let instants = column.values.iter().map(|&(t, _)| t).collect();
            Self::of(Instants::At(instants), move |k, outputs, by| {
                let left = (outputs[column.output] - column.values[k].1) / column.noise;
                by[column.output] += 2.0 * left / column.noise;
                left * left
            })
        };
        columns.iter().map(of).fold(Self::default(), Self::plus)
    }

    /// The sum over `instants` (s) of a function: `value` is handed the number of the instant and the outputs there,
    /// adds its derivatives by these to the last argument, and gives its value.
    pub fn samples(instants: &[f64], value: impl Fn(usize, &[f64], &mut [f64]) -> f64 + 'a) -> Self {
        Self::of(Instants::At(instants.to_vec()), value)
    }

    fn of(instants: Instants, value: impl Fn(usize, &[f64], &mut [f64]) -> f64 + 'a) -> Self {
        Self { terms: vec![Term { instants, factor: 1.0, value: Box::new(value) }], integrals: Vec::new() }
    }

    /// The sum of both.
    pub fn plus(mut self, mut other: Self) -> Self {
        self.terms.append(&mut other.terms);
        self.integrals.append(&mut other.integrals);
        self
    }

    /// `factor` times it.
    pub fn times(mut self, factor: f64) -> Self {
        self.terms.iter_mut().for_each(|term| term.factor *= factor);
        self.integrals.iter_mut().for_each(|(_, of)| *of *= factor);
        self
    }

    /// When terms are evaluated, ascending: the instant, s, the term, and the number of the instant in it.
    pub(super) fn instants(&self, t_end: f64) -> Vec<(f64, usize, usize)> {
        let of = |(term, Term { instants, .. }): (usize, &Term)| match instants {
            Instants::End => vec![(t_end, term, 0)],
            Instants::At(instants) => instants.iter().enumerate().map(|(k, &t)| (t, term, k)).collect(),
        };
        let mut all: Vec<_> = self.terms.iter().enumerate().flat_map(of).collect();
        all.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
        all
    }
}
