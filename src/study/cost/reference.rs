//! What errors are measured against, and the errors.

use crate::compare::{Metrics, Sizes, compare_events, horizon, metrics};
use crate::engine::{EngineSpec, engine, prepare, record};
use crate::error::{Error, Result};
use crate::physics::BodyState;
use crate::recording::{Recording, Undetermined, initial_states};
use crate::scene::Scene;

/// A recording that others are measured against.
#[derive(Debug, Clone)]
pub struct Reference {
    recording: Recording,
    metrics: Vec<Metrics>,
    /// What lengths and energies are measured against.
    pub sizes: Sizes,
    /// How many samples, the start included, it vouches for: up to the horizon.
    pub comparable: usize,
}

/// How far one run is from the reference; none for what has no value.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Errors {
    /// Root mean square of the distances over bodies and samples, scene length unit.
    pub position_rms: Option<f64>,
    /// Largest distance of a body at a sample, scene length unit.
    pub position_max: Option<f64>,
    /// Largest difference in time of two matched impacts, s.
    pub event_time: Option<f64>,
    /// Largest difference of the total energies, over the energy scale of the reference.
    pub energy: Option<f64>,
    /// Largest distance after one sample that starts on the reference, scene length unit.
    pub local: Option<f64>,
}

impl Reference {
    /// Takes a recording as the reference.
    #[must_use]
    pub fn new(scene: &Scene, recording: Recording) -> Self {
        let metrics = metrics(scene, &recording);
        Self {
            sizes: Sizes::of(&recording, &metrics),
            comparable: recording.comparable_samples(scene),
            metrics,
            recording,
        }
    }

    /// The exact engine's certified recording, or why there is none to compare with.
    ///
    /// # Errors
    /// A scene that is not one.
    pub fn exact(scene: &Scene) -> Result<std::result::Result<Self, String>> {
        let recording = match record(scene, &engine("exact")?, scene.sample_every) {
            Ok(recording) => recording,
            Err(refusal @ Error::EngineCannot { .. }) => return Ok(Err(refusal.to_string())),
            Err(error) => return Err(error),
        };
        let reference = Self::new(scene, recording);
        Ok(if reference.comparable > 1 {
            Ok(reference)
        } else {
            Err("exact certifies no sample past the start".to_owned())
        })
    }

    /// Vouches for nothing from where another recording, which knows no better, is farther away
    /// than a tolerance: the horizon. At least the first sample stays.
    pub fn cut_where(&mut self, scene: &Scene, twin: &Recording, tolerance: f64) {
        let twins = std::slice::from_ref(twin);
        let Some(time) = horizon(scene, &self.recording, twins, tolerance) else {
            return;
        };
        let time = time.max(scene.sample_time(2));
        let known = self.recording.undetermined.as_ref();
        if known.is_none_or(|known| known.time > time) {
            self.recording.undetermined = Some(Undetermined {
                time,
                bodies: Vec::new(),
                spread: None,
            });
            self.comparable = self.recording.comparable_samples(scene);
        }
    }

    /// Time of the last sample that is compared, s.
    #[must_use]
    pub fn until(&self, scene: &Scene) -> f64 {
        scene.sample_time(self.comparable.max(1) - 1)
    }

    /// The first sample from which on nothing moves any more; the last of the scene if
    /// something always does, or if the reference ends early.
    #[must_use]
    pub fn rest_sample(&self, scene: &Scene) -> usize {
        let last = scene.sample_count();
        if self.recording.sample_count() <= last {
            return last;
        }
        let moves = |sample: &usize| {
            let states = self.recording.sample(*sample);
            states.iter().any(|state| state.velocity.norm() > 0.0)
        };
        (0..=last)
            .rev()
            .find(moves)
            .map_or(last, |at| last.min(at + 1))
    }

    /// How far a run is from the reference, up to the horizon; blank for a run that does not
    /// come so far. The local error is measured apart, by [`local_error`](Self::local_error).
    #[must_use]
    pub fn errors(&self, scene: &Scene, run: &Recording) -> Errors {
        if run.sample_count() < self.comparable {
            return Errors::default();
        }
        let (mut squares, mut largest, mut count) = (0.0, 0.0_f64, 0.0);
        for sample in 1..self.comparable {
            for (a, b) in run.sample(sample).iter().zip(self.recording.sample(sample)) {
                let distance = (a.position - b.position).norm();
                squares += distance * distance;
                largest = largest.max(distance);
                count += 1.0;
            }
        }
        let energies = metrics(scene, run);
        let pairs = energies.iter().zip(&self.metrics).take(self.comparable);
        let energy = pairs
            .map(|(a, b)| (a.total_energy() - b.total_energy()).abs())
            .fold(0.0, f64::max);
        let events = compare_events(scene, run, &self.recording);
        Errors {
            position_rms: finite((squares / count).sqrt()),
            position_max: finite(largest),
            event_time: (events.matched > 0)
                .then_some(events.time_difference_max)
                .and_then(finite),
            energy: finite(Sizes::share(energy, self.sizes.energy)),
            local: None,
        }
    }

    /// The engine put on the reference at each sample and advanced by one, up to the horizon: its
    /// sample n comes from the reference's n - 1. None if it does not get through.
    ///
    /// # Errors
    /// As [`prepare`].
    pub fn one_by_one(
        &self,
        scene: &Scene,
        spec: &EngineSpec,
        dt: f64,
    ) -> Result<Option<Recording>> {
        let mut simulation = prepare(scene, spec, dt)?;
        let mut states = initial_states(scene);
        let mut hops = Recording::at_start(&spec.name, scene);
        for sample in 1..self.comparable {
            simulation.set_state(sample - 1, self.recording.sample(sample - 1));
            if simulation.advance_to(sample, None).is_some() {
                return Ok(None);
            }
            simulation.state_into(&mut states);
            hops.push(&states);
        }
        Ok(Some(hops))
    }

    /// The largest distance after one sample that starts on the reference, scene length unit.
    ///
    /// # Errors
    /// As [`prepare`].
    pub fn local_error(&self, scene: &Scene, spec: &EngineSpec, dt: f64) -> Result<Option<f64>> {
        let hops = self.one_by_one(scene, spec, dt)?;
        Ok(hops.and_then(|hops| self.distance(&hops)))
    }

    /// The largest distance of another recording up to the horizon, scene length unit.
    #[must_use]
    pub fn distance(&self, run: &Recording) -> Option<f64> {
        let both = self.comparable.min(run.sample_count());
        let at = |sample| distance(run.sample(sample), self.recording.sample(sample));
        (1..both).map(at).reduce(f64::max).and_then(finite)
    }
}

fn distance(a: &[BodyState], b: &[BodyState]) -> f64 {
    let pairs = a.iter().zip(b);
    let distances = pairs.map(|(a, b)| (a.position - b.position).norm());
    // `max` would pass over what is not a number.
    distances.fold(0.0, |largest, d| {
        if d > largest || d.is_nan() {
            d
        } else {
            largest
        }
    })
}

fn finite(value: f64) -> Option<f64> {
    value.is_finite().then_some(value)
}

#[cfg(test)]
mod tests {
    use super::*;

    const FALL: &str = "name='fall'\nduration=2\nsample_every=1\n\
        [[bodies]]\nname='a'\nmass=1\nradius=1\nposition=[0,0,0]\nvelocity=[0,0,0]\n\
        [effects.gravity]\nacceleration=[0,-8,0]\n";

    /// Symplectic Euler falls g h t / 2 too far: closed form. In one sample of 1 s from the
    /// exact state it errs by g h / 2.
    #[test]
    fn errors_of_a_fall_are_those_of_the_closed_form() {
        let scene = crate::scene::parse(FALL, "x").unwrap();
        let reference = Reference::exact(&scene).unwrap().unwrap();
        let lecture = engine("lecture").unwrap();
        let run = record(&scene, &lecture, 0.5).unwrap();
        let errors = reference.errors(&scene, &run);
        assert!((errors.position_max.unwrap() - 4.0).abs() < 1e-12);
        assert!((errors.position_rms.unwrap() - 10.0_f64.sqrt()).abs() < 1e-12);
        let local = reference.local_error(&scene, &lecture, 0.5).unwrap();
        assert!((local.unwrap() - 2.0).abs() < 1e-12);
        assert_eq!(errors.event_time, None);
        assert_eq!(reference.rest_sample(&scene), 2);
    }

    #[test]
    fn a_scene_at_rest_is_priced_up_to_there() {
        let text = "name='x'\nduration=8\nsample_every=1\n\
            [[bodies]]\nname='a'\nmass=1\nradius=1\nposition=[0,0,0]\nvelocity=[1,0,0]\n\
            [effects.drag]\ncoefficient=1\n[effects.rest]\nspeed=0.1\n";
        let scene = crate::scene::parse(text, "x").unwrap();
        let reference = Reference::exact(&scene).unwrap().unwrap();
        // It stops at t = ln 10 = 2.3 s.
        assert_eq!(reference.rest_sample(&scene), 3);
    }
}
