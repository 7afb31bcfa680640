//! A program made of the models of a graph: its name, its defaults, what it adds to the workbench.

pub mod case;

#[cfg(not(target_arch = "wasm32"))]
use std::path::Path;

use bg_model::description::Description;
use bg_model::mechanism::Scenes;

use crate::ask::compiled::Compiled;
use crate::ask::maker::Maker;
#[cfg(not(target_arch = "wasm32"))]
use crate::ask::scenes::Scene;
use crate::ask::scenes::{Models, in_small_letters};
use crate::ask::table_file::TableFile;
use crate::show::extras::{Extras, Page, Plain};
use case::{Case, CaseSolution};

impl Texts {
    /// The name with the version.
    pub fn name_and_version(&self) -> String {
        format!("{} {}", self.name, self.version)
    }

    /// What a report is called: as the file with the models, else as the program.
    #[cfg(not(target_arch = "wasm32"))]
    pub fn stem(&self) -> &str {
        let of_file = self.file.as_deref().and_then(|file| Path::new(file).file_stem()?.to_str());
        of_file.unwrap_or(&self.name)
    }
}

/// A program of the models of a graph.
pub struct Program {
    pub(crate) texts: Texts,
    pub(crate) scene: String,
    pub(crate) models: Models,
    pub(crate) cases: Vec<Case>,
    /// The names of the cases that are measured unless others are asked for; of the scene that is run where there are
    /// none.
    pub(crate) measured: Vec<String>,
    pub(crate) extras: Box<dyn Extras>,
    /// The tables of its text that have the points of other files.
    pub(crate) tables: Vec<TableFile>,
}

/// What a program says of itself.
#[derive(Clone, Debug)]
pub(crate) struct Texts {
    pub name: String,
    pub version: String,
    pub about: String,
    /// The file that has the models, which comes after each command; none of a compiled program.
    pub file: Option<String>,
    /// The same as results name it, without its folder, and the CRC-32 of its bytes; where they are known.
    pub text: Option<(String, String)>,
    /// The commit that the models are from, where it is known.
    pub commit: Option<String>,
}

impl Program {
    /// The program of any mechanism that `bond_graph!` made, with what [`Compiled`] has unless more is asked for.
    #[must_use]
    pub fn of<Me: Scenes>() -> Self {
        Self::with(Compiled::<Me>::new())
    }

    /// The program of the models of `maker`: it runs the graph as it stands, or where it has scenes only, the first
    /// one. Its command `precision` has a case for each scene and measures the scene that is run, against solutions
    /// that it computes.
    #[must_use]
    pub fn with(maker: impl Maker + 'static) -> Self {
        let models = Models::of(maker);
        let own = models.graph();
        let texts = Texts {
            name: in_small_letters(own.description.name),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            about: own.description.doc.split_whitespace().collect::<Vec<_>>().join(" "),
            file: None,
            text: None,
            commit: None,
        };
        Self {
            texts,
            scene: own.name.clone(),
            cases: Case::of_scenes(&models.scenes, 1.0, CaseSolution::Computed),
            models,
            measured: Vec::new(),
            extras: Box::new(Plain),
            tables: Vec::new(),
        }
    }

    /// These cases of `precision`, and the names of those that it measures unless others are asked for.
    #[must_use]
    pub fn with_cases(mut self, cases: Vec<Case>, measured: &[&str]) -> Self {
        self.cases = cases;
        self.measured = measured.iter().map(|&name| name.to_owned()).collect();
        self
    }

    /// The texts of the page of a run of this model: the title has its name, too, unless that is the graph's.
    pub(crate) fn page(&self, model: &'static Description) -> Page {
        let graph = self.models.maker().name();
        let page = self.extras.page(graph, model);
        if model.name == graph { page } else { Page { title: format!("{}: {}", page.title, model.name), ..page } }
    }

    /// Its models.
    #[must_use]
    pub const fn models(&self) -> &Models {
        &self.models
    }

    /// What `--help` says first; else the documentation of the graph.
    #[must_use]
    pub fn about(mut self, about: &str) -> Self {
        about.clone_into(&mut self.texts.about);
        self
    }

    /// It is called `name`, and its models are those of `file`, which comes after each command: `NAME run FILE`.
    #[must_use]
    pub fn on_file(mut self, name: &str, file: &str) -> Self {
        name.clone_into(&mut self.texts.name);
        self.texts.file = Some(file.to_owned());
        self
    }

    /// The commit that its models are from, for results to name: `option_env!("BG_COMMIT")` of a program that is built
    /// with `BG_COMMIT=$(git rev-parse HEAD) cargo build`. Nothing leaves what is known.
    #[must_use]
    pub fn commit(mut self, commit: Option<&str>) -> Self {
        self.texts.commit = commit.map(str::to_owned).or(self.texts.commit);
        self
    }

    /// Its models are those of the text in the file `name`, whose bytes have this CRC-32, for results to name.
    #[must_use]
    pub fn of_text(mut self, name: &str, crc32: &str) -> Self {
        self.texts.text = Some((name.to_owned(), crc32.to_owned()));
        self
    }

    /// The same where these tables of its text have the points of other files, as summaries of runs say.
    #[must_use]
    pub fn tables(mut self, tables: Vec<TableFile>) -> Self {
        self.tables = tables;
        self
    }

    /// What `--version` says: `env!("CARGO_PKG_VERSION")` of the program.
    #[must_use]
    pub fn version(mut self, version: &str) -> Self {
        version.clone_into(&mut self.texts.version);
        self
    }

    /// The scene that is run unless another is asked for, by its name on the command line.
    ///
    /// # Panics
    /// There is no such scene.
    #[must_use]
    pub fn scene(mut self, name: &str) -> Self {
        assert!(self.models.named(name).is_some(), "there is no scene `{name}`");
        name.clone_into(&mut self.scene);
        self
    }

    /// What the program adds.
    #[must_use]
    pub fn extras(mut self, extras: impl Extras + 'static) -> Self {
        self.extras = Box::new(extras);
        self
    }

    /// The scene called `name`, or without a name that of the program; else a sentence.
    #[cfg(not(target_arch = "wasm32"))]
    pub(crate) fn find_scene(&self, name: Option<&str>) -> Result<&Scene, String> {
        let name = name.unwrap_or(&self.scene);
        self.models.named(name).ok_or_else(|| {
            let known: Vec<&str> = self.models.scenes.iter().map(|scene| scene.name.as_str()).collect();
            format!("there is no scene `{name}`; there are {}", known.join(", "))
        })
    }

    /// The scene called `name`.
    #[cfg(not(target_arch = "wasm32"))]
    pub(crate) fn scene_called(&self, name: &str) -> &Scene {
        self.models.named(name).expect("the command line takes the names of scenes only")
    }
}
