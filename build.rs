//! Names the engine: a hash of its sources, so that a kept result is never taken for that of another.

use std::collections::hash_map::DefaultHasher;
use std::fs;
use std::hash::{Hash, Hasher};
use std::io;
use std::path::{Path, PathBuf};

/// The last module of `src/lib.rs` on which the result of a run depends.
const LAST: &str = "drive";

fn main() -> io::Result<()> {
    println!("cargo::rerun-if-changed=src");
    let list = fs::read_to_string("src/lib.rs")?;
    let modules = list
        .lines()
        .filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';'));
    let mut files = Vec::new();
    for module in modules {
        collect(&Path::new("src").join(module), &mut files)?;
        files.push(Path::new("src").join(format!("{module}.rs")));
        if module == LAST {
            break;
        }
    }
    files.sort();
    let mut hasher = DefaultHasher::new();
    for file in files.iter().filter(|file| file.is_file()) {
        file.hash(&mut hasher);
        for line in code(&fs::read_to_string(file)?) {
            line.hash(&mut hasher);
        }
    }
    println!("cargo::rustc-env=SANDBOX_ENGINE={:016x}", hasher.finish());
    Ok(())
}

/// What is left of a file without lines of comment and without its tests, which are its last module.
fn code(text: &str) -> impl Iterator<Item = &str> {
    let lines = text.lines().map(str::trim);
    lines
        .take_while(|line| *line != "#[cfg(test)]")
        .filter(|line| !line.is_empty() && !line.starts_with("//"))
}

/// All files under `folder`, if there is one.
fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    if folder.is_dir() {
        for entry in fs::read_dir(folder)? {
            let path = entry?.path();
            collect(&path, files)?;
            files.push(path);
        }
    }
    Ok(())
}
