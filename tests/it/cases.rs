//! Every reference case: whole, readable, and near its truth as far as the method promises.

use carom::case::{Case, Library};
use carom::compare::{Divergence, Sizes, compare_events, metrics};
use carom::scene;

use crate::scenes::lecture;

fn cases() -> Vec<Case> {
    let library = Library::Embedded;
    library
        .names()
        .unwrap()
        .iter()
        .map(|name| library.case(name).unwrap())
        .collect()
}

#[test]
fn the_lecture_is_covered() {
    let cases = cases();
    assert!(cases.len() >= 18, "{} cases", cases.len());
    for case in &cases {
        let name = &case.scene.name;
        assert!(case.scene.title.is_some(), "{name} has no title");
        assert!(case.scene.source.is_some(), "{name} names no slide");
        assert!(
            case.scene.watch.is_some(),
            "{name} does not say what to look for"
        );
        assert!(
            case.truth.is_none() || case.origin.is_some(),
            "{name}: truth without origin"
        );
        assert!(
            case.scene.warnings().is_empty(),
            "{name}: {:?}",
            case.scene.warnings()
        );
    }
}

#[test]
fn a_scene_written_and_read_again_is_the_same_scene() {
    for case in cases() {
        let text = scene::to_toml(&case.scene).unwrap();
        assert_eq!(scene::parse(&text, "again").unwrap(), case.scene);
    }
}

/// Without impacts the method is of first order: a tenth of the step, a tenth of the error.
/// The bounds leave 15 % for the next order.
#[test]
fn the_error_against_truth_falls_with_the_step_where_nothing_collides() {
    let mut seen = 0;
    for case in cases() {
        let Some(truth) = &case.truth else { continue };
        if truth.events.impacts().count() > 0 {
            continue;
        }
        let error = |dt: f64| {
            let recording = lecture(&case.scene, dt);
            Divergence::between(&case.scene, &recording, truth)
                .largest()
                .max_position
        };
        // Steps that divide every sample distance of these cases into whole numbers.
        let step = case.scene.sample_every / 64.0;
        let ratio = error(step) / error(step / 10.0);
        assert!(
            (8.5..11.5).contains(&ratio),
            "{}: ratio {ratio}",
            case.scene.name
        );
        seen += 1;
    }
    assert!(seen >= 5, "{seen} cases");
}

/// With one impact the position is off by a fraction of a step of travel, so a small step
/// comes near, and every impact is found in order.
#[test]
fn small_steps_find_every_impact_of_two_bodies() {
    for name in [
        "headon-equal",
        "oblique-inelastic",
        "inelastic-e05",
        "oblique-elastic",
    ] {
        let case = Library::Embedded.case(name).unwrap();
        let truth = case.truth.as_ref().unwrap();
        let recording = lecture(&case.scene, 1e-4);
        let size = Sizes::of(truth, &metrics(&case.scene, truth)).length;
        let error = Divergence::between(&case.scene, &recording, truth)
            .largest()
            .max_position;
        assert!(error < 1e-3 * size, "{name}: {error}");
        let agreement = compare_events(&case.scene, &recording, truth);
        assert_eq!(agreement.first_disagreement, None, "{name}");
        assert_eq!(agreement.matched, truth.events.impacts().count(), "{name}");
        assert!(
            agreement.time_difference_max <= 1e-4,
            "{name}: late by more than a step"
        );
    }
}
