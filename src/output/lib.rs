//! Output: Rerun recordings (the only module that names `rerun`), trajectories (SQLite, text and CSV), pictures of
//! crowds, and pages that play a run in a browser. Figures, tables and documents are those of the crate `figures`.

#![warn(missing_docs, clippy::unwrap_used)]

pub use figures::{colors, document, html, plot, table};

pub mod results;

pub mod scenery;

pub mod over_joins;

pub mod drawing;

pub mod labels;

pub mod events;

pub mod series;

pub mod recording;

pub mod trajectory;

pub mod picture;

pub mod page;
