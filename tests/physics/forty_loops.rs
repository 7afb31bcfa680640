//! The N-four-bar mechanism of IFToMM (A02) with forty loops: 81 rods, 121 rigid joints.
//!
//! The scene's equations are made by the compiler and evaluated by its interpreter: so no build of the suites has to
//! compile 243 states.

use bg_compiler::expr::{Environment, Id, evaluate};
use bg_compiler::pipeline::{self, Arranged};
use bg_compiler::source::{part, scene, syntax};
use bg_compiler::system::equations::stage::Closed;
use bg_compiler::system::equations::{Kind, StateEquations};
use bg_model::capability::Joints;
use bg_model::holding::{Held, Slip};
use bg_model::integrator::{Dop853, Tolerances};
use bg_model::nalgebra::SVector;
use bg_model::simulation::{Settings, Span, integrate};
use bg_model::system::System;

use super::truth::within;

/// An angle's cosine and sine and a momentum of each rod: joints determine the others.
const STATES: usize = 3 * 81;

const TEXT: &str = "
part Post {
    param place: m = 0;
    ground { point foot = [place, 0, 0]; }
    body rod {
        mass 1; inertia [1 / 12, 1e-3, 1 / 12]; point foot = [0, -0.5, 0]; point head = [0, 0.5, 0];
        start foot at [place, 0, 0]; start velocity [0.5, 0, 0]; start spin [0, 0, -1];
    }
    joint pin: revolute z (ground.foot -> rod.foot) { rigid; }
}
part Square {
    param place: m = 1;
    body rod {
        mass 1; inertia [1e-3, 1 / 12, 1 / 12]; point left = [-0.5, 0, 0]; point right = [0.5, 0, 0];
        start right at [place, 1, 0]; start velocity [1, 0, 0];
    }
    part post: Post { place = place; }
    joint pin: revolute z (rod.right -> post.rod.head) { rigid; }
}
graph Forty {
    gravity [0, -9.81, 0];
    part first: Post;
    part square[i in 0..40]: Square { place = i + 1; }
    joint left: revolute z (first.rod.head -> square[0].rod.left) { rigid; }
    joint middle[i in 1..40]: revolute z (square[i - 1].post.rod.head -> square[i].rod.left) { rigid; }
    observe { x: m = first.rod.head.position.x; y: m = first.rod.head.position.y; stored: J = stored_energy; \
    last: m = square[39].pin.gap }
    scene Plane { tune {} expect planar; expect independent speeds; expect states = 243; }
}";

/// The scene, interpreted.
struct Forty {
    equations: Closed,
    rates: Vec<Id>,
    entries: Vec<Id>,
    held: Held,
    kept: Vec<f64>,
}

impl Forty {
    fn new() -> Self {
        let source = syntax::parse(TEXT.parse().expect("tokens")).unwrap_or_else(|faults| panic!("{faults:?}"));
        let source = part::flatten(&source).unwrap_or_else(|faults| panic!("{faults:?}")).source;
        let variant = scene::variants(&source.graphs[0]).unwrap_or_else(|faults| panic!("{faults:?}")).remove(1);
        let Arranged { equations, .. } = pipeline::arrange(&variant).unwrap_or_else(|faults| panic!("{faults:?}"));
        let equations = equations.close();
        let rates = equations.states.iter().map(|state| state.rate).collect();
        let entries = equations.holding.entries(&equations.pool);
        let (held, kept) = held(&equations);
        Self { equations, rates, entries, held, kept }
    }

    fn values(&self, x: &SVector<f64, STATES>, roots: &[Id]) -> Vec<f64> {
        evaluate(&self.equations.pool, roots, &Environment { states: x.as_slice(), ..Environment::default() })
    }

    fn outputs(&self, x: &SVector<f64, STATES>) -> Vec<f64> {
        self.values(x, &self.equations.outputs.iter().map(|output| output.value).collect::<Vec<_>>())
    }

    fn start(&self) -> SVector<f64, STATES> {
        let starts: Vec<Id> = self.equations.states.iter().map(|state| state.start).collect();
        SVector::from_vec(self.values(&SVector::zeros(), &starts))
    }

    /// Gives the states of `moved` their expressions.
    fn move_to(&self, x: &mut SVector<f64, STATES>, moved: &[(usize, Id)]) {
        let (states, roots): (Vec<usize>, Vec<Id>) = moved.iter().copied().unzip();
        let values = self.values(x, &roots);
        states.into_iter().zip(values).for_each(|(state, value)| x[state] = value);
    }
}

/// What the joints hold, and that every row takes part.
fn held(equations: &StateEquations) -> (Held, Vec<f64>) {
    let holding = &equations.holding;
    let slip = |_| Slip { joint: "a joint", direction: "", unit: "m/s" };
    let closing = holding.rigid.iter().enumerate().filter_map(|(row, slip)| Some((row, slip.kept? as usize)));
    let closing: Vec<(usize, usize)> = closing.collect();
    let of = |kinds: &[Kind]| -> &'static [usize] {
        let states = equations.states.iter().enumerate();
        let indices = states.filter(|(_, state)| kinds.contains(&state.origin.kind())).map(|(index, _)| index);
        indices.collect::<Vec<_>>().leak()
    };
    let held = Held {
        rigid: (0..holding.rigid.len()).map(slip).collect::<Vec<_>>().leak(),
        compliant: &[],
        moved: holding.moves.iter().map(|(state, _)| *state).collect::<Vec<_>>().leak(),
        pose: of(&[Kind::Position, Kind::Orientation]),
        turning: of(&[Kind::Orientation]),
        closing: closing.clone().leak(),
        is_driven: false,
    };
    (held, vec![1.0; closing.len()])
}

impl System<f64, STATES, 0> for Forty {
    fn rate(&self, _: f64, x: &SVector<f64, STATES>, _: &[bool; 0], dx: &mut SVector<f64, STATES>) {
        dx.copy_from_slice(&self.values(x, &self.rates));
    }

    fn project(&self, _: f64, _: &[bool; 0], x: &mut SVector<f64, STATES>) {
        self.move_to(x, &self.equations.projections);
        self.move_to(x, &self.equations.settled);
    }

    fn joints(&self) -> Option<&impl Joints<f64, STATES, 0>> {
        Some(self)
    }
}

impl Joints<f64, STATES, 0> for Forty {
    fn held(&self) -> Held {
        self.held
    }

    fn kept(&self) -> &[f64] {
        &self.kept
    }

    fn hold(&self, _: f64, x: &SVector<f64, STATES>, _: &[bool; 0], entries: &mut [f64]) {
        entries.copy_from_slice(&self.values(x, &self.entries));
    }
}

/// All posts turn alike, theta'' = -11.059099 cos(theta) in the posts' angle; the first post's upper end at 5 s by
/// Jacobi's elliptic functions to 34 digits. It has then passed five flat poses, in each of which all forty loops could
/// go another way.
#[test]
fn forty_four_bars_in_a_row_pass_their_flat_poses() {
    let model = Forty::new();
    let start = model.start();
    let settings = Settings { tolerances: Tolerances::new(1e-10, 1e-11), ..Settings::default() };
    let span = Span { t0: 0.0, t_end: 5.0 };
    let finish = integrate(&model, &mut Dop853::new(), &start, span, &settings, &mut ());
    let finish = finish.unwrap_or_else(|failure| panic!("{failure}"));
    println!("{}", finish.statistics);
    let y = model.outputs(finish.state());
    let first = model.outputs(&start);
    within("x", (y[0] + 0.540_190_050_675_526_3).abs(), 1e-7);
    within("y", (y[1] + 0.841_543_052_464_443).abs(), 1e-7);
    // 41 posts at half of the height, 40 rods at all of it; in parts of the kinetic and potential energy at the start.
    let weight = 9.81 * (0.5 * 41.0 + 40.0);
    let (before, after) = (first[2] + weight * first[1], y[2] + weight * y[1]);
    within("energy", (after / before - 1.0).abs(), 1e-8);
    within("gap", y[3].hypot(y[4]).hypot(y[5]), 1e-12);
}
