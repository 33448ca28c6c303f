//! `time,body,x,y,z,vx,vy,vz`: a row per body and sample, read and written as a stream.

use std::io::{Read, Write};

use super::Recording;
use super::table::Table;
use crate::error::Result;
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
/// [`Error::Table`](crate::error::Error::Table) with the line, for a wrong header or number, a body missing or out of
/// order, and a time off the grid.
pub fn read_trajectory(
    voice: &str,
    scene: &Scene,
    input: impl Read,
    file: &str,
) -> Result<Recording> {
    read(voice, scene, input, file, scene.sample_count() + 1)
}

/// The same of a trajectory that may end before the scene does, after any sample.
///
/// # Errors
/// As [`read_trajectory`].
pub fn read_trajectory_start(
    voice: &str,
    scene: &Scene,
    input: impl Read,
    file: &str,
) -> Result<Recording> {
    read(voice, scene, input, file, 1)
}

fn read(
    voice: &str,
    scene: &Scene,
    input: impl Read,
    file: &str,
    least_samples: usize,
) -> Result<Recording> {
    let mut table = Table::open(input, &HEADER, file)?;
    let mut recording = Recording::empty(voice, scene.bodies.len());
    let mut states = Vec::with_capacity(scene.bodies.len());
    while table.advance()? {
        let sample = recording.sample_count();
        let (body, due) = (&scene.bodies[states.len()], scene.sample_time(sample));
        if table.text(1) != body.name {
            return Err(table.wrong(format!(
                "body `{}` where `{}` of t = {due} s is due; a row a body, in the scene's order",
                table.text(1),
                body.name
            )));
        }
        let time = table.number(0)?;
        if sample > scene.sample_count() {
            return Err(table.wrong(format!("goes on past the end, t = {} s", scene.duration)));
        }
        if (time - due).abs() > TIME_TOLERANCE * scene.duration {
            let message = format!("time {time} s where {due} s is due: off the scene's grid");
            return Err(table.wrong(message));
        }
        let vector = |first: usize| -> Result<Vector3> {
            let [x, y, z] = [0, 1, 2].map(|axis| table.number(first + axis));
            Ok(Vector3::new(x?, y?, z?))
        };
        let (position, velocity) = (vector(2)?, vector(5)?);
        states.push(BodyState { position, velocity });
        if states.len() == scene.bodies.len() {
            recording.push(&states);
            states.clear();
        }
    }
    let complete = states.is_empty() && recording.sample_count() >= least_samples;
    if !complete {
        return Err(table.wrong(format!(
            "ends after {} of {} samples; the file is not complete",
            recording.sample_count(),
            scene.sample_count() + 1
        )));
    }
    Ok(recording)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene() -> Scene {
        let text = "name='x'\nduration=1\nsample_every=1\n[[bodies]]\nname='a'\nmass=1\n\
            radius=1\nposition=[0,0,0]\nvelocity=[0,0,0]\n";
        crate::scene::parse(text, "x").unwrap()
    }

    fn read(rows: &str) -> Result<Recording> {
        let text = format!("time,body,x,y,z,vx,vy,vz\n{rows}");
        read_trajectory("x", &scene(), text.as_bytes(), "t.csv")
    }

    #[test]
    fn what_is_written_is_read_back_bit_for_bit() {
        let awkward = "0,a,0.1,-5e-324,1e300,1,2,3\n1,a,0.30000000000000004,0,0,0,0,-7.5\n";
        let recording = read(awkward).unwrap();
        let mut table = Vec::new();
        write_trajectory(&recording, &scene(), &mut table).unwrap();
        let again = read_trajectory("x", &scene(), table.as_slice(), "t.csv").unwrap();
        assert!(recording.samples().eq(again.samples()));
    }

    #[test]
    fn each_wrong_table_is_told_with_its_line() {
        let start = "0,a,0,0,0,0,0,0\n";
        let table = [
            ("0,b,0,0,0,0,0,0\n", "line 2: body `b` where `a`"),
            ("0,a,0,0,nan,0,0,0\n", "line 2: `z` is `nan`"),
            ("0.5,a,0,0,0,0,0,0\n", "line 2: time 0.5 s where 0 s is due"),
            ("0,a,0,0\n", "line 2"),
            (start, "ends after 1 of 2 samples"),
            (
                &format!("{start}{start}"),
                "line 3: time 0 s where 1 s is due",
            ),
        ];
        for (rows, said) in table {
            let complaint = read(rows).unwrap_err().to_string();
            assert!(complaint.contains(said), "{complaint}");
        }
        let header = read_trajectory("x", &scene(), b"a,b\n".as_slice(), "t.csv").unwrap_err();
        assert!(
            header.to_string().contains("the header must be"),
            "{header}"
        );
    }
}
