//! The whole drawing in pitches of the routing grid: blocks, frames, paths.
//!
//! In: a [`Sheet`] and its graph. Out: a [`Layout`]. Method: each group alone on a small grid ([`crate::place`]), the
//! groups on shelves ([`crate::shelves`]), each group once more with its outward links drawn to the sides where they
//! lead, then the paths ([`crate::route`]). Where the paths find no room, all distances grow and the drawing is made
//! anew.

use std::collections::BTreeSet;

use crate::graph::Graph;
use crate::place::{self, Cell, Effort, Problem};
use crate::route::{Plan, Rect, Routes, route};
use crate::sheet::{Block, Group, Of, Sheet};
use crate::shelves::{Point, Shelves};
use crate::text;

/// Pixels between two points of the grid.
pub(crate) const PITCH: i32 = 10;
/// The sizes of a label's two lines and of a group's title, in pixels.
const LARGE: i32 = 13;
const SMALL: i32 = 10;
const TITLE: i32 = 12;

const MARGIN: i32 = 2;
const PADDING: i32 = 3;
const TITLE_ROWS: i32 = 2;
const BLOCK_HEIGHT: i32 = 4;

/// Where everything is, in pitches.
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    pub width: i32,
    pub height: i32,
    pub blocks: Vec<Rect>,
    pub frames: Vec<Frame>,
    pub paths: Vec<Vec<Point>>,
}

/// The frame of a group that is a part.
#[derive(Clone, Debug)]
pub(crate) struct Frame {
    pub part: usize,
    pub rect: Rect,
}

/// A group with its blocks in their places.
struct Arranged {
    size: Point,
    /// The upper left corner of each of its blocks.
    corners: Vec<Point>,
}

impl Layout {
    /// The drawing of `sheet`.
    pub fn new(graph: &Graph, sheet: &Sheet) -> Self {
        const ATTEMPTS: i32 = 6;
        let sizes: Vec<Point> = sheet.blocks.iter().enumerate().map(|(block, of)| size(sheet, block, of)).collect();
        let mut wider = 0;
        loop {
            let (layout, is_clear) = Draft { graph, sheet, sizes: &sizes, wider }.layout();
            if is_clear || wider == ATTEMPTS {
                return layout;
            }
            wider += 1;
        }
    }
}

/// One attempt, with all distances `wider` by so many pitches.
struct Draft<'a> {
    graph: &'a Graph,
    sheet: &'a Sheet,
    sizes: &'a [Point],
    wider: i32,
}

impl Draft<'_> {
    fn layout(&self) -> (Layout, bool) {
        let mut problems: Vec<Problem> = (0..self.sheet.groups.len()).map(|group| problem(self.sheet, group)).collect();
        let first = self.arrange(&problems, Effort::Rough);
        let shelves = self.shelves(&first);
        let rows = shelves.rows();

        self.add_pulls(&shelves.place(&rows), &first, &mut problems);
        let groups = self.arrange(&problems, Effort::Fine);
        let corners = self.shelves(&groups).place(&rows);
        self.routed(&groups, &corners)
    }

    fn arrange(&self, problems: &[Problem], effort: Effort) -> Vec<Arranged> {
        let groups = self.sheet.groups.iter().zip(problems);
        groups.map(|(group, problem)| self.arranged(group, &place::place(problem, effort))).collect()
    }

    /// A group in pitches: columns as wide as their widest block.
    fn arranged(&self, group: &Group, cells: &[Cell]) -> Arranged {
        const ROW_GAP: i32 = 5;
        const COLUMN_GAP: i32 = 6;
        let columns = cells.iter().map(|cell| cell.0).max().unwrap_or_default() + 1;
        let rows = cells.iter().map(|cell| cell.1).max().unwrap_or_default() + 1;
        let mut widths = vec![0; columns as usize];
        for (&(column, _), &block) in cells.iter().zip(&group.blocks) {
            widths[column as usize] = widths[column as usize].max(self.sizes[block].0);
        }
        let (side, top) = if group.part.is_some() { (PADDING, PADDING + TITLE_ROWS) } else { (0, 0) };
        let mut centres = Vec::new();
        let mut x = side;
        for width in &widths {
            centres.push(x + width / 2);
            x += width + COLUMN_GAP + self.wider;
        }
        let row_height = BLOCK_HEIGHT + ROW_GAP + self.wider;
        let corners = cells.iter().zip(&group.blocks).map(|(&(column, row), &block)| {
            (centres[column as usize] - self.sizes[block].0 / 2, top + row * row_height)
        });
        let title = group.part.map_or(0, |part| title_width(self.graph, part) + 2);
        let width = (x - COLUMN_GAP - self.wider + side).max(title);
        let height = top + rows * row_height - ROW_GAP - self.wider + side;
        Arranged { size: (width, height), corners: corners.collect() }
    }

    /// The groups as rectangles with links between the middles of their blocks.
    fn shelves(&self, groups: &[Arranged]) -> Shelves {
        const GAP: i32 = 4;
        let outward = self.sheet.links.iter().filter_map(|link| {
            let ends = [link.from, link.to].map(|block| self.end(groups, block));
            (ends[0].0 != ends[1].0).then_some(ends)
        });
        let sizes = groups.iter().map(|group| group.size).collect();
        let links: Vec<[(usize, Point); 2]> = outward.collect();
        let pairs: BTreeSet<(usize, usize)> = links.iter().map(|[a, b]| (a.0.min(b.0), a.0.max(b.0))).collect();
        Shelves { sizes, links, pairs: pairs.into_iter().collect(), gap: GAP + self.wider }
    }

    /// A block's group, and its middle from the group's corner.
    fn end(&self, groups: &[Arranged], block: usize) -> (usize, Point) {
        let group = self.sheet.blocks[block].group;
        let place = self.sheet.groups[group].blocks.iter().position(|&member| member == block).unwrap_or_default();
        let (corner, size) = (groups[group].corners[place], self.sizes[block]);
        (group, (corner.0 + size.0 / 2, corner.1 + size.1 / 2))
    }

    /// Tells each group where its outward links lead.
    fn add_pulls(&self, corners: &[Point], groups: &[Arranged], problems: &mut [Problem]) {
        let middle =
            |group: usize| (corners[group].0 + groups[group].size.0 / 2, corners[group].1 + groups[group].size.1 / 2);
        for link in &self.sheet.links {
            for (own, other) in [(link.from, link.to), (link.to, link.from)] {
                let (group, goal) = (self.sheet.blocks[own].group, self.sheet.blocks[other].group);
                let ((x, y), (goal_x, goal_y)) = (middle(group), middle(goal));
                let (dx, dy) = (goal_x - x, goal_y - y);
                let is_clear = |one: i32, two: i32| if 2 * one.abs() >= two.abs() { one.signum() } else { 0 };
                let place = self.sheet.groups[group].blocks.iter().position(|&member| member == own);
                if let Some(place) = place.filter(|_| group != goal) {
                    problems[group].pulls.push((place, (is_clear(dx, dy), is_clear(dy, dx))));
                }
            }
        }
    }

    fn routed(&self, groups: &[Arranged], corners: &[Point]) -> (Layout, bool) {
        let mut blocks = vec![Rect { left: 0, top: 0, right: 0, bottom: 0 }; self.sheet.blocks.len()];
        let mut frames = Vec::new();
        for ((group, arranged), corner) in self.sheet.groups.iter().zip(groups).zip(corners) {
            let (x, y) = (corner.0 + MARGIN, corner.1 + MARGIN);
            for (&block, own) in group.blocks.iter().zip(&arranged.corners) {
                blocks[block] = sized((x + own.0, y + own.1), self.sizes[block]);
            }
            frames.extend(group.part.map(|part| Frame { part, rect: sized((x, y), arranged.size) }));
        }
        let far = |of: &dyn Fn(usize) -> i32| (0..groups.len()).map(of).max().unwrap_or_default() + 2 * MARGIN;
        let width = far(&|group| corners[group].0 + groups[group].size.0);
        let height = far(&|group| corners[group].1 + groups[group].size.1);
        let plan = Plan {
            width: width + 1,
            height: height + 1,
            blocks,
            labels: frames.iter().map(|frame| frame.title(self.graph)).collect(),
            frames: frames.iter().map(|frame| frame.rect).collect(),
            links: self.sheet.links.iter().map(|link| (link.from, link.to)).collect(),
        };
        let Routes { paths, is_clear } = route(&plan);
        (Layout { width, height, blocks: plan.blocks, frames, paths }, is_clear)
    }
}

impl Frame {
    /// The points under its title.
    pub fn title(&self, graph: &Graph) -> Rect {
        sized((self.rect.left + 1, self.rect.top + 1), (title_width(graph, self.part), TITLE_ROWS - 1))
    }
}

fn sized((left, top): Point, (width, height): Point) -> Rect {
    Rect { left, top, right: left + width, bottom: top + height }
}

/// The width of a group's title.
fn title_width(graph: &Graph, part: usize) -> i32 {
    let part = &graph.parts[part];
    let pixels = text::width(&part.word, TITLE, false) + text::width(&part.name, TITLE, true) + 10 * TITLE;
    pitches(pixels)
}

/// Tenths of pixels in pitches, rounded up.
fn pitches(tenths: i32) -> i32 {
    (tenths + 10 * PITCH - 1) / (10 * PITCH)
}

/// The size of a block: room for its label and for twice as many links as end there, even, so that it has a middle.
fn size(sheet: &Sheet, block: usize, of: &Block) -> Point {
    const ROOM: i32 = 120;
    // The larger line is the symbol of a node, the name of a part.
    let (large, small) = if matches!(of.of, Of::Part(_)) { (&of.name, &of.head) } else { (&of.head, &of.name) };
    let label = text::width(large, LARGE, true).max(text::width(small, SMALL, false)) + ROOM;
    let ends = sheet.links.iter().filter(|link| link.from == block || link.to == block).count();
    let width = pitches(label).max(i32::try_from(ends).unwrap_or(0) - BLOCK_HEIGHT + 2).max(4);
    (width + width % 2, BLOCK_HEIGHT)
}

/// The blocks of a group and the links between them.
fn problem(sheet: &Sheet, group: usize) -> Problem {
    let members = &sheet.groups[group].blocks;
    let place = |block: usize| members.iter().position(|&member| member == block);
    let size_cost = if sheet.groups[group].part.is_some() { 14 } else { 2 };
    let mut problem = Problem { count: members.len(), size_cost, ..Problem::default() };
    let mut inward: Vec<[Option<usize>; 2]> = vec![[None; 2]; members.len()];
    for link in &sheet.links {
        if let (Some(from), Some(to)) = (place(link.from), place(link.to)) {
            inward[from][1] = Some(problem.links.len());
            inward[to][0] = Some(problem.links.len());
            problem.links.push((from, to));
        }
    }
    for (&block, links) in members.iter().zip(inward) {
        if let (true, [Some(first), Some(second)]) = (is_two_port(&sheet.blocks[block]), links) {
            problem.straight.push((first, second));
        }
    }
    problem
}

fn is_two_port(block: &Block) -> bool {
    matches!(block.head.as_str(), "TF" | "GY" | "MTF" | "MGY")
}
