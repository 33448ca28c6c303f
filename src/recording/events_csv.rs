//! `time,kind,a,b,impulse`: a row an event, read and written as a stream.

use std::collections::HashMap;
use std::io::{Read, Write};

use super::table::Table;
use super::{Event, EventKind, EventLog, Wall};
use crate::error::{Result, number, quoted};
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
/// [`Error::Table`](crate::error::Error::Table) with the line, for a wrong header, number, kind or name.
pub fn read_events(scene: &Scene, input: impl Read, file: &str) -> Result<EventLog> {
    let mut table = Table::open(input, &HEADER, file)?;
    let names = scene.bodies.iter().map(|body| body.name.as_str());
    let indices: HashMap<&str, usize> = names.zip(0..).collect();
    let mut events = Vec::new();
    while table.advance()? {
        let body = |column: usize| {
            let name = table.text(column);
            let index = indices.get(name).copied();
            index.ok_or_else(|| table.wrong(format!("`{}` is no body of the scene", quoted(name))))
        };
        let kind = match table.text(1) {
            "contact" => {
                let (a, b) = (body(2)?, body(3)?);
                if a == b {
                    return Err(table.wrong(format!("`{}` hits itself", table.text(2))));
                }
                EventKind::Contact {
                    a: a.min(b),
                    b: a.max(b),
                }
            }
            "cushion" => {
                let name = table.text(3);
                let wall = Wall::from_name(name).ok_or_else(|| {
                    table.wrong(format!("`{}` is no wall: -x +x -z +z -y +y", quoted(name)))
                })?;
                EventKind::Cushion {
                    body: body(2)?,
                    wall,
                }
            }
            "rest" => EventKind::Rest { body: body(2)? },
            other => {
                let message = format!(
                    "kind `{}`: there are contact, cushion and rest",
                    quoted(other)
                );
                return Err(table.wrong(message));
            }
        };
        let (time, impulse) = (table.number(0)?, table.number(4)?);
        let latest = events.last().map_or(0.0, |event: &Event| event.time);
        // The last sample may stand a hair past the duration.
        let end = scene.duration.max(scene.sample_time(scene.sample_count()));
        if !(latest..=end).contains(&time) {
            return Err(table.wrong(format!(
                "time {} s: give the events in order of time, from 0 to {} s",
                number(time),
                number(end)
            )));
        }
        if impulse < 0.0 {
            return Err(table.wrong(format!(
                "impulse {}: give its size, 0 or above",
                number(impulse)
            )));
        }
        events.push(Event {
            time,
            kind,
            impulse,
        });
    }
    Ok(events.into_iter().collect())
}
