//! The lecture's steps once more, as plain as the slides, with a fault to be switched on: what
//! the checks must catch.

use carom::engine::{Simulation, StepGrid};
use carom::physics::{BodyState, SpringDamper, Vector3, length};
use carom::recording::{EventLog, Outcome, Work, initial_states};
use carom::scene::{Cushions, Scene};

/// A slip that people make in such a solver.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Fault {
    /// None: the lecture, bit for bit.
    None,
    /// J = -e v / (1/m + 1/m).
    DropsTheOneOfOnePlusE,
    /// The slides' vector formula: the whole relative velocity in place of its normal part.
    VectorFormulaOnObliqueHits,
    /// The impulse is divided by the mass of the other.
    SwapsTheMasses,
    /// Overlaps stay.
    SkipsThePushOut,
    /// Overlaps stay at walls.
    MirrorsOnlyTheVelocity,
    /// F = -2 k v.
    DoublesTheDrag,
    /// G m m / d.
    AttractsWithoutTheSquare,
    /// The damper acts with the other's sign.
    DampsTheWrongBody,
    /// Each wall is asked, not the first one only.
    ElseIfBecomesIf,
    /// Pairs from the last to the first.
    ContactsInAnotherOrder,
    /// The normal passes through single precision.
    SinglePrecisionNormal,
    /// Forces are not cleared.
    StaleForces,
    /// An impact of spheres that part already.
    HitsWhatParts,
    /// Positions move with the velocity before the kick.
    DriftsBeforeTheKick,
    /// Gravity acts on the weight twice: m m g.
    GravityTimesTheMassTwice,
    /// A spring pulls towards length 0.
    ForgetsTheRestLength,
    /// Rest is asked of the square of the speed.
    RestsByTheSquareOfTheSpeed,
    /// The second of two springs at a body is forgotten.
    ForgetsTheLastSpring,
}

impl Fault {
    /// All of them.
    pub const ALL: [Self; 18] = [
        Self::DropsTheOneOfOnePlusE,
        Self::VectorFormulaOnObliqueHits,
        Self::SwapsTheMasses,
        Self::SkipsThePushOut,
        Self::MirrorsOnlyTheVelocity,
        Self::DoublesTheDrag,
        Self::AttractsWithoutTheSquare,
        Self::DampsTheWrongBody,
        Self::ElseIfBecomesIf,
        Self::ContactsInAnotherOrder,
        Self::SinglePrecisionNormal,
        Self::StaleForces,
        Self::HitsWhatParts,
        Self::DriftsBeforeTheKick,
        Self::GravityTimesTheMassTwice,
        Self::ForgetsTheRestLength,
        Self::RestsByTheSquareOfTheSpeed,
        Self::ForgetsTheLastSpring,
    ];

    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::None => "none",
            Self::DropsTheOneOfOnePlusE => "drops the 1 of 1 + e",
            Self::VectorFormulaOnObliqueHits => "the slides' vector formula on oblique hits",
            Self::SwapsTheMasses => "swaps the masses",
            Self::SkipsThePushOut => "skips the push-out",
            Self::MirrorsOnlyTheVelocity => "mirrors only the velocity at cushions",
            Self::DoublesTheDrag => "doubles the drag",
            Self::AttractsWithoutTheSquare => "attracts without the square",
            Self::DampsTheWrongBody => "damper on the wrong body",
            Self::ElseIfBecomesIf => "else-if becomes if in the cushions",
            Self::ContactsInAnotherOrder => "contacts in another order",
            Self::SinglePrecisionNormal => "single precision in the normal",
            Self::StaleForces => "forces are not cleared",
            Self::HitsWhatParts => "hits spheres that part already",
            Self::DriftsBeforeTheKick => "drifts before the kick",
            Self::GravityTimesTheMassTwice => "gravity times the mass twice",
            Self::ForgetsTheRestLength => "forgets the rest length",
            Self::RestsByTheSquareOfTheSpeed => "rests by the square of the speed",
            Self::ForgetsTheLastSpring => "forgets the last spring",
        }
    }
}

struct Ball {
    mass: f64,
    radius: f64,
    x: Vector3,
    v: Vector3,
    force: Vector3,
}

/// The lecture's solver with a fault.
pub struct Faulty {
    fault: Fault,
    scene: Scene,
    springs: Vec<SpringDamper>,
    balls: Vec<Ball>,
    grid: StepGrid,
    sample: usize,
}

impl Faulty {
    pub fn new(fault: Fault, scene: &Scene, grid: StepGrid) -> Self {
        let states = initial_states(scene);
        let ball = |(body, state): (&carom::scene::Body, BodyState)| Ball {
            mass: body.mass,
            radius: body.radius,
            x: state.position,
            v: state.velocity,
            force: Vector3::zeros(),
        };
        Self {
            fault,
            springs: SpringDamper::all(scene),
            balls: scene.bodies.iter().zip(states).map(ball).collect(),
            scene: scene.clone(),
            grid,
            sample: 0,
        }
    }

    fn pairs(&self) -> Vec<(usize, usize)> {
        let count = self.balls.len();
        (0..count)
            .flat_map(|i| (i + 1..count).map(move |j| (i, j)))
            .collect()
    }

    fn step(&mut self, dt: f64) {
        self.sum_forces();
        self.integrate(dt);
        if let Some(rest) = self.scene.effects.rest {
            let squared = self.fault == Fault::RestsByTheSquareOfTheSpeed;
            for ball in &mut self.balls {
                let speed = length(&ball.v);
                let measure = if squared { speed * speed } else { speed };
                if measure < rest.speed {
                    ball.v = Vector3::zeros();
                }
            }
        }
        if let Some(cushions) = self.scene.effects.cushions {
            for ball in &mut self.balls {
                bounce(ball, &cushions, self.fault);
            }
        }
        if let Some(contact) = self.scene.effects.contact {
            let mut pairs = self.pairs();
            if self.fault == Fault::ContactsInAnotherOrder {
                pairs.reverse();
            }
            for (i, j) in pairs {
                let (head, tail) = self.balls.split_at_mut(j);
                collide(&mut head[i], &mut tail[0], contact.restitution, self.fault);
            }
        }
    }

    fn sum_forces(&mut self) {
        let effects = &self.scene.effects;
        if self.fault != Fault::StaleForces {
            for ball in &mut self.balls {
                ball.force = Vector3::zeros();
            }
        }
        if let Some(attraction) = effects.attraction {
            for (i, j) in self.pairs() {
                let apart = self.balls[j].x - self.balls[i].x;
                let d = length(&apart);
                let square = if self.fault == Fault::AttractsWithoutTheSquare {
                    d
                } else {
                    d * d
                };
                let masses = attraction.constant * self.balls[i].mass * self.balls[j].mass;
                let force = apart / d * (masses / square);
                self.balls[i].force += force;
                self.balls[j].force += -force;
            }
        }
        if let Some(drag) = effects.drag {
            let times = if self.fault == Fault::DoublesTheDrag {
                2.0
            } else {
                1.0
            };
            for ball in &mut self.balls {
                ball.force += ball.v * (-drag.coefficient * times);
            }
        }
        let forgotten = usize::from(self.fault == Fault::ForgetsTheLastSpring);
        let springs = &self.springs[..self.springs.len().saturating_sub(forgotten)];
        for spring in springs {
            let [a, b] = spring.ends;
            let apart = self.balls[b].x - self.balls[a].x;
            let l = length(&apart);
            let rest = if self.fault == Fault::ForgetsTheRestLength {
                0.0
            } else {
                spring.rest_length
            };
            let mut damper = (self.balls[b].v - self.balls[a].v) * spring.damping;
            if self.fault == Fault::DampsTheWrongBody {
                damper = -damper;
            }
            let force = apart / l * (spring.stiffness * (l - rest)) + damper;
            self.balls[a].force += force;
            self.balls[b].force += -force;
        }
        if let Some(gravity) = effects.gravity {
            let acceleration: Vector3 = gravity.acceleration.into();
            for ball in &mut self.balls {
                let mass = if self.fault == Fault::GravityTimesTheMassTwice {
                    ball.mass * ball.mass
                } else {
                    ball.mass
                };
                ball.force += acceleration * mass;
            }
        }
    }

    fn integrate(&mut self, dt: f64) {
        for ball in &mut self.balls {
            let before = ball.v;
            ball.v += ball.force * (1.0 / ball.mass) * dt;
            let moving = if self.fault == Fault::DriftsBeforeTheKick {
                before
            } else {
                ball.v
            };
            ball.x += moving * dt;
        }
    }
}

/// Two spheres at the end of a step.
fn collide(a: &mut Ball, b: &mut Ball, e: f64, fault: Fault) {
    let apart = a.x - b.x;
    let distance = length(&apart);
    if distance >= a.radius + b.radius {
        return;
    }
    let mut n = apart / distance;
    if fault == Fault::SinglePrecisionNormal {
        #[allow(clippy::cast_possible_truncation, reason = "the fault")]
        let single = |component: f64| f64::from(component as f32);
        n = n.map(single);
    }
    let (v1n, v2n) = (a.v.dot(&n), b.v.dot(&n));
    let vr = v1n - v2n;
    if vr < 0.0 || fault == Fault::HitsWhatParts {
        let one = if fault == Fault::DropsTheOneOfOnePlusE {
            0.0
        } else {
            1.0
        };
        let j = -vr * (e + one) / (1.0 / a.mass + 1.0 / b.mass);
        let (m1, m2) = if fault == Fault::SwapsTheMasses {
            (b.mass, a.mass)
        } else {
            (a.mass, b.mass)
        };
        if fault == Fault::VectorFormulaOnObliqueHits {
            // v1' = ((m1 - e m2) v1 + (1 + e) m2 v2) / (m1 + m2), with whole vectors.
            let total = a.mass + b.mass;
            let (v1, v2) = (a.v, b.v);
            a.v = (v1 * (a.mass - e * b.mass) + v2 * ((1.0 + e) * b.mass)) / total;
            b.v = (v2 * (b.mass - e * a.mass) + v1 * ((1.0 + e) * a.mass)) / total;
        } else {
            a.v = a.v - n * v1n + n * (v1n + j / m1);
            b.v = b.v - n * v2n + n * (v2n - j / m2);
        }
    }
    if fault != Fault::SkipsThePushOut {
        let push = n * (0.5 * (1.0 + e) * (a.radius + b.radius - distance));
        a.x += push;
        b.x -= push;
    }
}

/// The chain of walls.
fn bounce(ball: &mut Ball, cushions: &Cushions, fault: Fault) {
    let half = cushions.half_extents();
    let e = cushions.restitution;
    let axes: &[usize] = if cushions.half_height.is_some() {
        &[0, 2, 1]
    } else {
        &[0, 2]
    };
    for (axis, side) in axes.iter().flat_map(|axis| [(*axis, 1.0), (*axis, -1.0)]) {
        let r = ball.radius;
        let depth = if side > 0.0 {
            ball.x[axis] + r - half[axis]
        } else {
            -half[axis] - ball.x[axis] + r
        };
        let overlaps = if side > 0.0 {
            ball.x[axis] + r > half[axis]
        } else {
            ball.x[axis] - r < -half[axis]
        };
        if !overlaps {
            continue;
        }
        let normal = -side;
        let vn = ball.v[axis] * normal;
        if vn < 0.0 {
            ball.v[axis] -= (1.0 + e) * vn * normal;
        }
        if fault != Fault::MirrorsOnlyTheVelocity {
            ball.x[axis] += (1.0 + e) * depth * normal;
        }
        if fault != Fault::ElseIfBecomesIf {
            return;
        }
    }
}

impl Simulation for Faulty {
    fn advance_to(&mut self, sample: usize, _log: Option<&mut EventLog>) -> Option<Outcome> {
        while self.sample < sample {
            for _ in 0..self.grid.steps_per_sample {
                self.step(self.grid.step);
            }
            self.sample += 1;
        }
        None
    }

    fn state_into(&self, into: &mut [BodyState]) {
        for (state, ball) in into.iter_mut().zip(&self.balls) {
            (state.position, state.velocity) = (ball.x, ball.v);
        }
    }

    fn set_state(&mut self, sample: usize, states: &[BodyState]) {
        self.sample = sample;
        for (state, ball) in states.iter().zip(&mut self.balls) {
            (ball.x, ball.v) = (state.position, state.velocity);
        }
    }

    fn work(&self) -> Work {
        Work::default()
    }
}
