//! The look of a mechanism, with the places of its quantities on the model's tape.
//!
//! In: a [`Compiled`]. Out: a [`Drawing`].

use crate::expr::Symbol;
use crate::pipeline::Compiled;
use crate::program::Tape;
use crate::source::drawing;
use crate::system::equations::{Quantity, StateEquations};

/// Where a quantity begins among what the tape gives; none where the model does not know it.
pub type Place = Option<usize>;

/// The look of a mechanism.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawing {
    /// Its bodies.
    pub bodies: Vec<Body>,
    /// Named points of the ground.
    pub ground: Vec<drawing::Point<Place>>,
    /// The acceleration of gravity, where there is gravity.
    pub gravity: Option<Place>,
    /// Joints, springs and contacts.
    pub joints: Vec<drawing::Joint<Place>>,
    /// Effort and flow of each bond.
    pub bonds: Vec<[Place; 2]>,
    /// What gives them.
    pub tape: Tape,
}

/// A body.
#[derive(Clone, Debug, PartialEq)]
pub struct Body {
    /// Its look.
    pub look: drawing::Body<Place>,
    /// The states that its position and orientation depend on.
    pub states: Vec<usize>,
}

/// The look of a model.
#[must_use]
pub fn drawing(model: &Compiled) -> Drawing {
    let (shown, tape) = (&model.equations.shown, &model.programs.shown);
    let mut places = tape.places.iter().copied();
    let mut next = || places.next().expect("a place for each quantity");
    let drawing::Drawing { bodies, ground, gravity, joints } = shown.drawing.map(&mut |_| next());
    let bonds = shown.bonds.iter().map(|_| [next(), next()]).collect();
    let bodies = bodies.into_iter().zip(&shown.drawing.bodies).map(|(look, quantities)| {
        let states = states(&model.equations, &[&quantities.position, &quantities.orientation]);
        Body { look, states }
    });
    Drawing { bodies: bodies.collect(), ground, gravity, joints, bonds, tape: tape.clone() }
}

/// The states that quantities depend on.
fn states(equations: &StateEquations, of: &[&Quantity]) -> Vec<usize> {
    let ids: Vec<_> = of.iter().copied().flatten().flatten().copied().collect();
    equations.pool.symbols(&ids).into_iter().filter_map(Symbol::as_state).collect()
}
