//! The pollution problem: 20 species, 25 reactions of mass action.
//!
//! In: nothing. Out: the case. Rates and Jacobian follow from one table of reactions.

use bg_model::capability::Linearised;
use bg_model::nalgebra::SVector;
use bg_model::system::System;

use super::case::{Case, Measure};
use super::{QUAD, STIFF, problem};

const N: usize = 20;

/// A reaction: its rate constant, the species whose product it is proportional to, and what it adds of each species.
type Reaction = (f64, &'static [usize], &'static [(usize, f64)]);

/// The reactions in the order of the publication; species are counted from 1, as there.
const REACTIONS: [Reaction; 25] = [
    (0.35, &[1], &[(1, -1.0), (2, 1.0), (3, 1.0)]),
    (26.6, &[2, 4], &[(1, 1.0), (2, -1.0), (4, -1.0)]),
    (1.23e4, &[5, 2], &[(1, 1.0), (2, -1.0), (5, -1.0), (6, 1.0)]),
    (8.6e-4, &[7], &[(5, 2.0), (7, -1.0), (8, 1.0)]),
    (8.2e-4, &[7], &[(7, -1.0), (8, 1.0)]),
    (1.5e4, &[7, 6], &[(5, 1.0), (6, -1.0), (7, -1.0), (8, 1.0)]),
    (1.3e-4, &[9], &[(5, 1.0), (8, 1.0), (9, -1.0), (10, 1.0)]),
    (2.4e4, &[9, 6], &[(6, -1.0), (9, -1.0), (11, 1.0)]),
    (1.65e4, &[11, 2], &[(1, 1.0), (2, -1.0), (10, 1.0), (11, -1.0), (12, 1.0)]),
    (9e3, &[11, 1], &[(1, -1.0), (11, -1.0), (13, 1.0)]),
    (2.2e-2, &[13], &[(1, 1.0), (11, 1.0), (13, -1.0)]),
    (1.2e4, &[10, 2], &[(1, 1.0), (2, -1.0), (10, -1.0), (14, 1.0)]),
    (1.88, &[14], &[(5, 1.0), (7, 1.0), (14, -1.0)]),
    (1.63e4, &[1, 6], &[(1, -1.0), (6, -1.0), (15, 1.0)]),
    (4.8e6, &[3], &[(3, -1.0), (4, 1.0)]),
    (3.5e-4, &[4], &[(4, -1.0), (16, 1.0)]),
    (1.75e-2, &[4], &[(3, 1.0), (4, -1.0)]),
    (1e8, &[16], &[(6, 2.0), (16, -1.0)]),
    (4.44e11, &[16], &[(3, 1.0), (16, -1.0)]),
    (1.24e3, &[17, 6], &[(5, 1.0), (6, -1.0), (17, -1.0), (18, 1.0)]),
    (2.1, &[19], &[(2, 1.0), (19, -1.0)]),
    (5.78, &[19], &[(1, 1.0), (3, 1.0), (19, -1.0)]),
    (4.74e-2, &[1, 4], &[(1, -1.0), (4, -1.0), (19, 1.0)]),
    (1.78e3, &[19, 1], &[(1, -1.0), (19, -1.0), (20, 1.0)]),
    (3.12, &[20], &[(1, 1.0), (19, 1.0), (20, -1.0)]),
];

/// The chemical part of an air-pollution model.
struct Pollution;

impl System<f64, N, 0> for Pollution {
    fn rate(&self, _: f64, y: &SVector<f64, N>, _: &[bool; 0], dy: &mut SVector<f64, N>) {
        dy.fill(0.0);
        for (constant, reactants, changes) in REACTIONS {
            let rate = reactants.iter().fold(constant, |rate, species| rate * y[species - 1]);
            for (species, share) in changes {
                dy[species - 1] += share * rate;
            }
        }
    }

    fn linearised(&self) -> Option<&impl Linearised<f64, N, 0>> {
        Some(self)
    }
}

impl Linearised<f64, N, 0> for Pollution {
    fn jacobian(&self, _: f64, y: &SVector<f64, N>, _: &[bool; 0], entries: &mut [f64], slope: &mut SVector<f64, N>) {
        entries.fill(0.0);
        slope.fill(0.0);
        for (constant, reactants, changes) in REACTIONS {
            for (k, column) in reactants.iter().enumerate() {
                let others = reactants.iter().enumerate().filter(|(other, _)| *other != k);
                let derivative = others.fold(constant, |rate, (_, species)| rate * y[species - 1]);
                for (species, share) in changes {
                    entries[(column - 1) * N + species - 1] += share * derivative;
                }
            }
        }
    }
}

/// The pollution problem to t = 60 min.
#[must_use]
pub fn pollution() -> Case {
    let mut start = [0.0; N];
    for (species, value) in [(2, 0.2), (4, 0.04), (7, 0.1), (8, 0.3), (9, 0.01), (17, 0.007)] {
        start[species - 1] = value;
    }
    Case {
        name: "pollution",
        source: "Bari Test Set for IVP Solvers, POLLU (github cran/deTestSet, R/ex_pollution.R)",
        held_against: QUAD,
        measure: Measure::Relative,
        absolute: 1e-16,
        amplification: 1.0,
        floor: 1e-13,
        instants: vec![1.0, 10.0, 60.0],
        reference: vec![
            vec![
                0.03732630429886385,
                0.16251325412678647,
                2.734438930611227e-09,
                0.003299406575690944,
                3.1151619387247727e-07,
                2.6534918501662523e-07,
                0.09942310366621186,
                0.3006173127757484,
                0.00992699493831523,
                2.9529601826602432e-08,
                2.0994901154651784e-08,
                6.571492956826672e-05,
                5.9742964653865925e-06,
                2.785863950612213e-05,
                0.00013959464032071978,
                2.6002979092384103e-18,
                0.006997397465743566,
                2.6025342564343066e-06,
                3.8171954507742246e-07,
                7.245459009254926e-06,
            ],
            vec![
                0.041823150220558436,
                0.15646463318652837,
                3.063574587820955e-09,
                0.0035046427091080115,
                2.874315071051327e-07,
                2.3614856610373728e-07,
                0.09511790540292622,
                0.3054168460573193,
                0.009388686630581362,
                2.602707680209174e-08,
                1.8455864393120643e-08,
                0.0005358670099478226,
                6.284309219046804e-05,
                2.6259145457410806e-05,
                0.0016119664792476264,
                2.7620467196301847e-18,
                0.0069776919716044465,
                2.2308028395553098e-05,
                7.781798636736401e-07,
                1.831442080570747e-05,
            ],
            vec![
                0.056462554800227695,
                0.13424841304223384,
                4.139734331099427e-09,
                0.00552314020748436,
                2.018977262302196e-07,
                1.4645418634939657e-07,
                0.07784249118997964,
                0.3245075353396018,
                0.007494013383880406,
                1.6222931573015602e-08,
                1.1358638332570748e-08,
                0.00223050597572136,
                0.000208716288279863,
                1.3969210168401577e-05,
                0.008964884856898295,
                4.352846369330104e-18,
                0.006899219696263405,
                0.0001007803037365946,
                1.7721465139699844e-06,
                5.682943292316393e-05,
            ],
        ],
        moderate: 1e-6,
        fitting: STIFF,
        problem: problem::states(Pollution, start),
    }
}
