//! One level of the description: a graph, or a part in its own names.
//!
//! In: its statements without repetitions, the parts inside under the names that they have here. Out: a [`Flat`]. What
//! parts say of the ground comes into the one ground.

use std::collections::BTreeSet;

use super::flat::Flat;
use super::names::Names;
use super::watch::Seen;
use super::{check, place};
use crate::fault::Faults;
use crate::source::ast::{Item, Name, Point, Port, Scene, Start, Use, Watch};

/// A level while it is written out.
pub(super) struct Level<'f> {
    pub names: Names,
    pub flat: Flat,
    /// The nodes in the chains of this level.
    pub bonded: BTreeSet<String>,
    /// The uses of parts with ports.
    pub with_ports: Vec<(Name, Vec<Name>)>,
    /// The parameters and inputs of this level, each with its word.
    pub open: Vec<(&'static str, Name)>,
    starts: Vec<Start>,
    /// Where the first ground of a part inside is, and the points of the others.
    ground_inside: Option<usize>,
    points: Vec<Point>,
    pub faults: &'f mut Faults,
}

impl<'f> Level<'f> {
    /// A level of these statements with these parts, one for each use.
    pub fn of(mut items: Vec<Item>, inside: Vec<Flat>, faults: &'f mut Faults) -> Self {
        let mut level = Self {
            names: Names::of(&mut items, &inside),
            flat: Flat::default(),
            bonded: BTreeSet::new(),
            with_ports: Vec::new(),
            open: Vec::new(),
            starts: Vec::new(),
            ground_inside: None,
            points: Vec::new(),
            faults,
        };
        let mut inside = inside.into_iter();
        for item in items {
            match item {
                Item::Use(used) => level.place(used, inside.next().unwrap_or_default()),
                other => level.item(other),
            }
        }
        level
    }

    /// A part in its place.
    fn place(&mut self, mut used: Use, mut flat: Flat) {
        let prefix = used.name.as_ref().map_or_else(String::new, |name| format!("{}.", name.text));
        used.arguments.iter_mut().for_each(|argument| self.names.value(&mut argument.value, None, self.faults));
        place::give(&mut flat, &used, &prefix, self.faults);
        for mut start in std::mem::take(&mut used.starts) {
            start.of.text = format!("{prefix}{}", start.of.text);
            self.start(start);
        }
        flat.items.into_iter().for_each(|item| self.item_inside(item));
        self.flat.outputs.extend(flat.outputs);
        self.flat.aliases.extend(flat.aliases);
        self.flat.uses.extend(flat.uses);
        self.with_ports.push((used.name.unwrap_or(used.part.name), flat.ports));
    }

    /// A statement of a part inside. Of all their grounds the first one stays.
    fn item_inside(&mut self, item: Item) {
        match item {
            Item::Ground(ground) if self.ground_inside.is_some() => self.points.extend(ground.points),
            other => {
                if matches!(other, Item::Ground(_)) {
                    self.ground_inside = Some(self.flat.items.len());
                }
                self.flat.items.push(other);
            }
        }
    }

    /// A statement of this level itself.
    fn item(&mut self, mut item: Item) {
        self.open.extend(item.adjustable().map(|(word, name)| (word, name.clone())));
        match &mut item {
            // What is watched is looked at when everything is there.
            Item::Observe(_) => return self.flat.items.push(item),
            Item::Scene(scene) => {
                let watched = std::mem::take(&mut scene.observe);
                self.names.resolve(&mut item, self.faults);
                if let Item::Scene(scene) = &mut item {
                    scene.observe = watched;
                }
                return self.flat.items.push(item);
            }
            _ => {}
        }
        self.names.resolve(&mut item, self.faults);
        match item {
            Item::Start(start) => self.starts.push(start),
            Item::Port(Port::Junction(junction)) => {
                self.flat.ports.push(junction.name.clone());
                self.flat.items.push(Item::Junction(junction));
            }
            Item::Port(Port::Alias(name, of)) => self.flat.aliases.push((name.text, of.text)),
            Item::Chain(chain) => {
                self.bonded.extend(chain.iter().map(|name| name.text.clone()));
                self.flat.items.push(Item::Chain(chain));
            }
            other => self.flat.items.push(other),
        }
    }

    fn start(&mut self, mut start: Start) {
        self.names.name(&mut start.of, self.faults);
        self.names.value(&mut start.value, None, self.faults);
        self.starts.push(start);
    }

    /// The level, whose statements are all there: that of a part or of a graph, which `of` names, such as "part `Leg`".
    pub fn finish(mut self, of: &str, is_part: bool) -> Flat {
        place::start(&mut self.flat.items, std::mem::take(&mut self.starts), self.faults);
        self.one_ground();
        self.watch(is_part);
        check::ports(&mut self);
        let unused = check::open(&self, of);
        if is_part {
            self.faults.extend(unused);
        } else {
            self.flat.unused = unused;
        }
        self.flat.names = self.names.declared().map(str::to_owned).collect();
        self.flat
    }

    /// The points of all parts on one ground: that of this level, if it has one.
    fn one_ground(&mut self) {
        let Some(at) = self.ground_inside else { return };
        let items = &mut self.flat.items;
        let is_own = |k: &usize| *k != at && matches!(items[*k], Item::Ground(_));
        let own = (0..items.len()).find(is_own);
        if let Item::Ground(inside) = &mut items[at] {
            let others = std::mem::take(&mut self.points);
            match own {
                None => inside.points.extend(others),
                Some(_) => self.points = inside.points.drain(..).chain(others).collect(),
            }
        }
        if let Some(Item::Ground(ground)) = own.map(|own| &mut items[own]) {
            ground.points.append(&mut self.points);
            items.remove(at);
        }
    }

    /// Writes out what is watched; of a part it goes to the part's outputs.
    fn watch(&mut self, is_part: bool) {
        let mut items = std::mem::take(&mut self.flat.items);
        let places: Vec<usize> = (0..items.len()).filter(|&k| watched(&mut items[k]).is_some()).collect();
        let lists: Vec<Vec<Watch>> =
            places.iter().filter_map(|&k| watched(&mut items[k]).map(std::mem::take)).collect();
        self.flat.items = items;
        let uses = self.with_ports.iter().map(|(name, _)| name.text.clone()).collect();
        let mut seen = Seen { flat: &self.flat, uses: &uses, names: &mut self.names, faults: self.faults };
        let lists: Vec<Vec<_>> = lists.iter().map(|list| seen.observations(list)).collect();
        for (&place, list) in places.iter().zip(lists) {
            if is_part {
                list.into_iter().for_each(|output| self.flat.output(output));
            } else if let Some(slot) = watched(&mut self.flat.items[place]) {
                *slot = list.into_iter().map(Watch::Value).collect();
            }
        }
        if is_part {
            self.flat.items.retain(|item| !matches!(item, Item::Observe(_)));
        }
    }
}

/// What a statement watches.
fn watched(item: &mut Item) -> Option<&mut Vec<Watch>> {
    match item {
        Item::Observe(watched) | Item::Scene(Scene { observe: watched, .. }) => Some(watched),
        _ => None,
    }
}
