//! Output: what leaves the program. Tables as text, recordings for Rerun (the only place that names `rerun`),
//! trajectories as SQLite, text and CSV, written and read, and pictures as SVG and PNG (the only place that
//! names `plotters`).

pub mod table;

pub mod colors;

pub mod recording;

pub mod trajectory;

pub mod plot;
