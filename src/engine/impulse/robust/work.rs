//! The work that a run may take, and what gives way when it takes more.

use crate::engine::impulse::handling::Taken;

/// Motions of all bodies that each step may try; what it tries more is carried over to the next.
const MOTIONS_A_STEP: u64 = 10_000;
/// Shortest substep as a share of the step, before the work gets too much.
const SHORTEST: f64 = 1e-9;
/// Impacts that each step may take without carrying any over.
const IMPACTS_A_STEP: u64 = 2_000;
/// Impacts carried over, and a share more for few bodies, past which nothing
/// bounces any more; the share falls with the square of the bodies, as an impact gets dearer.
const IMPACTS: u64 = 10_000;
const IMPACTS_SHARED: u64 = 1_600_000;

/// Work counted in a run.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Work {
    /// What the present step took.
    pub(super) taken: Taken,
    /// Reflections at impacts, less those that steps were allowed.
    pub(super) impacts: u64,
    /// Motions tried, less those that earlier steps were allowed.
    motions: u64,
}

impl Work {
    pub(super) fn begin_step(&mut self) {
        self.motions = self.motions.saturating_sub(MOTIONS_A_STEP);
        self.impacts = self.impacts.saturating_sub(IMPACTS_A_STEP);
        self.taken = Taken::default();
    }

    /// A motion of all bodies was tried.
    pub(super) fn charge_motion(&mut self) {
        self.motions += 1;
    }

    /// A substep that led nowhere costs a whole allowance: where one does, more will.
    pub(super) fn charge_failure(&mut self) {
        self.motions += MOTIONS_A_STEP;
    }

    /// The shortest substep of a step: it doubles with every allowance that is overdrawn.
    pub(super) fn shortest(&self, dt: f64) -> f64 {
        let overdrawn = self.motions / MOTIONS_A_STEP;
        let doublings = i32::try_from(overdrawn).unwrap_or(i32::MAX).min(1000);
        dt * SHORTEST * 2.0_f64.powi(doublings)
    }

    /// Whether so many impacts happened that restitution is given up.
    pub(super) fn bounces_no_more(&self, bodies: usize) -> bool {
        self.impacts > most(bodies)
    }

    /// Whether impacts went on without restitution for as long again: nothing is looked for until
    /// the next step.
    pub(super) fn meets_no_more(&self, bodies: usize) -> bool {
        self.impacts > 2 * most(bodies)
    }
}

fn most(bodies: usize) -> u64 {
    let bodies = (bodies as u64).max(1);
    IMPACTS + IMPACTS_SHARED / (bodies * bodies)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// 1e-9 doubled thirty times is a whole step.
    #[test]
    fn an_overdrawn_allowance_makes_steps_longer_and_is_paid_back() {
        let mut work = Work::default();
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
}
