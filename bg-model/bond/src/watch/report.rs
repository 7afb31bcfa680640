//! A report, made by a process of its own.

use std::ffi::OsString;
use std::fs::File;
use std::path::Path;
use std::process::{Child, Command, Stdio};

use tempfile::TempDir;

/// A report that is being made. It is ended where this is dropped.
pub struct Making {
    child: Child,
    folder: TempDir,
}

/// How it ended.
pub enum Ended {
    /// The page.
    Made(String),
    /// What was said of what is wrong.
    Failed(String),
}

/// What the process says on its error output.
const SAID: &str = "said";
/// The folder of the report.
const OUT: &str = "out";

impl Making {
    /// Begins the report of a file with these options, for a frame of the page; the picture of the graph is kept in
    /// `picture`.
    ///
    /// # Errors
    /// No process can be started, or no file be written: a sentence.
    pub fn begin(file: &Path, options: &[OsString], picture: &Path) -> Result<Self, String> {
        let begun = || {
            let folder = TempDir::new()?;
            let said = File::create(folder.path().join(SAID))?;
            let mut command = Command::new(std::env::current_exe()?);
            command.arg("report").arg(file).args(options).arg("--out").arg(folder.path().join(OUT));
            command.arg("--frame").arg(picture);
            let child = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(said).spawn()?;
            Ok(Self { child, folder })
        };
        begun().map_err(|fault: std::io::Error| format!("error: no report can be made: {fault}\n"))
    }

    /// How it ended; none while it goes on.
    pub fn ended(&mut self) -> Option<Ended> {
        let status = match self.child.try_wait() {
            Ok(status) => status?,
            Err(fault) => return Some(Ended::Failed(format!("error: the report was lost: {fault}\n"))),
        };
        let said = std::fs::read_to_string(self.folder.path().join(SAID)).unwrap_or_default();
        Some(match self.page() {
            Some(page) if status.success() => Ended::Made(page),
            _ if said.trim().is_empty() => Ended::Failed(format!("error: the report ended with {status}\n")),
            _ => Ended::Failed(said),
        })
    }

    fn page(&self) -> Option<String> {
        let mut files = std::fs::read_dir(self.folder.path().join(OUT)).ok()?.flatten();
        let page = files.find(|file| file.path().extension().is_some_and(|end| end == "html"))?;
        std::fs::read_to_string(page.path()).ok()
    }
}

impl Drop for Making {
    fn drop(&mut self) {
        // It may have ended by itself.
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
