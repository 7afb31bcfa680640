//! The vectors of the machine at hand give the bytes that those of every machine give.

use crate::solve::integrator::Arch;
use nalgebra::SVector;

use super::{Bs5, Cfmr7, Dop853, Explicit, Tableau};
use crate::model::system::System;
use crate::solve::integrator::Tolerances;
use crate::solve::simulation::{Settings, Span, integrate};

/// A chain of pendulums on stiffening springs.
struct Chain;

impl System<f64, 11, 0> for Chain {
    #[inline(always)]
    fn rate(&self, t: f64, x: &SVector<f64, 11>, _negative: &[bool; 0], dx: &mut SVector<f64, 11>) {
        for i in 0..5 {
            let right = if i < 4 { x[i + 1] - x[i] } else { 0.1 * t - x[i] };
            let left = if i > 0 { x[i] - x[i - 1] } else { x[i] };
            dx[i] = x[5 + i];
            dx[5 + i] = 30.0 * (right - left) + 7.0 * (right * right * right) - x[i] / (1.0 + x[i] * x[i]);
        }
        dx[10] = x[5] * x[5];
    }

    fn guards(&self, _t: f64, _x: &SVector<f64, 11>, _negative: &[bool; 0], _guards: &mut SVector<f64, 0>) {}
}

fn bits<T: Tableau>(arch: Arch) -> ([u64; 11], u64) {
    let mut method = Explicit::<T> { arch, ..Explicit::new() };
    let start = SVector::from_fn(|i, _| 0.3 - 0.07 * i as f64);
    let settings = Settings { tolerances: Tolerances::new(1e-9, 1e-11), ..Settings::default() };
    let span = Span { t0: 0.0, t_end: 20.0 };
    let finish = integrate(&Chain, &mut method, &start, span, &settings, &mut ()).expect("a smooth system");
    (core::array::from_fn(|i| finish.x[i].to_bits()), finish.statistics.rate_evaluations)
}

fn agrees<T: Tableau>(_method: Explicit<T>) {
    let (everywhere, here) = (bits::<T>(Arch::Scalar), bits::<T>(Arch::new()));
    assert!(everywhere.1 > 1000);
    assert_eq!(everywhere, here);
}

#[test]
fn every_machine_gives_the_same_bytes() {
    agrees(Bs5::new());
    agrees(Cfmr7::new());
    agrees(Dop853::new());
}
