//! Surfaces that can touch: pairs of spheres, spheres and walls; their gaps and normals.

use super::scalar::{Real, Triple, dot, minus};
use crate::recording::{EventKind, Wall};
use crate::scene::Scene;

/// Two surfaces that can touch, in the model's order at one instant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Touch {
    /// Two spheres, `a < b`.
    Pair { a: usize, b: usize },
    /// A sphere and a wall.
    Wall { body: usize, wall: Wall },
}

impl Touch {
    pub(super) fn event(self) -> EventKind {
        match self {
            Self::Pair { a, b } => EventKind::Contact { a, b },
            Self::Wall { body, wall } => EventKind::Cushion { body, wall },
        }
    }

    /// The two bodies, the same one twice at a wall.
    pub(super) fn bodies(self) -> [usize; 2] {
        match self {
            Self::Pair { a, b } => [a, b],
            Self::Wall { body, .. } => [body; 2],
        }
    }
}

/// Where a push between two surfaces acts: on each body along a direction.
///
/// A pair's direction is `d = x_b - x_a` on b and -d on a, of length `r_a + r_b`; a wall's is its
/// inward normal. The same numbers times the bodies' velocities give the rate of the gap.
#[derive(Debug, Clone, Copy)]
pub(super) struct Arms<T> {
    pub(super) pushes: [(usize, Triple<T>); 2],
    /// 2 for a pair, 1 at a wall.
    pub(super) count: usize,
}

impl<T: Real> Arms<T> {
    pub(super) fn iter(&self) -> impl Iterator<Item = &(usize, Triple<T>)> {
        self.pushes[..self.count].iter()
    }

    /// Rate of separation that vectors per body give, times the length of the direction.
    pub(super) fn rate(&self, vectors: &[Triple<T>]) -> T {
        self.iter().fold(T::zero(), |sum, (body, push)| {
            sum + dot(push, &vectors[*body])
        })
    }

    /// Adds a push of that size, over the masses, to vectors per body.
    pub(super) fn push(&self, size: T, inverse_mass: &[T], vectors: &mut [Triple<T>]) {
        for (body, push) in self.iter() {
            super::scalar::add_scaled(&mut vectors[*body], size * inverse_mass[*body], push);
        }
    }
}

/// The surfaces of a scene.
#[derive(Debug, Clone)]
pub(super) struct Surfaces<T> {
    pub(super) radii: Vec<f64>,
    /// Restitution of contacts, if spheres collide.
    pub(super) contact: Option<T>,
    /// Restitution of cushions and the walls with their distances, if there are any.
    pub(super) cushions: Option<(T, Vec<(Wall, f64)>)>,
}

impl<T: Real> Surfaces<T> {
    pub(super) fn of(scene: &Scene) -> Self {
        let effects = &scene.effects;
        let walls = effects.cushions.map(|box_| {
            let half = [
                Some(box_.half_width),
                box_.half_height,
                Some(box_.half_length),
            ];
            let wall = |wall: Wall| half[wall.axis_and_side().0].map(|half| (wall, half));
            let walls = Wall::ALL.into_iter().filter_map(wall).collect();
            (T::from_f64(box_.restitution), walls)
        });
        Self {
            radii: scene.bodies.iter().map(|body| body.radius).collect(),
            contact: effects
                .contact
                .map(|contact| T::from_f64(contact.restitution)),
            cushions: walls,
        }
    }

    /// The restitution of a touch.
    pub(super) fn restitution(&self, touch: Touch) -> T {
        let own = match touch {
            Touch::Pair { .. } => self.contact,
            Touch::Wall { .. } => self.cushions.as_ref().map(|(e, _)| *e),
        };
        own.unwrap_or_else(T::zero)
    }

    /// Sum of the radii of a pair; 1 at a wall, whose direction has that length.
    pub(super) fn reach(&self, touch: Touch) -> f64 {
        match touch {
            Touch::Pair { a, b } => self.radii[a] + self.radii[b],
            Touch::Wall { .. } => 1.0,
        }
    }

    /// Every pair and wall that can be hit.
    pub(super) fn all(&self) -> impl Iterator<Item = Touch> {
        let count = self.radii.len();
        let last = if self.contact.is_some() { count } else { 0 };
        let pairs = (0..last).flat_map(move |a| (a + 1..count).map(move |b| Touch::Pair { a, b }));
        let walls = (0..count).flat_map(|body| {
            let walls = self.cushions.iter().flat_map(|(_, walls)| walls);
            walls.map(move |(wall, _)| Touch::Wall { body, wall: *wall })
        });
        pairs.chain(walls)
    }

    /// Distance of two surfaces, negative when they overlap.
    pub(super) fn gap(&self, touch: Touch, position: &[Triple<T>]) -> T {
        match touch {
            Touch::Pair { a, b } => {
                let d = minus(&position[b], &position[a]);
                dot(&d, &d).sqrt() - (T::from_f64(self.radii[a]) + T::from_f64(self.radii[b]))
            }
            Touch::Wall { body, wall } => {
                let (axis, side) = wall.axis_and_side();
                T::from_f64(self.half(wall))
                    - T::from_f64(self.radii[body])
                    - position[body][axis].times(side)
            }
        }
    }

    pub(super) fn half(&self, wall: Wall) -> f64 {
        let walls = self.cushions.iter().flat_map(|(_, walls)| walls);
        let mut own = walls.filter(|(other, _)| *other == wall);
        own.next().map_or(f64::INFINITY, |(_, half)| *half)
    }
}

/// Bodies and directions of a push at these positions.
pub(super) fn arms<T: Real>(touch: Touch, position: &[Triple<T>]) -> Arms<T> {
    match touch {
        Touch::Pair { a, b } => {
            let d = minus(&position[b], &position[a]);
            Arms {
                pushes: [(b, d), (a, d.map(|x| -x))],
                count: 2,
            }
        }
        Touch::Wall { body, wall } => {
            let (axis, side) = wall.axis_and_side();
            let mut inward = [T::zero(); 3];
            inward[axis] = T::from_f64(-side);
            Arms {
                pushes: [(body, inward), (body, inward)],
                count: 1,
            }
        }
    }
}
