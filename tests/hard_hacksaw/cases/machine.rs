//! The hacksaw as a problem that can be run, and what is observed of it.
//!
//! In: changed parameters, a disturbance of the start. Out: problems whose rows are the links' poses and two residuals:
//! that of the energy balance and that of the orientations' orthogonality. A row's components are of one size, so that
//! one absolute measure serves them all: m, sines and cosines of angles, and energy over a scale.

use bg_model::description::OutputInfo;
use bg_model::input::Input;
use bg_model::nalgebra::SVector;
use bg_model::parameters::Parameters;
use bg_model::system::Model;
use hacksaw::mechanism::{Full, FullParameters, Paper, PaperParameters};

use super::disturbed;
use super::reversal::{Reversal, ReversalInputs, ReversalParameters};
use crate::hardcases::case::larger;
use crate::hardcases::problem::{Followable, followable};

/// What is made of a model's outputs.
type Observe<const M: usize> = Box<dyn Fn(&[f64; M]) -> Vec<f64>>;

/// Names of parameters and their values.
pub type Changes<'a> = &'a [(&'static str, f64)];

/// The links' numbers in the names of outputs.
const LINKS: [u8; 4] = [2, 3, 4, 5];

/// The outputs that are a planar pose: two coordinates, cosine and sine of each link.
#[must_use]
pub fn planar_names() -> Vec<String> {
    names(&["C_x", "C_y", "R_11", "R_21"])
}

/// The outputs that are a pose in space: three coordinates and the orientation of each link.
#[must_use]
pub fn spatial_names() -> Vec<String> {
    let all = "C_x C_y C_z R_11 R_12 R_13 R_21 R_22 R_23 R_31 R_32 R_33";
    names(&all.split(' ').collect::<Vec<_>>())
}

/// Each kind of output of each link: `C_x` becomes `C2_x` and so on.
fn names(kinds: &[&str]) -> Vec<String> {
    let of = |link: u8| kinds.iter().map(move |kind| kind.replace('_', &format!("{link}_")));
    LINKS.into_iter().flat_map(of).collect()
}

/// The energy over which the balance is taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Scale {
    /// The same at all times, J.
    Fixed(f64),
    /// The sum of the energies stored, supplied and dissipated up to then, at least 1e-300 J.
    Present,
}

/// The poses called `names`; (stored - supplied + dissipated energy, less what is stored in `start`, the outputs at the
/// start) over the scale; max |R R^T - 1| of the links.
fn observe<const M: usize>(
    outputs: &'static [OutputInfo],
    names: &[String],
    scale: Scale,
    start: [f64; M],
) -> Observe<M> {
    let place = |name: &str| {
        let found = outputs.iter().position(|output| output.name == name);
        found.unwrap_or_else(|| panic!("no output `{name}`"))
    };
    let poses: Vec<usize> = names.iter().map(|name| place(name)).collect();
    let energies = ["stored_energy", "supplied_energy", "dissipated_energy"].map(place);
    let from = start[energies[0]];
    let orientations = LINKS.map(|link| {
        let entry = |k: usize| place(&format!("R{link}_{}{}", k / 3 + 1, k % 3 + 1));
        std::array::from_fn(entry)
    });
    Box::new(move |y| {
        let [stored, supplied, dissipated] = energies.map(|place| y[place]);
        let scale = match scale {
            Scale::Fixed(energy) => energy,
            Scale::Present => (stored.abs() + supplied.abs() + dissipated.abs()).max(1e-300),
        };
        let mut row: Vec<f64> = poses.iter().map(|place| y[*place]).collect();
        row.push((stored - from - supplied + dissipated) / scale);
        row.push(orientations.map(|places| orthogonality(places.map(|place| y[place]))).into_iter().fold(0.0, larger));
        row
    })
}

/// max |R R^T - 1| of a matrix given row by row.
#[must_use]
pub fn orthogonality(r: [f64; 9]) -> f64 {
    let row = |i: usize| [r[3 * i], r[3 * i + 1], r[3 * i + 2]];
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let entry = |(i, j): (usize, usize)| (dot(row(i), row(j)) - if i == j { 1.0 } else { 0.0 }).abs();
    [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)].map(entry).into_iter().fold(0.0, larger)
}

/// The model from the state `start`, its poses called `names` observed.
fn problem<Mo, const N: usize, const G: usize, const M: usize>(
    model: Mo,
    start: SVector<f64, N>,
    names: &[String],
    scale: Scale,
) -> Box<dyn Followable>
where
    Mo: Model<f64, N, G, M> + 'static,
{
    let mut outputs = SVector::<f64, M>::zeros();
    model.outputs(0.0, &start, &[false; G], &mut outputs);
    let observe = observe(model.description().outputs, names, scale, outputs.data.0[0]);
    followable(model, start, observe)
}

/// The defaults with `changes`.
///
/// # Panics
/// There is no such parameter, or the value is out of range.
#[must_use]
pub fn changed<P: Parameters>(changes: Changes) -> P {
    with(changes).expect("parameters in their ranges")
}

/// The same; says which value cannot be.
fn with<P: Parameters>(changes: Changes) -> Result<P, String> {
    let mut parameters = P::default();
    for (name, value) in changes {
        parameters.set(name, *value).map_err(|fault| fault.to_string())?;
    }
    Ok(parameters)
}

/// The paper's case in the plane with `changes`; energies over `scale`.
///
/// # Panics
/// A value is out of range, or the start does not close.
#[must_use]
pub fn planar(changes: Changes, scale: Scale) -> Box<dyn Followable> {
    try_planar(changes, scale).expect("there is such a machine")
}

/// The same; says why there is no such machine.
///
/// # Errors
/// What the parameters or the assembly say.
pub fn try_planar(changes: Changes, scale: Scale) -> Result<Box<dyn Followable>, String> {
    let model = Paper::new(with::<PaperParameters>(changes)?).map_err(|fault| fault.to_string())?;
    let start = model.start().map_err(|fault| fault.to_string())?;
    Ok(problem(model, start, &planar_names(), scale))
}

/// The hacksaw in space with `changes`, every state of its start that leads out of the plane moved by up to
/// `disturbance` in its SI unit; energies over `scale`.
///
/// # Panics
/// A value is out of range, or the start does not close.
#[must_use]
pub fn spatial(changes: Changes, disturbance: f64, scale: Scale) -> Box<dyn Followable> {
    let model = Full::new(changed::<FullParameters>(changes)).expect("in range");
    let mut start = model.start().expect("the mechanism closes");
    for (index, value) in start.iter_mut().enumerate() {
        *value += disturbance * disturbed::direction(model.description().states[index].name);
    }
    problem(model, start, &spatial_names(), scale)
}

/// The hacksaw in the plane whose torque of 10 N m turns round at `at` (s): a switch of its law, or an input without a
/// guard; energies over `scale`.
///
/// # Panics
/// The start does not close.
#[must_use]
pub fn reversed(at: f64, by_input: bool, scale: Scale) -> Box<dyn Followable> {
    let (reversal, extra) = if by_input {
        (1e9, Input::function(move |t| if t < at { 0.0 } else { -20.0 }))
    } else {
        (at, Input::constant(0.0))
    };
    let parameters = ReversalParameters { reversal };
    let model = Reversal::new(parameters, ReversalInputs { extra }).expect("in range");
    let start = model.start().expect("the mechanism closes");
    problem(model, start, &planar_names(), scale)
}
