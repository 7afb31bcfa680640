//! The coefficients of `ARK5(4)8L[2]SAb`, a pair of Runge-Kutta methods of order 5 with an error estimate of order 4:
//! an explicit one, and a diagonally implicit, L-stable one with the same weights at the end of the step.
//!
//! Source: C. A. Kennedy, M. H. Carpenter, Higher-order additive Runge-Kutta schemes for ordinary differential
//! equations, Applied Numerical Mathematics 136 (2019), 183-205; fractions as in SUNDIALS 7,
//! `ARKODE_ARK548L2SAb_ERK_8_4_5` and `ARKODE_ARK548L2SAb_DIRK_8_4_5`, rounded to the nearest `f64`. The dense output
//! of order 4 is our own: the combination of the stages and the rate at the end with the least squares of weights that
//! satisfies the conditions of both methods. So is the estimate of order 3 with the rate at the start, which has no
//! weight in the others: a jump in the first ninth of a step shows nowhere else.

use crate::solve::integrator::explicit::{Row, Tableau};

/// The stages, that at the end of the step apart.
pub(super) const STAGES: usize = 8;

/// The coefficients of [`super::Ark5`].
#[derive(Clone, Debug)]
pub(in crate::solve::integrator) struct KennedyCarpenter;

impl KennedyCarpenter {
    /// A difference to a method of order 3 with the rate at the start of the step.
    pub(super) const START: Row = &[
        (0, 1.0),
        (2, 0.382265143567961),
        (3, -1.3090735672650673),
        (4, -0.07413777913932196),
        (5, 0.42525625522883453),
        (6, -0.12090968470347964),
        (7, -0.30340036768892664),
    ];
}

impl Tableau for KennedyCarpenter {
    const NAME: &'static str = "ARK5(4)8L[2]SAb";
    const ERROR_ORDER: f64 = 5.0;
    const END: usize = STAGES;

    const C: &'static [f64] =
        &[0.0, 0.4444444444444444, 0.7587141249717989, 0.11526943456404197, 0.3567571284043185, 0.72, 0.955, 1.0, 1.0];

    const A: &'static [Row] = &[
        &[],
        &[(0, 0.4444444444444444)],
        &[(0, 0.1111111111111111), (1, 0.6476030138606877)],
        &[(0, 0.09182986664774791), (1, 0.03544856751779924), (2, -0.012008999601505184)],
        &[(0, -0.34252354516023137), (1, -0.2676778594305018), (2, 0.11056894178117282), (3, 0.8563895912138788)],
        &[
            (0, -0.009772282879004396),
            (1, 0.2107086539866175),
            (2, 0.07592412091217536),
            (3, 0.20765518596381696),
            (4, 0.23548432201639455),
        ],
        &[
            (0, 0.46686370681500694),
            (1, 1.2903598800650855),
            (2, 0.37840596884419414),
            (3, -0.5634558403282616),
            (4, -0.2883238346202236),
            (5, -0.3288498807758014),
        ],
        &[
            (0, 0.6143967162516691),
            (1, 0.6143967162516691),
            (2, 0.3174778010668616),
            (3, -0.7121520623952936),
            (4, 0.1149870801531021),
            (5, 0.09139031575415682),
            (6, -0.040496567082165244),
        ],
        &[
            (2, 0.1736625357358126),
            (3, 0.2547916626081235),
            (4, 0.2419017684509479),
            (5, 0.30740485830222825),
            (6, -0.19998304731933453),
            (7, 0.2222222222222222),
        ],
    ];

    const ERROR: Row = &[
        (2, 0.11093831878310549),
        (3, -0.0004414945386560899),
        (4, 0.002874219290934729),
        (5, -0.09167466377312979),
        (6, -0.056825796060827855),
        (7, 0.03512941629857352),
    ];

    const DENSE: &'static [Row] = &[&[
        (0, -2.5),
        (2, -0.31676037427923054),
        (3, 2.9366807737503597),
        (4, 1.0662353413733214),
        (5, -2.880935575877292),
        (6, 2.201605357356153),
        (7, -3.0068255223233114),
        (8, 2.5),
    ]];

    const MORE: &'static [Row] = &[
        &[],
        &[],
        &[(1, -0.37935706248589945)],
        &[(1, -0.09339415975503124), (2, 0.020947396417788918)],
        &[(1, 0.22437257170695415), (2, -0.14458283285874146), (3, -0.6012302185071186)],
        &[(1, -0.07891266374902074), (2, -0.1083008471900377), (3, -0.08380044168709447), (4, -0.09277654271267048)],
        &[
            (1, -0.9810370590607429),
            (2, -1.0613258960778733),
            (3, 0.5046330841785661),
            (4, 0.24701522078672417),
            (5, 1.226033313761768),
        ],
        &[
            (1, -0.6143967162516691),
            (2, -0.143815265331049),
            (3, 0.9669437250034172),
            (4, 0.12691468829784577),
            (5, 0.21601454254807143),
            (6, -0.1594864802371693),
        ],
    ];

    const GAMMA: f64 = 0.2222222222222222;
}
