//! What is checked: anything that computes a scene.

use crate::engine::{EngineKind, EngineSpec, Precision, Simulation, StepGrid, drive, record};
use crate::error::Result;
use crate::recording::Recording;
use crate::scene::Scene;

/// Anything that computes a scene and can be held against what is known about it.
pub trait Subject: Sync {
    /// The name in reports.
    fn name(&self) -> &str;

    /// Computes a scene with steps of `dt` s at most.
    ///
    /// # Errors
    /// What kept it from that.
    fn record(&self, scene: &Scene, dt: f64) -> Result<Recording>;

    /// Whether its recordings tell impacts.
    fn tells_events(&self) -> bool {
        true
    }

    /// The relative distance of neighbouring numbers in its arithmetic.
    fn epsilon(&self) -> f64 {
        f64::EPSILON
    }
}

impl Subject for EngineSpec {
    fn name(&self) -> &str {
        &self.name
    }

    fn record(&self, scene: &Scene, dt: f64) -> Result<Recording> {
        record(scene, self, dt)
    }

    fn epsilon(&self) -> f64 {
        match &self.kind {
            EngineKind::Rapier(settings) if settings.precision == Precision::Single => {
                f32::EPSILON.into()
            }
            EngineKind::Impulse(_) | EngineKind::Exact(_) | EngineKind::Rapier(_) => f64::EPSILON,
        }
    }
}

/// A simulation of your own: implements the trait that carom's engines implement.
pub struct Own<F> {
    name: String,
    make: F,
}

impl<F, S> Own<F>
where
    F: Fn(&Scene, StepGrid) -> S + Sync,
    S: Simulation,
{
    /// `make` puts your simulation at the start of a scene, to take the steps of a grid.
    pub fn new(name: impl Into<String>, make: F) -> Self {
        Self {
            name: name.into(),
            make,
        }
    }
}

impl<F, S> Subject for Own<F>
where
    F: Fn(&Scene, StepGrid) -> S + Sync,
    S: Simulation,
{
    fn name(&self) -> &str {
        &self.name
    }

    fn record(&self, scene: &Scene, dt: f64) -> Result<Recording> {
        scene.checked()?;
        let grid = StepGrid::new(scene, dt)?;
        let mut simulation = (self.make)(scene, grid);
        let mut recording = drive(scene, &self.name, &mut simulation);
        recording.step = Some(grid.step);
        Ok(recording)
    }
}
