//! One path over the grid, given what the other paths occupy.
//!
//! In: a plan, the traffic of the other links, a link, the price of a point that another link has. Out: the cheapest
//! path, or an empty one where obstacles leave none.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use crate::route::{Plan, Rect};
use crate::shelves::Point;

const STEP: i64 = 10;
const BEND: i64 = 35;
const CROSSING: i64 = 90;
const FOREIGN: i64 = 12;
const NEAR: i64 = 6;
const OFF_CENTRE: i64 = 9;
/// For a port beside one that another link has: half arrows and strokes want room.
const BESIDE: i64 = 35;

const DIRECTIONS: [Point; 4] = [(1, 0), (0, 1), (-1, 0), (0, -1)];

/// How a path uses a point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Use {
    Across,
    Down,
    /// A bend, or one of the two points at an end: nothing else may be there.
    Sole,
}

/// Who uses a point, and how often it was in dispute.
#[derive(Clone, Copy, Debug, Default)]
struct Load {
    across: u16,
    down: u16,
    sole: u16,
    history: u32,
}

/// What the paths occupy.
#[derive(Clone, Debug)]
pub(crate) struct Traffic {
    width: i32,
    loads: Vec<Load>,
}

impl Traffic {
    /// No paths yet.
    pub fn new(plan: &Plan) -> Self {
        Self { width: plan.width, loads: vec![Load::default(); (plan.width * plan.height) as usize] }
    }

    /// Adds a path.
    pub fn add(&mut self, path: &[Point]) {
        self.each(path, |count| *count += 1);
    }

    /// Removes a path that was added.
    pub fn remove(&mut self, path: &[Point]) {
        self.each(path, |count| *count -= 1);
    }

    fn each(&mut self, path: &[Point], change: impl Fn(&mut u16)) {
        for index in 0..path.len() {
            let load = &mut self.loads[(path[index].1 * self.width + path[index].0) as usize];
            match use_of(path, index) {
                Use::Across => change(&mut load.across),
                Use::Down => change(&mut load.down),
                Use::Sole => change(&mut load.sole),
            }
        }
    }

    /// Makes every disputed point dearer for the rounds to come; true where there is none.
    pub fn settle(&mut self) -> bool {
        let mut is_clear = true;
        for load in &mut self.loads {
            let most = load.across.max(load.down) + load.sole;
            let mixed = load.sole > 0 && load.across + load.down > 0;
            if most > 1 || mixed {
                load.history += 20;
                is_clear = false;
            }
        }
        is_clear
    }

    /// What paths that are clear of each other cost: length, bends, crossings.
    pub fn cost(&self, paths: &[Vec<Point>]) -> i64 {
        let crossings = self.loads.iter().filter(|load| load.across > 0 && load.down > 0).count() as i64;
        let bends = |path: &Vec<Point>| (1..path.len().saturating_sub(1)).filter(|&at| is_bend(path, at)).count();
        let length: usize = paths.iter().map(Vec::len).sum();
        STEP * length as i64 + BEND * paths.iter().map(bends).sum::<usize>() as i64 + CROSSING * crossings
    }

    /// Whether a path bends or ends at a point.
    fn is_sole(&self, index: usize) -> bool {
        self.loads[index].sole > 0
    }

    /// The price of using the point at `index`.
    fn price(&self, index: usize, of: Use, price: i64) -> i64 {
        let load = self.loads[index];
        let (across, down, sole) = (i64::from(load.across), i64::from(load.down), i64::from(load.sole));
        let (disputes, crossings) = match of {
            Use::Across => (across + sole, down),
            Use::Down => (down + sole, across),
            Use::Sole => (across + down + sole, 0),
        };
        let history = i64::from(load.history) * if disputes > 0 { 8 } else { 1 };
        disputes * price + crossings * CROSSING + history
    }
}

fn use_of(path: &[Point], index: usize) -> Use {
    if index < 2 || index + 2 >= path.len() || is_bend(path, index) {
        Use::Sole
    } else if path[index].1 == path[index - 1].1 {
        Use::Across
    } else {
        Use::Down
    }
}

fn is_bend(path: &[Point], index: usize) -> bool {
    let (a, b) = (path[index - 1], path[index + 1]);
    a.0 != b.0 && a.1 != b.1
}

/// The memory of the searches, used again by each.
pub(crate) struct Finder {
    /// Points that no path runs over.
    is_blocked: Vec<bool>,
    /// The cost of a step to each point without traffic.
    ground: Vec<i64>,
    /// Frames that a point lies in, as a set of bits of the first 64 frames.
    frames: Vec<u64>,
    cost: Vec<i64>,
    before: Vec<u32>,
    stamp: Vec<u32>,
    round: u32,
}

const NONE: u32 = u32::MAX;

impl Finder {
    /// For all links of a plan.
    pub fn new(plan: &Plan) -> Self {
        let count = (plan.width * plan.height) as usize;
        let mut finder = Self {
            is_blocked: vec![false; count],
            ground: vec![STEP; count],
            frames: vec![0; count],
            cost: vec![0; 4 * count],
            before: vec![NONE; 4 * count],
            stamp: vec![0; 4 * count],
            round: 0,
        };
        for (number, frame) in plan.frames.iter().enumerate() {
            finder.each_point(plan, *frame, |finder, index| finder.frames[index] |= 1 << (number % 64));
        }
        for block in &plan.blocks {
            let Rect { left, top, right, bottom } = *block;
            let around = Rect { left: left - 1, top: top - 1, right: right + 1, bottom: bottom + 1 };
            finder.each_point(plan, around, |finder, index| finder.ground[index] = STEP + NEAR);
        }
        for obstacle in plan.blocks.iter().chain(&plan.labels) {
            finder.each_point(plan, *obstacle, |finder, index| finder.is_blocked[index] = true);
        }
        finder
    }

    fn each_point(&mut self, plan: &Plan, rect: Rect, mut each: impl FnMut(&mut Self, usize)) {
        for y in rect.top.max(0)..=rect.bottom.min(plan.height - 1) {
            for x in rect.left.max(0)..=rect.right.min(plan.width - 1) {
                each(self, (y * plan.width + x) as usize);
            }
        }
    }

    /// The cheapest path of a link from border to border; empty where there is none.
    pub fn find(&mut self, plan: &Plan, traffic: &Traffic, link: usize, price: i64) -> Vec<Point> {
        let (from, to) = (plan.blocks[plan.links[link].0], plan.blocks[plan.links[link].1]);
        let own = [from, to].map(|block| self.frames[index_of(plan, block.centre())]);
        let own = own[0] | own[1];
        let goals = self.approaches(plan, traffic, &to, price);
        self.round += 1;
        let mut open: BinaryHeap<Reverse<(i64, u32)>> = BinaryHeap::new();
        for (point, direction, cost) in self.approaches(plan, traffic, &from, price) {
            let state = state_of(plan, point, direction);
            self.reach(state, cost, NONE);
            open.push(Reverse((cost + estimate(point, &to), state)));
        }
        let mut best: Option<(i64, u32)> = None;
        while let Some(Reverse((bound, state))) = open.pop() {
            if best.is_some_and(|(least, _)| least <= bound) {
                break;
            }
            let (point, direction) = point_of(plan, state);
            let cost = self.cost[state as usize];
            if cost + estimate(point, &to) < bound {
                continue;
            }
            let arriving = |&&(goal, away, _): &&(Point, usize, i64)| goal == point && away == (direction + 2) % 4;
            if let Some(&(_, _, rest)) = goals.iter().find(arriving) {
                let straight = traffic.price(index_of(plan, point), along(direction), price);
                let total = cost + straight + rest;
                if best.is_none_or(|(least, _)| total < least) {
                    best = Some((total, state));
                }
            }
            for turn in [0, 1, 3] {
                let next_direction = (direction + turn) % 4;
                let (dx, dy) = DIRECTIONS[next_direction];
                let next = (point.0 + dx, point.1 + dy);
                if !self.is_free(plan, next) {
                    continue;
                }
                let of = if turn == 0 { along(direction) } else { Use::Sole };
                let here = traffic.price(index_of(plan, point), of, price) + if turn == 0 { 0 } else { BEND };
                let index = index_of(plan, next);
                let foreign = i64::from((self.frames[index] & !own).count_ones());
                let next_cost = cost + here + self.ground[index] + FOREIGN * foreign;
                let next_state = state_of(plan, next, next_direction);
                if self.stamp[next_state as usize] != self.round || next_cost < self.cost[next_state as usize] {
                    self.reach(next_state, next_cost, state);
                    open.push(Reverse((next_cost + estimate(next, &to), next_state)));
                }
            }
        }
        best.map_or_else(Vec::new, |(_, state)| self.path(plan, state))
    }

    fn reach(&mut self, state: u32, cost: i64, before: u32) {
        self.stamp[state as usize] = self.round;
        self.cost[state as usize] = cost;
        self.before[state as usize] = before;
    }

    fn is_free(&self, plan: &Plan, (x, y): Point) -> bool {
        (0..plan.width).contains(&x) && (0..plan.height).contains(&y) && !self.is_blocked[index_of(plan, (x, y))]
    }

    /// The points two steps in front of a block's ports, the direction away from the block, and what these steps cost.
    fn approaches(&self, plan: &Plan, traffic: &Traffic, block: &Rect, price: i64) -> Vec<(Point, usize, i64)> {
        let mut found = Vec::new();
        for (port, (dx, dy)) in block.ports() {
            let next = (port.0 + dx, port.1 + dy);
            let last = (next.0 + dx, next.1 + dy);
            if self.is_free(plan, next) && self.is_free(plan, last) {
                let direction = DIRECTIONS.iter().position(|&known| known == (dx, dy)).unwrap_or_default();
                let sole = [port, next].map(|point| traffic.price(index_of(plan, point), Use::Sole, price));
                let off = OFF_CENTRE * i64::from(block.offset(port));
                let beside = [(port.0 + dy, port.1 + dx), (port.0 - dy, port.1 - dx)];
                let crowd = beside.iter().filter(|&&point| traffic.is_sole(index_of(plan, point))).count() as i64;
                found.push((last, direction, sole[0] + sole[1] + 2 * STEP + off + BESIDE * crowd));
            }
        }
        found
    }

    /// The points of the path that ends in `state`, with the two steps at either end.
    fn path(&self, plan: &Plan, last: u32) -> Vec<Point> {
        let mut path = Vec::new();
        let (point, direction) = point_of(plan, last);
        let (dx, dy) = DIRECTIONS[direction];
        path.extend([(point.0 + 2 * dx, point.1 + 2 * dy), (point.0 + dx, point.1 + dy)]);
        let mut state = last;
        loop {
            let (point, direction) = point_of(plan, state);
            path.push(point);
            if self.before[state as usize] == NONE {
                let (dx, dy) = DIRECTIONS[direction];
                path.extend([(point.0 - dx, point.1 - dy), (point.0 - 2 * dx, point.1 - 2 * dy)]);
                break;
            }
            state = self.before[state as usize];
        }
        path.reverse();
        path
    }
}

fn along(direction: usize) -> Use {
    if direction.is_multiple_of(2) { Use::Across } else { Use::Down }
}

fn index_of(plan: &Plan, (x, y): Point) -> usize {
    (y * plan.width + x) as usize
}

fn state_of(plan: &Plan, point: Point, direction: usize) -> u32 {
    (4 * index_of(plan, point) + direction) as u32
}

fn point_of(plan: &Plan, state: u32) -> (Point, usize) {
    let (index, direction) = ((state / 4) as i32, state as usize % 4);
    ((index % plan.width, index / plan.width), direction)
}

/// Never more than what is left to pay: the steps to the block's border.
fn estimate((x, y): Point, to: &Rect) -> i64 {
    let dx = (to.left - x).max(x - to.right).max(0);
    let dy = (to.top - y).max(y - to.bottom).max(0);
    STEP * i64::from(dx + dy)
}
