//! The coefficients of the explicit Runge-Kutta method of order 7 of Calvo, Franco, Montijano and Randez for
//! oscillating solutions, with an error estimate of order 5 and a dense output of order 5.
//!
//! For linear oscillations its amplitude has order 9 and its phase order 10; up to 4.5 on the imaginary axis a step
//! amplifies by less than a thousandth. Source: M. Calvo, J. M. Franco, J. I. Montijano, L. Randez, Explicit
//! Runge-Kutta methods for initial value problems with oscillating solutions, Journal of Computational and Applied
//! Mathematics 76 (1996), 195-212; fractions and dense output taken from extensisq 0.6.0, `calvo.py`, the dense output
//! put into the form of `dense` in exact arithmetic, all rounded to the nearest `f64`.

use super::{Row, Tableau};

/// The coefficients of [`super::Cfmr7`].
#[derive(Clone, Debug)]
pub struct CalvoFrancoMontijanoRandez;

impl Tableau for CalvoFrancoMontijanoRandez {
    const NAME: &'static str = "CFMR7osc";
    const ERROR_ORDER: f64 = 6.0;
    const END: usize = 9;

    const C: &'static [f64] = &[
        0.0,
        0.06349206349206349,
        0.09523809523809523,
        0.14285714285714285,
        0.4117647058823529,
        0.5416666666666666,
        0.7777777777777778,
        0.91,
        1.0,
        1.0,
    ];

    const A: &'static [Row] = &[
        &[],
        &[(0, 0.06349206349206349)],
        &[(0, 0.023809523809523808), (1, 0.07142857142857142)],
        &[(0, 0.03571428571428571), (2, 0.10714285714285714)],
        &[(0, 0.6386627315285976), (2, -2.4609708935477306), (3, 2.234072867901486)],
        &[(0, -1.3138860111584179), (2, 5.358156557436343), (3, -4.011227533159923), (4, 0.5086236535486651)],
        &[
            (0, -1.451774499442538),
            (2, 5.416438042981253),
            (3, -3.726569863682654),
            (4, -0.20520191120910639),
            (5, 0.7448860091308228),
        ],
        &[
            (0, 10.342976047485715),
            (2, -37.0676240025),
            (3, 27.164647303095222),
            (4, 3.0932146566796677),
            (5, -3.516297630257167),
            (6, 0.8930836254965625),
        ],
        &[
            (0, -11.85949238134783),
            (2, 42.377251026784144),
            (3, -30.28202964116663),
            (4, -3.4211036620826034),
            (5, 4.5798260424655775),
            (6, -0.5821787052886609),
            (7, 0.1877273206359986),
        ],
        &[
            (0, 0.04015215553677092),
            (3, 0.23054482959629613),
            (4, 0.2415417026624212),
            (5, 0.13411707799899125),
            (6, 0.23031809966633712),
            (7, 0.08336120749092299),
            (8, 0.03996492704826038),
        ],
    ];

    const ERROR: Row = &[
        (0, 0.00643755736981218),
        (3, -0.01945517040370386),
        (4, 0.055348046518796074),
        (5, -0.059488146575090724),
        (6, 0.0257281630250291),
        (7, -0.008570449934842768),
    ];

    const DENSE: &'static [Row] = &[
        &[
            (0, -3.4019442096365173),
            (3, 5.289713291412178),
            (4, 1.1580701853691442),
            (5, -4.385922933086134),
            (6, 0.6308199070069204),
            (7, 0.6302107286313778),
            (8, 1.0790530303030303),
            (9, -1.0),
        ],
        &[
            (0, 3.4142011834319526),
            (3, -6.865405949332713),
            (4, 2.4511013882933104),
            (5, 4.687118262385562),
            (6, -3.4786732266435987),
            (7, -3.851287786080642),
            (8, -3.357053872053872),
            (9, 7.0),
        ],
        &[
            (0, -0.9467455621301775),
            (3, 2.861193335000973),
            (4, -8.139813659753626),
            (5, 8.748681453841527),
            (6, -3.783737024221453),
            (7, 1.2604214572627557),
        ],
    ];
}
