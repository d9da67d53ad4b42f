//! The built-in scenarios.

use serde_json::Value;

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
    Shipped {
        name: "evacuation",
        text: include_str!("../../scenarios/evacuation.json"),
    },
    Shipped {
        name: "crossing",
        text: include_str!("../../scenarios/crossing.json"),
    },
    Shipped {
        name: "concert",
        text: include_str!("../../scenarios/concert.json"),
    },
    Shipped {
        name: "plaza",
        text: include_str!("../../scenarios/plaza.json"),
    },
];

impl Shipped {
    /// The file's `description`.
    pub fn description(&self) -> String {
        let document: Value = serde_json::from_str(self.text).unwrap_or_default();
        document["description"]
            .as_str()
            .unwrap_or_default()
            .to_owned()
    }
}
