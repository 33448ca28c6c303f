//! Which of several simultaneous events comes first.

use crate::recording::EventKind;

/// The order in which simultaneous events are taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum TieOrder {
    /// The model's rule: contacts, cushions, rests; lower body first; walls -x +x -z +z -y +y.
    #[default]
    Rule,
    /// The rule backwards.
    Backwards,
    /// An order drawn by lot, from a seed.
    Drawn(u64),
}

/// Rank of what is no event of the model, such as a change of cell: after all others.
pub(super) const INTERNAL: u64 = u64::MAX;

/// Bits of a body's index in a rank; scenes hold fewer bodies than that by far.
const BODY_BITS: u32 = 30;

impl TieOrder {
    /// Place of an event among simultaneous ones; the lowest goes first.
    #[inline]
    pub(super) fn rank(self, kind: EventKind) -> u64 {
        let packed = |class: u64, first: usize, second: usize| {
            (class << (2 * BODY_BITS)) | ((first as u64) << BODY_BITS) | second as u64
        };
        let rank = match kind {
            EventKind::Contact { a, b } => packed(0, a, b),
            EventKind::Cushion { body, wall } => packed(1, body, wall as usize),
            EventKind::Rest { body } => packed(2, body, 0),
        };
        match self {
            Self::Rule => rank,
            Self::Backwards => packed(3, 0, 0) - rank,
            Self::Drawn(seed) => mixed(rank ^ mixed(seed)) >> 1,
        }
    }
}

/// A well mixed number, one to one. Source: Steele, Lea, Flood 2014, `splitmix64`.
pub(super) fn mixed(number: u64) -> u64 {
    let x = number.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::Wall;

    #[test]
    fn contacts_then_cushions_then_rests_and_the_lower_body_first() {
        let sorted = [
            EventKind::Contact { a: 0, b: 7 },
            EventKind::Contact { a: 1, b: 2 },
            EventKind::Cushion {
                body: 0,
                wall: Wall::PlusX,
            },
            EventKind::Cushion {
                body: 0,
                wall: Wall::MinusZ,
            },
            EventKind::Cushion {
                body: 1,
                wall: Wall::MinusX,
            },
            EventKind::Rest { body: 0 },
        ];
        let rising = |order: TieOrder| sorted.map(|kind| order.rank(kind)).is_sorted();
        assert!(rising(TieOrder::Rule));
        assert!(!rising(TieOrder::Backwards));
        let mut backwards = sorted.map(|kind| TieOrder::Backwards.rank(kind));
        backwards.reverse();
        assert!(backwards.is_sorted());
        assert!(
            sorted
                .iter()
                .all(|kind| TieOrder::Drawn(1).rank(*kind) < INTERNAL)
        );
    }
}
