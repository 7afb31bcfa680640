//! Long routines as tables, for numbers in which models calculate seldom.
//!
//! In: a routine. Out: what it gives as an expression: where numbers are interpreted (`bg_model::tabled`) the table is
//! read, for all others there is straight code. rustc compiles one of the two for each kind of numbers.

use std::collections::BTreeMap;

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::super::routine::parsed_each;
use super::inlined::InlinedAlways;
use super::{Emission, Shape, names};
use crate::expr::Symbol;
use crate::program::batches::{Batches, Read, batches};
use crate::program::{Operand, Operation, Programs, Routine, Running};

/// The tables of constants that routines read.
pub(super) const CONSTANTS: &str = "constants";
pub(super) const HOLDING: &str = "holding_constants";
pub(super) const IMPACTS: &str = "impact_constants";
pub(super) const SIZES: &str = "size_constants";

/// Shorter routines are straight code for all numbers.
const SHORTEST: usize = 100;
/// Longer ones that are rarely asked are tables alone.
const LONGEST_RARE: usize = 400;
/// Longer ones of parameters, which are asked once for each model that is made, are tables alone.
const LONGEST_ONCE: usize = 50;

/// A routine of the running model.
#[derive(Clone, Copy)]
pub(super) struct Asked<'a> {
    pub routine: &'a Routine,
    /// The table of constants that it reads.
    pub constants: &'static str,
    /// Whether runs ask for it once in a while only: at impacts, or for pictures.
    pub is_rare: bool,
}

impl<'a> Asked<'a> {
    /// One that samples and steps ask for.
    pub fn often(routine: &'a Routine, constants: &'static str) -> Self {
        Self { routine, constants, is_rare: false }
    }

    /// One that is asked once in a while.
    pub fn rarely(routine: &'a Routine, constants: &'static str) -> Self {
        Self { routine, constants, is_rare: true }
    }

    fn constants(self) -> Ident {
        format_ident!("{}", self.constants)
    }

    /// Whether there is a table of it.
    fn is_tabled(self) -> bool {
        self.routine.assignments.len() >= SHORTEST
    }

    /// Whether there is nothing else.
    fn is_table_alone(self) -> bool {
        self.is_rare && self.routine.assignments.len() > LONGEST_RARE
    }

    /// The function that is its straight code.
    fn straight(self) -> Ident {
        format_ident!("straight_{}", self.routine.name)
    }
}

impl Emission<'_> {
    /// What a routine gives, as an array.
    pub(super) fn values(&self, asked: Asked<'_>) -> TokenStream {
        let Asked { routine, .. } = asked;
        let table = || {
            let (count, tabled) = (routine.results.len(), self.tabled(routine, &asked.constants()));
            quote! {
                let mut values = [S::from_f64(0.0); #count];
                let to = &mut values[..];
                #tabled
                values
            }
        };
        if !asked.is_tabled() {
            let (body, results) = self.running(routine, &asked.constants());
            return quote!({ #body [#(#results),*] });
        }
        let table = table();
        if asked.is_table_alone() {
            return quote!({ #table });
        }
        let (straight, handed) = (asked.straight(), self.reactions_read(routine).map(|[_, handed]| handed));
        quote! {
            if const { ::bg_model::__private::is_tabled::<S>() } {
                #table
            } else {
                self.#straight(t, x, negative, #handed)
            }
        }
    }

    /// The straight code of all that [`Self::values`] gives and that has a table: functions of their own, so that
    /// nothing of it is compiled for numbers that are interpreted.
    pub(super) fn straight(&self) -> Option<TokenStream> {
        let Shape { n, g, .. } = &self.shape;
        let inline = InlinedAlways;
        let functions = self.asked().into_iter().filter(|asked| asked.is_tabled() && !asked.is_table_alone());
        let functions: TokenStream = functions
            .map(|asked| {
                let (body, results) = self.running(asked.routine, &asked.constants());
                let (name, count) = (asked.straight(), results.len());
                let reactions = self.reactions_read(asked.routine).map(|[declared, _]| declared);
                quote! {
                    #inline
                    fn #name(
                        &self, t: S, x: &SVector<S, #n>, negative: &[S::Switch; #g], #reactions
                    ) -> [S; #count] {
                        #body
                        [#(#results),*]
                    }
                }
            })
            .collect();
        (!functions.is_empty()).then(|| quote!(impl<S: Scalar> Model<S> { #functions }))
    }

    /// Whether this is a routine of which there is a table alone.
    pub(super) fn is_table_alone(&self, routine: &Routine) -> bool {
        self.asked().into_iter().any(|asked| std::ptr::eq(asked.routine, routine) && asked.is_table_alone())
    }

    /// All routines that have a value by [`Self::values`].
    fn asked(&self) -> Vec<Asked<'_>> {
        let Programs { running, holding, impacts, sizes, .. } = &self.model.programs;
        let Running { guards, outputs, project, settle, stored_energy, powers, .. } = running;
        let often = [guards, outputs, project, settle, stored_energy, powers].map(|of| Asked::often(of, CONSTANTS));
        let holding = holding.iter().map(|of| Asked::often(&of.routines[0], HOLDING));
        let impacts = impacts.iter().map(|of| Asked::rarely(&of.routines[0], IMPACTS));
        let sizes = Asked::often(&sizes.routines[0], SIZES);
        often.into_iter().chain([self.asked_reactions()]).chain(holding).chain(impacts).chain([sizes]).collect()
    }

    /// The reactions: samples ask for them where outputs read them, else pictures alone.
    pub(super) fn asked_reactions(&self) -> Asked<'_> {
        let Running { reactions, outputs, .. } = &self.model.programs.running;
        Asked { routine: reactions, constants: CONSTANTS, is_rare: !names::reads_reactions(outputs) }
    }

    /// The reactions as an argument, declared and handed over, where the routine reads them.
    fn reactions_read(&self, routine: &Routine) -> Option<[TokenStream; 2]> {
        self.arguments(routine).remove("reactions")
    }

    /// Statements that write what a routine gives into the slice `to`, by its table; none of a short one.
    pub(super) fn tabled(&self, routine: &Routine, constants: &Ident) -> Option<TokenStream> {
        if !Asked::often(routine, CONSTANTS).is_tabled() {
            return None;
        }
        let table = Table::of(routine, self.states.len(), &Symbol::as_state);
        let (found, inputs) = (names::found(routine), self.input_bindings(routine, "t"));
        let others = self.with_names(|names| parsed_each(table.others.iter().map(|&symbol| (names.symbol)(symbol))));
        let chooses = routine.assignments.iter().any(|of| matches!(of.operation, Operation::Select { .. }));
        let negative = if chooses { quote!(negative) } else { quote!(&[]) };
        let (count, table) = (table.constants, table.written(routine));
        Some(quote! {
            #table
            #found
            #inputs
            let read = [x.as_slice(), &[#(#others),*], &self.#constants[..#count]];
            ::bg_model::__private::evaluate(&TABLE, read, #negative, to);
        })
    }

    /// Statements that write what a routine of parameters and of what a start has, its unknowns `u` among them, gives
    /// into the slice `to`, by its table; none of a short one. It reads the constants `c`, where it reads any.
    pub(super) fn tabled_once(&self, routine: &Routine) -> Option<TokenStream> {
        if routine.assignments.len() <= LONGEST_ONCE {
            return None;
        }
        let table = Table::of(routine, self.model.equations.parameters.len(), &|symbol| match symbol {
            Symbol::Parameter(index) => Some(index as usize),
            _ => None,
        });
        let others = self.with_names(|names| {
            parsed_each(table.others.iter().map(|&symbol| match symbol {
                Symbol::Kept(index) => format!("S::from_f64(kept[{index}])"),
                Symbol::Side(index) => format!("S::from_f64(sides[{index}])"),
                _ => (names.symbol)(symbol),
            }))
        });
        let constants = match table.constants {
            0 => quote!(&[]),
            count => quote!(&c[..#count]),
        };
        let table = table.written(routine);
        Some(quote! {
            #table
            ::bg_model::__private::evaluate(&TABLE, [parameters, &[#(#others),*], #constants], &[], to);
        })
    }
}

/// A routine as a table, and what it reads after numbers and the first array: states, or parameters.
struct Table {
    /// In bytes.
    numbers: Vec<u8>,
    /// Symbols that are not in the first array.
    others: Vec<Symbol>,
    /// How many constants, after these.
    constants: usize,
    /// In bytes.
    batches: Vec<u8>,
    /// Places, in bytes.
    results: Vec<u8>,
}

impl Table {
    /// That of a routine which reads an array of so many numbers first: `place` is that of a symbol in it.
    fn of(routine: &Routine, first: usize, place: &dyn Fn(Symbol) -> Option<usize>) -> Self {
        let (mut numbers, mut others, mut constants) = (BTreeMap::new(), Vec::new(), 0);
        let operands = routine.assignments.iter().flat_map(|of| of.operation.operands());
        for operand in operands.chain(routine.results.iter().copied()) {
            match operand {
                Operand::Number(value) => {
                    let next = numbers.len();
                    numbers.entry(value.to_bits()).or_insert(next);
                }
                Operand::Symbol(symbol) if place(symbol).is_none() && !others.contains(&symbol) => {
                    others.push(symbol);
                }
                Operand::Constant(index) => constants = constants.max(index as usize + 1),
                Operand::Symbol(_) | Operand::Temporary(_) => {}
            }
        }
        let read = |operand: Operand| match operand {
            Operand::Number(value) => Read::Number(value, small(numbers[&value.to_bits()])),
            Operand::Symbol(symbol) => {
                let other = || first + others.iter().position(|&other| other == symbol).expect("it is read");
                Read::Place(small(numbers.len() + place(symbol).unwrap_or_else(other)))
            }
            Operand::Constant(index) => Read::Place(small(numbers.len() + first + others.len()) + index),
            Operand::Temporary(index) => Read::Value(index),
        };
        let operations: Vec<Operation> = routine.assignments.iter().map(|of| of.operation.clone()).collect();
        let read_count = small(numbers.len() + first + others.len() + constants);
        let Batches { words, values } = batches(&operations, read_count, &read);
        let result = |&result: &Operand| match read(result) {
            Read::Place(place) | Read::Number(_, place) => place,
            Read::Value(value) => values[value as usize],
        };
        let mut in_order: Vec<(usize, u64)> = numbers.iter().map(|(&bits, &place)| (place, bits)).collect();
        in_order.sort_unstable();
        Self {
            numbers: in_order.iter().flat_map(|(_, bits)| bits.to_le_bytes()).collect(),
            results: routine.results.iter().map(result).flat_map(u32::to_le_bytes).collect(),
            batches: words.into_iter().flat_map(u32::to_le_bytes).collect(),
            others,
            constants,
        }
    }

    /// `static TABLE`.
    fn written(&self, routine: &Routine) -> TokenStream {
        let [numbers, batches, results] =
            [&self.numbers, &self.batches, &self.results].map(|bytes| Literal::byte_string(bytes));
        let operations = routine.assignments.len();
        quote! {
            static TABLE: ::bg_model::__private::Table = ::bg_model::__private::Table {
                numbers: #numbers, operations: #operations, batches: #batches, results: #results,
            };
        }
    }
}

fn small(index: usize) -> u32 {
    u32::try_from(index).expect("fewer than 2^32 values")
}
