//! Straight-line programs in batches of one kind, as an interpreter reads them.
//!
//! In: operations. Out: the words of a table, which `bg_model::tabled` describes and reads. Method: of what is ready
//! each time all of the kind that there is most of, so that a batch is one loop without a choice in it.

use std::mem::{Discriminant, discriminant};

use super::Operation;
use crate::expr::Function;

/// Operations in batches.
#[derive(Clone, Debug)]
pub struct Batches {
    /// The batches in words.
    pub words: Vec<u32>,
    /// The place of the value of each operation.
    pub values: Vec<u32>,
}

/// What an operand of a program is for a table of it.
#[derive(Clone, Copy, Debug)]
pub enum Read {
    /// What stands at this place.
    Place(u32),
    /// This number, which stands at this place.
    Number(f64, u32),
    /// The value of an earlier operation.
    Value(u32),
}

/// Operations in batches, whose values stand from the place `first` on; `read` says what an operand is.
///
/// # Panics
/// There are more than 2^32 operations, or one takes the value of a later one.
#[must_use]
pub fn batches<T: Copy>(operations: &[Operation<T>], first: u32, read: &dyn Fn(T) -> Read) -> Batches {
    let order = order(operations, read);
    let mut values = vec![0; operations.len()];
    order.iter().flatten().zip(first..).for_each(|(&of, place)| values[of] = place);
    let mut words = Vec::new();
    for batch in &order {
        words.extend(begin(&operations[batch[0]], read));
        words.push(u32::try_from(batch.len()).expect("fewer than 2^32 operations"));
        for &of in batch {
            operands(&operations[of], read, &values, &mut words);
        }
    }
    Batches { words, values }
}

/// The factor of a product with a number, and the other operand.
fn factor<T: Copy>(a: T, b: T, read: &dyn Fn(T) -> Read) -> Option<(f64, T)> {
    match (read(a), read(b)) {
        (Read::Number(factor, _), _) => Some((factor, b)),
        (_, Read::Number(factor, _)) => Some((factor, a)),
        _ => None,
    }
}

/// The kind of a batch, and its function.
fn begin<T: Copy>(of: &Operation<T>, read: &dyn Fn(T) -> Read) -> Vec<u32> {
    match of {
        Operation::Add(..) => vec![0],
        Operation::Subtract(..) => vec![1],
        Operation::Multiply(a, b) if factor(*a, *b, read).is_some() => vec![4],
        Operation::Multiply(..) => vec![2],
        Operation::Divide(..) => vec![3],
        Operation::Negate(_) => vec![5],
        Operation::Call(function, _) => vec![if function.arity() == 1 { 6 } else { 7 }, function.number()],
        Operation::Select { .. } => vec![8],
    }
}

fn operands<T: Copy>(of: &Operation<T>, read: &dyn Fn(T) -> Read, values: &[u32], words: &mut Vec<u32>) {
    let place = |operand: T| match read(operand) {
        Read::Place(place) | Read::Number(_, place) => place,
        Read::Value(value) => values[value as usize],
    };
    match of {
        Operation::Multiply(a, b) if let Some((factor, other)) = factor(*a, *b, read) => {
            let bits = factor.to_bits();
            words.extend([place(other), bits as u32, (bits >> 32) as u32]);
        }
        Operation::Select { switch, negative, positive } => words.extend([*switch, place(*negative), place(*positive)]),
        _ => words.extend(of.operands().into_iter().map(place)),
    }
}

/// Which operations are one batch.
type OperationKind = (Discriminant<Operation<()>>, bool, Option<Function>);

fn kind<T: Copy>(of: &Operation<T>, read: &dyn Fn(T) -> Read) -> OperationKind {
    let is_times = matches!(of, Operation::Multiply(a, b) if factor(*a, *b, read).is_some());
    let function = if let Operation::Call(function, _) = of { Some(*function) } else { None };
    (discriminant(&of.map(|_| ())), is_times, function)
}

/// The operations in their order, batch by batch.
fn order<T: Copy>(operations: &[Operation<T>], read: &dyn Fn(T) -> Read) -> Vec<Vec<usize>> {
    let mut users = vec![Vec::new(); operations.len()];
    let mut missing = vec![0_usize; operations.len()];
    for (index, operation) in operations.iter().enumerate() {
        for operand in operation.operands() {
            if let Read::Value(value) = read(operand) {
                users[value as usize].push(index);
                missing[index] += 1;
            }
        }
    }
    let mut ready: Vec<(OperationKind, Vec<usize>)> = Vec::new();
    let enter = |ready: &mut Vec<(OperationKind, Vec<usize>)>, index: usize| {
        let kind = kind(&operations[index], read);
        match ready.iter_mut().find(|(known, _)| *known == kind) {
            Some((_, of)) => of.push(index),
            None => ready.push((kind, vec![index])),
        }
    };
    (0..operations.len()).filter(|&index| missing[index] == 0).for_each(|index| enter(&mut ready, index));
    let mut batches = Vec::new();
    while let Some((_, most)) = ready.iter_mut().max_by_key(|(_, of)| of.len()).filter(|(_, of)| !of.is_empty()) {
        let mut batch = std::mem::take(most);
        batch.sort_unstable();
        for &user in batch.iter().flat_map(|&of| &users[of]) {
            missing[user] -= 1;
            if missing[user] == 0 {
                enter(&mut ready, user);
            }
        }
        batches.push(batch);
    }
    batches
}
