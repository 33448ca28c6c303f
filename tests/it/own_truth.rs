//! The truth of the clusters is carom's own, as far as `exact` certifies it, and says so.

use std::fs;
use std::path::Path;

use carom::case::{Evidence, Library, OWN_ORIGIN};
use carom::compare::Sizes;
use carom::engine::{DEFAULT_DT, engine, record};
use carom::recording::{Recording, write_events, write_trajectory};
use carom::scene::Scene;

/// Cases, and the time up to which their answer is the only one.
const CASES: [(&str, f64); 2] = [("cluster-8", 1.75), ("cluster-30", 1.125)];

/// So many impacts are far from the pile-ups whose last bounces depend on rounding.
const FIRST: usize = 20;

/// The comparable part of a scene on `exact`, with what it vouches for.
fn certified(scene: &Scene, until: f64) -> Recording {
    // As far as the answer is the only one; what comes later takes its time.
    let shorter = Scene {
        duration: until,
        ..scene.clone()
    };
    let recording = record(&shorter, &engine("exact").unwrap(), DEFAULT_DT).unwrap();
    assert!(recording.outcome.is_finished());
    assert_eq!(
        recording.comparable_samples(&shorter),
        recording.sample_count()
    );
    recording
}

fn files(scene: &Scene, recording: &Recording) -> [(&'static str, String); 3] {
    let (mut trajectory, mut events) = (Vec::new(), Vec::new());
    write_trajectory(recording, scene, &mut trajectory).unwrap();
    write_events(&recording.events, scene, &mut events).unwrap();
    let digits = recording.fewest_digits(scene).unwrap();
    let until = scene.sample_time(recording.sample_count() - 1);
    let origin = format!(
        "{OWN_ORIGIN}\n\
         Not independent: `exact` made `truth.csv` and `events.csv` itself, up to {until} s, and certifies {} digits of the\n\
         positions and {} of the velocities by a second computation. Soon after, an impact on touching bodies has no single\n\
         answer in the model: another order of the same simultaneous impacts ends elsewhere.\n\
         `CAROM_BLESS=1 cargo test own_truth` makes them anew. The bodies are those of `make_clusters.py`.\n",
        digits.position, digits.velocity
    );
    let text = |bytes| String::from_utf8(bytes).unwrap();
    [
        ("truth.csv", text(trajectory)),
        ("events.csv", text(events)),
        ("ORIGIN.md", origin),
    ]
}

/// What is stored is what `exact` gives, up to the digits that it certifies: steps of its
/// integrator depend on powers, which another machine may round otherwise.
#[test]
fn own_truth_is_marked_and_holds() {
    let reference = Path::new(env!("CARGO_MANIFEST_DIR")).join("reference");
    for (name, until) in CASES {
        let text = fs::read_to_string(reference.join(name).join("scene.toml")).unwrap();
        let scene = carom::scene::parse(&text, name).unwrap();
        let recording = certified(&scene, until);
        if std::env::var_os("CAROM_BLESS").is_some() {
            for (file, text) in files(&scene, &recording) {
                fs::write(reference.join(name).join(file), text).unwrap();
            }
        }
        let case = Library::Folder(reference.clone()).case(name).unwrap();
        assert_eq!(case.evidence, Some(Evidence::Own));
        let stored = case.truth.unwrap();
        assert_eq!(stored.sample_count(), recording.sample_count());
        let digits = recording.fewest_digits(&scene).unwrap();
        let known = 10.0_f64.powi(-i32::from(digits.position)) * Sizes::of(&recording, &[]).length;
        let both = stored
            .samples()
            .flatten()
            .zip(recording.samples().flatten());
        for (stored, computed) in both {
            let error = (stored.position - computed.position).norm();
            assert!(error <= known, "{name}: {error:e} > {known:e}");
        }
        let firsts = [&stored, &recording].map(|recording| {
            let first = recording.events.events().iter().take(FIRST);
            first.map(|event| event.kind).collect::<Vec<_>>()
        });
        assert_eq!(firsts[0], firsts[1]);
    }
}
