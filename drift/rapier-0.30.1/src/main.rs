//! rapier3d 0.30.1 as an external solver of carom.

#[path = "../../shared/scene.rs"]
mod scene;
#[path = "../../shared/nalgebra.rs"]
mod version;
#[path = "../../shared/worker.rs"]
mod worker;

fn main() -> std::process::ExitCode {
    worker::main()
}
