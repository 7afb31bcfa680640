//! Generated Jacobians are the derivatives of the generated rates; generated eliminations solve (I - c J) y = b.
//!
//! The derivatives are compared with those that dual numbers give of the same rate, column by column and along time, in
//! both branches of every switch; a place outside the pattern must have none. The second derivatives are compared with
//! those along the flow. The solutions are put back into the system. The rate that other numbers are given is that of
//! `f64`.

use bg_model::bond_graph;
use bg_model::capability::Elimination;
use bg_model::dynamics::{Machine, Typed};
use bg_model::input::Input;
use bg_model::linear::{Field, SMALLEST_PIVOT, Sparsity};
use bg_model::nalgebra::{Complex, DMatrix, DVector};
use bg_model::scalar::Dual;
use bond_graph_tests::support::example::{self, Example, Twin};
use bond_graph_tests::support::power::{Draw, state};
use bond_graph_tests::support::record::along;
use bond_graph_tests::{each_example, each_scene};

/// Largest deviation of an entry, relative to itself and, for what cancels, to 1e-2 of the largest in its row, in these
/// or in the opposite branches: what friction holds cancels all that the branch which slides has.
const DERIVATIVE: f64 = 1e-11;
/// Largest residual relative to |I - c J| |y| + |b|, maximum norms, for steps up to 1e-2 s.
const RESIDUAL: f64 = 1e-12;
/// The same for steps up to 1e2 s, over which stiff joints are rigid: what a pivot that is just large enough leaves.
const LARGE_STEP: f64 = f64::EPSILON / SMALLEST_PIVOT;

/// The entries of df/dx, it as a full matrix, and df/dt.
fn jacobian(model: &dyn Machine, t: f64, x: &[f64], negative: &[bool]) -> (Vec<f64>, DMatrix<f64>, Vec<f64>) {
    let sparsity = model.sparsity();
    assert_ne!(sparsity, Sparsity::Full, "a generated model knows its Jacobian and its pattern");
    let (mut entries, mut slope) = (vec![f64::NAN; sparsity.len(x.len())], vec![f64::NAN; x.len()]);
    model.jacobian(t, x, negative, &mut entries, &mut slope);
    let matrix = sparsity.matrix(x.len(), &entries);
    (entries, matrix, slope)
}

/// The entries of df/dx that say what dampers do, as a full matrix.
fn damping(model: &dyn Machine, t: f64, x: &[f64], negative: &[bool]) -> DMatrix<f64> {
    let sparsity = model.damping_sparsity();
    let mut entries = vec![f64::NAN; sparsity.len(x.len())];
    model.damping(t, x, negative, &mut entries);
    sparsity.matrix(x.len(), &entries)
}

/// The derivatives of the rate by dual numbers: df/dx with df/dt as one more column.
fn differentiated(twin: &dyn Twin, t: f64, x: &[f64], negative: &[bool]) -> DMatrix<f64> {
    let n = x.len();
    let mut matrix = DMatrix::zeros(n, n + 1);
    for column in 0..=n {
        let slope = |k: usize| if k == column { 1.0 } else { 0.0 };
        let seeded: Vec<Dual> = x.iter().enumerate().map(|(k, &x)| Dual::new(x, slope(k))).collect();
        let mut rate = vec![Dual::new(0.0, 0.0); n];
        twin.rate(Dual::new(t, slope(n)), &seeded, negative, &mut rate);
        (0..n).for_each(|row| matrix[(row, column)] = rate[row].slope);
    }
    matrix
}

/// Compares the Jacobian with dual numbers at this point.
fn is_the_derivative(example: &Example, t: f64, x: &[f64], negative: &[bool]) -> f64 {
    let (model, twin) = (&*example.machine, &*example.twin);
    let [rate, inlined, paired] = example.rates.rates(t, x, negative);
    assert_eq!(rate, inlined, "the rate without pairs at {x:?}");
    assert_eq!(rate, paired, "the rate in pairs at {x:?}");
    let (_, found, slope) = jacobian(model, t, x, negative);
    let damping = damping(model, t, x, negative);
    let second_order = model.second();
    let expected = differentiated(twin, t, x, negative);
    let opposite: Vec<bool> = negative.iter().map(|is_negative| !is_negative).collect();
    let opposite = differentiated(twin, t, x, &opposite);
    let mut largest: f64 = 0.0;
    let n = x.len();
    for row in 0..n {
        let size = expected.row(row).amax().max(opposite.row(row).amax());
        for column in 0..=n {
            let found = if column == n { slope[row] } else { found[(row, column)] };
            let value = expected[(row, column)];
            let scale = value.abs().max(1e-2 * size);
            let error = (found - value).abs() / if scale > 0.0 { scale } else { 1.0 };
            assert!(error <= DERIVATIVE, "entry {row}, {column}: {found:e}, not {value:e}, at {x:?}");
            largest = largest.max(error);
            if column < n && !second_order.contains(&row) && !second_order.contains(&column) {
                let found = damping[(row, column)];
                let error = (found - value).abs() / if scale > 0.0 { scale } else { 1.0 };
                assert!(error <= DERIVATIVE, "damping {row}, {column}: {found:e}, not {value:e}, at {x:?}");
            }
        }
    }
    largest
}

/// Compares the second derivatives of the states of second order with those that dual numbers give along the flow at
/// this point; the other rates must stay. Gives how many states are of second order.
fn second_derivatives_agree(example: &Example, t: f64, x: &[f64], negative: &[bool]) -> usize {
    let (model, twin) = (&*example.machine, &*example.twin);
    let [rate, ..] = example.rates.rates(t, x, negative);
    let mut found = rate.clone();
    model.second_derivatives(x, &mut found);
    let moving: Vec<Dual> = x.iter().zip(&rate).map(|(&x, &rate)| Dual::new(x, rate)).collect();
    let mut expected = vec![Dual::new(0.0, 0.0); x.len()];
    twin.rate(Dual::new(t, 1.0), &moving, negative, &mut expected);
    let of_second_order = model.second();
    let mut forces = rate.clone();
    if !of_second_order.is_empty() {
        model.forces(t, x, negative, &mut forces);
    }
    let largest = |of: &[f64]| of.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
    for (k, (force, value)) in forces.iter().zip(&found).enumerate() {
        let scale = value.abs().max(1e-2 * largest(&found));
        assert!((force - value).abs() <= DERIVATIVE * scale, "state {k}: {force:e}, not {value:e}, at {x:?}");
    }
    for k in 0..x.len() {
        if of_second_order.contains(&k) {
            let (value, scale) = (expected[k].slope, expected[k].slope.abs().max(1e-2 * largest(&rate)));
            assert!(
                (found[k] - value).abs() <= DERIVATIVE * scale,
                "state {k}: {:e}, not {value:e}, at {x:?}",
                found[k]
            );
        } else {
            assert_eq!(found[k].to_bits(), rate[k].to_bits(), "state {k} is of first order");
        }
    }
    of_second_order.len()
}

/// The solution y of (I - c J) y = b, real; none where a pivot is small.
fn solution(model: &dyn Machine, c: f64, entries: &[f64], b: &[f64]) -> Option<Vec<f64>> {
    let mut factors = vec![f64::NAN; model.factors()?];
    let mut y = b.to_vec();
    model.eliminate(c, entries, &mut factors).then(|| model.substitute(&factors, &mut y))?;
    Some(y)
}

/// The same, complex.
fn complex_solution(
    model: &dyn Machine,
    c: Complex<f64>,
    entries: &[f64],
    b: &[Complex<f64>],
) -> Option<Vec<Complex<f64>>> {
    let mut factors = vec![Complex::new(f64::NAN, 0.0); model.factors()?];
    let mut y = b.to_vec();
    model.eliminate_complex(c, entries, &mut factors).then(|| model.substitute_complex(&factors, &mut y))?;
    Some(y)
}

/// The residual of the solution `y` of (I - c J) y = b relative to |I - c J| |y| + |b|, maximum norms.
fn residual<F: Field<f64>>(c: F, matrix: &DMatrix<f64>, b: &[F], y: &[F]) -> f64 {
    let (mut rest, mut norm): (f64, f64) = (0.0, 0.0);
    for row in 0..b.len() {
        let products = (0..b.len()).map(|column| c.scaled(matrix[(row, column)]) * y[column]);
        let sum = products.fold(b[row] - y[row], |sum, product| sum + product);
        assert!(sum.size().is_finite(), "an unusable solution");
        rest = rest.max(sum.size());
        norm = norm.max(1.0 + (0..b.len()).map(|column| c.scaled(matrix[(row, column)]).size()).sum::<f64>());
    }
    let largest = |of: &[F]| of.iter().fold(0.0_f64, |largest, part| largest.max(part.size()));
    rest / (norm * largest(y) + largest(b))
}

/// What came of some solutions.
#[derive(Clone, Copy, Debug, Default)]
struct Solved {
    /// The largest residual with a step up to 1e-2 s.
    residual: f64,
    /// How often a pivot was too small with a step up to 1e-2 s.
    refused: usize,
}

/// Solves with random steps, real and complex, at this point.
fn solve(model: &dyn Machine, t: f64, x: &[f64], negative: &[bool], draw: &mut Draw, solved: &mut Solved) {
    let (entries, matrix, _) = jacobian(model, t, x, negative);
    for round in 0..8 {
        let is_large = round % 4 == 3;
        let c = 10.0_f64.powf(if is_large { 2.0 * draw.number() } else { -5.0 + 3.0 * draw.number() });
        let turned = Complex::new(c, c * draw.number());
        let b: Vec<f64> = x.iter().map(|_| draw.number()).collect();
        let complex: Vec<_> = b.iter().map(|&real| Complex::new(real, draw.number())).collect();
        let real_residual = solution(model, c, &entries, &b).map(|y| residual(c, &matrix, &b, &y));
        let complex_residual =
            complex_solution(model, turned, &entries, &complex).map(|y| residual(turned, &matrix, &complex, &y));
        for found in [real_residual, complex_residual] {
            let Some(found) = found else {
                solved.refused += usize::from(!is_large);
                continue;
            };
            let bound = if is_large { LARGE_STEP } else { RESIDUAL };
            assert!(found <= bound, "residual {found:e} with c = {c:e} at {x:?}");
            solved.residual = if is_large { solved.residual } else { solved.residual.max(found) };
        }
    }
}

/// Both comparisons at random states, every switch in either branch.
fn agrees(example: &Example) {
    let model = &*example.machine;
    let mut draw = Draw::new(3);
    let (mut derivative, mut rounds): (f64, usize) = (0.0, 0);
    let mut solved = Solved::default();
    let mut second = 0;
    for round in 0..12 {
        let x = state(model, &mut draw);
        let t = 1.0 + draw.number();
        let negative = vec![round % 2 == 0; model.switches()];
        // A law may have no value at a random state.
        if differentiated(&*example.twin, t, &x, &negative).iter().any(|value| !value.is_finite()) {
            continue;
        }
        rounds += 1;
        derivative = derivative.max(is_the_derivative(example, t, &x, &negative));
        second = second_derivatives_agree(example, t, &x, &negative);
        solve(model, t, &x, &negative, &mut draw, &mut solved);
    }
    let (name, n) = (model.description().name, model.states());
    println!("{name}: {n} states, {second} of second order, {rounds} rounds, derivatives {derivative:.1e}, {solved:?}");
    assert!(rounds >= 4, "{rounds} rounds");
    assert!(solved.refused <= rounds, "{solved:?}");
}

/// An input that changes in time.
fn wave() -> Input {
    Input::with_rate(|t| 0.7 + (3.0 * t).sin(), |t| 3.0 * (3.0 * t).cos())
}

macro_rules! example_agrees {
    ($($test:ident: $module:ident $model:ident ($($rest:tt)*);)*) => {$(
        #[test]
        fn $test() {
            agrees(&example::examples::$test(&wave()));
        }
    )*};
}

mod examples {
    use super::*;

    each_example!(example_agrees);
}

macro_rules! scene_agrees {
    ($($test:ident: $model:ident ($($rest:tt)*);)*) => {$(
        #[test]
        fn $test() {
            let scene = example::scenes::$test();
            agrees(&scene);
            along_the_trajectory(&*scene.machine);
        }
    )*};
}

mod scenes {
    use super::*;

    each_scene!(scene_agrees);
}

/// Solves at 20 states of the first 0.1 s; with steps up to 1e-2 s no pivot is small there.
fn along_the_trajectory(model: &dyn Machine) {
    let mut draw = Draw::new(4);
    let mut solved = Solved::default();
    for (t, x, negative) in along(model, 0.1) {
        solve(model, t, &x, &negative, &mut draw, &mut solved);
    }
    println!("{}: along the trajectory {solved:?}", model.description().name);
    assert_eq!(solved.refused, 0);
}

/// Compares the derivatives at 20 states until `end`, s, and solves as for a scene.
fn agrees_along(example: &Example, end: f64) {
    for (t, x, negative) in along(&*example.machine, end) {
        is_the_derivative(example, t, &x, &negative);
        second_derivatives_agree(example, t, &x, &negative);
    }
    along_the_trajectory(&*example.machine);
}

/// Its functions have loops.
#[test]
fn a_model_that_repeats_itself_along_its_motion() {
    agrees_along(&example::rope(), 0.05);
}

/// Its functions are in parts, and depend on switches.
#[test]
fn a_long_model_along_its_motion() {
    agrees_along(&example::whip(), 0.5);
}

#[test]
fn a_dense_solution_is_the_same() {
    let model = example::scenes::paper().machine;
    let (n, x) = (model.states(), model.start().unwrap());
    let (entries, matrix, _) = jacobian(&*model, 0.0, &x, &vec![false; model.switches()]);
    let mut draw = Draw::new(5);
    for c in [1e-8, 1e-5, 1e-3, 1e-2] {
        let b: Vec<f64> = x.iter().map(|_| draw.number()).collect();
        let y = solution(&*model, c, &entries, &b).expect("no pivot is small");
        let dense = DMatrix::identity(n, n) - &matrix * c;
        let expected = dense.clone().lu().solve(&DVector::from_column_slice(&b)).expect("regular");
        let apart = (DVector::from_column_slice(&y) - &expected).amax() / expected.amax();
        // What rounding does to either solution, in units of the condition number.
        let condition = dense.norm() * dense.try_inverse().expect("regular").norm();
        println!("c = {c:e}: {apart:.1e} apart, condition {condition:.1e}");
        assert!(apart < 1e-14 * condition, "c = {c:e}: {apart:e}, condition {condition:e}");
    }
}

bond_graph! {
    /// A block on a floor that resists in one direction only, and pushes in the other.
    graph Block {
        1 motion: translation; I block = 2; R floor(v) = if v < 0 { -4 * v } else { 3 * v };
        motion -> block; motion -> floor;
        observe { v: m/s = motion.flow; }
    }
}

#[test]
fn a_pivot_that_vanishes_is_refused() {
    let model = Block::new(BlockParameters::default()).unwrap();
    for negative in [false, true] {
        let (entries, matrix, _) = jacobian(&Typed::model(&model), 0.0, &[1.0], &[negative]);
        let rate = matrix[(0, 0)];
        let factors = model.factors();
        let eliminated = |c: f64| model.eliminate(c, &entries, &mut vec![0.0; factors]);
        assert!(!eliminated(1.0 / rate), "{negative}: {rate}");
        assert!(!eliminated((1.0 + 0.1 * SMALLEST_PIVOT) / rate));
        assert!(eliminated((1.0 + 10.0 * SMALLEST_PIVOT) / rate));
        assert!(!eliminated(f64::NAN) && !eliminated(f64::INFINITY));
        let eliminated = |c: Complex<f64>| model.eliminate(c, &entries, &mut vec![Complex::default(); factors]);
        assert!(!eliminated(Complex::new(1.0 / rate, 0.0)) && eliminated(Complex::new(1.0 / rate, 1e-3 / rate)));
    }
}

/// Entries, factors, and operations of `jacobian`, `eliminate`, `substitute`.
fn counts(model: &dyn Machine) -> [usize; 5] {
    let operations = |wanted: &str| {
        let found = model.description().operations.iter().find(|(name, _)| *name == wanted);
        found.expect("every function is listed").1.total()
    };
    [
        model.sparsity().len(model.states()),
        model.factors().expect("an elimination"),
        operations("jacobian"),
        operations("eliminate"),
        operations("substitute"),
    ]
}

#[test]
fn counts_of_the_hacksaw() {
    assert_eq!(counts(&*example::scenes::paper().machine), [243, 251, 779, 869, 486]);
    assert_eq!(counts(&*example::scenes::literal().machine), [1696, 1750, 9368, 15366, 3443]);
}
