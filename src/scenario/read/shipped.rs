//! The files that are built into the program: scenarios and studies.

use std::path::{Component, Path, PathBuf};

use include_dir::{Dir, include_dir};
use serde_json::Value;

use crate::input::embedded;

/// The folder `scenarios/`.
static FILES: Dir = include_dir!("$CARGO_MANIFEST_DIR/../../scenarios");

/// The text of a file under `scenarios/`, such as `stress/packed.json` or `studies/../stress/packed.json`.
pub fn built_in(path: &Path) -> Option<&'static str> {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir => _ = plain.pop(),
            part => plain.push(part),
        }
    }
    FILES.get_file(plain)?.contents_utf8()
}

/// A scenario file built into the program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shipped {
    /// Its name.
    pub name: &'static str,
    /// The text of the file.
    pub text: &'static str,
}

/// The paper's three scenarios (§6) and its open challenge (§7).
pub const SHIPPED: [Shipped; 4] = [
    Shipped::new(
        "evacuation",
        include_str!("../../../scenarios/evacuation.json"),
    ),
    Shipped::new("crossing", include_str!("../../../scenarios/crossing.json")),
    Shipped::new("concert", include_str!("../../../scenarios/concert.json")),
    Shipped::new("plaza", include_str!("../../../scenarios/plaza.json")),
];

impl Shipped {
    const fn new(name: &'static str, text: &'static str) -> Self {
        Self { name, text }
    }

    /// The file's `description`.
    pub fn description(&self) -> String {
        let document: Value = embedded(self.name, self.text);
        let text = document["description"].as_str();
        text.unwrap_or_default().to_owned()
    }
}
