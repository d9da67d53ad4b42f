//! Tables as text.

use super::error::ReproduceError;

/// A table whose cells are written already.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct TextTable {
    /// The names of the columns.
    pub head: Vec<String>,
    /// The rows.
    pub rows: Vec<Vec<String>>,
}

impl TextTable {
    /// An empty table.
    pub fn new(head: &[&str]) -> Self {
        Self {
            head: head.iter().map(|&name| name.to_owned()).collect(),
            rows: Vec::new(),
        }
    }

    /// Adds a row.
    pub fn add<const N: usize>(&mut self, row: [String; N]) {
        self.rows.push(row.to_vec());
    }

    /// As Markdown.
    pub fn markdown(&self) -> String {
        let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
        let rule = vec!["---".to_owned(); self.head.len()];
        let rows = self.rows.iter().map(|row| line(row));
        [line(&self.head), line(&rule)]
            .into_iter()
            .chain(rows)
            .collect()
    }

    /// As CSV.
    ///
    /// # Errors
    /// Never for rows as long as the head.
    pub fn csv(&self) -> Result<Vec<u8>, ReproduceError> {
        let invalid = |error: String| ReproduceError::Data(format!("CSV: {error}"));
        let mut writer = csv::Writer::from_writer(Vec::new());
        for row in std::iter::once(&self.head).chain(&self.rows) {
            writer
                .write_record(row)
                .map_err(|e| invalid(e.to_string()))?;
        }
        writer.into_inner().map_err(|e| invalid(e.to_string()))
    }
}

/// A number with all its digits, or nothing.
pub fn number(value: Option<f64>) -> String {
    value.map_or_else(String::new, |value| value.to_string())
}

/// `document` with `text` between the lines `<!-- name -->` and `<!-- /name -->`; `None` without them.
pub fn put_between(document: &str, name: &str, text: &str) -> Option<String> {
    let (open, close) = (format!("<!-- {name} -->\n"), format!("<!-- /{name} -->"));
    let (before, rest) = document.split_once(&open)?;
    let (_, after) = rest.split_once(&close)?;
    let text = text.trim_end();
    Some(format!("{before}{open}\n{text}\n\n{close}{after}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_takes_the_place_of_the_one_before_it() {
        let document = "a\n<!-- t -->\nold\n<!-- /t -->\nb\n";
        let once = put_between(document, "t", "new\n").unwrap();
        assert_eq!(once, "a\n<!-- t -->\n\nnew\n\n<!-- /t -->\nb\n");
        assert_eq!(put_between(&once, "t", "new").unwrap(), once);
        assert_eq!(put_between(document, "u", "new"), None);
    }

    #[test]
    fn the_same_table_as_markdown_and_csv() {
        let mut table = TextTable::new(&["a", "b"]);
        table.add(["1".to_owned(), "x, y".to_owned()]);
        assert_eq!(table.markdown(), "| a | b |\n| --- | --- |\n| 1 | x, y |\n");
        assert_eq!(table.csv().unwrap(), b"a,b\n1,\"x, y\"\n");
    }
}
