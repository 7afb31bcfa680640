//! Contacts of shapes: what touches pushes, and never pulls.
//!
//! In: `ast::ShapeContact`. Out: the distance of the two shapes as the displacement of a C, which pushes below zero,
//! and an R beside it. The force acts along the normal in the place of one body; what rubs has a junction of its own at
//! the place of contact. Methods: the distance of round and flat shapes is a function of the poses. Where a profile is
//! nearest to the other shape is a displacement q of its own, started where the distance is stationary: that it stays
//! so gives q' as a linear function of the relative velocities (F. Pfeiffer, C. Glocker, Multibody Dynamics with
//! Unilateral Contacts (1996), section 4.2: contour parameters). The force acts along the gradient of the distance by
//! the pose with q moving along, so that the power of the C is exact whatever truncation leaves.

use super::drawing::rounded;
use super::{End, Expansion, MechanismFault};
use crate::fault::near_miss;
use crate::source::ast::{
    Axis, Between, Beyond, Expression, ExpressionKind, Item, Name, ShapeContact, Table, Touching,
};
use crate::source::clause::{Allowed, Clause};

/// What is smooth in the place of a distance from the middle of a hole, beside the play: off by its square.
pub(super) const CENTER: &str = "1e-6";

/// Where and in which direction a contact acts; texts of expressions in inertial axes.
struct Geometry {
    /// The distance of the shapes, m; below zero they touch.
    gap: String,
    /// How the distance changes with the velocity of the second shape's body relative to the first at `place`.
    direction: String,
    /// Where the force of the contact acts.
    place: String,
    /// The normal from the first shape to the second, and the place of contact, for what rubs there.
    normal: String,
    touch: String,
    /// The axis about which the plane of the shapes turns; none of shapes in space.
    plane: Option<String>,
}

/// One side of a contact.
struct Side<'c> {
    shape: &'c Touching,
    end: &'c End,
    /// What the names of its sizes begin with: `CONTACT.first_`.
    sizes: String,
}

impl Side<'_> {
    /// The name of a size.
    fn size(&self, word: &str) -> String {
        format!("{}{word}", self.sizes)
    }

    /// The radius of what is round; 0 of a point.
    fn radius(&self) -> String {
        if matches!(self.shape, Touching::Point) { "0".to_owned() } else { self.size("radius") }
    }
}

impl Expansion<'_> {
    /// Expands a contact of shapes.
    pub(super) fn shape_contact(&mut self, contact: &ShapeContact) {
        let (name, span) = (&contact.name.text, contact.name.span);
        let Some((a, b)) = self.ends(&contact.name, &contact.ends) else { return };
        let ends = [&a, &b];
        let sides: Vec<Side> = (0..2).map(|k| self.side(contact, k, ends[k])).collect();
        let [first, second] = &sides[..] else { return };
        // The first shape is the one whose axes the normal is found in.
        let swapped = first.shape.rank() > second.shape.rank();
        let (first, second) = if swapped { (second, first) } else { (first, second) };
        let clauses = if contact.rigid { Self::rigid_clauses } else { Self::press_clauses };
        if !clauses(self, "contact", &contact.name, &contact.law) {
            return;
        }
        self.text(span, &format!("let {name}.between: m = {} - {};", second.end.position, first.end.position));
        let Some(geometry) = self.geometry(contact, (first, second), if swapped { "-" } else { "" }) else { return };
        self.text(
            span,
            &format!(
                "let {name}.gap: m = {}; let {name}.direction: 1 = {}; let {name}.place: m = {};
                 let {name}.normal: 1 = {}({});",
                geometry.gap,
                geometry.direction,
                geometry.touch,
                if swapped { "-" } else { "" },
                geometry.normal
            ),
        );
        let arms = |place: &str| (a.arm_to(place), b.arm_to(place));
        self.force_junction(span, &format!("{name}.push"), (&a, &b), arms(&geometry.place));
        let sign = if swapped { "-" } else { "" };
        self.text(
            span,
            &format!(
                "1 {name}.approach: translation; MTF {name}.axis(v) = {sign}dot({name}.direction, v);
                 {name}.push.slip -> {name}.axis -> {name}.approach; let {name}.speed: m/s = {name}.approach.flow;"
            ),
        );
        let gap = format!("{name}.gap");
        if contact.rigid {
            self.rigid_press(&contact.name, &contact.law, &gap);
        } else {
            self.press(&contact.name, &contact.law, (name, &gap));
        }
        let slides = self.is_braked(&format!("{name}.slide"));
        let mut force = format!("{name}.push.force");
        if slides {
            self.force_junction(span, &format!("{name}.rub"), (&a, &b), arms(&format!("{name}.place")));
            let (count, sliding) = match &geometry.plane {
                Some(plane) => ("", format!("dot(cross({plane}, {name}.normal), v)")),
                None => ("[3]", format!("v - {name}.normal * dot({name}.normal, v)")),
            };
            self.text(
                span,
                &format!(
                    "1 {name}.slide{count}: translation; MTF {name}.slide_axis(v) = {sliding};
                     {name}.rub.slip -> {name}.slide_axis -> {name}.slide;"
                ),
            );
            force = format!("{force} + {name}.rub.force");
        }
        self.text(span, &format!("let {name}.force = {force};"));
        let place = format!("{name}.place");
        self.draw_joint((&contact.name, "contact".to_owned()), &contact.ends, [&place, &place], false);
        let radii = contact.shapes.each_ref().map(|shape| shape.sizes().first().map(|(word, _)| *word));
        for (index, end) in [&contact.ends.from, &contact.ends.to].into_iter().enumerate() {
            let [own, other] = [index, 1 - index].map(|index| sizes_of(name, index));
            let beside = radii[1 - index].filter(|word| *word == "radius").map(|word| format!("{other}{word}"));
            self.draw_shape(&contact.shapes[index], (end, ends[index]), &own, beside.as_deref());
        }
    }

    /// A side with its sizes bound.
    fn side<'c>(&mut self, contact: &'c ShapeContact, index: usize, end: &'c End) -> Side<'c> {
        let (name, shape) = (&contact.name.text, &contact.shapes[index]);
        let sizes = sizes_of(name, index);
        for (word, value) in shape.sizes() {
            let (what, unit, allowed) = match word {
                "from" | "to" => (format!("the angle after `{word}`"), "rad", Allowed::Any),
                _ => (format!("the {word}"), "m", Allowed::Positive),
            };
            let clause = Clause::new(format!("{what} of the {} of contact `{name}`", shape.word()), 1);
            self.bind(&format!("{sizes}{word}"), unit, value, clause.allowed(allowed));
        }
        if let Touching::Arc([.., to]) = shape {
            let clause = Clause::new(format!("the angle of the arc of contact `{name}`, `to` minus `from`,"), 1);
            let clause = clause.allowed(Allowed::Positive);
            self.text_as(to.span, &format!("let {sizes}opening: rad = {sizes}to - {sizes}from;"), &clause);
        }
        Side { shape, end, sizes }
    }

    /// How two shapes meet, the first of which has the axes; `sign` turns what the second body does against the first
    /// into what the contact's second does. None with a fault.
    fn geometry(&mut self, contact: &ShapeContact, (first, second): (&Side, &Side), sign: &str) -> Option<Geometry> {
        use Touching as T;
        let name = &contact.name.text;
        match (first.shape, second.shape) {
            (T::Profile(table), T::Point | T::Circle(_)) => {
                let polar = self.profile(contact, table)?;
                Some(self.round_on_profile(contact, (first, second), polar, sign))
            }
            (T::Profile(table), T::Line(axis)) => {
                let polar = self.profile(contact, table)?;
                let normal = self.line_normal(contact, &second.end.axes, *axis)?;
                Some(self.flat_on_profile(contact, (first, second), (polar, normal)))
            }
            (T::Line(axis), T::Point | T::Circle(_)) => {
                let normal = self.line_normal(contact, &first.end.axes, *axis)?;
                Some(on_flat(name, second, normal, Some(plane_of(first))))
            }
            (T::Segment(axis, _), T::Circle(_)) | (T::Slot(axis, _), T::Point | T::Circle(_)) => {
                let normal = self.line_normal(contact, &first.end.axes, *axis)?;
                Some(self.round_at_segment(contact, (first, second), (*axis, normal)))
            }
            (T::Arc(_), T::Circle(_)) => Some(self.round_at_arc(contact, (first, second))),
            (T::Segment(..) | T::Arc(_), T::Point) => {
                let (name, word) = (name.clone(), first.shape.word());
                self.fault(contact.name.span, &MechanismFault::Thin { name, word });
                None
            }
            (T::Plane(axis), T::Point | T::Sphere(_)) => {
                let normal = format!("{}.{}_axis", first.end.axes, axis.letter());
                Some(on_flat(name, second, normal, None))
            }
            (T::Hole(_), T::Sphere(_)) | (T::Sphere(_), T::Point | T::Sphere(_)) => {
                Some(self.round(contact, (first, second), None))
            }
            (T::Hole(_), T::Point | T::Circle(_)) | (T::Circle(_), T::Point | T::Circle(_)) => {
                Some(self.round(contact, (first, second), Some(plane_of(first))))
            }
            (one, other) => {
                let [one, other] = [one, other].map(Touching::word);
                self.fault(contact.name.span, &MechanismFault::ShapesApart { name: name.clone(), one, other });
                None
            }
        }
    }

    /// The outward normal of a line along an axis: to its left, seen from where z points to.
    fn line_normal(&mut self, contact: &ShapeContact, axes: &str, axis: Axis) -> Option<String> {
        match axis {
            Axis::X => Some(format!("{axes}.y_axis")),
            Axis::Y => Some(format!("(-{axes}.x_axis)")),
            Axis::Z => {
                let name = contact.name.text.clone();
                self.fault(contact.name.span, &MechanismFault::LineAcross { name });
                None
            }
        }
    }

    /// Two round shapes, in a plane or in space.
    fn round(&mut self, contact: &ShapeContact, (first, second): (&Side, &Side), plane: Option<String>) -> Geometry {
        let (name, span) = (&contact.name.text, contact.name.span);
        let is_inside = matches!(first.shape, Touching::Hole(_));
        let [inner, outer] = [second.radius(), first.radius()];
        let smooth = if is_inside { format!(" + pow({CENTER} * ({outer} - {inner}), 2)") } else { String::new() };
        let (off, across) = match &plane {
            Some(z) => (format!(" - pow(dot({z}, {name}.between), 2)"), format!(" - {z} * dot({z}, {name}.between)")),
            None => (String::new(), String::new()),
        };
        self.text(
            span,
            &format!(
                "let {name}.distance: m = sqrt(dot({name}.between, {name}.between){off}{smooth});
                 let {name}.apart: 1 = ({name}.between{across}) / {name}.distance;"
            ),
        );
        let play = format!("({outer} - {inner})");
        let gap = format!("{name}.distance - ({outer} + {inner})");
        let geometry = around(name, (first, second), if is_inside { Some(&play) } else { None });
        Geometry { plane, gap: if is_inside { geometry.gap } else { gap }, ..geometry }
    }

    /// A circle at a thin wall of finite length, or what is in a slot around one.
    fn round_at_segment(
        &mut self,
        contact: &ShapeContact,
        (first, second): (&Side, &Side),
        (axis, across): (Axis, String),
    ) -> Geometry {
        let (name, span) = (&contact.name.text, contact.name.span);
        let (along, length) = (format!("{}.{}_axis", first.end.axes, axis.letter()), first.size("length"));
        let play = format!("({} / 2 - {})", first.size("width"), second.radius());
        let is_inside = matches!(first.shape, Touching::Slot(..));
        let smooth = if is_inside { format!(" + pow({CENTER} * {play}, 2)") } else { String::new() };
        self.text(
            span,
            &format!(
                "let {name}.lengthwise: m = dot({along}, {name}.between);
                 let {name}.across: m = dot({across}, {name}.between);
                 let {name}.past: m = if {name}.lengthwise < 0 {{ {name}.lengthwise }} else {{
                     if {name}.lengthwise > {length} {{ {name}.lengthwise - {length} }} else {{ 0 }} }};
                 let {name}.distance: m = sqrt({name}.past * {name}.past + {name}.across * {name}.across{smooth});
                 let {name}.apart: 1 = ({along} * {name}.past + {across} * {name}.across) / {name}.distance;"
            ),
        );
        around(name, (first, second), if is_inside { Some(&play) } else { None })
    }

    /// A circle at a thin wall that is a part of a circle: at its inside, its outside or its ends.
    fn round_at_arc(&mut self, contact: &ShapeContact, (first, second): (&Side, &Side)) -> Geometry {
        let (name, span) = (&contact.name.text, contact.name.span);
        let axes = &first.end.axes;
        let [radius, from, to, opening] = ["radius", "from", "to", "opening"].map(|word| first.size(word));
        // In axes whose first one points to the middle of the arc.
        self.text(
            span,
            &format!(
                "let {name}.middle: rad = 0.5 * ({from} + {to}); let {name}.half: rad = 0.5 * {opening};
                 let {name}.ahead: 1 = {axes}.x_axis * cos({name}.middle) + {axes}.y_axis * sin({name}.middle);
                 let {name}.aside: 1 = {axes}.y_axis * cos({name}.middle) - {axes}.x_axis * sin({name}.middle);
                 let {name}.cx: m = dot({name}.ahead, {name}.between); let {name}.cy: m = dot({name}.aside, \
                 {name}.between);
                 let {name}.far: m = sqrt({name}.cx * {name}.cx + {name}.cy * {name}.cy + pow({CENTER} * {radius}, 2));
                 let {name}.past: m = {name}.far * cos({name}.half) - {name}.cx;
                 let {name}.end: m = if {name}.cy < 0 {{ -{radius} * sin({name}.half) }} else {{ {radius} * \
                 sin({name}.half) }};
                 let {name}.out: 1 = ({name}.far - {radius}) / {name}.far;
                 let {name}.ux: m = if {name}.past < 0 {{ {name}.cx * {name}.out }} else {{ {name}.cx - {radius} * \
                 cos({name}.half) }};
                 let {name}.uy: m = if {name}.past < 0 {{ {name}.cy * {name}.out }} else {{ {name}.cy - {name}.end }};
                 let {name}.distance: m = sqrt(if {name}.past < 0 {{ pow({name}.far - {radius}, 2) }}
                     else {{ {name}.ux * {name}.ux + {name}.uy * {name}.uy }});
                 let {name}.apart: 1 = ({name}.ahead * {name}.ux + {name}.aside * {name}.uy) / {name}.distance;"
            ),
        );
        around(name, (first, second), None)
    }

    /// The table of a profile; whether it is one of an angle. None with a fault.
    fn profile(&mut self, contact: &ShapeContact, profile: &Name) -> Option<Polar> {
        let Some(Table { between, beyond, .. }) = self.table(profile) else {
            let near = self.source.items.iter().filter_map(|item| match item {
                Item::Table(table) => Some(table.name.text.as_str()),
                _ => None,
            });
            let near = near_miss(&profile.text, near).map(str::to_owned);
            self.fault(profile.span, &MechanismFault::UnknownTable { name: profile.text.clone(), near });
            return None;
        };
        let is_angle = self.is_outline(profile);
        let table = profile.text.clone();
        if *between == Between::Straight {
            self.fault(profile.span, &MechanismFault::RoughProfile { table, contact: contact.name.text.clone() });
            return None;
        }
        if is_angle && *beyond != Beyond::Periodic {
            self.fault(profile.span, &MechanismFault::OpenProfile { table, contact: contact.name.text.clone() });
            return None;
        }
        Some(Polar { table, is_angle })
    }

    /// The table of this name.
    fn table(&self, name: &Name) -> Option<&Table> {
        self.source.items.iter().find_map(|item| match item {
            Item::Table(table) if table.name.text == name.text => Some(table),
            _ => None,
        })
    }

    /// Whether a profile goes around the point of its end: its argument is an angle.
    fn is_outline(&self, profile: &Name) -> bool {
        let unit = self.table(profile).and_then(|table| table.argument.meaning());
        unit.is_some_and(|unit| unit.dimension == bg_units::Dimension::NONE)
    }

    /// Places of a profile, m, in the axes of its end, as far as the eye can tell.
    pub(super) fn outline(&self, profile: &Name) -> Vec<[f64; 2]> {
        let Some(Table { argument, value, points, .. }) = self.table(profile) else { return Vec::new() };
        let scales = [argument, value].map(|unit| unit.meaning().map_or(1.0, |unit| unit.size()));
        let rows = if let ExpressionKind::Vector(rows) = &points.kind { &rows[..] } else { &[] };
        let knot = |row: &Expression| {
            let ExpressionKind::Vector(pair) = &row.kind else { return None };
            Some([pair.first()?.number()? * scales[0], pair.get(1)?.number()? * scales[1]])
        };
        let is_angle = self.is_outline(profile);
        let place = |[at, of]: [f64; 2]| if is_angle { [of * at.cos(), of * at.sin()] } else { [at, of] };
        rounded(&rows.iter().filter_map(knot).collect::<Vec<_>>()).into_iter().map(place).collect()
    }

    /// A profile at the displacement q: its point p, p' and p'' in the axes of its body, `NAME.px` and so on.
    fn curve(&mut self, contact: &ShapeContact, Polar { table, is_angle }: &Polar) {
        let (name, span) = (&contact.name.text, contact.name.span);
        let q = format!("{name}.along.q");
        let [value, slope, bend] = ["", ".derivative", ".second_derivative"].map(|of| format!("{table}{of}({q})"));
        self.text(span, &format!("let {name}.h0 = {value}; let {name}.h1 = {slope}; let {name}.h2 = {bend};"));
        let curve = if *is_angle {
            format!(
                "let {name}.cosine: 1 = cos({q}); let {name}.sine: 1 = sin({q});
                 let {name}.px = {name}.h0 * {name}.cosine; let {name}.py = {name}.h0 * {name}.sine;
                 let {name}.tx = {name}.h1 * {name}.cosine - {name}.py;
                 let {name}.ty = {name}.h1 * {name}.sine + {name}.px;
                 let {name}.kx = {name}.h2 * {name}.cosine - 2 * {name}.h1 * {name}.sine - {name}.px;
                 let {name}.ky = {name}.h2 * {name}.sine + 2 * {name}.h1 * {name}.cosine - {name}.py;"
            )
        } else {
            format!(
                "let {name}.px = {q}; let {name}.py = {name}.h0; let {name}.tx: 1 = 1; let {name}.ty = {name}.h1;
                 let {name}.kx: 1/m = 0; let {name}.ky = {name}.h2;"
            )
        };
        self.text(span, &curve);
    }

    /// The displacement q, whose rate is `rate` of the flow of `slip`; it starts where `stationary` (m) is zero, from
    /// `guess` on.
    fn along(
        &mut self,
        contact: &ShapeContact,
        is_angle: bool,
        (slip, rate): (&str, &str),
        (stationary, guess): (&str, &str),
    ) {
        let (name, domain) = (&contact.name.text, if is_angle { "rotation" } else { "translation" });
        self.text(
            contact.name.span,
            &format!(
                "1 {name}.roll: {domain}; MTF {name}.roll_axis(v) = {rate};
                 {slip} -> {name}.roll_axis -> {name}.roll;
                 C {name}.along(q) = 0 * q start guess({guess}) energy 0 * q * q; {name}.roll -> {name}.along;
                 let {name}.at{} = {name}.along.q; close {name} = {stationary};",
                if is_angle { ": rad" } else { ": m" }
            ),
        );
    }

    /// A roller, or the point of a follower, on a profile.
    fn round_on_profile(
        &mut self,
        contact: &ShapeContact,
        (first, second): (&Side, &Side),
        polar: Polar,
        sign: &str,
    ) -> Geometry {
        let (name, span) = (&contact.name.text, contact.name.span);
        let axes = &first.end.axes;
        self.curve(contact, &polar);
        // The normal is to the right of the way along a profile about a centre, to the left of one along a line.
        let side = if polar.is_angle { "" } else { "-" };
        self.text(
            span,
            &format!(
                "let {name}.cx: m = dot({axes}.x_axis, {name}.between);
                 let {name}.cy: m = dot({axes}.y_axis, {name}.between);
                 let {name}.ux = {name}.cx - {name}.px; let {name}.uy = {name}.cy - {name}.py;
                 let {name}.size = sqrt({name}.tx * {name}.tx + {name}.ty * {name}.ty);
                 let {name}.nx = {side}{name}.ty / {name}.size; let {name}.ny = -({side}{name}.tx) / {name}.size;
                 let {name}.bend = {name}.tx * {name}.kx + {name}.ty * {name}.ky;
                 let {name}.turning = {side}(({name}.ky * {name}.ux - {name}.kx * {name}.uy) / {name}.size
                     - ({name}.ty * {name}.ux - {name}.tx * {name}.uy) * {name}.bend / pow({name}.size, 3));
                 let {name}.curved = {name}.tx * {name}.tx + {name}.ty * {name}.ty
                     - ({name}.ux * {name}.kx + {name}.uy * {name}.ky);
                 let {name}.tangent = {axes}.x_axis * {name}.tx + {axes}.y_axis * {name}.ty;
                 let {name}.upright = {axes}.x_axis * {name}.nx + {axes}.y_axis * {name}.ny;"
            ),
        );
        let guess = if polar.is_angle { format!("atan2({name}.cy, {name}.cx)") } else { format!("{name}.cx") };
        let stationary = format!("({name}.ux * {name}.tx + {name}.uy * {name}.ty) / {name}.size");
        let rate = format!("{sign}dot({name}.tangent, v) / {name}.curved");
        self.along(contact, polar.is_angle, (&format!("{name}.push.slip"), &rate), (&stationary, &guess));
        let place = second.end.position.clone();
        Geometry {
            gap: format!("{name}.nx * {name}.ux + {name}.ny * {name}.uy - {}", second.radius()),
            direction: format!("{name}.upright + {name}.tangent * ({name}.turning / {name}.curved)"),
            normal: format!("{name}.upright"),
            touch: format!("{place} - {} * {name}.upright", second.radius()),
            place,
            plane: Some(plane_of(first)),
        }
    }

    /// A flat follower on a profile.
    fn flat_on_profile(
        &mut self,
        contact: &ShapeContact,
        (first, second): (&Side, &Side),
        (polar, normal): (Polar, String),
    ) -> Geometry {
        let (name, span) = (&contact.name.text, contact.name.span);
        let axes = &first.end.axes;
        self.curve(contact, &polar);
        self.text(
            span,
            &format!(
                "let {name}.tangent = {axes}.x_axis * {name}.tx + {axes}.y_axis * {name}.ty;
                 let {name}.bend = {axes}.x_axis * {name}.kx + {axes}.y_axis * {name}.ky;
                 let {name}.top = {axes}.x_axis * {name}.px + {axes}.y_axis * {name}.py;
                 let {name}.slope = dot({normal}, {name}.tangent); let {name}.curved = dot({normal}, {name}.bend);
                 0 {name}.angular[3]: rotation; 1 {name}.twist[3]: rotation; {name}.twist -> {name}.angular;
                 {}.rotation -> {name}.angular -> {}.rotation;",
                first.end.body, second.end.body
            ),
        );
        let guess = if polar.is_angle {
            format!("atan2(-dot({normal}, {axes}.y_axis), -dot({normal}, {axes}.x_axis))")
        } else {
            format!("dot({axes}.x_axis, {name}.between)")
        };
        let stationary = format!("{name}.slope / norm({name}.tangent) * (1 m)");
        let rate = format!("dot(cross({name}.tangent, {normal}), v) / {name}.curved");
        self.along(contact, polar.is_angle, (&format!("{name}.twist"), &rate), (&stationary, &guess));
        let place = format!("{} + {name}.top - {name}.tangent * ({name}.slope / {name}.curved)", first.end.position);
        Geometry {
            gap: format!("dot({normal}, {name}.top - {name}.between)"),
            direction: format!("(-{normal})"),
            normal: format!("(-{normal})"),
            touch: place.clone(),
            place,
            plane: Some(plane_of(first)),
        }
    }
}

/// What the names of the sizes of a contact's first or second shape begin with.
fn sizes_of(contact: &str, index: usize) -> String {
    format!("{contact}.{}_", ["first", "second"][index])
}

/// The table of a profile.
struct Polar {
    table: String,
    /// Whether its argument is an angle, so that the profile goes around the point.
    is_angle: bool,
}

/// What is round beside what it has the distance `NAME.distance` from, in the direction `NAME.apart`; or inside of what
/// is as far around it as `play`.
fn around(name: &str, (first, second): (&Side, &Side), play: Option<&str>) -> Geometry {
    let (place, radius) = (second.end.position.clone(), second.radius());
    let (gap, direction) = match play {
        Some(play) => (format!("{play} - {name}.distance"), format!("(-{name}.apart)")),
        None => (format!("{name}.distance - {radius}"), format!("{name}.apart")),
    };
    let touch = format!("{place} - {radius} * {direction}");
    Geometry { gap, direction: direction.clone(), place, normal: direction, touch, plane: Some(plane_of(first)) }
}

/// What is round on what is flat.
fn on_flat(name: &str, second: &Side, normal: String, plane: Option<String>) -> Geometry {
    let place = second.end.position.clone();
    Geometry {
        gap: format!("dot({normal}, {name}.between) - {}", second.radius()),
        direction: normal.clone(),
        touch: format!("{place} - {} * {normal}", second.radius()),
        normal,
        place,
        plane,
    }
}

/// The axis about which the plane of a shape turns.
fn plane_of(side: &Side) -> String {
    format!("{}.z_axis", side.end.axes)
}
