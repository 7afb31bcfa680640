//! Which part of the graph a state belongs to.
//!
//! In: nothing. Out: [`Origin`], by which stages tell states apart; names are for people.

use crate::graph::NodeId;

/// What a state is, and of what.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub enum Origin {
    /// A component of the momentum of an I.
    Momentum(NodeId, usize),
    /// A component of the displacement of a C.
    Displacement(NodeId, usize),
    /// A coordinate of a position; the track's index and the axis.
    Position(usize, usize),
    /// A component of an orientation; the track's index, row and column.
    Orientation(usize, usize, usize),
    /// The angle of an orientation that turns about one axis; the track's index.
    Angle(usize),
    /// The angle that counts turns; its index in the graph.
    Turn(usize),
    /// The angle or the travel of a step of a joint; the track of the orientation that it gives, the step.
    Hinge(usize, usize),
    /// The speed of a step of a joint, in the place of a momentum; the track of the orientation that it turns, the
    /// step.
    Speed(usize, usize),
    /// The displacement of a scalar 1-junction.
    Way(NodeId),
    /// The integral that an output asks for, or a state of the graph's own; its index.
    Integral(usize),
    /// What a memory keeps; its index among the integrals.
    Memory(usize),
}

/// The kind of a state.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
#[expect(missing_docs, reason = "the names are those of the origins")]
pub enum Kind {
    Momentum,
    Displacement,
    Position,
    Orientation,
    Angle,
    Way,
    Integral,
}

impl Origin {
    /// Its kind.
    #[must_use]
    pub fn kind(self) -> Kind {
        match self {
            Self::Momentum(..) | Self::Speed(..) => Kind::Momentum,
            Self::Displacement(..) => Kind::Displacement,
            Self::Position(..) => Kind::Position,
            Self::Orientation(..) => Kind::Orientation,
            Self::Angle(_) => Kind::Angle,
            Self::Turn(_) | Self::Hinge(..) | Self::Way(_) => Kind::Way,
            Self::Integral(_) | Self::Memory(_) => Kind::Integral,
        }
    }

    /// Whether motion in planes across a coordinate axis leaves it constant: that component of a position, and of each
    /// axis of an orientation.
    #[must_use]
    pub fn leaves_plane(self, normal: usize) -> bool {
        match self {
            Self::Position(_, axis) => axis == normal,
            Self::Orientation(_, row, _) => row == normal,
            _ => false,
        }
    }
}

impl Kind {
    /// What stores it, in texts: the element's symbol, or a word.
    #[must_use]
    pub fn storage(self) -> &'static str {
        match self {
            Self::Momentum => "I",
            Self::Displacement => "C",
            Self::Position => "position",
            Self::Orientation => "orientation",
            Self::Angle => "angle",
            Self::Way => "way",
            Self::Integral => "integral",
        }
    }
}
