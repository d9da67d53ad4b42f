//! The results as tables for readers and as rows for programs.

use super::integrals::Region;
use sandbox::lab::error::LabError;
use sandbox::output::document::{Block, Document, Findings};
use sandbox::output::table::{Cell, Table};
use serde_json::json;

use super::{ABOUT, CaseReport, Error, METHODS, MethodReport, NAME, TABLES, WallReport};

impl WallReport {
    /// Everything for readers and programs.
    ///
    /// # Errors
    /// A table cannot be written.
    pub fn findings(&self) -> Result<Findings, LabError> {
        let about = "The polygons' methods and Akinci's particles are measured against the hidden region, the other \
                     particles and the maps against the solid; 0 is a rounding error.";
        let part = Block::Part(TABLES.to_owned(), ABOUT.to_owned());
        let mut blocks = vec![part, Block::text(about)];
        for (title, table) in self.tables() {
            blocks.push(Block::Table(table, title.to_owned()));
        }
        blocks.push(Block::figure(NAME, self.sheet(), ""));
        let document = Document::of("Integrals over walls", blocks);
        let findings = Findings::new(NAME, document, json!(self));
        Ok(findings.with_table(NAME, &self.rows())?)
    }

    /// Tables with one row per method and one column per case.
    fn tables(&self) -> [(&'static str, Table); 6] {
        [
            (
                "Error of the density ∫ W in % of the largest exact value on the path, root mean square (largest):",
                self.table(|method| Some(in_percent(method.density))),
            ),
            (
                "The same of the force ∫ ∇W:",
                self.table(|method| Some(in_percent(method.force))),
            ),
            (
                "Force along an endless straight wall, which should feel smooth, in % of the largest force:",
                self.table(|method| method.roughness.map(in_percent)),
            ),
            (
                "Nanoseconds per agent, search for walls within reach included (median):",
                self.table(|method| Some(format!("{:.0}", method.ns.median))),
            ),
            (
                "Before the first frame: milliseconds, kB beside the polygons:",
                self.table(|method| {
                    let (ms, kilobytes) = (method.preparation_ms, 1e-3 * method.bytes as f64);
                    Some(match method.bytes {
                        0 => "0".to_owned(),
                        _ => format!("{ms:.2}, {kilobytes:.0}"),
                    })
                }),
            ),
            ("The hidden and the solid region:", self.regions()),
        ]
    }

    /// One row for each case and method; errors are relative to the largest exact value.
    fn rows(&self) -> Table {
        let cases = self.cases.iter();
        let rows = cases.flat_map(|case| case.methods.iter().map(move |method| (case, method)));
        let rows: Vec<(&CaseReport, &MethodReport)> = rows.collect();
        let parts = ["_rms", "_max"];
        let error = |error: Error| Cell::Spread(error.rms, Some(error.max));
        Table::of(&rows)
            .column("case", |row| row.0.name)
            .column("method", |row| row.1.name.as_str())
            .column("against", |row| match row.1.region {
                Region::Hidden => "hidden",
                Region::Solid => "solid",
            })
            .spread("density", 3, parts, |row| error(row.1.density))
            .spread("force", 3, parts, |row| error(row.1.force))
            .spread("roughness", 3, parts, |row| row.1.roughness.map(error))
            .column("ns_minimum", |row| row.1.ns.minimum)
            .column("ns_median", |row| row.1.ns.median)
            .column("ns_maximum", |row| row.1.ns.maximum)
            .column("preparation_ms", |row| row.1.preparation_ms)
            .column("bytes", |row| row.1.bytes)
            .table()
    }

    /// A table with a column for each case that has a value.
    fn table(&self, cell: impl Fn(&MethodReport) -> Option<String>) -> Table {
        let methods: Vec<usize> = (0..METHODS.len()).collect();
        let mut table = Table::of(&methods).column("method", |&k| METHODS[k].name());
        for case in &self.cases {
            if case.methods.iter().any(|method| cell(method).is_some()) {
                table = table.column(case.name, |&k| cell(&case.methods[k]));
            }
        }
        table.table()
    }

    fn regions(&self) -> Table {
        type Row = (&'static str, fn(&CaseReport) -> String);
        let rows: [Row; 4] = [
            ("density, %", |case| in_percent(case.solid_density)),
            ("force, %", |case| in_percent(case.solid_force)),
            ("error of the quadrature, 1 or 1/m", |case| {
                format!("{:.0e}", case.quadrature)
            }),
            ("search for walls, ns (median)", |case| {
                format!("{:.0}", case.search_ns.median)
            }),
        ];
        let mut table =
            Table::of(&rows).column("the solid region minus the hidden one", |row| row.0);
        for case in &self.cases {
            table = table.column(case.name, |row| row.1(case));
        }
        table.table()
    }
}

fn in_percent(error: Error) -> String {
    format!("{} ({})", percent(error.rms), percent(error.max))
}

/// Three digits; values below 10⁻⁵ % are rounding errors and become 0.
fn percent(part: f64) -> String {
    match 100.0 * part {
        value if value >= 99.5 => format!("{value:.0}"),
        value if value >= 9.95 => format!("{value:.1}"),
        value if value >= 0.005 => format!("{value:.2}"),
        value if value >= 1e-5 => format!("{value:.0e}"),
        _ => "0".to_owned(),
    }
}
