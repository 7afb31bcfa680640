//! An inverted pendulum on a ball, the example `ball_balancer.bond`, beside hand-written equations of Newton and Euler.
//!
//! They have no constraint: the ball rolls, so its angular acceleration gives that of its centre, the frame's hub is
//! there, and force and moment of the hub and the ground follow from the two angular accelerations. What is left of the
//! moments of the two bodies is linear in these six numbers.

use bg_model::dynamics::{Dynamics, Machine};
use bg_model::nalgebra::{Matrix3, Matrix6, Quaternion, UnitQuaternion, Vector3, Vector6};

use super::hand::run;
use super::text::{graphs, model, outputs};

const TEXT: &str = include_str!("../../bond/examples/ball_balancer.bond");

const RADIUS: f64 = 0.12;
const HEIGHT: f64 = 0.5;
/// The masses of ball and frame, and the frame's edges.
const BALL: f64 = 550.0 * 4.0 / 3.0 * std::f64::consts::PI * RADIUS * RADIUS * RADIUS;
const FRAME: f64 = 400.0 * EDGES[0] * EDGES[1] * EDGES[2];
const EDGES: [f64; 3] = [0.24, 0.16, 0.6];

/// The ball's centre, the frame's quaternion, the angular velocities of ball and frame in inertial axes.
struct ByHand;

struct State {
    place: [f64; 2],
    axes: Matrix3<f64>,
    quaternion: Quaternion<f64>,
    of_ball: Vector3<f64>,
    of_frame: Vector3<f64>,
}

/// A velocity or an acceleration of the ball's centre by that of its turning.
fn rolled(turning: Vector3<f64>) -> Vector3<f64> {
    turning.cross(&(RADIUS * Vector3::z()))
}

impl State {
    fn of(x: &[f64]) -> Self {
        let quaternion = Quaternion::new(x[2], x[3], x[4], x[5]);
        Self {
            place: [x[0], x[1]],
            axes: UnitQuaternion::from_quaternion(quaternion).to_rotation_matrix().into_inner(),
            quaternion,
            of_ball: Vector3::new(x[6], x[7], x[8]),
            of_frame: Vector3::new(x[9], x[10], x[11]),
        }
    }

    fn torque(&self) -> Vector3<f64> {
        let (lean, velocity) = (self.axes.column(2), rolled(self.of_ball));
        Vector3::new(
            60.0 * lean[1] - 18.0 * self.of_frame.x + 3.0 * self.place[1] + 6.0 * velocity.y,
            -60.0 * lean[0] - 18.0 * self.of_frame.y - 3.0 * self.place[0] - 6.0 * velocity.x,
            0.0,
        )
    }

    /// What the moments on ball and frame are more than these angular accelerations need, and the force of the ground.
    fn moments(&self, ball: Vector3<f64>, frame: Vector3<f64>) -> (Vector6<f64>, Vector3<f64>) {
        let (gravity, torque, w) = (Vector3::new(0.0, 0.0, -9.81), self.torque(), self.of_frame);
        let arm = HEIGHT * self.axes.column(2);
        let center = rolled(ball) + frame.cross(&arm) + w.cross(&w.cross(&arm));
        let hub = FRAME * (center - gravity);
        let ground = BALL * (rolled(ball) - gravity) + hub;
        let squares = Vector3::from(EDGES).map(|edge| edge * edge);
        let moments = squares.map(|square| FRAME / 12.0 * (squares.sum() - square));
        let tensor = self.axes * Matrix3::from_diagonal(&moments) * self.axes.transpose();
        let on_frame = torque - arm.cross(&hub) - tensor * frame - w.cross(&(tensor * w));
        let on_ball = -torque + Vector3::new(0.0, 0.0, -RADIUS).cross(&ground) - 0.4 * BALL * RADIUS * RADIUS * ball;
        (Vector6::from_iterator(on_ball.iter().chain(on_frame.iter()).copied()), ground)
    }

    fn accelerations(&self) -> [Vector3<f64>; 2] {
        let split = |all: &Vector6<f64>| [all.fixed_rows::<3>(0).into_owned(), all.fixed_rows::<3>(3).into_owned()];
        let of = |all: Vector6<f64>| {
            let [ball, frame] = split(&all);
            self.moments(ball, frame).0
        };
        let without = of(Vector6::zeros());
        let columns: Vec<Vector6<f64>> = (0..6).map(|k| without - of(Vector6::ith(k, 1.0))).collect();
        let solved = Matrix6::from_columns(&columns).lu().solve(&without).expect("bodies have inertia");
        split(&solved)
    }
}

impl Dynamics for ByHand {
    fn states(&self) -> usize {
        12
    }

    fn rate(&self, _: f64, x: &[f64], _: &[bool], dx: &mut [f64]) {
        let state = State::of(x);
        let velocity = rolled(state.of_ball);
        let turning = Quaternion::from_imag(state.of_frame) * state.quaternion * 0.5;
        let [ball, frame] = state.accelerations();
        let turning = [turning.w, turning.i, turning.j, turning.k];
        let rates = [velocity.x, velocity.y].into_iter().chain(turning).chain(ball.iter().copied());
        for (dx, rate) in dx.iter_mut().zip(rates.chain(frame.iter().copied())) {
            *dx = rate;
        }
    }
}

#[test]
fn a_frame_on_a_ball_balances_as_by_hand() {
    let graphs = graphs(TEXT);
    for twist in [0.0, 2.0] {
        let balancer = model(&graphs, "BallBalancer", &[("twist", twist)]);
        let start = balancer.start().unwrap_or_else(|error| panic!("{error}"));
        let turned = UnitQuaternion::from_axis_angle(&Vector3::y_axis(), (-3_f64).to_radians())
            * UnitQuaternion::from_axis_angle(&Vector3::x_axis(), 5_f64.to_radians());
        let first = [0.0, 0.0, turned.w, turned.i, turned.j, turned.k, 0.0, 0.0, -twist, 0.0, 0.0, twist];
        for t in [0.5, 3.0] {
            let found = run(&*balancer, &start, t);
            let found = outputs(&*balancer, found.t, found.x.as_slice(), &found.negative);
            let state = State::of(run(&ByHand, &first, t).x.as_slice());
            let lean = state.axes.column(2);
            let [ball, frame] = state.accelerations();
            let pressed = state.moments(ball, frame).1.z;
            // In mm, degrees, N*m and N.
            let expected = [
                1e3 * state.place[0],
                1e3 * state.place[1],
                (-lean[1]).to_degrees(),
                lean[0].to_degrees(),
                state.torque().norm(),
                pressed,
            ];
            for (found, expected) in found.iter().zip(expected) {
                let error = (found - expected).abs() / expected.abs().max(1.0);
                assert!(error < 1e-9, "{t} s, {twist} rad/s: {found} {expected}");
            }
        }
    }
}

#[test]
fn a_frame_on_a_ball_comes_to_rest_where_it_began() {
    let balancer = model(&graphs(TEXT), "BallBalancer", &[]);
    let start = balancer.start().unwrap_or_else(|error| panic!("{error}"));
    let finish = run(&*balancer, &start, 40.0);
    let found = outputs(&*balancer, finish.t, finish.x.as_slice(), &finish.negative);
    assert!(
        found[..5].iter().all(|value| value.abs() < 1e-3) && (found[5] - (BALL + FRAME) * 9.81).abs() < 1e-6,
        "{found:?}"
    );
}
