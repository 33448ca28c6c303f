//! Events that never end: impacts that get weaker and weaker in a time that gets shorter and
//! shorter, or contact that lasts.

/// Share of the duration in which too many weak events are a runaway.
const SHORT: f64 = 1e-9;

/// An impact is weak below this share of the fastest approach so far.
const WEAK: f64 = 1e-8;

/// Weak events within the short time that are still taken: these, and so many a body.
const EVENTS: u64 = 1000;
const EVENTS_A_BODY: u64 = 16;

/// Counts weak events within a short time.
///
/// Many strong impacts in a short time are a light ball between two heavy ones, and come to an
/// end; a ball that bounces to rest, or one that is pressed on another, makes weak ones without
/// end. Work and memory stay bounded either way.
#[derive(Debug, Clone)]
pub(super) struct Runaway {
    short: f64,
    limit: u64,
    since: f64,
    count: u64,
    fastest: f64,
}

impl Runaway {
    /// A watch for a scene of that length and so many bodies.
    pub fn new(duration: f64, bodies: usize) -> Self {
        Self {
            short: SHORT * duration,
            limit: EVENTS + EVENTS_A_BODY * bodies as u64,
            since: 0.0,
            count: 0,
            fastest: 0.0,
        }
    }

    /// Notes an event with its speed of approach, 0 if it came to nothing. Tells whether it is
    /// one too many.
    #[inline]
    pub fn notes(&mut self, time: f64, approach: f64) -> bool {
        if approach > WEAK * self.fastest {
            if approach.is_finite() {
                self.fastest = self.fastest.max(approach);
            }
            return false;
        }
        if time > self.since + self.short {
            self.since = time;
            self.count = 0;
        }
        self.count += 1;
        self.count > self.limit
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strong_impacts_may_be_many_and_weak_ones_may_be_rare() {
        let mut watch = Runaway::new(1.0, 2);
        assert!((0..1_000_000).all(|_| !watch.notes(0.5, 3.0)));
        assert!((0..1_000_000).all(|i| !watch.notes(f64::from(i) * 1e-6, 1e-9)));
        assert!((0..2_000).any(|_| watch.notes(0.5, 1e-9)));
    }
}
