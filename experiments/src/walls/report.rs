//! The results as tables for readers and as rows for programs.

use std::path::{Path, PathBuf};

use super::integrals::Region;
use sandbox::lab::bench::created;
use sandbox::lab::error::LabError;
use sandbox::output::table::{Cell, Table};
use serde_json::{Value, json};

use super::{CaseReport, Error, METHODS, MethodReport, WallReport};

/// The files that the results are saved to in a folder.
pub fn files(folder: &Path) -> Vec<PathBuf> {
    let file = |extension: &str| folder.join(format!("walls.{extension}"));
    ["md", "csv", "json", "svg", "png"].map(file).into()
}

impl WallReport {
    /// All results as one object.
    pub fn json(&self) -> Value {
        json!(self)
    }

    /// Writes tables, CSV, JSON and the picture into a folder, and returns the paths.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn save(&self, folder: &Path) -> Result<Vec<PathBuf>, LabError> {
        let store = created(folder)?;
        store.write("walls.md", self.markdown().as_bytes())?;
        store.write("walls.csv", &self.csv()?)?;
        store.write("walls.json", format!("{:#}\n", self.json()).as_bytes())?;
        self.sheet().save(&folder.join("walls"))?;
        Ok(files(folder))
    }

    /// Tables with one row per method and one column per case.
    pub fn markdown(&self) -> String {
        let parts = [
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
        ];
        let parts = parts.map(|(title, table)| format!("{title}\n\n{}\n", table.markdown()));
        "The polygons' methods and Akinci's particles are measured against the hidden region, the other particles and \
         the maps against the solid; 0 is a rounding error.\n\n"
            .to_owned()
            + &parts.concat()
    }

    /// One row for each case and method; errors are relative to the largest exact value.
    pub fn csv(&self) -> Result<Vec<u8>, LabError> {
        let cases = self.cases.iter();
        let rows = cases.flat_map(|case| case.methods.iter().map(move |method| (case, method)));
        let rows: Vec<(&CaseReport, &MethodReport)> = rows.collect();
        let parts = ["_rms", "_max"];
        let error = |error: Error| Cell::Spread(error.rms, Some(error.max));
        let table = Table::of(&rows)
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
            .table();
        Ok(table.csv()?)
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
