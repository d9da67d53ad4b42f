//! Runs the program as a user does.

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

pub const PROGRAM: &str = env!("CARGO_BIN_EXE_sandbox");

/// Runs the program and returns its output.
pub fn run(arguments: &[&str]) -> Output {
    Command::new(PROGRAM).args(arguments).output().unwrap()
}

/// Runs the program in a working directory and returns its output.
pub fn run_in(folder: &Path, arguments: &[&str]) -> Output {
    let mut program = Command::new(PROGRAM);
    let program = program.args(arguments).current_dir(folder);
    program.output().unwrap()
}

/// Runs the program, expects exit code 0 and returns the JSON on stdout.
pub fn run_json(arguments: &[&str]) -> Value {
    let output = run(arguments);
    assert_eq!(
        output.status.code(),
        Some(0),
        "{arguments:?}: {}",
        stderr(&output)
    );
    json(&output)
}

/// Runs the program and expects exit code `code`, `words` on stderr and nothing on stdout.
pub fn refused(arguments: &[&str], code: i32, words: &[&str]) {
    let output = run(arguments);
    let stderr = stderr(&output);
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {stderr}");
    for word in words {
        assert!(
            stderr.contains(word),
            "{arguments:?}: no {word:?} in {stderr}"
        );
    }
    assert!(output.stdout.is_empty());
}

/// The JSON on stdout.
pub fn json(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).unwrap()
}

pub fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// A program that has not written its first output after this time hangs.
const LONGEST: Duration = Duration::from_secs(120);

/// Starts the program and waits until each of the files is longer than the given number of bytes.
pub fn start_and_wait(arguments: &[&str], files: &[(&Path, u64)]) -> Child {
    let mut child = Command::new(PROGRAM)
        .args(arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let start = Instant::now();
    let length = |file: &Path| fs::metadata(file).map_or(0, |about| about.len());
    while files.iter().any(|(file, bytes)| length(file) <= *bytes) {
        assert!(start.elapsed() < LONGEST, "{arguments:?} hangs");
        assert_eq!(child.try_wait().unwrap(), None, "{arguments:?} has ended");
        std::thread::sleep(Duration::from_millis(2));
    }
    child
}

/// Runs a shell command in which `$1` is the process id of `child`; returns the output of `child` when it ends.
pub fn stop_with(child: Child, shell: &str) -> Output {
    let number = child.id().to_string();
    let mut kill = Command::new("sh")
        .args(["-c", shell, "sh", &number])
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let output = child.wait_with_output().unwrap();
    kill.wait().unwrap();
    output
}

/// A path as text for a command line.
pub fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}
