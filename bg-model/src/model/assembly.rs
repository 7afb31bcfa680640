//! Assembly: moves a guessed start pose until every loop is closed.
//!
//! In: the guessed coordinates and a function that gives the gaps of the joints. Out: the nearest coordinates, to first
//! order, at which the gaps vanish to rounding, or the joints that stay open. Method: see `nearest`.

use alloc::format;
use alloc::string::{String, ToString};
use alloc::vec;
use alloc::vec::Vec;

use nalgebra::DVector;
use thiserror::Error;

use crate::model::holding::{Redundancy, Slipping};
use crate::model::nearest::nearest;
use crate::model::requirement::Impossible;

/// The largest gap of a closed joint, as a part of the machine's size in its unit; of an angle, of a radian at least.
pub const CLOSED: f64 = 1e-10;
/// A gap that is a larger part than this one is more than rounding.
const EXACT: f64 = 1e-13;

/// One residual row: a component of the gap of a joint.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gap {
    /// The joint's name.
    pub joint: &'static str,
    /// Which component, such as `x`; empty where the gap has only one.
    pub component: &'static str,
    /// Its unit, `m` or `rad`.
    pub unit: &'static str,
}

impl Gap {
    /// ` in x`, or nothing where the gap has only one component.
    fn direction(&self) -> String {
        if self.component.is_empty() { String::new() } else { format!(" in {}", self.component) }
    }
}

/// A gap that stays open.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenGap {
    /// Which gap.
    pub gap: Gap,
    /// Its signed size, in the gap's unit.
    pub size: f64,
    /// The largest that would be closed, in the gap's unit.
    pub allowed: f64,
}

impl core::fmt::Display for OpenGap {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "`{}` by {:.2e} {}{}", self.gap.joint, self.size, self.gap.unit, self.gap.direction())
    }
}

/// A mechanism that cannot be put together near the guess.
#[derive(Clone, PartialEq, Error)]
pub enum AssemblyError {
    /// Some joints stay open by more than [`CLOSED`] allows.
    #[error("the mechanism does not close: joint {largest} (allowed: {:.0e}){}", .largest.allowed, also_open(.others))]
    Open {
        /// The largest gap.
        largest: OpenGap,
        /// The other joints that stay open, each with its largest gap.
        others: Vec<OpenGap>,
    },
    /// A gap is not a finite number at the guess or near it.
    #[error("the gap of joint `{}`{} is not a finite number: {value}", .gap.joint, .gap.direction())]
    NonFinite {
        /// Which gap.
        gap: Gap,
        /// Its value.
        value: f64,
    },
    /// A start value cannot be, such as an orientation that is no rotation.
    #[error(transparent)]
    Impossible(#[from] Impossible),
    /// Some joints are torn apart by the start velocities, by more than the part
    /// [`FITTING`](crate::model::holding::FITTING) of what could move there.
    #[error(
        "the start velocities do not fit: joint {largest} (allowed: {allowed:.0e}){}; \
         correct them, give `guess(..)` to those that may change{}",
        also_torn(.others), or_impulse(.largest)
    )]
    Torn {
        /// The fastest.
        largest: Slipping,
        /// The fastest that would fit, in its unit.
        allowed: f64,
        /// The other joints that are torn apart, each with its fastest motion.
        others: Vec<Slipping>,
    },
    /// Rigid joints hold the same motion at the start but not near it: the start pose is singular.
    #[error("the start pose is singular: in it {0}; start a little beside it, or make one of them compliant")]
    Redundant(Redundancy),
    /// Rigid joints leave no motion, and no source gives one.
    #[error(
        "the mechanism cannot move: rigid joints {} hold it together in every direction; \
         leave one of them out, make it compliant, or give it another free axis", quoted(.joints)
    )]
    Immobile {
        /// The joints that clash: those that hold what others hold, or all where each holds something of its own.
        joints: Vec<&'static str>,
    },
}

fn quoted(names: &[&str]) -> String {
    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

fn also_torn(others: &[Slipping]) -> String {
    if others.is_empty() {
        return String::new();
    }
    let names: Vec<String> = others.iter().map(ToString::to_string).collect();
    format!("; also {}", names.join(", "))
}

fn or_impulse(of: &Slipping) -> &'static str {
    if of.is_rigid { ", or write `start impulse;`" } else { "" }
}

debug_is_display!(AssemblyError);

fn also_open(others: &[OpenGap]) -> String {
    if others.is_empty() {
        return String::new();
    }
    let names: Vec<String> = others.iter().map(ToString::to_string).collect();
    format!("; also open: {}", names.join(", "))
}

/// A pose in which the joints are closed.
#[derive(Clone, Debug, PartialEq)]
pub struct Closed {
    /// The coordinates.
    pub coordinates: Vec<f64>,
    /// Whether the gaps are closed to rounding; where not, no coordinate closes what is left of them.
    pub is_exact: bool,
}

/// The coordinates nearest to `guess`, to first order, at which all gaps are closed.
///
/// `residual` writes one value for each of `gaps`, in its unit (m or rad), for the given coordinates, `extents` how
/// large the machine is in that unit. Redundant gaps and coordinates without influence are allowed. Without coordinates
/// the gaps are only checked. Allocates.
///
/// # Errors
/// [`AssemblyError::Open`] if a gap stays above [`CLOSED`] (1e-10 of the machine's size),
/// [`AssemblyError::NonFinite`] if a gap is not a number.
pub fn close(
    guess: &[f64],
    gaps: &'static [Gap],
    residual: &dyn Fn(&[f64], &mut [f64]),
    extents: &dyn Fn(&[f64], &mut [f64]),
) -> Result<Closed, AssemblyError> {
    // Half a radian, or half the size of the coordinates, so that the pose is not thrown over into another one that
    // closes as well. Gaps are linear in lengths, so those of a small machine go where the angles want them.
    let largest = |of: &[f64]| of.iter().fold(0.0_f64, |largest, of| largest.max(of.abs()));
    let longest = |coordinates: &[f64]| 0.5 * largest(coordinates).max(1.0);
    let found = nearest(guess, gaps.len(), &longest, residual);
    let not_finite = |(row, value): (usize, f64)| AssemblyError::NonFinite { gap: gaps[row], value };
    let (coordinates, sizes) = found.map_err(not_finite)?;
    let mut all = vec![0.0; gaps.len()];
    extents(&coordinates, &mut all);
    let is_exact = check_closed(gaps, &sizes, &all)?;
    Ok(Closed { coordinates, is_exact })
}

/// Whether the gaps are closed to rounding.
fn check_closed(gaps: &[Gap], sizes: &DVector<f64>, extents: &[f64]) -> Result<bool, AssemblyError> {
    let machine = |unit: &str| {
        let of_unit = gaps.iter().zip(extents).filter(|(gap, _)| gap.unit == unit);
        // A radian is the size of an angle, whatever the machine.
        let least = if unit == "rad" { 1.0 } else { 0.0 };
        of_unit.fold(least, |largest: f64, (_, &extent)| largest.max(extent))
    };
    let is_exact = gaps.iter().zip(sizes).all(|(gap, size)| size.abs() <= EXACT * machine(gap.unit));
    let allowed = |unit: &str| CLOSED * machine(unit);
    let mut joints: Vec<OpenGap> = Vec::new();
    for (&gap, &size) in gaps.iter().zip(sizes.iter()) {
        let open = OpenGap { gap, size, allowed: allowed(gap.unit) };
        if size.abs() <= open.allowed {
            continue;
        }
        match joints.iter_mut().find(|other| other.gap.joint == gap.joint) {
            Some(other) if other.size.abs() >= size.abs() => {}
            Some(other) => *other = open,
            None => joints.push(open),
        }
    }
    joints.sort_by(|a, b| b.size.abs().total_cmp(&a.size.abs()));
    if joints.is_empty() {
        return Ok(is_exact);
    }
    let largest = joints.remove(0);
    Err(AssemblyError::Open { largest, others: joints })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same of a machine of 1 m.
    fn close(
        guess: &[f64],
        gaps: &'static [Gap],
        residual: impl Fn(&[f64], &mut [f64]),
    ) -> Result<Vec<f64>, AssemblyError> {
        super::close(guess, gaps, &residual, &|_, extents| extents.fill(1.0)).map(|closed| closed.coordinates)
    }

    #[test]
    fn what_is_closed_is_a_part_of_the_machine() {
        for size in [1e-15, 1e-6, 1.0, 1e6] {
            let close = |part: f64| {
                super::close(&[], &PIN, &|_, r| r.fill(part * size), &|_, of| of.copy_from_slice(&[0.0, size]))
            };
            assert_eq!(
                [0.0, 0.9e-13, 1.1e-13, 0.9e-10].map(|part| close(part).expect("closed").is_exact),
                [true, true, false, false]
            );
            let AssemblyError::Open { largest, .. } = close(1.1e-10).expect_err("open") else { panic!("a gap") };
            assert!((largest.allowed / size - 1e-10).abs() < 1e-16, "{largest:?}");
        }
    }

    #[test]
    fn what_is_closed_of_an_angle_is_a_part_of_a_radian() {
        static TILT: [Gap; 1] = [Gap { joint: "pin", component: "", unit: "rad" }];
        let close = |gap: f64| super::close(&[], &TILT, &|_, r| r[0] = gap, &|_, of| of[0] = 0.0);
        assert!(close(0.9e-10).is_ok() && close(1.1e-10).is_err());
    }

    const fn gap(joint: &'static str, component: &'static str) -> Gap {
        Gap { joint, component, unit: "m" }
    }
    static PIN: [Gap; 2] = [gap("pin", "x"), gap("pin", "y")];

    /// Two links of lengths 0.3 and 0.5 m that must reach the point (0.6, y).
    fn two_links(y: f64) -> impl Fn(&[f64], &mut [f64]) {
        move |q, r| {
            r[0] = 0.3 * libm::cos(q[0]) + 0.5 * libm::cos(q[1]) - 0.6;
            r[1] = 0.3 * libm::sin(q[0]) + 0.5 * libm::sin(q[1]) - y;
        }
    }

    #[test]
    fn a_loop_closes_to_rounding_on_the_side_of_the_guess() {
        for side in [1.0, -1.0] {
            let q = close(&[0.4 * side, -0.5 * side], &PIN, two_links(0.1)).unwrap();
            let mut r = [1.0; 2];
            two_links(0.1)(&q, &mut r);
            assert!(r.iter().all(|r| r.abs() <= 2.3e-16), "{r:?}");
            assert!((q[0] - q[1]) * side > 0.0, "{q:?}");
        }
    }

    #[test]
    fn a_loop_out_of_reach_names_its_joint_gap_and_unit() {
        let error = close(&[0.4, -0.5], &PIN, two_links(2.0)).unwrap_err();
        let AssemblyError::Open { largest, others } = &error else { panic!("{error}") };
        assert_eq!((largest.gap, others.len()), (PIN[1], 0));
        let (sum, reach) = (0.6_f64.hypot(2.0), 0.8);
        assert!((largest.size + 2.0 * (1.0 - reach / sum)).abs() < 1e-6, "{error}");
        assert!(error.to_string().contains("`pin` by -1.2") && error.to_string().contains(" m in y"), "{error}");
    }

    #[test]
    fn coordinates_without_influence_stay_and_redundant_gaps_do_no_harm() {
        static GAPS: [Gap; 3] = [gap("a", "x"), gap("a", "y"), gap("a", "again")];
        let q = close(&[0.4, 7.0, -0.5], &GAPS, |q, r| {
            two_links(0.1)(&[q[0], q[2]], &mut r[..2]);
            r[2] = r[0] + r[1];
        })
        .unwrap();
        assert_eq!(q[1], 7.0);
        let alone = close(&[0.4, -0.5], &PIN, two_links(0.1)).unwrap();
        assert!((q[0] - alone[0]).abs() < 1e-12 && (q[2] - alone[1]).abs() < 1e-12);
    }

    #[test]
    fn a_free_coordinate_pair_moves_as_little_as_possible() {
        static ONE: [Gap; 1] = [gap("rod", "length")];
        let q = close(&[3.0, 4.5], &ONE, |q, r| r[0] = q[0] + q[1] - 7.0).unwrap();
        assert!((q[0] - 2.75).abs() < 1e-14 && (q[1] - 4.25).abs() < 1e-14, "{q:?}");
    }

    #[test]
    fn without_coordinates_the_gaps_are_only_checked() {
        assert_eq!(close(&[], &PIN, |_, r| r.fill(CLOSED)), Ok(vec![]));
        let error = close(&[], &PIN, |_, r| r.copy_from_slice(&[2e-10, -3e-10])).unwrap_err();
        assert!(matches!(error, AssemblyError::Open { largest, .. } if largest.size == -3e-10));
        assert_eq!(close(&[1.0], &[], |_, _| {}), Ok(vec![1.0]));
    }

    #[test]
    fn other_open_joints_are_listed_once_each() {
        static GAPS: [Gap; 4] = [gap("a", "x"), gap("b", "x"), gap("b", "y"), gap("c", "x")];
        let error = close(&[], &GAPS, |_, r| r.copy_from_slice(&[1e-3, 2e-3, -5e-3, 0.0])).unwrap_err();
        let AssemblyError::Open { largest, others } = &error else { panic!("{error}") };
        assert_eq!((largest.gap, largest.size), (GAPS[2], -5e-3));
        assert_eq!(others.as_slice(), &[OpenGap { gap: GAPS[0], size: 1e-3, allowed: CLOSED }]);
        assert!(error.to_string().ends_with("also open: `a` by 1.00e-3 m in x"), "{error}");
    }

    #[test]
    fn a_gap_that_is_no_number_is_an_error() {
        let error = close(&[1.0, 1.0], &PIN, |_, r| r.copy_from_slice(&[0.0, f64::NAN])).unwrap_err();
        assert!(matches!(error, AssemblyError::NonFinite { gap, .. } if gap == PIN[1]));
        let error = close(&[0.0, 0.0], &PIN, |q, r| r.copy_from_slice(&[q[0].sqrt() - 1.0, q[1]])).unwrap_err();
        assert!(matches!(error, AssemblyError::NonFinite { gap, .. } if gap == PIN[0]));
    }
}
