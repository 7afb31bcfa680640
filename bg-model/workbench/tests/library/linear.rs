//! Equilibrium and linearisation against closed forms.

mod equilibria;
mod files;
mod models;
mod spectra;

use bg_model::input::Input;
use bg_model::mechanism::{Mechanism, ModelVisitor};
use bg_model::nalgebra::{DMatrix, DVector};
use bg_model::parameters::Parameters;
use bg_model::run::Simulation;
use bg_model::system::Model;
use bg_workbench::linear::{Equilibrium, StateSpace, equilibrium, linearise, linearise_at};
use models::*;

/// The start state.
struct Start;
impl ModelVisitor<f64> for Start {
    type Output = Vec<f64>;
    fn visit<Mo, const N: usize, const G: usize, const M: usize>(self, model: &Mo) -> Vec<f64>
    where
        Mo: Model<f64, N, G, M>,
    {
        model.start().unwrap().as_slice().to_vec()
    }
}

fn start<Me: Mechanism>(model: &Me) -> Vec<f64> {
    model.visit::<f64, _>(Start)
}

/// The model with these parameters, the others at their defaults, and inputs.
fn model<Me: Mechanism>(parameters: &[(&str, f64)], inputs: &[f64]) -> Me {
    let mut all = Me::Parameters::default();
    parameters.iter().for_each(|(name, value)| all.set(name, *value).unwrap());
    Me::make(all, &inputs.iter().map(|&value| Input::constant(value)).collect::<Vec<_>>()).unwrap()
}

fn at_rest<Me: Mechanism>(model: &Me) -> (Equilibrium, StateSpace) {
    let rest = equilibrium(model, 0.0, &start(model)).unwrap();
    let linear = linearise(model, 0.0, &rest.x).unwrap();
    (rest, linear)
}

#[track_caller]
fn near(value: f64, expected: f64, relative: f64) {
    assert!((value - expected).abs() <= relative * expected.abs(), "{value:?}, not {expected:?}");
}

#[track_caller]
fn same(matrix: &DMatrix<f64>, expected: &[f64]) {
    let expected = DMatrix::from_row_slice(matrix.nrows(), matrix.ncols(), expected);
    assert!((matrix - &expected).amax() <= 1e-13 * expected.amax(), "{matrix} {expected}");
}

fn names(of: &[bg_workbench::linear::Named]) -> Vec<&str> {
    of.iter().map(|named| named.name.as_str()).collect()
}

fn place(of: &[bg_workbench::linear::Named], name: &str) -> usize {
    of.iter().position(|named| named.name == name).unwrap()
}

/// Frequencies without damping, rad/s.
fn naturals(linear: &StateSpace) -> Vec<f64> {
    linear.modes.iter().map(|mode| mode.natural).collect()
}

#[test]
fn a_mass_on_a_spring_has_the_matrices_of_the_textbook() {
    let (rest, linear) = at_rest::<Oscillator>(&model(&[], &[3.0]));
    assert_eq!(names(&linear.states), ["spring.q", "inertia.p"]);
    near(rest.x[0], (3.0 + 2.0 * 9.81) / 200.0, 1e-14);
    same(&linear.a, &[0.0, 0.5, -200.0, -2.0]);
    same(&linear.b, &[0.0, 1.0]);
    // The integral `lost` grows with the square of the velocity: not at rest.
    same(&linear.c, &[1.0, 0.0, 0.0, 0.5, 0.0, 0.0, 0.0, -2.0]);
    same(&linear.d, &[0.0, 0.0, 0.0, 1.0]);
    assert_eq!(linear.left_out.integrals.len(), 1);
    let [mode] = &linear.modes[..] else { panic!("one mode") };
    near(mode.natural, 10.0, 1e-14);
    near(mode.damping.unwrap(), 0.1, 1e-13);
    near(mode.frequency, (100.0_f64 - 1.0).sqrt() / std::f64::consts::TAU, 1e-14);
    assert!(mode.words.starts_with("inertia 50 %") || mode.words.starts_with("spring 50 %"), "{}", mode.words);
}

#[test]
fn a_hanging_rod_has_its_swing_at_the_equilibrium_and_not_at_the_start() {
    let rod = model::<Rod>(&[("angle", -1.2)], &[]);
    let at_start = linearise(&rod, 0.0, &start(&rod)).unwrap();
    assert!(at_start.modes.iter().all(|mode| mode.natural == 0.0 || mode.natural > 50.0), "{}", at_start.table());
    let (_, linear) = at_rest(&rod);
    assert_eq!(linear.states.len(), 12);
    let slow = &linear.modes[0];
    near(slow.natural, 4.952_27, 1e-4);
    assert!(slow.words.starts_with("rod 100 %: position_x 1 m, rotation_z 3.33 rad"), "{}", slow.words);
    // In the plane: m x'' + c (x' + a w') + k (x + a w) = 0, and so on for the moment, with the load m g of the pin.
    let (m, inertia, a, k, c, g) = (2.0, 2.0 * 0.36 / 12.0, 0.3, 1e6, 100.0, 9.81);
    for mode in linear.modes.iter().filter(|mode| mode.words.contains("rotation_z")) {
        let s = bg_model::nalgebra::Complex::new(mode.real, mode.imaginary);
        let pin = s * c + k;
        let (xx, xw, ww) = (s * s * m + pin, pin * a, s * s * inertia + pin * a * a + m * g * a);
        let (determinant, size) = (xx * ww - xw * xw, (xx * ww).norm() + (xw * xw).norm());
        assert!(determinant.norm() < 1e-11 * size, "{} of {size}", determinant.norm());
    }
}

#[test]
fn all_descriptions_of_a_rod_swing_alike() {
    let parameters = [("angle", 0.5), ("length", 0.6)];
    let slow = |linear: &StateSpace| (linear.modes[0].real, linear.modes[0].imaginary);
    let (_, swing) = at_rest::<Swing>(&model(&parameters, &[]));
    let (_, angle) = at_rest::<SwingAngle>(&model(&parameters, &[]));
    let mut states = names(&swing.states);
    states.sort_unstable();
    let positions = ["rod.position_x", "rod.position_y", "rod.rotation_z"];
    assert_eq!(states, [["rod.angular.p_z", "rod.linear.p_x", "rod.linear.p_y"], positions].concat());
    near(slow(&swing).1, slow(&angle).1, 1e-9);
    near(slow(&swing).0, slow(&angle).0, 1e-4);
    // Rigid: one rotation and its momentum, sqrt(3 g / 2 l).
    let (_, ideal) = at_rest::<Ideal>(&model(&parameters, &[]));
    let (_, in_space) = at_rest::<IdealInSpace>(&model(&parameters, &[]));
    for linear in [&ideal, &in_space] {
        assert_eq!((linear.states.len(), linear.modes.len()), (2, 1));
        near(linear.modes[0].imaginary, (3.0 * 9.81 / 1.2_f64).sqrt(), 1e-13);
        assert!(linear.modes[0].real.abs() < 1e-13);
    }
    // The angle changes with the rotation, the force of the pin to second order only.
    let rotation = place(&ideal.states, "rod.rotation_z");
    near(ideal.c[(0, rotation)], 1.0, 1e-14);
    assert!(ideal.c[(1, rotation)].abs() < 1e-12);
}

#[test]
fn a_double_pendulum_has_its_two_modes() {
    let (_, linear) = at_rest::<DoubleIdeal>(&model(&[], &[]));
    // M w^2 = K for the angles of two uniform rods of 1.2 kg, 0.5 m and 0.8 kg, 0.7 m.
    let (m1, l1, m2, l2, g): (f64, f64, f64, f64, f64) = (1.2, 0.5, 0.8, 0.7, 9.81);
    let (a, b, c) = ((m1 / 3.0 + m2) * l1 * l1, m2 * l1 * l2 / 2.0, m2 * l2 * l2 / 3.0);
    let (k1, k2) = ((m1 / 2.0 + m2) * g * l1, m2 * g * l2 / 2.0);
    let (square, half, last) = (a * c - b * b, (a * k2 + c * k1) / 2.0, k1 * k2);
    let root = (half * half - square * last).sqrt();
    let expected = [((half - root) / square).sqrt(), ((half + root) / square).sqrt()];
    assert_eq!(linear.modes.len(), 2);
    naturals(&linear).iter().zip(expected).for_each(|(natural, expected)| near(*natural, expected, 1e-12));
    // In the slow mode the rods swing together, in the fast one against each other.
    let angles = ["upper.rotation_z", "lower.rotation_z"].map(|name| place(&linear.states, name));
    let apart = |mode: usize| {
        let [upper, lower] = angles.map(|angle| &linear.modes[mode].shape[angle]);
        let ratio = lower.magnitude / upper.magnitude;
        (ratio, (lower.phase - upper.phase).abs())
    };
    for (mode, w) in expected.iter().enumerate() {
        let ratio = (k1 - a * w * w) / (b * w * w);
        near(apart(mode).0, ratio.abs(), 1e-9);
        near(apart(mode).1 + 1.0, if ratio > 0.0 { 1.0 } else { 1.0 + std::f64::consts::PI }, 1e-9);
    }
    // The angles that count turns follow from the poses.
    assert_eq!(linear.states.len(), 4);
    assert_eq!(linear.left_out.dependent, ["shoulder.angle", "elbow.angle"]);
    // What the rigid joints hold of a scene with all reactions is not among the states, and is named.
    let (_, linear) = at_rest::<DoubleWithAll>(&model(&[], &[]));
    assert_eq!(linear.states.len(), 4);
    naturals(&linear).iter().zip(expected).for_each(|(natural, expected)| near(*natural, expected, 1e-12));
    assert!(linear.left_out.dependent.contains(&"lower.position_x".to_owned()), "{:?}", linear.left_out);
}

#[test]
fn a_motor_has_an_electrical_and_a_mechanical_pole() {
    let (rest, linear) = at_rest::<Motor>(&model(&[], &[12.0]));
    let (r, l, k, j, b): (f64, f64, f64, f64, f64) = (0.8, 2e-3, 0.05, 1e-3, 1e-3);
    let speed = 12.0 * k / (r * b + k * k);
    near(rest.x[place(&linear.states, "J.p")], j * speed, 1e-12);
    assert_eq!(rest.turning, []);
    let (half, product) = ((r / l + b / j) / 2.0, (r * b + k * k) / (l * j));
    let root = (half * half - product).sqrt();
    near(linear.modes[0].real, -product / (half + root), 1e-12);
    near(linear.modes[1].real, -half - root, 1e-12);
    assert!(linear.modes[0].words.starts_with("J 99 %: p 1 kg*m^2/s"), "{}", linear.modes[0].words);
    assert!(linear.modes[1].words.starts_with("L 99 %: p 1 Wb"), "{}", linear.modes[1].words);
    // From volt to speed at rest: k / (R b + k^2).
    let gain = &linear.responses(&["voltage"], &["speed"], &[1e-9]).unwrap()[0];
    near(gain.magnitude[0], k / (r * b + k * k), 1e-12);
}

#[test]
fn a_circuit_answers_as_its_transfer_function_says() {
    let (_, linear) = at_rest::<Circuit>(&model(&[], &[12.0]));
    let (r, l, c) = (10.0, 0.05, 2e-5);
    let frequencies = bg_workbench::linear::logarithmic(1.0, 1e6, 61);
    near(frequencies[30], 1e3, 1e-14);
    let responses = linear.responses(&[], &["capacitor_voltage", "coil_voltage"], &frequencies).unwrap();
    for (k, &w) in frequencies.iter().enumerate() {
        let below = (1.0 - w * w * l * c, w * r * c);
        let size = f64::hypot(below.0, below.1);
        let phase = -f64::atan2(below.1, below.0);
        near(responses[0].magnitude[k], 1.0 / size, 1e-12);
        near(responses[0].phase[k] - 1.0, phase - 1.0, 1e-12);
        // C (i w - A)^-1 B and D cancel at low frequencies.
        assert!((responses[1].magnitude[k] - w * w * l * c / size).abs() < 1e-14 + 1e-12 / size);
    }
    // The coil's voltage is ahead by half a turn at low frequencies and follows at once at high ones.
    near(responses[1].phase[0], std::f64::consts::PI, 1e-3);
    assert!(responses[1].phase[60].abs() < 1e-3);
}

#[test]
fn what_is_free_keeps_its_eigenvalue_zero_and_what_cannot_move_has_none() {
    let (rest, linear) = at_rest::<Turntable>(&model(&[], &[0.0]));
    assert_eq!(rest.turning, []);
    // 13 states for 19 numbers: 3 rotations for 9.
    assert_eq!((linear.states.len(), linear.modes.len()), (13, 8));
    let zeros = linear.modes.iter().filter(|mode| mode.natural == 0.0).collect::<Vec<_>>();
    assert_eq!(zeros.len(), 1);
    assert_eq!((zeros[0].words.as_str(), zeros[0].damping), ("disc 100 %: rotation_z 1 rad", None));
    assert!(linear.table().contains("disc.orientation: 3 rotations for its 9 entries"), "{}", linear.table());
    // Three springs of one mass, and its position: six states of twelve.
    let (_, thrice) = at_rest::<Thrice>(&model(&[], &[]));
    assert_eq!((thrice.states.len(), thrice.left_out.dependent.len()), (6, 6));
    naturals(&thrice).iter().for_each(|natural| near(*natural, 6.0, 1e-13));
    // Equal frequencies do not mix what is apart.
    assert!(thrice.modes.iter().all(|mode| mode.shape.iter().filter(|part| part.share > 1e-9).count() == 2));
}

#[test]
fn two_inputs_and_two_outputs_of_two_masses() {
    let model = model::<Pair>(&[("changing", 3.0)], &[1.5, -0.5]);
    let linear = linearise(&model, 0.7, &equilibrium(&model, 0.7, &start(&model)).unwrap().x).unwrap();
    assert_eq!(names(&linear.states), ["m1.p", "m2.p", "wall.q", "end.q"]);
    assert_eq!(linear.left_out.dependent, ["link.q"]);
    // The damper stands beside the spring between the masses, whose stretch is the difference of the two others.
    same(
        &linear.a,
        &[
            -2.0,
            2.0 / 3.0,
            -150.0,
            50.0, //
            2.0,
            -2.0 / 3.0,
            50.0,
            -250.0, //
            1.0,
            0.0,
            0.0,
            0.0, //
            0.0,
            1.0 / 3.0,
            0.0,
            0.0,
        ],
    );
    same(&linear.b, &[1.0, 0.0, 0.0, 2.0, 0.0, 0.0, 0.0, 0.0]);
    same(&linear.c, &[0.0, 0.0, 1.0, 0.0, 2.0, -2.0 / 3.0, 0.0, 0.0]);
    same(&linear.d, &[0.0, 0.0, 1.0, 0.0]);
    // C (s - A)^-1 B + D at s = 0 is the static answer.
    let gains = linear.responses(&["second"], &["x1"], &[1e-9]).unwrap();
    near(gains[0].magnitude[0], 2.0 * 50.0 / (150.0 * 250.0 - 50.0 * 50.0), 1e-12);
    // Two masses and a damper between: the phase falls by three quarters of a turn, without a jump.
    let far = &linear.responses(&["second"], &["x1"], &bg_workbench::linear::logarithmic(0.1, 1e6, 400)).unwrap()[0];
    near(far.phase[399], -1.5 * std::f64::consts::PI, 1e-4);
}

#[test]
fn a_moving_point_is_linearised_where_it_is() {
    // x' of a circuit is linear: the same matrices everywhere.
    let circuit = model::<Circuit>(&[], &[12.0]);
    let there = linearise(&circuit, 0.0, &[0.02, 0.3]).unwrap();
    assert_eq!(there.a, at_rest(&circuit).1.a);
    near(there.point[1].rate, 12.0 - 10.0 * 0.3 / 0.05 - 0.02 / 2e-5, 1e-13);
    // A rigid rod that turns at 3 rad/s when it hangs has the swing of one at rest: d(sin) there is the same.
    let rod = model::<Ideal>(&[], &[]);
    let mut x = equilibrium(&rod, 0.0, &start(&rod)).unwrap().x;
    let momentum = Ideal::describe().states.iter().position(|state| state.name == "rod.angular.p_z").unwrap();
    x[momentum] = 2.0 * 0.36 / 12.0 * 3.0;
    let moving = linearise(&rod, 0.0, &x).unwrap();
    near(moving.modes[0].natural, (3.0 * 9.81 / 1.2_f64).sqrt(), 1e-12);
}

#[test]
fn dual_numbers_give_the_jacobian_that_the_model_knows() {
    /// The largest difference between the exact sparse Jacobian and A at a state, for a model whose states are all
    /// coordinates.
    struct Jacobian<'a>(&'a [f64]);
    impl ModelVisitor<f64> for Jacobian<'_> {
        type Output = DMatrix<f64>;
        fn visit<Mo, const N: usize, const G: usize, const M: usize>(self, model: &Mo) -> DMatrix<f64>
        where
            Mo: Model<f64, N, G, M>,
        {
            use bg_model::capability::Linearised;
            use bg_model::nalgebra::SVector;
            let known = model.linearised().unwrap();
            let sparsity = known.sparsity();
            let mut entries = vec![0.0; sparsity.len(N)];
            let x = SVector::from_column_slice(self.0);
            known.jacobian(0.0, &x, &[false; G], &mut entries, &mut SVector::zeros());
            sparsity.matrix(N, &entries)
        }
    }
    let swing = model::<SwingAngle>(&[], &[]);
    let x = DVector::from_row_slice(&[1.3, -0.7, 0.2, 0.8, -0.4, 0.11]);
    let linear = linearise(&swing, 0.0, x.as_slice()).unwrap();
    assert_eq!(linear.states.len(), 6);
    let known = swing.visit::<f64, _>(Jacobian(x.as_slice()));
    assert!((&linear.a - &known).amax() <= 1e-15 * known.amax(), "{} {known}", linear.a);
}

#[test]
fn what_sticks_in_a_run_does_so_in_its_linear_model() {
    let clutch = model::<Clutch>(&[], &[]);
    let run = Simulation::new(&clutch).every(1.0).until(4.0).run().unwrap();
    let linear = linearise_at(&clutch, &run.last).unwrap();
    let (w, u) = (run["w"].last().unwrap(), run["u"].last().unwrap());
    near(*w, *u, 1e-12);
    // Both turn as one: the brake of 1 N m s against 6.1 kg m^2.
    near(linear.point[0].rate, -w * 1.5 / 6.1, 1e-9);
    // What slip there is decays by 1/s: nothing slides.
    near(linear.modes[0].real, -1.0 / 6.1, 1e-12);
    near(linear.modes[1].real, -1.0, 1e-12);
    // By the signs of the guards it would.
    let sliding = linearise(&clutch, 0.0, &start(&clutch)).unwrap();
    near(sliding.point[0].rate, -10.0, 1e-12);
}
