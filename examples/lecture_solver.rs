//! The lecture's solver as a program of its own, with nothing of carom in it: functions as in the
//! slides, phases in their order. `exercise.rs` is the same with a blank to fill in.
#![allow(clippy::pedantic)]

use std::collections::HashMap;

type Vec3 = nalgebra::Vector3<f64>;

#[derive(Default)]
struct Particle {
    name: String,
    mass: f64,
    radius: f64,
    loc: Vec3,
    vel: Vec3,
    force: Vec3,
}

/// Every pair i < j, in the slides' order.
fn for_pairs(particles: &mut [Particle], mut act: impl FnMut(&mut Particle, &mut Particle)) {
    for i in 0..particles.len() {
        let (head, tail) = particles.split_at_mut(i + 1);
        tail.iter_mut().for_each(|b| act(&mut head[i], b));
    }
}

fn compute_attraction(a: &mut Particle, b: &mut Particle, g: f64, softening: f64) {
    let xij = b.loc - a.loc;
    let (dist, gmm) = (xij.norm(), g * a.mass * b.mass);
    let force = if dist == 0.0 {
        Vec3::zeros() // no direction
    } else if softening == 0.0 {
        xij / dist * (gmm / (dist * dist))
    } else {
        let softened = (dist * dist + softening * softening).sqrt();
        xij * (gmm / (softened * softened * softened))
    };
    a.force += force;
    b.force -= force;
}

fn spring_damper(a: &mut Particle, b: &mut Particle, k: f64, rest_length: f64, kd: f64) {
    let xij = b.loc - a.loc;
    let length = xij.norm();
    let mut force = (b.vel - a.vel) * kd; // the full relative velocity
    if length > 0.0 {
        force += xij / length * (k * (length - rest_length));
    }
    a.force += force;
    b.force -= force;
}

fn floor_drag(p: &mut Particle, drag: f64) {
    p.force += p.vel * -drag;
}

fn force_integration(p: &mut Particle, dt: f64) {
    p.vel += p.force * (1.0 / p.mass) * dt;
    p.loc += p.vel * dt;
}

/// The first wall that a ball overlaps, and no other; `half`: from the middle to the walls.
fn cushion(p: &mut Particle, half: Vec3, e: f64) {
    let (pos, r) = (p.loc, p.radius);
    let walls = [
        (pos.x + r > half.x, pos.x + r - half.x, -Vec3::x()),
        (pos.x - r < -half.x, -half.x - pos.x + r, Vec3::x()),
        (pos.z + r > half.z, pos.z + r - half.z, -Vec3::z()),
        (pos.z - r < -half.z, -half.z - pos.z + r, Vec3::z()),
        (pos.y + r > half.y, pos.y + r - half.y, -Vec3::y()),
        (pos.y - r < -half.y, -half.y - pos.y + r, Vec3::y()),
    ];
    if let Some((_, penetration, n)) = walls.into_iter().find(|(overlaps, ..)| *overlaps) {
        let vn = p.vel.dot(&n);
        if vn < 0.0 {
            p.vel -= n * ((1.0 + e) * vn);
        }
        p.loc += n * ((1.0 + e) * penetration);
    }
}

/// Two balls at the end of a step; `e`: coefficient of restitution.
fn collision_handler(a: &mut Particle, b: &mut Particle, e: f64) {
    let dist = (a.loc - b.loc).norm();
    let penetration = a.radius + b.radius - dist;
    if dist < a.radius + b.radius {
        let mut n = (a.loc - b.loc) / dist;
        if dist == 0.0 {
            n = (b.vel - a.vel).try_normalize(0.0).unwrap_or(Vec3::x()); // as if head-on
        }
        let (v1n, v2n) = (a.vel.dot(&n), b.vel.dot(&n));
        if v1n - v2n < 0.0 {
            let j = -(v1n - v2n) * (e + 1.0) / (1.0 / a.mass + 1.0 / b.mass);
            a.vel = a.vel - n * v1n + n * (v1n + j / a.mass);
            b.vel = b.vel - n * v2n + n * (v2n - j / b.mass);
        }
        a.loc += n * (0.5 * (1.0 + e) * penetration);
        b.loc -= n * (0.5 * (1.0 + e) * penetration);
    }
}

/// One step. `effects`: the numbers of `effects.csv` by `effect.index.parameter`.
fn do_simulation(particles: &mut [Particle], effects: &HashMap<String, f64>, dt: f64) {
    let of = |parameter: &str| effects.get(parameter).copied(); // none where not declared
    particles.iter_mut().for_each(|p| p.force = Vec3::zeros());
    if let Some(g) = of("attraction.0.constant") {
        let softening = of("attraction.0.softening").unwrap_or(0.0);
        for_pairs(particles, |a, b| compute_attraction(a, b, g, softening));
    }
    if let Some(drag) = of("drag.0.coefficient") {
        particles.iter_mut().for_each(|p| floor_drag(p, drag));
    }
    let is_spring = |key: &&String| key.ends_with(".stiffness");
    for spring in 0..effects.keys().filter(is_spring).count() {
        let of = |parameter| effects[&format!("spring.{spring}.{parameter}")];
        let ends = [of("a") as usize, of("b") as usize];
        let [a, b] = particles.get_disjoint_mut(ends).expect("two bodies");
        spring_damper(a, b, of("stiffness"), of("rest_length"), of("damping"));
    }
    let gravity = ["x", "y", "z"].map(|axis| of(&format!("gravity.0.acceleration_{axis}")));
    let gravity: Vec3 = gravity.map(|component| component.unwrap_or(0.0)).into();
    let rest_speed = of("rest.0.speed").unwrap_or(0.0);
    for p in particles.iter_mut() {
        p.force += gravity * p.mass;
        force_integration(p, dt);
        if p.vel.norm() < rest_speed {
            p.vel = Vec3::zeros();
        }
    }
    if let Some(e) = of("cushions.0.restitution") {
        let half = ["width", "height", "length"].map(|side| of(&format!("cushions.0.half_{side}")));
        let half = half.map(|half| half.unwrap_or(f64::INFINITY)).into();
        particles.iter_mut().for_each(|p| cushion(p, half, e));
    }
    if let Some(e) = of("contact.0.restitution") {
        for_pairs(particles, |a, b| collision_handler(a, b, e));
    }
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let path = |n| std::env::args().nth(n).ok_or("give BODIES EFFECTS OUT");
    let (mut particles, mut effects) = (Vec::new(), HashMap::new());
    for row in csv::Reader::from_path(path(1)?)?.deserialize() {
        let mut p = Particle::default();
        let (loc, vel): ([f64; 3], [f64; 3]);
        (p.name, p.mass, p.radius, loc, vel) = row?;
        (p.loc, p.vel) = (loc.into(), vel.into());
        particles.push(p);
    }
    for row in csv::Reader::from_path(path(2)?)?.deserialize() {
        let (effect, index, parameter, value): (String, usize, String, f64) = row?;
        effects.insert(format!("{effect}.{index}.{parameter}"), value);
    }
    let number = |parameter| effects[&format!("scene.0.{parameter}")];
    let mut table = csv::Writer::from_path(path(3)?)?;
    table.write_record(["time", "body", "x", "y", "z", "vx", "vy", "vz"])?;
    for sample in 0..=number("samples") as u32 {
        let steps = u64::from(sample > 0) * number("steps_per_sample") as u64;
        (0..steps).for_each(|_| do_simulation(&mut particles, &effects, number("step")));
        let time = f64::from(sample) * number("sample_every");
        for p in &particles {
            let [loc, vel]: [[f64; 3]; 2] = [p.loc.into(), p.vel.into()];
            table.serialize((time, &p.name, loc, vel))?;
        }
    }
    Ok(table.flush()?)
}
