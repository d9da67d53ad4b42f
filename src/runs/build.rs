//! Names the engine by a SHA-256, so that a kept result is never taken for one of another engine: of the sources
//! on which the result of a run depends, of the versions of all dependencies, and of the compiler.

use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs, io};

use sha2::{Digest, Sha256};

/// The crates on which the result of a run depends.
const CRATES: [&str; 5] = [
    "src/common",
    "src/engine",
    "src/analysis",
    "src/scenario",
    "src/runs",
];

/// The versions of all dependencies.
const LOCK: &str = "Cargo.lock";

fn main() -> io::Result<()> {
    env::set_current_dir("../..")?; // the root of the project
    let mut files = Vec::new();
    for krate in CRATES {
        println!("cargo::rerun-if-changed=../../{krate}");
        collect(Path::new(krate), &mut files)?;
    }
    println!("cargo::rerun-if-changed=../../{LOCK}");
    files.sort();
    let mut hasher = Sha256::new();
    for file in &files {
        hasher.update(file.to_string_lossy().as_bytes());
        for line in fs::read_to_string(file)?.lines().map(str::trim) {
            // Comments change nothing.
            if !line.is_empty() && !line.starts_with("//") {
                hasher.update(line);
                hasher.update("\n");
            }
        }
    }
    // Absent where the package is a dependency of another one.
    hasher.update(fs::read(LOCK).unwrap_or_default());
    let compiler = env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    hasher.update(Command::new(compiler).arg("--version").output()?.stdout);
    let digits: String = hasher.finalize()[..16]
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect();
    println!("cargo::rustc-env=SANDBOX_ENGINE={digits}");
    Ok(())
}

/// Adds all files under `folder`.
fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            collect(&path, files)?;
        } else {
            files.push(path);
        }
    }
    Ok(())
}
