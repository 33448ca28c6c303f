//! The `lecture` engine against closed forms: exact where its method is exact, and else of
//! the order that symplectic Euler has.

use carom::scene::{Contact, Cushions, Drag, Effects, Gravity, Spring};

use crate::scenes::{body, lecture, scene};

/// The slope of log(error) over log(dt), by least squares.
fn order(points: &[(f64, f64)]) -> f64 {
    let n = points.len() as f64;
    let logs: Vec<_> = points
        .iter()
        .map(|(dt, error)| (dt.ln(), error.ln()))
        .collect();
    let mean = |of: fn(&(f64, f64)) -> f64| logs.iter().map(of).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let covariance: f64 = logs.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    let variance: f64 = logs.iter().map(|p| (p.0 - x).powi(2)).sum();
    covariance / variance
}

const LADDER: [f64; 5] = [0.02, 0.01, 0.005, 0.0025, 0.00125];

/// v = v0 exp(-k t/m). Euler gives (1 - k dt/m)^n, first order.
#[test]
fn drag_is_first_order() {
    let (k, m, v0, t) = (0.5, 1.6, 3.0, 2.0);
    let bodies = vec![body("a", m, 0.1, [0.0; 3], [v0, 0.0, 0.0])];
    let effects = Effects {
        drag: Some(Drag { coefficient: k }),
        ..Effects::default()
    };
    let scene = scene(t, 0.5, bodies, effects);
    let exact = v0 * (-k * t / m).exp();
    let points = LADDER.map(|dt| {
        let end = lecture(&scene, dt).sample(4)[0].velocity.x;
        (dt, (end - exact).abs())
    });
    let order = order(&points);
    assert!((0.95..1.05).contains(&order), "order {order}");
}

/// Kick then drift under constant force: x(n dt) = x0 + v0 t + g (t² + t dt)/2, exactly.
#[test]
fn gravity_is_off_by_half_a_step() {
    let bodies = vec![body("a", 2.0, 0.1, [0.0, 9.0, 0.0], [1.0, 0.5, 0.0])];
    let acceleration = [0.0, -9.81, 0.0];
    let effects = Effects {
        gravity: Some(Gravity { acceleration }),
        ..Effects::default()
    };
    let scene = scene(1.0, 0.25, bodies, effects);
    let (t, dt) = (1.0, 0.25 / 25.0);
    let end = lecture(&scene, dt).sample(4)[0];
    let expected = 9.0 + 0.5 * t - 9.81 * (t * t + t * dt) / 2.0;
    // 100 steps of half an ulp of 9 (9e-16) each.
    assert!(
        (end.position.y - expected).abs() < 1e-13,
        "{} {expected}",
        end.position.y
    );
    assert!((end.velocity.y - (0.5 - 9.81)).abs() < 1e-13);
}

/// An undamped pair: l(t) = l0 + A cos(w t), w² = k (1/ma + 1/mb). Symplectic Euler's position
/// error is of first order.
#[test]
fn a_spring_is_first_order() {
    let (k, l0, stretch) = (40.0, 1.2, 0.3);
    let bodies = vec![
        body("a", 1.0, 0.1, [0.0; 3], [0.0; 3]),
        body("b", 2.0, 0.1, [l0 + stretch, 0.0, 0.0], [0.0; 3]),
    ];
    let spring = Spring {
        between: ["a".into(), "b".into()],
        stiffness: k,
        rest_length: l0,
        damping: 0.0,
    };
    let effects = Effects {
        springs: vec![spring],
        ..Effects::default()
    };
    let scene = scene(1.0, 0.25, bodies, effects);
    let w = (k * 1.5_f64).sqrt();
    let points = LADDER.map(|dt| {
        let states = lecture(&scene, dt);
        let l = states.sample(4)[1].position.x - states.sample(4)[0].position.x;
        (dt, (l - (l0 + stretch * w.cos())).abs())
    });
    let order = order(&points);
    assert!((0.9..1.1).contains(&order), "order {order}");
}

/// A free flight takes no forces, and an impact between two samples leaves straight lines, so
/// velocities after a head-on impact are exact whatever the step; positions are off by at most
/// what the spheres travel within one step, both before and after it.
#[test]
fn head_on_velocities_are_exact_at_every_step() {
    for (e, m) in [(1.0, 3.0), (0.5, 1.0), (0.1, 1.0), (0.0, 1e3)] {
        let bodies = vec![
            body("a", m, 0.5, [-2.0, 0.0, 0.0], [2.0, 0.0, 0.0]),
            body("b", 1.0, 0.5, [1.0, 0.0, 0.0], [-1.0, 0.0, 0.0]),
        ];
        let effects = Effects {
            contact: Some(Contact { restitution: e }),
            ..Effects::default()
        };
        let scene = scene(2.0, 0.5, bodies, effects);
        // Momentum and restitution: two equations for two velocities.
        let va = (m * 2.0 - 1.0 - e * 3.0) / (m + 1.0);
        let vb = (m * 2.0 - 1.0 + e * m * 3.0) / (m + 1.0);
        let (t_impact, x_impact) = (2.0 / 3.0, -2.0 + 4.0 / 3.0);
        for dt in LADDER {
            let end = lecture(&scene, dt).sample(4).to_vec();
            assert!(
                (end[0].velocity.x - va).abs() < 1e-14,
                "e {e} m {m} dt {dt}"
            );
            assert!(
                (end[1].velocity.x - vb).abs() < 1e-12,
                "e {e} m {m} dt {dt}"
            );
            let exact = x_impact + va * (2.0 - t_impact);
            let reach = 2.0 * 3.0 * (1.0 + e) * dt;
            assert!(
                (end[0].position.x - exact).abs() <= reach,
                "e {e} m {m} dt {dt}"
            );
        }
    }
}

/// The mirror and the push of 2 x penetration put a ball exactly where a bounce at the right
/// time would have, for e = 1 and no forces.
#[test]
fn an_elastic_cushion_is_exact() {
    let bodies = vec![body("a", 1.0, 0.25, [0.5, 0.0, 0.0], [1.0, 0.0, 0.7])];
    let cushions = Cushions {
        half_width: 1.0,
        half_length: 9.0,
        half_height: None,
        restitution: 1.0,
    };
    let effects = Effects {
        cushions: Some(cushions),
        ..Effects::default()
    };
    let scene = scene(1.0, 0.125, bodies, effects);
    let end = lecture(&scene, 0.01).sample(8)[0];
    // 0.25 to the wall, then back 0.75: 100 additions of half an ulp of 1.
    assert!((end.position.x - 0.0).abs() < 2e-14, "{}", end.position.x);
    assert_eq!(end.velocity.x, -1.0);
}

/// With half_height the box is closed in y too; without it y is free.
#[test]
fn half_height_closes_the_box() {
    let run = |half_height| {
        let bodies = vec![body("a", 1.0, 0.25, [0.0, 0.0, 0.0], [0.0, -1.0, 0.0])];
        let cushions = Cushions {
            half_width: 1.0,
            half_length: 1.0,
            half_height,
            restitution: 0.5,
        };
        let effects = Effects {
            cushions: Some(cushions),
            ..Effects::default()
        };
        lecture(&scene(2.0, 0.5, bodies, effects), 0.01).sample(4)[0]
            .velocity
            .y
    };
    assert_eq!(run(None), -1.0);
    assert_eq!(run(Some(1.0)), 0.5);
}
