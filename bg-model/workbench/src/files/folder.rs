//! A folder of results that is one run's or none's.
//!
//! In: a folder and the names of the files that a run will write. Out: the folder with these files, without those of
//! the run before it, and with everything else that was there.
//!
//! A subfolder `.run` holds what this takes: `lock`, which a run keeps locked while it lasts; `unfinished`, where its
//! files grow; `files`, the names of those that it has put into the folder. Only when all files are written are those
//! of the earlier run removed and the new ones renamed into place, in this order. A program that is killed before
//! leaves the earlier run's files, one that is killed then leaves a part of one run's, and a file is never cut. Only
//! names on the list are removed; the list is there before the first of the files. Where no run has put anything into
//! the folder its subfolder goes with the run, and so does the folder if the run has made it.

use std::collections::BTreeSet;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use super::FileError;
use super::whole::{filled, read};

const OWN: &str = ".run";
const LOCK: &str = "lock";
const LIST: &str = "files";
const NEW_LIST: &str = "files.new";
const STAGE: &str = "unfinished";
/// The head of the list, for whoever looks at it.
const HEAD: &str = "# Files of the run in this folder. The next run into it replaces them and leaves all others.\n";

/// A folder that this run has claimed.
#[derive(Debug)]
pub struct RunFolder {
    folder: PathBuf,
    /// What the run before wrote, as far as it is there.
    earlier: BTreeSet<String>,
    /// What this run has written, in order.
    staged: Vec<String>,
    /// Whether the folder was not there before.
    is_new: bool,
    /// Locked until it is closed.
    _lock: File,
}

/// Whether `folder` can be one: neither it nor one above it is a file.
///
/// # Errors
/// [`FileError::NotAFolder`].
pub(crate) fn check_is_no_file(folder: &Path) -> Result<(), FileError> {
    let file = folder.ancestors().find(|path| fs::metadata(path).is_ok_and(|present| !present.is_dir()));
    let fault = |file: &Path| FileError::NotAFolder { folder: folder.to_owned(), file: file.to_owned() };
    file.map_or(Ok(()), |file| Err(fault(file)))
}

impl RunFolder {
    /// Claims `folder`, which is made if it is not there, for a run that will write files called `names`. What is in it
    /// stays as it is.
    ///
    /// # Errors
    /// The folder cannot be written, another run has claimed it, or it has a file of one of these names that no earlier
    /// run wrote.
    ///
    /// # Panics
    /// A name is no plain file name, or begins with a dot.
    pub fn claim(folder: &Path, names: &[String]) -> Result<Self, FileError> {
        assert!(names.iter().all(|name| is_plain(name)), "plain file names: {names:?}");
        check_is_no_file(folder)?;
        // Before anything is made, so that a folder of other things gets no trace of a run that was refused.
        check_foreign(folder, &listed(folder)?, names)?;
        let is_new = !folder.exists();
        let own = folder.join(OWN);
        let lock = locked(folder, &own)?;
        // Now that no other run can change it.
        let earlier = listed(folder)?;
        check_foreign(folder, &earlier, names)?;
        let stage = own.join(STAGE);
        remove_stage(&stage).and_then(|()| fs::create_dir(&stage)).map_err(failed(&stage))?;
        Ok(Self { folder: folder.to_owned(), earlier, staged: Vec::new(), is_new, _lock: lock })
    }

    /// Writes the file called `name` with what `fill` writes, or writes it anew. It is in the folder from
    /// [`RunFolder::publish`] on.
    ///
    /// # Errors
    /// [`FileError::Write`].
    ///
    /// # Panics
    /// As [`RunFolder::claim`].
    pub fn write(&mut self, name: &str, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), FileError> {
        assert!(is_plain(name), "a plain file name: {name:?}");
        let file = File::create(self.stage().join(name)).and_then(|file| filled(file, fill));
        file.map_err(failed(&self.folder.join(name)))?;
        if !self.staged.iter().any(|staged| staged == name) {
            self.staged.push(name.to_owned());
        }
        Ok(())
    }

    /// Writes a file with this text, as [`RunFolder::write`] does.
    ///
    /// # Errors
    /// As [`RunFolder::write`].
    pub fn write_text(&mut self, name: &str, text: &str) -> Result<(), FileError> {
        self.write(name, |file| file.write_all(text.as_bytes()))
    }

    /// Puts the files that were written in the place of the earlier run's, and gives their paths. The last one to be
    /// written is the last one to appear.
    ///
    /// # Errors
    /// A file that cannot be removed or put into its place, or one of a name written here that has come from elsewhere
    /// meanwhile.
    pub fn publish(self) -> Result<Vec<PathBuf>, FileError> {
        check_foreign(&self.folder, &self.earlier, &self.staged)?;
        let new: BTreeSet<String> = self.staged.iter().cloned().collect();
        self.list(&self.earlier.union(&new).cloned().collect())?;
        for name in &self.earlier {
            let path = self.folder.join(name);
            unless_absent(fs::remove_file(&path)).map_err(failed(&path))?;
        }
        let place = |name: &String| {
            let path = self.folder.join(name);
            fs::rename(self.stage().join(name), &path).map_err(failed(&path))?;
            Ok(path)
        };
        let paths = self.staged.iter().map(place).collect::<Result<_, _>>()?;
        self.list(&new)?;
        Ok(paths)
    }

    fn stage(&self) -> PathBuf {
        self.folder.join(OWN).join(STAGE)
    }

    /// Replaces the list of the files in the folder that are a run's.
    fn list(&self, names: &BTreeSet<String>) -> Result<(), FileError> {
        let [new, list] = [NEW_LIST, LIST].map(|name| self.folder.join(OWN).join(name));
        let lines: String = names.iter().map(|name| format!("{name}\n")).collect();
        fs::write(&new, HEAD.to_owned() + &lines).and_then(|()| fs::rename(&new, &list)).map_err(failed(&list))
    }
}

impl Drop for RunFolder {
    fn drop(&mut self) {
        // What cannot be removed here is removed by the next run.
        let _ = remove_stage(&self.stage());
        let own = self.folder.join(OWN);
        if CAN_TELL && !own.join(LIST).exists() {
            // While it is locked, so that none is removed that another run has locked.
            let _ = fs::remove_file(own.join(LOCK)).and_then(|()| fs::remove_dir(&own));
            if self.is_new {
                let _ = fs::remove_dir(&self.folder);
            }
        }
    }
}

/// The lock of a folder whose subfolder is `own`; both are made if they are not there.
fn locked(folder: &Path, own: &Path) -> Result<File, FileError> {
    let path = own.join(LOCK);
    loop {
        fs::create_dir_all(own).map_err(failed(folder))?;
        let lock = match OpenOptions::new().create(true).truncate(false).write(true).open(&path) {
            Err(fault) if CAN_TELL && fault.kind() == io::ErrorKind::NotFound => continue,
            lock => lock.map_err(failed(&path))?,
        };
        match lock.try_lock() {
            // A run that has ended meanwhile may have removed the file.
            Ok(()) if is_at(&lock, &path) => return Ok(lock),
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(FileError::Busy(folder.to_owned())),
            Err(TryLockError::Error(source)) => return Err(FileError::Lock { path, source }),
        }
    }
}

/// Whether the system says which file is at a path.
const CAN_TELL: bool = cfg!(unix);

/// Whether the open `file` is the one at `path`.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let identity = |present: fs::Metadata| (present.dev(), present.ino());
    let (open, there) = (file.metadata().map(identity), fs::metadata(path).map(identity));
    matches!((open, there), (Ok(open), Ok(there)) if open == there)
}

#[cfg(not(unix))]
fn is_at(_: &File, _: &Path) -> bool {
    true
}

fn failed(path: &Path) -> impl Fn(io::Error) -> FileError {
    move |source| FileError::Write { path: path.to_owned(), source }
}

/// Whether `name` is a file directly in the folder, and none of [`OWN`].
fn is_plain(name: &str) -> bool {
    !name.is_empty() && !name.starts_with('.') && !name.contains(|c: char| c.is_control() || "/\\:".contains(c))
}

/// The files in `folder` that an earlier run wrote.
fn listed(folder: &Path) -> Result<BTreeSet<String>, FileError> {
    let path = folder.join(OWN).join(LIST);
    let text = read(&path).map_err(failed(&path))?.unwrap_or_default();
    // A name that leads elsewhere is none that a run wrote.
    let names = text.lines().filter(|line| !line.starts_with('#') && is_plain(line));
    Ok(names.filter(|name| is_file(&folder.join(name))).map(str::to_owned).collect())
}

/// Whether there is something that [`fs::remove_file`] would remove.
fn is_file(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|present| !present.is_dir())
}

fn check_foreign(folder: &Path, earlier: &BTreeSet<String>, names: &[String]) -> Result<(), FileError> {
    let paths = names.iter().filter(|name| !earlier.contains(*name)).map(|name| folder.join(name));
    let foreign = paths.into_iter().find(|path| fs::symlink_metadata(path).is_ok());
    foreign.map_or(Ok(()), |path| Err(FileError::Foreign(path)))
}

fn remove_stage(stage: &Path) -> io::Result<()> {
    unless_absent(fs::remove_dir_all(stage))
}

/// `outcome` of a removal, where what is gone already is no fault.
fn unless_absent(outcome: io::Result<()>) -> io::Result<()> {
    match outcome {
        Err(fault) if fault.kind() == io::ErrorKind::NotFound => Ok(()),
        outcome => outcome,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(names: &[&str]) -> Vec<String> {
        names.iter().map(|&name| name.to_owned()).collect()
    }

    /// A run that writes files with these names; each has its own name as text.
    fn run(folder: &Path, files: &[&str]) -> Result<Vec<PathBuf>, FileError> {
        let mut claimed = RunFolder::claim(folder, &names(files))?;
        for name in files {
            claimed.write_text(name, name)?;
        }
        claimed.publish()
    }

    /// What is in the folder, hidden names left out.
    fn visible(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<String> = entries.filter(|name| !name.starts_with('.')).collect();
        names.sort();
        names
    }

    #[test]
    fn a_run_replaces_the_one_before_and_leaves_what_is_not_of_a_run() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path();
        fs::create_dir(path.join("older")).unwrap();
        assert_eq!(run(path, &["a", "b"]).unwrap(), [path.join("a"), path.join("b")]);
        fs::write(path.join("notes"), "mine").unwrap();
        run(path, &["b", "c"]).unwrap();
        assert_eq!(visible(path), ["b", "c", "notes", "older"]);
        assert_eq!(fs::read_to_string(path.join("notes")).unwrap(), "mine");
        assert!(!path.join(OWN).join(STAGE).exists());
    }

    #[test]
    fn until_a_run_publishes_the_earlier_one_is_there() {
        let folder = tempfile::tempdir().unwrap();
        run(folder.path(), &["a", "b"]).unwrap();
        let mut claimed = RunFolder::claim(folder.path(), &names(&["a"])).unwrap();
        claimed.write_text("a", "new").unwrap();
        assert_eq!(visible(folder.path()), ["a", "b"]);
        assert_eq!(fs::read_to_string(folder.path().join("a")).unwrap(), "a");
        drop(claimed);
        assert_eq!(fs::read_to_string(folder.path().join("a")).unwrap(), "a");
        assert!(!folder.path().join(OWN).join(STAGE).exists());
    }

    #[test]
    fn what_no_run_wrote_is_neither_replaced_nor_touched() {
        let folder = tempfile::tempdir().unwrap();
        let mine = folder.path().join("a");
        fs::write(&mine, "mine").unwrap();
        let fault = run(folder.path(), &["a"]).unwrap_err().to_string();
        assert!(fault.starts_with(&format!("{} is no file of an earlier run", mine.display())), "{fault}");
        assert!(!folder.path().join(OWN).exists());
        // Also where it comes while the run lasts.
        run(folder.path(), &["b"]).unwrap();
        let mut claimed = RunFolder::claim(folder.path(), &names(&["b", "c"])).unwrap();
        claimed.write_text("c", "new").unwrap();
        fs::write(folder.path().join("c"), "mine").unwrap();
        assert!(matches!(claimed.publish(), Err(FileError::Foreign(_))));
        assert_eq!(fs::read_to_string(folder.path().join("c")).unwrap(), "mine");
        assert_eq!(visible(folder.path()), ["a", "b", "c"]);
    }

    #[cfg(unix)]
    #[test]
    fn a_run_that_puts_nothing_into_the_folder_leaves_nothing_of_its_own() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path();
        fs::write(path.join("notes"), "mine").unwrap();
        drop(RunFolder::claim(path, &names(&["a"])).unwrap());
        assert!(!path.join(OWN).exists() && path.join("notes").exists());
        let new = path.join("new");
        let mut claimed = RunFolder::claim(&new, &names(&["a"])).unwrap();
        claimed.write_text("a", "a").unwrap();
        drop(claimed);
        assert!(!new.exists());
        // One that others have put something into stays what it was.
        run(path, &["a"]).unwrap();
        drop(RunFolder::claim(path, &names(&["b"])).unwrap());
        assert!(path.join(OWN).join(LIST).exists());
        run(path, &["b"]).unwrap();
        assert_eq!(visible(path), ["b", "notes"]);
    }

    #[test]
    fn a_second_run_at_once_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let first = RunFolder::claim(folder.path(), &[]).unwrap();
        let fault = RunFolder::claim(folder.path(), &[]).unwrap_err().to_string();
        assert!(fault.starts_with("another run is writing into "), "{fault}");
        drop(first);
        RunFolder::claim(folder.path(), &[]).unwrap();
    }

    #[test]
    fn a_file_that_cannot_be_written_leaves_the_earlier_run() {
        let folder = tempfile::tempdir().unwrap();
        run(folder.path(), &["a"]).unwrap();
        let mut claimed = RunFolder::claim(folder.path(), &names(&["a"])).unwrap();
        let cut = |file: &mut dyn Write| file.write_all(b"half").and(Err(io::ErrorKind::StorageFull.into()));
        let fault = claimed.write("a", cut).unwrap_err().to_string();
        assert!(fault.starts_with(&format!("cannot write {}: ", folder.path().join("a").display())), "{fault}");
        drop(claimed);
        assert_eq!(fs::read_to_string(folder.path().join("a")).unwrap(), "a");
    }

    #[test]
    fn what_a_run_had_placed_when_it_ended_on_the_way_is_cleared_by_the_next() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path();
        run(path, &["a", "b"]).unwrap();
        let mut claimed = RunFolder::claim(path, &names(&["c", "d"])).unwrap();
        claimed.write_text("c", "c").unwrap();
        claimed.write_text("d", "d").unwrap();
        // As much of it is done as if it were killed after the first of the new files.
        fs::remove_file(claimed.stage().join("d")).unwrap();
        assert!(claimed.publish().is_err());
        assert_eq!(visible(path), ["c"]);
        run(path, &["e"]).unwrap();
        assert_eq!(visible(path), ["e"]);
    }

    #[test]
    fn a_name_that_is_free_again_is_the_user_s() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path();
        run(path, &["a", "b"]).unwrap();
        run(path, &["b"]).unwrap();
        fs::write(path.join("a"), "mine").unwrap();
        run(path, &["b"]).unwrap();
        assert_eq!(fs::read_to_string(path.join("a")).unwrap(), "mine");
        assert!(matches!(run(path, &["a"]), Err(FileError::Foreign(_))));
    }

    #[test]
    fn a_list_that_was_tampered_with_leads_nowhere_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out");
        run(&path, &["a"]).unwrap();
        let outside = folder.path().join("outside");
        fs::write(&outside, "").unwrap();
        fs::create_dir(path.join("below")).unwrap();
        let list = format!("../outside\n{}\nbelow\n.run\nabsent\n\na\n", outside.display());
        fs::write(path.join(OWN).join(LIST), list).unwrap();
        run(&path, &["b"]).unwrap();
        assert!(outside.exists());
        assert_eq!(visible(&path), ["b", "below"]);
    }

    #[test]
    fn a_file_in_place_of_the_folder_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        fs::write(&file, "").unwrap();
        for path in [file.clone(), file.join("below"), file.join("below/more")] {
            let fault = run(&path, &["a"]).unwrap_err().to_string();
            let told = format!("cannot write into {}: {} is a file", path.display(), file.display());
            assert!(fault.starts_with(&told), "{fault}");
        }
    }
}
