//! Coordinate search: one setting changed at a time, the best kept, round after round.

use crate::error::Result;

/// The candidates beside one: all values of one thing, that of the one given included or not.
pub type Values<C> = Box<dyn Fn(&C) -> Vec<C>>;

/// One thing that can be changed, and the candidates that differ from another in it alone.
pub struct Coordinate<C> {
    /// Its name.
    pub name: &'static str,
    /// The candidates.
    pub values: Values<C>,
}

/// A candidate that was measured.
#[derive(Debug, Clone)]
pub struct Trial<C, M> {
    /// What was changed; none for the start.
    pub coordinate: Option<&'static str>,
    /// The candidate.
    pub candidate: C,
    /// What was measured of it.
    pub measured: M,
    /// What is to be small.
    pub objective: f64,
    /// Whether the search went on from it.
    pub accepted: bool,
}

/// A search that has ended.
#[derive(Debug, Clone)]
pub struct Search<C, M> {
    /// Every candidate, in the order measured; none twice.
    pub trials: Vec<Trial<C, M>>,
    /// Place of the best.
    pub best: usize,
    /// Whether it ended because no change of one setting helps, not because its budget was spent.
    pub is_settled: bool,
}

impl<C, M> Search<C, M> {
    /// Where it began.
    #[must_use]
    pub fn start(&self) -> &Trial<C, M> {
        &self.trials[0]
    }

    /// The best of all trials.
    #[must_use]
    pub fn found(&self) -> &Trial<C, M> {
        &self.trials[self.best]
    }
}

/// Searches from `start` with at most so many candidates, the start included.
///
/// The coordinates come in turn. Of one, every value not yet tried is measured, and the search
/// goes on from the best if that is better than all before, the first of equals. It ends after
/// a round in which nothing helped. `measure` gives what it measured and the objective, for
/// candidates that do not depend on each other.
///
/// # Errors
/// Those of `measure`.
pub fn search<C: Clone + PartialEq, M>(
    start: C,
    candidates_max: usize,
    coordinates: &[Coordinate<C>],
    mut measure: impl FnMut(&[C]) -> Result<Vec<(M, f64)>>,
) -> Result<Search<C, M>> {
    let mut trials: Vec<Trial<C, M>> = Vec::new();
    let mut best = 0;
    let mut is_settled = false;
    let first = measure(std::slice::from_ref(&start))?;
    keep(&mut trials, None, vec![start], first);
    trials[0].accepted = true;
    while !is_settled {
        is_settled = true;
        for coordinate in coordinates {
            let mut batch: Vec<C> = Vec::new();
            for value in (coordinate.values)(&trials[best].candidate) {
                let is_tried = trials.iter().any(|trial| trial.candidate == value);
                if !is_tried && !batch.contains(&value) {
                    batch.push(value);
                }
            }
            let left = candidates_max.saturating_sub(trials.len());
            let is_cut = batch.len() > left;
            batch.truncate(left);
            let measured = measure(&batch)?;
            keep(&mut trials, Some(coordinate.name), batch, measured);
            let smaller = |best: usize, place: usize| {
                if trials[place].objective < trials[best].objective {
                    place
                } else {
                    best
                }
            };
            let better = (0..trials.len()).fold(best, smaller);
            if better != best {
                best = better;
                trials[best].accepted = true;
                is_settled = false;
            }
            if is_cut {
                return Ok(Search {
                    trials,
                    best,
                    is_settled: false,
                });
            }
        }
    }
    Ok(Search {
        trials,
        best,
        is_settled,
    })
}

fn keep<C, M>(
    trials: &mut Vec<Trial<C, M>>,
    coordinate: Option<&'static str>,
    candidates: Vec<C>,
    measured: Vec<(M, f64)>,
) {
    let pairs = candidates.into_iter().zip(measured);
    trials.extend(pairs.map(|(candidate, (measured, objective))| Trial {
        coordinate,
        candidate,
        measured,
        objective,
        accepted: false,
    }));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn along(name: &'static str, axis: usize) -> Coordinate<[i32; 2]> {
        let values = move |from: &[i32; 2]| {
            let at = |value| {
                let mut to = *from;
                to[axis] = value;
                to
            };
            (-3..=3).map(at).collect()
        };
        Coordinate {
            name,
            values: Box::new(values),
        }
    }

    fn run(candidates_max: usize, bowl: fn(f64, f64) -> f64) -> Search<[i32; 2], ()> {
        let coordinates = [along("x", 0), along("y", 1)];
        search([0, 0], candidates_max, &coordinates, |batch| {
            let objective = |[x, y]: &[i32; 2]| ((), bowl(f64::from(*x), f64::from(*y)));
            Ok(batch.iter().map(objective).collect())
        })
        .unwrap()
    }

    /// The minimum of a tilted bowl needs a second round: x again after y.
    #[test]
    fn it_goes_round_until_nothing_helps_and_measures_nothing_twice() {
        let found = run(100, |x, y| (x - 0.5 * y).powi(2) + (y - 2.0).powi(2));
        assert!(found.is_settled);
        assert_eq!(found.found().candidate, [1, 2]);
        for (place, trial) in found.trials.iter().enumerate() {
            let earlier = &found.trials[..place];
            assert!(earlier.iter().all(|one| one.candidate != trial.candidate));
            let is_best = earlier.iter().all(|one| trial.objective < one.objective);
            assert!(!trial.accepted || is_best);
        }
    }

    #[test]
    fn it_stops_when_its_budget_is_spent() {
        let found = run(5, |x, y| x + y);
        assert_eq!(found.trials.len(), 5);
        assert!(!found.is_settled);
        assert_eq!(found.found().candidate, [-3, 0]);
        let start = run(1, |x, y| x + y);
        assert_eq!((start.trials.len(), start.best), (1, 0));
    }

    /// Equal is not better: nothing is changed without a reason.
    #[test]
    fn what_does_not_help_is_left_as_it_was() {
        let found = run(100, |x, _| x.abs());
        assert!(found.is_settled);
        assert_eq!(found.best, 0);
        assert_eq!(found.trials.len(), 13);
    }
}
