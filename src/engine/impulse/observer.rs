//! Who watches the solver. Nobody, most of the time, and then watching costs nothing.

use crate::recording::{Event, EventKind, EventLog};

/// Something told of events while the solver steps.
pub(super) trait Observer {
    /// An event at the end of the present step.
    fn note(&mut self, kind: EventKind, impulse: f64) {
        self.note_before_end(kind, impulse, 0.0);
    }

    /// An event so much time before the end of the present step.
    fn note_before_end(&mut self, kind: EventKind, impulse: f64, before: f64);
}

/// Nobody watches: every call compiles to nothing.
pub(super) struct Nobody;

impl Observer for Nobody {
    #[inline]
    fn note_before_end(&mut self, _kind: EventKind, _impulse: f64, _before: f64) {}
}

/// Notes events with the time at which the present step ends.
pub(super) struct Scribe<'a> {
    /// Where the events go.
    pub log: &'a mut EventLog,
    /// Time at the end of the present step, s.
    pub time: f64,
}

impl Observer for Scribe<'_> {
    fn note_before_end(&mut self, kind: EventKind, impulse: f64, before: f64) {
        self.log.push(Event {
            time: self.time - before,
            kind,
            impulse,
        });
    }
}
