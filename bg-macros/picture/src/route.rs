//! The paths of the links: orthogonal, clear of labels, no two on each other.
//!
//! In: the grid with its obstacles, the rectangles that each link joins. Out: a path of grid points for each link.
//! Method: A* (Hart, Nilsson, Raphael 1968) over points and directions with costs for length, bends and crossings,
//! and negotiation about points that several links want (McMurchie and Ebeling, PathFinder, 1995): each round makes
//! these dearer, until every link has its own. The first two steps at either end are straight and cross nothing: room
//! for half arrow and stroke.

use crate::search::{Finder, Traffic};
use crate::shelves::Point;

/// A rectangle of grid points, borders included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Rect {
    pub left: i32,
    pub top: i32,
    pub right: i32,
    pub bottom: i32,
}

/// What links run on.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    pub width: i32,
    pub height: i32,
    /// What no link may touch, but at its own ends.
    pub blocks: Vec<Rect>,
    /// Labels that no link may touch.
    pub labels: Vec<Rect>,
    /// Frames that only links from inside should enter.
    pub frames: Vec<Rect>,
    /// The blocks at the ends of each link.
    pub links: Vec<(usize, usize)>,
}

/// The links' paths, and whether all are clear of each other.
#[derive(Clone, Debug)]
pub(crate) struct Routes {
    pub paths: Vec<Vec<Point>>,
    pub is_clear: bool,
}

/// Routes all links.
pub(crate) fn route(plan: &Plan) -> Routes {
    const ROUNDS: u32 = 40;
    const POLISH: u32 = 3;
    let mut finder = Finder::new(plan);
    let mut traffic = Traffic::new(plan);
    let mut order: Vec<usize> = (0..plan.links.len()).collect();
    order.sort_by_key(|&link| (distance(plan, link), link));
    let mut paths: Vec<Vec<Point>> = vec![Vec::new(); plan.links.len()];
    let mut clear_rounds = 0;
    let mut best: Option<(i64, Vec<Vec<Point>>)> = None;
    for round in 0..ROUNDS {
        let price = 15_i64 << (round / 2).min(12);
        for &link in &order {
            traffic.remove(&paths[link]);
            paths[link] = finder.find(plan, &traffic, link, price);
            traffic.add(&paths[link]);
        }
        if traffic.settle() {
            let cost = traffic.cost(&paths);
            if best.as_ref().is_none_or(|(least, _)| cost < *least) {
                best = Some((cost, paths.clone()));
            }
            clear_rounds += 1;
            if clear_rounds > POLISH {
                break;
            }
        }
    }
    match best {
        Some((_, paths)) if paths.iter().all(|path| !path.is_empty()) => Routes { paths, is_clear: true },
        _ => Routes { paths, is_clear: false },
    }
}

fn distance(plan: &Plan, link: usize) -> i32 {
    let (a, b) = plan.links[link];
    let (a, b) = (plan.blocks[a].centre(), plan.blocks[b].centre());
    (a.0 - b.0).abs() + (a.1 - b.1).abs()
}

impl Rect {
    /// The point in the middle.
    pub fn centre(&self) -> Point {
        (self.left.midpoint(self.right), self.top.midpoint(self.bottom))
    }

    /// The points of its border where a link may end, without the corners, with the direction away from it.
    pub fn ports(&self) -> impl Iterator<Item = (Point, Point)> + use<> {
        let Self { left, top, right, bottom } = *self;
        let sides = (top + 1..bottom).flat_map(move |y| [((left, y), (-1, 0)), ((right, y), (1, 0))]);
        let ends = (left + 1..right).flat_map(move |x| [((x, top), (0, -1)), ((x, bottom), (0, 1))]);
        sides.chain(ends)
    }

    /// How far a port is from the middle of its side.
    pub fn offset(&self, (x, y): Point) -> i32 {
        let (cx, cy) = self.centre();
        if x == self.left || x == self.right { (y - cy).abs() } else { (x - cx).abs() }
    }
}
