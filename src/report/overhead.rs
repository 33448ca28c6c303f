//! What a step costs before the first body, for each body and for each pair, in cells of a table.

use super::{engineering, percent};
use crate::study::Overhead;

/// What stands above [`overhead_cells`].
pub(super) const OVERHEAD_HEADER: [&str; 5] = [
    "fixed, ns a step",
    "each body, ns",
    "each pair, ns",
    "the fit leaves, rms",
    "at most",
];

/// The parts of a step's cost, and what their fit leaves; dashes where there is no fit.
pub(super) fn overhead_cells(overhead: Option<&Overhead>) -> [String; 5] {
    let nanoseconds = |us: f64| engineering(1e3 * us);
    let Some(overhead) = overhead else {
        return [(); 5].map(|()| "–".to_owned());
    };
    [
        nanoseconds(overhead.fixed_us),
        nanoseconds(overhead.per_body_us),
        overhead.per_pair_us.map_or("–".to_owned(), nanoseconds),
        percent(overhead.left_rms),
        percent(overhead.left_max),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_parts_are_told_in_nanoseconds() {
        let overhead = Overhead {
            fixed_us: 5.0,
            per_body_us: 0.25,
            per_pair_us: Some(0.0),
            left_rms: 0.1,
            left_max: 0.2,
        };
        let cells = overhead_cells(Some(&overhead));
        assert_eq!(cells, ["5000", "250", "0", "10.0 %", "20.0 %"]);
        assert_eq!(overhead_cells(None)[0], "–");
    }
}
