//! What a program said last on standard error.

use std::fs::{self, File};
use std::io::{self, Read, Seek, SeekFrom};
use std::path::Path;

use crate::error::harmless;

/// Bytes that are looked at, from the end.
const BYTES_MAX: u64 = 4096;

/// Lines that are shown, from the end.
const LINES_MAX: usize = 5;

/// Characters of a line that are shown.
const LINE_MAX: usize = 200;

/// The last lines of a file in one line; none if there are none, or it cannot be read.
pub(super) fn last_words(file: &Path) -> Option<String> {
    let text = String::from_utf8_lossy(&tail(file).ok()?).into_owned();
    let lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
    let mut last: Vec<String> = lines
        .rev()
        .take(LINES_MAX)
        .map(|line| harmless(&line.chars().take(LINE_MAX).collect::<String>()))
        .collect();
    last.reverse();
    (!last.is_empty()).then(|| last.join(" | "))
}

fn tail(file: &Path) -> io::Result<Vec<u8>> {
    if !fs::symlink_metadata(file)?.is_file() {
        // The program may have put a pipe there, which nobody fills.
        return Ok(Vec::new());
    }
    let mut file = File::open(file)?;
    let length = file.metadata()?.len();
    file.seek(SeekFrom::Start(length.saturating_sub(BYTES_MAX)))?;
    let mut bytes = Vec::new();
    file.take(BYTES_MAX).read_to_end(&mut bytes)?;
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(bytes: &[u8]) -> Option<String> {
        let file = tempfile::NamedTempFile::new().unwrap();
        std::fs::write(file.path(), bytes).unwrap();
        last_words(file.path())
    }

    #[test]
    fn the_last_lines_stand_in_one_and_nothing_in_them_is_obeyed() {
        assert_eq!(of(b""), None);
        assert_eq!(of(b"\n \n"), None);
        let said = of(b"0\n1\n2\n3\n\n4\nred \x1b[31m\tand \xff\n").unwrap();
        assert_eq!(said, "1 | 2 | 3 | 4 | red \\u{1b}[31m and \u{fffd}");
    }

    #[test]
    fn a_long_story_is_cut() {
        let said = of("no! ".repeat(100_000).as_bytes()).unwrap();
        assert_eq!(said.len(), LINE_MAX);
    }
}
