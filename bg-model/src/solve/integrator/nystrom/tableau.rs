//! The coefficients of the Runge-Kutta-Nystrom method for stiff, lightly damped joints.
//!
//! They are this project's own. Quadrature is exact to order 6. The conditions of the trees up to order 5, and of those of order 6
//! in which no force acts by the momenta, hold to 2e-6 of their values: the second stage stands close to the first, and would have
//! to coincide with it for the rest. Within these conditions the coefficients are those for which one step is most precise on
//! linear oscillators of up to 7.6 in frequency times step: forced, damped, coupled with what relaxes, with a stiffness or a
//! damping that changes, all from their slow motion (nonlinear least squares over these errors). All stages behind the second
//! are good to order 2 in the momenta and to order 3 in the positions, nearly.
//!
//! An undamped oscillation shrinks in a step of up to 8.2, but for two narrow bands: where a step is half a turn it may grow by 0.3 %,
//! where it is one, from 6.21 to 6.33, by 5 %; a damping ratio of 0.008 is enough against that.
//! The error estimate is the difference to a method of order 4. The conditions up to order 4 leave two directions for its weights
//! in the momenta. In the one that is taken the estimate of an oscillation is 13 times its error or more, whatever the step, damped
//! or not, and sees every tree of order 5: forces that change with time, and those that act by the momenta, of which the
//! method's own errors of order 6 consist. Its size is that with which the error of a run is of the order of the tolerance on
//! mechanisms with rigid joints, and a tenth to a thousandth of it on compliant ones.
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
    0.00918298231999692,
    0.11245191589690101,
    0.23976343738736403,
    0.46922907105824957,
    0.5312920756132377,
    0.660382302907061,
    0.8974536839967575,
    0.9526198455653451,
];

/// For states of second order: weights of second derivatives, times the square of the step.
pub(super) const SECOND: Weights = [
    &[],
    &[4.2163582144688015e-05],
    &[-0.019021853474474507, 0.025344570168916357],
    &[-0.0012943718395267458, 0.01046725484307673, 0.01957036995035223],
    &[-0.20627492165476793, 0.2790221489820549, -0.04479566537519108, 0.08213639861099803],
    &[-0.05065915096913645, 0.06438271039296603, 0.07512934542028196, 0.03729480215305883, 0.014987927807540755],
    &[
        -0.03412462973245445,
        0.08255321047087069,
        0.03002527268437947,
        0.10047393415552007,
        0.016505132120779344,
        0.02261947329732155,
    ],
    &[
        -0.1394054225788895,
        0.23784153655814413,
        -0.046074198140713465,
        0.24328360080415629,
        0.002400717785820006,
        0.03962630575795214,
        0.06503901727320635,
    ],
    &[
        -0.028702382701668916,
        0.01996094379996974,
        0.25272346303373333,
        -0.005171641633839012,
        0.10331963449173939,
        0.07798973376262619,
        0.014106156730462465,
        0.019516377599447694,
    ],
    // The end of the step.
    &[
        -0.06844649217340633,
        0.1350323726213087,
        0.05631784783239143,
        0.1895721362253054,
        0.03256973886196952,
        0.06575713186699994,
        0.07074549844937604,
        0.0158494891177299,
        0.002602277198325379,
    ],
    // The difference to the embedded method.
    &[
        0.4142519207868606,
        -0.22749066632362802,
        -0.5325281238187927,
        0.45181318469526816,
        -0.10332628470833935,
        -0.029421805995528114,
        0.0260700621596435,
        0.0010541410638530574,
        -0.00042242785933716215,
    ],
];

/// For the others: weights of rates, times the step.
pub(super) const FIRST: Weights = [
    &[],
    &[0.00918298231999692],
    &[-0.5794600855084164, 0.6919120014053175],
    &[-0.17791071644335446, 0.17595985921000593, 0.2417142946207126],
    &[-0.2678772935128742, -0.016158423868257065, 0.5505539808236772, 0.20271080761570356],
    &[0.35423533289759923, -0.05316508050616053, -0.07170502282167965, -0.03351622238624524, 0.3354430684297239],
    &[
        -0.06294611153470409,
        0.055606269197664746,
        0.17000873189431648,
        0.22848158425390375,
        -0.01048283654697531,
        0.27971466564285546,
    ],
    &[
        -0.1930164328791273,
        0.08027573440265806,
        0.24923987715444287,
        0.2528039462682385,
        0.03464812247768009,
        0.11904036069619173,
        0.35446207587667355,
    ],
    &[
        0.190859093506203,
        0.09172155759028652,
        0.015607435753841605,
        0.11905079080824649,
        -0.013889973909632045,
        0.13188778090718944,
        0.06784468380008066,
        0.34953847710912933,
    ],
    // The end of the step.
    &[
        -0.06782329091535662,
        0.1356180488586247,
        0.06339506838231318,
        0.2495674772882789,
        0.06117913497996615,
        0.14024193698635987,
        0.20847843304605906,
        0.154584546713678,
        0.054758644660076794,
    ],
    // The difference to the embedded method.
    &[
        -9.798875166906303,
        8.637226893499156,
        5.625896808108635,
        -6.830190841236278,
        3.4284238960714375,
        -0.15404650081975046,
        -0.7936446432843639,
        -0.5847736267782171,
        0.4699831813456829,
    ],
];

/// The last two coefficients of the dense output of the others, which has order 4; the last weight is that of the rate at the end.
pub(super) const DENSE: [[f64; STAGES + 1]; 2] = [
    [
        -2.7680225371943425,
        2.422350459747559,
        -5.758354330824088,
        11.540271499330021,
        -4.051470531535011,
        -2.3145352189334862,
        -1.0588205248139093,
        2.472131508633202,
        0.9862036641161299,
        -1.4697539885260726,
    ],
    [
        -1.5416284601113064,
        -0.8070512633260841,
        12.999085232479494,
        -19.198824434561267,
        8.223212934445485,
        4.367963451619744,
        0.10817389255663339,
        -8.631872541697811,
        -3.459440034962301,
        7.94038122355741,
    ],
];
