//! Whether files have changed.

use std::path::PathBuf;
use std::time::SystemTime;

/// A file with its time and length; none of one that is not there.
type Stamp = (PathBuf, Option<(SystemTime, u64)>);

/// Files that are looked at again and again.
#[derive(Debug)]
pub struct Changes {
    /// Those that stay the same whatever the text uses.
    others: Vec<PathBuf>,
    /// At the last change that was told.
    known: Option<Vec<Stamp>>,
    /// At the last look, where that was different.
    seen: Option<Vec<Stamp>>,
}

impl Changes {
    /// Of these files, and of those that each look is told.
    pub fn of(others: Vec<PathBuf>) -> Self {
        Self { others, known: None, seen: None }
    }

    /// Whether the files have changed since that was asked last, and have been left alone since the last look: an
    /// editor may need several steps to save one. `files` are those that the text is made of. The first time there is a
    /// change.
    pub fn are_there(&mut self, files: impl Fn() -> Vec<PathBuf>) -> bool {
        let now = |files: &[PathBuf]| -> Vec<Stamp> { files.iter().map(|file| (file.clone(), stamp(file))).collect() };
        let known: Option<Vec<PathBuf>> =
            self.known.as_ref().map(|known| known.iter().map(|(file, _)| file.clone()).collect());
        if known.is_some_and(|files| Some(now(&files)) == self.known) {
            self.seen = None;
            return false;
        }
        let looked = now(&[files(), self.others.clone()].concat());
        let is_settled = self.known.is_none() || self.seen.as_ref() == Some(&looked);
        if is_settled {
            (self.known, self.seen) = (Some(looked), None);
        } else {
            self.seen = Some(looked);
        }
        is_settled
    }
}

fn stamp(file: &PathBuf) -> Option<(SystemTime, u64)> {
    let metadata = std::fs::metadata(file).ok()?;
    Some((metadata.modified().ok()?, metadata.len()))
}

#[cfg(test)]
mod tests {
    use std::fs::write;

    use super::*;

    #[test]
    fn a_change_is_told_when_it_has_settled() {
        let folder = tempfile::tempdir().expect("a folder");
        let (a, b) = (folder.path().join("a"), folder.path().join("b"));
        write(&a, "1").expect("a file");
        let mut changes = Changes::of(Vec::new());
        let files = || vec![a.clone(), b.clone()];
        assert!(changes.are_there(files), "the first time");
        assert!(!changes.are_there(files));
        write(&a, "12").expect("a file");
        assert!(!changes.are_there(files), "it may go on");
        write(&a, "123").expect("a file");
        assert!(!changes.are_there(files), "it went on");
        assert!(changes.are_there(files));
        assert!(!changes.are_there(files));
        // A file that comes, one that is replaced, one that goes.
        let steps: [&dyn Fn() -> std::io::Result<()>; 3] = [
            &|| write(&b, "1"),
            &|| write(folder.path().join("c"), "1234").and_then(|()| std::fs::rename(folder.path().join("c"), &a)),
            &|| std::fs::remove_file(&b),
        ];
        for change in steps {
            change().expect("a folder of its own");
            assert_eq!(
                [changes.are_there(files), changes.are_there(files), changes.are_there(files)],
                [false, true, false]
            );
        }
    }
}
