//! Documents: headings, texts, tables and figures, as one HTML file or as a PDF. Both show the same blocks in the same
//! order; neither needs another program, and equal documents are equal files.

mod pages;
mod web;

use std::path::Path;

use crate::plot::{PlotError, Print, Sheet};
use crate::table::Table;
use runs::outputs::write_file;

/// The width of figures and tables, millimeters.
const WIDTH_MM: f64 = 170.0;

/// A part of a document.
#[derive(Debug, Clone)]
pub enum Block {
    /// A heading.
    Heading(String),
    /// A paragraph.
    Text(String),
    /// A list of short texts.
    List(Vec<String>),
    /// Commands, line by line.
    Code(Vec<String>),
    /// A table with a caption.
    Table(Table, String),
    /// A figure with a caption.
    Figure(Box<Sheet>, String),
}

impl Block {
    /// A heading.
    pub fn heading(text: &str) -> Self {
        Self::Heading(text.to_owned())
    }

    /// A paragraph.
    pub fn text(text: impl Into<String>) -> Self {
        Self::Text(text.into())
    }

    /// A figure.
    pub fn figure(sheet: Sheet, caption: impl Into<String>) -> Self {
        Self::Figure(Box::new(sheet), caption.into())
    }
}

/// A document.
#[derive(Debug, Clone)]
pub struct Document {
    /// Its title.
    pub title: String,
    /// A line below the title.
    pub subtitle: String,
    /// What it shows.
    pub blocks: Vec<Block>,
}

impl Document {
    /// Writes it: a PDF if the name ends in .pdf, else HTML.
    ///
    /// # Errors
    /// A figure cannot be drawn, or the file cannot be written.
    pub fn save(&self, path: &Path) -> Result<(), PlotError> {
        let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
        let bytes = match extension.to_str() {
            Some("pdf") => self.pdf()?,
            _ => self.html()?.into_bytes(),
        };
        write_file(path, &bytes).map_err(|reason| PlotError::Writing {
            path: path.to_owned(),
            reason,
        })
    }
}

/// The print of all figures.
pub fn print() -> Print {
    Print::paper(WIDTH_MM)
}
