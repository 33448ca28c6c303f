//! The study of effects: what is never felt, what a change is worth, and what must change nothing.

use carom::case::Library;
use carom::engine::engine;
use carom::scene::Effect;
use carom::scene::{Contact, Drag, Rest, Scene};
use carom::study::{Change, EffectStudy, Timing, effects};

use crate::command::carom;
use crate::scenes::{body, oblique, scene};

const DT: f64 = 0.01;

fn study(scene: &Scene, names: &[&str]) -> EffectStudy {
    let specs: Vec<_> = names.iter().map(|name| engine(name).unwrap()).collect();
    let timing = Timing {
        seed: 1,
        repetitions: 1,
    };
    effects(scene, &specs, DT, timing).unwrap()
}

fn never_felt(study: &EffectStudy) -> Vec<Effect> {
    study
        .never_felt()
        .iter()
        .map(|never| never.effect)
        .collect()
}

/// The balls never get slower than 0.5, so a rest speed of 0.1 is declared and never felt, nor
/// is contact once they miss each other; the other way round each of them is.
#[test]
fn what_is_declared_and_never_felt_is_named_and_nothing_else() {
    let mut calm = oblique(0.9, [2.0, 1.0]);
    calm.effects.rest = Some(Rest { speed: 0.1 });
    assert_eq!(never_felt(&study(&calm, &["lecture"])), [Effect::Rest]);
    calm.bodies[1].position[1] += 50.0;
    assert_eq!(
        never_felt(&study(&calm, &["lecture"])),
        [Effect::Contact, Effect::Rest]
    );
    let mut stopping = oblique(0.9, [2.0, 1.0]);
    stopping.effects.rest = Some(Rest { speed: 2.0 });
    assert_eq!(never_felt(&study(&stopping, &["lecture"])), []);
}

/// One ball, k = 0.5 kg/s, 2 kg, 3 m/s, 4 s. The lecture's scheme gives, with q = 1 - h k/m,
/// `x_n = h v_0 q (1 - q^n) / (1 - q)`, and without drag `x = v_0 t`: the difference to
/// rounding, 400 steps of half an ulp of 8 each, 4e-13. The model's own closed form
/// `v_0 (t - (1 - E)/r)`, r = k/m, E = exp(-r t), is off by `h v_0 (1 - E - r t E/2)`, the first
/// term of the series of the above in h, 0.3 % here, and by terms of the size `(h r)^2 v_0 t`.
#[test]
fn switching_drag_off_changes_the_answer_by_the_closed_form() {
    let (k, mass, speed, duration) = (0.5, 2.0, 3.0, 4.0_f64);
    let ball = body("a", mass, 0.1, [0.0; 3], [speed, 0.0, 0.0]);
    let mut scene = scene(duration, 0.5, vec![ball], Default::default());
    scene.effects.drag = Some(Drag { coefficient: k });
    let study = study(&scene, &["lecture"]);
    let row = study.row("lecture", Some(Effect::Drag)).unwrap();
    let found = row.difference.unwrap().position_max;
    assert_eq!(row.change, Change::Off);
    let q: f64 = 1.0 - DT * k / mass;
    let dragged = DT * speed * q * (1.0 - q.powi(400)) / (1.0 - q);
    let scheme = speed * duration - dragged;
    assert!((found - scheme).abs() < 4e-13, "{found} for {scheme}");
    let rate = k / mass;
    let decay = (-rate * duration).exp();
    let model = speed * (duration - (1.0 - decay) / rate);
    let first_order = DT * speed * (1.0 - decay - 0.5 * rate * duration * decay);
    let second_order = (DT * rate).powi(2) * speed * duration;
    assert!(
        (found - model - first_order).abs() < second_order,
        "{found} for {model}"
    );
    assert_eq!(
        study.row("lecture", Some(Effect::Springs)),
        None,
        "one body has no springs"
    );
}

#[test]
fn neutral_effects_change_nothing_on_the_hand_written_engine() {
    let mut seen = 0;
    for name in [
        "shot-2-61",
        "billiard-pair",
        "cluster-8",
        "falling-pair",
        "spring-chain",
        "kepler-e06",
    ] {
        let scene = Library::Embedded.case(name).unwrap().scene;
        for row in study(&scene, &["lecture"]).rows {
            if row.change == Change::OnNeutral {
                let difference = row.difference.unwrap();
                assert!(difference.is_none, "{name}: {row:?}");
                assert_eq!(
                    (difference.impacts_lost, difference.impacts_gained),
                    (0, 0),
                    "{name}"
                );
                seen += 1;
            }
        }
    }
    assert!(seen >= 15, "only {seen} neutral effects");
}

/// Two balls meet once; without contact they do not.
#[test]
fn impacts_lost_and_gained_are_counted() {
    let scene = oblique(0.9, [2.0, 1.0]);
    let study = study(&scene, &["lecture"]);
    let unchanged = study.row("lecture", None).unwrap();
    assert_eq!((unchanged.impacts, unchanged.difference), (Some(1), None));
    let off = study.row("lecture", Some(Effect::Contact)).unwrap();
    let difference = off.difference.unwrap();
    assert_eq!(
        (
            off.impacts,
            difference.impacts_lost,
            difference.impacts_gained
        ),
        (Some(0), 1, 0)
    );
    assert_eq!(difference.compared_until_s, 2.0);
    assert!(!difference.is_none && difference.position_max > 0.1);
    let [before, after] = [unchanged.work, off.work].map(Option::unwrap);
    assert_eq!(
        (before.steps, before.pair_tests),
        (after.steps, after.steps)
    );
    assert_eq!(after.pair_tests, 0);
    assert!(unchanged.price.unwrap().median_ms_per_sim_s > 0.0);
    assert_eq!(unchanged.price.unwrap().ratio, 1.0);
}

/// Rest beside springs has no exact meaning: those rows are refused, the others are not; and
/// where the scene itself is refused, there is one row that says so.
#[test]
fn a_refusal_stands_in_its_row() {
    let mut scene = oblique(0.9, [2.0, 1.0]);
    scene.effects.rest = Some(Rest { speed: 0.1 });
    let own = study(&scene, &["exact-fast"]);
    let refused: Vec<_> = own
        .rows
        .iter()
        .filter(|row| row.outcome == "Refused")
        .map(|row| row.effect.unwrap())
        .collect();
    assert!(refused.contains(&Effect::Springs), "{refused:?}");
    assert!(own.row("exact-fast", None).unwrap().price.is_some());
    for row in own.rows.iter().filter(|row| row.outcome == "Refused") {
        assert!(row.outcome_text.contains("cannot compute"), "{row:?}");
        assert_eq!((row.difference, row.price, row.work), (None, None, None));
    }
    scene.effects.springs = Effect::Springs
        .switched(&oblique(0.9, [2.0, 1.0]))
        .unwrap()
        .1
        .effects
        .springs;
    let [row] = study(&scene, &["exact-fast"]).rows.try_into().unwrap();
    assert_eq!((row.outcome, row.change), ("Refused", Change::Unchanged));
}

/// A variant that blows up is a result: timed as far as it goes, compared as far as both go.
#[test]
fn a_run_that_blows_up_keeps_its_row() {
    let mut scene = oblique(0.9, [2.0, 1.0]);
    scene.effects.contact = Some(Contact { restitution: 1.0 });
    scene.effects.drag = Some(Drag { coefficient: 1e30 });
    let study = study(&scene, &["lecture"]);
    let unchanged = study.row("lecture", None).unwrap();
    assert_eq!((unchanged.outcome, unchanged.price), ("NonFinite", None));
    let off = study.row("lecture", Some(Effect::Drag)).unwrap();
    assert_eq!(off.outcome, "Finished");
    assert!(!off.difference.unwrap().is_none);
}

#[test]
fn the_command_writes_a_table_and_a_page_and_complains_in_one_line() {
    let scratch = tempfile::tempdir().unwrap();
    let effects = ["effects", "shot-2-61", "--engine", "lecture"];
    let short = [&effects[..], &["--repetitions", "2"]].concat();
    let (code, said, complaint) = carom(scratch.path(), &short);
    assert_eq!(code, 0, "{complaint}");
    for part in ["unchanged", "cushions", "on, neutral", "Written to"] {
        assert!(said.contains(part), "{said}");
    }
    let folder = scratch.path().join("runs/effects-shot-2-61");
    let table = std::fs::read_to_string(folder.join("effects.csv")).unwrap();
    let mut lines = table.lines();
    assert_eq!(
        lines.next().unwrap(),
        "scene,engine,effect,change,position_difference_max,impacts,cost_ms_per_sim_s,\
         cost_ratio,ratio_low,ratio_high,outcome"
    );
    // The scene as it stands, four effects off, three on.
    assert_eq!(lines.count(), 8);
    let page = std::fs::read_to_string(folder.join("README.md")).unwrap();
    let rows = page.lines().filter(|line| line.starts_with("| lecture |"));
    assert_eq!(rows.count(), 8, "{page}");
    let json = [&short[..], &["--json", "--out", "x"]].concat();
    let (_, said, _) = carom(scratch.path(), &json);
    let study: serde_json::Value = serde_json::from_str(&said).unwrap();
    assert_eq!(study["rows"].as_array().unwrap().len(), 8);
    assert!(study["rows"][1]["work"]["steps"].as_u64().unwrap() > 0);
    for wrong in [
        &["effects", "shot-2-61", "--repetitions", "0"][..],
        &["effects", "no-such-scene"],
        &["effects", "shot-2-61", "--engine", "nobody"],
        &["effects", "shot-2-61", "--engine", "lecture,lecture"],
        &["effects", "shot-2-61", "--dt", "-1"],
    ] {
        let wrong = [wrong, &["--out", "never"]].concat();
        let (code, _, said) = carom(scratch.path(), &wrong);
        assert_eq!((code, said.trim_end().lines().count()), (2, 1), "{said}");
        assert!(!scratch.path().join("never").exists(), "{wrong:?}");
    }
}
