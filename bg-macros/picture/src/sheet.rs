//! What stands on the sheet at a level of detail: blocks, links between them, groups of blocks.
//!
//! In: a [`Graph`], a [`Level`]. Out: a [`Sheet`] without places. At the full level every node is a block and every
//! bond a link. At the level of words a part is one block, and all bonds between it and another block are one link,
//! whose half arrow and stroke are drawn where these bonds agree.

use crate::graph::{Bond, End, Graph, Level};
use crate::marks::{Mark, marks};

/// Blocks and links to be placed.
#[derive(Clone, Debug)]
pub(crate) struct Sheet {
    pub blocks: Vec<Block>,
    pub links: Vec<Link>,
    pub groups: Vec<Group>,
}

/// A node, or a part as one box.
#[derive(Clone, Debug)]
pub(crate) struct Block {
    pub of: Of,
    /// The upper line of the label: a node's symbol, a part's word.
    pub head: String,
    /// The lower line: its name.
    pub name: String,
    pub mark: Mark,
    pub group: usize,
}

/// What a block stands for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Of {
    Node(usize),
    Part(usize),
}

/// A bond, or several between the same two blocks.
#[derive(Clone, Debug)]
pub(crate) struct Link {
    pub from: usize,
    pub to: usize,
    /// Whether the half arrow is drawn: not where bonds of both directions are one link.
    pub has_arrow: bool,
    pub stroke: Option<End>,
    /// Indices into the graph's table.
    pub bonds: Vec<usize>,
}

/// Blocks that stand together, with a frame around them where they are a part.
#[derive(Clone, Debug)]
pub(crate) struct Group {
    pub part: Option<usize>,
    pub blocks: Vec<usize>,
}

impl Sheet {
    /// The sheet of `graph` at `level`.
    pub fn new(graph: &Graph, level: Level) -> Self {
        let marks = marks(graph);
        let (mut blocks, block_of) = blocks(graph, level, &marks);
        let links = links(graph, &blocks, &block_of);
        let groups = groups(graph, &mut blocks, &links);
        Self { blocks, links, groups }
    }
}

impl Link {
    /// Whether it is drawn thick: a multibond, several bonds, or what joins two parts.
    pub fn is_thick(&self, graph: &Graph, sheet: &Sheet) -> bool {
        let is_part = |block: usize| matches!(sheet.blocks[block].of, Of::Part(_));
        let is_multi = self.bonds.iter().any(|&bond| graph.bonds[bond].cardinality > 1);
        is_multi || self.bonds.len() > 1 || (is_part(self.from) && is_part(self.to))
    }
}

/// The blocks, and the block of each node.
fn blocks(graph: &Graph, level: Level, marks: &[Mark]) -> (Vec<Block>, Vec<usize>) {
    let mut blocks: Vec<Block> = Vec::new();
    let mut of_part: Vec<Option<usize>> = vec![None; graph.parts.len()];
    let mut block_of = Vec::new();
    for (index, node) in graph.nodes.iter().enumerate() {
        let part = node.part.filter(|_| level == Level::Words);
        let block = part.and_then(|part| of_part[part]).unwrap_or(blocks.len());
        if block == blocks.len() {
            let (of, head, name) = if let Some(part) = part {
                of_part[part] = Some(block);
                (Of::Part(part), graph.parts[part].word.clone(), graph.parts[part].name.clone())
            } else {
                (Of::Node(index), node.kind.clone(), node.short_name(&graph.parts).to_owned())
            };
            blocks.push(Block { of, head, name, mark: Mark::None, group: 0 });
        }
        blocks[block].mark = blocks[block].mark.max(marks[index]);
        block_of.push(block);
    }
    (blocks, block_of)
}

fn links(graph: &Graph, blocks: &[Block], block_of: &[usize]) -> Vec<Link> {
    let mut links: Vec<Link> = Vec::new();
    for (index, bond) in graph.bonds.iter().enumerate() {
        let (from, to) = (block_of[bond.from], block_of[bond.to]);
        if from == to {
            continue;
        }
        let is_merged = [from, to].iter().any(|&end| matches!(blocks[end].of, Of::Part(_)));
        let same = |link: &&mut Link| [(from, to), (to, from)].contains(&(link.from, link.to));
        match links.iter_mut().find(same).filter(|_| is_merged) {
            Some(link) => merge(link, index, bond, from),
            None => links.push(Link { from, to, has_arrow: true, stroke: Some(bond.stroke), bonds: vec![index] }),
        }
    }
    links
}

/// Adds a bond that starts at the block `from` to a link.
fn merge(link: &mut Link, index: usize, bond: &Bond, from: usize) {
    let is_along = link.from == from;
    let stroke = if is_along { bond.stroke } else { bond.stroke.other() };
    link.has_arrow &= is_along;
    link.stroke = link.stroke.filter(|&end| end == stroke);
    link.bonds.push(index);
}

/// One group for each part that has blocks of nodes; one for each connected piece of the other blocks.
fn groups(graph: &Graph, blocks: &mut [Block], links: &[Link]) -> Vec<Group> {
    let part_of = |block: &Block| match block.of {
        Of::Node(node) => graph.nodes[node].part,
        Of::Part(_) => None,
    };
    let mut groups: Vec<Group> = Vec::new();
    let mut grouped = vec![false; blocks.len()];
    for first in 0..blocks.len() {
        if grouped[first] {
            continue;
        }
        let part = part_of(&blocks[first]);
        let members = match part {
            Some(_) => (0..blocks.len()).filter(|&block| part_of(&blocks[block]) == part).collect(),
            None => connected(first, links, blocks.len(), &|block| part_of(&blocks[block]).is_none()),
        };
        for &block in &members {
            grouped[block] = true;
            blocks[block].group = groups.len();
        }
        groups.push(Group { part, blocks: members });
    }
    groups
}

/// The blocks that links join to `first` by way of blocks that `is_open` lets through, in rising order.
fn connected(first: usize, links: &[Link], count: usize, is_open: &dyn Fn(usize) -> bool) -> Vec<usize> {
    let mut reached = vec![false; count];
    reached[first] = true;
    let mut open = vec![first];
    while let Some(block) = open.pop() {
        for link in links.iter().filter(|link| link.from == block || link.to == block) {
            let other = link.from + link.to - block;
            if is_open(other) && !std::mem::replace(&mut reached[other], true) {
                open.push(other);
            }
        }
    }
    (0..count).filter(|&block| reached[block]).collect()
}
