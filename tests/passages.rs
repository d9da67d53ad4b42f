//! Bodies and passages: what they fit through, which routes they take, and what files are refused for.

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sandbox::engine::routes::{Destination, Floor, Routes};
use sandbox::scenario::catalog::names;
use serde_json::{Value, json};

use crate::common::floors::Plan;
use crate::common::simulated::{after, scenario};

/// The part of its width that a body needs at least.
const SIDEWAYS: f64 = 0.6;

/// Two rooms with an opening of `width` meters in a wall of `thick` meters between them.
fn rooms(profile: &str, width: f64, thick: f64) -> Value {
    let [low, high] = [4.0 - 0.5 * width, 4.0 + 0.5 * width];
    let right = 8.0 + thick;
    json!({
        "profile": profile,
        "walkable_area": [[[[0, 0], [8, 0], [8, low], [right, low], [right, 0], [16, 0], [16, 8],
            [right, 8], [right, high], [8, high], [8, 8], [0, 8]]]],
    })
}

/// People who want to leave in the right room.
fn with_people(mut rooms: Value, radius: f64, places: &[[f64; 2]]) -> Value {
    let person =
        |p| json!({"position": p, "goal": [14, 4], "remove_within": 0.5, "radius": radius});
    rooms["agents"] = places.iter().map(person).collect();
    rooms
}

/// The least width that the scenario takes for passages.
fn least_width(document: &Value) -> f64 {
    scenario(document, &[]).unwrap().passage_width.unwrap()
}

#[test]
fn no_body_passes_an_opening_narrower_than_its_depth_however_many_push() {
    let places: Vec<[f64; 2]> = (0..30)
        .map(|k| [1.5 + 1.1 * f64::from(k % 6), 1.0 + 1.4 * f64::from(k / 6)])
        .collect();
    for profile in names() {
        for radius in [0.18, 0.24, 0.265, 0.3, 0.5] {
            let rooms = rooms(profile, 0.99 * SIDEWAYS * 2.0 * radius, 0.2);
            let document = with_people(rooms, radius, &places);
            let settings = ["navigation=straight"];
            let outcome = after(&document, &settings, 40.0).outcome().arrivals.len();
            assert_eq!(outcome, 0, "{profile}, {radius} m");
        }
    }
}

#[test]
fn a_lone_agent_before_the_narrowest_passage_that_it_chooses_passes_it() {
    let mut rng = ChaCha8Rng::seed_from_u64(4);
    for profile in names() {
        for radius in [0.18, 0.215, 0.24, 0.265, 0.3] {
            let from = [rng.random_range(1.0..7.0), rng.random_range(3.95..4.05)];
            let wide = with_people(rooms(profile, 3.0, 0.2), radius, &[from]);
            let width = 1.001 * least_width(&wide);
            let thick = rng.random_range(0.1..1.5);
            let document = with_people(rooms(profile, width, thick), radius, &[from]);
            let outcome = after(&document, &[], 60.0).outcome().arrivals.len();
            assert_eq!(outcome, 1, "{profile}, {radius} m, {width} m, {from:?}");
        }
    }
}

#[test]
fn the_default_width_of_passages_follows_from_the_widest_body() {
    let of = |profile: &str, radius: f64| {
        least_width(&with_people(
            rooms(profile, 3.0, 0.2),
            radius,
            &[[2.0, 2.0]],
        ))
    };
    for radius in [0.2, 0.265, 0.4] {
        for profile in names() {
            let part = of(profile, radius) / (2.0 * radius);
            assert!(
                (SIDEWAYS..=1.1 + 1e-12).contains(&part),
                "{profile}: {part}"
            );
        }
        assert!((of("sph", radius) - 2.0 * radius).abs() < 1e-12);
    }
    let mut document = with_people(rooms("sph", 3.0, 0.2), 0.2, &[[2.0, 2.0]]);
    document["crowds"] = json!([{"area": [[5, 5], [7, 5], [7, 7]], "number": 2, "goal": [14, 4],
        "radius": {"uniform": [0.2, 0.35]}}]);
    let width = least_width(&document);
    assert!((width - 0.7).abs() < 1e-4, "{width}");
    document["min_passage_width"] = json!(0.3);
    assert_eq!(least_width(&document), 0.3);
}

#[test]
fn files_whose_bodies_fit_no_way_are_refused_with_the_passage_and_others_get_a_note() {
    let refused = |document: &Value| scenario(document, &[]).unwrap_err();
    let people = [[2.0, 2.0], [2.0, 3.0]];
    let narrow = with_people(rooms("walk+sph", 0.42, 0.2), 0.4, &people);
    let error = refused(&narrow);
    let [default, body] = [
        "narrower than 0.64 m, too narrow for agents[0], up to 0.8 m wide",
        "has one of 0.42 m at (8",
    ];
    assert!(error.contains(default) && error.contains(body), "{error}");
    let mut given = narrow.clone();
    given["min_passage_width"] = json!(0.2);
    let error = refused(&given);
    let expected = "agents[0]: bodies 0.8 m wide need 0.48 m with turned shoulders, and the widest way has a passage \
                    of 0.42 m at (8";
    assert!(error.contains(expected), "{error}");
    let notes = |profile: &str, width: f64| {
        let mut document = with_people(rooms(profile, width, 0.2), 0.25, &people);
        document["min_passage_width"] = json!(0.2);
        scenario(&document, &[]).unwrap().notes
    };
    let expected = "agents[0]: on the way to (14, 4), bodies 0.5 m wide fit only with turned shoulders in a passage \
                    of 0.42 m";
    assert!(notes("walk+sph", 0.42)[0].contains(expected));
    assert!(notes("sph", 0.42)[0].contains("bodies 0.5 m wide can stick in a passage of 0.42 m"));
    assert_eq!(notes("sph", 0.52), Vec::<String>::new());
    // Another way is wide enough.
    let mut two = with_people(rooms("sph", 0.42, 0.2), 0.25, &people);
    two["min_passage_width"] = json!(0.2);
    two["walkable_area"].as_array_mut().unwrap().push(json!([[
        [7, 6.5],
        [9, 6.5],
        [9, 7.5],
        [7, 7.5]
    ]]));
    assert_eq!(scenario(&two, &[]).unwrap().notes, Vec::<String>::new());
}

#[test]
fn the_narrowest_passage_of_the_widest_way_is_where_routes_close() {
    let mut closed = 0;
    for case in 0..60 {
        let mut rng = ChaCha8Rng::seed_from_u64(case);
        let plan = Plan::with_gaps(&mut rng, 10, 0.1);
        let ends = [(); 2].map(|()| plan.free(&mut rng, 0.3));
        let [Some(from), Some(to)] = ends else {
            continue;
        };
        let areas = plan.areas();
        let floor = Floor::new(&areas, 1.0).unwrap();
        if floor.locate(from) == floor.locate(to) {
            continue;
        }
        let passages = floor.passages([to].into_iter());
        let Some(passage) = passages.from(floor.locate(from).unwrap()) else {
            continue;
        };
        let is_open = |width: f64| {
            let floor = Floor::new(&areas, width).unwrap();
            let routes = Routes::new(floor, &[], vec![to]).unwrap();
            routes.is_open(from, Destination::Goal(to))
        };
        let width = passage.width.min(1.0);
        assert!(is_open(width - 1e-6), "case {case}: {passage:?}");
        if passage.width < 1.0 {
            closed += 1;
            // Passages of the least width to within a micrometer are open.
            assert!(
                !is_open(width + 3e-6),
                "case {case}: {passage:?}, {from:?}, {to:?}"
            );
        }
    }
    assert!(closed > 5, "{closed}");
}
