//! Processes with all their children: a group each where the system has groups.

use std::io;
use std::process::{Child, Command};

/// What a whole group is known by.
#[cfg(unix)]
pub(super) type Group = rustix::process::Pid;

/// Where there are no groups, nothing is known of children.
#[cfg(not(unix))]
pub(super) type Group = ();

/// Starts a command as the leader of a group of its own.
pub(super) fn start(command: &mut Command) -> io::Result<Child> {
    #[cfg(unix)]
    std::os::unix::process::CommandExt::process_group(command, 0);
    command.spawn()
}

/// The group that a process leads.
#[cfg(unix)]
pub(super) fn group(child: &Child) -> Group {
    rustix::process::Pid::from_child(child)
}

/// The group that a process leads.
#[cfg(not(unix))]
pub(super) fn group(_child: &Child) -> Group {}

/// Kills a group. That nobody is left in it is no error.
#[cfg(unix)]
pub(super) fn kill_group(group: Group) {
    let _ = rustix::process::kill_process_group(group, rustix::process::Signal::KILL);
}

/// Kills a group. That nobody is left in it is no error.
#[cfg(not(unix))]
pub(super) fn kill_group(_group: Group) {}

/// Whether a process has ended. Its number is not given back yet, so that a signal to its group
/// cannot reach another.
#[cfg(unix)]
pub(super) fn has_ended(child: &mut Child) -> io::Result<bool> {
    use rustix::process::{WaitId, WaitIdOptions, waitid};
    let options = WaitIdOptions::EXITED | WaitIdOptions::NOHANG | WaitIdOptions::NOWAIT;
    Ok(waitid(WaitId::Pid(group(child)), options)?.is_some())
}

/// Whether a process has ended.
#[cfg(not(unix))]
pub(super) fn has_ended(child: &mut Child) -> io::Result<bool> {
    Ok(child.try_wait()?.is_some())
}
