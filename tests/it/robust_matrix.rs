//! `robust` on every hard case at every step of it: nothing that must hold breaks, and what holds
//! for any scheme of its kind does so to rounding.

use carom::case::{Expected, Library};
use carom::compare::{Metrics, Sizes, horizon, metrics};
use carom::engine::{drive, engine, prepare, record};
use carom::physics::Vector3;
use carom::recording::{Account, Recording};
use carom::scene::{Body, Scene};
use carom::study::breaches;
use rayon::prelude::*;

const LIBRARY: Library = Library::EmbeddedHard;

/// Every case with every step that it asks for.
fn matrix() -> Vec<(Scene, Expected, f64)> {
    let names = LIBRARY.names().unwrap();
    let cases = names.iter().map(|name| LIBRARY.case(name).unwrap());
    let runs = cases.flat_map(|case| {
        let expected = case.expected.unwrap();
        let steps = expected.dt.clone();
        let scene = case.scene;
        steps
            .into_iter()
            .map(move |dt| (scene.clone(), expected.clone(), dt))
    });
    runs.collect()
}

/// The share of its scale by which the energy rises above its start without a booked source.
fn gained(measured: &[Metrics], pushed_out: f64) -> f64 {
    let scale = largest(measured, Metrics::energy_scale);
    let most = largest(measured, |at| {
        at.total_energy() - measured[0].total_energy() - pushed_out.max(0.0)
    });
    if most > 0.0 { most / scale } else { 0.0 }
}

/// The share of its scale by which the momentum changes.
fn moved(measured: &[Metrics]) -> f64 {
    let scale = largest(measured, |at| at.momentum_scale);
    let most = largest(measured, |at| (at.momentum - measured[0].momentum).norm());
    if most > 0.0 { most / scale } else { 0.0 }
}

fn largest(measured: &[Metrics], value: impl Fn(&Metrics) -> f64) -> f64 {
    measured.iter().map(value).fold(0.0, f64::max)
}

/// Everything that one run breaks: what its case states, and the laws of any scene.
fn faults(scene: &Scene, expected: &Expected, dt: f64) -> Vec<String> {
    let mut simulation = prepare(scene, &engine("robust").unwrap(), dt).unwrap();
    assert!(simulation.keep_ledger());
    let recording = drive(scene, "robust", simulation.as_mut());
    let measured = metrics(scene, &recording);
    let mut faults: Vec<String> = breaches(scene, expected, &recording, &measured)
        .iter()
        .map(|breach| format!("{} at {dt}: {breach}", scene.name))
        .collect();
    let pushed_out = simulation.ledger().unwrap().of(Account::PushOut).energy;
    let gained = gained(&measured, pushed_out);
    // A million steps of a few roundings each add up to less.
    if gained > 1e-9 {
        faults.push(format!("{} at {dt}: energy up by {gained:e}", scene.name));
    }
    let effects = &scene.effects;
    let is_alone = effects.cushions.is_none()
        && effects.drag.is_none()
        && effects.rest.is_none()
        && effects.gravity.is_none();
    let moved = moved(&measured);
    if is_alone && moved > 1e-12 {
        faults.push(format!("{} at {dt}: momentum off by {moved:e}", scene.name));
    }
    faults
}

/// Forty-eight cases, nearly all at 0.1, 0.01 and 0.001: no bound of theirs breaks, the energy
/// has no source that is not booked, and the momentum stays where nothing from outside acts.
#[test]
fn every_hard_case_holds_at_every_step() {
    let runs = matrix();
    assert!(runs.len() > 120, "{} runs", runs.len());
    let faults: Vec<String> = runs
        .par_iter()
        .flat_map_iter(|(scene, expected, dt)| faults(scene, expected, *dt))
        .collect();
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// The law of the gain is broken where the lecture's solver blows up, so it can be broken.
#[test]
fn the_laws_of_any_scene_are_broken_by_the_lecture() {
    let scene = LIBRARY.case("fall-softened").unwrap().scene;
    let lecture = record(&scene, &engine("lecture").unwrap(), 0.01).unwrap();
    assert!(gained(&metrics(&scene, &lecture), 0.0) > 1e-9);
}

/// The scene with its bodies in another order.
fn permuted(scene: &Scene) -> Scene {
    let mut other = scene.clone();
    other.bodies.reverse();
    let count = other.bodies.len();
    if count > 2 {
        other.bodies.swap(0, count / 2);
    }
    other
}

/// The scene with its places moved by less than anyone could measure: 1e-12 of its size.
fn twin(scene: &Scene, size: f64) -> Scene {
    let mut twin = scene.clone();
    for (place, body) in twin.bodies.iter_mut().enumerate() {
        let angle = f64::from(u16::try_from(place).unwrap()) + 0.5;
        body.position[0] += 1e-12 * size * angle.sin();
        body.position[2] += 1e-12 * size * angle.cos();
    }
    twin
}

/// The recording with its bodies in the order of that scene.
fn sorted(recording: &Recording, scene: &Scene, bodies: &[Body]) -> Vec<Vec<Vector3>> {
    let place = |body: &Body| bodies.iter().position(|it| it.name == body.name).unwrap();
    let places: Vec<usize> = scene.bodies.iter().map(place).collect();
    let samples = recording.samples();
    samples
        .map(|states| places.iter().map(|place| states[*place].position).collect())
        .collect()
}

/// The bodies of the file in another order change nothing, as long as positions can be compared
/// at all: until a twin moved by 1e-12 of the size is 1e-9 away, a thousand times as far.
#[test]
fn a_permutation_of_the_bodies_changes_nothing_before_the_horizon() {
    let robust = engine("robust").unwrap();
    let compared: Vec<(String, usize, usize)> = LIBRARY
        .names()
        .unwrap()
        .par_iter()
        .filter(|name| *name != "million-steps" && *name != "overlap-1000")
        .map(|name| {
            let scene = LIBRARY.case(name).unwrap().scene;
            let run = |scene: &Scene| record(scene, &robust, 0.01).unwrap();
            let own = run(&scene);
            let size = Sizes::of(&own, &metrics(&scene, &own)).length;
            let until = horizon(&scene, &own, &[run(&twin(&scene, size))], 1e-9 * size);
            let other = permuted(&scene);
            let turned = sorted(&run(&other), &scene, &other.bodies);
            let mut compared = 0;
            for (sample, states) in own.samples().enumerate() {
                if until.is_some_and(|until| scene.sample_time(sample) >= until) {
                    break;
                }
                compared = sample;
                for (state, theirs) in states.iter().zip(&turned[sample]) {
                    let off = (state.position - theirs).norm();
                    let far = 8.0 * f64::EPSILON * state.position.amax();
                    assert!(off <= 1e-9 * size + far, "{name}, {sample}: {off:e}");
                }
            }
            (name.clone(), compared, own.sample_count() - 1)
        })
        .collect();
    // Where all of a scene is past its horizon nothing was tested.
    let whole = compared.iter().filter(|(_, seen, all)| seen == all).count();
    assert!(whole >= 25, "{whole} to their end: {compared:?}");
}
