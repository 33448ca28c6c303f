//! The plan tells what runs: the phases listed are those of the effects declared, and an effect
//! whose phase is listed changes the motion.

use carom::engine::{engine, plan};
use carom::recording::Recording;
use carom::scene::{
    Attraction, Body, Contact, Cushions, Drag, Effects, Gravity, Rest, Scene, Spring,
};

use crate::scenes::{apart, body, lecture, scene};

const DT: f64 = 0.01;

/// Declares one effect, strongly.
type Declare = fn(&mut Effects);

/// The effects by the name of their phase, in the order of the step.
const EFFECTS: [(&str, Declare); 7] = [
    ("attraction", |e| {
        e.attraction = Some(Attraction {
            constant: 30.0,
            softening: 0.5,
        });
    }),
    ("drag", |e| e.drag = Some(Drag { coefficient: 5.0 })),
    ("springs", |e| {
        e.springs = vec![Spring {
            between: ["a".into(), "c".into()],
            stiffness: 40.0,
            rest_length: 1.0,
            damping: 0.0,
        }];
    }),
    ("gravity", |e| {
        e.gravity = Some(Gravity {
            acceleration: [0.0, 0.0, -20.0],
        });
    }),
    ("rest", |e| e.rest = Some(Rest { speed: 1.0 })),
    ("cushions", |e| {
        e.cushions = Some(Cushions {
            half_width: 3.0,
            half_length: 9.0,
            half_height: None,
            restitution: 0.5,
        });
    }),
    ("contacts", |e| {
        e.contact = Some(Contact { restitution: 0.5 })
    }),
];

/// How many effects at the head of [`EFFECTS`] are forces, which the kick applies.
const FORCES: usize = 4;

/// Two spheres that overlap and approach, and a slow one beyond a cushion: every effect has
/// something to do in the first step already, whatever others are there.
fn bodies() -> Vec<Body> {
    vec![
        body("a", 1.0, 0.5, [0.0, 0.0, 0.0], [4.0, 0.0, 1.0]),
        body("b", 2.0, 0.5, [0.7, 0.1, 0.0], [-2.0, 0.0, 3.0]),
        body("c", 1.5, 0.5, [2.7, 1.0, 0.0], [0.4, 0.2, 0.1]),
    ]
}

/// The scene with the effects whose bit is set.
fn with_effects(declared: usize) -> Scene {
    let mut effects = Effects::default();
    for (place, (_, declare)) in EFFECTS.iter().enumerate() {
        if declared & (1 << place) != 0 {
            declare(&mut effects);
        }
    }
    scene(10.0 * DT, DT, bodies(), effects)
}

/// What must run, from the rule alone: forces between clear and kick, drift always, the rest
/// after it.
fn expected(declared: usize) -> Vec<&'static str> {
    let named = |places: std::ops::Range<usize>| {
        let is_declared = move |place: &usize| declared & (1 << place) != 0;
        places.filter(is_declared).map(|place| EFFECTS[place].0)
    };
    let mut phases: Vec<_> = named(0..FORCES).collect();
    if !phases.is_empty() {
        phases.insert(0, "clear");
        phases.push("kick");
    }
    phases.push("drift");
    phases.extend(named(FORCES..EFFECTS.len()));
    phases
}

#[test]
fn the_phases_are_those_of_the_effects_declared() {
    let spec = engine("lecture").unwrap();
    for declared in 0..1 << EFFECTS.len() {
        let plan = plan(&with_effects(declared), &spec, DT).unwrap();
        let names: Vec<_> = plan.phases.iter().map(|phase| phase.name).collect();
        assert_eq!(names, expected(declared), "effects {declared:07b}");
    }
}

/// The same for `robust`: safeguards only where an effect can need them.
fn expected_of_robust(declared: usize) -> Vec<&'static str> {
    let has = |name: &str| {
        let place = EFFECTS.iter().position(|(own, _)| *own == name);
        place.is_some_and(|place| declared & (1 << place) != 0)
    };
    let meets = has("cushions") || has("contacts");
    let joined = has("attraction") || has("springs");
    [
        ("room", meets),
        ("length", joined),
        ("attraction", has("attraction")),
        ("drag", has("drag")),
        ("springs", has("springs")),
        ("gravity", has("gravity")),
        ("pushes", meets && (joined || has("gravity"))),
        ("motion", true),
        ("rest", has("rest")),
        ("cushions", has("cushions")),
        ("contacts", has("contacts")),
    ]
    .into_iter()
    .filter_map(|(name, present)| present.then_some(name))
    .collect()
}

#[test]
fn the_phases_of_robust_are_the_safeguards_that_a_scene_can_need() {
    let spec = engine("robust").unwrap();
    for declared in 0..1 << EFFECTS.len() {
        let plan = plan(&with_effects(declared), &spec, DT).unwrap();
        let names: Vec<_> = plan.phases.iter().map(|phase| phase.name).collect();
        assert_eq!(
            names,
            expected_of_robust(declared),
            "effects {declared:07b}"
        );
    }
}

/// Ten steps are enough for every effect to move some body by 1 % of a radius, beside any
/// others: a phase that is listed and not run, or run without its effect, would move none.
#[test]
fn a_phase_that_is_listed_is_run() {
    let runs: Vec<Recording> = (0..1 << EFFECTS.len())
        .map(|declared| lecture(&with_effects(declared), DT))
        .collect();
    let mut compared = 0;
    for (declared, run) in runs.iter().enumerate() {
        for (place, (name, _)) in EFFECTS.iter().enumerate() {
            let without = declared & !(1 << place);
            if without == declared {
                continue;
            }
            let moved = apart(run, &runs[without]);
            assert!(moved > 0.005, "{name} in {declared:07b} moved {moved:e}");
            compared += 1;
        }
    }
    assert_eq!(compared, EFFECTS.len() << (EFFECTS.len() - 1));
}
