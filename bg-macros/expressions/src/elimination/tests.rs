//! Eliminations of random patterns, interpreted step by step, beside dense elimination.

use std::collections::BTreeSet;

use super::*;
use crate::random::Random;

struct Source(Random);

impl Source {
    fn below(&mut self, end: usize) -> usize {
        self.0.below(end)
    }

    fn number(&mut self) -> f64 {
        self.below(2001) as f64 / 1000.0 - 1.0
    }

    /// Different places of a matrix of `n` rows, in any order.
    fn places(&mut self, n: usize) -> Vec<(usize, usize)> {
        let count = self.below(n * n.min(5) + 1);
        let mut seen = BTreeSet::new();
        let drawn = (0..count).map(|_| (self.below(n), self.below(n)));
        drawn.filter(|&place| seen.insert(place)).collect()
    }
}

/// The factors of I - c J by the steps, and how often each slot was entered.
fn factors(elimination: &Elimination, c: f64, entries: &[f64]) -> Vec<f64> {
    let mut slots = vec![f64::NAN; elimination.slots];
    let first = |of: Row, is_pivot: bool| if is_pivot && of == Row::State { 1.0 } else { 0.0 };
    for step in &elimination.factorisation {
        match *step {
            Step::Enter { slot, entry, of: Row::Unknown, .. } => slots[slot] = entries[entry],
            Step::Enter { slot, entry, of, is_pivot } => slots[slot] = first(of, is_pivot) - c * entries[entry],
            Step::Fill { slot, product, of, is_pivot } => {
                slots[slot] = first(of, is_pivot) - slots[product.0] * slots[product.1];
            }
            Step::Update { slot, product, .. } => slots[slot] -= slots[product.0] * slots[product.1],
            Step::Invert { slot } => slots[slot] = 1.0 / slots[slot],
            Step::Scale { slot, by } => slots[slot] *= slots[by],
        }
    }
    slots
}

fn solve(elimination: &Elimination, slots: &[f64], b: &mut [f64]) {
    for step in &elimination.substitution {
        match *step {
            Substep::Subtract { row, slot, column } => b[row] -= slots[slot] * b[column],
            Substep::Scale { row, slot } => b[row] *= slots[slot],
        }
    }
}

/// A random Jacobian with small entries, so that no pivot of I - J is.
fn draw(seed: u64) -> (usize, Vec<(usize, usize)>, Vec<f64>) {
    let mut source = Source(Random::new(seed));
    let n = 1 + source.below(14);
    let places = source.places(n);
    let entries = places.iter().map(|_| source.number() / (2 * n) as f64).collect();
    (n, places, entries)
}

/// The largest |(I - c J) y - b|.
fn residual(places: &[(usize, usize)], entries: &[f64], c: f64, y: &[f64], b: &[f64]) -> f64 {
    let mut left: Vec<f64> = y.iter().zip(b).map(|(y, b)| y - b).collect();
    places.iter().zip(entries).for_each(|(&(row, column), entry)| left[row] -= c * entry * y[column]);
    left.into_iter().fold(0.0, |largest, value| if value.abs() <= largest { largest } else { value.abs() })
}

#[test]
fn steps_solve_the_system() {
    for seed in 0..400 {
        let (n, places, entries) = draw(seed);
        let elimination = plan(n, 0, 0, &places);
        let mut source = Source(Random::new(seed + 1000));
        let b: Vec<f64> = (0..n).map(|_| source.number()).collect();
        for c in [0.0, 0.7, 1.0] {
            let slots = factors(&elimination, c, &entries);
            assert!(slots.iter().all(|value| value.is_finite()), "seed {seed}: a slot without a value");
            let mut y = b.clone();
            solve(&elimination, &slots, &mut y);
            let residual = residual(&places, &entries, c, &y, &b);
            assert!(residual < 1e-14, "seed {seed}: {residual:e}");
        }
    }
}

/// With unknowns z after the states: (I - c f_x) y - c f_z z = b, r_x y + r_z z = 0.
#[test]
fn unknowns_are_solved_for_beside_the_states() {
    for seed in 0..400 {
        let mut source = Source(Random::new(seed));
        let (n, unknowns) = (1 + source.below(8), 1 + source.below(6));
        let size = n + unknowns;
        let mut places = source.places(size);
        places.extend((n..size).filter(|&row| !places.contains(&(row, row))).map(|row| (row, row)).collect::<Vec<_>>());
        let entry = |&(row, column): &(usize, usize)| {
            let diagonal = if row == column && row >= n { 1.0 } else { 0.0 };
            diagonal + source.number() / (2 * size) as f64
        };
        let entries: Vec<f64> = places.iter().map(entry).collect();
        let elimination = plan(n, unknowns, 0, &places);
        for c in [0.0, 0.7, 1.0] {
            let slots = factors(&elimination, c, &entries);
            let b: Vec<f64> = (0..size).map(|row| if row < n { source.number() } else { 0.0 }).collect();
            let mut y = b.clone();
            solve(&elimination, &slots, &mut y);
            // The steps leave out what no state needs: the unknowns follow from the states, by the dense equations.
            let z = dense_unknowns(n, &places, &entries, &y);
            y[n..].copy_from_slice(&z);
            let mut left: Vec<f64> = (0..size).map(|row| if row < n { y[row] - b[row] } else { 0.0 }).collect();
            for (&(row, column), entry) in places.iter().zip(&entries) {
                left[row] += if row < n { -c * entry * y[column] } else { entry * y[column] };
            }
            let residual = left.into_iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
            assert!(residual < 1e-13, "seed {seed}: {residual:e}");
        }
    }
}

/// Two masses on a rod: m z_i + l = -k x_i, z_1 + z_2 = 0; the last equation has nothing on its diagonal.
#[test]
fn an_unknown_without_a_diagonal_comes_after_those_in_its_equation() {
    let places = [(0, 2), (1, 3), (2, 0), (2, 2), (2, 4), (3, 1), (3, 3), (3, 4), (4, 2), (4, 3), (4, 4)];
    let entries = [1.0, 1.0, 3.0, 2.0, 1.0, 5.0, 4.0, 1.0, 1.0, 1.0, 0.0];
    let elimination = plan(2, 3, 1, &places);
    let at = |row: usize| elimination.order.iter().position(|&other| other == row).expect("a pivot");
    assert!(at(4) > at(2).min(at(3)), "{:?}", elimination.order);
    let c = 0.5;
    let slots = factors(&elimination, c, &entries);
    let mut y = vec![1.0, 2.0, 0.0, 0.0, 0.0];
    solve(&elimination, &slots, &mut y);
    // z_2 = -z_1 = -z: x_1 = 1 + c z, x_2 = 2 - c z, 3 x_1 + 2 z = 5 x_2 - 4 z.
    let z = 7.0 / (6.0 + 8.0 * c);
    assert!((y[0] - 1.0 - c * z).abs() < 1e-14 && (y[1] - 2.0 + c * z).abs() < 1e-14, "{y:?}");
}

/// z of r_x y + r_z z = 0, by iteration: r_z is near 1.
fn dense_unknowns(n: usize, places: &[(usize, usize)], entries: &[f64], y: &[f64]) -> Vec<f64> {
    let mut z = vec![0.0; y.len() - n];
    for _ in 0..200 {
        let mut left = vec![0.0; z.len()];
        for (&(row, column), entry) in places.iter().zip(entries).filter(|(place, _)| place.0 >= n) {
            left[row - n] += entry * if column < n { y[column] } else { z[column - n] };
        }
        z.iter_mut().zip(&left).for_each(|(z, left)| *z -= left);
    }
    z
}

/// What dense elimination in the same order fills, all entries positive and the diagonal large, so that nothing
/// cancels.
fn dense_fill(n: usize, places: &[(usize, usize)], order: &[usize]) -> BTreeSet<(usize, usize)> {
    let mut rows = vec![vec![false; n]; n];
    places.iter().for_each(|&(row, column)| rows[row][column] = true);
    let mut filled = BTreeSet::new();
    for (at, &pivot) in order.iter().enumerate() {
        for &row in &order[at + 1..] {
            for &column in &order[at + 1..] {
                if row != column && rows[row][pivot] && rows[pivot][column] && !rows[row][column] {
                    rows[row][column] = true;
                    filled.insert((row, column));
                }
            }
        }
    }
    filled
}

#[test]
fn fill_is_that_of_dense_elimination_and_never_above_the_natural_orders() {
    let mut less = 0;
    for seed in 0..400 {
        let (n, places, _) = draw(seed);
        let elimination = plan(n, 0, 0, &places);
        let mut rows = elimination.order.clone();
        rows.sort_unstable();
        assert_eq!(rows, (0..n).collect::<Vec<_>>(), "seed {seed}: every row is a pivot's once");
        assert_eq!(elimination.fill, dense_fill(n, &places, &elimination.order).len(), "seed {seed}");
        let natural = steps::in_order((0..n).collect(), n, &places);
        assert_eq!(natural.fill, dense_fill(n, &places, &natural.order).len(), "seed {seed}");
        assert!(elimination.fill <= natural.fill, "seed {seed}");
        less += usize::from(elimination.fill < natural.fill);
    }
    assert!(less > 100, "{less} orders fill less");
}

#[test]
fn an_arrow_that_points_down_does_not_fill() {
    let arrow: Vec<(usize, usize)> = (1..6).flat_map(|k| [(0, k), (k, 0)]).collect();
    let elimination = plan(6, 0, 0, &arrow);
    assert_eq!((elimination.fill, &elimination.order[4..]), (0, &[0, 5][..]));
    assert_eq!(steps::in_order((0..6).collect(), 6, &arrow).fill, 20);
    // Five entries in L, five in U, and the last two pivots; the others are 1.
    assert_eq!(elimination.slots, 12);
    let counts = elimination.factorisation_counts();
    assert_eq!((counts.multiplications, counts.additions, counts.divisions), (16, 6, 2));
    let counts = elimination.substitution_counts();
    assert_eq!((counts.multiplications, counts.additions, counts.divisions), (12, 10, 0));
}

#[test]
fn a_pivot_that_is_one_costs_nothing() {
    let elimination = plan(3, 0, 0, &[(0, 1), (1, 2), (2, 2)]);
    let inverted = elimination.factorisation.iter().filter(|step| matches!(step, Step::Invert { .. })).count();
    assert_eq!((inverted, elimination.slots), (1, 3));
    assert!(plan(4, 0, 0, &[]).factorisation.is_empty() && plan(4, 0, 0, &[]).substitution.is_empty());
}

#[test]
fn the_reciprocal_goes_to_the_shorter_side() {
    let mut places = vec![(0, 0)];
    places.extend((1..5).map(|k| (k, 0)));
    places.push((0, 1));
    places.extend((1..5).map(|k| (k, k)));
    let elimination = steps::in_order((0..5).collect(), 5, &places);
    let scaled = elimination.factorisation.iter().filter(|step| matches!(step, Step::Scale { .. })).count();
    // U has one entry in the first row, L has four in its column; column 1 has three below, row 1 none to the right.
    assert_eq!(scaled, 1);
}
