//! The slides' C++, bit for bit: `tests/oracle/` holds what it gave (see its README).

use std::fs::File;
use std::path::Path;

use carom::engine::{DEFAULT_DT, engine, record};
use carom::recording::{Recording, read_trajectory};
use carom::scene::{self, Scene};

fn oracle(case: &str) -> (Scene, Recording) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"))
        .join("tests/oracle")
        .join(case);
    let scene = scene::read(&folder.join("scene.toml")).unwrap();
    let table = File::open(folder.join("lecture.csv")).unwrap();
    let truth = read_trajectory("slides", &scene, table, "lecture.csv").unwrap();
    (scene, truth)
}

/// The first sample and body in which two recordings differ in any bit.
fn first_difference(a: &Recording, b: &Recording) -> Option<(usize, usize)> {
    assert_eq!(a.sample_count(), b.sample_count());
    let mut samples = a.samples().zip(b.samples()).enumerate();
    samples.find_map(|(sample, (a, b))| {
        a.iter()
            .zip(b)
            .position(|(a, b)| a != b)
            .map(|body| (sample, body))
    })
}

#[test]
fn lecture_gives_the_slides_bits() {
    for case in ["attraction-sparse", "shot-2-96", "shot-minus-0-94"] {
        let (scene, truth) = oracle(case);
        let ours = record(&scene, &engine("lecture").unwrap(), DEFAULT_DT).unwrap();
        assert_eq!(
            first_difference(&ours, &truth),
            None,
            "{case}: (sample, body)"
        );
        assert!(
            ours.events.counts().contacts > 0,
            "{case} without impacts would show little"
        );
    }
}

/// Negative control: one unit in the last place of one input must show.
#[test]
fn the_comparison_sees_one_ulp() {
    let (mut scene, truth) = oracle("shot-2-96");
    scene.bodies[0].velocity[0] = scene.bodies[0].velocity[0].next_up();
    let ours = record(&scene, &engine("lecture").unwrap(), DEFAULT_DT).unwrap();
    assert_eq!(first_difference(&ours, &truth), Some((0, 0)));
}
