//! The commit that a folder's repository is at.
//!
//! In: a folder. Out: the commit that git's `HEAD` names, or nothing where there is no repository. Files that differ
//! from it are not looked for: who has to know has their CRC-32. The files are those of gitrepository-layout(5).

use std::fs;
use std::path::{Path, PathBuf};

/// The commit of the repository that has `folder`, in hexadecimal digits.
#[must_use]
pub fn commit_of(folder: &Path) -> Option<String> {
    let folder = folder.canonicalize().ok()?;
    let own = folder.ancestors().map(|folder| folder.join(".git")).find(|place| place.exists())?;
    let git = if own.is_file() { elsewhere(&own)? } else { own };
    let head = line(&git.join("HEAD"))?;
    let Some(reference) = head.strip_prefix("ref: ") else { return hexadecimal(&head) };
    // Branches of a second work tree are those of the first one.
    let common = line(&git.join("commondir")).map_or_else(|| git.clone(), |common| git.join(common));
    line(&git.join(reference))
        .or_else(|| line(&common.join(reference)))
        .or_else(|| packed(&common, reference))
        .and_then(|text| hexadecimal(&text))
}

/// Where a file `.git` says that its folder is.
fn elsewhere(file: &Path) -> Option<PathBuf> {
    let place = line(file)?.strip_prefix("gitdir: ")?.to_owned();
    Some(file.parent()?.join(place))
}

/// A reference that is packed with others.
fn packed(git: &Path, reference: &str) -> Option<String> {
    let all = fs::read_to_string(git.join("packed-refs")).ok()?;
    let found = all.lines().filter_map(|line| line.split_once(' ')).find(|(_, name)| *name == reference)?;
    Some(found.0.to_owned())
}

fn line(file: &Path) -> Option<String> {
    Some(fs::read_to_string(file).ok()?.lines().next()?.trim().to_owned())
}

fn hexadecimal(text: &str) -> Option<String> {
    let is_it = text.len() >= 40 && text.chars().all(|digit| digit.is_ascii_hexdigit());
    is_it.then(|| text.to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_commit_is_found_however_it_is_written() {
        let root = tempfile::tempdir().unwrap();
        let [commit, other] = ["0123456789abcdef0123456789abcdef01234567", "f".repeat(40).as_str()].map(str::to_owned);
        let git = root.path().join(".git");
        let below = root.path().join("models/shafts");
        fs::create_dir_all(git.join("refs/heads")).unwrap();
        fs::create_dir_all(&below).unwrap();
        let write = |name: &str, text: &str| fs::write(git.join(name), text).unwrap();
        assert_eq!(commit_of(&below), None);
        write("HEAD", "ref: refs/heads/main\n");
        write("packed-refs", &format!("# pack-refs with: peeled\n{other} refs/heads/main\n"));
        assert_eq!(commit_of(&below), Some(other.clone()));
        write("refs/heads/main", &format!("{commit}\n"));
        assert_eq!(commit_of(&below), Some(commit.clone()));
        write("HEAD", &format!("{other}\n"));
        assert_eq!(commit_of(&below), Some(other));
        // A second work tree.
        let tree = tempfile::tempdir().unwrap();
        fs::create_dir_all(git.join("worktrees/tree")).unwrap();
        write("worktrees/tree/HEAD", "ref: refs/heads/main\n");
        write("worktrees/tree/commondir", "../..\n");
        fs::write(tree.path().join(".git"), format!("gitdir: {}\n", git.join("worktrees/tree").display())).unwrap();
        assert_eq!(commit_of(tree.path()), Some(commit));
        write("HEAD", "ref: refs/heads/none\n");
        assert_eq!(commit_of(&below), None);
    }
}
