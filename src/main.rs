//! The command line of carom.

fn main() -> std::process::ExitCode {
    carom::cli::main()
}
