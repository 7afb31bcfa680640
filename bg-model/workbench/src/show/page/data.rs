//! The data of the page, as its script reads them.
//!
//! In: a run, and what is known of it. Out: JSON that can stand in a `<script>`. A number of a sample that is a row of
//! the CSV file is the CSV's number with all its digits; others have six digits, as have poses and forces. A quantity
//! that never changes is a single number.

use bg_analysis::samples::{DIGITS, Instant, Series, Shared, instants, rounded};
use bg_model::description::{BondInfo, Description};
use bg_model::simulation::Recording;
use serde::Serialize;

use super::animation::{Animation, BodyTrack, JointTrack, NamedPoint, Shape, Solid};
use super::charts::{self, Balance};
use super::modes::Modes;
use super::picture::Picture;

/// All data of a page.
#[derive(Debug, Serialize)]
pub struct Data {
    /// The samples of the charts, s.
    pub times: Vec<f64>,
    /// Whether each is a row of the CSV file; how many samples the run has.
    pub rows: Vec<usize>,
    /// When switches changed their branches, s.
    pub events: Vec<f64>,
    pub charts: Vec<Chart>,
    /// Other runs and measurements, for the same charts.
    pub others: Vec<Other>,
    /// Energies, and what is left over.
    pub balance: Vec<Chart>,
    pub animation: Option<Motion>,
    pub modes: Option<Modes>,
}

#[derive(Debug, Serialize)]
pub struct Chart {
    pub title: String,
    pub unit: String,
    pub curves: Vec<Curve>,
}

#[derive(Debug, Serialize)]
pub struct Curve {
    pub name: String,
    /// The column of the CSV file; empty where it is none.
    #[serde(skip_serializing_if = "str::is_empty")]
    pub column: &'static str,
    pub values: Series,
}

/// Columns of another run or a measurement, at their own times.
#[derive(Debug, Serialize)]
pub struct Other {
    name: String,
    times: Vec<f64>,
    columns: Vec<OtherColumn>,
}

#[derive(Debug, Serialize)]
struct OtherColumn {
    name: String,
    values: Series,
}

#[derive(Debug, Serialize)]
pub struct Motion {
    times: Vec<f64>,
    bodies: Vec<Body>,
    ground: Vec<Point>,
    /// How it is turned so that y is up: a unit quaternion x, y, z, w.
    upright: [f64; 4],
    joints: Vec<Joint>,
}

#[derive(Debug, Serialize)]
struct Body {
    name: String,
    solids: Vec<Part>,
    points: Vec<Point>,
    position: [Series; 3],
    orientation: [Series; 4],
}

#[derive(Debug, Serialize)]
struct Part {
    shape: Form,
    at: [f64; 3],
    turned: [[f64; 3]; 3],
}

#[derive(Debug, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
enum Form {
    Cuboid { edges: [f64; 3] },
    Cylinder { radius: f64, length: f64, axis: usize },
    Sphere { radius: f64 },
}

#[derive(Debug, Serialize)]
struct Point {
    name: String,
    at: [f64; 3],
}

#[derive(Debug, Serialize)]
struct Joint {
    name: String,
    kind: String,
    place: [Series; 3],
    force: [Series; 3],
}

/// Effort and flow of the bonds, JSON of its own. Series that several bonds share stand here once.
#[derive(Debug, Serialize)]
pub struct Bonds {
    times: Vec<f64>,
    series: Vec<Series>,
    bonds: Vec<Bond>,
}

#[derive(Debug, Serialize)]
struct Bond {
    name: String,
    effort_unit: String,
    flow_unit: String,
    /// Indices into the series, one for each component.
    effort: Vec<usize>,
    flow: Vec<usize>,
}

/// The most numbers of all charts together, and of the tracks of bodies and joints: some hundred kB each.
const MOST_OF_CHARTS: usize = 48_000;
const MOST_OF_TRACKS: usize = 32_000;
/// The most numbers of all bonds together, and the digits of each.
const MOST_OF_BONDS: usize = 60_000;
const DIGITS_OF_BONDS: usize = 5;

impl Data {
    /// The data of a run of a model whose CSV file has the rows `rows`, s.
    pub fn new(
        description: &'static Description,
        run: &Recording,
        rows: &[f64],
        animation: Option<&Animation>,
        modes: Option<Modes>,
    ) -> Self {
        let curves = run.columns.iter().filter(|column| changes(&column.values)).count();
        let samples = instants(&run.times, rows, curves, MOST_OF_CHARTS);
        let charts = charts::charts(description, run);
        let curve = |(name, column): (String, &'static str)| {
            let values = run.column(column).unwrap_or_default();
            Curve { name, column, values: Series::new(sampled(values, &samples)) }
        };
        let charts = charts.into_iter().map(|charts::Chart { title, unit, curves }| Chart {
            title,
            unit,
            curves: curves.into_iter().map(curve).collect(),
        });
        Self {
            times: samples.iter().map(|sample| run.times[sample.index]).collect(),
            rows: (0..samples.len()).filter(|&k| samples[k].is_row).collect(),
            events: run.events.iter().map(|&t| rounded(t, DIGITS)).collect(),
            charts: charts.collect(),
            others: Vec::new(),
            balance: Balance::of(description, run).map_or_else(Vec::new, |balance| of_balance(&balance, &samples)),
            animation: animation.map(|animation| Motion::new(animation, rows)),
            modes,
        }
    }

    /// The same with what other runs and measurements have of the charts' columns, at samples that are few enough.
    pub fn with(mut self, others: &[(String, Recording)]) -> Self {
        let shown: Vec<&str> =
            self.charts.iter().flat_map(|chart| chart.curves.iter().map(|curve| curve.column)).collect();
        let other = |(name, run): &(String, Recording)| {
            let columns = || run.columns.iter().filter(|column| shown.contains(&column.name.as_str()));
            let samples = instants(&run.times, &[], columns().count(), MOST_OF_CHARTS);
            let values = |column: &[f64]| Series::rounded(samples.iter().map(|sample| column[sample.index]), DIGITS);
            Other {
                name: name.clone(),
                times: samples.iter().map(|sample| run.times[sample.index]).collect(),
                columns: columns()
                    .map(|column| OtherColumn { name: column.name.clone(), values: values(&column.values) })
                    .collect(),
            }
        };
        self.others = others.iter().map(other).collect();
        self
    }

    /// Which of `all` samples the charts show, and of the `of_csv` rows of the CSV file, in words.
    pub fn note(&self, all: usize, of_csv: usize) -> String {
        let (shown, rows) = (self.times.len(), self.rows.len());
        let thinned =
            if shown < all { format!("{shown} of {all} samples are shown") } else { format!("{shown} samples") };
        let of_rows = if rows < of_csv { format!("{rows} of {of_csv} rows") } else { format!("all {rows} rows") };
        format!(
            "{thinned}, among them {of_rows} of the CSV file. Press or drag in a chart to set the time; \
             Ctrl and the wheel zoom, a double click shows all."
        )
    }

    /// JSON in which nothing ends the `<script>` that it stands in.
    pub fn json(&self) -> String {
        let json = serde_json::to_string(self).expect("the data have text keys only");
        json.replace('<', "\\u003c")
    }
}

/// The values at these samples: a row's as it is, others to a few digits.
fn sampled(values: &[f64], samples: &[Instant]) -> Vec<f64> {
    let value = |sample: &Instant| {
        let value = values[sample.index];
        if sample.is_row { value } else { rounded(value, DIGITS) }
    };
    samples.iter().map(value).collect()
}

fn of_balance(balance: &Balance, samples: &[Instant]) -> Vec<Chart> {
    let curve = |name: &str, values: &[f64]| {
        let values = Series::rounded(samples.iter().map(|sample| values[sample.index]), DIGITS);
        Curve { name: name.to_owned(), column: "", values }
    };
    let has_lost = !balance.dissipated.is_empty();
    let dissipated = has_lost.then(|| curve("dissipated", &balance.dissipated));
    let energies =
        [curve("supplied", &balance.supplied), curve("stored", &balance.stored)].into_iter().chain(dissipated);
    let rest = if has_lost { "supplied \u{2212} stored \u{2212} dissipated" } else { "supplied \u{2212} stored" };
    let chart = |curves| Chart { title: String::new(), unit: "J".to_owned(), curves };
    vec![chart(energies.collect()), chart(vec![curve(rest, &balance.rest)])]
}

impl Motion {
    /// The machine at samples that are few enough, those at `rows` first.
    fn new(animation: &Animation, rows: &[f64]) -> Self {
        let Animation { times, bodies, ground, joints, .. } = animation;
        let all: usize = bodies.iter().map(|body| moving(&body.position) + moving(&body.orientation)).sum();
        let of_joints: usize = joints.iter().map(|joint| moving(&joint.place) + moving(&joint.force)).sum();
        let samples = instants(times, rows, all + of_joints, MOST_OF_TRACKS);
        Self {
            times: samples.iter().map(|sample| times[sample.index]).collect(),
            bodies: bodies.iter().map(|body| Body::new(body, &samples)).collect(),
            ground: ground.iter().map(Point::new).collect(),
            upright: animation.upright().map(|x| rounded(x, DIGITS)),
            joints: joints.iter().map(|joint| Joint::new(joint, &samples)).collect(),
        }
    }
}

/// How many components of a track change.
fn moving<const K: usize>(track: &[[f64; K]]) -> usize {
    let component = |axis: usize| track.iter().map(|value| value[axis]).collect::<Vec<f64>>();
    (0..K).filter(|&axis| changes(&component(axis))).count()
}

/// Whether a quantity ever changes.
fn changes(values: &[f64]) -> bool {
    values.windows(2).any(|pair| pair[0].to_bits() != pair[1].to_bits())
}

impl Body {
    fn new(BodyTrack { name, solids, points, position, orientation }: &BodyTrack, samples: &[Instant]) -> Self {
        Self {
            name: name.clone(),
            solids: solids.iter().map(Part::new).collect(),
            points: points.iter().map(Point::new).collect(),
            position: components(position, samples),
            orientation: components(orientation, samples),
        }
    }
}

impl Part {
    fn new(&Solid { shape, at, turned }: &Solid) -> Self {
        let shape = match shape {
            Shape::Cuboid { edges } => Form::Cuboid { edges },
            Shape::Cylinder { radius, length, axis } => Form::Cylinder { radius, length, axis },
            Shape::Sphere { radius } => Form::Sphere { radius },
        };
        Self { shape, at, turned }
    }
}

impl Point {
    fn new(NamedPoint { name, at }: &NamedPoint) -> Self {
        Self { name: name.clone(), at: *at }
    }
}

impl Joint {
    fn new(JointTrack { name, kind, place, force, .. }: &JointTrack, samples: &[Instant]) -> Self {
        let (place, force) = (components(place, samples), components(force, samples));
        Self { name: name.clone(), kind: kind.clone(), place, force }
    }
}

/// A series for each component.
fn components<const K: usize>(track: &[[f64; K]], samples: &[Instant]) -> [Series; K] {
    std::array::from_fn(|axis| Series::rounded(samples.iter().map(|sample| track[sample.index][axis]), DIGITS))
}

impl Bonds {
    /// The bonds' series at samples that are few enough; `None` where there are none.
    pub fn new(infos: &'static [BondInfo], picture: &Picture) -> Option<Self> {
        if picture.bonds.is_empty() || picture.times.is_empty() {
            return None;
        }
        let mut shared = Shared::default();
        let mut place = |values: &Vec<f64>| shared.place(values, DIGITS_OF_BONDS);
        let bonds = infos.iter().zip(&picture.bonds).map(|(info, bond)| Bond {
            name: format!("{} \u{2192} {}", info.from, info.to),
            effort_unit: charts::unit(info.effort),
            flow_unit: charts::unit(info.flow),
            effort: bond.effort.iter().map(&mut place).collect(),
            flow: bond.flow.iter().map(&mut place).collect(),
        });
        let bonds = bonds.collect();
        let series = shared.series();
        let curves = series.iter().filter(|values| changes(values)).count();
        let stride = (picture.times.len() * curves).div_ceil(MOST_OF_BONDS).max(1);
        let every = |values: &[f64]| -> Vec<f64> { values.iter().copied().step_by(stride).collect() };
        let times = every(&picture.times);
        Some(Self { times, series: series.iter().map(|values| Series::new(every(values))).collect(), bonds })
    }

    /// JSON; it is packed, so it may have anything in it.
    pub fn json(&self) -> String {
        serde_json::to_string(self).expect("the data have text keys only")
    }
}

#[cfg(test)]
mod tests {
    use super::super::picture::BondSeries;
    use super::*;
    use bg_model::description::BondEnd;

    #[test]
    fn series_that_bonds_share_stand_once() {
        static BONDS: [BondInfo; 2] = [BOND, BOND];
        const BOND: BondInfo =
            BondInfo { from: "a", to: "b", cardinality: 1, stroke: BondEnd::To, effort: "N", flow: "m/s" };
        let bond = |effort: [f64; 3]| BondSeries { effort: vec![effort.to_vec()], flow: vec![vec![2.0; 3]] };
        let bonds = vec![bond([1.0, 2.0, 3.0]), bond([1.0, 2.0, 3.000_001])];
        let picture = Picture { svg: String::new(), times: vec![0.0, 1.0, 2.0], bonds };
        let made = Bonds::new(&BONDS, &picture).unwrap();
        assert_eq!(made.series, [Series::Moving(vec![1.0, 2.0, 3.0]), Series::Still(2.0)]);
        assert_eq!((&made.bonds[1].effort[..], &made.bonds[1].flow[..]), (&[0][..], &[1][..]));
        assert!(Bonds::new(&BONDS, &Picture::default()).is_none());
    }
}
