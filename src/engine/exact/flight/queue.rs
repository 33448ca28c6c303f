//! Whose event comes next: a tournament of all bodies.

use crate::engine::exact::real::Real;

/// The earliest of one time a body, kept as a binary tree of winners.
///
/// A change of one time replays the matches on the way to the root: log2(bodies) of them.
#[derive(Debug, Clone)]
pub(super) struct Queue<R> {
    /// Winner of each match, the root at 1; leaves from `leaves` on. Shape: `[2 leaves]`.
    nodes: Vec<(R, u32)>,
    leaves: usize,
}

impl<R: Real> Queue<R> {
    /// A queue of that many bodies, none of which has an event.
    pub fn new(bodies: usize) -> Self {
        let leaves = bodies.next_power_of_two();
        Self {
            nodes: vec![(R::from_f64(f64::INFINITY), 0); 2 * leaves],
            leaves,
        }
    }

    /// The earliest time and its body.
    #[inline]
    pub fn first(&self) -> (R, usize) {
        let (time, body) = self.nodes[1];
        (time, body as usize)
    }

    /// Sets the time of a body.
    #[inline]
    #[allow(
        clippy::cast_possible_truncation,
        reason = "a recording holds at most 4e7 states, so there are fewer bodies than 2^32"
    )]
    pub fn set(&mut self, body: usize, time: R) {
        let mut node = self.leaves + body;
        let mut winner = (time, body as u32);
        self.nodes[node] = winner;
        while node > 1 {
            let rival = self.nodes[node ^ 1];
            if rival.0 < winner.0 {
                winner = rival;
            }
            node /= 2;
            self.nodes[node] = winner;
        }
    }

    /// Whether more than one body has a time up to `limit`.
    #[inline]
    pub fn is_crowded(&self, limit: R) -> bool {
        let (_, body) = self.first();
        let mut node = self.leaves + body;
        while node > 1 {
            if self.nodes[node ^ 1].0 <= limit {
                return true;
            }
            node /= 2;
        }
        false
    }

    /// Every body with a time up to `limit`, into `found`.
    pub fn up_to(&self, limit: R, found: &mut Vec<usize>) {
        found.clear();
        let mut open = vec![1];
        while let Some(node) = open.pop() {
            if !(self.nodes[node].0 <= limit) {
                continue;
            }
            if node >= self.leaves {
                found.push(node - self.leaves);
            } else {
                open.extend([2 * node + 1, 2 * node]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_earliest_wins_whatever_changed() {
        let mut queue = Queue::new(5);
        for (body, time) in [(0, 3.0), (1, 2.0), (2, 5.0), (3, 2.5), (4, 9.0)] {
            queue.set(body, time);
        }
        assert_eq!(queue.first(), (2.0, 1));
        queue.set(1, f64::INFINITY);
        assert_eq!(queue.first(), (2.5, 3));
        assert!(queue.is_crowded(3.0) && !queue.is_crowded(2.9));
        let mut found = Vec::new();
        queue.up_to(5.0, &mut found);
        assert_eq!(found, [0, 2, 3]);
    }

    #[test]
    fn one_body_is_a_queue_too() {
        let mut queue = Queue::new(1);
        queue.set(0, 1.0);
        assert_eq!(queue.first(), (1.0, 0));
        assert!(!queue.is_crowded(2.0));
    }
}
