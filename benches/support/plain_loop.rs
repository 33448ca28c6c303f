//! The opponents: a step of the lecture's solver written as a plain fused loop for exactly the
//! effects of a scene, without carom's plan, phases or observers. A test holds the bits of each
//! against the engine's.

use carom::case::Library;
use carom::scene::{Contact, Cushions, Effects, Gravity, Rest, Scene};

/// A ball of the plain loops.
#[derive(Debug, Clone, Copy)]
pub struct Ball {
    pub position: [f64; 3],
    pub velocity: [f64; 3],
    pub mass: f64,
    pub radius: f64,
}

/// Balls, the forces of the pair loops, and the springs.
#[derive(Debug, Clone)]
pub struct Plain {
    pub balls: Vec<Ball>,
    forces: Vec<[f64; 3]>,
    springs: Vec<Joined>,
    rules: Rules,
}

/// A spring-damper between two balls.
#[derive(Debug, Clone, Copy)]
struct Joined {
    ends: [usize; 2],
    stiffness: f64,
    rest_length: f64,
    damping: f64,
}

/// What the plain loops need to know of the scene; each reads what its effects have.
#[derive(Debug, Clone, Copy)]
struct Rules {
    half_width: f64,
    half_length: f64,
    half_height: f64,
    cushion_restitution: f64,
    contact_restitution: f64,
    drag: f64,
    rest_speed: f64,
    attraction: f64,
    gravity: [f64; 3],
}

impl Plain {
    /// A scene at its start.
    pub fn of(scene: &Scene) -> Self {
        let effects = &scene.effects;
        let ball = |body: &carom::scene::Body| Ball {
            position: body.position,
            velocity: body.velocity,
            mass: body.mass,
            radius: body.radius,
        };
        let springs = effects.springs.iter().zip(scene.spring_ends());
        let half = effects.cushions.map(|cushions| cushions.half_extents());
        let [half_width, half_height, half_length] = half.unwrap_or_default();
        Self {
            balls: scene.bodies.iter().map(ball).collect(),
            forces: vec![[0.0; 3]; scene.bodies.len()],
            springs: springs
                .map(|(spring, ends)| Joined {
                    ends,
                    stiffness: spring.stiffness,
                    rest_length: spring.rest_length,
                    damping: spring.damping,
                })
                .collect(),
            rules: Rules {
                half_width,
                half_length,
                half_height,
                cushion_restitution: effects.cushions.map_or(0.0, |c| c.restitution),
                contact_restitution: effects.contact.map_or(0.0, |c| c.restitution),
                drag: effects.drag.map_or(0.0, |drag| drag.coefficient),
                rest_speed: effects.rest.map_or(0.0, |rest| rest.speed),
                attraction: effects.attraction.map_or(0.0, |a| a.constant),
                gravity: effects.gravity.map_or([0.0; 3], |g| g.acceleration),
            },
        }
    }
}

/// A set of effects, a scene that has exactly these, and the loop written for them.
pub struct Combination {
    pub name: &'static str,
    /// How many effects.
    pub effects: usize,
    pub scene: fn() -> Scene,
    /// So many steps of that length.
    pub run: fn(&mut Plain, dt: f64, steps: u64),
}

/// Every combination that has a loop of its own.
pub const COMBINATIONS: [Combination; 8] = [
    Combination {
        name: "free flight",
        effects: 0,
        scene: || shot(|_| Effects::default()),
        run: |plain, dt, steps| {
            for _ in 0..steps {
                drift(&mut plain.balls, dt);
            }
        },
    },
    Combination {
        name: "contact",
        effects: 1,
        scene: || {
            shot(|effects| Effects {
                contact: effects.contact,
                ..Effects::default()
            })
        },
        run: |plain, dt, steps| {
            for _ in 0..steps {
                drift(&mut plain.balls, dt);
                contacts(&mut plain.balls, plain.rules.contact_restitution);
            }
        },
    },
    Combination {
        name: "contact, cushions",
        effects: 2,
        scene: || {
            shot(|effects| Effects {
                contact: effects.contact,
                cushions: effects.cushions,
                ..Effects::default()
            })
        },
        run: |plain, dt, steps| {
            for _ in 0..steps {
                frictionless_table(&mut plain.balls, &plain.rules, dt);
                contacts(&mut plain.balls, plain.rules.contact_restitution);
            }
        },
    },
    Combination {
        name: "contact, cushions, drag, rest",
        effects: 4,
        // Faster than the lecture's rest speed, which no ball falls to in this shot.
        scene: || {
            shot(|effects| Effects {
                rest: Some(Rest { speed: 600.0 }),
                ..effects.clone()
            })
        },
        run: |plain, dt, steps| {
            for _ in 0..steps {
                table(&mut plain.balls, &plain.rules, dt);
                contacts(&mut plain.balls, plain.rules.contact_restitution);
            }
        },
    },
    Combination {
        name: "contact, attraction",
        effects: 2,
        scene: || case("cluster-8"),
        run: |plain, dt, steps| {
            for _ in 0..steps {
                attraction(&plain.balls, &mut plain.forces, plain.rules.attraction);
                kick_and_drift(&mut plain.balls, &plain.forces, dt);
                contacts(&mut plain.balls, plain.rules.contact_restitution);
            }
        },
    },
    Combination {
        name: "contact, attraction, 30 bodies",
        effects: 2,
        scene: || case("cluster-30"),
        run: |plain, dt, steps| {
            for _ in 0..steps {
                attraction(&plain.balls, &mut plain.forces, plain.rules.attraction);
                kick_and_drift(&mut plain.balls, &plain.forces, dt);
                contacts(&mut plain.balls, plain.rules.contact_restitution);
            }
        },
    },
    Combination {
        name: "gravity, cushions on six sides",
        effects: 2,
        scene: || {
            shot(|effects| Effects {
                gravity: Some(Gravity {
                    acceleration: [0.0, -9810.0, 0.0],
                }),
                cushions: effects.cushions.map(|cushions| Cushions {
                    half_height: Some(300.0),
                    ..cushions
                }),
                ..Effects::default()
            })
        },
        run: |plain, dt, steps| {
            for _ in 0..steps {
                falling_box(&mut plain.balls, &plain.rules, dt);
            }
        },
    },
    Combination {
        name: "springs",
        effects: 1,
        scene: || {
            let mut scene = case("spring-chain");
            scene.effects = Effects {
                springs: scene.effects.springs,
                ..Effects::default()
            };
            scene
        },
        run: |plain, dt, steps| {
            for _ in 0..steps {
                springs(&plain.balls, &mut plain.forces, &plain.springs);
                kick_and_drift(&mut plain.balls, &plain.forces, dt);
            }
        },
    },
];

fn case(name: &str) -> Scene {
    let mut scene = Library::Embedded.case(name).expect("a case").scene;
    // The clusters' own contacts, and no other effect.
    if let Some(attraction) = scene.effects.attraction {
        scene.effects = Effects {
            contact: scene.effects.contact.or(Some(Contact { restitution: 0.1 })),
            attraction: Some(attraction),
            ..Effects::default()
        };
    }
    scene
}

/// The lecture's four balls with other effects.
fn shot(effects: fn(&Effects) -> Effects) -> Scene {
    let mut scene = Library::Embedded.case("shot-2-61").expect("a case").scene;
    scene.effects = effects(&scene.effects);
    scene
}

#[inline]
fn length(v: [f64; 3]) -> f64 {
    (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt()
}

#[inline]
fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

#[inline]
fn drift(balls: &mut [Ball], dt: f64) {
    for ball in balls {
        for axis in 0..3 {
            ball.position[axis] += dt * ball.velocity[axis];
        }
    }
}

#[inline]
fn kick_and_drift(balls: &mut [Ball], forces: &[[f64; 3]], dt: f64) {
    for (ball, force) in balls.iter_mut().zip(forces) {
        for (axis, force) in force.iter().enumerate() {
            ball.velocity[axis] += dt * ((1.0 / ball.mass) * force);
            ball.position[axis] += dt * ball.velocity[axis];
        }
    }
}

/// Balls that keep their speed between four walls.
#[inline]
fn frictionless_table(balls: &mut [Ball], rules: &Rules, dt: f64) {
    for ball in balls {
        for axis in 0..3 {
            ball.position[axis] += dt * ball.velocity[axis];
        }
        four_walls(ball, rules);
    }
}

/// The lecture's billiards: drag, rest, four walls.
#[inline]
fn table(balls: &mut [Ball], rules: &Rules, dt: f64) {
    for ball in balls {
        for axis in 0..3 {
            let force = 0.0 + -rules.drag * ball.velocity[axis];
            ball.velocity[axis] += dt * ((1.0 / ball.mass) * force);
            ball.position[axis] += dt * ball.velocity[axis];
        }
        if length(ball.velocity) < rules.rest_speed {
            ball.velocity = [0.0; 3];
        }
        four_walls(ball, rules);
    }
}

/// Balls that fall in a closed box.
#[inline]
fn falling_box(balls: &mut [Ball], rules: &Rules, dt: f64) {
    for ball in balls {
        for axis in 0..3 {
            let force = rules.gravity[axis] * ball.mass;
            ball.velocity[axis] += dt * ((1.0 / ball.mass) * force);
            ball.position[axis] += dt * ball.velocity[axis];
        }
        if four_walls(ball, rules) {
            continue;
        }
        let (y, r) = (ball.position[1], ball.radius);
        if y + r > rules.half_height {
            let penetration = y + r - rules.half_height;
            bounce(ball, rules, 1, penetration, -1.0);
        } else if y - r < -rules.half_height {
            let penetration = -rules.half_height - y + r;
            bounce(ball, rules, 1, penetration, 1.0);
        }
    }
}

/// The slides' chain of walls; whether one was touched.
#[inline]
fn four_walls(ball: &mut Ball, rules: &Rules) -> bool {
    let (x, z, r) = (ball.position[0], ball.position[2], ball.radius);
    let (axis, penetration, normal) = if x + r > rules.half_width {
        (0, x + r - rules.half_width, -1.0)
    } else if x - r < -rules.half_width {
        (0, -rules.half_width - x + r, 1.0)
    } else if z + r > rules.half_length {
        (2, z + r - rules.half_length, -1.0)
    } else if z - r < -rules.half_length {
        (2, -rules.half_length - z + r, 1.0)
    } else {
        return false;
    };
    bounce(ball, rules, axis, penetration, normal);
    true
}

#[inline]
fn bounce(ball: &mut Ball, rules: &Rules, axis: usize, penetration: f64, normal: f64) {
    let e = rules.cushion_restitution;
    let normal_velocity = ball.velocity[axis] * normal;
    if normal_velocity < 0.0 {
        ball.velocity[axis] -= (1.0 + e) * normal_velocity * normal;
    }
    ball.position[axis] += (1.0 + e) * penetration * normal;
}

#[inline]
fn attraction(balls: &[Ball], forces: &mut [[f64; 3]], constant: f64) {
    forces.fill([0.0; 3]);
    for i in 0..balls.len() {
        for j in i + 1..balls.len() {
            let (a, b) = (&balls[i], &balls[j]);
            let toward_b = [0, 1, 2].map(|axis| b.position[axis] - a.position[axis]);
            let distance = length(toward_b);
            if distance == 0.0 {
                continue;
            }
            let size = constant * a.mass * b.mass / (distance * distance);
            for (axis, d) in toward_b.into_iter().enumerate() {
                let force = d / distance * size;
                forces[i][axis] += force;
                forces[j][axis] -= force;
            }
        }
    }
}

#[inline]
fn springs(balls: &[Ball], forces: &mut [[f64; 3]], springs: &[Joined]) {
    forces.fill([0.0; 3]);
    for spring in springs {
        let [i, j] = spring.ends;
        let (a, b) = (&balls[i], &balls[j]);
        let toward_b = [0, 1, 2].map(|axis| b.position[axis] - a.position[axis]);
        let distance = length(toward_b);
        let pull = spring.stiffness * (distance - spring.rest_length);
        for (axis, d) in toward_b.into_iter().enumerate() {
            let damper = (b.velocity[axis] - a.velocity[axis]) * spring.damping;
            let force = if distance == 0.0 {
                damper
            } else {
                d / distance * pull + damper
            };
            forces[i][axis] += force;
            forces[j][axis] -= force;
        }
    }
}

#[inline]
fn contacts(balls: &mut [Ball], restitution: f64) {
    for i in 0..balls.len() {
        for j in i + 1..balls.len() {
            let (head, tail) = balls.split_at_mut(j);
            let (a, b) = (&mut head[i], &mut tail[0]);
            let apart = [0, 1, 2].map(|axis| a.position[axis] - b.position[axis]);
            let distance = length(apart);
            if distance < a.radius + b.radius {
                collide(a, b, apart.map(|x| x / distance), distance, restitution);
            }
        }
    }
}

fn collide(a: &mut Ball, b: &mut Ball, normal: [f64; 3], distance: f64, restitution: f64) {
    let penetration = a.radius + b.radius - distance;
    let (v1n, v2n) = (dot(a.velocity, normal), dot(b.velocity, normal));
    let vr = v1n - v2n;
    if vr < 0.0 {
        let impulse = -vr * (restitution + 1.0) / (1.0 / a.mass + 1.0 / b.mass);
        let (v1_new, v2_new) = (v1n + impulse / a.mass, v2n - impulse / b.mass);
        for (axis, n) in normal.into_iter().enumerate() {
            a.velocity[axis] = a.velocity[axis] - v1n * n + v1_new * n;
            b.velocity[axis] = b.velocity[axis] - v2n * n + v2_new * n;
        }
    }
    let push_out = 0.5 * (1.0 + restitution) * penetration;
    for (axis, n) in normal.into_iter().enumerate() {
        a.position[axis] += push_out * n;
        b.position[axis] -= push_out * n;
    }
}
