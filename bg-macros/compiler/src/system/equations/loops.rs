//! Algebraic loops: bond variables that need each other.
//!
//! In: which variable needs which, as the derivation asks for them. Out: one fault for each set of variables that all need
//! each other, however many circles there are in it.
//! Method: strongly connected components (Tarjan 1972, Depth-first search and linear graph algorithms).

use crate::fault::Fault;

/// What a depth-first search knows of one variable.
#[derive(Clone, Copy, Debug, Default)]
struct Visit {
    /// When it was entered, counted from 1; 0 before.
    entered: usize,
    /// The earliest variable of its component that is known to need it and to be needed by it.
    earliest: usize,
    /// Whether its component is not complete.
    open: bool,
}

/// The search so far. Variables are counted by the caller.
#[derive(Debug)]
pub(super) struct Loops {
    visits: Vec<Visit>,
    open: Vec<usize>,
    entered: usize,
    /// Circles that were closed, each with the variable at which it was.
    circles: Vec<(usize, Fault)>,
}

impl Loops {
    /// Nothing visited.
    pub fn new(variables: usize) -> Self {
        Self { visits: vec![Visit::default(); variables], open: Vec::new(), entered: 0, circles: Vec::new() }
    }

    /// The value of a variable begins to be calculated.
    pub fn enter(&mut self, variable: usize) {
        self.entered += 1;
        self.visits[variable] = Visit { entered: self.entered, earliest: self.entered, open: true };
        self.open.push(variable);
    }

    /// `by` needs a variable that has been entered before.
    pub fn need(&mut self, variable: usize, by: Option<usize>) {
        if let Some(by) = by
            && self.visits[variable].open
        {
            self.visits[by].earliest = self.visits[by].earliest.min(self.visits[variable].entered);
        }
    }

    /// A variable needs itself.
    pub fn circle(&mut self, variable: usize, fault: Fault) {
        self.circles.push((variable, fault));
    }

    /// The value is calculated, for `by`. Where that completes a component with circles, the first of them.
    pub fn leave(&mut self, variable: usize, by: Option<usize>) -> Option<Fault> {
        let visit = self.visits[variable];
        if visit.earliest < visit.entered {
            if let Some(by) = by {
                self.visits[by].earliest = self.visits[by].earliest.min(visit.earliest);
            }
            return None;
        }
        let first = self.open.iter().rposition(|&open| open == variable)?;
        for member in self.open.split_off(first) {
            self.visits[member].open = false;
        }
        // Components complete from the inside: all circles that are left and closed at what is complete are of this one.
        let (of_this, others) =
            std::mem::take(&mut self.circles).into_iter().partition(|(at, _)| !self.visits[*at].open);
        self.circles = others;
        let circles: Vec<(usize, Fault)> = of_this;
        circles.into_iter().next().map(|(_, fault)| fault)
    }
}
