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

    /// The best settings that a coordinate search found on three shots, for steps of an eighth of
    /// a millisecond; relative to the scene, so that they mean the same on any.
    ///
    /// Found by, and scored on the four scenes named first, which took no part in the search:
    ///
    /// ```text
    /// carom cost shot-0-75 shot-2-61 tests/exact/shot-1-13/scene.toml \
    ///     tests/exact/shot-4-02/scene.toml --tune-on shot-0-41,shot-2-96,shot-minus-0-94
    /// ```
    ///
    /// The search is kept in `tests/tuning/tuning.csv`. It made the error of stock parameters
    /// (the geometric mean over the shots of the largest position error before the horizon) from
    /// 357 mm to 36 mm where it was tuned, and from 685 mm to 72 mm where it was scored; on one
    /// of those four the error grew, from 180 mm to 286 mm.
    #[must_use]
    pub fn tuned() -> Self {
        Self {
            solver_iterations: Some(1),
            prediction_distance: Some(1e-3),
            length_scale: LengthScale::SmallestRadius(4.0),
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
        let spoken_of = ["precision", "forces", "sleeping"];
        let changed = self
            .parameters()
            .into_iter()
            .zip(Self::stock(self.precision).parameters());
        let changed: Vec<_> = changed
            .filter(|(own, stock)| own != stock && !spoken_of.contains(&own.0))
            .map(|((name, value), _)| format!("{name} {value}"))
            .collect();
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

    /// Every setting by its name and its value, `stock` where Rapier's own default is left.
    #[must_use]
    pub fn parameters(&self) -> Vec<(&'static str, String)> {
        fn or_stock(value: Option<impl ToString>) -> String {
            value.map_or_else(|| "stock".to_owned(), |value| value.to_string())
        }
        let precision = match self.precision {
            Precision::Single => "f32",
            Precision::Double => "f64",
        };
        let forces = match self.forces {
            Forces::Native => "native",
            Forces::Lecture => "lecture",
        };
        let length_unit = match self.length_scale {
            LengthScale::Metre => None,
            LengthScale::SmallestRadius(times) => Some(format!("{times}-smallest-radius")),
        };
        let ccd_enabled = match self.ccd_body {
            CcdBody::None => None,
            CcdBody::Fastest => Some("fastest-body"),
        };
        let distance = self.prediction_distance.map(|d| format!("{d:e}"));
        let speed_cap = (!self.speed_cap).then_some("none");
        let sleeping = self.sleeping.then_some("allowed");
        vec![
            ("precision", precision.to_owned()),
            ("forces", forces.to_owned()),
            ("num_solver_iterations", or_stock(self.solver_iterations)),
            ("normalized_prediction_distance", or_stock(distance)),
            ("contact_recycling", or_stock(self.contact_recycling)),
            ("max_ccd_substeps", or_stock(self.max_ccd_substeps)),
            ("speed_cap", or_stock(speed_cap)),
            ("length_unit", or_stock(length_unit)),
            ("ccd_enabled", or_stock(ccd_enabled)),
            ("sleeping", or_stock(sleeping)),
        ]
    }
}
