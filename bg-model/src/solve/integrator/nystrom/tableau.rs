//! The coefficients of the Runge-Kutta-Nystrom method for stiff, lightly damped joints.
//!
//! They are this project's own. `examples/nystrom_coefficients` finds them and compares them with this file. It starts
//! from four digits of each coefficient, which are literals there: an earlier search left them, by least squares over
//! the errors of one step on linear oscillators of up to 7.6 in frequency times step, forced, damped, coupled with what
//! relaxes, with a stiffness or a damping that changes. Its program is lost. The present one stays near this start,
//! meets the order conditions, and reduces the errors of one step on such oscillators that follow the cube of time.
//!
//! Quadrature is exact to order 6. The conditions of the trees up to order 5 hold to 7e-7 of their values, and those of
//! order 6 in which no force acts by the momenta to 1e-7: the second stage stands close to the first, and would have to
//! coincide with it for the rest. All stages after the second are good to order 2 in the momenta and to order 3 in the
//! positions, nearly.
//!
//! An undamped oscillation shrinks in a step of up to 8.2, but for two narrow bands: where a step is half a turn it may
//! grow by 0.3 %, where it is one, from 6.21 to 6.33, by 5 %; a damping ratio of 0.008 is enough against that.
//!
//! The error estimate is the difference to a method of order 4. The conditions up to order 4 leave two directions for
//! its weights in the momenta. In the one that is taken the estimate of an oscillation is 13 times its error or more,
//! whatever the step, damped or not, and sees every tree of order 5: forces that change with time, and those that act
//! by the momenta, of which the method's own errors of order 6 consist. Its size is that with which the error of a run
//! is of the order of the tolerance on mechanisms with rigid joints, and a tenth to a thousandth of it on compliant
//! ones. Four digits of these weights are literals of the program; their conditions give the others.
//!
//! The dense output follows from its conditions: those up to order 4 hold, those of order 5 in the least squares.
//! The conditions: Hairer, Norsett, Wanner, Solving Ordinary Differential Equations I, 2nd edition, section II.14.

/// The method's name.
pub(super) const NAME: &str = "Nystrom";
/// The power of the step with which the norm of the error estimate falls.
pub(super) const ERROR_ORDER: f64 = 5.0;
/// The largest product of the fastest frequency and the step; the control lets steps settle at seven tenths of it.
pub(super) const REACH: f64 = 8.4;
/// The rates of a step, the one at its start included.
pub(super) const STAGES: usize = 9;

/// The weights of the stages before, for each stage; for the end of the step; of the difference to the embedded method.
pub(super) type Weights = [&'static [f64]; STAGES + 2];

/// The stages' instants, as parts of the step.
pub(super) const INSTANTS: [f64; STAGES] = [
    0.0,
    0.009182414326459934,
    0.11244923924206374,
    0.23984658635615183,
    0.4693200001853852,
    0.5313506765969208,
    0.6604130389524752,
    0.8974803104189555,
    0.9525795218987159,
];

/// For states of second order: weights of second derivatives, times the square of the step.
pub(super) const SECOND: Weights = [
    &[],
    &[4.2158366431388316e-05],
    &[-0.01873344232419727, 0.02505585802725671],
    &[-0.001339713874311844, 0.010517657912844225, 0.019585248454817118],
    &[-0.2062295342302028, 0.2790059050790228, -0.0447914776441517, 0.08214573808233669],
    &[-0.05070976274197142, 0.06439355090163636, 0.07515288471090667, 0.037332574674648435, 0.014997523214782716],
    &[
        -0.0341030889599794,
        0.08255958260257594,
        0.03003816916580188,
        0.10049639513585178,
        0.016441381935170897,
        0.02264025112980066,
    ],
    &[
        -0.13934729052198724,
        0.23779759569903422,
        -0.0460503986704497,
        0.24331987392640428,
        0.0024164390528458174,
        0.03957835184944005,
        0.06502088245956493,
    ],
    &[
        -0.028696766096708907,
        0.01995830710191322,
        0.2527075988491359,
        -0.0051642845993581845,
        0.10330980816321603,
        0.07796095269973423,
        0.01410640560191482,
        0.019521851050545914,
    ],
    // The end of the step.
    &[
        -0.06837196552627592,
        0.13496079405753544,
        0.05633449902010816,
        0.18963423510979868,
        0.032501781262952535,
        0.06574496008014877,
        0.07074910195722824,
        0.01585026192481739,
        0.002596332113686693,
    ],
    // The difference to the embedded method.
    &[
        0.4143161362022201,
        -0.2274890442039474,
        -0.5325058710719602,
        0.4517766512048677,
        -0.10331972596646384,
        -0.0294800255444567,
        0.026046267457273432,
        0.0010867785638489693,
        -0.0004311666413820523,
    ],
];

/// For the others: weights of rates, times the step.
pub(super) const FIRST: Weights = [
    &[],
    &[0.009182414326459934],
    &[-0.5794758556818452, 0.691925094923909],
    &[-0.1781495400447275, 0.17611045964307365, 0.24188566675780568],
    &[-0.26791888225804067, -0.016251430349028616, 0.550757486364313, 0.2027328264281415],
    &[0.3542598758803908, -0.05321751507435364, -0.07165365754491355, -0.03343528483632529, 0.33539725817212246],
    &[
        -0.06288299634931464,
        0.055553435808082315,
        0.1700037472587598,
        0.22856341041161937,
        -0.010448762935882344,
        0.2796242047592107,
    ],
    &[
        -0.19287895217870443,
        0.08024524745203247,
        0.24924131867627228,
        0.25275452526181535,
        0.03446173952842159,
        0.11919590251453296,
        0.35446052916458526,
    ],
    &[
        0.19088823667855156,
        0.09165972399867474,
        0.01563260393725779,
        0.11911950355928422,
        -0.01398305205061435,
        0.13202503291545073,
        0.0677722022158953,
        0.34946527064421584,
    ],
    // The end of the step.
    &[
        -0.0679784811717917,
        0.135753255642524,
        0.0635658322709737,
        0.24943944360536496,
        0.0612383397390461,
        0.14028537085540255,
        0.20835012125223246,
        0.1546072409125174,
        0.054738876893730526,
    ],
    // The difference to the embedded method.
    &[
        -9.800772263128072,
        8.636894410775321,
        5.627248044558324,
        -6.828418930632501,
        3.4247611997156606,
        -0.15165601936544842,
        -0.7933481737597851,
        -0.5837741137662394,
        0.4690658456027398,
    ],
];

/// The last two coefficients of the dense output of the others, which has order 4; the last weight is that of the rate
/// at the end.
pub(super) const DENSE: [[f64; STAGES + 1]; 2] = [
    [
        -2.35912329073408,
        2.064891434404398,
        -6.026490160306932,
        11.874569050854564,
        -4.147161539085416,
        -2.3317685851812757,
        -1.144881825201084,
        2.62301512783756,
        1.0330551605981786,
        -1.5861053731859134,
    ],
    [
        -2.379039201500878,
        -0.0905803248900216,
        13.593952115987568,
        -19.92508213582827,
        8.429598594653816,
        4.410408320419158,
        0.2784020180079242,
        -8.941666920098681,
        -3.555733729483813,
        8.179741262733197,
    ],
];
