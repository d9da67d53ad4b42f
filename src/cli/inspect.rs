//! `sandbox inspect`: the forces on single agents, term by term.

use std::path::PathBuf;

use clap::Args;
use serde_json::json;

use super::arguments::{SceneOptions, use_threads};
use super::documents::DocumentOptions;
use super::failure::Failure;
use super::terminal::say;
use super::values::{id, is_page, recording, seconds};
use super::watch::Progress;
use super::{memory, moment, output};
use ::output::document::{Block, Document, Findings, Names};
use ::output::html::facts;
use ::output::over_joins;
use ::output::recording::check_enabled;
use ::output::table::Table;
use engine::breakdown::Breakdown;
use engine::pairs::Precision;
use engine::simulation::Simulation;
use runs::outputs::{Manner, Outputs};
use scenario::quote::{printable, shown};

#[derive(Args)]
pub struct InspectOptions {
    /// A built-in scenario or a scenario file
    #[arg(value_name = "SCENARIO_OR_FILE")]
    pub scenario: String,
    #[command(flatten)]
    pub scene: SceneOptions,
    /// Id of an agent; may be repeated
    #[arg(long, value_name = "ID", required_unless_present = "all", value_parser = id)]
    pub agent: Vec<u32>,
    /// Inspect every agent
    #[arg(long, conflicts_with = "agent")]
    pub all: bool,
    /// The moment, seconds; at 0 no agent has moved yet
    #[arg(long, value_name = "SECS", default_value_t = 0.0, allow_negative_numbers = true, value_parser = seconds)]
    pub at: f64,
    /// Also write this moment as a recording for the Rerun viewer (.rrd), or as a page (.html)
    #[arg(long, value_name = "FILE", value_parser = recording())]
    pub save: Option<PathBuf>,
    #[command(flatten)]
    pub files: DocumentOptions,
}

/// The name of the findings.
const NAME: &str = "inspected";

pub fn run(options: &InspectOptions) -> Result<(), Failure> {
    use_threads(options.scene.program.threads)?;
    if options.save.as_deref().is_some_and(|path| !is_page(path)) {
        check_enabled()?;
    }
    let writing = memory::of_inspecting(options.save.is_some(), options.all);
    let mut outputs = Outputs::new(options.scene.program.force);
    let (scene, at) = (&options.scene, options.at);
    let scenario = moment::scenario(&options.scenario, (scene, at), writing, &mut outputs)?;
    if let Some(path) = &options.save {
        outputs.writes("--save", path, Manner::InPlace);
    }
    let names = Names::new(NAME, &[NAME], &[]);
    options.files.add_to(&mut outputs, &names);
    outputs.check()?;
    let mut simulation = Simulation::new(scenario.scene.clone())?;
    // The rest density depends on the density's history, so every frame needs the density.
    simulation.request_density_until(u64::MAX);
    let went = rayon::scope(|_| go_to(at, &mut simulation));
    went.map_err(|failure| failure.with_forces(&mut simulation))?;
    let inspected = inspected(&simulation, options)?;
    if let Some(path) = &options.save {
        let ids = inspected.iter().map(|&(id, _)| id).collect();
        output::save_moment(path, &scenario, &simulation, ids)?;
    }
    if options.files.are_given() {
        options.files.save(&findings(&simulation, &inspected)?)?;
    }
    let clock = simulation.frame().clock;
    let (time, frame) = (clock.time(), clock.frame());
    let as_json = options.scene.program.json;
    // Print agent by agent: breakdowns of a whole crowd would take far more memory than the run.
    say(match as_json {
        true => "{\"agents\":[".to_owned(),
        false => format!("t = {time:.2} s, frame {frame}\n"),
    })?;
    for (k, &(id, i)) in inspected.iter().enumerate() {
        let breakdown = breakdown(&simulation, id, i)?;
        say(match as_json {
            true => {
                let mut agent = json!(breakdown);
                if let Some(level) = level(&simulation, i) {
                    agent["level"] = json!(level);
                }
                format!("{}{agent}", if k > 0 { "," } else { "" })
            }
            false => printable(&format!("\n{}{breakdown}", in_building(&simulation, i))),
        })?;
    }
    match as_json {
        true => say(format!(
            "],\"frame\":{frame},\"time_secs\":{}}}\n",
            json!(time)
        )),
        false => Ok(()),
    }
}

/// A line with the place of agent `i` in its building; empty on a single floor.
fn in_building(simulation: &Simulation, i: usize) -> String {
    let p = simulation.frame().agents.position[i];
    simulation
        .scene()
        .levels
        .as_ref()
        .map_or(String::new(), |levels| {
            let (place, name) = (levels.in_building(p), &levels.all()[levels.level(p)].name);
            format!(
                "on `{}` at ({:.4}, {:.4}), {:.2} m high\n",
                shown(name),
                place.x,
                place.y,
                levels.height(p)
            )
        })
}

/// The name of the level of agent `i`; `None` on a single floor.
fn level(simulation: &Simulation, i: usize) -> Option<&str> {
    let levels = simulation.scene().levels.as_ref()?;
    let number = levels.level(simulation.frame().agents.position[i]);
    Some(&levels.all()[number].name)
}

/// The breakdown of an agent, in a building with its points at their places there.
fn breakdown(simulation: &Simulation, id: u32, i: usize) -> Result<Breakdown, Failure> {
    let mut breakdown = Breakdown::of(simulation, i)
        .ok_or_else(|| Failure::Output(format!("--agent {id}: the frame has no densities")))?;
    if let Some(levels) = &simulation.scene().levels {
        over_joins::in_building(levels, &mut breakdown);
    }
    Ok(breakdown)
}

/// The breakdowns of agents, given by their ids and indices, for readers and programs: a row for each number.
fn findings(simulation: &Simulation, inspected: &[(u32, usize)]) -> Result<Findings, Failure> {
    let clock = simulation.frame().clock;
    let (time, frame) = (clock.time(), clock.frame());
    let mut blocks = vec![Block::Text(format!("t = {time:.2} s, frame {frame}"))];
    let (mut agents, mut rows) = (Vec::new(), Vec::new());
    for &(id, i) in inspected {
        let breakdown = breakdown(simulation, id, i)?;
        let text = breakdown.to_string();
        blocks.push(Block::Heading(format!("Agent {id}")));
        blocks.push(Block::Code(text.lines().map(str::to_owned).collect()));
        let data = json!(breakdown);
        rows.extend(
            facts(&data)
                .into_iter()
                .map(|(name, value)| (id, name, value)),
        );
        agents.push(data);
    }
    let table = Table::of(&rows)
        .column("agent", |(id, ..)| *id)
        .column("quantity", |(_, name, _)| name.as_str())
        .column("value", |(.., value)| value.as_str())
        .table();
    let data = json!({ "agents": agents, "frame": frame, "time_secs": time });
    let document = Document::of("Forces on inspected agents", blocks);
    let findings = Findings::new(NAME, document, data).with_table(NAME, &table);
    findings.map_err(|error| Failure::Output(error.to_string()))
}

/// Advances to the time `at`, seconds. The state is that of a normal run; only the last frame is evaluated in double
/// precision throughout.
fn go_to(at: f64, simulation: &mut Simulation) -> Result<(), Failure> {
    let option = format!("--at {at}");
    moment::advance(simulation, at, (&option, &Progress::new(at)))?;
    simulation.set_precision(Precision::Double);
    simulation.evaluate()?;
    Ok(())
}

/// Ids and indices of the requested agents.
fn inspected(
    simulation: &Simulation,
    options: &InspectOptions,
) -> Result<Vec<(u32, usize)>, Failure> {
    let agents = simulation.frame().agents;
    if options.all {
        let mut all: Vec<_> = agents.present().map(|i| (agents.id[i], i)).collect();
        all.sort_unstable();
        return Ok(all);
    }
    let index = |&id: &u32| match simulation.present(id) {
        Ok(i) => Ok((id, i)),
        Err(why) => Err(Failure::Input(format!("--agent {id}: {why}"))),
    };
    options.agent.iter().map(index).collect()
}
