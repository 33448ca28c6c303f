//! Whether the order of the impacts of a tie decides the answer, among forces.
//!
//! How inputs move the impacts is measured in double-doubles, where anything is near enough to a
//! tie; what other orders lead to in doubles, as they part by more than rounding where they
//! matter.

use super::accuracy::Accuracy;
use super::scalar::{Real, Wide};
use super::simulation::{ForcesSimulation, Together};
use crate::engine::Simulation;
use crate::engine::exact::claim::Scale;
use crate::engine::exact::parting::Parting;
use crate::engine::exact::ties::{CONTINUATIONS_MAX, COPIES, Measure, Noted, SAME, Tie, ties};
use crate::error::Result;
use crate::physics::BodyState;
use crate::recording::{Recording, Undetermined};
use crate::scene::Scene;

/// Inputs are moved by this share: hundreds of times the truncation of a step.
const NUDGE: f64 = 8.470_329_472_543_003e-22; // 2^-70

/// A run in doubles may show less of what half an ulp of the inputs leaves open by this factor,
/// but for one in a thousand.
const DOUBT: f64 = 1e3;

/// Half ulps by which times in doubles may be off beside.
const ROUNDINGS: f64 = 64.0;

/// Velocities after a tie that differ by so many times what moving the impacts by the width of
/// the tie does, differ by the order.
const MOVED: f64 = 64.0;

/// Operations that each run in doubles may take: some tenths of a second.
const OPERATIONS: u64 = 200_000_000;

/// Operations that each copy in double-doubles may take.
const COPY_OPERATIONS: u64 = 500_000_000;

/// A recorded scene whose ties are judged.
pub(super) struct Judge<'a> {
    pub scene: &'a Scene,
    pub recording: &'a Recording,
    pub scale: &'a Scale,
    /// Samples that are certain so far.
    pub known: usize,
    /// What nearly fell on one instant.
    pub noted: Noted<Wide>,
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

    fn ties(&self) -> Result<Vec<Tie<Wide>>> {
        let known = self.scene.sample_time(self.known.saturating_sub(1));
        let noted = self.noted.up_to(known);
        let noted = self.worth_a_look(noted)?;
        let Some(last) = noted.last() else {
            return Ok(Vec::new());
        };
        let mut copies = Vec::new();
        for seed in COPIES {
            let copy = ForcesSimulation::<Wide>::new(self.scene, Accuracy::WIDE)?;
            let copy = copy.perturbed(self.scene, (NUDGE, seed));
            let mut copy = copy.limited(COPY_OPERATIONS).patient().watched();
            copy.reaches(last + noted.within());
            copies.extend(copy.watch);
        }
        let copies: Vec<_> = copies.iter().map(|copy| &**copy).collect();
        let measure = Measure {
            share: NUDGE,
            roundings: 1.0,
            doubt: 1.0,
        };
        Ok(ties(&noted, &copies, measure))
    }

    /// Those of the near coincidences that a run in doubles does not tell apart clearly.
    fn worth_a_look(&self, noted: Noted<Wide>) -> Result<Noted<Wide>> {
        let Some(last) = noted.last() else {
            return Ok(noted);
        };
        let run = ForcesSimulation::<f64>::new(self.scene, Accuracy::FAST)?;
        let mut run = run.limited(OPERATIONS.min(self.operations)).watched();
        run.reaches(last + noted.within());
        let Some(doubles) = run.watch else {
            return Ok(noted);
        };
        Ok(noted.unclear(&doubles, DOUBT))
    }

    /// How other orders of a tie lead away, where that makes them other answers.
    fn try_orders(&self, tie: &Tie<Wide>, continuations: &mut u32) -> Result<Option<Undetermined>> {
        let doubles = ROUNDINGS * f64::EPSILON * self.scene.duration;
        let within = tie.length().to_f64() + doubles;
        let room = 4.0 * within;
        let between = [tie.from.to_f64() - room, tie.to.to_f64() + room];
        let before = |sample: &usize| self.scene.sample_time(*sample) < between[0];
        let Some(start) = (0..self.recording.sample_count()).rfind(before) else {
            return Ok(None);
        };
        let run = self.from(start)?;
        let mut plain = run.clone();
        if !plain.reaches(between[1]) {
            return Ok(None);
        }
        let there = states(&plain, self.scene);
        let mut most = Parting::default();
        let mut plain = Some(plain);
        for order in tie.orders() {
            let mut other = run.clone().with_together(Together {
                between,
                within,
                order,
            });
            if !other.reaches(between[1]) || *continuations == CONTINUATIONS_MAX {
                continue;
            }
            let apart = Parting::default().with_states(&there, &states(&other, self.scene));
            if apart.velocity <= self.moved(within) {
                continue;
            }
            if let Some(plain) = plain.take() {
                // In doubles the two may come in another order than as recorded.
                *continuations += 1;
                most = self.follow(plain, start, most);
            }
            *continuations += 1;
            most = self.follow(other, start, most);
        }
        let decides =
            most.position > SAME * self.scale.diagonal || most.velocity > SAME * self.scale.speed;
        Ok(decides.then(|| Undetermined {
            time: tie.from.to_f64(),
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
