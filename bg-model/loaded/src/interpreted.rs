//! A model that is interpreted.
//!
//! In: a [`Blueprint`], values of its parameters, its inputs. Out: an [`Interpreted`] model, over slices and in any
//! scalar, with the bits of generated code.

use std::cell::{OnceCell, RefCell};
use std::sync::Arc;

use bg_compiler::expr::Symbol;
use bg_model::description::Description;
use bg_model::input::Input;
use bg_model::iteration::{Equations, lift, newton};
use bg_model::nalgebra::{Const, Dyn};
use bg_model::parameters::ParameterError;
use bg_model::requirement::require;
use bg_model::scalar::Scalar;
use bg_model::start::{kept, sides};

use crate::blueprint::{Alone, Blueprint, Codes};
use crate::code::{BackEnd, Code, Row};
use crate::series::SeriesRow;

/// A model with its parameters and inputs, calculating in `S`.
#[derive(Debug)]
pub struct Interpreted<S: Scalar = f64> {
    pub(crate) blueprint: Arc<Blueprint>,
    pub(crate) parameters: Vec<f64>,
    pub(crate) values: Vec<S>,
    pub(crate) inputs: Vec<Input>,
    pub(crate) decided: Decided,
    /// The constants of the running programs.
    pub(crate) constants: Vec<S>,
    pub(crate) back_end: BackEnd,
    pub(crate) rows: Rows<S>,
}

/// What the start pose decides for a run.
#[derive(Clone, Debug)]
pub struct Decided {
    /// 1 for each row of the joints that close loops which takes part, else 0.
    pub kept: Vec<f64>,
    /// On which side of zero roots are, 1 or -1.
    pub sides: Vec<f64>,
}

/// The rows of values of the programs that are evaluated while a model runs; those with constants of their own are made
/// when they are first evaluated.
#[derive(Debug)]
pub(crate) struct Rows<S: Scalar> {
    pub rate: RefCell<Row<S>>,
    pub guards: RefCell<Row<S>>,
    pub loops: RefCell<Row<S>>,
    pub reactions: RefCell<Row<S>>,
    pub outputs: RefCell<Row<S>>,
    pub project: RefCell<Row<S>>,
    pub settle: RefCell<Row<S>>,
    pub stored_energy: RefCell<Row<S>>,
    pub powers: RefCell<Row<S>>,
    pub jacobian: Own<S>,
    pub damping: Own<S>,
    pub derivatives: Own<S>,
    pub forces: Own<S>,
    pub holding: Own<S>,
    pub impacts: Own<S>,
    pub sizes: Own<S>,
    pub not_finite: Own<S>,
    pub pivots: Own<S>,
    pub series: OnceCell<RefCell<SeriesRow<S>>>,
    pub reverse_rate: Own<S>,
    pub reverse_outputs: Own<S>,
    pub reverse_project: Own<S>,
    pub reverse_settle: Own<S>,
}

/// A row of a program with constants of its own.
pub(crate) type Own<S> = OnceCell<RefCell<Row<S>>>;

/// What a program reads at one moment, beside constants.
#[derive(Clone, Copy)]
pub(crate) struct Moment<'a, S: Scalar> {
    pub t: S,
    pub x: &'a [S],
    pub negative: &'a [S::Switch],
    pub found: &'a [S],
    pub reactions: &'a [S],
    pub rates: &'a [S],
    /// Of the results of a program that is followed backwards.
    pub weights: &'a [S],
}

impl<'a, S: Scalar> Moment<'a, S> {
    pub const fn at(t: S, x: &'a [S], negative: &'a [S::Switch]) -> Self {
        Self { t, x, negative, found: &[], reactions: &[], rates: &[], weights: &[] }
    }
}

impl<S: Scalar> Interpreted<S> {
    /// The model with these values of its parameters, in the order of their table, and these inputs, in theirs; those
    /// that are missing are 0.
    ///
    /// # Errors
    /// A parameter outside its range, a value that parameters give and that cannot be.
    ///
    /// # Panics
    /// There is no value for a parameter.
    pub fn new(blueprint: &Arc<Blueprint>, parameters: &[f64], inputs: &[Input]) -> Result<Self, ParameterError> {
        Self::of_values(blueprint, parameters.iter().copied().map(S::from_f64).collect(), inputs)
    }

    /// The same with values in the scalar, such as dual numbers.
    ///
    /// # Errors
    /// As [`Interpreted::new`].
    ///
    /// # Panics
    /// As [`Interpreted::new`].
    pub fn of_values(blueprint: &Arc<Blueprint>, values: Vec<S>, inputs: &[Input]) -> Result<Self, ParameterError> {
        let parameters: Vec<f64> = values.iter().copied().map(S::to_f64).collect();
        let Description { parameters: table, inputs: named, .. } = blueprint.description();
        table.iter().zip(&parameters).try_for_each(|(info, &value)| info.check(value))?;
        if let Some(program) = &blueprint.programs.required {
            let mut required = vec![0.0; program.code.results()];
            of_parameters(program, &parameters, &[], None, &mut required);
            require(blueprint.statics.required, &required)?;
        }
        let inputs: Vec<Input> = (0..named.len()).map(|index| inputs.get(index).cloned().unwrap_or_default()).collect();
        let decided = decide(blueprint, &parameters, &inputs);
        Ok(Self::made(blueprint, parameters, values, inputs, decided, BackEnd::default()))
    }

    /// The same model, evaluated by this back end.
    #[must_use]
    pub fn by(self, back_end: BackEnd) -> Self {
        let rows = Rows::of(&self.blueprint.programs, &self.constants, back_end);
        Self { back_end, rows, ..self }
    }

    fn made(
        blueprint: &Arc<Blueprint>,
        parameters: Vec<f64>,
        values: Vec<S>,
        inputs: Vec<Input>,
        decided: Decided,
        back_end: BackEnd,
    ) -> Self {
        let constants = table(&blueprint.programs.constants, &values, &decided);
        let rows = Rows::of(&blueprint.programs, &constants, back_end);
        Self { blueprint: Arc::clone(blueprint), parameters, values, inputs, decided, constants, back_end, rows }
    }

    /// The model in another scalar.
    #[must_use]
    pub fn in_scalar<T: Scalar>(&self) -> Interpreted<T> {
        let Self { blueprint, parameters, inputs, decided, back_end, .. } = self;
        let values = parameters.iter().copied().map(T::from_f64).collect();
        Interpreted::made(blueprint, parameters.clone(), values, inputs.clone(), decided.clone(), *back_end)
    }

    pub(crate) fn programs(&self) -> &Codes {
        &self.blueprint.programs
    }

    /// What a symbol is at a moment.
    pub(crate) fn symbol(&self, symbol: Symbol, moment: &Moment<'_, S>) -> S {
        match symbol {
            Symbol::Time => moment.t,
            Symbol::Input(index) => self.inputs[index as usize].value(moment.t),
            Symbol::Slope(index) => self.inputs[index as usize].slope(moment.t),
            Symbol::Found(index) => moment.found[index as usize],
            Symbol::Multiplier(index) => moment.reactions[index as usize],
            Symbol::Rate(index) => moment.rates[index as usize],
            Symbol::Weight(index) => moment.weights[index as usize],
            Symbol::Kept(index) => S::from_f64(self.decided.kept[index as usize]),
            Symbol::Side(index) => S::from_f64(self.decided.sides[index as usize]),
            _ => unreachable!("no program of a running model reads {symbol:?}"),
        }
    }

    /// Writes what a program gives at a time and a state: by the short way where there is one.
    #[inline]
    pub(crate) fn evaluate_at(
        &self,
        (code, row): (&Code, &RefCell<Row<S>>),
        t: S,
        x: &[S],
        negative: &[S::Switch],
        to: &mut [S],
    ) {
        if !code.evaluate_at(&row.borrow(), x, negative, to) {
            self.evaluate(code, row, Moment::at(t, x, negative), to);
        }
    }

    /// Writes what a program gives at a moment. What iterations find for it is found first.
    pub(crate) fn evaluate(&self, code: &Code, row: &RefCell<Row<S>>, moment: Moment<'_, S>, to: &mut [S]) {
        if moment.found.is_empty() && code.reads_found() {
            let found = self.found(moment.t, moment.x, moment.negative);
            self.evaluate_found(code, row, &Moment { found: &found, ..moment }, to);
        } else {
            self.evaluate_found(code, row, &moment, to);
        }
    }

    /// The same where what iterations find is there. A moment is not copied on the way to machine code: that would take
    /// a fifth of a rate, as a copy reads in large pieces what has just been written in small ones.
    fn evaluate_found(&self, code: &Code, row: &RefCell<Row<S>>, moment: &Moment<'_, S>, to: &mut [S]) {
        let row = &mut *row.borrow_mut();
        code.evaluate(row, moment.x, |symbol| self.symbol(symbol, moment), moment.negative, to);
    }

    /// The row of a program with these constants of its own.
    pub(crate) fn own<'a>(&self, row: &'a Own<S>, constants: &Code, code: &Code) -> &'a RefCell<Row<S>> {
        row.get_or_init(|| RefCell::new(code.row(&table(constants, &self.values, &self.decided), self.back_end)))
    }

    /// Writes what a program with constants of its own gives at a moment.
    pub(crate) fn alone(&self, of: &Alone, row: &Own<S>, moment: Moment<'_, S>, to: &mut [S]) {
        self.evaluate(&of.code, self.own(row, &of.constants, &of.code), moment, to);
    }

    /// The same as a list.
    pub(crate) fn alone_listed(&self, of: &Alone, row: &Own<S>, moment: Moment<'_, S>) -> Vec<S> {
        let mut results = vec![S::from_f64(0.0); of.code.results()];
        self.alone(of, row, moment, &mut results);
        results
    }

    /// What a program gives at a moment as a list.
    pub(crate) fn listed(&self, code: &Code, row: &RefCell<Row<S>>, moment: Moment<'_, S>) -> Vec<S> {
        let mut results = vec![S::from_f64(0.0); code.results()];
        self.evaluate(code, row, moment, &mut results);
        results
    }

    /// What the unknowns of algebraic loops are, nearly; not numbers where that is not found.
    pub(crate) fn found(&self, t: S, x: &[S], negative: &[S::Switch]) -> Vec<S> {
        let mut found = vec![S::from_f64(0.0); self.blueprint.found()];
        let code = &self.programs().loops;
        for of in &self.blueprint.loops {
            let unknowns = of.first..of.first + of.unknowns;
            let mut equations = |u: &[f64]| {
                lift(u, &mut found[unknowns.clone()]);
                let moment = Moment { found: &found, ..Moment::at(t, x, negative) };
                let results = self.listed(code, &self.rows.loops, moment);
                results[of.equation..of.equation + of.equations()].to_vec()
            };
            // On the stack where most loops are: of one unknown.
            let solved = if of.unknowns == 1 {
                newton(Const::<1>, |u| Equations::of(Const::<1>, &equations(u))).as_slice().to_vec()
            } else {
                let unknowns = Dyn(of.unknowns);
                newton(unknowns, |u| Equations::of(unknowns, &equations(u))).as_slice().to_vec()
            };
            lift(&solved, &mut found[unknowns]);
        }
        found
    }

    /// The reactions of all rigid joints, of least norm where they are not unique; none where joints close no loops.
    pub(crate) fn reactions(&self, t: S, x: &[S], negative: &[S::Switch]) -> Vec<S> {
        if self.blueprint.closing_rows == 0 {
            return Vec::new();
        }
        let mut reactions = self.listed(&self.programs().reactions, &self.rows.reactions, Moment::at(t, x, negative));
        bg_model::start::share(self, t, x, negative, &mut reactions);
        reactions
    }
}

/// What the start pose of a model decides.
fn decide(blueprint: &Arc<Blueprint>, parameters: &[f64], inputs: &[Input]) -> Decided {
    let mut decided =
        Decided { kept: vec![1.0; blueprint.closing_rows], sides: vec![1.0; blueprint.statics.start.sides] };
    let made = |decided: &Decided| {
        let (parameters, inputs) = (parameters.to_vec(), inputs.to_vec());
        Interpreted::<f64>::made(
            blueprint,
            parameters.clone(),
            parameters,
            inputs,
            decided.clone(),
            BackEnd::Interpreter,
        )
    };
    if !decided.sides.is_empty() {
        decided.sides = sides(&made(&decided));
    }
    if !decided.kept.is_empty() {
        let all = made(&decided);
        decided.kept = kept(&all, &all);
    }
    decided
}

/// Writes what a program of parameters and unknowns gives.
pub(crate) fn of_parameters<S: Scalar>(
    Alone { constants, code }: &Alone,
    values: &[S],
    unknowns: &[S],
    decided: Option<&Decided>,
    to: &mut [S],
) {
    let symbol = |symbol: Symbol| match symbol {
        Symbol::Parameter(index) => values[index as usize],
        Symbol::Unknown(index) => unknowns.get(index as usize).copied().unwrap_or(S::from_f64(0.0)),
        symbol => of_decided(symbol, decided),
    };
    let constants = constants.once(&[], symbol);
    code.evaluate(&mut code.row(&constants, BackEnd::Interpreter), &[], symbol, &[], to);
}

fn of_decided<S: Scalar>(symbol: Symbol, decided: Option<&Decided>) -> S {
    match (symbol, decided) {
        (Symbol::Kept(index), Some(decided)) => S::from_f64(decided.kept[index as usize]),
        (Symbol::Side(index), Some(decided)) => S::from_f64(decided.sides[index as usize]),
        _ => unreachable!("no program of parameters reads {symbol:?}"),
    }
}

/// A table of constants.
fn table<S: Scalar>(constants: &Code, values: &[S], decided: &Decided) -> Vec<S> {
    constants.once(&[], |symbol| match symbol {
        Symbol::Parameter(index) => values[index as usize],
        symbol => of_decided(symbol, Some(decided)),
    })
}

impl<S: Scalar> Rows<S> {
    fn of(programs: &Codes, running: &[S], back_end: BackEnd) -> Self {
        let row = |code: &Code| RefCell::new(code.row(running, back_end));
        Self {
            rate: row(&programs.rate),
            guards: row(&programs.guards),
            loops: row(&programs.loops),
            reactions: row(&programs.reactions),
            outputs: row(&programs.outputs),
            project: row(&programs.project),
            settle: row(&programs.settle),
            stored_energy: row(&programs.stored_energy),
            powers: row(&programs.powers),
            jacobian: OnceCell::new(),
            damping: OnceCell::new(),
            derivatives: OnceCell::new(),
            forces: OnceCell::new(),
            holding: OnceCell::new(),
            impacts: OnceCell::new(),
            sizes: OnceCell::new(),
            not_finite: OnceCell::new(),
            pivots: OnceCell::new(),
            series: OnceCell::new(),
            reverse_rate: OnceCell::new(),
            reverse_outputs: OnceCell::new(),
            reverse_project: OnceCell::new(),
            reverse_settle: OnceCell::new(),
        }
    }
}
