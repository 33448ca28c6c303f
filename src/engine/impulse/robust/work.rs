//! The work that a run may take, and what gives way when it takes more.

use crate::engine::impulse::handling::{Taken, pairs};
use crate::physics::Meter;

/// Elementary operations, about one a nanosecond, that count as a look at a pair does.
const OPERATIONS_A_UNIT: u64 = 10;

/// Motions of all bodies that each step may try; what it tries more is carried over to the next.
const MOTIONS_A_STEP: u64 = 10_000;
/// Motions that a run may try in all, where its steps are few.
const MOTIONS_A_RUN: u64 = 1_000_000;
/// Motions that a substep takes under forces that depend on places, about.
const MOTIONS_A_SUBSTEP: f64 = 12.0;
/// What a substep costs that is longer than the forces ask for: they are inaccurate anyway, and
/// many of them say little more than a few.
const LONG_STEP: u64 = 1_000;
/// Shortest substep as a share of the step, before the work gets too much.
const SHORTEST: f64 = 1e-9;
/// Operations of a look along the way of a body.
const OPERATIONS_A_LOOK: u64 = 20;
/// Impacts of each body that a step may take without carrying any over.
const IMPACTS_A_STEP: u64 = 25;
/// Looks along the ways of each body that an impact may take; more count as another.
const LOOKS: u64 = 64;
/// Impacts carried over, and a share more for few bodies, past which nothing bounces any more; the
/// share falls with the square of the pairs, as an impact gets dearer. The largest is for the
/// digits of pi: 314159 impacts of two bodies and a wall.
const IMPACTS: u64 = 2_000;
const IMPACTS_SHARED: u64 = 400_000;
/// Operations of a solution of touches that count as another impact: so many, and more for each
/// cube of the bodies. A jam of some dozen balls in no room takes a hundred times as many.
const SOLVED: u64 = 100_000;
const SOLVED_SHARED: u64 = 2;
/// Motions that an impact takes, about, where forces depend on places: its time is found in rounds
/// of rounds.
const MOTIONS_AN_IMPACT: u64 = 50;
/// Events at one instant after which the next substep is taken blindly: they change nothing.
const STANDING_MAX: u64 = 100;
/// So many events are timed together …
const PACED: u64 = 1_000;
/// … and where the rest of a step would take more than so many at their pace, they are endless.
const ENDLESS: f64 = 1e10;

/// Work counted in a run.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Work {
    bodies: u64,
    /// Impacts past which nothing bounces any more.
    most: u64,
    /// Motions that a step is allowed.
    motions_a_step: u64,
    /// All operations, those that are counted as steps, looks and forces included.
    pub(super) meter: Meter,
    /// Forces that are evaluated when all are.
    forces_a_pass: u64,
    /// Operations when the present step began.
    begun: u64,
    /// What the present step took.
    taken: Taken,
    /// Events and reflections at impacts, less those that steps were allowed.
    impacts: u64,
    /// Motions tried, less those that earlier steps were allowed.
    motions: u64,
    /// Events since time last went on.
    standing: u64,
    /// Events of the step since the pace was taken, and how long they took, s.
    paced: (u64, f64),
}

impl Work {
    /// For so many bodies over so many steps, with so many forces in all; whether any depend on
    /// places.
    pub(super) fn of(bodies: usize, steps: f64, forces_a_pass: u64, forced: bool) -> Self {
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "rounded down, and saturated, as it may be"
        )]
        let steps = steps.max(1.0) as u64;
        let bodies = (bodies as u64).max(1);
        let pairs = pairs(bodies).max(1);
        let shared = IMPACTS_SHARED / pairs.saturating_mul(pairs);
        Self {
            bodies,
            most: IMPACTS + shared / if forced { MOTIONS_AN_IMPACT } else { 1 },
            motions_a_step: MOTIONS_A_STEP.max(MOTIONS_A_RUN / steps),
            forces_a_pass,
            ..Self::default()
        }
    }

    /// Bounds the work: past so many units of it nothing is solved any more.
    pub(super) fn limit(&mut self, budget: u64) {
        self.meter.limit(budget.saturating_mul(OPERATIONS_A_UNIT));
    }

    /// Whether more is done than may be.
    #[inline]
    pub(super) fn is_spent(&self) -> bool {
        self.meter.is_spent()
    }

    /// Counts so many operations for each body.
    #[inline]
    pub(super) fn count_bodies(&mut self, operations: u64) {
        self.meter.add(operations * self.bodies);
    }

    /// Counts so many operations for each pair of all bodies.
    #[inline]
    pub(super) fn count_pairs(&mut self, operations: u64) {
        self.meter.add(operations * pairs(self.bodies));
    }

    /// So many pairs were looked at for an impact.
    pub(super) fn charge_pairs(&mut self, looked_at: u64) {
        self.taken.pairs += looked_at;
        self.meter.add(looked_at * OPERATIONS_A_UNIT);
    }

    /// The forces were summed.
    pub(super) fn charge_pass(&mut self) {
        self.taken.passes += 1;
        self.meter.add(self.forces_a_pass * OPERATIONS_A_UNIT);
    }

    /// A step begins; it counts itself.
    #[inline]
    pub(super) fn begin(&mut self) {
        self.taken = Taken::default();
        self.begun = self.meter.done();
        self.meter.add(OPERATIONS_A_UNIT);
    }

    /// What the step took.
    #[inline]
    pub(super) fn taken(&self) -> Taken {
        let operations = self.meter.done() - self.begun;
        let elsewhere = 1 + self.taken.pairs + self.taken.passes * self.forces_a_pass;
        // Rounded up, so that what goes past the bound is past it in these units too.
        let units = operations.div_ceil(OPERATIONS_A_UNIT);
        Taken {
            solving: units.saturating_sub(elsewhere),
            ..self.taken
        }
    }

    pub(super) fn begin_step(&mut self) {
        self.motions = self.motions.saturating_sub(self.motions_a_step);
        let impacts = IMPACTS_A_STEP * self.bodies;
        self.impacts = self.impacts.saturating_sub(impacts);
        self.paced = (0, 0.0);
    }

    /// Whether substeps of that length are more than all steps can pay.
    pub(super) fn cannot_pay(&self, substep: f64, step: f64) -> bool {
        #[allow(clippy::cast_precision_loss, reason = "some millions")]
        let affordable = self.motions_a_step as f64 / MOTIONS_A_SUBSTEP;
        step > affordable * substep
    }

    /// A motion of all bodies was tried.
    pub(super) fn charge_motion(&mut self) {
        self.motions += 1;
    }

    /// A substep is longer than the forces ask for.
    pub(super) fn charge_long_step(&mut self) {
        self.motions += LONG_STEP;
    }

    /// A substep that led nowhere costs a whole allowance: where one does, more will.
    pub(super) fn charge_failure(&mut self) {
        self.motions += MOTIONS_A_STEP;
    }

    /// An event was met after that time, with so much left of the step.
    pub(super) fn charge_event(&mut self, went: f64, left: f64) {
        self.standing = if went > 0.0 { 0 } else { self.standing + 1 };
        self.paced.0 += 1;
        self.paced.1 += went;
        if self.paced.0 == PACED {
            #[allow(clippy::cast_precision_loss, reason = "a thousand")]
            let needed = left / self.paced.1 * PACED as f64;
            if needed > ENDLESS {
                self.impacts = self.impacts.max(self.most + 1);
            }
            self.paced = (0, 0.0);
        }
    }

    /// What was met took so many rounds of reflections, since so many operations were done.
    pub(super) fn charge_rounds(&mut self, rounds: u64, before: u64) {
        self.impacts += rounds.max(1).max(self.solutions(before));
    }

    /// Touches were solved together since so many operations were done.
    pub(super) fn charge_solution(&mut self, before: u64) {
        self.impacts += self.solutions(before);
    }

    /// Impacts that the operations since then count as.
    fn solutions(&self, before: u64) -> u64 {
        let cube = self.bodies.saturating_pow(3);
        let dear = SOLVED.saturating_add(SOLVED_SHARED.saturating_mul(cube));
        (self.meter.done() - before) / dear
    }

    /// A search looked along the ways so often.
    pub(super) fn charge_looks(&mut self, looks: u64) {
        self.impacts += looks / (LOOKS * self.bodies);
        self.meter.add(looks * OPERATIONS_A_LOOK);
    }

    /// The shortest substep of a step: it doubles with every allowance that is overdrawn.
    pub(super) fn shortest(&self, dt: f64) -> f64 {
        let overdrawn = self.motions / MOTIONS_A_STEP;
        let doublings = i32::try_from(overdrawn).unwrap_or(i32::MAX).min(1000);
        dt * SHORTEST * 2.0_f64.powi(doublings)
    }

    /// Whether so many impacts happened that restitution is given up.
    pub(super) fn bounces_no_more(&self) -> bool {
        self.impacts > self.most
    }

    /// Whether impacts went on without restitution for as long again: nothing is looked for until
    /// the next step.
    pub(super) fn meets_no_more(&self) -> bool {
        self.impacts > 2 * self.most
    }

    /// Whether events follow each other without time going on; asked once, it starts anew.
    pub(super) fn stands_still(&mut self) -> bool {
        if self.standing <= STANDING_MAX {
            return false;
        }
        self.standing = 0;
        self.impacts += STANDING_MAX;
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1e-9 doubled thirty times is a whole step.
    #[test]
    fn an_overdrawn_allowance_makes_steps_longer_and_is_paid_back() {
        let mut work = Work::of(2, 1e9, 0, false);
        assert_eq!(work.shortest(2.0), 2e-9);
        for _ in 0..30 {
            work.charge_failure();
        }
        assert!(work.shortest(2.0) > 2.0);
        work.begin_step();
        assert!(work.shortest(2.0) > 1.0);
        for _ in 0..29 {
            work.begin_step();
        }
        assert_eq!(work.shortest(2.0), 2e-9);
    }

    /// Looks cost what impacts do: 64 along each way as much as one. So many that each search
    /// takes a thousand rounds end bounces long before their number does.
    #[test]
    fn many_looks_count_as_impacts() {
        let mut work = Work::of(2, 1.0, 0, false);
        work.charge_looks(2 * LOOKS - 1);
        assert_eq!(work.impacts, 0);
        for _ in 0..work.most / 1000 {
            work.charge_looks(1000 * 2 * LOOKS);
        }
        assert!(!work.bounces_no_more());
        work.charge_looks(1000 * 2 * LOOKS);
        assert!(work.bounces_no_more());
    }

    /// Events without time going on end after a hundred, those with it go on.
    #[test]
    fn events_that_stand_still_are_found_once() {
        let mut work = Work::of(2, 100.0, 0, false);
        for _ in 0..1000 {
            work.charge_event(1e-3, 1.0);
            assert!(!work.stands_still());
        }
        let stood = (0..=STANDING_MAX).filter(|_| {
            work.charge_event(0.0, 1.0);
            work.stands_still()
        });
        assert_eq!(stood.count(), 1);
        assert!(!work.stands_still());
    }

    /// A thousand events that take 2e-8 s leave 1 s to 5e10 more: endless. Ten times as long is
    /// slow, but ends.
    #[test]
    fn a_pace_that_never_arrives_ends_all_bounces() {
        for (went, endless) in [(2e-11, true), (2e-10, false)] {
            let mut work = Work::of(2, 1.0, 0, false);
            for _ in 1..PACED {
                work.charge_event(went, 1.0);
            }
            assert!(!work.bounces_no_more());
            work.charge_event(went, 1.0);
            assert_eq!(work.bounces_no_more(), endless, "{went}");
        }
        // The pace is that of the last thousand, not of all.
        let mut work = Work::of(2, 1.0, 0, false);
        for _ in 0..PACED {
            work.charge_event(1e-3, 1.0);
        }
        for _ in 0..PACED {
            work.charge_event(2e-11, 1.0);
        }
        assert!(work.bounces_no_more());
    }

    /// More pairs, and forces on the way, leave fewer impacts; few steps may try more motions.
    #[test]
    fn allowances_follow_pairs_forces_and_steps() {
        let most = |bodies, forced| Work::of(bodies, 1.0, 0, forced).most;
        assert_eq!(most(2, false), 402_000);
        assert_eq!(most(4, false), 2_000 + 11_111);
        assert_eq!(most(4, true), 2_000 + 222);
        let motions = |steps| Work::of(2, steps, 0, false).motions_a_step;
        assert_eq!([1.0, 10.0, 1e6].map(motions), [1_000_000, 100_000, 10_000]);
    }

    /// A million motions pay 83,333 substeps at 12 motions each; motions add up to a doubling of
    /// the shortest.
    #[test]
    fn substeps_are_paid_in_motions() {
        let work = Work::of(2, 1.0, 0, false);
        assert!(!work.cannot_pay(1.0, 83_333.0));
        assert!(work.cannot_pay(1.0, 83_334.0));
        let mut work = Work::of(2, 1e9, 0, false);
        for _ in 0..MOTIONS_A_STEP / 2 {
            work.charge_motion();
        }
        assert_eq!(work.shortest(1.0), 1e-9);
        for _ in 0..5 {
            work.charge_long_step();
        }
        assert_eq!(work.shortest(1.0), 2e-9);
    }

    /// A solution counts as one impact more for every 100,000 operations and twice the cube of the
    /// bodies: a cheap one as none, a dear one as many.
    #[test]
    fn dear_solutions_count_as_impacts() {
        let mut work = Work::of(10, 1.0, 0, false);
        for (operations, impacts) in [(101_999, 0), (102_000, 1), (10_200_000, 101)] {
            let before = work.meter.done();
            work.meter.add(operations);
            work.charge_solution(before);
            assert_eq!(work.impacts, impacts, "{operations}");
        }
    }

    /// Each round counts, one without any too; as many again end all meetings.
    #[test]
    fn rounds_of_impacts_count() {
        let mut work = Work::of(4, 1.0, 0, true);
        work.charge_rounds(0, 0);
        work.charge_rounds(work.most - 1, 0);
        assert!(!work.bounces_no_more());
        work.charge_rounds(1, 0);
        assert!(work.bounces_no_more() && !work.meets_no_more());
        work.charge_rounds(work.most, 0);
        assert!(work.meets_no_more());
        for _ in 0..2 * work.most {
            work.begin_step();
        }
        assert!(!work.bounces_no_more());
        assert_eq!(work.impacts, 0);
    }
}
