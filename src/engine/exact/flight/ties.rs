//! Whether the order of impacts that nearly fall on one instant decides the answer.
//!
//! A scene's numbers are decimals, each known to half an ulp. What that leaves open in the time
//! between two impacts is measured on runs from moved inputs; impacts nearer than that stand for
//! one instant, and the model has no order for them but a rule. Other orders are tried there.

use super::simulation::FlightSimulation;
use super::watch::{Near, Watch, shared};
use crate::engine::Simulation;
use crate::engine::exact::claim::Scale;
use crate::engine::exact::order::TieOrder;
use crate::engine::exact::parting::{Parting, SAFETY};
use crate::engine::exact::wide::Wide;
use crate::physics::real::Real;
use crate::recording::{EventKind, Recording, Undetermined, initial_states};
use crate::scene::Scene;

/// Answers that differ by less than this share of the scene's size, or speed, are one answer, with
/// as many digits as they share.
const SAME: f64 = 1e-9;

/// Other orders that are followed to the end of a scene.
const CONTINUATIONS_MAX: u32 = 24;

/// Ties of a scene that are looked at.
const TIES_MAX: usize = 256;

/// Other orders that are tried at one tie of more than two events, beside the rule and the reverse.
const DRAWN: u64 = 7;

/// Velocities after a tie that differ by so many times what moving the impacts by the width of
/// the tie does (turned normals, another moment of a flight), differ by the order.
const MOVED: f64 = 64.0;

/// Events that stand for one instant.
#[derive(Debug, Clone)]
pub(super) struct Tie {
    from: Wide,
    to: Wide,
    /// What inputs leave open in the time between them, s.
    width: Wide,
    kinds: Vec<EventKind>,
    /// The bodies that two of them share.
    bodies: Vec<usize>,
}

/// The near coincidences that half an ulp of the inputs may turn round, those at one instant
/// together. `share` is how far the inputs of the copies were moved, `doubt` by how much what
/// they show may be too small.
pub(super) fn ties(
    run: &Watch<Wide>,
    copies: &[&Watch<Wide>],
    (share, doubt): (f64, f64),
) -> Vec<Tie> {
    let mut ties: Vec<Tie> = Vec::new();
    for near in run.noted() {
        let Some(width) = width(near, run.within(), copies, share) else {
            continue;
        };
        let width = (doubt * width).min(run.within());
        if near.lag.to_f64().abs() > width {
            continue;
        }
        let width = Wide::from_f64(width);
        let same = ties
            .last_mut()
            .filter(|tie| near.time <= tie.to + tie.width.larger(width));
        match same {
            Some(tie) => tie.join(near, width),
            None => ties.push(Tie::of(near, width)),
        }
    }
    ties.truncate(TIES_MAX);
    ties
}

/// What half an ulp of the inputs leaves open in the time between two events; none where that
/// cannot be told.
///
/// The largest change over the copies, scaled from their share to half an ulp. A copy adds the
/// parts of some twenty inputs with random signs: rarely less than a tenth of the sum of their
/// sizes, which the factor makes up for.
fn width(near: &Near<Wide>, within: f64, copies: &[&Watch<Wide>], share: f64) -> Option<f64> {
    let mut moved = 0.0_f64;
    let mut known = false;
    for copy in copies {
        let apart = |other: &Near<Wide>| (other.time - near.time).to_f64().abs();
        let same = copy
            .noted()
            .iter()
            .filter(|other| other.kinds == near.kinds);
        let nearest = same.min_by(|one, other| apart(one).total_cmp(&apart(other)));
        let Some(nearest) = nearest.filter(|nearest| apart(nearest) <= within) else {
            continue;
        };
        known = true;
        moved = moved.max((nearest.lag - near.lag).to_f64().abs());
    }
    let width = SAFETY * moved * (0.5 * f64::EPSILON / share);
    (known && width < within).then_some(width)
}

impl Tie {
    fn of(near: &Near<Wide>, width: Wide) -> Self {
        let mut tie = Self {
            from: near.time,
            to: near.time,
            width,
            kinds: Vec::new(),
            bodies: Vec::new(),
        };
        tie.join(near, width);
        tie
    }

    fn join(&mut self, near: &Near<Wide>, width: Wide) {
        self.to = self.to.larger(near.time + near.lag.abs());
        self.width = self.width.larger(width);
        for kind in near.kinds {
            if !self.kinds.contains(&kind) {
                self.kinds.push(kind);
            }
        }
        if let Some(body) = shared(near.kinds)
            && !self.bodies.contains(&body)
        {
            self.bodies.push(body);
            self.bodies.sort_unstable();
        }
    }

    /// When it is over.
    pub fn end(&self) -> Wide {
        self.to + self.width
    }

    /// Orders to try beside that of the times as computed: the rule's, the reverse, others.
    fn orders(&self) -> impl Iterator<Item = TieOrder> + use<> {
        let drawn = if self.kinds.len() > 2 { DRAWN } else { 0 };
        let drawn = (1..=drawn).map(TieOrder::Drawn);
        [TieOrder::Rule, TieOrder::Backwards]
            .into_iter()
            .chain(drawn)
    }
}

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
    pub fn judge(&self, ties: &[Tie], mut run: FlightSimulation<Wide>) -> Judgement {
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

    /// Time before and after a tie in which nothing of it happens.
    fn room(&self, tie: &Tie) -> Wide {
        let least = Wide::from_f64(1e3 * Wide::EPSILON * self.scene.duration);
        tie.width.times(4.0).larger(least)
    }

    /// How far other orders of a tie lead away, where that makes them other answers.
    fn try_orders(
        &self,
        tie: &Tie,
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
            other.take_together(tie.to - tie.from + tie.width, order);
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
    fn moved(&self, tie: &Tie) -> f64 {
        let scene = self.scene;
        let least = |least: f64, body: &crate::scene::Body| least.min(body.radius);
        let radius = scene.bodies.iter().fold(f64::INFINITY, least);
        let gravity = scene.effects.gravity.map_or([0.0; 3], |g| g.acceleration);
        let falls = gravity.iter().map(|g| g * g).sum::<f64>().sqrt();
        let light = |least: f64, body: &crate::scene::Body| least.min(body.mass);
        let mass = scene.bodies.iter().fold(f64::INFINITY, light);
        let drag = scene.effects.drag.map_or(0.0, |drag| drag.coefficient) / mass;
        let speed = self.scale.speed;
        let time = (tie.to - tie.from + tie.width).to_f64();
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
