//! Repetitions written out.
//!
//! In: statements with `for`, arrays of parts and expressions of indices. Out: the same statement for statement, every
//! index a number. No longer occurs: `Item::For`, `Use::count`.

use proc_macro2::Span;

use super::PartFault;
use super::index::{self, Indices};
use crate::fault::{Explain, Fault, Faults};
use crate::source::ast::{ExpressionKind, For, Item, Name, Use};
use crate::source::walk::{Met, each_name, walk};

/// The most that one range repeats: far more than any array that compiles.
const MOST: i64 = 10_000;

/// The statements without repetitions; of more than `most` the first ones, one more than that.
pub(super) fn unrolled(items: &[Item], most: usize, faults: &mut Faults) -> Vec<Item> {
    let mut writing = Writing { items: Vec::new(), indices: Vec::new(), most, faults };
    items.iter().for_each(|item| writing.item(item));
    writing.items
}

struct Writing<'f> {
    items: Vec<Item>,
    /// The indices around the present statement.
    indices: Vec<(String, i64)>,
    most: usize,
    faults: &'f mut Faults,
}

impl Writing<'_> {
    fn item(&mut self, item: &Item) {
        match item {
            _ if self.items.len() > self.most => {}
            Item::For(repeated) => self.repeated(repeated),
            Item::Use(Use { count: Some((count, span)), .. }) => self.array(item, *count, *span),
            _ => self.statement(item.clone()),
        }
    }

    fn repeated(&mut self, repeated: &For) {
        let name = &repeated.index;
        if self.indices.iter().any(|(known, _)| *known == name.text) {
            self.fault(name.span, &PartFault::SameIndex { name: name.text.clone() });
            return;
        }
        let (Some(from), Some(to)) = (self.number(&repeated.from), self.number(&repeated.to)) else { return };
        if !self.fits(from, to, repeated.to.span) {
            return;
        }
        let before = self.faults.len();
        for number in from..to {
            self.indices.push((name.text.clone(), number));
            repeated.items.iter().for_each(|item| self.item(item));
            self.indices.pop();
            // One round has all faults there are, and all statements where there are none.
            if self.faults.len() > before || self.items.len() > self.most || is_idle(&repeated.items) {
                return;
            }
        }
    }

    /// The uses of an array of parts.
    fn array(&mut self, item: &Item, count: usize, span: Span) {
        let count = i64::try_from(count).unwrap_or(i64::MAX);
        if !self.fits(0, count, span) {
            return;
        }
        for number in 0..count {
            let Item::Use(mut used) = item.clone() else { return };
            if self.items.len() > self.most {
                return;
            }
            used.count = None;
            used.name.iter_mut().for_each(|name| name.text += &format!("[{number}]"));
            self.statement(Item::Use(used));
        }
    }

    fn fits(&mut self, from: i64, to: i64, span: Span) -> bool {
        if from >= to {
            self.fault(span, &PartFault::EmptyRange { from, to });
        } else if to - from > MOST {
            self.fault(span, &PartFault::TooMany { most: MOST });
        }
        from < to && to - from <= MOST
    }

    /// A statement with its numbers.
    fn statement(&mut self, mut item: Item) {
        let (indices, faults) = (&self.indices, &mut *self.faults);
        walk(&mut item, &mut |met| match met {
            Met::Declared(name) | Met::Named(name) => evaluate(&mut name.text, name.span, indices, faults),
            Met::Index(_) => {}
            Met::Value(value, _) => each_name(value, &mut |value| {
                let span = value.span;
                let ExpressionKind::Name(name) = &mut value.kind else { return };
                match indices.iter().find(|(index, _)| *index == name.text) {
                    #[expect(clippy::cast_precision_loss, reason = "an index is a small number")]
                    Some((_, number)) => value.kind = ExpressionKind::Number(*number as f64),
                    None => evaluate(&mut name.text, span, indices, faults),
                }
            }),
        });
        if let Item::Use(used) = &mut item {
            let paths = used.arguments.iter_mut().map(|argument| &mut argument.name);
            let paths = paths.chain(used.starts.iter_mut().map(|start| &mut start.of));
            paths.for_each(|path| evaluate(&mut path.text, path.span, indices, faults));
        }
        self.items.push(item);
    }

    fn number(&mut self, end: &Name) -> Option<i64> {
        match index::number(&end.text, &self.indices) {
            Ok(number) => Some(number),
            Err(word) => {
                self.fault(end.span, &PartFault::NotANumber { word });
                None
            }
        }
    }

    fn fault(&mut self, span: Span, fault: &impl Explain) {
        self.faults.push(Fault::new(span, fault));
    }
}

/// Whether there is nothing to repeat.
fn is_idle(items: &[Item]) -> bool {
    items.iter().all(|item| matches!(item, Item::For(repeated) if is_idle(&repeated.items)))
}

/// Brings the numbers into a name.
fn evaluate(name: &mut String, span: Span, indices: &Indices, faults: &mut Faults) {
    if !name.contains('[') {
        return;
    }
    match index::evaluated(name, indices) {
        Ok(text) => *name = text,
        Err(word) => faults.push(Fault::new(span, &PartFault::NotANumber { word })),
    }
}
