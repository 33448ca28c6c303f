//! The times at which the rung `swept` finds impacts, in one step, against Parry's shape cast and
//! against the closed form of the exact engine.

use carom::engine::{engine, record};
use carom::error::Error;
use carom::scene::{Contact, Cushions, Effects, Scene};
use nalgebra::Vector3;
use parry3d_f64::math::{Pose, Vector};
use parry3d_f64::query::{ShapeCastOptions, cast_shapes};
use parry3d_f64::shape::{Ball, HalfSpace};
use proptest::prelude::*;

use crate::scenes::{body, scene};

/// A product and a sum for each of two bodies: half an epsilon each, and as much again for what
/// is made of them. Six hundred thousand meetings passed; a tenth of it fails at once.
const ROUNDINGS: f64 = 4.0 * f64::EPSILON;

/// Two balls a and b on straight lines. Shape of the arrays: a, b.
#[derive(Debug, Clone)]
struct Meeting {
    radii: [f64; 2],
    positions: [Vector3<f64>; 2],
    velocities: [Vector3<f64>; 2],
}

impl Meeting {
    fn scene(&self) -> Scene {
        let ball = |which: usize, name: &str| {
            let (x, v) = (self.positions[which], self.velocities[which]);
            body(name, 1.0, self.radii[which], x.into(), v.into())
        };
        let effects = Effects {
            contact: Some(Contact { restitution: 0.5 }),
            ..Effects::default()
        };
        scene(1.0, 1.0, vec![ball(0, "a"), ball(1, "b")], effects)
    }

    fn by_parry(&self) -> Option<f64> {
        let pose = |which: usize| pose(&self.positions[which]);
        let vel = |which: usize| vector(&self.velocities[which]);
        let balls = self.radii.map(Ball::new);
        let (a, b) = (&balls[0], &balls[1]);
        let hit = cast_shapes(&pose(0), vel(0), a, &pose(1), vel(1), b, within_a_step());
        hit.unwrap().map(|hit| hit.time_of_impact)
    }

    fn room(&self) -> Room {
        let [d, w] = [&self.positions, &self.velocities].map(|pair| pair[0] - pair[1]);
        let reach = self.radii[0] + self.radii[1];
        let norms = self.positions.iter().chain(&self.velocities);
        let largest = norms.map(|v| v.norm()).fold(reach, f64::max);
        let pace = w.norm();
        Room {
            pace,
            chord: reach * reach - (d.cross(&w).norm() / pace).powi(2),
            apart: d.norm(),
            reach,
            largest,
            closest: -d.dot(&w) / (pace * pace),
        }
    }
}

fn pose(position: &Vector3<f64>) -> Pose {
    Pose::from_translation(vector(position))
}

fn vector(of: &Vector3<f64>) -> Vector {
    Vector::new(of.x, of.y, of.z)
}

fn within_a_step() -> ShapeCastOptions {
    ShapeCastOptions {
        max_time_of_impact: 1.0,
        stop_at_penetration: false,
        ..ShapeCastOptions::default()
    }
}

/// Where rounding can put the time at which |d + w t| falls to the reach s.
///
/// With p the impact parameter, `t = (-d.w/w - (s² - p²)^(1/2))/w`. What rounding changes in the
/// square under the root moves the root by no more than `min(change/root, change^(1/2))`.
#[derive(Debug, Clone, Copy)]
struct Room {
    pace: f64,
    /// s² - p², negative where they pass.
    chord: f64,
    apart: f64,
    reach: f64,
    largest: f64,
    /// Time of the closest approach.
    closest: f64,
}

impl Room {
    /// Rounding of the square by a search of the gap on the way: a place is rounded by the
    /// largest number, the gap by no more, and the square by the reach times that.
    fn by_search(&self) -> f64 {
        ROUNDINGS * self.reach * self.largest
    }

    /// The same by the textbook's discriminant, which has the square of the distance in it.
    fn by_discriminant(&self) -> f64 {
        self.by_search() + ROUNDINGS * self.apart * self.apart
    }

    fn tolerance(&self, square: f64) -> f64 {
        let root = self.chord.max(0.0).sqrt();
        let moved = (square / root).min(square.sqrt());
        (moved + ROUNDINGS * (self.apart + self.reach + self.largest)) / self.pace + ROUNDINGS
    }

    /// Whether rounding can tell if they meet within the step.
    fn is_clear(&self, square: f64) -> bool {
        let meet = self.closest - self.chord.max(0.0).sqrt() / self.pace;
        self.chord.abs() > square && (meet - 1.0).abs() > self.tolerance(square)
    }
}

/// The time of the first impact in one step of that engine.
fn first_impact(name: &str, scene: &Scene) -> Result<Option<f64>, Error> {
    let recording = record(scene, &engine(name).unwrap(), 1.0)?;
    let mut impacts = recording.events.impacts();
    Ok(impacts.next().map(|first| first.time))
}

/// What is wrong with a time, given another and how far apart they may be.
fn differ(a: Option<f64>, b: Option<f64>, within: f64) -> Result<(), String> {
    match (a, b) {
        (None, None) => Ok(()),
        (Some(a), Some(b)) if (a - b).abs() <= within => Ok(()),
        _ => Err(format!("{a:?} and {b:?}, {within:e} allowed")),
    }
}

/// Directions: any, and along the axes.
fn direction() -> impl Strategy<Value = Vector3<f64>> {
    let component = prop_oneof![Just(0.0), Just(1.0), -1.0..1.0];
    let any = [component.clone(), component.clone(), component];
    any.prop_filter_map("no direction", |v| Vector3::from(v).try_normalize(1e-3))
}

/// 10^-n, n up to that.
fn power(most: f64) -> impl Strategy<Value = f64> {
    (0.0..most).prop_map(|n| 10.0_f64.powf(-n))
}

/// Impact parameters as shares of the reach: head-on, oblique, grazing, missing by a hair or far.
fn aim() -> impl Strategy<Value = f64> {
    prop_oneof![
        Just(0.0),
        0.0..1.0,
        power(12.0).prop_map(|hair| 1.0 - 0.5 * hair),
        power(12.0).prop_map(|hair| 1.0 + hair),
    ]
}

/// Times: any within the step, at its very start, and at its end.
fn when() -> impl Strategy<Value = f64> {
    prop_oneof![Just(0.0), 0.0..1.2, power(9.0)]
}

/// Meetings that lean towards trouble: built backwards from how and when they touch.
fn meeting() -> impl Strategy<Value = Meeting> {
    let radius = prop_oneof![0.1..2.0, power(6.0)];
    let shape = ([radius.clone(), radius], aim(), when());
    let speed = prop_oneof![0.1..10.0, (0.0..4.0).prop_map(|n| 10.0_f64.powf(n))];
    let frame = prop_oneof![Just(0.0), -1e3..1e3];
    let motion = (direction(), direction(), speed, direction(), frame);
    (shape, motion).prop_filter_map("no direction across", |(shape, motion)| {
        let (radii, aim, when): ([f64; 2], f64, f64) = shape;
        let (along, side, speed, boost, frame): (
            Vector3<f64>,
            Vector3<f64>,
            f64,
            Vector3<f64>,
            f64,
        ) = motion;
        let across = (side - along * side.dot(&along)).try_normalize(1e-3)?;
        let reach = radii[0] + radii[1];
        let back = (reach * reach * (1.0 - aim * aim)).max(0.0).sqrt() + speed * when;
        let d = across * (aim * reach) - along * back;
        let (moved, carried) = (boost * (0.1 * frame), boost * frame);
        Some(Meeting {
            radii,
            positions: [moved + d, moved],
            velocities: [
                along * speed * 0.75 + carried,
                carried - along * speed * 0.25,
            ],
        })
    })
}

/// A ball that flies towards the wall x = half width, or away from it.
fn towards_wall() -> impl Strategy<Value = (f64, Vector3<f64>, Vector3<f64>, f64)> {
    let radius = prop_oneof![0.1..2.0, power(6.0)];
    let speed = prop_oneof![
        -1.0..10.0,
        power(6.0),
        (0.0..4.0).prop_map(|n| 10.0_f64.powf(n))
    ];
    let sideways = [-10.0..10.0, -10.0..10.0];
    let all = (radius, speed, when(), sideways, 1.0..1e3_f64);
    all.prop_map(|(radius, speed, when, [vy, vz], room)| {
        let (speed, when): (f64, f64) = (speed, when);
        let gap = (speed * when).abs();
        // The wall on the other side is as far from the centre of the box.
        let wall = room + gap + radius;
        let position = Vector3::new(wall - radius - gap, 0.0, 0.0);
        (radius, position, Vector3::new(speed, vy, vz), wall)
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    /// Two moving spheres. Parry casts a ray at a ball, by the discriminant; the exact engine has
    /// the closed form without differences of large numbers.
    #[test]
    fn two_spheres_meet_when_parry_and_the_closed_form_say(meeting in meeting()) {
        let (scene, room) = (meeting.scene(), meeting.room());
        let swept = first_impact("swept", &scene).unwrap();
        let closed_form = match first_impact("exact-fast", &scene) {
            Ok(time) => Some((time, room.by_search())),
            // Touching small balls may overlap by more rounding than it takes for a touch.
            Err(Error::EngineCannot { what, .. }) if what.contains("overlap at the start") => None,
            Err(error) => panic!("{error}"),
        };
        let parry = Some((meeting.by_parry(), room.by_discriminant()));
        for (other, square) in parry.into_iter().chain(closed_form) {
            if !room.is_clear(square) {
                continue;
            }
            let within = 2.0 * room.tolerance(square);
            prop_assert_eq!(differ(swept, other, within), Ok(()));
            // Control: a time that is wrong by twice as much is seen.
            let wrong = swept.map(|time| time + 2.0 * within);
            prop_assert!(swept.is_none() || differ(wrong, other, within).is_err());
        }
    }

    /// A sphere and a wall: the gap over the speed, by Parry against a half-space.
    #[test]
    fn a_sphere_meets_a_wall_when_parry_says((radius, position, velocity, wall) in towards_wall()) {
        let effects = Effects {
            cushions: Some(Cushions {
                half_width: wall,
                half_length: 1e6,
                restitution: 0.5,
                half_height: None,
            }),
            ..Effects::default()
        };
        let ball = body("a", 1.0, radius, position.into(), velocity.into());
        let scene = scene(1.0, 1.0, vec![ball], effects);
        let plane = HalfSpace::new(Vector::new(-1.0, 0.0, 0.0));
        let at = Vector3::new(wall, 0.0, 0.0);
        let still = Vector::ZERO;
        let ball = Ball::new(radius);
        let cast = cast_shapes(
            &pose(&at), still, &plane, &pose(&position), vector(&velocity), &ball, within_a_step(),
        );
        let parry = cast.unwrap().map(|hit| hit.time_of_impact);
        // Parry takes a ball that stands at the wall as hitting it whatever its way.
        let parry = parry.filter(|_| velocity.x > 0.0);
        let swept = first_impact("swept", &scene).unwrap();
        let within = ROUNDINGS * (wall + 1.0) / velocity.x.abs() + ROUNDINGS;
        let meet = (wall - radius - position.x) / velocity.x;
        if (meet - 1.0).abs() > within {
            prop_assert_eq!(differ(swept, parry, 2.0 * within), Ok(()));
            let closed = (velocity.x > 0.0 && meet < 1.0).then_some(meet);
            prop_assert_eq!(differ(swept, closed, 2.0 * within), Ok(()));
        }
    }
}

/// Control: the rung that finds impacts by overlap, at the end of the step, is told apart from
/// the swept one by the same comparison.
#[test]
fn a_time_found_by_overlap_is_seen_to_be_wrong() {
    let meeting = Meeting {
        radii: [0.5, 0.5],
        positions: [Vector3::new(-1.5, 0.2, 0.0), Vector3::zeros()],
        velocities: [Vector3::new(1.2, 0.0, 0.0), Vector3::zeros()],
    };
    let (scene, room) = (meeting.scene(), meeting.room());
    let within = 2.0 * room.tolerance(room.by_discriminant());
    let time = |name: &str| first_impact(name, &scene).unwrap();
    assert_eq!(differ(time("swept"), meeting.by_parry(), within), Ok(()));
    assert_eq!(time("lecture"), Some(1.0));
    assert!(differ(time("lecture"), meeting.by_parry(), within).is_err());
}

/// The gap is an ulp of the small distance and far less than one of the places: the search took
/// steps in which nothing moved, and gave up.
#[test]
fn balls_an_ulp_apart_used_to_pass_through_each_other() {
    let meeting = Meeting {
        radii: [2.338_651_479_971_299_5e-6, 0.001_100_578_566_552_874_6],
        positions: [
            Vector3::new(
                12.293_219_803_033_459,
                36.997_431_334_870_306,
                36.996_982_043_467_93,
            ),
            Vector3::new(
                12.294_272_548_840_26,
                36.997_266_777_745_29,
                36.997_266_777_745_29,
            ),
        ],
        velocities: [
            Vector3::new(
                7_258.559_389_621_579,
                -745.412_029_947_149_2,
                2_299.930_157_269_188,
            ),
            Vector3::new(
                -2_255.596_162_556_959,
                741.767_567_018_986_9,
                -273.346_495_386_458_9,
            ),
        ],
    };
    let d = meeting.positions[0] - meeting.positions[1];
    let gap = d.norm() - meeting.radii[0] - meeting.radii[1];
    assert!(0.0 < gap && gap < 1e-17, "{gap}");
    let time = first_impact("swept", &meeting.scene()).unwrap();
    assert!(time.is_some_and(|time| time < 1e-15), "{time:?}");
}
