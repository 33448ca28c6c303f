//! Every number of the hand-written engines is the one that is stored: what they compute changes
//! only where that is meant.
//!
//! Says nothing about right or wrong; other tests do. It tells a change of the numerics that is
//! too small for them, or in a branch that no closed form reaches, from a change of the code
//! alone. Where it fails and the change is meant, `cargo test --test it -- --ignored
//! bits_are_stored_anew` stores the new numbers in `tests/bits/bits.csv`, and `carom check
//! --bless` those of the reference cases.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use carom::case::{Case, Library};
use carom::engine::{EngineKind, EngineSpec, engines, prepare};
use carom::recording::{EventLog, Recording, initial_states};
use rayon::prelude::*;
use sha2::{Digest, Sha256};

/// One that all engines are at ease with, and one that the hard cases are hard for.
const STEPS: [f64; 2] = [0.01, 0.1];

/// As much of a case as takes all its branches: the first impacts of a long run show its numbers.
const SAMPLES: usize = 24;

/// Cases whose every sample takes long.
const SLOW: [(&str, usize); 3] = [("cluster-30", 4), ("overlap-1000", 2), ("pi-5", 2)];

/// States, then impacts, books, work and what was given up.
type Bits = [String; 2];

fn file() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bits/bits.csv")
}

fn short_hash(text: &str) -> String {
    let hash = Sha256::digest(text);
    hash.iter()
        .take(8)
        .map(|byte| format!("{byte:02x}"))
        .collect()
}

fn bits(case: &Case, spec: &EngineSpec, dt: f64) -> Bits {
    let mut scene = case.scene.clone();
    let slow = SLOW.iter().find(|(name, _)| *name == scene.name);
    let samples = slow.map_or(SAMPLES, |(_, samples)| *samples);
    let samples = samples.min(scene.sample_count());
    scene.duration = f64::from(u32::try_from(samples).unwrap()) * scene.sample_every;
    let mut simulation = prepare(&scene, spec, dt).unwrap();
    assert!(simulation.keep_ledger());
    let mut recording = Recording::at_start(&spec.name, &scene);
    let (mut log, mut states) = (EventLog::default(), initial_states(&scene));
    let mut outcome = None;
    for sample in 1..=samples {
        outcome = simulation.advance_to(sample, Some(&mut log));
        simulation.state_into(&mut states);
        if outcome.is_some() || !states.iter().all(|state| state.is_finite()) {
            break;
        }
        recording.push(&states);
    }
    // The debug form of a double is the shortest that reads back as the same bits.
    let beside = format!(
        "{outcome:?} {:?} {:?} {:?} {:?} {:?}",
        log.events(),
        log.counts(),
        simulation.ledger(),
        simulation.work(),
        simulation.concessions()
    );
    [recording.digest()[..16].to_owned(), short_hash(&beside)]
}

fn computed() -> BTreeMap<String, Bits> {
    let cases: Vec<Case> = [Library::Embedded, Library::EmbeddedHard]
        .iter()
        .flat_map(|library| {
            library
                .names()
                .unwrap()
                .into_iter()
                .map(|name| library.case(&name))
        })
        .map(Result::unwrap)
        .collect();
    let engines: Vec<EngineSpec> = engines()
        .into_iter()
        .filter(|spec| matches!(spec.kind, EngineKind::Impulse(_)))
        .collect();
    let one = |(case, spec, dt): (&Case, &EngineSpec, f64)| {
        let name = format!("{},{},{dt}", case.scene.name, spec.name);
        (name, bits(case, spec, dt))
    };
    let jobs: Vec<_> = cases
        .iter()
        .flat_map(|case| engines.iter().map(move |spec| (case, spec)))
        .flat_map(|(case, spec)| STEPS.map(|dt| (case, spec, dt)))
        .collect();
    jobs.into_par_iter().map(one).collect()
}

/// Functions such as the exponential are those of the system: elsewhere their last digit may be
/// another one.
#[cfg(all(target_arch = "x86_64", target_os = "linux", target_env = "gnu"))]
#[test]
fn every_number_is_the_stored_one() {
    let text = fs::read_to_string(file()).unwrap();
    let stored: BTreeMap<String, Bits> = text
        .lines()
        .skip(1)
        .map(|line| {
            let (rest, beside) = line.rsplit_once(',').unwrap();
            let (name, states) = rest.rsplit_once(',').unwrap();
            (name.to_owned(), [states.to_owned(), beside.to_owned()])
        })
        .collect();
    let computed = computed();
    assert!(stored.keys().eq(computed.keys()), "cases, engines or steps");
    let differ = |name: &&String| stored[*name] != computed[*name];
    let changed: Vec<&String> = computed.keys().filter(differ).collect();
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
    let mut text = String::from("case,engine,dt,states,beside\n");
    for (name, [states, beside]) in computed() {
        text += &format!("{name},{states},{beside}\n");
    }
    fs::create_dir_all(file().parent().unwrap()).unwrap();
    fs::write(file(), text).unwrap();
}
