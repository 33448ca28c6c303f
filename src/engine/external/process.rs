//! Processes with all their children: a group each where the system has groups.

use std::io;
use std::process::{Child, Command, ExitStatus, Stdio};

/// What a whole group is known by.
#[cfg(unix)]
pub(super) type Group = rustix::process::Pid;

/// Where there are no groups, nothing is known of children.
#[cfg(not(unix))]
pub(super) type Group = ();

/// What the guard does: it waits for the end of its input, which comes when carom has ended,
/// whatever ended it, and then kills the group that it leads, itself included.
const GUARD: &str = "trap '' HUP INT QUIT TERM; read -r end; kill -s KILL 0";

/// A process in a group of its own, with a guard that ends the group when this program does.
#[derive(Debug)]
pub(super) struct Guest {
    child: Child,
    /// The leader of the group, started first, so that there is no moment without it. Its input
    /// is the end of a pipe that no other process has.
    guard: Option<Child>,
}

impl Guest {
    /// Starts a command. Where the system has no shell for the guard, the guest is its own leader
    /// and outlives a program that is killed.
    pub fn start(command: &mut Command) -> io::Result<Self> {
        let mut guard = guard();
        in_group(command, guard.as_ref());
        match command.spawn() {
            Ok(child) => Ok(Self { child, guard }),
            Err(wrong) => {
                if let Some(guard) = &mut guard {
                    end(guard);
                }
                Err(wrong)
            }
        }
    }

    /// The group of the process and of its children.
    pub fn group(&self) -> Group {
        group(self.guard.as_ref().unwrap_or(&self.child))
    }

    /// Whether the process has ended; its children may go on. Its number is not given back yet,
    /// so that a signal cannot reach another.
    pub fn has_ended(&mut self) -> io::Result<bool> {
        has_ended(&mut self.child)
    }

    /// Waits for a process whose group was killed, and says how it ended.
    pub fn wait(mut self) -> io::Result<ExitStatus> {
        if let Some(guard) = &mut self.guard {
            end(guard);
        }
        // The process itself, if it has left its group. That it has ended is no error.
        let _ = self.child.kill();
        self.child.wait()
    }
}

/// Kills a process and waits for it. That it has ended is no error.
fn end(child: &mut Child) {
    let _ = child.kill();
    let _ = child.wait();
}

/// Starts the guard, as the leader of a group; none where that is not possible.
#[cfg(unix)]
fn guard() -> Option<Child> {
    let mut command = Command::new("/bin/sh");
    command
        .args(["-c", GUARD])
        .current_dir("/")
        .stdin(Stdio::piped())
        .stdout(Stdio::null())
        .stderr(Stdio::null());
    std::os::unix::process::CommandExt::process_group(&mut command, 0);
    command.spawn().ok()
}

/// Starts the guard: there is none without groups.
#[cfg(not(unix))]
fn guard() -> Option<Child> {
    None
}

/// Puts a command into the group of its guard, or into one of its own.
#[cfg(unix)]
fn in_group(command: &mut Command, guard: Option<&Child>) {
    let leader = guard.map_or(0, |guard| group(guard).as_raw_nonzero().get());
    std::os::unix::process::CommandExt::process_group(command, leader);
}

/// Puts a command nowhere: there are no groups.
#[cfg(not(unix))]
fn in_group(_command: &mut Command, _guard: Option<&Child>) {}

/// The group that a process leads.
#[cfg(unix)]
fn group(leader: &Child) -> Group {
    rustix::process::Pid::from_child(leader)
}

/// The group that a process leads.
#[cfg(not(unix))]
fn group(_leader: &Child) -> Group {}

/// Kills a group. That nobody is left in it is no error.
#[cfg(unix)]
pub(super) fn kill_group(group: Group) {
    let _ = rustix::process::kill_process_group(group, rustix::process::Signal::KILL);
}

/// Kills a group. That nobody is left in it is no error.
#[cfg(not(unix))]
pub(super) fn kill_group(_group: Group) {}

#[cfg(unix)]
fn has_ended(child: &mut Child) -> io::Result<bool> {
    use rustix::process::{WaitId, WaitIdOptions, waitid};
    let options = WaitIdOptions::EXITED | WaitIdOptions::NOHANG | WaitIdOptions::NOWAIT;
    Ok(waitid(WaitId::Pid(group(child)), options)?.is_some())
}

#[cfg(not(unix))]
fn has_ended(child: &mut Child) -> io::Result<bool> {
    Ok(child.try_wait()?.is_some())
}
