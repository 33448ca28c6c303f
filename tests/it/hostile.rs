//! Scenes made to hurt: nothing panics, and no recording holds a number that is not finite.

use std::cell::RefCell;

use carom::engine::{EngineKind, EngineSpec, engine, engines, record};
use carom::error::Error;
use carom::scene::{Attraction, Contact, Cushions, Drag, Effects, Gravity, Rest, Scene, Spring};
use proptest::prelude::*;
use proptest::strategy::ValueTree;
use proptest::test_runner::{RngAlgorithm, TestRng, TestRunner};
use rayon::prelude::*;

use crate::scenes::{body, scene};

/// How far the numbers go.
#[derive(Debug, Clone, Copy)]
enum Reach {
    /// As far as doubles do: what Rapier mostly refuses.
    Wild,
    /// As far as the squares and inverses of 32 bits do.
    Tame,
}

fn number(reach: Reach) -> BoxedStrategy<f64> {
    let near = prop_oneof![
        Just(0.0),
        Just(1.0),
        Just(1.0 + 1e-12),
        Just(-1.0),
        -2.0..2.0
    ];
    let far = match reach {
        Reach::Wild => [1e-300, 1e150, -1e300],
        Reach::Tame => [1e-9, 1e6, -1e9],
    };
    prop_oneof![5 => near, 3 => proptest::sample::select(far.to_vec())].boxed()
}

fn size(reach: Reach) -> BoxedStrategy<f64> {
    let far = match reach {
        Reach::Wild => [1e-300, 1e9, 1e-9, 1e300],
        Reach::Tame => [1e-3, 1e4, 1e-6, 1e6],
    };
    prop_oneof![1 => Just(0.5), 1 => 0.1..2.0, 4 => proptest::sample::select(far.to_vec())].boxed()
}

fn effects(reach: Reach) -> impl Strategy<Value = Effects> {
    let fraction = || prop_oneof![Just(0.0), Just(1.0), 0.0..1.0];
    (
        proptest::option::of(fraction()),
        proptest::option::of((
            size(reach),
            size(reach),
            proptest::option::of(size(reach)),
            fraction(),
        )),
        proptest::option::of(size(reach)),
        proptest::option::of(size(reach)),
        proptest::option::of((number(reach), prop_oneof![Just(0.0), Just(0.1)])),
        proptest::option::of([number(reach), number(reach), number(reach)]),
        proptest::option::of((size(reach), size(reach), size(reach))),
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

fn hostile(reach: Reach) -> impl Strategy<Value = Scene> {
    let vector = || [number(reach), number(reach), number(reach)];
    let sphere = (size(reach), size(reach), vector(), vector());
    (proptest::collection::vec(sphere, 2..5), effects(reach)).prop_map(|(spheres, effects)| {
        let names = ["a", "b", "c", "d"];
        let bodies = spheres
            .into_iter()
            .zip(names)
            .map(|((mass, radius, x, v), name)| body(name, mass, radius, x, v))
            .collect();
        scene(0.5, 0.125, bodies, effects)
    })
}

/// Recordings of one engine.
#[derive(Debug, Clone, Copy, Default)]
struct Kept {
    /// Scenes given, those that failed in earlier runs included.
    given: u32,
    /// Recordings made; the other scenes were refused.
    recorded: u32,
    /// Those that reached the end of their scene.
    finished: u32,
}

const CASES: u32 = 200;

/// Work that the exact engine may take for one of these scenes.
const OPERATIONS: u64 = 20_000_000;

/// The engine with a bound on its work that lets hundreds of scenes pass in seconds.
pub fn in_short(mut spec: EngineSpec) -> EngineSpec {
    if let EngineKind::Exact(settings) = &mut spec.kind {
        settings.operations = OPERATIONS;
    }
    spec
}

/// How many of the scenes an engine must record, and finish, at the least, in per cent.
///
/// Measured over 2000 scenes: the lecture refuses none and brings 55 % to the end; the Rapier
/// worlds record 51 % to 56 %, which are the tame half and a few, and finish 48 %, as the
/// matched one does 40 %. Five deviations of 200 draws, 18 %, lie between these and the bounds.
/// The exact engine refuses spheres that overlap at the start and rest with a force, and records
/// 25 %; 10 % and, in doubles, 13 % get to the end within the work allowed here. Of the rungs of
/// the ladder those with exact drag finish 62 % to 64 %, Runge-Kutta 53 %, with its
/// own steps 48 %; `robust` 84 %.
fn shares(engine: &str) -> [u32; 2] {
    match engine {
        "lecture" | "lecture-in-place" => [100, 37],
        "exact-drag" | "verlet" | "swept" => [100, 44],
        "swept-4" => [100, 35],
        "adaptive" => [100, 30],
        "robust" => [100, 66],
        "rapier" | "rapier-f64" | "rapier-tuned" => [32, 30],
        "rapier-matched" => [32, 22],
        "exact" | "exact-fast" => [9, 1],
        other => panic!("measure how many of these scenes `{other}` records, and state it"),
    }
}

/// What one engine does with one scene.
fn run(scene: &Scene, spec: &EngineSpec, dt: f64, kept: &mut Kept) -> Result<(), TestCaseError> {
    kept.given += 1;
    let recording = match record(scene, spec, dt) {
        Ok(recording) => recording,
        // A refusal names what the engine cannot do; the shares below bound how often.
        Err(Error::EngineCannot { .. }) if !matches!(spec.kind, EngineKind::Impulse(_)) => {
            return Ok(());
        }
        Err(error) => return Err(TestCaseError::fail(format!("{}: {error}", spec.name))),
    };
    kept.recorded += 1;
    kept.finished += u32::from(recording.outcome.is_finished());
    let finite = recording.samples().flatten().all(|state| state.is_finite());
    prop_assert!(finite, "{}", spec.name);
    let complete = recording.sample_count() == scene.sample_count() + 1;
    prop_assert!(complete == recording.outcome.is_finished(), "{}", spec.name);
    Ok(())
}

/// A speed whose square is no number used to give states that are none.
#[test]
fn a_speed_without_a_square_ends_the_recording_before_it_is_lost() {
    let bodies = vec![
        body("a", 0.5, 0.5, [-1e300, 0.0, 0.0], [0.0, 0.0, -1e300]),
        body("b", 0.5, 0.5, [-1e300, 0.0, 1e150], [0.0, 0.0, 0.0]),
    ];
    let spring = Spring {
        between: ["a".into(), "b".into()],
        stiffness: 0.5,
        rest_length: 0.5,
        damping: 0.5,
    };
    let effects = Effects {
        contact: Some(Contact { restitution: 0.0 }),
        springs: vec![spring],
        ..Effects::default()
    };
    let scene = scene(0.5, 0.125, bodies, effects);
    for name in ["exact", "exact-fast"] {
        let mut kept = Kept::default();
        run(&scene, &in_short(engine(name).unwrap()), 0.01, &mut kept).unwrap();
        assert_eq!(kept.recorded, 1, "{name}");
    }
}

#[test]
fn no_engine_panics_or_records_a_nan() {
    let built = engines().into_iter().filter(EngineSpec::is_built);
    let specs: Vec<_> = built.map(in_short).collect();
    let kept = RefCell::new(vec![Kept::default(); specs.len()]);
    let mut runner = TestRunner::new(ProptestConfig {
        cases: CASES,
        source_file: Some(file!()),
        ..ProptestConfig::default()
    });
    let scenes = prop_oneof![hostile(Reach::Wild), hostile(Reach::Tame)];
    let input = (scenes, prop_oneof![Just(0.01), Just(1.0)]);
    let outcome = runner.run(&input, |(scene, dt)| {
        prop_assert!(scene.check().is_ok(), "the generator makes scenes");
        for (spec, kept) in specs.iter().zip(kept.borrow_mut().iter_mut()) {
            run(&scene, spec, dt, kept)?;
        }
        Ok(())
    });
    if let Err(found) = outcome {
        panic!("{found}");
    }
    for (spec, kept) in specs.iter().zip(kept.take()) {
        let Kept {
            given,
            recorded,
            finished,
        } = kept;
        let name = &spec.name;
        println!("{name}: {recorded} of {given} recorded, {finished} to the end");
        let [least_recorded, least_finished] = shares(name);
        assert!(given >= CASES, "{name}: {given} scenes");
        assert!(
            100 * recorded >= least_recorded * given,
            "{name}: {recorded} of {given} recorded, must be {least_recorded} %"
        );
        assert!(
            100 * finished >= least_finished * given,
            "{name}: {finished} of {given} to the end, must be {least_finished} %"
        );
    }
}

/// So many hostile scenes with their steps, the same in every run.
pub fn drawn(count: usize) -> Vec<(Scene, f64)> {
    let rng = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    let mut runner = TestRunner::new_with_rng(ProptestConfig::default(), rng);
    let scenes = prop_oneof![hostile(Reach::Wild), hostile(Reach::Tame)];
    let input = (scenes, prop_oneof![Just(0.01), Just(1.0)]);
    (0..count)
        .map(|_| input.new_tree(&mut runner).unwrap().current())
        .collect()
}

/// So many scenes from one seed, spread over the engines in turn.
const MANY: usize = 20_000;

/// Every scene is the same in every run. Nothing panics, no number that is none is recorded, and
/// what ends early says how; a hang would be seen by who waits.
#[test]
#[ignore = "a minute or two: .ci/run runs it"]
fn twenty_thousand_hostile_scenes_leave_no_engine_without_an_answer() {
    let built = engines().into_iter().filter(EngineSpec::is_built);
    let specs: Vec<_> = built.map(in_short).collect();
    let kept: Vec<(usize, Kept)> = drawn(MANY)
        .par_iter()
        .enumerate()
        .map(|(place, (scene, dt))| {
            let engine = place % specs.len();
            let mut kept = Kept::default();
            if let Err(wrong) = run(scene, &specs[engine], *dt, &mut kept) {
                panic!("{}, scene {place}: {wrong}", specs[engine].name);
            }
            (engine, kept)
        })
        .collect();
    let mut tried = 0;
    for (engine, spec) in specs.iter().enumerate() {
        let own = kept.iter().filter(|(by, _)| *by == engine);
        let sum = |count: fn(&Kept) -> u32| own.clone().map(|(_, kept)| count(kept)).sum::<u32>();
        let [given, recorded, finished] = [
            sum(|kept| kept.given),
            sum(|kept| kept.recorded),
            sum(|kept| kept.finished),
        ];
        println!(
            "{}: {given} scenes, {recorded} recorded, {finished} to the end",
            spec.name
        );
        tried += given;
    }
    println!("{tried} hostile scenes tried");
    assert_eq!(tried as usize, MANY);
}
