//! The text of a file, with settings, presets and the files that it names → a checked [`Scenario`](scenario::Scenario).

pub mod check;
pub mod curves;
pub mod data;
pub mod document;
pub mod draft;
pub mod drawing;
pub mod effective;
pub mod late;
pub mod levels;
pub mod parsed;
pub mod places;
mod plan_files;
mod plan_levels;
pub mod plans;
pub mod preset;
pub mod rides;
pub mod scenario;
pub mod setting;
pub mod shipped;
