//! Points that another build has measured.

use std::io;
use std::path::{Path, PathBuf};

use super::{BodiesOptions, BodiesPoint};
use crate::engine::build;
use crate::error::{Error, Result};
use crate::input::{self, Rows, STORED_BYTES_MAX};

/// Reads a `bodies.csv`.
///
/// # Errors
/// [`Error::Read`] and [`Error::Table`] with the file, and the line where there is one.
fn read_bodies(file: &Path) -> Result<Vec<BodiesPoint>> {
    let (rows, row_end) = Rows::new(input::open(file, STORED_BYTES_MAX)?);
    let mut table = csv::Reader::from_reader(rows);
    // What cannot be read of the header would else pass for the end of the file.
    table.headers().map_err(|wrong| complaint(file, &wrong))?;
    let mut points: Vec<BodiesPoint> = Vec::new();
    for point in table.deserialize() {
        points.push(point.map_err(|wrong| complaint(file, &wrong))?);
        row_end.tell();
    }
    if points.is_empty() {
        return Err(Error::Table {
            file: file.display().to_string(),
            line: 1,
            message: "holds no point; give a bodies.csv of `carom cost --bodies`".to_owned(),
        });
    }
    Ok(points)
}

fn complaint(file: &Path, wrong: &csv::Error) -> Error {
    if let csv::ErrorKind::Io(wrong) = wrong.kind() {
        return Error::read(file, io::Error::new(wrong.kind(), wrong.to_string()));
    }
    Error::Table {
        file: file.display().to_string(),
        line: wrong.position().map_or(1, csv::Position::line),
        message: match wrong.kind() {
            csv::ErrorKind::Deserialize { err, .. } => err.to_string(),
            _ => wrong.to_string(),
        },
    }
}

/// The first thing that keeps a point from standing beside others, and what its file says of it.
fn obstacle(
    point: &BodiesPoint,
    options: &BodiesOptions,
    builds: &[String],
) -> Option<(&'static str, String)> {
    if builds.contains(&point.build) {
        return Some(("build", format!("`{}` too", point.build)));
    }
    if let Some(dt) = point.dt.filter(|dt| *dt != options.dt) {
        return Some(("dt", format!("{dt} s")));
    }
    if point.filling != options.filling {
        return Some(("filling", point.filling.to_string()));
    }
    if point.walls != options.walls {
        return Some(("walls", format!("`{:?}`", point.walls).to_lowercase()));
    }
    (point.seed != options.timing.seed).then(|| ("seed", point.seed.to_string()))
}

/// Reads the points of other builds, each file of builds of its own, measured in the same way.
///
/// # Errors
/// [`Error::Read`] and [`Error::Table`] with the file; [`Error::Join`] if they were measured otherwise, or are of a build that is
/// here already.
pub fn joined(files: &[PathBuf], options: &BodiesOptions) -> Result<Vec<BodiesPoint>> {
    let mut builds = vec![build()];
    let mut all = Vec::new();
    for file in files {
        let points = read_bodies(file)?;
        let wrong = points
            .iter()
            .find_map(|point| obstacle(point, options, &builds));
        if let Some((what, found)) = wrong {
            return Err(Error::Join {
                path: file.clone(),
                what,
                found,
            });
        }
        builds.extend(points.iter().map(|point| point.build.clone()));
        all.extend(points);
    }
    Ok(all)
}

#[cfg(test)]
mod tests {
    use super::super::Walls;
    use super::super::testing::study;
    use super::*;

    #[test]
    fn only_what_was_measured_in_the_same_way_is_joined() {
        let study = study(&[("lecture", 2.0, 1e-3)]);
        let (point, options) = (&study.points[0], &study.options);
        let wrong = |change: &dyn Fn(&mut BodiesPoint)| {
            let mut point = point.clone();
            change(&mut point);
            obstacle(&point, options, &["parallel".to_owned()]).map(|(what, _)| what)
        };
        assert_eq!(wrong(&|_| ()), None);
        assert_eq!(wrong(&|point| point.dt = None), None);
        assert_eq!(
            wrong(&|point| point.build = "parallel".into()),
            Some("build")
        );
        assert_eq!(wrong(&|point| point.dt = Some(0.02)), Some("dt"));
        assert_eq!(wrong(&|point| point.filling = 0.2), Some("filling"));
        assert_eq!(wrong(&|point| point.walls = Walls::Open), Some("walls"));
        assert_eq!(wrong(&|point| point.seed = 2), Some("seed"));
    }

    /// What was written is read; what is no such table is told with its line.
    #[test]
    fn a_table_is_read_as_it_was_written() {
        let mut study = study(&[("lecture", 2.0, 1e-3)]);
        study.points[2].dt = None;
        study.points[2].step_us = None;
        let scratch = tempfile::tempdir().unwrap();
        let file = scratch.path().join("bodies.csv");
        let mut table = csv::Writer::from_path(&file).unwrap();
        for point in &study.points {
            table.serialize(point).unwrap();
        }
        table.flush().unwrap();
        assert_eq!(read_bodies(&file).unwrap(), study.points);
        let text = std::fs::read_to_string(&file).unwrap();
        std::fs::write(&file, text.replacen(",100,", ",many,", 1)).unwrap();
        let said = read_bodies(&file).unwrap_err().to_string();
        assert!(said.contains("bodies.csv, line 5"), "{said}");
        std::fs::write(&file, text.lines().next().unwrap()).unwrap();
        assert!(
            read_bodies(&file)
                .unwrap_err()
                .to_string()
                .contains("no point")
        );
    }
}
