//! Tables read as streams, with a place for every complaint.

use std::io::{self, Read};
use std::path::Path;

use crate::error::{Error, Result, quoted};
use crate::input::{RowEnd, Rows};

/// A CSV file that is being read row by row.
pub(super) struct Table<'a, R> {
    reader: csv::Reader<Rows<R>>,
    row_end: RowEnd,
    header: &'static [&'static str],
    file: &'a str,
    row: csv::StringRecord,
}

impl<'a, R: Read> Table<'a, R> {
    /// Opens a table that must have this header; `file` is its name in messages.
    pub fn open(input: R, header: &'static [&'static str], file: &'a str) -> Result<Self> {
        let (rows, row_end) = Rows::new(input);
        let mut table = Self {
            reader: csv::Reader::from_reader(rows),
            row_end,
            header,
            file,
            row: csv::StringRecord::new(),
        };
        let found = table.reader.headers().cloned();
        let found = found.map_err(|wrong| table.unreadable(&wrong))?;
        if found == *header {
            return Ok(table);
        }
        let due = header.join(",");
        let message = if found.is_empty() {
            format!("nothing is there; the header must be `{due}`")
        } else {
            let found = found.iter().collect::<Vec<_>>().join(",");
            format!("the header must be `{due}`, not `{}`", quoted(&found))
        };
        Err(table.at(1).wrong(message))
    }

    /// Reads the next row; false at the end of the file.
    pub fn advance(&mut self) -> Result<bool> {
        self.row_end.tell();
        let read = self.reader.read_record(&mut self.row);
        read.map_err(|wrong| self.unreadable(&wrong))
    }

    /// The text in a column of the present row.
    pub fn text(&self, column: usize) -> &str {
        &self.row[column]
    }

    /// The number in a column of the present row.
    pub fn number(&self, column: usize) -> Result<f64> {
        let text = self.text(column);
        let number = text.trim().parse().ok().filter(|x: &f64| x.is_finite());
        number.ok_or_else(|| {
            let name = self.header[column];
            self.wrong(format!(
                "`{name}` is `{}`: not a finite number",
                quoted(text)
            ))
        })
    }

    /// Something is wrong with the present row.
    pub fn wrong(&self, message: String) -> Error {
        self.place().wrong(message)
    }

    /// Where the present row stands; past the last one, where the next would.
    pub fn place(&self) -> Place<'a> {
        self.at(self.row.position().map_or(1, csv::Position::line))
    }

    fn at(&self, line: u64) -> Place<'a> {
        let file = self.file;
        Place { file, line }
    }

    fn unreadable(&self, wrong: &csv::Error) -> Error {
        if let csv::ErrorKind::Io(wrong) = wrong.kind() {
            let wrong = io::Error::new(wrong.kind(), wrong.to_string());
            return Error::read(Path::new(self.file), wrong);
        }
        let line = wrong.position().map_or(1, csv::Position::line);
        let message = match wrong.kind() {
            csv::ErrorKind::UnequalLengths {
                expected_len, len, ..
            } => {
                format!("{len} columns where {expected_len} are due")
            }
            csv::ErrorKind::Utf8 { err, .. } => format!(
                "not UTF-8 in column {}; write the file as UTF-8 text",
                err.field() + 1
            ),
            _ => wrong.to_string(),
        };
        self.at(line).wrong(message)
    }
}

/// A line of a table.
#[derive(Debug, Clone, Copy)]
pub(super) struct Place<'a> {
    file: &'a str,
    line: u64,
}

impl Place<'_> {
    /// Something is wrong there.
    pub fn wrong(self, message: String) -> Error {
        Error::Table {
            file: self.file.to_owned(),
            line: self.line,
            message,
        }
    }
}
