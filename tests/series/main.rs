//! Generated Taylor series are those of the generated rates: the derivative of the polynomial is the rate along it.
//!
//! Held for every example and every scene of the hacksaw at random states, every switch in either branch, over a time
//! so short that what the polynomial leaves out is below rounding, and so long that its later terms are not.

use bg_model::capability::Series;
use bg_model::input::Input;
use bg_model::nalgebra::SVector;
use bg_model::system::{Model, System};
use bond_graph_tests::models;
use bond_graph_tests::support::power::{Draw, state};
use bond_graph_tests::support::record::along;
use bond_graph_tests::{each_example, each_scene};
use hacksaw::mechanism::{
    Angles, AnglesParameters, FreeRun, FreeRunParameters, Full, FullParameters, Hacksaw, HacksawParameters, Motion,
    MotionParameters, Paper, PaperParameters, Rigid, RigidParameters,
};

/// The order of the polynomials.
const ORDER: usize = 12;
/// The largest last term over the largest term of any state.
const LAST: f64 = 1e-14;
/// The largest difference between the derivative and the rate, relative to the sum of the derivative's terms.
const DIFFERENCE: f64 = 1e-11;

type Polynomial<const N: usize> = [SVector<f64, N>; ORDER + 1];

/// The series from time `t` and state `x` in units of `h`.
fn series<Mo, const N: usize, const G: usize>(
    model: &Mo,
    (t, h): (f64, f64),
    x: &SVector<f64, N>,
    negative: &[bool; G],
) -> Polynomial<N>
where
    Mo: System<f64, N, G>,
{
    let mut polynomial = [SVector::repeat(f64::NAN); ORDER + 1];
    polynomial[0] = *x;
    let series = model.series().expect("constant inputs only");
    series.expand(t, h, negative, &mut vec![f64::NAN; ORDER * series.width()], &mut polynomial);
    polynomial
}

/// The sum of the terms at the part `theta` of the unit, each times what `factor` makes of its order.
fn sum<const N: usize>(polynomial: &Polynomial<N>, theta: f64, factor: impl Fn(usize) -> f64) -> SVector<f64, N> {
    let terms = polynomial.iter().enumerate();
    terms.fold(SVector::zeros(), |sum, (k, term)| sum + term * (factor(k) * theta.powi(k as i32)))
}

/// The polynomial from here with the unit of time that makes its last terms small, and that unit.
fn short<Mo, const N: usize, const G: usize>(
    model: &Mo,
    t: f64,
    x: &SVector<f64, N>,
    negative: &[bool; G],
) -> Option<(Polynomial<N>, f64)>
where
    Mo: System<f64, N, G>,
{
    let mut h = 1.0;
    for _ in 0..60 {
        let polynomial = series(model, (t, h), x, negative);
        let largest = polynomial[1..].iter().map(|term| term.amax()).fold(0.0, f64::max);
        let last = polynomial[ORDER].amax().max(polynomial[ORDER - 1].amax());
        if polynomial.iter().any(|term| term.iter().any(|value| value.is_nan())) {
            return None;
        }
        if last <= LAST * largest {
            return Some((polynomial, h));
        }
        h *= 0.7;
    }
    None
}

/// Holds the polynomials at random states; a law may have no value, or no derivative, at some of them.
fn agrees<Mo, const N: usize, const G: usize, const M: usize>(model: &Mo)
where
    Mo: Model<f64, N, G, M>,
{
    let mut draw = Draw::new(7);
    let points = (0..12).map(|round| {
        let x = state(model, &mut draw);
        (1.0 + draw.number(), x, [round % 2 == 0; G])
    });
    let points: Vec<_> = points.collect();
    agrees_at(model, &points, 1e-6);
}

/// Holds the polynomials at these times, states and branches. Rates are compared as if each had at least the part
/// `floor` of the largest.
fn agrees_at<Mo, const N: usize, const G: usize, const M: usize>(
    model: &Mo,
    points: &[(f64, SVector<f64, N>, [bool; G])],
    floor: f64,
) where
    Mo: Model<f64, N, G, M>,
{
    let (mut largest, mut rounds): (f64, usize) = (0.0, 0);
    for (t, x, negative) in points {
        let Some((polynomial, h)) = short(model, *t, x, negative) else { continue };
        rounds += 1;
        for theta in [0.4, 0.7, 1.0] {
            let mut rate = SVector::zeros();
            model.rate(t + theta * h, &sum(&polynomial, theta, |_| 1.0), negative, &mut rate);
            let slope = sum(&polynomial, theta, |k| k as f64) / theta;
            let scale = polynomial.iter().enumerate().map(|(k, term)| term.amax() * k as f64).sum::<f64>();
            for k in 0..N {
                let own: f64 = polynomial.iter().enumerate().map(|(order, term)| term[k].abs() * order as f64).sum();
                let difference = (slope[k] - h * rate[k]).abs() / (own + floor * scale);
                largest = largest.max(difference);
            }
        }
    }
    println!("{}: {N} states, {rounds} rounds, {largest:.1e}", model.description().name);
    assert!(rounds >= 4, "{rounds} rounds");
    assert!(largest <= DIFFERENCE, "{largest:e}");
}

/// An input that does not change.
fn steady() -> Input {
    Input::constant(0.7)
}

macro_rules! example_agrees {
    ($($test:ident: $module:ident $model:ident ($parameters:ident $(, $inputs:ident { $($input:ident),* })?);)*) => {$(
        #[test]
        fn $test() {
            use models::$module::{$model, $parameters $(, $inputs)?};
            agrees(&$model::new($parameters::default() $(, $inputs { $($input: steady()),* })?).unwrap());
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
            agrees(&$model::new($parameters::default()).unwrap());
        }
    )*};
}

mod scenes {
    use super::*;

    each_scene!(scene_agrees);
}

/// Its series are in parts, and depend on switches.
#[test]
fn a_long_model_along_its_motion() {
    let model = models::long::Whip::new(models::long::WhipParameters::default()).unwrap();
    // Joints hold momenta at rest, whose rates are rounding.
    agrees_at(&model, &along(&model, 0.5), 1e-3);
}

/// Its series has loops.
#[test]
fn a_model_that_repeats_itself() {
    agrees(&models::long::Rope::new(models::long::RopeParameters::default()).unwrap());
}

#[test]
fn an_input_that_changes_leaves_no_series() {
    use models::dc_motor::{DcMotor, DcMotorInputs, DcMotorParameters};
    let motor = |voltage| DcMotor::new(DcMotorParameters::default(), DcMotorInputs { voltage }).unwrap();
    let has_series = |voltage| motor(voltage).series().is_some();
    assert!(has_series(Input::constant(12.0)));
    assert!(!has_series(Input::function(|t| t)));
    assert!(!has_series(Input::with_rate(|t| t, |_| 1.0)));
}

/// Twice the products of two factors that change, in fours, and the places of quotients and functions.
#[test]
fn widths_of_the_hacksaw() {
    assert_eq!(Paper::new(PaperParameters::default()).unwrap().width(), 120);
    assert_eq!(FreeRun::new(FreeRunParameters::default()).unwrap().width(), 72);
    assert_eq!(Hacksaw::new(HacksawParameters::default()).unwrap().width(), 576);
}
