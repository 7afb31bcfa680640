//! The unknowns of an algebraic loop that is not linear.
//!
//! In: equations with their derivatives. Out: a solution to rounding, or numbers that are none.
//! Method: Newton's iteration with the affine-invariant choice of the part of a step that is taken (Deuflhard 2004,
//! Newton Methods for Nonlinear Problems, section 3.3.2): the correction at the new place, by the old derivatives, has
//! to be smaller; of one unknown, between places at which the residual has opposite signs. It begins at zero; where
//! that leads nowhere, at some other places in a fixed order, so that the same state always gives the same bits.

use nalgebra::allocator::Allocator;
use nalgebra::{DefaultAllocator, Dim, DimMin, OMatrix, OVector, U1};

use crate::model::scalar::Scalar;

/// Where the iteration begins, one after the other, in the unknowns' own units: nothing is known of their sizes. What
/// is found is right to rounding from any of them; of an equation with several solutions they may say which.
const STARTS: [f64; 9] = [0.0, 1.0, -1.0, 1e-3, -1e-3, 1e3, -1e3, 1e6, -1e6];
/// Steps from one start.
const MOST_STEPS: u32 = 60;
/// Steps and halves between two places: halves alone meet from any two numbers after fewer.
const MOST_HALVES: u32 = 2200;
/// The smallest part of a step that is tried.
const SMALLEST_PART: f64 = 1e-5;
/// A relative step that is small enough: two more leave nothing but rounding.
const SMALL: f64 = 1e-9;
/// A residual beside the sum of its terms that is nothing but rounding.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// So many equations of as many unknowns, in memory of that size: on the stack where the number is in the type.
pub trait Unknowns: Dim + DimMin<Self, Output = Self> {}

impl<D: Dim + DimMin<Self, Output = Self>> Unknowns for D {}

/// Equations at a place.
#[derive(Clone, Debug)]
pub struct Equations<D: Unknowns>
where
    DefaultAllocator: Allocator<D> + Allocator<D, D>,
{
    residuals: OVector<f64, D>,
    sizes: OVector<f64, D>,
    slopes: OMatrix<f64, D, D>,
}

impl<D: Unknowns> Equations<D>
where
    DefaultAllocator: Allocator<D> + Allocator<D, D>,
{
    /// From residuals, the sums of the absolute values of their terms, and their derivatives row by row.
    pub fn of<S: Scalar>(unknowns: D, values: &[S]) -> Self {
        let count = unknowns.value();
        let (residuals, rest) = values.split_at(count);
        let (sizes, slopes) = rest.split_at(count);
        Self {
            residuals: OVector::from_fn_generic(unknowns, U1, |row, _| residuals[row].to_f64()),
            sizes: OVector::from_fn_generic(unknowns, U1, |row, _| sizes[row].to_f64()),
            slopes: OMatrix::from_fn_generic(unknowns, unknowns, |row, column| slopes[row * count + column].to_f64()),
        }
    }

    fn is_zero(&self) -> bool {
        let mut both = self.residuals.iter().zip(&self.sizes);
        both.all(|(residual, size)| residual.is_finite() && residual.abs() <= ROUNDING * size)
    }
}

/// Solves `equations`, which gives the equations at a place; not numbers where it finds no solution.
pub fn newton<D: Unknowns>(unknowns: D, mut equations: impl FnMut(&[f64]) -> Equations<D>) -> OVector<f64, D>
where
    DefaultAllocator: Allocator<D> + Allocator<D, D>,
{
    let found = if unknowns.value() == 1 {
        let found = bracketed(&mut |place| Point::at(place, &equations(&[place])));
        found.map(|place| OVector::from_fn_generic(unknowns, U1, |_, _| place))
    } else {
        // Not the same for all unknowns: symmetric equations have no regular derivatives there.
        let place = |start: f64| OVector::from_fn_generic(unknowns, U1, |row, _| start * (1.0 + 0.1 * row as f64));
        STARTS.iter().find_map(|&start| damped(place(start), &mut equations))
    };
    let Some(near) = found else { return OVector::from_fn_generic(unknowns, U1, |_, _| f64::NAN) };
    // Derivatives are those at the place that is found: it has to be right to rounding.
    let last = equations(near.as_slice());
    match last.slopes.lu().solve(&last.residuals).filter(is_finite) {
        Some(step) => near - step,
        None => near,
    }
}

/// Numbers in a scalar.
pub fn lift<S: Scalar>(of: &[f64], to: &mut [S]) {
    to.iter_mut().zip(of).for_each(|(to, &of)| *to = S::from_f64(of));
}

/// Newton's iteration from a place on, with parts of its steps.
fn damped<D: Unknowns>(
    mut place: OVector<f64, D>,
    equations: &mut impl FnMut(&[f64]) -> Equations<D>,
) -> Option<OVector<f64, D>>
where
    DefaultAllocator: Allocator<D> + Allocator<D, D>,
{
    let mut here = equations(place.as_slice());
    for _ in 0..MOST_STEPS {
        if here.is_zero() {
            return Some(place);
        }
        let factors = here.slopes.lu();
        let step = factors.solve(&here.residuals).filter(is_finite)?;
        if step.iter().zip(&place).all(|(step, place)| step.abs() <= SMALL * place.abs()) {
            return Some(place - step);
        }
        let weights = step.zip_map(&place, |step, place| step.abs().max(place.abs()).max(f64::MIN_POSITIVE));
        let length = |step: &OVector<f64, D>| step.component_div(&weights).amax();
        let mut part = 1.0;
        (place, here) = loop {
            let next = &place - &step * part;
            let there = equations(next.as_slice());
            let left = factors.solve(&there.residuals).filter(is_finite);
            if there.is_zero() || left.is_some_and(|left| length(&left) <= (1.0 - part / 4.0) * length(&step)) {
                break (next, there);
            }
            part *= 0.5;
            if part < SMALLEST_PART {
                return None;
            }
        };
    }
    None
}

fn is_finite<D: Unknowns>(of: &OVector<f64, D>) -> bool
where
    DefaultAllocator: Allocator<D>,
{
    of.iter().all(|value| value.is_finite())
}

/// One equation at a place.
#[derive(Clone, Copy, Debug)]
struct Point {
    place: f64,
    residual: f64,
    /// What Newton's iteration adds to the place.
    step: f64,
    is_zero: bool,
}

impl Point {
    fn at<D: Unknowns>(place: f64, equations: &Equations<D>) -> Self
    where
        DefaultAllocator: Allocator<D> + Allocator<D, D>,
    {
        let (residual, slope) = (equations.residuals[0], equations.slopes[(0, 0)]);
        Self { place, residual, step: -residual / slope, is_zero: equations.is_zero() }
    }

    fn is_opposite(&self, other: &Self) -> bool {
        self.residual.is_sign_negative() != other.residual.is_sign_negative()
    }
}

/// The solution of one equation: two places between which the residual changes its sign are looked for along Newton's
/// steps, lengthened, then they are brought together by these steps and by halves (Dekker 1969, Finding a zero by means
/// of successive linear interpolation).
fn bracketed(point: &mut impl FnMut(f64) -> Point) -> Option<f64> {
    let start = STARTS.iter().map(|&start| point(start)).find(|start| !start.residual.is_nan())?;
    let (mut near, mut reach) = (start, start.step);
    for _ in 0..MOST_STEPS {
        if near.is_zero {
            return Some(near.place);
        }
        if reach.abs() <= SMALL * near.place.abs() {
            return Some(near.place + reach);
        }
        if !reach.is_finite() {
            break;
        }
        let far = point(near.place + reach);
        if far.residual.is_nan() {
            reach *= 0.25;
        } else if far.is_opposite(&near) {
            return between(near, far, point);
        } else if far.step * reach < 0.0 {
            break;
        } else {
            // Along an exponential each step is as long as the one before it.
            let is_slow = far.step.abs() > 0.5 * near.step.abs();
            reach = if is_slow { 2.0 * reach } else { far.step };
            near = far;
        }
    }
    let mut others = STARTS.iter().map(|&start| point(start)).filter(|other| !other.residual.is_nan());
    let other = others.find(|other| other.is_opposite(&start))?;
    between(start, other, point)
}

/// The solution between two places with residuals of opposite signs.
fn between(mut a: Point, mut b: Point, point: &mut impl FnMut(f64) -> Point) -> Option<f64> {
    let mut here = if a.residual.abs() < b.residual.abs() { a } else { b };
    let mut before = f64::INFINITY;
    for _ in 0..MOST_HALVES {
        if here.is_zero {
            return Some(here.place);
        }
        if here.step.abs() <= SMALL * here.place.abs() {
            return Some(here.place + here.step);
        }
        let (low, high) = (a.place.min(b.place), a.place.max(b.place));
        let next = here.place + here.step;
        // Steps that do not shrink are no progress.
        let is_good = next > low && next < high && here.step.abs() < 0.5 * before;
        let next = if is_good { next } else { low + 0.5 * (high - low) };
        if next <= low || next >= high {
            // The residual jumps over zero.
            return None;
        }
        before = (next - here.place).abs();
        here = point(next);
        if here.residual.is_nan() {
            return None;
        }
        *if here.is_opposite(&a) { &mut b } else { &mut a } = here;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The solution of one equation and how often it was evaluated.
    fn solved(equation: impl Fn(f64) -> (f64, f64, f64)) -> (f64, u32) {
        let mut evaluations = 0;
        let found = newton(U1, |u| {
            evaluations += 1;
            let (residual, size, slope) = equation(u[0]);
            Equations::of(U1, &[residual, size, slope])
        });
        (found[0], evaluations)
    }

    #[test]
    fn one_equation_is_solved_from_far_away() {
        // A valve: u + u |u| = 12, a diode: 1e-9 (exp(40 u) - 1) + u = 5, a saturation: atan(u) = 1.5.
        let valve = solved(|u| (u + u * u.abs() - 12.0, u.abs() + u * u + 12.0, 1.0 + 2.0 * u.abs()));
        assert!((valve.0 - 3.0).abs() < 1e-8 && valve.1 < 12, "{valve:?}");
        let diode = solved(|u| {
            let e = 1e-9 * (40.0 * u).exp();
            (e + u - 5.0, e + u.abs() + 5.0, 40.0 * e + 1.0)
        });
        let left = 1e-9 * (40.0 * diode.0).exp() + diode.0 - 5.0;
        assert!(left.abs() < 1e-6 && diode.1 < 60, "{diode:?} {left:e}");
        let saturation = solved(|u| (u.atan() - 1.5, u.abs().atan() + 1.5, 1.0 / (1.0 + u * u)));
        assert!((saturation.0 - 1.5_f64.tan()).abs() < 1e-7, "{saturation:?}");
    }

    #[test]
    fn a_diode_takes_a_hundred_thousand_times_its_voltage() {
        for rest in [-4000.0, -1.0, 0.5, 10.0, 300.0, 4000.0] {
            // By the current: the exponential overflows at zero.
            let (current, evaluations) = solved(|i| {
                let e = 1e-9 * ((rest - 50.0 * i) / 0.05_f64).exp();
                (i - e + 1e-9, i.abs() + e + 1e-9, 1.0 + 1e3 * e)
            });
            let e = 1e-9 * ((rest - 50.0 * current) / 0.05_f64).exp();
            let step = (current - e + 1e-9) / (1.0 + 1e3 * e);
            println!("{rest} V: {evaluations} evaluations");
            assert!(step.abs() <= 1e-12 * f64::abs(current), "{rest}: {current} {step:e}");
            assert!(evaluations < 60, "{rest}: {evaluations}");
        }
    }

    #[test]
    fn what_is_only_rounding_is_zero() {
        // The residual is (1e7 + u) - 1e7 - 1e-10, which rounding makes a multiple of 1.9e-9.
        let (found, evaluations) = solved(|u| ((1e7 + u) - 1e7 - 1e-10, 2e7, 1.0));
        assert!(found.abs() < 1e-8 && evaluations < 5, "{found:e} {evaluations}");
    }

    #[test]
    fn what_has_no_solution_is_not_a_number() {
        assert!(solved(|u| (u * u + 1.0, u * u + 1.0, 2.0 * u)).0.is_nan());
        assert!(solved(|_| (f64::NAN, 1.0, 1.0)).0.is_nan());
    }

    #[test]
    fn equations_that_need_each_other_are_solved() {
        // x^2 + y^2 = 4, x y = 1, in memory of either kind.
        fn solved<D: Unknowns>(two: D) -> [f64; 2]
        where
            DefaultAllocator: Allocator<D> + Allocator<D, D>,
        {
            let found = newton(two, |u| {
                let (x, y) = (u[0], u[1]);
                let residuals = [x * x + y * y - 4.0, x * y - 1.0];
                let sizes = [x * x + y * y + 4.0, (x * y).abs() + 1.0];
                Equations::of(two, &[residuals, sizes, [2.0 * x, 2.0 * y], [y, x]].concat())
            });
            [found[0], found[1]]
        }
        let [x, y] = solved(nalgebra::U2);
        assert!((x * x + y * y - 4.0).abs() < 1e-7 && (x * y - 1.0).abs() < 1e-7, "{x} {y}");
        assert_eq!(solved(nalgebra::Dyn(2)), [x, y]);
    }
}
