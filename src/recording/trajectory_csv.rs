//! `time,body,x,y,z,vx,vy,vz`: a row per body and sample, read and written as a stream.

use std::io::{Read, Write};

use super::Recording;
use super::misplaced::{Due, misplaced};
use super::table::Table;
use crate::error::{Result, number};
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
/// [`Error::Table`](crate::error::Error::Table) with the line, for a wrong header or number, a
/// row that is missing, doubled or out of order, an unknown body, a time off the grid, and a file
/// that ends early or goes on past the end.
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
        let due = Due {
            sample: recording.sample_count(),
            body: states.len(),
        };
        let is_due = due.sample <= scene.sample_count()
            && body(&table) == scene.bodies[due.body].name
            && is_at(scene, due.sample, time(&table)?);
        if !is_due {
            return Err(misplaced(&mut table, scene, due)?);
        }
        states.push(state(&table)?);
        if states.len() == scene.bodies.len() {
            recording.push(&states);
            states.clear();
        }
    }
    let count = recording.sample_count();
    let samples = scene.sample_count() + 1;
    if let Some(body) = scene
        .bodies
        .get(states.len())
        .filter(|_| !states.is_empty())
    {
        return Err(table.wrong(format!(
            "ends in the middle of sample {} of {samples}, where body `{}` of t = {} s is due; \
             the file is not complete",
            count + 1,
            body.name,
            number(scene.sample_time(count))
        )));
    }
    if count < least_samples {
        return Err(table.wrong(format!(
            "ends after {count} of {samples} samples, where t = {} s is due; the file is not complete",
            number(scene.sample_time(count))
        )));
    }
    Ok(recording)
}

/// The name of the body in the present row.
pub(super) fn body<'t, R: Read>(table: &'t Table<'_, R>) -> &'t str {
    table.text(1)
}

/// The time in the present row, s.
pub(super) fn time<R: Read>(table: &Table<'_, R>) -> Result<f64> {
    table.number(0)
}

/// Whether a time is that of a sample, to the rounding of foreign files.
pub(super) fn is_at(scene: &Scene, sample: usize, time: f64) -> bool {
    (time - scene.sample_time(sample)).abs() <= TIME_TOLERANCE * scene.duration
}

/// The state in the present row.
fn state<R: Read>(table: &Table<'_, R>) -> Result<BodyState> {
    let vector = |first: usize| -> Result<Vector3> {
        let [x, y, z] = [0, 1, 2].map(|axis| table.number(first + axis));
        Ok(Vector3::new(x?, y?, z?))
    };
    Ok(BodyState {
        position: vector(2)?,
        velocity: vector(5)?,
    })
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

    /// A scene of two bodies and three samples.
    fn read_pair(rows: &[&str]) -> String {
        let text = "name='x'\nduration=1\nsample_every=0.5\n\
            [[bodies]]\nname='a'\nmass=1\nradius=1\nposition=[0,0,0]\nvelocity=[0,0,0]\n\
            [[bodies]]\nname='b'\nmass=1\nradius=1\nposition=[0,0,0]\nvelocity=[0,0,0]\n";
        let scene = crate::scene::parse(text, "x").unwrap();
        let mut table = "time,body,x,y,z,vx,vy,vz\n".to_owned();
        for row in rows {
            table.push_str(row);
            table.push_str(",0,0,0,0,0,0\n");
        }
        let read = read_trajectory("x", &scene, table.as_bytes(), "t.csv");
        read.map_or_else(|wrong| wrong.to_string(), |_| "good".to_owned())
    }

    #[test]
    fn a_row_out_of_its_place_is_told_from_another() {
        let good = ["0,a", "0,b", "0.5,a", "0.5,b", "1,a", "1,b"];
        assert_eq!(read_pair(&good), "good");
        let table: [(&[&str], &str); 12] = [
            (
                &["0,a", "0,b", "0.5,b", "1,a", "1,b"],
                "line 4: a row is missing: body `a` of t = 0.5 s is due, and `b` of t = 0.5 s follows",
            ),
            (
                &["0,a", "0,b", "0.5,a", "1,a", "1,b"],
                "line 5: a row is missing: body `b` of t = 0.5 s is due, and `a` of t = 1 s follows",
            ),
            (
                &["0,a", "0,b", "1,a", "1,b"],
                "line 4: a row is missing: body `a` of t = 0.5 s is due",
            ),
            (&["0,b"], "line 2: a row is missing: body `a` of t = 0 s"),
            (
                &["0,a", "0,a", "0,b"],
                "line 3: body `a` of t = 0 s comes a second time, where `b` of t = 0 s is due",
            ),
            (
                &["0,a", "0,b", "0,a", "0,b", "0.5,a"],
                "line 4: time 0 s where 0.5 s is due: body `a` of t = 0 s comes a second time",
            ),
            (
                &["0,b", "0,a", "0.5,b", "0.5,a"],
                "line 2: out of order: body `b` of t = 0 s comes before `a` of t = 0 s",
            ),
            (
                &["0,a", "0.5,a", "1,a", "0,b", "0.5,b", "1,b"],
                "line 3: out of order: body `a` of t = 0.5 s comes before `b` of t = 0 s",
            ),
            (
                &["0,a", "0,b", "0.25,a"],
                "line 4: time 0.25 s where 0.5 s is due: off the scene's grid, a sample every 0.5 s",
            ),
            (
                &["0,a", "0,b", "1e300,a"],
                "line 4: time 1e300 s where 0.5 s is due: off the scene's grid",
            ),
            (
                &["0,a", "0,b", "0.5,a", "0.5,b", "1,a", "1,b", "1.5,a"],
                "line 8: goes on past the end, t = 1 s",
            ),
            (
                &["0,a", "0,b", "0.5,a"],
                "line 5: ends in the middle of sample 2 of 3, where body `b` of t = 0.5 s is due",
            ),
        ];
        for (rows, said) in table {
            let complaint = read_pair(rows);
            assert!(complaint.contains(said), "{rows:?}: {complaint}");
        }
    }

    #[test]
    fn an_unknown_body_names_a_few_known_ones() {
        let said = read_pair(&["0,a\u{1b}[31m"]);
        assert!(
            said.ends_with(
                "line 2: body `a\\u{1b}[31m` where `a` of t = 0 s is due: no body is called so; \
                 the scene has `a`, `b`"
            ),
            "{said}"
        );
        let body = |i| {
            format!(
                "[[bodies]]\nname='ball {i}'\nmass=1\nradius=1\nposition=[0,0,0]\nvelocity=[0,0,0]\n"
            )
        };
        let many: String = (0..16).map(body).collect();
        let scene = crate::scene::parse(
            &format!("name='x'\nduration=1\nsample_every=1\n{many}"),
            "x",
        )
        .unwrap();
        let rows = "time,body,x,y,z,vx,vy,vz\n0,cue,0,0,0,0,0,0\n";
        let wrong = read_trajectory("x", &scene, rows.as_bytes(), "t.csv").unwrap_err();
        let said = wrong.to_string();
        assert!(
            said.ends_with("`ball 7` … (16 in all)") && !said.contains("`ball 8`"),
            "{said}"
        );
    }

    #[test]
    fn what_is_no_text_or_no_table_is_told() {
        let header = b"time,body,x,y,z,vx,vy,vz\n".as_slice();
        let latin = [header, b"0,B\xe4r,0,0,0,0,0,0\n"].concat();
        let table: [(&[u8], &str); 4] = [
            (
                b"",
                "line 1: nothing is there; the header must be `time,body,",
            ),
            (b"\xff\xfet\0", "line 1: not UTF-8 in column 1"),
            (&latin, "line 2: not UTF-8 in column 2"),
            (
                b"t,b\n",
                "line 1: the header must be `time,body,x,y,z,vx,vy,vz`, not `t,b`",
            ),
        ];
        for (bytes, said) in table {
            let wrong = read_trajectory("x", &scene(), bytes, "t.csv").unwrap_err();
            let complaint = wrong.to_string();
            assert!(complaint.contains(said), "{complaint}");
        }
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
