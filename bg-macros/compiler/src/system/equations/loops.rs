//! Groups of things that need each other.
//!
//! In: for each thing the others that it needs. Out: the groups in which all need each other, those that are needed
//! first. Method: strongly connected components (Tarjan 1972, Depth-first search and linear graph algorithms).

/// What a depth-first search knows of one thing.
#[derive(Clone, Copy, Debug, Default)]
struct Visit {
    /// When it was entered, counted from 1; 0 before.
    entered: usize,
    /// The earliest thing of its group that it is known to need.
    earliest: usize,
    /// Whether its group is not complete.
    open: bool,
}

struct Search<'a> {
    needs: &'a [Vec<usize>],
    visits: Vec<Visit>,
    open: Vec<usize>,
    entered: usize,
    groups: Vec<Vec<usize>>,
}

/// The groups, each in the order of counting.
pub(super) fn groups(needs: &[Vec<usize>]) -> Vec<Vec<usize>> {
    let visits = vec![Visit::default(); needs.len()];
    let mut search = Search { needs, visits, open: Vec::new(), entered: 0, groups: Vec::new() };
    for thing in 0..needs.len() {
        if search.visits[thing].entered == 0 {
            search.visit(thing);
        }
    }
    search.groups
}

impl Search<'_> {
    fn visit(&mut self, thing: usize) {
        self.entered += 1;
        self.visits[thing] = Visit { entered: self.entered, earliest: self.entered, open: true };
        self.open.push(thing);
        for &needed in &self.needs[thing] {
            if self.visits[needed].entered == 0 {
                self.visit(needed);
            }
            if self.visits[needed].open {
                self.visits[thing].earliest = self.visits[thing].earliest.min(self.visits[needed].earliest);
            }
        }
        if self.visits[thing].earliest == self.visits[thing].entered {
            self.close(thing);
        }
    }

    /// The first thing of a group has been left: all that is open since belongs to it.
    fn close(&mut self, first: usize) {
        let from = self.open.iter().rposition(|&open| open == first).unwrap_or(0);
        let mut group = self.open.split_off(from);
        group.iter().for_each(|&member| self.visits[member].open = false);
        group.sort_unstable();
        self.groups.push(group);
    }
}

#[cfg(test)]
mod tests {
    use super::groups;

    #[test]
    fn what_needs_each_other_is_a_group_and_what_is_needed_comes_first() {
        let needs = [vec![1], vec![2, 4], vec![0], vec![3], vec![5], vec![], vec![0, 7], vec![6]];
        assert_eq!(groups(&needs), [vec![5], vec![4], vec![0, 1, 2], vec![3], vec![6, 7]]);
        assert!(groups(&[]).is_empty());
    }

    #[test]
    fn circles_that_share_a_member_are_one_group() {
        assert_eq!(groups(&[vec![1], vec![0, 2], vec![1]]), [vec![0, 1, 2]]);
        assert_eq!(groups(&[vec![2], vec![0], vec![1, 3], vec![2]]), [vec![0, 1, 2, 3]]);
    }
}
