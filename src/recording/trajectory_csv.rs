//! `time,body,x,y,z,vx,vy,vz`: a row per body and sample, read and written as a stream.

use std::io::{Read, Write};

use super::Recording;
use crate::error::{Error, Result};
use crate::physics::{BodyState, Vector3};
use crate::scene::Scene;

const HEADER: [&str; 8] = ["time", "body", "x", "y", "z", "vx", "vy", "vz"];

/// Relative room for the times of a foreign file: they may be printed with 9 digits.
const TIME_TOLERANCE: f64 = 1e-9;

/// Writes a recording. Numbers are the shortest that read back as the same double.
///
/// # Errors
/// Those of the writer.
pub fn write_trajectory(
    recording: &Recording,
    scene: &Scene,
    out: impl Write,
) -> std::result::Result<(), csv::Error> {
    let mut table = csv::Writer::from_writer(out);
    table.write_record(HEADER)?;
    for (sample, states) in recording.samples().enumerate() {
        let time = scene.sample_time(sample);
        for (body, state) in scene.bodies.iter().zip(states) {
            let [x, v] = [&state.position, &state.velocity];
            table.serialize((time, &body.name, x.x, x.y, x.z, v.x, v.y, v.z))?;
        }
    }
    table.flush()?;
    Ok(())
}

/// Reads a trajectory that stands on the scene's time grid; `file` is its name in messages.
///
/// # Errors
/// [`Error::Table`] with the line, for a wrong header or number, a body missing or out of
/// order, and a time off the grid.
pub fn read_trajectory(
    voice: &str,
    scene: &Scene,
    input: impl Read,
    file: &str,
) -> Result<Recording> {
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
    let mut recording = Recording::empty(voice, scene.bodies.len());
    let mut states = Vec::with_capacity(scene.bodies.len());
    let mut row = csv::StringRecord::new();
    while table.read_record(&mut row).map_err(unreadable)? {
        let line = row.position().map_or(0, csv::Position::line);
        let sample = recording.sample_count();
        let (body, expected) = (&scene.bodies[states.len()], scene.sample_time(sample));
        if row[1] != body.name {
            let message = format!(
                "body `{}` where `{}` of t = {expected} s is due; a row a body, in the scene's order",
                &row[1], body.name
            );
            return Err(complaint(line, message));
        }
        let mut numbers = [0.0; 8];
        for (column, number) in numbers
            .iter_mut()
            .enumerate()
            .filter(|(column, _)| *column != 1)
        {
            let text = &row[column];
            *number = text
                .trim()
                .parse()
                .ok()
                .filter(|x: &f64| x.is_finite())
                .ok_or_else(|| {
                    complaint(
                        line,
                        format!("`{}` is `{text}`: not a finite number", HEADER[column]),
                    )
                })?;
        }
        let [time, _, x, y, z, vx, vy, vz] = numbers;
        if (time - expected).abs() > TIME_TOLERANCE * scene.duration
            || sample > scene.sample_count()
        {
            let message = format!("time {time} s where {expected} s is due: off the scene's grid");
            return Err(complaint(line, message));
        }
        let (position, velocity) = (Vector3::new(x, y, z), Vector3::new(vx, vy, vz));
        states.push(BodyState { position, velocity });
        if states.len() == scene.bodies.len() {
            recording.push(&states);
            states.clear();
        }
    }
    let complete = states.is_empty() && recording.sample_count() == scene.sample_count() + 1;
    if !complete {
        let line = row.position().map_or(1, csv::Position::line);
        let message = format!(
            "ends after {} of {} samples; the file is not complete",
            recording.sample_count(),
            scene.sample_count() + 1
        );
        return Err(complaint(line, message));
    }
    Ok(recording)
}
