//! A program made of a mechanism: its name, its defaults, what it adds to the workbench.

use std::ffi::OsString;
use std::marker::PhantomData;
use std::process::ExitCode;

use bg_model::mechanism::Scenes;

use crate::extras::{Extras, Plain};
#[cfg(not(target_arch = "wasm32"))]
use crate::gradient::Differentiate;
use crate::precision::case::Case;
#[cfg(not(target_arch = "wasm32"))]
use crate::precision::case::CaseSolution;
use crate::scenes::{Scene, scenes};
#[cfg(not(target_arch = "wasm32"))]
use crate::sweep::lanes::Many;

/// A program of the mechanism `Me`.
pub struct Program<Me> {
    pub(crate) texts: Texts,
    pub(crate) scene: String,
    pub(crate) scenes: Vec<Scene>,
    pub(crate) cases: Vec<Case>,
    /// The names of the cases that are measured unless others are asked for; of the scene that is run where there are
    /// none.
    pub(crate) measured: Vec<String>,
    pub(crate) extras: Box<dyn Extras>,
    /// What makes runs side by side, if the program has it.
    #[cfg(not(target_arch = "wasm32"))]
    pub(crate) lanes: Option<Many>,
    /// What follows runs backwards, if the program has it.
    #[cfg(not(target_arch = "wasm32"))]
    pub(crate) gradients: Option<Differentiate>,
    mechanism: PhantomData<Me>,
}

/// What a program says of itself.
#[derive(Clone, Debug)]
pub(crate) struct Texts {
    pub name: String,
    pub version: String,
    pub about: String,
}

/// The end of a run that is not told another, s.
pub const T_END: f64 = 5.0;

impl<Me: Scenes> Default for Program<Me> {
    fn default() -> Self {
        Self::new()
    }
}

impl<Me: Scenes> Program<Me> {
    /// The program of any mechanism: it runs the graph as it stands, or where it has scenes only, the first one. Its
    /// command `precision` has a case for each scene and measures the scene that is run, against solutions that it
    /// computes.
    #[must_use]
    pub fn new() -> Self {
        // A page has no such command.
        let cases = cfg_select! {
            target_arch = "wasm32" => Vec::new(),
            _ => Case::of_scenes(&scenes::<Me>(), 1.0, CaseSolution::computed::<Me>()),
        };
        Self::with_cases(cases, &[])
    }

    /// The same with these cases of `precision`, and the names of those that it measures unless others are asked for.
    /// With stored solutions alone nothing is compiled for computing any.
    #[must_use]
    pub fn with_cases(cases: Vec<Case>, measured: &[&str]) -> Self {
        let scenes = scenes::<Me>();
        let own = scenes.iter().find(|scene| scene.index == 0).expect("the mechanism is one of its models");
        let texts = Texts {
            name: crate::scenes::in_small_letters(own.description.name),
            version: env!("CARGO_PKG_VERSION").to_owned(),
            about: own.description.doc.split_whitespace().collect::<Vec<_>>().join(" "),
        };
        Self {
            texts,
            scene: own.name.clone(),
            scenes,
            cases,
            measured: measured.iter().map(|&name| name.to_owned()).collect(),
            extras: Box::new(Plain),
            #[cfg(not(target_arch = "wasm32"))]
            lanes: None,
            #[cfg(not(target_arch = "wasm32"))]
            gradients: None,
            mechanism: PhantomData,
        }
    }

    /// What `--help` says first; else the documentation of the graph.
    #[must_use]
    pub fn about(mut self, about: &str) -> Self {
        about.clone_into(&mut self.texts.about);
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
        assert!(self.scenes.iter().any(|scene| scene.name == name), "there is no scene `{name}`");
        name.clone_into(&mut self.scene);
        self
    }

    /// What the program adds.
    #[must_use]
    pub fn extras(mut self, extras: impl Extras + 'static) -> Self {
        self.extras = Box::new(extras);
        self
    }

    /// Lets `sweep` make runs by the methods `nystrom`, `cfmr7` and `dop853` side by side, eight at a time on a machine
    /// with AVX-512, four with AVX2; what they give is the same to the bit. It is compiled for each model twice, so a
    /// program has it only if it asks for it.
    #[cfg(not(target_arch = "wasm32"))]
    #[must_use]
    pub fn lanes(mut self) -> Self {
        self.lanes = Some(crate::sweep::lanes::many::<Me>);
        self
    }

    /// Gives the program the command `gradient`: one number of a run differentiated by all parameters, by the run
    /// followed backwards. It is compiled for each model, so a program has it only if it asks for it. A page has no use
    /// for it.
    #[must_use]
    pub fn gradients(self) -> Self {
        cfg_select! {
            target_arch = "wasm32" => self,
            _ => Self { gradients: Some(crate::gradient::differentiate::<Me>), ..self },
        }
    }

    /// Does what `arguments` ask for, the program's name first, and gives the exit code: 0 done, 1 the run or an output
    /// failed, 2 the input cannot be used. In WebAssembly there are no arguments: the program answers a page from then
    /// on, see [`live`](crate::live).
    pub fn main(self, arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
        cfg_select! {
            target_arch = "wasm32" => {
                drop(arguments);
                crate::live::register(self);
                ExitCode::SUCCESS
            }
            _ => crate::command::main(&self, arguments),
        }
    }

    /// The scene called `name`, or without a name that of the program; else a sentence.
    #[cfg(not(target_arch = "wasm32"))]
    pub(crate) fn find_scene(&self, name: Option<&str>) -> Result<&Scene, String> {
        let name = name.unwrap_or(&self.scene);
        self.scenes.iter().find(|scene| scene.name == name).ok_or_else(|| {
            let known: Vec<&str> = self.scenes.iter().map(|scene| scene.name.as_str()).collect();
            format!("there is no scene `{name}`; there are {}", known.join(", "))
        })
    }

    /// The scene called `name`.
    #[cfg(not(target_arch = "wasm32"))]
    pub(crate) fn scene_called(&self, name: &str) -> &Scene {
        let scene = self.scenes.iter().find(|scene| scene.name == name);
        scene.expect("the command line takes the names of scenes only")
    }
}
