//! A limit as a row of `limits.csv`, written by a study and read back by a report.

use std::io::Read;

use serde::{Deserialize, Serialize};

use super::EngineLimit;
use crate::compare::{Estimate, Limit, Remainder};
use crate::error::{Error, Result};

/// A row of `limits.csv`; the names of the fields are the header. Lengths are in the scene's unit.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LimitRow {
    /// Name of the scene.
    pub scene: String,
    /// The engine.
    pub engine: String,
    /// What is left; blank with too few steps or phases, and then all that follows is.
    pub kind: Option<Remainder>,
    /// The position error that stays.
    pub limit: Option<f64>,
    /// Lower end of its 95 % interval.
    pub limit_low: Option<f64>,
    /// Upper end.
    pub limit_high: Option<f64>,
    /// The slope at the finest steps.
    pub slope: Option<f64>,
    /// The error at the finest step.
    pub finest: Option<f64>,
    /// Below this, an error is rounding.
    pub floor: Option<f64>,
}

impl LimitRow {
    /// The row of an engine on a scene.
    #[must_use]
    pub fn new(scene: &str, row: &EngineLimit) -> Self {
        let limit = row.limit;
        let stays = limit.and_then(|limit| limit.stays);
        Self {
            scene: scene.to_owned(),
            engine: row.engine.clone(),
            kind: limit.map(|limit| limit.kind),
            limit: stays.map(|stays| stays.value),
            limit_low: stays.map(|stays| stays.low),
            limit_high: stays.map(|stays| stays.high),
            slope: limit.and_then(|limit| limit.slope),
            finest: limit.map(|limit| limit.finest),
            floor: limit.map(|limit| limit.floor),
        }
    }

    /// The engine with its limit; what is wrong with the row if it has a kind without its error.
    fn limit(&self) -> std::result::Result<EngineLimit, String> {
        let stays = match (self.limit, self.limit_low, self.limit_high) {
            (Some(value), Some(low), Some(high)) => Some(Estimate { value, low, high }),
            _ => None,
        };
        let limit = match (self.kind, self.finest, self.floor) {
            (None, _, _) => None,
            (Some(kind), Some(finest), Some(floor)) => Some(Limit {
                kind,
                stays,
                slope: self.slope,
                finest,
                floor,
            }),
            (Some(kind), _, _) => {
                let word = kind.word();
                return Err(format!("`{word}` needs `finest` and `floor`"));
            }
        };
        Ok(EngineLimit {
            engine: self.engine.clone(),
            limit,
        })
    }
}

/// The limits of one scene from a stored `limits.csv`; `file` is its name in messages.
///
/// # Errors
/// [`Error::Table`] for what is no such table, with the line.
pub fn read_limits(input: impl Read, file: &str, scene: &str) -> Result<Vec<EngineLimit>> {
    let mut reader = csv::Reader::from_reader(input);
    let mut limits = Vec::new();
    let complaint = |line: u64, message: String| Error::Table {
        file: file.to_owned(),
        line,
        message,
    };
    for (place, row) in reader.deserialize::<LimitRow>().enumerate() {
        let line = 2 + place as u64;
        let row = row.map_err(|wrong| {
            let line = wrong.position().map_or(line, csv::Position::line);
            complaint(line, wrong.to_string())
        })?;
        if row.scene == scene {
            limits.push(row.limit().map_err(|wrong| complaint(line, wrong))?);
        }
    }
    Ok(limits)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn limits() -> Vec<EngineLimit> {
        let limit = Limit {
            kind: Remainder::Model,
            stays: Some(Estimate {
                value: 0.1,
                low: 0.09,
                high: 0.11,
            }),
            slope: Some(-1e-3),
            finest: 0.1 + 1e-17,
            floor: 1e-13,
        };
        let rounding = Limit {
            kind: Remainder::Rounding,
            stays: None,
            slope: None,
            ..limit
        };
        let named = |engine: &str, limit| EngineLimit {
            engine: engine.to_owned(),
            limit,
        };
        vec![
            named("a", Some(limit)),
            named("b", Some(rounding)),
            named("c", None),
        ]
    }

    #[test]
    fn what_is_written_is_read_back() {
        let mut table = csv::Writer::from_writer(Vec::new());
        for scene in ["one", "two"] {
            for row in limits() {
                table.serialize(LimitRow::new(scene, &row)).unwrap();
            }
        }
        let bytes = table.into_inner().unwrap();
        assert_eq!(read_limits(&bytes[..], "x", "two").unwrap(), limits());
        assert_eq!(read_limits(&bytes[..], "x", "three").unwrap(), []);
    }

    #[test]
    fn a_wrong_row_is_named_with_its_line() {
        let header = "scene,engine,kind,limit,limit_low,limit_high,slope,finest,floor\n";
        let says = |row: &str| {
            let text = format!("{header}one,a,,,,,,,\n{row}\n");
            read_limits(text.as_bytes(), "limits.csv", "one")
                .unwrap_err()
                .to_string()
        };
        assert_eq!(
            says("one,b,model,,,,,,"),
            "limits.csv, line 3: `model` needs `finest` and `floor`"
        );
        assert!(says("one,b,guess,,,,,1,1").starts_with("limits.csv, line 3: "));
    }
}
