//! How far two recordings of one scene part.

use crate::recording::Recording;
use crate::scene::Scene;

/// The distance between two recordings at one sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DivergenceSample {
    /// Time, s.
    pub time: f64,
    /// Root mean square over the bodies of the distance between their two positions.
    pub rms_position: f64,
    /// Largest of these distances.
    pub max_position: f64,
    /// The body that has it.
    pub worst_body: usize,
    /// Root mean square over the bodies of the difference of their two velocities.
    pub rms_velocity: f64,
}

/// The distance between two recordings over all samples that both have.
#[derive(Debug, Clone, PartialEq)]
pub struct Divergence {
    /// First voice.
    pub voice_a: String,
    /// Second voice.
    pub voice_b: String,
    /// Sample by sample.
    pub samples: Vec<DivergenceSample>,
    /// How many samples at the start are comparable; past them a recording no longer vouches
    /// for its positions.
    pub comparable: usize,
    /// Largest distance of each body over the comparable samples. Shape: `[body]`.
    pub body_max: Vec<f64>,
}

impl Divergence {
    /// Compares two recordings of `scene`.
    #[must_use]
    pub fn between(scene: &Scene, a: &Recording, b: &Recording) -> Self {
        let mut body_max = vec![0.0_f64; scene.bodies.len()];
        let mut samples = Vec::new();
        let comparable = a
            .comparable_samples(scene)
            .min(b.comparable_samples(scene))
            .max(1);
        for (sample, (states_a, states_b)) in a.samples().zip(b.samples()).enumerate() {
            let mut at = DivergenceSample {
                time: scene.sample_time(sample),
                rms_position: 0.0,
                max_position: 0.0,
                worst_body: 0,
                rms_velocity: 0.0,
            };
            for (body, (state_a, state_b)) in states_a.iter().zip(states_b).enumerate() {
                let distance = (state_a.position - state_b.position).norm();
                at.rms_position += distance * distance;
                at.rms_velocity += (state_a.velocity - state_b.velocity).norm_squared();
                if sample < comparable {
                    body_max[body] = body_max[body].max(distance);
                }
                if distance > at.max_position {
                    (at.max_position, at.worst_body) = (distance, body);
                }
            }
            #[allow(clippy::cast_precision_loss, reason = "bodies are far fewer than 2^53")]
            let count = states_a.len() as f64;
            at.rms_position = (at.rms_position / count).sqrt();
            at.rms_velocity = (at.rms_velocity / count).sqrt();
            samples.push(at);
        }
        Self {
            voice_a: a.voice.clone(),
            voice_b: b.voice.clone(),
            comparable: comparable.min(samples.len()),
            samples,
            body_max,
        }
    }

    /// The comparable sample at which one body is farthest apart; the first of equals.
    #[must_use]
    pub fn largest(&self) -> DivergenceSample {
        let farther = |best: DivergenceSample, at: &DivergenceSample| {
            if at.max_position > best.max_position {
                *at
            } else {
                best
            }
        };
        let comparable = &self.samples[..self.comparable];
        comparable.iter().fold(self.samples[0], farther)
    }

    /// The first comparable time at which one body is apart by more than that.
    #[must_use]
    pub fn first_beyond(&self, distance: f64) -> Option<f64> {
        self.samples[..self.comparable]
            .iter()
            .find(|at| at.max_position > distance)
            .map(|at| at.time)
    }

    /// Whether this is the divergence between these two voices, in either order.
    #[must_use]
    pub fn is_between(&self, voice_a: &str, voice_b: &str) -> bool {
        (self.voice_a == voice_a && self.voice_b == voice_b)
            || (self.voice_a == voice_b && self.voice_b == voice_a)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::physics::Vector3;

    #[test]
    fn a_shifted_twin_is_apart_by_the_shift() {
        let text = "name = 'x'\nduration = 1\nsample_every = 1\n\
            [[bodies]]\nname='a'\nmass=1\nradius=1\nposition=[0,0,0]\nvelocity=[0,0,0]\n\
            [[bodies]]\nname='b'\nmass=1\nradius=1\nposition=[9,0,0]\nvelocity=[0,0,0]\n";
        let scene = crate::scene::parse(text, "x").unwrap();
        let mut a = Recording::at_start("a", &scene);
        let mut b = Recording::at_start("b", &scene);
        let mut states = crate::recording::initial_states(&scene);
        a.push(&states);
        states[1].position += Vector3::new(3.0, 0.0, 4.0);
        states[1].velocity += Vector3::new(0.0, 2.0, 0.0);
        b.push(&states);
        let apart = Divergence::between(&scene, &a, &b);
        let largest = apart.largest();
        assert_eq!(
            (largest.time, largest.max_position, largest.worst_body),
            (1.0, 5.0, 1)
        );
        assert_eq!(largest.rms_position, 12.5_f64.sqrt());
        assert_eq!(largest.rms_velocity, 2.0_f64.sqrt());
        assert_eq!(apart.body_max, [0.0, 5.0]);
        assert_eq!(apart.first_beyond(5.0), None);
        assert_eq!(apart.first_beyond(4.9), Some(1.0));
    }
}
