//! The colour of each engine, the same in every picture of a study.

use crate::report::chart::LineStyle;
use crate::study::cost::EngineFamily;

/// How an engine is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Look {
    /// Index of its colour.
    pub(super) color: usize,
    /// How its line is broken.
    pub(super) line: LineStyle,
}

/// Colours of Rapier worlds: warm ones.
const RAPIER: [usize; 3] = [1, 4, 3];
/// The colour of engines without steps.
const EXACT: usize = 6;
/// The colour of the first hand-written solver.
const FIRST: usize = 0;
/// Colours of the other hand-written solvers, from the last rung of the ladder down.
const RUNGS: [usize; 3] = [2, 5, 7];

/// The colour that stands for all engines of a family.
pub(super) fn family_color(family: EngineFamily) -> usize {
    match family {
        EngineFamily::Impulse => FIRST,
        EngineFamily::Rapier => RAPIER[0],
        EngineFamily::Exact => EXACT,
    }
}

/// The looks of engines of these families, in their order.
///
/// Neighbours of one family that share a colour are solid, dashed and dotted in turn; Rapier
/// worlds, which often coincide, always are.
pub(super) fn looks(families: &[EngineFamily]) -> Vec<Look> {
    let before = |place: usize, family| {
        let all = families[..place].iter();
        all.filter(|other| **other == family).count()
    };
    let after = |place: usize, family| {
        let all = families[place + 1..].iter();
        all.filter(|other| **other == family).count()
    };
    let look = |(place, family): (usize, &EngineFamily)| match family {
        EngineFamily::Rapier => Look {
            color: RAPIER[before(place, *family) % RAPIER.len()],
            line: LineStyle::of_voice(before(place, *family) % 2),
        },
        EngineFamily::Exact => Look {
            color: EXACT,
            line: LineStyle::Solid,
        },
        EngineFamily::Impulse if before(place, *family) == 0 => Look {
            color: FIRST,
            line: LineStyle::Solid,
        },
        EngineFamily::Impulse => {
            let rung = after(place, *family);
            Look {
                color: RUNGS[rung % RUNGS.len()],
                line: LineStyle::of_voice(rung / RUNGS.len()),
            }
        }
    };
    families.iter().enumerate().map(look).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn engines_of_a_usual_study_look_different() {
        use EngineFamily::{Exact, Impulse, Rapier};
        let families = [
            Impulse, Rapier, Rapier, Rapier, Exact, Impulse, Impulse, Impulse, Impulse, Impulse,
            Impulse,
        ];
        let looks = looks(&families);
        for (place, look) in looks.iter().enumerate() {
            assert!(!looks[..place].contains(look), "{place}: {look:?}");
        }
        assert_eq!(looks[0].color, FIRST);
        assert_eq!([1, 2, 3].map(|place| looks[place].color), RAPIER);
    }
}
