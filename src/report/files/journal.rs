//! What a commit does, written down before it begins: one that was killed halfway is completed
//! by the next run in the same folder.

use std::fs::{self, File};
use std::io;
use std::path::{Component, Path, PathBuf};

use serde::{Deserialize, Serialize};

use super::listing::digest;
use crate::input::{self, STORED_BYTES_MAX};

/// The name of a journal within its stage.
const JOURNAL: &str = "journal.json";

/// The folder of the staged files within a stage.
pub(super) const FILES: &str = "files";

/// A file that a commit removes or puts in place.
#[derive(Debug, Clone, Serialize, Deserialize)]
pub(super) struct Act {
    /// Relative to the folder of the output.
    pub path: PathBuf,
    /// Digest of what stands there before; none where nothing does, or where a link does that is
    /// to be replaced.
    pub before: Option<String>,
}

/// The acts of a commit, in order.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(super) struct Journal {
    /// Files of the earlier result that the new one does not have.
    pub remove: Vec<Act>,
    /// Folders that may be empty then, and are removed if so.
    pub prune: Vec<PathBuf>,
    /// Files to rename into place; summaries come after what they list.
    pub place: Vec<Act>,
}

impl Journal {
    /// Writes the journal into a stage. From here on the commit will be completed.
    pub fn write(&self, stage: &Path) -> io::Result<()> {
        let begun = stage.join("journal.part");
        fs::write(&begun, serde_json::to_vec(self)?)?;
        fs::rename(begun, stage.join(JOURNAL))
    }

    /// The journal of a stage; none if its commit never began, or if it is none of carom's: it
    /// names a place outside the folder, or is no regular file.
    pub fn read(stage: &Path) -> Option<Self> {
        let path = stage.join(JOURNAL);
        if !fs::symlink_metadata(&path).ok()?.is_file() {
            return None;
        }
        let bytes = input::bytes(&path, STORED_BYTES_MAX).ok()?;
        let journal: Self = serde_json::from_slice(&bytes).ok()?;
        let acts = journal.remove.iter().chain(&journal.place);
        let mut paths = acts.map(|act| &act.path).chain(&journal.prune);
        paths.all(|path| is_inside(path)).then_some(journal)
    }

    /// Does what the journal says.
    ///
    /// # Errors
    /// The file, and what the system said. [`complete`](Self::complete) does the rest.
    pub fn apply(&self, root: &Path, stage: &Path) -> Result<(), (PathBuf, io::Error)> {
        for act in &self.remove {
            let path = root.join(&act.path);
            absent_is_fine(fs::remove_file(&path)).map_err(|wrong| (path, wrong))?;
        }
        self.prune_empty(root);
        for act in &self.place {
            place(act, root, stage)?;
        }
        Ok(())
    }

    /// Does what is left of a journal after a kill. Files that somebody has changed or put there
    /// since stay, and nothing is done through a link.
    ///
    /// # Errors
    /// As [`apply`](Self::apply).
    pub fn complete(&self, root: &Path, stage: &Path) -> Result<(), (PathBuf, io::Error)> {
        for act in &self.remove {
            let path = root.join(&act.path);
            if is_as_before(root, act) == Some(true) && path.is_file() {
                absent_is_fine(fs::remove_file(&path)).map_err(|wrong| (path, wrong))?;
            }
        }
        self.prune_empty(root);
        for act in &self.place {
            let staged = stage.join(FILES).join(&act.path);
            let is_staged = fs::symlink_metadata(&staged).is_ok_and(|found| found.is_file());
            if is_staged && is_as_before(root, act) == Some(true) {
                place(act, root, stage)?;
            }
        }
        Ok(())
    }

    fn prune_empty(&self, root: &Path) {
        for relative in &self.prune {
            // A folder that holds a file of somebody else stays.
            let _ = fs::remove_dir(root.join(relative));
        }
    }
}

/// Whether a path leads to a place inside of the folder that it is relative to.
fn is_inside(path: &Path) -> bool {
    let mut parts = path.components();
    !path.as_os_str().is_empty() && parts.all(|part| matches!(part, Component::Normal(_)))
}

/// Whether what stands at the place of an act is what stood there when the journal was written;
/// none where a link leads there, or nothing can be said.
fn is_as_before(root: &Path, act: &Act) -> Option<bool> {
    let mut folder = root.to_owned();
    for part in act.path.parent()? {
        folder.push(part);
        if fs::symlink_metadata(&folder).is_ok_and(|found| !found.is_dir()) {
            return None;
        }
    }
    let path = root.join(&act.path);
    match (fs::symlink_metadata(&path), &act.before) {
        (Err(wrong), _) => (wrong.kind() == io::ErrorKind::NotFound).then_some(true),
        (Ok(found), Some(before)) if found.is_file() => {
            Some(*before == digest(File::open(&path).ok()?).ok()?)
        }
        (Ok(_), _) => Some(false),
    }
}

/// Renames a staged file into place.
fn place(act: &Act, root: &Path, stage: &Path) -> Result<(), (PathBuf, io::Error)> {
    let (from, to) = (stage.join(FILES).join(&act.path), root.join(&act.path));
    let placed = make_folders(root, act.path.parent()).and_then(|()| fs::rename(&from, &to));
    placed.map_err(|wrong| (to, wrong))
}

/// Makes the folders of a relative path that are not there; the root must be.
pub(super) fn make_folders(root: &Path, relative: Option<&Path>) -> io::Result<()> {
    let mut folder = root.to_owned();
    for part in relative.into_iter().flatten() {
        folder.push(part);
        match fs::create_dir(&folder) {
            Err(wrong) if wrong.kind() != io::ErrorKind::AlreadyExists => return Err(wrong),
            Ok(()) | Err(_) => {}
        }
    }
    Ok(())
}

fn absent_is_fine(done: io::Result<()>) -> io::Result<()> {
    match done {
        Err(wrong) if wrong.kind() == io::ErrorKind::NotFound => Ok(()),
        done => done,
    }
}
