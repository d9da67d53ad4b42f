//! Rejects zones, regions and lines off the floor, where there is nothing to slow or to measure, and agents off the
//! floor.

use crate::error::quote::shown;
use crate::error::{Problem, Under};
use crate::file::File;
use crate::floor_plan::{FloorPlanError, Rings, is_line_on_floor, is_on_floor};
use crate::measurements::Observed;
use crate::scene::origin::{Member, Origins};
use engine::geometry::Ring;
use engine::journeys::{Kind, Place};
use engine::math::Vector;
use engine::routes::nearest_on;
use engine::scene::Scene;

/// The reason why an area or a line is refused.
pub const OFF: &str = "lies in obstacles or outside of the walkable area; move it onto the floor";

/// Rejects zones, and regions and lines of measurements, that lie wholly in obstacles or outside of the walkable area.
pub fn check(keys: &File, scene: &Scene) -> Result<(), Problem> {
    let walls = &scene.walls;
    for (k, zone) in scene.journeys.zones.iter().enumerate() {
        let place = format!("zones[{k}].area");
        accept(is_on_floor(zone.area.points(), walls)).under(&place)?;
    }
    for (k, measurement) in keys.measurements.iter().enumerate() {
        for (key, observed) in measurement.places() {
            let found = match observed {
                Observed::Region(region) => is_on_floor(&region.corners(), walls),
                Observed::Line(ends) => is_line_on_floor(ends, walls),
            };
            accept(found).under(&format!("measurements[{k}].{key}"))?;
        }
    }
    Ok(())
}

/// Rejects waypoints on the floors `behind` exits and entrances, to which people would walk through the line.
pub fn check_waypoints(scene: &Scene, behind: &Rings) -> Result<(), Problem> {
    let rings = rings(behind);
    let places = scene.journeys.places.iter();
    let waypoints = places.filter(|place| matches!(place.kind, Kind::Line(_) | Kind::Disk { .. }));
    for (k, place) in waypoints.enumerate() {
        let points = match &place.kind {
            Kind::Disk { at, .. } => vec![*at],
            _ => place.line().map_or(Vec::new(), Vec::from),
        };
        let is_behind =
            |p: &Vector| !is_on_line(scene, *p) && rings.iter().any(|ring| ring.contains(*p));
        if points.iter().all(is_behind) {
            let reason = format!(
                "`{}` lies behind the line of an exit or entrance and outside of the walkable area; move it onto the \
                 floor",
                shown(&place.name)
            );
            return Err(Problem::new(format!("waypoints[{k}]"), reason));
        }
    }
    Ok(())
}

fn rings(behind: &Rings) -> Vec<Ring> {
    let rings = behind.iter().map(|ring| Ring::new(ring.clone()));
    rings.filter_map(Result::ok).collect()
}

/// Single agents in obstacles start at the nearest free point, which may be this far away, meters.
const NEAR: f64 = 2.0;

/// Rejects agents of `agents`, `grids` and `sources` that start on the floors `behind` exits and entrances, or that
/// would be moved there from an obstacle, and single ones that start far off the floor.
pub fn check_starts(origins: &Origins, behind: &Rings) -> Result<(), Problem> {
    let rings = rings(behind);
    let scene = origins.scene;
    for (k, agent) in scene.agents.iter().enumerate() {
        let member = Member {
            agent: Some(k),
            group: agent.group,
        };
        let Some(key) = origins.start_key(member) else {
            continue;
        };
        let p = agent.position;
        let at = format!("({:.2}, {:.2})", p.x, p.y);
        check_behind(scene, &rings, p).under(&key)?;
        if origins.single(member).is_none() || scene.walls.obstacle_at(p).is_none() {
            continue;
        }
        let free = scene.walls.free_point_near(p);
        let distance = free.map_or(f64::INFINITY, |free| (free - p).norm());
        if distance > NEAR {
            let reason = match distance.is_finite() {
                true => format!("{at} lies {distance:.1} m off the floor; move it onto the floor"),
                false => OFF.to_owned(),
            };
            return Err(Problem::new(key, reason));
        }
    }
    for (k, source) in scene.sources.iter().enumerate() {
        // The jittered positions are known only on entry, so check the corners of the squares in which they lie.
        let reach = source.grid.jitter;
        let around = [
            (0.0, 0.0),
            (-1.0, -1.0),
            (1.0, -1.0),
            (1.0, 1.0),
            (-1.0, 1.0),
        ];
        for center in source.grid.centers() {
            for (x, y) in around {
                let corner = center + reach * Vector::new(x, y);
                check_behind(scene, &rings, corner).under(&format!("sources[{k}]"))?;
            }
        }
    }
    Ok(())
}

/// Rejects an agent at `p` if it, or the nearest free point, lies in one of `rings`: floors behind exits and entrances.
fn check_behind(scene: &Scene, rings: &[Ring], p: Vector) -> Result<(), Problem> {
    let is_solid = !rings.is_empty() && scene.walls.obstacle_at(p).is_some();
    let free = is_solid.then(|| scene.walls.free_point_near(p)).flatten();
    let start = free.unwrap_or(p);
    if is_on_line(scene, start) || !rings.iter().any(|ring| ring.contains(start)) {
        return Ok(());
    }
    let is_seen = scene.levels.as_ref().is_some_and(|levels| {
        let (level, at) = (
            &levels.all()[levels.level(start)],
            levels.in_building(start),
        );
        !level.floor.iter().any(|area| area.contains(at))
    });
    let where_to = match is_seen {
        true => "outside of this level; move it onto the floor, or name the level there",
        false if is_solid => "outside of the walkable area; move it onto the floor",
        false => {
            "behind the line of an exit or entrance and outside of the walkable area; move it onto the floor"
        }
    };
    let reason = format!("an agent starts at ({:.2}, {:.2}), {where_to}", p.x, p.y);
    Err(Problem::new("", reason))
}

/// Whether a point lies on the line of an exit, at the edge of both floors.
fn is_on_line(scene: &Scene, p: Vector) -> bool {
    let mut lines = scene.journeys.places.iter().filter_map(Place::line);
    lines.any(|[a, b]| (nearest_on(p, a, b) - p).norm() < 1e-6)
}

fn accept(is_on: Result<bool, FloorPlanError>) -> Result<(), Problem> {
    match is_on {
        Ok(true) => Ok(()),
        Ok(false) => Err(Problem::new("", OFF)),
        Err(error) => Err(Problem::new("", error.to_string())),
    }
}
