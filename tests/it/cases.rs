//! Every reference case: whole, readable, and near its truth as far as the method promises.

use std::f64::consts::PI;

use carom::case::{Case, Library};
use carom::compare::{Divergence, Sizes, compare_events};
use carom::physics::Vector3;
use carom::recording::Recording;
use carom::scene::{self, Scene};

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

/// Without impacts the method is of first order, and its error at a given time is
/// `c1 h + c2 h² + ...`. With `q = c2 h / c1` a tenth of the step leaves a tenth of the error but
/// for `d(h) = e(h)/e(h/10) - 10 = 9 q / (1 + q/10)`.
///
/// - q is about the angular rate of the motion times h. Samples that show the motion come twice
///   a period at least, so that is at most pi h / `sample_every` = pi/64 here, and `|d|` at most
///   9 pi/64: 4.4 % of the 10.
/// - d falls with the step as q does: `d(h/10) = d(h)/10`, but for terms of the size `q²`, which
///   is below `d²/10`.
/// - A ball comes to rest at the end of a step: up to a step at the rest speed too far, a share
///   of the error that differs from step to step, on both sides of each ratio.
/// - Rounding: a step adds half an ulp of the size of the scene at most.
#[test]
fn the_error_against_truth_falls_with_the_step_where_nothing_collides() {
    let mut seen = 0;
    for case in cases() {
        let Some(truth) = &case.truth else { continue };
        if truth.events.impacts().count() > 0 {
            continue;
        }
        // Steps that divide every sample distance of these cases into whole numbers.
        let step = case.scene.sample_every / 64.0;
        let ladder = [step, step / 10.0, step / 100.0];
        let errors = errors_at_the_worst_sample(&case, truth, ladder);
        let [coarse, fine] = [errors[0] / errors[1] - 10.0, errors[1] / errors[2] - 10.0];
        let stop = case.scene.effects.rest.map_or(0.0, |rest| rest.speed) * step / errors[0];
        let steps = case.scene.duration / ladder[2];
        let size = Sizes::of(truth, &[]).length;
        let rounding = 10.0 * steps * size * f64::EPSILON / 2.0 / errors[2];
        let name = &case.scene.name;
        println!("{name}: {coarse:.5}, {fine:.6}; a stop {stop:.1e}, rounding {rounding:.1e}");
        assert!(
            coarse.abs() < 9.0 * PI / 64.0 + 20.0 * stop,
            "{name}: ratio 10 + {coarse}"
        );
        let next = coarse * coarse / 10.0 + 22.0 * stop + rounding;
        assert!(
            (fine - coarse / 10.0).abs() < next,
            "{name}: ratios 10 + {coarse} and 10 + {fine}, not a tenth within {next}"
        );
        seen += 1;
    }
    assert!(seen >= 5, "{seen} cases");
}

/// Distance of the farthest body from the truth for each step, all at one sample: the one where
/// the smallest step is farthest off. Where an orbit closes, c1 vanishes and nothing is learnt.
fn errors_at_the_worst_sample(case: &Case, truth: &Recording, ladder: [f64; 3]) -> [f64; 3] {
    let runs = ladder.map(|dt| Divergence::between(&case.scene, &lecture(&case.scene, dt), truth));
    let worst = runs[2].largest().time;
    runs.map(|run| {
        let at = run.samples.iter().find(|at| at.time == worst);
        at.unwrap().max_position
    })
}

/// The largest error that an impact seen `late` leaves, to first order in `late`, and the size
/// of the next order. Two spheres, no forces.
///
/// With n from b to a at contact, `v = v_a - v_b` its normal part `v_n` and its sideways part
/// `v_t`, d the sum of the radii, `u_a = m_b/(m_a + m_b)` and u_b alike, up to the sign of b:
/// - the change of velocity `-(1 + e) u v_n n` comes late and the push-out of half
///   `(1 + e) |v_n| late` makes up for half of it: `(1 + e) v_n late (u - 1/2) n`;
/// - the line of action has turned by `dn = v_t late / d`: the change of velocity is off by
///   `-(1 + e) u ((v . dn) n + v_n dn)`, for all the time that is left.
fn error_of_a_late_impact(scene: &Scene, at: f64, late: f64) -> (f64, f64) {
    let [a, b] = [&scene.bodies[0], &scene.bodies[1]];
    let e = scene.effects.contact.unwrap().restitution;
    let [x_a, x_b, v_a, v_b] = [a.position, b.position, a.velocity, b.velocity].map(Vector3::from);
    let v = v_a - v_b;
    let n = (x_a - x_b + v * at).normalize();
    let (v_n, d) = (v.dot(&n), a.radius + b.radius);
    let turn = (v - n * v_n) * (late / d);
    let left = scene.duration - at;
    let of_body = |u: f64| {
        let shift = n * ((1.0 + e) * v_n * late * (u - 0.5));
        let drift = (n * v.dot(&turn) + turn * v_n) * (-(1.0 + e) * u * left);
        shift.norm().max((shift + drift).norm())
    };
    let total = a.mass + b.mass;
    let first = of_body(b.mass / total).max(of_body(a.mass / total));
    // Each further order brings another factor |dn|, or |v| late / d.
    let order = v.norm() * late / d;
    let next = order * turn.norm() * (1.0 + e) * (v.norm() * left + d);
    (first, next)
}

/// An impact is seen at the end of the step in which the spheres meet, late by up to a step,
/// and the error is the one that this must leave: see [`error_of_a_late_impact`]. Rounding:
/// half an ulp of the size of the scene a step.
#[test]
fn small_steps_find_every_impact_of_two_bodies() {
    const DT: f64 = 1e-4;
    for name in [
        "headon-equal",
        "oblique-inelastic",
        "inelastic-e05",
        "oblique-elastic",
    ] {
        let case = Library::Embedded.case(name).unwrap();
        let truth = case.truth.as_ref().unwrap();
        let recording = lecture(&case.scene, DT);
        let agreement = compare_events(&case.scene, &recording, truth);
        assert_eq!(agreement.first_disagreement, None, "{name}");
        assert_eq!(agreement.matched, 1, "{name}");
        let [at, seen] = [truth, &recording].map(|r| r.events.events()[0].time);
        let late = seen - at;
        assert!((0.0..=DT).contains(&late), "{name}: late by {late}");
        let (first, next) = error_of_a_late_impact(&case.scene, at, late);
        let size = Sizes::of(truth, &[]).length;
        let rounding = case.scene.duration / DT * size * f64::EPSILON / 2.0;
        let error = Divergence::between(&case.scene, &recording, truth)
            .largest()
            .max_position;
        println!(
            "{name}: late {late:.2e}, error {error:e}, expected {first:e} ± {next:.1e}, rounding {rounding:.1e}"
        );
        assert!(
            (error - first).abs() <= next + rounding,
            "{name}: {error:e}, not {first:e} ± {next:e}"
        );
    }
}
