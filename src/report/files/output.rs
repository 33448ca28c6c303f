//! The folder of a result: locked, staged, and committed as a whole.

use std::collections::BTreeMap;
use std::fs::{self, File, TryLockError};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use serde::Serialize;

use super::journal::{Act, Journal};
use super::listing::{Found, Hashed, Listing, digest, listed, listing};
use super::stage::{Stage, complete_earlier, stages};
use super::{SUMMARY, UNFINISHED};
use crate::error::{Error, Result};

/// What a result may take the place of.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Replace {
    /// Files that an earlier summary of carom lists, as long as nobody changed them.
    Own,
    /// Any regular file of the names that are written: the user asked for these to be edited.
    Named,
    /// Any regular file or link.
    All,
}

/// A locked folder, and the result that is staged for it.
///
/// Dropped without [`commit`](Self::commit), it leaves the folder as it was.
#[derive(Debug)]
pub struct Output {
    root: PathBuf,
    replace: Replace,
    /// Whether it holds a result of which more is to come.
    unfinished: bool,
    stage: Stage,
    /// Digests of the staged files by their folder, relative to the root, and name.
    staged: Mutex<BTreeMap<PathBuf, Listing>>,
    /// Holds the lock, until the output is dropped.
    _lock: File,
}

impl Output {
    /// Makes the folder, locks it, completes or removes what a killed run left in it, and finds
    /// out before the long run whether files can be written there.
    ///
    /// # Errors
    /// [`Error::Write`] with the folder, [`Error::InUse`] if another run writes there.
    pub fn open(root: &Path, replace: Replace) -> Result<Self> {
        Self::begin(root, replace, false)
    }

    fn begin(root: &Path, replace: Replace, unfinished: bool) -> Result<Self> {
        let unwritable = |source| Error::write(root, source);
        let made = missing(root);
        fs::create_dir_all(root).map_err(unwritable)?;
        let lock = lock(root)?;
        Ok(Self {
            root: root.to_owned(),
            replace,
            unfinished,
            stage: Stage::begin(root, made)?,
            staged: Mutex::default(),
            _lock: lock,
        })
    }

    /// The folder itself, to write into.
    #[must_use]
    pub fn folder(&self) -> Folder<'_> {
        Folder {
            output: self,
            below: PathBuf::new(),
        }
    }

    fn staged(&self) -> MutexGuard<'_, BTreeMap<PathBuf, Listing>> {
        self.staged.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Puts the staged files in place of the earlier result. A folder's summary is placed after
    /// what it lists, and the root's at the very end.
    ///
    /// # Errors
    /// As [`Folder::claim`], with nothing changed; [`Error::Commit`] if the system refuses to
    /// rename a file, which the next run in the folder tries again.
    pub fn commit(self) -> Result<()> {
        let journal = self.journal()?;
        // From here on an interrupt waits.
        let guard = stages();
        let stage = self.stage.path();
        let unwritable = |source| Error::write(&self.root, source);
        journal.write(stage).map_err(unwritable)?;
        let applied = journal.apply(&self.root, stage);
        drop(guard);
        if let Err((path, source)) = applied {
            let stage = stage.to_owned();
            self.stage.leave();
            return Err(Error::Commit {
                path,
                stage,
                source,
            });
        }
        Ok(())
    }

    /// What the commit has to do, after a last look at what stands there.
    fn journal(&self) -> Result<Journal> {
        let staged = self.staged();
        let mut journal = Journal::default();
        let mut summaries = Vec::new();
        // Deeper folders first; the root's own files come last.
        let mut folders: Vec<_> = staged.iter().collect();
        folders.sort_by_key(|(below, _)| std::cmp::Reverse(below.components().count()));
        for (below, files) in folders {
            self.look(below, self.unfinished, files.keys().map(String::as_str))?;
            for name in files.keys() {
                let act = self.act(below.join(name))?;
                if name == SUMMARY {
                    summaries.push(act);
                } else {
                    journal.place.push(act);
                }
            }
            if files.contains_key(SUMMARY) {
                journal
                    .remove
                    .extend(self.stale(below, self.unfinished, files)?);
                let part = below.join(UNFINISHED);
                let place = self.root.join(&part);
                if fs::symlink_metadata(&place).is_ok_and(|found| found.is_dir()) {
                    complete_earlier(&place)?;
                    journal
                        .remove
                        .extend(self.stale(&part, true, &Listing::new())?);
                    journal.prune.push(part);
                }
            }
        }
        journal.place.extend(summaries);
        Ok(journal)
    }

    /// An act at a place, with what stands there.
    fn act(&self, path: PathBuf) -> Result<Act> {
        let place = self.root.join(&path);
        let is_file = fs::symlink_metadata(&place).is_ok_and(|found| found.is_file());
        let before = is_file
            .then(|| File::open(&place).and_then(digest))
            .transpose();
        let before = before.map_err(|source| Error::read(&place, source))?;
        Ok(Act { path, before })
    }

    /// Files of the earlier result in a folder that the new one does not have, as long as they
    /// are as carom wrote them.
    fn stale(&self, below: &Path, unfinished: bool, new: &Listing) -> Result<Vec<Act>> {
        let folder = self.root.join(below);
        let Some(listing) = listing(&folder, unfinished) else {
            return Ok(Vec::new());
        };
        let mut stale = Vec::new();
        for name in listing.keys().map(String::as_str).chain([SUMMARY]) {
            let found = Found::at(&folder, name, Some(&listing));
            let found = found.map_err(|source| Error::read(&folder.join(name), source))?;
            if found == Found::Own && !new.contains_key(name) {
                stale.push(self.act(below.join(name))?);
            }
        }
        Ok(stale)
    }

    /// Whether files of these names may be placed in a folder below the root.
    fn look<'n>(
        &self,
        below: &Path,
        unfinished: bool,
        names: impl IntoIterator<Item = &'n str>,
    ) -> Result<()> {
        let mut folder = self.root.clone();
        for part in below {
            folder.push(part);
            look_at_folder(&folder)?;
        }
        let listing = listing(&folder, unfinished);
        for name in names {
            let path = folder.join(name);
            let found = Found::at(&folder, name, listing.as_ref());
            let found = found.map_err(|source| Error::read(&path, source))?;
            self.allow(found, path)?;
        }
        Ok(())
    }

    fn allow(&self, found: Found, path: PathBuf) -> Result<()> {
        let reason = match (found, self.replace) {
            (Found::Free | Found::Own, _)
            | (Found::Changed | Found::Foreign, Replace::Named | Replace::All)
            | (Found::Link, Replace::All) => return Ok(()),
            (Found::Changed, Replace::Own) => "was changed after carom wrote it",
            (Found::Foreign, Replace::Own) => "was not written by this version of carom",
            (Found::Link, Replace::Own | Replace::Named) => "is a link",
            (Found::Blocked, _) => {
                return Err(Error::foreign(&path, "is no regular file"));
            }
        };
        Err(Error::Foreign {
            path,
            reason,
            remedy: match self.replace {
                Replace::Own => "choose another folder with --out, or replace it with --force",
                Replace::Named | Replace::All => "put a regular file in its place",
            },
        })
    }
}

/// A folder of an [`Output`], or the output itself: where a result is written.
#[derive(Debug, Clone)]
pub struct Folder<'o> {
    output: &'o Output,
    below: PathBuf,
}

impl Folder<'_> {
    /// Where the folder is, once committed.
    #[must_use]
    pub fn path(&self) -> PathBuf {
        self.output.root.join(&self.below)
    }

    /// A folder within.
    #[must_use]
    pub fn folder(&self, name: &str) -> Self {
        Self {
            output: self.output,
            below: self.below.join(name),
        }
    }

    /// Sees before a long run that files of these names may be written: nothing of somebody else
    /// stands in their place.
    ///
    /// # Errors
    /// [`Error::Foreign`] with the first file that may not be replaced, and the remedy.
    pub fn claim<'n>(&self, names: impl IntoIterator<Item = &'n str>) -> Result<()> {
        let unfinished = self.below.ends_with(UNFINISHED);
        self.output.look(&self.below, unfinished, names)?;
        let path = self.path();
        if path.is_dir() {
            tempfile::tempfile_in(&path).map_err(|source| Error::write(&path, source))?;
        }
        Ok(())
    }

    /// The path at which a file of the result can be read: the staged one, else the one in place.
    #[must_use]
    pub fn current(&self, name: &str) -> PathBuf {
        let relative = self.below.join(name);
        let staged = self.output.staged();
        if staged
            .get(&self.below)
            .is_some_and(|files| files.contains_key(name))
        {
            self.output.stage.place(&relative)
        } else {
            self.output.root.join(relative)
        }
    }

    /// Stages a file.
    ///
    /// # Errors
    /// [`Error::Write`] with the file; the folder is as it was.
    pub fn write(
        &self,
        name: &str,
        fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> Result<()> {
        let relative = self.below.join(name);
        let write = || {
            let file = self.output.stage.create(&relative)?;
            let mut out = BufWriter::new(Hashed::new(file));
            fill(&mut out)?;
            let hashed = out.into_inner().map_err(io::IntoInnerError::into_error)?;
            Ok(hashed.finish().0)
        };
        let path = || self.output.root.join(&relative);
        let digest = write().map_err(|source| Error::write(&path(), source))?;
        let mut staged = self.output.staged();
        let files = staged.entry(self.below.clone()).or_default();
        files.insert(name.to_owned(), digest);
        Ok(())
    }

    /// Stages the summary, which lists the files that were written into this folder before.
    ///
    /// # Errors
    /// As [`write`](Self::write).
    pub fn write_summary(&self, summary: &impl Serialize) -> Result<()> {
        let files = self.output.staged().get(&self.below).cloned();
        let mut files = files.unwrap_or_default();
        files.remove(SUMMARY);
        let unfinished = self.output.unfinished;
        self.write(SUMMARY, |out| {
            let text = listed(summary, &files, unfinished)?;
            out.write_all(text.as_bytes())
        })
    }

    /// Where a result stands that is not complete yet; the complete one removes it.
    #[must_use]
    pub fn unfinished(&self) -> Self {
        self.folder(UNFINISHED)
    }

    /// Puts a part of the result into the folder `unfinished`, so that an interrupted run leaves
    /// what it has found while the earlier result stands.
    ///
    /// # Errors
    /// Those of `write` and of [`Output::commit`].
    pub fn keep_unfinished(&self, write: impl FnOnce(&Folder) -> Result<()>) -> Result<()> {
        let place = self.unfinished().path();
        look_at_folder(&place)?;
        let part = Output::begin(&place, self.output.replace, true)?;
        write(&part.folder())?;
        part.commit()
    }
}

/// Whether a folder stands there, or can be made there.
fn look_at_folder(folder: &Path) -> Result<()> {
    match fs::symlink_metadata(folder) {
        Ok(found) if found.is_dir() => Ok(()),
        Ok(found) if found.is_symlink() => Err(Error::foreign(
            folder,
            "is a link, which carom does not write through",
        )),
        Ok(_) => Err(Error::foreign(folder, "is a file where a folder is needed")),
        Err(wrong) if wrong.kind() == io::ErrorKind::NotFound => Ok(()),
        Err(wrong) => Err(Error::read(folder, wrong)),
    }
}

/// The folders that are not there yet, the deepest first.
fn missing(root: &Path) -> Vec<PathBuf> {
    let absent = |folder: &&Path| !folder.as_os_str().is_empty() && !folder.exists();
    root.ancestors()
        .take_while(absent)
        .map(Path::to_owned)
        .collect()
}

/// Locks a folder against other runs. The lock ends with the process, however that ends.
fn lock(root: &Path) -> Result<File> {
    // Elsewhere than on Unix a folder cannot be opened, and a file in it is locked.
    let opened = if cfg!(unix) {
        File::open(root)
    } else {
        File::create(root.join(".carom-lock"))
    };
    let file = opened.map_err(|source| Error::write(root, source))?;
    match file.try_lock() {
        Err(TryLockError::WouldBlock) => Err(Error::InUse {
            path: root.to_owned(),
        }),
        // Some network file systems have no locks: there, two runs are the user's concern.
        Ok(()) | Err(TryLockError::Error(_)) => Ok(file),
    }
}
