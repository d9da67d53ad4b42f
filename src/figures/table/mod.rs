//! Tables: rows under columns, as plain text for a terminal, as Markdown, HTML and CSV.
//!
//! A column says how a row fills it. Text, Markdown and HTML show numbers as their column formats them, CSV with all
//! digits. A missing number is `–` there, and empty in CSV. Names for readers end in their unit, as in `speed [m/s]`,
//! those for programs are words, as in `speed_m_per_s`. JSON does not come from tables: it is the serde form of the
//! rows themselves.

mod cell;

pub use cell::{Cell, as_precise};

use rayon::prelude::*;
use serde::Serialize;

use crate::html::escape;
use cell::Format;
use common::statistics::Range;

#[derive(Debug, Clone, PartialEq)]
struct Head {
    name: String,
    format: Format,
    suffixes: Option<[&'static str; 2]>,
}

/// A table.
#[derive(Debug, Clone, PartialEq)]
pub struct Table {
    heads: Vec<Head>,
    rows: Vec<Vec<Cell>>,
}

/// A table to which columns are added, from the left to the right.
pub struct Columns<'r, R> {
    rows: &'r [R],
    table: Table,
}

impl<'r, R> Columns<'r, R> {
    /// Adds a column of texts, or of numbers that keep all their digits in text and Markdown.
    pub fn column<C: Into<Cell>>(self, name: &str, cell: impl Fn(&'r R) -> C) -> Self {
        self.formatted(name, Format::AllDigits, None, cell)
    }

    /// Adds a column of numbers with `digits` decimals.
    pub fn fixed<C: Into<Cell>>(
        self,
        name: &str,
        digits: usize,
        cell: impl Fn(&'r R) -> C,
    ) -> Self {
        self.formatted(name, Format::Fixed(digits), None, cell)
    }

    /// Adds a column of numbers like 1.2e-3, with `digits` decimals.
    pub fn exponent<C: Into<Cell>>(
        self,
        name: &str,
        digits: usize,
        cell: impl Fn(&'r R) -> C,
    ) -> Self {
        self.formatted(name, Format::Exponent(digits), None, cell)
    }

    /// Adds a column of [`Cell::Spread`]. It is two columns in CSV, whose names end in `suffixes`, such as `_mean` and
    /// `_std`.
    pub fn spread<C: Into<Cell>>(
        self,
        name: &str,
        digits: usize,
        suffixes: [&'static str; 2],
        cell: impl Fn(&'r R) -> C,
    ) -> Self {
        self.formatted(name, Format::Fixed(digits), Some(suffixes), cell)
    }

    /// Adds three columns with `digits` decimals: minimum, median and maximum.
    pub fn range<C: Into<Option<Range>>>(
        self,
        name: &str,
        digits: usize,
        range: impl Fn(&'r R) -> C,
    ) -> Self {
        let range = |row| -> Option<Range> { range(row).into() };
        self.fixed(&format!("{name} min"), digits, |row| {
            range(row).map(|range| range.minimum)
        })
        .fixed("median", digits, |row| range(row).map(|range| range.median))
        .fixed("max", digits, |row| range(row).map(|range| range.maximum))
    }

    fn formatted<C: Into<Cell>>(
        mut self,
        name: &str,
        format: Format,
        suffixes: Option<[&'static str; 2]>,
        cell: impl Fn(&'r R) -> C,
    ) -> Self {
        self.table.heads.push(Head {
            name: name.to_owned(),
            format,
            suffixes,
        });
        for (row, cells) in self.rows.iter().zip(&mut self.table.rows) {
            cells.push(cell(row).into());
        }
        self
    }

    /// The table.
    pub fn table(self) -> Table {
        self.table
    }
}

impl Table {
    /// A table with one row for each of `rows`, and no columns yet.
    pub fn of<R>(rows: &[R]) -> Columns<'_, R> {
        Columns {
            rows,
            table: Self {
                heads: Vec::new(),
                rows: vec![Vec::new(); rows.len()],
            },
        }
    }

    /// As plain text in aligned columns: texts left-aligned, numbers right-aligned; with the names of columns, unless
    /// all are empty.
    pub fn text(&self) -> String {
        let mut lines = self.lines();
        if self.heads.iter().all(|head| head.name.is_empty()) {
            lines.remove(0);
        }
        let columns = (0..self.heads.len()).map(|k| {
            let width = lines.iter().map(|line| line[k].chars().count()).max();
            (width.unwrap_or(0), self.has_numbers(k))
        });
        let layout: Vec<(usize, bool)> = columns.collect();
        let mut text = String::new();
        for line in &lines {
            let cells = line.iter().zip(&layout);
            let padded = cells.map(|(cell, &(width, right))| match right {
                true => format!("{cell:>width$}"),
                false => format!("{cell:<width$}"),
            });
            text += padded.collect::<Vec<_>>().join("  ").trim_end();
            text.push('\n');
        }
        text
    }

    /// As Markdown.
    pub fn markdown(&self) -> String {
        let mut rows = self.lines();
        rows.insert(1, vec!["---".to_owned(); self.heads.len()]);
        let lines = rows.iter();
        lines
            .map(|cells| {
                let cells: Vec<String> =
                    cells.iter().map(|cell| cell.replace('|', "\\|")).collect();
                format!("| {} |\n", cells.join(" | "))
            })
            .collect()
    }

    /// As HTML, numbers right-aligned.
    pub fn html(&self) -> String {
        self.html_of(escape)
    }

    /// The same, with `html` of the text of each cell.
    pub fn html_of(&self, html: impl Fn(&str) -> String) -> String {
        let mut rows = self.lines().into_iter().map(|cells| {
            let cells = cells.iter().enumerate().map(|(k, cell)| {
                let class = if self.has_numbers(k) {
                    " class=\"number\""
                } else {
                    ""
                };
                (class, html(cell))
            });
            cells.collect::<Vec<_>>()
        });
        let row = |tag: &str, cells: Vec<(&str, String)>| {
            let classed = cells.iter();
            let cells = classed.map(|(class, cell)| format!("<{tag}{class}>{cell}</{tag}>"));
            format!("<tr>{}</tr>\n", cells.collect::<String>())
        };
        let head = rows
            .next()
            .map(|cells| row("th", cells))
            .unwrap_or_default();
        let body: String = rows.map(|cells| row("td", cells)).collect();
        format!(
            "<div class=\"scroll\"><table>\n<thead>\n{head}</thead>\n<tbody>\n{body}</tbody>\n</table></div>\n"
        )
    }

    /// As CSV.
    ///
    /// # Errors
    /// Never in practice: the rows are written to memory and have the same length.
    pub fn csv(&self) -> Result<Vec<u8>, csv::Error> {
        let heads = self.heads.iter().flat_map(|head| {
            let suffixes = head.suffixes.as_ref().map_or(&[""][..], |both| both).iter();
            suffixes.map(|suffix| format!("{}{suffix}", head.name))
        });
        let number = |number: &f64| number.to_string();
        let rows = self.rows.iter().map(|row| {
            let fields = row.iter().zip(&self.heads).flat_map(|(cell, head)| {
                let (first, second) = match cell {
                    Cell::Text(text) => (text.clone(), None),
                    Cell::Number(value) => (number(value), None),
                    Cell::Spread(value, off) => (number(value), off.as_ref().map(number)),
                    Cell::Missing => (String::new(), None),
                };
                let second = head.suffixes.map(|_| second.unwrap_or_default());
                std::iter::once(first).chain(second)
            });
            fields.collect::<Vec<_>>()
        });
        let lines: Vec<Vec<String>> = std::iter::once(heads.collect()).chain(rows).collect();
        csv_lines(&lines, false)
    }

    /// Whether a column is one of numbers, which are right-aligned.
    pub fn has_numbers(&self, k: usize) -> bool {
        let mut cells = self.rows.iter().map(|row| &row[k]);
        let is_number = |cell| matches!(cell, &Cell::Number(_) | &Cell::Spread(..));
        self.heads[k].format != Format::AllDigits || cells.any(is_number)
    }

    /// The heads and the rows as they are shown.
    pub fn lines(&self) -> Vec<Vec<String>> {
        let heads = self.heads.iter().map(|head| head.name.clone());
        let rows = self.rows.iter().map(|row| {
            let cells = row.iter().zip(&self.heads);
            cells.map(|(cell, head)| cell.shown(head.format)).collect()
        });
        std::iter::once(heads.collect()).chain(rows).collect()
    }
}

/// CSV lines of serializable rows, made in parallel: for files with one row per agent and frame, which are too long for
/// a [`Table`]. `has_head` begins with a line of the fields' names, if there are rows.
///
/// # Errors
/// A row cannot be written as one line.
pub fn csv_lines<R: Serialize + Sync>(rows: &[R], has_head: bool) -> Result<Vec<u8>, csv::Error> {
    let lines = |(k, rows): (usize, &[R])| {
        let mut writer = csv::WriterBuilder::new()
            .has_headers(has_head && k == 0)
            .from_writer(Vec::new());
        rows.iter().try_for_each(|row| writer.serialize(row))?;
        let written = writer.into_inner();
        written.map_err(|error| error.into_error().into())
    };
    let parts = rows.par_chunks(1024).enumerate().map(lines);
    Ok(parts.collect::<Result<Vec<_>, csv::Error>>()?.concat())
}
