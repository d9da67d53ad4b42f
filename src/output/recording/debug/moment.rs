//! The numbers of single agents at one moment, as tables.

use rerun::{RecordingStream, TextDocument};

use super::Open;
use crate::recording::error::Cause;
use engine::breakdown::Breakdown;
use engine::math::Vector;

/// The most neighbors and walls in a table.
const MOST_ROWS: usize = 20;

/// The entity of the table of an agent.
pub fn entity(name: &str) -> String {
    format!("info/agents/{name}")
}

/// Logs the table of an agent.
pub fn log(stream: &RecordingStream, agent: &Open) -> Result<(), Cause> {
    let of = &agent.breakdown;
    let level = agent.level.as_ref();
    let on_level = level.map_or(String::new(), |name| format!(" on {name}"));
    let document = TextDocument::from_markdown(markdown(of, &on_level));
    Ok(stream.log_static(entity(&of.id.to_string()), &document)?)
}

/// A breakdown in Markdown; `level`: on which level of a building.
fn markdown(of: &Breakdown, level: &str) -> String {
    let mut text = format!("# Agent {}{level}\n\n## Accelerations, m/s²\n\n", of.id);
    text += &accelerations(of);
    text += "\n## State\n\n| quantity | value |\n|---|---:|\n";
    for (quantity, value) in state(of) {
        text += &format!("| {quantity} | {value} |\n");
    }
    let way = of.route_and_visit();
    if !way.is_empty() {
        text += "\n## Way\n\n";
        for line in way.lines() {
            text += &format!("* {}\n", line.trim());
        }
    }
    text += &format!(
        "\n## Walls that hide a part of the kernel: {}\n\n",
        of.walls.len()
    );
    if !of.walls.is_empty() {
        text += "| wall | nearest point, m | hidden area, m² | density, P/m² |\n|---:|---:|---:|---:|\n";
    }
    for wall in of.walls.iter().take(MOST_ROWS) {
        let (at, area, density) = (pair(wall.nearest_point), wall.hidden_area, wall.density);
        text += &format!("| {} | {at} | {area:.4} | {density:.4} |\n", wall.wall);
    }
    text += &rest(of.walls.len());
    text += &format!(
        "\n## Neighbors within the kernel: {}\n\n",
        of.neighbors.len()
    );
    if !of.neighbors.is_empty() {
        text += "| id | distance, m |\n|---:|---:|\n";
    }
    for neighbor in of.neighbors.iter().take(MOST_ROWS) {
        text += &format!("| {} | {:.3} |\n", neighbor.id, neighbor.distance);
    }
    text + &rest(of.neighbors.len())
}

/// A note on the rows beyond the most.
fn rest(rows: usize) -> String {
    match rows.saturating_sub(MOST_ROWS) {
        0 => String::new(),
        more => format!("\nand {more} more\n"),
    }
}

fn pair([x, y]: [f64; 2]) -> String {
    format!("({x:.3}, {y:.3})")
}

fn row(name: &str, acceleration: Vector) -> String {
    let (x, y, size) = (acceleration.x, acceleration.y, acceleration.norm());
    format!("| {name} | {x:.4} | {y:.4} | {size:.4} |\n")
}

/// The terms of every active profile, and their weighted sum.
fn accelerations(of: &Breakdown) -> String {
    let mut text = "| term | x | y | magnitude |\n|---|---:|---:|---:|\n".to_owned();
    for share in &of.profiles {
        text += &format!("| **{} × {:.4}** | | | |\n", share.name, share.weight);
        for (name, value) in share.accelerations.listed() {
            text += &row(name, value);
        }
    }
    for force in &of.own_forces {
        text += &row(&force.name, force.acceleration.into());
    }
    text + &row("**total (weighted)**", of.acceleration.into())
}

fn state(of: &Breakdown) -> [(&'static str, String); 10] {
    let speed = Vector::from(of.velocity).norm();
    let parts = [of.density_from_agents, of.density_from_walls];
    [
        ("position, m", pair(of.position)),
        ("velocity, m/s", pair(of.velocity)),
        ("speed, m/s", format!("{speed:.4}")),
        ("radius, m", format!("{:.4}", of.radius)),
        ("mass (1: an average person)", format!("{:.4}", of.mass)),
        ("density ρ, P/m²", format!("{:.4}", of.density)),
        (
            "of it from agents and from walls",
            format!("{:.4} + {:.4}", parts[0], parts[1]),
        ),
        ("mean density, P/m²", format!("{:.4}", of.mean_density)),
        ("rest density ρ⁰, P/m²", format!("{:.4}", of.rest_density)),
        ("pressure p, 1/s²", format!("{:.4}", of.pressure)),
    ]
}
