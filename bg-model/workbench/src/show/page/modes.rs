//! The modes of the linearised machine, as the page shows them.
//!
//! In: modes and the poses of the bodies where it was linearised. Out: how each body swings. A body's coordinates are
//! known by their names, `BODY.position_x` and `BODY.rotation_x`; a rotation is one about an inertial axis.

use serde::Serialize;

use super::animation::Animation;
use bg_analysis::linear::{Mode, Participation};
use bg_analysis::samples::{DIGITS, rounded};

/// Modes and what they swing about.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Modes {
    /// The bodies' poses where it was linearised.
    bodies: Vec<Rest>,
    modes: Vec<Swing>,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
struct Rest {
    position: [f64; 3],
    orientation: [f64; 4],
}

#[derive(Clone, Debug, PartialEq, Serialize)]
struct Swing {
    bodies: Vec<BodySwing>,
}

/// Complex amplitudes, real and imaginary part, of a body's place (m) and turn (rad).
#[derive(Clone, Debug, PartialEq, Serialize)]
struct BodySwing {
    translation: [[f64; 2]; 3],
    rotation: [[f64; 2]; 3],
}

impl Modes {
    /// The modes of the machine whose only sample in `rest` is where it was linearised.
    #[must_use]
    pub fn new(modes: &[Mode], rest: &Animation) -> Self {
        let bodies = rest.bodies.iter().map(|body| Rest {
            position: body.position.first().copied().unwrap_or_default(),
            orientation: body.orientation.first().copied().unwrap_or([0.0, 0.0, 0.0, 1.0]),
        });
        let swing = |mode: &Mode| {
            let of_body = |name: &str| BodySwing {
                translation: amplitudes(mode, &format!("{name}.position")),
                rotation: amplitudes(mode, &format!("{name}.rotation")),
            };
            Swing { bodies: rest.bodies.iter().map(|body| of_body(&body.name)).collect() }
        };
        Self { bodies: bodies.collect(), modes: modes.iter().map(swing).collect() }
    }
}

/// The amplitudes of `stem_x`, `stem_y` and `stem_z`.
fn amplitudes(mode: &Mode, stem: &str) -> [[f64; 2]; 3] {
    ["x", "y", "z"].map(|axis| {
        let name = format!("{stem}_{axis}");
        let part = mode.shape.iter().find(|part| part.name == name);
        let of = |Participation { magnitude, phase, .. }: &Participation| {
            [magnitude * phase.cos(), magnitude * phase.sin()].map(|value| rounded(value, DIGITS))
        };
        part.map_or([0.0; 2], of)
    })
}
