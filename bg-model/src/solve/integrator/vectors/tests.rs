//! The vectors of the machine at hand give the bytes that those of every machine give. (Explicit methods:
//! `explicit::vectors`.)

use crate::solve::integrator::Arch;
use nalgebra::SVector;

use crate::model::capability::{Elimination, Linearised, Series};
use crate::model::dynamics::Typed;
use crate::model::linear::{Field, Pivot};
use crate::model::series::{InnerProducts, quotient, store};
use crate::model::system::System;
use crate::solve::integrator::{Flow, Gauss6, Method, Radau5, Radau9, Rodas5p, Ros2, Taylor, Tolerances};
use crate::solve::simulation::{Settings, Span, integrate};
use crate::solve::statistics::Statistics;

/// Masses, and the states: momenta, then displacements.
const M: usize = 6;
const N: usize = 2 * M;
/// The places of a series: squares and cubes of the displacements' differences, two quotients each.
const PRODUCTS: usize = 2 * M;
const PLACES: usize = 2 * PRODUCTS + 2 * M;

/// A row of masses on stiffening springs: all that generated code is made of, to be inlined in debug builds as well.
struct Row;

impl Row {
    #[inline(always)]
    fn stretch(x: &[f64; N], i: usize) -> f64 {
        x[M + i] - if i > 0 { x[M + i - 1] } else { 0.0 }
    }

    /// The rates, with the cubes of the stretches and the parts of the displacements that a quotient gives.
    #[inline(always)]
    fn rates(x: &[f64; N], cubes: &[f64; M], quotients: &[f64; M]) -> [f64; N] {
        core::array::from_fn(|k| match k {
            0..M => {
                let force = |i: usize| if i < M { 30.0 * Self::stretch(x, i) + 7.0 * cubes[i] } else { 0.0 };
                force(k + 1) - force(k) - quotients[k]
            }
            _ => x[k - M],
        })
    }
}

impl System<f64, N, 0> for Row {
    #[inline(always)]
    fn rate(&self, _t: f64, x: &SVector<f64, N>, _negative: &[bool; 0], dx: &mut SVector<f64, N>) {
        let [x] = &x.data.0;
        let cubes = core::array::from_fn(|i| Self::stretch(x, i) * Self::stretch(x, i) * Self::stretch(x, i));
        dx.data.0 = [Self::rates(x, &cubes, &core::array::from_fn(|i| x[i] / (1.5 + x[M + i])))];
    }

    fn linearised(&self) -> Option<&impl Linearised<f64, N, 0>> {
        Some(self)
    }

    fn series(&self) -> Option<&impl Series<f64, N, 0>> {
        Some(self)
    }
}

impl Series<f64, N, 0> for Row {
    fn width(&self) -> usize {
        PLACES
    }

    #[inline(always)]
    fn expand(&self, _t: f64, h: f64, _: &[bool; 0], rows: &mut [f64], series: &mut [SVector<f64, N>]) {
        let rows = rows.as_chunks_mut::<PLACES>().0;
        let mut inner = InnerProducts::<f64, PRODUCTS>::first();
        for k in 0..series.len() - 1 {
            let [x] = series[k].data.0;
            let inner = inner.at_next_order(&rows[..k]);
            let stretches: [f64; M] = core::array::from_fn(|i| Self::stretch(&x, i));
            let mut lefts = [0.0; PRODUCTS];
            let mut rights = [0.0; PRODUCTS];
            let mut products = [0.0; PRODUCTS];
            for i in 0..PRODUCTS {
                let (left, right) = (stretches[i % M], if i < M { stretches[i] } else { products[i - M] });
                let (first_left, first_right) = (rows[0][i], rows[0][PRODUCTS + i]);
                products[i] = if k == 0 { left * right } else { inner[i] + (left * first_right + first_left * right) };
                (lefts[i], rights[i]) = (left, right);
            }
            store(&mut rows[k], 0, lefts);
            store(&mut rows[k], PRODUCTS, rights);
            let quotients = core::array::from_fn(|i| {
                let divisor = if k == 0 { 1.5 + x[M + i] } else { x[M + i] };
                quotient(&mut rows[..=k], k, 2 * PRODUCTS + 2 * i, x[i], divisor)
            });
            let part = h / (k + 1) as f64;
            series[k + 1].data.0 =
                [Self::rates(&x, &core::array::from_fn(|i| products[M + i]), &quotients).map(|rate| rate * part)];
        }
    }
}

impl Linearised<f64, N, 0> for Row {
    fn jacobian(&self, _t: f64, x: &SVector<f64, N>, _: &[bool; 0], entries: &mut [f64], slope: &mut SVector<f64, N>) {
        let [x] = &x.data.0;
        entries.fill(0.0);
        let mut set = |row: usize, column: usize, by: f64| entries[column * N + row] += by;
        for i in 0..M {
            let steep = 30.0 + 21.0 * Self::stretch(x, i) * Self::stretch(x, i);
            let below = 1.5 + x[M + i];
            set(i, M + i, x[i] / (below * below) - steep);
            set(i, i, -1.0 / below);
            set(M + i, i, 1.0);
            if i > 0 {
                set(i, M + i - 1, steep);
                set(i - 1, M + i, steep);
                set(i - 1, M + i - 1, -steep);
            }
        }
        slope.fill(0.0);
    }

    fn elimination(&self) -> Option<&impl Elimination<f64, N>> {
        Some(self)
    }
}

impl Elimination<f64, N> for Row {
    fn factors(&self) -> usize {
        N * N
    }

    #[inline(always)]
    fn eliminate<F: Field<f64>>(&self, c: F, entries: &[f64], factors: &mut [F]) -> bool {
        let mut is_regular = true;
        for row in 0..N {
            for column in 0..N {
                let one = F::real(if row == column { 1.0 } else { 0.0 });
                factors[row * N + column] = one - c.scaled(entries[column * N + row]);
            }
        }
        for k in 0..N {
            factors[k * N + k] = Pivot::new(factors[k * N + k]).reciprocal(&mut is_regular);
            for row in k + 1..N {
                factors[row * N + k] = factors[row * N + k] * factors[k * N + k];
                for column in k + 1..N {
                    let product = factors[row * N + k] * factors[k * N + column];
                    factors[row * N + column] = factors[row * N + column] - product;
                }
            }
        }
        is_regular
    }

    #[inline(always)]
    fn substitute<F: Field<f64>>(&self, factors: &[F], b: &mut [F; N]) {
        for row in 0..N {
            for column in 0..row {
                b[row] = b[row] - factors[row * N + column] * b[column];
            }
        }
        for row in (0..N).rev() {
            for column in row + 1..N {
                b[row] = b[row] - factors[row * N + column] * b[column];
            }
            b[row] = b[row] * factors[row * N + row];
        }
    }
}

/// The state after some time, bit for bit, and what the run cost.
fn bits<Me: Method>(mut method: Me) -> ([u64; N], u64, u64) {
    let start = SVector::from_fn(|i, _| 0.3 - 0.07 * i as f64);
    let settings = Settings { tolerances: Tolerances::new(1e-9, 1e-11), step_limit: 100_000, ..Settings::default() };
    let span = Span { t0: 0.0, t_end: 5.0 };
    let finish = integrate(&Row, &mut method, &start, span, &settings, &mut ()).expect("a smooth system");
    assert_eq!(finish.statistics.pivoted_factorisations, 0);
    (core::array::from_fn(|i| finish.x[i].to_bits()), finish.statistics.steps, finish.statistics.rate_evaluations)
}

#[test]
fn every_machine_gives_the_same_bytes() {
    let of = |arch: Arch| {
        let (mut taylor, rodas, ros) = (Taylor::new(), Rodas5p::new(), Ros2::new(1e-3));
        let (mut radau5, mut radau9, mut gauss) = (Radau5::new(), Radau9::new(), Gauss6::new(1e-2));
        taylor.arch = arch;
        (radau5.core.arch, radau9.core.arch, gauss.core.arch) = (arch, arch, arch);
        [bits(taylor), bits(radau5), bits(radau9), bits(gauss), bits(rodas), bits(ros)]
    };
    let (everywhere, here) = (of(Arch::Scalar), of(Arch::new()));
    assert_eq!(everywhere, here);
    // All of them solve this system.
    let at = |run: &([u64; N], u64, u64)| SVector::<f64, N>::from(run.0.map(f64::from_bits));
    let reference = at(&here[0]);
    for (run, error) in here.iter().zip([0.0, 1e-6, 1e-7, 1e-5, 1e-6, 1e-3]) {
        let off = (at(run) - reference).amax();
        assert!(off <= error && run.1 > 20, "{off:e} {run:?}");
    }
}

#[test]
fn a_flow_has_the_same_bytes_in_all_vectors() {
    const ORDER: usize = 6;
    let of = |arch: Arch| {
        let mut statistics = Statistics::default();
        let system = Typed::<_, N, 0, 0> { of: &Row, arch };
        let flow = Flow::new(&system, &[], &mut statistics);
        let x: [f64; N] = core::array::from_fn(|i| 0.3 - 0.07 * i as f64);
        let (mut rate, mut slope, mut entries, mut factors) = ([0.0; N], [0.0; N], [0.0; N * N], [0.0; N * N]);
        flow.rate(0.0, &x, &mut rate);
        flow.jacobian(0.0, &x, &mut entries, &mut slope);
        assert!(flow.eliminate(0.01, &entries, &mut factors));
        let mut solution = rate;
        flow.substitute(&factors, &mut solution);
        let (mut rows, mut series) = ([0.0; ORDER * PLACES], [0.0; (ORDER + 1) * N]);
        series[..N].copy_from_slice(&x);
        flow.expand(0.0, 0.1, &mut rows, &mut series);
        [&rate[..], &factors, &solution, &series].concat().iter().map(|number| number.to_bits()).collect::<Vec<_>>()
    };
    assert_eq!(of(Arch::Scalar), of(Arch::new()));
}
