//! Laws that hold for every model: the power balance at any state, and that the order of declaration changes nothing.

use bg_model::input::Input;
use bond_graph_tests::each_example;
use bond_graph_tests::models;
use bond_graph_tests::support::example::{Example, examples};
use bond_graph_tests::support::power::{Draw, imbalance, state};
use bond_graph_tests::support::record::{Record, instants, record};

/// What rounding leaves of the balance, relative to the sum of all powers' magnitudes.
const ROUNDING: f64 = 1e-14;

fn balance(example: &Example) {
    let (model, mut draw) = (&*example.machine, Draw::new(2));
    let mut largest: f64 = 0.0;
    for _ in 0..25 {
        let x = state(model, &mut draw);
        let t = 1.0 + draw.number();
        let found = imbalance(model, &*example.twin, t, &x);
        assert!(found <= ROUNDING, "{}: {found:e} at {x:?}", model.description().name);
        largest = largest.max(found);
    }
    println!("{}: {} states, {largest:.1e}", model.description().name, model.states());
}

/// One test a model: d(stored)/dt = supplied - dissipated at 25 random states.
macro_rules! power_is_balanced {
    ($($test:ident: $module:ident $model:ident ($($rest:tt)*);)*) => {$(
        #[test]
        fn $test() {
            balance(&examples::$test(&Input::constant(0.7)));
        }
    )*};
}

mod power_is_balanced {
    use super::*;

    each_example!(power_is_balanced);
}

/// Equal up to the rounding that another order of sums leaves in an adaptive run.
fn same_numbers(a: &Record, b: &Record, outputs: &[&str]) {
    for name in outputs {
        let (left, right) = (a.series(name), b.series(name));
        assert!(left.iter().chain(&right).all(|value| value.is_finite()), "{name}");
        let apart = left.iter().zip(&right).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
        println!("{name}: {apart:.1e}{}", if left == right { ", to the bit" } else { "" });
        assert!(apart <= 1e-11 * (1.0 + a.largest(name)), "{name}: {apart:e}");
    }
}

#[test]
fn the_order_of_declaration_changes_nothing_in_a_bond_graph() {
    use models::permuted::{Backward, BackwardParameters, Forward, ForwardParameters};
    let times = instants(3.0, 30);
    let forward = record(&Forward::new(ForwardParameters::default()).unwrap(), &times, 1e-10);
    let backward = record(&Backward::new(BackwardParameters::default()).unwrap(), &times, 1e-10);
    same_numbers(&forward, &backward, &["a", "b", "wall", "spring", "stored"]);
    assert_eq!(forward.statistics.events, backward.statistics.events);
    assert!(forward.statistics.events > 2);
}

#[test]
fn the_order_of_declaration_changes_nothing_in_a_mechanism() {
    use models::permuted::{Chain, ChainBackward, ChainBackwardParameters, ChainParameters};
    let times = instants(1.0, 30);
    let forward = record(&Chain::new(ChainParameters::default()).unwrap(), &times, 1e-10);
    let backward = record(&ChainBackward::new(ChainBackwardParameters::default()).unwrap(), &times, 1e-10);
    same_numbers(
        &forward,
        &backward,
        &["first_x", "first_y", "first_z", "second_x", "second_y", "h_x", "h_z", "stored"],
    );
}
