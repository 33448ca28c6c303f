//! Files that carom reads: the one place that opens them. Only regular files of a bounded size,
//! and rows of a bounded length, so that memory is bounded before it is taken.

use std::cell::Cell;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::Path;
use std::rc::Rc;

use crate::error::{Error, Result};

/// Bytes of a row of a table. The longest row that carom writes has a name of 200 characters
/// (800 bytes, 1,602 with every one of them a doubled quote) and 8 numbers of 25 bytes; foreign
/// rows with blanks and more digits have 30 times the room. A reader holds two of them.
const ROW_BYTES_MAX: u64 = 1 << 16;

/// Bytes of a summary that a study has left, or of a table of measured points. A number takes 8
/// bytes of memory for 2 in the file, a point some 200 for 20, which makes 170 MB; the largest
/// that carom has written takes 2 MB.
pub(crate) const STORED_BYTES_MAX: u64 = 16 << 20;

/// Opens a regular file of at most so many bytes.
///
/// # Errors
/// [`Error::Read`]: not there, no regular file, or larger.
pub(crate) fn open(path: &Path, bytes_max: u64) -> Result<File> {
    let refused = |message: String| Error::read(path, io::Error::other(message));
    let found = fs::metadata(path).map_err(|source| Error::read(path, source))?;
    if !found.is_file() {
        let what = if found.is_dir() {
            "a folder"
        } else {
            "a pipe or a device"
        };
        return Err(refused(format!(
            "it is {what}; give the path of a regular file"
        )));
    }
    if found.len() > bytes_max {
        return Err(refused(format!(
            "it has {} bytes, more than the {bytes_max} that are read of such a file",
            found.len()
        )));
    }
    File::open(path).map_err(|source| Error::read(path, source))
}

/// All bytes of a regular file, at most so many.
///
/// # Errors
/// As [`open`]; a file may grow while it is read, or say that it is empty as those of `/proc` do.
pub(crate) fn bytes(path: &Path, bytes_max: u64) -> Result<Vec<u8>> {
    let file = open(path, bytes_max)?;
    let mut bytes = Vec::new();
    file.take(bytes_max + 1)
        .read_to_end(&mut bytes)
        .map_err(|source| Error::read(path, source))?;
    if bytes.len() as u64 > bytes_max {
        let message =
            format!("it has more than the {bytes_max} bytes that are read of such a file");
        return Err(Error::read(path, io::Error::other(message)));
    }
    Ok(bytes)
}

/// The text of a regular file of at most so many bytes.
///
/// # Errors
/// As [`bytes`], or [`Error::NotUtf8`].
pub(crate) fn text(path: &Path, bytes_max: u64) -> Result<String> {
    let bytes = bytes(path, bytes_max)?;
    let file = path.display().to_string();
    String::from_utf8(bytes).map_err(|wrong| Error::not_utf8(&file, &wrong))
}

/// A reader of rows that fails where a row does not end. Who reads rows from it says after each
/// that it has ended.
pub(crate) struct Rows<R> {
    inner: R,
    left: RowEnd,
}

/// Tells [`Rows`] that a row has ended.
#[derive(Clone)]
pub(crate) struct RowEnd(Rc<Cell<u64>>);

impl RowEnd {
    /// The next row may be as long again.
    pub fn tell(&self) {
        self.0.set(ROW_BYTES_MAX);
    }
}

impl<R: Read> Rows<R> {
    /// Rows of `inner`, and what to tell when one has ended.
    pub fn new(inner: R) -> (Self, RowEnd) {
        let left = RowEnd(Rc::new(Cell::new(ROW_BYTES_MAX)));
        let end = left.clone();
        (Self { inner, left }, end)
    }
}

impl<R: Read> Read for Rows<R> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let left = self.left.0.get();
        if left == 0 {
            return Err(io::Error::other(format!(
                "no row ends within {ROW_BYTES_MAX} bytes; write a row a line, without empty lines"
            )));
        }
        let room = usize::try_from(left).map_or(buffer.len(), |left| left.min(buffer.len()));
        let count = self.inner.read(&mut buffer[..room])?;
        self.left.0.set(left - count as u64);
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_without_an_end_is_read_no_further() {
        let (mut rows, end) = Rows::new(io::repeat(b'x'));
        let mut buffer = vec![0; 1000];
        let mut read = 0;
        let wrong = loop {
            match rows.read(&mut buffer) {
                Ok(count) => read += count as u64,
                Err(wrong) => break wrong,
            }
        };
        assert_eq!(read, ROW_BYTES_MAX);
        assert!(wrong.to_string().contains("no row ends"), "{wrong}");
        end.tell();
        assert_eq!(rows.read(&mut buffer).unwrap(), 1000);
    }

    #[test]
    fn only_regular_files_of_that_size_are_read() {
        let scratch = tempfile::tempdir().unwrap();
        let file = scratch.path().join("a");
        fs::write(&file, "1234").unwrap();
        assert_eq!(bytes(&file, 4).unwrap(), b"1234");
        let said = bytes(&file, 3).unwrap_err().to_string();
        assert!(said.contains("4 bytes, more than the 3"), "{said}");
        let said = bytes(scratch.path(), 3).unwrap_err().to_string();
        assert!(said.contains("a folder"), "{said}");
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_device_is_no_file_and_what_says_nothing_of_its_size_is_cut() {
        let said = text(Path::new("/dev/zero"), 9).unwrap_err().to_string();
        assert!(said.contains("a pipe or a device"), "{said}");
        let said = text(Path::new("/proc/self/status"), 9).unwrap_err();
        assert!(said.to_string().contains("more than the 9 bytes"), "{said}");
    }
}
