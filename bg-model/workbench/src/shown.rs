//! The page that shows a run, and the files that it comes with.
//!
//! In: a run, its figures, drawn, and what is known beyond it. Out: the overview page with links to its figures' files,
//! or the report, which has everything in it.

use std::path::PathBuf;

use bg_model::description::Description;
use bg_model::simulation::Recording;

use crate::extras::Page as Texts;
use crate::figures::{Figure, outputs};
use crate::live::Live;
use crate::output::ReportFiles;
use crate::overview;
use crate::page::{self, Parameter, Report, Views};
use crate::summary::Summary;

/// The overview page's file.
pub(crate) const OVERVIEW: &str = "index.html";

/// What a report shows beside the run.
#[derive(Clone, Copy, Debug)]
pub struct Exhibits<'a> {
    /// The model.
    pub description: &'static Description,
    /// What the scene is, in words; may be empty.
    pub scene: &'a str,
    /// The parameters of the mechanism with their values.
    pub parameters: &'a [Parameter],
    /// More drawings, each with its title: SVG texts.
    pub drawings: &'a [(String, String)],
    /// What is known beyond the run.
    pub views: &'a Views,
    /// The model inside, where the page is to run it again.
    pub live: Option<&'a Live>,
}

impl Exhibits<'_> {
    /// Whether a figure shows more than the charts of the outputs.
    pub(crate) fn is_own(&self, figure: &Figure) -> bool {
        outputs::figures(self.description).iter().all(|usual| usual.file != figure.file)
    }
}

/// The page that shows a run, with its figures, drawn.
pub(crate) enum Page<'a> {
    /// The overview page, with links to the figures' files.
    Overview {
        texts: &'a Texts,
        figures: Vec<(Figure, String)>,
        /// The CSV file as seen from the page, where it is below it.
        data: Option<PathBuf>,
    },
    /// The report, which has everything in it.
    Report {
        files: &'a ReportFiles,
        exhibits: &'a Exhibits<'a>,
        texts: &'a Texts,
        figures: Vec<(Figure, String)>,
        run: &'a Recording,
        /// The instants of the rows of the CSV file, s.
        rows: &'a [f64],
    },
}

impl Page<'_> {
    /// The page's file.
    pub fn name(&self) -> &str {
        match self {
            Self::Overview { .. } => OVERVIEW,
            Self::Report { files, .. } => &files.page,
        }
    }

    /// The files beside it that it comes with.
    pub fn more(&self) -> Vec<(String, Vec<u8>)> {
        match self {
            Self::Overview { figures, .. } => {
                figures.iter().map(|(figure, svg)| (figure.file.clone(), svg.clone().into_bytes())).collect()
            }
            Self::Report { files, exhibits, .. } => {
                let glb = || page::glb::glb(exhibits.views.animation.as_ref()?);
                files.glb.clone().and_then(|name| Some((name, glb()?))).into_iter().collect()
            }
        }
    }

    pub fn html(&self, summary: &Summary) -> String {
        match self {
            Self::Overview { texts, figures, data } => {
                let drawn: Vec<Figure> = figures.iter().map(|(figure, _)| figure.clone()).collect();
                overview::page(texts, summary, &drawn, data.as_deref())
            }
            Self::Report { exhibits, texts, figures, run, rows, .. } => {
                let Exhibits { description, scene, parameters, drawings, views, live } = **exhibits;
                page::page(&Report {
                    texts,
                    description,
                    scene,
                    parameters,
                    summary,
                    run,
                    rows,
                    figures,
                    drawings,
                    views,
                    live,
                })
            }
        }
    }
}
