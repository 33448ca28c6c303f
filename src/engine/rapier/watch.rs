//! Events from impulses: which pairs began to push in this step.

use super::layout::Layout;
use super::world::World;
use crate::physics::length;
use crate::recording::{Event, EventKind, EventLog, Wall};

/// Rounding errors, in units of the last place, that a velocity may carry through a step.
///
/// Rapier adds and removes the impulse of the step before (warm start), four substeps of
/// solving and relaxing, and a restitution pass: some twenty roundings.
const ROUNDINGS: f64 = 64.0;

/// Turns the impulses of each step into events; works only while somebody keeps a log.
///
/// An impulse in a step after one without is a new event, at the end of the step; impulse in
/// consecutive steps belongs to the same event.
#[derive(Debug)]
pub(super) struct Watch {
    masses: Vec<f64>,
    walls: Vec<Wall>,
    /// Largest speed of each body seen so far.
    speeds: Vec<f64>,
    /// Pairs that pushed in the previous step, in order, and in this one.
    before: Vec<EventKind>,
    now: Vec<(EventKind, f64)>,
}

impl Watch {
    pub fn new(layout: &Layout) -> Self {
        Self {
            masses: layout.bodies.iter().map(|body| body.mass).collect(),
            walls: layout.walls.iter().map(|plan| plan.wall).collect(),
            speeds: vec![0.0; layout.bodies.len()],
            before: Vec::new(),
            now: Vec::new(),
        }
    }

    /// Forgets which pairs pushed: a step went by unobserved, or the world is a new one.
    pub fn look_away(&mut self) {
        self.before.clear();
    }

    /// Notes the events of the last step, which ended at `time`, in the model's order:
    /// contacts by their bodies, then cushions by body and wall.
    pub fn observe<W: World>(&mut self, world: &W, time: f64, log: &mut EventLog) {
        for (body, speed) in self.speeds.iter_mut().enumerate() {
            *speed = speed.max(length(&world.velocity(body)));
        }
        let Self {
            masses,
            walls,
            speeds,
            before,
            now,
        } = self;
        now.clear();
        world.each_impulse(|a, b, impulse| {
            let (a, b) = (a.min(b), a.max(b));
            let (kind, floor) = if b < masses.len() {
                let reduced = 1.0 / (1.0 / masses[a] + 1.0 / masses[b]);
                (
                    EventKind::Contact { a, b },
                    reduced * (speeds[a] + speeds[b]),
                )
            } else {
                let wall = walls[b - masses.len()];
                (EventKind::Cushion { body: a, wall }, masses[a] * speeds[a])
            };
            let pushed = before.binary_search(&kind).is_ok();
            // What rounding alone can make of an approach speed is no new impact.
            if impulse > 0.0 && (pushed || impulse > ROUNDINGS * W::RANGE.epsilon * floor) {
                now.push((kind, impulse));
            }
        });
        now.sort_unstable_by_key(|(kind, _)| *kind);
        for &(kind, impulse) in &*now {
            if before.binary_search(&kind).is_ok() {
                log.prolong(kind, impulse);
            } else {
                log.push(Event {
                    time,
                    kind,
                    impulse,
                });
            }
        }
        before.clear();
        before.extend(now.iter().map(|(kind, _)| *kind));
    }
}
