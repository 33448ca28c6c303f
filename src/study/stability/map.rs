//! Maps of stability: a pair on a spring and a pair in orbit, over the step and their own shape.

use rayon::prelude::*;

use crate::compare::metrics;
use crate::engine::{EngineSpec, record};
use crate::error::{Error, Result};
use crate::scene::{Attraction, Body, Effects, Scene, Spring, Units};

/// The lighter and the heavier body of every pair, kg: unequal, so that the reduced mass counts.
const MASSES: [f64; 2] = [1.0, 3.0];
/// Steps of a run on a spring.
const SPRING_STEPS: u32 = 256;
/// The step on a spring, s; all that counts are the numbers k dt²/mu and 2 kd dt/mu.
const SPRING_DT: f64 = 1.0 / 128.0;
/// A symplectic step below its limit swings about the right energy: by no more than
/// (1 + s)/(1 - s), s = sqrt(k dt²/mu)/2, which is 8 at 2.4, the last point of the grid below the
/// limit of 4. At 4.2, the first one past it, the energy grows 2.5 times in every step, until the
/// swing passes through the middle, where the spring turns round: 640 times, at the least.
const SPRING_GROWTH_MAX: f64 = 30.0;
/// Revolutions of an orbit.
const REVOLUTIONS: f64 = 10.0;
/// An orbit whose energy is off by more than half is another orbit: its axis is twice as long, or
/// two thirds as long, or it is none.
const ORBIT_DRIFT_MAX: f64 = 0.5;

/// A run of a map.
#[derive(Debug, Clone, PartialEq)]
pub struct MapPoint {
    /// The engine.
    pub engine: String,
    /// Across: a number without unit.
    pub x: f64,
    /// Up: a number without unit.
    pub y: f64,
    /// Springs: the largest energy over that of the start. Orbits: the largest change of the
    /// energy over that of the start. None where the run did not come to its end.
    pub growth: Option<f64>,
    /// Whether the run came to its end within the bound.
    pub is_stable: bool,
}

/// What a map shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MapKind {
    /// Springs: x = k dt²/mu, y = 2 kd dt/mu.
    Spring,
    /// Orbits: x = the eccentricity, y = w dt with w² = G M/q³, q the smallest distance.
    Orbit,
}

impl MapKind {
    /// The corners, low and high, of the cell that a point stands for.
    #[must_use]
    pub fn cell(self, [x, y]: [f64; 2]) -> [[f64; 2]; 2] {
        // Half a quarter of a decade on either side.
        let ratio = 10.0_f64.powf(0.125);
        let [below, above] = match self {
            Self::Spring => [x / ratio, x * ratio],
            Self::Orbit => [x - 0.05, x + 0.05],
        };
        [[below, y / ratio], [above, y * ratio]]
    }

    /// Where symplectic Euler loses its hold, y over x; nothing is kept where that is not above 0.
    ///
    /// Equation: k dt²/mu + 2 kd dt/mu = 4; w dt = 2, the same for the pull linearised at the
    /// smallest distance. Source: the roots of the step's characteristic polynomial, Hairer,
    /// Lubich and Wanner, Geometric Numerical Integration, I.1.
    #[must_use]
    pub fn limit(self, x: f64) -> f64 {
        match self {
            Self::Spring => 4.0 - x,
            Self::Orbit => 2.0,
        }
    }
}

/// A map for each of some engines.
#[derive(Debug, Clone, PartialEq)]
pub struct StabilityMap {
    /// What it shows.
    pub kind: MapKind,
    /// The values across.
    pub across: Vec<f64>,
    /// The values up.
    pub up: Vec<f64>,
    /// Engine by engine, up by up, across by across.
    pub points: Vec<MapPoint>,
}

/// Runs a map on some engines.
///
/// # Errors
/// As [`record`]; an engine that cannot do such a scene is told.
pub fn stability_map(kind: MapKind, engines: &[EngineSpec]) -> Result<StabilityMap> {
    let (across, up) = match kind {
        MapKind::Spring => (quarters(-2, 5), quarters(-2, 5)),
        MapKind::Orbit => (tenths(9), quarters(-2, 1)),
    };
    let mut runs = Vec::new();
    for spec in engines {
        for y in &up {
            runs.extend(across.iter().map(|x| (spec, *x, *y)));
        }
    }
    let points = runs.into_par_iter().map(|(spec, x, y)| {
        let growth = match kind {
            MapKind::Spring => spring_growth(spec, x, y)?,
            MapKind::Orbit => orbit_drift(spec, x, y)?,
        };
        let most = match kind {
            MapKind::Spring => SPRING_GROWTH_MAX,
            MapKind::Orbit => ORBIT_DRIFT_MAX,
        };
        Ok(MapPoint {
            engine: spec.name.clone(),
            x,
            y,
            growth,
            is_stable: growth.is_some_and(|growth| growth <= most),
        })
    });
    let points = points.collect::<Result<_>>()?;
    Ok(StabilityMap {
        kind,
        across,
        up,
        points,
    })
}

/// The middles of the quarters of the decades from 10^`first` to 10^`last`.
fn quarters(first: i32, last: i32) -> Vec<f64> {
    let middle = |eighth: i32| 10.0_f64.powf(f64::from(eighth) / 8.0);
    (8 * first..8 * last)
        .filter(|eighth| eighth.rem_euclid(2) == 1)
        .map(middle)
        .collect()
}

/// 0, 0.1, ... , n/10.
fn tenths(last: i32) -> Vec<f64> {
    (0..=last).map(|n| f64::from(n) / 10.0).collect()
}

/// The largest energy over that of the start, of a pair that a stretched spring pulls.
fn spring_growth(spec: &EngineSpec, x: f64, y: f64) -> Result<Option<f64>> {
    let reduced = MASSES[0] * MASSES[1] / (MASSES[0] + MASSES[1]);
    let spring = Spring {
        between: ["a".into(), "b".into()],
        stiffness: x * reduced / (SPRING_DT * SPRING_DT),
        rest_length: 1.0,
        damping: y * reduced / (2.0 * SPRING_DT),
    };
    let effects = Effects {
        springs: vec![spring],
        ..Effects::default()
    };
    let duration = f64::from(SPRING_STEPS) * SPRING_DT;
    let scene = pair("spring", [1.1, 0.0], duration, duration / 16.0, effects);
    let energies = energies(&scene, spec, SPRING_DT)?;
    Ok(energies.map(|energies| {
        let start = energies[0];
        energies
            .iter()
            .fold(0.0, |most: f64, at| most.max(at / start))
    }))
}

/// The largest change of the energy of a pair in orbit, over that of the start.
fn orbit_drift(spec: &EngineSpec, eccentricity: f64, y: f64) -> Result<Option<f64>> {
    // Semi-axis 1 and G M = 1, so that a revolution takes 2 pi; from the far point.
    let far = 1.0 + eccentricity;
    let speed = ((1.0 - eccentricity) / far).sqrt();
    let effects = Effects {
        attraction: Some(Attraction {
            constant: 1.0 / (MASSES[0] + MASSES[1]),
            softening: 0.0,
        }),
        ..Effects::default()
    };
    let dt = y * (1.0 - eccentricity).powf(1.5);
    let revolution = std::f64::consts::TAU;
    // Sixteen samples a revolution, a whole number of steps apart, or every step where it is long.
    let sample_every = dt * (revolution / 16.0 / dt).round().max(1.0);
    let samples = (REVOLUTIONS * revolution / sample_every).round();
    let scene = pair(
        "orbit",
        [far, speed],
        samples * sample_every,
        sample_every,
        effects,
    );
    let energies = energies(&scene, spec, dt)?;
    Ok(energies.map(|energies| {
        let start = energies[0];
        let changes = energies.iter().map(|at| ((at - start) / start).abs());
        changes.fold(0.0, f64::max)
    }))
}

/// Two small spheres a distance apart, with a relative speed across it, their centre at rest.
fn pair(
    name: &str,
    [distance, speed]: [f64; 2],
    duration: f64,
    sample_every: f64,
    effects: Effects,
) -> Scene {
    let whole = MASSES[0] + MASSES[1];
    let body = |name: &str, mass: f64, share: f64| Body {
        name: name.into(),
        mass,
        radius: 1e-3,
        position: [share * distance, 0.0, 0.0],
        velocity: [0.0, share * speed, 0.0],
    };
    Scene {
        name: name.into(),
        title: None,
        source: None,
        watch: None,
        duration,
        sample_every,
        units: Units::default(),
        bodies: vec![
            body("a", MASSES[0], -MASSES[1] / whole),
            body("b", MASSES[1], MASSES[0] / whole),
        ],
        effects,
    }
}

/// The energy at every sample; none where the run did not come to its end.
fn energies(scene: &Scene, spec: &EngineSpec, dt: f64) -> Result<Option<Vec<f64>>> {
    let recording = match record(scene, spec, dt) {
        Ok(recording) => recording,
        // A spring beyond what single precision holds, for instance.
        Err(Error::EngineCannot { .. }) => return Ok(None),
        Err(error) => return Err(error),
    };
    if !recording.outcome.is_finished() {
        return Ok(None);
    }
    let energies = metrics(scene, &recording)
        .into_iter()
        .map(|at| at.total_energy());
    let energies: Vec<f64> = energies.collect();
    Ok(energies
        .iter()
        .all(|energy| energy.is_finite())
        .then_some(energies))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::engine;

    /// Every point of the grid on the side of the line where the theory puts it.
    #[test]
    fn symplectic_euler_loses_a_spring_where_the_theory_says() {
        let map = stability_map(MapKind::Spring, &[engine("lecture").unwrap()]).unwrap();
        assert_eq!(map.points.len(), 28 * 28);
        for point in &map.points {
            assert_eq!(
                point.is_stable,
                point.x + point.y < 4.0,
                "k dt²/mu = {}, 2 kd dt/mu = {}: {:?}",
                point.x,
                point.y,
                point.growth
            );
        }
    }

    /// Its circular orbits are lost past the linear limit; a tenth of it is safe everywhere.
    #[test]
    fn symplectic_euler_keeps_orbits_of_small_steps_and_loses_those_of_large_ones() {
        let map = stability_map(MapKind::Orbit, &[engine("lecture").unwrap()]).unwrap();
        for point in &map.points {
            if point.y < 0.1 {
                assert!(point.is_stable, "{point:?}");
            }
            if point.x == 0.0 && point.y > MapKind::Orbit.limit(0.0) {
                assert!(!point.is_stable, "{point:?}");
            }
        }
    }

    #[test]
    fn robust_keeps_every_spring() {
        let robust = engine("robust").unwrap();
        for x in quarters(-2, 5).into_iter().step_by(3) {
            for y in quarters(-2, 5).into_iter().step_by(3) {
                let growth = spring_growth(&robust, x, y).unwrap().unwrap();
                assert!(growth <= 1.0 + 1e-9, "{x} {y}: {growth}");
            }
        }
    }
}
