//! The tables of a model as bg-model has them.
//!
//! In: [`Tables`] of the compiler. Out: the tables of a description, of joints, stops and starts. They live as long as
//! the process, as those of generated code do: who loads a text again and again pays some 50 kB each time.

use bg_compiler::source::drawing as look;
use bg_compiler::tables::{self, Place, Tables};
use bg_model::assembly::Gap;
use bg_model::delay::{Signal, States};
use bg_model::description::{
    BondEnd, BondInfo, Description, ElementInfo, InputInfo, OperationCount, OutputInfo, ParameterInfo, PartInfo, Range,
    StateInfo, StateKind, SwitchInfo,
};
use bg_model::drawing::{Body, Drawing, Joint, Point, Shape, Solid, Tape};
use bg_model::holding::{Held, Slip, Stop, Stops};
use bg_model::linear::Sparsity;
use bg_model::requirement::Requirement;
use bg_model::start::StartTable;

/// The tables of one model.
#[derive(Clone, Debug)]
pub struct Statics {
    pub description: &'static Description,
    pub start: StartTable,
    /// What is asked of parameters alone.
    pub required: &'static [Requirement],
    pub held: Option<Held>,
    pub stops: Option<Stops>,
    /// Kind and name of the laws that can give what is not finite.
    pub fallible: Vec<[&'static str; 2]>,
    /// The joints of loops that may come to their ends.
    pub turning: &'static [&'static str],
    pub sparsity: Sparsity,
}

/// The tables of one model.
pub fn statics(of: &Tables) -> Statics {
    Statics {
        description: leaked(&of.description),
        start: start(&of.start),
        required: each(&of.required, requirement),
        held: of.held.as_ref().map(held),
        stops: of.stops.as_ref().map(stops),
        fallible: of.fallible.iter().map(|(kind, name)| [*kind, text(name)]).collect(),
        turning: each(&of.turning, |joint| text(joint)),
        sparsity: match of.unknowns {
            0 => Sparsity::Places(places(&of.jacobian)),
            unknowns => Sparsity::Bordered { places: places(&of.jacobian), unknowns },
        },
    }
}

/// Where the states of delays are.
pub fn delays(of: &[tables::Delay]) -> &'static [States] {
    let signal = |(coefficients, is_given): &(Vec<usize>, bool)| Signal {
        coefficients: each(coefficients, |&state| state),
        is_given: *is_given,
    };
    each(of, |of| States { clock: of.clock, window: of.window, signals: each(&of.signals, signal) })
}

/// A description.
pub fn leaked(of: &tables::Description) -> &'static Description {
    Box::leak(Box::new(description(of)))
}

fn text(of: &str) -> &'static str {
    String::leak(of.to_owned())
}

fn each<T, U>(of: &[T], make: impl FnMut(&T) -> U) -> &'static [U] {
    Vec::leak(of.iter().map(make).collect())
}

/// Row and column of entries.
pub fn places(of: &[(usize, usize)]) -> &'static [(u16, u16)] {
    let small = |index: usize| u16::try_from(index).expect("fewer than 2^16 states");
    each(of, |&(row, column)| (small(row), small(column)))
}

fn description(of: &tables::Description) -> Description {
    Description {
        name: text(&of.name),
        doc: text(&of.doc),
        graph: text(&of.graph),
        reduction: text(&of.reduction),
        parameters: each(&of.parameters, parameter),
        inputs: each(&of.inputs, |of| InputInfo { name: text(&of.name), unit: text(&of.unit), doc: text(&of.doc) }),
        states: each(&of.states, state),
        outputs: each(&of.outputs, |of| OutputInfo {
            name: text(&of.name),
            of: text(&of.of),
            observes: text(&of.observes),
            unit: text(&of.unit),
        }),
        switches: each(&of.switches, |of| SwitchInfo {
            name: text(&of.name),
            element: text(&of.element),
            guard: text(&of.guard),
        }),
        parts: each(&of.parts, |of| PartInfo { word: text(&of.word), name: text(&of.name) }),
        elements: each(&of.elements, |of| ElementInfo {
            kind: of.kind,
            name: text(&of.name),
            law: text(&of.law),
            part: text(&of.part),
        }),
        bonds: each(&of.bonds, bond),
        equations: each(&of.equations, |of| text(of)),
        operations: each(&of.operations, |(name, counts)| (text(name), operations(*counts))),
        drawing: drawing(&of.drawing),
    }
}

fn parameter(of: &tables::Parameter) -> ParameterInfo {
    let tables::Bounds { lower: (lower, lower_included), upper: (upper, upper_included) } = of.range;
    ParameterInfo {
        name: text(&of.name),
        unit: text(&of.unit),
        default: of.default,
        doc: text(&of.doc),
        range: Range { lower, lower_included, upper, upper_included },
    }
}

fn state(of: &tables::State) -> StateInfo {
    let kind = match of.kind {
        tables::StateKind::Momentum(component) => StateKind::Momentum(component),
        tables::StateKind::Displacement(component) => StateKind::Displacement(component),
        tables::StateKind::Position(axis) => StateKind::Position(axis),
        tables::StateKind::Orientation(row, column) => StateKind::Orientation(row, column),
        tables::StateKind::Angle => StateKind::Angle,
        tables::StateKind::Way => StateKind::Way,
        tables::StateKind::Integral => StateKind::Integral,
    };
    StateInfo { name: text(&of.name), unit: text(&of.unit), kind, element: text(&of.element) }
}

fn bond(of: &tables::Bond) -> BondInfo {
    BondInfo {
        from: text(&of.from),
        to: text(&of.to),
        cardinality: of.cardinality,
        stroke: if of.stroke_at_end { BondEnd::To } else { BondEnd::From },
        effort: text(&of.effort),
        flow: text(&of.flow),
    }
}

const fn operations(of: bg_compiler::program::Counts) -> OperationCount {
    OperationCount {
        additions: of.additions,
        multiplications: of.multiplications,
        divisions: of.divisions,
        functions: of.functions,
        choices: of.choices,
    }
}

fn start(of: &tables::Start) -> StartTable {
    StartTable {
        unknowns: of.unknowns,
        gaps: each(&of.gaps, |of| Gap { joint: text(&of.joint), component: of.component, unit: text(&of.unit) }),
        speeds: each(&of.speeds, |&speed| speed),
        required: each(&of.required, requirement),
        sides: of.sides,
        impulse: of.impulse,
    }
}

fn requirement(of: &tables::Requirement) -> Requirement {
    Requirement {
        subject: text(&of.subject),
        wanted: of.wanted,
        unit: of.unit.as_deref().map(text),
        is_strict: of.is_strict,
        parameters: each(&of.parameters, |of| text(of)),
    }
}

fn slip(of: &tables::Slip) -> Slip {
    Slip { joint: text(&of.joint), direction: text(&of.direction), unit: text(&of.unit) }
}

fn held(of: &tables::Held) -> Held {
    Held {
        rigid: each(&of.rigid, slip),
        compliant: each(&of.compliant, slip),
        moved: each(&of.moved, |&state| state),
        pose: each(&of.pose, |&state| state),
        turning: each(&of.turning, |&state| state),
        closing: each(&of.closing, |&row| row),
        is_driven: of.is_driven,
    }
}

fn stops(of: &tables::Stops) -> Stops {
    Stops {
        rigid: of.rigid,
        closing: each(&of.closing, |&row| row),
        stops: each(&of.stops, |of| Stop { name: text(&of.name), unit: text(&of.unit), switch: of.switch }),
        moved: each(&of.moved, |&state| state),
        integrals: each(&of.integrals, |&state| state),
    }
}

fn drawing(of: &tables::Drawing) -> Drawing {
    Drawing {
        bodies: each(&of.bodies, |of| Body {
            name: text(&of.look.name),
            position: of.look.position,
            orientation: of.look.orientation,
            states: each(&of.states, |&state| state),
            solids: each(&of.look.solids, solid),
            points: each(&of.look.points, point),
        }),
        ground: each(&of.ground, point),
        gravity: of.gravity,
        joints: each(&of.joints, |of| Joint {
            name: text(&of.name),
            word: text(&of.word),
            ends: [text(&of.ends[0]), text(&of.ends[1])],
            places: of.places,
            force: of.force,
            moment: of.moment,
        }),
        bonds: each(&of.bonds, |&places| places),
        tape: Tape {
            numbers: each(&of.tape.numbers, |&number| number),
            words: each(&of.tape.words, |&word| word),
            results: each(&of.tape.results, |&result| result),
        },
    }
}

fn solid(of: &look::Solid<Place>) -> Solid {
    let shape = match of.shape {
        look::Shape::Cuboid(edges) => Shape::Cuboid(edges),
        look::Shape::Cylinder { radius, length, axis } => Shape::Cylinder { radius, length, axis: axis as usize },
        look::Shape::Sphere(radius) => Shape::Sphere(radius),
    };
    Solid { shape, center: of.center, turned: of.turned }
}

fn point(of: &look::Point<Place>) -> Point {
    Point { name: text(&of.name), place: of.place }
}
