//! Tables: rows under columns, as plain text for a terminal, as Markdown and as CSV.
//!
//! A column says how a row fills it. Text and Markdown show numbers as their column formats them, CSV with all digits.
//! A missing number is `–` in text and Markdown, and empty in CSV. Names for readers end in their unit, as in
//! `speed [m/s]`, those for programs are words, as in `speed_m_per_s`. JSON does not come from tables: it is the serde
//! form of the rows themselves.

use serde::Serialize;

use crate::analysis::statistics::{Estimate, MeanStd};

/// What a row has in a column.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    /// Words; left-aligned.
    Text(String),
    /// A number.
    Number(f64),
    /// A number and its uncertainty or deviation, if known: `3.27 ± 0.01`.
    Spread(f64, Option<f64>),
    /// No value; also from `None` and NaN.
    Missing,
}

/// How text and Markdown show numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Format {
    AllDigits,
    Fixed(usize),
    Exponent(usize),
}

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

    /// As plain text in aligned columns: texts left-aligned, numbers right-aligned.
    pub fn text(&self) -> String {
        let lines = self.lines();
        let columns = 0..self.heads.len();
        let width = |k: usize| lines.iter().map(|line| line[k].chars().count()).max();
        let has_numbers = |k: usize| {
            let mut cells = self.rows.iter().map(|row| &row[k]);
            cells.any(|cell| matches!(cell, Cell::Number(_) | Cell::Spread(..)))
        };
        let layout: Vec<(usize, bool)> = columns
            .map(|k| (width(k).unwrap_or(0), has_numbers(k)))
            .collect();
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
        let mut lines = self.lines();
        lines.insert(1, vec!["---".to_owned(); self.heads.len()]);
        let lines = lines.iter();
        lines
            .map(|cells| format!("| {} |\n", cells.join(" | ")))
            .collect()
    }

    /// As CSV.
    ///
    /// # Errors
    /// Never in practice: the rows are written to memory and have the same length.
    pub fn csv(&self) -> Result<Vec<u8>, csv::Error> {
        let heads = self.heads.iter().flat_map(|head| {
            let suffixes = head.suffixes.as_ref().map_or(&[""][..], |both| both);
            let suffixes = suffixes.iter();
            suffixes.map(|suffix| format!("{}{suffix}", head.name))
        });
        let number = |number: &f64| number.to_string();
        let rows = self.rows.iter().map(|row| {
            let cells = row.iter().zip(&self.heads);
            let fields = cells.flat_map(|(cell, head)| {
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
        csv_lines(std::iter::once(heads.collect()).chain(rows), false)
    }

    /// The heads and the rows as they are shown.
    fn lines(&self) -> Vec<Vec<String>> {
        let heads = self.heads.iter().map(|head| head.name.clone());
        let rows = self.rows.iter().map(|row| {
            let cells = row.iter().zip(&self.heads);
            cells.map(|(cell, head)| cell.shown(head.format)).collect()
        });
        std::iter::once(heads.collect()).chain(rows).collect()
    }
}

impl Cell {
    fn shown(&self, format: Format) -> String {
        let number = |value: f64| match format {
            Format::AllDigits => value.to_string(),
            Format::Fixed(digits) => format!("{value:.digits$}"),
            Format::Exponent(digits) => format!("{value:.digits$e}"),
        };
        match self {
            Self::Text(text) => text.clone(),
            Self::Number(value) | Self::Spread(value, None) => number(*value),
            Self::Spread(value, Some(off)) => format!("{} ± {}", number(*value), number(*off)),
            Self::Missing => "–".to_owned(),
        }
    }
}

impl From<String> for Cell {
    fn from(text: String) -> Self {
        Self::Text(text)
    }
}

impl From<&str> for Cell {
    fn from(text: &str) -> Self {
        Self::Text(text.to_owned())
    }
}

impl From<bool> for Cell {
    fn from(value: bool) -> Self {
        Self::Text(value.to_string())
    }
}

impl From<f64> for Cell {
    fn from(value: f64) -> Self {
        if value.is_nan() {
            return Self::Missing;
        }
        Self::Number(value)
    }
}

impl From<usize> for Cell {
    fn from(value: usize) -> Self {
        Self::Number(value as f64)
    }
}

impl From<u32> for Cell {
    fn from(value: u32) -> Self {
        Self::Number(f64::from(value))
    }
}

impl From<u64> for Cell {
    fn from(value: u64) -> Self {
        Self::Number(value as f64)
    }
}

/// Mean ± sample standard deviation.
impl From<MeanStd> for Cell {
    fn from(of: MeanStd) -> Self {
        Self::Spread(of.mean, of.std())
    }
}

/// Value ± standard error.
impl From<Estimate> for Cell {
    fn from(estimate: Estimate) -> Self {
        Self::Spread(estimate.value, Some(estimate.error))
    }
}

impl<C: Into<Cell>> From<Option<C>> for Cell {
    fn from(value: Option<C>) -> Self {
        value.map_or(Self::Missing, C::into)
    }
}

/// CSV lines of serializable rows: for files with one row per agent and frame, which are too long for a [`Table`].
/// `has_head` begins with a line of the fields' names.
///
/// # Errors
/// A row cannot be written as one line.
pub fn csv_lines(
    rows: impl Iterator<Item: Serialize>,
    has_head: bool,
) -> Result<Vec<u8>, csv::Error> {
    let mut writer = csv::WriterBuilder::new()
        .has_headers(has_head)
        .from_writer(Vec::new());
    for row in rows {
        writer.serialize(row)?;
    }
    writer
        .into_inner()
        .map_err(|error| error.into_error().into())
}

/// A table whose cells are already formatted; only until all callers use [`Table::of`].
#[derive(Debug, Clone, PartialEq, Default)]
pub struct OldTable {
    /// Number of text columns at the left; the others hold numbers.
    pub words: usize,
    /// The names of the columns.
    pub head: Vec<String>,
    /// The rows.
    pub rows: Vec<Vec<String>>,
}

impl OldTable {
    /// An empty table.
    pub fn new(words: usize, head: &[&str]) -> Self {
        Self {
            words,
            head: head.iter().map(|&name| name.to_owned()).collect(),
            rows: Vec::new(),
        }
    }

    /// Adds a row.
    pub fn add<const N: usize>(&mut self, row: [String; N]) {
        self.rows.push(row.to_vec());
    }

    /// As plain text in aligned columns: text left-aligned, numbers right-aligned.
    pub fn text(&self) -> String {
        let length =
            |line: &Vec<String>, k: usize| line.get(k).map_or(0, |cell| cell.chars().count());
        let widths: Vec<usize> = (0..self.head.len())
            .map(|k| self.lines().map(|line| length(line, k)).max().unwrap_or(0))
            .collect();
        let mut text = String::new();
        for line in self.lines() {
            let cells = line.iter().zip(&widths).enumerate();
            let padded = cells.map(|(k, (cell, &width))| {
                if k < self.words {
                    format!("{cell:<width$}")
                } else {
                    format!("{cell:>width$}")
                }
            });
            let padded: Vec<String> = padded.collect();
            text += &format!("{}\n", padded.join("  ").trim_end());
        }
        text
    }

    /// As Markdown.
    pub fn markdown(&self) -> String {
        let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
        let rule = vec!["---".to_owned(); self.head.len()];
        let rows = self.rows.iter().map(|row| line(row));
        line(&self.head) + &line(&rule) + &rows.collect::<String>()
    }

    /// As CSV.
    ///
    /// # Errors
    /// Never for rows as long as the head.
    pub fn csv(&self) -> Result<Vec<u8>, csv::Error> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        for row in self.lines() {
            writer.write_record(row)?;
        }
        writer
            .into_inner()
            .map_err(|error| error.into_error().into())
    }

    fn lines(&self) -> impl Iterator<Item = &Vec<String>> {
        std::iter::once(&self.head).chain(&self.rows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Row {
        name: &'static str,
        speed: Option<Estimate>,
        count: usize,
        energy: f64,
    }

    fn table() -> Table {
        let speed = |value, error| Some(Estimate { value, error });
        let row = |name, speed, count, energy| Row {
            name,
            speed,
            count,
            energy,
        };
        let rows = [
            row("x, y", speed(1.0, 0.25), 12, 0.00123),
            row("z", None, 3, f64::NAN),
        ];
        Table::of(&rows)
            .column("name", |row| row.name)
            .spread("speed", 2, ["_mean", "_error"], |row| row.speed)
            .column("n", |row| row.count)
            .exponent("energy", 1, |row| row.energy)
            .table()
    }

    #[test]
    fn text_and_markdown_have_formatted_numbers_and_csv_all_digits() {
        let text = "\
name        speed   n  energy
x, y  1.00 ± 0.25  12  1.2e-3
z               –   3       –
";
        let markdown = "\
| name | speed | n | energy |
| --- | --- | --- | --- |
| x, y | 1.00 ± 0.25 | 12 | 1.2e-3 |
| z | – | 3 | – |
";
        let csv = "\
name,speed_mean,speed_error,n,energy
\"x, y\",1,0.25,12,0.00123
z,,,3,
";
        assert_eq!(table().text(), text);
        assert_eq!(table().markdown(), markdown);
        assert_eq!(table().csv().unwrap(), csv.as_bytes());
    }
}
