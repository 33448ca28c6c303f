//! Taylor series of the motion, by recurrences through the force law.
//!
//! With `u = (t - t0)/tau`, every quantity is a polynomial in u. From the coefficients of x and
//! v up to order k follow those of the squared distance s = d.d (a convolution), of its power
//! q = s^p (from `s q' = p s' q`), of the force q d, and so the next ones of v and x. The
//! scaling by tau, a power of two near the step, keeps all coefficients near the size of the
//! quantity itself, whatever the stiffness.
//!
//! Source: Jorba and Zou 2005, "A software package for the numerical integration of ODEs by
//! means of high-order Taylor methods"; Moore 1966.

use super::law::{Law, Link};
use super::scalar::{Real, Triple, add_scaled, dot, minus};
use super::touch::{Arms, Touch, arms};
use crate::physics::cholesky::Cholesky;

/// The series of one link.
#[derive(Debug, Clone)]
struct LinkSeries<T> {
    distance: Vec<Triple<T>>,
    squared: Vec<T>,
    power: Vec<T>,
}

impl<T: Real> LinkSeries<T> {
    fn with_order(order: usize) -> Self {
        Self {
            distance: Vec::with_capacity(order),
            squared: Vec::with_capacity(order),
            power: Vec::with_capacity(order),
        }
    }

    /// Takes the next coefficient of d; gives that of `(offset + scale s^power) d`.
    fn extend(&mut self, link: &Link<T>, d: Triple<T>) -> Triple<T> {
        let k = self.distance.len();
        self.distance.push(d);
        let mut squared = self_convolution(&self.distance);
        if k == 0 {
            squared += link.softening_squared;
        }
        self.squared.push(squared);
        let power = self.next_power(link);
        self.power.push(power);
        let mut force = [T::zero(); 3];
        let factors = self.power.iter().zip(self.distance.iter().rev());
        // The leading factor carries the offset; with it a spring near rest cancels once.
        add_scaled(&mut force, self.power[0] + link.offset, &d);
        for (factor, d) in factors.skip(1) {
            add_scaled(&mut force, *factor, d);
        }
        force
    }

    /// Equation: `q_k = 1/(k s_0) sum_{j<k} (p (k - j) - j) s_{k-j} q_j`.
    fn next_power(&self, link: &Link<T>) -> T {
        let (s, q) = (&self.squared, &self.power);
        let k = q.len();
        if k == 0 {
            return link.scaled_power(s[0]);
        }
        let order = as_real(k);
        let mut sum = T::zero();
        let mut weight = link.power * order;
        for (s, q) in s[1..=k].iter().rev().zip(q) {
            sum += (*s * *q).times(weight);
            weight -= link.power + 1.0;
        }
        sum / s[0].times(order)
    }
}

/// Coefficient k of `d . d` from coefficients 0..=k of d.
fn self_convolution<T: Real>(d: &[Triple<T>]) -> T {
    let k = d.len() - 1;
    let half = d.len() / 2;
    let mut sum = [T::zero(); 3];
    for (a, b) in d[..half].iter().zip(d.iter().rev()) {
        for axis in 0..3 {
            sum[axis] += a[axis] * b[axis];
        }
    }
    let twice = (sum[0] + sum[1] + sum[2]).times(2.0);
    if k.is_multiple_of(2) {
        twice + dot(&d[half], &d[half])
    } else {
        twice
    }
}

#[allow(clippy::cast_precision_loss, reason = "orders are below a hundred")]
pub(super) fn as_real(k: usize) -> f64 {
    k as f64
}

/// A contact that is kept, and the series of its force.
#[derive(Debug, Clone)]
pub(super) struct Held<T> {
    pub(super) touch: Touch,
    /// Force over the length of the direction it acts along; non-negative while it presses.
    pub(super) force: Vec<T>,
    pub(super) arms: Arms<T>,
}

/// The series of all bodies.
#[derive(Debug, Clone)]
pub(super) struct Series<T> {
    /// Scale of time, s.
    pub(super) tau: f64,
    /// Shape: `[coefficient][body]`, order + 1 coefficients.
    pub(super) position: Vec<Vec<Triple<T>>>,
    /// Shape: `[coefficient][body]`, order + 1 coefficients.
    pub(super) velocity: Vec<Vec<Triple<T>>>,
    /// Shape: `[coefficient][body]`, order coefficients.
    pub(super) acceleration: Vec<Vec<Triple<T>>>,
    pub(super) held: Vec<Held<T>>,
    links: Vec<LinkSeries<T>>,
}

impl<T: Real> Series<T> {
    /// The motion at a state, with no power of time yet.
    ///
    /// `held` contacts are kept closed by forces that make their gaps' accelerations vanish at
    /// every order. `tau` is the scale of time, `order` what will be asked for.
    pub(super) fn at(
        law: &Law<T>,
        start: (Vec<Triple<T>>, Vec<Triple<T>>),
        held: &[Touch],
        (order, tau): (usize, f64),
    ) -> Self {
        let (position, velocity) = start;
        let held = held.iter().map(|touch| Held {
            touch: *touch,
            force: Vec::with_capacity(order),
            arms: arms(*touch, &position),
        });
        Self {
            tau,
            held: held.collect(),
            position: vec![position],
            velocity: vec![velocity],
            acceleration: Vec::with_capacity(order),
            links: law
                .links
                .iter()
                .map(|_| LinkSeries::with_order(order))
                .collect(),
        }
    }

    /// Goes on to that order; `factor` is the [matrix of contacts](contact_matrix).
    pub(super) fn extend(&mut self, law: &Law<T>, factor: &Cholesky<T>, order: usize) {
        for k in self.order()..order {
            let mut acceleration = self.applied(law, k);
            self.hold(law, factor, &mut acceleration, k);
            let step = T::from_f64(self.tau) / T::from_f64(as_real(k + 1));
            let next = |of: &[Triple<T>]| of.iter().map(|x| x.map(|x| x * step)).collect();
            let velocity = next(&acceleration);
            let position = next(&self.velocity[k]);
            self.acceleration.push(acceleration);
            self.velocity.push(velocity);
            self.position.push(position);
        }
    }

    /// Coefficient k of the accelerations without contact forces.
    fn applied(&mut self, law: &Law<T>, k: usize) -> Vec<Triple<T>> {
        let (position, velocity) = (&self.position[k], &self.velocity[k]);
        let mut acceleration = vec![[T::zero(); 3]; position.len()];
        for (link, series) in law.links.iter().zip(&mut self.links) {
            let [a, b] = link.ends;
            let mut force = series.extend(link, minus(&position[b], &position[a]));
            if let Some(damping) = link.damping {
                add_scaled(&mut force, damping, &minus(&velocity[b], &velocity[a]));
            }
            add_scaled(&mut acceleration[a], law.inverse_mass[a], &force);
            add_scaled(&mut acceleration[b], -law.inverse_mass[b], &force);
        }
        law.add_drag(velocity, &mut acceleration);
        if k == 0 {
            law.add_gravity(&mut acceleration);
        }
        acceleration
    }

    /// Adds the forces that keep the held contacts closed.
    ///
    /// Equation, pairs: `d . d'' + d' . d' = 0`, order by order: the unknown force coefficient
    /// multiplies `d_0` alone, so that one matrix serves every order. Walls: `n . x'' = 0`.
    fn hold(&mut self, law: &Law<T>, factor: &Cholesky<T>, now: &mut [Triple<T>], k: usize) {
        if self.held.is_empty() {
            return;
        }
        let mut right = Vec::with_capacity(self.held.len());
        for held in &self.held {
            let Touch::Pair { a, b } = held.touch else {
                continue;
            };
            let mut push = [T::zero(); 3];
            for j in 1..=k {
                let d = minus(&self.position[j][b], &self.position[j][a]);
                add_scaled(&mut push, held.force[k - j], &d);
            }
            add_scaled(&mut now[b], law.inverse_mass[b], &push);
            add_scaled(&mut now[a], -law.inverse_mass[a], &push);
        }
        for held in &self.held {
            let own = held.arms.rate(now);
            let known = match held.touch {
                Touch::Pair { a, b } => self.known(a, b, k),
                Touch::Wall { .. } => T::zero(),
            };
            right.push(-(own + known));
        }
        factor.solve(&mut right);
        for (held, force) in self.held.iter_mut().zip(right) {
            held.arms.push(force, &law.inverse_mass, now);
            held.force.push(force);
        }
    }

    /// `sum_{j<=k} w_j . w_{k-j} + sum_{1<=j<=k} d_j . (a_b - a_a)_{k-j}`, w the relative velocity.
    fn known(&self, a: usize, b: usize, k: usize) -> T {
        let between = |of: &[Vec<Triple<T>>], j: usize| minus(&of[j][b], &of[j][a]);
        let mut sum = T::zero();
        for j in 0..=k {
            let [one, other] = [j, k - j].map(|j| between(&self.velocity, j));
            sum += dot(&one, &other);
            if j > 0 {
                let d = between(&self.position, j);
                sum += dot(&d, &between(&self.acceleration, k - j));
            }
        }
        sum
    }

    /// The series of each link's power of the distance, in the order of the law's links.
    pub(super) fn powers(&self) -> impl Iterator<Item = &[T]> {
        self.links.iter().map(|link| link.power.as_slice())
    }

    /// The order: the highest power of the positions.
    pub(super) fn order(&self) -> usize {
        self.position.len() - 1
    }

    /// Whether every coefficient is finite.
    pub(super) fn is_finite(&self) -> bool {
        let last = [self.position.last(), self.velocity.last()];
        let mut all = last.into_iter().flatten().flatten().flatten();
        all.all(|coefficient| coefficient.is_finite())
    }

    /// Change of a quantity since the start of the series, per body, at time `u tau`.
    pub(super) fn change(of: &[Vec<Triple<T>>], u: T) -> Vec<Triple<T>> {
        let Some((last, rest)) = of.split_last() else {
            return Vec::new();
        };
        let mut sum = last.clone();
        for coefficients in rest.iter().skip(1).rev() {
            for (sum, coefficient) in sum.iter_mut().zip(coefficients) {
                for axis in 0..3 {
                    sum[axis] = coefficient[axis] + u * sum[axis];
                }
            }
        }
        for triple in &mut sum {
            *triple = triple.map(|x| x * u);
        }
        sum
    }
}

/// Entry of the matrix of contacts: what a push at one does to the rate of the other.
///
/// Equation: `A = N M⁻¹ Nᵀ`, the rows of N being the contacts' directions per body.
pub(super) fn contact_matrix<T: Real>(inverse_mass: &[T], one: &Arms<T>, other: &Arms<T>) -> T {
    let mut sum = T::zero();
    for (body, push) in one.iter() {
        for (same, push_other) in other.iter() {
            if body == same {
                sum += dot(push, push_other) * inverse_mass[*body];
            }
        }
    }
    sum
}
