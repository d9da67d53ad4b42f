//! Scenario files: the text of a file → a checked [`Scenario`] → a [`Scene`](engine::scene::Scene) for the
//! simulation.
//!
//! A file is a JSON object. Every top-level key is optional; an unknown key is an error. The structs in `keys/`
//! have one field per key, with its description, default and range; [`schema()`], [`settings()`] and the range checks
//! come from them. Presets and [`Setting`]s change the JSON before it is parsed once, by `Draft::read`.
//!
//! Agents can walk in the `walkable_area` (everywhere if it is missing) except in the `obstacles`. Each of the two
//! is a list of polygons, or the name of a file that `floor_plan` reads. `$schema` is ignored; editors use it.
//!
//! An agent is removed within `remove_within` meters of its goal, or never if the key is missing. Its arrival
//! counts as evacuated unless `counted` is false. Top-level `parameters` override those of the profiles. Ids count
//! from 0 in order of entry: the people of `from`, agents, grids, crowds, then the others as they enter.

#![warn(missing_docs, clippy::unwrap_used)]

// What is hidden is public for the other crates of this workspace, and no part of what the library promises.

mod error;

#[doc(hidden)]
pub mod input;

#[doc(hidden)]
pub mod trajectories;

#[doc(hidden)]
pub mod kinds;

#[doc(hidden)]
pub mod floor_plan;

mod keys;

pub mod measurements;

mod file;

mod scene;

mod jupedsim;

mod read;

pub use error::{Problem, ScenarioError};
pub use file::Stop;
pub use file::listed::{ObjectDoc, Presence, SettingDoc, nested_settings, settings};
pub use file::schema::schema;
pub use floor_plan::Label;
pub use keys::{calibrated, catalog};
pub use read::plans::PlanFile;
pub use read::scenario::Scenario;
pub use read::setting::{Setting, SettingError};
pub use read::shipped::{SHIPPED, Shipped};
pub use scene::view::View;

#[doc(hidden)]
pub use error::{in_plain_words, numbers::tidy, quote, suggestion};
#[doc(hidden)]
pub use jupedsim::config_in;
#[doc(hidden)]
pub use keys::{goals::WayFinding, preset::Preset};
#[doc(hidden)]
pub use read::document::read as read_document;
#[doc(hidden)]
pub use read::draft::Draft;
#[doc(hidden)]
pub use read::drawing::begun;
#[doc(hidden)]
pub use read::scenario::{read_text, shipped_text};
#[doc(hidden)]
pub use read::shipped::built_in;
#[doc(hidden)]
pub use scene::levels::in_building;
#[doc(hidden)]
pub use scene::need::{Need, in_units};
#[doc(hidden)]
pub use scene::numerics::automatic_step;
#[doc(hidden)]
pub use scene::units::doubtful_radius;
