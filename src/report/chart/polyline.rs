//! Lines as lists of points in pixels: broken at gaps, thinned, clipped, dashed.

/// A number of things, as a length.
pub(super) fn count(things: usize) -> f64 {
    (0..things).fold(0.0, |count, _| count + 1.0)
}

/// A place on the canvas in pixels, x to the right and y down.
pub(super) type Point = [f64; 2];

/// Clipping takes what is farther away to be here.
const FARTHEST: f64 = 1e150;

/// A rectangle on the canvas.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Frame {
    /// Left edge.
    pub(super) left: f64,
    /// Upper edge.
    pub(super) top: f64,
    /// Right edge.
    pub(super) right: f64,
    /// Lower edge.
    pub(super) bottom: f64,
}

impl Frame {
    /// Extent from left to right.
    pub(super) fn width(&self) -> f64 {
        self.right - self.left
    }

    /// Extent from top to bottom.
    pub(super) fn height(&self) -> f64 {
        self.bottom - self.top
    }

    /// The column at a share (0 left, 1 right) of the width.
    pub(super) fn x(&self, share: f64) -> f64 {
        self.left + share * self.width()
    }

    /// The row at a share (0 bottom, 1 top) of the height.
    pub(super) fn y(&self, share: f64) -> f64 {
        self.bottom - share * self.height()
    }

    /// Whether the point lies within, edges included.
    pub(super) fn contains(&self, point: Point) -> bool {
        (self.left..=self.right).contains(&point[0]) && (self.top..=self.bottom).contains(&point[1])
    }

    /// The frame without a margin along its edges, as far as there is one.
    pub(super) fn inset(&self, margin: f64) -> Self {
        let across = margin.min(self.width() / 2.0);
        let down = margin.min(self.height() / 2.0);
        Self {
            left: self.left + across,
            top: self.top + down,
            right: self.right - across,
            bottom: self.bottom - down,
        }
    }

    /// The outline, closed.
    pub(super) fn outline(&self) -> [Point; 5] {
        [
            [self.left, self.top],
            [self.right, self.top],
            [self.right, self.bottom],
            [self.left, self.bottom],
            [self.left, self.top],
        ]
    }
}

/// The unbroken stretches of a line that has gaps (`None`).
pub(super) fn runs(points: impl IntoIterator<Item = Option<Point>>) -> Vec<Vec<Point>> {
    let mut runs = Vec::new();
    let mut run = Vec::new();
    for point in points {
        match point {
            Some(point) => run.push(point),
            None if run.is_empty() => {}
            None => runs.push(std::mem::take(&mut run)),
        }
    }
    if !run.is_empty() {
        runs.push(run);
    }
    runs
}

/// The line without points nearer than half a pixel to the one before; its ends stay.
pub(super) fn thinned(run: &[Point]) -> Vec<Point> {
    let mut kept: Vec<Point> = Vec::new();
    for (i, &point) in run.iter().enumerate() {
        let far = kept.last().is_none_or(|last| distance(*last, point) >= 0.5);
        if far || i + 1 == run.len() {
            kept.push(point);
        }
    }
    kept
}

/// A curve over time with at most four points per half pixel of time: where it enters,
/// its lowest, its highest, where it leaves. Draws the same as all of its points.
pub(super) fn thinned_columns(run: &[Point]) -> Vec<Point> {
    let column = |point: &Point| (point[0] * 2.0).floor();
    let mut kept: Vec<Point> = Vec::new();
    let same = |a: &Point, b: &Point| column(a).total_cmp(&column(b)).is_eq();
    for group in run.chunk_by(same) {
        let by_height = |a: &usize, b: &usize| group[*a][1].total_cmp(&group[*b][1]);
        let mut picked = vec![0, group.len() - 1];
        picked.extend((0..group.len()).min_by(by_height));
        picked.extend((0..group.len()).max_by(by_height));
        picked.sort_unstable();
        picked.dedup();
        kept.extend(picked.into_iter().map(|i| group[i]));
    }
    kept
}

/// The parts of a line within the frame.
pub(super) fn clipped(run: &[Point], frame: &Frame) -> Vec<Vec<Point>> {
    if run.iter().all(|point| frame.contains(*point)) {
        return vec![run.to_vec()];
    }
    let mut parts: Vec<Vec<Point>> = Vec::new();
    let mut open = false;
    for pair in run.windows(2) {
        let Some([from, to]) = clipped_segment(pair[0], pair[1], frame) else {
            open = false;
            continue;
        };
        match parts.last_mut() {
            Some(part) if open => part.push(to),
            Some(_) | None => parts.push(vec![from, to]),
        }
        open = frame.contains(pair[1]);
    }
    parts
}

/// The part of one segment within the frame, edges included: cut at one edge after the
/// other, which stays exact to a fraction of a pixel however far away the ends are.
fn clipped_segment(from: Point, to: Point, frame: &Frame) -> Option<[Point; 2]> {
    // Differences stay finite.
    let near = |point: Point| point.map(|v| v.clamp(-FARTHEST, FARTHEST));
    let mut ends = [near(from), near(to)];
    let limits = [[frame.left, frame.right], [frame.top, frame.bottom]];
    for (axis, [low, high]) in limits.into_iter().enumerate() {
        for (edge, sign) in [(low, 1.0), (high, -1.0)] {
            let out = ends.map(|end| (end[axis] - edge) * sign < 0.0);
            let [a, b] = ends;
            match out {
                [true, true] => return None,
                [true, false] => ends[0] = crossing(b, a, axis, edge),
                [false, true] => ends[1] = crossing(a, b, axis, edge),
                [false, false] => {}
            }
        }
    }
    Some(ends)
}

/// Where the way from `inside` to `outside` crosses the edge at `edge` along an axis.
fn crossing(inside: Point, outside: Point, axis: usize, edge: f64) -> Point {
    let share = (edge - inside[axis]) / (outside[axis] - inside[axis]);
    let mut at = between(inside, outside, share);
    at[axis] = edge;
    at
}

/// The pieces of a line drawn with `on` pixels of ink and `off` pixels of gap in turn.
/// The pattern runs on around corners.
pub(super) fn dashed(run: &[Point], on: f64, off: f64) -> Vec<Vec<Point>> {
    let mut pieces: Vec<Vec<Point>> = Vec::new();
    let mut drawing = true;
    let mut left = on;
    let mut piece: Vec<Point> = run.first().copied().into_iter().collect();
    for pair in run.windows(2) {
        let mut here = pair[0];
        let mut rest = distance(here, pair[1]);
        while rest > left {
            let share = left / rest;
            here = [
                here[0] + share * (pair[1][0] - here[0]),
                here[1] + share * (pair[1][1] - here[1]),
            ];
            rest -= left;
            if drawing {
                piece.push(here);
                pieces.push(std::mem::take(&mut piece));
            } else {
                piece = vec![here];
            }
            drawing = !drawing;
            left = if drawing { on } else { off };
        }
        left -= rest;
        if drawing {
            piece.push(pair[1]);
        }
    }
    if drawing && !piece.is_empty() {
        pieces.push(piece);
    }
    pieces
}

/// Places along a line: the first after `lead` pixels, then one every `step`. A line
/// shorter than `lead` has one, at its start.
pub(super) fn dotted(run: &[Point], lead: f64, step: f64) -> Vec<Point> {
    let mut dots: Vec<Point> = Vec::new();
    let mut left = lead;
    for pair in run.windows(2) {
        let length = distance(pair[0], pair[1]);
        while left <= length && left.is_finite() && step > 0.0 {
            let share = if length > 0.0 { left / length } else { 0.0 };
            dots.push(between(pair[0], pair[1], share));
            left += step;
        }
        left -= length;
    }
    if dots.is_empty() {
        dots.extend(run.first());
    }
    dots
}

/// The point at a share (0 to 1) of the way.
fn between(from: Point, to: Point, share: f64) -> Point {
    [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]))
}

/// A circle as a closed line.
pub(super) fn circle(center: Point, radius: f64) -> Vec<Point> {
    const SIDES: u32 = 72;
    (0..=SIDES)
        .map(|i| {
            let angle = f64::from(i) / f64::from(SIDES) * std::f64::consts::TAU;
            [
                center[0] + radius * angle.cos(),
                center[1] + radius * angle.sin(),
            ]
        })
        .collect()
}

fn distance(a: Point, b: Point) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIT: Frame = Frame {
        left: 0.0,
        top: 0.0,
        right: 10.0,
        bottom: 10.0,
    };

    #[test]
    fn a_gap_breaks_the_line() {
        let points = [
            None,
            Some([0.0, 0.0]),
            Some([1.0, 0.0]),
            None,
            Some([5.0, 0.0]),
        ];
        assert_eq!(
            runs(points),
            vec![vec![[0.0, 0.0], [1.0, 0.0]], vec![[5.0, 0.0]]]
        );
    }

    #[test]
    fn thinning_keeps_both_ends() {
        let run: Vec<Point> = (0..=100).map(|i| [f64::from(i) * 0.01, 0.0]).collect();
        let kept = thinned(&run);
        assert_eq!(kept.first(), run.first());
        assert_eq!(kept.last(), run.last());
        assert!(kept.len() <= 4, "{kept:?}");
    }

    #[test]
    fn thinning_by_columns_keeps_the_extremes() {
        let mut run: Vec<Point> = (0..10_000).map(|i| [f64::from(i) * 0.001, 5.0]).collect();
        run[4321][1] = -7.0;
        run[8765][1] = 70.0;
        let kept = thinned_columns(&run);
        assert!(kept.len() < 100, "{}", kept.len());
        assert!(kept.contains(&run[4321]) && kept.contains(&run[8765]));
    }

    #[test]
    fn clipping_cuts_at_the_edges() {
        let through = [[-10.0, 5.0], [20.0, 5.0]];
        assert_eq!(
            clipped(&through, &UNIT),
            vec![vec![[0.0, 5.0], [10.0, 5.0]]]
        );
        let beside = [[-10.0, 50.0], [20.0, 50.0]];
        assert!(clipped(&beside, &UNIT).is_empty());
        let out_and_in = [[5.0, 5.0], [15.0, 5.0], [15.0, 8.0], [5.0, 8.0]];
        assert_eq!(
            clipped(&out_and_in, &UNIT),
            vec![vec![[5.0, 5.0], [10.0, 5.0]], vec![[10.0, 8.0], [5.0, 8.0]]]
        );
    }

    #[test]
    fn nothing_clipped_leaves_the_frame_however_far_it_came_from() {
        let far = [1e-9, 1.0, 1e3, 1e17, 1e151, 1e231, f64::MAX, f64::INFINITY];
        let all: Vec<f64> = far.iter().flat_map(|v| [-v, *v, 3.7]).collect();
        for (x, y) in all.iter().flat_map(|x| all.iter().map(move |y| (*x, *y))) {
            for other in [[5.0, 5.0], [-7.0, 5.0], [-1e231, 4.0], [y, -x]] {
                for run in [[[x, y], other], [other, [x, y]]] {
                    for point in clipped(&run, &UNIT).concat() {
                        assert!(UNIT.contains(point), "{run:?}: {point:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_line_to_far_away_keeps_its_direction() {
        let far = [[2.0, 5.0], [1e231, 5.0]];
        assert_eq!(clipped(&far, &UNIT), vec![vec![[2.0, 5.0], [10.0, 5.0]]]);
        let back = [[1e100, -1e100], [2.0, 8.0]];
        let part = &clipped(&back, &UNIT)[0];
        assert!((part[0][0] - 10.0).abs() + part[0][1].abs() < 1e-9);
        assert_eq!(part[1], [2.0, 8.0]);
        let through = [[-1e231, 4.0], [1e231, 4.0]];
        assert_eq!(
            clipped(&through, &UNIT),
            vec![vec![[0.0, 4.0], [10.0, 4.0]]]
        );
    }

    #[test]
    fn dots_stand_in_the_gaps_of_dashes() {
        let run = [[0.0, 0.0], [5.0, 0.0], [5.0, 8.0]];
        let pieces = dashed(&run, 3.0, 2.0);
        let dots = dotted(&run, 4.0, 5.0);
        assert_eq!(dots, [[4.0, 0.0], [5.0, 4.0]]);
        for piece in pieces {
            assert!(
                piece
                    .iter()
                    .all(|p| dots.iter().all(|d| distance(*p, *d) >= 1.0))
            );
        }
        assert_eq!(dotted(&run[..2], 9.0, 5.0), [[0.0, 0.0]]);
    }

    #[test]
    fn dashes_cover_their_share_and_turn_corners() {
        let run = [[0.0, 0.0], [5.0, 0.0], [5.0, 5.0]];
        let pieces = dashed(&run, 3.0, 1.0);
        assert_eq!(
            pieces,
            vec![
                vec![[0.0, 0.0], [3.0, 0.0]],
                vec![[4.0, 0.0], [5.0, 0.0], [5.0, 2.0]],
                vec![[5.0, 3.0], [5.0, 5.0]],
            ]
        );
    }
}
