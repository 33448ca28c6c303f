//! Scenes made to hurt: nothing panics, and no recording holds a number that is not finite.

use carom::engine::{engines, record};
use carom::scene::{Attraction, Contact, Cushions, Drag, Effects, Gravity, Rest, Scene, Spring};
use proptest::prelude::*;

use crate::scenes::{body, scene};

fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        Just(0.0),
        Just(1.0),
        Just(1.0 + 1e-12),
        Just(-1.0),
        -2.0..2.0,
        Just(1e-300),
        Just(1e150),
        Just(-1e300),
    ]
}

fn size() -> impl Strategy<Value = f64> {
    prop_oneof![
        Just(0.5),
        Just(1e-300),
        Just(1e9),
        Just(1e-9),
        0.1..2.0,
        Just(1e300)
    ]
}

fn effects() -> impl Strategy<Value = Effects> {
    let fraction = || prop_oneof![Just(0.0), Just(1.0), 0.0..1.0];
    (
        proptest::option::of(fraction()),
        proptest::option::of((size(), size(), proptest::option::of(size()), fraction())),
        proptest::option::of(size()),
        proptest::option::of(size()),
        proptest::option::of((number(), prop_oneof![Just(0.0), Just(0.1)])),
        proptest::option::of([number(), number(), number()]),
        proptest::option::of((size(), size(), size())),
    )
        .prop_map(
            |(contact, cushions, drag, rest, attraction, gravity, spring)| Effects {
                contact: contact.map(|restitution| Contact { restitution }),
                cushions: cushions.map(|(half_width, half_length, half_height, restitution)| {
                    Cushions {
                        half_width,
                        half_length,
                        half_height,
                        restitution,
                    }
                }),
                drag: drag.map(|coefficient| Drag { coefficient }),
                rest: rest.map(|speed| Rest { speed }),
                attraction: attraction.map(|(constant, softening)| Attraction {
                    constant,
                    softening,
                }),
                gravity: gravity.map(|acceleration| Gravity { acceleration }),
                springs: spring
                    .map(|(stiffness, rest_length, damping)| Spring {
                        between: ["a".into(), "b".into()],
                        stiffness,
                        rest_length,
                        damping,
                    })
                    .into_iter()
                    .collect(),
            },
        )
}

fn hostile() -> impl Strategy<Value = Scene> {
    let vector = || [number(), number(), number()];
    let sphere = (size(), size(), vector(), vector());
    (proptest::collection::vec(sphere, 2..5), effects()).prop_map(|(spheres, effects)| {
        let names = ["a", "b", "c", "d"];
        let bodies = spheres
            .into_iter()
            .zip(names)
            .map(|((mass, radius, x, v), name)| body(name, mass, radius, x, v))
            .collect();
        scene(0.5, 0.125, bodies, effects)
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn no_engine_panics_or_records_a_nan(scene in hostile(), dt in prop_oneof![Just(0.01), Just(1.0)]) {
        prop_assume!(scene.check().is_ok());
        for spec in engines().into_iter().filter(carom::engine::EngineSpec::is_built) {
            // An engine may refuse a scene by name; it may not panic or keep a NaN.
            let Ok(recording) = record(&scene, &spec, dt) else { continue };
            let finite = recording.samples().flatten().all(|state| state.is_finite());
            prop_assert!(finite, "{}", spec.name);
            let complete = recording.sample_count() == scene.sample_count() + 1;
            prop_assert!(complete == recording.outcome.is_finished(), "{}", spec.name);
        }
    }
}
