//! Scenario files: the text of a file → a checked [`Scenario`] → a [`Scene`](engine::scene::Scene) for the
//! simulation.
//!
//! A file is a JSON object. Every top-level key is optional; an unknown key is an error. The structs in `keys/`
//! have one field per key, with its description, default and range; [`schema()`], [`settings()`] and the range checks
//! come from them. Presets and [`Setting`]s change the JSON before it is parsed once, by [`Draft::read`].
//!
//! Agents can walk in the `walkable_area` (everywhere if it is missing) except in the `obstacles`. Each of the two
//! is a list of polygons, or the name of a file that [`floor_plan`] reads. `$schema` is ignored; editors use it.
//!
//! An agent is removed within `remove_within` meters of its goal, or never if the key is missing. Its arrival
//! counts as evacuated unless `counted` is false. Top-level `parameters` override those of the profiles. Ids count
//! from 0 in order of entry: the people of `from`, agents, grids, crowds, then the others as they enter.

#![warn(missing_docs, clippy::unwrap_used)]

mod error;

pub mod input;

pub mod trajectories;

pub mod kinds;

pub mod floor_plan;

mod keys;

pub mod measurements;

mod file;

mod scene;

mod read;

pub use error::numbers::tidy;
pub use error::{Problem, ScenarioError, in_plain_words, quote, suggestion};
pub use file::Stop;
pub use file::listed::{ObjectDoc, Presence, SettingDoc, nested_settings, settings};
pub use file::schema::schema;
pub use keys::goals::WayFinding;
pub use keys::preset::Preset;
pub use keys::{calibrated, catalog};
pub use read::document::read as read_document;
pub use read::draft::Draft;
pub use read::plans::PlanFile;
pub use read::scenario::{Scenario, read_text, shipped_text};
pub use read::setting::{Setting, SettingError};
pub use read::shipped::{SHIPPED, Shipped, built_in};
pub use scene::need::{Need, in_units};
pub use scene::numerics::automatic_step;
pub use scene::units::doubtful_radius;
pub use scene::view::View;
