//! What a Rapier engine does on a scene, in words: phases of a step, and notes on differences.

use super::layout::{Combine, Layout, length_unit};
use super::parameters;
use super::world::Parameters;
use crate::engine::{CcdBody, Forces, Phase, Precision, RapierSettings};
use crate::physics::length;
use crate::scene::{Body, Scene};

/// Version of both crates, as they state it themselves.
pub const VERSION: &str = rapier3d::VERSION;

/// The phases of a step, in order. Rapier's own come as its pipeline runs them: collision
/// detection, then substeps of kick, constraints and drift, restitution, damping.
pub(super) fn phases(scene: &Scene, layout: &Layout, p: &Parameters) -> Vec<Phase> {
    let mut phases = harness_phases(scene, layout.settings.forces);
    if layout.has_colliders() {
        let recycling = p.recycle_distance.map_or("no recycling".to_owned(), |d| {
            format!("recycled below a motion of {}", shown(d))
        });
        let reach = shown(p.prediction_distance);
        phases.push(Phase::new(
            "detection",
            format!("pairs closer than {reach}, {recycling}"),
        ));
    }
    if layout.gravity.is_some() {
        phases.push(Phase::new("gravity", "Rapier's own, each substep"));
    }
    if !phases.iter().all(|phase| phase.name == "detection") {
        phases.push(Phase::new("kick", "v += h F/m each substep"));
    }
    if !layout.springs.is_empty() {
        let count = layout.springs.len();
        phases.push(Phase::new(
            "springs",
            format!("{count} spring joints, implicit"),
        ));
    }
    phases.extend(constraint_phases(layout, p));
    let cap = p.speed_cap.map_or("no speed cap".to_owned(), |cap| {
        format!("speeds cut at {}", shown(cap))
    });
    phases.push(Phase::new(
        "drift",
        format!("{} substep(s) x += h v, {cap}", p.substeps),
    ));
    if layout.has_colliders() {
        phases.push(Phase::new("restitution", "once a step, after the substeps"));
    }
    if layout.bodies.iter().any(|body| body.damping > 0.0) {
        phases.push(Phase::new(
            "drag",
            "linear damping, v / (1 + dt k/m) after the substeps",
        ));
    }
    phases.extend(sweep_phase(scene, layout, p));
    phases.extend(p.sleep.map(|sleep| {
        let (speed, after) = (shown(sleep.speed), shown(sleep.after));
        Phase::new(
            "sleep",
            format!("slower than {speed} for {after} s: asleep"),
        )
    }));
    if scene.effects.rest.is_some() {
        phases.push(Phase::new(
            "rest",
            "by carom: slower than the rest speed: stop",
        ));
    }
    phases
}

/// Continuous collision detection, where something is swept.
fn sweep_phase(scene: &Scene, layout: &Layout, p: &Parameters) -> Option<Phase> {
    let walls = (!layout.walls.is_empty()).then(|| "fast balls stop at walls".to_owned());
    let balls = layout
        .ccd_body
        .map(|body| format!("`{}`, when fast, stops at balls", scene.bodies[body].name));
    let swept: Vec<_> = walls.into_iter().chain(balls).collect();
    (p.ccd_passes > 0 && !swept.is_empty()).then(|| {
        let method = format!("{} (continuous collision detection)", swept.join(", "));
        Phase::new("sweep", method)
    })
}

/// A parameter as it was meant, whether it was rounded to 32 or to 64 bits.
#[allow(
    clippy::cast_possible_truncation,
    reason = "to show seven digits is the purpose"
)]
fn shown(value: f64) -> String {
    (value as f32).to_string()
}

/// The forces that carom adds before the step.
fn harness_phases(scene: &Scene, forces: Forces) -> Vec<Phase> {
    let effects = &scene.effects;
    let mut phases = Vec::new();
    if effects.attraction.is_some() {
        phases.push(Phase::new(
            "attraction",
            "by carom: every pair i < j, a force a step",
        ));
    }
    match forces {
        Forces::Native => {}
        Forces::Lecture => {
            if effects.drag.is_some() {
                phases.push(Phase::new("drag", "by carom: force -k v, explicit"));
            }
            if !effects.springs.is_empty() {
                let count = effects.springs.len();
                phases.push(Phase::new(
                    "springs",
                    format!("by carom: {count} spring-dampers, explicit"),
                ));
            }
            if effects.gravity.is_some() {
                phases.push(Phase::new("gravity", "by carom: force m g"));
            }
        }
    }
    phases
}

fn constraint_phases(layout: &Layout, p: &Parameters) -> Vec<Phase> {
    let mut phases = Vec::new();
    if layout.balls_collide {
        let method = format!(
            "one sweep of soft contacts a substep, restitution {}, push-out up to {}",
            layout.ball_restitution,
            shown(p.push_out_speed)
        );
        phases.push(Phase::new("contacts", method));
    }
    if !layout.walls.is_empty() {
        let rule = match layout.wall_rule {
            Combine::Min => "Min",
            Combine::Max => "Max",
        };
        let method = format!(
            "{} half-spaces, restitution {} (rule {rule})",
            layout.walls.len(),
            layout.wall_restitution
        );
        phases.push(Phase::new("cushions", method));
    }
    phases
}

/// What carom supplies and what Rapier computes in another way than the lecture, a line each.
#[must_use]
pub fn notes(scene: &Scene, settings: &RapierSettings) -> Vec<String> {
    let effects = &scene.effects;
    let mut notes = Vec::new();
    let mut note = |line: &str| notes.push(line.to_owned());
    if effects.attraction.is_some() {
        note("carom supplies attraction: a force a step, in 64 bits, from Rapier's positions");
    }
    if effects.rest.is_some() {
        note("carom supplies rest: velocity zero below the rest speed, after each step");
    }
    match settings.forces {
        Forces::Lecture => {
            if effects.drag.is_some() || effects.gravity.is_some() || !effects.springs.is_empty() {
                note("carom supplies drag, springs and gravity as the lecture's forces");
            }
        }
        Forces::Native => native_notes(scene, settings, &mut note),
    }
    match settings.precision {
        Precision::Single => note("state and step are rounded to 32 bits"),
        Precision::Double => {}
    }
    if effects.contact.is_some() || effects.cushions.is_some() {
        contact_notes(scene, settings, &mut note);
    }
    if settings.sleeping {
        note("a slow body falls asleep: it stands still until something touches or pushes it");
    }
    notes
}

/// The parameters of a scene's world, for steps of 1 s: none of what is told of them depends on
/// the step.
fn on_scene(scene: &Scene, settings: &RapierSettings) -> Parameters {
    parameters(settings, length_unit(scene, settings.length_scale), 1.0)
}

fn native_notes(scene: &Scene, settings: &RapierSettings, note: &mut impl FnMut(&str)) {
    let effects = &scene.effects;
    if effects.drag.is_some() {
        note("drag is linear damping: v / (1 + dt k/m) once a step, after the motion");
    }
    if !effects.springs.is_empty() {
        note(
            "springs are implicit joints; their damper acts along the spring only, the lecture's \
             on the full relative velocity: another model",
        );
    }
    if settings.solver_iterations != Some(1) {
        note("a step is divided into substeps over which forces stay constant");
    }
    if let Some(cap) = on_scene(scene, settings).speed_cap {
        let unit = scene.units.length.symbol();
        note(&format!(
            "speeds are cut at {} {unit}/s, by Rapier's default",
            shown(cap)
        ));
    }
}

/// What Rapier does to this scene from the start that has nothing to do with its physics.
#[must_use]
pub fn warnings(scene: &Scene, settings: &RapierSettings) -> Vec<String> {
    let cap = on_scene(scene, settings).speed_cap;
    let fast = |body: &&Body| cap.is_some_and(|cap| length(&body.velocity.into()) > cap);
    let fast = scene.bodies.iter().filter(fast).map(|body| {
        let cap = cap.map_or_else(String::new, shown);
        let unit = scene.units.length.symbol();
        format!(
            "`{}` starts faster than Rapier's cap of speeds, {cap} {unit}/s, and is slowed to it",
            body.name
        )
    });
    fast.collect()
}

fn contact_notes(scene: &Scene, settings: &RapierSettings, note: &mut impl FnMut(&str)) {
    note("an overlap at the end of a step is solved in the next: impacts come up to a step late");
    note(
        "in the step of an impact bodies move on at the velocity that just stops the approach; \
         the bounce follows at its end",
    );
    note("overlaps are pushed out over many steps, the lecture's at once");
    if scene
        .effects
        .contact
        .is_some_and(|contact| contact.restitution < 1.0)
        || scene
            .effects
            .cushions
            .is_some_and(|cushions| cushions.restitution < 1.0)
    {
        note("below e = 1, only a contact without impulse in the step before bounces");
    }
    if scene.effects.cushions.is_some() {
        note("a ball may touch several walls in a step, the lecture's one");
    }
    if settings.prediction_distance.is_none() {
        note("contacts act ahead of touch, within the prediction distance");
    }
    if settings.contact_recycling != Some(false) {
        note("a pair that moved little keeps its old contact normal");
    }
    if settings.max_ccd_substeps == Some(0) {
        return;
    }
    if scene.effects.cushions.is_some() {
        note("a ball faster than half a radius a step stops at a wall (motion clamped)");
    }
    match settings.ccd_body {
        CcdBody::Fastest if scene.effects.contact.is_some() => note(&format!(
            "`{}`, faster than half a radius a step, stops at a ball as well",
            scene.bodies[scene.fastest_body()].name
        )),
        CcdBody::Fastest | CcdBody::None => {}
    }
}
