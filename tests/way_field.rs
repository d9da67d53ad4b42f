//! Sampled ways and the corners of whole ways agree with the path maps that they come from.

use sandbox::analysis::way_field::{Grid, WayField};
use sandbox::engine::math::Vector;
use sandbox::engine::ways::{Destination, Next, Ways};
use sandbox::scenario::Scenario;

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

fn ways() -> std::sync::Arc<Ways> {
    let scenario = Scenario::parse(HALL, "hall.json", &[]).unwrap();
    scenario.scene.ways.unwrap()
}

fn grid(cell: f64) -> Grid {
    Grid::over([Vector::new(-1.0, -1.0), Vector::new(45.0, 31.0)], cell)
}

#[test]
fn a_sampled_way_is_the_way_from_the_center_of_its_cell() {
    let ways = ways();
    for place in 0..3 {
        let to = Destination::Place(place);
        let field = WayField::new(&ways, to, grid(0.4));
        let (mut inside, mut longest) = (0, 0.0_f64);
        for (k, length) in field.lengths.iter().enumerate() {
            let p = field.grid.center(k);
            let way = ways.floor.locate(p).and_then(|_| ways.way(p, to));
            assert_eq!(*length, way.map(|way| way.length));
            inside += usize::from(length.is_some());
            longest = longest.max(length.unwrap_or(0.0));
        }
        assert!(inside > 6000, "{inside}");
        assert_eq!(field.longest(), longest);
        let bands = field.bands();
        assert!((5..=14).contains(&bands.count), "{bands:?}");
        assert!(bands.end() >= longest && bands.end() - bands.width < longest);
    }
}

#[test]
fn borders_lie_where_the_next_corner_changes() {
    let ways = ways();
    let to = Destination::Place(0);
    let field = WayField::new(&ways, to, grid(0.5));
    let next = |k: usize| {
        let p = field.grid.center(k);
        let way = ways.floor.locate(p).and_then(|_| ways.way(p, to));
        way.map(|way| match way.next {
            Next::Corner { bend, .. } => bend.index() as i64,
            Next::Goal(_) => -1,
            Next::Out(_) => -2,
        })
    };
    let (columns, count) = (field.grid.columns, field.grid.len());
    let mut borders = 0;
    for k in 0..count {
        let others = [
            (k + 1, (k + 1) % columns != 0),
            (k + columns, k + columns < count),
        ];
        let changes = others.into_iter().any(|(other, is_there)| {
            let (here, there) = (next(k), is_there.then(|| next(other)).flatten());
            here.is_some() && there.is_some() && here != there
        });
        assert_eq!(field.is_border(k), changes, "{}", field.grid.center(k));
        borders += usize::from(changes);
    }
    assert!((50..count / 10).contains(&borders), "{borders}");
    for corner in field.corners() {
        assert!(ways.floor.corners.get(corner as usize).is_some());
    }
}

#[test]
fn the_points_of_a_whole_way_are_as_far_apart_as_the_way_is_long() {
    let ways = ways();
    let grid = grid(0.9);
    let (mut checked, mut bends) = (0, 0);
    for place in 0..3 {
        let to = Destination::Place(place);
        for p in (0..grid.len()).map(|k| grid.center(k)) {
            let Some(way) = ways.floor.locate(p).and_then(|_| ways.way(p, to)) else {
                continue;
            };
            if matches!(way.next, Next::Out(_)) {
                continue;
            }
            let course = ways.course(p, to);
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
    let ways = ways();
    let unknown = [
        Destination::Place(3),
        Destination::Goal(Vector::new(1.0, 1.0)),
    ];
    for to in unknown {
        assert!(!ways.leads_to(to));
        assert_eq!(ways.way(Vector::new(5.0, 5.0), to), None);
        assert!(ways.course(Vector::new(5.0, 5.0), to).is_empty());
    }
}
