//! The bond-graph picture of the page, and what its bonds do over the run.

/// A picture of a model's graph with the series of its bonds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Picture {
    /// An SVG text with a `<g class="bond" data-bond="INDEX">` for each bond of the description; it goes into the page
    /// as it is.
    pub svg: String,
    /// The samples of the series, s, ascending; empty without series.
    pub times: Vec<f64>,
    /// The series of each bond, in the order of the description.
    pub bonds: Vec<BondSeries>,
}

/// Effort and flow of a bond over the run, in the units of the description: for each component a value for each sample.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BondSeries {
    /// One component, or three of a multibond.
    pub effort: Vec<Vec<f64>>,
    /// As many as of the effort.
    pub flow: Vec<Vec<f64>>,
}
