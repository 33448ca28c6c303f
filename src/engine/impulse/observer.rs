//! Who watches the solver. Nobody, most of the time, and then watching costs nothing.

use crate::recording::{Account, Entry, Event, EventKind, EventLog, Ledger};

/// Something told of events while the solver steps.
pub(super) trait Observer {
    /// Whether it keeps books. Where it does not, nothing is computed for them.
    const BOOKS: bool = false;

    /// What a phase takes or gives.
    fn book(&mut self, _account: Account, _entry: Entry) {}

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

/// Books what each phase takes and gives, and notes events if they are wanted too.
pub(super) struct Bookkeeper<'a> {
    /// Where the entries go.
    pub ledger: &'a mut Ledger,
    /// Who notes the events.
    pub scribe: Option<Scribe<'a>>,
}

impl Observer for Bookkeeper<'_> {
    const BOOKS: bool = true;

    fn book(&mut self, account: Account, entry: Entry) {
        self.ledger.book(account, entry);
    }

    fn note_before_end(&mut self, kind: EventKind, impulse: f64, before: f64) {
        if let Some(scribe) = &mut self.scribe {
            scribe.note_before_end(kind, impulse, before);
        }
    }
}
