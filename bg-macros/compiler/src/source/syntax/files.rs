//! Files that use parts of other files, `use "parts/shaft.bond";`, and of the library, `use gears;`.
//!
//! In: the text of a file, what opens others; or a call of the macro, which uses the library only. Out: the tokens of
//! one text: the parts of all files that it uses, each file once, then what stands in the file itself. Of the library
//! there are only the parts that are used. No longer occurs: `use`, but for those of files in a call, which the parser
//! has a fault for.
//!
//! Graphs of a used file are left alone, and its parts are no items of Rust: these are what the file itself has.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use proc_macro2::{Delimiter, LexError, Span, TokenStream, TokenTree};

use super::{parse_leniently, points};
use crate::fault::{Explain, Fault, Faults, near_miss};
use crate::source::ast::{PartPath, Source, used_parts};
use crate::source::library;

/// Files around a file that use each other: more than any library of parts has.
const DEEPEST: usize = 64;
/// Files of one text.
const MOST: usize = 1000;

/// A file that has been opened.
#[derive(Clone, Debug)]
pub struct Opened {
    /// Which file it is, whatever path leads to it.
    pub file: PathBuf,
    /// Its text.
    pub text: String,
}

/// What opens the file of a path, or says why it cannot.
pub type Open<'o> = &'o dyn Fn(&Path) -> Result<Opened, String>;

/// A file of a text.
#[derive(Clone, Debug)]
pub struct File {
    /// Its path: that of the first file, or one that begins in the folder of the file that uses it.
    pub path: PathBuf,
    /// Its text.
    pub text: String,
    /// Whether it is one of the library, which is in no folder.
    pub is_of_library: bool,
    /// What the spans of its tokens call it.
    called: String,
}

/// A text with all files that it uses.
#[derive(Clone, Debug, Default)]
pub struct Gathered {
    /// Its parts and graphs.
    pub tokens: TokenStream,
    /// The files: first the text itself.
    pub files: Vec<File>,
    /// What is wrong with the files.
    pub faults: Faults,
}

impl Gathered {
    /// The file of a place; the text itself where a place is in none.
    #[must_use]
    pub fn place(&self, span: Span) -> usize {
        let called = span.file();
        let is_called = |file: &File| !file.called.is_empty() && file.called == called;
        self.files.iter().position(is_called).unwrap_or_default()
    }

    /// The fault with the files' paths in its message.
    #[must_use]
    pub fn named(&self, mut fault: Fault) -> Fault {
        for file in self.files.iter().filter(|file| !file.called.is_empty()) {
            fault.message = fault.message.replace(&file.called, &file.path.display().to_string());
        }
        fault
    }
}

/// A fault of files that use each other.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "each variant's message says what it and its fields are")]
pub enum FileFault {
    Unreadable { reason: String, folder: PathBuf },
    Circle { files: Vec<PathBuf> },
    Deep,
    Many,
    Elsewhere { part: String, file: PathBuf },
    NoPart { file: PathBuf },
    NoPoints { file: PathBuf, reason: String },
    NotInLibrary { name: String },
    OfLibrary { part: String, library: &'static str },
    NoText,
}

impl Explain for FileFault {
    fn code(&self) -> &'static str {
        match self {
            Self::Unreadable { .. } => "BG0901",
            Self::Circle { .. } => "BG0902",
            Self::Deep | Self::Many => "BG0903",
            Self::Elsewhere { .. } => "BG0904",
            Self::NoPart { .. } => "BG0905",
            Self::NoPoints { .. } => "BG0907",
            Self::NotInLibrary { .. } => "BG0908",
            Self::OfLibrary { .. } => "BG0302",
            Self::NoText => "BG0906",
        }
    }

    fn message(&self) -> String {
        match self {
            Self::Unreadable { reason, .. } => reason.clone(),
            Self::Circle { files } => {
                let files: Vec<String> = files.iter().map(|file| file.display().to_string()).collect();
                format!("`{}` uses itself: {}", files[0], files.join(" -> "))
            }
            Self::Deep => format!("files use files, more than {DEEPEST} deep"),
            Self::Many => format!("more than {MOST} files"),
            Self::Elsewhere { part, file } => {
                format!("the part `{part}` stands in `{}`, which this file does not use", file.display())
            }
            Self::NoPart { file } => format!("`{}` has no part to use", file.display()),
            Self::NoPoints { file, reason } => format!("`{}` has no points of a table: {reason}", file.display()),
            Self::NotInLibrary { name } => format!("the library of parts has no file `{name}`"),
            Self::OfLibrary { part, library } => {
                format!("`{part}` is the name of a part of the library, too, which `use {library};` brings")
            }
            Self::NoText => "a bracket, a quote or a character is out of place".to_owned(),
        }
    }

    fn help(&self) -> String {
        match self {
            Self::Unreadable { folder, .. } if folder.as_os_str().is_empty() => {
                "write its path from the folder of this file".to_owned()
            }
            Self::Unreadable { folder, .. } => {
                format!("write its path from the folder of this file, `{}`", folder.display())
            }
            Self::Circle { .. } => "move what both need into a file of its own, and use that".to_owned(),
            Self::Deep | Self::Many => "write parts that belong together into one file".to_owned(),
            Self::Elsewhere { part, .. } => match library::home(part) {
                Some(library) => format!("write `use {library};` above it"),
                None => "add a `use` of that file".to_owned(),
            },
            Self::NoPart { .. } => "make a part of what is to be used, or remove this".to_owned(),
            Self::NoPoints { .. } => "write two columns of numbers separated by commas, with a head such as \
                                      `speed [rpm],torque [N*m]` or without"
                .to_owned(),
            Self::NotInLibrary { name } => match near_miss(name, library::names()) {
                Some(near) => format!("write `use {near};`"),
                None => {
                    let known: Vec<String> = library::names().map(|name| format!("`{name}`")).collect();
                    format!("write one of {}, or the path of a file of yours in quotes", known.join(", "))
                }
            },
            Self::OfLibrary { .. } => "give yours another name".to_owned(),
            Self::NoText => "close what is open, and quote what is text".to_owned(),
        }
    }
}

/// The text of the file at `path` with the files that it uses.
#[must_use]
pub fn gather(path: &Path, first: Opened, open: Open<'_>) -> Gathered {
    let mut gathering = Gathering::new(open);
    gathering.file(path, first, Of::First);
    gathering.finish()
}

/// A call of the macro with the parts of the library that it uses.
#[must_use]
pub fn call(tokens: TokenStream) -> (TokenStream, Faults) {
    let own = pieces(tokens.clone(), false);
    if !own.iter().any(|piece| matches!(piece, Piece::Library(..))) {
        return (tokens, Faults::new());
    }
    let open: Open<'_> = &|path| Err(format!("cannot read {}", path.display()));
    let mut gathering = Gathering::new(open);
    let place = gathering.begin(Path::new(""), Opened { file: PathBuf::new(), text: String::new() }, Of::First);
    gathering.own(place, own, Of::First);
    let Gathered { tokens, faults, .. } = gathering.finish();
    (tokens, faults)
}

/// The text of a file alone, without what it uses; tables of other files have two points.
///
/// # Errors
/// It is made of no tokens.
pub fn alone(text: &str) -> Result<TokenStream, Fault> {
    let tokens = text.parse().map_err(|fault: LexError| Fault::new(fault.span(), &FileFault::NoText))?;
    let tokens = points::replaced(tokens, &mut |_, span| points::points("0,0\n1,0", span).ok());
    let own = pieces(tokens, true).into_iter().filter_map(|piece| match piece {
        Piece::Use(..) | Piece::Library(..) => None,
        Piece::Graph(tokens) | Piece::Part(tokens) | Piece::Other(tokens) => Some(tokens),
    });
    Ok(own.flatten().collect())
}

/// What a file is among those of a text.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Of {
    /// The text itself.
    First,
    /// A file of its user's.
    User,
    /// A file of the library.
    Library,
}

/// A file whose uses have been followed.
#[derive(Default)]
struct Known {
    file: PathBuf,
    /// Its pieces: parts and graphs.
    own: Vec<TokenStream>,
    uses: Vec<usize>,
}

impl Known {
    /// What could be read of it, and whether that is all.
    fn source(&self) -> (Source, bool) {
        if self.own.is_empty() {
            return (Source::default(), true);
        }
        let (source, faults) = parse_leniently(self.own.iter().cloned().collect());
        (source, faults.is_empty())
    }
}

struct Gathering<'o> {
    open: Open<'o>,
    known: Vec<Known>,
    /// The files that are being read, the outermost first.
    around: Vec<usize>,
    /// The files in the order in which they have been read.
    read: Vec<usize>,
    gathered: Gathered,
}

impl<'o> Gathering<'o> {
    fn new(open: Open<'o>) -> Self {
        Self { open, known: Vec::new(), around: Vec::new(), read: Vec::new(), gathered: Gathered::default() }
    }

    /// The place of a file that is to be read.
    fn begin(&mut self, path: &Path, Opened { file, text }: Opened, of: Of) -> usize {
        self.known.push(Known { file, ..Known::default() });
        let is_of_library = of == Of::Library;
        self.gathered.files.push(File { path: path.to_owned(), text, is_of_library, called: String::new() });
        self.known.len() - 1
    }

    /// Reads a file, after those that it uses, and gives its place.
    fn file(&mut self, path: &Path, opened: Opened, of: Of) -> usize {
        let tokens = opened.text.parse::<TokenStream>().map_err(|fault| fault.span());
        let called = match &tokens {
            Ok(tokens) => tokens.clone().into_iter().next().map_or_else(String::new, |first| first.span().file()),
            Err(span) => span.file(),
        };
        let place = self.begin(path, opened, of);
        self.gathered.files[place].called = called;
        match tokens {
            Ok(tokens) => {
                let tokens = points::replaced(tokens, &mut |name, span| self.points(place, name, span));
                self.own(place, pieces(tokens, true), of);
            }
            Err(span) => self.fault(span, &FileFault::NoText),
        }
        place
    }

    /// Follows what the pieces of a file use, and keeps what is left of them.
    fn own(&mut self, place: usize, pieces: Vec<Piece>, of: Of) {
        self.around.push(place);
        self.known[place].own = pieces.into_iter().filter_map(|piece| self.piece(place, piece, of)).collect();
        self.around.pop();
        self.read.push(place);
    }

    /// What is left of a piece of a file where the file is one of several.
    fn piece(&mut self, place: usize, piece: Piece, of: Of) -> Option<TokenStream> {
        match piece {
            Piece::Use(path, span) => {
                self.used(place, &path, span);
                None
            }
            Piece::Library(name, span) => {
                self.library(place, &name, span);
                None
            }
            Piece::Graph(_) if of != Of::First => None,
            Piece::Part(tokens) if of != Of::First => Some(without_visibility(tokens)),
            Piece::Graph(tokens) | Piece::Part(tokens) | Piece::Other(tokens) => Some(tokens.into_iter().collect()),
        }
    }

    /// A file of the library.
    fn library(&mut self, by: usize, name: &str, span: Span) {
        let Some(text) = library::text(name) else {
            return self.fault(span, &FileFault::NotInLibrary { name: name.to_owned() });
        };
        let path = library::path(name);
        let known = (0..self.known.len()).find(|&place| self.is_of_library(place) && self.known[place].file == path);
        let place = known.unwrap_or_else(|| {
            let opened = Opened { file: path.clone(), text: text.to_owned() };
            self.file(&path, opened, Of::Library)
        });
        self.known[by].uses.push(place);
    }

    fn is_of_library(&self, place: usize) -> bool {
        self.gathered.files[place].is_of_library
    }

    fn used(&mut self, by: usize, path: &str, span: Span) {
        if self.around.len() >= DEEPEST {
            return self.fault(span, &FileFault::Deep);
        }
        if self.known.len() >= MOST {
            return self.fault(span, &FileFault::Many);
        }
        let Some((path, opened)) = self.opened(by, path, span) else { return };
        let is_same = |place: &usize| !self.is_of_library(*place) && self.known[*place].file == opened.file;
        let known = (0..self.known.len()).find(is_same);
        if let Some(start) = known.and_then(|known| self.around.iter().position(|around| *around == known)) {
            let circle = self.around[start..].iter().chain([&self.around[start]]);
            let files = circle.map(|place| self.gathered.files[*place].path.clone()).collect();
            return self.fault(span, &FileFault::Circle { files });
        }
        let place = known.unwrap_or_else(|| {
            let before = self.gathered.faults.len();
            let place = self.file(&path, opened, Of::User);
            let Known { own, uses, .. } = &self.known[place];
            if own.is_empty() && uses.is_empty() && self.gathered.faults.len() == before {
                self.fault(span, &FileFault::NoPart { file: path });
            }
            place
        });
        self.known[by].uses.push(place);
    }

    /// The points of a file that a table of the file `by` names.
    fn points(&mut self, by: usize, name: &str, span: Span) -> Option<TokenStream> {
        let (path, Opened { file, text }) = self.opened(by, name, span)?;
        let points = points::points(&text, span);
        self.begin(&path, Opened { file, text }, Of::User);
        points.map_err(|reason| self.fault(span, &FileFault::NoPoints { file: path, reason })).ok()
    }

    /// The file of this path from the folder of the file `by`.
    fn opened(&mut self, by: usize, path: &str, span: Span) -> Option<(PathBuf, Opened)> {
        let folder = self.gathered.files[by].path.parent().unwrap_or(Path::new("")).to_owned();
        let path = folder.join(path);
        match (self.open)(&path) {
            Ok(opened) => Some((path, opened)),
            Err(reason) => {
                self.fault(span, &FileFault::Unreadable { reason, folder });
                None
            }
        }
    }

    /// Each file uses what it names; of the library what is used is there.
    fn finish(mut self) -> Gathered {
        let order = std::mem::take(&mut self.read);
        let own = |gathering: &Self| order.iter().flat_map(|&place| gathering.known[place].own.clone()).collect();
        if self.known.len() == 1 || !self.gathered.faults.is_empty() {
            self.gathered.tokens = own(&self);
            return self.gathered;
        }
        let (sources, are_whole): (Vec<Source>, Vec<bool>) = self.known.iter().map(Known::source).unzip();
        // Of files with faults of syntax not all parts are known.
        if are_whole.iter().all(|is_whole| *is_whole) {
            self.find_parts(&sources);
        }
        // An editor compares a text with the same one and a fault at the caret: the library's part in both is one.
        self.leave_what_nobody_uses(&sources);
        self.gathered.tokens = own(&self);
        self.gathered
    }

    /// A part of another file stands in a file that is used, and its name is no other one's.
    fn find_parts(&mut self, sources: &[Source]) {
        let has = |file: usize, name: &str| sources[file].parts.iter().any(|part| part.name.text == name);
        for place in 0..sources.len() {
            let mut seen = BTreeSet::from([place]);
            self.reach(place, &mut seen);
            for path in named(&sources[place]) {
                let name = &path.name.text;
                if seen.iter().any(|&file| has(file, name)) {
                    continue;
                }
                if let Some(file) = (0..sources.len()).find(|&file| has(file, name)) {
                    let file = self.gathered.files[file].path.clone();
                    self.fault(path.name.span, &FileFault::Elsewhere { part: name.clone(), file });
                }
            }
            let is_twice = |name: &str| (0..sources.len()).any(|file| self.is_of_library(file) && has(file, name));
            let own = sources[place].parts.iter().filter(|_| !self.is_of_library(place));
            let twice: Vec<_> = own.filter(|part| is_twice(&part.name.text)).map(|part| part.name.clone()).collect();
            for name in twice {
                let library = library::home(&name.text).unwrap_or_default();
                self.fault(name.span, &FileFault::OfLibrary { part: name.text, library });
            }
        }
    }

    /// Takes parts of the library away that neither the text nor those which it uses name.
    fn leave_what_nobody_uses(&mut self, sources: &[Source]) {
        let (of_library, of_user): (Vec<usize>, Vec<usize>) =
            (0..sources.len()).partition(|&place| self.is_of_library(place));
        let mut used: BTreeSet<&str> =
            of_user.iter().flat_map(|&place| named(&sources[place])).map(|path| path.name.text.as_str()).collect();
        let parts = || of_library.iter().flat_map(|&place| &sources[place].parts);
        loop {
            let inside = parts().filter(|part| used.contains(part.name.text.as_str()));
            let inside: Vec<&PartPath> = inside.flat_map(|part| used_parts(&part.items)).collect();
            let before = used.len();
            used.extend(inside.iter().map(|path| path.name.text.as_str()));
            if used.len() == before {
                break;
            }
        }
        for &place in &of_library {
            let mut parts = sources[place].parts.iter();
            // Each piece of such a file is a part.
            self.known[place].own.retain(|_| parts.next().is_some_and(|part| used.contains(part.name.text.as_str())));
        }
    }

    /// Adds the files that one uses, and those that these use.
    fn reach(&self, place: usize, seen: &mut BTreeSet<usize>) {
        for &used in &self.known[place].uses {
            if seen.insert(used) {
                self.reach(used, seen);
            }
        }
    }

    fn fault(&mut self, span: Span, fault: &FileFault) {
        self.gathered.faults.push(Fault::new(span, fault));
    }
}

/// The parts that a source names by their names alone.
fn named(source: &Source) -> impl Iterator<Item = &PartPath> {
    let lists = source.parts.iter().map(|part| &part.items).chain(source.graphs.iter().map(|graph| &graph.items));
    lists.flat_map(|items| used_parts(items)).filter(|path| !path.is_foreign())
}

/// A piece of a file.
enum Piece {
    /// `use "PATH";`, with the place of the path.
    Use(String, Span),
    /// `use NAME;`, with the place of the name.
    Library(String, Span),
    /// `graph NAME { ... }`
    Graph(Vec<TokenTree>),
    /// `part NAME { ... }`
    Part(Vec<TokenTree>),
    /// What the parser has a fault for.
    Other(Vec<TokenTree>),
}

/// A file or a call in pieces, each as far as its braces. A call uses no files.
fn pieces(tokens: TokenStream, is_file: bool) -> Vec<Piece> {
    let (mut pieces, mut open) = (Vec::new(), Vec::new());
    let tokens: Vec<TokenTree> = tokens.into_iter().collect();
    let mut rest = tokens.as_slice();
    while let [first, after @ ..] = rest {
        if open.is_empty()
            && let [word, TokenTree::Ident(name), TokenTree::Punct(end), others @ ..] = rest
            && is_word(word, "use")
            && end.as_char() == ';'
        {
            pieces.push(Piece::Library(name.to_string(), name.span()));
            rest = others;
            continue;
        }
        if open.is_empty()
            && is_file
            && let [word, TokenTree::Literal(path), TokenTree::Punct(end), others @ ..] = rest
            && is_word(word, "use")
            && end.as_char() == ';'
            && let syn::Lit::Str(text) = syn::Lit::new(path.clone())
        {
            pieces.push(Piece::Use(text.value(), path.span()));
            rest = others;
            continue;
        }
        open.push(first.clone());
        rest = after;
        if matches!(first, TokenTree::Group(group) if group.delimiter() == Delimiter::Brace) {
            pieces.push(piece(std::mem::take(&mut open)));
        }
    }
    if !open.is_empty() {
        pieces.push(Piece::Other(open));
    }
    pieces
}

fn piece(tokens: Vec<TokenTree>) -> Piece {
    match tokens.as_slice() {
        [.., word, TokenTree::Ident(_), _] if is_word(word, "graph") => Piece::Graph(tokens),
        [.., word, TokenTree::Ident(_), _] if is_word(word, "part") => Piece::Part(tokens),
        _ => Piece::Other(tokens),
    }
}

/// A part that is no item of Rust: without `pub`, `pub(crate)`.
fn without_visibility(tokens: Vec<TokenTree>) -> TokenStream {
    let is_visibility = |tree: &TokenTree| {
        is_word(tree, "pub") || matches!(tree, TokenTree::Group(group) if group.delimiter() == Delimiter::Parenthesis)
    };
    tokens.into_iter().filter(|tree| !is_visibility(tree)).collect()
}

fn is_word(tree: &TokenTree, word: &str) -> bool {
    matches!(tree, TokenTree::Ident(found) if found == word)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pipeline;
    use crate::source::syntax::parse;

    const SHAFT: &str = "pub part Shaft { port end: rotation; I wheel = 2; end -> wheel; }";

    /// The faults of the file `a`, each with its file, line and column, or the graphs' names.
    fn gathered(files: &[(&str, &str)]) -> Result<Vec<String>, Vec<String>> {
        let open = |path: &Path| {
            let (mut clean, text) = (PathBuf::new(), path.to_str().expect("a path"));
            for word in text.split('/') {
                if word == ".." {
                    clean.pop();
                } else {
                    clean.push(word);
                }
            }
            let found = files.iter().find(|(name, _)| Path::new(name) == clean);
            let (_, text) = found.ok_or_else(|| format!("cannot read {text}"))?;
            Ok(Opened { file: clean, text: (*text).to_owned() })
        };
        let path = Path::new(files[0].0);
        let gathered = gather(path, open(path).expect("the first file"), &open);
        let models = if gathered.faults.is_empty() {
            parse(gathered.tokens.clone()).and_then(|source| pipeline::models(&source))
        } else {
            Err(gathered.faults.clone())
        };
        let told = |fault: Fault| {
            let (place, fault) = (fault.span.start(), gathered.named(fault));
            let file = gathered.files[gathered.place(fault.span)].path.display();
            format!("{file}:{}:{}: {} {}", place.line, place.column + 1, fault.code, fault.message)
        };
        models
            .map(|models| models.into_iter().map(|model| model.source.name.text).collect())
            .map_err(|faults| faults.into_iter().map(told).collect())
    }

    fn graph(uses: &str, part: &str) -> String {
        format!("{uses} graph G {{ part s: {part}; Se drive = 1; 1 j: rotation; drive -> j -> s.end; }}")
    }

    #[test]
    fn parts_of_other_files_are_there() {
        let a = graph("use \"parts/shaft.bond\"; use \"parts/b.bond\";", "Shaft");
        // Each file once; a graph of a used file is left alone, even with faults.
        let b = "use \"shaft.bond\"; graph G { wrong }";
        assert_eq!(gathered(&[("a", &a), ("parts/shaft.bond", SHAFT), ("parts/b.bond", b)]), Ok(vec!["G".to_owned()]));
        // A file hands on what it uses.
        let a = graph("use \"parts/b.bond\";", "Shaft");
        assert!(
            gathered(&[("a", &a), ("parts/shaft.bond", SHAFT), ("parts/b.bond", "use \"../parts/shaft.bond\";")])
                .is_ok()
        );
    }

    #[test]
    fn faults_are_at_their_places_in_their_files() {
        let said = |a: &str, b: &str, expected: &[&str]| {
            let faults = gathered(&[("f/a", a), ("f/b", b), ("f/shaft", SHAFT)]).expect_err(a);
            assert_eq!(faults, expected, "{a}\n{b}");
        };
        let (a, own) = (graph("use \"b\";", "Shaft"), graph("", "Shaft"));
        said(&graph("use \"c\";", "Shaft"), "", &["f/a:1:5: BG0901 cannot read f/c"]);
        said(&a, "\nuse \"a\";", &["f/b:2:5: BG0902 `f/a` uses itself: f/a -> f/b -> f/a"]);
        said(&a, &own, &["f/a:1:5: BG0905 `f/b` has no part to use"]);
        said(&a, "part Shaft {", &["f/b:1:12: BG0906 a bracket, a quote or a character is out of place"]);
        said(&a, "part Shaft { wrong }", &["f/b:1:14: BG0101 `wrong` begins no statement of a part"]);
        let twice = "f/shaft:1:10: BG0302 `Shaft` is declared twice, first in line 2 of f/b";
        said(&graph("use \"b\"; use \"shaft\";", "Shaft"), &format!("\n{SHAFT}"), &[twice]);
        // A unit that does not fit, deep inside.
        let wrong = SHAFT.replace("= 2", "= [1, 2]");
        let faults = gathered(&[("f/a", &a), ("f/b", &wrong)]).expect_err("a vector");
        assert!(faults[0].starts_with("f/b:1:") && faults[0].contains("in part `s: Shaft`"), "{faults:?}");
        // `b` needs what only `a` uses.
        let part = "part Both { part one: Shaft; }";
        let other = "f/b:1:23: BG0904 the part `Shaft` stands in `f/shaft`, which this file does not use";
        said(&graph("use \"shaft\"; use \"b\";", "Shaft"), part, &[other]);
    }

    #[test]
    fn files_in_files_end() {
        let deep: Vec<(String, String)> =
            (0..200).map(|k| (format!("{k}"), format!("use \"{}\"; part P{k} {{ let a = 1; }}", k + 1))).collect();
        let files: Vec<(&str, &str)> = deep.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
        assert_eq!(gathered(&files), Err(vec!["63:1:5: BG0903 files use files, more than 64 deep".to_owned()]));
        let uses: String = (0..2000).map(|k| format!("use \"{k}\";")).collect();
        let open = |path: &Path| Ok(Opened { file: path.to_owned(), text: SHAFT.to_owned() });
        let first = Opened { file: "a".into(), text: uses };
        let gathered = gather(Path::new("a"), first, &open);
        assert_eq!((gathered.files.len(), gathered.faults[0].code), (MOST, "BG0903"));
    }
}
