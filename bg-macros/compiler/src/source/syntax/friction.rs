//! The words of what acts on one junction: friction, stop, orifice.
//!
//! In: statements of a graph. Out: their [`Item`](crate::source::ast::Item)s.

use super::cursor::{Block, Cursor, Parsed};
use crate::source::ast::{Friction, Name, Orifice, Stop};

/// The block of a friction.
pub(super) const FRICTION: Block = Block {
    name: "a friction",
    words: &["coulomb", "static", "stribeck", "viscous", "normal", "radius", "creep", "stiffness"],
    list: false,
};

/// The block of a stop.
pub(super) const STOP: Block = Block {
    name: "a stop",
    words: &["at least", "at most", "stiffness", "damping", "restitution", "rest below", "start"],
    list: false,
};

/// The block of an orifice.
pub(super) const ORIFICE: Block =
    Block { name: "an orifice", words: &["area", "coefficient", "density", "laminar"], list: false };

impl Cursor<'_> {
    /// `friction NAME on TARGET { ... }`
    pub fn friction(&mut self) -> Parsed<Friction> {
        let (name, target) = self.named_on("the friction")?;
        let mut friction = Friction::new(name, target);
        self.block_or_semicolon(&FRICTION, |entry| {
            entry.setting(&mut [
                ("coulomb", &mut friction.coulomb),
                ("static", &mut friction.at_rest),
                ("stribeck", &mut friction.stribeck),
                ("viscous", &mut friction.viscous),
                ("normal", &mut friction.normal),
                ("radius", &mut friction.radius),
                ("creep", &mut friction.creep),
                ("stiffness", &mut friction.stiffness),
            ])
        });
        Ok(friction)
    }

    /// `stop NAME on TARGET { ... }`
    pub fn stop(&mut self) -> Parsed<Stop> {
        let (name, target) = self.named_on("the stop")?;
        let mut stop = Stop::new(name, target);
        self.block_or_semicolon(&STOP, |entry| {
            entry.setting(&mut [
                ("at least", &mut stop.least),
                ("at most", &mut stop.most),
                ("stiffness", &mut stop.stiffness),
                ("damping", &mut stop.damping),
                ("restitution", &mut stop.restitution),
                ("rest below", &mut stop.rest),
                ("start", &mut stop.start),
            ])
        });
        Ok(stop)
    }

    /// `orifice NAME on JUNCTION { ... }`
    pub fn orifice(&mut self) -> Parsed<Orifice> {
        let (name, target) = self.named_on("the orifice")?;
        let mut orifice = Orifice { name, target, area: None, coefficient: None, density: None, laminar: None };
        self.block_or_semicolon(&ORIFICE, |entry| {
            entry.setting(&mut [
                ("area", &mut orifice.area),
                ("coefficient", &mut orifice.coefficient),
                ("density", &mut orifice.density),
                ("laminar", &mut orifice.laminar),
            ])
        });
        Ok(orifice)
    }

    /// `WORD NAME on TARGET`
    fn named_on(&mut self, what: &'static str) -> Parsed<(Name, Name)> {
        self.advance();
        let name = self.plain_name(what)?;
        self.expect_word("on")?;
        Ok((name, self.name("what it acts on")?))
    }
}
