//! The first event within a step, on the step's own polynomials.

use super::bernstein::{Fall, first_fall, polish};
use super::law::Law;
use super::noise::{Noise, Sign};
use super::scalar::{Real, Triple, dot, minus, size};
use super::series::Series;
use super::touch::{Surfaces, Touch};

/// Error of a polynomial's values in doubles, over its largest coefficient: some roundings for
/// each of up to fifty terms and halvings.
const NOISE: f64 = 200.0 * f64::ROUNDING;

/// A pair farther apart than so many sums of its radii is followed to where it has come so many
/// times nearer, and its impact found from there: the squared distance loses twice the digits of
/// the distance over the radii, at most twelve bits at a time.
const NEARER: f64 = 64.0;

/// What ends a step early.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Cause {
    /// Two surfaces meet with strict approach.
    Approach,
    /// A closed gap would close further, by a derivative above the first: the contact presses.
    Press,
    /// The force of a held contact falls through zero.
    Release,
    /// Small bodies that were far apart have come nearer: no event of the model.
    Nearer,
}

/// The first event within a step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Upcoming<T> {
    /// Time since the start of the step, in units of the series' tau.
    pub(super) at: T,
    pub(super) touch: Touch,
    pub(super) cause: Cause,
}

/// A gap that is closed at the step's start though nothing presses: its first coefficients are
/// zero up to rounding and are left out.
#[derive(Debug, Clone, Copy)]
pub(super) struct Fresh {
    pub(super) touch: Touch,
    /// 1: it opens with a speed; 2: with an acceleration; 3: with a jerk, after a release.
    pub(super) skip: usize,
}

/// The first event on `0 <= u <= span`; counts the surfaces looked at.
///
/// `fresh` gaps are closed and open from here on, `idle` ones are kept closed by held contacts.
pub(super) fn first_event<T: Real>(
    series: &Series<T>,
    (law, surfaces): (&Law<T>, &Surfaces<T>),
    span: f64,
    (fresh, idle): (&[Fresh], &[Touch]),
    looked_at: &mut u64,
) -> Option<Upcoming<T>> {
    let powers = powers::<T>(span, series.order());
    let travel = travel(series, &powers);
    let noise = Noise::over(series, law, &powers);
    let mut first: Option<Upcoming<T>> = None;
    let mut offer = |event: Option<(T, Cause)>, touch: Touch| {
        if let Some((at, cause)) = event
            && first.is_none_or(|first| at < first.at)
        {
            first = Some(Upcoming { at, touch, cause });
        }
    };
    for touch in surfaces.all() {
        *looked_at += 1;
        if out_of_reach(series, surfaces, touch, &travel)
            || series.held.iter().any(|held| held.touch == touch)
            || idle.contains(&touch)
        {
            continue;
        }
        let reach = watched_reach(series, surfaces, touch);
        let gap = gap_series(series, surfaces, touch, reach);
        let own = fresh.iter().find(|fresh| fresh.touch == touch);
        let fall = |gap: &[T], cause: Cause| {
            let at = fall_within(gap, span, &powers);
            at.map(|at| (at, cause))
        };
        let event = if own.is_none() && gap[0] > T::zero() {
            let is_near = reach <= surfaces.reach(touch);
            fall(
                &gap,
                if is_near {
                    Cause::Approach
                } else {
                    Cause::Nearer
                },
            )
        } else {
            // The first coefficients are 0 up to rounding, so that the root at the start is not
            // met again.
            let skip = own.map_or(1, |own| own.skip);
            match noise.of_gap(&gap, touch, surfaces, skip) {
                Sign::Positive(from) => fall(&gap[from..], Cause::Approach),
                Sign::Negative(1) => Some((T::zero(), Cause::Approach)),
                Sign::Negative(_) => Some((T::zero(), Cause::Press)),
                Sign::None => None,
            }
        };
        offer(event, touch);
    }
    for held in &series.held {
        let at = match noise.of_force(held) {
            Sign::Positive(from) => fall_within(&held.force[from..], span, &powers),
            Sign::Negative(_) => Some(T::zero()),
            Sign::None => None,
        };
        offer(at.map(|at| (at, Cause::Release)), held.touch);
    }
    first
}
/// Powers in the full arithmetic: a target that is small and far leaves no digit to lose.
fn powers<T: Real>(span: f64, order: usize) -> Vec<T> {
    let next = |power: &T| Some(power.times(span));
    std::iter::successors(Some(T::one()), next)
        .take(order + 1)
        .collect()
}

/// A bound on how far each body goes within the step.
fn travel<T: Real>(series: &Series<T>, powers: &[T]) -> Vec<f64> {
    let mut travel = vec![0.0; series.position[0].len()];
    for (coefficients, power) in series.position.iter().zip(powers).skip(1) {
        for (travel, coefficient) in travel.iter_mut().zip(coefficients) {
            *travel += size(coefficient) * power.to_f64();
        }
    }
    travel
}

/// Whether two surfaces cannot meet within the step; doubles will do, with a margin.
fn out_of_reach<T: Real>(
    series: &Series<T>,
    surfaces: &Surfaces<T>,
    touch: Touch,
    travel: &[f64],
) -> bool {
    let position = &series.position[0];
    match touch {
        Touch::Pair { a, b } => {
            let d = size(&minus(&position[b], &position[a]));
            d * (1.0 - 1e-9) - surfaces.reach(touch) > (travel[a] + travel[b]) * (1.0 + 1e-9)
        }
        Touch::Wall { body, wall } => {
            let (axis, side) = wall.axis_and_side();
            let gap =
                surfaces.half(wall) - surfaces.radii[body] - position[body][axis].to_f64() * side;
            gap - 1e-9 * surfaces.half(wall) > travel[body] * (1.0 + 1e-9)
        }
    }
}

/// The distance at which a pair is watched for: the sum of the radii, or more if that is small
/// and far.
fn watched_reach<T: Real>(series: &Series<T>, surfaces: &Surfaces<T>, touch: Touch) -> f64 {
    let reach = surfaces.reach(touch);
    match touch {
        Touch::Pair { a, b } => {
            let position = &series.position[0];
            let distance = size(&minus(&position[b], &position[a]));
            reach.max(distance / NEARER)
        }
        Touch::Wall { .. } => reach,
    }
}

/// The gap's polynomial in u; of a pair, of `d . d - reach²`.
fn gap_series<T: Real>(
    series: &Series<T>,
    surfaces: &Surfaces<T>,
    touch: Touch,
    reach: f64,
) -> Vec<T> {
    match touch {
        Touch::Pair { a, b } => {
            let d: Vec<Triple<T>> = series
                .position
                .iter()
                .map(|x| minus(&x[b], &x[a]))
                .collect();
            let mut gap = square(&d);
            let reach = if reach > surfaces.reach(touch) {
                T::from_f64(reach)
            } else {
                T::from_f64(surfaces.radii[a]) + T::from_f64(surfaces.radii[b])
            };
            gap[0] -= reach * reach;
            gap
        }
        Touch::Wall { body, wall } => {
            let (axis, side) = wall.axis_and_side();
            let mut gap: Vec<T> = series
                .position
                .iter()
                .map(|x| x[body][axis].times(-side))
                .collect();
            gap[0] = surfaces.gap(touch, &series.position[0]);
            gap
        }
    }
}

/// `d . d` of a polynomial, up to its own order; flights without forces but gravity end early.
fn square<T: Real>(d: &[Triple<T>]) -> Vec<T> {
    let is_there = |d: &Triple<T>| d.iter().any(|x| !x.is_zero());
    let last = d.iter().rposition(is_there).unwrap_or(0);
    let coefficient = |k: usize| {
        let (from, to) = (k.saturating_sub(last), k.min(last));
        (from..=to).fold(T::zero(), |sum, i| sum + dot(&d[i], &d[k - i]))
    };
    // A contact that has just opened leaves out the first three.
    let count = d.len().min((2 * last + 1).max(4));
    (0..count).map(coefficient).collect()
}

/// Where a polynomial in u falls through zero on `0 <= u <= span`.
fn fall_within<T: Real>(polynomial: &[T], span: f64, powers: &[T]) -> Option<T> {
    let scaled: Vec<T> = polynomial
        .iter()
        .zip(powers)
        .map(|(c, power)| *c * *power)
        .collect();
    let doubles: Vec<f64> = scaled.iter().map(|c| c.to_f64()).collect();
    let largest = doubles.iter().fold(0.0_f64, |most, c| most.max(c.abs()));
    let is_wide = T::ROUNDING < f64::ROUNDING;
    let noise = if is_wide { NOISE * largest } else { 0.0 };
    let fall = match first_fall(&doubles, noise) {
        Fall::Unclear => first_fall(&scaled, 0.0),
        clear => clear,
    };
    match fall {
        Fall::Within(low, high) => Some(polish(&scaled, (low, high)).times(span)),
        Fall::Never | Fall::Unclear => None,
    }
}
