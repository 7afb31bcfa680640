//! An example, as its head comment tells of it.
//!
//! In: the source text of `examples/NAME.rs`. Out: what it is, what to look at, and the arguments to try.

use std::path::Path;

/// An example of the gallery.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Example {
    /// Its name, which is the file's.
    pub name: String,
    /// What it is: the first line, without the full stop.
    pub title: String,
    /// What to look at.
    pub text: String,
    /// The output that is drawn: the first name in the text that stands in backticks.
    pub output: String,
    /// What to try, after `--`.
    pub arguments: Vec<String>,
}

impl Example {
    /// The example that this source text is; `None` where its head comment lacks something.
    pub fn parse(name: &str, source: &str) -> Option<Self> {
        let head: Vec<&str> = source.lines().map_while(|line| line.strip_prefix("//!")).collect();
        let title = head.first()?.trim().trim_end_matches('.').to_owned();
        let command = format!("     cargo run --release --example {name} -- ");
        let arguments = head.iter().find_map(|line| line.strip_prefix(&command))?;
        let text: Vec<&str> = head[1..]
            .iter()
            .filter(|line| !line.starts_with("     "))
            .flat_map(|line| line.split_whitespace())
            .collect();
        let text = text.join(" ");
        let output = text.split('`').nth(1)?.to_owned();
        let arguments = arguments.split_whitespace().map(str::to_owned).collect();
        Some(Self { name: name.to_owned(), title, text, output, arguments })
    }

    /// All examples of a folder, by name; the error is the file that cannot be read.
    pub fn all(folder: &Path) -> Result<Vec<Self>, String> {
        let failed = |path: &Path, fault: &dyn std::fmt::Display| format!("{}: {fault}", path.display());
        let mut examples = Vec::new();
        for file in std::fs::read_dir(folder).map_err(|fault| failed(folder, &fault))? {
            let path = file.map_err(|fault| failed(folder, &fault))?.path();
            let Some(name) = path.extension().filter(|&end| end == "rs").and_then(|_| path.file_stem()) else {
                continue;
            };
            let source = std::fs::read_to_string(&path).map_err(|fault| failed(&path, &fault))?;
            let example = Self::parse(&name.to_string_lossy(), &source);
            examples.push(example.ok_or_else(|| failed(&path, &"its head comment has no title, output or command"))?);
        }
        examples.sort_unstable_by(|a, b| a.name.cmp(&b.name));
        Ok(examples)
    }

    /// The command of the head comment.
    pub fn command(&self) -> String {
        format!("cargo run --release --example {} -- {}", self.name, self.arguments.join(" "))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_head_comment_says_everything() {
        let source = "//! A block on a slide.\n//!\n//! Look at `v`\n//! and at `x`.\n//!\n//!     cargo run --release \
                      --example block -- --t-end 3\n\nuse x;\n//! no head\n";
        let example = Example::parse("block", source).unwrap();
        assert_eq!((example.title.as_str(), example.output.as_str()), ("A block on a slide", "v"));
        assert_eq!(example.text, "Look at `v` and at `x`.");
        assert_eq!(example.command(), "cargo run --release --example block -- --t-end 3");
        assert_eq!(Example::parse("other", source), None, "no command");
    }
}
