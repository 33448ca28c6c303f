//! What the tests of the study share.

use super::{CostPoint, Ending, EngineCost, Errors, Price, SceneCost};
use crate::engine::engine;
use crate::recording::Outcome;

/// Engine, setting, and (error, cost) from coarse to fine.
pub(super) type Ladder<'a> = (&'a str, &'a str, &'a [(f64, f64)]);

/// A study with ladders with steps from 1 s
/// down by halves, on a scene in millimetres.
pub(super) fn study(ladders: &[Ladder]) -> SceneCost {
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
                price: Some(Price {
                    rounds: vec![*cost; 5],
                    median: *cost,
                    min: *cost,
                    steps: 1,
                }),
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
        refusals: Vec::new(),
        notes: Vec::new(),
    }
}
