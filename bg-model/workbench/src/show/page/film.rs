//! A run as a film: the columns of what is shown, put together as bodies, joints and bonds.
//!
//! In: the drawing of a description, a run whose last columns are those of [`Part::Shown`]. Out: the
//! [`Animation`] and the series of the bonds. What a scene does not know is left out.

use bg_model::description::Description;
use bg_model::drawing::{self, Drawing, Place};
use bg_model::nalgebra::{Matrix3, Rotation3, UnitQuaternion};
use bg_model::run::Trajectory;
use bg_model::simulation::{Column, Part};

use super::animation::{Animation, BodyTrack, JointTrack, NamedPoint, Shape, Solid};
use super::picture::{BondSeries, Picture};
use super::{Linearised, Views};
use crate::ask::machine::Machine;

/// What is shown of a run, by its columns.
pub struct Film {
    description: &'static Description,
    times: Vec<f64>,
    columns: Vec<Column>,
}

impl Film {
    /// Takes the columns of what is shown, which were asked for last, out of a run.
    pub fn taken(description: &'static Description, run: &mut Trajectory) -> Self {
        run.request.parts.retain(|part| *part != Part::Shown);
        let recording = &mut run.recording;
        let first = recording.columns.len() - description.drawing.tape.results.len();
        Self { description, times: recording.times.clone(), columns: recording.columns.split_off(first) }
    }

    /// The film of one sample: the machine at `t` (s) in the state `x`.
    pub fn still(machine: &dyn Machine, t: f64, x: &[f64]) -> Self {
        let values = machine.shown(t, x);
        let column = |value: f64| Column { values: vec![value], ..Column::default() };
        Self { description: machine.description(), times: vec![t], columns: values.into_iter().map(column).collect() }
    }

    /// The machine in motion; none where no body is known.
    pub fn animation(&self) -> Option<Animation> {
        let Drawing { bodies, joints, ground, gravity, .. } = &self.description.drawing;
        let bodies: Vec<BodyTrack> = bodies.iter().filter_map(|body| self.body(body)).collect();
        let joints = joints.iter().filter_map(|joint| self.joint(joint)).collect();
        let (ground, gravity) = (self.points(ground), self.still_at(gravity.flatten()).unwrap_or_default());
        (!bodies.is_empty()).then(|| Animation { times: self.times.clone(), bodies, ground, gravity, joints })
    }

    /// What the bonds do, with the picture of the graph, an SVG text.
    pub fn picture(&self, svg: String) -> Picture {
        Picture { svg, times: self.times.clone(), bonds: self.bonds() }
    }

    /// All that a report shows beside the run, with these modes and this picture of the graph, an SVG text.
    pub fn views(&self, modes: Option<Result<Linearised, String>>, svg: String) -> Views {
        let picture = Some(self.picture(svg));
        Views { animation: self.animation(), picture, modes }
    }

    /// The series of each bond; without components where a scene does not know them.
    fn bonds(&self) -> Vec<BondSeries> {
        let Description { bonds, drawing, .. } = self.description;
        let cardinalities = bonds.iter().map(|bond| bond.cardinality);
        let series = |place: Place, count: usize| -> Vec<Vec<f64>> {
            place
                .map_or_else(Vec::new, |first| (first..first + count).map(|k| self.columns[k].values.clone()).collect())
        };
        let bonds = drawing.bonds.iter().zip(cardinalities);
        bonds
            .map(|(&[effort, flow], count)| BondSeries { effort: series(effort, count), flow: series(flow, count) })
            .collect()
    }

    fn body(&self, body: &drawing::Body) -> Option<BodyTrack> {
        let orientations = self.moving::<9>(body.orientation)?;
        Some(BodyTrack {
            name: body.name.to_owned(),
            solids: body.solids.iter().filter_map(|solid| self.solid(solid)).collect(),
            points: self.points(body.points),
            position: self.moving(body.position)?,
            orientation: quaternions(&orientations),
        })
    }

    fn solid(&self, solid: &drawing::Solid) -> Option<Solid> {
        let number = |place: Place| self.still_at(place).map(|[value]: [f64; 1]| value);
        let shape = match &solid.shape {
            drawing::Shape::Cuboid(edges) => Shape::Cuboid { edges: self.still_at(*edges)? },
            drawing::Shape::Cylinder { radius, length, axis } => {
                Shape::Cylinder { radius: number(*radius)?, length: number(*length)?, axis: *axis }
            }
            drawing::Shape::Sphere(radius) => Shape::Sphere { radius: number(*radius)? },
        };
        let turned = solid.turned.map_or(Some(IDENTITY), |place| self.still_at(place))?;
        Some(Solid { shape, at: self.still_at(solid.center)?, turned: rows(&turned) })
    }

    fn joint(&self, joint: &drawing::Joint) -> Option<JointTrack> {
        // A contact acts where the first body touches.
        let end = usize::from(joint.word != "contact");
        Some(JointTrack {
            name: joint.name.to_owned(),
            kind: joint.word.to_owned(),
            place: self.moving(joint.places[end])?,
            force: self.moving(joint.force)?,
            torque: joint.moment.and_then(|place| self.moving(place)).unwrap_or_default(),
        })
    }

    fn points(&self, points: &[drawing::Point]) -> Vec<NamedPoint> {
        let known =
            |point: &drawing::Point| Some(NamedPoint { name: point.name.to_owned(), at: self.still_at(point.place)? });
        points.iter().filter_map(known).collect()
    }

    /// A quantity at each sample.
    fn moving<const C: usize>(&self, place: Place) -> Option<Vec<[f64; C]>> {
        let first = place?;
        let sample = |index: usize| std::array::from_fn(|k| self.columns[first + k].values[index]);
        Some((0..self.times.len()).map(sample).collect())
    }

    /// A quantity that does not change in a run.
    fn still_at<const C: usize>(&self, place: Place) -> Option<[f64; C]> {
        let first = place?;
        (!self.times.is_empty()).then(|| std::array::from_fn(|k| self.columns[first + k].values[0]))
    }
}

const IDENTITY: [f64; 9] = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

fn rows(matrix: &[f64; 9]) -> [[f64; 3]; 3] {
    std::array::from_fn(|row| std::array::from_fn(|column| matrix[3 * row + column]))
}

/// The quaternions x, y, z, w of rotation matrices; each on the side of the one before.
fn quaternions(matrices: &[[f64; 9]]) -> Vec<[f64; 4]> {
    let mut all: Vec<[f64; 4]> = Vec::with_capacity(matrices.len());
    for matrix in matrices {
        let rotation = Rotation3::from_matrix_unchecked(Matrix3::from_row_slice(matrix));
        let found: [f64; 4] = UnitQuaternion::from_rotation_matrix(&rotation).coords.into();
        let along = all.last().map_or(found[3], |last| last.iter().zip(&found).map(|(a, b)| a * b).sum());
        all.push(if along < 0.0 { found.map(|value| -value) } else { found });
    }
    all
}
