//! Whose event comes next: a tournament of all bodies.

use crate::physics::real::Real;

/// Bodies that share a leaf: their times lie in one line of the cache and are scanned.
const BLOCK: usize = 8;

/// The earliest of one time a body, kept as a binary tree of winners over blocks of bodies.
///
/// A change of one time replays the matches on the way to the root, as far as they change.
#[derive(Debug, Clone)]
pub(super) struct Queue<R> {
    /// Shape: `[body]`, filled up to whole blocks with times that never come.
    times: Vec<R>,
    /// Winner of each match, the root at 1; blocks from `leaves` on. Shape: `[2 leaves]`.
    nodes: Vec<(R, u32)>,
    leaves: usize,
}

impl<R: Real> Queue<R> {
    /// A queue of that many bodies, none of which has an event.
    pub fn new(bodies: usize) -> Self {
        let leaves = bodies.div_ceil(BLOCK).next_power_of_two();
        let never = R::from_f64(f64::INFINITY);
        Self {
            times: vec![never; leaves * BLOCK],
            nodes: vec![(never, 0); 2 * leaves],
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
        self.times[body] = time;
        let start = body / BLOCK * BLOCK;
        let mut winner = (self.times[start], start as u32);
        for (place, rival) in self.times[start..start + BLOCK].iter().enumerate().skip(1) {
            if *rival < winner.0 {
                winner = (*rival, (start + place) as u32);
            }
        }
        let mut node = self.leaves + body / BLOCK;
        while self.nodes[node] != winner {
            self.nodes[node] = winner;
            if node == 1 {
                break;
            }
            let rival = self.nodes[node ^ 1];
            if rival.0 < winner.0 {
                winner = rival;
            }
            node /= 2;
        }
    }

    /// Whether more than one body has a time up to `limit`.
    #[inline]
    pub fn is_crowded(&self, limit: R) -> bool {
        let (_, first) = self.first();
        let start = first / BLOCK * BLOCK;
        let block = &self.times[start..start + BLOCK];
        if block.iter().filter(|time| **time <= limit).count() > 1 {
            return true;
        }
        let mut node = self.leaves + first / BLOCK;
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
        // Depth first: never more nodes open than the tree has levels.
        let (mut open, mut count) = ([1_usize; usize::BITS as usize + 1], 1);
        while count > 0 {
            count -= 1;
            let node = open[count];
            if self.nodes[node].0 > limit {
                continue;
            }
            if node >= self.leaves {
                let start = (node - self.leaves) * BLOCK;
                let due = (start..start + BLOCK).filter(|body| self.times[*body] <= limit);
                found.extend(due);
            } else {
                (open[count], open[count + 1]) = (2 * node + 1, 2 * node);
                count += 2;
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

    /// Every state of a queue of 41 bodies against a plain search.
    #[test]
    fn many_changes_keep_the_earliest_first() {
        let mut queue = Queue::new(41);
        let mut times = [f64::INFINITY; 41];
        let mut lot = 1_u64;
        for _ in 0..5000 {
            lot = lot.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            #[allow(clippy::cast_precision_loss, reason = "24 bits")]
            let (body, time) = ((lot >> 33) as usize % 41, (lot >> 40) as f64);
            times[body] = time;
            queue.set(body, time);
            let earliest = times.iter().copied().fold(f64::INFINITY, f64::min);
            let (first, winner) = queue.first();
            assert_eq!((first, times[winner]), (earliest, earliest));
            let mut found = Vec::new();
            let limit = earliest + 1e5;
            queue.up_to(limit, &mut found);
            assert_eq!(found.len(), times.iter().filter(|t| **t <= limit).count());
            assert_eq!(queue.is_crowded(limit), found.len() > 1);
        }
    }

    #[test]
    fn one_body_is_a_queue_too() {
        let mut queue = Queue::new(1);
        queue.set(0, 1.0);
        assert_eq!(queue.first(), (1.0, 0));
        assert!(!queue.is_crowded(2.0));
    }
}
