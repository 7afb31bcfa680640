//! Coefficients of Rosenbrock methods.
//!
//! In the form of Hairer, Wanner, Solving Ordinary Differential Equations II, 2nd edition, section IV.7, equations
//! (7.23) and (7.25): with the increments u_j of the stages before,
//! (I / (h gamma) - J) u_i = f(t + c_i h, x + sum a_ij u_j) + sum C_ij / h u_j + d_i h df/dt, and x + sum b_i u_i at
//! the end.

/// A method of `S` stages.
pub(super) struct Tableau<const S: usize> {
    /// The diagonal coefficient.
    pub gamma: f64,
    /// The stages' instants, as parts of the step.
    pub c: [f64; S],
    /// Weights of df/dt.
    pub d: [f64; S],
    /// Weights of the increments in the stages' states; row i has i of them.
    pub a: [[f64; S]; S],
    /// Weights of the increments in the stages' right-hand sides.
    pub cc: [[f64; S]; S],
    /// Weights of the increments at the end.
    pub b: [f64; S],
    /// Weights of the increments in the error estimate.
    pub e: [f64; S],
}

/// RODAS5P of order 5(4): G. Steinebach, Construction of Rosenbrock-Wanner method Rodas5P and numerical benchmarks
/// within the Julia Differential Equations package, BIT Numerical Mathematics 63 (2023) 27. Digits as in the package
/// OrdinaryDiffEq.jl (`Rodas5PTableau`). Stiffly accurate; the error estimate is the last increment.
pub(super) const RODAS5P: Tableau<8> = Tableau {
    gamma: 0.21193756319429014,
    c: [0.0, 0.6358126895828704, 0.4095798393397535, 0.9769306725060716, 0.4288403609558664, 1.0, 1.0, 1.0],
    d: [
        0.21193756319429014,
        -0.42387512638858027,
        -0.3384627126235924,
        1.8046452872882734,
        2.325825639765069,
        0.0,
        0.0,
        0.0,
    ],
    a: [
        [0.0; 8],
        [3.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [2.849394379747939, 0.45842242204463923, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [-6.954028509809101, 2.489845061869568, -10.358996098473584, 0.0, 0.0, 0.0, 0.0, 0.0],
        [2.8029986275628964, 0.5072464736228206, -0.3988312541770524, -0.04721187230404641, 0.0, 0.0, 0.0, 0.0],
        [A6[0], A6[1], A6[2], A6[3], A6[4], 0.0, 0.0, 0.0],
        [A6[0], A6[1], A6[2], A6[3], A6[4], 1.0, 0.0, 0.0],
        [A6[0], A6[1], A6[2], A6[3], A6[4], 1.0, 1.0, 0.0],
    ],
    cc: [
        [0.0; 8],
        [-14.155112264123755, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [-17.97296035885952, -2.859693295451294, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        [147.12150275711716, -1.41221402718213, 71.68940251302358, 0.0, 0.0, 0.0, 0.0, 0.0],
        [165.43517024871676, -0.4592823456491126, 42.90938336958603, -5.961986721573306, 0.0, 0.0, 0.0, 0.0],
        [
            24.854864614690072,
            -3.0009227002832186,
            47.4931110020768,
            5.5814197821558125,
            -0.6610691825249471,
            0.0,
            0.0,
            0.0,
        ],
        [
            30.91273214028599,
            -3.1208243349937974,
            77.79954646070892,
            34.28646028294783,
            -19.097331116725623,
            -28.087943162872662,
            0.0,
            0.0,
        ],
        [
            37.80277123390563,
            -3.2571969029072276,
            112.26918849496327,
            66.9347231244047,
            -40.06618937091002,
            -54.66780262877968,
            -9.48861652309627,
            0.0,
        ],
    ],
    b: [A6[0], A6[1], A6[2], A6[3], A6[4], 1.0, 1.0, 1.0],
    e: [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0],
};

const A6: [f64; 5] =
    [-7.502846399306121, 2.561846144803919, -11.627539656261098, -0.18268767659942256, 0.030198172008377946];

/// The dense output of RODAS5P, of order 4: the state at the part theta of the step is
/// (1 - theta) x0 + theta (x1 + (1 - theta) (v0 + theta (v1 + theta v2))), v_i = sum `RODAS5P_DENSE[i][j]` u_j.
pub(super) const RODAS5P_DENSE: [[f64; 8]; 3] = [
    [
        25.948786856663858,
        -2.5579724845846235,
        10.433815404888879,
        -2.3679251022685204,
        0.524948541321073,
        1.1241088310450404,
        0.4272876194431874,
        -0.17202221070155493,
    ],
    [
        -9.91568850695171,
        -0.9689944594115154,
        3.0438037242978453,
        -24.495224566215796,
        20.176138334709044,
        15.98066361424651,
        -6.789040303419874,
        -6.710236069923372,
    ],
    [
        11.419903575922262,
        2.8879645146136994,
        72.92137995996029,
        80.12511834622643,
        -52.072871366152654,
        -59.78993625266729,
        -0.15582684282751913,
        4.883087185713722,
    ],
];

/// 1 - 1 / sqrt 2, with which the method below is L-stable.
const GAMMA2: f64 = 1.0 - core::f64::consts::FRAC_1_SQRT_2;

/// ROS2 of order 2, L-stable: J. G. Verwer, E. J. Spee, J. G. Blom, W. Hundsdorfer, A second-order Rosenbrock method
/// applied to photochemical dispersion problems, SIAM Journal on Scientific Computing 20 (1999) 1456, equation (2.3),
/// in terms of u_i = gamma h k_i.
pub(super) const ROS2: Tableau<2> = Tableau {
    gamma: GAMMA2,
    c: [0.0, 1.0],
    d: [GAMMA2, -GAMMA2],
    a: [[0.0; 2], [1.0 / GAMMA2, 0.0]],
    cc: [[0.0; 2], [-2.0 / GAMMA2, 0.0]],
    b: [1.5 / GAMMA2, 0.5 / GAMMA2],
    e: [0.0; 2],
};
