//! Settings of a Rapier world.

use serde::Serialize;

/// Floating-point numbers inside Rapier.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Precision {
    /// 32 bits: the crate `rapier3d`.
    Single,
    /// 64 bits: the crate `rapier3d-f64`.
    Double,
}

/// How drag, springs and gravity act in a Rapier world.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Forces {
    /// Rapier's own features: linear damping, spring joints, gravity.
    Native,
    /// The lecture's formulas, added as forces before each step.
    Lecture,
}

/// The length in which a Rapier world measures its normalised parameters: `length_unit`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum LengthScale {
    /// Scene length units a metre, as the manual has it.
    Metre,
    /// The radius of the smallest body, times this.
    SmallestRadius(f64),
}

/// Which body has continuous collision detection of its own (`ccd_enabled`): it is swept against
/// the others as well, not against walls alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum CcdBody {
    /// None.
    None,
    /// The one that is fastest at the start. One alone, for two such bodies pass each other by.
    Fastest,
}

/// Settings of a Rapier world; `None` leaves Rapier's own default.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct RapierSettings {
    /// Which of the two crates computes.
    pub precision: Precision,
    /// How drag, springs and gravity act.
    pub forces: Forces,
    /// `num_solver_iterations`: since Rapier 0.30 these are substeps of the step.
    pub solver_iterations: Option<usize>,
    /// `normalized_prediction_distance`: contacts are made this far ahead, in `length_unit`s.
    pub prediction_distance: Option<f64>,
    /// `contact_recycling`: keep a pair's old contact while it moved little.
    pub contact_recycling: Option<bool>,
    /// `max_ccd_substeps`; 0 switches all continuous collision detection off.
    pub max_ccd_substeps: Option<usize>,
    /// `false` lifts the cap of speeds (`normalized_max_linear_velocity`).
    pub speed_cap: bool,
    /// What `length_unit` is.
    pub length_scale: LengthScale,
    /// Which body is swept against the others.
    pub ccd_body: CcdBody,
    /// Whether bodies may fall asleep, by Rapier's own thresholds.
    pub sleeping: bool,
}

impl RapierSettings {
    /// Stock parameters.
    #[must_use]
    pub fn stock(precision: Precision) -> Self {
        Self {
            precision,
            forces: Forces::Native,
            solver_iterations: None,
            prediction_distance: None,
            contact_recycling: None,
            max_ccd_substeps: None,
            speed_cap: true,
            length_scale: LengthScale::Metre,
            ccd_body: CcdBody::None,
            sleeping: false,
        }
    }

    /// As near to the lecture as Rapier's interface allows.
    #[must_use]
    pub fn matched() -> Self {
        Self {
            forces: Forces::Lecture,
            solver_iterations: Some(1),
            prediction_distance: Some(1e-9),
            contact_recycling: Some(false),
            max_ccd_substeps: Some(0),
            speed_cap: false,
            ..Self::stock(Precision::Double)
        }
    }

    pub(super) fn describe(&self) -> String {
        let krate = match self.precision {
            Precision::Single => "rapier3d (f32)",
            Precision::Double => "rapier3d-f64",
        };
        let forces = match self.forces {
            Forces::Native => "drag, springs and gravity by Rapier's own features",
            Forces::Lecture => "drag, springs and gravity as the lecture's forces",
        };
        let changed = self.changed();
        let changed = if changed.is_empty() {
            "stock parameters".to_owned()
        } else {
            changed.join(", ")
        };
        let sleeping = if self.sleeping {
            "sleeping allowed"
        } else {
            "no sleeping"
        };
        format!("{krate}: {forces}; {changed}; friction 0, rotations locked, {sleeping}.")
    }

    /// Every parameter that is not Rapier's own default, in words.
    fn changed(&self) -> Vec<String> {
        let mut changed = Vec::new();
        changed.extend(
            self.solver_iterations
                .map(|n| format!("num_solver_iterations {n}")),
        );
        changed.extend(
            self.prediction_distance
                .map(|d| format!("normalized_prediction_distance {d:e}")),
        );
        changed.extend(
            self.contact_recycling
                .map(|on| format!("contact_recycling {on}")),
        );
        changed.extend(
            self.max_ccd_substeps
                .map(|n| format!("max_ccd_substeps {n}")),
        );
        if !self.speed_cap {
            changed.push("no cap of speeds".to_owned());
        }
        match self.length_scale {
            LengthScale::Metre => {}
            LengthScale::SmallestRadius(times) => {
                changed.push(format!("length_unit {times} x the smallest radius"));
            }
        }
        match self.ccd_body {
            CcdBody::None => {}
            CcdBody::Fastest => changed.push("ccd_enabled on the fastest body".to_owned()),
        }
        changed
    }
}
