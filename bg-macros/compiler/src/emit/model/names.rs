//! What values are called in generated functions.
//!
//! In: symbols of a program. Out: identifiers, and the `let`s that read parameters, states and inputs under them.

use std::collections::{BTreeMap, BTreeSet};

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::super::items::identifier;
use super::super::routine::Names;
use super::Emission;
use crate::expr::Symbol;
use crate::program::{Assignment, Operand, Operation, Routine};
use crate::source::names;
use crate::system::equations::StateEquations;

/// `let name = value;` for the symbols that some routines use.
pub(super) fn bindings(routines: &[&Routine], binding: &dyn Fn(Symbol) -> Option<TokenStream>) -> TokenStream {
    symbols(routines).into_iter().filter_map(binding).collect()
}

/// Whether the routine reads what iterations have found.
pub(super) fn reads_found(routine: &Routine) -> bool {
    symbols(&[routine]).iter().any(|symbol| matches!(symbol, Symbol::Found(_)))
}

/// Whether the routine reads reactions.
pub(super) fn reads_reactions(routine: &Routine) -> bool {
    symbols(&[routine]).iter().any(|symbol| matches!(symbol, Symbol::Multiplier(_)))
}

/// `let found`, where the routine reads what iterations find.
pub(super) fn found(routine: &Routine) -> Option<TokenStream> {
    reads_found(routine).then(|| quote!(let found = self.found(t, x, negative);))
}

/// The symbols that some routines use.
fn symbols(routines: &[&Routine]) -> BTreeSet<Symbol> {
    let operands = routines.iter().flat_map(|routine| {
        let inside = routine.assignments.iter().flat_map(|assignment| assignment.operation.operands());
        inside.chain(routine.results.iter().copied())
    });
    operands.filter_map(|operand| if let Operand::Symbol(symbol) = operand { Some(symbol) } else { None }).collect()
}

impl Emission<'_> {
    /// Parameters that the routines use.
    pub(super) fn parameter_bindings(&self, routines: &[&Routine]) -> TokenStream {
        bindings(routines, &|symbol| match symbol {
            Symbol::Parameter(index) => {
                let (name, index) = (self.symbol_name(symbol), Literal::u32_unsuffixed(index));
                Some(quote!(let #name = parameters[#index];))
            }
            Symbol::Kept(index) | Symbol::Side(index) => {
                let array = if matches!(symbol, Symbol::Kept(_)) { "kept" } else { "sides" };
                let (name, array, index) =
                    (self.symbol_name(symbol), format_ident!("{array}"), Literal::u32_unsuffixed(index));
                Some(quote!(let #name = S::from_f64(#array[#index]);))
            }
            _ => None,
        })
    }

    /// Inputs, their slopes and states that the routine uses, and what iterations find for it.
    pub(super) fn dynamic_bindings(&self, routine: &Routine) -> TokenStream {
        let found = found(routine);
        let (inputs, states) = (self.input_bindings(routine, "t"), self.state_bindings(routine));
        quote! { #found #inputs #states }
    }

    /// What the routine reads beside states and constants, each as it is declared as an argument and as it is handed
    /// over: time, switches, reactions, what iterations find, rates, weights.
    pub(super) fn arguments(&self, routine: &Routine) -> BTreeMap<&'static str, [TokenStream; 2]> {
        let g = &self.shape.g;
        let of_symbols = symbols(&[routine]).into_iter().filter_map(|symbol| {
            let (name, is_array) = match symbol {
                Symbol::Time | Symbol::Input(_) | Symbol::Slope(_) => ("t", false),
                Symbol::Multiplier(_) => ("reactions", true),
                Symbol::Found(_) => ("found", true),
                Symbol::Rate(_) => ("r", true),
                Symbol::Weight(_) => ("weights", true),
                _ => return None,
            };
            let ident = format_ident!("{name}");
            let tokens = if is_array {
                [quote!(#ident: &[S]), quote!(&#ident[..])]
            } else {
                [quote!(#ident: S), quote!(#ident)]
            };
            Some((name, tokens))
        });
        let is_choice = |of: &Assignment| matches!(of.operation, Operation::Select { .. });
        let chooses = routine.assignments.iter().any(is_choice);
        let switches = chooses.then(|| ("negative", [quote!(negative: &[S::Switch; #g]), quote!(negative)]));
        of_symbols.chain(switches).collect()
    }

    /// Inputs that the routine uses, and their slopes, at the time of this name.
    pub(super) fn input_bindings(&self, routine: &Routine, time: &str) -> TokenStream {
        let time = format_ident!("{time}");
        let input = |index: u32| identifier(&self.model.equations.inputs[index as usize].name.text);
        bindings(&[routine], &|symbol| match symbol {
            Symbol::Input(index) => {
                let (name, field) = (self.symbol_name(symbol), input(index));
                Some(quote!(let #name = self.inputs.#field.value(#time);))
            }
            Symbol::Slope(index) => {
                let (name, field) = (self.symbol_name(symbol), input(index));
                Some(quote!(let #name = self.inputs.#field.slope(#time);))
            }
            _ => None,
        })
    }

    /// States of the array `x` that the routine uses, in one pattern: rustc checks it faster than a place of `x` for
    /// each.
    pub(super) fn state_bindings(&self, routine: &Routine) -> Option<TokenStream> {
        let state = |symbol| if let Symbol::State(index) = symbol { Some(index) } else { None };
        let used: BTreeSet<u32> = symbols(&[routine]).into_iter().filter_map(state).collect();
        let behind = used.last()? + 1;
        let names = (0..behind).map(|index| {
            if used.contains(&index) { self.symbol_name(Symbol::State(index)) } else { format_ident!("_") }
        });
        let rest = ((behind as usize) < self.states.len()).then(|| quote!(, ..));
        Some(quote!(let [#(#names),* #rest] = *x;))
    }

    /// The name of a symbol that is a variable.
    fn symbol_name(&self, symbol: Symbol) -> Ident {
        let equations = &self.model.equations;
        let input = |index: u32| names::field(&equations.inputs[index as usize].name.text);
        match symbol {
            Symbol::Time => format_ident!("t"),
            Symbol::State(index) => self.states[index as usize].clone(),
            Symbol::Parameter(index) => {
                format_ident!("p_{}", names::field(&equations.parameters[index as usize].name.text))
            }
            Symbol::Input(index) => format_ident!("u_{}", input(index)),
            Symbol::Slope(index) => format_ident!("slope_{}", input(index)),
            Symbol::Kept(index) => format_ident!("kept_{index}"),
            Symbol::Side(index) => format_ident!("side_{index}"),
            _ => unreachable!("{symbol:?} is no variable"),
        }
    }

    /// The text of a symbol.
    fn symbol_text(&self, symbol: Symbol) -> String {
        match symbol {
            Symbol::Multiplier(_) => {
                let row = self.model.equations.solution.row(symbol).expect("a reaction that is solved for");
                entry("reactions", u32::try_from(row).expect("fewer than 2^32 reactions"))
            }
            Symbol::Law(_) | Symbol::Storage(_) | Symbol::Flow(_) | Symbol::Turned(_) | Symbol::Unsolved(_) => {
                unreachable!("a model's equations contain no {symbol:?}")
            }
            Symbol::Found(index) => entry("found", index),
            Symbol::Unknown(index) => entry("u", index),
            Symbol::Rate(index) => entry("r", index),
            Symbol::Weight(index) => entry("weights", index),
            _ => self.symbol_name(symbol).to_string(),
        }
    }

    /// Hands the text of what a routine refers to to `then`.
    pub(super) fn with_names<T>(&self, then: impl FnOnce(&Names) -> T) -> T {
        then(&Names {
            symbol: &|symbol| self.symbol_text(symbol),
            constant: &|index| entry("c", index),
            switch: &|index| entry("negative", index),
        })
    }
}

/// An entry of an array.
fn entry(array: &str, index: u32) -> String {
    format!("{array}[{index}]")
}

/// The states' names as identifiers: readable, different from each other and from the functions' own names.
pub(super) fn of_states(equations: &StateEquations) -> Vec<Ident> {
    // Words of the functions' bodies, of a series from `k` on; at the end constants and variants, which no `let` can
    // hide.
    const OWN: &str = "t x c q r u v y dx negative guards state projected entries slope k h rows series part table \
        inner at first_product next_product reactions kept sides found weights by_state by_constants DESCRIPTION Some \
        None Ok Err";
    let mut used: BTreeSet<String> = OWN.split_whitespace().map(str::to_owned).collect();
    for input in &equations.inputs {
        used.extend(["u", "slope"].map(|prefix| format!("{prefix}_{}", names::field(&input.name.text))));
    }
    let mut identifiers = Vec::new();
    for (index, state) in equations.states.iter().enumerate() {
        let letter = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
        let mut name: String = state.name.chars().map(letter).collect();
        let is_temporary =
            name.strip_prefix(['v', 'w', 'i', 'l', 'r']).is_some_and(|rest| rest.chars().all(|c| c.is_ascii_digit()));
        if is_temporary || syn::parse_str::<Ident>(&name).is_err() || !used.insert(name.clone()) {
            name = format!("state_{index}_{name}");
            used.insert(name.clone());
        }
        identifiers.push(identifier(&name));
    }
    identifiers
}
