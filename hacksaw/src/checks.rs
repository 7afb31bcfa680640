//! What the paper says its figures show, checked on a trajectory.
//!
//! In: a trajectory. Out: each statement with what was measured and whether it holds. With other parameters than the
//! paper's a statement may honestly not hold; that is a finding, not a fault.

use std::f64::consts::TAU;

use bg_model::simulation::{MissingColumn, Recording};
use bg_workbench::summary::Check;

use crate::columns::{AXES, continued};

/// What stands still moves less than this: m, rad or a part of the moving component. The model is exact there; what is
/// left is rounding.
const STILL: f64 = 1e-9;
/// A path is a circle where its radius is off by less than this part. The crank's pin is compliant: in the paper's case
/// it gives way by 0.7 mm, a fiftieth of the radius.
const ROUND: f64 = 0.05;
/// What moves, moves by more than this, m or rad: a fiftieth of the crank's throw of 0.075 m.
const MOVING: f64 = 1.5e-3;
/// Frame and guide move together where their angles differ by less than this part of the frame's swing. Their coupling
/// is compliant: in the paper's case it gives way by a twelfth.
const TOGETHER: f64 = 0.2;
/// "At the start" is the first part of a run, s.
const START: f64 = 1.0;

/// All statements about a trajectory.
///
/// # Errors
/// A column is missing.
pub fn check(trajectory: &Recording) -> Result<Vec<Check>, MissingColumn> {
    if trajectory.times.is_empty() {
        return Ok(Vec::new());
    }
    let data = Data { trajectory };
    Ok(vec![
        data.crank_vectors()?,
        data.crank_axis()?,
        data.crank_angular_momentum()?,
        data.crank_path()?,
        data.rod_angular_momentum()?,
        data.rod_oscillates()?,
        data.rod_moves()?,
        data.rod_plane()?,
        data.frame_slides()?,
        data.frame_descends()?,
        data.frame_plane()?,
        data.guide_angular_momentum()?,
    ])
}

struct Data<'a> {
    trajectory: &'a Recording,
}

type Measured = Result<Check, MissingColumn>;

impl Data<'_> {
    fn values(&self, name: &str) -> Result<&[f64], MissingColumn> {
        self.trajectory.values(name)
    }

    /// The angle of a link about z, rad, whole turns counted.
    fn angle(&self, link: u8) -> Result<Vec<f64>, MissingColumn> {
        let (sine, cosine) = (self.values(&format!("R{link}_21"))?, self.values(&format!("R{link}_11"))?);
        Ok(continued(sine.iter().zip(cosine).map(|(sine, cosine)| sine.atan2(*cosine))))
    }

    /// The largest change of any component of a link's z axis since the start, and of its z coordinate.
    fn out_of_plane(&self, link: u8) -> Result<(f64, f64), MissingColumn> {
        let [x, y, z] = [1, 2, 3].map(|row| self.values(&format!("R{link}_{row}3")).map(largest_change));
        Ok((largest(&[x?, y?, z?]), largest_change(self.values(&format!("C{link}_z"))?)))
    }

    fn crank_vectors(&self) -> Measured {
        let mut deviations = Vec::new();
        for column in [1, 2] {
            let [x, y, z] = [1, 2, 3].map(|row| self.values(&format!("R2_{row}{column}")));
            let (x, y, z) = (x?, y?, z?);
            deviations.extend(x.iter().zip(y).map(|(x, y)| x.hypot(*y) - 1.0).chain(z.iter().copied()));
        }
        let deviation = largest(&deviations);
        let turns = span(&self.angle(2)?) / TAU;
        Ok(Check {
            figure: "Fig. 4",
            statement: "The crank's x and y unit vectors run on circles.",
            measured: format!("{turns:.2} turns; off the unit circle by {} at most", small(deviation)),
            holds: deviation < STILL && turns >= 1.0,
        })
    }

    fn crank_axis(&self) -> Measured {
        let (axis, _) = self.out_of_plane(2)?;
        Ok(Check {
            figure: "Fig. 4",
            statement: "The crank's z unit vector stands still.",
            measured: format!("largest change of a component {}", small(axis)),
            holds: axis < STILL,
        })
    }

    fn crank_angular_momentum(&self) -> Measured {
        let [x, y, z] = AXES.map(|axis| self.values(&format!("h2_{axis}")));
        let across = largest(&[largest(x?), largest(y?)]);
        let along = span(z?);
        Ok(Check {
            figure: "Fig. 5",
            statement: "Only the z component of the crank's angular momentum varies.",
            measured: format!("z varies by {along:.4} N m s, x and y are {} N m s at most", small(across)),
            holds: along > 0.0 && across < STILL * along,
        })
    }

    fn crank_path(&self) -> Measured {
        let (x, y) = (self.values("C2_x")?, self.values("C2_y")?);
        let radii: Vec<f64> = x.iter().zip(y).map(|(x, y)| x.hypot(*y)).collect();
        let mean = radii.iter().sum::<f64>() / radii.len() as f64;
        let deviation = largest(&radii.iter().map(|radius| radius - mean).collect::<Vec<_>>());
        let turns = span(&continued(y.iter().zip(x).map(|(y, x)| y.atan2(*x)))) / TAU;
        Ok(Check {
            figure: "Fig. 7",
            statement: "C2 runs on a circle.",
            measured: format!("{turns:.2} turns; radius {mean:.6} m, off by {} m at most", small(deviation)),
            holds: deviation < ROUND * mean && turns >= 1.0,
        })
    }

    fn rod_angular_momentum(&self) -> Measured {
        let (h, angle) = (self.values("h3_z")?, self.angle(2)?);
        let start = angle[0];
        let peak = |turn: f64| {
            let inside = |angle: f64| (turn..turn + 1.0).contains(&((angle - start).abs() / TAU));
            largest(&h.iter().zip(&angle).filter(|(_, angle)| inside(**angle)).map(|(h, _)| *h).collect::<Vec<_>>())
        };
        let (first, second) = (peak(0.0), peak(1.0));
        Ok(Check {
            figure: "Fig. 8",
            statement: "The rod's angular momentum grows at first, from the constant torque.",
            measured: format!("largest |h3_z| {first:.3} N m s in the crank's first turn, {second:.3} in its second"),
            holds: second > first,
        })
    }

    fn rod_moves(&self) -> Measured {
        let (x, y) = (span(self.values("C3_x")?), span(self.values("C3_y")?));
        Ok(Check {
            figure: "Fig. 11",
            statement: "The rod moves in x and y.",
            measured: format!("C3 covers {x:.4} m in x and {y:.4} m in y"),
            holds: x > MOVING && y > MOVING,
        })
    }

    fn rod_oscillates(&self) -> Measured {
        let angle = self.angle(3)?;
        let (reversals, range) = (reversals(&angle, MOVING), span(&angle));
        Ok(Check {
            figure: "Fig. 10",
            statement: "The rod oscillates about z.",
            measured: format!("{reversals} reversals within {range:.4} rad"),
            holds: reversals >= 2 && range < TAU / 2.0,
        })
    }

    fn rod_plane(&self) -> Measured {
        let (axis, z) = self.out_of_plane(3)?;
        Ok(Check {
            figure: "Fig. 10, 11",
            statement: "The rod's z does not change.",
            measured: format!("largest change: C3_z {} m, z unit vector {}", small(z), small(axis)),
            holds: axis < STILL && z < STILL,
        })
    }

    fn frame_slides(&self) -> Measured {
        let x = self.values("C4_x")?;
        let (reversals, range) = (reversals(x, MOVING), span(x));
        Ok(Check {
            figure: "Fig. 15",
            statement: "The frame slides to and fro in x.",
            measured: format!("{reversals} reversals within {range:.4} m"),
            holds: reversals >= 2,
        })
    }

    fn frame_descends(&self) -> Measured {
        let (y, frame, guide) = (self.values("C4_y")?, self.angle(4)?, self.angle(5)?);
        // Half of the samples are enough strokes for a mean.
        let late = &y[y.len() / 2..];
        let descent = y[0] - late.iter().sum::<f64>() / late.len() as f64;
        let swing = span(&frame);
        let apart = largest(&frame.iter().zip(&guide).map(|(frame, guide)| frame - guide).collect::<Vec<_>>());
        Ok(Check {
            figure: "Fig. 14, 15",
            statement: "The frame moves downward with the guide.",
            measured: format!(
                "C4 is {descent:.4} m lower in the mean of the second half than at the start; \
                 the frame swings by {swing:.4} rad, the guide with it within {apart:.4} rad"
            ),
            holds: descent > MOVING && apart < TOGETHER * swing,
        })
    }

    fn frame_plane(&self) -> Measured {
        let (axis, z) = self.out_of_plane(4)?;
        Ok(Check {
            figure: "Fig. 14, 15",
            statement: "The frame's z stays.",
            measured: format!("largest change: C4_z {} m, z unit vector {}", small(z), small(axis)),
            holds: axis < STILL && z < STILL,
        })
    }

    fn guide_angular_momentum(&self) -> Measured {
        let (times, h) = (&self.trajectory.times, self.values("h5_z")?);
        let early = times.partition_point(|&t| t <= START);
        let settled = times.partition_point(|&t| t <= times[times.len() - 1] / 2.0).max(early);
        let (peak, after) = (largest(&h[..early]), largest(&h[settled..]));
        let measured = if settled < h.len() {
            format!(
                "from rest to |h5_z| = {peak:.3} N m s in the first {START} s; \
                later, in the second half, {after:.3} at most"
            )
        } else {
            format!("from rest to |h5_z| = {peak:.3} N m s in the first {START} s; the run ends before it settles")
        };
        Ok(Check {
            figure: "Fig. 17",
            statement: "The guide's angular momentum changes sharply at the start, from the sudden torque.",
            measured,
            holds: peak > after && settled < h.len(),
        })
    }
}

/// A deviation as text.
fn small(value: f64) -> String {
    if value == 0.0 { "0".to_owned() } else { format!("{value:.1e}") }
}

/// The largest value without its sign; not a number where one is none, so that no statement holds of it.
fn largest(values: &[f64]) -> f64 {
    let worse = |most: f64, value: f64| if most >= value || most.is_nan() { most } else { value };
    values.iter().map(|value| value.abs()).fold(0.0, worse)
}

/// The largest difference from the first value; not a number where one value is none.
fn largest_change(values: &[f64]) -> f64 {
    largest(&values.iter().map(|value| value - values[0]).collect::<Vec<_>>())
}

/// The largest value less the smallest; not a number where one value is none.
fn span(values: &[f64]) -> f64 {
    let changes = values.iter().map(|value| value - values[0]);
    let (below, above): (Vec<f64>, Vec<f64>) = changes.partition(|change| *change < 0.0);
    largest(&below) + largest(&above)
}

/// How often values, of which there is one at least, turn back by more than `threshold`, which has their unit.
#[must_use]
pub fn reversals(values: &[f64], threshold: f64) -> usize {
    let mut count = 0;
    // The farthest value since the last reversal, and the direction; 0 before the first motion.
    let (mut farthest, mut direction) = (values[0], 0.0);
    for &value in values {
        if direction == 0.0 {
            if (value - farthest).abs() > threshold {
                direction = (value - farthest).signum();
                farthest = value;
            }
        } else if (value - farthest) * direction > 0.0 {
            farthest = value;
        } else if (farthest - value) * direction > threshold {
            count += 1;
            direction = -direction;
            farthest = value;
        }
    }
    count
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_statement_holds_of_what_is_no_number() {
        assert_eq!(
            (largest(&[1.0, -3.0]), largest_change(&[1.0, -3.0, 2.0]), span(&[1.0, -3.0, 2.0])),
            (3.0, 4.0, 5.0)
        );
        for place in 0..3 {
            let mut values = [1.0, -3.0, 2.0];
            values[place] = f64::NAN;
            assert!([largest(&values), largest_change(&values), span(&values)].iter().all(|of| of.is_nan()), "{place}");
        }
    }
}
