//! Where the solver departs from the slides on a given scene.

use crate::scene::Scene;

/// The departures (`DEVIATES:` in the sources) that can matter on this scene, a line each.
#[must_use]
pub fn notes(scene: &Scene) -> Vec<String> {
    let effects = &scene.effects;
    let divides_by_distance =
        effects.contact.is_some() || effects.attraction.is_some() || !effects.springs.is_empty();
    let mut notes = Vec::new();
    if divides_by_distance {
        notes.push(
            "where centres coincide the slides divide 0 by 0; here attraction and spring are zero \
             and a contact's normal is against the relative velocity"
                .to_owned(),
        );
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
