//! What an engine is known to do on a case: measured values with derived tolerances, beside the
//! bounds of `expected.toml`.

use serde::{Deserialize, Serialize};

use super::expected::check_step;
use crate::error::number;
use crate::scene::check::check_text;
use crate::scene::fault::{fault, not_negative};
use crate::scene::{Fault, FieldPath, Scene};

/// What is measured of a solver on a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Metric {
    /// Largest distance of a body at a sample, scene length unit.
    Position,
    /// Largest difference of a velocity at a sample, scene length unit per second.
    Velocity,
    /// Largest |E(t) - E(0)| over the energy scale, where the model keeps it.
    Energy,
    /// Largest |p(t) - p(0)| over the momentum scale, where the model keeps it.
    Momentum,
    /// Largest |L(t) - L(0)| about the origin over its scale, where the model keeps it.
    AngularMomentum,
    /// Deepest overlap at a sample, scene length unit.
    Penetration,
    /// Impacts of the truth that find no partner.
    MissedImpacts,
    /// Largest difference in time of two matched impacts, s.
    ImpactTime,
}

impl Metric {
    /// Every metric, in the order of reports.
    pub const ALL: [Self; 8] = [
        Self::Position,
        Self::Velocity,
        Self::Energy,
        Self::Momentum,
        Self::AngularMomentum,
        Self::Penetration,
        Self::MissedImpacts,
        Self::ImpactTime,
    ];

    /// The key in `expected.toml`.
    #[must_use]
    pub fn key(self) -> &'static str {
        match self {
            Self::Position => "position",
            Self::Velocity => "velocity",
            Self::Energy => "energy",
            Self::Momentum => "momentum",
            Self::AngularMomentum => "angular_momentum",
            Self::Penetration => "penetration",
            Self::MissedImpacts => "missed_impacts",
            Self::ImpactTime => "impact_time",
        }
    }

    /// The name for people.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::AngularMomentum => "angular momentum",
            Self::MissedImpacts => "missed impacts",
            Self::ImpactTime => "impact time",
            other => other.key(),
        }
    }
}

/// What an engine does on a case, and how far from that another run may be.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Profile {
    /// Versions, target and precision that it was made with.
    pub made: String,
    /// The largest step, s.
    pub dt: f64,
    /// The digest of the recording.
    pub digest: String,
    /// Held against truth, and against what the model keeps.
    pub truth: Option<Tolerances>,
    /// Held against the engine's own stored recording.
    pub baseline: Option<Tolerances>,
    /// The change of the distance to the stored recording of Rapier.
    pub rapier: Option<Tolerances>,
}

/// Tolerances of one comparison.
#[derive(Debug, Clone, PartialEq, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tolerances {
    /// Positions, velocities and impacts are compared up to this time, s.
    pub until: f64,
    position: Option<Tolerance>,
    velocity: Option<Tolerance>,
    energy: Option<Tolerance>,
    momentum: Option<Tolerance>,
    angular_momentum: Option<Tolerance>,
    penetration: Option<Tolerance>,
    missed_impacts: Option<Tolerance>,
    impact_time: Option<Tolerance>,
}

/// How large a metric is, and may be.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tolerance {
    /// What the engine was measured to do.
    pub value: f64,
    /// What a run may do.
    pub tolerance: f64,
    /// Where the tolerance comes from.
    pub why: String,
}

impl Profile {
    /// The comparisons, by their keys in `expected.toml`.
    #[must_use]
    pub fn comparisons(&self) -> [(&'static str, Option<&Tolerances>); 3] {
        [
            ("truth", self.truth.as_ref()),
            ("baseline", self.baseline.as_ref()),
            ("rapier", self.rapier.as_ref()),
        ]
    }

    pub(super) fn check(&self, path: &FieldPath, scene: &Scene) -> Result<(), Fault> {
        check_step(&path.clone().key("dt"), self.dt, scene)?;
        check_text(path, &self.made)?;
        check_text(path, &self.digest)?;
        for (key, tolerances) in self.comparisons() {
            if let Some(tolerances) = tolerances {
                tolerances.check(&path.clone().key(key), scene)?;
            }
        }
        Ok(())
    }
}

impl Tolerances {
    /// Nothing yet, up to that time, s.
    #[must_use]
    pub fn up_to(until: f64) -> Self {
        Self {
            until,
            ..Self::default()
        }
    }

    /// That of one metric.
    #[must_use]
    pub fn of(&self, metric: Metric) -> Option<&Tolerance> {
        match metric {
            Metric::Position => &self.position,
            Metric::Velocity => &self.velocity,
            Metric::Energy => &self.energy,
            Metric::Momentum => &self.momentum,
            Metric::AngularMomentum => &self.angular_momentum,
            Metric::Penetration => &self.penetration,
            Metric::MissedImpacts => &self.missed_impacts,
            Metric::ImpactTime => &self.impact_time,
        }
        .as_ref()
    }

    /// Sets that of one metric.
    pub fn set(&mut self, metric: Metric, tolerance: Tolerance) {
        let place = match metric {
            Metric::Position => &mut self.position,
            Metric::Velocity => &mut self.velocity,
            Metric::Energy => &mut self.energy,
            Metric::Momentum => &mut self.momentum,
            Metric::AngularMomentum => &mut self.angular_momentum,
            Metric::Penetration => &mut self.penetration,
            Metric::MissedImpacts => &mut self.missed_impacts,
            Metric::ImpactTime => &mut self.impact_time,
        };
        *place = Some(tolerance);
    }

    /// All that there are, in the order of reports.
    pub fn all(&self) -> impl Iterator<Item = (Metric, &Tolerance)> {
        let metrics = Metric::ALL.into_iter();
        metrics.filter_map(|metric| Some((metric, self.of(metric)?)))
    }

    fn check(&self, path: &FieldPath, scene: &Scene) -> Result<(), Fault> {
        let until = path.clone().key("until");
        not_negative(&until, self.until)?;
        if self.until > scene.duration * (1.0 + 1e-9) {
            let remedy = format!(
                "the scene ends at {} s; give a time in it",
                number(scene.duration)
            );
            return Err(fault(until, format!("{} s", number(self.until)), remedy));
        }
        for (metric, tolerance) in self.all() {
            let path = path.clone().key(metric.key());
            not_negative(&path.clone().key("value"), tolerance.value)?;
            not_negative(&path.clone().key("tolerance"), tolerance.tolerance)?;
            check_text(&path.key("why"), &tolerance.why)?;
        }
        Ok(())
    }
}
