//! Where the blocks of one group stand: cells of a small grid.
//!
//! In: how many blocks, the links between them, where their links to other groups lead. Out: a cell for each block, no two
//! the same. Method: threshold accepting (Dueck and Scheuer, J. Comput. Phys. 90, 1990) in whole numbers, from a greedy
//! start. The cost counts what makes a drawing hard to read: length, bends, what a link runs over or across, two-ports and
//! half arrows against the direction of reading, and distance to the side that a link leaves by.

use crate::random::Random;

/// A cell: column to the right, row downwards.
pub(crate) type Cell = (i32, i32);

/// What is placed.
#[derive(Clone, Debug, Default)]
pub(crate) struct Problem {
    pub count: usize,
    /// From and to.
    pub links: Vec<(usize, usize)>,
    /// Blocks with two links that should run straight through: the link in, the link out.
    pub straight: Vec<(usize, usize)>,
    /// A block, and the direction in which a link of it leaves the group: signs to the right and downwards.
    pub pulls: Vec<(usize, Cell)>,
    /// What a column or a row more costs: much in a frame, whose pieces would drift apart.
    pub size_cost: i64,
}

const LENGTH: i64 = 10;
const BEND: i64 = 22;
const OVER_BLOCK: i64 = 60;
const OVERLAP: i64 = 40;
const CROSSING: i64 = 30;
const BACKWARDS: i64 = 5;
const UPWARDS: i64 = 3;
const KINK: i64 = 20;
const PULL: i64 = 5;

/// Cells for all blocks; the least column and row are 0.
pub(crate) fn place(problem: &Problem) -> Vec<Cell> {
    let mut board = Board::new(problem);
    board.start();
    board.improve(60, 3000);
    board.turn();
    board.improve(12, 1000);
    let (left, top) = corner(&board.cells);
    board.cells.iter().map(|&(x, y)| (x - left, y - top)).collect()
}

/// The least column and the least row.
fn corner(cells: &[Cell]) -> Cell {
    let least = |of: fn(&Cell) -> i32| cells.iter().map(of).min().unwrap_or_default();
    (least(|cell| cell.0), least(|cell| cell.1))
}

/// What lies on a cell.
#[derive(Clone, Copy, Debug, Default)]
struct Load {
    is_taken: bool,
    across: i64,
    down: i64,
}

struct Board<'a> {
    problem: &'a Problem,
    side: i32,
    cells: Vec<Cell>,
    /// The blocks at the other ends of each block's links.
    neighbours: Vec<Vec<usize>>,
    loads: Vec<Load>,
}

impl<'a> Board<'a> {
    fn new(problem: &'a Problem) -> Self {
        let mut root = 1;
        while root * root < problem.count {
            root += 1;
        }
        let side = 3 * i32::try_from(root).unwrap_or(1) + 2;
        let mut neighbours = vec![Vec::new(); problem.count];
        for &(from, to) in &problem.links {
            neighbours[from].push(to);
            neighbours[to].push(from);
        }
        let loads = vec![Load::default(); (side * side) as usize];
        Self { problem, side, cells: Vec::new(), neighbours, loads }
    }

    fn index(&self, (x, y): Cell) -> usize {
        (y * self.side + x) as usize
    }

    fn is_inside(&self, (x, y): Cell) -> bool {
        (0..self.side).contains(&x) && (0..self.side).contains(&y)
    }

    /// Each block, in the order of links from the best connected one, on the free cell next to its neighbours.
    fn start(&mut self) {
        let count = self.problem.count;
        let outside = (-1, -1);
        self.cells = vec![outside; count];
        let mut taken = vec![false; self.loads.len()];
        for block in self.order() {
            let placed: Vec<Cell> =
                self.neighbours[block].iter().map(|&other| self.cells[other]).filter(|&cell| cell != outside).collect();
            let middle = (self.side / 2, self.side / 2);
            let distance = |cell: Cell| -> i32 {
                let to = |other: Cell| {
                    let (dx, dy) = ((cell.0 - other.0).abs(), (cell.1 - other.1).abs());
                    4 * (dx + dy) + if dx > 0 && dy > 0 { 5 } else { 0 }
                };
                placed.iter().map(|&other| to(other)).sum::<i32>() * 8 + to(middle)
            };
            let free = (0..self.side * self.side).map(|index| (index % self.side, index / self.side));
            let best = free.filter(|&cell| !taken[self.index(cell)]).min_by_key(|&cell| distance(cell));
            let cell = best.unwrap_or(middle);
            let index = self.index(cell);
            taken[index] = true;
            self.cells[block] = cell;
        }
    }

    /// Blocks in breadth-first order, each piece from its best connected block.
    fn order(&self) -> Vec<usize> {
        let mut seeds: Vec<usize> = (0..self.problem.count).collect();
        seeds.sort_by_key(|&block| std::cmp::Reverse(self.neighbours[block].len()));
        let mut order: Vec<usize> = Vec::new();
        let mut seen = vec![false; self.problem.count];
        for seed in seeds {
            let mut next = order.len();
            if !std::mem::replace(&mut seen[seed], true) {
                order.push(seed);
            }
            while let Some(&block) = order.get(next) {
                next += 1;
                for &other in &self.neighbours[block] {
                    if !std::mem::replace(&mut seen[other], true) {
                        order.push(other);
                    }
                }
            }
        }
        order
    }

    /// Threshold accepting from `first` on, with `moves` for each block.
    fn improve(&mut self, first: i64, moves: usize) {
        const EFFORT: usize = 30_000_000;
        let count = self.problem.count;
        if count < 2 {
            return;
        }
        let weight = 8 * (count + self.problem.links.len());
        let moves = (moves * count).min(EFFORT / weight);
        let mut random = Random::new(1);
        let mut cost = self.cost();
        let mut best = (cost, self.cells.clone());
        for step in 0..moves {
            let left = (moves - step) as i64;
            let threshold = first * left * left / (moves as i64 * moves as i64);
            let before = self.cells.clone();
            if !self.shake(&mut random) {
                continue;
            }
            let after = self.cost();
            if after > cost + threshold {
                self.cells = before;
                continue;
            }
            cost = after;
            if cost < best.0 {
                best = (cost, self.cells.clone());
            }
        }
        self.cells = best.1;
    }

    /// Mirrors all where that reads better: left to right, with the links that leave.
    fn turn(&mut self) {
        let (left, top) = corner(&self.cells);
        let right = self.cells.iter().map(|cell| cell.0).max().unwrap_or_default();
        let bottom = self.cells.iter().map(|cell| cell.1).max().unwrap_or_default();
        let own = self.cells.clone();
        let turned = [(false, false), (true, false), (false, true), (true, true)].map(|(is_across, is_down)| {
            self.cells = own.clone();
            for (x, y) in &mut self.cells {
                *x = if is_across { left + right - *x } else { *x };
                *y = if is_down { top + bottom - *y } else { *y };
            }
            (self.cost(), self.cells.clone())
        });
        self.cells = turned.into_iter().min_by_key(|(cost, _)| *cost).map_or(own, |(_, cells)| cells);
    }

    /// Moves a block near one of its neighbours, or with all that hangs on it by a little. False if it cannot go there.
    fn shake(&mut self, random: &mut Random) -> bool {
        let block = random.below(self.problem.count);
        if random.below(3) == 0 {
            return self.shift(block, (random.offset(2), random.offset(2)));
        }
        let near = &self.neighbours[block];
        let around = if near.is_empty() { block } else { near[random.below(near.len())] };
        let (x, y) = self.cells[around];
        let cell = (x + random.offset(2), y + random.offset(2));
        if !self.is_inside(cell) || cell == self.cells[block] {
            return false;
        }
        if let Some(other) = self.cells.iter().position(|&taken| taken == cell) {
            self.cells[other] = self.cells[block];
        }
        self.cells[block] = cell;
        true
    }

    /// Moves a block and the blocks that have no other neighbour.
    fn shift(&mut self, block: usize, (dx, dy): Cell) -> bool {
        let mut moved = vec![block];
        moved.extend(self.neighbours[block].iter().copied().filter(|&other| self.neighbours[other].len() == 1));
        let goals: Vec<Cell> =
            moved.iter().map(|&block| (self.cells[block].0 + dx, self.cells[block].1 + dy)).collect();
        let is_free = |goal: &Cell| {
            let at = self.cells.iter().position(|cell| cell == goal);
            self.is_inside(*goal) && at.is_none_or(|at| moved.contains(&at))
        };
        if (dx, dy) == (0, 0) || !goals.iter().all(is_free) {
            return false;
        }
        for (&block, goal) in moved.iter().zip(goals) {
            self.cells[block] = goal;
        }
        true
    }

    fn cost(&mut self) -> i64 {
        self.loads.fill(Load::default());
        for block in 0..self.cells.len() {
            let index = self.index(self.cells[block]);
            self.loads[index].is_taken = true;
        }
        let links: i64 = (0..self.problem.links.len()).map(|link| self.link_cost(link)).sum();
        links + self.straightness() + self.frame_cost()
    }

    /// The cost of a link along the better of its routes, which it then occupies.
    fn link_cost(&mut self, link: usize) -> i64 {
        let (from, to) = self.problem.links[link];
        let (a, b) = (self.cells[from], self.cells[to]);
        let (dx, dy) = (b.0 - a.0, b.1 - a.1);
        let mut cost = LENGTH * i64::from(dx.abs() + dy.abs());
        cost += if dx < 0 { BACKWARDS } else { 0 } + if dy < 0 { UPWARDS } else { 0 };
        if dx == 0 || dy == 0 {
            cost += self.run_cost(a, b);
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
        cost + BEND + first.min(second)
    }

    /// What a straight run meets between its ends.
    fn run_cost(&self, a: Cell, b: Cell) -> i64 {
        let mut cost = 0;
        let is_across = a.1 == b.1;
        each_between(a, b, |cell| {
            let load = self.loads[self.index(cell)];
            let (along, over) = if is_across { (load.across, load.down) } else { (load.down, load.across) };
            cost += OVERLAP * along + CROSSING * over + if load.is_taken { OVER_BLOCK } else { 0 };
        });
        cost
    }

    fn occupy(&mut self, a: Cell, b: Cell) {
        let (side, is_across) = (self.side, a.1 == b.1);
        let loads = &mut self.loads;
        each_between(a, b, |(x, y)| {
            let load = &mut loads[(y * side + x) as usize];
            if is_across { load.across += 1 } else { load.down += 1 }
        });
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

/// Calls `each` for the cells strictly between `a` and `b`, which are in one row or column.
fn each_between(a: Cell, b: Cell, mut each: impl FnMut(Cell)) {
    let (dx, dy) = ((b.0 - a.0).signum(), (b.1 - a.1).signum());
    let (mut x, mut y) = (a.0 + dx, a.1 + dy);
    while (x, y) != b && (dx, dy) != (0, 0) {
        each((x, y));
        (x, y) = (x + dx, y + dy);
    }
}
