//! Impacts matched in order: where do two recordings first tell another story?
//!
//! The order that means something is that of each body: two impacts far apart on the table may
//! swap without anyone noticing. So impacts are matched body by body, as a graph in which each
//! impact follows the last one of each body that takes part.

use std::collections::VecDeque;

use crate::recording::{Event, Recording};
use crate::scene::Scene;

/// The first impact at which two recordings disagree: one has it, the other does not have it
/// next for those bodies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Disagreement {
    /// The impact of the first recording, if it has one there.
    pub event_a: Option<Event>,
    /// The impact of the second recording for the same bodies, if it has one there.
    pub event_b: Option<Event>,
}

impl Disagreement {
    /// The earlier of the two times, s.
    #[must_use]
    pub fn time(&self) -> f64 {
        let time = |event: Option<Event>| event.map_or(f64::INFINITY, |event| event.time);
        time(self.event_a).min(time(self.event_b))
    }
}

/// How the impacts of two recordings match.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EventAgreement {
    /// Impacts that match: the same bodies, and the same history of each of them.
    pub matched: usize,
    /// Largest difference in time of two matched impacts, s.
    pub time_difference_max: f64,
    /// Largest difference in impulse of two matched impacts, over the larger of the two.
    pub impulse_difference_max: f64,
    /// The earliest disagreement.
    pub first_disagreement: Option<Disagreement>,
}

/// The impacts of one recording, and for each body the places of those still to come.
struct Histories<'a> {
    impacts: Vec<&'a Event>,
    next: Vec<VecDeque<usize>>,
    /// Impacts that have been dealt with. Shape: `[impact]`.
    done: Vec<bool>,
}

/// Impulses below this share of a recording's largest are rounding: two spheres that lie
/// together after an impact with e = 0 may still approach by the last bit of their speeds.
const ROUNDING: f64 = 1e-13;

impl<'a> Histories<'a> {
    fn of(recording: &'a Recording, bodies: usize) -> Self {
        let impulses = recording.events.impacts().map(|event| event.impulse);
        let least = ROUNDING * impulses.fold(0.0, f64::max);
        let felt = |event: &&Event| event.impulse > least;
        let impacts: Vec<_> = recording.events.impacts().filter(felt).collect();
        let mut next = vec![VecDeque::new(); bodies];
        for (place, event) in impacts.iter().enumerate() {
            for body in participants(event) {
                next[body].push_back(place);
            }
        }
        let done = vec![false; impacts.len()];
        Self {
            impacts,
            next,
            done,
        }
    }

    fn next_of(&self, body: usize) -> Option<&'a Event> {
        self.next[body].front().map(|place| self.impacts[*place])
    }

    /// Place of the same impact, if it comes next for every body that takes part; impacts of a
    /// body within `window` of each other have no order.
    fn place_of(&self, event: &Event, window: f64) -> Option<usize> {
        let (first, _) = event.kind.bodies();
        let next = self.next_of(first)?.time;
        let place = self.next[first]
            .iter()
            .copied()
            .take_while(|place| self.impacts[*place].time <= next + window)
            .find(|place| self.impacts[*place].kind == event.kind)?;
        let time = self.impacts[place].time;
        let is_next = |body| {
            self.next_of(body)
                .is_some_and(|head| time <= head.time + window)
        };
        participants(event).all(is_next).then_some(place)
    }

    /// Deals with an impact: it is no longer to come.
    fn take(&mut self, place: usize) -> &'a Event {
        let event = self.impacts[place];
        self.done[place] = true;
        for body in participants(event) {
            let queue = &mut self.next[body];
            if let Some(at) = queue.iter().position(|other| *other == place) {
                queue.remove(at);
            }
        }
        event
    }

    /// The impact of these bodies that comes next, if it is another one.
    fn rival_of(&self, event: &Event) -> Option<&'a Event> {
        let next = participants(event).filter_map(|body| self.next_of(body));
        let others = next.filter(|rival| rival.kind != event.kind);
        others.min_by(|x, y| x.time.total_cmp(&y.time))
    }
}

fn participants(event: &Event) -> impl Iterator<Item = usize> + use<> {
    let (first, second) = event.kind.bodies();
    std::iter::once(first).chain(second)
}

/// Every impact of both recordings in order of time: which recording, and its place there.
fn merged(histories: &[Histories; 2]) -> Vec<(usize, usize)> {
    let places = |side: usize| (0..histories[side].impacts.len()).map(move |place| (side, place));
    let mut all: Vec<_> = places(0).chain(places(1)).collect();
    let time = |&(side, place): &(usize, usize)| histories[side].impacts[place].time;
    all.sort_by(|x, y| time(x).total_cmp(&time(y)));
    all
}

/// Matches the impacts of two recordings of `scene`.
///
/// Impacts of one body within a step of each other have no order: a stepping engine handles
/// them at the same instant. After a disagreement the bodies that take part, and whoever meets
/// them later, are no longer compared. An impact within two steps of the end that only one
/// recording has is no disagreement: the other may have it just past the end; the end is that
/// of the samples that both vouch for, and what comes later is not compared. Which recording
/// comes first makes no difference.
#[must_use]
pub fn compare_events(scene: &Scene, a: &Recording, b: &Recording) -> EventAgreement {
    let bodies = scene.bodies.len();
    let step = a.step.unwrap_or(0.0).max(b.step.unwrap_or(0.0));
    let samples = a.comparable_samples(scene).min(b.comparable_samples(scene));
    let last = scene.sample_time(samples.max(1) - 1);
    let end = last - 2.0 * step;
    let mut histories = [Histories::of(a, bodies), Histories::of(b, bodies)];
    let mut parted = vec![false; bodies];
    let mut agreement = EventAgreement::default();
    for (side, place) in merged(&histories) {
        if histories[side].done[place] {
            continue;
        }
        if histories[side].impacts[place].time > last {
            break;
        }
        let other = 1 - side;
        let event = histories[side].take(place);
        if participants(event).any(|body| parted[body]) {
            participants(event).for_each(|body| parted[body] = true);
        } else if let Some(twin) = histories[other].place_of(event, step) {
            let twin = histories[other].take(twin);
            agreement.matches(event, twin);
        } else {
            let rival = histories[other].rival_of(event).copied();
            participants(event)
                .chain(rival.iter().flat_map(participants))
                .for_each(|body| parted[body] = true);
            if event.time <= end && agreement.first_disagreement.is_none() {
                let [event_a, event_b] = match side {
                    0 => [Some(*event), rival],
                    _ => [rival, Some(*event)],
                };
                agreement.first_disagreement = Some(Disagreement { event_a, event_b });
            }
        }
    }
    agreement
}

impl EventAgreement {
    fn matches(&mut self, event: &Event, twin: &Event) {
        self.matched += 1;
        let time = (event.time - twin.time).abs();
        self.time_difference_max = self.time_difference_max.max(time);
        let scale = event.impulse.max(twin.impulse);
        let impulse = (event.impulse - twin.impulse).abs() / scale;
        self.impulse_difference_max = self.impulse_difference_max.max(impulse);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::EventKind;

    fn scene() -> Scene {
        let body = |name: &str| {
            format!(
                "[[bodies]]\nname='{name}'\nmass=1\nradius=1\nposition=[0,0,0]\nvelocity=[0,0,0]\n"
            )
        };
        let bodies: String = ["a", "b", "c", "d"].map(body).concat();
        let text = format!("name='x'\nduration=9\nsample_every=9\n{bodies}");
        crate::scene::parse(&text, "x").unwrap()
    }

    fn recording(scene: &Scene, contacts: &[(f64, usize, usize)]) -> Recording {
        let mut recording = Recording::at_start("x", scene);
        let events = contacts.iter().map(|&(time, a, b)| Event {
            time,
            kind: EventKind::Contact { a, b },
            impulse: 1.0,
        });
        recording.events = events.collect();
        recording.push(&crate::recording::initial_states(scene));
        recording
    }

    #[test]
    fn impacts_of_strangers_may_swap() {
        let scene = scene();
        let a = recording(&scene, &[(1.0, 0, 1), (1.1, 2, 3), (2.0, 1, 2)]);
        let b = recording(&scene, &[(1.05, 2, 3), (1.06, 0, 1), (2.25, 1, 2)]);
        let agreement = compare_events(&scene, &a, &b);
        assert_eq!((agreement.matched, agreement.first_disagreement), (3, None));
        assert_eq!(agreement.time_difference_max, 0.25);
    }

    #[test]
    fn impacts_within_one_step_have_no_order() {
        let scene = scene();
        let mut a = recording(&scene, &[(1.0, 0, 1), (1.001, 1, 2), (1.002, 2, 3)]);
        let b = recording(&scene, &[(0.997, 2, 3), (0.998, 1, 2), (0.999, 0, 1)]);
        assert_ne!(compare_events(&scene, &a, &b).first_disagreement, None);
        a.step = Some(0.01);
        let agreement = compare_events(&scene, &a, &b);
        assert_eq!((agreement.matched, agreement.first_disagreement), (3, None));
    }

    #[test]
    fn the_first_of_several_disagreements_is_named() {
        let scene = scene();
        let a = recording(&scene, &[(1.0, 0, 1), (2.0, 1, 2), (3.0, 0, 3)]);
        let b = recording(&scene, &[(1.0, 0, 1), (2.5, 1, 3), (3.0, 0, 3)]);
        let first = compare_events(&scene, &a, &b).first_disagreement.unwrap();
        assert_eq!(
            first.event_a.unwrap().kind,
            EventKind::Contact { a: 1, b: 2 }
        );
        assert_eq!(
            first.event_b.unwrap().kind,
            EventKind::Contact { a: 1, b: 3 }
        );
        assert_eq!(first.time(), 2.0);
    }

    #[test]
    fn an_impact_that_only_one_has_is_found_from_either_side() {
        let scene = scene();
        let a = recording(&scene, &[(1.0, 0, 1)]);
        let b = recording(&scene, &[(1.0, 0, 1), (2.0, 2, 3)]);
        let [forth, back] = [
            compare_events(&scene, &a, &b),
            compare_events(&scene, &b, &a),
        ];
        assert_eq!(forth.first_disagreement.unwrap().event_b.unwrap().time, 2.0);
        assert_eq!(back.first_disagreement.unwrap().event_a.unwrap().time, 2.0);
        assert_eq!((forth.matched, back.matched), (1, 1));
    }

    /// The list walked first used to hide what the other one had earlier.
    #[test]
    fn which_recording_comes_first_makes_no_difference() {
        let scene = scene();
        let a = recording(&scene, &[(1.2, 2, 3), (1.5, 0, 1)]);
        let b = recording(&scene, &[(1.1, 0, 2), (1.3, 1, 3)]);
        let (forth, back) = (
            compare_events(&scene, &a, &b),
            compare_events(&scene, &b, &a),
        );
        let (forth, back) = (
            forth.first_disagreement.unwrap(),
            back.first_disagreement.unwrap(),
        );
        assert_eq!(forth.time(), 1.1);
        assert_eq!(forth.event_a, back.event_b);
        assert_eq!(forth.event_b, back.event_a);
    }
}
