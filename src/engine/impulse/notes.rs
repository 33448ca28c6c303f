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

#[cfg(test)]
mod tests {
    use super::*;

    fn said(effects: &str, settings: ImpulseSettings) -> Vec<String> {
        let body = |name: &str, x: u8| {
            format!(
                "[[bodies]]\nname='{name}'\nmass=1\nradius=1\nposition=[{x},0,0]\n\
                 velocity=[0,0,0]\n"
            )
        };
        let bodies = body("a", 0) + &body("b", 9);
        let text = format!("name='x'\nduration=1\nsample_every=1\n{bodies}{effects}");
        notes(&crate::scene::parse(&text, "x").unwrap(), settings)
    }

    /// Each departure is told where the scene has what it departs in, and nowhere else.
    #[test]
    fn departures_are_told_where_they_matter() {
        let spring = "[[effects.springs]]\nbetween=['a','b']\nstiffness=1\nrest_length=1\n\
            damping=0\n";
        let cushions = "[effects.cushions]\nhalf_width=20\nhalf_length=20\n";
        for (effects, departures) in [
            (String::new(), &[][..]),
            (
                "[effects.contact]\nrestitution=1\n".into(),
                &["relative velocity"],
            ),
            (
                "[effects.attraction]\nconstant=1\n".into(),
                &["the attraction is zero"],
            ),
            (
                "[effects.attraction]\nconstant=1\nsoftening=0.1\n".into(),
                &["the attraction is zero", "not softened"],
            ),
            (spring.into(), &["the spring is zero"]),
            (format!("{cushions}restitution=1\n"), &[]),
            (
                format!("{cushions}restitution=0.5\n"),
                &["cushions are elastic"],
            ),
            (
                format!("{cushions}half_height=20\nrestitution=1\n"),
                &["no walls in y"],
            ),
            (
                "[effects.gravity]\nacceleration=[0,-9.81,0]\n".into(),
                &["never uses it"],
            ),
        ] {
            let lines = said(&effects, ImpulseSettings::LECTURE);
            assert_eq!(lines.len(), departures.len(), "{effects}{lines:?}");
            for (line, departure) in lines.iter().zip(departures) {
                assert!(line.contains(departure), "{line}");
            }
        }
        let other = crate::engine::engine("verlet").unwrap();
        let crate::engine::EngineKind::Impulse(settings) = other.kind else {
            panic!("not hand-written");
        };
        assert_eq!(said("", settings).len(), 1);
    }
}
