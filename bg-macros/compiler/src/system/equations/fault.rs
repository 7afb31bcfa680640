//! What can go wrong when bonds become equations.

use crate::fault::Explain;

/// A fault of the derivation.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "each variant's message says what it and its fields are")]
pub enum EquationFault {
    AlgebraicLoop { members: Vec<String>, reactions: Vec<String> },
    UndeterminedLoop { members: Vec<String>, why: String },
    DependentStart { kind: ElementKind, name: String, by: Vec<String> },
    PartlyDependentStart { kind: ElementKind, name: String, free: Vec<String> },
    DependentOnInput { kind: ElementKind, name: String, input: String },
    DependentJumps { kind: ElementKind, name: String, element: String, condition: String },
    DependentOpen { members: Vec<String>, why: String },
    NotLinear { symbol: &'static str, name: String },
    NoEnergy { symbol: &'static str, name: String },
    EnergyOfOtherLaw { symbol: &'static str, name: String },
    EnergyJumps { symbol: &'static str, name: String, by: f64, at: Vec<f64> },
    EnergyNotCompared { symbol: &'static str, name: String, points: usize },
    DisplacementOfOtherFlow { name: String, is_sink: bool },
    FrictionOfReaction { name: String, by: String },
    CannotStick { name: String, input: Option<String> },
    CannotStop { name: String },
    UnknownTurn { name: String },
}

use crate::graph::ElementKind;
use EquationFault as F;

impl Explain for EquationFault {
    fn code(&self) -> &'static str {
        match self {
            F::AlgebraicLoop { .. } => "BG0501",
            F::NotLinear { .. } => "BG0502",
            F::NoEnergy { .. } => "BG0503",
            F::EnergyOfOtherLaw { .. } => "BG0504",
            F::DisplacementOfOtherFlow { .. } => "BG0505",
            F::EnergyJumps { .. } => "BG0506",
            F::EnergyNotCompared { .. } => "BG0507",
            F::UndeterminedLoop { .. } => "BG0508",
            F::DependentStart { .. } | F::PartlyDependentStart { .. } => "BG0509",
            F::DependentOnInput { .. } => "BG0510",
            F::DependentJumps { .. } => "BG0511",
            F::DependentOpen { .. } => "BG0512",
            F::FrictionOfReaction { .. } => "BG0515",
            F::CannotStick { .. } => "BG0516",
            F::CannotStop { .. } => "BG0517",
            F::UnknownTurn { .. } => "BG0518",
        }
    }

    fn message(&self) -> String {
        match self {
            F::AlgebraicLoop { members, reactions } => format!(
                "algebraic loop that is not linear and depends on the reaction of {}, which is not known before it: {}",
                reactions.join(", "),
                members.join(" -> ")
            ),
            F::UndeterminedLoop { members, why } => format!(
                "algebraic loop: {} need each other in a way that leaves their efforts and flows open, or has no \
                solution: {why}",
                members.join(", ")
            ),
            F::DependentStart { kind, name, by } => {
                let symbol = kind.symbol();
                let by = if by.is_empty() { "sources".to_owned() } else { by.join(", ") };
                format!(
                    "{symbol} `{name}` has no start of its own: it is in derivative causality, its state follows from \
                    {by}"
                )
            }
            F::PartlyDependentStart { kind, name, free } => {
                let (symbol, free) = (kind.symbol(), free.join(", "));
                format!(
                    "{symbol} `{name}` cannot start anywhere: of its components only {free} is free, the others follow"
                )
            }
            F::DependentOnInput { kind, name, input } => {
                let symbol = kind.symbol();
                format!(
                    "the state of {symbol} `{name}` is given by the input `{input}`, whose rate of change is not known"
                )
            }
            F::DependentJumps { kind, name, element, condition } => {
                let symbol = kind.symbol();
                format!(
                    "the state of {symbol} `{name}` is given by others and may jump where `{condition}` of `{element}` \
                     changes: that would take an impulse"
                )
            }
            F::DependentOpen { members, why } => {
                let members = members.join(", ");
                format!("in derivative causality, and what it gives cannot be solved for: {members}: {why}")
            }
            F::NotLinear { symbol, name } => {
                format!("the law of {symbol} `{name}` is not linear in its variable, so it would not conserve power")
            }
            F::NoEnergy { symbol, name } => {
                format!(
                    "the energy stored in {symbol} `{name}` is not known: its law has no integral that the compiler \
                    can find"
                )
            }
            F::EnergyOfOtherLaw { symbol, name } => {
                format!("the energy given for {symbol} `{name}` does not have the law as its derivative")
            }
            F::EnergyJumps { symbol, name, by, at } => {
                let at: Vec<String> = at.iter().map(|&value| rounded(value)).collect();
                let (by, at) = (rounded(by.abs()), at.join(", "));
                format!("the energy given for {symbol} `{name}` jumps by {by} J where its law switches, at {at}")
            }
            F::EnergyNotCompared { symbol, name, points } => format!(
                "the energy given for {symbol} `{name}` could not be compared with its law: at most of {points} points \
                 one of them is not a finite number"
            ),
            F::DisplacementOfOtherFlow { name, is_sink } => {
                let (what, symbol) = if *is_sink { ("gap", "rSe") } else { ("displacement", "C") };
                format!("the {what} given for {symbol} `{name}` does not change with the flow of its bond")
            }
            F::FrictionOfReaction { name, by } if name == by => {
                format!("the friction of R `{name}` depends on its own effort")
            }
            F::FrictionOfReaction { name, by } => {
                format!("the friction of R `{name}` depends on the reaction of `{by}`, which depends on the friction")
            }
            F::CannotStick { name, input: Some(input) } => {
                format!("R `{name}` cannot stick: its flow depends on input `{input}`, whose rate is not known")
            }
            F::CannotStick { name, input: None } => {
                format!("R `{name}` cannot stick: no momentum determines its flow")
            }
            F::CannotStop { name } => {
                format!("nothing can hit stop `{name}`: no momentum determines its flow, or an input does")
            }
            F::UnknownTurn { name } => {
                format!(
                    "the angle `{name}` is not known at the start: its sine or cosine depends on more than poses and \
                    parameters"
                )
            }
        }
    }

    fn help(&self) -> String {
        match self {
            F::AlgebraicLoop { members, reactions } => format!(
                "make {} compliant, or break the loop with a storage: bond a C or an I to one of its junctions, for \
                example at {}",
                reactions.first().map_or("the joint", String::as_str),
                members.first().map_or("one of them", String::as_str)
            ),
            F::UndeterminedLoop { .. } => {
                "leave out what says the same twice, such as a second transformer beside a first".to_owned()
            }
            F::PartlyDependentStart { .. } => "leave `start` out, then it starts at zero".to_owned(),
            F::DependentStart { by, .. } if by.is_empty() => "leave `start` out".to_owned(),
            F::DependentStart { by, .. } => format!("leave `start` out here, and give the start of {}", by.join(", ")),
            F::DependentOnInput { kind, name, input } => format!(
                "write the source as a function of time, or let {} sit between `{input}` and `{name}`",
                between(*kind)
            ),
            F::DependentJumps { kind, name, .. } => {
                format!("let {} sit in front of `{name}`, or write the law without the comparison", between(*kind))
            }
            F::DependentOpen { members, .. } => format!(
                "let a C and an R (a compliant coupling) sit in front of {}, or write the laws beside it as functions \
                 of the other variable",
                members.first().map_or("it", String::as_str)
            ),
            F::NotLinear { .. } => "write it as a factor times the variable, or as `dot`, `cross` of it".to_owned(),
            F::NoEnergy { .. } => "give it after the law, `energy E`".to_owned(),
            F::EnergyOfOtherLaw { .. } => "correct the energy, or leave it out".to_owned(),
            F::EnergyJumps { .. } => {
                "add a constant to the energy of one branch, so that both give the same at the switch".to_owned()
            }
            F::EnergyNotCompared { .. } => {
                "write law and energy so that they are finite for states of either sign, with `abs` or `if`".to_owned()
            }
            F::DisplacementOfOtherFlow { is_sink: true, .. } => {
                "write a gap of the poses that this flow opens, or leave `at` out where there is none: a wheel that \
                rolls"
                    .to_owned()
            }
            F::DisplacementOfOtherFlow { .. } => {
                "leave `at` out, then the displacement is a state of its own".to_owned()
            }
            F::FrictionOfReaction { name, by } if name == by => {
                "take the component of the force that presses, without that along the motion".to_owned()
            }
            F::FrictionOfReaction { by, .. } => {
                format!(
                    "make `{by}` compliant, so that its force follows from the motion, or give the force as a number"
                )
            }
            F::CannotStick { input: Some(_), .. } => "use a parameter or a function of `t` for the input".to_owned(),
            F::CannotStick { input: None, .. } => "bond an I to its junction, or leave `holds` out".to_owned(),
            F::CannotStop { .. } => {
                "let it act where a mass moves, or give it a stiffness and a damping for the restitution".to_owned()
            }
            F::UnknownTurn { .. } => "use `atan2(y, x)`, which gives the angle in one turn".to_owned(),
        }
    }
}

/// What gives a storage integral causality.
fn between(kind: ElementKind) -> &'static str {
    if kind == ElementKind::I { "a C and an R (a compliant coupling)" } else { "an R" }
}

/// A number with four digits, as short as it can be.
fn rounded(value: f64) -> String {
    format!("{value:.3e}").parse::<f64>().map_or_else(|_| value.to_string(), |value| value.to_string())
}
