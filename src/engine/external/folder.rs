//! The temporary folder of a run, and those that runs left behind which were killed.

use std::fs::{self, File, TryLockError};
use std::path::{Path, PathBuf};
use std::sync::Once;
use std::time::Duration;
use std::{io, thread};

/// What the names of the folders begin with.
const PREFIX: &str = "carom-solver-";

/// A file in a folder that its owner keeps locked: the system gives the lock back when the owner
/// ends, whatever ends it.
const LOCK: &str = ".lock";

/// A folder that belongs to a run.
#[derive(Debug)]
pub(super) struct Folder {
    path: PathBuf,
    /// Held, not read.
    lock: Option<File>,
}

impl Folder {
    /// A new, empty one. The first of a process removes those that were left behind.
    pub fn open() -> io::Result<Self> {
        static SWEPT: Once = Once::new();
        SWEPT.call_once(|| sweep(&std::env::temp_dir()));
        Self::within(&std::env::temp_dir())
    }

    fn within(parent: &Path) -> io::Result<Self> {
        let folder = tempfile::Builder::new().prefix(PREFIX).tempdir_in(parent)?;
        // Locked before it has its name: a folder with a lock that nobody holds is left behind,
        // one without a lock may be about to get it.
        let unnamed = folder.path().join(".unlocked");
        let lock = File::create_new(&unnamed)?;
        if lock.try_lock().is_ok() {
            fs::rename(&unnamed, folder.path().join(LOCK))?;
        } else {
            // Where files cannot be locked nothing can tell whose a folder is.
            fs::remove_file(&unnamed)?;
        }
        Ok(Self {
            path: folder.keep(),
            lock: Some(lock),
        })
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // Not every system removes a file that is open.
        self.lock = None;
        remove(&self.path);
    }
}

/// Removes a folder. One who was killed may still be on the way out and write a last file.
pub(super) fn remove(folder: &Path) {
    for _ in 0..20 {
        match fs::remove_dir_all(folder) {
            Ok(()) => return,
            Err(wrong) if wrong.kind() == io::ErrorKind::NotFound => return,
            Err(_) => thread::sleep(Duration::from_millis(5)),
        }
    }
}

/// Removes the folders of this user whose owners have ended. What cannot be looked at is left.
fn sweep(parent: &Path) {
    let Ok(entries) = fs::read_dir(parent) else {
        return;
    };
    for entry in entries.flatten() {
        let is_named = entry.file_name().to_string_lossy().starts_with(PREFIX);
        if is_named && is_own_folder(&entry.path()) {
            remove_if_left(&entry.path());
        }
    }
}

fn remove_if_left(folder: &Path) {
    let path = folder.join(LOCK);
    if !fs::symlink_metadata(&path).is_ok_and(|found| found.is_file() && found.len() == 0) {
        // Somebody else's: carom's own is an empty file.
        return;
    }
    let Ok(lock) = File::options().read(true).write(true).open(path) else {
        return;
    };
    match lock.try_lock() {
        // The lock is held until the folder is gone, so that another sweep leaves it alone; where
        // an open file cannot be removed, it is given back first.
        Ok(()) if cfg!(unix) => remove(folder),
        Ok(()) => {
            drop(lock);
            remove(folder);
        }
        Err(TryLockError::WouldBlock | TryLockError::Error(_)) => {}
    }
}

/// Whether it is a folder, no link to one, of the user who runs this.
#[cfg(unix)]
fn is_own_folder(path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let own = rustix::process::geteuid().as_raw();
    fs::symlink_metadata(path).is_ok_and(|found| found.is_dir() && found.uid() == own)
}

/// Whether it is a folder, no link to one; each user has temporary folders of his own.
#[cfg(not(unix))]
fn is_own_folder(path: &Path) -> bool {
    fs::symlink_metadata(path).is_ok_and(|found| found.is_dir())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As the system does when a process is killed: the lock goes, the folder stays.
    fn abandon(mut folder: Folder) -> PathBuf {
        folder.lock = None;
        let path = folder.path.clone();
        std::mem::forget(folder);
        path
    }

    #[test]
    fn only_folders_whose_owner_is_gone_are_swept() {
        let parent = tempfile::tempdir().unwrap();
        let held = Folder::within(parent.path()).unwrap();
        let left = abandon(Folder::within(parent.path()).unwrap());
        fs::write(left.join("bodies.csv"), "x").unwrap();
        let foreign = parent.path().join("carom-solver-notes");
        fs::create_dir(&foreign).unwrap();
        let other = parent.path().join("other");
        fs::create_dir(&other).unwrap();
        fs::write(other.join(LOCK), "").unwrap();
        sweep(parent.path());
        assert!(!left.exists());
        assert!(held.path().exists() && foreign.exists() && other.exists());
        let path = held.path().to_owned();
        drop(held);
        assert!(!path.exists());
    }

    /// A link is not followed: what it leads to is not the run's.
    #[cfg(unix)]
    #[test]
    fn a_link_with_the_name_of_a_folder_is_left() {
        let parent = tempfile::tempdir().unwrap();
        let target = parent.path().join("mine");
        fs::create_dir(&target).unwrap();
        fs::write(target.join(LOCK), "").unwrap();
        std::os::unix::fs::symlink(&target, parent.path().join("carom-solver-link")).unwrap();
        sweep(parent.path());
        assert!(target.join(LOCK).exists());
    }
}
