//! Facts about a collapse that are comparable where positions are not.

use serde::Serialize;

use super::metrics::metrics;
use crate::physics::{BodyState, attraction_energy, kinetic_energy, momentum};
use crate::recording::Recording;
use crate::scene::Scene;

/// Surfaces nearer than this share of the sum of the radii count as touching.
///
/// An engine that takes steps lets the bodies of a clump hop: they overlap by up to about 2 % of
/// the radii in a step of 0.01 s, are pushed out and fall back. A share well below that counts
/// the hops instead of the clump; from 2 % to 5 % the lecture's two clusters collapse at the same
/// sample, or the one beside it, on every engine.
const TOUCHING: f64 = 0.02;

/// What became of bodies that attract and collide.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ClusterFacts {
    /// Time of the first sample from which at least half of the bodies always belong to the
    /// largest clump of touching bodies, s.
    pub collapse_time: Option<f64>,
    /// Energy lost from the first to the last sample, over the largest |kinetic| + |potential|.
    pub energy_lost: f64,
    /// Bodies of the largest clump at the last sample.
    pub largest_clump: usize,
    /// Bodies bound to the largest clump at the last sample, its own included: those whose
    /// energy relative to it is negative.
    pub bound_bodies: usize,
}

/// The cluster facts of a recording of at least one sample.
#[must_use]
pub fn cluster_facts(scene: &Scene, recording: &Recording) -> ClusterFacts {
    let metrics = metrics(scene, recording);
    let scale = metrics
        .iter()
        .fold(0.0_f64, |most, at| most.max(at.energy_scale()));
    let energies = metrics.first().zip(metrics.last());
    let decline = energies.map_or(0.0, |(first, last)| {
        first.total_energy() - last.total_energy()
    });
    let is_collapsed = |states: &[BodyState]| {
        let clump = largest_clump(scene, states).len();
        clump > 1 && 2 * clump >= states.len()
    };
    let samples: Vec<&[BodyState]> = recording.samples().collect();
    let settled = samples
        .iter()
        .rev()
        .take_while(|states| is_collapsed(states))
        .count();
    let last = samples.last().copied().unwrap_or(&[]);
    let clump = largest_clump(scene, last);
    ClusterFacts {
        collapse_time: (settled > 0).then(|| scene.sample_time(samples.len() - settled)),
        energy_lost: if scale == 0.0 { 0.0 } else { decline / scale },
        largest_clump: clump.len(),
        bound_bodies: bound(scene, last, &clump),
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
    use crate::scene;

    /// Two that touch at rest, one that leaves at twice the speed of escape.
    #[test]
    fn counts_the_clump_and_the_bound() {
        let text = "name = \"c\"\nduration = 1.0\nsample_every = 1.0\n\
            [effects.attraction]\nconstant = 1.0\n\
            [[bodies]]\nname = \"a\"\nmass = 1.0\nradius = 0.5\nposition = [0.0, 0.0, 0.0]\nvelocity = [0.0, 0.0, 0.0]\n\
            [[bodies]]\nname = \"b\"\nmass = 1.0\nradius = 0.5\nposition = [1.0, 0.0, 0.0]\nvelocity = [0.0, 0.0, 0.0]\n\
            [[bodies]]\nname = \"c\"\nmass = 1.0\nradius = 0.5\nposition = [4.5, 0.0, 0.0]\nvelocity = [2.0, 0.0, 0.0]\n";
        let scene = scene::parse(text, "test").unwrap();
        let facts = cluster_facts(&scene, &Recording::at_start("test", &scene));
        assert_eq!(facts.collapse_time, Some(0.0));
        assert_eq!((facts.largest_clump, facts.bound_bodies), (2, 2));
        assert!(facts.energy_lost.abs() < 1e-15);
    }
}
