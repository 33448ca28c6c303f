//! Every number of the hand-written engines is the one that is stored: what they compute changes
//! only where that is meant.
//!
//! Says nothing about right or wrong; other tests do. It tells a change of the numerics that is
//! too small for them, or in a branch that no closed form reaches, from a change of the code
//! alone. Where it fails and the change is meant, `cargo test --test it -- --ignored
//! bits_are_stored_anew` stores the new numbers in `tests/bits/bits.csv`, and `carom check
//! --bless` those of the reference cases.

use std::fs;
use std::path::{Path, PathBuf};

use carom::case::Library;
use carom::engine::{EngineKind, EngineSpec, engines, prepare};
use carom::recording::{EventLog, Recording, initial_states};
use carom::scene::{
    Attraction, Body, Contact, Cushions, Drag, Effects, Gravity, Rest, Scene, Spring,
};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};

use crate::hostile;
use crate::scenes::{body, scene};

/// One that all engines are at ease with, and one that the hard cases are hard for.
const STEPS: [f64; 2] = [0.01, 0.1];

/// As much of a case as takes all its branches: the first impacts of a long run show its numbers.
const SAMPLES: usize = 24;

/// Cases whose every sample takes long.
const SLOW: [(&str, usize); 3] = [("cluster-30", 4), ("overlap-1000", 1), ("pi-5", 2)];

/// Lively scenes, and hostile ones, each on `robust` and on one of the others in turn.
const DRAWN: usize = 200;

/// A line of the file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
struct Line {
    case: String,
    engine: String,
    dt: f64,
    /// States.
    states: String,
    /// Impacts, books and what was given up.
    beside: String,
    /// Counted work.
    work: String,
}

/// What is run.
struct Run {
    scene: Scene,
    spec: EngineSpec,
    dt: f64,
}

impl Run {
    fn new(scene: &Scene, spec: &EngineSpec, dt: f64) -> Self {
        let slow = SLOW.iter().find(|(name, _)| *name == scene.name);
        let samples = slow.map_or(SAMPLES, |(_, samples)| *samples);
        let samples = u32::try_from(samples.min(scene.sample_count())).unwrap();
        let mut scene = scene.clone();
        scene.duration = f64::from(samples) * scene.sample_every;
        Self {
            scene,
            spec: spec.clone(),
            dt,
        }
    }

    fn line(&self) -> Line {
        let scene = &self.scene;
        let mut simulation = prepare(scene, &self.spec, self.dt).unwrap();
        assert!(simulation.keep_ledger());
        let mut recording = Recording::at_start(&self.spec.name, scene);
        let (mut log, mut states) = (EventLog::default(), initial_states(scene));
        let mut outcome = None;
        for sample in 1..=scene.sample_count() {
            outcome = simulation.advance_to(sample, Some(&mut log));
            simulation.state_into(&mut states);
            if outcome.is_some() || !states.iter().all(|state| state.is_finite()) {
                break;
            }
            recording.push(&states);
        }
        // The debug form of a double is the shortest that reads back as the same bits.
        let beside = format!(
            "{outcome:?} {:?} {:?} {:?} {:?}",
            log.events(),
            log.counts(),
            simulation.ledger(),
            simulation.concessions()
        );
        let work = format!("{:?}", simulation.work());
        Line {
            case: scene.name.clone(),
            engine: self.spec.name.clone(),
            dt: self.dt,
            states: recording.digest()[..16].to_owned(),
            beside: short_hash(&beside),
            work: short_hash(&work),
        }
    }
}

fn short_hash(text: &str) -> String {
    let hash = Sha256::digest(text);
    hash.iter()
        .take(8)
        .map(|byte| format!("{byte:02x}"))
        .collect()
}

/// Balls of unlike masses and sizes in a small box, with some of the effects, at moderate numbers.
fn lively(seed: u64) -> Scene {
    let mut random = Pcg64::seed_from_u64(seed);
    #[allow(clippy::cast_precision_loss, reason = "53 bits fit")]
    let mut within = |low: f64, high: f64| {
        low + (high - low) * ((random.next_u64() >> 11) as f64 * 2f64.powi(-53))
    };
    let count = within(2.0, 6.0);
    let bodies: Vec<Body> = ["a", "b", "c", "d", "e", "f"]
        .into_iter()
        .zip(0..)
        .take_while(|(_, place)| f64::from(*place) < count)
        .map(|(name, _)| {
            let (mass, radius) = (within(0.3, 4.0), within(0.2, 0.5));
            let position = [(); 3].map(|()| within(-1.2, 1.2));
            body(
                name,
                mass,
                radius,
                position,
                [(); 3].map(|()| within(-2.0, 2.0)),
            )
        })
        .collect();
    // Some restitutions, softenings, dampings and stiffnesses are none.
    let mut some = |share: f64| within(0.0, 1.0) < share;
    let [contact, cushions, tall, drag, rest, attraction, gravity] =
        [0.85, 0.7, 0.5, 0.4, 0.4, 0.4, 0.4].map(&mut some);
    let [soft, bouncy, stiff, damped] = [0.5, 0.5, 0.8, 0.6].map(&mut some);
    let between: &[[&str; 2]] = match (some(0.4), some(0.4)) {
        (true, true) if bodies.len() > 2 => &[["a", "b"], ["c", "b"]],
        (true, _) => &[["b", "a"]],
        _ => &[],
    };
    let restitution = if bouncy { within(0.2, 1.0) } else { 0.0 };
    let effects = Effects {
        contact: contact.then_some(Contact { restitution }),
        cushions: cushions.then(|| Cushions {
            half_width: within(1.8, 2.5),
            half_length: within(1.8, 2.5),
            half_height: tall.then(|| within(1.8, 2.5)),
            restitution: within(0.3, 1.0),
        }),
        drag: drag.then(|| Drag {
            coefficient: within(0.05, 0.8),
        }),
        rest: rest.then(|| Rest {
            speed: within(0.05, 0.4),
        }),
        attraction: attraction.then(|| Attraction {
            constant: within(0.2, 3.0),
            softening: if soft { within(0.05, 0.3) } else { 0.0 },
        }),
        gravity: gravity.then(|| Gravity {
            acceleration: [within(-0.5, 0.5), within(-6.0, 0.0), within(-0.5, 0.5)],
        }),
        springs: between
            .iter()
            .map(|ends| Spring {
                between: ends.map(Into::into),
                stiffness: if stiff { within(1.0, 60.0) } else { 0.0 },
                rest_length: within(0.0, 1.5),
                damping: if damped { within(0.05, 2.0) } else { 0.0 },
            })
            .collect(),
    };
    let mut scene = scene(2.0, 0.25, bodies, effects);
    scene.name = format!("lively-{seed}");
    scene
}

/// Every run that is stored.
fn runs() -> Vec<Run> {
    let engines: Vec<EngineSpec> = engines()
        .into_iter()
        .filter(|spec| matches!(spec.kind, EngineKind::Impulse(_)))
        .collect();
    let (robust, others) = engines.split_last().unwrap();
    assert_eq!(robust.name, "robust");
    let cases = [Library::Embedded, Library::EmbeddedHard]
        .into_iter()
        .flat_map(|library| {
            library
                .names()
                .unwrap()
                .into_iter()
                .map(move |name| library.case(&name))
        })
        .map(|case| case.unwrap().scene);
    let mut runs = Vec::new();
    for scene in cases {
        for spec in &engines {
            runs.extend(STEPS.map(|dt| Run::new(&scene, spec, dt)));
        }
    }
    let lively = (0..).map(lively).zip(STEPS.into_iter().cycle());
    let hostile = hostile::drawn(DRAWN)
        .into_iter()
        .zip(0..)
        .map(|((mut scene, dt), number)| {
            scene.name = format!("hostile-{number}");
            (scene, dt)
        });
    let drawn = lively.take(DRAWN).chain(hostile);
    for ((scene, dt), other) in drawn.zip(others.iter().cycle()) {
        runs.extend([robust, other].map(|spec| Run::new(&scene, spec, dt)));
    }
    runs
}

/// Every run in its order.
fn computed() -> Vec<Line> {
    runs().par_iter().map(Run::line).collect()
}

fn file() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bits/bits.csv")
}

/// Functions such as the exponential are those of the system: elsewhere, and on a processor that
/// does not multiply and add in one, their last digit may be another one.
#[cfg(all(target_arch = "x86_64", target_os = "linux", target_env = "gnu"))]
#[test]
fn every_number_is_the_stored_one() {
    if !std::arch::is_x86_feature_detected!("fma") {
        return;
    }
    let mut stored = csv::Reader::from_path(file()).unwrap();
    let stored: Vec<Line> = stored.deserialize().map(Result::unwrap).collect();
    let computed = computed();
    assert_eq!(computed.len(), stored.len(), "cases, engines or steps");
    let changed: Vec<&Line> = computed
        .iter()
        .zip(&stored)
        .filter(|(computed, stored)| computed != stored)
        .map(|(computed, _)| computed)
        .collect();
    let some = &changed[..changed.len().min(8)];
    assert!(
        changed.is_empty(),
        "{} of {} runs differ from the stored ones, such as {some:?}; if that is meant, store them \
         anew: cargo test --test it -- --ignored bits_are_stored_anew",
        changed.len(),
        stored.len()
    );
}

#[test]
#[ignore = "stores the numbers of this build, to be looked at before they are committed"]
fn bits_are_stored_anew() {
    fs::create_dir_all(file().parent().unwrap()).unwrap();
    let mut table = csv::Writer::from_path(file()).unwrap();
    for line in computed() {
        table.serialize(line).unwrap();
    }
    table.flush().unwrap();
}
