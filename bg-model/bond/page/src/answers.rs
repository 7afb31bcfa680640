//! What the page asks, and what it is answered.
//!
//! In: a [`Question`] as JSON. Out: JSON again. An answerer remembers the text that it compiled last: runs are of that.
//! The same answers come natively, so that a test can hold one against the other.

use std::cell::RefCell;
use std::collections::BTreeMap;

use bg_loaded::{Fault, Graph, Told, told};
use bg_model::dynamics::branches;
use bg_workbench::Program;
use bg_workbench::inputs::Setting;
use bg_workbench::live::{self, Order};
use bg_workbench::request::Integration;
use bg_workbench::scenes::{Models, Scene};
use bond_graph::faults::Line;
use bond_graph::maker::Loaded;
use bond_graph::text::{Counted, DEEPEST, Text, Wanted, graphs_alone};
use serde::{Deserialize, Serialize};

/// What the page asks. What is known of a text is answered as `{ "faults": [..], "graphs": [{ "name": .., "scenes": [{
/// "name": .., "about": .. }] }], "chosen": [GRAPH, SCENE], "inputs": [{ "name": .., "unit": .. }] }`: faults as `bond
/// check --json` has them, and then no graphs; `chosen` is `null` and there are no inputs where nothing was compiled to
/// be run.
#[derive(Debug, Deserialize)]
#[serde(tag = "ask", rename_all = "snake_case", deny_unknown_fields)]
pub enum Question {
    /// What is wrong with a text, all its models looked at: what is known of it.
    Check {
        /// The text.
        text: String,
    },
    /// The words and functions of a text: `{ "words": [{ "bytes": [FROM, TO], "block": .., "word": .. }] }`, the words
    /// in the order of the text, then the functions, whose block is `null`. What is told of them is in the file beside
    /// the page.
    Words {
        /// The text.
        text: String,
    },
    /// To compile one model of a text, which is remembered: what is known of it, and what was chosen.
    Compile {
        /// The text.
        text: String,
        /// The graph; the last one unless it is said or there.
        graph: Option<String>,
        /// The scene by its name on the command line; the one that stands for the graph unless it is said or there.
        scene: Option<String>,
    },
    /// The report of a run of what was compiled, in HTML for a frame of the page: `{ "page": .. }`, or
    /// `{ "fault": .. }`.
    Report(Run),
    /// Another run of it: what [`live::answer`] answers.
    Run {
        /// An [`Order`] as JSON.
        order: String,
    },
    /// To evaluate the rate of what was compiled at its start, again and again: `{ "states": .. }` or `{ "fault": ..
    /// }`. Who asks has a clock.
    Rate {
        /// How often.
        count: usize,
    },
}

/// A run that is not that of all defaults.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Run {
    /// Its end, s; 5 unless it is said.
    pub t_end: Option<f64>,
    /// The interval of the rows, s; 0.01, or a hundredth of a shorter run.
    pub step: Option<f64>,
    /// Parameters that are not at their defaults; names that the graph does not have are left out.
    #[serde(default)]
    pub set: BTreeMap<String, f64>,
    /// Inputs that are not 0; names that the graph does not have are left out.
    #[serde(default)]
    pub inputs: BTreeMap<String, f64>,
}

/// What is known of a text.
#[derive(Debug, Serialize)]
struct Checked<'a> {
    /// What is wrong with it, as `bond check --json` has it; then there are no graphs.
    faults: Vec<Line<'a>>,
    graphs: Vec<Known>,
    /// The names of the graph and the scene that were compiled.
    chosen: Option<[String; 2]>,
    /// The inputs of that graph.
    inputs: Vec<KnownInput>,
}

#[derive(Debug, Serialize)]
struct KnownInput {
    name: &'static str,
    unit: &'static str,
}

/// A graph.
#[derive(Debug, Serialize)]
struct Known {
    name: String,
    scenes: Vec<KnownScene>,
}

#[derive(Debug, Serialize)]
struct KnownScene {
    name: String,
    /// Its documentation in a sentence; empty where the scene was not compiled.
    about: String,
}

#[derive(Debug, Serialize)]
struct Words<'a> {
    words: Vec<Word<'a>>,
}

/// A word or function.
#[derive(Debug, Serialize)]
struct Word<'a> {
    bytes: [usize; 2],
    block: Option<&'a str>,
    word: &'a str,
}

impl<'a> Word<'a> {
    fn of(Told { bytes, block, word }: &'a Told) -> Self {
        Self { bytes: [bytes.start, bytes.end], block: *block, word }
    }
}

/// A page, or a fault.
#[derive(Debug, Serialize)]
#[serde(rename_all = "snake_case")]
enum Answer {
    Page(String),
    States(usize),
    Fault(String),
}

/// What answers the page.
#[derive(Default)]
pub struct Answerer {
    /// What was compiled last, with the name of its scene.
    compiled: RefCell<Option<(Program, String)>>,
}

/// The file that faults are in: the text itself.
const FILE: &str = "text";

impl Answerer {
    /// The answer to a question, JSON both.
    #[must_use]
    pub fn answer(&self, question: &str) -> String {
        match serde_json::from_str(question) {
            Ok(Question::Check { text }) => {
                let wanted = Wanted { counted: Counted::Made, ..Wanted::default() };
                self.checked(text, &wanted, None)
            }
            Ok(Question::Compile { text, graph, scene }) => {
                self.compiled.take();
                let wanted =
                    Wanted { scene: Some(scene.clone().unwrap_or_default()), counted: Counted::Made, most: None };
                self.checked(text, &wanted, Some((graph, scene)))
            }
            Ok(Question::Words { text }) => json(&Words { words: told(&text).iter().map(Word::of).collect() }),
            Ok(Question::Report(run)) => json(&self.told(|program, scene| {
                let order = order(program, scene, &run);
                live::report(program, &order).map(Answer::Page)
            })),
            Ok(Question::Run { order }) => match &*self.compiled.borrow() {
                Some((program, _)) => live::answer(program, &order),
                None => json(&Answer::Fault(NOTHING.to_owned())),
            },
            Ok(Question::Rate { count }) => json(&self.told(|program, scene| rates(program, scene, count))),
            Err(fault) => json(&Answer::Fault(format!("the question cannot be read: {fault}"))),
        }
    }

    /// What is known of a text; of what was chosen the program is remembered.
    fn checked(&self, text: String, wanted: &Wanted, chosen: Option<(Option<String>, Option<String>)>) -> String {
        let text = Text { path: FILE.into(), text };
        let graphs = if text.is_deep() { Err(vec![deep()]) } else { graphs_alone(&text, wanted) };
        let (faults, graphs) = match graphs {
            Ok(graphs) => (Vec::new(), graphs),
            Err(faults) => (faults, Vec::new()),
        };
        let known = graphs.iter().map(known).collect();
        let chosen = chosen.and_then(|(graph, scene)| self.choose(graphs, graph.as_deref(), scene.as_deref()));
        let inputs = if chosen.is_some() { self.inputs() } else { Vec::new() };
        let faults = faults.iter().map(|fault| Line::of(&text, fault)).collect();
        json(&Checked { faults, graphs: known, chosen, inputs })
    }

    /// Remembers the program of a graph and says which graph and scene it is; none of a text without graphs.
    fn choose(&self, graphs: Vec<Graph>, graph: Option<&str>, scene: Option<&str>) -> Option<[String; 2]> {
        let is_there = graph.filter(|name| graphs.iter().any(|graph| graph.name == *name));
        let name = is_there.or_else(|| Some(&graphs.last()?.name)).map(str::to_owned)?;
        let program = Program::with(Loaded::of(graphs, Some(&name)).ok()?);
        let models = program.models();
        let scene = scene.and_then(|scene| models.named(scene)).unwrap_or_else(|| models.graph()).name.clone();
        self.compiled.replace(Some((program, scene.clone())));
        Some([name, scene])
    }

    fn inputs(&self) -> Vec<KnownInput> {
        let compiled = self.compiled.borrow();
        let inputs = compiled.as_ref().map_or(&[][..], |(program, _)| program.models().graph().description.inputs);
        inputs.iter().map(|info| KnownInput { name: info.name, unit: info.unit }).collect()
    }

    fn told(&self, tell: impl FnOnce(&Program, &Scene) -> Result<Answer, String>) -> Answer {
        let compiled = self.compiled.borrow();
        let told = compiled.as_ref().ok_or_else(|| NOTHING.to_owned()).and_then(|(program, scene)| {
            tell(program, program.models().named(scene).expect("it was chosen among them"))
        });
        told.unwrap_or_else(Answer::Fault)
    }
}

const NOTHING: &str = "nothing is compiled";

fn json(answer: &impl Serialize) -> String {
    serde_json::to_string(answer).expect("texts and numbers")
}

/// The fault of a text that no reader can follow.
fn deep() -> Fault {
    Fault {
        code: "",
        message: format!("brackets in brackets, more than {DEEPEST} deep"),
        help: String::new(),
        place: [1, 1],
        bytes: 0..0,
        file: None,
    }
}

/// A graph with its scenes, in the order of a list to choose from.
fn known(graph: &Graph) -> Known {
    let models = Models::of(Loaded::of(vec![graph.clone()], None).expect("it is the only one"));
    let scene = |scene: &Scene| KnownScene { name: scene.name.clone(), about: scene.summary() };
    Known { name: graph.name.clone(), scenes: models.scenes.iter().map(scene).collect() }
}

/// The order of a run.
fn order(program: &Program, scene: &Scene, run: &Run) -> Order {
    let own = program.models().graph().description;
    let usual = Integration::default();
    let t_end = run.t_end.unwrap_or(usual.t_end);
    let step = run.step.unwrap_or_else(|| usual.step.min(t_end / 100.0));
    let names: Vec<&str> = own.parameters.iter().map(|info| info.name).collect();
    let parameters = run.set.iter().filter(|(name, _)| names.contains(&name.as_str()));
    let input = |name: &str| run.inputs.get(name).map_or(Setting::NotGiven, |value| Setting::Constant(*value));
    Order {
        scene: scene.name.clone(),
        parameters: parameters.map(|(name, value)| (name.clone(), *value)).collect(),
        inputs: own.inputs.iter().map(|info| input(info.name)).collect(),
        integration: Integration { t_end, step, ..usual },
        begin: Default::default(),
    }
}

/// Evaluates the rate at the start `count` times.
fn rates(program: &Program, scene: &Scene, count: usize) -> Result<Answer, String> {
    let models = program.models();
    let machine = models.made(scene, &models.defaults(), &[]).map_err(|fault| fault.to_string())?;
    let x = machine.start(None).map_err(|fault| fault.to_string())?.values();
    let model = machine.model();
    let negative = branches(&*model, 0.0, &x);
    let mut dx = vec![0.0; x.len()];
    for _ in 0..count {
        model.rate(0.0, &x, &negative, &mut dx);
    }
    Ok(Answer::States(x.len()))
}
