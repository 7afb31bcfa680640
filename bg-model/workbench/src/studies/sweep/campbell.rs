//! Campbell diagrams: natural frequencies over a parameter, such as the speed of a rotor, and where the orders of that
//! speed meet them.
//!
//! In: which parameter, from where to where, and what linearises a model at a value of it. Out: the branches of its
//! modes, critical speeds, as a text, tables and a figure. A mode is the same one along a branch as
//! `bg_analysis::linear::branches` has it.

use bg_analysis::linear::{Branch, Mode, branches, crossings};
use bg_model::description::ParameterInfo;
use bg_units::Unit;

use crate::ask::parameters::number;
use crate::files::parquet::{Column, Table, Values};
use crate::files::table::table;
use crate::run::summary::short;
use crate::show::figures::FigureError;
use crate::show::figures::plot::{Mark, Plot, Series, with_unit};

/// What is asked for.
#[derive(Clone, Debug)]
pub struct Asked {
    /// The parameter.
    pub by: &'static ParameterInfo,
    /// Its least and its largest value, in its unit.
    pub range: [f64; 2],
    /// At how many values, two at least.
    pub points: usize,
    /// The orders whose lines are drawn: multiples of the speed that the parameter is.
    pub orders: Vec<f64>,
    /// The highest frequency that is drawn, Hz.
    pub up_to: Option<f64>,
}

/// Where an order meets a mode.
#[derive(Clone, Debug, PartialEq)]
pub struct Critical {
    /// The order.
    pub order: f64,
    /// The branch, counted from 0.
    pub branch: usize,
    /// The parameter, in its unit.
    pub value: f64,
    /// The mode there.
    pub mode: Mode,
}

/// Modes over a parameter.
#[derive(Clone, Debug)]
pub struct Campbell {
    /// What was asked for.
    pub asked: Asked,
    /// The modes that swing.
    pub branches: Vec<Branch>,
    /// Where orders meet them, by orders and speeds.
    pub criticals: Vec<Critical>,
    /// The values at which there is no linear model, and why.
    pub failed: Vec<(f64, String)>,
}

/// Revolutions per second of one unit of a speed; `None` of what is no speed.
#[must_use]
pub fn turns(unit: &str) -> Option<f64> {
    let unit: Unit = unit.parse().ok()?;
    let rate: Unit = "Hz".parse().ok()?;
    // A frequency counts revolutions, an angular speed radians.
    let circle = if unit.angle == 0 { 1.0 } else { std::f64::consts::TAU };
    (unit.dimension == rate.dimension).then(|| unit.convert(1.0, rate) / circle)
}

/// Follows the modes; `modes` gives those at a value of the parameter.
pub fn campbell(asked: Asked, mut modes: impl FnMut(f64) -> Result<Vec<Mode>, String>) -> Campbell {
    let mut failed = Vec::new();
    let [from, to] = asked.range;
    let mut known = Vec::new();
    for k in 0..asked.points {
        let part = k as f64 / (asked.points - 1) as f64;
        let value = from * (1.0 - part) + to * part;
        match modes(value) {
            Ok(modes) => known.push((value, modes)),
            Err(why) => failed.push((value, why)),
        }
    }
    let branches = branches(known);
    let turns = turns(asked.by.unit).unwrap_or(f64::NAN);
    let range = to - from;
    let mut criticals = Vec::new();
    for &order in &asked.orders {
        let mut of_order: Vec<Critical> = Vec::new();
        for (place, branch) in branches.iter().enumerate() {
            let excess = |value: f64, mode: &Mode| mode.frequency - order * turns * value.abs();
            let found = crossings(branch, excess, |value| modes(value).ok());
            of_order.extend(found.into_iter().map(|(value, mode)| Critical { order, branch: place, value, mode }));
        }
        // Modes that are equal but for rounding stay in their order.
        let place = |critical: &Critical| (critical.value * 1e9 / (range.max(f64::MIN_POSITIVE))).round();
        of_order.sort_by(|a, b| place(a).total_cmp(&place(b)).then(a.branch.cmp(&b.branch)));
        criticals.extend(of_order);
    }
    Campbell { asked, branches, criticals, failed }
}

impl Campbell {
    /// Why there is nothing, where no value has a linear model: a sentence.
    #[must_use]
    pub fn failure(&self) -> Option<&str> {
        self.failed.first().filter(|_| self.failed.len() == self.asked.points).map(|(_, why)| why.as_str())
    }

    /// The modes, and what orders meet them.
    #[must_use]
    pub fn text(&self) -> String {
        let Asked { by, range, points, .. } = &self.asked;
        let [from, to] = range.map(number);
        let mut text =
            format!("modes that swing, over {} = {from} to {to} {} at {points} values\n\n", by.name, by.unit);
        let head = ["mode", "from, Hz", "to, Hz", "least damping", "what moves"].map(str::to_owned);
        let row = |(place, branch): (usize, &Branch)| {
            let ends =
                [branch.points.first(), branch.points.last()].map(|end| end.map_or(f64::NAN, |end| end.1.frequency));
            let damping = branch.points.iter().filter_map(|(_, mode)| mode.damping).fold(f64::INFINITY, f64::min);
            let words = branch.points[branch.points.len() / 2].1.words.clone();
            let range = [branch.points.first(), branch.points.last()].map(|end| end.map_or(f64::NAN, |end| end.0));
            let part = if range == self.asked.range {
                String::new()
            } else {
                format!(" ({} to {} {})", number(range[0]), number(range[1]), by.unit)
            };
            [(place + 1).to_string(), short(ends[0]), short(ends[1]), damping_text(damping), words + &part]
        };
        let rows: Vec<_> = std::iter::once(head).chain(self.branches.iter().enumerate().map(row)).collect();
        text += &table(&rows);
        for branch in self.branches.iter().enumerate() {
            text += &self.unstable(branch).map_or_else(String::new, |sentence| format!("  {sentence}\n"));
        }
        if !self.asked.orders.is_empty() {
            text += "\nwhere an order of the speed meets a mode\n";
            let head = [
                "order".to_owned(),
                with_unit(by.name, by.unit),
                "frequency, Hz".to_owned(),
                "damping".to_owned(),
                "mode".to_owned(),
            ];
            let row = |Critical { order, branch, value, mode }: &Critical| {
                let damping = mode.damping.unwrap_or(f64::NAN);
                [number(*order), short(*value), short(mode.frequency), damping_text(damping), (branch + 1).to_string()]
            };
            let rows: Vec<_> = std::iter::once(head).chain(self.criticals.iter().map(row)).collect();
            text += &if self.criticals.is_empty() { "  nowhere\n".to_owned() } else { table(&rows) };
        }
        if let Some((value, why)) = self.failed.first() {
            let count = self.failed.len();
            let more = if count > 1 { format!(", and {} more", count - 1) } else { String::new() };
            text += &format!("\nno linear model at {} = {} {}{more}: {why}\n", by.name, number(*value), by.unit);
        }
        if self.is_level() {
            text += &format!(
                "\nno frequency depends on `{}`; at an equilibrium nothing moves: --start model has the speeds that \
                 the machine starts with\n",
                by.name
            );
        }
        text
    }

    /// From where on a mode grows, where it does.
    fn unstable(&self, (place, branch): (usize, &Branch)) -> Option<String> {
        // Rounding of an undamped mode is no growth.
        let grows = |mode: &Mode| mode.damping.is_some_and(|damping| damping < -1e-9);
        let (value, _) = branch.points.iter().find(|(_, mode)| grows(mode))?;
        let by = self.asked.by;
        Some(format!("mode {} grows at {} = {} {}: unstable", place + 1, by.name, number(*value), by.unit))
    }

    /// Whether no frequency changes.
    fn is_level(&self) -> bool {
        let still = |branch: &Branch| {
            let first = branch.points[0].1.frequency;
            branch.points.iter().all(|(_, mode)| (mode.frequency - first).abs() <= 1e-9 * first)
        };
        !self.branches.is_empty() && self.branches.iter().all(still)
    }

    /// A row for each mode at each value.
    #[must_use]
    pub fn modes(&self) -> Table {
        let points = self.branches.iter().zip(1..).flat_map(|(branch, place): (&Branch, i64)| {
            branch.points.iter().map(move |(value, mode)| (place, *value, mode))
        });
        let points: Vec<(i64, f64, &Mode)> = points.collect();
        let real = |of: &dyn Fn(&(i64, f64, &Mode)) -> f64| Values::Real(points.iter().map(of).collect());
        columns([
            ("mode", "", Values::Whole(points.iter().map(|point| point.0).collect())),
            (self.asked.by.name, self.asked.by.unit, real(&|point| point.1)),
            ("frequency", "Hz", real(&|point| point.2.frequency)),
            ("damping", "", real(&|point| point.2.damping.unwrap_or(f64::NAN))),
            ("real", "1/s", real(&|point| point.2.real)),
            ("imaginary", "rad/s", real(&|point| point.2.imaginary)),
            ("what moves", "", Values::Text(points.iter().map(|point| point.2.words.clone()).collect())),
        ])
    }

    /// A row for each place where an order meets a mode.
    #[must_use]
    pub fn critical_speeds(&self) -> Table {
        let real = |of: fn(&Critical) -> f64| Values::Real(self.criticals.iter().map(of).collect());
        let place = |critical: &Critical| i64::try_from(critical.branch + 1).unwrap_or(i64::MAX);
        columns([
            ("order", "", real(|critical| critical.order)),
            (self.asked.by.name, self.asked.by.unit, real(|critical| critical.value)),
            ("frequency", "Hz", real(|critical| critical.mode.frequency)),
            ("damping", "", real(|critical| critical.mode.damping.unwrap_or(f64::NAN))),
            ("mode", "", Values::Whole(self.criticals.iter().map(place).collect())),
        ])
    }

    /// Draws frequencies over the parameter, lines of the orders, and where they meet.
    ///
    /// # Errors
    /// No mode swings, or the drawing crate refuses.
    pub fn drawn(&self, scene: &str) -> Result<String, FigureError> {
        let Asked { by, range, orders, .. } = &self.asked;
        let up_to = self.up_to();
        let is_shown = |frequency: f64| frequency <= up_to;
        let of_branch = |(place, branch): (usize, &Branch)| {
            let points: Vec<(f64, f64)> = branch.points.iter().map(|(value, mode)| (*value, mode.frequency)).collect();
            let points = below(&points, up_to);
            (!points.is_empty()).then(|| Series { name: format!("mode {}", place + 1), points, mark: Mark::Line })
        };
        let mut series: Vec<Series> = self.branches.iter().enumerate().filter_map(of_branch).collect();
        let turns = turns(by.unit).unwrap_or(f64::NAN);
        series.extend(orders.iter().map(|order| {
            let line = |part: f64| {
                let value = range[0] + part * (range[1] - range[0]);
                (value, order * turns * value.abs())
            };
            let points: Vec<(f64, f64)> = (0..=200).map(|k| line(f64::from(k) / 200.0)).collect();
            Series { name: format!("order {}", number(*order)), points: below(&points, up_to), mark: Mark::Guide }
        }));
        let met = self.criticals.iter().map(|critical| (critical.value, critical.mode.frequency));
        let met: Vec<(f64, f64)> = met.filter(|(_, frequency)| is_shown(*frequency)).collect();
        if !met.is_empty() {
            series.push(Series { name: "critical speeds".to_owned(), points: met, mark: Mark::Dots });
        }
        if series.iter().all(|series| series.mark == Mark::Guide) {
            return Err(FigureError::Empty);
        }
        let heading = format!("{scene}: natural frequencies over {}", by.name);
        Plot::new(&heading, &with_unit(by.name, by.unit), "frequency in Hz", series).drawn()
    }

    /// The highest frequency that is drawn, Hz: a quarter above the highest order, and so far that two modes are seen.
    fn up_to(&self) -> f64 {
        let Asked { by, range, orders, up_to, .. } = &self.asked;
        if let Some(up_to) = up_to {
            return *up_to;
        }
        let fastest = range[0].abs().max(range[1].abs()) * turns(by.unit).unwrap_or(f64::NAN);
        let highest = orders.iter().fold(0.0_f64, |highest, order| highest.max(order * fastest));
        if highest == 0.0 {
            return f64::INFINITY;
        }
        let mut first: Vec<f64> = self.branches.iter().map(|branch| branch.points[0].1.frequency).collect();
        first.sort_by(f64::total_cmp);
        let second = first.get(1).or(first.first()).copied().unwrap_or(0.0);
        1.25 * highest.max(second)
    }
}

/// The points up to where a line leaves the picture, there on its edge.
fn below(points: &[(f64, f64)], up_to: f64) -> Vec<(f64, f64)> {
    let mut kept: Vec<(f64, f64)> = Vec::new();
    for (k, &(x, y)) in points.iter().enumerate() {
        let is_inside = y <= up_to;
        let before = k.checked_sub(1).map(|k| points[k]);
        if let Some((before, low)) = before.filter(|(_, low)| (*low <= up_to) != is_inside) {
            kept.push((before + (x - before) * (up_to - low) / (y - low), up_to));
        }
        if is_inside {
            kept.push((x, y));
        }
    }
    kept
}

fn damping_text(damping: f64) -> String {
    if !damping.is_finite() {
        return "-".to_owned();
    }
    let text = format!("{damping:.4}");
    // Rounding alone is no growth.
    if text == "-0.0000" { "0.0000".to_owned() } else { text }
}

/// Columns with their units in their heads.
fn columns<const K: usize>(columns: [(&str, &str, Values); K]) -> Table {
    let column = |(name, unit, values): (&str, &str, Values)| {
        let name = if matches!(unit, "" | "1") { name.to_owned() } else { format!("{name} [{unit}]") };
        Column { name, values }
    };
    Table { columns: columns.map(column).into(), texts: Vec::new() }
}
