//! The manager of files: each appears whole or not at all.

use std::collections::BTreeSet;
use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::NamedTempFile;

use crate::error::{Error, Result};

/// Files in the making, of all folders.
static UNFINISHED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn unfinished() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes every file in the making, and lets none be finished or begun from here on: the last
/// act before the program ends on Ctrl-C.
pub fn remove_unfinished() {
    let files = unfinished();
    for file in files.iter() {
        // Best effort: there is nobody left to tell.
        let _ = fs::remove_file(file);
    }
    std::mem::forget(files);
}

/// A folder that carom writes into.
#[derive(Debug, Clone)]
pub struct Folder {
    path: PathBuf,
}

impl Folder {
    /// Makes the folder, and finds out before the long run whether files can be written there.
    ///
    /// # Errors
    /// [`Error::Write`] with the folder.
    pub fn open(path: &Path) -> Result<Self> {
        fs::create_dir_all(path).map_err(|source| Error::write(path, source))?;
        tempfile::tempfile_in(path).map_err(|source| Error::write(path, source))?;
        Ok(Self {
            path: path.to_owned(),
        })
    }

    /// Where the folder is.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// A folder within.
    ///
    /// # Errors
    /// As [`open`](Self::open).
    pub fn folder(&self, name: &str) -> Result<Self> {
        Self::open(&self.path.join(name))
    }

    /// Removes the files of an earlier run, so that a folder never mixes two.
    ///
    /// # Errors
    /// [`Error::Write`] with the file that stays.
    pub fn remove(&self, stale: impl Fn(&str) -> bool) -> Result<()> {
        let unreadable = |source| Error::read(&self.path, source);
        for entry in fs::read_dir(&self.path).map_err(unreadable)? {
            let entry = entry.map_err(unreadable)?;
            if entry.file_name().to_str().is_some_and(&stale) && entry.path().is_file() {
                let path = entry.path();
                fs::remove_file(&path).map_err(|source| Error::write(&path, source))?;
            }
        }
        Ok(())
    }

    /// Writes a file: into a file of another name beside it, which then takes its place.
    ///
    /// # Errors
    /// [`Error::Write`] with the file; what stood in its place before still stands.
    pub fn write(
        &self,
        name: &str,
        fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<()> {
        let path = self.path.join(name);
        write_whole(&self.path, &path, fill).map_err(|source| Error::write(&path, source))
    }
}

fn write_whole(
    folder: &Path,
    path: &Path,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let path = &destination(path)?;
    let folder = path.parent().unwrap_or(folder);
    let file = {
        let mut known = unfinished();
        let file = begin(folder)?;
        known.insert(file.path().to_owned());
        file
    };
    let temporary = file.path().to_owned();
    let mut writer = BufWriter::new(file);
    let filled = fill(&mut writer).and_then(|()| writer.flush());
    let mut known = unfinished();
    let placed = filled.and_then(|()| {
        let file = writer
            .into_inner()
            .map_err(io::IntoInnerError::into_error)?;
        file.persist(path).map_err(|wrong| wrong.error)?;
        Ok(())
    });
    known.remove(&temporary);
    placed
}

/// Where a file is to stand: where a link leads, and never in place of a device or a folder.
fn destination(path: &Path) -> io::Result<PathBuf> {
    match fs::metadata(path) {
        Ok(found) if found.is_file() => fs::canonicalize(path),
        Ok(_) => Err(io::Error::new(
            io::ErrorKind::InvalidInput,
            "there is something else than a regular file",
        )),
        Err(wrong) if wrong.kind() == io::ErrorKind::NotFound => Ok(path.to_owned()),
        Err(wrong) => Err(wrong),
    }
}

/// A file of its own name, with the permissions that any new file would have.
fn begin(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".carom-");
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[cfg(unix)]
    #[test]
    fn a_link_is_followed_and_a_folder_is_not_replaced() {
        let scratch = tempfile::tempdir().unwrap();
        let (real, link) = (scratch.path().join("real"), scratch.path().join("link"));
        fs::write(&real, "old").unwrap();
        std::os::unix::fs::symlink(&real, &link).unwrap();
        let folder = Folder::open(scratch.path()).unwrap();
        folder.write("link", |out| out.write_all(b"new")).unwrap();
        assert_eq!(fs::read(&real).unwrap(), b"new");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        fs::create_dir(scratch.path().join("sub")).unwrap();
        let said = folder.write("sub", |_| Ok(())).unwrap_err().to_string();
        assert!(said.contains("regular file"), "{said}");
    }

    #[test]
    fn a_failed_write_leaves_the_old_file_and_nothing_else() {
        let scratch = tempfile::tempdir().unwrap();
        let folder = Folder::open(scratch.path()).unwrap();
        folder.write("a.csv", |out| out.write_all(b"old")).unwrap();
        let said = folder
            .write("a.csv", |out| {
                out.write_all(b"half")?;
                Err(io::Error::other("disk full"))
            })
            .unwrap_err()
            .to_string();
        assert!(
            said.contains("a.csv") && said.contains("disk full"),
            "{said}"
        );
        assert_eq!(fs::read(scratch.path().join("a.csv")).unwrap(), b"old");
        assert_eq!(fs::read_dir(scratch.path()).unwrap().count(), 1);
    }
}
