//! A rigid body: two 1-junctions with their inertias, its pose, its points.
//!
//! In: `ast::Body`. Out: bond-graph words. Momenta and the tensor are in inertial axes; the tensor turns with the body.

use super::{Expansion, MechanismFault, ORIGIN, is_among, is_vector, unknown_point};
use crate::source::ast::{Axis, Body, Expression, ExpressionKind, Name, Shape, Solid};
use crate::source::clause::{Allowed, Clause, Given};

impl Expansion<'_> {
    /// Expands a body.
    pub(super) fn body(&mut self, body: &Body) {
        let (name, span) = (&body.name.text, body.name.span);
        let given = body.mass.is_some() || body.inertia.is_some() || body.center.is_some();
        match (body.solids.is_empty(), given) {
            (true, true) => self.given_mass(body),
            (false, false) => self.mass_of_parts(body),
            (true, false) => self.fault(span, &MechanismFault::NoMass { name: name.clone() }),
            (false, true) => self.fault(span, &MechanismFault::MassTwice { name: name.clone() }),
        }
        self.points(body);
        self.start(body);
        self.text(
            span,
            &format!(
                "1 {name}.translation[3]: translation; 1 {name}.rotation[3]: rotation;
                 position {name}.position of {name}.translation start {name}.start.position;
                 orientation {name}.orientation of {name}.rotation start {name}.start.orientation;
                 I {name}.linear = {name}.mass start {name}.mass * {name}.start.velocity;
                 I {name}.angular = {name}.tensor in {name}.orientation start {name}.start.orientation *
                     ({name}.tensor * (transpose({name}.start.orientation) * {name}.start.spin));
                 {name}.translation -> {name}.linear; {name}.rotation -> {name}.angular;
                 let {name}.velocity = {name}.translation.flow; let {name}.angular_velocity: rad/s = \
                 {name}.rotation.flow;
                 let {name}.momentum = {name}.linear.p; let {name}.angular_momentum = {name}.angular.p;
                 let {name}.p = {name}.linear.p; let {name}.h = {name}.angular.p;
                 let {name}.kinetic_energy: J = {name}.linear.energy + {name}.angular.energy;
                 let {name}.direction: rad = atan2({name}.x_axis.y, {name}.x_axis.x);
                 let {name}.angle: rad = unwrapped({name}.x_axis.y, {name}.x_axis.x, {name}.angular_velocity.z);"
            ),
        );
        for (axis, unit) in Axis::ALL.into_iter().zip(["[1, 0, 0]", "[0, 1, 0]", "[0, 0, 1]"]) {
            self.text(span, &format!("let {name}.{}_axis: 1 = {name}.orientation * {unit};", axis.letter()));
        }
        if self.has_gravity {
            self.text(
                span,
                &format!("Se {name}.weight = {name}.mass * gravity_field; {name}.weight -> {name}.translation;"),
            );
        }
    }

    fn given_mass(&mut self, body: &Body) {
        let (name, span) = (&body.name.text, body.name.span);
        let missing = |clause| MechanismFault::MissingClause {
            word: "body",
            name: name.clone(),
            clause,
            why: "given mass properties are its mass and its inertia",
        };
        match (&body.mass, &body.inertia) {
            (Some(mass), Some(inertia)) => {
                self.bind(&format!("{name}.mass"), "kg", mass, mass_of(name));
                let principal = matches!(&inertia.kind, ExpressionKind::Vector(parts) if !parts.iter().any(is_vector));
                let clause = Clause::new(format!("the inertia of body `{name}`"), if principal { 3 } else { 9 });
                let clause = clause.allowed(Allowed::Inertia);
                if principal {
                    self.bind(&format!("{name}.moments"), "kg*m^2", inertia, clause);
                    let tensor = format!("let {name}.tensor = diagonal({name}.moments);");
                    self.text_as(inertia.span, &tensor, &tensor_of(name));
                } else {
                    self.bind(&format!("{name}.tensor"), "kg*m^2", inertia, clause);
                }
            }
            (None, _) => self.fault(span, &missing("mass")),
            (_, None) => self.fault(span, &missing("inertia")),
        }
        if let Some(density) = &body.density {
            let why = "its mass is given";
            let (word, name) = ("body", name.clone());
            self.fault(density.span, &MechanismFault::SuperfluousClause { word, name, clause: "density", why });
        }
        match &body.center {
            Some(center) => {
                let clause = Clause::new(format!("the center of body `{name}`"), 3);
                self.bind(&format!("{name}.center"), "m", center, clause);
            }
            None => self.text(span, &format!("let {name}.center: m = [0, 0, 0];")),
        }
    }

    /// Sum of the solids: mass, centre, and tensor about the centre (Steiner).
    fn mass_of_parts(&mut self, body: &Body) {
        let (name, span) = (&body.name.text, body.name.span);
        if let Some(density) = &body.density {
            let clause = Clause::new(format!("the density of body `{name}`"), 1).allowed(Allowed::NotNegative);
            self.bind(&format!("{name}.density"), "kg/m^3", density, clause);
        }
        let parts: Vec<String> = (1..=body.solids.len()).map(|k| format!("{name}.part{k}")).collect();
        for (index, (part, label)) in body.solids.iter().zip(&parts).enumerate() {
            self.part(body, part, label, &format!("part {} of body `{name}`", index + 1));
        }
        let sum = |term: &dyn Fn(&String) -> String| parts.iter().map(term).collect::<Vec<_>>().join(" + ");
        let masses = sum(&|part| format!("{part}.mass"));
        let moments = sum(&|part| format!("{part}.mass * {part}.place"));
        let tensors = sum(&|part| {
            format!(
                "{part}.tensor + {part}.mass * (dot({part}.offset, {part}.offset) * identity() - \
                 outer({part}.offset, {part}.offset))"
            )
        });
        // Solids of densities and edges that are not negative, some of them with a mass, have an inertia that can be.
        self.text_as(span, &format!("let {name}.mass: kg = {masses};"), &mass_of(name).allowed(Allowed::Total));
        self.text(span, &format!("let {name}.center: m = ({moments}) / {name}.mass;"));
        self.text_as(span, &format!("let {name}.tensor: kg*m^2 = {tensors};"), &tensor_of(name));
        for part in &parts {
            self.text(span, &format!("let {part}.offset: m = {part}.place - {name}.center;"));
        }
    }

    /// One solid; `words` name it.
    fn part(&mut self, body: &Body, part: &Solid, label: &str, words: &str) {
        let (name, span) = (&body.name.text, part.span);
        let size = |what: &str, components| {
            Clause::new(format!("the {what} of {words}"), components).allowed(Allowed::NotNegative)
        };
        match (&part.density, &body.density) {
            (Some(density), _) => self.bind(&format!("{label}.density"), "kg/m^3", density, size("density", 1)),
            (None, Some(_)) => self.text(span, &format!("let {label}.density = {name}.density;")),
            (None, None) => {
                let (word, name, clause) = ("body", name.clone(), "density");
                let why = "its solids need one";
                self.fault(span, &MechanismFault::MissingClause { word, name, clause, why });
                return;
            }
        }
        match &part.at {
            Some(place) => {
                self.bind(&format!("{label}.place"), "m", place, Clause::new(format!("the place of {words}"), 3))
            }
            None => self.text(span, &format!("let {label}.place: m = [0, 0, 0];")),
        }
        let pi = std::f64::consts::PI;
        match &part.shape {
            Shape::Cuboid(edges) => {
                self.bind(&format!("{label}.size"), "m", edges, size("edges", 3));
                let square = |axis: &str| format!("{label}.size.{axis} * {label}.size.{axis}");
                let (x, y, z) = (square("x"), square("y"), square("z"));
                self.text(
                    span,
                    &format!(
                        "let {label}.mass = {label}.density * {label}.size.x * {label}.size.y * {label}.size.z;
                         let {label}.upright = {label}.mass / 12 * diagonal([{y} + {z}, {x} + {z}, {x} + {y}]);"
                    ),
                );
            }
            Shape::Cylinder { radius, length, axis } => {
                self.bind(&format!("{label}.radius"), "m", radius, size("radius", 1));
                self.bind(&format!("{label}.length"), "m", length, size("length", 1));
                let across = format!("(3 * {label}.radius * {label}.radius + {label}.length * {label}.length) / 12");
                let along = format!("{label}.radius * {label}.radius / 2");
                let moments = Axis::ALL.map(|k| if k == *axis { along.clone() } else { across.clone() }).join(", ");
                self.text(
                    span,
                    &format!(
                        "let {label}.mass = {pi} * {label}.density * {label}.radius * {label}.radius * {label}.length;
                         let {label}.upright = {label}.mass * diagonal([{moments}]);"
                    ),
                );
            }
            Shape::Sphere(radius) => {
                self.bind(&format!("{label}.radius"), "m", radius, size("radius", 1));
                self.text(
                    span,
                    &format!(
                        "let {label}.mass = 4 / 3 * {pi} * {label}.density * pow({label}.radius, 3);
                         let {label}.upright = 2 / 5 * {label}.mass * {label}.radius * {label}.radius * identity();"
                    ),
                );
            }
        }
        match &part.turned {
            Some(turned) => {
                let clause = Clause::new(format!("the orientation of {words}"), 9).allowed(Allowed::Rotation);
                self.bind(&format!("{label}.turned"), "1", turned, clause);
                let tensor = format!("{label}.turned * {label}.upright * transpose({label}.turned)");
                self.text(span, &format!("let {label}.tensor = {tensor};"));
            }
            None => self.text(span, &format!("let {label}.tensor = {label}.upright;")),
        }
    }

    /// Named points and the origin: lever arm, position and velocity in inertial axes.
    fn points(&mut self, body: &Body) {
        let name = &body.name.text;
        for point in &body.points {
            let clause = Clause::new(format!("point `{}` of body `{name}`", point.name.text), 3);
            self.bind(&format!("{name}.{}.place", point.name.text), "m", &point.place, clause);
            self.point_axes(point, name, &format!("{name}.orientation * "));
        }
        let span = body.name.span;
        self.text(span, &format!("let {name}.origin.place: m = [0, 0, 0];"));
        let points: Vec<&str> = body.points.iter().map(|point| point.name.text.as_str()).chain(["origin"]).collect();
        for point in points {
            self.text(
                span,
                &format!(
                    "let {name}.{point}.arm = {name}.orientation * ({name}.{point}.place - {name}.center);
                     let {name}.{point}.position = {name}.position + {name}.{point}.arm;
                     let {name}.{point}.velocity = {name}.velocity + cross({name}.angular_velocity, \
                     {name}.{point}.arm);"
                ),
            );
        }
    }

    /// Pose and motion at t = 0.
    fn start(&mut self, body: &Body) {
        let (name, span) = (&body.name.text, body.name.span);
        let clause = |what: &str, components| {
            Clause::new(format!("the {what} of body `{name}`"), components).given(Given::Start)
        };
        let orientation = clause("start orientation", 9).allowed(Allowed::Rotation);
        self.bind_or(
            ("start.orientation", "1"),
            body.start_orientation.as_ref(),
            "identity()",
            &body.name,
            orientation,
        );
        let reference = match &body.start_position {
            Some((point, place)) => {
                self.bind(&format!("{name}.start.place"), "m", place, clause("start", 3));
                point.as_ref().map_or("origin", |point| point.text.as_str()).to_owned()
            }
            None => {
                self.text(span, &format!("let {name}.start.place: m = [0, 0, 0];"));
                "origin".to_owned()
            }
        };
        if let Some((Some(point), _)) = &body.start_position
            && reference != ORIGIN
            && !is_among(&body.points, &reference)
        {
            self.fault(point.span, &unknown_point(name, &reference, &body.points));
            return;
        }
        self.text(
            span,
            &format!(
                "let {name}.start.position: m = {name}.start.place + {name}.start.orientation * \
                 ({name}.center - {name}.{reference}.place);"
            ),
        );
        let (velocity, spin) = (clause("start velocity", 3), clause("start spin", 3));
        self.bind_or(("start.velocity", "m/s"), body.start_velocity.as_ref(), "[0, 0, 0]", &body.name, velocity);
        self.bind_or(("start.spin", "rad/s"), body.start_spin.as_ref(), "[0, 0, 0]", &body.name, spin);
    }

    /// Binds the user's expression to a name of the body, or the default where there is none.
    fn bind_or(
        &mut self,
        (name, unit): (&str, &str),
        value: Option<&Expression>,
        default: &str,
        body: &Name,
        clause: Clause,
    ) {
        let name = format!("{}.{name}", body.text);
        match value {
            Some(value) => self.bind(&name, unit, value, clause),
            None => self.text(body.span, &format!("let {name}: {unit} = {default};")),
        }
    }
}

/// What the mass of a body must be.
fn mass_of(body: &str) -> Clause {
    Clause::new(format!("the mass of body `{body}`"), 1).allowed(Allowed::Positive)
}

/// What the tensor of a body must be that is made from what is looked at itself.
fn tensor_of(body: &str) -> Clause {
    Clause::new(format!("the tensor of body `{body}`"), 9)
}
