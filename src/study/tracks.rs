//! Paths for pictures: the scene's own samples would cut every corner.

use crate::engine::{StepGrid, record};
use crate::error::Result;
use crate::physics::Vector3;
use crate::recording::Recording;
use crate::scene::Scene;
use crate::study::Voice;

/// States that the track of one picture may hold.
const STATES_MAX: u64 = 100_000;

/// Where each body went. Shape: `[body][point]`, the points not evenly spaced in time.
pub type Track = Vec<Vec<Vector3>>;

/// The path of a voice: an engine is run again with the same steps and sampled every few of
/// them, every step where that stays within a bound; a reference gets its impacts put in.
///
/// # Errors
/// As [`record`].
pub fn track(scene: &Scene, voice: &Voice, dt: f64) -> Result<Track> {
    let Some(spec) = voice.spec.as_ref().filter(|spec| spec.takes_steps()) else {
        return Ok(with_corners(scene, &voice.recording));
    };
    let grid = StepGrid::new(scene, dt)?;
    let states = (scene.sample_count() * scene.bodies.len()) as u64;
    let divides = |parts: &u64| grid.steps_per_sample.is_multiple_of(*parts);
    let fits = |parts: &u64| states * parts <= STATES_MAX;
    let parts = (1..=grid.steps_per_sample.min(1000))
        .filter(divides)
        .take_while(fits)
        .last()
        .unwrap_or(1);
    #[allow(clippy::cast_precision_loss, reason = "1000 at most")]
    let sample_every = scene.sample_every / parts as f64;
    let fine = record(
        &Scene {
            sample_every,
            ..scene.clone()
        },
        spec,
        dt,
    )?;
    // A recording ends with its last finite sample on the scene's own grid; so does its path.
    let intervals = voice.recording.sample_count() - 1;
    let kept = intervals * usize::try_from(parts).unwrap_or(1) + 1;
    Ok(points(scene, &fine, kept, |_, _| None))
}

/// Samples, with a point put in at the impact of a body between two of them.
///
/// The point lies on the straight line before the first impact; that drag and gravity bend
/// the flight in between does not show in a picture.
fn with_corners(scene: &Scene, recording: &Recording) -> Track {
    points(
        scene,
        recording,
        recording.sample_count(),
        |sample, body| {
            let (start, end) = (scene.sample_time(sample), scene.sample_time(sample + 1));
            let mut impacts = recording.events.impacts();
            let hit = impacts.find(|event| {
                let (first, second) = event.kind.bodies();
                event.time > start && event.time < end && (first == body || second == Some(body))
            })?;
            let state = recording.sample(sample)[body];
            Some(state.position + state.velocity * (hit.time - start))
        },
    )
}

fn points(
    scene: &Scene,
    recording: &Recording,
    samples: usize,
    after: impl Fn(usize, usize) -> Option<Vector3>,
) -> Track {
    let of_body = |body: usize| {
        let at = |sample: usize| {
            let here = recording.sample(sample)[body].position;
            std::iter::once(here).chain(after(sample, body))
        };
        (0..samples.min(recording.sample_count()))
            .flat_map(at)
            .collect()
    };
    (0..scene.bodies.len()).map(of_body).collect()
}
