//! The program as a user runs it.

use std::fs;
use std::path::Path;
use std::process::{Child, Command, Output, Stdio};
use std::time::{Duration, Instant};

pub const PROGRAM: &str = env!("CARGO_BIN_EXE_sandbox");

/// Starts the program, and waits until each of the files is longer than so many bytes.
pub fn under_way(arguments: &[&str], files: &[(&Path, u64)]) -> Child {
    let mut child = Command::new(PROGRAM)
        .args(arguments)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let start = Instant::now();
    let length = |file: &Path| fs::metadata(file).map_or(0, |about| about.len());
    while files.iter().any(|(file, bytes)| length(file) <= *bytes) {
        assert!(start.elapsed() < Duration::from_secs(120));
        assert_eq!(child.try_wait().unwrap(), None, "{arguments:?} has ended");
        std::thread::sleep(Duration::from_millis(2));
    }
    child
}

/// The child's end after a line of shell, in which `$1` is its number.
pub fn ended(child: Child, shell: &str) -> Output {
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

/// A path as it is typed.
pub fn text(path: &Path) -> &str {
    path.to_str().unwrap()
}
