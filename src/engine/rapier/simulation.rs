//! Steps a Rapier world from sample to sample.

use super::harness::Harness;
use super::layout::Layout;
use super::watch::Watch;
use super::world::World;
use crate::engine::{Simulation, StepGrid};
use crate::physics::{BodyState, length};
use crate::recording::{Event, EventKind, EventLog, Outcome, Work, initial_states};
use crate::scene::{Rest, Scene};

/// A Rapier world on one scene, with what carom adds to it.
pub(super) struct RapierSimulation<W> {
    world: W,
    layout: Layout,
    harness: Option<Harness>,
    rest: Option<Rest>,
    watch: Watch,
    grid: StepGrid,
    sample: usize,
    work: Work,
    /// A body with which the world cannot be stepped at all.
    out_of_range: Option<usize>,
    /// How it ended, if it has.
    ended: Option<Outcome>,
}

impl<W: World> RapierSimulation<W> {
    /// Puts a checked scene at its start.
    pub fn new(scene: &Scene, layout: Layout, grid: StepGrid) -> Self {
        let states = initial_states(scene);
        Self {
            world: W::build(&layout, &states),
            harness: Harness::new(scene, &layout),
            rest: scene.effects.rest,
            watch: Watch::new(&layout),
            grid,
            sample: 0,
            work: Work::default(),
            out_of_range: out_of_range::<W>(&states),
            ended: None,
            layout,
        }
    }

    /// One step, which ends at `time`.
    #[inline]
    fn step(&mut self, time: f64, mut log: Option<&mut EventLog>) -> Option<Outcome> {
        if let Some(harness) = &mut self.harness {
            if let Some(body) = harness.apply(&mut self.world) {
                return Some(Outcome::NonFinite { time, body });
            }
            self.work.force_evaluations += harness.evaluations();
        }
        self.world.step();
        self.work.steps += 1;
        self.work.pair_tests += self.world.pair_count();
        if let Some(body) = self.world.lost() {
            return Some(Outcome::Disabled { time, body });
        }
        if let Some(body) = self.flung() {
            return Some(Outcome::NonFinite { time, body });
        }
        if let Some(log) = log.as_deref_mut() {
            self.watch.observe(&self.world, time, log);
        }
        if let Some(rest) = self.rest {
            self.settle(rest, time, log);
        }
        None
    }

    /// The first body that a spring joint made too fast for the square of its velocity; contacts
    /// only pass on the speed there is, and carom's own forces are checked before they act.
    fn flung(&self) -> Option<usize> {
        let ends = self.layout.springs.iter().flat_map(|spring| spring.ends);
        let too_fast = |body: &usize| !W::RANGE.holds(length(&self.world.velocity(*body)));
        ends.filter(too_fast).min()
    }

    /// Stops every body slower than the rest speed.
    fn settle(&mut self, rest: Rest, time: f64, mut log: Option<&mut EventLog>) {
        for (body, plan) in self.layout.bodies.iter().enumerate() {
            let speed = length(&self.world.velocity(body));
            if speed > 0.0 && speed < rest.speed {
                self.world.stop(body);
                if let Some(log) = log.as_deref_mut() {
                    let kind = EventKind::Rest { body };
                    log.push(Event {
                        time,
                        kind,
                        impulse: plan.mass * speed,
                    });
                }
            }
        }
    }
}

/// The first body with a number whose square is infinite.
///
/// Rapier takes lengths of vectors everywhere. Where one overflows, its speed cap scales the
/// velocity by cap/infinity: the body stands still, without a word.
fn out_of_range<W: World>(states: &[BodyState]) -> Option<usize> {
    let fits = |state: &BodyState| {
        W::RANGE.holds(length(&state.position)) && W::RANGE.holds(length(&state.velocity))
    };
    states.iter().position(|state| !fits(state))
}

impl<W: World> Simulation for RapierSimulation<W> {
    fn advance_to(&mut self, sample: usize, mut log: Option<&mut EventLog>) -> Option<Outcome> {
        if log.is_none() {
            self.watch.look_away();
        }
        while self.ended.is_none() && self.sample < sample {
            self.sample += 1;
            let first = self.grid.time(self.sample, 1);
            self.ended = self
                .out_of_range
                .map(|body| Outcome::NonFinite { time: first, body });
            for step in 1..=self.grid.steps_per_sample {
                if self.ended.is_some() {
                    break;
                }
                let time = self.grid.time(self.sample, step);
                self.ended = self.step(time, log.as_deref_mut());
            }
        }
        self.ended
    }

    fn state_into(&self, into: &mut [BodyState]) {
        for (body, state) in into.iter_mut().enumerate() {
            *state = self.world.state(body);
        }
    }

    /// Builds the world anew, for that is the one way to drop everything that Rapier carries
    /// from step to step: warm-start impulses, recycled contacts, which contacts are new, the
    /// tree of the broad phase. So the next step is the first step of a scene that starts so;
    /// a ball that lies on another or at a wall touches it as if for the first time.
    fn set_state(&mut self, sample: usize, states: &[BodyState]) {
        self.sample = sample;
        self.world = W::build(&self.layout, states);
        self.out_of_range = out_of_range::<W>(states);
        self.ended = None;
        self.watch.look_away();
    }

    fn work(&self) -> Work {
        self.work
    }
}
