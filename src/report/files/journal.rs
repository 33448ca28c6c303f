//! What a commit does, written down before it begins: one that was killed halfway is completed
//! by the next run in the same folder.

use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};

use serde::{Deserialize, Serialize};

/// The name of a journal within its stage.
const JOURNAL: &str = "journal.json";

/// The folder of the staged files within a stage.
pub(super) const FILES: &str = "files";

/// The acts of a commit, in order. Paths are relative to the folder of the output.
#[derive(Debug, Default, Serialize, Deserialize)]
pub(super) struct Journal {
    /// Files of the earlier result that the new one does not have.
    pub remove: Vec<PathBuf>,
    /// Folders that may be empty then, and are removed if so.
    pub prune: Vec<PathBuf>,
    /// Files to rename into place; summaries come after what they list.
    pub place: Vec<PathBuf>,
}

impl Journal {
    /// Writes the journal into a stage. From here on the commit will be completed.
    pub fn write(&self, stage: &Path) -> io::Result<()> {
        let begun = stage.join("journal.part");
        fs::write(&begun, serde_json::to_vec(self)?)?;
        fs::rename(begun, stage.join(JOURNAL))
    }

    /// The journal of a stage; none if its commit never began, or if it names a place outside the
    /// folder, as no journal of carom does.
    pub fn read(stage: &Path) -> Option<Self> {
        let bytes = fs::read(stage.join(JOURNAL)).ok()?;
        let journal: Self = serde_json::from_slice(&bytes).ok()?;
        let is_inside = |path: &PathBuf| {
            let mut parts = path.components();
            parts.all(|part| matches!(part, Component::Normal(_)))
        };
        let all = [&journal.remove, &journal.prune, &journal.place];
        let inside = all.into_iter().flatten().all(is_inside);
        inside.then_some(journal)
    }

    /// Does what the journal says, or what is left of it.
    ///
    /// # Errors
    /// The file, and what the system said. The journal can be applied again.
    pub fn apply(&self, root: &Path, stage: &Path) -> Result<(), (PathBuf, io::Error)> {
        for relative in &self.remove {
            let path = root.join(relative);
            absent_is_fine(fs::remove_file(&path)).map_err(|wrong| (path, wrong))?;
        }
        for relative in &self.prune {
            // A folder that holds a file of somebody else stays.
            let _ = fs::remove_dir(root.join(relative));
        }
        for relative in &self.place {
            let (from, to) = (stage.join(FILES).join(relative), root.join(relative));
            let folder = to.parent().unwrap_or(root);
            let placed = fs::create_dir_all(folder).and_then(|()| fs::rename(&from, &to));
            match placed {
                Err(_) if !from.exists() && to.is_file() => {}
                placed => placed.map_err(|wrong| (to, wrong))?,
            }
        }
        Ok(())
    }
}

fn absent_is_fine(done: io::Result<()>) -> io::Result<()> {
    match done {
        Err(wrong) if wrong.kind() == io::ErrorKind::NotFound => Ok(()),
        done => done,
    }
}
