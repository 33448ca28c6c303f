//! Numbers for people.

pub(super) use crate::error::code;
use crate::error::harmless;

/// Three significant digits, plain between 0.001 and a million, powers of ten outside.
///
/// ```
/// use carom::report::engineering;
/// assert_eq!(engineering(1234.5), "1234");
/// assert_eq!(engineering(0.0123456), "0.0123");
/// assert_eq!(engineering(-3.2e-14), "-3.2e-14");
/// assert_eq!(engineering(99.98), "100");
/// assert_eq!(engineering(0.0), "0");
/// ```
#[must_use]
pub fn engineering(value: f64) -> String {
    let size = value.abs();
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
        return "not finite".to_owned();
    }
    if !(1e-3..1e6).contains(&size) {
        return format!("{value:.1e}");
    }
    // The exponent after rounding: 99.98 is 100, not 100.0.
    let rounded = format!("{value:.2e}");
    let exponent = rounded
        .rsplit('e')
        .next()
        .and_then(|e| e.parse::<i32>().ok());
    let decimals = usize::try_from(2 - exponent.unwrap_or(0)).unwrap_or(0);
    format!("{value:.decimals$}")
}

/// A count from 1 on that is known to no more than two significant digits.
pub(super) fn about(count: f64) -> String {
    let unit = 10_f64.powf((count.log10().floor() - 1.0).max(0.0));
    format!("{:.0}", (count / unit).round() * unit)
}

/// A share as a percentage; tiny shares as powers of ten.
///
/// ```
/// use carom::report::percent;
/// assert_eq!(percent(0.1234), "12.3 %");
/// assert_eq!(percent(0.0), "0 %");
/// assert_eq!(percent(2e-15), "2.0e-13 %");
/// ```
#[must_use]
pub fn percent(share: f64) -> String {
    format!("{} %", engineering(100.0 * share))
}

/// A share that was chosen round, as a percentage without needless zeros.
pub(super) fn whole_percent(share: f64) -> String {
    format!("{} %", 100.0 * share)
}

/// Rows of cells for a terminal, each column as wide as its widest cell.
pub(super) fn aligned(rows: &[Vec<String>]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        let cells = rows.iter().filter_map(|row| row.get(column));
        cells
            .map(|cell| harmless(cell).chars().count())
            .max()
            .unwrap_or(0)
    };
    let widths: Vec<_> = (0..columns).map(width).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths);
        let cells = cells.map(|(cell, width)| (harmless(cell), width));
        let padded: Vec<_> = cells
            .map(|(cell, width)| format!("{cell:width$}"))
            .collect();
        padded.join("  ").trim_end().to_owned()
    };
    rows.iter().map(line).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counts_have_two_digits() {
        let told = [4.4, 12.6, 1849.0, 9960.0].map(about);
        assert_eq!(told, ["4", "13", "1800", "10000"]);
    }

    #[test]
    fn columns_are_as_wide_as_their_widest_cell() {
        let rows = [
            vec!["a".to_owned(), "µµµ".into()],
            vec!["bb".into(), "c".into()],
        ];
        assert_eq!(aligned(&rows), "a   µµµ\nbb  c");
        assert_eq!(aligned(&[]), "");
    }
}
