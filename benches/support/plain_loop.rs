//! The opponent: the lecture's billiards step written as one plain fused loop, for exactly the
//! effects of the four-ball scene (drag, rest, cushions, contacts), without carom's plan,
//! phases or observers. A test holds its bits against the engine's.

/// A ball of the plain loop.
#[derive(Debug, Clone, Copy)]
pub struct Ball {
    pub position: [f64; 3],
    pub velocity: [f64; 3],
    pub mass: f64,
    pub radius: f64,
}

/// What the plain loop needs to know of the scene.
#[derive(Debug, Clone, Copy)]
pub struct Table {
    pub half_width: f64,
    pub half_length: f64,
    pub cushion_restitution: f64,
    pub contact_restitution: f64,
    pub drag: f64,
    pub rest_speed: f64,
}

fn length(v: [f64; 3]) -> f64 {
    (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt()
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// One step.
pub fn step(balls: &mut [Ball], table: &Table, dt: f64) {
    for ball in balls.iter_mut() {
        for axis in 0..3 {
            let force = 0.0 + -table.drag * ball.velocity[axis];
            ball.velocity[axis] += dt * ((1.0 / ball.mass) * force);
            ball.position[axis] += dt * ball.velocity[axis];
        }
        if length(ball.velocity) < table.rest_speed {
            ball.velocity = [0.0; 3];
        }
        let (r, e) = (ball.radius, table.cushion_restitution);
        let (axis, penetration, normal) = if ball.position[0] + r > table.half_width {
            (0, ball.position[0] + r - table.half_width, -1.0)
        } else if ball.position[0] - r < -table.half_width {
            (0, -table.half_width - ball.position[0] + r, 1.0)
        } else if ball.position[2] + r > table.half_length {
            (2, ball.position[2] + r - table.half_length, -1.0)
        } else if ball.position[2] - r < -table.half_length {
            (2, -table.half_length - ball.position[2] + r, 1.0)
        } else {
            continue;
        };
        let normal_velocity = ball.velocity[axis] * normal;
        if normal_velocity < 0.0 {
            ball.velocity[axis] -= (1.0 + e) * normal_velocity * normal;
        }
        ball.position[axis] += (1.0 + e) * penetration * normal;
    }
    for i in 0..balls.len() {
        for j in i + 1..balls.len() {
            let (head, tail) = balls.split_at_mut(j);
            let (a, b) = (&mut head[i], &mut tail[0]);
            let apart = [0, 1, 2].map(|axis| a.position[axis] - b.position[axis]);
            let distance = length(apart);
            if distance < a.radius + b.radius {
                collide(
                    a,
                    b,
                    apart.map(|x| x / distance),
                    distance,
                    table.contact_restitution,
                );
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
