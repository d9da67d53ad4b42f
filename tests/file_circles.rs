//! Files of a crate use each other in one direction: of two files, at most one needs the other. The circles that exist
//! are listed here, and the list may only shrink.
//!
//! A file uses those that its paths name: `use` declarations, and paths in the code that begin with `crate`, `super` or
//! `self`. An item that a module shows by `pub use` is of the file that has it. A file may use the modules that it is
//! inside of: what they share stands there.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

/// Every circle, as the files in it without their ending, sorted. A draft becomes a scenario, and a scenario is read as
/// a draft.
const KNOWN: [&[&str]; 1] = [&["scenario/read/draft", "scenario/read/scenario"]];

/// The names from the crate down to a file, such as `engine`, `simulation`, `plans`.
type Names = Vec<String>;

/// A file without comments and tests.
fn code(text: &str) -> String {
    let code = text
        .split_once("\n#[cfg(test)]\nmod ")
        .map_or(text, |(code, _)| code);
    let lines = code.lines();
    let lines = lines.map(|line| line.split_once("//").map_or(line, |(code, _)| code));
    lines.collect::<Vec<_>>().join("\n")
}

/// The code of all files by the names of their modules.
fn sources() -> BTreeMap<Names, String> {
    fn collect(folder: &Path, names: &Names, found: &mut BTreeMap<Names, String>) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let stem = path.file_stem().unwrap().to_str().unwrap();
            let inside = [names.as_slice(), &[stem.to_owned()]].concat();
            if path.is_dir() {
                collect(&path, &inside, found);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let is_root = ["mod", "lib"].contains(&stem);
                let module = if is_root { names.clone() } else { inside };
                found.insert(module, code(&fs::read_to_string(&path).unwrap()));
            }
        }
    }
    let mut found = BTreeMap::new();
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    collect(&source, &Names::new(), &mut found);
    found.retain(|file, _| !file.is_empty() && file[0] != "main");
    found
}

/// The paths of a tree of uses, such as `a::b` and `a::c` of `a::{b, c}`.
fn paths(tree: &str) -> Vec<Names> {
    let (mut depth, mut entry, mut entries) = (0, String::new(), Vec::new());
    for letter in tree.chars() {
        depth += i32::from(letter == '{') - i32::from(letter == '}');
        match letter {
            ',' if depth == 0 => entries.push(std::mem::take(&mut entry)),
            _ => entry.push(letter),
        }
    }
    entries.push(entry);
    let mut found = Vec::new();
    for entry in entries
        .iter()
        .map(|entry| entry.trim())
        .filter(|entry| !entry.is_empty())
    {
        let (start, inner) = entry.split_once('{').unwrap_or((entry, ""));
        let path = start.split(" as ").next().unwrap();
        let path: Names = path
            .split("::")
            .map(str::trim)
            .filter(|name| !name.is_empty())
            .map(str::to_owned)
            .collect();
        if inner.is_empty() {
            found.push(path);
        } else {
            let inner = paths(inner.strip_suffix('}').unwrap());
            found.extend(inner.into_iter().map(|rest| [path.clone(), rest].concat()));
        }
    }
    found
}

/// The paths that code declares by `use`, each with whether it is shown to others.
fn uses(code: &str) -> Vec<(Names, bool)> {
    let mut found = Vec::new();
    for (at, word) in code.match_indices("use ") {
        let line = code[..at].rsplit('\n').next().unwrap().trim();
        if !line.is_empty() && !line.starts_with("pub") {
            continue; // in a string
        }
        let (tree, _) = code[at + word.len()..].split_once(';').unwrap();
        let tree = paths(tree).into_iter();
        found.extend(tree.map(|path| (path, line.starts_with("pub"))));
    }
    found
}

/// The paths in code that begin with `crate`, `super` or `self`.
fn written_out(code: &str) -> Vec<Names> {
    let is_part = |letter: char| letter.is_alphanumeric() || letter == '_' || letter == ':';
    let words = code.split(|letter| !is_part(letter));
    let paths = words.filter(|word| {
        ["crate::", "super::", "self::"]
            .iter()
            .any(|start| word.starts_with(start))
    });
    let names = paths.map(|path| path.split("::").filter(|name| !name.is_empty()));
    names
        .map(|names| names.map(str::to_owned).collect())
        .collect()
}

struct Files {
    /// The paths that each file uses.
    used: BTreeMap<Names, Vec<Names>>,
    /// The paths of the items that each file shows to others, by their last name.
    shown: BTreeMap<Names, BTreeMap<String, Names>>,
}

impl Files {
    fn of(sources: &BTreeMap<Names, String>) -> Self {
        let (mut used, mut shown) = (BTreeMap::new(), BTreeMap::new());
        for (file, code) in sources {
            let (public, private): (Vec<_>, Vec<_>) =
                uses(code).into_iter().partition(|(_, is_shown)| *is_shown);
            let mut own: Vec<Names> = private.into_iter().map(|(path, _)| path).collect();
            own.extend(written_out(code));
            used.insert(file.clone(), own);
            let public = public.into_iter().map(|(path, _)| path);
            let by_name = public.filter_map(|path| Some((path.last()?.clone(), path)));
            shown.insert(file.clone(), by_name.collect());
        }
        Self { used, shown }
    }

    /// The file of this crate that has what `path` names in `file`.
    fn file_of(&self, file: &Names, path: &[String], steps: usize) -> Option<Names> {
        let (first, mut rest) = path.split_first()?;
        let mut module = match first.as_str() {
            "crate" if rest.first().is_some_and(|name| name == "cli") => Names::new(),
            "crate" => file[..1].to_vec(),
            "self" => file.clone(),
            "super" => file[..file.len() - 1].to_vec(),
            _ => {
                rest = path;
                file.clone()
            }
        };
        while let Some((name, others)) = rest.split_first() {
            let inner = [module.as_slice(), std::slice::from_ref(name)].concat();
            if name == "super" {
                module.pop();
            } else if self.used.contains_key(&inner) {
                module = inner;
            } else {
                break;
            }
            rest = others;
        }
        if rest == path {
            return None; // of another crate
        }
        let shown = rest
            .first()
            .and_then(|name| self.shown.get(&module)?.get(name));
        let Some(shown) = shown.filter(|_| steps > 0) else {
            return Some(module);
        };
        let path = [shown.as_slice(), &rest[1..]].concat();
        self.file_of(&module, &path, steps - 1).or(Some(module))
    }

    /// The files that each file uses, without those that it is inside of.
    fn arrows(&self) -> BTreeMap<Names, BTreeSet<Names>> {
        let arrows = self.used.iter().map(|(file, paths)| {
            let files = paths.iter().filter_map(|path| self.file_of(file, path, 4));
            (file.clone(), files.filter(|used| !file.starts_with(used)))
        });
        arrows.map(|(file, used)| (file, used.collect())).collect()
    }
}

/// All files that can be reached from `file`.
fn reached(arrows: &BTreeMap<Names, BTreeSet<Names>>, file: &Names) -> BTreeSet<Names> {
    let (mut found, mut open) = (BTreeSet::new(), vec![file.clone()]);
    while let Some(next) = open.pop() {
        for used in arrows.get(&next).into_iter().flatten() {
            if found.insert(used.clone()) {
                open.push(used.clone());
            }
        }
    }
    found
}

/// The largest sets of files that all reach each other.
fn circles(arrows: &BTreeMap<Names, BTreeSet<Names>>) -> BTreeSet<Vec<String>> {
    let all: BTreeMap<&Names, BTreeSet<Names>> = arrows
        .keys()
        .map(|file| (file, reached(arrows, file)))
        .collect();
    let circle = |(file, ahead): (&&Names, &BTreeSet<Names>)| {
        let back = ahead.iter().filter(|other| all[other].contains(*file));
        let names: Vec<String> = back.map(|other| other.join("/")).collect();
        (names.len() > 1).then_some(names)
    };
    all.iter().filter_map(circle).collect()
}

#[test]
fn no_circle_between_files_is_new() {
    let found = circles(&Files::of(&sources()).arrows());
    let known = KNOWN.map(|circle| circle.iter().map(|&file| file.to_owned()).collect());
    let known: BTreeSet<Vec<String>> = known.into_iter().collect();
    let new: Vec<_> = found.difference(&known).collect();
    assert!(new.is_empty(), "new circles between files: {new:#?}");
    let mended: Vec<_> = known.difference(&found).collect();
    assert!(mended.is_empty(), "no circles any more: {mended:#?}");
}

#[test]
fn circles_are_found_through_what_modules_show() {
    let files = [
        ("a", "pub use one::One;"),
        ("a/one", "use super::two;\npub struct One;"),
        ("a/two", "fn f() -> super::One { crate::one::One }"),
        ("a/three", "use crate::{one::{One}, two as second};"),
    ];
    let names = |path: &str| path.split('/').map(str::to_owned).collect::<Names>();
    let sources = files.map(|(path, code)| (names(path), code.to_owned()));
    let found = circles(&Files::of(&sources.into()).arrows());
    assert_eq!(
        found,
        BTreeSet::from([vec!["a/one".to_owned(), "a/two".to_owned()]])
    );
}
