//! Tables read as streams, with a place for every complaint.

use std::io::Read;

use crate::error::{Error, Result};

/// A CSV file that is being read row by row.
pub(super) struct Table<'a, R> {
    reader: csv::Reader<R>,
    header: &'static [&'static str],
    file: &'a str,
    row: csv::StringRecord,
}

impl<'a, R: Read> Table<'a, R> {
    /// Opens a table that must have this header; `file` is its name in messages.
    pub fn open(input: R, header: &'static [&'static str], file: &'a str) -> Result<Self> {
        let mut table = Self {
            reader: csv::Reader::from_reader(input),
            header,
            file,
            row: csv::StringRecord::new(),
        };
        let found = table.reader.headers().cloned();
        if found.map_err(|wrong| table.unreadable(&wrong))? != *header {
            let message = format!("the header must be `{}`", header.join(","));
            return Err(table.complaint(1, message));
        }
        Ok(table)
    }

    /// Reads the next row; false at the end of the file.
    pub fn advance(&mut self) -> Result<bool> {
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
            self.wrong(format!("`{name}` is `{text}`: not a finite number"))
        })
    }

    /// Something is wrong with the present row.
    pub fn wrong(&self, message: String) -> Error {
        self.complaint(self.row.position().map_or(1, csv::Position::line), message)
    }

    fn unreadable(&self, wrong: &csv::Error) -> Error {
        let line = wrong.position().map_or(1, csv::Position::line);
        let message = match wrong.kind() {
            csv::ErrorKind::UnequalLengths {
                expected_len, len, ..
            } => {
                format!("{len} columns where {expected_len} are due")
            }
            _ => wrong.to_string(),
        };
        self.complaint(line, message)
    }

    fn complaint(&self, line: u64, message: String) -> Error {
        Error::Table {
            file: self.file.to_owned(),
            line,
            message,
        }
    }
}
