//! All bodies at their last events, and what happens to them at the next.

use nalgebra::Vector3;

use super::grid::{Face, Grid};
use super::law::State;
use super::model::Model;
use crate::engine::exact::order::TieOrder;
use crate::physics::real::{Real, length};
use crate::recording::Wall;

/// With more bodies than this, cells save time.
const GRID_FROM: usize = 40;

/// A body at its last event; between events it is not touched.
///
/// In doubles it fills one line of the cache, and looking at a neighbour loads just that.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub(super) struct Ball<R: Real> {
    /// State at `epoch`.
    pub state: State<R>,
    /// Time of its last event, s.
    pub epoch: R,
    /// How often its flight has changed; plans made for another count are void.
    pub count: u32,
}

/// The last impact of a body with another one.
#[derive(Debug, Clone, Copy)]
struct Meeting<R> {
    partner: u32,
    count: u32,
    partner_count: u32,
    time: R,
}

/// What an impact came to.
#[derive(Debug, Clone, Copy)]
pub(super) struct Impact<R> {
    /// Size of the impulse.
    pub impulse: R,
    /// Speed of approach before it.
    pub approach: R,
}

/// All bodies of a scene on their flights.
#[derive(Debug, Clone)]
pub(super) struct World<R: Real> {
    /// What does not change.
    pub model: Model<R>,
    /// Order of simultaneous events.
    pub order: TieOrder,
    /// Events no farther apart are simultaneous, s.
    pub tie: R,
    /// Shape: `[body]`.
    pub balls: Vec<Ball<R>>,
    meetings: Vec<Meeting<R>>,
    /// Cells, if bodies are many.
    pub grid: Option<Grid<R>>,
    /// The present, s.
    pub now: R,
    /// Pairs looked at so far.
    pub pair_tests: u64,
}

impl<R: Real> World<R> {
    /// Puts all bodies on their flights at time `now`.
    pub fn new(model: Model<R>, order: TieOrder, states: &[State<R>], now: R) -> Self {
        let never = Meeting {
            partner: u32::MAX,
            count: 0,
            partner_count: 0,
            time: R::from_f64(f64::NEG_INFINITY),
        };
        let balls = states.iter().map(|state| Ball {
            state: *state,
            epoch: now,
            count: 0,
        });
        let grid = (model.contact.is_some() && states.len() > GRID_FROM).then(|| {
            let positions: Vec<_> = states.iter().map(|state| state.position).collect();
            let radius_max = model
                .fixed
                .iter()
                .fold(R::zero(), |most, body| most.larger(body.radius));
            Grid::new(&positions, radius_max)
        });
        Self {
            tie: model.tie,
            model,
            order,
            balls: balls.collect(),
            meetings: vec![never; states.len()],
            grid,
            now,
            pair_tests: 0,
        }
    }

    /// The state of a body at any time of its present flight.
    #[inline]
    pub fn state_at(&self, body: usize, time: R) -> State<R> {
        let ball = &self.balls[body];
        self.model
            .law
            .after(&ball.state, self.model.fixed[body].rate, time - ball.epoch)
    }

    /// The state of a body now.
    #[inline]
    pub fn state_now(&self, body: usize) -> State<R> {
        self.state_at(body, self.now)
    }

    /// Time until the end of the scene, with a little more.
    pub fn time_left(&self) -> R {
        (self.model.duration - self.now).larger(R::zero()) + self.model.near
    }

    /// Visits every body that this one might touch before either changes its cell.
    #[inline]
    pub fn for_each_partner(
        &self,
        body: usize,
        entered: Option<Face>,
        mut visit: impl FnMut(usize),
    ) {
        if self.model.contact.is_none() {
            return;
        }
        match &self.grid {
            Some(grid) => grid.for_each_near(body, entered, visit),
            None => (0..self.balls.len())
                .filter(|other| *other != body)
                .for_each(&mut visit),
        }
    }

    /// Whether the last thing that happened to either was their impact with each other.
    #[inline]
    pub fn have_just_met(&self, a: usize, b: usize) -> bool {
        let meeting = &self.meetings[a];
        meeting.partner as usize == b
            && meeting.count == self.balls[a].count
            && meeting.partner_count == self.balls[b].count
    }

    #[allow(clippy::cast_possible_truncation, reason = "fewer bodies than 2^32")]
    fn note_meeting(&mut self, a: usize, b: usize) {
        for (body, partner) in [(a, b), (b, a)] {
            self.meetings[body] = Meeting {
                partner: partner as u32,
                count: self.balls[body].count,
                partner_count: self.balls[partner].count,
                time: self.now,
            };
        }
    }

    /// Puts a body on a new flight from here and now.
    fn launch(&mut self, body: usize, state: State<R>) {
        let ball = &mut self.balls[body];
        ball.state = state;
        ball.epoch = self.now;
        ball.count = ball.count.wrapping_add(1);
    }

    /// An impact of two spheres, a < b; none without approach.
    ///
    /// Equation: `J = -(1 + e) v_r/(1/m_a + 1/m_b)` along the normal from b to a.
    /// Source: lecture, "충격량" (impulse).
    pub fn collide(&mut self, a: usize, b: usize) -> Option<Impact<R>> {
        let e = self.model.contact?;
        let (mut state_a, mut state_b) = (self.state_now(a), self.state_now(b));
        let normal = unit(&(state_a.position - state_b.position));
        let approach = (state_a.velocity - state_b.velocity).dot(&normal);
        let impact = (approach < R::zero()).then(|| {
            let [ma, mb] = [a, b].map(|body| self.model.fixed[body].mass);
            let j = -(R::one() + e) * approach / (R::one() / ma + R::one() / mb);
            state_a.velocity += normal * (j / ma);
            state_b.velocity -= normal * (j / mb);
            Impact {
                impulse: j,
                approach: -approach,
            }
        });
        self.launch(a, state_a);
        self.launch(b, state_b);
        self.note_meeting(a, b);
        impact
    }

    /// An impact on a wall, with the impulse `m (1 + e) |v_n|`; none without approach.
    pub fn bounce(&mut self, body: usize, wall: Wall) -> Option<Impact<R>> {
        let plane = *self.model.planes.iter().find(|plane| plane.wall == wall)?;
        let mut state = self.state_now(body);
        let speed = plane.side * state.velocity[plane.axis];
        let impact = (speed > R::zero()).then(|| {
            state.position[plane.axis] = plane.side * (plane.half - self.model.fixed[body].radius);
            state.velocity[plane.axis] = -(plane.side * self.model.cushion * speed);
            let mass = self.model.fixed[body].mass;
            Impact {
                impulse: mass * (R::one() + self.model.cushion) * speed,
                approach: speed,
            }
        });
        self.launch(body, state);
        impact
    }

    /// A stop. Gives its impulse `m |v|`, and the bodies that lose the rest of their approach.
    ///
    /// A partner that has just hit the body and still approaches would hit it again and again at
    /// this same instant, the body stopping each time; in the limit its approach is gone.
    pub fn stop(&mut self, body: usize, slowed: &mut Vec<usize>) -> R {
        let mut state = self.state_now(body);
        let speed = length(&state.velocity);
        state.velocity = Vector3::zeros();
        self.launch(body, state);
        slowed.clear();
        let since = self.now - self.tie;
        let met_now = |a: usize, b: usize| {
            self.meetings[a].partner as usize == b && self.meetings[a].time >= since
        };
        self.for_each_partner(body, None, |other| {
            if met_now(body, other) || met_now(other, body) {
                slowed.push(other);
            }
        });
        slowed.retain(|other| self.take_approach(*other, body));
        self.model.fixed[body].mass * speed
    }

    /// Takes from a body its velocity towards a resting one that it touches, if there is any.
    fn take_approach(&mut self, body: usize, resting: usize) -> bool {
        let mut state = self.state_now(body);
        let normal = unit(&(state.position - self.balls[resting].state.position));
        let approach = state.velocity.dot(&normal);
        if approach >= R::zero() {
            return false;
        }
        state.velocity -= normal * approach;
        self.launch(body, state);
        self.note_meeting(body, resting);
        true
    }
}

/// A vector of length 1 along another one; +x where that has no direction.
fn unit<R: Real>(v: &Vector3<R>) -> Vector3<R> {
    let size = length(v);
    if size > R::zero() {
        v / size
    } else {
        Vector3::x()
    }
}
