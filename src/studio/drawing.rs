//! What pages draw: checks of a scenario, files that are opened, examples.

use std::path::{Component, Path, PathBuf};

use runs::case::Source;
use scenario::floor_plan::is_plan;
use scenario::{Draft, Scenario, begun, built_in, read_text};
use serde_json::{Value, json};

use crate::answer::Refusal;

/// An example on the first page.
struct Example {
    name: &'static str,
    title: &'static str,
    /// Its files among those that are built into the program, the scenario first.
    files: &'static [&'static str],
}

const EXAMPLES: [Example; 4] = [
    Example {
        name: "evacuation",
        title: "The paper's evacuation",
        files: &["evacuation.json"],
    },
    Example {
        name: "concert",
        title: "A concert, and its wave",
        files: &["studio/concert.json"],
    },
    Example {
        name: "office",
        title: "An office floor",
        files: &["office.json", "office.geojson"],
    },
    Example {
        name: "empty",
        title: "An empty floor",
        files: &[],
    },
];

/// The examples: name, title and description.
///
/// # Errors
/// One of them cannot be read.
pub fn examples() -> Result<Value, Refusal> {
    let one = |example: &Example| -> Result<Value, Refusal> {
        let document = example.document()?;
        let description = document["description"].as_str().unwrap_or_default();
        Ok(json!({"name": example.name, "title": example.title, "description": description}))
    };
    EXAMPLES.iter().map(one).collect()
}

/// The document of an example, which needs no other file.
///
/// # Errors
/// There is no such example.
pub fn example(name: &str) -> Result<Value, Refusal> {
    let found = EXAMPLES.iter().find(|example| example.name == name);
    found
        .ok_or_else(|| Refusal::with(404, format!("{name}: there is no such example")))?
        .document()
}

impl Example {
    fn document(&self) -> Result<Value, Refusal> {
        let text = |&file: &&'static str| {
            let path = Path::new(file);
            let text = built_in(path).ok_or_else(|| Refusal::failed("an example is missing"));
            let name = path.file_name().unwrap_or_default();
            text.map(|text| (PathBuf::from(name), text.as_bytes()))
        };
        let texts = self.files.iter().map(text);
        match texts.collect::<Result<Vec<_>, _>>()?.as_slice() {
            [] => Ok(json!({
                "name": "drawing", "profile": "steer+sph", "duration_secs": 600, "stop": {"when_empty": true},
            })),
            files => Ok(read(files)?.0),
        }
    }
}

/// The document of the first of some files, which may name the others, and the notes on it.
fn read(files: &[(PathBuf, &[u8])]) -> Result<(Value, Vec<String>), Refusal> {
    let [(name, content), others @ ..] = files else {
        return Err(Refusal::wrong("name: give the name of the file"));
    };
    let folder = tempfile::tempdir().map_err(Refusal::failed)?;
    let first = folder.path().join(name);
    std::fs::write(&first, content).map_err(Refusal::failed)?;
    let text = read_text(&first).unwrap_or_default();
    let document = serde_json::from_str(&text).unwrap_or_default();
    for (other, content) in others {
        let place = place_in(&document, other).ok_or_else(|| {
            Refusal::wrong(format!(
                "{} names no file {}; open one plan, or one scenario with the files that it names",
                name.display(),
                other.display()
            ))
        })?;
        write_new(&folder.path().join(place), content)?;
    }
    let inside = format!("{}/", folder.path().display());
    let plain = |text: String| match text.replace(&inside, "") {
        text if text.contains("cannot be read: No such file") => {
            format!("{text}: it is another file; open it together with the scenario")
        }
        text => text,
    };
    let (document, notes) = whole(&Source::at(first)).map_err(|refusal| Refusal {
        reason: plain(refusal.reason),
        message: plain(refusal.message),
        ..refusal
    })?;
    Ok((document, notes.into_iter().map(plain).collect()))
}

/// The path by which a scenario names a file, within its own folder.
fn place_in(document: &Value, name: &Path) -> Option<PathBuf> {
    let is_inside = |file: &PathBuf| {
        let mut parts = file.components();
        parts.all(|part| matches!(part, Component::Normal(_)))
    };
    files_named_in(document)
        .into_iter()
        .map(|(_, file)| PathBuf::from(file))
        .filter(is_inside)
        .find(|file| file.file_name() == name.file_name())
}

/// Writes a file that is not there yet, with its folder.
fn write_new(path: &Path, content: &[u8]) -> Result<(), Refusal> {
    if path.exists() {
        let name = path.file_name().unwrap_or_default().display();
        return Err(Refusal::wrong(format!("{name} is given twice")));
    }
    let folder = path.parent().unwrap_or(path);
    std::fs::create_dir_all(folder).map_err(Refusal::failed)?;
    std::fs::write(path, content).map_err(Refusal::failed)
}

/// The document of a scenario, which needs no other file, and the notes on it. Of a floor plan, a scenario with the
/// exits and crowds that it names. A wrong scenario that needs no other file is returned as it is: it is drawn with its
/// problem, and can be mended.
///
/// # Errors
/// It cannot be read.
pub fn whole(source: &Source) -> Result<(Value, Vec<String>), Refusal> {
    let (text, file) = source.text()?;
    let whole = || -> Result<(Value, Vec<String>), Refusal> {
        let mut draft = Draft::read(&text, &file, &[])?;
        if let Source::File(path) = source
            && is_plan(path)
        {
            draft = begun(path, &draft, &[])?;
        }
        let scenario = draft.scenario()?;
        Ok((scenario.document, scenario.notes))
    };
    whole().or_else(|refusal| match mendable(&text) {
        Some(document) => Ok((document, Vec::new())),
        None => Err(refusal),
    })
}

/// The document of a wrong scenario that needs no other file.
fn mendable(text: &str) -> Option<Value> {
    // Text that is no JSON is refused with its own message.
    let document: Value = serde_json::from_str(text).ok()?;
    let has = |key: &str| document[key].is_array();
    let is_scenario = has("walkable_area") || has("obstacles") || has("levels");
    (is_scenario && files_named_in(&document).is_empty()).then_some(document)
}

/// The document of the files that a page has opened: a floor plan, or a scenario with the files that it names.
///
/// # Errors
/// It cannot be read, or one of the files does not belong to it.
pub fn opened(files: &[(String, &[u8])]) -> Result<Value, Refusal> {
    let mut named: Vec<(PathBuf, &[u8])> = Vec::new();
    for (name, content) in files {
        let last = Path::new(name).file_name();
        let name = last.ok_or_else(|| Refusal::wrong("name: give the name of the file"))?;
        named.push((name.into(), content));
    }
    // The scenario comes first.
    named.sort_by_key(|(path, _)| is_plan(path));
    let (mut document, notes) = read(&named)?;
    if document.get("name").is_none() {
        let stem = named.first().and_then(|(path, _)| path.file_stem());
        document["name"] = stem.unwrap_or_default().to_string_lossy().into();
    }
    Ok(json!({"document": document, "notes": notes}))
}

/// A scenario from a document that needs no other file, if its run fits into `memory` bytes.
///
/// # Errors
/// The first problem, with its place.
pub fn scenario(document: &Value, memory: Option<u64>) -> Result<Scenario, Refusal> {
    names_no_file(document)?;
    let name = document["name"].as_str().unwrap_or("drawing");
    let draft = Draft::read(&document.to_string(), &format!("{name}.json"), &[])?;
    Ok(draft.within(memory, 0)?.0)
}

/// Whether a drawing can be played: its first problem, the notes on it, and the number of people at the start.
pub fn check(document: &Value, memory: Option<u64>) -> Value {
    match scenario(document, memory) {
        Ok(scenario) => {
            let count = document["interventions"].as_array().map_or(0, Vec::len);
            let played = (count > 0).then(|| {
                format!(
                    "{count} change(s) made while it was played are part of the drawing and are made again: the key \
                     `interventions`; the run ends at {} s",
                    scenario.duration_secs
                )
            });
            let notes: Vec<String> = played.into_iter().chain(scenario.notes).collect();
            json!({"problem": null, "notes": notes, "people": scenario.scene.agents.len()})
        }
        Err(refusal) => json!({"problem": refusal.document(), "notes": [], "people": null}),
    }
}

/// Pages bring all that they need: files of this machine are not theirs to read.
fn names_no_file(document: &Value) -> Result<(), Refusal> {
    let Some((path, _)) = files_named_in(document).into_iter().next() else {
        return Ok(());
    };
    let reason = "a drawing has no other files; open the file itself";
    Err(Refusal {
        status: 422,
        message: format!("{path}: {reason}"),
        path,
        reason: reason.to_owned(),
    })
}

/// The files that a scenario names, each after the place where it does.
fn files_named_in(document: &Value) -> Vec<(String, &str)> {
    const OF_ALL: [&str; 4] = ["walkable_area", "obstacles", "levels", "from.trajectory"];
    const OF_ELEMENTS: [(&str, &str); 3] = [
        ("levels", "walkable_area"),
        ("levels", "obstacles"),
        ("events", "acceleration"),
    ];
    let of_elements = OF_ELEMENTS.into_iter().flat_map(|(list, key)| {
        let count = document[list].as_array().map_or(0, Vec::len);
        (0..count).map(move |k| format!("{list}[{k}].{key}"))
    });
    let paths = OF_ALL.into_iter().map(str::to_owned).chain(of_elements);
    let file = |path: String| {
        let pointer = path.replace(['.', '['], "/").replace(']', "");
        let file = document.pointer(&format!("/{pointer}"))?.as_str()?;
        Some((path, file))
    };
    paths.filter_map(file).collect()
}

/// The schema of scenario files.
pub fn schema() -> Value {
    scenario::schema()
}
