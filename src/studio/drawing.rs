//! What pages draw: checks of a scenario, files that are opened, examples.

use std::path::Path;

use runs::case::Source;
use scenario::floor_plan::is_plan;
use scenario::{Draft, Scenario, begun, built_in};
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
            text.map(|text| (path, text.as_bytes()))
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

/// The document of the first of some files, and the notes on it.
fn read(files: &[(&Path, &[u8])]) -> Result<(Value, Vec<String>), Refusal> {
    let folder = tempfile::tempdir().map_err(Refusal::failed)?;
    let mut paths = Vec::new();
    for (name, content) in files {
        let path = folder.path().join(name.file_name().unwrap_or_default());
        std::fs::write(&path, content).map_err(Refusal::failed)?;
        paths.push(path);
    }
    let place = format!("{}/", folder.path().display());
    let plain = |text: String| match text.replace(&place, "") {
        text if text.contains("cannot be read: No such file") => format!(
            "{text}: it is another file; `sandbox convert` writes a scenario that needs no other"
        ),
        text => text,
    };
    let first = paths.swap_remove(0);
    let (document, notes) = whole(&Source::at(first)).map_err(|refusal| Refusal {
        reason: plain(refusal.reason),
        message: plain(refusal.message),
        ..refusal
    })?;
    Ok((document, notes.into_iter().map(plain).collect()))
}

/// The document of a scenario, which needs no other file, and the notes on it. Of a floor plan, a scenario with the
/// exits and crowds that it names.
///
/// # Errors
/// It cannot be read.
pub fn whole(source: &Source) -> Result<(Value, Vec<String>), Refusal> {
    let (text, file) = source.text()?;
    let mut draft = Draft::read(&text, &file, &[])?;
    if let Source::File(path) = source
        && is_plan(path)
    {
        draft = begun(path, &draft, &[])?;
    }
    let scenario = draft.scenario()?;
    Ok((scenario.document, scenario.notes))
}

/// The document of a file that a page has opened.
///
/// # Errors
/// It cannot be read.
pub fn opened(name: &str, content: &[u8]) -> Result<Value, Refusal> {
    let path = Path::new(name);
    let Some(stem) = path.file_stem() else {
        return Err(Refusal::wrong("name: give the name of the file"));
    };
    let (mut document, notes) = read(&[(path, content)])?;
    if document.get("name").is_none() {
        document["name"] = stem.to_string_lossy().into();
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
    const PLANS: [&str; 2] = ["walkable_area", "obstacles"];
    let in_list = |list: &'static str, keys: &'static [&'static str]| {
        let count = document[list].as_array().map_or(0, Vec::len);
        let paths = move |k| keys.iter().map(move |key| (list, Some(k), *key));
        (0..count).flat_map(paths)
    };
    let at_top = ["walkable_area", "obstacles", "levels"].map(|key| ("", None, key));
    let mut all = at_top
        .into_iter()
        .chain([("from", None, "trajectory")])
        .chain(in_list("levels", &PLANS))
        .chain(in_list("events", &["acceleration"]));
    let named = all.find(|&(list, k, key)| {
        let owner = match (list, k) {
            ("", _) => document,
            (_, Some(k)) => &document[list][k],
            (_, None) => &document[list],
        };
        owner[key].is_string()
    });
    let path = match named {
        None => return Ok(()),
        Some(("", _, key)) => key.to_owned(),
        Some((list, None, key)) => format!("{list}.{key}"),
        Some((list, Some(k), key)) => format!("{list}[{k}].{key}"),
    };
    let reason = "a drawing has no other files; open the file itself";
    Err(Refusal {
        status: 422,
        message: format!("{path}: {reason}"),
        path,
        reason: reason.to_owned(),
    })
}

/// The schema of scenario files.
pub fn schema() -> Value {
    scenario::schema()
}
