//! How far rounding may have moved the coefficients of a series.
//!
//! A contact presses or opens by the first derivative that is not 0. What is 0 in the model comes
//! out as rounding of the forces that cancel in it: a derivative counts from there on alone.

use std::cell::OnceCell;

use super::law::Law;
use super::scalar::{Real, dot, minus, size};
use super::series::{Held, Series, contact_matrix};
use super::touch::{Surfaces, Touch};

/// Roundings that may have come together in a coefficient of a force.
///
/// A coefficient of a link's force is a sum of up to fifty products, each of two factors with two
/// roundings of their own, and one more for the product and for the sum: 50 x 4 are 200.
const ROUNDINGS: f64 = 256.0;

/// Rate of a gap below which it neither opens nor closes: so many roundings of the largest speed.
///
/// Half of what an instant takes for none ([`resolve`](super::impacts::Instant::resolve)), so that
/// a contact that it lets open with a speed is seen to open.
const ROUNDINGS_OF_RATE: f64 = 32.0;

/// What the first coefficient that is not 0 within its error says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Sign {
    /// Positive from that coefficient on.
    Positive(usize),
    /// Negative, by that coefficient.
    Negative(usize),
    /// All coefficients are within their errors.
    None,
}

/// Errors of the coefficients of a series over a span.
pub(super) struct Noise<'a, T: Real> {
    series: &'a Series<T>,
    law: &'a Law<T>,
    /// Length of the span, s, and in units of the series' tau.
    span: f64,
    powers: Vec<f64>,
    fastest: f64,
    /// Error of the accelerations at the start. Shape: `[body]`.
    start: OnceCell<Vec<f64>>,
    /// Error of the accelerations, the largest up to each coefficient. Shape: `[coefficient][body]`.
    later: OnceCell<Vec<Vec<f64>>>,
}

impl<'a, T: Real> Noise<'a, T> {
    /// Of a series over so many of its tau.
    pub(super) fn over(series: &'a Series<T>, law: &'a Law<T>, powers: &[T]) -> Self {
        let fastest = series.velocity[0].iter().map(size).fold(0.0, f64::max);
        let powers: Vec<f64> = powers.iter().map(|power| power.to_f64()).collect();
        Self {
            series,
            law,
            span: powers.get(1).map_or(0.0, |span| span * series.tau),
            powers,
            fastest,
            start: OnceCell::new(),
            later: OnceCell::new(),
        }
    }

    /// What a gap that is closed does next, by its coefficients from `skip` on.
    ///
    /// `gap` is the polynomial of the gap, of a pair that of its squared distance.
    pub(super) fn of_gap(
        &self,
        gap: &[T],
        touch: Touch,
        surfaces: &Surfaces<T>,
        skip: usize,
    ) -> Sign {
        let twice = match touch {
            Touch::Pair { .. } => 2.0 * surfaces.reach(touch),
            Touch::Wall { .. } => 1.0,
        };
        let rate = ROUNDINGS_OF_RATE * T::ROUNDING * self.fastest * twice * self.span;
        for (k, coefficient) in gap.iter().enumerate().skip(skip.max(1)) {
            let error = match k {
                1 => rate,
                _ => self.of_gaps_coefficient(touch, twice, k),
            };
            let value = coefficient.to_f64() * self.powers[k];
            if value > error {
                return Sign::Positive(k);
            }
            if value < -error {
                return Sign::Negative(k);
            }
        }
        Sign::None
    }

    /// Equation: the k-th coefficient of a path is the (k-2)-th of its acceleration times
    /// `tau²/(k (k-1))`; errors of earlier ones come in through the forces, hence the largest.
    fn of_gaps_coefficient(&self, touch: Touch, twice: f64, k: usize) -> f64 {
        let bodies = touch.bodies();
        let of = |body: usize| self.up_to(k - 2)[body];
        let acceleration = of(bodies[0]).max(of(bodies[1]));
        let products = match touch {
            Touch::Pair { a, b } => {
                let x = &self.series.position;
                let length = |j: usize| size(&minus(&x[j][b], &x[j][a])) * self.powers[j];
                let products = (1..k).map(|j| length(j) * length(k - j));
                ROUNDINGS * T::ROUNDING * products.sum::<f64>()
            }
            Touch::Wall { .. } => 0.0,
        };
        twice * acceleration * self.span * self.span + products
    }

    /// Whether a held contact presses, by the series of its force.
    pub(super) fn of_force(&self, held: &Held<T>) -> Sign {
        let own = contact_matrix(&self.law.inverse_mass, &held.arms, &held.arms).to_f64();
        let error = |of: &[f64]| {
            let errors = held.arms.iter().map(|(body, push)| size(push) * of[*body]);
            errors.sum::<f64>() / own
        };
        for (k, force) in held.force.iter().enumerate() {
            let error = if k == 0 {
                error(self.at_start())
            } else {
                error(self.up_to(k))
            };
            let value = force.to_f64() * self.powers[k];
            if value > error {
                return Sign::Positive(k);
            }
            if value < -error {
                return Sign::Negative(k);
            }
        }
        Sign::None
    }

    fn at_start(&self) -> &[f64] {
        self.start.get_or_init(|| self.accelerations(0))
    }

    fn up_to(&self, k: usize) -> &[f64] {
        let all = self.later.get_or_init(|| {
            let mut all: Vec<Vec<f64>> = Vec::with_capacity(self.series.acceleration.len());
            for k in 0..self.series.acceleration.len() {
                let mut own = self.accelerations(k);
                if let Some(before) = all.last() {
                    for (own, before) in own.iter_mut().zip(before) {
                        *own = own.max(*before);
                    }
                }
                all.push(own);
            }
            all
        });
        &all[k.min(all.len() - 1)]
    }

    /// Errors of coefficient k of the accelerations, at the span's end.
    ///
    /// Equation: a rounding of each term that enters, before they cancel; a coordinate counts from
    /// the origin, as it is rounded there.
    fn accelerations(&self, k: usize) -> Vec<f64> {
        let Series {
            position,
            velocity,
            held,
            ..
        } = self.series;
        let inverse_mass = &self.law.inverse_mass;
        let mut sizes = vec![0.0; position[0].len()];
        let length = |[a, b]: [usize; 2], j: usize| {
            if j == 0 {
                size(&position[0][a]) + size(&position[0][b])
            } else {
                size(&minus(&position[j][b], &position[j][a]))
            }
        };
        let mut add = |body: usize, force: f64| sizes[body] += force * inverse_mass[body].to_f64();
        for (link, power) in self.law.links.iter().zip(self.series.powers()) {
            let products = (0..=k).map(|j| power[j].to_f64().abs() * length(link.ends, k - j));
            let mut force =
                link.offset.to_f64().abs() * length(link.ends, k) + products.sum::<f64>();
            if let Some(damping) = link.damping {
                let speeds = link.ends.map(|body| size(&velocity[k][body]));
                force += damping.to_f64() * (speeds[0] + speeds[1]);
            }
            add(link.ends[0], force);
            add(link.ends[1], force);
        }
        for held in held {
            match held.touch {
                Touch::Pair { a, b } => {
                    let products =
                        (0..=k).map(|j| held.force[k - j].to_f64().abs() * length([a, b], j));
                    let force = products.sum::<f64>();
                    add(a, force);
                    add(b, force);
                }
                Touch::Wall { body, .. } => add(body, held.force[k].to_f64().abs()),
            }
        }
        let drag = self.law.drag.map_or(0.0, Real::to_f64);
        for (body, velocity) in velocity[k].iter().enumerate() {
            add(body, drag * size(velocity));
        }
        if k == 0 {
            let gravity = dot(&self.law.gravity, &self.law.gravity).to_f64().sqrt();
            for size in &mut sizes {
                *size += gravity;
            }
        }
        let share = ROUNDINGS * T::ROUNDING * self.powers[k];
        sizes.into_iter().map(|size| size * share).collect()
    }
}
