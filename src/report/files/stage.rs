//! The hidden folder in which a result is staged; it goes with its run, however that ends.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use super::journal::{FILES, Journal, make_folders};
use crate::error::{Error, Result};

/// What the names of stages begin with.
const PREFIX: &str = ".carom-stage-";

/// A file in every stage, by which it is told from a folder of somebody else; and what it says.
const MARK: (&str, &str) = (
    "about.txt",
    "A result of carom in the making. The next run into the folder around it removes this one.\n",
);

/// The stages there are, each with the folders that were made for it, the deepest first.
static STAGES: Mutex<BTreeMap<PathBuf, Vec<PathBuf>>> = Mutex::new(BTreeMap::new());

/// The stages, which nobody begins, writes into or commits meanwhile.
pub(super) fn stages() -> MutexGuard<'static, BTreeMap<PathBuf, Vec<PathBuf>>> {
    STAGES.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes every stage, after a commit that has begun, and lets none be begun or committed from
/// here on: the last act before the program ends on Ctrl-C.
pub fn remove_unfinished() {
    let stages = stages();
    for (stage, made) in stages.iter() {
        remove(stage, made);
    }
    std::mem::forget(stages);
}

/// Removes a stage, and the folders made for it if nothing else stands in them.
fn remove(stage: &Path, made: &[PathBuf]) {
    // Another thread may just write a file there; the second time it cannot.
    if fs::remove_dir_all(stage).is_err() {
        let _ = fs::remove_dir_all(stage);
    }
    for folder in made {
        if fs::remove_dir(folder).is_err() {
            break;
        }
    }
}

/// A stage in a folder, which is removed when it is dropped.
#[derive(Debug)]
pub(super) struct Stage {
    path: PathBuf,
}

impl Stage {
    /// Makes a stage in a folder that was made for it up to these folders, and completes or
    /// removes stages that a killed run left there. The folder must be locked.
    pub fn begin(root: &Path, made: Vec<PathBuf>) -> Result<Self> {
        complete_earlier(root)?;
        let mut stages = stages();
        let unwritable = |source| Error::write(root, source);
        let path = begin_in(root).map_err(unwritable)?;
        stages.insert(path.clone(), made);
        drop(stages);
        let stage = Self { path };
        let (name, text) = MARK;
        fs::write(stage.path.join(name), text).map_err(unwritable)?;
        fs::create_dir(stage.path.join(FILES)).map_err(unwritable)?;
        Ok(stage)
    }

    /// Where the stage is.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Where a staged file stands.
    pub fn place(&self, relative: &Path) -> PathBuf {
        self.path.join(FILES).join(relative)
    }

    /// Begins a file.
    pub fn create(&self, relative: &Path) -> io::Result<File> {
        let _stages = stages();
        make_folders(&self.path.join(FILES), relative.parent())?;
        File::create(self.place(relative))
    }

    /// Leaves the stage for the next run to complete.
    pub fn leave(self) {
        stages().remove(&self.path);
        std::mem::forget(self);
    }
}

impl Drop for Stage {
    fn drop(&mut self) {
        let mut stages = stages();
        let made = stages.remove(&self.path).unwrap_or_default();
        remove(&self.path, &made);
    }
}

/// An empty folder of a name of its own, with the permissions that any new folder would have.
fn begin_in(root: &Path) -> io::Result<PathBuf> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o777));
    }
    Ok(builder.tempdir_in(root)?.keep())
}

/// Completes what a killed run had begun to commit, and removes what it had not.
pub(super) fn complete_earlier(root: &Path) -> Result<()> {
    let unreadable = |source| Error::read(root, source);
    for entry in fs::read_dir(root).map_err(unreadable)? {
        let entry = entry.map_err(unreadable)?;
        let is_stage = entry.file_name().to_string_lossy().starts_with(PREFIX);
        if !is_stage || !entry.file_type().map_err(unreadable)?.is_dir() {
            continue;
        }
        let stage = entry.path();
        let (name, text) = MARK;
        let marked = fs::symlink_metadata(stage.join(name)).is_ok_and(|found| found.is_file());
        if !marked
            || fs::metadata(stage.join(name)).is_ok_and(|found| found.len() != text.len() as u64)
        {
            // Empty, if the kill came before the mark; else of somebody else.
            let _ = fs::remove_dir(&stage);
            continue;
        }
        let is_folder = fs::symlink_metadata(stage.join(FILES)).is_ok_and(|found| found.is_dir());
        if let Some(journal) = Journal::read(&stage).filter(|_| is_folder) {
            let done = journal.complete(root, &stage);
            done.map_err(|(path, source)| Error::Commit {
                path,
                stage: stage.clone(),
                source,
            })?;
        }
        remove(&stage, &[]);
    }
    Ok(())
}
