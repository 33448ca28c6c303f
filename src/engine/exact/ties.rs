//! Events that nearly fall on one instant, and which of them stand for one.
//!
//! A scene's numbers are decimals, each known to half an ulp. What that leaves open in the time
//! between two impacts is measured on runs from moved inputs; impacts nearer than that stand for
//! one instant, and the model has no order for them but a rule. Other orders are tried there.

use super::order::TieOrder;
use super::parting::SAFETY;
use crate::physics::real::Real;
use crate::recording::EventKind;

/// Share of the duration within which two events of a body are noted. Where half an ulp of an
/// input leaves more open than that, positions have lost the digits to be compared.
const NOTED: f64 = 1e-6;

/// At most so many are noted, from the first on: bounces that pile up come ever closer.
const KEPT: usize = 4096;

/// Ties of a scene that are looked at.
const TIES_MAX: usize = 256;

/// Other orders that are tried at one tie of more than two events, beside the rule and the reverse.
const DRAWN: u64 = 7;

/// Roundings of a time by which events of one instant may be apart as they are computed.
const ROUNDINGS: f64 = 1e3;

/// Other orders that are followed to the end of a scene.
pub(super) const CONTINUATIONS_MAX: u32 = 24;

/// Answers that differ by less than this share of the scene's size, or speed, are one answer, with
/// as many digits as they share.
pub(super) const SAME: f64 = 1e-9;

/// Copies from moved inputs on which ties are measured.
pub(super) const COPIES: std::ops::RangeInclusive<u64> = 1..=6;

/// What is foreseen: an event, and the time until then.
pub(super) type Foreseen<R> = (EventKind, R);

/// Two events that share a body and nearly an instant.
#[derive(Debug, Clone, Copy)]
pub(super) struct Near<R> {
    /// The first of them, s.
    pub time: R,
    /// Both, the lower one first.
    pub kinds: [EventKind; 2],
    /// Time from the first to the second, s; negative where the second comes first.
    pub lag: R,
}

/// The near coincidences of a run.
#[derive(Debug, Clone)]
pub(super) struct Noted<R> {
    within: f64,
    list: Vec<Near<R>>,
}

impl<R: Real> Noted<R> {
    /// None yet, of a run of that length.
    pub fn new(duration: f64) -> Self {
        Self {
            within: NOTED * duration,
            list: Vec::new(),
        }
    }

    /// The longest time between two events that are noted, s.
    pub fn within(&self) -> f64 {
        self.within
    }

    /// The time of the last of them, s.
    pub fn last(&self) -> Option<f64> {
        self.list.last().map(|near| near.time.to_f64())
    }

    /// Those up to a time, s.
    pub fn up_to(&self, time: f64) -> Self {
        self.filtered(|near| near.time.to_f64() <= time)
    }

    /// Those whose lag is no larger than `doubt` times what doubles have made of it.
    pub fn unclear(&self, doubles: &Noted<f64>, doubt: f64) -> Self {
        let in_doubles = |near: &Near<R>| Near {
            time: near.time.to_f64(),
            kinds: near.kinds,
            lag: near.lag.to_f64(),
        };
        self.filtered(|near| {
            let near = in_doubles(near);
            let rounded = f64::EPSILON * near.time;
            let off = |lag: f64| (lag - near.lag).abs().max(rounded);
            let lag = doubles.lag_of(&near);
            lag.is_none_or(|lag| near.lag.abs() <= doubt * off(lag))
        })
    }

    fn filtered(&self, keep: impl Fn(&Near<R>) -> bool) -> Self {
        Self {
            within: self.within,
            list: self
                .list
                .iter()
                .copied()
                .filter(|near| keep(near))
                .collect(),
        }
    }

    /// Notes the pairs of foreseen events that share a body.
    pub fn note(&mut self, now: R, foreseen: &[Foreseen<R>]) {
        for (place, one) in foreseen.iter().enumerate() {
            for other in &foreseen[..place] {
                let later = one.0 > other.0;
                let [first, second] = if later { [other, one] } else { [one, other] };
                let kinds = [first.0, second.0];
                if shared(kinds).is_none() || kinds[0] == kinds[1] || self.knows(now, kinds) {
                    continue;
                }
                if self.list.len() < KEPT {
                    let sooner = if second.1 < first.1 { second } else { first };
                    let (time, lag) = (now + sooner.1, second.1 - first.1);
                    self.list.push(Near { time, kinds, lag });
                }
            }
        }
    }

    /// Whether the two have been noted just now.
    fn knows(&self, now: R, kinds: [EventKind; 2]) -> bool {
        let recent = |near: &&Near<R>| (now - near.time).to_f64() <= self.within;
        let mut latest = self.list.iter().rev().take_while(recent);
        latest.any(|near| near.kinds == kinds)
    }

    /// The lag of the same two events in another run, if they nearly coincide there too.
    fn lag_of(&self, near: &Near<R>) -> Option<R> {
        let apart = |other: &Near<R>| (other.time - near.time).to_f64().abs();
        let same = self.list.iter().filter(|other| other.kinds == near.kinds);
        let nearest = same.min_by(|one, other| apart(one).total_cmp(&apart(other)));
        let nearest = nearest.filter(|nearest| apart(nearest) <= self.within);
        nearest.map(|nearest| nearest.lag)
    }
}

/// A body that takes part in both.
fn shared(kinds: [EventKind; 2]) -> Option<usize> {
    let [(a, b), (c, d)] = kinds.map(EventKind::bodies);
    if a == c || Some(a) == d {
        return Some(a);
    }
    b.filter(|b| *b == c || Some(*b) == d)
}

/// Events that stand for one instant.
#[derive(Debug, Clone)]
pub(super) struct Tie<R> {
    /// The first of them, s.
    pub from: R,
    /// The last of them, s.
    pub to: R,
    kinds: Vec<EventKind>,
    /// The bodies that two of them share.
    pub bodies: Vec<usize>,
}

/// What half an ulp of the inputs leaves open, as copies from inputs moved further show it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Measure {
    /// How far the inputs of the copies were moved, relative.
    pub share: f64,
    /// How many half ulps the inputs, and what was computed from them, are taken to be off.
    pub roundings: f64,
    /// By how much what the copies show may be too small.
    pub doubt: f64,
}

impl Measure {
    /// What is open in the time between two events, at most what is noted; none where that cannot
    /// be told.
    ///
    /// The largest change over the copies. A copy adds the parts of some twenty inputs with random
    /// signs: rarely less than a tenth of the sum of their sizes, which the factor makes up for.
    fn width<R: Real>(&self, near: &Near<R>, run: &Noted<R>, copies: &[&Noted<R>]) -> Option<f64> {
        let lags = copies.iter().filter_map(|copy| copy.lag_of(near));
        let moved = lags
            .map(|lag| (lag - near.lag).to_f64().abs())
            .reduce(f64::max)?;
        let half_ulp = self.roundings * 0.5 * f64::EPSILON;
        let width = self.doubt * SAFETY * moved * (half_ulp / self.share);
        Some(width.min(run.within))
    }
}

/// The near coincidences that the inputs may turn round, those at one instant together.
pub(super) fn ties<R: Real>(run: &Noted<R>, copies: &[&Noted<R>], measure: Measure) -> Vec<Tie<R>> {
    let open = |near: &&Near<R>| {
        let width = measure.width(near, run, copies);
        width.is_some_and(|width| near.lag.to_f64().abs() <= width)
    };
    let mut open: Vec<_> = run.list.iter().filter(open).collect();
    open.sort_by(|one, other| one.time.to_f64().total_cmp(&other.time.to_f64()));
    let mut ties: Vec<Tie<R>> = Vec::new();
    for near in open {
        match ties.last_mut().filter(|tie| tie.holds(near)) {
            Some(tie) => tie.join(near),
            None => ties.push(Tie::of(near)),
        }
    }
    ties.truncate(TIES_MAX);
    ties
}

impl<R: Real> Tie<R> {
    fn of(near: &Near<R>) -> Self {
        let mut tie = Self {
            from: near.time,
            to: near.time,
            kinds: Vec::new(),
            bodies: Vec::new(),
        };
        tie.join(near);
        tie
    }

    /// Whether these two events belong to it as well: they overlap.
    fn holds(&self, near: &Near<R>) -> bool {
        let room = self.to.abs().times(ROUNDINGS * R::EPSILON);
        near.time <= self.to + room
    }

    fn join(&mut self, near: &Near<R>) {
        self.to = self.to.larger(near.time + near.lag.abs());
        for kind in near.kinds {
            if !self.kinds.contains(&kind) {
                self.kinds.push(kind);
            }
        }
        if let Some(body) = shared(near.kinds)
            && !self.bodies.contains(&body)
        {
            self.bodies.push(body);
            self.bodies.sort_unstable();
        }
    }

    /// From the first to the last of its events, s.
    pub fn length(&self) -> R {
        self.to - self.from
    }

    /// Orders to try beside that of the times as computed: the rule's, the reverse, others.
    pub fn orders(&self) -> impl Iterator<Item = TieOrder> + use<R> {
        let drawn = if self.kinds.len() > 2 { DRAWN } else { 0 };
        let drawn = (1..=drawn).map(TieOrder::Drawn);
        [TieOrder::Rule, TieOrder::Backwards]
            .into_iter()
            .chain(drawn)
    }
}
