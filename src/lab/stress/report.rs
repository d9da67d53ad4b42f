//! What `sandbox stress` prints and writes.

use std::fmt::Write;

use super::cell::Cell;
use super::condition::Condition;
use super::fit::LEAST;
use super::hard::Survival;
use super::jitter::{Jitter, Variant};
use crate::analysis::stability::{Constants, FITTED};
use crate::lab::error::LabError;
use crate::runs::store::Store;

/// All results.
#[derive(Debug, Clone)]
pub struct Report {
    /// The hard cases by name.
    pub hard: Vec<(&'static str, Survival)>,
    /// The maps.
    pub cells: Vec<Cell>,
    /// Points that the fit does not use.
    pub held_out: Vec<Cell>,
    /// The constants fitted to the maps.
    pub fitted: Constants,
    /// The residual motion of crowds at rest.
    pub jitter: Vec<(Variant, Jitter)>,
}

impl Report {
    /// All violated requirements; empty if there are none.
    pub fn failures(&self) -> Vec<String> {
        let hard = self
            .hard
            .iter()
            .filter(|(_, survival)| !survival.is_passed());
        let hard = hard.map(|(name, survival)| match &survival.fault {
            Some(fault) => format!("{name}: {fault}"),
            None => format!("{name}: {} through a wall", survival.found.passed),
        });
        let everywhere = self.cells.iter().chain(&self.held_out);
        let unstable = everywhere.filter(|cell| !cell.auto_is_stable());
        let unstable = unstable.map(|cell| format!("auto is not stable: {cell:?}"));
        let is_short = |cell: &&Cell| cell.limits.iter().any(|limit| limit.ratio() < LEAST);
        let short = self.cells.iter().filter(is_short);
        let short = short.map(|cell| format!("auto is too short: {cell:?}"));
        hard.chain(unstable).chain(short).collect()
    }

    /// All results as Markdown: (name, text).
    pub fn parts(&self) -> [(&'static str, String); 3] {
        [
            ("hard", hard_table(&self.hard)),
            ("maps", self.maps()),
            ("jitter", jitter_table(&self.jitter)),
        ]
    }

    /// Writes the tables into the store's folder.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn write(&self, store: &Store) -> Result<(), LabError> {
        let text: String = self.parts().map(|(_, text)| text + "\n").concat();
        store.write("report.md", text.as_bytes())?;
        store.write("maps.csv", csv(&self.cells).as_bytes())?;
        store.write("held_out.csv", csv(&self.held_out).as_bytes())?;
        let json = serde_json::json!({
            "hard": self.hard,
            "maps": self.cells,
            "held_out": self.held_out,
            "jitter": self.jitter.iter().map(|(v, j)| (v.label, j)).collect::<Vec<_>>(),
        });
        let json = format!("{json}\n");
        store.write("stress.json", json.as_bytes())?;
        Ok(())
    }

    fn maps(&self) -> String {
        let constants = |c: &Constants| {
            format!(
                "C₁ = {:.2}, C₂ = {:.2}, C₃ = {:.2}, margin {:.2} (Verlet {:.2})",
                c.pressure, c.contact, c.drag, c.margin, c.verlet_margin
            )
        };
        format!(
            "{}\n{} Constants of the engine: {}. Fitted to these maps: {}.\n\n\
             Places that the fit never saw, with other people:\n\n{}\n{}\n",
            map_table(&self.cells),
            summary(&self.cells),
            constants(&FITTED),
            constants(&self.fitted),
            map_table(&self.held_out),
            summary(&self.held_out),
        )
    }
}

/// The smallest and the largest ratio of `auto` to the largest stable step under one of the conditions.
fn range(cells: &[Cell], condition: usize) -> [f64; 2] {
    let ratios = || cells.iter().map(|cell| cell.limits[condition].ratio());
    [
        ratios().fold(f64::INFINITY, f64::min),
        ratios().fold(0.0, f64::max),
    ]
}

fn summary(cells: &[Cell]) -> String {
    let ranges = Condition::ALL.iter().enumerate().map(|(k, condition)| {
        let [least, most] = range(cells, k);
        format!("{least:.2} to {most:.2} ({})", condition.name)
    });
    let stable = cells.iter().filter(|cell| cell.auto_is_stable()).count();
    format!(
        "auto is stable at {stable} of {} places, at {} of the largest stable step.",
        cells.len(),
        ranges.collect::<Vec<_>>().join(", "),
    )
}

fn map_table(cells: &[Cell]) -> String {
    let mut text = "| k | ρ⁰max | K^ag | μ | auto is stable |".to_owned();
    for Condition { name, .. } in Condition::ALL {
        let _ = write!(
            text,
            " {name}: auto / largest stable Δt [s] | speed, fine steps → auto [m/s] |"
        );
    }
    let columns = 5 + 2 * Condition::ALL.len();
    let _ = writeln!(text, "\n|{}", "---|".repeat(columns));
    for cell in cells {
        let crowd = cell.crowd;
        let _ = write!(
            text,
            "| {} | {} | {} | {} | {} |",
            crowd.gas_constant,
            crowd.rest_density_max,
            crowd.agent_stiffness,
            crowd.viscosity,
            if cell.auto_is_stable() {
                "yes"
            } else {
                "**no**"
            },
        );
        for limit in cell.limits {
            let _ = write!(
                text,
                " {} / {:.4} = {:.2} | {:.2} → {:.2} |",
                limit.auto,
                limit.largest,
                limit.ratio(),
                limit.fine_speed,
                limit.auto_speed,
            );
        }
        text.push('\n');
    }
    text
}

fn hard_table(hard: &[(&str, Survival)]) -> String {
    let mut text = "| case | what it is | passed | agents | frames | through a wall | stopped at a wall | speeds cut | \
                    put out of obstacles | nearest centers [D_i + D_j] |\n|---|---|---|---|---|---|---|---|---|---|\n"
        .to_owned();
    for (name, survival) in hard {
        let found = &survival.found;
        let _ = writeln!(
            text,
            "| {name} | {} | {} | {} | {} | {} | {} | {} | {} | {:.2} |",
            survival.description,
            if survival.is_passed() {
                "yes"
            } else {
                "**no**"
            },
            found.entered,
            found.frames,
            found.passed,
            found.contained_moves,
            found.clamped_speeds,
            found.displaced,
            found.closest,
        );
    }
    text
}

fn jitter_table(jitter: &[(Variant, Jitter)]) -> String {
    let mut text =
        "| crowd | energy before the push [m²/s²] | after it | inside | rim | density [P/m²] | \
                    nearest centers [D_i + D_j] |\n|---|---|---|---|---|---|---|\n"
            .to_owned();
    for (variant, jitter) in jitter {
        let _ = writeln!(
            text,
            "| {} | {:.1e} | {:.1e} | {:.1e} | {:.1e} | {:.2} | {:.2} |",
            variant.label,
            jitter.energy[0],
            jitter.energy[1],
            jitter.inside_and_rim[0],
            jitter.inside_and_rim[1],
            jitter.density,
            jitter.closest,
        );
    }
    text
}

/// One row for each point and condition.
fn csv(cells: &[Cell]) -> String {
    let mut text = "gas_constant,rest_density_max,agent_stiffness,viscosity,condition,auto_secs,auto_is_stable,\
                    largest_secs,fine_speed,auto_speed\n"
        .to_owned();
    for cell in cells {
        let crowd = cell.crowd;
        for (condition, limit) in Condition::ALL.iter().zip(cell.limits) {
            let _ = writeln!(
                text,
                "{},{},{},{},{},{},{},{:.5},{:.4},{:.4}",
                crowd.gas_constant,
                crowd.rest_density_max,
                crowd.agent_stiffness,
                crowd.viscosity,
                condition.name,
                limit.auto,
                limit.auto_is_stable,
                limit.largest,
                limit.fine_speed,
                limit.auto_speed,
            );
        }
    }
    text
}
