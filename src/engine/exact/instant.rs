//! One instant at which several bodies touch: impacts one after the other, to the limit.
//!
//! Strict approach makes an impact; contacts come before cushions, the lower body first; this is
//! repeated while anything approaches. With restitutions below 1 it may never end: the speeds of
//! approach then fall as a geometric series, whose limit is the answer.

/// A series has no end where its last round is weaker than this share of its strongest impact:
/// one that ends does so while it is strong, but for chance.
const WEAK: f64 = 1e-6;

/// So many impacts at least make a series.
const LEAST: usize = 4;

/// Whether impacts of these speeds of approach, in their order, are a series without end.
pub(super) fn is_endless(approaches: impl Iterator<Item = f64>) -> bool {
    let (mut count, mut strongest, mut last) = (0, 0.0_f64, [0.0_f64; 2]);
    for approach in approaches {
        count += 1;
        strongest = strongest.max(approach);
        last = [last[1], approach];
    }
    count >= LEAST && last[0].max(last[1]) < WEAK * strongest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_series_that_falls_away_has_no_end_and_a_short_one_has() {
        let halving = |count: i32| (0..count).map(|power| 0.5_f64.powi(power));
        assert!(is_endless(halving(30)));
        assert!(!is_endless(halving(10)));
        assert!(!is_endless([1.0, 1e-9].into_iter()));
    }
}
