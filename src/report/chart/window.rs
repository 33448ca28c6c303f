//! Which part of the plane a picture of paths shows, and how it is turned.

use super::axis::extent;
use super::paths_figure::{PathsFigure, View};
use super::polyline::{Frame, Point};

/// Share of all samples, at each end, that may lie outside when a few run far away.
const OUTLIERS: f64 = 0.02;
/// The picture is cut when everything is this many times as wide as what matters.
const FAR: f64 = 3.0;
/// The shorter side of the window is at least this share of the longer one.
const LEAST_RATIO: f64 = 0.36;

/// The part of the plane that is shown.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Window {
    /// Limits of the horizontal and of the vertical axis of the picture.
    pub(super) limits: [[f64; 2]; 2],
    /// The second coordinate runs to the right, the first upwards.
    turned: bool,
    /// The vertical axis of the picture runs down.
    pub(super) down: bool,
    /// How many bodies go beyond the limits.
    pub(super) leaving: usize,
}

/// The window that holds everything, unless a few samples lie so far out that nothing
/// else could be seen.
pub(super) fn window(figure: &PathsFigure) -> Window {
    let mut limits = [[0.0, 1.0]; 2];
    for (axis, limits) in limits.iter_mut().enumerate() {
        *limits = axis_limits(figure, axis);
    }
    let leaves = |point: &[f64; 2]| {
        let beyond = |axis: usize| point[axis] < limits[axis][0] || point[axis] > limits[axis][1];
        point.iter().all(|v| v.is_finite()) && (beyond(0) || beyond(1))
    };
    let leaving = figure.bodies.iter();
    let leaving = leaving
        .filter(|body| body.tracks.iter().flatten().any(leaves))
        .count();
    let span = |axis: usize| limits[axis][1] - limits[axis][0];
    let turned = match figure.view {
        View::Above => span(1) > span(0),
        View::Side => false,
    };
    if turned {
        limits.reverse();
    }
    let down = match figure.view {
        View::Above => !turned,
        View::Side => false,
    };
    Window {
        limits,
        turned,
        down,
        leaving,
    }
}

/// The limits along one coordinate: all discs at both ends, all samples, the cushions.
fn axis_limits(figure: &PathsFigure, axis: usize) -> [f64; 2] {
    let mut samples: Vec<f64> = Vec::new();
    let mut discs: Vec<f64> = Vec::new();
    for body in &figure.bodies {
        let finite = |point: &&[f64; 2]| point.iter().all(|v| v.is_finite());
        let radius = if body.radius.is_finite() {
            body.radius.abs()
        } else {
            0.0
        };
        for track in &body.tracks {
            let track: Vec<f64> = track.iter().filter(finite).map(|p| p[axis]).collect();
            if let Some(start) = track.first() {
                discs.extend([start - radius, start + radius]);
            }
            if let Some(end) = track.last() {
                samples.extend([end - radius, end + radius]);
            }
            samples.extend(track);
        }
    }
    if let Some(half) = figure.cushions.map(|half| half[axis].abs()) {
        discs.extend([-half, half]);
    }
    samples.sort_by(f64::total_cmp);
    let everything = extent(&[&samples[..], &discs].concat()).unwrap_or([-1.0, 1.0]);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "a share of a length in memory"
    )]
    let skipped = (samples.len() as f64 * OUTLIERS) as usize;
    let middle = &samples[skipped..samples.len() - skipped];
    let core = extent(&[middle, &discs].concat()).unwrap_or(everything);
    let span = |limits: [f64; 2]| limits[1] - limits[0];
    let [low, high] = if span(everything) > FAR * span(core) && span(core) > 0.0 {
        core
    } else {
        everything
    };
    // Limits must differ, by more than rounding.
    let size = low.abs().max(high.abs());
    let pad = (0.04 * (high - low)).max(1e-9 * size);
    if pad > 1e-300 {
        [low - pad, high + pad]
    } else {
        [low - 1.0, high + 1.0]
    }
}

impl Window {
    /// Indices of the coordinates along the horizontal and the vertical axis.
    pub(super) fn axes(&self) -> [usize; 2] {
        if self.turned { [1, 0] } else { [0, 1] }
    }

    /// Pixels per unit when the window fills the frame as far as equal scales allow.
    pub(super) fn scale_in(&self, frame: &Frame) -> f64 {
        let [width, height] = self.spans();
        (frame.width() / width).min(frame.height() / height)
    }

    /// The same window, its shorter side widened so that it is no thin strip, and the
    /// part of the frame that it fills, at the upper left.
    pub(super) fn filling(&self, frame: &Frame) -> (Self, Frame) {
        let [width, height] = self.spans();
        let scale = self.scale_in(frame);
        let mut widened = *self;
        widened.limits[0] = grown(
            self.limits[0],
            (LEAST_RATIO * height).min(frame.width() / scale),
        );
        widened.limits[1] = grown(
            self.limits[1],
            (LEAST_RATIO * width).min(frame.height() / scale),
        );
        let [width, height] = widened.spans();
        let plot = Frame {
            right: frame.left + width * scale,
            bottom: frame.top + height * scale,
            ..*frame
        };
        (widened, plot)
    }

    /// Where a point of the plane lies on the canvas; `None` for what is not finite.
    pub(super) fn place(&self, point: [f64; 2], plot: &Frame) -> Option<Point> {
        let [across, up] = self.axes();
        let share = |value: f64, [low, high]: [f64; 2]| {
            value
                .is_finite()
                .then(|| (value.clamp(-1e300, 1e300) - low) / (high - low))
        };
        let x = share(point[across], self.limits[0])?;
        let y = share(point[up], self.limits[1])?;
        let y = if self.down { 1.0 - y } else { y };
        Some([plot.x(x), plot.y(y)])
    }

    fn spans(&self) -> [f64; 2] {
        self.limits.map(|[low, high]| high - low)
    }
}

/// Limits at least `least` apart, around the same centre.
fn grown(limits: [f64; 2], least: f64) -> [f64; 2] {
    let missing = (least - (limits[1] - limits[0])).max(0.0);
    [limits[0] - missing / 2.0, limits[1] + missing / 2.0]
}

#[cfg(test)]
mod tests {
    use super::super::paths_figure::{AxisLabel, PathBody};
    use super::*;

    const BOX: Frame = Frame {
        left: 0.0,
        top: 0.0,
        right: 1000.0,
        bottom: 500.0,
    };

    fn figure(view: View, tracks: Vec<Vec<[f64; 2]>>) -> PathsFigure {
        let body = |track| PathBody {
            name: String::new(),
            radius: 1.0,
            tracks: vec![track],
        };
        PathsFigure {
            title: String::new(),
            subtitle: String::new(),
            axes: [AxisLabel::new("x", "m"), AxisLabel::new("z", "m")],
            view,
            cushions: None,
            bodies: tracks.into_iter().map(body).collect(),
            voices: Vec::new(),
        }
    }

    #[test]
    fn from_above_the_longer_side_runs_horizontally_without_mirroring() {
        let long_z = figure(View::Above, vec![vec![[0.0, 0.0], [10.0, 90.0]]]);
        let (window, plot) = window(&long_z).filling(&BOX);
        let place = |p| window.place(p, &plot).unwrap();
        let origin = place([0.0, 0.0]);
        assert!(place([0.0, 90.0])[0] > origin[0], "z runs to the right");
        assert!(place([10.0, 0.0])[1] < origin[1], "x runs up");

        let long_x = figure(View::Above, vec![vec![[0.0, 0.0], [90.0, 10.0]]]);
        let (window, plot) = super::window(&long_x).filling(&BOX);
        let place = |p| window.place(p, &plot).unwrap();
        let origin = place([0.0, 0.0]);
        assert!(place([90.0, 0.0])[0] > origin[0], "x runs to the right");
        assert!(place([0.0, 10.0])[1] > origin[1], "z runs down");
    }

    #[test]
    fn from_the_side_the_second_axis_runs_up() {
        let fall = figure(View::Side, vec![vec![[0.0, 90.0], [0.0, 0.0]]]);
        let (window, plot) = window(&fall).filling(&BOX);
        let high = window.place([0.0, 90.0], &plot).unwrap();
        let low = window.place([0.0, 0.0], &plot).unwrap();
        assert!(high[1] < low[1] && (high[0] - low[0]).abs() < 1e-9);
    }

    #[test]
    fn both_axes_have_the_same_scale() {
        for view in [View::Above, View::Side] {
            let wide = figure(view, vec![vec![[0.0, 0.0], [30.0, 7.0], [12.0, -9.0]]]);
            let (window, plot) = window(&wide).filling(&BOX);
            let [width, height] = window.spans();
            let (across, up) = (plot.width() / width, plot.height() / height);
            assert!((across / up - 1.0).abs() < 1e-9, "{view:?}: {across} {up}");
            assert!(plot.right <= BOX.right + 1e-9 && plot.bottom <= BOX.bottom + 1e-9);
        }
    }

    #[test]
    fn a_single_runaway_does_not_shrink_the_rest_to_a_dot() {
        let mut tracks: Vec<Vec<[f64; 2]>> = (0..40)
            .map(|i| vec![[f64::from(i), 0.0], [f64::from(i), 20.0]])
            .collect();
        tracks[3][1] = [3.0, 1e9];
        let window = window(&figure(View::Above, tracks));
        assert_eq!(window.leaving, 1);
        assert!(
            window.limits.iter().all(|l| l[1] - l[0] < 60.0),
            "{window:?}"
        );
    }

    #[test]
    fn one_of_two_bodies_going_far_is_shown() {
        let far = (0..50).map(|i| [f64::from(i) * 1000.0, 0.0]).collect();
        let near = (0..50).map(|i| [f64::from(i), 0.0]).collect();
        let window = window(&figure(View::Above, vec![near, far]));
        assert_eq!(window.leaving, 0);
        assert!(window.limits[0][1] > 49_000.0);
    }
}
