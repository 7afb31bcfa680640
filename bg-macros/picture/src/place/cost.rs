//! What makes a drawing of blocks on cells hard to read, as one number.
//!
//! In: a board with a cell for each block. Out: the cost: lengths, bends, what links run over or across, half arrows
//! against the direction of reading, two-ports that are not run straight through, size, distance of outward links
//! from their side.

use super::{Board, Cell};

const LENGTH: i64 = 10;
const BEND: i64 = 22;
const OVER_BLOCK: i64 = 60;
const OVERLAP: i64 = 40;
const CROSSING: i64 = 30;
const BACKWARDS: i64 = 5;
const UPWARDS: i64 = 3;
/// For a link between two blocks that both have others: the main chain reads from left to right.
const STEEP: i64 = 6;
const KINK: i64 = 20;
const PULL: i64 = 5;

/// What lies on a cell.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Load {
    is_taken: bool,
    across: i16,
    down: i16,
}

impl Board<'_> {
    /// The cost of the drawing as it stands; none where it is more than `most`. No part of it is negative, so those
    /// that are quick to find come first: most drawings are found too dear by them.
    pub(super) fn cost(&mut self, most: i64) -> Option<i64> {
        let apart: i64 = self.problem.links.iter().map(|&link| self.shape_cost(link)).sum();
        let mut cost = apart + self.straightness() + self.frame_cost();
        if cost > most {
            return None;
        }
        self.loads.fill(Load::default());
        for block in 0..self.cells.len() {
            let index = self.index(self.cells[block]);
            self.loads[index].is_taken = true;
        }
        for &(from, to) in &self.problem.links {
            cost += self.meeting_cost(self.cells[from], self.cells[to]);
            if cost > most {
                return None;
            }
        }
        Some(cost)
    }

    /// What a link costs wherever the others run.
    fn shape_cost(&self, (from, to): (usize, usize)) -> i64 {
        let (a, b) = (self.cells[from], self.cells[to]);
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        let mut cost = LENGTH * i64::from(dx.abs() + dy.abs());
        cost += if dx < 0 { BACKWARDS } else { 0 } + if dy < 0 { UPWARDS } else { 0 };
        if dx == 0 && [from, to].iter().all(|&end| self.neighbours[end].len() > 1) {
            cost += STEEP;
        }
        if dx == 0 || dy == 0 { cost } else { cost + BEND }
    }

    /// What a link meets along the better of its routes, which it then occupies.
    fn meeting_cost(&mut self, a: Cell, b: Cell) -> i64 {
        if a.0 == b.0 || a.1 == b.1 {
            let cost = self.run_cost(a, b);
            self.occupy(a, b);
            return cost;
        }
        let over = |corner: Cell| {
            let block = if self.loads[self.index(corner)].is_taken { OVER_BLOCK } else { 0 };
            self.run_cost(a, corner) + block + self.run_cost(corner, b)
        };
        let corners = [(b.0, a.1), (a.0, b.1)];
        let [first, second] = corners.map(over);
        let corner = corners[usize::from(second < first)];
        self.occupy(a, corner);
        self.occupy(corner, b);
        first.min(second)
    }

    /// What a straight run meets between its ends.
    fn run_cost(&self, a: Cell, b: Cell) -> i64 {
        let is_across = a.1 == b.1;
        let cost = |place: usize| {
            let load = self.loads[place];
            let (along, over) = if is_across { (load.across, load.down) } else { (load.down, load.across) };
            OVERLAP * i64::from(along) + CROSSING * i64::from(over) + if load.is_taken { OVER_BLOCK } else { 0 }
        };
        self.between(a, b).map(cost).sum()
    }

    fn occupy(&mut self, a: Cell, b: Cell) {
        let is_across = a.1 == b.1;
        for place in self.between(a, b) {
            let load = &mut self.loads[place];
            if is_across { load.across += 1 } else { load.down += 1 }
        }
    }

    /// The places of the cells strictly between `a` and `b`, which are in one row or column.
    fn between(&self, a: Cell, b: Cell) -> impl Iterator<Item = usize> + use<> {
        let (first, last) = (self.index(a).min(self.index(b)), self.index(a).max(self.index(b)));
        let step = if a.1 == b.1 { 1 } else { self.side as usize };
        (first..last).step_by(step).skip(1)
    }

    fn straightness(&self) -> i64 {
        let bent = |&&(first, second): &&(usize, usize)| {
            let direction = |link: usize| {
                let (from, to) = self.problem.links[link];
                let (a, b) = (self.cells[from], self.cells[to]);
                ((b.0 - a.0).signum(), (b.1 - a.1).signum())
            };
            direction(first) != direction(second)
        };
        KINK * self.problem.straight.iter().filter(bent).count() as i64
    }

    /// The group's size, and how far its outward links are from the sides that they leave by.
    fn frame_cost(&self) -> i64 {
        let range = |of: fn(&Cell) -> i32| {
            let values = self.cells.iter().map(of);
            (values.clone().min().unwrap_or_default(), values.max().unwrap_or_default())
        };
        let ((left, right), (top, bottom)) = (range(|cell| cell.0), range(|cell| cell.1));
        let mut cost = self.problem.size_cost * i64::from(right - left + bottom - top);
        for &(block, (to_right, down)) in &self.problem.pulls {
            let (x, y) = self.cells[block];
            let distance = |sign: i32, value: i32, least: i32, most: i32| match sign {
                0 => 0,
                sign if sign < 0 => value - least,
                _ => most - value,
            };
            cost += PULL * i64::from(distance(to_right, x, left, right) + distance(down, y, top, bottom));
        }
        cost
    }
}
