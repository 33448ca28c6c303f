//! Where a scene starts, and whether a trajectory starts there too.

use super::Recording;
use crate::error::{Error, Result};
use crate::physics::{BodyState, Vector3};
use crate::scene::{Body, Scene};

/// Relative room for a start that was printed and read again: files may have ten digits.
const ROUNDING: f64 = 1e-9;

/// The states with which a scene starts. Shape: `[body]`.
///
/// A negative zero becomes a positive one: that no engine ever meets a negative zero is what
/// makes an absent effect equal its neutral value bit for bit.
#[must_use]
pub fn initial_states(scene: &Scene) -> Vec<BodyState> {
    let state = |body: &Body| BodyState {
        position: body.position.map(|x| x + 0.0).into(),
        velocity: body.velocity.map(|v| v + 0.0).into(),
    };
    scene.bodies.iter().map(state).collect()
}

/// A trajectory must start where its scene starts, to the rounding of its printed digits; `file`
/// is its name in messages. Valid for a trajectory that has its first sample.
///
/// # Errors
/// [`Error::Table`] with the line, the body, and both starts.
pub fn check_start(scene: &Scene, trajectory: &Recording, file: &str) -> Result<()> {
    let starts = initial_states(scene);
    let rows = scene.bodies.iter().zip(&starts).zip(trajectory.sample(0));
    // The header is line 1.
    for (line, ((body, ours), theirs)) in (2..).zip(rows) {
        let quantities = [
            ("position", &ours.position, &theirs.position),
            ("velocity", &ours.velocity, &theirs.velocity),
        ];
        for (quantity, due, found) in quantities {
            let room = ROUNDING * due.norm().max(found.norm());
            if (due - found).norm() > room {
                let message = format!(
                    "the first sample is not the scene's start: the {quantity} of `{}` is {} \
                     where {} is due; begin with the start itself, before any step, with 17 \
                     digits a number",
                    body.name,
                    components(found),
                    components(due)
                );
                let file = file.to_owned();
                return Err(Error::Table {
                    file,
                    line,
                    message,
                });
            }
        }
    }
    Ok(())
}

fn components(vector: &Vector3) -> String {
    format!("({:?}, {:?}, {:?})", vector.x, vector.y, vector.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn scene() -> Scene {
        let text = "name='x'\nduration=1\nsample_every=1\n\
            [[bodies]]\nname='a'\nmass=1\nradius=1\nposition=[0,0,0]\nvelocity=[0,0,0]\n\
            [[bodies]]\nname='b'\nmass=1\nradius=1\nposition=[5,0,0]\nvelocity=[0,3,0]\n";
        crate::scene::parse(text, "x").unwrap()
    }

    fn complaint(change: impl FnOnce(&mut BodyState)) -> Option<String> {
        let scene = scene();
        let mut states = initial_states(&scene);
        change(&mut states[1]);
        let mut trajectory = Recording::empty("x", states.len());
        trajectory.push(&states);
        let checked = check_start(&scene, &trajectory, "t.csv");
        checked.err().map(|wrong| wrong.to_string())
    }

    #[test]
    fn a_start_elsewhere_is_told_with_its_line_and_both_starts() {
        let said = complaint(|b| b.position.x = 5.01).unwrap();
        assert!(
            said.starts_with("t.csv, line 3: the first sample is not"),
            "{said}"
        );
        assert!(
            said.contains("position of `b` is (5.01, 0.0, 0.0)"),
            "{said}"
        );
        assert!(said.contains("where (5.0, 0.0, 0.0) is due"), "{said}");
        let said = complaint(|b| b.velocity.y = 0.0).unwrap();
        assert!(said.contains("velocity of `b`"), "{said}");
    }

    #[test]
    fn ten_printed_digits_are_enough() {
        assert_eq!(complaint(|_| ()), None);
        assert_eq!(complaint(|b| b.position.x = 5.000_000_001), None);
        assert!(complaint(|b| b.position.x = 5.000_000_1).is_some());
    }
}
