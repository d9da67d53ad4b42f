//! Rejects overcrowded cells and agents that start inside obstacles.

use crate::error::Problem;
use crate::file::File;
use crate::scene::need;
use crate::scene::origin::Items;
use engine::geometry::Walls;
use engine::math::Vector;
use engine::scene::Scene;

/// Most agents, or corners of obstacles, in one square meter. Ten agents are a crush, and run time grows with the
/// square of the density.
const MOST_PER_CELL: usize = 1_000;

/// Rejects overcrowded cells, and agents inside obstacles with no free point nearby.
pub fn check(
    file: &File,
    (scene, items): (&Scene, &Items),
    duration_secs: f64,
) -> Result<(), Problem> {
    let corners: Vec<Vector> = scene.walls.iter().map(|wall| wall.start).collect();
    if let Some((k, count)) = crowded(&corners) {
        let place = format!("obstacles[{}]", scene.walls.wall(k as u32).obstacle);
        let reason = format!(
            "{count} corners of obstacles {}; at most {MOST_PER_CELL} are allowed: leave out unimportant \
             corners",
            near(corners[k])
        );
        return Err(Problem::new(place, reason));
    }
    let people: Vec<Vector> = scene.agents.iter().map(|agent| agent.position).collect();
    if let Some((k, count)) = crowded(&people) {
        return Err(Problem::new(
            items.of_agent(k).to_string(),
            too_close(count, people[k]),
        ));
    }
    if let Some((k, reason)) = locked(&scene.walls, &people) {
        return Err(Problem::new(items.of_agent(k).to_string(), reason));
    }
    let last_entry = need::last_entry(file, &scene.clock, duration_secs);
    for (k, (source, given)) in scene.sources.iter().zip(&file.sources).enumerate() {
        if need::entries(given, last_entry) == 0 {
            continue;
        }
        let people: Vec<Vector> = source.grid.positions(scene.seed, 0).collect();
        if let Some((i, count)) = crowded(&people) {
            return Err(Problem::new(
                format!("sources[{k}]"),
                too_close(count, people[i]),
            ));
        }
        // The jittered positions are known only on entry, so check the cell centers.
        let centers: Vec<Vector> = source.grid.centers().collect();
        if let Some((_, reason)) = locked(&scene.walls, &centers) {
            return Err(Problem::new(format!("sources[{k}]"), reason));
        }
    }
    Ok(())
}

fn too_close(count: usize, p: Vector) -> String {
    format!(
        "{count} agents {}; at most {MOST_PER_CELL} are allowed: give them more room, or use fewer",
        near(p)
    )
}

/// The square meter around a point, for messages.
pub fn near(p: Vector) -> String {
    let [x, y] = cell(&p).map(f64::from);
    format!(
        "in the square meter from ({x}, {y}) to ({}, {})",
        x + 1.0,
        y + 1.0
    )
}

/// The lower left corner of the square meter around a point.
pub fn cell(p: &Vector) -> [i32; 2] {
    [p.x.floor() as i32, p.y.floor() as i32]
}

/// The first of `points` in an overcrowded square meter, and the number of points there.
pub fn crowded(points: &[Vector]) -> Option<(usize, usize)> {
    if points.len() <= MOST_PER_CELL {
        return None;
    }
    let mut cells: Vec<[i32; 2]> = points.iter().map(cell).collect();
    cells.sort_unstable();
    let groups = cells.chunk_by(|a, b| a == b);
    let full: Vec<&[[i32; 2]]> = groups.filter(|same| same.len() > MOST_PER_CELL).collect();
    points.iter().enumerate().find_map(|(k, p)| {
        let found = full.binary_search_by_key(&cell(p), |same| same[0]).ok()?;
        Some((k, full[found].len()))
    })
}

/// The first of `people` inside an obstacle with no free point nearby, and the message.
fn locked(walls: &Walls, people: &[Vector]) -> Option<(usize, String)> {
    people.iter().enumerate().find_map(|(k, &p)| {
        let obstacle = walls.obstacle_at(p)?;
        if walls.free_point_near(p).is_some() {
            return None;
        }
        let reason = format!(
            "an agent at ({:.2}, {:.2}) is inside obstacles[{obstacle}], and no free point is near; move \
             the agent or the obstacle",
            p.x, p.y
        );
        Some((k, reason))
    })
}
