//! What a WebAssembly module of a `bg-workbench` program exports: a question goes in as text, its answer comes out as
//! text.
//!
//! ```text
//! main(0, 0)                         once: the program registers what answers
//! at = bg_live_reserve(length)       then write the question there, in UTF-8
//! at = bg_live_answer()              the answer is there, in UTF-8
//! length = bg_live_length()          of it, in bytes
//! ```
//!
//! A program that panics traps; the module is then used up, and another instance of it must be made. Nothing here is
//! unsafe but that the exported names could clash with others: the host reads and writes the memory, this code does not
//! read through pointers.

use std::cell::RefCell;

/// What answers a question.
type Answerer = Box<dyn Fn(&str) -> String>;

thread_local! {
    static ANSWERER: RefCell<Option<Answerer>> = const { RefCell::new(None) };
    /// The question, then the answer.
    static TEXT: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
}

/// Registers what answers from now on.
pub fn register(answerer: impl Fn(&str) -> String + 'static) {
    ANSWERER.set(Some(Box::new(answerer)));
}

/// Makes room for a question of `length` bytes and says where; the place is valid until the next call.
#[unsafe(no_mangle)]
pub extern "C" fn bg_live_reserve(length: usize) -> *mut u8 {
    TEXT.with_borrow_mut(|text| {
        text.clear();
        text.resize(length, 0);
        text.as_mut_ptr()
    })
}

/// Answers the question and says where the answer is, valid until the next call; empty where nothing is registered.
#[unsafe(no_mangle)]
pub extern "C" fn bg_live_answer() -> *const u8 {
    let question = String::from_utf8_lossy(&TEXT.take()).into_owned();
    let answer = ANSWERER.with_borrow(|answerer| answerer.as_ref().map(|answer| answer(&question)));
    TEXT.with_borrow_mut(|text| {
        *text = answer.unwrap_or_default().into_bytes();
        text.as_ptr()
    })
}

/// The length of the answer in bytes.
#[unsafe(no_mangle)]
pub extern "C" fn bg_live_length() -> usize {
    TEXT.with_borrow(Vec::len)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_answer_replaces_its_question() {
        assert!(!bg_live_answer().is_null() && bg_live_length() == 0);
        register(|question| format!("{} bytes", question.len()));
        assert!(!bg_live_reserve(12).is_null() && bg_live_length() == 12);
        assert!(!bg_live_answer().is_null());
        assert_eq!(TEXT.with_borrow(Clone::clone), b"12 bytes");
    }
}
