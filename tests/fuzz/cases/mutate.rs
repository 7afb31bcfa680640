//! Mutants of valid texts.
//!
//! In: texts. Out: one of them with one to four changes of its lexemes.

use fastrand::Rng;

use super::draw::{EXTREMES, one, rarely};
use super::lexemes::{joined, lexemes};
use super::vocabulary;

/// Texts beyond so many bytes are taken a hundredth as often: they take a hundred times as long.
const LONG: usize = 4000;

/// A mutant of one of the texts.
pub(super) fn mutant(rng: &mut Rng, seeds: &[String]) -> String {
    let mut text = rng.choice(seeds).map_or("", String::as_str);
    while text.len() > LONG && !rarely(rng, 100) {
        text = rng.choice(seeds).map_or("", String::as_str);
    }
    let mut all = lexemes(text);
    for _ in 0..=rng.usize(..4).min(rng.usize(..4)) {
        if all.is_empty() {
            break;
        }
        change(rng, &mut all, seeds);
    }
    joined(&all)
}

/// One change.
fn change(rng: &mut Rng, all: &mut Vec<String>, seeds: &[String]) {
    let (at, other) = (rng.usize(..all.len()), rng.usize(..all.len()));
    let end = all.len().min(at + 1 + rng.usize(..8).min(rng.usize(..8)));
    match rng.u32(..20) {
        0 | 1 => drop(all.drain(at..end)),
        2 => {
            let copy: Vec<String> = all[at..end].to_vec();
            all.splice(other..other, copy);
        }
        3 => all.swap(at, other),
        4 => all[at] = all[other].clone(),
        5 => all[at] = vocabulary::lexeme(rng),
        6 => all.insert(at, vocabulary::lexeme(rng)),
        7 | 8 | 17 => renumber(rng, all),
        9 | 18 => rename(rng, all),
        10 | 19 => nest(rng, all, at),
        12 | 13 => alike(rng, all, at),
        14..=16 => statement(rng, all, at, other),
        _ => graft(rng, all, at, seeds),
    }
}

/// Another number in the place of one.
fn renumber(rng: &mut Rng, all: &mut [String]) {
    let is_number = |lexeme: &&mut String| lexeme.starts_with(|c: char| c.is_ascii_digit());
    let mut numbers: Vec<&mut String> = all.iter_mut().filter(is_number).collect();
    let count = numbers.len();
    if count > 0 {
        *numbers[rng.usize(..count)] = one(rng, &EXTREMES).to_owned();
    }
}

/// A word becomes another word of the text, a mark another mark.
fn alike(rng: &mut Rng, all: &mut [String], at: usize) {
    let is_word = |lexeme: &str| lexeme.starts_with(char::is_alphabetic);
    let same: Vec<String> = all.iter().filter(|lexeme| is_word(lexeme) == is_word(&all[at])).cloned().collect();
    if let Some(found) = rng.choice(&same) {
        all[at].clone_from(found);
    }
}

/// A statement goes, comes twice, or moves.
fn statement(rng: &mut Rng, all: &mut Vec<String>, at: usize, to: usize) {
    let behind =
        |all: &[String], from: usize| all[from..].iter().position(|lexeme| lexeme == ";").map(|k| from + k + 1);
    let Some(begin) = behind(all, at) else { return };
    let Some(end) = behind(all, begin) else { return };
    let text = all[begin..end].to_vec();
    if rng.bool() {
        all.drain(begin..end);
    }
    if rng.u32(..3) > 0
        && let Some(place) = behind(all, to.min(all.len()))
    {
        all.splice(place..place, text);
    }
}

/// Every occurrence of one word becomes another word of the text.
fn rename(rng: &mut Rng, all: &mut [String]) {
    let is_word = |lexeme: &&String| lexeme.starts_with(|c: char| c.is_alphabetic());
    let words: Vec<String> = all.iter().filter(is_word).cloned().collect();
    let (Some(from), Some(to)) = (rng.choice(&words), rng.choice(&words)) else { return };
    all.iter_mut().filter(|lexeme| *lexeme == from).for_each(|lexeme| lexeme.clone_from(to));
}

/// Brackets, signs, a function or a power around a lexeme, a few or very many.
fn nest(rng: &mut Rng, all: &mut Vec<String>, at: usize) {
    let (open, close) =
        [("(", ")"), ("-", ""), ("[", "]"), ("abs(", ")"), ("pow(", ",16)"), ("{", "}")][rng.usize(..6)];
    let times = if rarely(rng, 20) { 10_000 } else { rng.usize(1..40) };
    let nested = format!("{}{}{}", open.repeat(times), all[at], close.repeat(times));
    all.splice(at..=at, lexemes(&nested));
}

/// A piece of another text.
fn graft(rng: &mut Rng, all: &mut Vec<String>, at: usize, seeds: &[String]) {
    let short: Vec<&String> = seeds.iter().filter(|text| text.len() <= LONG).collect();
    let Some(donor) = rng.choice(&short) else { return };
    let donor = lexemes(donor);
    if donor.is_empty() {
        return;
    }
    let begin = rng.usize(..donor.len());
    let end = donor.len().min(begin + rng.usize(1..40));
    all.splice(at..at, donor[begin..end].iter().cloned());
}
