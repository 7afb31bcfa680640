//! What is asked of a run: by its options, or by the summary of another run that is made again.

use std::path::Path;

use bg_model::run::State;

use super::InputError;
use super::arguments::{RunArguments, Start};
use crate::ask::inputs::{self, Setting};
use crate::ask::parameters::{self, Chosen};
use crate::ask::request::Integration;
use crate::ask::scenes::Scene;
use crate::program::Program;
use crate::run::recipe::{self, AgainError, ModelFile, Recipe, fingerprint, input_files};
use crate::run::running::Begin;

/// What is asked of a run, from the command line or from a summary.
pub struct Asked<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// The values of the parameters and the inputs.
    pub chosen: Chosen,
    /// What the inputs are set to.
    pub settings: Vec<Setting>,
    /// The same and all else, as results have it.
    pub recipe: Recipe,
}

impl<'a> Asked<'a> {
    /// As the arguments say.
    pub fn of(program: &'a Program, arguments: &RunArguments) -> Result<Self, InputError> {
        if let Some(path) = &arguments.again {
            return Self::again(program, path);
        }
        let RunArguments { model, integration, .. } = arguments;
        let graph = program.models.graph().description;
        let chosen = parameters::merge(graph.parameters, model.params.as_deref(), &model.set)?;
        let begin = match (&arguments.from, arguments.start) {
            (Some(path), _) => Begin::At(read_state(path)?),
            (None, Start::Model) => Begin::Model,
            (None, Start::Equilibrium) => Begin::Equilibrium,
        };
        Self::with(program, &model.scene, chosen, model.input.clone(), integration.integration(), begin)
    }

    /// As the run was asked for whose summary is at `path`.
    fn again(program: &'a Program, path: &Path) -> Result<Self, InputError> {
        let failed = |fault: String| AgainError { path: path.to_owned(), fault };
        let there = recipe::read(path)?;
        let Recipe { parameters, inputs, integration, begin, .. } = &there;
        if there.program != program.texts.name {
            return Err(failed(format!("is a run of `{}`, and this is `{}`", there.program, program.texts.name)).into());
        }
        if program.models.named(&there.scene).is_none() {
            return Err(failed(format!("there is no scene `{}` any more", there.scene)).into());
        }
        let mut chosen = Chosen::new(program.models.graph().description.parameters);
        let place = path.display().to_string();
        for (name, quantity) in parameters {
            parameters::set(&mut chosen, &place, name, quantity.value)?;
        }
        let asked = Self::with(program, &there.scene, chosen, inputs.clone(), integration.clone(), begin.clone())?;
        let differs = |what: &str| failed(format!("{what} than then; the run would be another one"));
        if asked.recipe.model != there.model {
            return Err(differs("the model has other equations or outputs").into());
        }
        if asked.recipe.parameters != there.parameters {
            return Err(differs("the model has other parameters, or other units of them").into());
        }
        let other =
            asked.recipe.input_files.iter().find(|(input, crc32)| there.input_files.get(*input) != Some(*crc32));
        if let Some((input, _)) = other {
            return Err(differs(&format!("the file of the input `{input}` has other bytes")).into());
        }
        Ok(asked)
    }

    fn with(
        program: &'a Program,
        scene: &str,
        mut chosen: Chosen,
        inputs: Vec<String>,
        integration: Integration,
        begin: Begin,
    ) -> Result<Self, InputError> {
        let scene = program.scene_called(scene);
        let infos = program.models.graph().description.inputs;
        let settings = inputs::settings(&inputs, infos)?;
        chosen.inputs = inputs::made(&settings);
        let text = &program.texts.text;
        let recipe = Recipe {
            program: program.texts.name.clone(),
            version: program.texts.version.clone(),
            workbench: env!("CARGO_PKG_VERSION").to_owned(),
            model_file: text.clone().map(|(name, crc32)| ModelFile { name, crc32 }),
            commit: program.texts.commit.clone(),
            model: fingerprint(scene.description),
            scene: scene.name.clone(),
            parameters: recipe::quantities(&chosen.values),
            inputs,
            input_files: input_files(&inputs::named(&settings, infos)),
            tables: program.tables.clone(),
            integration,
            begin,
        };
        Ok(Self { scene, chosen, settings, recipe })
    }
}

fn read_state(path: &Path) -> Result<State, InputError> {
    let failed = |fault: String| InputError::From { path: path.to_owned(), fault };
    let text = std::fs::read_to_string(path).map_err(|fault| failed(format!("cannot be read: {fault}")))?;
    State::from_json(&text).map_err(|fault| failed(fault.to_string()))
}
