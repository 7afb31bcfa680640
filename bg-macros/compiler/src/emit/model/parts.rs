//! Long routines in parts: their blocks, each a function of its own.
//!
//! In: the routines of the running model that are long. Out: the functions of their blocks and loops, and the calls
//! that stand in the routine's place. rustc checks a function of fifty thousand assignments five times as long as fifty
//! of a thousand.

use proc_macro2::{Ident, TokenStream};
use quote::{format_ident, quote};

use super::super::blocks::{Blocks, Group};
use super::super::routine::{assignments, parsed, parsed_each};
use super::{Emission, names};
use crate::program::{Assignment, Operand, Reversed, Routine};

impl Emission<'_> {
    /// The functions of the parts of all long routines that [`Self::running`] calls.
    pub(super) fn parts(&self) -> Option<TokenStream> {
        let programs = &self.model.programs;
        let running = &programs.running;
        // The equations of iterations are written out where their unknowns are found.
        let functions = running.routines().into_iter().filter(|routine| !std::ptr::eq(*routine, &running.loops));
        let sweeps = programs.reversed().into_iter().flat_map(Reversed::sweeps).map(|sweep| &sweep.routine);
        let second_order = programs.second_order.iter().flat_map(|second| second.routines());
        let tables: [(&str, Vec<&Routine>); 7] = [
            ("constants", functions.chain(sweeps).collect()),
            ("slope_constants", programs.derivatives.jacobian.routines.iter().collect()),
            ("damping_constants", programs.derivatives.damping.iter().flat_map(|program| &program.routines).collect()),
            ("second_constants", second_order.collect()),
            ("holding_constants", programs.holding.iter().flat_map(|program| &program.routines).collect()),
            ("size_constants", programs.sizes.routines.iter().collect()),
            ("impact_constants", programs.impacts.iter().flat_map(|program| &program.routines).collect()),
        ];
        let long = tables.iter().flat_map(|(constants, routines)| {
            let constants = format_ident!("{constants}");
            let long = routines.iter().filter(|routine| routine.is_long() && !self.is_table_alone(routine));
            long.map(move |routine| self.functions(routine, &constants))
        });
        let functions: TokenStream = long.collect();
        (!functions.is_empty()).then(|| quote!(impl<S: Scalar> Model<S> { #functions }))
    }

    fn functions(&self, routine: &Routine, constants: &Ident) -> TokenStream {
        let n = &self.shape.n;
        let (groups, blocks) = blocks(routine);
        let array_type = blocks.array_type();
        let declared: Vec<_> = self.arguments(routine).into_values().map(|[declared, _]| declared).collect();
        let functions = groups.iter().enumerate().map(|(index, group)| {
            let (name, part) = (name(routine, index), blocks.part(group));
            let read = alone(routine, &part.assignments, &[]);
            let (inputs, states) = (self.input_bindings(&read, "t"), self.state_bindings(&read));
            let block = self.with_names(|names| parsed(&part.code(&assignments(&part.assignments, names))));
            quote! {
                #[inline(never)]
                fn #name(&self, x: &[S; #n], #(#declared,)* v: &mut #array_type) {
                    let c = &self.#constants;
                    #inputs
                    #states
                    #block
                }
            }
        });
        functions.collect()
    }

    /// The statements and results of a long routine: calls of its parts.
    pub(super) fn in_parts(&self, routine: &Routine) -> (TokenStream, Vec<TokenStream>) {
        let (groups, blocks) = blocks(routine);
        let array = blocks.array();
        let handed: Vec<_> = self.arguments(routine).into_values().map(|[_, handed]| handed).collect();
        let (found, read) = (names::found(routine), alone(routine, &[], &routine.results));
        let (inputs, states) = (self.input_bindings(&read, "t"), self.state_bindings(&read));
        let calls = (0..groups.len()).map(|index| {
            let name = name(routine, index);
            quote!(self.#name(x, #(#handed,)* v);)
        });
        let statements = quote!(#array #found #(#calls)* #inputs #states);
        let results =
            self.with_names(|names| parsed_each(routine.results.iter().map(|result| blocks.result(result, names))));
        (statements, results)
    }
}

/// The function of a part.
fn name(routine: &Routine, index: usize) -> Ident {
    format_ident!("{}_part_{index}", routine.name)
}

/// The assignments of the parts, and what these hand on.
fn blocks(routine: &Routine) -> (Vec<Group<'_>>, Blocks) {
    let groups = Group::of(&routine.assignments, &|_| false);
    let blocks = Blocks::of(&groups, &routine.results);
    (groups, blocks)
}

/// The routine with these assignments and results only.
pub(super) fn alone(routine: &Routine, assignments: &[Assignment], results: &[Operand]) -> Routine {
    let Routine { name, counts, .. } = routine;
    Routine { name: name.clone(), assignments: assignments.to_vec(), results: results.to_vec(), counts: *counts }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;
    use std::fmt::Write;

    use crate::source::syntax;
    use crate::{emit, pipeline};

    /// Eight bodies on hinges with stops, whose impacts and reactions are tables alone.
    fn arm() -> String {
        let mut text = "graph G { gravity [0, 0, -9.81]; ground { point O = [0, 0, 0]; } ".to_owned();
        for k in 0..8 {
            let (upper, axis) = (format!("b{}.low", k - 1), ["y", "z", "x"][k as usize % 3]);
            let upper = if k == 0 { "ground.O" } else { &upper };
            let _ = write!(
                text,
                "body b{k} {{ mass 1; inertia [[0.1, 0.01, 0.02], [0.01, 0.2, -0.03], [0.02, -0.03, 0.15]];
                    point top = [0.1, 0.2, 0.5]; point low = [0.2, 0.2, 0.5] - [0, 0.3, 0.9];
                    start top at {k} * [0.1, -0.3, -0.9]; }}
                 joint j{k}: revolute {axis} ({upper} -> b{k}.top) {{ rigid; }}
                 stop s{k} on j{k} {{ at most 0.2; restitution 0.5; }} "
            );
        }
        text + "observe { a: rad = j7.angle; } scenes only; scene S {} }"
    }

    #[test]
    fn every_part_of_a_long_routine_is_called() {
        let source = syntax::parse(arm().parse().expect("tokens")).expect("a graph");
        let code = emit::model(&pipeline::models(&source).expect("a model")[0]).to_string();
        let names = |before: &str| -> BTreeSet<&str> {
            let all = code.split(before).skip(1).filter_map(|rest| rest.split([' ', '(']).next());
            all.filter(|name| name.contains("_part_")).collect()
        };
        let (declared, called) = (names("fn "), names("self . "));
        assert!(declared.iter().any(|name| name.starts_with("rate_part_")), "it is long: {declared:?}");
        assert_eq!(declared, called);
    }
}
