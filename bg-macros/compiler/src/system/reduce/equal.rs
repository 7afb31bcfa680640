//! States that stay equal up to sign.
//!
//! In: equations. Out: the same with one state for each class of equal ones.
//! Method: partition refinement. Candidates are states with the same start value up to sign; assume each class equal,
//! derive, split the classes whose rates (or projections) differ, repeat until none splits. What remains is proved by
//! induction in time: equal start, equal rate wherever the equalities hold. States that start at zero show no sign;
//! they get it from their rates.

use std::collections::BTreeMap;

use super::report::{Fate, Report};
use crate::expr::{Id, Node, Pool, Symbol, substitute};
use crate::system::equations::StateEquations;

/// Merges equal states.
pub(super) fn merge(equations: &mut StateEquations, report: &mut Report) {
    let classes = classes(equations);
    let symbols: Vec<Id> = state_symbols(equations);
    let images: Vec<Id> = images(&mut equations.pool, &symbols, &classes);
    let mut kept = vec![true; classes.len()];
    for (state, &(first, negative)) in classes.iter().enumerate() {
        if first != state {
            kept[state] = false;
            let sign = if negative { "-" } else { "" };
            report.say(state, Fate::Equal(format!("{sign}{}", equations.states[first].name)));
        }
    }
    equations.replace(&|symbol| symbol.as_state().map(|state| images[state]));
    super::live::keep_states(equations, report, &kept);
}

/// For each state the first of its class, and whether it is its negative.
type Classes = Vec<(usize, bool)>;

fn state_symbols(equations: &mut StateEquations) -> Vec<Id> {
    let states = equations.states.len();
    (0..states).map(|state| equations.pool.symbol(Symbol::state(state))).collect()
}

/// Every state in terms of the first of its class.
fn images(pool: &mut Pool, symbols: &[Id], classes: &Classes) -> Vec<Id> {
    classes.iter().map(|&(first, negative)| if negative { pool.neg(symbols[first]) } else { symbols[first] }).collect()
}

fn classes(equations: &mut StateEquations) -> Classes {
    let symbols = state_symbols(equations);
    let candidates = Candidates::of(equations);
    let pool = &mut equations.pool;
    let mut current = candidates.first(pool, &symbols);
    // Every round splits a class or is the last; signs that will not settle prove nothing.
    for _ in 0..2 * symbols.len() + 2 {
        let image = images(pool, &symbols, &current);
        let at = |symbol: Symbol| symbol.as_state().map(|state| image[state]);
        let rates = substitute(pool, &candidates.rates, &at);
        let projections = substitute(pool, &candidates.projections, &at);
        let next = group(symbols.len(), |state| {
            let negative = candidates.sign(pool, state, rates[state]);
            let signed = [rates[state], projections[state]].map(|id| if negative { pool.neg(id) } else { id });
            Some((vec![candidates.starts[state].0, symbols[current[state].0], signed[0], signed[1]], negative))
        });
        if next == current {
            return current;
        }
        current = next;
    }
    (0..symbols.len()).map(|state| (state, false)).collect()
}

/// What equal states have in common.
struct Candidates {
    /// Start values without their signs, and whether they had one.
    starts: Vec<(Id, bool)>,
    rates: Vec<Id>,
    /// What `project` gives the state: itself where nothing.
    projections: Vec<Id>,
}

impl Candidates {
    /// The coarsest classes. States with a start value: those of the same up to sign. Then, round by round, states that
    /// start at zero: those whose rates are equal up to sign where the classes found so far hold and all other states
    /// are zero. A guess only; the rounds that follow prove it.
    fn first(&self, pool: &mut Pool, symbols: &[Id]) -> Classes {
        let mut keys: Vec<Option<(Vec<Id>, bool)>> = self
            .starts
            .iter()
            .map(|&(start, negative)| (!pool.is_zero(start)).then(|| (vec![start], negative)))
            .collect();
        let zero = pool.zero();
        loop {
            let classes = group(symbols.len(), |state| keys[state].clone());
            let mut image = images(pool, symbols, &classes);
            for (image, key) in image.iter_mut().zip(&keys) {
                if key.is_none() {
                    *image = zero;
                }
            }
            let rates = substitute(pool, &self.rates, &|symbol| symbol.as_state().map(|state| image[state]));
            let mut found = false;
            for (key, rate) in keys.iter_mut().zip(rates) {
                if key.is_none() && !pool.is_zero(rate) {
                    let (rate, negative) = unsigned(pool, rate);
                    *key = Some((vec![zero, rate], negative));
                    found = true;
                }
            }
            if !found {
                // What the coarse classes cancel shows its sign later.
                let rest = |state: usize| keys[state].clone().unwrap_or_else(|| (vec![zero], false));
                return group(symbols.len(), |state| Some(rest(state)));
            }
        }
    }

    /// Whether a state is negative beside its class: by its start value, or by its rate if it starts at zero. A state
    /// that starts at zero and has no rate equals its negative.
    fn sign(&self, pool: &mut Pool, state: usize, rate: Id) -> bool {
        let (start, negative) = self.starts[state];
        if pool.is_zero(start) { unsigned(pool, rate).1 } else { negative }
    }

    fn of(equations: &mut StateEquations) -> Self {
        let zero = equations.pool.zero();
        let mut projections = vec![zero; equations.states.len()];
        for &(state, id) in &equations.projections {
            projections[state] = id;
        }
        let rates = equations.states.iter().map(|state| state.rate).collect();
        let starts = equations.states.iter().map(|state| unsigned(&mut equations.pool, state.start)).collect();
        Self { starts, rates, projections }
    }
}

/// States with the same key in one class; a state without a key stays alone.
fn group(states: usize, mut key: impl FnMut(usize) -> Option<(Vec<Id>, bool)>) -> Classes {
    let mut firsts: BTreeMap<Vec<Id>, (usize, bool)> = BTreeMap::new();
    (0..states)
        .map(|state| match key(state) {
            None => (state, false),
            Some((key, sign)) => {
                let &mut (first, first_sign) = firsts.entry(key).or_insert((state, sign));
                (first, sign != first_sign)
            }
        })
        .collect()
}

/// An expression without its sign, that of a sum being its first part's, and whether it had one.
fn unsigned(pool: &mut Pool, id: Id) -> (Id, bool) {
    let negative = match pool.node(id) {
        Node::Number(number) => number.value() < 0.0,
        Node::Sum { constant, .. } if constant.value() != 0.0 => constant.value() < 0.0,
        Node::Sum { terms, .. } => terms.first().is_some_and(|(_, coefficient)| coefficient.value() < 0.0),
        _ => false,
    };
    (if negative { pool.neg(id) } else { id }, negative)
}

#[cfg(test)]
mod tests {
    use crate::system::reduce::tests::{coupling, oscillator, scene};

    const PARAMETERS: &str = "param m: kg = 2; param k: N/m = 30; param l: N/m = 30; param c: N*s/m = 0.4;";

    /// Two oscillators with these parameters and start values of stretch, both flows observed.
    fn pair(first: [&str; 3], second: [&str; 3], stretches: [&str; 2]) -> String {
        PARAMETERS.to_owned()
            + &oscillator("a", first, ["0", stretches[0]])
            + &oscillator("b", second, ["0", stretches[1]])
            + "observe { a: m/s = a.flow; b: m/s = b.flow; q: m = ak.q; p: m = bk.q; }"
    }

    #[test]
    fn equal_subsystems_become_one() {
        let scene = scene(&pair(["m", "k", ""], ["m", "k", ""], ["0.1", "0.1"]), "");
        assert_eq!(scene.left(), ["am.p", "ak.q"]);
        assert_eq!(scene.words(&["bm.p", "bk.q"]), ["equal am.p", "equal ak.q"]);
        scene.agrees();
    }

    /// The momenta's rates depend on the momenta themselves, which start at zero.
    #[test]
    fn equal_damped_subsystems_become_one() {
        for (stretches, names) in
            [(["0.1", "0.1"], ["equal am.p", "equal ak.q"]), (["0.1", "-0.1"], ["equal -am.p", "equal -ak.q"])]
        {
            let scene = scene(&pair(["m", "k", "c"], ["m", "k", "c"], stretches), "");
            scene.agrees();
            assert_eq!(scene.words(&["bm.p", "bk.q"]), names);
        }
    }

    #[test]
    fn an_antisymmetric_pair_becomes_one_with_its_sign() {
        // The momenta start at zero: their signs are those of their rates.
        let scene = scene(&pair(["m", "k", ""], ["m", "k", ""], ["0.1", "-0.1"]), "tune { m, k }");
        assert_eq!(scene.words(&["bm.p", "bk.q"]), ["equal -am.p", "equal -ak.q"]);
        scene.agrees();
    }

    #[test]
    fn a_coupling_of_an_antisymmetric_pair_is_stretched_twice() {
        let graph = pair(["m", "k", ""], ["m", "k", ""], ["0.1", "-0.1"])
            + &coupling("s", "a", "b", "k").replace("C s = k", "C s = k start 0.2");
        let scene = scene(&graph, "");
        scene.agrees();
        assert_eq!(scene.words(&["bk.q"]), ["equal -ak.q"], "{}", scene.report);
    }

    #[test]
    fn tuned_parameters_tell_apart_what_equal_numbers_do_not() {
        let graph = pair(["m", "k", ""], ["m", "l", ""], ["0.1", "0.1"]);
        for clauses in ["", "tune { k }", "tune { l, m }"] {
            let apart = scene(&graph, clauses);
            assert_eq!(apart.reduced.states.len(), 4, "{clauses}: {}", apart.report);
            apart.agrees();
        }
        let same = scene(&graph, "tune { m, c }");
        assert_eq!(same.left(), ["am.p", "ak.q"]);
        same.agrees();
    }

    #[test]
    fn equal_starts_with_other_rates_stay_apart() {
        for second in [["3", "k", "c"], ["m", "2 * k", "c"], ["m", "k", "2 * c"], ["m", "k", ""]] {
            let scene = scene(&pair(["m", "k", "c"], second, ["0.1", "0.1"]), "tune {}");
            assert_eq!(scene.reduced.states.len(), 4, "{second:?}: {}", scene.report);
            scene.agrees();
        }
        let scene = scene(&pair(["m", "k", "c"], ["m", "k", "c"], ["0.1", "0.2"]), "tune {}");
        assert_eq!(scene.reduced.states.len(), 4);
        scene.agrees();
    }

    #[test]
    fn a_difference_far_down_a_chain_splits_every_class_above_it() {
        let chain = |name: &str, last: &str| {
            let [one, two, three] = ["1", "2", "3"].map(|k| format!("{name}{k}"));
            oscillator(&one, ["m", "k", "c"], ["0", "0.1"])
                + &oscillator(&two, ["m", "", ""], ["0", ""])
                + &oscillator(&three, [last, "", ""], ["0", ""])
                + &coupling(&format!("{name}_s"), &one, &two, "k").replace("= k;", "= k start 0.1;")
                + &coupling(&format!("{name}_t"), &two, &three, "k").replace("= k;", "= k start 0.1;")
        };
        let observed = "observe { a: m/s = a1.flow; b: m/s = b1.flow; }";
        let same = scene(&format!("{PARAMETERS}{}{}{observed}", chain("a", "m"), chain("b", "m")), "");
        assert_eq!(same.reduced.states.len(), 6, "{}", same.report);
        same.agrees();
        let other = scene(&format!("{PARAMETERS}{}{}{observed}", chain("a", "m"), chain("b", "3")), "");
        assert_eq!(other.reduced.states.len(), 12, "{}", other.report);
        other.agrees();
    }

    #[test]
    fn a_force_that_comes_later_tells_a_pair_apart_from_the_start() {
        for law in ["if t < 1 { 0 } else { 1 }", "sin(2 * t) * 0.1"] {
            let graph = pair(["m", "k", "c"], ["m", "k", "c"], ["0.1", "0.1"]) + "MSe late = " + law + "; late -> b;";
            let scene = scene(&graph, "");
            assert_eq!(scene.reduced.states.len(), 4, "{law}: {}", scene.report);
            scene.agrees();
        }
    }

    #[test]
    fn the_same_force_on_both_keeps_them_together_and_opposite_ones_turn_the_sign() {
        let plain = pair(["m", "", ""], ["m", "", ""], ["", ""]).replace("q: m = ak.q; p: m = bk.q;", "");
        let same = plain.clone() + "input push: N; Se f = push; Se g = push; f -> a; g -> b;";
        let same = scene(&same, "");
        assert_eq!(same.words(&["bm.p"]), ["equal am.p"]);
        same.agrees();
        let opposite = plain + "input push: N; Se f = push; Se g = -push; f -> a; g -> b;";
        let opposite = scene(&opposite, "");
        assert_eq!(opposite.words(&["bm.p"]), ["equal -am.p"]);
        opposite.agrees();
    }

    #[test]
    fn a_law_that_is_not_odd_splits_an_antisymmetric_pair() {
        let law = |name: &str| format!("R {name}r(v) = if v < 0 {{ 1 * v }} else {{ 2 * v }}; {name} -> {name}r;");
        let graph = pair(["m", "k", ""], ["m", "k", ""], ["0.1", "-0.1"]) + &law("a") + &law("b");
        let scene = scene(&graph, "");
        assert_eq!(scene.reduced.states.len(), 4, "{}", scene.report);
        scene.agrees();
    }

    #[test]
    fn states_that_wait_for_each_other_do_not_prove_themselves() {
        // x' = y, y' = -x from (1, 0), and u' = -v, v' = u from (1, 0): u = x and v = -y.
        // From (1, 0) with v' = 2 u nothing is equal.
        let graph = |factor: &str| {
            format!(
                "1 a: translation; 1 b: translation; 1 c: translation; 1 d: translation;
                 I x = 1 start 1; I y = 1; I u = 1 start 1; I v = 1; a -> x; b -> y; c -> u; d -> v;
                 MSe e = 1 * y.p; MSe f = -1 * x.p; MSe g = -1 * v.p; MSe h = {factor} * u.p; e -> a; f -> b; g -> c; \
                 h -> d;
                 observe {{ x: m/s = a.flow; y: m/s = b.flow; u: m/s = c.flow; v: m/s = d.flow; }}"
            )
        };
        let turned = scene(&graph("1"), "");
        assert_eq!(turned.words(&["u.p", "v.p"]), ["equal x.p", "equal -y.p"]);
        turned.agrees();
        let faster = scene(&graph("2"), "");
        assert_eq!(faster.left(), ["x.p", "y.p", "u.p", "v.p"]);
        faster.agrees();
    }

    /// Equal starts and equal rates: (R_11, R_21) turns as (x, y) does. Only `project` makes R an orientation and
    /// leaves x as it is.
    #[test]
    fn a_projection_tells_states_apart() {
        let graph = "param s: 1 = 1.1; 1 j[3]: rotation; Sf spin = [0, 0, 2]; spin -> j;
            orientation R of j start [[s, 0, 0], [0, 1, 0], [0, 0, 1]];
            1 a: translation; 1 b: translation; I x = 1 start 1 * s; I y = 1; MSe e = -2 * y.p; MSe f = 2 * x.p;
            e -> a; f -> b; a -> x; b -> y; observe { r = R; x: m/s = a.flow; y: m/s = b.flow; }";
        let scene = scene(graph, "tune { s }");
        assert_eq!(scene.words(&["x.p", "y.p"]), ["integrated", "integrated"], "{}", scene.report);
        scene.agrees();
    }
}
