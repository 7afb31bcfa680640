//! Operation counts of small examples, which a reader can check.

use super::*;
use crate::expr::Function;

/// Additions, multiplications, divisions of the single routine; it has no functions or choices.
fn counts(pool: &mut Pool, roots: &[Id]) -> (usize, usize, usize) {
    let counts = single(pool, roots).routines[0].counts;
    assert_eq!((counts.functions, counts.choices), (0, 0));
    (counts.additions, counts.multiplications, counts.divisions)
}

fn products(pool: &mut Pool, products: &[&[Id]]) -> Vec<Id> {
    products.iter().map(|factors| pool.product(factors)).collect()
}

#[test]
fn common_parameter() {
    let mut pool = Pool::new();
    let ([x, y], k) = (states(&mut pool), parameter(&mut pool, 0));
    let terms = products(&mut pool, &[&[k, x], &[k, y]]);
    let (sum, difference) = (pool.sum(&terms), pool.sub(terms[0], terms[1]));
    assert_eq!(counts(&mut pool, &[sum]), (1, 1, 0));
    assert_eq!(counts(&mut pool, &[difference]), (1, 1, 0));
    assert_eq!(counts(&mut pool, &[sum, difference]), (2, 2, 0));
}

#[test]
fn shared_product() {
    let mut pool = Pool::new();
    let [x, y, z, w] = states(&mut pool);
    let roots = products(&mut pool, &[&[x, y, z], &[x, y, w]]);
    assert_eq!(counts(&mut pool, &roots), (0, 3, 0));
}

#[test]
fn division_by_a_parameter() {
    let mut pool = Pool::new();
    let ([a, b], m) = (states(&mut pool), parameter(&mut pool, 0));
    let sum = pool.add(a, b);
    let root = pool.div(sum, m);
    assert_eq!(counts(&mut pool, &[root]), (1, 1, 0));
    let program = single(&mut pool, &[root]);
    assert_eq!(program.constants.counts, Counts { divisions: 1, ..Counts::default() });
    assert_eq!(program.constants.results.len(), 1);
}

#[test]
fn numbers_and_parameters_are_one_constant() {
    let mut pool = Pool::new();
    let ([x], k) = (states(&mut pool), parameter(&mut pool, 0));
    let square = pool.powi(x, 2);
    let energy = pool.mul(k, square);
    let root = pool.scale(0.5, energy);
    assert_eq!(counts(&mut pool, &[root]), (0, 2, 0));
}

#[test]
fn signs_are_free() {
    let mut pool = Pool::new();
    let ([x, y, z], k) = (states(&mut pool), parameter(&mut pool, 0));
    let product = pool.mul(x, y);
    let root = pool.sub(z, product);
    assert_eq!(counts(&mut pool, &[root]), (1, 1, 0));
    let opposite = pool.neg(root);
    assert_eq!(counts(&mut pool, &[opposite]), (1, 1, 0));
    let scaled = pool.product(&[k, x]);
    let negative = pool.neg(scaled);
    assert_eq!(counts(&mut pool, &[negative]), (0, 1, 0));
    let difference = pool.sub(x, y);
    let power = pool.product(&[difference, z]);
    let power = pool.neg(power);
    assert_eq!(counts(&mut pool, &[power]), (1, 1, 0));
    let one = pool.one();
    let rest = pool.sub(one, x);
    let shifted = pool.linear(-1.0, &[(x, -1.0)]);
    assert_eq!(counts(&mut pool, &[rest, shifted]), (2, 0, 0));
}

#[test]
fn powers_by_squaring() {
    let mut pool = Pool::new();
    let [x, y] = states(&mut pool);
    for (exponent, multiplications) in [(2, 1), (3, 2), (4, 2), (7, 4), (8, 3), (16, 4)] {
        let power = pool.powi(x, exponent);
        assert_eq!(counts(&mut pool, &[power]), (0, multiplications, 0), "x^{exponent}");
    }
    let product = pool.mul(x, y);
    let square = pool.powi(product, 2);
    assert_eq!(counts(&mut pool, &[square]), (0, 2, 0));
    let (squared, fourth) = (pool.powi(x, 2), pool.powi(x, 4));
    assert_eq!(counts(&mut pool, &[squared, fourth]), (0, 2, 0));
}

#[test]
fn quotients() {
    let mut pool = Pool::new();
    let ([x, y, z, w], k) = (states(&mut pool), parameter(&mut pool, 0));
    let below = pool.mul(z, w);
    let above = pool.mul(x, y);
    let root = pool.div(above, below);
    assert_eq!(counts(&mut pool, &[root]), (0, 2, 1));
    let inverse = pool.div(k, below);
    assert_eq!(counts(&mut pool, &[inverse]), (0, 1, 1));
    let many: Vec<Id> = [x, y, z].iter().map(|&state| pool.div(state, w)).collect();
    assert_eq!(counts(&mut pool, &many), (0, 3, 1));
    assert_eq!(counts(&mut pool, &many[..2]), (0, 0, 2));
    let sum = pool.add(many[0], many[1]);
    assert_eq!(counts(&mut pool, &[sum]), (1, 0, 1));
}

#[test]
fn factors_come_out_of_sums() {
    let mut pool = Pool::new();
    let [x, y, a, b] = states(&mut pool);
    let terms = products(&mut pool, &[&[x, a], &[x, b], &[y, a], &[y, b]]);
    let half = pool.sum(&terms[..2]);
    assert_eq!(counts(&mut pool, &[half]), (1, 1, 0));
    let root = pool.sum(&terms);
    assert_eq!(counts(&mut pool, &[root]), (2, 1, 0));
    // Horner's scheme.
    let powers: Vec<Id> = (1..4).map(|exponent| pool.powi(x, exponent)).collect();
    let terms = products(&mut pool, &[&[a, powers[0]], &[b, powers[1]], &[y, powers[2]]]);
    let root = pool.sum(&terms);
    assert_eq!(counts(&mut pool, &[root]), (2, 3, 0));
}

#[test]
fn pairs_of_terms() {
    let mut pool = Pool::new();
    let ([x, y, z, w], k, l) = (states(&mut pool), parameter(&mut pool, 0), parameter(&mut pool, 1));
    let [kx, ly] = [pool.mul(k, x), pool.mul(l, y)];
    let first = pool.sum(&[kx, ly, z]);
    let second = pool.linear(0.0, &[(kx, -1.0), (ly, -1.0), (w, 1.0)]);
    assert_eq!(counts(&mut pool, &[first, second]), (3, 2, 0));
    let doubled = pool.linear(0.0, &[(kx, 2.0), (ly, 2.0), (w, 1.0)]);
    assert_eq!(counts(&mut pool, &[first, doubled]), (3, 3, 0));
    let differences = [pool.sub(x, y), pool.sub(y, x)];
    let first = pool.mul(differences[0], z);
    let second = pool.mul(differences[1], w);
    let root = pool.sum(&[first, second]);
    assert_eq!(counts(&mut pool, &[root]), (2, 1, 0));
}

#[test]
fn rotation_of_two_points() {
    let mut pool = Pool::new();
    let [angle, a, b, c, d] = states(&mut pool);
    let (cosine, sine) = (pool.call(Function::Cos, &[angle]), pool.call(Function::Sin, &[angle]));
    let mut roots = Vec::new();
    for (x, y) in [(a, b), (c, d)] {
        let terms = products(&mut pool, &[&[cosine, x], &[sine, y], &[sine, x], &[cosine, y]]);
        roots.push(pool.sub(terms[0], terms[1]));
        roots.push(pool.add(terms[2], terms[3]));
    }
    let counts = single(&mut pool, &roots).routines[0].counts;
    assert_eq!(counts, Counts { additions: 4, multiplications: 8, functions: 2, ..Counts::default() });
}

#[test]
fn arms_of_a_body() {
    let mut pool = Pool::new();
    let rotation: [Id; 9] = states(&mut pool);
    let mut roots = Vec::new();
    for vector in 0..2 {
        let arm = [0, 1, 2].map(|axis| parameter(&mut pool, 3 * vector + axis));
        for row in rotation.chunks(3) {
            let terms = products(&mut pool, &[&[row[0], arm[0]], &[row[1], arm[1]], &[row[2], arm[2]]]);
            roots.push(pool.sum(&terms));
        }
    }
    assert_eq!(counts(&mut pool, &roots), (12, 18, 0));
    // The difference of both arms is no new product.
    let difference = pool.sub(roots[0], roots[3]);
    roots.push(difference);
    assert_eq!(counts(&mut pool, &roots), (13, 18, 0));
}

#[test]
fn centripetal_acceleration_uses_the_arm() {
    let mut pool = Pool::new();
    let [cosine, sine, speed] = states(&mut pool);
    let [a, b] = [parameter(&mut pool, 0), parameter(&mut pool, 1)];
    let square = pool.powi(speed, 2);
    let terms = products(&mut pool, &[&[a, cosine], &[b, sine], &[a, cosine, square], &[b, sine, square]]);
    let arm = pool.sub(terms[0], terms[1]);
    let acceleration = pool.sub(terms[3], terms[2]);
    // Two products and a difference for the arm, the square, and one product; the sign is one more operation.
    assert_eq!(counts(&mut pool, &[arm, acceleration]), (2, 4, 0));
}

#[test]
fn choices_and_functions() {
    let mut pool = Pool::new();
    let ([x, y], k) = (states(&mut pool), parameter(&mut pool, 0));
    let [kx, ky] = [pool.mul(k, x), pool.mul(k, y)];
    let root = pool.select(0, kx, ky);
    let counts = single(&mut pool, &[root]).routines[0].counts;
    assert_eq!(counts, Counts { multiplications: 1, choices: 1, ..Counts::default() });
    let inner = pool.call(Function::Sqrt, &[k]);
    let scaled = pool.mul(inner, x);
    let root = pool.call(Function::Sin, &[scaled]);
    let program = single(&mut pool, &[root]);
    assert_eq!(program.routines[0].counts, Counts { multiplications: 1, functions: 1, ..Counts::default() });
    assert_eq!(program.constants.counts, Counts { functions: 1, ..Counts::default() });
}
