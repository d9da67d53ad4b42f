//! Output: HTML files and tables, Rerun recordings (the only module that names `rerun`), trajectories (SQLite, text and
//! CSV), pictures and animations (SVG, PNG, PDF, GIF, APNG and video; the only module that names `plotters`), pages
//! that play a run in a browser, and documents.

#![warn(missing_docs, clippy::unwrap_used)]

pub mod html;

pub mod table;

pub mod results;

pub mod colors;

pub mod scenery;

pub mod labels;

pub mod events;

pub mod series;

pub mod recording;

pub mod trajectory;

pub mod plot;

pub mod picture;

pub mod page;

pub mod document;
