//! `time,kind,a,b,impulse`: a row an event, read and written as a stream.

use std::io::{Read, Write};

use super::{Event, EventKind, EventLog, Wall};
use crate::error::{Error, Result};
use crate::scene::Scene;

const HEADER: [&str; 5] = ["time", "kind", "a", "b", "impulse"];

/// Writes the events kept in a log.
///
/// # Errors
/// Those of the writer.
pub fn write_events(
    log: &EventLog,
    scene: &Scene,
    out: impl Write,
) -> std::result::Result<(), csv::Error> {
    let name = |body: usize| scene.bodies[body].name.as_str();
    let mut table = csv::Writer::from_writer(out);
    table.write_record(HEADER)?;
    for event in log.events() {
        let (kind, a, b) = match event.kind {
            EventKind::Contact { a, b } => ("contact", name(a), name(b)),
            EventKind::Cushion { body, wall } => ("cushion", name(body), wall.name()),
            EventKind::Rest { body } => ("rest", name(body), ""),
        };
        table.serialize((event.time, kind, a, b, event.impulse))?;
    }
    table.flush()?;
    Ok(())
}

/// Reads a list of events; `file` is its name in messages.
///
/// # Errors
/// [`Error::Table`] with the line, for a wrong header, number, kind or name.
pub fn read_events(scene: &Scene, input: impl Read, file: &str) -> Result<EventLog> {
    let complaint = |line: u64, message: String| Error::Table {
        file: file.to_owned(),
        line,
        message,
    };
    let unreadable = |wrong: csv::Error| {
        complaint(
            wrong.position().map_or(1, csv::Position::line),
            wrong.to_string(),
        )
    };
    let mut table = csv::Reader::from_reader(input);
    if table.headers().map_err(unreadable)? != HEADER.as_slice() {
        return Err(complaint(
            1,
            format!("the header must be `{}`", HEADER.join(",")),
        ));
    }
    let mut events = Vec::new();
    for row in table.into_records() {
        let row = row.map_err(unreadable)?;
        let line = row.position().map_or(0, csv::Position::line);
        let number = |column: usize| {
            row[column]
                .trim()
                .parse()
                .ok()
                .filter(|x: &f64| x.is_finite())
                .ok_or_else(|| {
                    complaint(
                        line,
                        format!(
                            "`{}` is `{}`: not a finite number",
                            HEADER[column], &row[column]
                        ),
                    )
                })
        };
        let body = |column: usize| {
            scene.body_index(&row[column]).ok_or_else(|| {
                complaint(line, format!("`{}` is no body of the scene", &row[column]))
            })
        };
        let kind = match &row[1] {
            "contact" => {
                let (a, b) = (body(2)?, body(3)?);
                EventKind::Contact {
                    a: a.min(b),
                    b: a.max(b),
                }
            }
            "cushion" => {
                let wall = Wall::from_name(&row[3]).ok_or_else(|| {
                    complaint(line, format!("`{}` is no wall: -x +x -z +z -y +y", &row[3]))
                })?;
                EventKind::Cushion {
                    body: body(2)?,
                    wall,
                }
            }
            "rest" => EventKind::Rest { body: body(2)? },
            other => {
                let message = format!("kind `{other}`: there are contact, cushion and rest");
                return Err(complaint(line, message));
            }
        };
        events.push(Event {
            time: number(0)?,
            kind,
            impulse: number(4)?,
        });
    }
    Ok(events.into_iter().collect())
}
