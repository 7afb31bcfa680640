//! What the linear algebra of implicit methods costs, generated and dense: prints a table.
//!
//! `cargo bench -p bond-graph-tests --bench linear`. Times are minima of [`BATCHES`] batches at the start state.
#![allow(missing_docs)]

use std::hint::black_box;
use std::time::Instant;

use bg_model::capability::{Elimination, Linearised};
use bg_model::linear::Field;
use bg_model::nalgebra::{Complex, ComplexField, Const, DMatrix, DimMin, SMatrix, SVector};
use bg_model::system::Model;
use hacksaw::mechanism::{Full, FullParameters, Paper, PaperParameters, Rigid, RigidParameters};

const BATCHES: usize = 40;

/// Nanoseconds of one call, the least of the batches of `calls`.
fn nanoseconds(calls: u32, mut call: impl FnMut()) -> f64 {
    let batch = |_| {
        let start = Instant::now();
        (0..calls).for_each(|_| call());
        start.elapsed().as_secs_f64() * 1e9 / f64::from(calls)
    };
    (0..BATCHES).map(batch).fold(f64::INFINITY, f64::min)
}

/// Elimination and substitution with this step; nanoseconds of each.
fn generated<F: Field<f64>, const N: usize>(model: &impl Elimination<f64, N>, c: F, entries: &[f64]) -> [f64; 2] {
    let mut factors = vec![F::real(0.0); model.factors()];
    let eliminate = nanoseconds(200, || {
        assert!(model.eliminate(black_box(c), black_box(entries), &mut factors));
        black_box(&factors);
    });
    let b = [F::real(1.0); N];
    let substitute = nanoseconds(200, || {
        let mut y = black_box(b);
        model.substitute(black_box(&factors), &mut y);
        black_box(&y);
    });
    [eliminate, substitute]
}

/// Factorisation by nalgebra, of fixed and of dynamic size.
fn dense<F: ComplexField, const N: usize>(matrix: &DMatrix<F>) -> [f64; 2]
where
    Const<N>: DimMin<Const<N>, Output = Const<N>>,
{
    let fixed = Box::new(SMatrix::<F, N, N>::from_fn(|row, column| matrix[(row, column)].clone()));
    [
        nanoseconds(20, || {
            black_box(black_box(&*fixed).clone().lu());
        }),
        nanoseconds(20, || {
            black_box(black_box(matrix).clone().lu());
        }),
    ]
}

fn measure<Mo, const N: usize, const G: usize, const M: usize>(model: &Mo)
where
    Mo: Model<f64, N, G, M> + Linearised<f64, N, G> + Elimination<f64, N>,
    Const<N>: DimMin<Const<N>, Output = Const<N>>,
{
    let sparsity = model.sparsity();
    let factors = model.factors();
    let x = model.start().expect("the mechanism closes");
    let negative = [false; G];
    let (mut dx, mut slope) = (SVector::zeros(), SVector::zeros());
    let mut entries = vec![0.0; sparsity.len(N)];
    let rate = nanoseconds(200, || model.rate(0.0, black_box(&x), &negative, black_box(&mut dx)));
    let jacobian = nanoseconds(200, || {
        model.jacobian(0.0, black_box(&x), &negative, black_box(&mut entries), &mut slope);
    });
    let c = 1e-4;
    let matrix = DMatrix::identity(N, N) - sparsity.matrix(N, &entries) * c;
    let [eliminate, substitute] = generated(model, c, &entries);
    let [eliminate_complex, substitute_complex] = generated(model, Complex::new(c, c), &entries);
    let [fixed, dynamic] = dense::<f64, N>(&matrix);
    let complex = matrix.map(|entry| Complex::new(entry, 0.1 * entry));
    let [fixed_complex, dynamic_complex] = dense::<Complex<f64>, N>(&complex);
    let lu = matrix.clone().lu();
    let b = DMatrix::repeat(N, 1, 1.0);
    let solve = nanoseconds(200, || {
        let mut y = black_box(&b).clone();
        black_box(lu.solve_mut(&mut y));
        black_box(&y);
    });
    println!("{}: {N} states, {} entries, {factors} factors; ns", model.description().name, entries.len());
    println!("  rate {rate:.0}, jacobian {jacobian:.0}");
    println!(
        "  eliminate {eliminate:.0}, complex {eliminate_complex:.0}; substitute {substitute:.0}, complex \
        {substitute_complex:.0}"
    );
    println!(
        "  nalgebra's LU: SMatrix {fixed:.0}, complex {fixed_complex:.0}; \
        DMatrix {dynamic:.0}, complex {dynamic_complex:.0}; solve {solve:.0}"
    );
}

fn main() {
    // `cargo test` runs benches without this argument.
    if !std::env::args().any(|argument| argument == "--bench") {
        return;
    }
    measure(&Paper::new(PaperParameters::default()).expect("defaults are in their ranges"));
    measure(&Rigid::new(RigidParameters::default()).expect("defaults are in their ranges"));
    measure(&Full::new(FullParameters::default()).expect("defaults are in their ranges"));
}
