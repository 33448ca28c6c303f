//! Whether the order of the events of a tie decides the answer: other orders, tried.

use super::simulation::FlightSimulation;
use crate::engine::Simulation;
use crate::engine::exact::claim::Scale;
use crate::engine::exact::order::TieOrder;
use crate::engine::exact::parting::Parting;
use crate::engine::exact::ties::{CONTINUATIONS_MAX, SAME, Tie};
use crate::engine::exact::wide::Wide;
use crate::physics::real::Real;
use crate::recording::{Recording, Undetermined, initial_states};
use crate::scene::Scene;

/// Velocities after a tie that differ by so many times what moving the impacts by the width of
/// the tie does (turned normals, another moment of a flight), differ by the order.
const MOVED: f64 = 64.0;

/// What other orders of ties come to.
#[derive(Debug)]
pub(super) struct Judgement {
    /// From when on there is no single answer.
    pub undetermined: Option<Undetermined>,
    /// How far answers part that are one answer nevertheless. Shape: `[sample]`.
    pub partings: Vec<Parting>,
    /// Other orders that were followed to the end.
    pub continuations: u32,
}

/// A recorded scene whose ties are judged.
pub(super) struct Judge<'a> {
    pub scene: &'a Scene,
    pub recording: &'a Recording,
    pub scale: &'a Scale,
}

impl Judge<'_> {
    /// Tries other orders at each of the ties, up to the first one that has no single answer.
    /// `run` is at the start of the scene.
    pub fn judge(&self, ties: &[Tie<Wide>], mut run: FlightSimulation<Wide>) -> Judgement {
        let mut judgement = Judgement {
            undetermined: None,
            partings: vec![Parting::default(); self.recording.sample_count()],
            continuations: 0,
        };
        for tie in ties {
            let room = self.room(tie);
            if run.run_to(tie.from - room, &mut None).is_some() {
                break;
            }
            if let Some(spread) = self.try_orders(tie, &run, &mut judgement) {
                judgement.undetermined = Some(Undetermined {
                    time: tie.from.to_f64(),
                    bodies: tie.bodies.clone(),
                    spread: Some(spread),
                });
                break;
            }
        }
        judgement
    }

    /// Events of a tie are within this time of each other as they are computed.
    fn within(&self, tie: &Tie<Wide>) -> Wide {
        tie.length() + Wide::from_f64(1e3 * Wide::EPSILON * self.scene.duration)
    }

    /// Time before and after a tie in which nothing of it happens.
    fn room(&self, tie: &Tie<Wide>) -> Wide {
        self.within(tie).times(4.0)
    }

    /// How far other orders of a tie lead away, where that makes them other answers.
    fn try_orders(
        &self,
        tie: &Tie<Wide>,
        run: &FlightSimulation<Wide>,
        judgement: &mut Judgement,
    ) -> Option<f64> {
        let room = self.room(tie);
        let end = tie.to + room;
        let mut rule = run.clone();
        if rule.run_to(end, &mut None).is_some() {
            return None;
        }
        let (mut spread, mut decides) = (0.0_f64, false);
        for order in tie.orders() {
            let mut other = run.clone();
            other.take_together(self.within(tie), order);
            if other.run_to(end, &mut None).is_some() {
                continue;
            }
            let turned = turned(&rule, &other, end);
            if turned <= self.moved(tie) || judgement.continuations == CONTINUATIONS_MAX {
                continue;
            }
            judgement.continuations += 1;
            other.take_together(Wide::from_f64(0.0), TieOrder::Rule);
            let partings = self.follow(other, (tie.from - room, end), turned);
            let most = partings
                .iter()
                .fold(Parting::default(), |most, parting| Parting {
                    position: most.position.max(parting.position),
                    velocity: most.velocity.max(parting.velocity),
                });
            spread = spread.max(most.position);
            if most.position > SAME * self.scale.diagonal || most.velocity > SAME * self.scale.speed
            {
                decides = true;
                continue;
            }
            for (all, parting) in judgement.partings.iter_mut().zip(partings) {
                all.position = all.position.max(parting.position);
                all.velocity = all.velocity.max(parting.velocity);
            }
        }
        decides.then_some(spread)
    }

    /// Velocities that impacts moved by the width of a tie may differ by.
    fn moved(&self, tie: &Tie<Wide>) -> f64 {
        let scene = self.scene;
        let least = |least: f64, body: &crate::scene::Body| least.min(body.radius);
        let radius = scene.bodies.iter().fold(f64::INFINITY, least);
        let gravity = scene.effects.gravity.map_or([0.0; 3], |g| g.acceleration);
        let falls = gravity.iter().map(|g| g * g).sum::<f64>().sqrt();
        let light = |least: f64, body: &crate::scene::Body| least.min(body.mass);
        let mass = scene.bodies.iter().fold(f64::INFINITY, light);
        let drag = scene.effects.drag.map_or(0.0, |drag| drag.coefficient) / mass;
        let speed = self.scale.speed;
        let time = self.within(tie).to_f64();
        MOVED * (time * (speed * speed / radius + falls + drag * speed) + Wide::EPSILON * speed)
    }

    /// How far a run is from the recording, at each sample; what it has `turned` at the samples
    /// within the tie.
    fn follow(
        &self,
        mut other: FlightSimulation<Wide>,
        (start, end): (Wide, Wide),
        turned: f64,
    ) -> Vec<Parting> {
        let count = self.recording.sample_count();
        let mut partings = vec![Parting::default(); count];
        let mut states = initial_states(self.scene);
        for (sample, parting) in partings.iter_mut().enumerate() {
            let time = Wide::from_f64(self.scene.sample_time(sample));
            if time < start {
                continue;
            }
            if time <= end {
                parting.velocity = turned;
                continue;
            }
            if other.advance_to(sample, None).is_some() {
                break;
            }
            other.state_into(&mut states);
            *parting = Parting::default().with_states(self.recording.sample(sample), &states);
        }
        partings
    }
}

/// Largest difference of velocities between two runs at a time.
fn turned(one: &FlightSimulation<Wide>, other: &FlightSimulation<Wide>, time: Wide) -> f64 {
    let pairs = one.states_at(time).zip(other.states_at(time));
    let off = pairs.map(|(one, other)| (one.velocity - other.velocity).map(Real::to_f64).norm());
    off.fold(0.0, f64::max)
}
