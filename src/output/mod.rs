//! Output: HTML files, text tables, Rerun recordings (the only module that names `rerun`), trajectories (SQLite, text
//! and CSV), and pictures and animations (SVG, PNG, PDF, GIF, APNG and video; the only module that names `plotters`).

pub mod html;

pub mod table;

pub mod colors;

pub mod scenery;

pub mod labels;

pub mod recording;

pub mod trajectory;

pub mod plot;

pub mod picture;

pub mod document;
