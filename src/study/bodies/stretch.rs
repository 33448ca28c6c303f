//! How many steps of an engine are timed, by the work that it has been seen to do.

/// Steps before the timed ones: the first fill caches and make room, once for all.
pub(super) const LEAD: usize = 2;
/// With fewer timed steps there is no point.
pub(super) const STEPS_MIN: usize = 3;
/// More say nothing new: then a run of the fastest engine is repeated instead.
const STEPS_MAX: u64 = 400;
/// Engines that can pay for it get so many steps where others can not.
const STEPS_WANTED: u64 = 32;

/// The work of all pairs of bodies in a step, and of the bodies.
#[allow(clippy::cast_precision_loss, reason = "far below 2^53 pairs")]
pub(super) fn all_pairs(bodies: usize) -> f64 {
    let count = bodies as f64;
    count + 0.5 * count * (count - 1.0)
}

/// The work that a step of an engine will take, from what it took with fewer bodies.
///
/// `seen`: numbers of bodies, ascending, and the work a step. Along the power law through the
/// last two; with one, as all pairs grow; with none, all pairs.
pub(super) fn expected(seen: &[(usize, f64)], bodies: usize) -> f64 {
    #[allow(clippy::cast_precision_loss, reason = "far below 2^53 bodies")]
    let count = |bodies: usize| bodies as f64;
    match seen {
        [] => all_pairs(bodies),
        [(fewer, work)] => work * all_pairs(bodies) / all_pairs(*fewer),
        [.., (first, less), (last, more)] => {
            let power = (more / less).ln() / (count(*last) / count(*first)).ln();
            more * (count(bodies) / count(*last)).powf(power.max(1.0))
        }
    }
}

/// How many steps are timed where a step takes so much work; none if not even a few can be paid.
///
/// All engines take as many as the budget allows for all pairs, so that they see the same stretch
/// of the motion; fewer where a step of their own is dearer, and some at least where it is not.
pub(super) fn steps(bodies: usize, work: f64, budget: u64) -> Option<usize> {
    #[allow(
        clippy::cast_precision_loss,
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "counts, clamped"
    )]
    let affordable = |work: f64| (budget as f64 / work).min(1e6) as u64;
    let common = affordable(all_pairs(bodies)).clamp(STEPS_WANTED, STEPS_MAX);
    let own = affordable(work).min(common + LEAD as u64);
    let timed = usize::try_from(own).ok()?.checked_sub(LEAD)?;
    (timed >= STEPS_MIN).then_some(timed)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_grows_as_it_has_grown() {
        assert_eq!(expected(&[], 4), 10.0);
        assert_eq!(expected(&[(4, 20.0)], 10), 20.0 * 55.0 / 10.0);
        let cubic = [(10, 1e3), (100, 1e6)];
        assert!((expected(&cubic, 1000) / 1e9 - 1.0).abs() < 1e-9);
        // What has become cheaper is not taken to go on so.
        assert_eq!(expected(&[(10, 100.0), (20, 50.0)], 40), 100.0);
    }

    /// 100 bodies are 5050 units a step.
    #[test]
    fn steps_are_as_many_as_the_budget_pays() {
        let steps = |work, budget| steps(100, work, budget);
        assert_eq!(steps(5050.0, 1_000_000_000), Some(400));
        assert_eq!(steps(5050.0, 505_000), Some(98));
        assert_eq!(steps(5050.0, 5 * 5050), Some(3));
        assert_eq!(steps(5050.0, 5 * 5050 - 1), None);
        assert_eq!(steps(100.0, 5 * 5050), Some(32), "a cheap step");
        assert_eq!(steps(50_500.0, 505_000), Some(8), "a dear step");
    }
}
