//! Whether the order of the impacts of a tie decides the answer, among forces.
//!
//! All of it in doubles, which are fast: how inputs move the impacts is seen on moves that are
//! large beside their rounding, and other orders part by more than rounding where they matter.

use super::accuracy::Accuracy;
use super::simulation::{ForcesSimulation, Together};
use crate::engine::Simulation;
use crate::engine::exact::claim::Scale;
use crate::engine::exact::nudge::moved;
use crate::engine::exact::parting::Parting;
use crate::engine::exact::ties::{CONTINUATIONS_MAX, COPIES, Measure, SAME, Tie, ties};
use crate::error::Result;
use crate::physics::BodyState;
use crate::recording::{Recording, Undetermined};
use crate::scene::Scene;

/// Inputs are moved by this share: far above rounding, far below what bends a path.
const NUDGE: f64 = 1.455_191_522_836_685e-11; // 2^-36

/// Half ulps by which what is computed in doubles may be off beside its inputs.
const ROUNDINGS: f64 = 64.0;

/// Velocities after a tie that differ by so many times what moving the impacts by the width of
/// the tie does, differ by the order.
const MOVED: f64 = 64.0;

/// Operations that each run which looks for ties may take: some tenths of a second.
const OPERATIONS: u64 = 200_000_000;

/// A recorded scene whose ties are judged.
pub(super) struct Judge<'a> {
    pub scene: &'a Scene,
    pub recording: &'a Recording,
    pub scale: &'a Scale,
    /// Samples that are certain so far.
    pub known: usize,
    pub operations: u64,
}

impl Judge<'_> {
    /// The first tie whose order decides the answer.
    pub fn judge(&self) -> Result<Option<Undetermined>> {
        let mut continuations = 0;
        for tie in self.ties()? {
            if let Some(found) = self.try_orders(&tie, &mut continuations)? {
                return Ok(Some(found));
            }
        }
        Ok(None)
    }

    fn ties(&self) -> Result<Vec<Tie<f64>>> {
        let operations = OPERATIONS.min(self.operations);
        let last = self.scene.sample_time(self.known.saturating_sub(1));
        let mut run = ForcesSimulation::<f64>::new(self.scene, Accuracy::FAST)?
            .limited(operations)
            .watched();
        run.reaches(last);
        let Some((noted, last)) = run.watch.and_then(|noted| {
            let last = noted.last()?;
            Some((noted, last))
        }) else {
            return Ok(Vec::new());
        };
        let copies = COPIES.filter_map(|seed| {
            let scene = moved(self.scene, NUDGE, seed);
            let copy = ForcesSimulation::<f64>::unchecked(&scene, Accuracy::FAST);
            let mut copy = copy.limited(operations).watched();
            copy.reaches(last + noted.within());
            copy.watch
        });
        let copies: Vec<_> = copies.collect();
        let copies: Vec<_> = copies.iter().map(|copy| &**copy).collect();
        let measure = Measure {
            share: NUDGE,
            roundings: ROUNDINGS,
            doubt: 1.0,
        };
        Ok(ties(&noted, &copies, measure))
    }

    /// How other orders of a tie lead away, where that makes them other answers.
    fn try_orders(&self, tie: &Tie<f64>, continuations: &mut u32) -> Result<Option<Undetermined>> {
        let room = 4.0 * tie.width + ROUNDINGS * f64::EPSILON * self.scene.duration;
        let between = [tie.from - room, tie.to + room];
        let before = |sample: &usize| self.scene.sample_time(*sample) < between[0];
        let Some(start) = (0..self.recording.sample_count()).rfind(before) else {
            return Ok(None);
        };
        let run = self.from(start)?;
        let mut plain = run.clone();
        if !plain.reaches(between[1]) {
            return Ok(None);
        }
        let plain = states(&plain, self.scene);
        let (mut most, mut decides) = (Parting::default(), false);
        for order in tie.orders() {
            let mut other = run.clone().with_together(Together {
                between,
                within: tie.within(),
                order,
            });
            if !other.reaches(between[1]) || *continuations == CONTINUATIONS_MAX {
                continue;
            }
            let apart = Parting::default().with_states(&plain, &states(&other, self.scene));
            if apart.velocity <= self.moved(tie.within()) {
                continue;
            }
            *continuations += 1;
            most = self.follow(other, start, most);
            decides |= most.position > SAME * self.scale.diagonal
                || most.velocity > SAME * self.scale.speed;
        }
        Ok(decides.then(|| Undetermined {
            time: tie.from,
            bodies: tie.bodies.clone(),
            spread: Some(most.position),
        }))
    }

    /// A run from a sample on.
    fn from(&self, sample: usize) -> Result<ForcesSimulation<f64>> {
        let mut run = ForcesSimulation::<f64>::new(self.scene, Accuracy::FAST)?
            .limited(OPERATIONS.min(self.operations));
        run.set_state(sample, self.recording.sample(sample));
        Ok(run)
    }

    /// Velocities that impacts moved by that time may differ by.
    fn moved(&self, time: f64) -> f64 {
        let radii = self.scene.bodies.iter().map(|body| body.radius);
        let radius = radii.fold(f64::INFINITY, f64::min);
        let speed = self.scale.speed;
        (SAME * speed).max(MOVED * time * speed * speed / radius)
    }

    /// The largest distance from the recording, at the samples after `start`.
    fn follow(&self, mut other: ForcesSimulation<f64>, start: usize, most: Parting) -> Parting {
        let mut most = most;
        for sample in start + 1..self.recording.sample_count() {
            if other.advance_to(sample, None).is_some() {
                break;
            }
            let shown = states(&other, self.scene);
            most = most.with_states(self.recording.sample(sample), &shown);
        }
        most
    }
}

fn states(run: &ForcesSimulation<f64>, scene: &Scene) -> Vec<BodyState> {
    let mut states = crate::recording::initial_states(scene);
    run.state_into(&mut states);
    states
}
