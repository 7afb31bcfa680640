//! The page that shows a run, and the files that it comes with.
//!
//! In: a run, its figures, drawn, and what is known beyond it. Out: the report, which has everything in it, with the
//! machine in motion where that was recorded.

use bg_model::description::Description;
use bg_model::simulation::Recording;

use crate::run::summary::Summary;
use crate::show::extras::Page as Texts;
use crate::show::figures::{Figure, outputs};
use crate::show::page::order::Live;
use crate::show::page::{self, Parameter, Report, Views};

/// The files of a page.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PageFiles {
    /// The name of the page.
    pub page: String,
    /// Whether it has everything in it.
    pub form: PageForm,
    /// Whether the figures have files beside it.
    pub figures: bool,
    /// The name of the machine in motion as binary glTF, where that is wanted.
    pub glb: Option<String>,
}

/// What a page has in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PageForm {
    /// Everything: it can be opened anywhere.
    Whole,
    /// For a frame of a page that has its style and script.
    Framed,
}

impl PageFiles {
    /// Those of a run: a page without the machine, and the figures.
    #[must_use]
    pub fn of_run() -> Self {
        Self { page: "index.html".to_owned(), form: PageForm::Whole, figures: true, glb: None }
    }
}

/// What a page shows beside the run.
#[derive(Clone, Copy, Debug)]
pub struct Exhibits<'a> {
    /// The model.
    pub description: &'static Description,
    /// What the scene is, in words; may be empty.
    pub scene: &'a str,
    /// The parameters of the mechanism with their values.
    pub parameters: &'a [Parameter],
    /// Other runs and measurements, each with its name.
    pub others: &'a [(String, Recording)],
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

/// The page that shows a run.
pub(crate) struct Page<'a> {
    /// Its files.
    pub files: &'a PageFiles,
    /// What it shows beside the run.
    pub exhibits: &'a Exhibits<'a>,
    /// Its texts.
    pub texts: &'a Texts,
    /// The figures, drawn.
    pub figures: Vec<(Figure, String)>,
    /// The run.
    pub run: &'a Recording,
    /// The instants of the rows of the CSV file, s.
    pub rows: &'a [f64],
}

impl Page<'_> {
    /// The page's file.
    pub fn name(&self) -> &str {
        &self.files.page
    }

    /// The files beside it that it comes with.
    pub fn more(&self) -> Vec<(String, Vec<u8>)> {
        let figures = self.figures.iter().filter(|_| self.files.figures);
        let figures = figures.map(|(figure, svg)| (figure.file.clone(), svg.clone().into_bytes()));
        let glb = || page::glb::glb(self.exhibits.views.animation.as_ref()?);
        figures.chain(self.files.glb.clone().and_then(|name| Some((name, glb()?)))).collect()
    }

    /// Its text. The figures in it are those that show more than its charts.
    pub fn html(&self, summary: &Summary) -> String {
        let Self { exhibits, texts, figures, run, rows, .. } = self;
        let own: Vec<(Figure, String)> =
            figures.iter().filter(|(figure, _)| exhibits.is_own(figure)).cloned().collect();
        let Exhibits { description, scene, parameters, others, drawings, views, live } = **exhibits;
        let figures = &own;
        let report = Report {
            texts,
            description,
            scene,
            parameters,
            summary,
            run,
            rows,
            figures,
            others,
            drawings,
            views,
            live,
        };
        match self.files.form {
            PageForm::Whole => page::page(&report),
            PageForm::Framed => page::page_beside(&report, None),
        }
    }
}
