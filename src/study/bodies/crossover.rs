//! Where one engine overtakes another.

use std::cmp::Ordering;

use super::{BASE, BodiesStudy, Series};

/// How a series stands to the base of its own build, which ran in the same rounds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Standing {
    /// Number of bodies.
    pub bodies: usize,
    /// Cost over that of the base.
    pub ratio: f64,
    /// Its 95 % interval; none with too few rounds.
    pub interval: Option<[f64; 2]>,
}

impl Standing {
    /// Whether it can be told which of the two is dearer.
    #[must_use]
    pub fn is_decided(&self) -> bool {
        let apart = |[low, high]: [f64; 2]| low > 1.0 || high < 1.0;
        self.interval.is_some_and(apart)
    }

    /// How this one stands to another at the same number of bodies, each held against the base of
    /// its own build; equal where their intervals overlap.
    #[must_use]
    pub fn against(&self, other: &Self) -> Ordering {
        match (self.interval, other.interval) {
            (Some([_, high]), Some([low, _])) if high < low => Ordering::Less,
            (Some([low, _]), Some([_, high])) if low > high => Ordering::Greater,
            _ => Ordering::Equal,
        }
    }
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
    /// How a series stands to the base of its build, by size.
    #[must_use]
    pub fn standings(&self, series: Series) -> Vec<Standing> {
        let standing = |point: &super::BodiesPoint| {
            Some(Standing {
                bodies: point.bodies,
                ratio: point.ratio?,
                interval: point
                    .ratio_low
                    .and_then(|low| Some([low, point.ratio_high?])),
            })
        };
        self.of(series).into_iter().filter_map(standing).collect()
    }

    /// Every number of bodies at which a series overtakes the base, or the base it.
    #[must_use]
    pub fn crossovers(&self, series: Series) -> Vec<Crossover> {
        let standings = self.standings(series).into_iter();
        let decided: Vec<_> = standings.filter(Standing::is_decided).collect();
        let pairs = decided.windows(2);
        let crossing = |pair: &[Standing]| {
            let [low, high] = [pair[0], pair[1]];
            if (low.ratio > 1.0) == (high.ratio > 1.0) {
                return None;
            }
            let share = low.ratio.ln() / (low.ratio / high.ratio).ln();
            let base = |bodies| {
                let base = Series {
                    engine: BASE,
                    ..series
                };
                self.at(base, bodies)?.per_step_us(self.options.dt)
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
    use super::super::testing::{SIZES, study};
    use super::*;

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
        assert!(!standings[5].is_decided(), "{:?}", standings[5]);
        let [low, high] = standings[7].interval.unwrap();
        assert!(low <= 0.1 && 0.1 <= high && standings[7].is_decided());
    }

    #[test]
    fn who_is_always_cheaper_is_never_overtaken() {
        let study = study(&[(BASE, 2.0, 1e-3), ("rapier", 2.0, 1e-2)]);
        assert_eq!(study.crossovers(study.series()[1]), []);
        assert_eq!(study.crossovers(study.own(BASE)), []);
    }

    /// On a machine half as fast, another build is held against the lecture of its own run: the
    /// crossing stays where it is.
    #[test]
    fn each_build_is_held_against_its_own_lecture() {
        let mut own = study(&[(BASE, 2.0, 1e-3), ("rapier", 1.0, 1.0)]);
        let mut other = study(&[(BASE, 2.0, 2e-3), ("rapier", 1.0, 2.0)]);
        for point in &mut other.points {
            "parallel".clone_into(&mut point.build);
        }
        own.points.extend(other.points);
        let at = [1, 3].map(|place| own.crossovers(own.series()[place])[0]);
        assert!((at[0].bodies / at[1].bodies - 1.0).abs() < 1e-9, "{at:?}");
        assert!((at[1].step_us / at[0].step_us - 2.0).abs() < 1e-9, "{at:?}");
        let [one, same] = [1, 3].map(|place| own.standings(own.series()[place])[7]);
        assert_eq!(one.against(&same), Ordering::Equal);
        let cheaper = Standing {
            ratio: 0.5 * one.ratio,
            interval: one.interval.map(|ends| ends.map(|end| 0.5 * end)),
            ..one
        };
        assert_eq!(cheaper.against(&one), Ordering::Less);
        assert_eq!(one.against(&cheaper), Ordering::Greater);
        let unsure = Standing {
            interval: None,
            ..cheaper
        };
        assert_eq!(unsure.against(&one), Ordering::Equal);
    }
}
