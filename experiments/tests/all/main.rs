//! Tests of the experiments, in one program: it links faster than three.

mod compare;
mod domains;
mod physics;
#[path = "../../../tests/common/reports.rs"]
mod reports;
mod walls;

use std::process::{Command, Output};

/// Runs the program as a user does.
fn run(arguments: &[&str]) -> Output {
    let mut program = Command::new(env!("CARGO_BIN_EXE_experiments"));
    program.args(arguments).output().unwrap()
}
