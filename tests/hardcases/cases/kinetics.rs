//! Chemical kinetics: Robertson, HIRES, E5, the Oregonator.
//!
//! In: nothing. Out: cases. Each is stiff with negative real eigenvalues, and held against Radau IIA of orders 13 and
//! 17 in quad precision, whose two runs agree to 14 digits and more.

use bg_model::capability::Linearised;
use bg_model::nalgebra::SVector;
use bg_model::system::System;

use super::case::{Case, Measure};
use super::{QUAD, STIFF, dense, problem};

/// Robertson's reaction.
struct Robertson;

impl System<f64, 3, 0> for Robertson {
    fn rate(&self, _: f64, y: &SVector<f64, 3>, _: &[bool; 0], dy: &mut SVector<f64, 3>) {
        let [r1, r2, r3] = [0.04 * y[0], 3e7 * y[1] * y[1], 1e4 * y[1] * y[2]];
        *dy = SVector::from([-r1 + r3, r1 - r2 - r3, r2]);
    }

    fn linearised(&self) -> Option<&impl Linearised<f64, 3, 0>> {
        Some(self)
    }
}

impl Linearised<f64, 3, 0> for Robertson {
    fn jacobian(&self, _: f64, y: &SVector<f64, 3>, _: &[bool; 0], entries: &mut [f64], slope: &mut SVector<f64, 3>) {
        let [square, a, b] = [6e7 * y[1], 1e4 * y[2], 1e4 * y[1]];
        dense([[-0.04, a, b], [0.04, -square - a, -b], [0.0, square, 0.0]], entries, slope);
    }
}

/// Robertson to 1e11: fourteen orders of magnitude in time, y2 falls to 1e-13.
#[must_use]
pub fn robertson() -> Case {
    Case {
        name: "robertson",
        source: "Bari Test Set for IVP Solvers, ROBER (github cran/deTestSet, R/ex_rober.R)",
        held_against: QUAD,
        measure: Measure::Relative,
        absolute: 1e-14,
        amplification: 1.0,
        floor: 1e-13,
        instants: vec![0.4, 40.0, 4e3, 4e5, 4e7, 1e11],
        reference: vec![
            vec![0.9851721138609899, 3.386395378974904e-05, 0.014794022185220388],
            vec![0.715827068719405, 9.185534764557764e-06, 0.28416374574583037],
            vec![0.18320225777670932, 8.94237125277591e-07, 0.8167968479861654],
            vec![0.004938274520979815, 1.9849940879543756e-08, 0.9950617056290793],
            vec![5.2030718441205475e-05, 2.0813357318925326e-10, 0.9999479690734252],
            vec![2.083340149701294e-08, 8.333360770334784e-14, 0.9999999791665152],
        ],
        moderate: 1e-6,
        fitting: STIFF,
        problem: problem::states(Robertson, [1.0, 0.0, 0.0]),
    }
}

/// High irradiance responses of photomorphogenesis.
struct Hires;

impl System<f64, 8, 0> for Hires {
    fn rate(&self, _: f64, y: &SVector<f64, 8>, _: &[bool; 0], dy: &mut SVector<f64, 8>) {
        let d6 = 280.0 * y[5] * y[7] - 1.81 * y[6];
        *dy = SVector::from([
            -1.71 * y[0] + 0.43 * y[1] + 8.32 * y[2] + 0.0007,
            1.71 * y[0] - 8.75 * y[1],
            -10.03 * y[2] + 0.43 * y[3] + 0.035 * y[4],
            8.32 * y[1] + 1.71 * y[2] - 1.12 * y[3],
            -1.745 * y[4] + 0.43 * y[5] + 0.43 * y[6],
            -280.0 * y[5] * y[7] + 0.69 * y[3] + 1.71 * y[4] - 0.43 * y[5] + 0.69 * y[6],
            d6,
            -d6,
        ]);
    }

    fn linearised(&self) -> Option<&impl Linearised<f64, 8, 0>> {
        Some(self)
    }
}

impl Linearised<f64, 8, 0> for Hires {
    fn jacobian(&self, _: f64, y: &SVector<f64, 8>, _: &[bool; 0], entries: &mut [f64], slope: &mut SVector<f64, 8>) {
        let [a, b] = [280.0 * y[7], 280.0 * y[5]];
        let rows = [
            [-1.71, 0.43, 8.32, 0.0, 0.0, 0.0, 0.0, 0.0],
            [1.71, -8.75, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, -10.03, 0.43, 0.035, 0.0, 0.0, 0.0],
            [0.0, 8.32, 1.71, -1.12, 0.0, 0.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 0.0, -1.745, 0.43, 0.43, 0.0],
            [0.0, 0.0, 0.0, 0.69, 1.71, -a - 0.43, 0.69, -b],
            [0.0, 0.0, 0.0, 0.0, 0.0, a, -1.81, b],
            [0.0, 0.0, 0.0, 0.0, 0.0, -a, 1.81, -b],
        ];
        dense(rows, entries, slope);
    }
}

/// HIRES to t = 321.8122.
#[must_use]
pub fn hires() -> Case {
    Case {
        name: "hires",
        source: "Bari Test Set for IVP Solvers, HIRES (github cran/deTestSet, R/ex_hires.R)",
        held_against: QUAD,
        measure: Measure::Relative,
        absolute: 1e-6,
        amplification: 1.0,
        floor: 1e-13,
        instants: vec![10.0, 100.0, 300.0, 321.8122],
        reference: vec![
            vec![
                0.008324735469236576,
                0.0016526725080012942,
                0.001410342659307849,
                0.017433224297452265,
                0.1857204640652447,
                0.7494166221553578,
                0.005651253341825106,
                4.8746658174894655e-05,
            ],
            vec![
                0.0045208593641245165,
                0.0008839056323374763,
                0.0007971942865685902,
                0.007811326061370791,
                0.13238525409506346,
                0.5301676923204691,
                0.005631339757843243,
                6.866024215675676e-05,
            ],
            vec![
                0.0010211076081657745,
                0.00019989944853184133,
                0.0001135414734690615,
                0.0016826415185746178,
                0.011779282233421895,
                0.04163910043221187,
                0.004936473121081306,
                0.0007635268789186942,
            ],
            vec![
                0.0007371312573325667,
                0.00014424857263161848,
                5.888729740967575e-05,
                0.001175651343283149,
                0.0023863561988313304,
                0.0062389682527427956,
                0.0028499983951857685,
                0.0028500016048142313,
            ],
        ],
        moderate: 1e-6,
        fitting: STIFF,
        problem: problem::states(Hires, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0057]),
    }
}

/// Problem E5 of stiff DETEST. y3' is formed as y2' - y4': the sum of the four rates loses all digits late.
struct E5;

impl E5 {
    const A: f64 = 7.89e-10;
    const B: f64 = 1.1e7;
    const C: f64 = 1.13e3;
    const M: f64 = 1e6;
}

impl System<f64, 4, 0> for E5 {
    fn rate(&self, _: f64, y: &SVector<f64, 4>, _: &[bool; 0], dy: &mut SVector<f64, 4>) {
        let (p1, p2) = (Self::A * y[0], Self::B * y[0] * y[2]);
        let (p3, p4) = (Self::M * Self::C * y[1] * y[2], Self::C * y[3]);
        let (d2, d4) = (p1 - p3, p2 - p4);
        *dy = SVector::from([-p1 - p2, d2, d2 - d4, d4]);
    }

    fn linearised(&self) -> Option<&impl Linearised<f64, 4, 0>> {
        Some(self)
    }
}

impl Linearised<f64, 4, 0> for E5 {
    fn jacobian(&self, _: f64, y: &SVector<f64, 4>, _: &[bool; 0], entries: &mut [f64], slope: &mut SVector<f64, 4>) {
        let mc = Self::M * Self::C;
        let second = [Self::A, -mc * y[2], -mc * y[1], 0.0];
        let fourth = [Self::B * y[2], 0.0, Self::B * y[0], -Self::C];
        let third = std::array::from_fn(|i| second[i] - fourth[i]);
        dense([[-Self::A - Self::B * y[2], 0.0, -Self::B * y[0], 0.0], second, third, fourth], entries, slope);
    }
}

/// E5 to 1e9: beyond that, rounding of y2 - y3 - y4 = 0 spoils every method in double precision.
#[must_use]
pub fn e5() -> Case {
    Case {
        name: "e5",
        source: "Bari Test Set for IVP Solvers, E5 (github cran/deTestSet, R/ex_e5.R); to 1e9 only",
        held_against: QUAD,
        measure: Measure::Relative,
        absolute: 1e-20,
        amplification: 1.0,
        floor: 1e-9,
        instants: vec![10.0, 1e3, 1e5, 1e7, 1e9],
        reference: vec![
            vec![0.0017599259497677897, 1.3846281519376517e-11, 7.637003853007391e-13, 1.3082581134075777e-11],
            vec![0.0016180769999072943, 1.3822370304983736e-10, 8.251573500683834e-12, 1.2997212954915352e-10],
            vec![7.481320822429222e-06, 2.3734781561205976e-12, 2.2123586689581663e-12, 1.6111948716243113e-13],
            vec![4.715033363040164e-10, 1.8188895860807023e-14, 1.8188812376786725e-14, 8.348402029632169e-20],
            vec![3.1317148329356996e-14, 1.4840957952870065e-16, 1.4840957948345692e-16, 4.524372827978262e-26],
        ],
        moderate: 1e-6,
        fitting: STIFF,
        problem: problem::states(E5, [1.76e-3, 0.0, 0.0, 0.0]),
    }
}

/// The Oregonator of the Belousov-Zhabotinskii reaction.
struct Oregonator;

impl Oregonator {
    const S: f64 = 77.27;
    const Q: f64 = 8.375e-6;
    const W: f64 = 0.161;
}

impl System<f64, 3, 0> for Oregonator {
    fn rate(&self, _: f64, y: &SVector<f64, 3>, _: &[bool; 0], dy: &mut SVector<f64, 3>) {
        *dy = SVector::from([
            Self::S * (y[1] + y[0] * (1.0 - Self::Q * y[0] - y[1])),
            (y[2] - (1.0 + y[0]) * y[1]) / Self::S,
            Self::W * (y[0] - y[2]),
        ]);
    }

    fn linearised(&self) -> Option<&impl Linearised<f64, 3, 0>> {
        Some(self)
    }
}

impl Linearised<f64, 3, 0> for Oregonator {
    fn jacobian(&self, _: f64, y: &SVector<f64, 3>, _: &[bool; 0], entries: &mut [f64], slope: &mut SVector<f64, 3>) {
        let rows = [
            [Self::S * (1.0 - 2.0 * Self::Q * y[0] - y[1]), Self::S * (1.0 - y[0]), 0.0],
            [-y[1] / Self::S, -(1.0 + y[0]) / Self::S, 1.0 / Self::S],
            [Self::W, 0.0, -Self::W],
        ];
        dense(rows, entries, slope);
    }
}

/// The Oregonator through its first two relaxations, to t = 360.
#[must_use]
pub fn oregonator() -> Case {
    Case {
        name: "oregonator",
        source: "Bari Test Set for IVP Solvers, OREGO (github cran/deTestSet, R/ex_orego.R)",
        held_against: QUAD,
        measure: Measure::Relative,
        absolute: 1e-2,
        amplification: 1.0,
        floor: 1e-12,
        instants: vec![30.0, 60.0, 180.0, 300.0, 360.0],
        reference: vec![
            vec![1.0006614671804968, 1512.7789373482503, 10358.543127672276],
            vec![1.0008746251996257, 1144.3369723844962, 83.72149966624625],
            vec![1.0197634725372982, 51.597613229475336, 1.016985778956374],
            vec![1.7797247519370194, 2.2818523855424018, 1.613754023671725],
            vec![1.0008148703185227, 1228.178521549888, 132.05549428465082],
        ],
        moderate: 1e-6,
        fitting: STIFF,
        problem: problem::states(Oregonator, [1.0, 2.0, 3.0]),
    }
}
