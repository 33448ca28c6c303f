//! What carom does to Rapier and for it: the facts of the page on fairness.

/// One thing that is done to every Rapier world, or for it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Handling {
    /// What is done.
    pub what: &'static str,
    /// Why.
    pub why: &'static str,
    /// How somebody who sees it otherwise changes it.
    pub change: &'static str,
}

/// All of it. Settings are fields of [`RapierSettings`](super::RapierSettings), a preset each in
/// the table of engines; the rest is code of `src/engine/rapier/`.
pub const RAPIER_HANDLING: [Handling; 11] = [
    Handling {
        what: "rest: the velocity of a ball slower than the rest speed is set to 0 after each step",
        why: "the lecture's game has it; Rapier's sleeping has a threshold and a delay of its own",
        change: "leave `[effects.rest]` out of the scene",
    },
    Handling {
        what: "attraction: a force on each pair, in 64 bits, from the positions before the step",
        why: "Rapier has no attraction; a user would add it so",
        change: "`src/engine/rapier/harness.rs`",
    },
    Handling {
        what: "walls: a fixed half-space for each, not a box of cuboids",
        why: "nothing passes through a half-space, however fast; this favours Rapier",
        change: "`insert_walls` in `src/engine/rapier/worlds.rs`",
    },
    Handling {
        what: "restitution: combine rule Min, and Max for walls that bounce more than balls",
        why: "each pair gets the restitution that the scene gives it; Rapier's default averages",
        change: "`wall_rule` in `src/engine/rapier/layout.rs`",
    },
    Handling {
        what: "friction 0, combine rule Min",
        why: "the model has none",
        change: "`collider` in `src/engine/rapier/worlds.rs`",
    },
    Handling {
        what: "rotations are locked, mass without inertia",
        why: "the model's balls do not turn; without friction nothing would turn them",
        change: "`insert_ball` in `src/engine/rapier/worlds.rs`",
    },
    Handling {
        what: "no body falls asleep",
        why: "the model knows no sleep; it would end slow motions",
        change: "setting `sleeping`",
    },
    Handling {
        what: "`length_unit` is one metre in the scene's unit; `rapier-tuned`: four radii of the smallest ball",
        why: "as Rapier's manual has it; its tolerances are lengths and mean nothing without it",
        change: "setting `length_scale`",
    },
    Handling {
        what: "`ccd_enabled` is set on no ball; the walls' own sweep stays as it comes",
        why: "stock; two swept balls pass each other by (`CcdBody`)",
        change: "settings `ccd_body` and `max_ccd_substeps`",
    },
    Handling {
        what: "crate features `dim3`, `f32` or `f64`, `std`: no SIMD over bodies, no threads, no block solver",
        why: "both precisions from the same features; `block-solver` is a default of one of the two crates alone",
        change: "build with `--features rapier-simd8` or `rapier-parallel` (`carom cost --bodies`)",
    },
    Handling {
        what: "a spring without stiffness and damping is left out",
        why: "Rapier would make a rigid bar of it",
        change: "`joints` in `src/engine/rapier/layout.rs`",
    },
];
