//! The four pictures of a comparison: paths, divergence, energy, momentum.

use super::chart::{
    AxisLabel, Curve, CurvesFigure, LineStyle, Marks, Panel, PathBody, PathsFigure, Scale, View,
    Weight, curves, paths,
};
use super::engineering;
use crate::compare::{Metrics, Sizes};
use crate::error::{Error, Result};
use crate::physics::Vector3;
use crate::scene::Scene;
use crate::study::{SideBySide, Track, Voice, track};

/// Ranges below this share of the quantity's size are drawn flat: the rounding of Rapier's
/// single precision (6e-8 a step, accumulated), which is no finding to magnify.
const FLAT: f64 = 1e-6;

/// Colours of pairs of voices: none that stands for a voice in the same picture.
const PAIR_COLORS: [usize; 3] = [6, 3, 5];

/// A picture's file name and its PNG bytes.
pub(super) type Picture = (&'static str, Vec<u8>);

/// Draws all pictures of a comparison with these voices, two or three of them.
pub(super) fn pictures(comparison: &SideBySide, voices: &[&Voice]) -> Result<Vec<Picture>> {
    let plane = Plane::of(comparison, voices);
    let png = |name: &'static str,
               drawn: std::result::Result<Vec<u8>, super::chart::ChartError>| {
        drawn
            .map(|bytes| (name, bytes))
            .map_err(|wrong| Error::Picture {
                name,
                message: wrong.to_string(),
            })
    };
    Ok(vec![
        png(
            "paths.png",
            paths(&paths_figure(comparison, voices, plane)?),
        )?,
        png(
            "divergence.png",
            curves(&divergence_figure(comparison, voices)),
        )?,
        png("energy.png", curves(&energy_figure(comparison, voices)))?,
        png(
            "momentum.png",
            curves(&momentum_figure(comparison, voices, plane)),
        )?,
    ])
}

/// The plane in which a scene is shown: from above, or from the side if things fall along y or
/// move in y much more than in z.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Plane {
    Above,
    Side,
}

impl Plane {
    fn of(comparison: &SideBySide, voices: &[&Voice]) -> Self {
        let spread = |axis: usize| {
            let states = voices.iter().flat_map(|v| v.recording.samples()).flatten();
            let (low, high) = states
                .map(|state| state.position[axis])
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), x| {
                    (l.min(x), h.max(x))
                });
            high - low
        };
        let effects = &comparison.scene.effects;
        let table = effects.cushions.is_some_and(|c| c.half_height.is_none());
        let falls = effects.gravity.is_some_and(|gravity| {
            let [x, y, z] = gravity.acceleration.map(f64::abs);
            y > x.max(z)
        });
        if falls || !table && spread(1) > 2.0 * spread(2) {
            Self::Side
        } else {
            Self::Above
        }
    }

    /// The axes shown, as indices into x, y, z.
    fn axes(self) -> [usize; 2] {
        match self {
            Self::Above => [0, 2],
            Self::Side => [0, 1],
        }
    }

    /// The axis that points at the reader.
    fn normal(self) -> usize {
        match self {
            Self::Above => 1,
            Self::Side => 2,
        }
    }
}

const AXIS: [&str; 3] = ["x", "y", "z"];

fn style(voice: usize) -> LineStyle {
    match voice {
        0 => LineStyle::Solid,
        1 => LineStyle::Dashed,
        _ => LineStyle::Dotted,
    }
}

fn paths_figure(comparison: &SideBySide, voices: &[&Voice], plane: Plane) -> Result<PathsFigure> {
    let scene = &comparison.scene;
    let [across, up] = plane.axes();
    let tracks: Vec<Track> = voices
        .iter()
        .map(|voice| track(scene, voice, comparison.dt))
        .collect::<Result<_>>()?;
    let flat = |point: &Vector3| [point[across], point[up]];
    let body = |(index, body): (usize, &crate::scene::Body)| PathBody {
        name: body.name.clone(),
        radius: body.radius,
        tracks: tracks
            .iter()
            .map(|track| track[index].iter().map(flat).collect())
            .collect(),
    };
    let unit = scene.units.length.symbol();
    let half = scene.effects.cushions.and_then(|cushions| match plane {
        Plane::Above => Some([cushions.half_width, cushions.half_length]),
        Plane::Side => cushions
            .half_height
            .map(|height| [cushions.half_width, height]),
    });
    let seen = match plane {
        Plane::Above => "seen from above",
        Plane::Side => "seen from the side",
    };
    Ok(PathsFigure {
        title: scene.heading().to_owned(),
        subtitle: format!(
            "paths {seen}, {} s, {}",
            super::engineering(scene.duration),
            steps(voices)
        ),
        axes: [
            AxisLabel::new(AXIS[across], unit),
            AxisLabel::new(AXIS[up], unit),
        ],
        view: match plane {
            Plane::Above => View::Above,
            Plane::Side => View::Side,
        },
        cushions: half,
        bodies: scene.bodies.iter().enumerate().map(body).collect(),
        voices: voices.iter().map(|voice| voice.name().to_owned()).collect(),
    })
}

/// The step in words: the same for all engines of one comparison.
fn steps(voices: &[&Voice]) -> String {
    let step = voices.iter().find_map(|voice| voice.recording.step);
    step.map_or(String::new(), |step| {
        format!("step {} s", super::engineering(step))
    })
}

fn divergence_figure(comparison: &SideBySide, voices: &[&Voice]) -> CurvesFigure {
    let scene = &comparison.scene;
    let unit = scene.units.length.symbol();
    let mut position = Panel::new(labelled("largest distance of a body", unit), Scale::Log);
    let speed_unit = if unit.is_empty() {
        String::new()
    } else {
        format!("{unit}/s")
    };
    let mut velocity = Panel::new(
        labelled("rms difference of velocity", &speed_unit),
        Scale::Log,
    );
    let length = scene.units.length;
    let mut energy = Panel::new(
        labelled("difference of energy", length.energy_symbol()),
        Scale::Log,
    );
    let mut momentum = Panel::new(
        labelled("difference of momentum", length.momentum_symbol()),
        Scale::Log,
    );
    let pairs = (0..voices.len()).flat_map(|a| (a + 1..voices.len()).map(move |b| (a, b)));
    for (number, (a, b)) in pairs.enumerate() {
        let Some((divergence, _)) = comparison.pair(voices[a].name(), voices[b].name()) else {
            continue;
        };
        let curve = |value: fn(&crate::compare::DivergenceSample) -> f64| Curve {
            label: format!("{} to {}", voices[a].name(), voices[b].name()),
            color: PAIR_COLORS[number % PAIR_COLORS.len()],
            line: style(number),
            weight: Weight::Main,
            points: divergence.samples[..divergence.comparable]
                .iter()
                .map(|at| [at.time, value(at)])
                .collect(),
        };
        position.curves.push(curve(|at| at.max_position));
        velocity.curves.push(curve(|at| at.rms_velocity));
        let difference = |value: fn(&Metrics, &Metrics) -> f64| {
            let pairs = voices[a].metrics.iter().zip(&voices[b].metrics);
            let points = pairs.map(|(a, b)| [a.time, value(a, b)]);
            Curve {
                points: points.take(divergence.comparable).collect(),
                ..curve(|at| at.max_position)
            }
        };
        energy.curves.push(difference(|a, b| {
            (a.total_energy() - b.total_energy()).abs()
        }));
        momentum
            .curves
            .push(difference(|a, b| (a.momentum - b.momentum).norm()));
    }
    CurvesFigure {
        title: scene.heading().to_owned(),
        subtitle: format!(
            "how far the voices are apart, {}{}",
            steps(voices),
            vouched(comparison, voices)
        ),
        x_label: "time [s]".into(),
        panels: vec![position, velocity, energy, momentum],
        marks: marks(voices),
    }
}

/// Until when the voices vouch for their positions, if one does not to the end.
fn vouched(comparison: &SideBySide, voices: &[&Voice]) -> String {
    let scene = &comparison.scene;
    let ends = voices.iter().filter_map(|voice| {
        let comparable = voice.recording.comparable_samples(scene);
        let until = scene.sample_time(comparable.max(1) - 1);
        let is_cut = comparable < voice.recording.sample_count();
        is_cut.then(|| format!("; {} vouches until {} s", voice.name(), engineering(until)))
    });
    ends.collect()
}

/// A row of strokes for the impacts of each voice that has any.
fn marks(voices: &[&Voice]) -> Vec<Marks> {
    let row = |(index, voice): (usize, &&Voice)| Marks {
        label: format!("impacts, {}", voice.name()),
        color: index,
        times: voice
            .recording
            .events
            .impacts()
            .map(|event| event.time)
            .collect(),
    };
    let rows = voices.iter().enumerate().map(row);
    rows.filter(|row| !row.times.is_empty()).collect()
}

fn energy_figure(comparison: &SideBySide, voices: &[&Voice]) -> CurvesFigure {
    let scene = &comparison.scene;
    let unit = scene.units.length.energy_symbol();
    let mut total = Panel::new(labelled("energy", unit), Scale::Linear);
    total.least_span = FLAT;
    total.size = comparison.scale.energy;
    let potential = scene.effects.attraction.is_some()
        || scene.effects.gravity.is_some()
        || !scene.effects.springs.is_empty();
    if let (true, Some(first)) = (potential, voices.first()) {
        let of_first = |part: &str| format!("{part}, {}", first.name());
        let mut kinetic = curve(first, 3, LineStyle::Solid, |at| at.kinetic_energy);
        kinetic.label = of_first("kinetic");
        let mut potential = curve(first, 4, LineStyle::Solid, Metrics::potential_energy);
        potential.label = of_first("potential");
        total.curves.extend([kinetic, potential].map(|c| Curve {
            weight: Weight::Aside,
            ..c
        }));
    }
    for (index, voice) in voices.iter().enumerate() {
        let mut total_energy = curve(voice, index, style(index), Metrics::total_energy);
        if potential {
            total_energy.label = format!("total, {}", voice.name());
        }
        total.curves.push(total_energy);
    }
    CurvesFigure {
        title: scene.heading().to_owned(),
        subtitle: energy_words(scene).to_owned(),
        x_label: "time [s]".into(),
        panels: vec![total, energy_change(comparison, voices)],
        marks: marks(voices),
    }
}

fn energy_words(scene: &Scene) -> &'static str {
    if scene.effects.conserve_energy() {
        "energy: the model keeps it, so any change is an error"
    } else {
        "energy: the model lets it fall, so compare the voices with each other"
    }
}

/// Where the model keeps the energy, its change; else the difference to the last voice, which
/// is truth where there is truth.
fn energy_change(comparison: &SideBySide, voices: &[&Voice]) -> Panel {
    let share = |difference: f64| Sizes::share(difference.abs(), comparison.scale.energy);
    let conserved = comparison.scene.effects.conserve_energy();
    let label = match voices.last() {
        Some(last) if !conserved => format!("difference to {}, relative", last.name()),
        Some(_) | None => "change since the start, relative".to_owned(),
    };
    let mut panel = Panel::new(label, Scale::Log);
    for (index, voice) in voices.iter().enumerate() {
        let reference: Vec<f64> = match voices.last() {
            Some(last) if !conserved => last.metrics.iter().map(Metrics::total_energy).collect(),
            Some(_) | None => vec![voice.metrics[0].total_energy(); voice.metrics.len()],
        };
        if !conserved && index + 1 == voices.len() {
            continue;
        }
        let points = voice.metrics.iter().zip(&reference);
        let points = points.map(|(at, reference)| [at.time, share(at.total_energy() - reference)]);
        let mut change = curve(voice, index, style(index), Metrics::total_energy);
        change.points = points.collect();
        panel.curves.push(change);
    }
    if comparison.scene.effects.attraction.is_some()
        || comparison.scene.effects.gravity.is_some()
        || !comparison.scene.effects.springs.is_empty()
    {
        for change in &mut panel.curves {
            change.label = format!("total, {}", change.label);
        }
    }
    panel
}

fn momentum_figure(comparison: &SideBySide, voices: &[&Voice], plane: Plane) -> CurvesFigure {
    let scene = &comparison.scene;
    let unit = scene.units.length.momentum_symbol();
    let length = scene.units.length.symbol();
    let scale = &comparison.scale;
    let mut panels = Vec::new();
    for axis in plane.axes() {
        let mut panel = Panel::new(labelled(&format!("p_{}", AXIS[axis]), unit), Scale::Linear);
        panel.size = scale.momentum;
        panel.curves = component(voices, |at| &at.momentum, axis);
        panels.push(panel);
    }
    let normal = plane.normal();
    let angular_unit = match (unit, length) {
        ("", _) => String::new(),
        (_, "m") => "kg m²/s".to_owned(),
        (_, length) => format!("kg {length}²/s"),
    };
    let mut angular = Panel::new(
        labelled(&format!("L_{}", AXIS[normal]), &angular_unit),
        Scale::Linear,
    );
    angular.size = scale.momentum * scale.length;
    angular.curves = component(voices, |at| &at.angular_momentum, normal);
    panels.push(angular);
    for panel in &mut panels {
        panel.least_span = FLAT;
    }
    CurvesFigure {
        title: scene.heading().to_owned(),
        subtitle: momentum_words(scene).to_owned(),
        x_label: "time [s]".into(),
        panels,
        marks: marks(voices),
    }
}

fn momentum_words(scene: &Scene) -> &'static str {
    let effects = &scene.effects;
    match (
        effects.conserve_momentum(),
        effects.conserve_angular_momentum(),
    ) {
        (true, true) => "momentum p and angular momentum L: the model keeps both",
        (true, false) => "the model keeps the momentum p; the springs' dampers change L",
        (false, _) => "momentum p and angular momentum L: walls, drag or gravity change them",
    }
}

fn component(voices: &[&Voice], vector: fn(&Metrics) -> &Vector3, axis: usize) -> Vec<Curve> {
    let one =
        |(index, voice): (usize, &&Voice)| curve(voice, index, style(index), |at| vector(at)[axis]);
    voices.iter().enumerate().map(one).collect()
}

fn curve(voice: &Voice, color: usize, line: LineStyle, value: impl Fn(&Metrics) -> f64) -> Curve {
    Curve {
        label: voice.name().to_owned(),
        color,
        line,
        weight: Weight::Main,
        points: voice
            .metrics
            .iter()
            .map(|at| [at.time, value(at)])
            .collect(),
    }
}

fn labelled(name: &str, unit: &str) -> String {
    if unit.is_empty() {
        name.to_owned()
    } else {
        format!("{name} [{unit}]")
    }
}
