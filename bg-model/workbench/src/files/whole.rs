//! A file that is written whole or not at all.
//!
//! In: a path and what fills the file. Out: the file. The bytes go into a new file beside it, which takes its name at
//! the end, so a program that is killed leaves the file as it was. A power failure is not guarded against. What is no
//! regular file, such as a pipe or `/dev/full`, is written through.

use std::fs::{self, File, OpenOptions};
use std::io::{self, BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};

use tempfile::{Builder, NamedTempFile};

use super::FileError;
use super::console::{STANDARD, unless_closed};

/// Names of what the program has open already. What is behind them must not be replaced, be it a regular file.
const OPEN: [&str; 4] = ["/dev/stdout", "/dev/stderr", "/dev/fd", "/proc"];

/// Writes the file at `path` with what `fill` writes; [`STANDARD`] is standard output.
///
/// # Errors
/// [`FileError::Write`]; the file is then as it was before.
pub fn write(path: &Path, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> Result<(), FileError> {
    let outcome = target(path).and_then(|target| match target {
        Target::Standard => unless_closed(filled(io::stdout().lock(), fill).and_then(|mut file| file.flush())),
        Target::Through => {
            let file = OpenOptions::new().write(true).truncate(true).open(path)?;
            unless_closed(filled(file, fill).map(|_| ()))
        }
        Target::Aside(real) => {
            let mut file = filled(beside(&real)?, fill)?;
            if let Ok(present) = fs::metadata(&real) {
                file.as_file_mut().set_permissions(present.permissions())?;
            }
            file.persist(&real).map(|_| ()).map_err(|fault| fault.error)
        }
    });
    outcome.map_err(|fault| FileError::Write { path: path.to_owned(), source: without_path(fault) })
}

/// Finds out whether [`write()`] could write `path`, and changes nothing.
///
/// # Errors
/// [`FileError::Write`].
pub fn probe(path: &Path) -> Result<(), FileError> {
    let outcome = target(path).and_then(|target| match target {
        Target::Standard | Target::Through => Ok(()),
        Target::Aside(real) => {
            // A file that is marked as not to be written is not to be replaced either.
            if real.exists() {
                OpenOptions::new().write(true).open(&real)?;
            }
            beside(&real).map(|_| ())
        }
    });
    outcome.map_err(|fault| FileError::Write { path: path.to_owned(), source: without_path(fault) })
}

/// Fills `file` through a buffer.
pub(super) fn filled<W: Write>(file: W, fill: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<W> {
    let mut buffer = BufWriter::new(file);
    fill(&mut buffer)?;
    buffer.into_inner().map_err(io::IntoInnerError::into_error)
}

enum Target {
    /// Standard output, which is [`STANDARD`].
    Standard,
    /// What has no content to lose.
    Through,
    /// The regular file that is replaced, behind all symbolic links.
    Aside(PathBuf),
}

fn target(path: &Path) -> io::Result<Target> {
    if path.as_os_str() == STANDARD {
        return Ok(Target::Standard);
    }
    match fs::metadata(path) {
        Ok(present) if present.is_dir() => Err(ErrorKind::IsADirectory.into()),
        Ok(present) if !present.is_file() || OPEN.iter().any(|open| path.starts_with(open)) => Ok(Target::Through),
        Ok(_) => fs::canonicalize(path).map(Target::Aside),
        Err(fault) if fault.kind() == ErrorKind::NotFound => Ok(Target::Aside(path.to_owned())),
        Err(fault) => Err(fault),
    }
}

/// A new file in the folder of `path`, which goes away unless it is given a name.
pub(crate) fn beside(path: &Path) -> io::Result<NamedTempFile> {
    let name = path.file_name().ok_or(ErrorKind::InvalidInput)?;
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut prefix = std::ffi::OsString::from(".");
    prefix.push(name);
    let mut builder = Builder::new();
    builder.prefix(&prefix).suffix(".unfinished");
    // Like any new file: readable by all whom the user's mask lets.
    #[cfg(unix)]
    let mode = std::os::unix::fs::PermissionsExt::from_mode(0o666);
    #[cfg(unix)]
    builder.permissions(mode);
    builder.tempfile_in(folder)
}

/// A fault without the name of the file beside, which `tempfile` adds to its text and which says nothing to anybody.
fn without_path(fault: io::Error) -> io::Error {
    match fault.to_string().split_once(" at path ") {
        Some((cause, _)) => io::Error::new(fault.kind(), cause),
        None => fault,
    }
}

/// The bytes of a file that is read back, for [`RunFolder`](super::RunFolder)'s own small files.
pub(super) fn read(path: &Path) -> io::Result<Option<String>> {
    match File::open(path).and_then(io::read_to_string) {
        Ok(text) => Ok(Some(text)),
        Err(fault) if fault.kind() == ErrorKind::NotFound => Ok(None),
        Err(fault) => Err(fault),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(text: &str) -> impl FnOnce(&mut dyn Write) -> io::Result<()> {
        move |file| file.write_all(text.as_bytes())
    }

    #[test]
    fn a_failure_on_the_way_leaves_the_file_as_it_was() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        let cut = |file: &mut dyn Write| file.write_all(b"half").and(Err(ErrorKind::StorageFull.into()));
        assert!(write(&path, cut).is_err());
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);
        write(&path, text("before")).unwrap();
        assert!(write(&path, cut).unwrap_err().to_string().starts_with(&format!("cannot write {}: ", path.display())));
        assert_eq!(fs::read_to_string(&path).unwrap(), "before");
        write(&path, text("after")).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "after");
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 1);
    }

    #[test]
    fn probing_changes_nothing_and_finds_what_cannot_be_written() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        probe(&path).unwrap();
        assert!(!path.exists());
        fs::write(&path, "before").unwrap();
        probe(&path).unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "before");
        for bad in [folder.path().to_owned(), path.join("below"), folder.path().join("absent/file")] {
            for fault in [probe(&bad), write(&bad, text(""))].map(|outcome| outcome.unwrap_err().to_string()) {
                let start = format!("cannot write {}: ", bad.display());
                assert!(fault.starts_with(&start) && !fault.contains("unfinished"), "{fault}");
            }
        }
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_one_and_the_permissions_too() {
        use std::os::unix::fs::{PermissionsExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let (real, link) = (folder.path().join("real"), folder.path().join("link"));
        fs::write(&real, "before").unwrap();
        fs::set_permissions(&real, fs::Permissions::from_mode(0o640)).unwrap();
        symlink(&real, &link).unwrap();
        write(&link, text("after")).unwrap();
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::read_to_string(&real).unwrap(), "after");
        assert_eq!(fs::metadata(&real).unwrap().permissions().mode() & 0o777, 0o640);
        // A new file gets the permissions that any new file gets.
        let (ours, theirs) = (folder.path().join("ours"), folder.path().join("theirs"));
        write(&ours, text("")).unwrap();
        fs::write(&theirs, "").unwrap();
        assert_eq!(fs::metadata(ours).unwrap().permissions(), fs::metadata(theirs).unwrap().permissions());
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_device_is_written_through() {
        let device = Path::new("/dev/full");
        // Before anything is written: an administrator could replace a device.
        assert!(matches!(target(device), Ok(Target::Through)));
        let full = write(device, text("x")).unwrap_err().to_string();
        assert!(full.starts_with("cannot write /dev/full: No space left"), "{full}");
    }
}
