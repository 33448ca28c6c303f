//! The findings of a study of cost, as programs read them (`summary.json`) and pages show them,
//! today's and those of a study that was stored.

use serde::{Deserialize, Serialize};

use super::{CostOptions, CostPoint, EngineLimit, PriceTag, SceneCost, Sensitivity};
use crate::engine::{EngineKind, EngineSpec};
use crate::error::Result;
use crate::scene::{LengthUnit, Scene, parse, to_toml};
use crate::study::Made;

/// A study of cost over some scenes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CostSummary {
    /// When, with what and where it was made.
    #[serde(flatten)]
    pub made: Made,
    /// How it was made.
    pub options: CostOptions,
    /// Each scene.
    pub scenes: Vec<SceneCostSummary>,
}

/// What accuracy costs on one scene.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct SceneCostSummary {
    /// Name of the scene.
    pub scene: String,
    /// Title of the scene, or its name.
    pub title: String,
    /// The scene as it was measured, so that a later reader sees whether it still is.
    pub scene_toml: String,
    /// Unit of length.
    pub length_unit: LengthUnit,
    /// Until when positions are compared, s; none without a common reference.
    pub compared_until_s: Option<f64>,
    /// What a ball placed a little off does.
    pub sensitivity: Option<Sensitivity>,
    /// The price of each accuracy, from coarse to fine.
    pub tags: Vec<TagSummary>,
    /// What is left of each engine's error as the step goes to 0.
    pub limits: Vec<EngineLimit>,
}

/// What one accuracy costs.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct TagSummary {
    /// How the accuracy is called.
    pub name: String,
    /// Largest position error allowed, scene length unit.
    pub position_error_max: f64,
    /// Each engine, in the order of the study.
    pub offers: Vec<Offer>,
}

/// An engine's price for an accuracy.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Offer {
    /// The engine.
    pub engine: String,
    /// What kind of engine it is.
    pub family: EngineFamily,
    /// Its cheapest setting that keeps the accuracy; none within the budget.
    pub bid: Option<Bid>,
}

/// The kinds of engines, for sentences about one of them.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum EngineFamily {
    /// The lecture's solver and the rungs of its ladder.
    Impulse,
    /// From event to event, without steps.
    Exact,
    /// A Rapier world.
    Rapier,
}

/// A way to an accuracy.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Bid {
    /// The setting, `stock` for the engine as it comes.
    pub setting: String,
    /// The step taken, s; none for engines without steps.
    pub dt_s: Option<f64>,
    /// The median price.
    pub cost_ms_per_sim_s: f64,
    /// The error that it leaves, scene length unit.
    pub position_error_max: f64,
}

impl CostSummary {
    /// A study begun today, on this machine, with nothing measured yet.
    #[must_use]
    pub fn begin(options: CostOptions) -> Self {
        Self {
            made: Made::now(),
            options,
            scenes: Vec::new(),
        }
    }

    /// The results on a scene of that name.
    #[must_use]
    pub fn scene(&self, name: &str) -> Option<&SceneCostSummary> {
        self.scenes.iter().find(|scene| scene.scene == name)
    }
}

impl SceneCostSummary {
    /// Takes from a study what is worth keeping; `seed` is that of the intervals.
    ///
    /// # Errors
    /// A scene that is not one.
    pub fn of(cost: &SceneCost, seed: u64) -> Result<Self> {
        let tags = cost.price_tags();
        Ok(Self {
            scene: cost.scene.name.clone(),
            title: cost.scene.heading().to_owned(),
            scene_toml: to_toml(&cost.scene)?,
            length_unit: cost.scene.units.length,
            compared_until_s: cost.compared_until,
            sensitivity: cost.sensitivity.clone(),
            tags: tags.iter().map(|tag| TagSummary::of(cost, tag)).collect(),
            limits: cost.limits(seed),
        })
    }

    /// How many bodies the scene has, as it was measured.
    #[must_use]
    pub fn body_count(&self) -> usize {
        parse(&self.scene_toml, &self.scene).map_or(0, |scene| scene.bodies.len())
    }

    /// Whether this is still the scene that was measured.
    #[must_use]
    pub fn is_of(&self, scene: &Scene) -> bool {
        to_toml(scene).is_ok_and(|text| text == self.scene_toml)
    }
}

impl TagSummary {
    fn of(cost: &SceneCost, tag: &PriceTag) -> Self {
        let offer = |(engine, (_, point)): (_, &(&str, Option<&CostPoint>))| {
            let spec: &EngineSpec = engine;
            Offer {
                engine: spec.name.clone(),
                family: EngineFamily::of(spec),
                bid: point.and_then(Bid::of),
            }
        };
        let specs = cost.engines.iter().map(|engine| &engine.spec);
        Self {
            name: tag.target.name.to_owned(),
            position_error_max: tag.target.length,
            offers: specs.zip(&tag.cheapest).map(offer).collect(),
        }
    }

    /// The lowest price for the accuracy among some engines.
    pub fn cheapest(&self, asked: impl Fn(&Offer) -> bool) -> Option<(&Offer, &Bid)> {
        let offers = self.offers.iter().filter(|offer| asked(offer));
        let bids = offers.filter_map(|offer| Some((offer, offer.bid.as_ref()?)));
        bids.min_by(|(_, a), (_, b)| a.cost_ms_per_sim_s.total_cmp(&b.cost_ms_per_sim_s))
    }
}

impl EngineFamily {
    fn of(spec: &EngineSpec) -> Self {
        match spec.kind {
            EngineKind::Impulse(_) => Self::Impulse,
            EngineKind::Exact(_) => Self::Exact,
            EngineKind::Rapier(_) => Self::Rapier,
        }
    }

    /// Whether its engines compute step by step.
    #[must_use]
    pub fn takes_steps(self) -> bool {
        match self {
            Self::Impulse | Self::Rapier => true,
            Self::Exact => false,
        }
    }
}

impl Bid {
    fn of(point: &CostPoint) -> Option<Self> {
        Some(Self {
            setting: point.setting.clone(),
            dt_s: point.dt,
            cost_ms_per_sim_s: point.cost()?,
            position_error_max: point.error()?,
        })
    }

    /// Whether the engine ran as it comes.
    #[must_use]
    pub fn is_stock(&self) -> bool {
        self.setting == super::STOCK
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::study;
    use super::*;
    use crate::study::Timing;

    #[test]
    fn what_is_stored_is_read_back_and_names_the_cheapest() {
        let cost = study(&[
            ("a", "stock", &[(5.0, 3.0), (0.5, 4.0)]),
            ("b", "stock", &[(5.0, 1.0), (2.0, 2.0)]),
        ]);
        let mut summary = CostSummary::begin(CostOptions {
            timing: Timing {
                seed: 1,
                repetitions: 5,
            },
            budget: 10,
            phases: 3,
            runs: 30,
        });
        summary.scenes.push(SceneCostSummary::of(&cost, 1).unwrap());
        let text = serde_json::to_string(&summary).unwrap();
        let back: CostSummary = serde_json::from_str(&text).unwrap();
        assert_eq!(back, summary);
        let scene = back.scene("x").unwrap();
        let cheapest = |tag: &TagSummary| {
            tag.cheapest(|offer| offer.family.takes_steps())
                .map(|(offer, bid)| (offer.engine.clone(), bid.cost_ms_per_sim_s))
        };
        let found: Vec<_> = scene.tags.iter().map(cheapest).collect();
        let a = |price| Some(("a".to_owned(), price));
        let b = |price| Some(("b".to_owned(), price));
        assert_eq!(found, [b(1.0), a(4.0), None, None]);
        assert!(scene.is_of(&cost.scene));
        let mut other = cost.scene.clone();
        other.bodies[0].mass = 2.0;
        assert!(!scene.is_of(&other));
    }
}
