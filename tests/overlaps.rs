//! A note on agents that overlap at the start.

use std::collections::BTreeMap;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use sandbox::scenario::Scenario;
use serde_json::{Value, json};

fn notes(document: &Value) -> Vec<String> {
    let scenario = Scenario::parse(&document.to_string(), "f.json", &[]);
    scenario.unwrap_or_else(|error| panic!("{error}")).notes
}

#[test]
fn a_grid_that_is_too_dense_is_noted_with_its_place_and_density() {
    let grid = |cells: u32| {
        json!({"goal": [9, 9], "grids": [{"min": [4, 4], "max": [5, 5], "columns": cells, "rows": cells,
                                          "radius": 0.24}]})
    };
    let note = "400 of 400 agents overlap others by more than half a radius at the start, up to 400 P/m², in the \
                square meter from (4, 4) to (5, 5); give them more room, or check the units";
    assert_eq!(notes(&grid(20)), [note]);
    assert_eq!(notes(&grid(4)).len(), 1, "0.25 m apart");
    assert_eq!(notes(&grid(3)).len(), 0, "0.33 m apart");
}

type Agent = [f64; 3];

fn overlap([x, y, r]: &Agent, [u, v, s]: &Agent) -> bool {
    (x - u).hypot(y - v) < r.max(*s) + 0.5 * r.min(*s)
}

/// The agents that overlap others: their number, and the most in a square meter.
fn overlapping(agents: &[Agent]) -> (usize, usize) {
    let (mut count, mut cells) = (0, BTreeMap::new());
    for (k, one) in agents.iter().enumerate() {
        let others = agents.iter().enumerate().filter(|(l, _)| *l != k);
        if others
            .map(|(_, other)| other)
            .any(|other| overlap(one, other))
        {
            count += 1;
            let cell = [one[0], one[1]].map(|x| x.floor() as i32);
            *cells.entry(cell).or_insert(0) += 1;
        }
    }
    (count, cells.into_values().max().unwrap_or(0))
}

#[test]
fn overlapping_agents_are_those_that_a_search_over_all_pairs_finds() {
    let mut random = ChaCha8Rng::seed_from_u64(7);
    let mut noted = 0;
    for case in 0..200 {
        let side = [0.8, 2.0, 5.0][case % 3];
        let count = random.random_range(1..120);
        let agents = (0..count).map(|_| {
            let place = [(); 2].map(|()| random.random_range(-side..side));
            [place[0], place[1], random.random_range(0.1..0.6)]
        });
        let agents: Vec<Agent> = agents.collect();
        let (expected, most) = overlapping(&agents);
        let agents = agents
            .iter()
            .map(|[x, y, r]| json!({"position": [x, y], "radius": r}));
        let document = json!({"goal": [99, 9], "agents": agents.collect::<Vec<_>>()});
        let of_density = |note: &String| note.contains("P/m²");
        let Some(note) = notes(&document).into_iter().find(of_density) else {
            assert!(most < 10, "{expected} of {count}");
            continue;
        };
        noted += 1;
        assert!(
            most >= 10 && note.starts_with(&format!("{expected} of {count} ")),
            "{note}"
        );
        assert!(note.contains(&format!("up to {most} P/m²")), "{note}");
    }
    assert!((50..150).contains(&noted), "{noted}");
}
