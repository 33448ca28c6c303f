//! The phases of a step of `robust`, in order: only the safeguards that the scene can need.

use crate::engine::Phase;
use crate::engine::impulse::phases::Phases;

/// The phases that a scene calls for.
pub(in crate::engine::impulse) fn plan(phases: &Phases) -> Vec<Phase> {
    let mut all = Vec::new();
    let mut add = |present: bool, name: &'static str, method: String| {
        if present {
            all.push(Phase::new(name, method));
        }
    };
    let meets = phases.contact.is_some() || phases.cushions.is_some();
    let damped = phases.springs.iter().filter(|it| it.damping != 0.0).count();
    let joined = phases.attraction.is_some() || !phases.springs.is_empty();
    add(
        meets,
        "room",
        "spheres that overlap are moved apart, once".to_owned(),
    );
    add(
        joined,
        "length",
        "substeps as short as encounters and springs ask for".to_owned(),
    );
    add(
        phases.attraction.is_some(),
        "attraction",
        "every pair i < j: the constant force that does the work of its potential".to_owned(),
    );
    add(
        phases.decay.is_some(),
        "drag",
        "exact decay, with the path that goes with it".to_owned(),
    );
    add(
        !phases.springs.is_empty(),
        "springs",
        format!(
            "{} springs: the constant force that does the work of its potential{}",
            phases.springs.len(),
            if damped > 0 {
                format!("; {damped} dampers: exact decay of the relative velocities")
            } else {
                String::new()
            }
        ),
    );
    add(
        phases.gravity.is_some(),
        "gravity",
        "a parabola, in closed form".to_owned(),
    );
    add(
        meets && phases.forces,
        "pushes",
        "surfaces that stay in touch press, all together, without work; bounces that lose and lift \
         less than 1e-6 of a radius end"
            .to_owned(),
    );
    add(
        true,
        "motion",
        "closed form under a constant force".to_owned(),
    );
    add(
        phases.rest.is_some(),
        "rest",
        "slower than the rest speed: stop, at that time".to_owned(),
    );
    if let Some(cushions) = phases.cushions {
        let walls = if cushions.half_height.is_some() { 6 } else { 4 };
        let method = format!("{walls} walls, at the time of impact, together with contacts");
        add(true, "cushions", method);
    }
    add(
        phases.contact.is_some(),
        "contacts",
        "every pair i < j, at the time of impact: all of one instant reflected together".to_owned(),
    );
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::impulse::robust::touch::tests::start;

    /// Springs and dampers are counted each on their own.
    #[test]
    fn the_plan_counts_springs_and_dampers() {
        let spring = |damping: u8| {
            format!(
                "[[effects.springs]]\nbetween=['b0','b1']\nstiffness=1\nrest_length=1\n\
                 damping={damping}\n"
            )
        };
        let spheres = [(1.0, [0.0; 3], [0.0; 3]), (1.0, [9.0, 0.0, 0.0], [0.0; 3])];
        for (dampings, text, dampers) in [
            (&[0, 0][..], "2 springs", None),
            (&[0, 1, 0], "3 springs", Some("1 dampers")),
        ] {
            let effects: String = dampings.iter().map(|damping| spring(*damping)).collect();
            let (phases, ..) = start(&spheres, &effects);
            let said = format!("{:?}", plan(&phases));
            assert!(said.contains(text), "{said}");
            assert_eq!(said.contains("dampers"), dampers.is_some(), "{said}");
            assert!(dampers.is_none_or(|count| said.contains(count)), "{said}");
        }
    }
}
