//! Times rates and Jacobians of imported robots, these with and without unknowns beside the states: the least of 40
//! rounds over 256 states.

mod chain16;
mod chain2;
mod chain32;
mod chain4;
mod chain64;
mod chain8;
mod panda;
mod solo12;
mod ur5;

use std::time::Instant;

use bg_model::input::Input;
use bg_model::linear::Sparsity;
use bg_model::mechanism::Mechanism;

const ROUNDS: usize = 40;
const AGAIN: usize = 8;

/// The least time of `count` calls, ns each.
fn least(count: usize, mut call: impl FnMut()) -> f64 {
    let round = |_| {
        let begin = Instant::now();
        call();
        begin.elapsed().as_nanos() as f64 / count as f64
    };
    (0..ROUNDS).map(round).fold(f64::MAX, f64::min)
}

fn time<Me: Mechanism>(name: &str) {
    let inputs = vec![Input::constant(0.3); Me::describe().inputs.len()];
    let robot = Me::make(Me::Parameters::default(), &inputs).expect("defaults are possible").machine();
    let (start, negative) = (robot.start().expect("it closes"), vec![false; robot.switches()]);
    let mut seed = 1_u64;
    let mut draw = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    let states: Vec<Vec<f64>> = (0..256).map(|_| start.iter().map(|x| x + 0.3 * draw()).collect()).collect();
    let places = match robot.sparsity() {
        Sparsity::Full => start.len().pow(2),
        Sparsity::Places(places) | Sparsity::Bordered { places, .. } => places.len(),
    };
    let (mut dx, mut slope, mut entries) = (start.clone(), start.clone(), vec![0.0; places]);
    let rate = least(AGAIN * states.len(), || {
        for x in std::iter::repeat_n(&states, AGAIN).flatten() {
            robot.rate(0.0, std::hint::black_box(x), &negative, &mut dx);
        }
    });
    let jacobian = least(states.len(), || {
        for x in &states {
            robot.jacobian(0.0, std::hint::black_box(x), &negative, &mut entries, &mut slope);
        }
    });
    let whole = least(states.len(), || {
        for x in &states {
            robot.jacobian(0.0, std::hint::black_box(x), &negative, &mut entries, &mut slope);
            std::hint::black_box(robot.sparsity().matrix(start.len(), &entries));
        }
    });
    println!("{name}: rate {rate:.0} ns, Jacobian {jacobian:.0} ns, with its unknowns eliminated densely {whole:.0} \
        ns");
}

fn main() {
    time::<ur5::Ur5>("ur5");
    time::<panda::Panda>("panda");
    time::<solo12::Solo>("solo12");
    time::<chain2::Chain2>("chain2");
    time::<chain4::Chain4>("chain4");
    time::<chain8::Chain8>("chain8");
    time::<chain16::Chain16>("chain16");
    time::<chain32::Chain32>("chain32");
    time::<chain64::Chain64>("chain64");
}
