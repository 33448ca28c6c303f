//! Taking the next event: which one among simultaneous ones, and what it does.

use super::plan::Deed;
use super::simulation::FlightSimulation;
use super::world::Impact;
use crate::engine::exact::instant::is_endless;
use crate::engine::exact::order::INTERNAL;
use crate::physics::real::Real;
use crate::recording::{CollapseReason, Event, EventKind, EventLog, Outcome};

/// Changes of cell, a body, without any event between them that are worth their while.
const CROSSINGS_A_BODY: u64 = 20;

/// Operations to take an event and plan what comes next, the pairs aside.
const OPERATIONS_A_TURN: f64 = 200.0;

/// Operations to foresee the impact of a pair by a closed form.
const OPERATIONS_A_PAIR: f64 = 30.0;

/// The same by a search of some ten steps.
const OPERATIONS_A_SEARCH: f64 = 1000.0;

impl<R: Real> FlightSimulation<R> {
    /// All events up to a time. Gives the outcome if they never end, or are too many.
    pub(super) fn run_to(&mut self, time: R, log: &mut Option<&mut EventLog>) -> Option<Outcome> {
        loop {
            let (due, first) = self.queue.first();
            if due > time {
                self.end_series(log);
                return None;
            }
            if self.effort.is_spent() {
                return Some(Outcome::BudgetSpent {
                    time: self.world.now.to_f64(),
                });
            }
            let limit = due + self.world.tie;
            let body = if self.queue.is_crowded(limit) {
                let Some(chosen) = self.choose(due, limit) else {
                    continue;
                };
                chosen
            } else {
                first
            };
            let before = self.world.pair_tests;
            if let Some(outcome) = self.take(body, due, log) {
                return Some(outcome);
            }
            self.count(self.world.pair_tests - before);
        }
    }

    /// Counts a turn in which so many pairs were looked at.
    #[inline]
    #[allow(clippy::cast_precision_loss, reason = "an estimate")]
    fn count(&mut self, looked_at: u64) {
        let a_pair = if self.world.model.law.is_searched() {
            OPERATIONS_A_SEARCH
        } else {
            OPERATIONS_A_PAIR
        };
        let operations = OPERATIONS_A_TURN + a_pair * looked_at as f64;
        self.effort.add::<R>(operations);
    }

    /// The body whose event goes first of all that are due together; none if a plan among them
    /// was void, which has then been made anew.
    ///
    /// The model's rule goes through contacts, cushions and rests in rounds: an event that was
    /// already passed in this round waits for the next one.
    fn choose(&mut self, due: R, limit: R) -> Option<usize> {
        let mut crowd = std::mem::take(&mut self.crowd);
        self.queue.up_to(limit, &mut crowd);
        let void = crowd.iter().copied().find(|body| self.is_void(*body));
        if let Some(body) = void {
            self.plan(body);
            self.crowd = crowd;
            return None;
        }
        // Two bodies that plan the same impact with each other are no crowd.
        if let [a, b] = crowd[..]
            && self.agendas[a].planned.rank == self.agendas[b].planned.rank
            && self.agendas[a].planned.rank != INTERNAL
        {
            self.crowd = crowd;
            return Some(a);
        }
        let passed = self
            .cursor
            .filter(|_| due <= self.instant + self.world.tie)
            .map_or(0, |rank| rank + 1);
        let turn = |body: &usize| {
            let planned = &self.agendas[*body].planned;
            let rank = if planned.time <= limit {
                planned.rank
            } else {
                INTERNAL
            };
            (rank < passed, rank, *body)
        };
        let chosen = crowd
            .iter()
            .copied()
            .filter(|body| self.agendas[*body].due() <= limit)
            .min_by_key(turn);
        self.crowd = crowd;
        chosen
    }

    /// Whether a body's plan was made for a partner that has flown on otherwise.
    fn is_void(&self, body: usize) -> bool {
        let planned = &self.agendas[body].planned;
        match planned.deed {
            Deed::Event(EventKind::Contact { a, b }) => {
                let partner = if a == body { b } else { a };
                self.world.balls[partner].count != planned.partner_count
            }
            Deed::Event(EventKind::Cushion { .. } | EventKind::Rest { .. })
            | Deed::PlanAgain
            | Deed::Nothing => false,
        }
    }

    /// Takes what a body has next: its event, a new plan, or a change of cell.
    fn take(&mut self, body: usize, due: R, log: &mut Option<&mut EventLog>) -> Option<Outcome> {
        let agenda = self.agendas[body];
        self.world.now = self.world.now.larger(due);
        if agenda.crossing + self.world.tie < agenda.planned.time {
            self.cross(body);
            return None;
        }
        self.world.now = self.world.now.larger(agenda.planned.time);
        self.crossings = 0;
        if self.is_void(body) {
            self.plan(body);
            return None;
        }
        let approach = match agenda.planned.deed {
            Deed::Event(kind) => {
                if self.world.now > self.instant + self.world.tie {
                    self.end_series(log);
                }
                self.advance_round(agenda.planned.rank);
                let foreseen = self.foresee(kind);
                let impact = self.happen(kind);
                if let Some(impact) = impact {
                    self.watch(kind, foreseen);
                    self.note(kind, impact, log);
                }
                impact.map_or(R::zero(), |impact| impact.approach)
            }
            Deed::PlanAgain | Deed::Nothing => {
                self.plan(body);
                R::zero()
            }
        };
        let runs_away = self
            .runaway
            .notes(self.world.now.to_f64(), approach.to_f64());
        runs_away.then(|| self.collapse(body, agenda.planned.deed))
    }

    /// What the bodies of an event are about to do beside it, where that is watched.
    fn foresee(&self, kind: EventKind) -> Option<Vec<(EventKind, R)>> {
        let watch = self.watch.as_ref()?;
        let mut foreseen = watch.foresee(&self.world, kind);
        foreseen.retain(|(other, _)| *other != kind);
        foreseen.push((kind, R::zero()));
        Some(foreseen)
    }

    /// Notes what nearly fell on the instant of an event, and what it has set off at once.
    fn watch(&mut self, kind: EventKind, foreseen: Option<Vec<(EventKind, R)>>) {
        let (Some(watch), Some(foreseen)) = (&mut self.watch, foreseen) else {
            return;
        };
        watch.noted.note(self.world.now, &foreseen);
        let set_off = watch.foresee(&self.world, kind);
        watch.noted.note(self.world.now, &set_off);
    }

    fn note(&mut self, kind: EventKind, impact: Impact<R>, log: &mut Option<&mut EventLog>) {
        let Impact { impulse, approach } = impact;
        self.events += 1;
        if let Some(log) = log {
            // A stop is no impact, whatever comes of it.
            self.series
                .extend(Some(approach.to_f64()).filter(|it| it.is_finite()));
            log.push(Event {
                time: self.world.now.to_f64(),
                kind,
                impulse: impulse.to_f64(),
            });
        }
    }

    /// Sums the impacts of an instant that is over where their series had no end.
    fn end_series(&mut self, log: &mut Option<&mut EventLog>) {
        if let Some(log) = log {
            if is_endless(self.series.iter().copied()) {
                log.sum_from(self.series_from);
            }
            self.series_from = log.events().len();
        }
        self.series.clear();
    }

    fn collapse(&self, body: usize, deed: Deed) -> Outcome {
        let (a, b) = match deed {
            Deed::Event(kind) => kind.bodies(),
            Deed::PlanAgain | Deed::Nothing => (body, None),
        };
        Outcome::Collapsed {
            time: self.world.now.to_f64(),
            a,
            b,
            reason: CollapseReason::EndlessImpacts,
        }
    }

    /// Moves the round of simultaneous events on, or starts one.
    fn advance_round(&mut self, rank: u64) {
        if self.world.now > self.instant + self.world.tie {
            self.instant = self.world.now;
        }
        self.cursor = Some(rank);
    }

    /// Lets an event happen; none if it comes to nothing.
    fn happen(&mut self, kind: EventKind) -> Option<Impact<R>> {
        match kind {
            EventKind::Contact { a, b } => {
                let impact = self.world.collide(a, b);
                self.replan(a);
                self.replan(b);
                impact
            }
            EventKind::Cushion { body, wall } => {
                let impact = self.world.bounce(body, wall);
                self.replan(body);
                impact
            }
            EventKind::Rest { body } => {
                let mut slowed = std::mem::take(&mut self.slowed);
                let impulse = self.world.stop(body, &mut slowed);
                self.replan(body);
                for other in &slowed {
                    self.replan(*other);
                }
                self.slowed = slowed;
                // A stop never follows a stop: no runaway comes of it, whatever its speed.
                let approach = R::from_f64(f64::INFINITY);
                Some(Impact { impulse, approach })
            }
        }
    }

    /// Puts a body into its next cell.
    ///
    /// Bodies that fly on through empty space, at any speed, would change cells for ever: if
    /// nothing else happens for long, all pairs are planned at once and the cells given up.
    fn cross(&mut self, body: usize) {
        self.crossings += 1;
        if self.crossings > CROSSINGS_A_BODY * self.world.balls.len() as u64 {
            self.world.grid = None;
            self.plan_all();
            return;
        }
        let face = self.agendas[body].face;
        if let Some(grid) = &mut self.world.grid {
            grid.cross(body, face);
        }
        self.plan_crossing(body);
        if self.is_void(body) {
            self.plan(body);
            return;
        }
        let kept = self.agendas[body].planned;
        self.agendas[body].planned = self.world.plan_entering(body, &kept, face);
        self.enqueue(body);
    }
}
