//! What a friction or a stop acts on: a free axis of a joint, the line of a contact, a junction.
//!
//! In: its name. Out: the junction to bond to, with the units of its domain where that is known.

use super::{Expansion, MechanismFault};
use crate::source::ast::{Contact, Item, Name, ShapeContact, Touching};

/// The units of a domain's laws; empty where the domain is not known.
pub(super) struct Units {
    pub effort: &'static str,
    pub flow: &'static str,
    pub displacement: &'static str,
    pub stiffness: &'static str,
    pub resistance: &'static str,
}

const TRANSLATION: Units = Units { effort: "N", flow: "m/s", displacement: "m", stiffness: "N/m", resistance: "N*s/m" };
const ROTATION: Units =
    Units { effort: "N*m", flow: "rad/s", displacement: "rad", stiffness: "N*m/rad", resistance: "N*m*s/rad" };
const UNKNOWN: Units = Units { effort: "", flow: "", displacement: "", stiffness: "", resistance: "" };

/// A free axis.
pub(super) struct FreeAxis {
    /// The 1-junction of its motion.
    pub junction: String,
    /// Those of its domain.
    pub units: &'static Units,
    /// The joint, if it is one.
    pub joint: Option<String>,
    /// The force that presses where shapes touch, N.
    pub pressed: Option<String>,
    /// Whether it is a plane, in which what touches in space slides: its flow is a vector.
    pub is_plane: bool,
    /// Whether it is that of shapes which do not give way.
    pub is_rigid: bool,
}

impl FreeAxis {
    /// Whether it is known to slide.
    pub fn slides(&self) -> bool {
        self.units.effort == TRANSLATION.effort
    }
}

impl Expansion<'_> {
    /// The axis that a `word` of this name acts on; a joint without one is a fault.
    pub(super) fn free_axis(&mut self, word: &'static str, name: &Name, target: &Name) -> Option<FreeAxis> {
        let axis = self.axis_of(&target.text);
        let (name, target_name) = (name.text.clone(), target.text.clone());
        match &axis {
            None => self.fault(target.span, &MechanismFault::NoFreeAxis { word, name, target: target_name }),
            Some(axis) if axis.is_plane && word != "friction" => {
                self.fault(target.span, &MechanismFault::InSpace { word, name, target: target_name });
                return None;
            }
            Some(_) => {}
        }
        axis
    }

    /// The axis of a target; of a joint that both turns and slides the rotation, unless it is named.
    fn axis_of(&self, target: &str) -> Option<FreeAxis> {
        let (first, axis) = target.split_once('.').map_or((target, None), |(first, axis)| (first, Some(axis)));
        if let Some(joint) = self.joints.get(first) {
            let free = |axis: &str, units| {
                let (junction, joint) = (format!("{first}.{axis}"), Some(first.to_owned()));
                FreeAxis { junction, units, joint, pressed: None, is_plane: false, is_rigid: false }
            };
            let spin = joint.kind.spin().filter(|_| axis != Some("slide")).map(|_| free("spin", &ROTATION));
            return spin
                .or_else(|| joint.kind.slide().filter(|_| axis != Some("spin")).map(|_| free("slide", &TRANSLATION)));
        }
        let of_shapes = |contact: &&ShapeContact| target.strip_suffix(".slide").unwrap_or(target) == contact.name.text;
        if let Some(ShapeContact { name, shapes, rigid, .. }) = self.shape_contacts().find(of_shapes) {
            let (junction, pressed) = (format!("{name}.slide"), Some(format!("{name}.pressed")));
            let is_plane = shapes.iter().any(Touching::is_in_space);
            return Some(FreeAxis { junction, units: &TRANSLATION, joint: None, pressed, is_plane, is_rigid: *rigid });
        }
        let contact = self.contacts().find(|contact| contact.name.text == target);
        let line = contact.map(|contact| format!("{target}.{}", contact.along.letter()));
        let units = if line.is_some() { &TRANSLATION } else { &UNKNOWN };
        let junction = line.unwrap_or_else(|| target.to_owned());
        Some(FreeAxis { junction, units, joint: None, pressed: None, is_plane: false, is_rigid: false })
    }

    fn contacts(&self) -> impl Iterator<Item = &Contact> {
        self.source.items.iter().filter_map(|item| if let Item::Contact(contact) = item { Some(contact) } else { None })
    }

    fn shape_contacts(&self) -> impl Iterator<Item = &ShapeContact> {
        self.source
            .items
            .iter()
            .filter_map(|item| if let Item::ShapeContact(contact) = item { Some(contact) } else { None })
    }

    /// Whether a friction or a stop acts on this junction of an axis.
    pub(super) fn is_braked(&self, junction: &str) -> bool {
        let targets = self.source.items.iter().filter_map(|item| match item {
            Item::Friction(friction) => Some(&friction.target),
            Item::Stop(stop) => Some(&stop.target),
            _ => None,
        });
        targets.filter_map(|target| self.axis_of(&target.text)).any(|axis| axis.junction == junction)
    }
}
