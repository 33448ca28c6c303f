//! The price tag: the cheapest way to an accuracy, and the accuracy for a price.

use super::{CostPoint, Ending, SceneCost};
use crate::scene::LengthUnit;
use crate::study::{Price, Ratio, paired_ratio};

/// Targets of scenes with a unit of length, m.
const TARGETS_M: [(f64, &str); 4] = [
    (1e-2, "10 mm"),
    (1e-3, "1 mm"),
    (1e-4, "0.1 mm"),
    (1e-6, "0.001 mm"),
];
/// Targets of scenes without one, shares of the size.
const TARGET_SHARES: [(f64, &str); 5] = [
    (1e-2, "1e-2 of the size"),
    (1e-3, "1e-3 of the size"),
    (1e-4, "1e-4 of the size"),
    (1e-5, "1e-5 of the size"),
    (1e-6, "1e-6 of the size"),
];
/// The target that stands for all where one must: 1 mm, or a thousandth of the size.
pub const MAIN_TARGET: usize = 1;

/// An accuracy that prices are asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Target {
    /// Largest position error allowed, scene length unit.
    pub length: f64,
    /// How it is called, the same in every unit.
    pub name: &'static str,
}

/// What one accuracy costs.
#[derive(Debug, Clone)]
pub struct PriceTag<'a> {
    /// The accuracy.
    pub target: Target,
    /// Each engine that was priced, in the order of the study: its cheapest point that keeps
    /// the target; none if it has none.
    pub cheapest: Vec<(&'a str, Option<&'a CostPoint>)>,
}

/// An engine's price over the cheapest one's, at one accuracy.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison<'a> {
    /// The engine.
    pub engine: &'a str,
    /// The cheapest engine.
    pub cheapest: &'a str,
    /// The paired ratio of their prices; none with too few rounds.
    pub ratio: Option<Ratio>,
}

impl PriceTag<'_> {
    /// Every engine that keeps the target against the cheapest of them.
    #[must_use]
    pub fn comparisons(&self, seed: u64) -> Vec<Comparison<'_>> {
        let kept = || {
            let kept = self.cheapest.iter();
            kept.filter_map(|(engine, point)| Some((*engine, point.as_ref()?.price.as_ref()?)))
        };
        let Some((winner, least)) = kept().min_by(|a, b| a.1.median.total_cmp(&b.1.median)) else {
            return Vec::new();
        };
        let against = |(engine, price): (_, &Price)| Comparison {
            engine,
            cheapest: winner,
            ratio: paired_ratio(&price.rounds, &least.rounds, seed),
        };
        kept()
            .filter(|(engine, _)| *engine != winner)
            .map(against)
            .collect()
    }
}

/// The accuracies that a scene's prices are asked for, from coarse to fine.
#[must_use]
pub fn targets(unit: LengthUnit, size: f64) -> Vec<Target> {
    let (all, whole): (&[(f64, &'static str)], f64) = match unit {
        LengthUnit::None => (&TARGET_SHARES, size),
        LengthUnit::Millimetre | LengthUnit::Centimetre | LengthUnit::Metre => {
            (&TARGETS_M, unit.per_metre())
        }
    };
    let target = |(share, name): &(f64, &'static str)| Target {
        length: share * whole,
        name,
    };
    all.iter().map(target).collect()
}

impl SceneCost {
    /// The price tags of all targets.
    #[must_use]
    pub fn price_tags(&self) -> Vec<PriceTag<'_>> {
        let tag = |target: Target| PriceTag {
            target,
            cheapest: self.per_engine(|engine| self.cheapest(engine, target.length)),
        };
        let targets = targets(self.scene.units.length, self.size);
        targets.into_iter().map(tag).collect()
    }

    /// The error that each engine leaves at a price, ms per simulated second: its best setting,
    /// each at the finest step that it can pay.
    #[must_use]
    pub fn for_price(&self, price: f64) -> Vec<(&str, Option<&CostPoint>)> {
        self.per_engine(|engine| {
            let affordable = |point: &&CostPoint| point.cost().is_some_and(|cost| cost <= price);
            let ladders = self.ladders(engine).into_iter();
            let finest = ladders.filter_map(|ladder| ladder.into_iter().rfind(affordable));
            smallest(finest, CostPoint::error)
        })
    }

    fn per_engine<'a>(
        &'a self,
        find: impl Fn(&str) -> Option<&'a CostPoint>,
    ) -> Vec<(&'a str, Option<&'a CostPoint>)> {
        let engines = self.engines.iter();
        let names = engines.map(|engine| engine.spec.name.as_str());
        names.map(|name| (name, find(name))).collect()
    }

    /// The cheapest point of an engine that keeps a target. A step counts only if no finer one
    /// of the same setting misses the target: a coarse step may be right by luck.
    fn cheapest(&self, engine: &str, target: f64) -> Option<&CostPoint> {
        let keeps = |point: &&CostPoint| point.error().is_some_and(|error| error <= target);
        let ladders = self.ladders(engine).into_iter();
        let kept = ladders.flat_map(|ladder| {
            let judged = ladder.into_iter().rev().filter(|point| is_judged(point));
            judged.take_while(keeps)
        });
        smallest(kept, CostPoint::cost)
    }

    /// The points of an engine, a ladder from coarse to fine for each setting.
    fn ladders(&self, engine: &str) -> Vec<Vec<&CostPoint>> {
        let mut ladders: Vec<Vec<&CostPoint>> = Vec::new();
        for point in self.points.iter().filter(|point| point.engine == engine) {
            match ladders.last_mut() {
                Some(ladder) if ladder[0].setting == point.setting => ladder.push(point),
                Some(_) | None => ladders.push(vec![point]),
            }
        }
        ladders
    }
}

/// Whether a point can keep or miss a target: not one that was never run, nor one that finished
/// and has no error because it is itself what the others are measured against.
fn is_judged(point: &CostPoint) -> bool {
    match &point.ending {
        Ending::OverBudget => false,
        Ending::Ran(outcome) => !outcome.is_finished() || point.error().is_some(),
        Ending::Refused(_) => true,
    }
}

/// The point with the smallest value, of those that have one.
fn smallest<'a>(
    points: impl Iterator<Item = &'a CostPoint>,
    value: impl Fn(&CostPoint) -> Option<f64>,
) -> Option<&'a CostPoint> {
    let valued = points.filter_map(|point| Some((value(point)?, point)));
    let best = valued.min_by(|a, b| a.0.total_cmp(&b.0));
    best.map(|(_, point)| point)
}

#[cfg(test)]
mod tests {
    use super::super::testing::study;
    use super::*;
    use crate::recording::Outcome;

    #[test]
    fn targets_follow_the_unit() {
        let lengths = |unit, size| -> Vec<f64> {
            let targets = targets(unit, size);
            targets.iter().map(|target| target.length).collect()
        };
        assert_eq!(lengths(LengthUnit::Millimetre, 5.0), [10.0, 1.0, 0.1, 1e-3]);
        assert_eq!(lengths(LengthUnit::Metre, 5.0), [1e-2, 1e-3, 1e-4, 1e-6]);
        assert_eq!(lengths(LengthUnit::None, 50.0)[0], 0.5);
        assert_eq!(targets(LengthUnit::Metre, 5.0)[MAIN_TARGET].name, "1 mm");
    }

    /// 20 mm, 0.5 mm by luck, 2 mm, 0.9 mm: the lucky step does not count for 1 mm.
    #[test]
    fn a_lucky_coarse_step_does_not_count() {
        let errors = [(20.0, 1.0), (0.5, 2.0), (2.0, 4.0), (0.9, 8.0)];
        let study = study(&[("a", "stock", &errors)]);
        let tags = study.price_tags();
        let cost = |tag: &PriceTag| tag.cheapest[0].1.and_then(CostPoint::cost);
        assert_eq!(tags[0].target.length, 10.0);
        assert_eq!(cost(&tags[0]), Some(2.0));
        assert_eq!(cost(&tags[1]), Some(8.0));
        assert_eq!(cost(&tags[2]), None);
    }

    /// Without a common reference the finest step has no error; it is no miss. A blow-up is.
    #[test]
    fn the_finest_step_is_no_miss_where_it_is_the_reference_but_a_blow_up_is() {
        let mut study = study(&[("a", "stock", &[(2.0, 1.0), (0.5, 2.0), (0.0, 4.0)])]);
        study.points[2].errors.position_max = None;
        let cheapest = |study: &SceneCost| study.cheapest("a", 1.0).and_then(CostPoint::cost);
        assert_eq!(cheapest(&study), Some(2.0));
        study.points[2].ending = Ending::Ran(Outcome::NonFinite { time: 0.5, body: 0 });
        assert_eq!(cheapest(&study), None);
    }

    #[test]
    fn the_best_setting_counts_and_the_price_decides_the_step() {
        let study = study(&[
            ("a", "stock", &[(20.0, 1.0), (5.0, 2.0)]),
            ("a", "tuned", &[(9.0, 1.5), (4.0, 3.0)]),
            ("b", "stock", &[(0.5, 1.0)]),
        ]);
        let tag = &study.price_tags()[0];
        assert_eq!(tag.cheapest[0].1.map(|p| p.setting.as_str()), Some("tuned"));
        let ranked = tag.comparisons(1);
        assert_eq!((ranked[0].engine, ranked[0].cheapest), ("a", "b"));
        assert!((ranked[0].ratio.unwrap().median - 1.5).abs() < 1e-12);
        let bought = study.for_price(2.5);
        assert_eq!(bought[0].1.and_then(CostPoint::error), Some(5.0));
        assert_eq!(study.for_price(0.5)[0].1.map(|p| p.setting.as_str()), None);
    }
}
