//! Figures, tables and documents. It knows no crowd: the crate `output` draws crowds with it.
//!
//! [`plot`] draws sheets of panels as SVG, PNG and PDF, and animations (the only module that names `plotters`).
//! [`table`] has rows under columns, as text, Markdown, HTML and CSV. [`document`] has headings, texts, tables and
//! figures as one file, and the [`Findings`](document::Findings) of commands.

#![warn(missing_docs, clippy::unwrap_used)]

pub mod html;

pub mod table;

pub mod colors;

pub mod plot;

pub mod document;
