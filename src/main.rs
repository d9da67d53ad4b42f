//! The `sandbox` program: parse, run, print the error, exit code.

fn main() -> std::process::ExitCode {
    sandbox::cli::main()
}
