//! The text of a criterion, read.
//!
//! In: a text such as `max |pin.force| < 2 kN`, a model's description. Out: trees with their names resolved, and the
//! measures in them. Method: recursive descent.

use bg_model::description::Description;

use super::tree::{Node, One, Two};
use super::units::Shown;
use super::{CriterionError, CriterionKind, Measure};

/// How two sides are compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Relation {
    /// The left side is at most the right one.
    AtMost,
    /// The left side is at least the right one.
    AtLeast,
    /// Both are equal.
    Equal,
}

#[derive(Clone, Debug, PartialEq)]
enum Token {
    Number(f64),
    Name(String),
    Sign(&'static str),
}

/// The signs, longer ones first.
const SIGNS: [&str; 17] =
    ["..", "<=", ">=", "==", "<", ">", "=", "+", "-", "*", "/", "^", "(", ")", ",", "|", "\u{2264}"];

/// The numbers that a run gives of a signal.
const MEASURES: [(&str, CriterionKind); 12] = [
    ("max", CriterionKind::Max),
    ("min", CriterionKind::Min),
    ("range", CriterionKind::Range),
    ("mean", CriterionKind::Mean),
    ("rms", CriterionKind::Rms),
    ("deviation", CriterionKind::Deviation),
    ("integral", CriterionKind::Integral),
    ("final", CriterionKind::Final),
    ("at", CriterionKind::At(0.0)),
    ("time_of_max", CriterionKind::TimeOfMax),
    ("time_of_min", CriterionKind::TimeOfMin),
    ("crossings", CriterionKind::Crossings(0.0)),
];

/// Functions of one number.
const FUNCTIONS: [(&str, One); 7] = [
    ("abs", One::Abs),
    ("sqrt", One::Sqrt),
    ("sin", One::Sin),
    ("cos", One::Cos),
    ("tan", One::Tan),
    ("exp", One::Exp),
    ("ln", One::Ln),
];

/// Reads a text. The measures in it are added to `measures`.
pub struct Reader<'a> {
    model: &'static Description,
    measures: &'a mut Vec<Measure>,
    text: &'a str,
    tokens: Vec<(usize, Token)>,
    next: usize,
}

type Found<T> = Result<T, CriterionError>;

impl<'a> Reader<'a> {
    /// That of `text`, of a model that is described so.
    ///
    /// # Errors
    /// A character that means nothing.
    pub fn new(text: &'a str, model: &'static Description, measures: &'a mut Vec<Measure>) -> Found<Self> {
        Ok(Self { model, measures, text, tokens: tokens(text)?, next: 0 })
    }

    /// A number.
    ///
    /// # Errors
    /// It is none.
    pub fn number(mut self) -> Found<Node> {
        let node = self.sum()?;
        self.end()?;
        self.is_number(node)
    }

    /// A function of time, without measures.
    ///
    /// # Errors
    /// It is none.
    pub fn signal(mut self) -> Found<Node> {
        let node = self.sum()?;
        self.end()?;
        let mut has_measure = false;
        node.each(&mut |node| has_measure |= matches!(node, Node::Measure(_)));
        if has_measure { Err(CriterionError::NoCourse(self.text.trim().to_owned())) } else { Ok(node) }
    }

    /// Two numbers that are compared.
    ///
    /// # Errors
    /// It is none.
    pub fn comparison(mut self) -> Found<(Node, Relation, Node)> {
        let left = self.sum()?;
        let relation = match self.peek() {
            Some(Token::Sign("<" | "<=" | "\u{2264}")) => Relation::AtMost,
            Some(Token::Sign(">" | ">=")) => Relation::AtLeast,
            Some(Token::Sign("=" | "==")) => Relation::Equal,
            _ => return Err(self.fault("`<`, `>` or `=`, as in mean(speed) > 30")),
        };
        self.next += 1;
        let right = self.sum()?;
        self.end()?;
        Ok((self.is_number(left)?, relation, self.is_number(right)?))
    }

    fn is_number(&self, node: Node) -> Found<Node> {
        if node.is_signal() { Err(CriterionError::Signal(self.text.trim().to_owned())) } else { Ok(node) }
    }

    fn peek(&self) -> Option<&Token> {
        self.tokens.get(self.next).map(|(_, token)| token)
    }

    fn is_next(&self, sign: &str) -> bool {
        matches!(self.peek(), Some(Token::Sign(found)) if *found == sign)
    }

    fn takes(&mut self, sign: &str) -> bool {
        let is = self.is_next(sign);
        self.next += usize::from(is);
        is
    }

    fn wants(&mut self, sign: &'static str) -> Found<()> {
        if self.takes(sign) { Ok(()) } else { Err(self.fault(&format!("`{sign}`"))) }
    }

    fn end(&self) -> Found<()> {
        if self.next == self.tokens.len() { Ok(()) } else { Err(self.fault("an end or an operator")) }
    }

    fn fault(&self, wanted: &str) -> CriterionError {
        let at = self.tokens.get(self.next).map_or(self.text.len(), |(at, _)| *at);
        let found = self.text[at..].trim();
        let found = if found.is_empty() { "the end".to_owned() } else { format!("`{found}`") };
        CriterionError::Syntax { text: self.text.trim().to_owned(), wanted: wanted.to_owned(), found }
    }

    fn sum(&mut self) -> Found<Node> {
        let mut node = self.product()?;
        loop {
            let two = if self.takes("+") {
                Two::Plus
            } else if self.takes("-") {
                Two::Minus
            } else {
                return Ok(node);
            };
            node = Node::Two(two, Box::new(node), Box::new(self.product()?));
        }
    }

    fn product(&mut self) -> Found<Node> {
        let mut node = self.signed()?;
        loop {
            let two = if self.takes("*") {
                Two::Times
            } else if self.takes("/") {
                Two::Over
            } else {
                return Ok(node);
            };
            node = Node::Two(two, Box::new(node), Box::new(self.signed()?));
        }
    }

    fn signed(&mut self) -> Found<Node> {
        if self.takes("-") {
            return Ok(self.signed()?.negative());
        }
        let base = self.primary()?;
        if self.takes("^") {
            return Ok(Node::Two(Two::Power, Box::new(base), Box::new(self.signed()?)));
        }
        Ok(base)
    }

    fn primary(&mut self) -> Found<Node> {
        match self.peek().cloned() {
            Some(Token::Number(number)) => {
                self.next += 1;
                let unit = self.unit();
                Ok(Node::Number(unit.as_ref().map_or(number, |shown| shown.unit.in_si(number)), unit))
            }
            Some(Token::Sign("(")) => {
                self.next += 1;
                let node = self.sum()?;
                self.wants(")").map(|()| node)
            }
            Some(Token::Sign("|")) => {
                self.next += 1;
                let node = self.vector_or_sum()?;
                self.wants("|")?;
                Ok(match <[Node; 1]>::try_from(node) {
                    Ok([one]) => Node::One(One::Abs, Box::new(one)),
                    Err(several) => Node::Norm(several),
                })
            }
            Some(Token::Name(name)) => {
                self.next += 1;
                self.named(&name)
            }
            _ => Err(self.fault("a number, an output, a parameter or a measure")),
        }
    }

    /// The unit after a number: as long as what follows is one.
    fn unit(&mut self) -> Option<Shown> {
        let symbol = |token: Option<&(usize, Token)>| match token {
            Some((_, Token::Name(name))) if Shown::of(name).is_some() && !self.is_known(name) => Some(name.clone()),
            _ => None,
        };
        let mut text = symbol(self.tokens.get(self.next))?;
        let mut end = self.next + 1;
        loop {
            match &self.tokens.get(end..) {
                Some([(_, Token::Sign("^")), (_, Token::Number(power)), ..]) if power.fract() == 0.0 => {
                    text += &format!("^{power}");
                    end += 2;
                }
                Some([(_, Token::Sign(sign @ ("*" | "/"))), rest, ..]) => match symbol(Some(rest)) {
                    Some(more) => {
                        text += sign;
                        text += &more;
                        end += 2;
                    }
                    None => break,
                },
                _ => break,
            }
        }
        self.next = end;
        Shown::of(&text)
    }

    fn is_known(&self, name: &str) -> bool {
        self.model.parameters.iter().any(|info| info.name == name) || !self.outputs(name).is_empty()
    }

    /// The outputs of a name: one of it, the components of a vector, or what observes what is written so.
    fn outputs(&self, name: &str) -> Vec<usize> {
        let all = self.model.outputs;
        if let Some(place) = all.iter().position(|output| output.name == name) {
            return vec![place];
        }
        let of = |is: &dyn Fn(&bg_model::description::OutputInfo) -> bool| -> Vec<usize> {
            all.iter().enumerate().filter(|(_, output)| is(output)).map(|(place, _)| place).collect()
        };
        let components = of(&|output| output.of == name);
        if !components.is_empty() {
            return components;
        }
        // A component is `pin.force.x` beside what is observed, `pin.force`.
        let observed = of(&|output| output.observes == name);
        match (observed.as_slice(), name.rsplit_once('.')) {
            ([], Some((vector, axis))) => {
                let found = of(&|output| output.observes == vector && output.name == format!("{}_{axis}", output.of));
                found.into_iter().take(1).collect()
            }
            ([first, ..], _) => {
                let of = all[*first].of;
                observed.into_iter().filter(|&place| all[place].of == of).collect()
            }
            _ => Vec::new(),
        }
    }

    fn named(&mut self, name: &str) -> Found<Node> {
        // A function has its argument right after it.
        let is_applied = matches!(self.peek(), Some(Token::Sign("(" | "|") | Token::Name(_)));
        if is_applied && !self.is_known(name) {
            if let Some((_, kind)) = MEASURES.iter().find(|(known, _)| *known == name) {
                return self.measure(name, *kind);
            }
            if let Some((_, one)) = FUNCTIONS.iter().find(|(known, _)| *known == name) {
                let [argument] = self.arguments(name)?;
                return Ok(Node::One(*one, Box::new(argument)));
            }
            if name == "norm" {
                self.wants("(")?;
                let components = self.vector_or_sum()?;
                self.wants(")")?;
                return Ok(Node::Norm(components));
            }
        }
        let places = self.outputs(name);
        match places[..] {
            [place] => return Ok(Node::Output(place)),
            [_, _, ..] => {
                let names: Vec<&str> = places.iter().map(|&place| self.model.outputs[place].name).collect();
                return Err(CriterionError::Vector { name: name.to_owned(), components: names.join(", ") });
            }
            [] => {}
        }
        if let Some(place) = self.model.parameters.iter().position(|info| info.name == name) {
            return Ok(Node::Parameter(place));
        }
        if name == "t" {
            return Ok(Node::Time);
        }
        Err(self.unknown(name))
    }

    fn unknown(&self, name: &str) -> CriterionError {
        // As the command line tells of near misses.
        const SIMILAR: f64 = 0.7;
        let outputs = self.model.outputs.iter().map(|output| output.name);
        let words = MEASURES.iter().map(|(name, _)| *name).chain(FUNCTIONS.iter().map(|(name, _)| *name));
        let all = outputs.chain(self.model.parameters.iter().map(|info| info.name)).chain(words);
        let near = all.map(|known| (strsim::jaro_winkler(name, known), known));
        let near = near.filter(|(similarity, _)| *similarity > SIMILAR).max_by(|a, b| a.0.total_cmp(&b.0));
        CriterionError::Unknown { name: name.to_owned(), near: near.map(|(_, near)| near.to_owned()) }
    }

    /// The components of a vector that is named alone, or one sum.
    fn vector_or_sum(&mut self) -> Found<Vec<Node>> {
        if let (Some(Token::Name(name)), Some((_, Token::Sign(")" | "|")))) =
            (self.peek().cloned(), self.tokens.get(self.next + 1))
        {
            let places = self.outputs(&name);
            if !places.is_empty() {
                self.next += 1;
                return Ok(places.into_iter().map(Node::Output).collect());
            }
        }
        let mut several = vec![self.sum()?];
        while self.takes(",") {
            several.push(self.sum()?);
        }
        Ok(several)
    }

    /// So many arguments of a function; of one alone brackets may be left out.
    fn arguments<const N: usize>(&mut self, name: &str) -> Found<[Node; N]> {
        let several = if self.takes("(") {
            let mut several = vec![self.sum()?];
            while self.takes(",") {
                several.push(self.sum()?);
            }
            self.wants(")")?;
            several
        } else {
            vec![self.primary()?]
        };
        several.try_into().map_err(|_| CriterionError::Arguments { name: name.to_owned() })
    }

    /// A measure of a signal, over a window of time if one is given; `max` and `min` of several are the one of these.
    fn measure(&mut self, name: &str, kind: CriterionKind) -> Found<Node> {
        let mut several = Vec::new();
        let mut window = None;
        if self.takes("(") {
            loop {
                match self.window()? {
                    Some(found) => window = Some(found),
                    None => several.push(self.sum()?),
                }
                if !self.takes(",") {
                    break;
                }
            }
            self.wants(")")?;
        } else {
            several.push(self.primary()?);
        }
        let wrong = || CriterionError::Arguments { name: name.to_owned() };
        let number = |node: Option<Node>| node.and_then(|node| node.constant()).ok_or_else(wrong);
        let (kind, count) = match kind {
            CriterionKind::Max if several.len() > 1 && window.is_none() => return Ok(Node::Largest(several)),
            CriterionKind::Min if several.len() > 1 && window.is_none() => return Ok(Node::Least(several)),
            CriterionKind::At(_) => (CriterionKind::At(number(several.get(1).cloned())?), 2),
            CriterionKind::Crossings(_) if several.len() > 1 => {
                (CriterionKind::Crossings(number(several.get(1).cloned())?), 2)
            }
            kind => (kind, 1),
        };
        if several.len() != count {
            return Err(wrong());
        }
        let signal = several.swap_remove(0);
        if !signal.is_signal() {
            return Err(CriterionError::NoSignal { name: name.to_owned() });
        }
        let measure = Measure { kind, signal, window };
        let place = self.measures.iter().position(|known| *known == measure).unwrap_or_else(|| {
            self.measures.push(measure);
            self.measures.len() - 1
        });
        Ok(Node::Measure(place))
    }

    /// A window of time, `2..5` or `2..`, s.
    fn window(&mut self) -> Found<Option<[f64; 2]>> {
        let Some([(_, Token::Number(from)), (_, Token::Sign(".."))]) = self.tokens.get(self.next..self.next + 2) else {
            return Ok(None);
        };
        let from = *from;
        self.next += 2;
        let to = match self.peek() {
            Some(Token::Number(to)) => {
                let to = *to;
                self.next += 1;
                to
            }
            _ => f64::INFINITY,
        };
        if from < to {
            Ok(Some([from, to]))
        } else {
            Err(CriterionError::Window { from: from.to_string(), to: to.to_string() })
        }
    }
}

fn tokens(text: &str) -> Found<Vec<(usize, Token)>> {
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(first) = text[at..].chars().next() {
        let rest = &text[at..];
        if first.is_whitespace() {
            at += first.len_utf8();
            continue;
        }
        let (token, length) = if first.is_ascii_digit() || (first == '.' && rest[1..].starts_with(digit)) {
            let length = length_of_number(rest);
            let number = rest[..length].parse().map_err(|_| unreadable(text, rest))?;
            (Token::Number(number), length)
        } else if first.is_alphabetic() || first == '_' || first == '%' {
            let is_part = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.' | '[' | ']' | '%');
            let length = rest.find(|c| !is_part(c)).unwrap_or(rest.len());
            // `x..` begins a window, and a name ends with no dot.
            let length = rest[..length].find("..").unwrap_or(length);
            (Token::Name(rest[..length].to_owned()), length)
        } else {
            let sign = SIGNS.iter().find(|sign| rest.starts_with(**sign)).ok_or_else(|| unreadable(text, rest))?;
            (Token::Sign(sign), sign.len())
        };
        tokens.push((at, token));
        at += length;
    }
    Ok(tokens)
}

fn digit(c: char) -> bool {
    c.is_ascii_digit()
}

fn unreadable(text: &str, rest: &str) -> CriterionError {
    let (text, found) = (text.trim().to_owned(), format!("`{}`", rest.trim()));
    CriterionError::Syntax { text, wanted: "a number, a name or an operator".to_owned(), found }
}

/// The length of the number at the start of a text: digits, a point that no second one follows, an exponent.
fn length_of_number(text: &str) -> usize {
    let digits = |from: usize| text[from..].find(|c: char| !digit(c)).map_or(text.len(), |length| from + length);
    let mut end = digits(0);
    if text[end..].starts_with('.') && !text[end..].starts_with("..") {
        end = digits(end + 1);
    }
    if let Some(exponent) = text[end..].strip_prefix(['e', 'E']) {
        let signed = exponent.strip_prefix(['+', '-']).unwrap_or(exponent);
        if signed.starts_with(digit) {
            end = digits(text.len() - signed.len());
        }
    }
    end
}
