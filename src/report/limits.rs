//! What kind of error an engine makes, in words.

use super::case_page::with_unit;
use crate::compare::{Estimate, Limit, Remainder};

/// What is left of an error as the step goes to 0, as a sentence.
pub(super) fn sentence(limit: &Limit, unit: &str) -> String {
    let finest = with_unit(limit.finest, unit);
    let told = match limit.kind {
        Remainder::Model => format!(
            "{} of it stay as the step goes to 0",
            limit.stays.map_or(finest, |stays| estimate(&stays, unit))
        ),
        Remainder::Discretisation => {
            format!("it shrinks with the step, to {finest} at the finest")
        }
        Remainder::Rounding => format!(
            "at the finest step it is {finest}, below the floor of the arithmetic at {}",
            with_unit(limit.floor, unit)
        ),
        Remainder::Unsettled => format!(
            "neither settled nor shrinking steadily within the budget, {finest} at the finest step"
        ),
    };
    format!("The error is *{}*: {told}.", limit.kind.word())
}

/// An estimate with its interval and the unit.
pub(super) fn estimate(found: &Estimate, unit: &str) -> String {
    let [low, high] = [found.low, found.high].map(super::engineering);
    format!("{} ({low} to {high})", with_unit(found.value, unit))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_kind_has_its_sentence() {
        let limit = |kind, stays| Limit {
            kind,
            stays,
            slope: Some(1.0),
            finest: 0.25,
            floor: 1e-9,
        };
        let stays = Estimate {
            value: 0.2,
            low: 0.15,
            high: 0.3,
        };
        let says = |kind| sentence(&limit(kind, Some(stays)), "mm");
        assert_eq!(
            says(Remainder::Model),
            "The error is *model*: 0.200 mm (0.150 to 0.300) of it stay as the step goes to 0."
        );
        assert_eq!(
            says(Remainder::Discretisation),
            "The error is *discretisation*: it shrinks with the step, to 0.250 mm at the finest."
        );
        assert!(
            says(Remainder::Rounding).contains("*rounding*: at the finest step it is 0.250 mm")
        );
        assert!(says(Remainder::Unsettled).contains("*unsettled*: neither settled"));
    }
}
