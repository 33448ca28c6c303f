//! rapier3d 0.35.0-beta.0 as an external solver of carom.

#[path = "../../shared/scene.rs"]
mod scene;
#[path = "../../shared/glam.rs"]
mod version;
#[path = "../../shared/worker.rs"]
mod worker;

fn main() -> std::process::ExitCode {
    worker::main()
}
