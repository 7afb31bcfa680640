//! The model type and its functions.
//!
//! In: equations and their programs. Out: a type that implements `bg_model::System` and `bg_model::Model`, generic over
//! the scalar; flat single assignments over fixed-size vectors.

mod start;

use std::collections::BTreeSet;

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::items::{Given, identifier};
use super::programs::{Programs, SecondOrder, Table};
use super::routine::{Names, assignments, operand, statements};
use super::{description, elimination, pairs, series};
use crate::causality::CausalGraph;
use crate::elimination::Elimination;
use crate::equations::StateEquations;
use crate::expr::Symbol;
use crate::jacobian::Jacobian;
use crate::pairs::Paired;
use crate::program::{Assignment, Counts, Operand, Program, Routine};
use crate::reduce::Report;
use crate::second::Second;

/// What a model is made from.
pub struct Parts<'a> {
    /// The graph in bond-graph words as text.
    pub expanded: &'a str,
    /// The graph with its strokes.
    pub causal: &'a CausalGraph,
    /// Its equations.
    pub equations: &'a mut StateEquations,
    /// What a scene left out of it.
    pub report: Option<&'a Report>,
    /// The derivatives of its rates.
    pub jacobian: &'a mut Jacobian,
    /// Its states of second order.
    pub second: &'a mut Second,
    /// How I - c J is factored and solved.
    pub elimination: &'a Elimination,
}

/// The items of one model: parameters, inputs, the type, its functions, its description.
pub fn model(parts: Parts) -> TokenStream {
    let Parts { expanded, causal, equations, report, jacobian, second, elimination } = parts;
    let programs = Programs::new(equations, jacobian, second);
    let reduction = report.map(ToString::to_string).unwrap_or_default();
    let (equations, jacobian, second): (&StateEquations, &Jacobian, &Second) = (equations, jacobian, second);
    let states = state_identifiers(equations);
    Emission { expanded, causal, equations, reduction, jacobian, second, elimination, programs, states }.items()
}

struct Emission<'a> {
    expanded: &'a str,
    causal: &'a CausalGraph,
    equations: &'a StateEquations,
    reduction: String,
    jacobian: &'a Jacobian,
    second: &'a Second,
    elimination: &'a Elimination,
    programs: Programs,
    states: Vec<Ident>,
}

/// What a model has of its tables: fields of its type, their values, the functions that calculate them and the `let`s that call
/// these.
#[derive(Default)]
struct Tables {
    fields: TokenStream,
    values: TokenStream,
    functions: TokenStream,
    lets: TokenStream,
}

/// `let name = value;` for the symbols that some routines use.
fn bindings(routines: &[&Routine], binding: &dyn Fn(Symbol) -> Option<TokenStream>) -> TokenStream {
    let operands = routines.iter().flat_map(|routine| {
        let inside = routine.assignments.iter().flat_map(|assignment| assignment.operation.operands());
        inside.chain(routine.results.iter().copied())
    });
    let used: BTreeSet<Symbol> = operands
        .filter_map(|operand| if let Operand::Symbol(symbol) = operand { Some(symbol) } else { None })
        .collect();
    used.into_iter().filter_map(binding).collect()
}

impl Emission<'_> {
    fn items(&self) -> TokenStream {
        let graph = &self.causal.graph;
        let given = Given {
            name: &graph.name.text,
            visibility: &graph.visibility,
            parameters: &self.equations.parameters,
            inputs: &graph.inputs,
        };
        let structs = given.structs();
        let (name, visibility) = (&identifier(&graph.name.text), &graph.visibility);
        let (parameters, inputs) = (&given.parameters_name(), &given.inputs_name());
        let costs = self.costs();
        let pattern = (self.jacobian, self.elimination);
        let doc = description::documentation(&graph.docs, self.equations, pattern, &costs);
        let description = description::description(
            &description::Texts { expanded: self.expanded, reduction: &self.reduction },
            self.causal,
            self.equations,
            &costs,
        );
        let (states, switches, outputs) =
            (self.equations.states.len(), self.equations.switches.len(), self.equations.outputs.len());
        let has_inputs = !graph.inputs.is_empty();
        let input_field = has_inputs.then(|| quote!(inputs: #inputs,));
        let input_argument = has_inputs.then(|| quote!(, inputs: #inputs));
        let input_value = has_inputs.then(|| quote!(inputs,));
        let input_pass = has_inputs.then(|| quote!(, inputs));
        let starting = self.starting();
        let system = self.system();
        let model = self.model();
        let tables = self.programs.tables();
        let import_pair = tables.iter().any(|table| table.paired.is_some()).then(|| {
            quote!(
                use ::bg_model::scalar::Pair as _;
            )
        });
        let Tables { fields, values, functions, lets } = self.tables(&tables, parameters);
        quote! {
            #structs

            #[doc = #doc]
            #[derive(Clone, Debug)]
            #visibility struct #name<S: ::bg_model::scalar::Scalar = f64> {
                parameters: #parameters,
                #input_field
                #fields
            }

            #[allow(missing_docs, clippy::all, clippy::pedantic)]
            const _: () = {
                use ::bg_model::scalar::Scalar;
                #import_pair
                use ::bg_model::nalgebra::SVector;

                const N: usize = #states;
                const G: usize = #switches;
                const M: usize = #outputs;
                static DESCRIPTION: ::std::sync::LazyLock<::bg_model::description::Description> =
                    ::std::sync::LazyLock::new(|| {
                        let PARAMETERS = <#parameters as ::bg_model::parameters::Parameters>::table();
                        #description
                    });

                impl #name {
                    /// Number of states.
                    pub const STATES: usize = N;
                    /// Number of switches.
                    pub const SWITCHES: usize = G;
                    /// Number of scalar outputs.
                    pub const OUTPUTS: usize = M;

                    /// The model with these parameters, in `f64`.
                    ///
                    /// # Errors
                    /// A parameter outside its range.
                    pub fn new(parameters: #parameters #input_argument)
                        -> Result<Self, ::bg_model::parameters::ParameterError>
                    {
                        Self::in_scalar(parameters #input_pass)
                    }
                }

                impl<S: Scalar> #name<S> {
                    /// The model with these parameters, calculating in `S`.
                    ///
                    /// # Errors
                    /// A parameter outside its range.
                    pub fn in_scalar(parameters: #parameters #input_argument)
                        -> Result<Self, ::bg_model::parameters::ParameterError>
                    {
                        ::bg_model::parameters::Parameters::validate(&parameters)?;
                        #lets
                        Ok(Self { parameters, #input_value #values })
                    }

                    /// The parameters.
                    pub fn parameters(&self) -> &#parameters {
                        &self.parameters
                    }

                    #functions

                    #starting
                }

                #system
                #model
            };
        }
    }

    /// The functions of the running model with their operations.
    fn costs(&self) -> Vec<(&str, Counts)> {
        let routines = self.programs.routines().map(|routine| (routine.name.as_str(), routine.counts));
        let factored = ("eliminate", self.elimination.factorisation_counts());
        let solved = ("substitute", self.elimination.substitution_counts());
        routines.chain([factored, solved]).collect()
    }

    /// The tables of constants, and of their pairs.
    fn tables(&self, tables: &[Table], parameters: &Ident) -> Tables {
        let mut made = Tables::default();
        for &Table { prefix, doc, program, paired } in tables {
            let name = |suffix: &str| format_ident!("{prefix}{suffix}");
            let (field, table, pair_field) = (name("s"), name("_table"), name("_pairs"));
            let (count, body) = (program.constants.results.len(), self.constant_table(program));
            made.fields.extend(quote!(#field: [S; #count],));
            made.lets.extend(quote!(let #field = Self::#table(&parameters);));
            made.functions.extend(quote! {
                #[doc = #doc]
                fn #table(parameters: &#parameters) -> [S; #count] {
                    #body
                }
            });
            if let Some(paired) = paired {
                let (pairs, body) =
                    (paired.constants.len(), self.with_names(false, |names| pairs::constants(paired, names)));
                made.fields.extend(quote!(#pair_field: [S::Pair; #pairs],));
                made.values.extend(quote!(#pair_field: Self::#pair_field(&#field),));
                made.functions.extend(quote! {
                    /// Pairs of them.
                    fn #pair_field(c: &[S; #count]) -> [S::Pair; #pairs] {
                        #body
                    }
                });
            }
            made.values.extend(quote!(#field,));
        }
        made
    }

    fn constant_table(&self, program: &Program) -> TokenStream {
        let routine = &program.constants;
        let parameters = self.parameter_bindings(&[routine]);
        let (statements, results) = self.body(routine);
        quote! { #parameters #statements [#(#results),*] }
    }

    /// Guesses, gaps and start state, each with its constants inside.
    fn starting(&self) -> TokenStream {
        let name = identifier(&format!("{}Parameters", self.causal.graph.name.text));
        let unknowns = self.equations.guesses.len();
        let functions = self.programs.starting.iter().map(|program| {
            let routine = &program.routines[0];
            let function = identifier(&routine.name);
            let parameters = self.parameter_bindings(&[&program.constants, routine]);
            let (constants, table) = self.body(&program.constants);
            let (statements, results) = self.body(routine);
            let length = results.len();
            let entries = table.len();
            quote! {
                fn #function(parameters: &#name, u: &[S; #unknowns]) -> [S; #length] {
                    #parameters
                    let c: [S; #entries] = { #constants [#(#table),*] };
                    #statements
                    [#(#results),*]
                }
            }
        });
        quote! { #(#functions)* }
    }

    fn parameter_bindings(&self, routines: &[&Routine]) -> TokenStream {
        bindings(routines, &|symbol| match symbol {
            Symbol::Parameter(index) => {
                let field = identifier(&self.equations.parameters[index as usize].name.text);
                let name = self.symbol_name(symbol);
                Some(quote!(let #name = S::from_f64(parameters.#field);))
            }
            _ => None,
        })
    }

    /// Inputs, their slopes and states that the routine uses.
    fn dynamic_bindings(&self, routine: &Routine) -> TokenStream {
        bindings(&[routine], &|symbol| self.dynamic_binding(symbol))
    }

    /// An input at time `t`, its slope there, or a state of `x`.
    fn dynamic_binding(&self, symbol: Symbol) -> Option<TokenStream> {
        let name = self.symbol_name(symbol);
        match symbol {
            Symbol::State(index) => {
                let index = Literal::usize_unsuffixed(index as usize);
                Some(quote!(let #name = x[#index];))
            }
            Symbol::Input(index) => {
                let field = identifier(&self.equations.inputs[index as usize].name.text);
                Some(quote!(let #name = self.inputs.#field.value(t);))
            }
            Symbol::Slope(index) => {
                let field = identifier(&self.equations.inputs[index as usize].name.text);
                Some(quote!(let #name = self.inputs.#field.slope(t);))
            }
            _ => None,
        }
    }

    fn symbol_name(&self, symbol: Symbol) -> TokenStream {
        let ident = match symbol {
            Symbol::Time => format_ident!("t"),
            Symbol::State(index) => self.states[index as usize].clone(),
            Symbol::Parameter(index) => {
                format_ident!("p_{}", self.equations.parameters[index as usize].name.text)
            }
            Symbol::Input(index) => format_ident!("u_{}", self.equations.inputs[index as usize].name.text),
            Symbol::Unknown(index) => {
                let index = Literal::usize_unsuffixed(index as usize);
                return quote!(u[#index]);
            }
            Symbol::Atom(index) => format_ident!("atom_{index}"),
            Symbol::Slope(index) => format_ident!("slope_{}", self.equations.inputs[index as usize].name.text),
            Symbol::Rate(index) => {
                let index = Literal::usize_unsuffixed(index as usize);
                return quote!(r[#index]);
            }
        };
        quote!(#ident)
    }

    fn body(&self, routine: &Routine) -> (TokenStream, Vec<TokenStream>) {
        self.with_names(routine.is_long(), |names| {
            let results = routine.results.iter().map(|result| operand(result, names)).collect();
            (statements(routine, names), results)
        })
    }

    /// Hands the tokens of what a routine refers to to `then`.
    fn with_names<T>(&self, is_long: bool, then: impl FnOnce(&Names) -> T) -> T {
        then(&Names {
            symbol: &|symbol| self.symbol_name(symbol),
            constant: &|index| {
                let index = Literal::usize_unsuffixed(index as usize);
                quote!(c[#index])
            },
            switch: &|index| {
                let index = Literal::usize_unsuffixed(index as usize);
                quote!(negative[#index])
            },
            is_long,
        })
    }

    /// A long routine of the running model in parts, each a function of its own: the hacksaw's crate then builds in 52 s
    /// instead of 65 s. Gives the functions, the body that calls them, and the results.
    fn in_parts(&self, routine: &Routine, constants: &Ident) -> (TokenStream, TokenStream, Vec<TokenStream>) {
        const PART: usize = 1000;
        let count = routine.assignments.len();
        let alone = |assignments: &[Assignment], results: &[Operand]| Routine {
            assignments: assignments.to_vec(),
            results: results.to_vec(),
            ..routine.clone()
        };
        let (mut functions, mut calls) = (TokenStream::new(), TokenStream::new());
        for (index, part) in routine.assignments.chunks(PART).enumerate() {
            let name = format_ident!("{}_part_{index}", routine.name);
            let bindings = self.dynamic_bindings(&alone(part, &[]));
            let statements = self.with_names(true, |names| assignments(part, names));
            functions.extend(quote! {
                #[inline(never)]
                fn #name(&self, t: S, x: &[S; N], negative: &[bool; G], v: &mut [S; #count]) {
                    let c = &self.#constants;
                    #bindings
                    #statements
                }
            });
            calls.extend(quote!(self.#name(t, x, negative, &mut v);));
        }
        let bindings = self.dynamic_bindings(&alone(&[], &routine.results));
        let results =
            self.with_names(true, |names| routine.results.iter().map(|result| operand(result, names)).collect());
        let body = quote! {
            let c = &self.#constants;
            let [x] = &x.data.0;
            let mut v = [S::from_f64(0.0); #count];
            #calls
            #bindings
        };
        (functions, body, results)
    }

    /// The statements of a function of the running model, and its results.
    fn function(&self, index: usize) -> (TokenStream, Vec<TokenStream>) {
        self.running(&self.programs.dynamic.routines[index], &format_ident!("constants"))
    }

    /// The statements of a routine that reads states and this table of constants, and its results.
    fn running(&self, routine: &Routine, constants: &Ident) -> (TokenStream, Vec<TokenStream>) {
        let bindings = self.dynamic_bindings(routine);
        let (statements, results) = self.body(routine);
        let body = quote! {
            let c = &self.#constants;
            let [x] = &x.data.0;
            #bindings
            #statements
        };
        (body, results)
    }

    /// The statements of a routine that may have pairs, and its results.
    fn with_pairs(&self, routine: &Routine, paired: Option<&Paired>, prefix: &str) -> (TokenStream, Vec<TokenStream>) {
        let (constants, constant_pairs) = (format_ident!("{prefix}s"), format_ident!("{prefix}_pairs"));
        let Some(paired) = paired else { return self.running(routine, &constants) };
        let bindings = self.dynamic_bindings(routine);
        self.with_names(false, |names| {
            let statements = pairs::statements(paired, names);
            let body = quote! {
                let (c, q) = (&self.#constants, &self.#constant_pairs);
                let [x] = &x.data.0;
                #bindings
                #statements
            };
            (body, paired.results.iter().map(|result| pairs::half(result, names)).collect())
        })
    }

    fn system(&self) -> TokenStream {
        let name = identifier(&self.causal.graph.name.text);
        let (rate, rates) =
            self.with_pairs(&self.programs.dynamic.routines[0], self.programs.paired.as_ref(), "constant");
        let (guard, guards) = self.function(1);
        let (project, projected) = self.function(3);
        let indices = self.equations.projections.iter().map(|&(index, _)| Literal::usize_unsuffixed(index));
        let inline = self.programs.is_inlined().then(|| quote!(#[cfg_attr(not(debug_assertions), inline(always))]));
        let (parts, linear) = self.linear();
        let (second, series, holding) = (self.second(&inline), self.series(), self.holding());
        let parts = (!parts.is_empty()).then(|| quote!(#[allow(unused_variables)] impl<S: Scalar> #name<S> { #parts }));
        quote! {
            #parts
            #[allow(unused_variables)]
            impl<S: Scalar> ::bg_model::system::System<S, N, G> for #name<S> {
                #inline
                fn rate(&self, t: S, x: &SVector<S, N>, negative: &[bool; G], dx: &mut SVector<S, N>) {
                    #rate
                    dx.data.0 = [[#(#rates),*]];
                }
                #[inline(always)]
                fn guards(&self, t: S, x: &SVector<S, N>, negative: &[bool; G], guards: &mut SVector<S, G>) {
                    #guard
                    guards.data.0 = [[#(#guards),*]];
                }
                fn project(&self, state: &mut SVector<S, N>) {
                    let x = &*state;
                    #project
                    let [projected] = &mut state.data.0;
                    #(projected[#indices] = #projected;)*
                }
                fn state_name(&self, index: usize) -> &'static str {
                    DESCRIPTION.states.get(index).map_or("state", |state| state.name)
                }
                #linear
                #second
                #series
                #holding
            }
        }
    }

    /// The states of second order and their second derivatives.
    fn second(&self, inline: &Option<TokenStream>) -> TokenStream {
        let Some(SecondOrder { program, paired }) = &self.programs.second else { return TokenStream::new() };
        let (body, derivatives) = self.running(&program.routines[0], &format_ident!("second_constants"));
        let states = &self.second.states;
        let [first, behind] = [states.start, states.end].map(Literal::usize_unsuffixed);
        let indices = states.clone().map(Literal::usize_unsuffixed);
        let forces = program.routines.get(1).map(|routine| {
            let (body, forces) = self.with_pairs(routine, paired.as_ref(), "second_constant");
            quote! {
                #inline
                fn forces(&self, t: S, x: &SVector<S, N>, negative: &[bool; G], dx: &mut SVector<S, N>) {
                    #body
                    dx.data.0 = [[#(#forces),*]];
                }
            }
        });
        quote! {
            #[inline(always)]
            fn second_order(&self) -> ::core::ops::Range<usize> {
                #first..#behind
            }
            fn second_derivatives(&self, x: &SVector<S, N>, dx: &mut SVector<S, N>) {
                let [r] = dx.data.0;
                #body
                let [dx] = &mut dx.data.0;
                #(dx[#indices] = #derivatives;)*
            }
            #forces
        }
    }

    /// The Taylor series of the states.
    fn series(&self) -> TokenStream {
        let routine = &self.programs.dynamic.routines[0];
        let reading = |is_state: bool| {
            let reads = |symbol: Symbol| matches!(symbol, Symbol::State(_)) == is_state;
            bindings(&[routine], &|symbol| if reads(symbol) { self.dynamic_binding(symbol) } else { None })
        };
        let fields: Vec<_> = self.equations.inputs.iter().map(|input| identifier(&input.name.text)).collect();
        let reads = series::Reads { inputs: &fields, values: reading(false), states: reading(true) };
        self.with_names(routine.is_long(), |names| series::functions(routine, names, &reads))
    }

    /// The Jacobian with its sparsity, and the elimination along it; before them the parts of a long Jacobian.
    fn linear(&self) -> (TokenStream, TokenStream) {
        let places = self.jacobian.entries.iter().map(|entry| {
            let (row, column) = (Literal::usize_unsuffixed(entry.row), Literal::usize_unsuffixed(entry.column));
            quote!((#row, #column))
        });
        let (count, slots) = (self.jacobian.entries.len(), self.elimination.slots);
        let routine = &self.programs.jacobian.routines[0];
        let constants = format_ident!("slope_constants");
        let (parts, derivative, derivatives) = if routine.is_long() {
            self.in_parts(routine, &constants)
        } else {
            let (derivative, derivatives) = self.running(routine, &constants);
            (TokenStream::new(), derivative, derivatives)
        };
        let (entries, slopes) = derivatives.split_at(count);
        let (factorisation, substitution) =
            (elimination::factorisation(self.elimination), elimination::substitution(self.elimination));
        let functions = quote! {
            fn sparsity(&self) -> ::bg_model::linear::Sparsity {
                static ENTRIES: [(u16, u16); #count] = [#(#places),*];
                ::bg_model::linear::Sparsity::Places { entries: &ENTRIES, factors: #slots }
            }
            #[inline(never)]
            fn jacobian(
                &self, t: S, x: &SVector<S, N>, negative: &[bool; G], entries: &mut [S], slope: &mut SVector<S, N>,
            ) {
                let entries: &mut [S; #count] = entries.try_into().expect("one entry for each place");
                #derivative
                *entries = [#(#entries),*];
                slope.data.0 = [[#(#slopes),*]];
            }
            #[inline(never)]
            fn eliminate<F: ::bg_model::linear::Field<S>>(&self, c: F, entries: &[S], factors: &mut [F]) -> bool {
                let entries: &[S; #count] = entries.try_into().expect("one entry for each place");
                let factors: &mut [F; #slots] = factors.try_into().expect("as many factors as the sparsity says");
                #factorisation
            }
            #[inline(never)]
            fn substitute<F: ::bg_model::linear::Field<S>>(&self, factors: &[F], b: &mut [F; N]) {
                let factors: &[F; #slots] = factors.try_into().expect("as many factors as the sparsity says");
                #substitution
            }
        };
        (parts, functions)
    }

    fn model(&self) -> TokenStream {
        let name = identifier(&self.causal.graph.name.text);
        let (output, outputs) = self.function(2);
        let (energy, stored) = self.function(4);
        let (power, powers) = self.function(5);
        let (supplied, dissipated) = (&powers[0], &powers[1]);
        let (start, started) = self.start();
        quote! {
            #started
            #[allow(unused_variables)]
            impl<S: Scalar> ::bg_model::system::Model<S, N, G, M> for #name<S> {
                fn description(&self) -> &'static ::bg_model::description::Description {
                    &DESCRIPTION
                }
                #start
                fn outputs(&self, t: S, x: &SVector<S, N>, negative: &[bool; G], y: &mut SVector<S, M>) {
                    #output
                    y.data.0 = [[#(#outputs),*]];
                }
                fn stored_energy(&self, t: S, x: &SVector<S, N>, negative: &[bool; G]) -> S {
                    #energy
                    #(#stored)*
                }
                fn powers(&self, t: S, x: &SVector<S, N>, negative: &[bool; G]) -> ::bg_model::system::Powers<S> {
                    #power
                    ::bg_model::system::Powers { supplied: #supplied, dissipated: #dissipated }
                }
            }
        }
    }
}

/// The states' names as identifiers: readable, different from each other and from the functions' own names.
fn state_identifiers(equations: &StateEquations) -> Vec<Ident> {
    // Words of the functions' bodies; of a series from `k` on.
    const OWN: &str =
        "t x c q r u v y dx negative guards state projected entries slope k h rows series part table inner a b";
    let mut used: BTreeSet<String> = OWN.split(' ').map(str::to_owned).collect();
    for input in &equations.inputs {
        used.extend(["u", "slope"].map(|prefix| format!("{prefix}_{}", input.name.text)));
    }
    let mut identifiers = Vec::new();
    for (index, state) in equations.states.iter().enumerate() {
        let letter = |c: char| if c.is_ascii_alphanumeric() { c } else { '_' };
        let mut name: String = state.name.chars().map(letter).collect();
        let is_temporary = name.strip_prefix(['v', 'w']).is_some_and(|rest| rest.chars().all(|c| c.is_ascii_digit()));
        if is_temporary || syn::parse_str::<Ident>(&name).is_err() || !used.insert(name.clone()) {
            name = format!("state_{index}_{name}");
            used.insert(name.clone());
        }
        identifiers.push(identifier(&name));
    }
    identifiers
}
