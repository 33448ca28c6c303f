//! Impacts and stops.

use std::collections::HashMap;
use std::fmt;

use serde::Serialize;

use super::bounds::EVENTS_MAX;

/// A wall of the box of cushions, named after the side on which it stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[allow(missing_docs, reason = "the names say it all")]
pub enum Wall {
    MinusX,
    PlusX,
    MinusZ,
    PlusZ,
    MinusY,
    PlusY,
}

impl Wall {
    /// Every wall, in the model's order.
    pub const ALL: [Self; 6] = [
        Self::MinusX,
        Self::PlusX,
        Self::MinusZ,
        Self::PlusZ,
        Self::MinusY,
        Self::PlusY,
    ];

    /// The name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::MinusX => "-x",
            Self::PlusX => "+x",
            Self::MinusZ => "-z",
            Self::PlusZ => "+z",
            Self::MinusY => "-y",
            Self::PlusY => "+y",
        }
    }

    /// The wall of that name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|wall| wall.name() == name)
    }

    /// Index of the axis that the wall is normal to, and the sign of its side.
    #[must_use]
    pub fn axis_and_side(self) -> (usize, f64) {
        match self {
            Self::MinusX => (0, -1.0),
            Self::PlusX => (0, 1.0),
            Self::MinusZ => (2, -1.0),
            Self::PlusZ => (2, 1.0),
            Self::MinusY => (1, -1.0),
            Self::PlusY => (1, 1.0),
        }
    }
}

impl fmt::Display for Wall {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// What happened, and to which bodies.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum EventKind {
    /// Two spheres collided; `a < b`.
    Contact {
        /// Index of the first body.
        a: usize,
        /// Index of the second body.
        b: usize,
    },
    /// A sphere hit a wall.
    Cushion {
        /// Index of the body.
        body: usize,
        /// The wall.
        wall: Wall,
    },
    /// A sphere fell below the rest speed and stopped.
    Rest {
        /// Index of the body.
        body: usize,
    },
}

impl EventKind {
    /// Whether it is an impact, not a stop.
    #[must_use]
    pub fn is_impact(self) -> bool {
        match self {
            Self::Contact { .. } | Self::Cushion { .. } => true,
            Self::Rest { .. } => false,
        }
    }

    /// The bodies that take part: one or two.
    #[must_use]
    pub fn bodies(self) -> (usize, Option<usize>) {
        match self {
            Self::Contact { a, b } => (a, Some(b)),
            Self::Cushion { body, .. } | Self::Rest { body } => (body, None),
        }
    }
}

/// One event.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Event {
    /// Time, s. A stepping engine gives the end of the step in which it handled the event.
    pub time: f64,
    /// What happened.
    pub kind: EventKind,
    /// Size of the impulse: contact `J`, cushion `m (1 + e) |v_n|`, rest `m speed`.
    pub impulse: f64,
}

/// How many events of each kind.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct EventCounts {
    /// Impacts between spheres.
    pub contacts: u64,
    /// Impacts on walls.
    pub cushions: u64,
    /// Stops.
    pub rests: u64,
}

/// Events of one kind and the same bodies that are kept one by one between two samples.
const KEPT_PER_INTERVAL: u32 = 32;

/// Events in order of time, in memory that grows with samples and not with steps.
///
/// Bodies pressed together collide in every step. Past the 32nd event of the same bodies
/// between two samples, further ones add their impulse to the 32nd; they are counted in
/// [`counts`](Self::counts) and in [`merged`](Self::merged) all the same. So are all past the
/// millionth, and where none of the same bodies is kept, their impulse is in no other.
#[derive(Debug, Clone, Default)]
pub struct EventLog {
    events: Vec<Event>,
    counts: EventCounts,
    merged: u64,
    latest: HashMap<EventKind, Latest>,
    interval: u64,
}

/// The latest event of a kind.
#[derive(Debug, Clone, Copy, Default)]
struct Latest {
    /// Its place in the list.
    place: usize,
    /// The interval between two samples in which it happened.
    interval: u64,
    /// How many of its kind were kept in that interval.
    kept: u32,
}

impl EventLog {
    /// Notes an event.
    pub fn push(&mut self, event: Event) {
        match event.kind {
            EventKind::Contact { .. } => self.counts.contacts += 1,
            EventKind::Cushion { .. } => self.counts.cushions += 1,
            EventKind::Rest { .. } => self.counts.rests += 1,
        }
        if self.events.len() >= EVENTS_MAX {
            self.merged += 1;
            return self.prolong(event.kind, event.impulse);
        }
        let latest = self.latest.entry(event.kind).or_default();
        if latest.interval != self.interval {
            (latest.interval, latest.kept) = (self.interval, 0);
        }
        if latest.kept == KEPT_PER_INTERVAL {
            self.events[latest.place].impulse += event.impulse;
            self.merged += 1;
        } else {
            latest.kept += 1;
            latest.place = self.events.len();
            self.events.push(event);
        }
    }

    /// Adds impulse to the latest event of that kind: an impact that an engine spreads over
    /// several steps.
    pub fn prolong(&mut self, kind: EventKind, impulse: f64) {
        let latest = self.latest.get(&kind).map(|latest| latest.place);
        if let Some(event) = latest.and_then(|place| self.events.get_mut(place)) {
            event.impulse += impulse;
        }
    }

    /// Sums the impulses of the events from that place in the list on, one event a kind: a series
    /// without end at one instant is one event.
    pub fn sum_from(&mut self, place: usize) {
        let place = place.min(self.events.len());
        for event in self.events.split_off(place) {
            let same = self.events[place..]
                .iter_mut()
                .find(|kept| kept.kind == event.kind);
            if let Some(same) = same {
                same.impulse += event.impulse;
                match event.kind {
                    EventKind::Contact { .. } => self.counts.contacts -= 1,
                    EventKind::Cushion { .. } => self.counts.cushions -= 1,
                    EventKind::Rest { .. } => self.counts.rests -= 1,
                }
            } else {
                let latest = self.latest.entry(event.kind).or_default();
                (latest.place, latest.interval) = (self.events.len(), self.interval);
                latest.kept = 1;
                self.events.push(event);
            }
        }
    }

    /// Tells that a sample has been reached.
    pub fn end_interval(&mut self) {
        self.interval += 1;
    }

    /// Forgets every event after that time, those with it.
    pub fn truncate_after(&mut self, time: f64) {
        self.events
            .retain(|event| event.time <= time && event.impulse.is_finite());
        self.latest.clear();
    }

    /// The events kept, in order of time.
    #[must_use]
    pub fn events(&self) -> &[Event] {
        &self.events
    }

    /// How many events there were, the merged ones included.
    #[must_use]
    pub fn counts(&self) -> EventCounts {
        self.counts
    }

    /// How many events were merged into another of the same bodies.
    #[must_use]
    pub fn merged(&self) -> u64 {
        self.merged
    }

    /// The impacts kept, without the stops.
    pub fn impacts(&self) -> impl Iterator<Item = &Event> {
        self.events.iter().filter(|event| event.kind.is_impact())
    }
}

impl FromIterator<Event> for EventLog {
    /// Keeps every event, as evidence from elsewhere is kept.
    fn from_iter<I: IntoIterator<Item = Event>>(events: I) -> Self {
        let mut log = Self::default();
        for event in events {
            log.push(event);
            log.end_interval();
        }
        log
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_grows_with_samples_not_with_steps() {
        let mut log = EventLog::default();
        let kind = EventKind::Contact { a: 0, b: 1 };
        for step in 0..10_000 {
            log.push(Event {
                time: f64::from(step),
                kind,
                impulse: 0.5,
            });
        }
        log.end_interval();
        log.push(Event {
            time: 10_000.0,
            kind,
            impulse: 0.5,
        });
        assert_eq!(log.events().len(), 33);
        assert_eq!(log.counts().contacts, 10_001);
        assert_eq!(log.merged(), 10_000 - 32);
        let total: f64 = log.events().iter().map(|event| event.impulse).sum();
        assert_eq!(total, 0.5 * 10_001.0);
    }

    /// A heap of bodies pressed together has as many kinds of events as it has pairs.
    #[test]
    fn memory_does_not_grow_with_pairs_past_a_bound() {
        let mut log = EventLog::default();
        for a in 0..1500 {
            for b in a + 1..1500 {
                let kind = EventKind::Contact { a, b };
                let (time, impulse) = (1.0, 0.5);
                log.push(Event {
                    time,
                    kind,
                    impulse,
                });
            }
        }
        assert_eq!(log.events().len(), EVENTS_MAX);
        assert_eq!(log.latest.len(), EVENTS_MAX);
        assert_eq!(log.counts().contacts, 1_124_250);
        assert_eq!(log.merged(), 124_250);
    }

    #[test]
    fn a_series_at_one_instant_is_one_event_a_kind() {
        let kinds = [
            EventKind::Contact { a: 0, b: 1 },
            EventKind::Rest { body: 0 },
        ];
        let mut log = EventLog::default();
        for (turn, kind) in kinds.iter().cycle().take(5).enumerate() {
            let (time, impulse) = (f64::from(u8::from(turn > 0)), 1.0);
            let kind = *kind;
            log.push(Event {
                time,
                kind,
                impulse,
            });
        }
        log.sum_from(1);
        let impulses = log.events().iter().map(|event| event.impulse);
        assert_eq!(impulses.collect::<Vec<_>>(), [1.0, 2.0, 2.0]);
        assert_eq!((log.counts().contacts, log.counts().rests), (2, 1));
    }

    #[test]
    fn walls_are_read_back_by_their_name() {
        for wall in Wall::ALL {
            assert_eq!(Wall::from_name(wall.name()), Some(wall));
        }
    }
}
