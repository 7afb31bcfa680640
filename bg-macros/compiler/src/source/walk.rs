//! Every name and every value of a statement.
//!
//! In: an [`Item`]. Out: each of its names and expressions in turn, handed to a function that may change it. What is
//! only known inside of the item, such as a body's points, is not met.

use crate::source::ast::{
    Body, Choice, Element, Ends, Expression, ExpressionKind, Friction, Item, LawVariable, Name, Observation, Point,
    Port, Rigid, Scene, Shape, Solid, Touching, Tune, Use, Watch,
};

/// What is met.
pub(crate) enum Met<'a> {
    /// The name of what the item declares.
    Declared(&'a mut Name),
    /// The name of something else.
    Named(&'a mut Name),
    /// An end of a repetition, an expression of indices.
    Index(&'a mut Name),
    /// A value, with the name of its law's variable.
    Value(&'a mut Expression, Option<&'a str>),
}

/// Hands everything of the item to `each`; of a repetition what is around its statements.
pub(crate) fn walk(item: &mut Item, each: &mut dyn FnMut(Met)) {
    match item {
        Item::Parameter(parameter) => {
            each(Met::Declared(&mut parameter.name));
            let bounds = [&mut parameter.lower, &mut parameter.upper].into_iter().flatten();
            values(std::iter::once(&mut parameter.default).chain(bounds.map(|bound| &mut bound.value)), each);
        }
        Item::Input(input) => each(Met::Declared(&mut input.name)),
        Item::Let(binding) => {
            each(Met::Declared(&mut binding.name));
            values([&mut binding.value], each);
        }
        Item::State(state) => {
            each(Met::Declared(&mut state.name));
            values(std::iter::once(&mut state.rate).chain(&mut state.start), each);
        }
        Item::Memory(memory) => {
            each(Met::Declared(&mut memory.name));
            let Choice { left, right, then, otherwise, .. } = &mut memory.following;
            values([then, left, right, otherwise].into_iter().chain(&mut memory.start), each);
        }
        Item::Every(every) => {
            values(std::iter::once(&mut every.period).chain(&mut every.offset), each);
            for sample in &mut every.samples {
                each(Met::Declared(&mut sample.name));
                values(std::iter::once(&mut sample.value).chain(&mut sample.start), each);
            }
        }
        Item::Table(table) => {
            each(Met::Declared(&mut table.name));
            values([&mut table.points], each);
        }
        Item::Junction(junction) => each(Met::Declared(&mut junction.name)),
        Item::Element(element) => of_element(element, each),
        Item::Chain(chain) => chain.iter_mut().for_each(|name| each(Met::Named(name))),
        Item::Track(track) => {
            each(Met::Declared(&mut track.name));
            each(Met::Named(&mut track.junction));
            values(&mut track.start, each);
        }
        Item::Close(close) => {
            each(Met::Named(&mut close.joint));
            values([&mut close.gap], each);
        }
        Item::Observe(watched) => watches(watched, each),
        Item::Scene(scene) => of_scene(scene, each),
        Item::Ground(ground) => {
            ground.points.iter_mut().for_each(|point| each(Met::Declared(&mut point.name)));
            values(points(&mut ground.points), each);
        }
        Item::Gravity(gravity) => values([&mut gravity.acceleration], each),
        Item::Impulse(_) | Item::IntegralCausality | Item::ScenesOnly(_) => {}
        Item::Baumgarte(baumgarte) => values([&mut baumgarte.rate], each),
        Item::Body(body) => of_body(body, each),
        Item::Joint(joint) => {
            each(Met::Declared(&mut joint.name));
            ends(&mut joint.ends, each);
            let clauses =
                [&mut joint.stiffness, &mut joint.damping, &mut joint.tilt_stiffness, &mut joint.tilt_damping];
            values(clauses.into_iter().chain([&mut joint.clearance, &mut joint.length]).flatten(), each);
            values(joint.play.play_mut().into_iter().flat_map(|(_, value)| value), each);
        }
        Item::Spring(spring) => {
            each(Met::Declared(&mut spring.name));
            ends(&mut spring.ends, each);
            values([&mut spring.stiffness, &mut spring.damping, &mut spring.length].into_iter().flatten(), each);
        }
        Item::Drive(drive) => {
            each(Met::Declared(&mut drive.name));
            each(Met::Named(&mut drive.target));
            let coupling = [&mut drive.stiffness, &mut drive.damping].into_iter().flatten();
            values(std::iter::once(&mut drive.value).chain(coupling), each);
        }
        Item::Contact(contact) => {
            each(Met::Declared(&mut contact.name));
            ends(&mut contact.ends, each);
            for law in &mut contact.laws {
                each(Met::Value(&mut law.law, variable(law.variable.as_ref())));
            }
        }
        Item::ShapeContact(contact) => {
            each(Met::Declared(&mut contact.name));
            ends(&mut contact.ends, each);
            for shape in &mut contact.shapes {
                if let Touching::Profile(table) = shape {
                    each(Met::Named(table));
                }
                values(shape.sizes_mut(), each);
            }
            values(contact.law.clauses_mut().into_iter().flat_map(|(_, value)| value), each);
        }
        Item::Friction(friction) => of_friction(friction, each),
        Item::Stop(stop) => {
            on_target((&mut stop.name, &mut stop.target), each);
            let ends = [&mut stop.least, &mut stop.most];
            let clauses =
                [&mut stop.stiffness, &mut stop.damping, &mut stop.restitution, &mut stop.rest, &mut stop.start];
            values(ends.into_iter().chain(clauses).flatten(), each);
        }
        Item::Orifice(orifice) => {
            on_target((&mut orifice.name, &mut orifice.target), each);
            let flow = [&mut orifice.area, &mut orifice.coefficient];
            let fluid = [&mut orifice.density, &mut orifice.laminar];
            values(flow.into_iter().chain(fluid).flatten(), each);
        }
        Item::Use(part) => of_use(part, each),
        Item::Port(port) => of_port(port, each),
        Item::Start(start) => {
            each(Met::Named(&mut start.of));
            values([&mut start.value], each);
        }
        Item::For(repeated) => [&mut repeated.from, &mut repeated.to].into_iter().for_each(|end| each(Met::Index(end))),
    }
}

/// Hands every name in an expression to `each`, as the expression that it is; of a function's name the call.
pub(crate) fn each_name(expression: &mut Expression, each: &mut dyn FnMut(&mut Expression)) {
    match &mut expression.kind {
        ExpressionKind::Number(_) | ExpressionKind::Quantity(..) => {}
        ExpressionKind::Name(_) => each(expression),
        ExpressionKind::Negate(inner) => each_name(inner, each),
        ExpressionKind::Chain(first, rest) => {
            each_name(first, each);
            rest.iter_mut().for_each(|operation| each_name(&mut operation.operand, each));
        }
        ExpressionKind::Call(_, arguments) => {
            arguments.iter_mut().for_each(|argument| each_name(argument, each));
            each(expression);
        }
        ExpressionKind::Vector(parts) => parts.iter_mut().for_each(|part| each_name(part, each)),
        ExpressionKind::If(choice) => {
            let parts = [&mut choice.left, &mut choice.right, &mut choice.then, &mut choice.otherwise];
            parts.into_iter().for_each(|part| each_name(part, each));
        }
    }
}

fn values<'e>(of: impl IntoIterator<Item = &'e mut Expression>, each: &mut dyn FnMut(Met)) {
    of.into_iter().for_each(|value| each(Met::Value(value, None)));
}

fn variable(of: Option<&LawVariable>) -> Option<&str> {
    of.map(|variable| variable.name.text.as_str())
}

fn ends(ends: &mut Ends, each: &mut dyn FnMut(Met)) {
    each(Met::Named(&mut ends.from));
    each(Met::Named(&mut ends.to));
}

fn of_element(element: &mut Element, each: &mut dyn FnMut(Met)) {
    each(Met::Declared(&mut element.name));
    let variable = variable(element.variable.as_ref());
    each(Met::Value(&mut element.law, variable));
    element.energy.iter_mut().for_each(|energy| each(Met::Value(energy, variable)));
    let clauses = [&mut element.frame, &mut element.displacement, &mut element.start, &mut element.sticking];
    let of_stop = [&mut element.restitution, &mut element.rest];
    values(clauses.into_iter().chain(of_stop).flatten(), each);
    element.held.iter_mut().for_each(|held| each(Met::Named(&mut held.joint)));
}

fn on_target((name, target): (&mut Name, &mut Name), each: &mut dyn FnMut(Met)) {
    each(Met::Declared(name));
    each(Met::Named(target));
}

fn of_friction(friction: &mut Friction, each: &mut dyn FnMut(Met)) {
    let Friction { name, target, coulomb, at_rest, stribeck, viscous, normal, radius, creep, stiffness } = friction;
    on_target((name, target), each);
    values([coulomb, at_rest, stribeck, viscous, normal, radius, creep, stiffness].into_iter().flatten(), each);
}

fn of_body(body: &mut Body, each: &mut dyn FnMut(Met)) {
    each(Met::Declared(&mut body.name));
    body.solids.iter_mut().for_each(|solid| of_solid(solid, each));
    values(points(&mut body.points), each);
    let given = [&mut body.density, &mut body.mass, &mut body.center, &mut body.inertia];
    let start = [&mut body.start_orientation, &mut body.start_velocity, &mut body.start_spin];
    values(given.into_iter().chain(start).flatten(), each);
    values(body.start_position.as_mut().map(|(_, place)| place), each);
}

fn points(points: &mut [Point]) -> impl Iterator<Item = &mut Expression> {
    points.iter_mut().flat_map(|point| [&mut point.place].into_iter().chain(&mut point.turned))
}

fn of_solid(solid: &mut Solid, each: &mut dyn FnMut(Met)) {
    match &mut solid.shape {
        Shape::Cuboid(size) | Shape::Sphere(size) => values([size], each),
        Shape::Cylinder { radius, length, .. } => values([radius, length], each),
    }
    values([&mut solid.at, &mut solid.turned, &mut solid.density].into_iter().flatten(), each);
}

fn watches(watched: &mut [Watch], each: &mut dyn FnMut(Met)) {
    for watch in watched {
        match watch {
            Watch::Value(observation) => of_observation(observation, each),
            Watch::All(name) => each(Met::Named(name)),
        }
    }
}

/// Of an output.
pub(crate) fn of_observation(observation: &mut Observation, each: &mut dyn FnMut(Met)) {
    observation.name.iter_mut().for_each(|name| each(Met::Declared(name)));
    values([&mut observation.value], each);
}

fn of_scene(scene: &mut Scene, each: &mut dyn FnMut(Met)) {
    watches(&mut scene.observe, each);
    let tuned = match &mut scene.tune {
        Tune::All => None,
        Tune::Only(names) | Tune::AllBut(names) => Some(names),
    };
    let rigid = if let Rigid::Some(names) = &mut scene.rigid { Some(names) } else { None };
    let lists = [tuned, Some(&mut scene.without), rigid, Some(&mut scene.dependent)];
    lists.into_iter().flatten().flatten().for_each(|name| each(Met::Named(name)));
}

fn of_use(part: &mut Use, each: &mut dyn FnMut(Met)) {
    part.name.iter_mut().for_each(|name| each(Met::Declared(name)));
    values(part.arguments.iter_mut().map(|argument| &mut argument.value), each);
    values(part.starts.iter_mut().map(|start| &mut start.value), each);
}

fn of_port(port: &mut Port, each: &mut dyn FnMut(Met)) {
    match port {
        Port::Junction(junction) => each(Met::Declared(&mut junction.name)),
        Port::Alias(name, of) => {
            each(Met::Declared(name));
            each(Met::Named(of));
        }
    }
}
