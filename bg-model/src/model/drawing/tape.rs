//! A tape: expressions as a table of numbers, read by an interpreter.
//!
//! In: the steps that the compiler wrote, a moment of a run. Out: values. A step is an operation and its operands, each
//! a word; its value is at hand for all later steps.
//!
//! | operation | operands | value |
//! |---|---|---|
//! | 0 | number k | `numbers[k]` |
//! | 1 | 0 | time, s |
//! | 2, 3, 4, 5 | index k | state, parameter, input, slope of input k |
//! | 6 | number c, count n, n times (step, number) | c + sum of step * number |
//! | 7 | count n, n times (step, exponent) | product of step^exponent |
//! | 8 | function, its arguments | function of steps |
//! | 9 | switch k, step a, step b | a where switch k is negative, else b |
//! | 10 | index k | reaction k of the rigid joints |
//! | 11 | index k | what was found for unknown k of the algebraic loops |
//! | 12 | index k | side of root k by which a loop is closed, 1 or -1 |

use alloc::vec::Vec;

use crate::model::scalar::Scalar;

/// The steps and what is wanted of them.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tape {
    /// The numbers that steps refer to.
    pub numbers: &'static [f64],
    /// The steps.
    pub words: &'static [u32],
    /// For each wanted value the step that gives it.
    pub results: &'static [u32],
}

/// A moment of a run.
#[derive(Clone, Copy)]
pub struct Moment<'a> {
    /// Time, s.
    pub t: f64,
    /// The states.
    pub states: &'a [f64],
    /// The values of the parameters, in the order of their table.
    pub parameters: &'a [f64],
    /// Value and slope of each input, in the order of their table.
    pub inputs: &'a [[f64; 2]],
    /// Whether each switch is in the branch of its negative guard.
    pub negative: &'a [bool],
    /// The reactions of the rigid joints, where joints close loops.
    pub reactions: &'a [f64],
    /// What has been found for the unknowns of algebraic loops.
    pub found: &'a [f64],
    /// On which sides of zero the roots are by which loops are closed, 1 or -1.
    pub sides: &'a [f64],
}

impl Tape {
    /// Appends the wanted values at a moment to `values`.
    ///
    /// # Panics
    /// The moment is not one of the model that the tape was written for.
    pub fn evaluate(&self, moment: &Moment<'_>, values: &mut Vec<f64>) {
        let mut reader = Reader { words: self.words.iter(), numbers: self.numbers, steps: Vec::new() };
        while let Some(value) = reader.step(moment) {
            reader.steps.push(value);
        }
        values.extend(self.results.iter().map(|&step| reader.steps[step as usize]));
    }
}

struct Reader<'a> {
    words: core::slice::Iter<'a, u32>,
    numbers: &'a [f64],
    /// The values of the steps so far.
    steps: Vec<f64>,
}

impl Reader<'_> {
    /// The value of the next step; none after the last.
    fn step(&mut self, moment: &Moment<'_>) -> Option<f64> {
        let operation = *self.words.next()?;
        Some(match operation {
            0 => self.number(),
            1 => {
                self.index();
                moment.t
            }
            2 => moment.states[self.index()],
            3 => moment.parameters[self.index()],
            4 => moment.inputs[self.index()][0],
            5 => moment.inputs[self.index()][1],
            6 => {
                let mut sum = self.number();
                for _ in 0..self.index() {
                    let value = self.value();
                    sum += value * self.number();
                }
                sum
            }
            7 => self.product(),
            8 => self.function(),
            9 => {
                let (switch, negative, positive) = (self.index(), self.value(), self.value());
                if moment.negative[switch] { negative } else { positive }
            }
            10 => moment.reactions[self.index()],
            11 => moment.found[self.index()],
            12 => moment.sides[self.index()],
            other => unreachable!("a tape has no operation {other}"),
        })
    }

    fn word(&mut self) -> u32 {
        *self.words.next().expect("a step has all of its operands")
    }

    fn index(&mut self) -> usize {
        self.word() as usize
    }

    fn number(&mut self) -> f64 {
        let number = self.index();
        self.numbers[number]
    }

    fn value(&mut self) -> f64 {
        let step = self.index();
        self.steps[step]
    }

    fn product(&mut self) -> f64 {
        let (mut numerator, mut denominator) = (1.0, 1.0);
        for _ in 0..self.index() {
            let (value, exponent) = (self.value(), self.word().cast_signed());
            let side = if exponent > 0 { &mut numerator } else { &mut denominator };
            for _ in 0..exponent.unsigned_abs() {
                *side *= value;
            }
        }
        numerator / denominator
    }

    fn function(&mut self) -> f64 {
        let (function, x) = (self.word(), self.value());
        match function {
            0 => Scalar::sqrt(x),
            1 => Scalar::sin(x),
            2 => Scalar::cos(x),
            3 => Scalar::tan(x),
            4 => Scalar::asin(x),
            5 => Scalar::acos(x),
            6 => Scalar::atan2(x, self.value()),
            7 => Scalar::exp(x),
            8 => Scalar::ln(x),
            9 => Scalar::tanh(x),
            10 => Scalar::abs(x),
            11 => Scalar::powf(x, self.value()),
            other => unreachable!("a tape has no function {other}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_operation() {
        let tape = Tape {
            numbers: &[2.0, -3.0, 0.5],
            // 0: t, 1: state 1, 2: parameter 0, 3: input 0, 4: slope of input 0, 5: 2 - 3 t + 0.5 state,
            // 6: t^2 / state, 7: atan2(state, parameter), 8: the branch of switch 1, 9: the number -3.
            words: &[
                1,
                0,
                2,
                1,
                3,
                0,
                4,
                0,
                5,
                0,
                6,
                0,
                2,
                0,
                1,
                1,
                2,
                7,
                2,
                0,
                2,
                1,
                u32::MAX,
                8,
                6,
                1,
                2,
                9,
                1,
                5,
                6,
                0,
                1,
            ],
            results: &[9, 3, 4, 5, 6, 7, 8],
        };
        let moment = Moment {
            t: 3.0,
            states: &[0.0, 4.0],
            parameters: &[4.0],
            inputs: &[[30.0, 10.0]],
            negative: &[false, true],
            reactions: &[],
            found: &[],
            sides: &[-1.0],
        };
        let mut values = Vec::new();
        tape.evaluate(&moment, &mut values);
        assert_eq!(values, [-3.0, 30.0, 10.0, -5.0, 2.25, core::f64::consts::FRAC_PI_4, -5.0]);
        values.clear();
        tape.evaluate(&Moment { negative: &[true, false], ..moment }, &mut values);
        assert_eq!(values[6], 2.25);
    }
}
