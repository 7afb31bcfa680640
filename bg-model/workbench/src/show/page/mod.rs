//! The report: one HTML file of a run that needs nothing else to be opened.
//!
//! In: a run, what is known of its model, and where they are there what the machine looks like, the picture of its
//! graph and its modes. Out: HTML with style, script and data in it; the same as binary glTF. The script moves the
//! machine, draws the charts and links both by one time. It is bundled from `page/` of this package (`npm ci && npm run
//! build`), with three.js and uPlot inside; their licence stands at the foot of the page. Script and drawings are
//! packed, the data are plain JSON.

pub mod animation;
mod charts;
mod data;
pub(crate) mod film;
#[cfg(not(target_arch = "wasm32"))]
pub mod glb;
mod html;
#[cfg(not(target_arch = "wasm32"))]
mod mesh;
mod modes;
pub mod order;
#[cfg(not(target_arch = "wasm32"))]
mod packed;
mod picture;
mod report;
mod settings;

use bg_model::description::ParameterInfo;

use crate::ask::parameters::Values;
use animation::Animation;
use bg_analysis::linear::Mode;

pub(crate) use charts::Balance;
pub(crate) use data::{Bonds, Data};
pub use picture::{BondSeries, Picture};
pub use report::Report;
pub(crate) use report::page_beside;
#[cfg(not(target_arch = "wasm32"))]
pub use report::{BESIDE, page};

/// A parameter of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Name, unit, default, meaning.
    pub info: ParameterInfo,
    /// Its value in the run.
    pub value: f64,
    /// Where the default is from, such as `paper`; empty where nothing is said.
    pub source: &'static str,
}

impl Parameter {
    /// All of a table, with their values, and `source` as where each default is from.
    pub(crate) fn all(values: &Values, source: impl Fn(&str) -> &'static str) -> Vec<Self> {
        let parameter =
            |(info, value): (&ParameterInfo, f64)| Self { info: info.clone(), value, source: source(info.name) };
        values.all().map(parameter).collect()
    }

    /// Whether the run has another value than the default.
    #[must_use]
    pub fn is_changed(&self) -> bool {
        self.value != self.info.default
    }
}

/// What a report shows beside a run, as far as it is there.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Views {
    /// The machine in motion.
    pub animation: Option<Animation>,
    /// The picture of the graph.
    pub picture: Option<Picture>,
    /// The modes of the linearised machine, or why there are none, in words; `None` where they are not asked for.
    pub modes: Option<Result<Linearised, String>>,
}

/// The modes, and the machine where it was linearised.
#[derive(Clone, Debug, PartialEq)]
pub struct Linearised {
    /// The modes.
    pub modes: Vec<Mode>,
    /// Where it was linearised, in words.
    pub place: String,
    /// The machine there, one sample; `None` of one without bodies.
    pub rest: Option<Animation>,
}
