//! What the terminal sees: results, warnings, progress, and Ctrl-C.

use std::fmt::Display;
use std::io::{self, Write};
#[cfg(unix)]
use std::sync::Arc;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

#[cfg(unix)]
use crate::engine::external;
use crate::error::{Error, Result};
#[cfg(unix)]
use crate::report::remove_unfinished;

/// Prints a result. A reader who has seen enough (`| head`) is no error.
pub(super) fn say(text: impl Display) -> Result<()> {
    let mut out = io::stdout().lock();
    match writeln!(out, "{text}").and_then(|()| out.flush()) {
        Err(wrong) if wrong.kind() != io::ErrorKind::BrokenPipe => Err(Error::Write {
            path: "standard output".into(),
            source: wrong,
        }),
        Ok(()) | Err(_) => Ok(()),
    }
}

/// Warns on standard error. That nobody listens there is no reason to stop.
pub(super) fn warn(text: impl Display) {
    let _ = writeln!(io::stderr().lock(), "warning: {text}");
}

/// Says why carom could not run.
pub(super) fn complain(error: &Error) {
    let line = error.to_string().replace(['\n', '\r'], " ");
    let _ = writeln!(io::stderr().lock(), "error: {line}");
}

/// A progress bar on a terminal, silence in a pipe or when asked to be quiet.
pub(super) fn progress(length: usize, quiet: bool) -> ProgressBar {
    let bar = ProgressBar::new(length as u64);
    if quiet {
        bar.set_draw_target(ProgressDrawTarget::hidden());
    }
    if let Ok(style) =
        ProgressStyle::with_template("{wide_bar} {pos}/{len}, {elapsed_precise}, {msg}")
    {
        bar.set_style(style);
    }
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

/// A sign of life on a terminal while one scene is computed.
pub(super) fn spinner(message: &str, hidden: bool) -> ProgressBar {
    let bar = ProgressBar::new_spinner();
    if hidden {
        bar.set_draw_target(ProgressDrawTarget::hidden());
    }
    bar.set_message(message.to_owned());
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

/// On Ctrl-C and its kin, leaves complete files only and no solver running, and ends as shells
/// expect: 128 plus the number of the signal.
#[cfg(unix)]
pub(super) fn tidy_up_on_interrupt() -> Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGXFSZ};

    let failed = |wrong: io::Error| Error::Interrupt {
        message: wrong.to_string(),
    };
    // A file that grows past the shell's limit: caught, the write fails and can be told.
    signal_hook::flag::register(SIGXFSZ, Arc::default()).map_err(failed)?;
    let mut signals =
        signal_hook::iterator::Signals::new([SIGINT, SIGTERM, SIGHUP]).map_err(failed)?;
    std::thread::spawn(move || {
        if let Some(signal) = signals.forever().next() {
            external::end_all();
            remove_unfinished();
            std::process::exit(128 + signal);
        }
    });
    Ok(())
}

/// Elsewhere an interrupt ends the program at once.
#[cfg(not(unix))]
pub(super) fn tidy_up_on_interrupt() -> Result<()> {
    Ok(())
}
