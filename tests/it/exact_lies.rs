//! `exact` against itself: changes that must not matter leave every answer within the digits that
//! are claimed.
//!
//! Random scenes of each family that it once got wrong are computed as they are and changed: axes
//! relabelled, bodies in another order, time and length in other units, a still spring beside them
//! (which makes the half with Taylor series compute what the half with closed forms did).

use std::collections::BTreeMap;

use carom::engine::{DEFAULT_DT, EngineKind, EngineSpec, engine, record};
use carom::recording::{Digits, Recording};
use carom::scene::{
    Attraction, Body, Contact, Cushions, Drag, Effects, Gravity, Scene, Spring, Units,
};
use rand_pcg::Pcg64;
use rand_pcg::rand_core::{Rng, SeedableRng};
use rayon::prelude::*;

/// Elementary operations of a computation: enough for these short scenes, and no minute for one
/// that chance has made hard.
const OPERATIONS: u64 = 300_000_000;

/// Scenes that every run of the tests tries; `two_thousand` tries more.
const FEW: u64 = 60;

struct Lot(Pcg64);

impl Lot {
    fn unit(&mut self) -> f64 {
        // 53 bits.
        (self.0.next_u64() >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn within(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    fn below(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize
    }

    fn one<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.below(of.len())]
    }

    /// A multiple of 1/64, as tidy scenes have: sums of it are exact.
    fn tidy(&mut self, low: f64, high: f64) -> f64 {
        (self.within(low, high) * 64.0).round() / 64.0
    }

    fn vector(&mut self, size: f64) -> [f64; 3] {
        [0; 3].map(|_| self.within(-size, size))
    }
}

fn body(name: String, mass: f64, radius: f64, position: [f64; 3], velocity: [f64; 3]) -> Body {
    crate::scenes::body(&name, mass, radius, position, velocity)
}

fn spring(between: [&str; 2], stiffness: f64, rest_length: f64, damping: f64) -> Spring {
    Spring {
        between: between.map(String::from),
        stiffness,
        rest_length,
        damping,
    }
}

fn cube(half: f64, restitution: f64) -> Option<Cushions> {
    Some(Cushions {
        half_width: half,
        half_length: half,
        half_height: Some(half),
        restitution,
    })
}

fn scene(duration: f64, sample_every: f64, bodies: Vec<Body>, effects: Effects) -> Scene {
    Scene {
        units: Units::default(),
        ..crate::scenes::scene(duration, sample_every, bodies, effects)
    }
}

const AXES: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

fn along(axis: [f64; 3], by: f64) -> [f64; 3] {
    axis.map(|x| x * by + 0.0)
}

/// A ball rests on a wall, joined to another by a spring that is relaxed at the start.
fn pressed_on_a_wall(lot: &mut Lot) -> Scene {
    let axis = lot.one(&AXES);
    let radius = lot.one(&[0.125, 0.0625]);
    let length = lot.one(&[0.5, 0.375, 0.625]);
    let at = radius - 1.0;
    let speed = lot.tidy(-2.0, 2.0);
    let mut bodies = vec![
        body(
            "low".into(),
            lot.tidy(0.5, 3.0),
            radius,
            along(axis, at),
            [0.0; 3],
        ),
        body(
            "high".into(),
            lot.tidy(0.5, 3.0),
            radius,
            along(axis, at + length),
            along(axis, speed),
        ),
    ];
    let mut springs = vec![spring(
        ["low", "high"],
        lot.within(20.0, 200.0),
        length,
        0.0,
    )];
    if lot.below(2) == 0 {
        // A third one, on the second by another relaxed spring.
        let position = along(axis, at + 2.0 * length);
        bodies.push(body(
            "top".into(),
            1.0,
            radius,
            position,
            along(axis, lot.tidy(-1.0, 1.0)),
        ));
        springs.push(spring(
            ["high", "top"],
            lot.within(20.0, 200.0),
            length,
            lot.one(&[0.0, 0.5]),
        ));
    }
    let effects = Effects {
        cushions: cube(1.0, lot.one(&[0.0, 0.5, 1.0])),
        contact: Some(Contact {
            restitution: lot.one(&[0.0, 0.5, 1.0]),
        }),
        springs,
        ..Effects::default()
    };
    scene(1.0, 0.0625, bodies, effects)
}

/// A ball sticks to a block on a relaxed spring, or on one a little pressed or drawn.
fn putty_and_block(lot: &mut Lot) -> Scene {
    let axis = lot.one(&AXES);
    let radius = 0.0625;
    let stretch = lot.one(&[0.0, 0.0, 0.01, -0.01]);
    let sign = lot.one(&[1.0, -1.0]);
    let place = |x: f64| along(axis, sign * x);
    let gap = lot.tidy(0.0, 0.5);
    let bodies = vec![
        body(
            "anchor".into(),
            lot.one(&[1e6, 8.0]),
            radius,
            place(1.0 + stretch),
            [0.0; 3],
        ),
        body(
            "block".into(),
            lot.tidy(0.5, 2.0),
            radius,
            place(0.0),
            [0.0; 3],
        ),
        body(
            "putty".into(),
            lot.tidy(0.5, 2.0),
            radius,
            place(-0.125 - gap),
            place(lot.tidy(0.5, 2.0)),
        ),
    ];
    let effects = Effects {
        contact: Some(Contact {
            restitution: lot.one(&[0.0, 0.0, 0.25, 0.5]),
        }),
        springs: vec![spring(
            ["anchor", "block"],
            lot.within(30.0, 300.0),
            1.0,
            lot.one(&[0.0, 0.0, 0.5]),
        )],
        drag: lot.one(&[None, Some(Drag { coefficient: 0.25 })]),
        ..Effects::default()
    };
    scene(1.0, 0.0625, bodies, effects)
}

/// Balls thrown into a box, none overlapping.
fn thrown(lot: &mut Lot, count: usize, radius: f64, speed: f64, flat: bool) -> Vec<Body> {
    let mut bodies: Vec<Body> = Vec::new();
    while bodies.len() < count {
        let (mut position, mut velocity) = (lot.vector(1.0 - 1.01 * radius), lot.vector(speed));
        if flat {
            (position[1], velocity[1]) = (0.0, 0.0);
        }
        let clear = |other: &Body| {
            let squares = [0, 1, 2].map(|axis| (other.position[axis] - position[axis]).powi(2));
            squares.iter().sum::<f64>().sqrt() > 2.02 * radius
        };
        if bodies.iter().all(clear) {
            let mass = lot.one(&[1.0, 1.0, 2.0, 0.5]);
            bodies.push(body(
                format!("b{}", bodies.len()),
                mass,
                radius,
                position,
                velocity,
            ));
        }
    }
    bodies
}

/// Billiards whose small errors grow.
fn billiards(lot: &mut Lot) -> Scene {
    let count = 2 + lot.below(3);
    let flat = lot.below(2) == 0;
    let bodies = thrown(lot, count, 0.12, 1.0, flat);
    let restitution = lot.one(&[1.0, 1.0, 0.9]);
    let effects = Effects {
        contact: Some(Contact { restitution }),
        cushions: cube(1.0, lot.one(&[1.0, 0.9])),
        ..Effects::default()
    };
    scene(32.0, 2.0, bodies, effects)
}

/// Balls that lie, and others that hit them.
fn lying(lot: &mut Lot) -> Scene {
    let mut bodies = vec![body("lying".into(), 1.0, 0.25, [0.0, -0.75, 0.0], [0.0; 3])];
    for index in 0..1 + lot.below(2) {
        let position = [
            0.55 * (index as f64 * 2.0 - 1.0),
            lot.within(0.0, 0.7),
            lot.within(-0.7, 0.7),
        ];
        bodies.push(body(
            format!("b{index}"),
            1.0,
            0.25,
            position,
            lot.vector(1.5),
        ));
    }
    let restitution = lot.one(&[1.0, 0.5, 0.0]);
    let effects = Effects {
        gravity: Some(Gravity {
            acceleration: [0.0, -2.0, 0.0],
        }),
        contact: Some(Contact { restitution }),
        cushions: cube(1.0, restitution),
        ..Effects::default()
    };
    scene(6.0, 0.5, bodies, effects)
}

/// Bodies that attract each other, and collide.
fn attracting(lot: &mut Lot) -> Scene {
    let (count, flat) = (2 + lot.below(3), lot.below(2) == 0);
    let bodies = thrown(lot, count, 0.1, 0.7, flat);
    let effects = Effects {
        attraction: Some(Attraction {
            constant: 0.5,
            softening: lot.one(&[0.0, 0.0, 0.25]),
        }),
        contact: Some(Contact {
            restitution: lot.one(&[1.0, 0.6, 0.0]),
        }),
        ..Effects::default()
    };
    scene(3.0, 0.125, bodies, effects)
}

/// A chain of springs that swings, collides and is damped or not.
fn swinging(lot: &mut Lot) -> Scene {
    let count = 2 + lot.below(3);
    let mut bodies = Vec::new();
    let mut springs = Vec::new();
    for index in 0..count {
        let position = [
            0.45 * (index as f64) - 0.6,
            lot.within(-0.1, 0.1),
            lot.within(-0.1, 0.1),
        ];
        bodies.push(body(
            format!("b{index}"),
            lot.within(0.5, 2.0),
            0.1,
            position,
            lot.vector(1.0),
        ));
        if index > 0 {
            let between = [format!("b{}", index - 1), format!("b{index}")];
            let rest_length = lot.one(&[0.4, 0.25]);
            let damping = lot.one(&[0.0, 0.3]);
            springs.push(Spring {
                between,
                stiffness: lot.within(5.0, 500.0),
                rest_length,
                damping,
            });
        }
    }
    let effects = Effects {
        contact: Some(Contact {
            restitution: lot.one(&[1.0, 0.7]),
        }),
        cushions: cube(1.5, lot.one(&[1.0, 0.6])),
        gravity: lot.one(&[
            None,
            Some(Gravity {
                acceleration: [0.1, -3.0, 0.2],
            }),
        ]),
        drag: lot.one(&[None, Some(Drag { coefficient: 0.2 })]),
        springs,
        ..Effects::default()
    };
    scene(2.0, 0.125, bodies, effects)
}

/// Tiny balls that meet far away.
fn far_and_small(lot: &mut Lot) -> Scene {
    let (radius, far) = (lot.one(&[1e-3, 1e-6]), lot.one(&[1e3, 1e6]));
    let aside = lot.vector(1.0).map(|x| x * radius);
    let bodies = vec![
        body("bullet".into(), 1.0, radius, [0.0; 3], [far, 0.0, 0.0]),
        body(
            "target".into(),
            lot.within(0.5, 2.0),
            radius,
            [far, aside[1], aside[2]],
            [0.0; 3],
        ),
    ];
    let effects = Effects {
        contact: Some(Contact {
            restitution: lot.one(&[1.0, 0.5]),
        }),
        ..Effects::default()
    };
    scene(2.0, 0.25, bodies, effects)
}

/// In two scenes of three a spring that swings on its own, so that the half with Taylor series
/// computes them.
fn fallen_spring(lot: &mut Lot, bodies: &mut Vec<Body>) -> Vec<Spring> {
    if lot.below(3) == 0 {
        return Vec::new();
    }
    for (name, x) in [("s0", 0.25), ("s1", 0.5)] {
        bodies.push(body(name.into(), 1.0, 0.015625, [x, 0.5, 0.5], [0.0; 3]));
    }
    vec![spring(["s0", "s1"], lot.within(0.5, 5.0), 0.2, 0.0)]
}

/// A ball that meets walls at the instants of samples, in numbers that binary fractions hold.
fn on_samples(lot: &mut Lot) -> Scene {
    let speed = lot.one(&[0.5, 1.0, 2.0]);
    let (sign, at) = (lot.one(&[1.0, -1.0]), lot.one(&[0.5, 1.0]));
    // 0.75 from the wall after `at` seconds, then there and back for ever.
    let start = sign * (0.75 - speed * at);
    let mut bodies = vec![body(
        "ball".into(),
        1.0,
        0.25,
        [start, 0.0, 0.0],
        [sign * speed, lot.tidy(-1.0, 1.0), 0.0],
    )];
    let springs = fallen_spring(lot, &mut bodies);
    let effects = Effects {
        cushions: cube(1.0, lot.one(&[1.0, 0.5])),
        springs,
        ..Effects::default()
    };
    scene(4.0, 0.5, bodies, effects)
}

/// Hops far lower than the ball, of which most begin with an impact at time 0.
fn low_hops(lot: &mut Lot) -> Scene {
    let speed = 3e-13 * lot.within(0.5, 2.0) * lot.one(&[1.0, 1e3, 1e-3]);
    let mut bodies = vec![body(
        "ball".into(),
        1.0,
        1.0,
        [0.0, -7.0, 0.0],
        [0.0, -speed, 0.0],
    )];
    let springs = fallen_spring(lot, &mut bodies);
    let effects = Effects {
        gravity: Some(Gravity {
            acceleration: [0.0, -1.0, 0.0],
        }),
        cushions: cube(8.0, lot.one(&[1.0, 0.75, 0.5])),
        springs,
        ..Effects::default()
    };
    // The hops last twice the speed.
    let every = (speed * 0.7).log2().floor().exp2();
    scene(16.0 * every, every, bodies, effects)
}

/// What draws a scene.
type Draw = fn(&mut Lot) -> Scene;

const FAMILIES: [(&str, Draw); 9] = [
    (
        "pressed on a wall by a higher derivative",
        pressed_on_a_wall,
    ),
    ("putty and block", putty_and_block),
    ("billiards", billiards),
    ("lying and hit", lying),
    ("attracting", attracting),
    ("springs", swinging),
    ("far and small", far_and_small),
    ("impacts on samples", on_samples),
    ("low hops", low_hops),
];

/// A change that must not matter, and how to compare after it.
struct Change {
    name: &'static str,
    scene: Scene,
    /// Axis of the changed scene for each of the old one.
    axes: [usize; 3],
    /// Body of the changed scene for each of the old one.
    bodies: Vec<usize>,
    length: f64,
    speed: f64,
}

fn unchanged(name: &'static str, scene: &Scene) -> Change {
    Change {
        name,
        scene: scene.clone(),
        axes: [0, 1, 2],
        bodies: (0..scene.bodies.len()).collect(),
        length: 1.0,
        speed: 1.0,
    }
}

fn with_axes_relabelled(scene: &Scene) -> Change {
    // x to y, y to z, z to x.
    let turned = |v: [f64; 3]| [v[2], v[0], v[1]];
    let mut change = unchanged("axes relabelled", scene);
    change.axes = [1, 2, 0];
    for body in &mut change.scene.bodies {
        (body.position, body.velocity) = (turned(body.position), turned(body.velocity));
    }
    if let Some(gravity) = &mut change.scene.effects.gravity {
        gravity.acceleration = turned(gravity.acceleration);
    }
    change
}

fn with_bodies_reordered(scene: &Scene) -> Change {
    let mut change = unchanged("bodies reordered", scene);
    change.scene.bodies.reverse();
    change.bodies.reverse();
    change
}

fn in_other_units(scene: &Scene, lot: &mut Lot) -> Change {
    let (length, time) = (lot.one(&[0.125, 1.0, 1024.0]), lot.one(&[0.03125, 4.0]));
    let mut change = unchanged("other units of time and length", scene);
    let speed = length / time;
    (change.length, change.speed) = (length, speed);
    let Scene {
        duration,
        sample_every,
        bodies,
        effects,
        ..
    } = &mut change.scene;
    *duration *= time;
    *sample_every *= time;
    for body in bodies {
        body.radius *= length;
        body.position = body.position.map(|x| x * length);
        body.velocity = body.velocity.map(|v| v * speed);
    }
    if let Some(cushions) = &mut effects.cushions {
        cushions.half_width *= length;
        cushions.half_length *= length;
        cushions.half_height = cushions.half_height.map(|half| half * length);
    }
    if let Some(gravity) = &mut effects.gravity {
        gravity.acceleration = gravity.acceleration.map(|g| g * (speed / time));
    }
    if let Some(attraction) = &mut effects.attraction {
        attraction.constant *= length * length * length / (time * time);
        attraction.softening *= length;
    }
    if let Some(drag) = &mut effects.drag {
        drag.coefficient /= time;
    }
    for spring in &mut effects.springs {
        spring.stiffness /= time * time;
        spring.rest_length *= length;
        spring.damping /= time;
    }
    change
}

/// A spring at rest beside the scene, out of reach; none where attraction or gravity would move it
/// or a closed box has no room.
fn beside_a_still_spring(scene: &Scene) -> Option<Change> {
    let effects = &scene.effects;
    if effects.attraction.is_some() || effects.gravity.is_some() {
        return None;
    }
    let mut change = unchanged("beside a still spring", scene);
    let at = effects.cushions.map_or(-100.0, |_| -0.98);
    let tiny = 1e-4;
    for (name, x) in [("still-a", at), ("still-b", at + 0.0009765625)] {
        let corner = [x, at, at];
        change
            .scene
            .bodies
            .push(body(name.into(), 1.0, tiny, corner, [0.0; 3]));
    }
    let rest = change
        .scene
        .bodies
        .iter()
        .rev()
        .take(2)
        .map(|b| b.position[0]);
    let rest = rest.reduce(|high, low| high - low).unwrap();
    change
        .scene
        .effects
        .springs
        .push(spring(["still-a", "still-b"], 1.0, rest, 0.0));
    Some(change)
}

fn exact(scene: &Scene) -> Result<Recording, String> {
    let mut spec: EngineSpec = engine("exact").unwrap();
    if let EngineKind::Exact(settings) = &mut spec.kind {
        settings.operations = OPERATIONS;
    }
    record(scene, &spec, DEFAULT_DT).map_err(|error| error.to_string())
}

fn scales(recording: &Recording) -> (f64, f64, f64) {
    let sizes = carom::compare::Sizes::of(recording, &[]);
    let states = || recording.samples().flatten();
    let speed = states()
        .map(|state| state.velocity.norm())
        .fold(0.0, f64::max);
    let far = states()
        .map(|state| state.position.norm())
        .fold(0.0, f64::max);
    (sizes.length, speed, far)
}

/// What both claim and do not agree on.
fn disagreement(
    scene: &Scene,
    own: &Recording,
    change: &Change,
    other: &Recording,
) -> Option<String> {
    let (length, speed, far) = scales(own);
    let (length_other, speed_other, _) = scales(other);
    let samples = own.sample_count().min(other.sample_count());
    let from = |recording: &Recording, scene: &Scene| {
        let from = recording
            .undetermined
            .as_ref()
            .map_or(f64::INFINITY, |from| from.time);
        (0..samples)
            .find(|sample| scene.sample_time(*sample) >= from)
            .unwrap_or(samples)
    };
    let known = from(own, scene).min(from(other, &change.scene));
    let empty = Vec::new();
    let digits = |recording: &Recording| -> Vec<Digits> {
        recording.digits.as_ref().unwrap_or(&empty).clone()
    };
    let (mine, theirs) = (digits(own), digits(other));
    for sample in 0..known {
        let allowed = |mine: u8, theirs: u8, sizes: [f64; 2]| {
            if mine == 0 || theirs == 0 {
                return f64::INFINITY;
            }
            let each = [mine, theirs].map(|digits| 10.0_f64.powi(-i32::from(digits)));
            each[0] * sizes[0] + each[1] * sizes[1]
        };
        let (a, b) = (mine[sample], theirs[sample]);
        let room = allowed(
            a.position,
            b.position,
            [length, length_other / change.length],
        ) + 4.0 * f64::EPSILON * far;
        let room_speed = allowed(a.velocity, b.velocity, [speed, speed_other / change.speed])
            + 4.0 * f64::EPSILON * speed;
        for (body, state) in own.sample(sample).iter().enumerate() {
            let changed = other.sample(sample)[change.bodies[body]];
            let (mut off, mut off_speed) = (0.0_f64, 0.0_f64);
            for axis in 0..3 {
                let there = change.axes[axis];
                off = off.hypot(state.position[axis] - changed.position[there] / change.length);
                off_speed =
                    off_speed.hypot(state.velocity[axis] - changed.velocity[there] / change.speed);
            }
            if off > room || off_speed > room_speed {
                return Some(format!(
                    "{}: at sample {sample} of body {body} {off:e} of {length:e} and {off_speed:e} of {speed:e} \
                     where {a:?} and {b:?} are claimed",
                    change.name
                ));
            }
        }
    }
    None
}

/// What became of a scene.
#[derive(Default)]
struct Tried {
    family: &'static str,
    compared: u32,
    refused: u32,
    undetermined: u32,
    last_digits: u8,
    lies: Vec<String>,
}

fn tried(seed: u64) -> Tried {
    let (family, draw) = FAMILIES[(seed % FAMILIES.len() as u64) as usize];
    let mut lot = Lot(Pcg64::seed_from_u64(seed));
    let scene = draw(&mut lot);
    let mut tried = Tried {
        family,
        ..Tried::default()
    };
    let own = match exact(&scene) {
        Ok(own) => own,
        Err(error) => {
            assert!(
                error.contains("exact cannot"),
                "{family}, seed {seed}: {error}"
            );
            tried.refused += 1;
            return tried;
        }
    };
    let digits = own.digits.as_ref().unwrap();
    tried.last_digits = digits.last().map_or(0, |digits| digits.position);
    tried.undetermined = u32::from(own.undetermined.is_some());
    let mut changes = vec![
        with_axes_relabelled(&scene),
        with_bodies_reordered(&scene),
        in_other_units(&scene, &mut lot),
    ];
    changes.extend(beside_a_still_spring(&scene));
    // Two of them a scene: more scenes say more than more changes of one.
    for _ in 0..2 {
        let change = changes.swap_remove(lot.below(changes.len()));
        match exact(&change.scene) {
            Ok(other) => {
                tried.compared += 1;
                if let Some(lie) = disagreement(&scene, &own, &change, &other) {
                    tried.lies.push(format!("{family}, seed {seed}, {lie}"));
                }
            }
            Err(_) => tried.refused += 1,
        }
    }
    tried
}

fn agree(scenes: u64) {
    let start = std::env::var("CAROM_SEED")
        .ok()
        .and_then(|seed| seed.parse().ok())
        .unwrap_or(0);
    let all: Vec<Tried> = (start..start + scenes).into_par_iter().map(tried).collect();
    let mut table: BTreeMap<&str, [u32; 6]> = BTreeMap::new();
    let mut lies = Vec::new();
    for one in all {
        let row = table.entry(one.family).or_default();
        row[0] += 1;
        row[1] += one.compared;
        row[2] += one.refused;
        row[3] += one.undetermined;
        row[4] += u32::from(one.last_digits);
        row[5] += one.lies.len() as u32;
        lies.extend(one.lies);
    }
    println!("family: scenes, compared, refused, undetermined, mean digits at the end, lies");
    for (family, [scenes, compared, refused, undetermined, digits, lies]) in table {
        let mean = f64::from(digits) / f64::from(scenes);
        println!("{family}: {scenes}, {compared}, {refused}, {undetermined}, {mean:.1}, {lies}");
    }
    assert!(lies.is_empty(), "{} lies:\n{}", lies.len(), lies.join("\n"));
}

#[test]
fn changes_that_must_not_matter_leave_answers_within_what_is_claimed() {
    agree(FEW);
}

/// `CAROM_SCENES` says how many instead.
#[test]
#[ignore = "minutes; .ci/run runs it"]
fn two_thousand_scenes_and_their_changes_agree_within_what_is_claimed() {
    let scenes = std::env::var("CAROM_SCENES")
        .ok()
        .and_then(|count| count.parse().ok());
    agree(scenes.unwrap_or(2000));
}
