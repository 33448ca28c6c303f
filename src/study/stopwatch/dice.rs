//! Seeded random numbers, the same on every platform.

use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};

/// Draws places and orders.
pub(in crate::study) struct Dice(Pcg64);

impl Dice {
    pub(in crate::study) fn new(seed: u64) -> Self {
        Self(Pcg64::seed_from_u64(seed))
    }

    /// Below `count`, which is small: the bias is below 1e-15.
    pub(in crate::study) fn below(&mut self, count: usize) -> usize {
        let found = self.0.next_u64() % (count.max(1) as u64);
        usize::try_from(found).unwrap_or(0)
    }

    /// Puts the items into random order (Fisher and Yates).
    pub(in crate::study) fn shuffle<T>(&mut self, items: &mut [T]) {
        for last in (1..items.len()).rev() {
            items.swap(last, self.below(last + 1));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shuffling_keeps_every_item() {
        let mut items: Vec<usize> = (0..50).collect();
        Dice::new(3).shuffle(&mut items);
        assert_ne!(items, (0..50).collect::<Vec<_>>());
        items.sort_unstable();
        assert_eq!(items, (0..50).collect::<Vec<_>>());
    }
}
