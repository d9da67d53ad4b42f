//! The results as tables for readers and as rows for programs.

use std::fmt::Write;

use super::{CaseReport, Error, METHODS, Method, MethodReport, Region, WallReport};

impl WallReport {
    /// Tables with one row per method and one column per case.
    pub fn markdown(&self) -> String {
        let error =
            |of: fn(&MethodReport) -> Error| move |method: &MethodReport| in_percent(of(method));
        let mut text = "The polygons' methods and Akinci's particles are measured against what the walls hide, the \
                        other particles and the maps against the solid; 0 is rounding.\n\n"
            .to_owned();
        let mut part = |title: &str, table: String| {
            let _ = write!(text, "{title}\n\n{table}\n");
        };
        part(
            "Error of the density ∫ W in % of the largest exact value on the path, root mean square (largest):",
            self.table(error(|method| method.density)),
        );
        part(
            "The same of the force ∫ ∇W:",
            self.table(error(|method| method.force)),
        );
        part(
            "Force along an endless straight wall, which should feel smooth, in % of the largest force:",
            self.table(|method| method.roughness.map_or("".to_owned(), in_percent)),
        );
        part(
            "Nanoseconds per agent, search for what is in reach included (median):",
            self.table(|method| format!("{:.0}", method.ns.median)),
        );
        part(
            "Before the first frame: milliseconds, kB beside the polygons:",
            self.table(|method| match method.bytes {
                0 => "0".to_owned(),
                bytes => format!("{:.2}, {:.0}", method.preparation_ms, 1e-3 * bytes as f64),
            }),
        );
        part("What the walls hide and what is solid:", self.regions());
        text
    }

    /// One row for each case and method; errors are relative to the largest exact value.
    pub fn csv(&self) -> String {
        let mut text =
            "case,method,against,density_rms,density_max,force_rms,force_max,roughness_rms,\
                        roughness_max,ns_minimum,ns_median,ns_maximum,preparation_ms,bytes\n"
                .to_owned();
        for (case, method) in self.rows() {
            let against = match method.region {
                Region::Hidden => "hidden",
                Region::Solid => "solid",
            };
            let (density, force, ns) = (method.density, method.force, method.ns);
            let roughness = method
                .roughness
                .map_or(",".to_owned(), |r| format!("{:.3e},{:.3e}", r.rms, r.max));
            let _ = writeln!(
                text,
                "\"{}\",\"{}\",{against},{:.3e},{:.3e},{:.3e},{:.3e},{roughness},{:.1},{:.1},{:.1},{:.3},{}",
                case.name,
                method.name,
                density.rms,
                density.max,
                force.rms,
                force.max,
                ns.minimum,
                ns.median,
                ns.maximum,
                method.preparation_ms,
                method.bytes,
            );
        }
        text
    }

    fn rows(&self) -> impl Iterator<Item = (&CaseReport, &MethodReport)> {
        self.cases
            .iter()
            .flat_map(|case| case.methods.iter().map(move |method| (case, method)))
    }

    /// A table with a column for each case in which `cell` is not empty.
    fn table(&self, cell: impl Fn(&MethodReport) -> String) -> String {
        let speaks = |case: &&CaseReport| case.methods.iter().any(|m| !cell(m).is_empty());
        let cases: Vec<&CaseReport> = self.cases.iter().filter(speaks).collect();
        let row = |(k, method): (usize, &Method)| {
            let cells = cases.iter().map(|case| cell(&case.methods[k]));
            line(&method.name(), cells)
        };
        let rows: String = METHODS.iter().enumerate().map(row).collect();
        head("method", &cases) + &rows
    }

    fn regions(&self) -> String {
        let cases: Vec<&CaseReport> = self.cases.iter().collect();
        let row = |name: &str, cell: fn(&CaseReport) -> String| {
            line(name, cases.iter().map(|case| cell(case)))
        };
        [
            head("the solid is off what is hidden by", &cases),
            row("density, %", |case| in_percent(case.solid_density)),
            row("force, %", |case| in_percent(case.solid_force)),
            row("error of the quadrature, 1 or 1/m", |case| {
                format!("{:.0e}", case.quadrature)
            }),
            row("search for walls, ns (median)", |case| {
                format!("{:.0}", case.search_ns.median)
            }),
        ]
        .concat()
    }
}

fn head(first: &str, cases: &[&CaseReport]) -> String {
    let names = cases.iter().map(|case| case.name.to_owned());
    line(first, names) + &line("---", cases.iter().map(|_| "---".to_owned()))
}

fn line(first: &str, cells: impl Iterator<Item = String>) -> String {
    let cells: Vec<String> = std::iter::once(first.to_owned()).chain(cells).collect();
    format!("| {} |\n", cells.join(" | "))
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
