//! What a search has found: as text, as tables, as parameters for the next run, as figures, as a page.

use bg_analysis::criterion::{Criterion, Relation};
use serde_json::{Value, json};

use super::{End, Minimum, OptimizeError, Optimum, Sought, Trial};
use crate::ask::parameters::number;
use crate::files::parquet::{Column, Table, Values};
use crate::files::table::{aligned, table};
use crate::show::figures::FigureError;
use crate::show::figures::plot::{Mark, Plot, Series, with_unit};
use crate::show::sheet::{Item, sheet};

/// A number in so many digits, as tables have it.
fn digits(value: f64) -> String {
    if value.is_finite() { format!("{value:.6e}") } else { "-".to_owned() }
}

impl Sought {
    /// The values of all goals of a run, each as it was written and in its unit; none of a run that failed.
    #[must_use]
    pub fn goals(&self, trial: &Trial) -> Option<Vec<f64>> {
        let goals = trial.goals.as_ref()?.iter().zip(&self.task.goals).zip(&self.is_largest);
        Some(goals.map(|((&value, goal), &is_largest)| self.shown(goal, value, is_largest)).collect())
    }

    /// What is sought, in a few words.
    #[must_use]
    pub fn title(&self) -> String {
        let way = |&is_largest: &bool| if is_largest { "largest" } else { "least" };
        let goals = self.texts.iter().zip(&self.is_largest);
        goals.map(|(text, largest)| format!("{} {}", way(largest), shortened(text))).collect::<Vec<_>>().join(", ")
    }

    fn shown(&self, goal: &Criterion, value: f64, is_largest: bool) -> f64 {
        let value = goal.shown(value);
        if is_largest { -value } else { value }
    }

    /// Goals with their units, as axes are called.
    fn heads(&self) -> Vec<String> {
        let with = |(text, goal): (&String, &Criterion)| with_unit(&shortened(text), goal.unit());
        self.texts.iter().zip(&self.task.goals).map(with).collect()
    }
}

/// A text that fits into a table.
fn shortened(text: &str) -> String {
    const MOST: usize = 56;
    if text.chars().count() <= MOST {
        text.to_owned()
    } else {
        text.chars().take(MOST - 1).chain(['\u{2026}']).collect()
    }
}

/// So many of these.
fn counted(count: usize, one: &str) -> String {
    if count == 1 { format!("one {one}") } else { format!("{count} {one}s") }
}

/// In a sentence how a search has ended.
fn ended(minimum: &Minimum) -> String {
    let fault = minimum.fault.as_ref().map_or_else(String::new, |fault| format!(": {fault}"));
    let end = match minimum.end {
        End::Converged if minimum.is_feasible() => "converged".to_owned(),
        End::Converged => "converged where the requirements are missed least".to_owned(),
        End::Steps => "not converged: as many steps as are allowed; allow more with --steps".to_owned(),
        End::NoStep => format!("ended where no step helps{fault}"),
        End::NoDerivatives => format!("ended where there are no derivatives{fault}"),
        End::Stopped => "stopped".to_owned(),
    };
    match minimum.hops {
        0 => end,
        1 => format!("{end}, once from a better run farther away: there are several minima"),
        hops => {
            format!("{end}, {hops} times from a better run farther away: there are many minima; --starts 8 sees more")
        }
    }
}

/// What failed, in a sentence, if anything did: no feasible point, or no convergence.
#[must_use]
pub fn failure(sought: &Sought, found: &Optimum) -> Option<String> {
    let best = &found.best;
    if !best.is_feasible() {
        let task = &sought.task;
        let sides = task.subjects.iter().zip(&best.sides);
        let missed = sides.filter(|(subject, [left, right])| {
            let (left, right) = (subject.left.shown(*left), subject.left.shown(*right));
            let off = (left - right) / left.abs().max(right.abs()).max(f64::MIN_POSITIVE);
            match subject.relation {
                Relation::AtMost => off > 1e-6,
                Relation::AtLeast => off < -1e-6,
                Relation::Equal => off.abs() > 1e-6,
            }
        });
        let missed: Vec<String> = missed
            .map(|(subject, [left, _])| {
                format!("`{}`, whose left side is {} there", subject.text, digits(subject.left.shown(*left)))
            })
            .collect();
        return Some(format!(
            "no feasible point was found; the best one misses {}; widen bounds or requirements, or try --starts 8",
            if missed.is_empty() { "a requirement".to_owned() } else { missed.join(", and ") }
        ));
    }
    match best.end {
        End::Converged => None,
        End::NoStep if best.fault.is_none() => None,
        _ => Some(format!("the best search has {}", ended(best))),
    }
}

/// The report for the terminal.
#[must_use]
pub fn text(sought: &Sought, found: &Optimum) -> String {
    let best = &found.best;
    let runs: usize = found.searches.iter().flatten().map(|of| of.trials.len()).sum();
    let sloped: usize = found.searches.iter().flatten().map(|of| of.sloped).sum();
    let mut text = format!(
        "{}, after {} and {sloped} with derivatives, from {}\n\n",
        ended(best),
        counted(runs, "run"),
        counted(found.searches.len(), "start")
    );
    text += &table(&goals(sought, best));
    text += &format!("\n{}", table(&variables(sought, best)));
    if !sought.task.subjects.is_empty() {
        text += &format!("\n{}", table(&subjects(sought, best)));
    }
    if found.searches.len() > 1 {
        text += "\nsearches\n";
        text += &table(&searches(sought, found));
    }
    if !found.front.is_empty() {
        text += "\nfront\n";
        text += &aligned(&front_rows(sought, found));
    }
    text
}

fn goals(sought: &Sought, best: &Minimum) -> Vec<[String; 4]> {
    let head = ["goal", "at the start", "found", "unit"].map(str::to_owned);
    let first = best.trials.first().and_then(|trial| sought.goals(trial)).unwrap_or_default();
    let last = sought.goals(&best.best).unwrap_or_default();
    let of = |trial: &[f64], k: usize| trial.get(k).map_or_else(|| "-".to_owned(), |value| digits(*value));
    let rows = (0..sought.texts.len()).map(|k| {
        let way = if sought.is_largest[k] { "largest" } else { "least" };
        let name = format!("{way} {}", shortened(&sought.texts[k]));
        [name, of(&first, k), of(&last, k), sought.task.goals[k].unit().to_owned()]
    });
    std::iter::once(head).chain(rows).collect()
}

/// Which bound a variable is at.
fn at_bound(value: f64, [lower, upper]: [f64; 2]) -> &'static str {
    const NEAR: f64 = 1e-6;
    let near = |bound: f64| bound.is_finite() && (value - bound).abs() <= NEAR * bound.abs().max(value.abs());
    if near(lower) {
        "lower"
    } else if near(upper) {
        "upper"
    } else {
        ""
    }
}

fn variables(sought: &Sought, best: &Minimum) -> Vec<[String; 7]> {
    let head = ["parameter", "unit", "start", "found", "from", "to", "at bound"].map(str::to_owned);
    let bound = |value: f64| if value.is_finite() { number(value) } else { "-".to_owned() };
    let rows = sought.task.variables.iter().zip(best.job.start.iter().zip(&best.best.values));
    let rows = rows.map(|(of, (start, value))| {
        let cells = [bound(of.lower), bound(of.upper)];
        let [lower, upper] = cells;
        let at = at_bound(*value, [of.lower, of.upper]).to_owned();
        [of.info.name.to_owned(), of.info.unit.to_owned(), digits(*start), digits(*value), lower, upper, at]
    });
    std::iter::once(head).chain(rows).collect()
}

fn subjects(sought: &Sought, best: &Minimum) -> Vec<[String; 5]> {
    const NEAR: f64 = 1e-5;
    let head = ["requirement", "left", "right", "unit", "is"].map(str::to_owned);
    let rows = sought.task.subjects.iter().zip(&best.sides).map(|(subject, sides)| {
        let [left, right] = sides.map(|side| subject.left.shown(side));
        let size = left.abs().max(right.abs()).max(f64::MIN_POSITIVE);
        let room = if subject.relation == Relation::AtLeast { left - right } else { right - left } / size;
        let is = match subject.relation {
            Relation::Equal if room.abs() <= NEAR => "met",
            Relation::Equal => "missed",
            _ if room < -NEAR => "missed",
            _ if room < NEAR => "active",
            _ => "met",
        };
        [shortened(&subject.text), digits(left), digits(right), subject.left.unit().to_owned(), is.to_owned()]
    });
    std::iter::once(head).chain(rows).collect()
}

fn searches(sought: &Sought, found: &Optimum) -> Vec<[String; 4]> {
    let head = ["start", "goal", "runs", "end"].map(str::to_owned);
    let rows = found.searches.iter().zip(sought.task.starts(found.searches.len() as u32)).map(|(search, start)| {
        let start = start.iter().map(|value| format!("{value:.4e}")).collect::<Vec<_>>().join(", ");
        match search {
            Ok(found) => {
                let goal = sought.goals(&found.best).filter(|_| found.is_feasible());
                let goal = goal.map_or_else(|| "-".to_owned(), |goals| digits(goals[0]));
                [start, goal, found.trials.len().to_string(), ended(found)]
            }
            Err(OptimizeError::Start { fault, .. }) => [start, "-".to_owned(), "1".to_owned(), fault.clone()],
            Err(fault) => [start, "-".to_owned(), "0".to_owned(), fault.to_string()],
        }
    });
    std::iter::once(head).chain(rows).collect()
}

/// The front: goals, then variables.
fn front_rows(sought: &Sought, found: &Optimum) -> Vec<Vec<String>> {
    let names = sought.task.variables.iter().map(|of| with_unit(of.info.name, of.info.unit));
    let head = sought.heads().into_iter().chain(names).collect();
    let row = |of: &Minimum| {
        let goals = sought.goals(&of.best).unwrap_or_default();
        goals.iter().chain(&of.best.values).map(|value| digits(*value)).collect()
    };
    std::iter::once(head).chain(found.front.iter().map(row)).collect()
}

/// The parameters found, as a file for `--params`.
#[must_use]
pub fn toml(sought: &Sought, found: &Optimum) -> String {
    let values = sought.task.variables.iter().zip(&found.best.best.values);
    let line = |(of, value): (&super::Variable, &f64)| {
        let unit = if of.info.unit.is_empty() { "1" } else { of.info.unit };
        format!("# [{unit}]\n{} = {value:?}\n", of.info.name)
    };
    values.map(line).collect()
}

/// All runs, a row for each: search, run, variables, goals, by how much requirements are missed.
#[must_use]
pub fn trials(sought: &Sought, found: &Optimum) -> Table {
    rows_of(
        sought,
        found.searches.iter().enumerate().filter_map(|(k, search)| Some((k, search.as_ref().ok()?))).flat_map(
            |(search, found)| {
                found.trials.iter().enumerate().map(move |(run, trial)| ([search as i64, run as i64], trial))
            },
        ),
    )
}

/// The front, a row for each point.
#[must_use]
pub fn front(sought: &Sought, found: &Optimum) -> Table {
    rows_of(sought, found.front.iter().enumerate().map(|(k, of)| ([k as i64, 0], &of.best)))
}

fn rows_of<'a>(sought: &Sought, rows: impl Iterator<Item = ([i64; 2], &'a Trial)>) -> Table {
    let rows: Vec<([i64; 2], &Trial)> = rows.collect();
    let column = |name: &str, values: Values| Column { name: name.to_owned(), values };
    let whole = |place: usize| Values::Whole(rows.iter().map(|(numbers, _)| numbers[place]).collect());
    let real = |of: &dyn Fn(&Trial) -> f64| Values::Real(rows.iter().map(|(_, trial)| of(trial)).collect());
    let variables = sought.task.variables.iter().enumerate();
    let variables = variables.map(|(k, of)| column(of.info.name, real(&|trial| trial.values[k])));
    let goals = sought
        .texts
        .iter()
        .enumerate()
        .map(|(k, text)| column(text, real(&|trial| sought.goals(trial).map_or(f64::NAN, |goals| goals[k]))));
    let missed = |trial: &Trial| if trial.missed.is_finite() { trial.missed } else { f64::NAN };
    let missed = std::iter::once(column("missed", real(&missed)));
    let columns = [column("search", whole(0)), column("run", whole(1))];
    let units = sought.task.variables.iter().map(|of| (of.info.name.to_owned(), of.info.unit));
    let units = units.chain(sought.texts.iter().cloned().zip(sought.task.goals.iter().map(Criterion::unit)));
    let units: serde_json::Map<String, Value> = units.map(|(name, unit)| (name, unit.into())).collect();
    let texts = vec![("units".to_owned(), Value::Object(units).to_string())];
    Table { columns: columns.into_iter().chain(variables).chain(goals).chain(missed).collect(), texts }
}

/// All that was found, for programs.
#[must_use]
pub fn json(sought: &Sought, found: &Optimum) -> Value {
    let minimum = |of: &Minimum| {
        let values: serde_json::Map<String, Value> = (sought.task.variables.iter().zip(&of.best.values))
            .map(|(variable, &value)| (variable.info.name.to_owned(), value.into()))
            .collect();
        let goals = sought.goals(&of.best).unwrap_or_default();
        let goals = goals.iter().zip(&sought.texts).zip(&sought.task.goals);
        let goals = goals.map(|((value, text), goal)| json!({ "text": text, "value": value, "unit": goal.unit() }));
        let subjects = sought.task.subjects.iter().zip(&of.sides).map(|(subject, sides)| {
            let [left, right] = sides.map(|side| subject.left.shown(side));
            json!({ "text": subject.text, "left": left, "right": right, "unit": subject.left.unit() })
        });
        json!({
            "parameters": values,
            "goals": goals.collect::<Vec<_>>(),
            "subjects": subjects.collect::<Vec<_>>(),
            "feasible": of.is_feasible(),
            "converged": of.end == End::Converged,
            "end": ended(of),
            "hops": of.hops,
            "runs": of.trials.len(),
            "runs_with_derivatives": of.sloped,
        })
    };
    let search = |search: &Result<Minimum, OptimizeError>| match search {
        Ok(found) => minimum(found),
        Err(fault) => json!({ "failed": fault.to_string() }),
    };
    json!({
        "best": minimum(&found.best),
        "searches": found.searches.iter().map(search).collect::<Vec<_>>(),
        "front": found.front.iter().map(minimum).collect::<Vec<_>>(),
        "units": sought.task.variables.iter().map(|of| (of.info.name.to_owned(), Value::from(of.info.unit)))
            .collect::<serde_json::Map<String, Value>>(),
    })
}

/// The figure of a search: its first goal over the runs that fulfil all requirements, and the least one so far.
///
/// # Errors
/// No run is feasible, or the drawing crate refuses.
pub fn course(sought: &Sought, found: &Optimum) -> Result<String, FigureError> {
    let all = &found.best.trials;
    let goal = |trial: &Trial| sought.goals(trial).map(|goals| goals[0]);
    let points = |is_feasible: bool| -> Vec<(f64, f64)> {
        let numbered = all.iter().enumerate().filter(|(_, trial)| (trial.missed <= 1e-6) == is_feasible);
        numbered.filter_map(|(run, trial)| Some((run as f64 + 1.0, goal(trial)?))).collect()
    };
    let series = |name: &str, points, mark| Series { name: name.to_owned(), points, mark };
    let kept = points(true);
    let best = kept.iter().scan(None::<f64>, |best, &(run, value)| {
        let is_better = best.is_none_or(|best| if sought.is_largest[0] { value > best } else { value < best });
        *best = Some(if is_better { value } else { best.unwrap_or(value) });
        best.map(|best| (run, best))
    });
    let best: Vec<(f64, f64)> = best.collect();
    let heads = sought.heads();
    let mut series = vec![
        series("best so far", best, Mark::Line),
        series("missed", points(false), Mark::Dots),
        series("fulfilled", kept, Mark::Dots),
    ];
    series.retain(|series| !series.points.is_empty());
    Plot::new("The best search, run by run", "run", &heads[0], series).drawn()
}

/// The figure of the front.
///
/// # Errors
/// There is none, or the drawing crate refuses.
pub fn front_figure(sought: &Sought, found: &Optimum) -> Result<String, FigureError> {
    let point = |of: &Minimum| sought.goals(&of.best).map(|goals| (goals[0], goals[1]));
    let points: Vec<(f64, f64)> = found.front.iter().filter_map(point).collect();
    let heads = sought.heads();
    let first = found.best.trials.first().and_then(|trial| sought.goals(trial)).map(|goals| (goals[0], goals[1]));
    let series = vec![
        Series { name: "front".to_owned(), points, mark: Mark::Both },
        Series { name: "at the start".to_owned(), points: first.into_iter().collect(), mark: Mark::Dots },
    ];
    Plot::new("None of both goals gets better without the other one getting worse", &heads[0], &heads[1], series)
        .drawn()
}

/// The page of all that.
#[must_use]
pub fn page(title: &str, sought: &Sought, found: &Optimum, about: &str, figures: Vec<(String, String)>) -> String {
    fn item<const K: usize>(rows: Vec<[String; K]>) -> Item {
        let mut rows = rows.into_iter().map(|row| row.to_vec());
        let head = rows.next().unwrap_or_default();
        Item::Table(head, rows.collect())
    }
    let mut items = vec![Item::Text(about.to_owned()), Item::Text(format!("The best search: {}.", ended(&found.best)))];
    items.extend(failure(sought, found).map(|failure| Item::Text(format!("Note: {failure}."))));
    items.extend([item(goals(sought, &found.best)), item(variables(sought, &found.best))]);
    if !sought.task.subjects.is_empty() {
        items.extend([Item::Heading("Requirements".to_owned()), item(subjects(sought, &found.best))]);
    }
    items.extend(figures.into_iter().map(|(caption, svg)| Item::Figure(caption, svg)));
    if !found.front.is_empty() {
        let mut rows = front_rows(sought, found);
        let head = rows.remove(0);
        items.extend([Item::Heading("Front".to_owned()), Item::Table(head, rows)]);
    }
    if found.searches.len() > 1 {
        items.extend([Item::Heading("Searches".to_owned()), item(searches(sought, found))]);
    }
    sheet(title, &items)
}
