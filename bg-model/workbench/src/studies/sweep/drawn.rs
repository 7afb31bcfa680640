//! What a sweep looks like: a page with the numbers of its runs over the parameters; of tolerances how they are spread,
//! and which parameter spreads them.
//!
//! In: a program, the folder of a sweep. Out: `index.html`, and of tolerances `statistics.csv` and a text. Lines over
//! one parameter, maps over two, parallel axes and dots over more; histograms and ranked bars of tolerances, beside
//! what derivatives at the means say to first order.

use std::path::Path;

use bg_model::integrator::Integrator;
use bg_model::run::Request;

use super::SweepError;
use super::design::Layout;
use super::distribution::Drawn;
use super::folder::{Folder, ShardFile};
use super::plan::Plan;
use super::shown::tables;
use super::statistics::{Estimate, Index, Spread, indices, spread};
use crate::files::parquet::Values;
use crate::files::table::table;
use crate::files::whole;
use crate::program::Program;
use crate::show::figures::FigureError;
use crate::show::figures::parallel::{Column as Parallel, parallel};
use crate::show::figures::plot::{Bar, Map, Mark, Plot, Series, bars, histogram, with_unit};
use crate::show::sheet::{Item, sheet};

/// The page of a sweep, and the file of its statistics.
pub const PAGE: &str = "index.html";
/// As above.
pub const STATISTICS: &str = "statistics.csv";
/// The most numbers that are drawn.
const MOST: usize = 12;
/// The most runs that a page draws: of more every second, third .. one.
const MOST_RUNS: usize = 4000;
/// The most lines over one parameter, one for each value of the other ones.
const MOST_LINES: usize = 7;

/// A column: its name with its unit, its values.
struct Column {
    name: String,
    unit: String,
    values: Vec<f64>,
}

impl Column {
    fn head(&self) -> String {
        with_unit(&self.name, &self.unit)
    }

    fn parallel(&self) -> Parallel<'_> {
        Parallel { name: &self.name, unit: &self.unit, values: &self.values }
    }
}

/// What is known of a number of runs whose parameters have tolerances.
struct Toleranced {
    name: String,
    unit: String,
    values: Vec<f64>,
    spread: Spread,
    indices: Option<Vec<Index>>,
    /// Value at the means, and the parts of the standard deviation by each parameter, to first order.
    first_order: Option<(f64, Vec<f64>, f64)>,
}

/// Whether the folder has a page.
#[must_use]
pub fn is_there(folder: &Folder) -> bool {
    folder.path().join(PAGE).exists()
}

/// Writes the page of what is in a folder, and gives a text on tolerances, which is empty without any.
///
/// # Errors
/// A file cannot be read or written.
pub fn write(program: &Program, folder: &Folder) -> Result<String, SweepError> {
    let recipe = folder.entries()?;
    let text = recipe.get("plan").and_then(toml::Value::as_str).unwrap_or_default().to_owned();
    // Files that a plan names may be elsewhere now; then there is no page.
    let Ok(plan) = Plan::parse(program, "the plan", Path::new(""), text) else { return Ok(String::new()) };
    let width = plan.design.names.len();
    let (columns, failed) = read(folder, &plan)?;
    let (swept, numbers) = columns.split_at(width.min(columns.len()));
    let runs = swept.first().map_or(0, |column| column.values.len());
    let mut items = vec![Item::Text(format!(
        "{}, scene `{}`, over {} s: {runs} of {} runs are here, {failed} of them failed.",
        program.texts.name_and_version(),
        plan.scene.name,
        plan.request.t_end,
        plan.design.runs
    ))];
    let mut told = String::new();
    match plan.design.layout() {
        Layout::Drawn(drawn) => {
            let found = toleranced(program, &plan, drawn, numbers);
            told = told_of(&found, &plan.design.names);
            whole::write(&folder.path().join(STATISTICS), |file| {
                file.write_all(csv(&found, &plan.design.names).as_bytes())
            })?;
            items.extend(items_of(&found, &plan.design.names));
        }
        Layout::Grid(axes) => items.extend(of_grid(axes, swept, numbers)),
        Layout::Scattered => items.extend(scattered(swept, numbers)),
    }
    if numbers.len() > MOST {
        items.push(Item::Text(format!("{} more numbers are in the files.", numbers.len() - MOST)));
    }
    let names = plan.design.names.join(", ");
    let page = sheet(&format!("{}: sweep of {names}", plan.scene.name), &items);
    whole::write(&folder.path().join(PAGE), |file| file.write_all(page.as_bytes()))?;
    Ok(told)
}

/// The swept parameters, then the first numbers, of the runs that are there; how many have failed.
fn read(folder: &Folder, plan: &Plan<'_>) -> Result<(Vec<Column>, usize), SweepError> {
    let mut columns: Vec<Column> = Vec::new();
    let mut failed = 0;
    let swept = &plan.design.names;
    let is_all = matches!(plan.design.layout(), Layout::Drawn(_));
    for table in tables(folder, ShardFile::Runs)? {
        let table = table?;
        let units = table.texts.iter().find(|(name, _)| name == "units").map_or("{}", |(_, text)| text);
        let units: std::collections::BTreeMap<String, String> = serde_json::from_str(units).unwrap_or_default();
        let own = |name: &str| super::OWN_COLUMNS.contains(&name);
        let is_swept = |name: &String| swept.contains(name);
        let numbers = table.columns.iter().filter(|column| !own(&column.name) && !is_swept(&column.name));
        let parameters = swept.iter().filter_map(|name| table.columns.iter().find(|column| column.name == *name));
        let kept = parameters.chain(numbers.take(if is_all { usize::MAX } else { MOST + 1 }));
        for (place, column) in kept.enumerate() {
            let Values::Real(values) = &column.values else { continue };
            if columns.len() <= place {
                let unit = units.get(&column.name).cloned().unwrap_or_default();
                columns.push(Column { name: column.name.clone(), unit, values: Vec::new() });
            }
            columns[place].values.extend_from_slice(values);
        }
        if let Some(Values::Text(status)) =
            table.columns.iter().find(|column| column.name == "status").map(|column| &column.values)
        {
            failed += status.iter().filter(|status| *status != "done").count();
        }
    }
    Ok((columns, failed))
}

fn toleranced(program: &Program, plan: &Plan<'_>, drawn: &Drawn, numbers: &[Column]) -> Vec<Toleranced> {
    let first_order = first_order(program, plan, drawn);
    let width = drawn.width();
    let of = |(place, column): (usize, &Column)| {
        // Of the runs for indices A and B are drawn alone.
        let is_drawn = |run: usize| !drawn.has_indices() || run % width < 2;
        let values: Vec<f64> =
            column.values.iter().enumerate().filter(|(run, _)| is_drawn(*run)).map(|(_, v)| *v).collect();
        Some(Toleranced {
            name: column.name.clone(),
            unit: column.unit.clone(),
            spread: spread(&values)?,
            indices: drawn.has_indices().then(|| indices(&column.values, width - 2)).flatten(),
            first_order: first_order.as_ref().and_then(|of| of.get(place).cloned()).flatten(),
            values,
        })
    };
    numbers.iter().enumerate().filter_map(of).collect()
}

/// For each number its value with all parameters at their means, the parts of its deviation by each, and all of it;
/// none where there are no derivatives.
type FirstOrder = Vec<Option<(f64, Vec<f64>, f64)>>;

fn first_order(program: &Program, plan: &Plan<'_>, drawn: &Drawn) -> Option<FirstOrder> {
    let numbers = plan.numbers.as_ref()?;
    let mut values = plan.chosen.values.clone();
    for (name, of) in plan.design.names.iter().zip(drawn.distributions()) {
        values.set(name, of.moments()[0]).ok()?;
    }
    let machine = program.models.made(plan.scene, &values, &plan.chosen.inputs).ok()?;
    let by: Vec<&str> = plan.design.names.iter().map(String::as_str).collect();
    let auto = plan.request.method == Integrator::default();
    let method = if auto { Integrator::Dop853 } else { plan.request.method };
    let request = Request { method, ..plan.request.clone() };
    let (found, slopes) = machine.looked(&numbers.look, &request, &by)?.ok()?;
    let criteria = numbers.look.criteria();
    let of = |number: &bg_analysis::criterion::Criterion| {
        if criteria.without_derivatives(number).is_some() {
            return None;
        }
        let slopes: Vec<f64> = slopes.of(criteria, number).into_iter().map(|slope| number.shown(slope)).collect();
        let deviation = |k: usize| drawn.covariance(k, k).sqrt();
        let parts = slopes.iter().enumerate().map(|(k, slope)| slope * deviation(k)).collect();
        let pairs = (0..slopes.len()).flat_map(|a| (0..slopes.len()).map(move |b| (a, b)));
        let variance = pairs.fold(0.0, |sum, (a, b)| sum + slopes[a] * slopes[b] * drawn.covariance(a, b));
        Some((number.shown(criteria.value(number, &found.known)), parts, variance.max(0.0).sqrt()))
    };
    Some(numbers.named.iter().map(|(_, number)| of(number)).collect())
}

fn digits(value: f64) -> String {
    if value.is_finite() { format!("{value:.4e}") } else { "-".to_owned() }
}

/// A value with half of its interval.
fn with_error(of: &Estimate) -> String {
    let half = 0.5 * (of.interval[1] - of.interval[0]);
    format!("{} +- {half:.1e}", digits(of.value))
}

const HEAD: [&str; 7] = ["number", "unit", "mean", "deviation", "5 % are below", "median", "95 % are below"];

fn spread_rows(found: &[Toleranced]) -> Vec<[String; 7]> {
    let row = |of: &Toleranced| {
        let Spread { mean, deviation, quantiles, .. } = &of.spread;
        let [five, half, ninety_five] = [1, 2, 3].map(|k: usize| with_error(&quantiles[k].1));
        [of.name.clone(), of.unit.clone(), with_error(mean), with_error(deviation), five, half, ninety_five]
    };
    std::iter::once(HEAD.map(str::to_owned)).chain(found.iter().map(row)).collect()
}

/// Which parameter spreads a number: indices where there are some, parts of the variance to first order.
fn part_rows(of: &Toleranced, names: &[String]) -> Vec<[String; 4]> {
    let head = ["parameter", "first index", "total index", "first order, % of the variance"].map(str::to_owned);
    let squares = of.first_order.as_ref().map(|(_, parts, all)| (parts, all * all));
    let row = |(k, name): (usize, &String)| {
        let index = of.indices.as_ref().map(|indices| indices[k]);
        let first = index.map_or_else(|| "-".to_owned(), |index| short(&index.first));
        let total = index.map_or_else(|| "-".to_owned(), |index| short(&index.total));
        let part = squares.as_ref().map_or_else(
            || "-".to_owned(),
            |(parts, all)| {
                if *all > 0.0 { format!("{:.1}", 100.0 * parts[k] * parts[k] / all) } else { "-".to_owned() }
            },
        );
        [name.clone(), first, total, part]
    };
    std::iter::once(head).chain(names.iter().enumerate().map(row)).collect()
}

fn short(of: &Estimate) -> String {
    format!("{:.3} +- {:.3}", of.value, 0.5 * (of.interval[1] - of.interval[0]))
}

/// A sentence on what derivatives at the means say.
fn first_order_text(of: &Toleranced) -> Option<String> {
    let (value, _, deviation) = of.first_order.as_ref()?;
    Some(format!(
        "to first order, by derivatives at the means: {} with a deviation of {}",
        digits(*value),
        digits(*deviation)
    ))
}

/// The text for the terminal.
fn told_of(found: &[Toleranced], names: &[String]) -> String {
    let mut told = format!("\n{}", table(&spread_rows(found)));
    for of in found {
        told += &format!("\n{}, which parameter spreads it\n", of.name);
        told += &table(&part_rows(of, names));
        told += &first_order_text(of).map_or_else(String::new, |text| format!("  {text}\n"));
    }
    told
}

/// All statistics as CSV: a row for each number and what is said of it.
fn csv(found: &[Toleranced], names: &[String]) -> String {
    let mut text = "number,unit,statistic,parameter,value,from,to\n".to_owned();
    for of in found {
        let mut row = |statistic: &str, parameter: &str, value: f64, [from, to]: [f64; 2]| {
            let cell = |value: f64| if value.is_finite() { format!("{value:?}") } else { String::new() };
            let cells = [cell(value), cell(from), cell(to)].join(",");
            text += &format!("{},{},{statistic},{parameter},{cells}\n", of.name, of.unit);
        };
        let none = [f64::NAN; 2];
        let Spread { count, mean, deviation, range, quantiles } = &of.spread;
        row("count", "", *count as f64, none);
        row("mean", "", mean.value, mean.interval);
        row("deviation", "", deviation.value, deviation.interval);
        row("least", "", range[0], none);
        row("largest", "", range[1], none);
        for (part, quantile) in quantiles {
            row(&format!("quantile {part}"), "", quantile.value, quantile.interval);
        }
        for (index, name) in of.indices.iter().flatten().zip(names) {
            row("first index", name, index.first.value, index.first.interval);
            row("total index", name, index.total.value, index.total.interval);
        }
        if let Some((value, parts, deviation)) = &of.first_order {
            row("first order value", "", *value, none);
            row("first order deviation", "", *deviation, none);
            names
                .iter()
                .zip(parts)
                .for_each(|(name, part)| row("first order part of the deviation", name, *part, none));
        }
    }
    text
}

fn rows_item<const K: usize>(rows: Vec<[String; K]>) -> Item {
    let mut rows = rows.into_iter().map(|row| row.to_vec());
    let head = rows.next().unwrap_or_default();
    Item::Table(head, rows.collect())
}

/// A figure, where there is one.
fn figure(caption: &str, drawn: Result<String, FigureError>) -> Option<Item> {
    drawn.ok().map(|svg| Item::Figure(caption.to_owned(), svg))
}

fn items_of(found: &[Toleranced], names: &[String]) -> Vec<Item> {
    let mut items = vec![rows_item(spread_rows(found))];
    for of in found.iter().take(MOST) {
        items.push(Item::Heading(of.name.clone()));
        let head = with_unit(&of.name, &of.unit);
        let quantile = |k: usize| of.spread.quantiles[k].1.value;
        let marks = [("5 %", quantile(1)), ("mean", of.spread.mean.value), ("95 %", quantile(3))];
        let marks = marks.map(|(name, at)| (name.to_owned(), at));
        let count = of.spread.count;
        items.extend(figure(
            &format!("How {} is spread in {count} runs", of.name),
            histogram(&format!("{} in {count} runs", of.name), &head, &of.values, &marks),
        ));
        let bar = |(k, name): (usize, &String)| match (&of.indices, &of.first_order) {
            (Some(indices), _) => {
                let Index { first, total } = &indices[k];
                let text = format!("{:.3}, by itself {:.3}", total.value, first.value);
                Some(Bar { name: name.clone(), value: total.value.max(0.0), inner: Some(first.value), text })
            }
            (None, Some((_, parts, all))) if *all > 0.0 => {
                let part = (parts[k] / all).powi(2);
                let text = format!("{:.1} %", 100.0 * part);
                Some(Bar { name: name.clone(), value: part, inner: None, text })
            }
            _ => None,
        };
        let ranked: Vec<Bar> = names.iter().enumerate().filter_map(bar).collect();
        let caption = if of.indices.is_some() {
            "part of the variance: total Sobol index, dark by itself"
        } else {
            "part of the variance, to first order"
        };
        items
            .extend(figure("Which parameter spreads it", bars(&format!("What spreads {}", of.name), caption, &ranked)));
        items.push(rows_item(part_rows(of, names)));
        items.extend(first_order_text(of).map(Item::Text));
    }
    items
}

/// Lines over the parameter with the most values, or a map over two.
fn of_grid(axes: &[Vec<f64>], swept: &[Column], numbers: &[Column]) -> Vec<Item> {
    let several: Vec<usize> = (0..axes.len()).filter(|&axis| axes[axis].len() > 1).collect();
    let drawn = numbers.iter().take(MOST);
    match several[..] {
        [axis] => drawn.filter_map(|number| over_one(&swept[axis], None, number)).collect(),
        [a, b] if axes[a].len().min(axes[b].len()) <= MOST_LINES => {
            let (lines, across) = if axes[a].len() < axes[b].len() { (a, b) } else { (b, a) };
            drawn.filter_map(|number| over_one(&swept[across], Some(&swept[lines]), number)).collect()
        }
        [a, b] => drawn.filter_map(|number| map(axes, [a, b], swept, number)).collect(),
        _ => scattered(swept, numbers),
    }
}

/// A number over one parameter, a line for each value of another one.
fn over_one(across: &Column, lines: Option<&Column>, number: &Column) -> Option<Item> {
    let mut series: Vec<(f64, Series)> = Vec::new();
    for run in 0..number.values.len() {
        let of = lines.map_or(0.0, |column| column.values[run]);
        let point = (across.values[run], number.values[run]);
        match series.iter_mut().find(|(known, _)| *known == of) {
            Some((_, series)) => series.points.push(point),
            None => {
                let name = lines.map_or_else(String::new, |column| {
                    format!("{} = {}", column.name, crate::ask::parameters::number(of))
                });
                series.push((of, Series { name, points: vec![point], mark: Mark::Both }));
            }
        }
    }
    let plot = Plot::new(
        &format!("{} over {}", number.name, across.name),
        &across.head(),
        &number.head(),
        series.into_iter().map(|(_, series)| series).collect(),
    );
    figure(&format!("{} over {}", number.name, across.name), plot.drawn())
}

fn map(axes: &[Vec<f64>], [a, b]: [usize; 2], swept: &[Column], number: &Column) -> Option<Item> {
    let sorted = |axis: usize| {
        let mut values = axes[axis].clone();
        values.sort_unstable_by(f64::total_cmp);
        values.dedup();
        values
    };
    let (up, across) = (sorted(a), sorted(b));
    let mut values = vec![f64::NAN; up.len() * across.len()];
    let place = |of: &[f64], value: f64| of.iter().position(|known| *known == value);
    for (run, value) in number.values.iter().enumerate() {
        let (row, column) = (place(&up, swept[a].values[run])?, place(&across, swept[b].values[run])?);
        values[row * across.len() + column] = *value;
    }
    let caption = format!("{} over {} and {}", number.name, swept[b].name, swept[a].name);
    let captions = [swept[b].head(), swept[a].head(), number.head()];
    figure(&caption, Map { heading: caption.clone(), captions, across, up, values }.drawn())
}

/// Of more than two parameters each number on parallel axes, a line for each run; then each number over each parameter,
/// a dot for each run.
fn scattered(swept: &[Column], numbers: &[Column]) -> Vec<Item> {
    let on_axes = |number: &Column| {
        let names = swept.iter().map(|column| column.name.as_str()).collect::<Vec<_>>().join(", ");
        let caption = format!("{} of each run by {names}, in the colour of {}", number.name, number.name);
        let columns: Vec<Parallel<'_>> = swept.iter().chain([number]).map(Column::parallel).collect();
        figure(&caption, parallel(&format!("{} on parallel axes", number.name), &columns))
    };
    let mut items: Vec<Item> = Vec::new();
    if swept.len() > 2 {
        items.extend(numbers.iter().take(MOST).filter_map(on_axes));
    }
    let every = numbers.first().map_or(1, |number| number.values.len().div_ceil(MOST_RUNS)).max(1);
    let pairs = numbers.iter().take(MOST).flat_map(|number| swept.iter().map(move |across| (number, across)));
    let one = |(number, across): (&Column, &Column)| {
        let points = across.values.iter().copied().zip(number.values.iter().copied()).step_by(every).collect();
        let series = vec![Series { name: String::new(), points, mark: Mark::Dots }];
        let caption = format!("{} over {}", number.name, across.name);
        figure(&caption, Plot::new(&caption, &across.head(), &number.head(), series).drawn())
    };
    items.extend(pairs.take(2 * MOST).filter_map(one));
    items
}
