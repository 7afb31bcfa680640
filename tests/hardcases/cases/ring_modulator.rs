//! The ring modulator: two transformers with centre taps, four diodes in a ring, in bond-graph words.
//!
//! In: nothing. Out: the case. Lightly damped oscillations of 3e7 1/s meet diodes of 1e10 1/s.

use bg_model::bond_graph;

use super::case::{Case, Measure};
use super::{QUAD, STIFF, problem};

bond_graph! {
    /// Two signals are multiplied: one at 1 kHz comes through `signal`, one at 10 kHz through `carrier`.
    pub graph RingModulator {
        /// Capacitances at the outer windings.
        param outer: F = 1.6e-8, above 0;
        /// Stray capacitances at the ring.
        param stray: F = 2e-12, above 0;
        /// Capacitance at the carrier.
        param middle: F = 1e-8, above 0;
        /// Saturation current of the diodes.
        param saturation: A = 40.67286402e-9, above 0;
        /// Thermal voltage of the diodes; its reciprocal is the published number.
        param thermal: V = 1 / 17.7493332, above 0;

        0 n1, n2, n3, n4, n5, n6, n7: electrical;
        C c1 = outer; R r1 = 25e3; I l1 = 4.45; n1 -> c1; n1 -> r1; n1 -> l1;
        C c2 = outer; R r2 = 25e3; I l2 = 4.45; n2 -> c2; n2 -> r2; n2 -> l2;
        C c3 = stray; n3 -> c3; C c4 = stray; n4 -> c4; C c5 = stray; n5 -> c5; C c6 = stray; n6 -> c6;
        C c7 = middle; R r7 = 50; n7 -> c7; n7 -> r7;

        1 b3, b4, b5, b6: electrical;
        I l3 = 5e-4; R r3 = 17.3; TF t3 = 2; n1 -> t3 -> b3 -> n3; b3 -> l3; b3 -> r3;
        I l4 = 5e-4; R r4 = 17.3; TF t4 = 0.5; n4 -> b4 -> t4 -> n1; b4 -> l4; b4 -> r4;
        I l5 = 5e-4; R r5 = 17.3; TF t5 = 2; n2 -> t5 -> b5 -> n5; b5 -> l5; b5 -> r5;
        I l6 = 5e-4; R r6 = 17.3; TF t6 = 0.5; n6 -> b6 -> t6 -> n2; b6 -> l6; b6 -> r6;

        1 b7, b8: electrical;
        Se signal = 0.5 * sin(6283.185307179586 * t);
        I l7 = 2e-3; R r77 = 86.3; signal -> b7 -> n1; b7 -> l7; b7 -> r77;
        I l8 = 2e-3; R r8 = 636.3; b8 -> n2; b8 -> l8; b8 -> r8;

        0 carrier: electrical;
        Se oscillator = 2 * sin(62831.85307179586 * t);
        oscillator -> carrier;
        1 d1, d2, d3, d4: electrical;
        R diode1(effort u) = saturation * (exp(u / thermal) - 1);
        R diode2(effort u) = saturation * (exp(u / thermal) - 1);
        R diode3(effort u) = saturation * (exp(u / thermal) - 1);
        R diode4(effort u) = saturation * (exp(u / thermal) - 1);
        n3 -> d1 -> n5; d1 -> n7; d1 -> carrier; d1 -> diode1;
        n6 -> d2 -> n4; d2 -> n7; d2 -> carrier; d2 -> diode2;
        n4 -> d3; n5 -> d3; n7 -> d3; carrier -> d3; d3 -> diode3;
        n7 -> d4 -> n3; carrier -> d4 -> n6; d4 -> diode4;

        observe {
            u1: V = n1.effort; u2: V = n2.effort; u3: V = n3.effort; u4: V = n4.effort; u5: V = n5.effort;
            u6: V = n6.effort; u7: V = n7.effort; i1: A = -l1.flow; i2: A = -l2.flow; i3: A = b3.flow; i4: A = b4.flow;
            i5: A = b5.flow; i6: A = b6.flow; i7: A = b7.flow; i8: A = b8.flow;
        }
    }
}

/// The ring modulator over the carrier's first ten periods, to t = 1 ms.
///
/// # Panics
/// Never: the parameters are in range.
#[must_use]
pub fn ring_modulator() -> Case {
    let model = RingModulator::new(RingModulatorParameters::default()).expect("the defaults are in range");
    Case {
        name: "ring-modulator",
        source: "Bari Test Set for IVP Solvers, ring modulator as an ODE (github cran/deTestSet, R/ex_ring.R)",
        held_against: QUAD,
        measure: Measure::Scaled,
        absolute: 1e-14,
        amplification: 1.0,
        floor: 1e-10,
        instants: vec![2.5e-4, 5e-4, 7.5e-4, 1e-3],
        reference: vec![
            vec![
                0.4893865970380441,
                -0.345099476323692,
                -0.060796062480961234,
                0.5741532834749002,
                0.12714464201860265,
                -0.5078047039372589,
                -0.11186120464342537,
                -1.545767299333859e-05,
                1.5647299451413047e-06,
                -0.0001349715172192417,
                -0.0014218852127808512,
                0.001422436002918873,
                0.00013442072708121994,
                0.0005852129747261517,
                0.0005557175451966829,
            ],
            vec![
                0.020736224931860607,
                0.0054937131293245215,
                0.40519601159666874,
                -0.2595561036512472,
                -0.2617942353540423,
                0.4029578798938736,
                0.11067561641932572,
                -3.1623281302806886e-05,
                -1.6179437927873066e-08,
                0.0007892576976341193,
                0.0007303945013523447,
                -0.0007907358011594344,
                -0.0007289163978270298,
                -4.254926702308735e-05,
                -2.0895432412136194e-05,
            ],
            vec![
                -0.4920746902908161,
                0.34695080794409183,
                -0.5823715133213834,
                0.05200353620343083,
                0.5152899446178207,
                -0.11908510490699338,
                -0.11187582342118726,
                -1.60068859600933e-05,
                -1.62693472916479e-06,
                -0.001425780099063855,
                -0.00013157990472932558,
                0.0001315396494422167,
                0.0014258203543509639,
                -0.0005568823077873547,
                -0.0005587419248575478,
            ],
            vec![
                -0.023390573584371598,
                -0.007367485486008226,
                0.2582956709991919,
                -0.4064465720588011,
                -0.40394556644554414,
                0.2607966766124488,
                0.11067618612732984,
                2.939904342433007e-07,
                -2.840029933066481e-08,
                0.0007267198267291457,
                0.0007929487197023235,
                -0.0007255283495765844,
                -0.0007941401968548848,
                7.088495416875679e-05,
                2.390059075277106e-05,
            ],
        ],
        moderate: 1e-4,
        fitting: STIFF,
        problem: problem::outputs(model, |y| y.to_vec()),
    }
}
