//! Maximum matching in a graph some of whose vertices need no partner.
//!
//! In: vertices, edges, spares. Out: for every vertex its partner or its spare; those that can have neither, on
//! request. Method: the shrinking of odd cycles (blossoms) of Edmonds, Paths, trees, and flowers (Canadian J. Math. 17,
//! 1965). A search grows a tree of alternating paths from a vertex without a partner; it ends at another such vertex,
//! or at one that can change over between a partner and its spare.

use std::collections::VecDeque;

/// What a vertex is content with.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) enum Mate {
    /// Nothing yet.
    None,
    /// Its spare of this number.
    Spare(usize),
    /// Another vertex, along the edge of this number.
    Vertex(usize, usize),
}

/// A graph and a matching in it.
#[derive(Debug, Default)]
pub(super) struct Matching {
    /// Neighbours of every vertex, each with the number of the edge.
    edges: Vec<Vec<(usize, usize)>>,
    /// A spare of every vertex that has any.
    spares: Vec<Option<usize>>,
    mates: Vec<Mate>,
}

/// A tree of alternating paths; outer vertices are an even number of edges from its root.
struct Tree {
    outer: Vec<bool>,
    /// The outer vertex before an inner one, and the edge between them.
    parent: Vec<Option<(usize, usize)>>,
    /// The vertex that stands for the blossom a vertex is in.
    base: Vec<usize>,
    queue: VecDeque<usize>,
}

impl Matching {
    /// A new vertex.
    pub fn vertex(&mut self) -> usize {
        self.edges.push(Vec::new());
        self.spares.push(None);
        self.mates.push(Mate::None);
        self.edges.len() - 1
    }

    /// An edge between two vertices that differ.
    pub fn edge(&mut self, a: usize, b: usize, number: usize) {
        self.edges[a].push((b, number));
        self.edges[b].push((a, number));
    }

    /// A spare of a vertex; of several the first is taken where nothing speaks for another.
    pub fn spare(&mut self, a: usize, number: usize) {
        self.spares[a].get_or_insert(number);
    }

    /// What a vertex has.
    pub fn mate(&self, a: usize) -> Mate {
        self.mates[a]
    }

    /// Gives two vertices each other as partners where both are free: a guess that shortens the search.
    pub fn suggest(&mut self, a: usize, b: usize, number: usize) {
        if self.mates[a] == Mate::None && self.mates[b] == Mate::None {
            self.join(a, b, number);
        }
    }

    /// Gives a vertex one of its spares where it has nothing.
    pub fn settle(&mut self, a: usize, number: usize) {
        if self.mates[a] == Mate::None {
            self.mates[a] = Mate::Spare(number);
        }
    }

    fn join(&mut self, a: usize, b: usize, number: usize) {
        self.mates[a] = Mate::Vertex(b, number);
        self.mates[b] = Mate::Vertex(a, number);
    }

    /// Finds a partner or spare for `root`, which has none; all that are content stay so. Where that cannot be, those
    /// any one of which could go without in its place.
    pub fn augment(&mut self, root: usize) -> Result<(), Vec<usize>> {
        let count = self.edges.len();
        let mut tree = Tree {
            outer: vec![false; count],
            parent: vec![None; count],
            base: (0..count).collect(),
            queue: [root].into(),
        };
        tree.outer[root] = true;
        while let Some(u) = tree.queue.pop_front() {
            if let Some(number) = self.spares[u] {
                let before = std::mem::replace(&mut self.mates[u], Mate::Spare(number));
                self.flip(&tree, before);
                return Ok(());
            }
            for k in 0..self.edges[u].len() {
                let (w, number) = self.edges[u][k];
                if tree.base[u] == tree.base[w] {
                    continue;
                }
                if tree.outer[w] {
                    self.shrink(&mut tree, (u, w), number);
                } else if tree.parent[w].is_none() {
                    tree.parent[w] = Some((u, number));
                    let Mate::Vertex(next, _) = self.mates[w] else {
                        self.flip(&tree, Mate::Vertex(w, number));
                        return Ok(());
                    };
                    tree.outer[next] = true;
                    tree.queue.push_back(next);
                }
            }
        }
        Err((0..count).filter(|&vertex| tree.outer[vertex]).collect())
    }

    /// Changes the partners along the path from the inner vertex `end` to the root.
    fn flip(&mut self, tree: &Tree, end: Mate) {
        let mut end = end;
        while let Mate::Vertex(inner, _) = end {
            let Some((outer, number)) = tree.parent[inner] else { return };
            end = self.mates[outer];
            self.join(inner, outer, number);
        }
    }

    /// Makes the odd cycle that the edge between two outer vertices closes one outer vertex.
    fn shrink(&self, tree: &mut Tree, (u, w): (usize, usize), number: usize) {
        let base = self.common_base(tree, u, w);
        let mut inside = vec![false; self.edges.len()];
        self.mark(tree, (u, base), (w, number), &mut inside);
        self.mark(tree, (w, base), (u, number), &mut inside);
        for vertex in 0..self.edges.len() {
            if inside[tree.base[vertex]] {
                tree.base[vertex] = base;
                if !tree.outer[vertex] {
                    tree.outer[vertex] = true;
                    tree.queue.push_back(vertex);
                }
            }
        }
    }

    /// The outer vertex before `u` on its path, one pair further to the root.
    fn before(&self, tree: &Tree, u: usize) -> Option<(usize, usize)> {
        match self.mates[u] {
            Mate::Vertex(inner, _) => Some((inner, tree.parent[inner]?.0)),
            _ => None,
        }
    }

    fn common_base(&self, tree: &Tree, u: usize, w: usize) -> usize {
        let mut seen = vec![false; self.edges.len()];
        let mut at = tree.base[u];
        seen[at] = true;
        while let Some((_, outer)) = self.before(tree, at) {
            at = tree.base[outer];
            seen[at] = true;
        }
        let mut at = tree.base[w];
        while !seen[at] {
            match self.before(tree, at) {
                Some((_, outer)) => at = tree.base[outer],
                None => break,
            }
        }
        at
    }

    /// Marks the bases of the blossoms from `from` to `base`, and turns the path round: it now leads over `child`.
    fn mark(&self, tree: &mut Tree, (from, base): (usize, usize), child: (usize, usize), inside: &mut [bool]) {
        let (mut vertex, mut child) = (from, child);
        while tree.base[vertex] != base {
            let Mate::Vertex(inner, _) = self.mates[vertex] else { return };
            let Some((outer, number)) = tree.parent[inner] else { return };
            inside[tree.base[vertex]] = true;
            inside[tree.base[inner]] = true;
            tree.parent[vertex] = Some(child);
            child = (inner, number);
            vertex = outer;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::Random;

    /// How many vertices go without at best: by trying all edges.
    fn least(count: usize, edges: &[(usize, usize)], spares: &[bool]) -> usize {
        let Some((&(a, b), rest)) = edges.split_first() else { return (0..count).filter(|&v| !spares[v]).count() };
        let without = least(count, rest, spares);
        let taken: Vec<(usize, usize)> =
            rest.iter().copied().filter(|&(c, d)| ![c, d].contains(&a) && ![c, d].contains(&b)).collect();
        let both = usize::from(!spares[a]) + usize::from(!spares[b]);
        without.min(least(count, &taken, spares) - both)
    }

    #[test]
    fn as_many_as_possible_are_content() {
        let mut random = Random::new(3);
        let mut short = 0;
        for _ in 0..4000 {
            let count = 2 + random.below(8);
            let mut edges: Vec<(usize, usize)> = Vec::new();
            for _ in 0..random.below(13) {
                let (a, b) = (random.below(count), random.below(count));
                if a != b {
                    edges.push((a, b));
                }
            }
            let spares: Vec<bool> = (0..count).map(|_| random.below(6) == 0).collect();
            let mut matching = Matching::default();
            (0..count).for_each(|_| assert!(matching.vertex() < count));
            edges.iter().enumerate().for_each(|(number, &(a, b))| matching.edge(a, b, number));
            (0..count).filter(|&v| spares[v]).for_each(|v| matching.spare(v, 100 + v));
            if let Some(&(a, b)) = edges.last() {
                matching.suggest(a, b, edges.len() - 1);
            }
            let mut without = 0;
            for vertex in 0..count {
                if matching.mate(vertex) == Mate::None
                    && let Err(candidates) = matching.augment(vertex)
                {
                    assert!(candidates.contains(&vertex) && candidates.iter().all(|&v| !spares[v]));
                    without += 1;
                }
            }
            assert_eq!(without, least(count, &edges, &spares), "{edges:?} {spares:?}");
            for (vertex, &has_spare) in spares.iter().enumerate() {
                match matching.mate(vertex) {
                    Mate::None => {}
                    Mate::Spare(number) => assert!(has_spare && number == 100 + vertex),
                    Mate::Vertex(other, number) => {
                        assert_eq!(matching.mate(other), Mate::Vertex(vertex, number));
                        assert!([(vertex, other), (other, vertex)].contains(&edges[number]));
                    }
                }
            }
            short += usize::from(without > 0);
        }
        assert!(short > 500 && short < 3500, "{short}");
    }
}
