//! The model type and its functions.
//!
//! In: equations and their programs. Out: a type that implements `bg_model::System` and `bg_model::Model`, generic over
//! the scalar; flat single assignments over fixed-size vectors.

mod required;
mod start;

use std::collections::BTreeSet;

use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

use super::items::{Given, identifier};
use super::routine::{Names, assignments, operand, statements};
use super::{description, elimination, pairs, series};
use crate::expr::Symbol;
use crate::pipeline::Compiled;
use crate::program::pairs::Paired;
use crate::program::{Assignment, Counts, Operand, Program, Programs, Routine, SecondOrderPrograms};
use crate::system::equations::StateEquations;

/// The items of one model: parameters, inputs, the type, its functions, its description.
#[must_use]
pub fn model(model: &Compiled) -> TokenStream {
    Emission { model, states: state_identifiers(&model.equations) }.items()
}

struct Emission<'a> {
    model: &'a Compiled,
    states: Vec<Ident>,
}

/// A table of what depends on parameters only.
struct Table<'a> {
    /// What the names of the table, of its pairs and of their functions begin with.
    prefix: &'static str,
    doc: &'static str,
    constants: &'a Routine,
    /// The routine that reads pairs of the table.
    paired: Option<&'a Paired>,
}

/// What a model has of its tables: fields of its type, their values, the functions that calculate them and the `let`s that call
/// these.
#[derive(Default)]
struct Tables {
    fields: TokenStream,
    values: TokenStream,
    functions: TokenStream,
    lets: TokenStream,
    has_pairs: bool,
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
        let graph = &self.model.derived.causal.graph;
        let given = Given {
            name: &graph.name.text,
            visibility: &graph.visibility,
            parameters: &self.model.equations.parameters,
            inputs: &graph.inputs,
        };
        let (name, scalar) = (identifier(given.name), given.scalar());
        let fields = given.fields();
        let costs = self.costs();
        let pattern = (&self.model.jacobian, &self.model.elimination);
        let doc = description::documentation(&graph.docs, &self.model.equations, pattern, &costs);
        let tables = self.constant_tables();
        let made = self.tables(&tables, &scalar);
        let table_fields = &made.fields;
        let definition = quote! {
            #[doc = #doc]
            #[derive(Clone, Debug)]
            pub struct #name<#scalar: ::bg_model::scalar::Scalar = ::core::primitive::f64> {
                #fields
                #table_fields
            }
        };
        given.items(&definition, &self.code(&costs, &made))
    }

    /// What the model's struct implements.
    fn code(&self, costs: &[(&str, Counts)], tables: &Tables) -> TokenStream {
        let expanded = self.model.derived.expanded.to_string();
        let reduction = self.model.reduction.as_ref().map(ToString::to_string).unwrap_or_default();
        let description = description::description(
            &description::Texts { expanded: &expanded, reduction: &reduction },
            &self.model.derived.causal,
            &self.model.equations,
            costs,
        );
        let (states, switches, outputs) = (
            self.model.equations.states.len(),
            self.model.equations.switches.len(),
            self.model.equations.outputs.len(),
        );
        let has_inputs = !self.model.derived.causal.graph.inputs.is_empty();
        let input_argument = has_inputs.then(|| quote!(, inputs: Inputs));
        let input_value = has_inputs.then(|| quote!(inputs,));
        let input_pass = has_inputs.then(|| quote!(, inputs));
        let starting = self.starting();
        let required = self.required();
        let system = self.system();
        let model = self.model();
        let Tables { values, functions, lets, has_pairs, .. } = tables;
        let import_pair = has_pairs.then(|| {
            quote!(
                use ::bg_model::scalar::Pair as _;
            )
        });
        quote! {
            use ::bg_model::scalar::Scalar;
            #import_pair
            use ::bg_model::nalgebra::SVector;

            const N: usize = #states;
            const G: usize = #switches;
            const M: usize = #outputs;
            static DESCRIPTION: ::std::sync::LazyLock<::bg_model::description::Description> =
                ::std::sync::LazyLock::new(|| {
                    let PARAMETERS = <Parameters as ::bg_model::parameters::Parameters>::table();
                    #description
                });

            impl Model {
                /// Number of states.
                pub const STATES: usize = N;
                /// Number of switches.
                pub const SWITCHES: usize = G;
                /// Number of scalar outputs.
                pub const OUTPUTS: usize = M;

                /// The model with these parameters, in `f64`.
                ///
                /// # Errors
                /// A parameter outside its range, a value that parameters give and that cannot be.
                pub fn new(parameters: Parameters #input_argument)
                    -> Result<Self, ::bg_model::parameters::ParameterError>
                {
                    Self::in_scalar(parameters #input_pass)
                }
            }

            impl<S: Scalar> Model<S> {
                /// The model with these parameters, calculating in `S`.
                ///
                /// # Errors
                /// A parameter outside its range, a value that parameters give and that cannot be.
                pub fn in_scalar(parameters: Parameters #input_argument)
                    -> Result<Self, ::bg_model::parameters::ParameterError>
                {
                    ::bg_model::parameters::Parameters::validate(&parameters)?;
                    #required
                    #lets
                    Ok(Self { parameters, #input_value #values })
                }

                /// The parameters.
                pub fn parameters(&self) -> &Parameters {
                    &self.parameters
                }

                #functions

                #starting
            }

            #system
            #model
        }
    }

    /// The functions of the running model with their operations.
    fn costs(&self) -> Vec<(&str, Counts)> {
        let routines = self.model.programs.costs();
        let factored = ("eliminate", self.model.elimination.factorisation_counts());
        let solved = ("substitute", self.model.elimination.substitution_counts());
        routines.chain([factored, solved]).collect()
    }

    /// The tables of constants, and of their pairs; `scalar` is what the model's struct calls it.
    fn tables(&self, tables: &[Table], scalar: &Ident) -> Tables {
        let mut made = Tables::default();
        for &Table { prefix, doc, constants, paired } in tables {
            let name = |suffix: &str| format_ident!("{prefix}{suffix}");
            let (field, table, pair_field) = (name("s"), name("_table"), name("_pairs"));
            let (count, body) = (constants.results.len(), self.constant_table(constants));
            made.fields.extend(quote!(#field: [#scalar; #count],));
            made.lets.extend(quote!(let #field = Self::#table(&parameters);));
            made.functions.extend(quote! {
                #[doc = #doc]
                fn #table(parameters: &Parameters) -> [S; #count] {
                    #body
                }
            });
            if let Some(paired) = paired {
                let (pairs, body) =
                    (paired.constants.len(), self.with_names(false, |names| pairs::constants(paired, names)));
                made.has_pairs = true;
                made.fields.extend(quote!(#pair_field: [#scalar::Pair; #pairs],));
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

    /// The tables of the running model.
    fn constant_tables(&self) -> Vec<Table<'_>> {
        let Programs { running, jacobian, second_order, holding, .. } = &self.model.programs;
        let table = |prefix, doc, constants, paired| Table { prefix, doc, constants, paired };
        let of_rates = " What depends on parameters only.";
        let of_jacobian = " What depends on parameters only, of the Jacobian.";
        let of_forces = " What depends on parameters only, of forces.";
        let of_holding = " What depends on parameters only, of held motions.";
        let mut tables = vec![
            table("constant", of_rates, &running.constants, running.paired_rate.as_ref()),
            table("slope_constant", of_jacobian, &jacobian.constants, None),
        ];
        tables.extend(holding.as_ref().map(|program| table("holding_constant", of_holding, &program.constants, None)));
        tables.extend(second_order.as_ref().map(|SecondOrderPrograms { constants, paired_forces, .. }| {
            table("second_constant", of_forces, constants, paired_forces.as_ref())
        }));
        tables
    }

    fn constant_table(&self, routine: &Routine) -> TokenStream {
        let parameters = self.parameter_bindings(&[routine]);
        let (statements, results) = self.body(routine);
        quote! { #parameters #statements [#(#results),*] }
    }

    /// Guesses, gaps, start state and what is asked of values, each with its constants inside.
    fn starting(&self) -> TokenStream {
        let unknowns = self.model.equations.guesses.len();
        let Programs { starting, required, .. } = &self.model.programs;
        let functions = starting.programs().into_iter().chain(required.iter().flatten()).map(|program| {
            let [routine] = &program.routines;
            let function = identifier(&routine.name);
            let constants = self.own_constants(program);
            let (statements, results) = self.body(routine);
            let length = results.len();
            quote! {
                fn #function(parameters: &Parameters, u: &[S; #unknowns]) -> [S; #length] {
                    #constants
                    #statements
                    [#(#results),*]
                }
            }
        });
        quote! { #(#functions)* }
    }

    /// `let c`: the constants of a program that is evaluated by itself, from `parameters`; before it the parameters it reads.
    fn own_constants(&self, program: &Program<1>) -> TokenStream {
        let [routine] = &program.routines;
        let parameters = self.parameter_bindings(&[&program.constants, routine]);
        let (constants, table) = self.body(&program.constants);
        let entries = table.len();
        quote! {
            #parameters
            let c: [S; #entries] = { #constants [#(#table),*] };
        }
    }

    fn parameter_bindings(&self, routines: &[&Routine]) -> TokenStream {
        bindings(routines, &|symbol| match symbol {
            Symbol::Parameter(index) => {
                let field = identifier(&self.model.equations.parameters[index as usize].name.text);
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
                let field = identifier(&self.model.equations.inputs[index as usize].name.text);
                Some(quote!(let #name = self.inputs.#field.value(t);))
            }
            Symbol::Slope(index) => {
                let field = identifier(&self.model.equations.inputs[index as usize].name.text);
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
                format_ident!("p_{}", self.model.equations.parameters[index as usize].name.text)
            }
            Symbol::Input(index) => format_ident!("u_{}", self.model.equations.inputs[index as usize].name.text),
            Symbol::Unknown(index) => {
                let index = Literal::usize_unsuffixed(index as usize);
                return quote!(u[#index]);
            }
            Symbol::Law(_) | Symbol::Storage(_) | Symbol::Flow(_) | Symbol::Multiplier(_) | Symbol::Loop => {
                unreachable!("a model's equations contain no {symbol:?}")
            }
            Symbol::Slope(index) => format_ident!("slope_{}", self.model.equations.inputs[index as usize].name.text),
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
    fn function(&self, routine: &Routine) -> (TokenStream, Vec<TokenStream>) {
        self.running(routine, &format_ident!("constants"))
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
        let running = &self.model.programs.running;
        let (rate, rates) = self.with_pairs(&running.rate, running.paired_rate.as_ref(), "constant");
        let (guard, guards) = self.function(&running.guards);
        let (project, projected) = self.function(&running.project);
        let indices = self.model.equations.projections.iter().map(|&(index, _)| Literal::usize_unsuffixed(index));
        let inline = running.is_inlined().then(|| quote!(#[cfg_attr(not(debug_assertions), inline(always))]));
        let (parts, linear) = self.linear();
        let (second, series, holding) = (self.second(&inline), self.series(), self.holding());
        let (switch_name, not_finite) = (self.switch_name(), self.not_finite());
        let parts = (!parts.is_empty()).then(|| quote!(impl<S: Scalar> Model<S> { #parts }));
        quote! {
            #parts
            impl<S: Scalar> ::bg_model::system::System<S, N, G> for Model<S> {
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
                #switch_name
                #not_finite
                #linear
                #second
                #series
                #holding
            }
        }
    }

    /// What switches are called.
    fn switch_name(&self) -> Option<TokenStream> {
        (!self.model.equations.switches.is_empty()).then(|| {
            quote! {
                fn switch_name(&self, index: usize) -> Option<&'static str> {
                    DESCRIPTION.switches.get(index).map(|switch| switch.name)
                }
            }
        })
    }

    /// Which input or law is the first whose value is not finite; nothing where none can be.
    fn not_finite(&self) -> Option<TokenStream> {
        let program = &self.model.programs.not_finite;
        let [routine] = &program.routines;
        let (fallible, inputs) = (&self.model.equations.fallible, &self.model.equations.inputs);
        if fallible.is_empty() && inputs.is_empty() {
            return None;
        }
        let inputs = inputs.iter().map(|input| {
            let (field, name) = (identifier(&input.name.text), &input.name.text);
            quote!(("input", #name, self.inputs.#field.value(t)))
        });
        let constants = self.own_constants(program);
        let bindings = self.dynamic_bindings(routine);
        let (statements, values) = self.body(routine);
        let laws = fallible.iter().zip(values).map(|(law, value)| {
            let (kind, element) = (law.kind, &law.element);
            quote!((#kind, #element, #value))
        });
        Some(quote! {
            #[cold]
            fn not_finite(&self, t: S, x: &SVector<S, N>, negative: &[bool; G]) -> Option<::bg_model::failure::Origin> {
                let parameters = &self.parameters;
                #constants
                let [x] = &x.data.0;
                #bindings
                #statements
                ::bg_model::failure::Origin::first(&[#(#inputs,)* #(#laws,)*])
            }
        })
    }

    /// The states of second order and their second derivatives.
    fn second(&self, inline: &Option<TokenStream>) -> TokenStream {
        let Some(programs) = &self.model.programs.second_order else { return TokenStream::new() };
        let (body, derivatives) = self.running(&programs.second_derivatives, &format_ident!("second_constants"));
        let states = &self.model.second_order.states;
        let [first, behind] = [states.start, states.end].map(Literal::usize_unsuffixed);
        let indices = states.clone().map(Literal::usize_unsuffixed);
        let forces = programs.forces.as_ref().map(|routine| {
            let (body, forces) = self.with_pairs(routine, programs.paired_forces.as_ref(), "second_constant");
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
        let routine = &self.model.programs.running.rate;
        let reading = |is_state: bool| {
            let reads = |symbol: Symbol| matches!(symbol, Symbol::State(_)) == is_state;
            bindings(&[routine], &|symbol| if reads(symbol) { self.dynamic_binding(symbol) } else { None })
        };
        let fields: Vec<_> = self.model.equations.inputs.iter().map(|input| identifier(&input.name.text)).collect();
        let reads = series::Reads { inputs: &fields, values: reading(false), states: reading(true) };
        self.with_names(routine.is_long(), |names| series::functions(routine, names, &reads))
    }

    /// The Jacobian with its sparsity, and the elimination along it; before them the parts of a long Jacobian.
    fn linear(&self) -> (TokenStream, TokenStream) {
        let places = self.model.jacobian.entries.iter().map(|entry| {
            let (row, column) = (Literal::usize_unsuffixed(entry.row), Literal::usize_unsuffixed(entry.column));
            quote!((#row, #column))
        });
        let (count, slots) = (self.model.jacobian.entries.len(), self.model.elimination.slots);
        let [routine] = &self.model.programs.jacobian.routines;
        let constants = format_ident!("slope_constants");
        let (parts, derivative, derivatives) = if routine.is_long() {
            self.in_parts(routine, &constants)
        } else {
            let (derivative, derivatives) = self.running(routine, &constants);
            (TokenStream::new(), derivative, derivatives)
        };
        let (entries, slopes) = derivatives.split_at(count);
        let (factorisation, substitution) =
            (elimination::factorisation(&self.model.elimination), elimination::substitution(&self.model.elimination));
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
        let running = &self.model.programs.running;
        let (output, outputs) = self.function(&running.outputs);
        let (energy, stored) = self.function(&running.stored_energy);
        let (power, powers) = self.function(&running.powers);
        let (supplied, dissipated) = (&powers[0], &powers[1]);
        let (start, started) = self.start();
        quote! {
            #started
            impl<S: Scalar> ::bg_model::system::Model<S, N, G, M> for Model<S> {
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
    // Words of the functions' bodies, of a series from `k` on; at the end constants and variants, which no `let` can hide.
    const OWN: &str = "t x c q r u v y dx negative guards state projected entries slope k h rows series part table inner a b \
        N G M DESCRIPTION Some None Ok Err";
    let mut used: BTreeSet<String> = OWN.split_whitespace().map(str::to_owned).collect();
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
