//! Tables of formatted cells, for callers that do not use [`Table`](super::Table) yet.

/// A table whose cells are already formatted; only until all callers use [`Table::of`](super::Table::of).
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
