//! Where the solver departs from the slides on a given scene.

use crate::engine::spec::ImpulseSettings;
use crate::scene::Scene;

/// The departures (`DEVIATES:` in the sources) that can matter on this scene, a line each.
#[must_use]
pub fn notes(scene: &Scene, settings: ImpulseSettings) -> Vec<String> {
    let effects = &scene.effects;
    let mut notes = Vec::new();
    if settings != ImpulseSettings::LECTURE {
        notes.push("a rung of the ladder: other numerical choices than the slides'".to_owned());
    }
    let guards = [
        (
            effects.contact.is_some(),
            "a contact's normal is against the relative velocity",
        ),
        (effects.attraction.is_some(), "the attraction is zero"),
        (!effects.springs.is_empty(), "the spring is zero"),
    ];
    let guards = guards.iter().filter(|(present, _)| *present);
    let guards: Vec<_> = guards.map(|(_, guard)| *guard).collect();
    if !guards.is_empty() {
        notes.push(format!(
            "where centres coincide the slides divide 0 by 0; here {}",
            guards.join(" and ")
        ));
    }
    if effects
        .cushions
        .is_some_and(|cushions| cushions.restitution < 1.0)
    {
        notes.push("the slides' cushions are elastic; here they have a restitution".to_owned());
    }
    if effects
        .cushions
        .is_some_and(|cushions| cushions.half_height.is_some())
    {
        notes.push("the slides have no walls in y".to_owned());
    }
    if effects
        .attraction
        .is_some_and(|attraction| attraction.softening > 0.0)
    {
        notes.push("the slides' attraction is not softened".to_owned());
    }
    if effects.gravity.is_some() {
        notes.push("the slides' particle has a field for gravity but never uses it".to_owned());
    }
    notes
}
