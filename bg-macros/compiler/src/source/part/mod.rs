//! Parts: what is described once and used often, written out where it is used.
//!
//! In: [`Source`]. Out: its graphs without parts and repetitions; what is inside of `part front: Leg` has a path,
//! `front.spring`. Every part is written out once, in its own names; a use is a copy of it under another name. So each
//! fault inside of a part is found once. No longer occurs: `Item::Use`, `Item::Port`, `Item::Start`, `Item::For`,
//! `Watch::All`.

mod check;
mod fault;
mod flat;
mod index;
mod level;
mod names;
mod place;
mod repeat;
mod told;
mod watch;

#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use crate::fault::{DeclaredTwice, Explain, Fault, Faults, Staged, near_miss};
use crate::source::ast::{Graph, Item, MOST_STATEMENTS, Name, Part, PartPath, Source, Use, used_parts};
use flat::{Flat, Placed};
use level::Level;

pub use fault::PartFault;

/// The graphs without parts, and where the parts have gone.
#[derive(Debug, Default)]
pub struct Flattened {
    /// The graphs.
    pub source: Source,
    /// Each part that no graph of the call uses, as a graph of its own with something at each of its ports.
    pub unused: Vec<Graph>,
    /// Parameters and inputs of graphs that nothing uses. A wrong name may be meant for one, so this is a fault only
    /// where nothing else is wrong.
    pub unused_parameters: Faults,
    uses: Vec<Placed>,
}

impl Flattened {
    /// Faults, each told once, with the use of the part that it is in.
    #[must_use]
    pub fn told(&self, faults: Faults) -> Faults {
        told::told(faults, &self.uses)
    }
}

/// The graphs without parts and repetitions.
///
/// # Errors
/// Unknown parts and parameters, parts that contain themselves, ports without bonds, elements that an array does not
/// have, more statements than [`Source::most`].
pub fn flatten(source: &Source) -> Staged<Flattened> {
    let (flattened, faults) = flatten_leniently(source);
    if faults.is_empty() { Ok(flattened) } else { Err(flattened.told(faults)) }
}

/// What could be written out, and the faults.
#[must_use]
pub fn flatten_leniently(source: &Source) -> (Flattened, Faults) {
    let mut stage = Flattening { most: source.most.unwrap_or(MOST_STATEMENTS), ..Flattening::default() };
    let mut flattened = Flattened::default();
    let call = Scope { key: String::new(), source };
    for graph in &source.graphs {
        let Flat { items, uses, unused, .. } = stage.level(&call, &graph.items, &graph.name, false);
        flattened.unused_parameters.extend(unused);
        flattened.source.graphs.push(Graph { items, ..graph.clone() });
        flattened.uses.extend(uses);
    }
    for (place, part) in source.parts.iter().enumerate() {
        if let Some(first) = source.parts[..place].iter().find(|known| known.name.text == part.name.text) {
            let twice = DeclaredTwice::new(&part.name.text, part.name.span, first.name.span);
            stage.faults.push(Fault::new(part.name.span, &twice));
        }
        if stage.parts.contains_key(&call.key_of(part)) {
            continue;
        }
        let flat = stage.part(&call, part);
        flattened.uses.push(Placed::of(part));
        flattened.uses.extend(flat.uses.iter().cloned());
        flattened.unused.push(check::alone(part, flat));
    }
    // What has been cut off is missing elsewhere.
    if stage.is_cut {
        stage.faults.retain(|fault| fault.code == PartFault::Large { of: String::new(), most: 0 }.code());
    }
    (flattened, stage.faults)
}

/// The first path of a part of another call that has not been asked yet.
#[must_use]
pub fn unasked(source: &Source) -> Option<&PartPath> {
    let lists = source.parts.iter().map(|part| &part.items).chain(source.graphs.iter().map(|graph| &graph.items));
    let is_unasked = |path: &&PartPath| source.foreign.iter().all(|known| known.path.text != path.name.text);
    lists.flat_map(|items| used_parts(items)).filter(|path| path.is_foreign()).find(is_unasked)
}

/// The fault of such a path where no macro can be asked.
#[must_use]
pub fn of_rust(path: &PartPath) -> Fault {
    Fault::new(path.name.span, &PartFault::OfRust { name: path.name.text.clone() })
}

/// Where the name of a part means something: the call, or what another call has answered.
struct Scope<'s> {
    key: String,
    source: &'s Source,
}

impl<'s> Scope<'s> {
    /// The part of this name or path, with the scope of the names in it.
    fn part(&self, path: &PartPath) -> Option<(Self, &'s Part)> {
        let source = self.source;
        if path.is_foreign() {
            let foreign = source.foreign.iter().find(|foreign| foreign.path.text == path.name.text)?;
            let key = format!("{}{} ", self.key, path.name.text);
            return Some((Self { key, source: &foreign.source }, foreign.source.parts.first()?));
        }
        let part = source.parts.iter().find(|part| part.name.text == path.name.text)?;
        Some((Self { key: self.key.clone(), source }, part))
    }

    fn key_of(&self, part: &Part) -> String {
        format!("{}{}", self.key, part.name.text)
    }
}

#[derive(Default)]
struct Flattening {
    /// The parts that have been written out.
    parts: BTreeMap<String, Flat>,
    /// The parts that are being written out, the outermost first.
    around: Vec<String>,
    faults: Faults,
    /// The most statements of one of them, or of a graph.
    most: usize,
    /// Whether one has had more.
    is_cut: bool,
}

impl Flattening {
    /// The statements of a graph, or of a part, without parts. Of one that is too large there are none.
    fn level(&mut self, scope: &Scope, items: &[Item], name: &Name, is_part: bool) -> Flat {
        let of = format!("{} `{}`", if is_part { "part" } else { "graph" }, name.text);
        let items = repeat::unrolled(items, self.most, &mut self.faults);
        let mut count = items.len();
        let mut inside = Vec::new();
        for used in items.iter().filter_map(|item| if let Item::Use(used) = item { Some(used) } else { None }) {
            if count > self.most {
                break;
            }
            let flat = self.used(scope, used).unwrap_or_default();
            count += flat.items.len();
            inside.push(flat);
        }
        if count > self.most {
            self.faults.push(Fault::new(name.span, &PartFault::Large { of, most: self.most }));
            self.is_cut = true;
            return Flat::default();
        }
        Level::of(items, inside, &mut self.faults).finish(&of, is_part)
    }

    /// A part, written out once.
    fn part(&mut self, scope: &Scope, part: &Part) -> Flat {
        let key = scope.key_of(part);
        if let Some(flat) = self.parts.get(&key) {
            return flat.clone();
        }
        self.around.push(key.clone());
        let flat = self.level(scope, &part.items, &part.name, true);
        self.around.pop();
        self.parts.insert(key, flat.clone());
        flat
    }

    /// A part under the name that it has in its place; none where there is no such part.
    fn used(&mut self, scope: &Scope, used: &Use) -> Option<Flat> {
        let name = &used.part.name;
        let Some((inner, part)) = scope.part(&used.part) else {
            let known = scope.source.parts.iter().map(|part| part.name.text.as_str());
            let near = near_miss(&name.text, known).map(str::to_owned);
            self.faults.push(Fault::new(name.span, &PartFault::UnknownPart { name: name.text.clone(), near }));
            return None;
        };
        if let Some(circle) = self.circle(&inner.key_of(part)) {
            self.faults.push(Fault::new(name.span, &PartFault::ContainsItself { circle }));
            return None;
        }
        let mut flat = self.part(&inner, part);
        flat.uses.insert(0, Placed { part: name.text.clone(), ..Placed::of(part) });
        Some(if let Some(path) = &used.name { flat.under(&path.text) } else { flat })
    }

    /// The parts from this one back to itself, if it is being written out.
    fn circle(&self, key: &str) -> Option<Vec<String>> {
        let start = self.around.iter().position(|known| known == key)?;
        let circle = self.around[start..].iter().map(String::as_str).chain([key]);
        Some(circle.map(|key| key.rsplit(' ').next().unwrap_or_default().to_owned()).collect())
    }
}
