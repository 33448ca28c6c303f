//! The words for what is left of an error as the step goes to 0, on real engines.

use carom::case::Library;
use carom::compare::{Limit, Remainder};
use carom::engine::engine;
use carom::scene::{Drag, Effects, Scene};
use carom::study::Timing;
use carom::study::cost::{CostOptions, SceneCost, scene_cost};

use crate::scenes::{body, scene};

/// Work a run may take: enough for ten halvings and more of the step on the scenes here.
fn study(scene: &Scene, names: &[&str], budget: u64) -> SceneCost {
    let specs: Vec<_> = names.iter().map(|name| engine(name).unwrap()).collect();
    let options = CostOptions {
        timing: Timing {
            seed: 1,
            repetitions: 1,
        },
        budget,
        phases: 7,
        runs: 1,
    };
    scene_cost(scene, &specs, &options, &|_, _, _| {}).unwrap()
}

fn limit_of(study: &SceneCost, name: &str) -> Limit {
    let limits = study.limits(1);
    let row = limits.iter().find(|row| row.engine == name).unwrap();
    row.limit.unwrap()
}

fn case(name: &str) -> Scene {
    Library::Embedded.case(name).unwrap().scene
}

/// Symplectic Euler converges on an orbit: nothing stays.
#[test]
fn the_lecture_on_an_orbit_is_discretisation() {
    let study = study(&case("kepler-circle"), &["lecture"], 100_000);
    let limit = limit_of(&study, "lecture");
    assert_eq!(limit.kind, Remainder::Discretisation, "{limit:?}");
    assert!(limit.stays.unwrap().low < 0.05 * limit.finest, "{limit:?}");
    // As tests/it/orders.rs has it.
    assert!((limit.slope.unwrap() - 1.0).abs() < 0.15, "{limit:?}");
}

/// The decay under drag is exact, so that rounding alone is left, at every step.
#[test]
fn exact_drag_on_pure_drag_is_rounding() {
    let effects = Effects {
        drag: Some(Drag { coefficient: 0.8 }),
        ..Effects::default()
    };
    let ball = body("a", 2.0, 0.1, [0.5, 0.0, 0.0], [3.0, -1.0, 0.0]);
    let study = study(
        &scene(2.0, 0.5, vec![ball], effects),
        &["exact-drag", "lecture"],
        5000,
    );
    assert_eq!(limit_of(&study, "exact-drag").kind, Remainder::Rounding);
    let lecture = limit_of(&study, "lecture");
    assert_eq!(lecture.kind, Remainder::Discretisation, "{lecture:?}");
    let orders = study.orders();
    assert!(
        orders
            .iter()
            .all(|row| row.engine != "exact-drag" || row.fit.order.is_none())
    );
}

/// Two bodies of different k/m and one impact: the overlap rungs are of order 1, the swept ones
/// keep theirs, each over seven phases of the step and from four points at least.
#[test]
fn orders_over_phases_are_the_stated_ones() {
    let effects = Effects {
        drag: Some(Drag { coefficient: 0.4 }),
        contact: Some(carom::scene::Contact { restitution: 0.8 }),
        attraction: Some(carom::scene::Attraction {
            constant: 1.0,
            softening: 0.0,
        }),
        ..Effects::default()
    };
    let bodies = vec![
        body("a", 2.0, 0.3, [-1.5, 0.1, 0.0], [1.4, 0.0, 0.1]),
        body("b", 1.0, 0.2, [1.2, 0.0, 0.1], [-0.5, 0.0, 0.0]),
    ];
    let scene = scene(3.0, 0.25, bodies, effects);
    let names = ["lecture", "exact-drag", "verlet", "swept", "swept-4"];
    let study = study(&scene, &names, 100_000);
    assert_eq!(study.phases.len(), 7);
    let orders = study.orders();
    for (name, stated) in names.into_iter().zip([1.0, 1.0, 1.0, 2.0, 4.0]) {
        let row = orders
            .iter()
            .find(|row| row.engine == name && row.error == "position_error_rms");
        let fit = row.unwrap().fit;
        assert!(fit.points >= 4, "{name}: {fit:?}");
        let order = fit.order.unwrap();
        // As tests/it/orders.rs has it.
        assert!((order.order - stated).abs() < 0.15, "{name}: {order:?}");
        // Order 4 has come down to the floor where order 2 is at 1e-9.
        let kind = if name == "swept-4" {
            Remainder::Rounding
        } else {
            Remainder::Discretisation
        };
        let limit = limit_of(&study, name);
        assert_eq!(limit.kind, kind, "{name}: {limit:?}");
    }
}

/// Rapier's damper acts along the spring, the lecture's against all of the relative velocity: the
/// one converges to another motion, the other on the same scene does not.
#[cfg(feature = "rapier")]
#[test]
fn another_damper_is_another_model() {
    let study = study(&case("spring-under"), &["lecture", "rapier-f64"], 10_000);
    let rapier = limit_of(&study, "rapier-f64");
    assert_eq!(rapier.kind, Remainder::Model, "{rapier:?}");
    let stays = rapier.stays.unwrap();
    assert!(stays.low > 0.9 * rapier.finest && stays.high < 1.1 * rapier.finest);
    assert_eq!(limit_of(&study, "lecture").kind, Remainder::Discretisation);
}
