//! The ledger adds up: what each phase books is what energy and momentum change by.

use carom::case::Library;
use carom::compare::metrics;
use carom::engine::{EngineKind, EngineSpec, StepGrid, engine, engines, prepare};
use carom::physics::Vector3;
use carom::recording::{Account, Entry, Ledger, Recording, initial_states};
use carom::scene::Scene;

/// The hand-written engines, which keep books.
fn bookkeepers() -> Vec<EngineSpec> {
    let all = engines().into_iter();
    all.filter(|spec| matches!(spec.kind, EngineKind::Impulse(_)))
        .collect()
}

/// The books at the end of a run, with the change of energy and momentum over it, and the scale of
/// the rounding on the way: largest energy, largest momentum, and the number of steps.
fn booked(scene: &Scene, spec: &EngineSpec, dt: f64) -> Option<(Ledger, Entry, [f64; 2])> {
    let mut simulation = prepare(scene, spec, dt).unwrap();
    assert!(simulation.keep_ledger());
    let mut recording = Recording::at_start(&spec.name, scene);
    let mut states = initial_states(scene);
    for sample in 1..=scene.sample_count() {
        simulation.advance_to(sample, None);
        simulation.state_into(&mut states);
        if !states.iter().all(|state| state.is_finite()) {
            return None;
        }
        recording.push(&states);
    }
    let measured = metrics(scene, &recording);
    let (first, last) = (&measured[0], measured.last()?);
    let scale =
        |value: fn(&carom::compare::Metrics) -> f64| measured.iter().map(value).fold(0.0, f64::max);
    let change = Entry {
        energy: last.total_energy() - first.total_energy(),
        momentum: last.momentum - first.momentum,
    };
    let scales = [
        scale(carom::compare::Metrics::energy_scale),
        scale(|at| at.momentum_scale),
    ];
    Some((*simulation.ledger()?, change, scales))
}

/// Entries add up over so many steps, each with some roundings of the scale.
#[allow(clippy::cast_precision_loss)]
fn rounding(scene: &Scene, dt: f64) -> f64 {
    let steps = StepGrid::new(scene, dt).unwrap().steps_per_sample * scene.sample_count() as u64;
    64.0 * f64::EPSILON * (steps as f64 + 100.0)
}

const CASES: [&str; 8] = [
    "shot-2-61",
    "rack-break",
    "bounce-floor",
    "spring-chain",
    "spring-under-simple",
    "kepler-e06",
    "falling-pair",
    "cluster-8",
];

#[test]
fn entries_add_up_to_the_change_of_energy_and_momentum() {
    for name in CASES {
        let mut scene = Library::Embedded.case(name).unwrap().scene;
        scene.duration = scene.duration.min(24.0 * scene.sample_every);
        for spec in bookkeepers() {
            let dt = 0.01;
            let Some((ledger, change, [energy, momentum])) = booked(&scene, &spec, dt) else {
                panic!("{name} {}: not finite", spec.name);
            };
            let sum = ledger.sum();
            let allowed = rounding(&scene, dt);
            let off = (sum.energy - change.energy).abs();
            let turnover = energy + ledger.turnover;
            assert!(
                off <= allowed * turnover,
                "{name} {}: {off:e} of {turnover}",
                spec.name
            );
            let off = (sum.momentum - change.momentum).norm();
            assert!(
                off <= allowed * momentum,
                "{name} {}: {off:e} of {momentum}",
                spec.name
            );
        }
    }
}

/// A phase that books the restitution of another e is found out.
#[test]
fn a_phase_that_lies_is_found_out() {
    let scene = Library::Embedded.case("rack-break").unwrap().scene;
    let spec = engine("lecture").unwrap();
    let (mut ledger, change, [energy, _]) = booked(&scene, &spec, 0.01).unwrap();
    let honest = ledger.of(Account::Contacts);
    assert!(honest.energy < 0.0);
    let lie = Entry {
        energy: 1e-6 * honest.energy,
        momentum: Vector3::zeros(),
    };
    ledger.book(Account::Contacts, lie);
    let off = (ledger.sum().energy - change.energy).abs();
    assert!(off > rounding(&scene, 0.01) * energy, "{off:e}");
}

/// On a table with cushions only they, drag and rest change the momentum.
#[test]
fn momentum_is_judged_on_a_table_with_cushions() {
    let scene = Library::Embedded.case("shot-2-61").unwrap().scene;
    let (ledger, ..) = booked(&scene, &engine("lecture").unwrap(), 0.01).unwrap();
    for account in [
        Account::Contacts,
        Account::PushOut,
        Account::Gravity,
        Account::Dampers,
    ] {
        assert_eq!(
            ledger.of(account).momentum,
            Vector3::zeros(),
            "{}",
            account.name()
        );
    }
    for account in [Account::Cushions, Account::Drag] {
        assert!(
            ledger.of(account).momentum.norm() > 0.0,
            "{}",
            account.name()
        );
    }
}

/// In the lecture's cluster it is the push-out, or the integrator, that heats; `robust` heats by
/// nothing.
#[test]
fn the_scheme_robust_has_no_account_that_gives_energy() {
    for name in CASES {
        let mut scene = Library::Embedded.case(name).unwrap().scene;
        scene.duration = scene.duration.min(24.0 * scene.sample_every);
        let (ledger, _, [energy, _]) = booked(&scene, &engine("robust").unwrap(), 0.01).unwrap();
        for account in Account::ALL {
            let given = ledger.of(account).energy;
            if account == Account::Integrator
                && (scene.effects.drag.is_some()
                    || scene.effects.springs.iter().any(|s| s.damping > 0.0))
            {
                // Drag and dampers are booked by the mean velocity; the rest of what they take,
                // which is never below that, stands with the integrator.
                assert!(given <= 1e-12 * energy, "{name}: {given:e}");
                continue;
            }
            assert!(
                given.abs() <= 1e-12 * energy || given < 0.0,
                "{name} {}: {given:e}",
                account.name()
            );
        }
    }
}
