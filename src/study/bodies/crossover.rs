//! Where one engine overtakes another.

use super::{BodiesStudy, Series};
use crate::study::Ratio;

/// How a series stands to the base at a number of bodies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Standing {
    /// Number of bodies.
    pub bodies: usize,
    /// Cost of the series over that of the base.
    pub ratio: f64,
    /// The same with its interval, where both were measured in the same rounds.
    pub paired: Option<Ratio>,
    /// Whether it can be told which is dearer. Across builds, where there are no pairs, the
    /// medians decide.
    pub is_decided: bool,
}

/// A number of bodies at which a series costs as much as the base.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossover {
    /// Where, on the straight line between the ends on log-log.
    pub bodies: f64,
    /// What a step costs there, µs.
    pub step_us: f64,
    /// The largest number of bodies below, and the smallest above, at which it can be told which
    /// is dearer.
    pub between: [usize; 2],
    /// Whether the series is the cheaper one above.
    pub is_cheaper_above: bool,
}

impl BodiesStudy {
    /// How a series stands to the base, by size, wherever both have a cost.
    #[must_use]
    pub fn standings(&self, series: Series) -> Vec<Standing> {
        let standing = |point: &super::BodiesPoint| {
            let base = self.at(self.base(), point.bodies)?;
            let ratio = point.cost_ms_per_sim_s? / base.cost_ms_per_sim_s?;
            let paired = self.ratio(series, point.bodies);
            let is_decided = if series.build == self.build {
                paired.is_some_and(|ratio| ratio.is_decided())
            } else {
                true
            };
            Some(Standing {
                bodies: point.bodies,
                ratio: paired.map_or(ratio, |paired| paired.median),
                paired,
                is_decided,
            })
        };
        self.of(series).into_iter().filter_map(standing).collect()
    }

    /// Every number of bodies at which a series overtakes the base, or the base it.
    #[must_use]
    pub fn crossovers(&self, series: Series) -> Vec<Crossover> {
        let standings = self.standings(series).into_iter();
        let decided: Vec<_> = standings.filter(|standing| standing.is_decided).collect();
        let pairs = decided.windows(2);
        let crossing = |pair: &[Standing]| {
            let [low, high] = [pair[0], pair[1]];
            if (low.ratio > 1.0) == (high.ratio > 1.0) {
                return None;
            }
            let share = low.ratio.ln() / (low.ratio / high.ratio).ln();
            let base = |bodies| {
                let point = self.at(self.base(), bodies)?;
                point.per_step_us(self.options.dt)
            };
            Some(Crossover {
                bodies: between(share, count(low.bodies), count(high.bodies)),
                step_us: between(share, base(low.bodies)?, base(high.bodies)?),
                between: [low.bodies, high.bodies],
                is_cheaper_above: high.ratio < 1.0,
            })
        };
        pairs.filter_map(crossing).collect()
    }
}

#[allow(clippy::cast_precision_loss, reason = "far below 2^53 bodies")]
fn count(bodies: usize) -> f64 {
    bodies as f64
}

/// At a share of the way between two positive numbers, on a logarithmic scale.
fn between(share: f64, low: f64, high: f64) -> f64 {
    low * (high / low).powf(share)
}

#[cfg(test)]
mod tests {
    use super::super::BASE;
    use super::super::testing::{SIZES, study};

    /// n²/1000 against n: they meet at 1000, on any straight line of log-log; between 300 and
    /// 3000, for at 1000 their interval holds 1.
    #[test]
    fn two_power_laws_meet_where_they_must() {
        let study = study(&[(BASE, 2.0, 1e-3), ("rapier", 1.0, 1.0)]);
        let rapier = study.series()[1];
        let [crossover] = study.crossovers(rapier)[..] else {
            panic!("one crossover");
        };
        assert!(
            (crossover.bodies / 1000.0 - 1.0).abs() < 0.03,
            "{crossover:?}"
        );
        assert!(
            (crossover.step_us / 1000.0 - 1.0).abs() < 0.06,
            "{crossover:?}"
        );
        assert_eq!(crossover.between, [300, 3000]);
        assert!(crossover.is_cheaper_above);
        let standings = study.standings(rapier);
        assert_eq!(standings.len(), SIZES.len());
        assert!(!standings[5].is_decided, "{:?}", standings[5]);
        let last = standings[7].paired.unwrap();
        assert!(last.low <= 0.1 && 0.1 <= last.high && last.is_decided());
    }

    #[test]
    fn who_is_always_cheaper_is_never_overtaken() {
        let study = study(&[(BASE, 2.0, 1e-3), ("rapier", 2.0, 1e-2)]);
        assert_eq!(study.crossovers(study.series()[1]), []);
        assert_eq!(study.crossovers(study.base()), []);
    }

    /// Across builds there are no rounds to pair: the medians decide, without an interval.
    #[test]
    fn a_point_of_another_build_has_a_ratio_and_no_interval() {
        let mut study = study(&[(BASE, 2.0, 1e-3), ("rapier", 1.0, 2.0)]);
        for point in &mut study.points {
            if point.engine == "rapier" {
                "parallel".clone_into(&mut point.build);
                point.rounds.clear();
            }
        }
        let series = study.series()[1];
        assert_eq!(series.build, "parallel");
        assert!(study.standings(series).iter().all(|at| at.paired.is_none()));
        let [crossover] = study.crossovers(series)[..] else {
            panic!("one crossover");
        };
        assert!(
            (crossover.bodies / 2000.0 - 1.0).abs() < 0.05,
            "{crossover:?}"
        );
        assert_eq!(crossover.between, [1000, 3000]);
    }
}
