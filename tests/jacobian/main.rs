//! Generated Jacobians are the derivatives of the generated rates; generated eliminations solve (I - c J) y = b.
//!
//! The derivatives are compared with those that dual numbers give of the same rate, column by column and along time, in
//! both branches of every switch; a place outside the pattern must have none. The second derivatives are compared with those
//! along the flow. The solutions are put back into the system. The rate that other numbers are given is that of `f64`.

use bg_model::bond_graph;
use bg_model::capability::{Elimination, Linearised, SecondOrder};
use bg_model::input::Input;
use bg_model::linear::{Field, SMALLEST_PIVOT, Sparsity};
use bg_model::nalgebra::{Complex, DMatrix, DVector, SVector};
use bg_model::scalar::Dual;
use bg_model::system::{Model, System};
use bond_graph_tests::models;
use bond_graph_tests::support::power::{Draw, state};
use bond_graph_tests::support::record::along;
use bond_graph_tests::{each_example, each_scene};
use hacksaw::mechanism::{
    Angles, AnglesParameters, FreeRun, FreeRunParameters, Full, FullParameters, Hacksaw, HacksawParameters, Motion,
    MotionParameters, Paper, PaperParameters, Rigid, RigidParameters,
};

/// Largest deviation of an entry, relative to itself and, for what cancels, to 1e-2 of the largest in its row, in these or in the
/// opposite branches: what friction holds cancels all that the branch which slides has.
const DERIVATIVE: f64 = 1e-11;
/// Largest residual relative to |I - c J| |y| + |b|, maximum norms, for steps up to 1e-2 s.
const RESIDUAL: f64 = 1e-12;
/// The same for steps up to 1e2 s, over which stiff joints are rigid: what a pivot that is just large enough leaves.
const LARGE_STEP: f64 = f64::EPSILON / SMALLEST_PIVOT;

/// df/dx as a full matrix and df/dt.
fn jacobian<Mo, const N: usize, const G: usize>(
    model: &Mo,
    t: f64,
    x: &SVector<f64, N>,
    negative: &[bool; G],
) -> (Vec<f64>, DMatrix<f64>, SVector<f64, N>)
where
    Mo: System<f64, N, G>,
{
    let model = model.linearised().expect("a generated model knows its Jacobian");
    let sparsity = model.sparsity();
    assert_ne!(sparsity, Sparsity::Full, "a generated model knows its pattern");
    let (mut entries, mut slope) = (vec![f64::NAN; sparsity.len(N)], SVector::repeat(f64::NAN));
    model.jacobian(t, x, negative, &mut entries, &mut slope);
    let matrix = sparsity.matrix(N, &entries);
    (entries, matrix, slope)
}

/// The entries of df/dx that say what dampers do, as a full matrix.
fn damping<Mo, const N: usize, const G: usize>(
    model: &Mo,
    t: f64,
    x: &SVector<f64, N>,
    negative: &[bool; G],
) -> DMatrix<f64>
where
    Mo: System<f64, N, G>,
{
    let model = model.linearised().expect("a generated model knows its Jacobian");
    let sparsity = model.damping_sparsity();
    let mut entries = vec![f64::NAN; sparsity.len(N)];
    model.damping(t, x, negative, &mut entries);
    sparsity.matrix(N, &entries)
}

/// The derivatives of the rate by dual numbers: df/dx with df/dt as one more column.
fn differentiated<B, const N: usize, const G: usize>(
    twin: &B,
    t: f64,
    x: &SVector<f64, N>,
    negative: &[bool; G],
) -> DMatrix<f64>
where
    B: System<Dual, N, G>,
{
    let mut matrix = DMatrix::zeros(N, N + 1);
    for column in 0..=N {
        let seeded = SVector::<Dual, N>::from_fn(|k, _| Dual::new(x[k], if k == column { 1.0 } else { 0.0 }));
        let time = Dual::new(t, if column == N { 1.0 } else { 0.0 });
        let mut rate = SVector::repeat(Dual::new(0.0, 0.0));
        twin.rate(time, &seeded, negative, &mut rate);
        (0..N).for_each(|row| matrix[(row, column)] = rate[row].slope);
    }
    matrix
}

/// Compares the Jacobian with dual numbers at this point.
fn is_the_derivative<A, B, const N: usize, const G: usize>(
    (model, twin): (&A, &B),
    t: f64,
    x: &SVector<f64, N>,
    negative: &[bool; G],
) -> f64
where
    A: System<f64, N, G>,
    B: System<Dual, N, G>,
{
    let (mut rate, mut inlined) = (SVector::zeros(), SVector::zeros());
    model.rate(t, x, negative, &mut rate);
    model.always_inlined_rate(t, x, negative, &mut inlined);
    assert_eq!(rate, inlined, "the rate without pairs at {x:?}");
    model.paired_rate(t, x, negative, &mut inlined);
    assert_eq!(rate, inlined, "the rate in pairs at {x:?}");
    let (_, found, slope) = jacobian(model, t, x, negative);
    let damping = damping(model, t, x, negative);
    let second_order = model.second_order().map_or(0..0, |second| second.states());
    let expected = differentiated(twin, t, x, negative);
    let opposite = differentiated(twin, t, x, &negative.map(|is_negative| !is_negative));
    let mut largest: f64 = 0.0;
    for row in 0..N {
        let size = expected.row(row).amax().max(opposite.row(row).amax());
        for column in 0..=N {
            let found = if column == N { slope[row] } else { found[(row, column)] };
            let value = expected[(row, column)];
            let scale = value.abs().max(1e-2 * size);
            let error = (found - value).abs() / if scale > 0.0 { scale } else { 1.0 };
            assert!(error <= DERIVATIVE, "entry {row}, {column}: {found:e}, not {value:e}, at {x:?}");
            largest = largest.max(error);
            if column < N && !second_order.contains(&row) && !second_order.contains(&column) {
                let found = damping[(row, column)];
                let error = (found - value).abs() / if scale > 0.0 { scale } else { 1.0 };
                assert!(error <= DERIVATIVE, "damping {row}, {column}: {found:e}, not {value:e}, at {x:?}");
            }
        }
    }
    largest
}

/// Compares the second derivatives of the states of second order with those that dual numbers give along the flow at this
/// point; the other rates must stay. Gives how many states are of second order.
fn second_derivatives_agree<A, B, const N: usize, const G: usize>(
    (model, twin): (&A, &B),
    t: f64,
    x: &SVector<f64, N>,
    negative: &[bool; G],
) -> usize
where
    A: System<f64, N, G>,
    B: System<Dual, N, G>,
{
    let mut rate = SVector::zeros();
    model.rate(t, x, negative, &mut rate);
    let mut found = rate;
    if let Some(second) = model.second_order() {
        second.second_derivatives(x, &mut found);
    }
    let moving = SVector::<Dual, N>::from_fn(|k, _| Dual::new(x[k], rate[k]));
    let mut expected = SVector::repeat(Dual::new(0.0, 0.0));
    twin.rate(Dual::new(t, 1.0), &moving, negative, &mut expected);
    let of_second_order = model.second_order().map_or(0..0, |second| second.states());
    let mut forces = rate;
    if let Some(second) = model.second_order() {
        second.forces(t, x, negative, &mut forces);
    }
    for (k, (force, value)) in forces.iter().zip(&found).enumerate() {
        let scale = value.abs().max(1e-2 * found.amax());
        assert!((force - value).abs() <= DERIVATIVE * scale, "state {k}: {force:e}, not {value:e}, at {x:?}");
    }
    for k in 0..N {
        if of_second_order.contains(&k) {
            let (value, scale) = (expected[k].slope, expected[k].slope.abs().max(1e-2 * rate.amax()));
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

/// The residual of (I - c J) y = b relative to |I - c J| |y| + |b|, maximum norms; none where a pivot is small.
fn residual<F, Mo, const N: usize, const G: usize>(
    model: &Mo,
    c: F,
    (entries, matrix): (&[f64], &DMatrix<f64>),
    b: &[F; N],
) -> Option<f64>
where
    F: Field<f64>,
    Mo: System<f64, N, G>,
{
    let elimination = model.linearised()?.elimination()?;
    let mut factors = vec![F::real(f64::NAN); elimination.factors()];
    if !elimination.eliminate(c, entries, &mut factors) {
        return None;
    }
    let mut y = *b;
    elimination.substitute(&factors, &mut y);
    let (mut rest, mut norm): (f64, f64) = (0.0, 0.0);
    for row in 0..N {
        let products = (0..N).map(|column| c.scaled(matrix[(row, column)]) * y[column]);
        let sum = products.fold(b[row] - y[row], |sum, product| sum + product);
        assert!(sum.size().is_finite(), "an unusable solution");
        rest = rest.max(sum.size());
        norm = norm.max(1.0 + (0..N).map(|column| c.scaled(matrix[(row, column)]).size()).sum::<f64>());
    }
    let largest = |of: &[F]| of.iter().fold(0.0_f64, |largest, part| largest.max(part.size()));
    Some(rest / (norm * largest(&y) + largest(b)))
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
fn solve<Mo, const N: usize, const G: usize>(
    model: &Mo,
    t: f64,
    x: &SVector<f64, N>,
    negative: &[bool; G],
    draw: &mut Draw,
    solved: &mut Solved,
) where
    Mo: System<f64, N, G>,
{
    let (entries, matrix, _) = jacobian(model, t, x, negative);
    for round in 0..8 {
        let is_large = round % 4 == 3;
        let c = 10.0_f64.powf(if is_large { 2.0 * draw.number() } else { -5.0 + 3.0 * draw.number() });
        let turned = Complex::new(c, c * draw.number());
        let b: [f64; N] = std::array::from_fn(|_| draw.number());
        let complex: [Complex<f64>; N] = std::array::from_fn(|k| Complex::new(b[k], draw.number()));
        let given = (&entries[..], &matrix);
        for found in [residual(model, c, given, &b), residual(model, turned, given, &complex)] {
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
fn agrees<A, B, const N: usize, const G: usize, const M: usize>(model: &A, twin: &B)
where
    A: Model<f64, N, G, M>,
    B: Model<Dual, N, G, M>,
{
    let mut draw = Draw::new(3);
    let (mut derivative, mut rounds): (f64, usize) = (0.0, 0);
    let mut solved = Solved::default();
    let mut second = 0;
    for round in 0..12 {
        let x = state(model, &mut draw);
        let t = 1.0 + draw.number();
        let negative = [round % 2 == 0; G];
        // A law may have no value at a random state.
        if differentiated(twin, t, &x, &negative).iter().any(|value| !value.is_finite()) {
            continue;
        }
        rounds += 1;
        derivative = derivative.max(is_the_derivative((model, twin), t, &x, &negative));
        second = second_derivatives_agree((model, twin), t, &x, &negative);
        solve(model, t, &x, &negative, &mut draw, &mut solved);
    }
    let name = model.description().name;
    println!("{name}: {N} states, {second} of second order, {rounds} rounds, derivatives {derivative:.1e}, {solved:?}");
    assert!(rounds >= 4, "{rounds} rounds");
    assert!(solved.refused <= rounds, "{solved:?}");
}

/// An input that changes in time.
fn wave() -> Input {
    Input::with_rate(|t| 0.7 + (3.0 * t).sin(), |t| 3.0 * (3.0 * t).cos())
}

macro_rules! example_agrees {
    ($($test:ident: $module:ident $model:ident ($parameters:ident $(, $inputs:ident { $($input:ident),* })?);)*) => {$(
        #[test]
        fn $test() {
            use models::$module::{$model, $parameters $(, $inputs)?};
            let model = $model::new($parameters::default() $(, $inputs { $($input: wave()),* })?);
            let twin = $model::<Dual>::in_scalar($parameters::default() $(, $inputs { $($input: wave()),* })?);
            agrees(&model.unwrap(), &twin.unwrap());
        }
    )*};
}

mod examples {
    use super::*;

    each_example!(example_agrees);
}

macro_rules! scene_agrees {
    ($($test:ident: $model:ident ($parameters:ident);)*) => {$(
        #[test]
        fn $test() {
            let model = $model::new($parameters::default()).unwrap();
            agrees(&model, &$model::<Dual>::in_scalar($parameters::default()).unwrap());
            along_the_trajectory(&model);
        }
    )*};
}

mod scenes {
    use super::*;

    each_scene!(scene_agrees);
}

/// Solves at 20 states of the first 0.1 s; with steps up to 1e-2 s no pivot is small there.
fn along_the_trajectory<Mo, const N: usize, const G: usize, const M: usize>(model: &Mo)
where
    Mo: Model<f64, N, G, M>,
{
    let mut draw = Draw::new(4);
    let mut solved = Solved::default();
    for (t, x, negative) in along(model, 0.1) {
        solve(model, t, &x, &negative, &mut draw, &mut solved);
    }
    println!("{}: along the trajectory {solved:?}", model.description().name);
    assert_eq!(solved.refused, 0);
}

/// Its functions have loops.
#[test]
fn a_model_that_repeats_itself_along_its_motion() {
    use models::long::{Rope, RopeParameters};
    let model = Rope::new(RopeParameters::default()).unwrap();
    let twin = Rope::<Dual>::in_scalar(RopeParameters::default()).unwrap();
    for (t, x, negative) in along(&model, 0.05) {
        is_the_derivative((&model, &twin), t, &x, &negative);
        second_derivatives_agree((&model, &twin), t, &x, &negative);
    }
    along_the_trajectory(&model);
}

/// Its functions are in parts, and depend on switches.
#[test]
fn a_long_model_along_its_motion() {
    use models::long::{Whip, WhipParameters};
    let model = Whip::new(WhipParameters::default()).unwrap();
    let twin = Whip::<Dual>::in_scalar(WhipParameters::default()).unwrap();
    for (t, x, negative) in along(&model, 0.5) {
        is_the_derivative((&model, &twin), t, &x, &negative);
        second_derivatives_agree((&model, &twin), t, &x, &negative);
    }
    along_the_trajectory(&model);
}

#[test]
fn a_dense_solution_is_the_same() {
    let model = Paper::new(PaperParameters::default()).unwrap();
    let x = model.start().unwrap();
    let (entries, matrix, _) = jacobian(&model, 0.0, &x, &[false; Paper::SWITCHES]);
    let mut factors = vec![0.0; model.factors()];
    let mut draw = Draw::new(5);
    for c in [1e-8, 1e-5, 1e-3, 1e-2] {
        let b: [f64; Paper::STATES] = std::array::from_fn(|_| draw.number());
        assert!(model.eliminate(c, &entries, &mut factors));
        let mut y = b;
        model.substitute(&factors, &mut y);
        let dense = DMatrix::identity(Paper::STATES, Paper::STATES) - &matrix * c;
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
    let x = SVector::from([1.0]);
    for negative in [false, true] {
        let (entries, matrix, _) = jacobian(&model, 0.0, &x, &[negative]);
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
fn counts<Mo, const N: usize, const G: usize, const M: usize>(model: &Mo) -> [usize; 5]
where
    Mo: Model<f64, N, G, M> + Linearised<f64, N, G> + Elimination<f64, N>,
{
    let operations = |wanted: &str| {
        let found = model.description().operations.iter().find(|(name, _)| *name == wanted);
        found.expect("every function is listed").1.total()
    };
    [
        model.sparsity().len(N),
        model.factors(),
        operations("jacobian"),
        operations("eliminate"),
        operations("substitute"),
    ]
}

#[test]
fn counts_of_the_hacksaw() {
    assert_eq!(counts(&Paper::new(PaperParameters::default()).unwrap()), [243, 251, 779, 869, 486]);
    assert_eq!(counts(&Hacksaw::new(HacksawParameters::default()).unwrap()), [1696, 1750, 9368, 15366, 3443]);
}
