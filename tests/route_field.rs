//! Sampled routes agree with a visibility graph by brute force, and the corners of whole routes with the path maps that
//! they come from.

use std::collections::BTreeSet;

use sandbox::analysis::way_field::{Grid, WayField};
use sandbox::engine::math::Vector;
use sandbox::engine::routes::{Destination, Next, Routes, nearest_on};
use sandbox::scenario::Scenario;

use crate::common::floors::Plan;
use crate::common::visibility::Sights;

/// A hall with walls, a pillar and a narrow passage at the lower end of one wall.
const HALL: &str = r#"{
    "walkable_area": [[[[0,0],[40,0],[40,30],[0,30]], [[10,5],[11,5],[11,25],[10,25]],
        [[20,0.6],[21,0.6],[21,18],[30,18],[30,19],[20,19]], [[32,5],[37,6],[34,12]]]],
    "exits": [{"name": "east", "line": [[40,14],[40,16]]}],
    "waypoints": [{"name": "kiosk", "at": [25,8], "within": 1}],
    "queues": [{"name": "till", "path": [[35,25],[30,25],[30,22]], "service_secs": 3}],
    "journeys": [{"name": "guest", "stages": ["kiosk", "till", "east"]}],
    "grids": [{"min": [1,1], "max": [9,29], "columns": 3, "rows": 9, "journey": "guest"}]
}"#;

fn routes() -> std::sync::Arc<Routes> {
    let scenario = Scenario::parse(HALL, "hall.json", &[]).unwrap();
    scenario.scene.routes.unwrap()
}

fn grid(cell: f64) -> Grid {
    Grid::over([Vector::new(-1.0, -1.0), Vector::new(45.0, 31.0)], cell)
}

/// Cells over the hall, with no center on the line of a wall.
fn inside() -> Grid {
    let cell = 40.0 / 104.0;
    let grid = Grid::over([Vector::zeros(), Vector::new(39.9, 29.9)], cell);
    assert_eq!([grid.columns, grid.rows], [104, 78]);
    grid
}

/// The hall as a plan.
fn plan() -> Plan {
    let hall: serde_json::Value = serde_json::from_str(HALL).unwrap();
    let rings = serde_json::from_value(hall["walkable_area"][0].clone());
    Plan {
        rings: rings.unwrap(),
    }
}

/// The ends of the places of the hall, as lines and points. Path maps shorten lines by 1 cm at both ends.
fn ends(place: u16) -> Vec<[Vector; 2]> {
    let point = |x, y| [Vector::new(x, y); 2];
    match place {
        0 => vec![[Vector::new(40.0, 14.01), Vector::new(40.0, 15.99)]],
        1 => vec![point(25.0, 8.0)],
        _ => vec![point(35.0, 25.0), point(30.0, 25.0), point(30.0, 22.0)],
    }
}

/// Lengths that differ by less than this are equal, meters: joining areas moves corners by up to a micrometer.
const EQUAL: f64 = 1e-5;

/// Shortest routes to a place by a visibility graph.
struct Oracle {
    sights: Sights,
    ends: Vec<[Vector; 2]>,
    /// The lengths of the routes from the bends, meters.
    rest: Vec<f64>,
}

impl Oracle {
    fn new(place: u16) -> Self {
        let sights = Sights::new(&plan().areas());
        let corners: Vec<Vector> = sights.bends.iter().map(|bend| bend.place).collect();
        let ends = ends(place);
        let mut rest = vec![f64::INFINITY; corners.len()];
        for &end in &ends {
            let lengths = sights.lengths(end, &corners).into_iter();
            rest = lengths.zip(rest).map(|(a, b)| a.min(b)).collect();
        }
        Self { sights, ends, rest }
    }

    /// The length of the shortest way from `p`, meters, and the number of its first corner, if it has one; the number
    /// is `Err` if two ways with different beginnings are equally long.
    fn way(&self, p: Vector) -> (f64, Result<Option<usize>, ()>) {
        let sights = &self.sights;
        let straight = self
            .ends
            .iter()
            .flat_map(|&[a, b]| [nearest_on(p, a, b), a, b]);
        let straight = straight.filter(|&end| sights.sees(p, end));
        let straight = straight.map(|end| ((end - p).norm(), None));
        let bends = sights.bends.iter().zip(&self.rest).enumerate();
        let bends = bends.filter(|(_, (bend, _))| sights.sees_bend(p, bend));
        let bends = bends.map(|(k, (bend, rest))| ((bend.place - p).norm() + rest, Some(k)));
        let mut routes: Vec<(f64, Option<usize>)> = straight.chain(bends).collect();
        routes.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (length, first) = routes[0];
        let is_tie = |&(other, by): &(f64, Option<usize>)| other < length + EQUAL && by != first;
        let first = if routes.iter().any(is_tie) {
            Err(())
        } else {
            Ok(first)
        };
        (length, first)
    }
}

#[test]
fn sampled_lengths_agree_with_a_visibility_graph_by_brute_force() {
    let (routes, plan) = (routes(), plan());
    for place in 0..3 {
        let field = WayField::new(&routes, Destination::Place(place), inside());
        let oracle = Oracle::new(place);
        let (mut on_floor, mut longest) = (0, 0.0_f64);
        for (k, length) in field.lengths.iter().enumerate() {
            let p = field.grid.center(k);
            assert_eq!(length.is_some(), plan.is_free(p, 0.0), "{p}");
            if let Some(length) = length {
                let expected = oracle.way(p).0;
                assert!(
                    (length - expected).abs() < EQUAL,
                    "{length} instead of {expected} m from {p} to place {place}"
                );
                on_floor += 1;
                longest = longest.max(expected);
            }
        }
        assert!(on_floor > 6000, "{on_floor}");
        assert!((field.longest() - longest).abs() < EQUAL);
        let bands = field.bands();
        assert!((5..=14).contains(&bands.count), "{bands:?}");
        assert!(bands.end() > longest - EQUAL && bands.end() - bands.width < longest + EQUAL);
    }
}

#[test]
fn borders_lie_where_the_next_corner_of_a_visibility_graph_changes() {
    let (routes, plan) = (routes(), plan());
    for place in 0..3 {
        let field = WayField::new(&routes, Destination::Place(place), inside());
        let oracle = Oracle::new(place);
        let (columns, count) = (field.grid.columns, field.grid.len());
        let centers = (0..count).map(|k| field.grid.center(k));
        let next = centers.map(|p| plan.is_free(p, 0.0).then(|| oracle.way(p).1));
        let next: Vec<Option<Result<Option<usize>, ()>>> = next.collect();
        let (mut borders, mut skipped) = (0, 0);
        for k in 0..count {
            let right = ((k + 1) % columns != 0).then_some(k + 1);
            let near = [right, Some(k + columns).filter(|&above| above < count)];
            let near = near.into_iter().flatten().filter_map(|other| next[other]);
            let near: Vec<Result<Option<usize>, ()>> = near.collect();
            if next[k] == Some(Err(())) || near.contains(&Err(())) {
                skipped += 1;
                continue;
            }
            let changes = next[k].is_some_and(|here| near.iter().any(|&there| here != there));
            assert_eq!(field.is_border(k), changes, "{}", field.grid.center(k));
            borders += usize::from(changes);
        }
        assert!((50..count / 10).contains(&borders), "{borders} borders");
        assert!(skipped < count / 50, "{skipped} skipped");
        let first: BTreeSet<usize> = next.iter().flatten().flatten().flatten().copied().collect();
        let corners = field.corners();
        assert_eq!(corners.len(), first.len());
        for corner in corners {
            let corner = routes.floor.corners[corner as usize].place;
            let is_here = |&k: &usize| (oracle.sights.bends[k].place - corner).norm() < EQUAL;
            assert!(first.iter().any(is_here), "{corner}");
        }
    }
}

#[test]
fn the_points_of_a_whole_way_are_as_far_apart_as_the_way_is_long() {
    let routes = routes();
    let grid = grid(0.9);
    let (mut checked, mut bends) = (0, 0);
    for place in 0..3 {
        let to = Destination::Place(place);
        for p in (0..grid.len()).map(|k| grid.center(k)) {
            let Some(way) = routes.floor.locate(p).and_then(|_| routes.way(p, to)) else {
                continue;
            };
            if matches!(way.next, Next::Out(_)) {
                continue;
            }
            let course = routes.course(p, to);
            let mut points = vec![p];
            points.extend(&course);
            let sides = points.windows(2).map(|pair| (pair[1] - pair[0]).norm());
            let length: f64 = sides.sum();
            assert!(
                (length - way.length).abs() < 1e-6,
                "{p}: {length} is not {}",
                way.length
            );
            checked += 1;
            bends = bends.max(course.len() - 1);
        }
    }
    assert!(checked > 3000 && bends >= 3, "{checked}, {bends}");
}

#[test]
fn a_destination_without_a_path_map_has_no_way() {
    let routes = routes();
    let unknown = [
        Destination::Place(3),
        Destination::Goal(Vector::new(1.0, 1.0)),
    ];
    for to in unknown {
        assert!(!routes.leads_to(to));
        assert_eq!(routes.way(Vector::new(5.0, 5.0), to), None);
        assert!(routes.course(Vector::new(5.0, 5.0), to).is_empty());
    }
}
