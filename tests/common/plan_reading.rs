//! Reads any text as a floor plan, for tests and for fuzzing.

use sandbox::engine::geometry::{Area, Polygon, Walls};
use sandbox::scenario::floor_plan::{self, FloorPlan, FloorPlanError};

/// Checks the walls of a valid plan, or that the error names a place in the text.
pub fn read(text: &str) {
    let plan = match floor_plan::parse(text) {
        Ok(plan) => plan,
        Err(error) => return check_place(text, &error),
    };
    let rings = |area: &Area| -> Vec<Vec<[f64; 2]>> {
        let points = area.rings().map(|ring| ring.points().iter());
        points
            .map(|points| points.map(|p| [p.x, p.y]).collect())
            .collect()
    };
    let written: Vec<_> = plan.walkable.iter().map(rings).collect();
    if !written.is_empty() {
        // Writing and reading a plan gives the same plan. Near the origin, where corners are accurate to less than
        // a micrometer, its areas are valid obstacles, too.
        let again = FloorPlan::walkable(&written).unwrap();
        let size = |plan: &FloorPlan| plan.walkable.iter().map(Area::area).sum::<f64>();
        let points = written.iter().flatten().flatten().flatten();
        let reach = points.fold(1.0_f64, |reach, x| reach.max(x.abs()));
        let length: f64 = plan.clone().solids().unwrap().iter().map(perimeter).sum();
        let rounding = (1e-6 + 1e-8 * reach) * length;
        assert!((size(&again) - size(&plan)).abs() < rounding, "{again:?}");
        if reach < 100.0 {
            for rings in &written {
                FloorPlan::obstacle(rings).unwrap();
            }
        }
    }
    let walls = Walls::new(plan.solids().unwrap());
    for wall in walls.iter() {
        assert!(wall.start.amax() <= 1e6 && wall.length() > 0.0);
        walls.obstacle_at((wall.start + wall.end) * 0.5);
    }
}

/// The total length of all edges, meters.
fn perimeter(solid: &Polygon) -> f64 {
    solid.edges().map(|(a, b)| (b - a).norm()).sum()
}

/// Checks that every point in a message is a point of the text.
fn check_place(text: &str, error: &FloorPlanError) {
    let said = error.to_string();
    assert!(!said.is_empty() && !said.contains("near ("), "{said}");
    if !matches!(error, FloorPlanError::Geometry { .. }) {
        return;
    }
    let is_number = |c: char| c.is_ascii_digit() || "+-.eE".contains(c);
    let drawn = |number: f64| {
        let given = text
            .split(|c| !is_number(c))
            .filter_map(|n| n.parse::<f64>().ok());
        given
            .into_iter()
            .any(|n| n == number || n.is_nan() && number.is_nan())
    };
    for point in said
        .split('(')
        .skip(1)
        .filter_map(|part| part.split(')').next())
    {
        let Some((x, y)) = point.split_once(", ") else {
            continue;
        };
        if let (Ok(x), Ok(y)) = (x.parse::<f64>(), y.parse::<f64>()) {
            let finite = x.is_finite() && y.is_finite();
            assert!(!finite || drawn(x) && drawn(y), "({x}, {y}): {said}");
        }
    }
}
