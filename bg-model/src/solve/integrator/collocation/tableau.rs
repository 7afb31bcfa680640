//! The coefficients of the three-stage methods of Radau (order 5) and Gauss (order 6).
//!
//! The nodes are the zeros of d^(s-1)/dt^(s-1) (t^(s-1) (t - 1)^s) for Radau IIA and of d^s/dt^s (t^s (t - 1)^s) for
//! Gauss: Hairer, Wanner, Solving Ordinary Differential Equations II, 2nd edition, section IV.5, theorems 5.2 and 5.3
//! and tables 5.2 and 5.6. All else follows from them and was calculated with 60 digits; `order` checks it by its
//! definition.

/// A collocation method of `S` stages; A has one real and `P` pairs of complex eigenvalues, S = 1 + 2 P.
#[derive(Debug)]
pub(in crate::solve::integrator) struct Tableau<const S: usize, const P: usize> {
    /// The nodes, ascending, as parts of the step.
    pub c: [f64; S],
    /// The integrals from zero to the nodes of Lagrange's polynomials over the nodes.
    pub a: [[f64; S]; S],
    /// Their integrals over the step.
    pub b: [f64; S],
    /// The slope at the start of the polynomial through zero and given increments: its weights.
    pub slope: [f64; S],
    /// A = real + the real part of the sum over the pairs of right value left.
    pub real: Real<S>,
    /// The eigenvalues with positive imaginary part.
    pub pairs: [Pair<S>; P],
}

/// A real eigenvalue of A with its eigenvectors, left times right being 1.
#[derive(Debug)]
pub(in crate::solve::integrator) struct Real<const S: usize> {
    pub value: f64,
    pub left: [f64; S],
    pub right: [f64; S],
}

/// A complex eigenvalue of A, real and imaginary part, with its eigenvectors, left times right being 2: half for the
/// conjugate.
#[derive(Debug)]
pub(in crate::solve::integrator) struct Pair<const S: usize> {
    pub value: [f64; 2],
    pub left: [[f64; S]; 2],
    pub right: [[f64; S]; 2],
}

/// Radau IIA with three stages, of order 5 (Ehle 1969).
pub(in crate::solve::integrator) static RADAU5: Tableau<3, 1> = Tableau {
    c: [0.155_051_025_721_682_2, 0.644_948_974_278_317_8, 1.0],
    a: [
        [0.196_815_477_223_660_4, -0.065_535_425_850_198_39, 0.023_770_974_348_220_15],
        [0.394_424_314_739_087_3, 0.292_073_411_665_228_5, -0.041_548_752_125_997_93],
        [0.376_403_062_700_467_25, 0.512_485_826_188_421_6, 0.111_111_111_111_111_1],
    ],
    b: [0.376_403_062_700_467_25, 0.512_485_826_188_421_6, 0.111_111_111_111_111_1],
    slope: [10.048_809_399_827_416, -1.382_142_733_160_749, 0.333_333_333_333_333_3],
    real: Real {
        value: 0.274_888_829_595_677_34,
        left: [4.178_718_591_551_905, 0.327_682_820_761_062_37, 0.523_376_445_499_449_5],
        right: [0.094_438_762_488_975_24, 0.250_213_122_965_333_3, 1.0],
    },
    pairs: [Pair {
        value: [0.162_555_585_202_161_32, 0.184_949_324_407_140_8],
        left: [
            [-2.089_359_295_775_952_6, -0.163_841_410_380_531_18, 0.238_311_777_250_275_22],
            [0.251_436_317_472_893_4, -1.285_963_474_927_802_6, 0.298_019_602_414_112_46],
        ],
        right: [
            [-0.282_510_590_041_908_4, 0.408_258_704_587_599_9, 2.0],
            [-0.060_058_388_210_294_85, 0.765_884_225_514_523_8, 0.0],
        ],
    }],
};

/// Gauss with three stages, of order 6 (Kuntzmann 1961, Butcher 1964).
pub(in crate::solve::integrator) static GAUSS6: Tableau<3, 1> = Tableau {
    c: [0.112_701_665_379_258_31, 0.5, 0.887_298_334_620_741_7],
    a: [
        [0.138_888_888_888_888_9, -0.035_976_667_524_938_9, 0.009_789_444_015_308_325],
        [0.300_263_194_980_864_57, 0.222_222_222_222_222_2, -0.022_485_417_203_086_815],
        [0.267_988_333_762_469_44, 0.480_421_111_969_383_36, 0.138_888_888_888_888_9],
    ],
    b: [0.277_777_777_777_777_8, 0.444_444_444_444_444_4, 0.277_777_777_777_777_8],
    slope: [13.121_638_910_345_695, -1.333_333_333_333_333_3, 0.211_694_422_987_638_52],
    real: Real {
        value: 0.215_314_423_116_112_18,
        left: [5.991_698_084_937_801, 1.139_214_295_155_735_4, 0.432_312_113_783_858_36],
        right: [0.072_151_852_055_200_17, 0.118_832_578_741_277_81, 1.0],
    },
    pairs: [Pair {
        value: [0.142_342_788_441_943_92, 0.135_799_925_708_153_8],
        left: [
            [-2.995_849_042_468_900_6, -0.569_607_147_577_867_7, 0.283_843_943_108_070_8],
            [0.623_106_636_793_115_7, -1.462_779_823_096_156_8, 0.128_867_600_636_716_23],
        ],
        right: [
            [-0.164_482_461_147_261_34, 0.106_130_181_484_122_79, 2.0],
            [-0.120_241_477_238_617, 0.632_410_102_264_583_2, 0.0],
        ],
    }],
};
