//! The paper's Figures 4 to 19, drawn as SVG from a trajectory.
//!
//! In: a [`Recording`]. Out: one SVG text for each entry of [`FIGURES`]. [`FIGURES`] is the only place that says which
//! figure shows what; `momentum`, `orientation` and `path` draw the three kinds of figure.

mod momentum;
mod orientation;
mod path;

use std::sync::Arc;

use bg_model::simulation::Recording;
use bg_workbench::figures::canvas::{Area, UNITS, drawing, text, write};
use bg_workbench::figures::palette::PENCIL;
use bg_workbench::figures::{self, FigureError};
use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

/// What a figure shows of its link.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// The paths of the tips of the link's unit vectors, and its rotation over time.
    Orientation,
    /// The angular momentum about the centre of mass, inertial axes, over time.
    AngularMomentum,
    /// The momentum, inertial axes, over time.
    Momentum,
    /// The path of the centre of mass in the plane of motion, and its coordinates over time.
    Path,
}

/// Whether the paper's text says what a figure shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Assignment {
    /// The text says it.
    Stated,
    /// Deduced from the order of the figures about it.
    Deduced,
}

/// A figure of the paper.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Figure {
    /// Its number in the paper.
    pub number: u8,
    /// The link, 2 to 5.
    pub link: u8,
    /// What is shown.
    pub quantity: Quantity,
    /// How far this is certain.
    pub assignment: Assignment,
}

/// Figures 4 to 19.
///
/// The paper's text fixes figures 4, 5, 7 (crank), 8, 10, 11 (rod), 14, 15 (frame) and 17 (guide); it calls the others
/// "momenta, orientation and path of the links". Sixteen figures are four quantities of each of four links, link after
/// link. For the crank 4, 5 and 7 leave 6 to the momentum; for the rod 8, 10 and 11 leave 9 to the momentum; for the
/// frame 14 and 15 leave 12 and 13 to the momenta, in the rod's order; for the guide 17 in second place is the crank's
/// order.
pub const FIGURES: [Figure; 16] = {
    use Assignment::{Deduced, Stated};
    use Quantity::{AngularMomentum, Momentum, Orientation, Path};
    [
        figure(4, 2, Orientation, Stated),
        figure(5, 2, AngularMomentum, Stated),
        figure(6, 2, Momentum, Deduced),
        figure(7, 2, Path, Stated),
        figure(8, 3, AngularMomentum, Stated),
        figure(9, 3, Momentum, Deduced),
        figure(10, 3, Orientation, Stated),
        figure(11, 3, Path, Stated),
        figure(12, 4, AngularMomentum, Deduced),
        figure(13, 4, Momentum, Deduced),
        figure(14, 4, Orientation, Stated),
        figure(15, 4, Path, Stated),
        figure(16, 5, Orientation, Deduced),
        figure(17, 5, AngularMomentum, Stated),
        figure(18, 5, Momentum, Deduced),
        figure(19, 5, Path, Deduced),
    ]
};

const fn figure(number: u8, link: u8, quantity: Quantity, assignment: Assignment) -> Figure {
    Figure { number, link, quantity, assignment }
}

impl Figure {
    /// The link's name.
    #[must_use]
    pub const fn link_name(&self) -> &'static str {
        match self.link {
            2 => "crank",
            3 => "rod",
            4 => "frame",
            _ => "guide",
        }
    }

    /// What the figure shows, such as `Angular momentum of the crank`.
    #[must_use]
    pub fn title(&self) -> String {
        let (link, name) = (self.link, self.link_name());
        match self.quantity {
            Quantity::Orientation => format!("Orientation of the {name}"),
            Quantity::AngularMomentum => format!("Angular momentum of the {name}"),
            Quantity::Momentum => format!("Momentum of the {name}"),
            Quantity::Path => format!("Path of C{link}, the {name}'s centre of mass"),
        }
    }

    /// The figure's file name, such as `figure_05_crank_angular_momentum.svg`.
    #[must_use]
    pub fn file_name(&self) -> String {
        let quantity = match self.quantity {
            Quantity::Orientation => "orientation",
            Quantity::AngularMomentum => "angular_momentum",
            Quantity::Momentum => "momentum",
            Quantity::Path => "path",
        };
        format!("figure_{:02}_{}_{quantity}.svg", self.number, self.link_name())
    }

    /// The figure as the workbench draws it.
    #[must_use]
    pub fn drawn(self) -> figures::Figure {
        let caption = match self.assignment {
            Assignment::Stated => "Number and content as the paper's text says.",
            Assignment::Deduced => "Number deduced from the order of the figures about it.",
        };
        figures::Figure {
            file: self.file_name(),
            anchor: format!("figure-{}", self.number),
            title: format!("Figure {}. {}", self.number, self.title()),
            caption: caption.to_owned(),
            draw: Arc::new(move |run| self.draw(run)),
        }
    }

    /// Draws the figure.
    ///
    /// # Errors
    /// A trajectory without samples or without the link's columns.
    pub fn draw(&self, trajectory: &Recording) -> Result<String, FigureError> {
        if trajectory.times.is_empty() {
            return Err(FigureError::Empty);
        }
        let heading = format!("Figure {}. {}", self.number, self.title());
        match self.quantity {
            Quantity::Orientation => orientation::draw(&heading, trajectory, self.link),
            Quantity::AngularMomentum => momentum::draw(&heading, trajectory, 'h', self.link),
            Quantity::Momentum => momentum::draw(&heading, trajectory, 'p', self.link),
            Quantity::Path => path::draw(&heading, trajectory, self.link),
        }
    }
}
/// The width of [`key_of_ends`], CSS pixels.
const KEY: i32 = 84;

/// What the marks at a curve's start and end are, from `at` (CSS pixels): drawn, as letters of circles are not in every
/// reader's font.
fn key_of_ends(area: &Area, (x, y): (i32, i32)) -> Result<(), FigureError> {
    let (radius, middle) = (4 * UNITS, y + 7);
    let centre = |x: i32| (x * UNITS + radius, middle * UNITS);
    let style = text(12, PENCIL.light, HPos::Left);
    area.draw(&Circle::new(centre(x), radius, PENCIL.light.stroke_width(UNITS as u32))).map_err(drawing)?;
    write(area, "start", (x + 12, y), &style)?;
    area.draw(&Circle::new(centre(x + 50), radius, PENCIL.light.filled())).map_err(drawing)?;
    write(area, "end", (x + 62, y), &style)
}
