//! What the tests of the study share.

use super::{
    Bid, CostOptions, CostPoint, CostSummary, Ending, EngineCost, EngineFamily, Errors, Offer,
    SceneCost, SceneCostSummary, TagSummary,
};
use crate::engine::engine;
use crate::recording::{Outcome, Work};
use crate::study::{Price, Timing};

/// Engine, setting, and (error, cost) from coarse to fine.
pub(crate) type Ladder<'a> = (&'a str, &'a str, &'a [(f64, f64)]);

/// A study with ladders of steps from 1 s down by halves, on a scene in millimetres.
pub(crate) fn study(ladders: &[Ladder]) -> SceneCost {
    let text = "name='x'\nduration=1\nsample_every=1\n[units]\nlength='mm'\n\
        [[bodies]]\nname='a'\nmass=1\nradius=1\nposition=[0,0,0]\nvelocity=[0,0,0]\n";
    let scene = crate::scene::parse(text, "x").unwrap();
    let mut engines: Vec<EngineCost> = Vec::new();
    let mut points = Vec::new();
    for (name, setting, ladder) in ladders {
        if engines.iter().all(|engine| engine.spec.name != *name) {
            let mut spec = engine("lecture").unwrap();
            (*name).clone_into(&mut spec.name);
            engines.push(EngineCost {
                spec,
                settings: 1,
                runs: ladder.len(),
                found: None,
            });
        }
        let mut dt = 1.0;
        for (error, cost) in *ladder {
            points.push(CostPoint {
                engine: (*name).to_owned(),
                setting: (*setting).to_owned(),
                dt: Some(dt),
                errors: Errors {
                    position_max: Some(*error),
                    ..Errors::default()
                },
                price: Some(Price::new(vec![*cost; 7], Work::default())),
                ending: Ending::Ran(Outcome::Finished),
            });
            dt /= 2.0;
        }
    }
    SceneCost {
        scene,
        size: 1000.0,
        compared_until: Some(1.0),
        priced_until: 1.0,
        sensitivity: None,
        engines,
        points,
        step_costs: Vec::new(),
        phases: Vec::new(),
        push_out: Vec::new(),
        refusals: Vec::new(),
        notes: Vec::new(),
    }
}

/// The summary of a study of one scene in millimetres: engines with their prices from the
/// coarsest accuracy on, all with a step of 0.01 s.
pub(crate) fn summary(engines: &[(&str, EngineFamily, &[f64])]) -> CostSummary {
    let cost = study(&[]);
    let offer = |place: usize| {
        move |(engine, family, prices): &(&str, EngineFamily, &[f64])| Offer {
            engine: (*engine).to_owned(),
            family: *family,
            bid: prices.get(place).map(|price| Bid {
                setting: super::STOCK.to_owned(),
                dt_s: Some(0.01),
                cost_ms_per_sim_s: *price,
                position_error_max: 1e-4,
            }),
        }
    };
    let scene = SceneCostSummary::of(&cost, 1).unwrap();
    let tags = scene.tags.into_iter().enumerate();
    let tags = tags.map(|(place, tag)| TagSummary {
        offers: engines.iter().map(offer(place)).collect(),
        ..tag
    });
    let scene = SceneCostSummary {
        tags: tags.collect(),
        ..scene
    };
    let options = CostOptions {
        timing: Timing {
            seed: 1,
            repetitions: 5,
        },
        phases: 3,
        runs: 30,
        budget: 1000,
    };
    CostSummary {
        scenes: vec![scene],
        ..CostSummary::begin(options)
    }
}
