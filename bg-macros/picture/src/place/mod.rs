//! Where the blocks of one group stand: cells of a small grid.
//!
//! In: how many blocks, the links between them, where their links to other groups lead. Out: a cell for each block,
//! no two the same. Method: threshold accepting (Dueck and Scheuer, J. Comput. Phys. 90, 1990) in whole numbers, from
//! a greedy start. What a drawing costs, and why: [`cost`].

mod cost;

use crate::random::Random;
use cost::Load;

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

/// How long a good arrangement is looked for.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Effort {
    /// To know about how large the group is.
    Rough,
    /// To draw it.
    Fine,
}

/// Cells for all blocks; the least column and row are 0.
pub(crate) fn place(problem: &Problem, effort: Effort) -> Vec<Cell> {
    let [first, second] = match effort {
        Effort::Rough => [500, 100],
        Effort::Fine => [2500, 1000],
    };
    let mut board = Board::new(problem);
    board.start();
    board.improve(60, first);
    board.turn();
    board.improve(12, second);
    let (left, top) = corner(&board.cells);
    board.cells.iter().map(|&(x, y)| (x - left, y - top)).collect()
}

/// The least column and the least row.
fn corner(cells: &[Cell]) -> Cell {
    let least = |of: fn(&Cell) -> i32| cells.iter().map(of).min().unwrap_or_default();
    (least(|cell| cell.0), least(|cell| cell.1))
}

struct Board<'a> {
    problem: &'a Problem,
    side: i32,
    cells: Vec<Cell>,
    /// The blocks at the other ends of each block's links.
    neighbours: Vec<Vec<usize>>,
    /// For each link that alone joins two pieces: the block at one end, and all blocks of the piece at the other.
    branches: Vec<(usize, Vec<usize>)>,
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
        let branches = branches(problem, &neighbours);
        Self { problem, side, cells: Vec::new(), neighbours, branches, loads }
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
        let mut cost = self.whole_cost();
        let mut best = (cost, self.cells.clone());
        let mut before = self.cells.clone();
        for step in 0..moves {
            let left = (moves - step) as i64;
            let threshold = first * left * left / (moves as i64 * moves as i64);
            before.clone_from(&self.cells);
            if !self.shake(&mut random) {
                continue;
            }
            let Some(after) = self.cost(cost + threshold) else {
                self.cells.clone_from(&before);
                continue;
            };
            cost = after;
            if cost < best.0 {
                best = (cost, self.cells.clone());
            }
        }
        self.cells = best.1;
    }

    fn whole_cost(&mut self) -> i64 {
        self.cost(i64::MAX).expect("no cost is larger")
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
            (self.whole_cost(), self.cells.clone())
        });
        self.cells = turned.into_iter().min_by_key(|(cost, _)| *cost).map_or(own, |(_, cells)| cells);
    }

    /// Moves a block near one of its neighbours, or a whole branch. False if it cannot go there.
    fn shake(&mut self, random: &mut Random) -> bool {
        if !self.branches.is_empty() && random.below(3) == 0 {
            return self.swing(random);
        }
        let block = random.below(self.problem.count);
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

    /// Turns a branch about the block that it hangs on, mirrors it there, or moves it by a little.
    fn swing(&mut self, random: &mut Random) -> bool {
        let (root, branch) = &self.branches[random.below(self.branches.len())];
        let (x, y) = self.cells[*root];
        let way = random.below(8);
        let offset = (random.offset(2), random.offset(2));
        let goal = |block: &usize| {
            let (dx, dy) = (self.cells[*block].0 - x, self.cells[*block].1 - y);
            match way {
                0 => (x - dy, y + dx),
                1 => (x + dy, y - dx),
                2 => (x - dx, y + dy),
                3 => (x + dx, y - dy),
                _ => (x + dx + offset.0, y + dy + offset.1),
            }
        };
        let goals: Vec<Cell> = branch.iter().map(goal).collect();
        let is_free = |goal: &Cell| {
            let at = self.cells.iter().position(|cell| cell == goal);
            self.is_inside(*goal) && at.is_none_or(|at| branch.contains(&at))
        };
        if !goals.iter().all(is_free) {
            return false;
        }
        for (&block, goal) in branch.iter().zip(goals) {
            self.cells[block] = goal;
        }
        true
    }
}

/// The branches of a problem, both ways of each link.
fn branches(problem: &Problem, neighbours: &[Vec<usize>]) -> Vec<(usize, Vec<usize>)> {
    let both = problem.links.iter().flat_map(|&(from, to)| [(from, to), (to, from)]);
    let branch = |(root, first): (usize, usize)| {
        let mut branch = vec![first];
        let mut next = 0;
        while let Some(&block) = branch.get(next) {
            next += 1;
            for &other in &neighbours[block] {
                let is_back = block == first && other == root;
                if !is_back && !branch.contains(&other) {
                    branch.push(other);
                }
            }
        }
        (!branch.contains(&root)).then_some((root, branch))
    };
    both.filter_map(branch).collect()
}
