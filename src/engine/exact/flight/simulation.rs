//! From event to event, from sample to sample.

use super::grid::Face;
use super::law::State;
use super::model::{Model, accept, start};
use super::plan::Planned;
use super::queue::Queue;
use super::runaway::Runaway;
use super::watch::Watch;
use super::world::World;
use crate::engine::Simulation;
use crate::engine::exact::effort::Effort;
use crate::engine::exact::order::TieOrder;
use crate::error::Result;
use crate::physics::BodyState;
use crate::physics::real::{Real, vector};
use crate::recording::{EventLog, Outcome, Work};
use crate::scene::Scene;

/// What a body does next, in the model and in the table of cells.
#[derive(Debug, Clone, Copy)]
pub(super) struct Agenda<R> {
    /// Its next event.
    pub planned: Planned<R>,
    /// When it leaves its cell, s.
    pub crossing: R,
    /// Through which face it does.
    pub face: Face,
}

impl<R: Real> Agenda<R> {
    /// When the next of the two is due, s.
    #[inline]
    pub fn due(&self) -> R {
        if self.crossing < self.planned.time {
            self.crossing
        } else {
            self.planned.time
        }
    }
}

/// The event-driven engine for scenes without attraction and springs, in closed form.
///
/// Between events nothing is computed; an event touches one or two bodies. States are exact but
/// for the rounding of the scalar.
/// Valid for: contact, cushions, drag, uniform gravity, and rest without gravity.
/// Source: Alder and Wainwright 1959; Smallenburg 2022 (arXiv 2201.01100).
#[derive(Debug, Clone)]
pub struct FlightSimulation<R: Real> {
    pub(super) world: World<R>,
    pub(super) agendas: Vec<Agenda<R>>,
    pub(super) queue: Queue<R>,
    sample: usize,
    pub(super) events: u64,
    pub(super) instant: R,
    pub(super) cursor: Option<u64>,
    /// Speeds of approach of the impacts of this instant, and the first of them in the log.
    pub(super) series: Vec<f64>,
    pub(super) series_from: usize,
    pub(super) runaway: Runaway,
    pub(super) crossings: u64,
    pub(super) watch: Option<Box<Watch<R>>>,
    pub(super) crowd: Vec<usize>,
    pub(super) slowed: Vec<usize>,
    pub(super) effort: Effort,
}

impl<R: Real> FlightSimulation<R> {
    /// Puts a scene at its start.
    ///
    /// # Errors
    /// [`Error::Scene`](crate::error::Error::Scene) for what is no scene,
    /// [`Error::EngineCannot`](crate::error::Error::EngineCannot) for what has no exact meaning.
    pub fn new(scene: &Scene, order: TieOrder) -> Result<Self> {
        accept(scene)?;
        Ok(Self::with(Model::of(scene), order, &start(scene)))
    }

    /// The same with every event searched for, closed form or not: the second path of the tests.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub fn searching(scene: &Scene, order: TieOrder) -> Result<Self> {
        accept(scene)?;
        let mut model = Model::of(scene);
        model.law = model.law.without_shortcut();
        Ok(Self::with(model, order, &start(scene)))
    }

    /// The same with every input moved by a relative `size`, up or down by lot from a seed.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    pub(super) fn perturbed(scene: &Scene, size: f64, seed: u64) -> Result<Self> {
        accept(scene)?;
        let mut model = Model::<R>::of(scene);
        let mut states = start(scene);
        super::perturb::perturb(&mut model, &mut states, scene, (size, seed));
        Ok(Self::with(model, TieOrder::Rule, &states))
    }

    fn with(model: Model<R>, order: TieOrder, states: &[State<R>]) -> Self {
        let mut simulation = Self {
            agendas: Vec::new(),
            queue: Queue::new(states.len()),
            sample: 0,
            events: 0,
            instant: R::from_f64(f64::NEG_INFINITY),
            cursor: None,
            series: Vec::new(),
            series_from: 0,
            runaway: Runaway::new(model.duration.to_f64(), states.len()),
            crossings: 0,
            watch: None,
            crowd: Vec::new(),
            slowed: Vec::new(),
            effort: Effort::limited(u64::MAX),
            world: World::new(model, order, states, R::zero()),
        };
        simulation.plan_all();
        simulation
    }

    /// The same with a bound on the work: past so many elementary operations it ends.
    #[must_use]
    pub fn limited(mut self, operations: u64) -> Self {
        self.effort = Effort::limited(operations);
        self
    }

    /// The same with an eye on impacts that nearly fall on one instant.
    pub(super) fn watched(mut self) -> Self {
        self.watch = Some(Box::new(Watch::new(&self.world)));
        self
    }

    /// From here on events within that time count as simultaneous and are taken in that order.
    pub(super) fn take_together(&mut self, within: R, order: TieOrder) {
        let tie = self.world.model.tie.larger(within);
        self.world.tie = tie;
        self.world.model.near = self.world.model.near.larger(tie);
        self.world.order = order;
        self.instant = R::from_f64(f64::NEG_INFINITY);
        self.cursor = None;
        self.plan_all();
    }

    /// How many events of the model there have been.
    #[must_use]
    pub fn event_count(&self) -> u64 {
        self.events
    }

    /// Present time of the last sample reached, s: the double that is printed.
    #[allow(clippy::cast_precision_loss, reason = "4e7 samples at most")]
    fn sample_time(&self) -> R {
        R::from_f64(self.sample as f64 * self.world.model.sample_every)
    }

    /// States at the last sample reached, in the engine's own scalar.
    pub(super) fn states(&self) -> impl Iterator<Item = State<R>> {
        self.states_at(self.sample_time())
    }

    /// States at a time, on the flights of now.
    pub(super) fn states_at(&self, time: R) -> impl Iterator<Item = State<R>> {
        (0..self.agendas.len()).map(move |body| self.world.state_at(body, time))
    }

    /// The time of the last event, and the states then.
    pub(in crate::engine::exact) fn here(&self) -> (f64, Vec<BodyState>) {
        let now = self.world.now;
        let states = (0..self.agendas.len()).map(|body| rounded(&self.world.state_at(body, now)));
        (now.to_f64(), states.collect())
    }

    pub(super) fn plan_all(&mut self) {
        let nothing = Agenda {
            planned: Planned::nothing(),
            crossing: R::from_f64(f64::INFINITY),
            face: Face {
                axis: 0,
                upper: true,
            },
        };
        let bodies = self.world.balls.len();
        self.agendas = vec![nothing; bodies];
        for body in 0..bodies {
            self.plan_crossing(body);
            self.plan(body);
        }
    }

    pub(super) fn plan(&mut self, body: usize) {
        self.agendas[body].planned = self.world.plan(body);
        self.enqueue(body);
    }

    pub(super) fn plan_crossing(&mut self, body: usize) {
        if self.world.grid.is_some() {
            let (crossing, face) = self.world.plan_crossing(body);
            self.agendas[body].crossing = crossing;
            self.agendas[body].face = face;
        }
    }

    /// Plans a body that has just been put on a new flight.
    pub(super) fn replan(&mut self, body: usize) {
        self.plan_crossing(body);
        self.plan(body);
    }

    #[inline]
    pub(super) fn enqueue(&mut self, body: usize) {
        self.queue.set(body, self.agendas[body].due());
    }
}

impl<R: Real> Simulation for FlightSimulation<R> {
    /// An event at the instant of a sample comes before it.
    fn advance_to(&mut self, sample: usize, mut log: Option<&mut EventLog>) -> Option<Outcome> {
        if sample <= self.sample {
            return None;
        }
        self.sample = sample;
        let time = self.sample_time() + self.world.tie;
        self.run_to(time, &mut log)
    }

    fn state_into(&self, into: &mut [BodyState]) {
        for (state, mine) in into.iter_mut().zip(self.states()) {
            *state = rounded(&mine);
        }
    }

    fn set_state(&mut self, sample: usize, states: &[BodyState]) {
        self.sample = sample;
        let states: Vec<_> = states
            .iter()
            .map(|state| State {
                position: vector(state.position.into()),
                velocity: vector(state.velocity.into()),
            })
            .collect();
        let (now, looked) = (self.sample_time(), self.world.pair_tests);
        self.world = World::new(self.world.model.clone(), self.world.order, &states, now);
        self.world.pair_tests = looked;
        self.instant = R::from_f64(f64::NEG_INFINITY);
        self.cursor = None;
        self.plan_all();
    }

    /// Steps are events; between them there are none.
    fn work(&self) -> Work {
        Work {
            steps: self.events,
            pair_tests: self.world.pair_tests,
            force_evaluations: 0,
            solving: 0,
        }
    }
}

fn rounded<R: Real>(state: &State<R>) -> BodyState {
    BodyState {
        position: state.position.map(Real::to_f64),
        velocity: state.velocity.map(Real::to_f64),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::generate::Gas;
    use crate::scene::{Contact, Cushions};

    fn gas(drag: f64, falls: bool, spread: f64) -> Scene {
        let recipe = Gas {
            cells: 3,
            filling: 0.3,
            seed: 3,
        };
        let mut scene = recipe.scene().expect("a gas");
        (scene.duration, scene.sample_every) = (0.75, 0.25);
        for (place, body) in scene.bodies.iter_mut().enumerate() {
            // Larger and smaller spheres, heavier and lighter ones.
            body.radius *= 1.0 - spread * f64::from(u8::from(place % 3 == 0));
            body.mass *= 1.0 + spread * f64::from(u8::from(place % 2 == 0));
        }
        scene.effects.drag = (drag > 0.0).then_some(crate::scene::Drag { coefficient: drag });
        scene.effects.gravity = falls.then_some(crate::scene::Gravity {
            acceleration: [0.3, -2.0, 0.1],
        });
        scene
    }

    fn ends(scene: &Scene, cells: bool) -> (Vec<BodyState>, u64) {
        let mut run = FlightSimulation::<f64>::new(scene, TieOrder::Rule).expect("a run");
        assert!(run.world.grid.is_some());
        if !cells {
            run.world.grid = None;
            run.plan_all();
        }
        assert_eq!(run.advance_to(scene.sample_count(), None), None);
        let mut states = crate::recording::initial_states(scene);
        run.state_into(&mut states);
        (states, run.event_count())
    }

    /// Cells must not change anything: not one event, under every law of flight.
    #[test]
    fn cells_find_what_all_pairs_find() {
        for (drag, falls, spread) in [
            (0.0, false, 0.0),
            (0.3, false, 0.0),
            (0.0, true, 0.3),
            (0.3, true, 0.0),
            (0.3, false, 0.3),
        ] {
            let scene = gas(drag, falls, spread);
            let ((with, events), (without, expected)) = (ends(&scene, true), ends(&scene, false));
            assert_eq!(
                events, expected,
                "drag {drag}, falls {falls}, spread {spread}"
            );
            assert!(events > 100, "{events}");
            for (a, b) in with.iter().zip(&without) {
                // Some ten impacts a sphere amplify the rounding of other moments of planning.
                let off = (a.position - b.position).norm();
                assert!(off < 1e-6, "drag {drag}, falls {falls}: {off:e}");
            }
        }
    }

    /// Elastic impacts keep the kinetic energy, whoever meets whom: 1e5 of them.
    #[test]
    fn energy_and_room_are_kept_over_many_impacts() {
        let mut scene = gas(0.0, false, 0.2);
        (scene.duration, scene.sample_every) = (64.0, 16.0);
        let energy = |states: &[BodyState]| -> f64 {
            let each = scene.bodies.iter().zip(states);
            each.map(|(body, s)| crate::physics::kinetic_energy(body.mass, &s.velocity))
                .sum()
        };
        let mut run = FlightSimulation::<f64>::new(&scene, TieOrder::Rule).expect("a run");
        let mut states = crate::recording::initial_states(&scene);
        let before = energy(&states);
        assert_eq!(run.advance_to(4, None), None);
        run.state_into(&mut states);
        // 1e5 impacts of two roundings each, as a random walk.
        assert!((energy(&states) / before - 1.0).abs() < 1e-12);
        assert!(run.event_count() > 20_000, "{}", run.event_count());
        let spheres: Vec<_> = states
            .iter()
            .zip(&scene.bodies)
            .map(|(state, body)| (state.position, body.radius))
            .collect();
        let overlaps = crate::scene::overlap::overlaps(&spheres);
        assert!(
            overlaps.iter().all(|pair| pair.depth < 1e-12),
            "{overlaps:?}"
        );
    }

    #[test]
    fn a_state_that_is_set_goes_on_from_there() {
        let mut scene = gas(0.0, false, 0.0);
        scene.effects.contact = Some(Contact { restitution: 0.9 });
        let whole = ends(&scene, true).0;
        let mut run = FlightSimulation::<f64>::new(&scene, TieOrder::Rule).expect("a run");
        let mut states = crate::recording::initial_states(&scene);
        run.advance_to(2, None);
        run.state_into(&mut states);
        let mut other = FlightSimulation::<f64>::new(&scene, TieOrder::Rule).expect("a run");
        other.set_state(2, &states);
        other.advance_to(3, None);
        other.state_into(&mut states);
        for (a, b) in states.iter().zip(&whole) {
            assert!((a.position - b.position).norm() < 1e-9);
        }
    }

    #[test]
    fn bodies_far_too_fast_used_to_cross_cells_for_ever() {
        let mut scene = gas(0.0, false, 0.0);
        scene.effects.cushions = None::<Cushions>;
        for body in &mut scene.bodies {
            body.velocity = body.velocity.map(|v| v * 1e200);
        }
        let mut run = FlightSimulation::<f64>::new(&scene, TieOrder::Rule).expect("a run");
        run.advance_to(3, None);
    }
}
