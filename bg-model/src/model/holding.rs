//! What joints hold: the motions, how they are stored, and what is wrong with them.
//!
//! In: nothing. Out: the tables that generated code fills, and the sentences of joints that are torn apart or hold the
//! same.

use alloc::format;
use alloc::string::String;
use alloc::vec::Vec;

/// The largest relative flow of a joint that fits, as a part of what sources and all kinetic energy could move there.
pub const FITTING: f64 = 1e-9;

/// A motion that a joint holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slip {
    /// The joint's name.
    pub joint: &'static str,
    /// `in x`, `about x` and so on; empty where there is only one direction.
    pub direction: &'static str,
    /// The unit of the relative flow, `m/s` or `rad/s` of a mechanism.
    pub unit: &'static str,
}

/// What the joints of a system hold.
///
/// [`Joints::hold`](crate::capability::Joints::hold) writes, one after the other: the flow of each rigid motion, the
/// flow of each compliant one, the gap of each rigid motion (its integral as the poses have it, 0 where they do not),
/// its mobility (how much one unit of its reaction changes the rate of its flow while no other joint holds anything:
/// A_ii where no rows are solved), the lower triangle of the symmetric matrix A by rows (1, 2, 3 ... numbers), and for
/// each reaction how much one unit of it changes the rate of each moved state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Held {
    /// The motions that rigid joints hold, each with a reaction.
    pub rigid: &'static [Slip],
    /// Those that compliant joints hold, of the joints that a guessed start velocity moves.
    pub compliant: &'static [Slip],
    /// The indices of the states that reactions change: momenta.
    pub moved: &'static [usize],
    /// The indices of the states of the pose: positions, orientations, displacements.
    pub pose: &'static [usize],
    /// Those of them that are orientations or angles.
    pub turning: &'static [usize],
    /// The rigid motions of joints that close loops, which may follow from others: the row, and its place in
    /// [`Joints::kept`](crate::capability::Joints::kept).
    pub closing: &'static [(usize, usize)],
    /// Whether sources give flows, so that something moves, or is to move, where [`Held::moved`] is zero.
    pub is_driven: bool,
}

impl Held {
    /// No joint holds anything.
    pub const NOTHING: Self =
        Self { rigid: &[], compliant: &[], moved: &[], pose: &[], turning: &[], closing: &[], is_driven: false };

    /// How many numbers [`Joints::hold`](crate::capability::Joints::hold) writes.
    #[must_use]
    pub const fn entries(&self) -> usize {
        let reactions = self.rigid.len();
        3 * reactions + self.compliant.len() + reactions * (reactions + 1) / 2 + reactions * self.moved.len()
    }

    /// These numbers by what they are.
    ///
    /// # Panics
    /// There are not as many as [`Held::entries`].
    #[must_use]
    pub fn read<'a, S>(&self, entries: &'a [S]) -> HeldNow<'a, S> {
        let reactions = self.rigid.len();
        let (flows, rest) = entries.split_at(reactions + self.compliant.len());
        let (gaps, rest) = rest.split_at(reactions);
        let (mobilities, rest) = rest.split_at(reactions);
        let (lower, moves) = rest.split_at(reactions * (reactions + 1) / 2);
        HeldNow { flows, gaps, mobilities, lower, moves }
    }
}

/// The numbers of [`Held`] at one state.
#[derive(Clone, Copy, Debug)]
pub struct HeldNow<'a, S> {
    /// The flows of rigid motions, then of compliant ones.
    pub flows: &'a [S],
    /// The gaps of rigid motions.
    pub gaps: &'a [S],
    /// Their mobilities.
    pub mobilities: &'a [S],
    /// The lower triangle of A by rows.
    pub lower: &'a [S],
    /// What one unit of each reaction changes, state by state of [`Held::moved`].
    pub moves: &'a [S],
}

/// A stop that gives back a part of the speed with which something hits it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stop {
    /// Its name.
    pub name: &'static str,
    /// The unit of the flow towards it.
    pub unit: &'static str,
    /// Its switch, negative while something is clear of it. The guard then is how far its end is passed.
    pub switch: usize,
}

/// The stops of a system, and what impulses change.
///
/// [`Impacts::impact`](crate::capability::Impacts::impact) writes, one after the other: the flow of each rigid motion
/// and of each stop, positive towards it; of each stop the restitution, the speed of a rebound below which something
/// rests on it (-1 where the accuracy of the run decides), and the rate of its flow; the mobility of each rigid motion;
/// the lower triangle of the symmetric, negative definite matrix A by rows, where impulses L change the flows by A L;
/// and for each row by how much one unit of its impulse changes the moved states, then the integrals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stops {
    /// How many motions rigid joints hold: the first rows.
    pub rigid: usize,
    /// Those of them that may follow from others, each with its place in
    /// [`Impacts::kept`](crate::capability::Impacts::kept).
    pub closing: &'static [(usize, usize)],
    /// The stops: the rows after those.
    pub stops: &'static [Stop],
    /// The momenta that impulses change.
    pub moved: &'static [usize],
    /// The integrals that go along.
    pub integrals: &'static [usize],
}

impl Stops {
    /// How many rows there are.
    #[must_use]
    pub const fn rows(&self) -> usize {
        self.rigid + self.stops.len()
    }

    /// How many numbers [`Impacts::impact`](crate::capability::Impacts::impact) writes.
    #[must_use]
    pub const fn entries(&self) -> usize {
        let rows = self.rows();
        let moves = rows * (self.moved.len() + self.integrals.len());
        rows + 3 * self.stops.len() + self.rigid + rows * (rows + 1) / 2 + moves
    }
}

/// A joint that is torn apart.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Slipping {
    /// What it should hold.
    pub slip: Slip,
    /// How fast it moves, in the slip's unit.
    pub speed: f64,
    /// Whether it is a rigid joint.
    pub is_rigid: bool,
}

impl core::fmt::Display for Slipping {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Slip { joint, direction, unit } = self.slip;
        let how = match unit {
            "m/s" => "is torn apart at",
            "rad/s" => "is twisted at",
            _ => "misses its flow by",
        };
        let space = if direction.is_empty() { "" } else { " " };
        write!(f, "`{joint}` {how} {} {unit}{space}{direction}", Short(self.speed))
    }
}

/// A number to five digits.
struct Short(f64);

impl core::fmt::Display for Short {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let rounded = format!("{:.4e}", self.0).parse::<f64>().unwrap_or(self.0);
        write!(f, "{rounded:?}")
    }
}

/// Rigid joints that hold the same motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Redundancy {
    /// The joint that holds nothing more.
    pub joint: &'static str,
    /// The directions in which it does so; empty where it has only one.
    pub directions: Vec<&'static str>,
    /// The joints that hold these motions already; none where nothing could move anyway.
    pub others: Vec<&'static str>,
}

impl core::fmt::Display for Redundancy {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        let Self { joint, directions, others } = self;
        let space = if directions.is_empty() { "" } else { " " };
        let directions = format!("{space}{}", directions.join(", "));
        if others.is_empty() {
            return write!(f, "rigid joint `{joint}` holds{directions} what cannot move anyway");
        }
        let others: Vec<String> = others.iter().map(|name| format!("`{name}`")).collect();
        let (word, verb) = if others.len() == 1 { ("joint", "holds") } else { ("joints", "hold") };
        let others = others.join(", ");
        write!(f, "rigid joint `{joint}` holds{directions} what rigid {word} {others} {verb} already")
    }
}
