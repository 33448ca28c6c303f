//! Which spheres overlap, without looking at every pair.

use std::ops::ControlFlow;

use nalgebra::Vector3;

use super::bounds::OVERLAPS_MAX;

/// Two overlapping spheres, `a < b`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overlap {
    /// Index of the first sphere.
    pub a: usize,
    /// Index of the second sphere.
    pub b: usize,
    /// `r_a + r_b - |x_a - x_b|`, above 0.
    pub depth: f64,
}

/// What a look at many spheres has found.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Survey {
    /// The deepest overlap, the last found of equals.
    pub deepest: Option<Overlap>,
    /// How many pairs overlap.
    pub pairs: u64,
    /// Whether every pair was looked at that can overlap.
    pub all: bool,
}

/// Counts the overlapping pairs and keeps the deepest, in memory that does not grow with them:
/// coincident spheres overlap all with all. Looks at no more than so many pairs.
#[must_use]
pub fn survey(spheres: &[(Vector3<f64>, f64)], looks_max: u64) -> Survey {
    let (mut deepest, mut pairs, mut looks) = (None::<Overlap>, 0, 0);
    let ended = for_each_near(spheres, |a, b| {
        if looks == looks_max {
            return ControlFlow::Break(());
        }
        looks += 1;
        if let Some(found) = overlap(spheres, a, b) {
            pairs += 1;
            if deepest.is_none_or(|known| found.depth.total_cmp(&known.depth).is_ge()) {
                deepest = Some(found);
            }
        }
        ControlFlow::Continue(())
    });
    Survey {
        deepest,
        pairs,
        all: ended.is_continue(),
    }
}

/// Calls `visit` for every overlapping pair, in no particular order.
///
/// Sort and sweep along the axis on which the spheres spread widest: spheres whose intervals
/// on it are disjoint cannot overlap. Pairs with a non-finite centre are passed over.
pub fn for_each_overlap(spheres: &[(Vector3<f64>, f64)], mut visit: impl FnMut(Overlap)) {
    let _ = for_each_near(spheres, |a, b| {
        if let Some(found) = overlap(spheres, a, b) {
            visit(found);
        }
        ControlFlow::Continue(())
    });
}

/// The overlap of two spheres, if they do.
fn overlap(spheres: &[(Vector3<f64>, f64)], i: usize, j: usize) -> Option<Overlap> {
    let depth = spheres[i].1 + spheres[j].1 - (spheres[i].0 - spheres[j].0).norm();
    (depth > 0.0).then(|| Overlap {
        a: i.min(j),
        b: i.max(j),
        depth,
    })
}

/// Calls `visit` for every pair of spheres whose intervals on the axis overlap, until it breaks.
fn for_each_near(
    spheres: &[(Vector3<f64>, f64)],
    mut visit: impl FnMut(usize, usize) -> ControlFlow<()>,
) -> ControlFlow<()> {
    let axis = widest_axis(spheres);
    let mut order: Vec<usize> = (0..spheres.len()).collect();
    let low = |i: usize| spheres[i].0[axis] - spheres[i].1;
    order.sort_by(|&i, &j| low(i).total_cmp(&low(j)));
    for (place, &i) in order.iter().enumerate() {
        let high = spheres[i].0[axis] + spheres[i].1;
        for &j in order[place + 1..].iter().take_while(|&&j| low(j) < high) {
            visit(i, j)?;
        }
    }
    ControlFlow::Continue(())
}

/// Every overlapping pair; of more than four million, so many of them.
#[must_use]
pub fn overlaps(spheres: &[(Vector3<f64>, f64)]) -> Vec<Overlap> {
    let mut found = Vec::new();
    let _ = for_each_near(spheres, |a, b| {
        found.extend(overlap(spheres, a, b));
        if found.len() < OVERLAPS_MAX {
            ControlFlow::Continue(())
        } else {
            ControlFlow::Break(())
        }
    });
    found
}

fn widest_axis(spheres: &[(Vector3<f64>, f64)]) -> usize {
    let spread = |axis: usize| {
        let (low, high) = spheres
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), s| {
                (low.min(s.0[axis]), high.max(s.0[axis]))
            });
        high - low
    };
    (0..3)
        .max_by(|&a, &b| spread(a).total_cmp(&spread(b)))
        .unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A hundred coincident spheres, one of them larger, and one apart.
    #[test]
    fn a_survey_counts_what_a_list_would_hold() {
        let mut spheres = vec![(Vector3::new(1.0, 2.0, 3.0), 1.0); 100];
        spheres[7].1 = 1.5;
        spheres.push((Vector3::new(9.0, 0.0, 0.0), 1.0));
        let listed = overlaps(&spheres);
        let found = survey(&spheres, u64::MAX);
        assert!(found.all);
        assert_eq!((found.pairs, listed.len()), (4950, 4950));
        let deepest = found.deepest.unwrap();
        assert_eq!(deepest.depth, 2.5);
        assert!(deepest.a == 7 || deepest.b == 7);
        let some = survey(&spheres, 1000);
        assert_eq!((some.pairs, some.all), (1000, false));
        assert_eq!(survey(&spheres[..1], 0).deepest, None);
    }
}
