//! What the terminal sees: results, warnings, progress, and Ctrl-C.

use std::fmt::{Display, Write as _};
use std::io::{self, Write as _};
#[cfg(unix)]
use std::sync::Arc;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use serde::Serialize;

#[cfg(unix)]
use crate::engine::external;
use crate::error::{Error, Result, harmless, is_invisible, one_line, quoted};
#[cfg(unix)]
use crate::report::remove_unfinished;

/// Prints a result of one line, cleaned. A reader who has seen enough (`| head`) is no error.
pub(super) fn say(line: impl Display) -> Result<()> {
    print(&harmless(&line.to_string()))
}

/// Prints a text of several lines, each cleaned. What made it has cleaned the foreign text in it
/// of ends of lines, or the text is a file that is shown as it stands.
pub(super) fn say_lines(text: impl Display) -> Result<()> {
    let text = text.to_string();
    let lines: Vec<String> = text.split('\n').map(line_of_file).collect();
    print(&lines.join("\n"))
}

/// A line without what a terminal would obey; tabs and the line end of Windows stay.
fn line_of_file(line: &str) -> String {
    let bare = line.strip_suffix('\r').unwrap_or(line);
    let pieces: Vec<String> = bare.split('\t').map(harmless).collect();
    pieces.join("\t") + &line[bare.len()..]
}

/// Prints a value as JSON, whose own escapes clean it.
pub(super) fn say_json(value: &impl Serialize) -> Result<()> {
    print(&json_text(value)?)
}

fn json_text(value: &impl Serialize) -> Result<String> {
    let text = serde_json::to_string_pretty(value)?;
    let mut cleaned = String::with_capacity(text.len());
    for c in text.chars() {
        if c == '\n' || !is_invisible(c) {
            cleaned.push(c);
            continue;
        }
        // Only strings hold such characters; serde has escaped those below U+0020.
        for unit in c.encode_utf16(&mut [0; 2]) {
            let _ = write!(cleaned, "\\u{unit:04x}");
        }
    }
    Ok(cleaned)
}

fn print(text: &str) -> Result<()> {
    let mut out = io::stdout().lock();
    match writeln!(out, "{text}").and_then(|()| out.flush()) {
        Err(wrong) if wrong.kind() != io::ErrorKind::BrokenPipe => {
            Err(Error::Stdout { source: wrong })
        }
        Ok(()) | Err(_) => Ok(()),
    }
}

/// Warns on standard error. That nobody listens there is no reason to stop.
pub(super) fn warn(text: impl Display) {
    let line = one_line(&text.to_string());
    let _ = writeln!(io::stderr().lock(), "warning: {line}");
}

/// Says why carom could not run.
pub(super) fn complain(error: &Error) {
    let line = one_line(&error.to_string());
    let _ = writeln!(io::stderr().lock(), "error: {line}");
}

/// A sign of progress, whose messages are cleaned like all that is shown.
pub(super) struct Progress(ProgressBar);

impl Progress {
    pub fn set_length(&self, length: u64) {
        self.0.set_length(length);
    }

    pub fn set_position(&self, position: u64) {
        self.0.set_position(position);
    }

    pub fn inc(&self, more: u64) {
        self.0.inc(more);
    }

    pub fn set_message(&self, message: impl AsRef<str>) {
        self.0.set_message(quoted(message.as_ref()));
    }

    pub fn finish_and_clear(&self) {
        self.0.finish_and_clear();
    }
}

/// A progress bar on a terminal, silence in a pipe or when asked to be quiet.
pub(super) fn progress(length: usize, quiet: bool) -> Progress {
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
    Progress(bar)
}

/// A sign of life on a terminal while one scene is computed.
pub(super) fn spinner(message: &str, hidden: bool) -> Progress {
    let bar = ProgressBar::new_spinner();
    if hidden {
        bar.set_draw_target(ProgressDrawTarget::hidden());
    }
    bar.enable_steady_tick(Duration::from_millis(200));
    let bar = Progress(bar);
    bar.set_message(message);
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_shown_as_they_stand_without_what_a_terminal_obeys() {
        assert_eq!(line_of_file("a\tb\u{1b}[31m\r"), "a\tb\\u{1b}[31m\r");
    }

    #[test]
    fn json_stays_json_and_shows_nothing_to_a_terminal() {
        let value = "a\u{9b}31m\u{202e}\u{fffe}\u{e0041}\u{1b}\n";
        let text = json_text(&value).unwrap();
        assert!(!text.chars().any(is_invisible), "{text}");
        assert_eq!(serde_json::from_str::<String>(&text).unwrap(), value);
    }
}
