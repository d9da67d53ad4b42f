//! The architecture: crates and modules use only those declared above them, each foreign crate is used in one place,
//! no module has its source elsewhere, there is no `unwrap` outside of tests, no file has more than 500 lines, and no
//! line more than 120 characters. The checks of lengths hold for all Rust files, that of `unwrap` for `experiments`,
//! too.

use std::fs;
use std::path::{Path, PathBuf};

/// The folders with Rust files.
const FOLDERS: [&str; 6] = [
    "src",
    "tests",
    "experiments",
    "examples",
    "benches",
    "python",
];
const LONGEST_FILE: usize = 500;
const LONGEST_LINE: usize = 120;

fn source() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// All Rust files under `folder`, sorted.
pub fn files(folder: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            // Build folders contain generated code.
            if !path.ends_with("target") {
                found.extend(files(&path));
            }
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// A line without its comment. `//` in a string also counts as a comment.
fn without_comment(line: &str) -> &str {
    line.split_once("//").map_or(line, |(code, _)| code)
}

/// The code of a file without comments and tests, as lines numbered from 1.
pub fn code(path: &Path) -> Vec<(usize, String)> {
    let text = fs::read_to_string(path).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    // By convention, the tests are the last module of a file.
    let tests = lines
        .windows(2)
        .position(|pair| pair[0] == "#[cfg(test)]" && pair[1].starts_with("mod "));
    let end = tests.unwrap_or(lines.len());
    let numbered = lines[..end].iter().enumerate();
    numbered
        .map(|(k, line)| (k + 1, without_comment(line).to_owned()))
        .collect()
}

/// The modules that a file declares by `pub mod name;` and `mod name;`, in order.
fn declared(path: &Path) -> Vec<String> {
    let lines = code(path).into_iter();
    let name = |(_, line): (usize, String)| {
        let line = line.trim();
        let rest = line.strip_prefix("pub ").unwrap_or(line);
        let name = rest.strip_prefix("mod ")?.strip_suffix(';')?;
        Some(name.to_owned())
    };
    lines.filter_map(name).collect()
}

/// The crates in `src/` from top to bottom, with the program's own part at the end, and the file that declares the
/// modules of each. The compiler keeps a crate from using those below it.
const CRATES: [(&str, &str); 10] = [
    ("common", "lib.rs"),
    ("engine", "lib.rs"),
    ("analysis", "lib.rs"),
    ("scenario", "lib.rs"),
    ("runs", "lib.rs"),
    ("figures", "lib.rs"),
    ("output", "lib.rs"),
    ("lab", "lib.rs"),
    ("studio", "lib.rs"),
    ("cli", "mod.rs"),
];

/// The files of the crates: without the roots, and without the program's library and `main`.
fn files_of_crates() -> Vec<PathBuf> {
    let mut found = files(&source());
    found.retain(|path| {
        !["lib.rs", "main.rs", "build.rs"]
            .iter()
            .any(|name| path.ends_with(name))
    });
    found
}

/// The crate and the module of a file, such as `engine` and `frame`.
fn place_of(path: &Path) -> (String, String) {
    let inside = path.strip_prefix(source()).unwrap();
    let mut names = inside
        .components()
        .map(|part| part.as_os_str().to_str().unwrap().trim_end_matches(".rs"));
    let krate = names.next().unwrap().to_owned();
    (krate, names.next().unwrap_or_default().to_owned())
}

/// Every identifier directly after `prefix` in a text, including the entries of a `{…}` list.
fn names_after(text: &str, prefix: &str) -> Vec<String> {
    let identifier = |text: &str| -> String {
        let letters = text.trim_start().chars();
        letters
            .take_while(|c| c.is_alphanumeric() || *c == '_')
            .collect()
    };
    let mut found = Vec::new();
    for (at, _) in text.match_indices(prefix) {
        if text[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_') {
            continue;
        }
        let rest = &text[at + prefix.len()..];
        let Some(list) = rest.strip_prefix('{') else {
            found.push(identifier(rest));
            continue;
        };
        // Collect the top-level entries of the list, outside of inner braces.
        let (mut depth, mut entry) = (0, String::new());
        for c in list.chars() {
            match c {
                '{' => depth += 1,
                '}' if depth == 0 => break,
                '}' => depth -= 1,
                ',' if depth == 0 => found.push(identifier(&std::mem::take(&mut entry))),
                _ if depth == 0 => entry.push(c),
                _ => {}
            }
        }
        found.push(identifier(&entry));
    }
    found.retain(|name| !name.is_empty());
    found
}

fn joined(path: &Path) -> String {
    let lines: Vec<String> = code(path).into_iter().map(|(_, line)| line).collect();
    lines.join("\n")
}

#[test]
fn modules_use_only_those_declared_above_them() {
    for path in files_of_crates() {
        let (krate, module) = place_of(&path);
        let (_, root) = CRATES
            .into_iter()
            .find(|(name, _)| *name == krate)
            .unwrap_or_else(|| panic!("{krate} is no crate"));
        let order = declared(&source().join(&krate).join(root));
        let Some(own) = order.iter().position(|name| *name == module) else {
            assert!(path.ends_with(root), "{} is in no module", path.display());
            continue;
        };
        let text = joined(&path);
        let from = match krate.as_str() {
            "cli" => "crate::cli::",
            _ => "crate::",
        };
        let mut used = names_after(&text, from);
        // From a module's own file, `super` is its crate.
        let own_file = if path.ends_with("mod.rs") {
            path.parent()
        } else {
            Some(path.as_path())
        };
        if own_file.and_then(Path::parent) == Some(source().join(&krate).as_path()) {
            used.extend(names_after(&text, "super::"));
        }
        for name in used {
            // Items of the root itself, such as re-exports, are of no module.
            let Some(place) = order.iter().position(|other| *other == name) else {
                continue;
            };
            assert!(
                place <= own,
                "{}: `{module}` uses `{name}`, which stands below it",
                path.display()
            );
        }
    }
}

#[test]
fn every_module_has_its_source_beside_it() {
    for path in files(&source()) {
        for (k, line) in code(&path) {
            let elsewhere = line.trim_start().starts_with("#[path");
            assert!(!elsewhere, "{}:{k}: {line}", path.display());
        }
    }
}

/// Every line of code that uses `krate` outside of the modules in `homes`.
fn strays(krate: &str, homes: &[&str]) -> Vec<String> {
    let names = |line: &str| {
        let path = format!("{krate}::");
        let starts = line
            .match_indices(&path)
            .any(|(at, _)| !line[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_'));
        let used = line.trim_start().strip_prefix(&format!("use {krate}"));
        starts || used.is_some_and(|rest| rest.starts_with([';', ' ']))
    };
    let mut found = Vec::new();
    for path in files_of_crates() {
        let (krate, module) = place_of(&path);
        if homes.contains(&krate.as_str()) || homes.contains(&format!("{krate}/{module}").as_str())
        {
            continue;
        }
        let lines = code(&path).into_iter().filter(|(_, line)| names(line));
        found.extend(lines.map(|(k, line)| format!("{}:{k}: {line}", path.display())));
    }
    found
}

#[test]
fn each_foreign_crate_is_used_in_one_place() {
    for (krate, home) in [
        ("parry2d", "engine/geometry"),
        ("wkt", "scenario/floor_plan"),
        ("geojson", "scenario/floor_plan"),
        ("roxmltree", "scenario/floor_plan"),
        ("hdf5_pure", "scenario/trajectories"),
        ("rerun", "output/recording"),
        ("clap", "cli"),
        ("clap_complete", "cli"),
        ("clap_mangen", "cli"),
        ("signal_hook", "cli"),
        ("plotters", "figures/plot"),
        ("plotters_backend", "figures/plot"),
        ("pdf_writer", "figures/plot"),
        ("subsetter", "figures/plot"),
        ("gif", "figures/plot"),
        ("png", "figures/plot"),
        ("colorgrad", "figures/colors"),
        ("fearless_simd", "engine/pairs"),
        ("sysinfo", "lab/machine"),
        ("tiny_http", "studio/server"),
        ("open", "cli/studio"),
        ("i_overlay", "scenario/floor_plan"),
    ] {
        assert_eq!(strays(krate, &[home]), Vec::<String>::new());
    }
    for (krate, homes) in [
        ("spade", ["engine/routes", "analysis/voronoi"]),
        ("statrs", ["engine/distribution", "common/statistics"]),
        ("rusqlite", ["scenario/trajectories", "output/trajectory"]), // reads and writes
    ] {
        assert_eq!(strays(krate, &homes), Vec::<String>::new());
    }
}

#[test]
fn no_unwrap_outside_tests() {
    let experiments = Path::new(env!("CARGO_MANIFEST_DIR")).join("experiments/src");
    for path in files(&source()).into_iter().chain(files(&experiments)) {
        for (k, line) in code(&path) {
            assert!(
                !line.contains(".unwrap()"),
                "{}:{k}: {line}",
                path.display()
            );
        }
    }
}

#[test]
fn no_file_is_longer_than_five_hundred_lines() {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR"));
    for path in FOLDERS
        .iter()
        .flat_map(|folder| files(&manifest.join(folder)))
    {
        let length = fs::read_to_string(&path).unwrap().lines().count();
        assert!(length <= LONGEST_FILE, "{}: {length} lines", path.display());
    }
}

#[test]
fn no_line_is_longer_than_120_characters_except_in_tables() {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR"));
    for path in FOLDERS
        .iter()
        .flat_map(|folder| files(&manifest.join(folder)))
    {
        for (k, line) in fs::read_to_string(&path).unwrap().lines().enumerate() {
            let is_table = ["//! |", "/// |"].map(|row| line.trim_start().starts_with(row));
            let is_short = line.chars().count() <= LONGEST_LINE;
            assert!(
                is_short || is_table.contains(&true),
                "{}:{}: {line}",
                path.display(),
                k + 1
            );
        }
    }
}

#[test]
fn every_test_file_is_part_of_a_test_program() {
    let tests = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    let programs = ["engine", "program"];
    let lists = programs.map(|name| fs::read_to_string(tests.join(format!("{name}.rs"))).unwrap());
    for entry in fs::read_dir(&tests).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_stem().unwrap().to_str().unwrap();
        if path.extension().is_some_and(|extension| extension == "rs") && !programs.contains(&name)
        {
            let listed = lists
                .iter()
                .any(|list| list.contains(&format!("\nmod {name};\n")));
            assert!(
                listed,
                "tests/{name}.rs is in no test program: its tests never run"
            );
        }
    }
}

#[test]
fn the_helpers_of_these_checks_work() {
    let text = "use crate::{agents::Agents, math::{Vector, direction}, frame};\nlet x = crate::kernel::density(0.0);";
    assert_eq!(
        names_after(text, "crate::"),
        ["agents", "math", "frame", "kernel"]
    );
    assert_eq!(without_comment("let a = 1; // crate::cli"), "let a = 1; ");
    assert!(!strays("nalgebra", &[]).is_empty());
}
