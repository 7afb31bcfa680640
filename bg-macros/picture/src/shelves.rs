//! Where the groups stand: rows of rectangles, like books on shelves.
//!
//! In: the sizes of the groups, the links between points of different groups. Out: the upper left corner of each
//! group, no two closer than the gap. Method: threshold accepting over the order of groups in rows, then each group
//! slides within its place until its links are short and straight. Whole numbers throughout, in pitches of the
//! routing grid.

use crate::random::Random;

/// A place or a distance in pitches: to the right, downwards.
pub(crate) type Point = (i32, i32);

/// What is placed.
#[derive(Clone, Debug)]
pub(crate) struct Shelves {
    /// Width and height of each group.
    pub sizes: Vec<Point>,
    /// Two points in two groups, each from its group's corner.
    pub links: Vec<[(usize, Point); 2]>,
    /// The pairs of groups with links, each once.
    pub pairs: Vec<(usize, usize)>,
    /// The least distance between groups.
    pub gap: i32,
}

/// The groups in their order, row by row.
pub(crate) type Rows = Vec<Vec<usize>>;

impl Shelves {
    /// The corners of the groups, which stand in `rows`.
    pub fn place(&self, rows: &Rows) -> Vec<Point> {
        let mut corners = self.corners(rows);
        for _ in 0..3 {
            for row in rows {
                for place in 0..row.len() {
                    self.slide(row, place, &mut corners);
                }
            }
        }
        corners
    }

    /// The order of the groups in rows.
    pub fn rows(&self) -> Rows {
        const FIRST_THRESHOLD: i64 = 150;
        let count = self.sizes.len();
        let mut root = 1;
        while root * root < count {
            root += 1;
        }
        let all: Vec<usize> = (0..count).collect();
        let mut rows: Rows = all.chunks(root).map(<[usize]>::to_vec).collect();
        if count < 2 {
            return rows;
        }
        let moves = (4000 * count).min(20_000_000 / (count + self.links.len()));
        let mut random = Random::new(2);
        let mut cost = self.cost(&rows, i64::MAX).expect("no cost is larger");
        let mut best = (cost, rows.clone());
        for step in 0..moves {
            let left = (moves - step) as i64;
            let threshold = FIRST_THRESHOLD * left * left / (moves as i64 * moves as i64);
            let before = rows.clone();
            shuffle(&mut rows, &mut random);
            let Some(after) = self.cost(&rows, cost + threshold) else {
                rows = before;
                continue;
            };
            cost = after;
            if cost < best.0 {
                best = (cost, rows.clone());
            }
        }
        best.1
    }

    /// Rows one below the other, each in the middle of the sheet, each group in the middle of its row.
    fn corners(&self, rows: &Rows) -> Vec<Point> {
        let mut corners = vec![(0, 0); self.sizes.len()];
        let widest = rows.iter().map(|row| self.width(row)).max().unwrap_or_default();
        let mut y = 0;
        for row in rows {
            let height = row.iter().map(|&group| self.sizes[group].1).max().unwrap_or_default();
            let mut x = (widest - self.width(row)) / 2;
            for &group in row {
                let (width, own_height) = self.sizes[group];
                corners[group] = (x, y + (height - own_height) / 2);
                x += width + self.gap;
            }
            y += height + self.gap;
        }
        corners
    }

    fn width(&self, row: &[usize]) -> i32 {
        row.iter().map(|&group| self.sizes[group].0 + self.gap).sum::<i32>() - self.gap
    }

    /// Length of the links, and the size of the sheet, which is best one and a half times as wide as high; none where
    /// it is more than `most`.
    fn cost(&self, rows: &Rows, most: i64) -> Option<i64> {
        const SIZE: i64 = 12;
        let corners = self.corners(rows);
        let far = |of: &dyn Fn(usize) -> i32| (0..self.sizes.len()).map(of).max().unwrap_or_default();
        let width = far(&|group| corners[group].0 + self.sizes[group].0);
        let height = far(&|group| corners[group].1 + self.sizes[group].1);
        let links: i64 = self.links.iter().map(|link| length(link, &corners)).sum();
        let apart = links + SIZE * i64::from(width.max(height * 3 / 2));
        Some(apart + self.disorder(&corners, most.checked_sub(apart).filter(|&rest| rest >= 0)?)?)
    }

    /// How much links run over groups and across each other, if each were a straight line between the middles of two
    /// groups; none where it is more than `most`.
    fn disorder(&self, corners: &[Point], most: i64) -> Option<i64> {
        const OVER_GROUP: i64 = 40;
        const CROSSING: i64 = 40;
        let middle =
            |group: usize| (corners[group].0 + self.sizes[group].0 / 2, corners[group].1 + self.sizes[group].1 / 2);
        let mut cost = 0;
        for (index, &(a, b)) in self.pairs.iter().enumerate() {
            let line = [middle(a), middle(b)];
            let others = (0..self.sizes.len()).filter(|&group| group != a && group != b);
            let is_under = |group: &usize| {
                let ((x, y), (width, height)) = (corners[*group], self.sizes[*group]);
                let (right, bottom) = (x + width, y + height);
                // Where all of a line is on one side of a group nothing can cross.
                let is_beside = line.iter().all(|end| end.0 < x)
                    || line.iter().all(|end| end.0 > right)
                    || line.iter().all(|end| end.1 < y)
                    || line.iter().all(|end| end.1 > bottom);
                !is_beside && (cross(line, [(x, y), (right, bottom)]) || cross(line, [(right, y), (x, bottom)]))
            };
            cost += OVER_GROUP * others.filter(is_under).count() as i64;
            let apart = self.pairs[..index].iter().filter(|&&(c, d)| ![a, b].contains(&c) && ![a, b].contains(&d));
            cost += CROSSING * apart.filter(|&&(c, d)| cross(line, [middle(c), middle(d)])).count() as i64;
            if cost > most {
                return None;
            }
        }
        Some(cost)
    }

    /// Moves one group within its place in a row to where its links cost least.
    fn slide(&self, row: &[usize], place: usize, corners: &mut [Point]) {
        let group = row[place];
        let (width, height) = self.sizes[group];
        let end = |other: usize| corners[other].0 + self.sizes[other].0;
        let sheet = (0..self.sizes.len()).map(end).max().unwrap_or_default();
        let left = if place > 0 { end(row[place - 1]) + self.gap } else { 0 };
        let right = row.get(place + 1).map_or(sheet, |&next| corners[next].0 - self.gap) - width;
        let top = row.iter().map(|&other| corners[other].1).min().unwrap_or_default();
        let bottom = row.iter().map(|&other| corners[other].1 + self.sizes[other].1).max().unwrap_or_default() - height;
        let own = corners[group];
        let links: Vec<_> = self.links.iter().filter(|link| link.iter().any(|end| end.0 == group)).collect();
        let cost = |corners: &[Point]| -> i64 { links.iter().map(|link| bent_length(link, corners)).sum() };
        let mut best = (cost(corners), own);
        for is_across in [true, false] {
            for link in &links {
                let [(a, p), (b, q)] = **link;
                let (mine, (other, theirs)) = if a == group { (p, (b, q)) } else { (q, (a, p)) };
                let base = best.1;
                let corner = if is_across {
                    ((corners[other].0 + theirs.0 - mine.0).clamp(left, right.max(left)), base.1)
                } else {
                    (base.0, (corners[other].1 + theirs.1 - mine.1).clamp(top, bottom.max(top)))
                };
                corners[group] = corner;
                best = best.min((cost(corners), corner));
            }
        }
        corners[group] = best.1;
    }
}

/// Whether two straight lines cross.
fn cross(one: [Point; 2], two: [Point; 2]) -> bool {
    let side = |[a, b]: [Point; 2], p: Point| {
        let [ax, ay, bx, by, px, py] = [a.0, a.1, b.0, b.1, p.0, p.1].map(i64::from);
        ((bx - ax) * (py - ay) - (by - ay) * (px - ax)).signum()
    };
    side(one, two[0]) * side(one, two[1]) < 0 && side(two, one[0]) * side(two, one[1]) < 0
}

/// Swaps two groups, or puts one elsewhere.
fn shuffle(rows: &mut Rows, random: &mut Random) {
    let row = random.below(rows.len());
    let place = random.below(rows[row].len());
    if random.below(2) == 0 {
        let other = random.below(rows.len());
        let other_place = random.below(rows[other].len());
        let (a, b) = (rows[row][place], rows[other][other_place]);
        rows[row][place] = b;
        rows[other][other_place] = a;
        return;
    }
    let group = rows[row].remove(place);
    let goal = random.below(rows.len() + 1);
    if goal == rows.len() {
        rows.insert(random.below(rows.len() + 1), vec![group]);
    } else {
        let place = random.below(rows[goal].len() + 1);
        rows[goal].insert(place, group);
    }
    rows.retain(|row| !row.is_empty());
}

fn span(link: &[(usize, Point); 2], corners: &[Point]) -> Point {
    let [a, b] = link.map(|(group, (x, y))| (corners[group].0 + x, corners[group].1 + y));
    ((a.0 - b.0).abs(), (a.1 - b.1).abs())
}

fn length(link: &[(usize, Point); 2], corners: &[Point]) -> i64 {
    let (dx, dy) = span(link, corners);
    i64::from(dx + dy)
}

/// The length, and something for the bends of a link that is not straight.
fn bent_length(link: &[(usize, Point); 2], corners: &[Point]) -> i64 {
    let (dx, dy) = span(link, corners);
    i64::from(dx + dy) + if dx > 0 && dy > 0 { 6 } else { 0 }
}
