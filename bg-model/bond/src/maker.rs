//! The models of a graph of a text, for the workbench.
//!
//! In: the graphs of a text, the name of one. Out: what makes its models: they run in machine code where that pays, or
//! are interpreted.

use std::sync::Arc;

use bg_loaded::{BackEnd, Blueprint, Bundle, Chosen, Graph, Interpreted};
use bg_model::description::Description;
use bg_model::input::Input;
use bg_model::parameters::ParameterError;
use bg_workbench::machine::{Machine, Studied};
use bg_workbench::maker::{Maker, Prebuilt};

use crate::text::Text;

/// The text of a graph.
#[derive(Clone, Debug)]
pub struct Source {
    /// The text.
    pub text: Text,
    /// What gathers the files that it uses.
    pub gather: fn(&Text) -> Bundle,
    /// The most statements of a graph with its repetitions and parts written out; none: 20000.
    pub most: Option<usize>,
}

/// A graph of a text.
#[derive(Clone, Debug)]
pub struct Loaded {
    graph: Graph,
    back_end: BackEnd,
    /// What a unit of it is made of, where there may be one.
    source: Option<Source>,
}

impl Loaded {
    /// The graph called `name`, or the only one.
    ///
    /// # Errors
    /// There is none, or there are several and no name: a sentence.
    pub fn of(graphs: Vec<Graph>, name: Option<&str>) -> Result<Self, String> {
        let names = || graphs.iter().map(|graph| format!("`{}`", graph.name)).collect::<Vec<_>>().join(", ");
        let place = match name {
            Some(name) => graphs
                .iter()
                .position(|graph| graph.name == name)
                .ok_or_else(|| format!("there is no graph `{name}`; there are {}", names()))?,
            None if graphs.len() == 1 => 0,
            None if graphs.is_empty() => return Err("there is no graph, only parts".to_owned()),
            None => return Err(format!("which graph? Say --graph NAME: there are {}", names())),
        };
        let graph = graphs.into_iter().nth(place).expect("it has this place");
        Ok(Self { graph, back_end: BackEnd::default(), source: None })
    }

    /// The same, whose models are evaluated by this back end.
    #[must_use]
    pub fn by(self, back_end: BackEnd) -> Self {
        Self { back_end, ..self }
    }

    /// The same, of this text.
    #[must_use]
    pub fn of_source(self, source: Source) -> Self {
        Self { source: Some(source), ..self }
    }

    fn blueprint(&self, model: usize) -> &Arc<Blueprint> {
        let blueprint = &self.graph.models[model].blueprint;
        blueprint.as_ref().expect("the models that a command asks for have been compiled")
    }
}

impl Maker for Loaded {
    fn models(&self) -> Vec<&'static Description> {
        self.graph.models.iter().map(|model| model.description).collect()
    }

    fn name(&self) -> &str {
        &self.graph.name
    }

    fn is_literal(&self) -> bool {
        self.graph.is_literal
    }

    fn has(&self, model: usize) -> bool {
        self.graph.models[model].blueprint.is_some()
    }

    fn make(&self, model: usize, own: &[f64], inputs: &[Input]) -> Result<Box<dyn Machine>, ParameterError> {
        let model = Interpreted::new(self.blueprint(model), own, inputs)?.by(self.back_end);
        Ok(Box::new(cfg_select! {
            target_arch = "wasm32" => Studied::new(model),
            _ => Studied::reversible(model),
        }))
    }

    fn prebuilt(&self, model: usize) -> Option<Prebuilt> {
        let Source { text, gather, most } = self.source.as_ref()?;
        let (graph, model) = (self.graph.name.clone(), self.graph.models[model].description.name.to_owned());
        let chosen = Chosen { text: gather(text), graph, model, most: *most };
        let content = serde_json::to_vec(&chosen).expect("paths of text are text");
        Some(Prebuilt { name: chosen.text.name(), package: "bond-fmu", resources: vec![(Chosen::FILE, content)] })
    }
}
