//! A recording made again: does it differ from the first one in any bit, and where first?

use serde::Serialize;

use crate::recording::Recording;
use crate::scene::Scene;

/// What a replay came to.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "found", rename_all = "kebab-case")]
pub enum Replay {
    /// Every bit is the same.
    Same {
        /// Samples, the start included.
        samples: usize,
        /// The digest of both.
        digest: String,
    },
    /// The first number that differs.
    Differs {
        /// The sample.
        sample: usize,
        /// Its time, s.
        time: f64,
        /// The body.
        body: String,
        /// The component: x, y, z, vx, vy or vz.
        component: &'static str,
        /// What the recording has.
        recorded: f64,
        /// What came out now.
        replayed: f64,
        /// How many doubles lie between them, one more.
        ulps: u64,
    },
    /// All that both have is the same, but one is longer.
    Length {
        /// Samples of the recording.
        recorded: usize,
        /// Samples now.
        replayed: usize,
    },
}

const COMPONENTS: [&str; 6] = ["x", "y", "z", "vx", "vy", "vz"];

/// Compares a recording with one made now, bit by bit.
#[must_use]
pub fn replay(scene: &Scene, recorded: &Recording, replayed: &Recording) -> Replay {
    for (sample, (before, now)) in recorded.samples().zip(replayed.samples()).enumerate() {
        for (body, (before, now)) in before.iter().zip(now).enumerate() {
            let numbers = |state: &crate::physics::BodyState| {
                let [x, v] = [state.position, state.velocity];
                [x.x, x.y, x.z, v.x, v.y, v.z]
            };
            let pairs = numbers(before).into_iter().zip(numbers(now));
            for (component, (before, now)) in COMPONENTS.into_iter().zip(pairs) {
                if before.to_bits() != now.to_bits() {
                    return Replay::Differs {
                        sample,
                        time: scene.sample_time(sample),
                        body: scene.bodies[body].name.clone(),
                        component,
                        recorded: before,
                        replayed: now,
                        ulps: place(before).abs_diff(place(now)),
                    };
                }
            }
        }
    }
    let (before, now) = (recorded.sample_count(), replayed.sample_count());
    if before == now {
        Replay::Same {
            samples: now,
            digest: replayed.digest(),
        }
    } else {
        Replay::Length {
            recorded: before,
            replayed: now,
        }
    }
}

/// The place of a double in the order of all doubles; both zeros at 0.
fn place(value: f64) -> i64 {
    let size = (value.to_bits() & (u64::MAX >> 1)).cast_signed();
    if value.is_sign_negative() {
        -size
    } else {
        size
    }
}
