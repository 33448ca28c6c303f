//! Room for labels beside points: none covers a point or another label.

use super::polyline::{Frame, Point};

/// Between a point and a label that must be near.
pub(super) const NEAR: [f64; 1] = [17.0];
/// Between a point and a label that may stand farther off where it is crowded.
pub(super) const FAR: [f64; 5] = [17.0, 34.0, 60.0, 100.0, 170.0];

/// The plot, and what of it is taken.
pub(super) struct Room {
    frame: Frame,
    /// Never covered: points and labels.
    taken: Vec<Frame>,
    /// Covered only by a label that finds no other place: lines and small dots.
    thin: Vec<Frame>,
}

impl Room {
    /// A plot with nothing in it.
    pub(super) fn new(frame: Frame) -> Self {
        Self {
            frame,
            taken: Vec::new(),
            thin: Vec::new(),
        }
    }

    /// Nothing may cover this.
    pub(super) fn take(&mut self, frame: Frame) {
        self.taken.push(frame);
    }

    /// Nothing should cover this.
    pub(super) fn spare(&mut self, frame: Frame) {
        self.thin.push(frame);
    }

    /// Takes room for a label of this width and height beside the first of the points that has
    /// some, where it covers nothing; failing that, where it covers lines at most.
    pub(super) fn beside(
        &mut self,
        points: &[Point],
        gaps: &[f64],
        [wide, high]: [f64; 2],
    ) -> Option<Frame> {
        let search = |taken: &[&[Frame]]| {
            let rings = gaps.iter().copied();
            let mut places = rings.flat_map(|gap| {
                points
                    .iter()
                    .flat_map(move |at| around_point(*at, gap, wide, high))
            });
            places.find(|label| self.fits(label, taken))
        };
        let clear = search(&[&self.taken, &self.thin]);
        let found = clear.or_else(|| search(&[&self.taken]))?;
        self.taken.push(found);
        Some(found)
    }

    fn fits(&self, label: &Frame, taken: &[&[Frame]]) -> bool {
        let frame = &self.frame;
        let inside =
            frame.contains([label.left, label.top]) && frame.contains([label.right, label.bottom]);
        inside
            && !taken
                .iter()
                .copied()
                .flatten()
                .any(|other| overlap(label, other))
    }
}

/// A square around a point.
pub(super) fn around([x, y]: Point, reach: f64) -> Frame {
    Frame {
        left: x - reach,
        top: y - reach,
        right: x + reach,
        bottom: y + reach,
    }
}

/// Places of a label beside a point: to the right, the left, above and below.
fn around_point([x, y]: Point, gap: f64, wide: f64, high: f64) -> [Frame; 8] {
    let half = high / 2.0;
    let [right, left] = [x + gap, x - gap - wide];
    let [above, below] = [y - gap - half, y + gap + half];
    let corners = [
        [right, y],
        [left, y],
        [right - gap, above],
        [right - gap, below],
        [left + gap, above],
        [left + gap, below],
        [x - wide / 2.0, above],
        [x - wide / 2.0, below],
    ];
    corners.map(|[left, middle]| Frame {
        left,
        top: middle - half,
        right: left + wide,
        bottom: middle + half,
    })
}

fn overlap(a: &Frame, b: &Frame) -> bool {
    a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom
}

#[cfg(test)]
mod tests {
    use super::*;

    const FRAME: Frame = Frame {
        left: 0.0,
        top: 0.0,
        right: 400.0,
        bottom: 400.0,
    };
    const SIZE: [f64; 2] = [60.0, 24.0];

    #[test]
    fn a_label_covers_no_other_label_and_stays_within() {
        let mut room = Room::new(FRAME);
        let point = [[200.0, 200.0]];
        let first = room.beside(&point, &NEAR, SIZE).unwrap();
        assert!(first.left > 200.0);
        let second = room.beside(&point, &NEAR, SIZE).unwrap();
        assert!(second.right < 200.0 && !overlap(&first, &second));
        let at_the_edge = room.beside(&[[395.0, 100.0]], &NEAR, SIZE).unwrap();
        assert!(at_the_edge.right < 395.0);
        room.take(FRAME);
        assert_eq!(room.beside(&point, &NEAR, SIZE), None);
    }

    #[test]
    fn a_label_stands_farther_off_where_it_may_and_must() {
        let mut room = Room::new(FRAME);
        let point = [200.0, 200.0];
        room.take(around(point, 90.0));
        assert_eq!(room.beside(&[point], &NEAR, SIZE), None);
        let label = room.beside(&[point], &FAR, SIZE).unwrap();
        assert!(!overlap(&label, &around(point, 90.0)), "{label:?}");
    }

    #[test]
    fn lines_are_covered_only_where_there_is_no_other_place() {
        let mut room = Room::new(FRAME);
        let [near, far] = [[200.0, 200.0], [200.0, 350.0]];
        room.spare(around(near, 90.0));
        let label = room.beside(&[near, far], &NEAR, SIZE).unwrap();
        assert!(label.top > 300.0, "{label:?}");
        room.spare(FRAME);
        let label = room.beside(&[near, far], &NEAR, SIZE).unwrap();
        assert!(label.bottom < 300.0, "{label:?}");
    }
}
