//! Facts about a collapse that are comparable where positions are not.

use serde::Serialize;

use super::{Metrics, Sizes};
use crate::physics::{BodyState, attraction_energy, kinetic_energy, momentum};
use crate::recording::Recording;
use crate::scene::Scene;

/// Surfaces nearer than this share of the sum of the radii count as touching.
///
/// An engine that takes steps lets the bodies of a clump hop: at the end of a step they overlap
/// by a few per cent of the radii, are pushed out and fall back. A share below 1 % counts
/// the hops instead of the clump; from 2 % to 5 % the lecture's two clusters collapse at the same
/// sample, or the one beside it, on every engine.
pub const TOUCHING: f64 = 0.02;

/// Fewer bodies than this are a pair or a lone body, about which these facts say nothing.
const BODIES_MIN: usize = 3;

/// What became of bodies that attract and collide, over the first samples of a recording.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct ClusterFacts {
    /// Time of the last sample looked at, s.
    pub until_s: f64,
    /// Time of the first sample from which at least half of the bodies always belong to the
    /// largest clump of touching bodies, s; none if the last sample is not such a one.
    pub collapse_time_s: Option<f64>,
    /// Energy lost from the first to the last sample, as a share of the scale; negative where
    /// energy was gained.
    pub energy_lost: f64,
    /// Bodies of the largest clump at the last sample.
    pub largest_clump: usize,
    /// Bodies bound to the largest clump at the last sample, its own included: those whose
    /// energy relative to it is negative.
    pub bound_bodies: usize,
}

/// The cluster facts of each of several recordings of `scene`, each with its metrics, in the
/// same order.
///
/// All facts are of one time. A clump grows and loses energy while a run goes on, so the facts
/// of a run that ended early say nothing against those of one that went on; what is compared
/// is the samples that all recordings have, up to the last one of the shortest. The price:
/// one recording that breaks off at once leaves little to compare, and what the others do
/// later is not told here.
///
/// None where the facts mean nothing, as they need attraction, contact and three bodies at
/// least; none without a recording.
/// Shape of the metrics: `[sample]`, of at least one sample.
#[must_use]
pub fn cluster_facts(
    scene: &Scene,
    recordings: &[(&Recording, &[Metrics])],
    scale: &Sizes,
) -> Option<Vec<ClusterFacts>> {
    if !is_cluster(scene) {
        return None;
    }
    let lengths = recordings
        .iter()
        .map(|(recording, _)| recording.sample_count());
    let shared = lengths.min()?;
    let facts = |(recording, metrics): &(&Recording, &[Metrics])| {
        let samples: Vec<_> = recording.samples().take(shared).collect();
        facts_of(scene, &samples, &metrics[..shared], scale)
    };
    Some(recordings.iter().map(facts).collect())
}

/// Whether bodies can fall together and stay together: three at least attract and collide.
fn is_cluster(scene: &Scene) -> bool {
    let effects = &scene.effects;
    effects.attraction.is_some() && effects.contact.is_some() && scene.bodies.len() >= BODIES_MIN
}

/// The facts over these samples, at least one. Shape of `samples`: `[sample][body]`.
fn facts_of(
    scene: &Scene,
    samples: &[&[BodyState]],
    metrics: &[Metrics],
    scale: &Sizes,
) -> ClusterFacts {
    let end = samples.len() - 1;
    let is_collapsed =
        |states: &&&[BodyState]| 2 * largest_clump(scene, states).len() >= states.len();
    let settled = samples.iter().rev().take_while(is_collapsed).count();
    let clump = largest_clump(scene, samples[end]);
    let energy_lost = metrics[0].total_energy() - metrics[end].total_energy();
    ClusterFacts {
        until_s: scene.sample_time(end),
        collapse_time_s: (settled > 0).then(|| scene.sample_time(samples.len() - settled)),
        energy_lost: Sizes::share(energy_lost, scale.energy),
        largest_clump: clump.len(),
        bound_bodies: bound(scene, samples[end], &clump),
    }
}

/// The bodies of the largest set connected by touching; a lone body is a set of one.
fn largest_clump(scene: &Scene, states: &[BodyState]) -> Vec<usize> {
    let touching = |a: usize, b: usize| {
        let reach = scene.bodies[a].radius + scene.bodies[b].radius;
        (states[a].position - states[b].position).norm() <= reach * (1.0 + TOUCHING)
    };
    let mut free: Vec<usize> = (0..states.len()).collect();
    let mut largest = Vec::new();
    while let Some(seed) = free.pop() {
        let mut clump = vec![seed];
        let mut next = 0;
        while let Some(body) = clump.get(next).copied() {
            next += 1;
            let (near, far) = free.into_iter().partition(|other| touching(body, *other));
            free = far;
            let near: Vec<usize> = near;
            clump.extend(near);
        }
        if clump.len() > largest.len() {
            largest = clump;
        }
    }
    largest.sort_unstable();
    largest
}

/// How many bodies have negative energy relative to a clump's centre of mass.
fn bound(scene: &Scene, states: &[BodyState], clump: &[usize]) -> usize {
    let masses: Vec<f64> = clump.iter().map(|body| scene.bodies[*body].mass).collect();
    let members: Vec<BodyState> = clump.iter().map(|body| states[*body]).collect();
    let total: f64 = masses.iter().sum();
    let drift = momentum(&masses, &members) / total;
    let is_bound = |body: &usize| {
        if clump.contains(body) {
            return true;
        }
        let mass = scene.bodies[*body].mass;
        let pull = |other: &usize| {
            let Some(effect) = scene.effects.attraction else {
                return 0.0;
            };
            let distance = (states[*body].position - states[*other].position).norm();
            let pair = [mass, scene.bodies[*other].mass];
            attraction_energy(effect.constant, effect.softening, pair, distance)
        };
        let relative = states[*body].velocity - drift;
        kinetic_energy(mass, &relative) + clump.iter().map(pull).sum::<f64>() < 0.0
    };
    (0..states.len()).filter(is_bound).count()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::compare::metrics;
    use crate::physics::Vector3;
    use crate::recording::initial_states;
    use crate::scene;

    const EFFECTS: &str =
        "[effects.attraction]\nconstant = 1\n[effects.contact]\nrestitution = 0\n";

    /// Spheres of mass 1 and radius 0.5 on the x axis, each with its velocity along it.
    fn scene(effects: &str, bodies: &[(f64, f64)]) -> Scene {
        let body = |(place, (x, v)): (usize, &(f64, f64))| {
            format!(
                "[[bodies]]\nname = 'b{place}'\nmass = 1\nradius = 0.5\n\
                 position = [{x}, 0, 0]\nvelocity = [{v}, 0, 0]\n"
            )
        };
        let bodies: String = bodies.iter().enumerate().map(body).collect();
        let text = format!("name = 'c'\nduration = 2\nsample_every = 1\n{effects}{bodies}");
        scene::parse(&text, "test").unwrap()
    }

    /// The facts, with energies as shares of 1.
    fn facts(scene: &Scene, recordings: &[&Recording]) -> Option<Vec<ClusterFacts>> {
        let measured: Vec<_> = recordings.iter().map(|own| metrics(scene, own)).collect();
        let both = recordings.iter().zip(&measured);
        let both: Vec<_> = both.map(|(own, at)| (*own, at.as_slice())).collect();
        let one = Sizes {
            length: 1.0,
            energy: 1.0,
            momentum: 1.0,
            angular_momentum: 1.0,
        };
        cluster_facts(scene, &both, &one)
    }

    /// Two that touch at rest, one that leaves at twice the speed of escape.
    #[test]
    fn counts_the_clump_and_the_bound() {
        let scene = scene(EFFECTS, &[(0.0, 0.0), (1.0, 0.0), (4.5, 2.0)]);
        let start = Recording::at_start("test", &scene);
        let found = facts(&scene, &[&start]).unwrap();
        let expected = ClusterFacts {
            until_s: 0.0,
            collapse_time_s: Some(0.0),
            energy_lost: 0.0,
            largest_clump: 2,
            bound_bodies: 2,
        };
        assert_eq!(found, [expected]);
    }

    /// Facts of each recording's own last sample would call the longer one collapsed.
    #[test]
    fn facts_are_of_the_last_sample_that_all_recordings_have() {
        let scene = scene(EFFECTS, &[(0.0, 0.0), (4.0, 0.0), (-4.0, 0.0)]);
        let apart = initial_states(&scene);
        let mut clump = apart.clone();
        clump[1].position = Vector3::new(1.0, 0.0, 0.0);
        clump[2].position = Vector3::new(-1.0, 0.0, 0.0);
        let mut short = Recording::at_start("short", &scene);
        short.push(&apart);
        let mut long = short.clone();
        long.push(&clump);
        let both = facts(&scene, &[&long, &short]).unwrap();
        let expected = ClusterFacts {
            until_s: 1.0,
            collapse_time_s: None,
            energy_lost: 0.0,
            largest_clump: 1,
            bound_bodies: 3,
        };
        assert_eq!(both, [expected, expected]);
        // Alone, the longer one is looked at to its end. Potential energy: -1/4 - 1/4 - 1/8
        // before, -1 - 1 - 1/2 after.
        let alone = ClusterFacts {
            until_s: 2.0,
            collapse_time_s: Some(2.0),
            energy_lost: 1.875,
            largest_clump: 3,
            bound_bodies: 3,
        };
        assert_eq!(facts(&scene, &[&long]).unwrap(), [alone]);
    }

    #[test]
    fn there_are_none_without_attraction_contact_or_a_third_body() {
        let three = [(0.0, 0.0), (1.0, 0.0), (4.5, 2.0)];
        let (attraction, contact) = EFFECTS.split_at(EFFECTS.rfind('[').unwrap());
        let count = |effects: &str, bodies: &[(f64, f64)]| {
            let scene = scene(effects, bodies);
            let start = Recording::at_start("test", &scene);
            facts(&scene, &[&start]).map(|facts| facts.len())
        };
        assert_eq!(count(EFFECTS, &three), Some(1));
        assert_eq!(count(attraction, &three), None);
        assert_eq!(count(contact, &three), None);
        assert_eq!(count(EFFECTS, &three[..2]), None);
        assert_eq!(facts(&scene(EFFECTS, &three), &[]), None);
    }
}
