//! Whether Rapier's worlds give the same bits again.

use carom::engine::{engine, prepare};
use carom::physics::BodyState;
use carom::recording::initial_states;
use carom::scene::Scene;
use carom::scene::generate::Gas;

use super::RAPIER;

/// Enough bodies that a build with `rapier-parallel` shares the work out, and a gas dense enough
/// that everything has met something when it ends.
fn gas() -> Scene {
    let mut scene = Gas::thinned(2000, 0.3, 1).unwrap();
    scene.duration = 0.5;
    scene.sample_every = 0.5;
    scene
}

/// The states at the end, on so many threads.
fn end(scene: &Scene, name: &str, threads: usize) -> Vec<BodyState> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads);
    pool.build().unwrap().install(|| {
        let mut simulation = prepare(scene, &engine(name).unwrap(), 0.01).unwrap();
        assert_eq!(simulation.advance_to(1, None), None);
        let mut states = initial_states(scene);
        simulation.state_into(&mut states);
        states
    })
}

/// A world steps on the threads of the pool that it is called from: alone, with as many as there
/// are cores, and with more, it gives the same bits. In a build without `rapier-parallel` there
/// is one thread in any case, and the bits are those of a second run.
#[test]
fn a_world_gives_the_same_bits_again_on_any_number_of_threads() {
    let scene = gas();
    for name in RAPIER {
        let once = end(&scene, name, 1);
        let moved = scene.bodies.iter().zip(&once);
        let turned = moved.filter(|(before, after)| {
            let apart = after.velocity - carom::physics::Vector3::from(before.velocity);
            apart.norm() > 0.1
        });
        assert!(turned.count() > 1000, "{name}: hardly anything met");
        for threads in [1, 2, 4] {
            assert!(
                once == end(&scene, name, threads),
                "{name}, {threads} threads"
            );
        }
    }
}
