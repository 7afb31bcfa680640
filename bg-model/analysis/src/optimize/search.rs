//! One search from one start, by sequential least-squares programming.
//!
//! In: what is evaluated at variables, with derivatives where it is wanted. Out: the best variables that were seen.
//! Method: D. Kraft, A software package for sequential quadratic programming, DFVLR-FB 88-28 (1988), as the crate
//! `basin` has it. A goal that is the largest of several numbers becomes a bound above all of them, which is smooth
//! where its largest one changes. All numbers are in parts of their sizes at the start.

use std::cell::{Cell, RefCell};
use std::ops::ControlFlow;

use basin::{
    BoxBounds, ConstraintDescription, ConstraintJacobian, ConstraintSet, ConstraintSolveError, Constraints,
    CostFunction, DenseMatrix, Executor, Gradient, NoLinearConstraints, NonlinearBlock, NonlinearBlocks,
    NonlinearEqualityValues, NonlinearInequalityValues, SelectedFirstOrderState, Slsqp, TerminationCode,
};

/// The numbers at some variables.
#[derive(Clone, Debug, PartialEq)]
pub struct Numbers {
    /// Several numbers, the largest of which is to be least.
    pub goal: Vec<f64>,
    /// Numbers that are to be zero.
    pub zero: Vec<f64>,
    /// Numbers that are to be zero at most.
    pub at_most_zero: Vec<f64>,
}

/// Their derivatives by the variables, a row for each.
#[derive(Clone, Debug, PartialEq)]
pub struct Rows {
    /// Of the goal.
    pub goal: Vec<Vec<f64>>,
    /// Of what is to be zero.
    pub zero: Vec<Vec<f64>>,
    /// Of what is to be zero at most.
    pub at_most_zero: Vec<Vec<f64>>,
}

/// What is searched in.
pub trait Evaluated {
    /// The numbers at variables; none where there are none.
    ///
    /// # Errors
    /// The search is to stop.
    fn numbers(&mut self, x: &[f64]) -> ControlFlow<(), Option<Numbers>>;

    /// Their derivatives where numbers were found last; none where there are none.
    fn rows(&mut self, x: &[f64]) -> Option<Rows>;
}

/// How a search ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum End {
    /// It has converged.
    Converged,
    /// It has made as many steps as it may.
    Steps,
    /// It finds no step that helps.
    NoStep,
    /// There are no derivatives where it has come to.
    NoDerivatives,
    /// It was told to stop.
    Stopped,
}

/// Searches from `start` between bounds, in at most `steps` steps, to the accuracy `accuracy` of all numbers.
/// `numbers` are those at the start.
pub fn search(
    evaluated: &mut dyn Evaluated,
    (start, numbers): (&[f64], &Numbers),
    [lower, upper]: [&[f64]; 2],
    (steps, accuracy): (u64, f64),
) -> End {
    let largest = numbers.goal.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    // The bound above several goals is a variable more.
    let bound = (numbers.goal.len() > 1).then_some(largest);
    let with = |of: &[f64], more: f64| of.iter().copied().chain(bound.map(|_| more)).collect::<Vec<f64>>();
    let goals = if bound.is_some() { numbers.goal.len() } else { 0 };
    let has_rows = Cell::new(true);
    let problem = Adapter {
        evaluated: RefCell::new(evaluated),
        latest: RefCell::new(None),
        slopes: RefCell::new(None),
        has_rows: &has_rows,
        variables: start.len(),
        bounds: [with(lower, f64::NEG_INFINITY), with(upper, f64::INFINITY)],
        zero: numbers.zero.len(),
        at_most_zero: numbers.at_most_zero.len() + goals,
        has_bound: bound.is_some(),
    };
    let solver = Slsqp::new().with_absolute_accuracy_tolerance(accuracy);
    let first = SelectedFirstOrderState::new(with(start, largest));
    match Executor::new(problem, solver, first).max_iter(steps).run() {
        Err(_) => End::Stopped,
        Ok(_) if !has_rows.get() => End::NoDerivatives,
        Ok(result) => match result.report.code() {
            TerminationCode::SolverConverged => End::Converged,
            TerminationCode::MaxIter => End::Steps,
            _ => End::NoStep,
        },
    }
}

/// What `basin` asks.
struct Adapter<'a> {
    evaluated: RefCell<&'a mut dyn Evaluated>,
    /// The last numbers, and of which variables.
    latest: RefCell<Option<(Vec<f64>, Option<Numbers>)>>,
    /// The last derivatives likewise: those of the goal and of the rest are asked for one after the other.
    slopes: RefCell<Option<(Vec<f64>, Option<Rows>)>>,
    /// Whether there were derivatives wherever they were asked for.
    has_rows: &'a Cell<bool>,
    variables: usize,
    bounds: [Vec<f64>; 2],
    zero: usize,
    at_most_zero: usize,
    /// Whether the last variable is the bound above several goals.
    has_bound: bool,
}

/// The search is to stop.
#[derive(Debug, thiserror::Error)]
#[error("stopped")]
struct Stopped;

type Asked<T> = Result<T, ConstraintSolveError<Stopped>>;

impl Adapter<'_> {
    /// The numbers at variables; infinite ones where there are none, which no step leads to.
    fn numbers<T>(&self, x: &[f64], of: impl FnOnce(Option<&Numbers>) -> T) -> Result<T, Stopped> {
        let own = &x[..self.variables];
        let is_known = self.latest.borrow().as_ref().is_some_and(|(known, _)| known == own);
        if !is_known {
            let ControlFlow::Continue(numbers) = self.evaluated.borrow_mut().numbers(own) else { return Err(Stopped) };
            *self.latest.borrow_mut() = Some((own.to_vec(), numbers));
        }
        let latest = self.latest.borrow();
        Ok(of(latest.as_ref().and_then(|(_, numbers)| numbers.as_ref())))
    }

    /// The derivatives there; what is no number where there are none.
    fn rows(&self, x: &[f64]) -> Result<Option<Rows>, Stopped> {
        let own = &x[..self.variables];
        let is_known = self.slopes.borrow().as_ref().is_some_and(|(known, _)| known == own);
        if !is_known {
            self.numbers(x, |_| ())?;
            let rows = self.evaluated.borrow_mut().rows(own);
            self.has_rows.set(self.has_rows.get() && rows.is_some());
            *self.slopes.borrow_mut() = Some((own.to_vec(), rows));
        }
        Ok(self.slopes.borrow().as_ref().and_then(|(_, rows)| rows.clone()))
    }
}

impl Constraints for Adapter<'_> {
    type Set = ConstraintSet<BoxBounds<Vec<f64>>, NoLinearConstraints, NonlinearBlocks<NonlinearBlock, NonlinearBlock>>;

    fn constraints(&self) -> <Self::Set as ConstraintDescription>::Borrowed<'_> {
        let [lower, upper] = &self.bounds;
        ConstraintSet::new()
            .with_bounds(BoxBounds::new(Some(lower), Some(upper)))
            .with_nonlinear_equalities(self.zero)
            .with_nonlinear_inequalities(self.at_most_zero)
    }
}

impl CostFunction for Adapter<'_> {
    type Param = Vec<f64>;
    type Output = f64;
    type Error = Stopped;

    fn cost(&self, x: &Vec<f64>) -> Result<f64, Stopped> {
        let goal = self.numbers(x, |numbers| numbers.map_or(f64::INFINITY, |numbers| numbers.goal[0]))?;
        Ok(if self.has_bound { x[self.variables] } else { goal })
    }
}

impl Gradient for Adapter<'_> {
    type Gradient = Vec<f64>;

    fn gradient(&self, x: &Vec<f64>) -> Result<Vec<f64>, Stopped> {
        if self.has_bound {
            return Ok((0..x.len()).map(|k| f64::from(u8::from(k == self.variables))).collect());
        }
        let rows = self.rows(x)?;
        Ok(rows.map_or_else(|| vec![f64::NAN; x.len()], |rows| rows.goal[0].clone()))
    }
}

impl NonlinearEqualityValues for Adapter<'_> {
    type Param = Vec<f64>;
    type Values = Vec<f64>;
    type Error = Stopped;

    fn nonlinear_equalities(&self, x: &Vec<f64>) -> Asked<Vec<f64>> {
        let values = self.numbers(x, |numbers| {
            numbers.map_or_else(|| vec![f64::INFINITY; self.zero], |numbers| numbers.zero.clone())
        });
        values.map_err(ConstraintSolveError::Evaluation)
    }
}

impl NonlinearInequalityValues for Adapter<'_> {
    type Param = Vec<f64>;
    type Values = Vec<f64>;
    type Error = Stopped;

    fn nonlinear_inequalities(&self, x: &Vec<f64>) -> Asked<Vec<f64>> {
        let values = self.numbers(x, |numbers| {
            let Some(numbers) = numbers else { return vec![f64::INFINITY; self.at_most_zero] };
            let bound = x.get(self.variables);
            let goals = bound.into_iter().flat_map(|bound| numbers.goal.iter().map(move |goal| goal - bound));
            numbers.at_most_zero.iter().copied().chain(goals).collect()
        });
        values.map_err(ConstraintSolveError::Evaluation)
    }
}

impl ConstraintJacobian for Adapter<'_> {
    type Param = Vec<f64>;
    type Jacobian = DenseMatrix;
    type Error = Stopped;

    fn constraint_jacobian(&self, x: &Vec<f64>) -> Asked<DenseMatrix> {
        let (height, width) = (self.zero + self.at_most_zero, x.len());
        let rows = self.rows(x).map_err(ConstraintSolveError::Evaluation)?;
        let Some(rows) = rows else {
            return Ok(DenseMatrix::from_row_slice(height, width, &vec![f64::NAN; height * width]));
        };
        let mut entries = Vec::with_capacity(height * width);
        let of_bound = if self.has_bound { vec![0.0] } else { Vec::new() };
        for row in rows.zero.iter().chain(&rows.at_most_zero) {
            entries.extend(row.iter().chain(&of_bound));
        }
        if self.has_bound {
            for row in &rows.goal {
                entries.extend(row.iter().chain(&[-1.0]));
            }
        }
        Ok(DenseMatrix::from_row_slice(height, width, &entries))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Function = fn(&[f64]) -> (Numbers, Rows);

    /// Numbers in closed form; none where the first variable is above a limit.
    struct Closed {
        of: Function,
        limit: f64,
        best: Option<(Vec<f64>, f64)>,
        counts: [usize; 2],
    }

    impl Evaluated for Closed {
        fn numbers(&mut self, x: &[f64]) -> ControlFlow<(), Option<Numbers>> {
            self.counts[0] += 1;
            let numbers = (x[0] <= self.limit).then(|| (self.of)(x).0);
            if let Some(found) = &numbers {
                let goal = found.goal.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                let is_feasible = found.at_most_zero.iter().all(|excess| *excess < 1e-7)
                    && found.zero.iter().all(|off| off.abs() < 1e-7);
                if is_feasible && self.best.as_ref().is_none_or(|(_, best)| goal < *best) {
                    self.best = Some((x.to_vec(), goal));
                }
            }
            ControlFlow::Continue(numbers)
        }

        fn rows(&mut self, x: &[f64]) -> Option<Rows> {
            self.counts[1] += 1;
            Some((self.of)(x).1)
        }
    }

    fn searched(of: Function, start: &[f64], limit: f64, bounds: [&[f64]; 2]) -> (End, Closed) {
        let mut closed = Closed { of, limit, best: None, counts: [0; 2] };
        let end = search(&mut closed, (start, &of(start).0), bounds, (100, 1e-10));
        (end, closed)
    }

    /// W. Hock, K. Schittkowski, Test Examples for Nonlinear Programming Codes (1981), problem 71: at the optimum the
    /// goal is 17.0140173.
    #[test]
    fn a_problem_of_the_literature_is_solved() {
        let problem: Function = |x| {
            let (a, b, c, d) = (x[0], x[1], x[2], x[3]);
            let numbers = Numbers {
                goal: vec![a * d * (a + b + c) + c],
                zero: vec![a * a + b * b + c * c + d * d - 40.0],
                at_most_zero: vec![25.0 - a * b * c * d],
            };
            let rows = Rows {
                goal: vec![vec![d * (2.0 * a + b + c), a * d, a * d + 1.0, a * (a + b + c)]],
                zero: vec![x.iter().map(|x| 2.0 * x).collect()],
                at_most_zero: vec![vec![-b * c * d, -a * c * d, -a * b * d, -a * b * c]],
            };
            (numbers, rows)
        };
        let (end, found) = searched(problem, &[1.0, 5.0, 5.0, 1.0], f64::INFINITY, [&[1.0; 4], &[5.0; 4]]);
        let (x, goal) = found.best.clone().unwrap();
        assert!(end == End::Converged && (goal - 17.014_017_3).abs() < 1e-6, "{end:?} {x:?} {goal}");
        let [tried, linear] = found.counts;
        assert!(linear <= tried && tried < 20, "derivatives once where a step has helped: {:?}", found.counts);
    }

    /// The largest of three numbers is least at a corner of them (C. Charalambous, A. R. Conn, SIAM J. Numer. Anal. 15
    /// (1978)): 1.9522245 at (1.1390377, 0.8995599).
    #[test]
    fn the_largest_of_several_is_least_at_a_corner_of_them() {
        let problem: Function = |x| {
            let (a, b) = (x[0], x[1]);
            let exp = 2.0 * (b - a).exp();
            let numbers = Numbers {
                goal: vec![a * a + b.powi(4), (2.0 - a).powi(2) + (2.0 - b).powi(2), exp],
                zero: Vec::new(),
                at_most_zero: Vec::new(),
            };
            let goal = vec![vec![2.0 * a, 4.0 * b.powi(3)], vec![-2.0 * (2.0 - a), -2.0 * (2.0 - b)], vec![-exp, exp]];
            (numbers, Rows { goal, zero: Vec::new(), at_most_zero: Vec::new() })
        };
        let open = [f64::NEG_INFINITY; 2];
        let (end, found) = searched(problem, &[1.0, -0.1], f64::INFINITY, [&open, &[f64::INFINITY; 2]]);
        let (x, goal) = found.best.unwrap();
        assert!(end == End::Converged && (goal - 1.952_224_5).abs() < 1e-6, "{end:?} {x:?} {goal}");
    }

    #[test]
    fn where_there_are_no_numbers_a_shorter_step_is_tried() {
        let problem: Function = |x| {
            let goal = vec![(x[0] - 3.0).powi(2)];
            let numbers = Numbers { goal, zero: Vec::new(), at_most_zero: vec![x[0] - 0.9] };
            let rows = Rows { goal: vec![vec![2.0 * (x[0] - 3.0)]], zero: Vec::new(), at_most_zero: vec![vec![1.0]] };
            (numbers, rows)
        };
        let (end, found) = searched(problem, &[0.0], 1.0, [&[-10.0], &[10.0]]);
        let (x, _) = found.best.unwrap();
        assert!(end == End::Converged && (x[0] - 0.9).abs() < 1e-6, "{end:?} {x:?}");
    }
}
