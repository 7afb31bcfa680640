//! What is given: four digits of each coefficient where the search starts, and of the error estimates.
//!
//! An earlier search left them, by nonlinear least squares over errors of one step on linear oscillators. Its program
//! is lost. The conditions and the errors on the model oscillators decide on all further digits.

/// For states of second order, stage by stage from the third one on, then the end of the step. A stage's first weight
/// follows from its instant and the others.
pub const SECOND: [&[f64]; 8] = [
    &[0.02534],
    &[0.01047, 0.01957],
    &[0.279, -0.0448, 0.08214],
    &[0.06438, 0.07513, 0.03729, 0.01499],
    &[0.08255, 0.03003, 0.1005, 0.01651, 0.02262],
    &[0.2378, -0.04607, 0.2433, 0.002401, 0.03963, 0.06504],
    &[0.01996, 0.2527, -0.005172, 0.1033, 0.07799, 0.01411, 0.01952],
    &[-0.06845, 0.135, 0.05632, 0.1896, 0.03257, 0.06576, 0.07075, 0.01585, 0.002602],
];

/// For the others, stage by stage from the second one on, then the end of the step.
pub const FIRST: [&[f64]; 9] = [
    &[0.009183],
    &[-0.5795, 0.6919],
    &[-0.1779, 0.176, 0.2417],
    &[-0.2679, -0.01616, 0.5506, 0.2027],
    &[0.3542, -0.05317, -0.07171, -0.03352, 0.3354],
    &[-0.06295, 0.05561, 0.17, 0.2285, -0.01048, 0.2797],
    &[-0.193, 0.08028, 0.2492, 0.2528, 0.03465, 0.119, 0.3545],
    &[0.1909, 0.09172, 0.01561, 0.1191, -0.01389, 0.1319, 0.06784, 0.3495],
    &[-0.06782, 0.1356, 0.0634, 0.2496, 0.06118, 0.1402, 0.2085, 0.1546, 0.05476],
];

/// The difference to the embedded method, for states of second order.
pub const SECOND_ERROR: [f64; 9] = [0.4143, -0.2275, -0.5325, 0.4518, -0.1033, -0.02942, 0.02607, 0.001054, -0.0004224];

/// The difference to the embedded method, for the others. The conditions up to order 4 leave two directions. A scan of
/// the angle between them gave this one, in which the estimate of an oscillation stays far above its error and every
/// tree of order 5 is seen, and its size: 20 times the error of an undamped oscillation at 6 in frequency times step.
pub const FIRST_ERROR: [f64; 9] = [-9.799, 8.637, 5.626, -6.83, 3.428, -0.154, -0.7936, -0.5848, 0.47];
