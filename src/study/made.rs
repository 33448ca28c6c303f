//! When, with what and where a study was made.

use std::collections::BTreeMap;
use std::time::SystemTime;

use serde::{Deserialize, Serialize};

use super::Machine;

/// What every stored study says of itself.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Made {
    /// The day it was begun, UTC, as 2026-01-31.
    pub date: String,
    /// Versions of carom and Rapier that were studied.
    pub versions: BTreeMap<String, String>,
    /// The machine that times hold for.
    pub machine: Machine,
    /// Whether carom was built for speed; otherwise times mean nothing.
    pub optimised: bool,
}

impl Made {
    /// Today, on this machine, with this build.
    #[must_use]
    pub fn now() -> Self {
        let versions = crate::engine::versions().into_iter();
        Self {
            date: day(SystemTime::now()),
            versions: versions
                .map(|(name, version)| (name.to_owned(), version.to_owned()))
                .collect(),
            machine: Machine::this(),
            optimised: !cfg!(debug_assertions),
        }
    }
}

/// The day of an instant, UTC, as ISO 8601 has it; a clock set before 1970 counts as 1970.
fn day(now: SystemTime) -> String {
    let now = now.max(SystemTime::UNIX_EPOCH);
    let instant = humantime::format_rfc3339_seconds(now).to_string();
    let (day, _) = instant.split_once('T').unwrap_or((&instant, ""));
    day.to_owned()
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::*;

    #[test]
    fn days_are_those_of_the_calendar() {
        let at = |seconds| day(SystemTime::UNIX_EPOCH + Duration::from_secs(seconds));
        assert_eq!(at(0), "1970-01-01");
        // `date -u -d 2024-02-29T23:59:59Z +%s`
        assert_eq!(at(1_709_251_199), "2024-02-29");
        assert_eq!(at(1_709_251_200), "2024-03-01");
        let before = SystemTime::UNIX_EPOCH - Duration::from_secs(1);
        assert_eq!(day(before), "1970-01-01");
    }
}
