//! Settings beyond the presets': the length unit, a body with sweeps of its own, sleep.

use carom::engine::{
    CcdBody, EngineKind, EngineSpec, LengthScale, Precision, RapierSettings, engine, notes, plan,
    prepare, record,
};
use carom::recording::Recording;
use carom::scene::{Attraction, Contact, Rest, Scene};

use super::{body, box_of, last, scene};

/// Rapier in 64 bits with settings changed.
fn with(change: impl Fn(&mut RapierSettings)) -> EngineSpec {
    let mut settings = RapierSettings::stock(Precision::Double);
    change(&mut settings);
    EngineSpec {
        kind: EngineKind::Rapier(settings),
        ..engine("rapier-f64").unwrap()
    }
}

fn run(scene: &Scene, spec: &EngineSpec) -> Recording {
    record(scene, spec, 0.01).unwrap()
}

fn phase(scene: &Scene, spec: &EngineSpec, name: &str) -> Option<String> {
    let plan = plan(scene, spec, 0.01).unwrap();
    let phase = plan.phases.into_iter().find(|phase| phase.name == name);
    phase.map(|phase| phase.method)
}

/// A ball at 100 m/s moves 1 m a step, and the other, 8 cm thick, stands in the middle of one.
fn bullet() -> Scene {
    let bodies = vec![
        body("still", 1.0, 0.04, 2.5, 0.0),
        body("bullet", 1.0, 0.04, 0.0, 100.0),
    ];
    let mut scene = scene(0.1, bodies);
    scene.effects.contact = Some(Contact { restitution: 1.0 });
    scene
}

#[test]
fn the_fastest_body_hits_what_it_would_jump_over() {
    let scene = bullet();
    let spec = with(|settings| settings.ccd_body = CcdBody::Fastest);
    assert_eq!(run(&scene, &with(|_| ())).events.counts().contacts, 0);
    let hit = run(&scene, &spec);
    assert_eq!(hit.events.counts().contacts, 1);
    // Equal masses at e = 1 swap velocities; roundings of 100 m/s.
    assert!((last(&hit)[0].velocity.x - 100.0).abs() < 1e-10);
    let swept = phase(&scene, &spec, "sweep").unwrap();
    assert!(
        swept.starts_with("`bullet`, when fast, stops at balls"),
        "{swept}"
    );
    assert!(
        notes(&scene, &spec)
            .join("\n")
            .contains("`bullet`, faster than half a radius")
    );
    // Where balls do not meet, none is swept against another.
    let mut alone = scene;
    alone.effects.contact = None;
    assert_eq!(phase(&alone, &spec, "sweep"), None);
    alone.effects.cushions = Some(box_of(9.0, 1.0));
    let swept = phase(&alone, &spec, "sweep").unwrap();
    assert!(swept.starts_with("fast balls stop at walls ("), "{swept}");
}

/// Without sweeps at all (`max_ccd_substeps` 0) a body of its own is none.
#[test]
fn no_passes_no_sweep() {
    let spec = with(|settings| {
        settings.ccd_body = CcdBody::Fastest;
        settings.max_ccd_substeps = Some(0);
    });
    assert_eq!(run(&bullet(), &spec).events.counts().contacts, 0);
    assert_eq!(phase(&bullet(), &spec, "sweep"), None);
}

/// Rapier's cap of speeds is 400 length units a second: 16 m/s with the radius of 4 cm.
#[test]
fn the_length_unit_follows_the_smallest_ball_whatever_the_label() {
    let spec = with(|settings| settings.length_scale = LengthScale::SmallestRadius(1.0));
    let mut scene = bullet();
    scene.bodies[0].radius = 0.05;
    let drift = |scene: &Scene| phase(scene, &spec, "drift").unwrap();
    assert!(
        drift(&scene).ends_with("speeds cut at 16"),
        "{}",
        drift(&scene)
    );
    let capped = run(&scene, &spec);
    // The first sample is one step on: at 16 m/s, but for the rounding of 0.04 x 400 x 0.01.
    assert!((capped.sample(1)[1].position.x - 0.16).abs() < 1e-12);
    let in_metres = capped;
    scene.units.length = carom::scene::LengthUnit::Millimetre;
    assert!(in_metres.samples().eq(run(&scene, &spec).samples()));
    let free = with(|settings| {
        settings.length_scale = LengthScale::SmallestRadius(1.0);
        settings.speed_cap = false;
    });
    assert!((run(&scene, &free).sample(1)[1].position.x - 1.0).abs() < 1e-12);
}

/// 5 cm/s is below Rapier's threshold (10 cm/s in metres, for 0.5 s): the ball freezes until it
/// is hit.
#[test]
fn a_slow_ball_falls_asleep_and_a_hit_awakens_it() {
    let bodies = vec![
        body("slow", 1.0, 0.1, 0.0, 0.05),
        body("late", 1.0, 0.1, -3.0, 1.0),
    ];
    let mut scene = scene(4.0, bodies);
    scene.effects.contact = Some(Contact { restitution: 1.0 });
    let spec = with(|settings| settings.sleeping = true);
    assert!(spec.describe().ends_with("sleeping allowed."));
    assert_eq!(
        phase(&scene, &spec, "sleep").unwrap(),
        "slower than 0.1 for 0.5 s: asleep"
    );
    assert_eq!(phase(&scene, &with(|_| ()), "sleep"), None);
    let run = run(&scene, &spec);
    let at = |sample: usize| run.sample(sample)[0];
    // Asleep from 0.5 s on, to a step or two; samples are 0.4 s apart.
    assert_eq!(at(3).position, at(5).position);
    assert!((0.024..0.03).contains(&at(3).position.x), "{:?}", at(3));
    assert_eq!(run.events.counts().contacts, 1);
    assert!(at(10).velocity.x > 0.9, "{:?}", at(10));
}

/// A force that carom adds is one that a user would add: it awakens its body.
#[test]
fn who_is_pulled_does_not_sleep() {
    let bodies = vec![body("a", 1.0, 0.1, 0.0, 0.0), body("b", 1.0, 0.1, 1.0, 0.0)];
    let mut scene = scene(4.0, bodies);
    scene.effects.attraction = Some(Attraction {
        constant: 1e-3,
        softening: 0.0,
    });
    let asleep = run(&scene, &with(|settings| settings.sleeping = true));
    assert!(asleep.samples().eq(run(&scene, &with(|_| ())).samples()));
    assert!(last(&asleep)[0].position.x > 5e-3, "it moves");
}

/// A stop by carom is no sleep by Rapier: stopped balls take a hit like any other, and a world
/// put back to its start is awake.
#[test]
fn stops_and_fresh_starts_are_awake() {
    let bodies = vec![
        body("stops", 1.0, 0.1, 0.0, 0.2),
        body("late", 1.0, 0.1, -3.0, 1.0),
    ];
    let mut scene = scene(4.0, bodies);
    scene.effects.contact = Some(Contact { restitution: 1.0 });
    scene.effects.rest = Some(Rest { speed: 0.3 });
    let spec = with(|settings| settings.sleeping = true);
    let once = run(&scene, &spec);
    assert_eq!(once.events.counts().contacts, 1);
    assert!(last(&once)[0].velocity.x > 0.9);
    let mut simulation = prepare(&scene, &spec, 0.01).unwrap();
    simulation.advance_to(6, None);
    simulation.set_state(0, once.sample(0));
    simulation.advance_to(scene.sample_count(), None);
    let mut states = once.sample(0).to_vec();
    simulation.state_into(&mut states);
    assert_eq!(states, last(&once));
}
