//! The report of `sandbox stress`.

use serde::Serialize;
use serde_json::json;

use super::cell::Cell;
use super::condition::Condition;
use super::fit::LEAST;
use super::map::Detail;
use super::pictures;
use crate::error::LabError;
use analysis::statistics::Range;
use engine::stability::{Constants, FITTED};
use output::document::{Block, Document, Findings, Names};
use output::table::Table;
use runs::case::RunResult;

/// A finished run of one of the studies.
#[derive(Debug, Clone, Serialize)]
pub struct Finished {
    /// Its label in the study.
    pub label: String,
    /// The description of its scenario, one line.
    pub description: String,
    /// Its result.
    #[serde(flatten)]
    pub result: RunResult,
}

impl Finished {
    /// The value of a measurement; `None` if it has none.
    pub fn metric(&self, name: &str) -> Option<f64> {
        self.result.summary.metric(name)
    }
}

/// All results.
#[derive(Debug, Clone, Serialize)]
pub struct Report {
    /// The hard cases.
    pub hard: Vec<Finished>,
    /// The maps.
    #[serde(rename = "maps")]
    pub cells: Vec<Cell>,
    /// Points that the fit does not use.
    pub held_out: Vec<Cell>,
    /// The constants fitted to the maps.
    #[serde(skip)]
    pub fitted: Constants,
    /// The residual motion of crowds at rest.
    pub jitter: Vec<Finished>,
}

/// The names of the tables in documents.
pub const PARTS: [&str; 3] = ["hard", "maps", "jitter"];
/// The names of the files.
const NAME: &str = "stress";
const MAPS: &str = "maps";
const HELD_OUT: &str = "held_out";

/// The names of all files with results.
pub fn names() -> Names {
    Names::new(NAME, &[MAPS, HELD_OUT], &[MAPS])
}

impl Report {
    /// All violated requirements; empty if there are none.
    pub fn failures(&self) -> Vec<String> {
        let failed = self.hard.iter().filter(|run| !is_passed(run));
        let hard = failed.map(|run| {
            let [through_walls, not_finite] =
                FAULTS.map(|name| run.metric(name).unwrap_or_default());
            format!(
                "{}: {through_walls} agents through a wall, {not_finite} frames with numbers that are not finite",
                run.label
            )
        });
        let everywhere = self.cells.iter().chain(&self.held_out);
        let longer = everywhere.filter(|cell| !cell.auto_is_stable());
        let unstable = longer.map(|cell| format!("auto is not stable: {cell:?}"));
        let is_short = |cell: &&Cell| cell.limits.iter().any(|limit| limit.ratio() < LEAST);
        let shorter = self.cells.iter().filter(is_short);
        let short = shorter.map(|cell| format!("auto is too short: {cell:?}"));
        hard.chain(unstable).chain(short).collect()
    }

    /// Everything for readers and programs. `detail` has the points of the maps.
    ///
    /// # Errors
    /// A table cannot be written.
    pub fn findings(&self, detail: &Detail) -> Result<Findings, LabError> {
        let [hard, maps, jitter] = PARTS;
        let part = |name: &str, heading: &str| Block::Part(name.to_owned(), heading.to_owned());
        let mut blocks = vec![
            part(hard, "Hard cases"),
            Block::table(hard_table(&self.hard)),
            part(maps, "The largest stable time step"),
        ];
        blocks.extend(self.maps());
        let sheet = pictures::sheet(&self.cells, detail);
        blocks.push(Block::figure(MAPS, sheet, "The maps."));
        blocks.push(part(jitter, "Crowds at rest"));
        blocks.push(Block::table(jitter_table(&self.jitter)));
        let document = Document::of("Stress tests", blocks);
        let whole = Findings::new(NAME, document, json!(self));
        let findings = whole.with_table(MAPS, &rows(&self.cells))?;
        Ok(findings.with_table(HELD_OUT, &rows(&self.held_out))?)
    }

    fn maps(&self) -> [Block; 5] {
        let constants = |c: &Constants| {
            format!(
                "C₁ = {:.2}, C₂ = {:.2}, C₃ = {:.2}, margin {:.2} (Verlet {:.2})",
                c.pressure, c.contact, c.drag, c.margin, c.verlet_margin
            )
        };
        [
            Block::table(map_table(&self.cells)),
            Block::text(format!(
                "{} Constants of the engine: {}. Fitted to these maps: {}.",
                summary(&self.cells),
                constants(&FITTED),
                constants(&self.fitted),
            )),
            Block::text("Places that the fit does not use, with other agents:"),
            Block::table(map_table(&self.held_out)),
            Block::text(summary(&self.held_out)),
        ]
    }
}

fn summary(cells: &[Cell]) -> String {
    let ranges = Condition::ALL.iter().enumerate().map(|(k, condition)| {
        let ratios: Vec<f64> = cells.iter().map(|cell| cell.limits[k].ratio()).collect();
        let ratio = Range::of(&ratios);
        format!(
            "{:.2} to {:.2} ({})",
            ratio.minimum, ratio.maximum, condition.name
        )
    });
    let stable = cells.iter().filter(|cell| cell.auto_is_stable()).count();
    format!(
        "auto is stable at {stable} of {} places, at {} of the largest stable step.",
        cells.len(),
        ranges.collect::<Vec<_>>().join(", "),
    )
}

fn map_table(cells: &[Cell]) -> Table {
    let mut table = Table::of(cells)
        .column("k", |cell| cell.crowd.gas_constant)
        .column("ρ⁰max", |cell| cell.crowd.rest_density_max)
        .column("K^ag", |cell| cell.crowd.agent_stiffness)
        .column("μ", |cell| cell.crowd.viscosity)
        .column("walking law", |cell| cell.crowd.law.to_string())
        .column("auto is stable", |cell| yes(cell.auto_is_stable()));
    for (k, condition) in Condition::ALL.iter().enumerate() {
        let steps = format!("{}: auto / largest stable Δt [s]", condition.name);
        table = table
            .column(&steps, |cell| {
                let limit = cell.limits[k];
                let (auto, largest) = (limit.auto, limit.largest);
                format!("{auto} / {largest:.4} = {:.2}", limit.ratio())
            })
            .column("speed, fine steps → auto [m/s]", |cell| {
                let limit = cell.limits[k];
                format!("{:.2} → {:.2}", limit.fine_speed, limit.auto_speed)
            });
    }
    table.table()
}

/// The values of a hard case that must be zero.
const FAULTS: [&str; 2] = ["agents_through_walls", "non_finite_frames"];

fn is_passed(run: &Finished) -> bool {
    FAULTS.iter().all(|name| run.metric(name) == Some(0.0))
}

fn yes(is_good: bool) -> &'static str {
    if is_good { "yes" } else { "**no**" }
}

fn hard_table(hard: &[Finished]) -> Table {
    let table = Table::of(hard)
        .column("case", |run| run.label.as_str())
        .column("what it is", |run| run.description.as_str())
        .column("passed", |run| yes(is_passed(run)))
        .column("agents", |run| run.result.summary.agents)
        .column("frames", |run| run.result.summary.frames)
        .column("through a wall", |run| run.metric(FAULTS[0]))
        .column("stopped at a wall", |run| {
            run.result.summary.contained_moves
        })
        .column("speeds cut", |run| run.result.summary.clamped_speeds)
        .column("put out of obstacles", |run| {
            run.result.summary.displaced_agents
        })
        .fixed("nearest centers [D_i + D_j]", 2, |run| {
            run.metric("closest_centers")
        });
    table.table()
}

fn jitter_table(jitter: &[Finished]) -> Table {
    let mut table = Table::of(jitter).column("crowd", |run| run.label.as_str());
    for (name, metric) in [
        ("energy before the push [m²/s²]", "jitter_35_to_40s"),
        ("after it", "jitter_50_to_60s"),
        ("inside", "jitter_inside_50_to_60s"),
        ("rim", "jitter_rim_50_to_60s"),
    ] {
        table = table.exponent(name, 1, |run| run.metric(metric));
    }
    let table = table
        .fixed("density [P/m²]", 2, |run| run.metric("density_mean_60s"))
        .fixed("nearest centers [D_i + D_j]", 2, |run| {
            run.metric("closest_centers")
        });
    table.table()
}

/// One row for each point and condition.
fn rows(cells: &[Cell]) -> Table {
    let limits_of = cells.iter().flat_map(|cell| {
        let limits = Condition::ALL.into_iter().zip(cell.limits);
        limits.map(|limit| (cell.crowd, limit))
    });
    let rows: Vec<_> = limits_of.collect();
    let table = Table::of(&rows)
        .column("gas_constant", |(crowd, _)| crowd.gas_constant)
        .column("rest_density_max", |(crowd, _)| crowd.rest_density_max)
        .column("agent_stiffness", |(crowd, _)| crowd.agent_stiffness)
        .column("viscosity", |(crowd, _)| crowd.viscosity)
        .column("walking_law", |(crowd, _)| crowd.law.to_string())
        .column("condition", |(_, (condition, _))| condition.name)
        .column("auto_secs", |(_, (_, limit))| limit.auto)
        .column("auto_is_stable", |(_, (_, limit))| limit.auto_is_stable)
        .column("largest_secs", |(_, (_, limit))| limit.largest)
        .column("fine_speed", |(_, (_, limit))| limit.fine_speed)
        .column("auto_speed", |(_, (_, limit))| limit.auto_speed);
    table.table()
}
