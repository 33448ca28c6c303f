//! The scheme `robust`: closed forms of simultaneous impacts and of contacts that last, and every
//! safeguard at work.

use carom::compare::metrics;
use carom::engine::{engine, record};
use carom::physics::Vector3;
use carom::recording::{ConcessionKind, Recording};
use carom::scene::generate::{Cluster, Rack};
use carom::scene::{
    Attraction, Body, Contact, Cushions, Drag, Effects, Gravity, Rest, Scene, Spring,
};

use crate::scenes::{body, scene};

pub fn robust(scene: &Scene, dt: f64) -> Recording {
    let recording = record(scene, &engine("robust").unwrap(), dt).unwrap();
    assert!(recording.outcome.is_finished(), "{:?}", recording.outcome);
    recording
}

pub fn contact(restitution: f64) -> Effects {
    Effects {
        contact: Some(Contact { restitution }),
        ..Effects::default()
    }
}

fn last_velocities(recording: &Recording) -> Vec<Vector3> {
    let last = recording.sample(recording.sample_count() - 1);
    last.iter().map(|state| state.velocity).collect()
}

/// Largest gain of energy over the start, and largest change of momentum, over their scales.
pub fn gains(scene: &Scene, recording: &Recording) -> [f64; 2] {
    let measured = metrics(scene, recording);
    let start = &measured[0];
    let largest = |value: &dyn Fn(&carom::compare::Metrics) -> f64| {
        measured.iter().map(value).fold(0.0_f64, f64::max)
    };
    let energy = largest(&|at| at.energy_scale());
    let momentum = largest(&|at| at.momentum_scale);
    [
        largest(&|at| at.total_energy() - start.total_energy()) / energy,
        largest(&|at| (at.momentum - start.momentum).norm()) / momentum,
    ]
}

/// Five balls in a row, so far apart; so many of them come in with speed 1.
fn cradle(gap: f64, incoming: usize, restitution: f64) -> Scene {
    let radius = 0.02;
    let bodies = (0..5).map(|place| {
        let ahead = if place < incoming { -0.01 } else { 0.0 };
        let x = f64::from(u8::try_from(place).unwrap()) * (2.0 * radius + gap) + ahead;
        let speed = if place < incoming { 1.0 } else { 0.0 };
        body(
            &format!("b{place}"),
            0.1,
            radius,
            [x, 0.0, 0.0],
            [speed, 0.0, 0.0],
        )
    });
    scene(0.1, 0.05, bodies.collect(), contact(restitution))
}

/// Newton's cradle: as many leave as come in, with their speed, whatever the gaps.
#[test]
fn the_last_balls_of_a_cradle_leave_alone() {
    for gap in [0.0, 1e-9, 1e-6, 1e-3] {
        for incoming in [1, 2, 3] {
            for dt in [0.05, 0.01, 0.001] {
                let scene = cradle(gap, incoming, 1.0);
                let found = last_velocities(&robust(&scene, dt));
                for (place, velocity) in found.iter().enumerate() {
                    let leaves = place >= 5 - incoming;
                    let wanted = Vector3::x() * f64::from(u8::from(leaves));
                    // A dozen impulses, each with a few roundings.
                    assert!(
                        (velocity - wanted).norm() < 1e-13,
                        "{gap} {incoming} {place} {velocity}"
                    );
                }
            }
        }
    }
}

/// A ball between two that touch, all equal: it comes back with a fifth of its speed, the two
/// leave along the lines of centres with 2 sqrt(3)/5 of it. Energy and momentum with the mirror.
#[test]
fn a_ball_that_hits_two_at_once_comes_back_with_a_fifth_of_its_speed() {
    let (r, h) = (0.5, 0.75_f64.sqrt());
    let bodies = vec![
        body("a", 1.0, r, [-h - 0.3, 0.0, 0.0], [1.0, 0.0, 0.0]),
        body("b", 1.0, r, [0.0, 0.0, 0.5], [0.0; 3]),
        body("c", 1.0, r, [0.0, 0.0, -0.5], [0.0; 3]),
    ];
    for dt in [1.0, 0.01] {
        let found = last_velocities(&robust(&scene(1.0, 1.0, bodies.clone(), contact(1.0)), dt));
        let leave = 2.0 * 3.0_f64.sqrt() / 5.0;
        for (velocity, wanted) in found.iter().zip([
            Vector3::new(-0.2, 0.0, 0.0),
            Vector3::new(leave * h, 0.0, leave * 0.5),
            Vector3::new(leave * h, 0.0, -leave * 0.5),
        ]) {
            assert!((velocity - wanted).norm() < 1e-14, "{velocity} {wanted}");
        }
    }
}

/// The break of a rack of touching balls, head-on.
fn break_shot(restitution: f64) -> Scene {
    let recipe = Rack {
        gap: 0.0,
        ..Rack::default()
    };
    let mut scene = recipe.scene().unwrap();
    scene.effects = contact(restitution);
    scene.duration = 4.0 * scene.sample_every;
    scene
}

/// Each ball's image in the mirror x -> -x, by place.
fn mirrored(scene: &Scene) -> Vec<usize> {
    let place = |at: &Body| {
        let image = [-at.position[0], at.position[1], at.position[2]];
        let near =
            |b: &Body| (Vector3::from(b.position) - Vector3::from(image)).norm() < 1e-6 * at.radius;
        scene
            .bodies
            .iter()
            .position(near)
            .expect("a rack is its own mirror image")
    };
    scene.bodies.iter().map(place).collect()
}

/// Impacts of one instant are solved together: no order of bodies breaks the mirror, and elastic
/// ones keep the energy. Contacts one after the other in order of index break it at once.
#[test]
fn a_rack_keeps_its_mirror_image_and_its_energy() {
    let scene = break_shot(1.0);
    let images = mirrored(&scene);
    let asymmetry = |recording: &Recording| {
        recording.samples().fold(0.0_f64, |most, states| {
            let off = |(body, image): (usize, &usize)| {
                let (own, other) = (states[body].position, states[*image].position);
                (own - Vector3::new(-other.x, other.y, other.z)).norm()
            };
            images.iter().enumerate().map(off).fold(most, f64::max)
        })
    };
    let recording = robust(&scene, 0.01);
    let size = 1000.0;
    assert!(
        asymmetry(&recording) < 1e-9 * size,
        "{}",
        asymmetry(&recording)
    );
    let [gained, moved] = gains(&scene, &recording);
    let measured = metrics(&scene, &recording);
    let lost = 1.0 - measured.last().unwrap().kinetic_energy / measured[0].kinetic_energy;
    assert!(
        gained < 1e-9 && lost.abs() < 1e-9 && moved < 1e-12,
        "{gained} {lost} {moved}"
    );
    let lecture = record(&scene, &engine("lecture").unwrap(), 0.01).unwrap();
    assert!(asymmetry(&lecture) > 1e-6 * size, "{}", asymmetry(&lecture));
}

/// The bodies of the file in another order change nothing.
#[test]
fn a_permutation_of_the_bodies_changes_nothing() {
    for restitution in [1.0, 0.9, 0.0] {
        let scene = break_shot(restitution);
        let mut turned = scene.clone();
        turned.bodies.reverse();
        turned.bodies.swap(2, 7);
        let (one, other) = (robust(&scene, 0.01), robust(&turned, 0.01));
        for sample in 0..one.sample_count() {
            for (body, state) in scene.bodies.iter().zip(one.sample(sample)) {
                let place = turned
                    .bodies
                    .iter()
                    .position(|b| b.name == body.name)
                    .unwrap();
                let off = (other.sample(sample)[place].position - state.position).norm();
                assert!(
                    off < 1e-9 * 1000.0,
                    "e {restitution}, sample {sample}: {off:e}"
                );
            }
        }
    }
}

pub fn floor(half_height: f64, restitution: f64) -> Effects {
    Effects {
        contact: Some(Contact { restitution }),
        cushions: Some(Cushions {
            half_width: 10.0,
            half_length: 10.0,
            half_height: Some(half_height),
            restitution,
        }),
        gravity: Some(Gravity {
            acceleration: [0.0, -10.0, 0.0],
        }),
        ..Effects::default()
    }
}

/// A ball dropped from 1 m, e = 1/2: it bounces for `t (1 + e)/(1 - e)` with t the time of the
/// fall, and lies still from then on.
#[test]
fn bounces_that_pile_up_end_in_a_ball_that_lies() {
    let bodies = vec![body("a", 1.0, 0.5, [0.0, 1.5 - 5.0, 0.0], [0.0; 3])];
    for dt in [0.125, 0.01] {
        let recording = robust(&scene(2.0, 0.125, bodies.clone(), floor(5.0, 0.5)), dt);
        let ends = 0.2_f64.sqrt() * 3.0;
        for (sample, states) in recording.samples().enumerate() {
            let time = 0.125 * f64::from(u32::try_from(sample).unwrap());
            if time > ends {
                assert!((states[0].position.y + 4.5).abs() < 1e-9);
                assert!(
                    states[0].velocity.norm() < 1e-12,
                    "{time} {}",
                    states[0].velocity
                );
            }
        }
    }
}

/// Three balls on top of each other stay so, and so does the energy, for a thousand steps.
#[test]
fn a_pile_at_rest_stays_at_rest() {
    let ball = |place: u8| {
        let y = 0.5 + f64::from(place) - 5.0;
        body(
            &format!("b{place}"),
            1.0 + f64::from(place),
            0.5,
            [0.0, y, 0.0],
            [0.0; 3],
        )
    };
    let scene = scene(10.0, 1.0, (0..3).map(ball).collect(), floor(5.0, 0.5));
    let recording = robust(&scene, 0.01);
    for states in recording.samples() {
        for (state, body) in states.iter().zip(&scene.bodies) {
            let off = (state.position - Vector3::from(body.position)).norm();
            assert!(off < 1e-12 && state.velocity.norm() < 1e-12, "{off:e}");
        }
    }
}

/// A small ball slides off the top of a large one without friction, which stands on the floor and
/// weighs a billion times as much: it leaves where cos = 2/3, with v² = g R cos.
#[test]
fn a_ball_that_slides_off_a_sphere_leaves_it_where_the_cosine_is_two_thirds() {
    let (large, small) = (2.0, 0.1);
    let reach: f64 = large + small;
    let start: f64 = 0.05;
    let bodies = vec![
        body("large", 1e9, large, [0.0, large - 5.0, 0.0], [0.0; 3]),
        body(
            "small",
            1.0,
            small,
            [reach * start.sin(), large - 5.0 + reach * start.cos(), 0.0],
            [0.0; 3],
        ),
    ];
    let scene = scene(3.0, 0.0078125, bodies, floor(5.0, 0.0));
    let recording = robust(&scene, 0.01);
    let leaves = recording.samples().find_map(|states| {
        let apart = states[1].position - states[0].position;
        (apart.norm() > reach * (1.0 + 1e-7)).then(|| apart.y / apart.norm())
    });
    let energy = metrics(&scene, &recording);
    let [gained, _] = gains(&scene, &recording);
    assert!(gained < 1e-9, "{gained:e}");
    let cosine = leaves.expect("it leaves");
    // It starts at 0.05, so leaves at 2/3 of that cosine; a sample later it is lower.
    let wanted = 2.0 / 3.0 * start.cos();
    assert!((cosine - wanted).abs() < 0.03, "{cosine} {wanted}");
    let sliding = energy
        .iter()
        .zip(recording.samples())
        .take_while(|(_, states)| {
            let apart = states[1].position - states[0].position;
            apart.y > wanted * reach
        });
    for (at, _) in sliding {
        let lost = (energy[0].total_energy() - at.total_energy()).abs() / (10.0 * reach);
        assert!(
            lost < 1e-6,
            "sliding without friction takes nothing: {lost:e} at {}",
            at.time
        );
    }
}

/// Kepler, e = 0.999: the energy holds at any step, and the body comes round.
#[test]
fn an_orbit_of_eccentricity_0_999_keeps_its_energy_at_any_step() {
    let e: f64 = 0.999;
    let far = 1.0 + e;
    let speed = ((1.0 - e) / (1.0 + e)).sqrt();
    let bodies = vec![
        body("sun", 1.0, 1e-5, [0.0; 3], [0.0; 3]),
        body("planet", 1e-9, 1e-5, [far, 0.0, 0.0], [0.0, 0.0, speed]),
    ];
    let effects = Effects {
        attraction: Some(Attraction {
            constant: 1.0,
            softening: 0.0,
        }),
        ..Effects::default()
    };
    let scene = scene(8.0, 1.0, bodies, effects);
    for dt in [1.0, 0.1, 0.01] {
        let recording = robust(&scene, dt);
        let [gained, moved] = gains(&scene, &recording);
        assert!(gained < 1e-9 && moved < 1e-12, "{dt}: {gained:e} {moved:e}");
        assert!(
            recording.concessions.is_empty(),
            "{:?}",
            recording.concessions
        );
    }
}

pub fn oscillator(stiffness: f64, damping: f64, rest_length: f64) -> Scene {
    let bodies = vec![
        body("a", 2.0, 0.1, [-0.6, 0.0, 0.0], [0.0, 0.3, 0.0]),
        body("b", 1.0, 0.1, [0.6, 0.0, 0.0], [0.0, -0.6, 0.1]),
    ];
    let effects = Effects {
        springs: vec![Spring {
            between: ["a".into(), "b".into()],
            stiffness,
            rest_length,
            damping,
        }],
        ..Effects::default()
    };
    scene(1.0, 0.25, bodies, effects)
}

/// From tame to 1e4 times past the limit of symplectic Euler, `k dt²/mu + 2 kd dt/mu < 4`.
#[test]
fn stiff_springs_and_dampers_gain_nothing() {
    let (dt, mu) = (0.01, 2.0 / 3.0);
    for past in [1e-2, 1.0, 1e2, 1e4] {
        for (stiffness, damping) in [
            (4.0 * past * mu / (dt * dt), 0.0),
            (100.0, 2.0 * past * mu / dt),
            (2.0 * past * mu / (dt * dt), past * mu / dt),
        ] {
            for rest_length in [1.0, 0.0] {
                let scene = oscillator(stiffness, damping, rest_length);
                let recording = robust(&scene, dt);
                let [gained, moved] = gains(&scene, &recording);
                assert!(
                    gained < 1e-9 && moved < 1e-12,
                    "k {stiffness} kd {damping} l0 {rest_length}: {gained:e} {moved:e} {:?}",
                    recording.concessions
                );
            }
        }
    }
}

/// A thousand balls in half the room they need are moved apart once, the centre of mass stays.
#[test]
fn a_deep_overlap_of_a_thousand_balls_is_resolved_once() {
    let ball = |place: u16| {
        let [x, y, z] = [place % 10, place / 10 % 10, place / 100].map(|n| f64::from(n) * 1.0);
        body(
            &format!("b{place}"),
            1.0 + f64::from(place % 3),
            1.0,
            [x, y, z],
            [0.0; 3],
        )
    };
    let scene = scene(0.02, 0.01, (0..1000).map(ball).collect(), contact(0.5));
    let recording = robust(&scene, 0.01);
    let measured = metrics(&scene, &recording);
    assert!(measured[0].max_penetration > 0.9);
    for at in &measured[1..] {
        assert!(at.max_penetration < 1e-9, "{}", at.max_penetration);
        let moved = (at.centre_of_mass - measured[0].centre_of_mass).norm();
        assert!(moved < 1e-9, "{moved:e}");
        assert_eq!(at.kinetic_energy, 0.0);
    }
}

/// Coincident centres, nearly coincident ones and a heap of them come apart.
#[test]
fn coincident_centres_come_apart() {
    for (count, offset) in [(2_u8, 0.0), (2, 1e-300), (2, 1e-12), (7, 0.0)] {
        let ball = |n: u8| {
            let x = f64::from(n) * offset;
            body(
                &format!("b{n}"),
                1.0,
                0.5,
                [x, 0.0, 0.0],
                [0.0, 0.0, f64::from(n) * 0.1],
            )
        };
        let scene = scene(0.1, 0.05, (0..count).map(ball).collect(), contact(1.0));
        let recording = robust(&scene, 0.01);
        let measured = metrics(&scene, &recording);
        assert!(
            measured[1].max_penetration < 1e-9,
            "{count} {offset}: {}",
            measured[1].max_penetration
        );
        let [gained, moved] = gains(&scene, &recording);
        assert!(gained < 1e-9 && moved < 1e-12, "{gained:e} {moved:e}");
    }
}

/// A box too small for its balls.
pub fn crowded() -> Scene {
    let ball = |n: u8| {
        body(
            &format!("b{n}"),
            1.0,
            0.9,
            [f64::from(n) * 0.3, 0.0, 0.0],
            [0.0; 3],
        )
    };
    let mut effects = floor(1.0, 0.5);
    effects.cushions = Some(Cushions {
        half_width: 1.0,
        half_length: 1.0,
        half_height: Some(1.0),
        restitution: 0.5,
    });
    scene(0.1, 0.05, (0..3).map(ball).collect(), effects)
}

/// There is no room, and the run says so.
#[test]
fn a_box_without_room_is_a_concession() {
    let recording = robust(&crowded(), 0.01);
    let kinds: Vec<_> = recording.concessions.iter().map(|it| it.kind).collect();
    assert!(kinds.contains(&ConcessionKind::Jammed), "{kinds:?}");
}

/// Flights are closed forms: one step for the whole duration gives what small ones do, tunnelling
/// nothing.
#[test]
fn one_step_for_the_whole_duration_is_as_good_as_many() {
    let bodies = vec![
        body("fast", 1.0, 0.05, [-2.0, 0.0, 0.01], [1e6, 0.0, 0.0]),
        body("target", 1.0, 0.05, [0.0; 3], [0.0; 3]),
    ];
    let effects = Effects {
        contact: Some(Contact { restitution: 0.9 }),
        cushions: Some(Cushions {
            half_width: 3.0,
            half_length: 3.0,
            half_height: None,
            restitution: 0.9,
        }),
        drag: Some(Drag { coefficient: 2.0 }),
        rest: Some(Rest { speed: 10.0 }),
        ..Effects::default()
    };
    let duration = 1.0 / 4096.0;
    let scene = scene(duration, duration, bodies, effects);
    let (one, many) = (robust(&scene, duration), robust(&scene, duration / 1000.0));
    assert_eq!(one.events.counts(), many.events.counts());
    assert!(one.events.counts().contacts > 0 && one.events.counts().cushions > 10);
    for (a, b) in one.sample(1).iter().zip(many.sample(1)) {
        // A hundred impacts on curved surfaces enlarge the rounding of the first.
        assert!(
            (a.position - b.position).norm() < 1e-5,
            "{} {}",
            a.position,
            b.position
        );
    }
}

/// The digits of pi: a heavy ball, a light one and a wall, masses 100^k to 1, all elastic.
/// Source: Galperin 2003, "Playing pool with pi".
#[test]
fn impacts_spell_the_digits_of_pi() {
    for (power, digits) in [3_u64, 31, 314, 3141, 31415].into_iter().enumerate() {
        let heavy = 100.0_f64.powi(i32::try_from(power).unwrap());
        let bodies = vec![
            body("light", 1.0, 0.1, [0.0, 0.0, 0.0], [0.0; 3]),
            body("heavy", heavy, 0.1, [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]),
        ];
        let effects = Effects {
            contact: Some(Contact { restitution: 1.0 }),
            cushions: Some(Cushions {
                half_width: 1000.0,
                half_length: 1000.0,
                half_height: None,
                restitution: 1.0,
            }),
            ..Effects::default()
        };
        let mut scene = scene(8.0, 8.0, bodies, effects);
        for body in &mut scene.bodies {
            body.position[0] -= 999.0;
        }
        let counts = robust(&scene, 8.0).events.counts();
        assert_eq!(counts.contacts + counts.cushions, digits, "100^{power}");
    }
}

/// An attracting cluster that collapses: heaps held together by pushes; nothing heats.
#[test]
fn a_cluster_collapses_without_gaining_energy_or_momentum() {
    let recipe = Cluster {
        count: 8,
        seed: 8,
        extent: 12.0,
        ..Default::default()
    };
    let mut scene = recipe.scene().unwrap();
    scene.effects.contact = Some(Contact { restitution: 0.1 });
    scene.duration = 16.0 * scene.sample_every;
    for dt in [0.0625, 0.01] {
        let recording = robust(&scene, dt);
        let [gained, moved] = gains(&scene, &recording);
        assert!(gained < 1e-9 && moved < 1e-12, "{gained:e} {moved:e}");
        let deepest = metrics(&scene, &recording)
            .iter()
            .map(|at| at.max_penetration)
            .fold(0.0, f64::max);
        assert!(deepest < 1e-9, "{deepest:e}");
    }
}

/// A ball between two walls, so fast that it hits them so often in a second.
fn rattle(speed: f64) -> Scene {
    let mut effects = floor(1.0, 1.0);
    effects.gravity = None;
    let bodies = vec![body("a", 1.0, 9.5, [0.0; 3], [speed, 0.0, 0.0])];
    scene(1.0, 1.0, bodies, effects)
}

/// Impacts are counted, and past their allowance nothing bounces any more: five million of them
/// end after some hundred thousand, and what would never end does so after a thousand.
#[test]
fn endless_impacts_are_cut_short_and_said_to_be() {
    for (speed, most) in [(5e6, 500_000), (1e15, 2_000)] {
        let recording = robust(&rattle(speed), 1.0);
        let found = recording.events.counts().cushions;
        assert!(found < most, "{speed:e}: {found}");
        let kinds: Vec<_> = recording.concessions.iter().map(|it| it.kind).collect();
        assert_eq!(kinds, [ConcessionKind::CutShort], "{speed:e}");
    }
    // 1000 in a second are no concession.
    let recording = robust(&rattle(1000.0), 1.0);
    assert_eq!(recording.events.counts().cushions, 1000);
    assert_eq!(recording.concessions, []);
}

/// A spring that no run can pay: its ends turn back relative to their centre of mass, which goes
/// on as if there were none; energy and momentum stay, and it costs next to nothing.
#[test]
fn a_spring_beyond_all_work_keeps_energy_and_the_centre_of_mass() {
    for stiffness in [1e16, 1e30] {
        beyond_all_work(oscillator(stiffness, 0.0, 1.0));
    }
}

fn beyond_all_work(mut scene: Scene) {
    for body in &mut scene.bodies {
        body.velocity[2] += 1.0;
    }
    let recording = robust(&scene, 0.01);
    let [gained, moved] = gains(&scene, &recording);
    assert!(gained < 1e-9 && moved < 1e-12, "{gained:e} {moved:e}");
    let measured = metrics(&scene, &recording);
    let last = measured.last().unwrap();
    let due = measured[0].centre_of_mass + measured[0].momentum / 3.0;
    let off = (last.centre_of_mass - due).norm();
    // A hundred steps of a few roundings.
    assert!(off < 1e-12, "{off:e}");
    let kinds: Vec<_> = recording.concessions.iter().map(|it| it.kind).collect();
    assert_eq!(
        kinds,
        [ConcessionKind::LongStep, ConcessionKind::TurnedBack]
    );
    // A hundred steps: a start, and two rounds that lead apart.
    assert_eq!(recording.work.force_evaluations, 300);
}

/// Without anything to hold it a ball below the rest speed falls, is stopped at the end of each
/// step, and so never gets on: the speed at every sample is none.
#[test]
fn what_forces_bring_below_the_rest_speed_is_stopped_at_the_end_of_a_step() {
    let effects = Effects {
        gravity: Some(Gravity {
            acceleration: [0.0, -10.0, 0.0],
        }),
        rest: Some(Rest { speed: 1.0 }),
        ..Effects::default()
    };
    let bodies = vec![body("a", 1.0, 0.5, [0.0; 3], [0.0; 3])];
    let recording = robust(&scene(0.5, 0.01, bodies, effects), 0.01);
    for states in recording.samples() {
        assert_eq!(states[0].velocity, Vector3::zeros());
    }
}

/// A small ball slides down a large one from its top, a third of a radian in one step: that is
/// divided, and the ball is where small steps lead to.
#[test]
fn a_slide_is_followed_in_steps_that_turn_little() {
    let bodies = vec![
        body("large", 1e9, 2.0, [0.0, -3.0, 0.0], [0.0; 3]),
        body("small", 1.0, 0.1, [0.0, -0.9, 0.0], [3.0, 0.0, 0.0]),
    ];
    let scene = scene(0.25, 0.25, bodies, floor(5.0, 0.0));
    let (long, short) = (robust(&scene, 0.25), robust(&scene, 0.001));
    let off = (long.sample(1)[1].position - short.sample(1)[1].position).norm();
    // A step that turns by a leaves a³/12 of the distance: 8e-3 in one, 2e-4 in eight.
    assert!(off < 1e-3, "{off:e}");
}
