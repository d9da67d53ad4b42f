//! Documents: headings, texts, tables and figures, for the terminal, as Markdown, as one HTML file and as a PDF. All of
//! them show the same blocks in the same order; none needs another program, and equal documents are equal files.
//!
//! [`Findings`] are what a command found: a document for readers, with tables and data for programs.

mod findings;
mod lines;
mod pages;
mod web;

pub use findings::{ENDINGS, Findings, Names};
pub use lines::put_between;

use crate::plot::{Print, Sheet};
use crate::table::Table;

/// The width of figures and tables, millimeters.
const WIDTH_MM: f64 = 170.0;

/// A part of a document. Words between backticks are code, words between two asterisks on each side are bold.
#[derive(Debug, Clone)]
pub enum Block {
    /// The beginning of a part with a heading of its own. Its name marks its place in documents that are updated.
    Part(String, String),
    /// A heading.
    Heading(String),
    /// A paragraph; lines stay lines.
    Text(String),
    /// A list of short texts.
    List(Vec<String>),
    /// Commands, line by line.
    Code(Vec<String>),
    /// A table with a caption.
    Table(Table, String),
    /// A figure.
    Figure(Box<Figure>),
}

/// A figure of a document.
#[derive(Debug, Clone)]
pub struct Figure {
    /// The name of its file, without an ending.
    pub name: String,
    /// What is drawn.
    pub sheet: Sheet,
    /// Its caption.
    pub caption: String,
}

impl Figure {
    /// What it shows: the caption or, without one, the title.
    fn about(&self) -> &str {
        match self.caption.as_str() {
            "" => &self.sheet.title,
            caption => caption,
        }
    }
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

    /// A table without a caption.
    pub fn table(table: Table) -> Self {
        Self::Table(table, String::new())
    }

    /// A figure.
    pub fn figure(name: &str, sheet: Sheet, caption: impl Into<String>) -> Self {
        Self::Figure(Box::new(Figure {
            name: name.to_owned(),
            sheet,
            caption: caption.into(),
        }))
    }

    /// Whether it shows nothing.
    fn is_empty(&self) -> bool {
        match self {
            Self::Text(text) => text.is_empty(),
            Self::List(lines) | Self::Code(lines) => lines.is_empty(),
            _ => false,
        }
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
    /// A document without a subtitle.
    pub fn of(title: impl Into<String>, blocks: Vec<Block>) -> Self {
        Self {
            title: title.into(),
            subtitle: String::new(),
            blocks,
        }
    }

    /// A document whose figures are called `figure-1`, `figure-2`, …
    pub fn numbered(title: String, subtitle: String, mut blocks: Vec<Block>) -> Self {
        let mut count = 0;
        for block in &mut blocks {
            if let Block::Figure(figure) = block {
                count += 1;
                figure.name = format!("figure-{count}");
            }
        }
        Self {
            title,
            subtitle,
            blocks,
        }
    }

    /// Its figures, in order.
    pub fn figures(&self) -> impl Iterator<Item = &Figure> {
        self.blocks.iter().filter_map(|block| match block {
            Block::Figure(figure) => Some(&**figure),
            _ => None,
        })
    }
}

/// The print of all figures.
pub fn print() -> Print {
    Print::paper(WIDTH_MM)
}

/// The pieces of a text: plain, code between backticks, or bold between two asterisks on each side.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Piece<'a> {
    Plain(&'a str),
    Code(&'a str),
    Bold(&'a str),
}

/// The pieces of a text, in order. Marks without an end are text.
fn pieces(text: &str) -> Vec<Piece<'_>> {
    let mut found = Vec::new();
    let mut rest = text;
    while let Some((before, piece, after)) = marked(rest) {
        found.extend([Piece::Plain(before), piece]);
        rest = after;
    }
    found.push(Piece::Plain(rest));
    found.retain(|piece| *piece != Piece::Plain(""));
    found
}

/// The first marked piece of a text, with what is before and after it.
fn marked(text: &str) -> Option<(&str, Piece<'_>, &str)> {
    let within = |mark| {
        let (before, rest) = text.split_once(mark)?;
        let (inner, after) = rest.split_once(mark)?;
        Some((before, inner, after))
    };
    let code = within("`").map(|(before, inner, after)| (before, Piece::Code(inner), after));
    let bold = within("**").map(|(before, inner, after)| (before, Piece::Bold(inner), after));
    let both = [code, bold].into_iter().flatten();
    both.min_by_key(|(before, ..)| before.len())
}

/// A text without marks.
fn unmarked(text: &str) -> String {
    let pieces = pieces(text).into_iter();
    let words = pieces.map(|piece| match piece {
        Piece::Plain(words) | Piece::Code(words) | Piece::Bold(words) => words,
    });
    words.collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_without_an_end_are_text() {
        let all = pieces("a `b` **c** d** e");
        let expected = [
            Piece::Plain("a "),
            Piece::Code("b"),
            Piece::Plain(" "),
            Piece::Bold("c"),
            Piece::Plain(" d** e"),
        ];
        assert_eq!(all, expected);
        assert_eq!(unmarked("**1 to 2** of `K^ag`"), "1 to 2 of K^ag");
    }
}
