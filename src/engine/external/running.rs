//! Who runs at present, and the guard that ends them: no process and no file of a solver stays
//! behind, whatever ends the run.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, ExitStatus};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::{io, mem};

use super::folder::{Folder, remove};
use super::process::{self, Group, Guest};

/// The temporary folders there are, each with the group that works in it.
static RUNNING: Mutex<BTreeMap<PathBuf, Option<Group>>> = Mutex::new(BTreeMap::new());

fn running() -> MutexGuard<'static, BTreeMap<PathBuf, Option<Group>>> {
    RUNNING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Ends every solver that runs, with its children, removes their files, and lets none be started
/// or finish from here on: an act for the end of the program on Ctrl-C, which a process group of
/// its own does not get from the terminal.
///
/// Where the system has no process groups, only the files are removed.
pub fn end_all() {
    let all = running();
    for group in all.values().flatten() {
        process::kill_group(*group);
    }
    for folder in all.keys() {
        remove(folder);
    }
    // Whoever would start or finish waits for the end.
    mem::forget(all);
}

/// A temporary folder and the solver that works in it. With the guard both end.
#[derive(Debug)]
pub(super) struct Running {
    guest: Option<Guest>,
    folder: Folder,
}

impl Running {
    /// An empty folder.
    pub fn open() -> io::Result<Self> {
        let mut all = running();
        let folder = Folder::open()?;
        all.insert(folder.path().to_owned(), None);
        let guest = None;
        Ok(Self { guest, folder })
    }

    /// Where the folder is.
    pub fn folder(&self) -> &Path {
        self.folder.path()
    }

    /// Starts the solver.
    pub fn start(&mut self, command: &mut Command) -> io::Result<()> {
        let mut all = running();
        let guest = Guest::start(command)?;
        all.insert(self.folder().to_owned(), Some(guest.group()));
        self.guest = Some(guest);
        Ok(())
    }

    /// Whether the solver has ended; its children may go on.
    pub fn has_ended(&mut self) -> io::Result<bool> {
        self.guest.as_mut().map_or(Ok(true), Guest::has_ended)
    }

    /// Ends the solver if it has not ended, and all its children; how it ended, none if it was
    /// never started or had been ended before.
    pub fn end(&mut self) -> io::Result<Option<ExitStatus>> {
        let Some(guest) = self.guest.take() else {
            return Ok(None);
        };
        {
            // Before the leader is waited for: until then the group's number is its own.
            let mut all = running();
            process::kill_group(guest.group());
            all.insert(self.folder().to_owned(), None);
        }
        guest.wait().map(Some)
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        // Nobody is left to be told.
        let _ = self.end();
        let mut all = running();
        remove(self.folder());
        all.remove(self.folder());
    }
}

#[cfg(all(test, unix))]
mod tests {
    use std::panic::{AssertUnwindSafe, catch_unwind};

    use std::thread;
    use std::time::Duration;

    use super::*;

    #[test]
    fn a_panic_ends_the_solver_and_removes_its_folder() {
        let mut group = None;
        let mut folder = PathBuf::new();
        let unwound = catch_unwind(AssertUnwindSafe(|| {
            let mut running = Running::open().unwrap();
            folder = running.folder().to_owned();
            running.start(Command::new("sleep").arg("300")).unwrap();
            assert!(!running.has_ended().unwrap());
            group = running.guest.as_ref().map(Guest::group);
            std::panic::resume_unwind(Box::new(()));
        }));
        assert!(unwound.is_err());
        // The leader was waited for, so that its number is free again.
        assert!(rustix::process::test_kill_process(group.unwrap()).is_err());
        assert!(folder.is_absolute() && !folder.exists());
        assert!(!running().contains_key(&folder));
    }

    #[test]
    fn a_solver_that_was_ended_says_how_once() {
        let mut running = Running::open().unwrap();
        running.start(&mut Command::new("false")).unwrap();
        while !running.has_ended().unwrap() {
            thread::sleep(Duration::from_millis(1));
        }
        assert_eq!(running.end().unwrap().unwrap().code(), Some(1));
        assert!(running.end().unwrap().is_none());
    }
}
