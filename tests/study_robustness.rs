//! Any study file gives checked cells or an error, within bounded memory.
//!
//! Only 25,000 cases, because the scenario of every cell is read; more with `BAD_INPUT_TIMES=10 cargo test …`. The
//! memory limit is 1 MB plus 200 bytes per byte of the text and 100 kB per cell.

use crate::common::bounded::cases;
use crate::common::documents::{count, invalid_value, replace};
use crate::common::reading_studies::read;
use proptest::prelude::*;
use proptest::sample::Index;
use serde_json::{Value, json};

fn memory_limit(text: &str, cells: u64) -> u64 {
    (1 << 20) + 200 * text.len() as u64 + 100_000 * cells
}

/// Valid studies of several cells, which together have every key.
fn studies() -> [Value; 3] {
    let few = json!({"grids.0.columns": 2, "grids.0.rows": 2});
    [
        json!({"scenario": "evacuation", "settings": few, "grid": {"viscosity": [1, 2]}, "seeds": 2}),
        json!({"name": "a", "description": "b", "scenario": "evacuation", "settings": few, "seeds": [3, 1],
               "list": [{"viscosity": 1}, {"gas_constant": 100, "profile": "sf->sph"}], "grid": {"max_speed": [2]}}),
        json!({"grid": {"scenario": ["evacuation"], "grids.0.columns": [1, 3], "grids.0.rows": [2],
                        "profile": ["sph", {"base": "sf"}]}}),
    ]
}

#[test]
fn any_text_is_read_or_refused() {
    cases(5_000, any::<String>, |text| {
        memory_limit(&text, read(&text))
    });
}

#[test]
fn a_study_with_changed_values_is_read_or_refused() {
    let studies = studies();
    for study in &studies {
        assert!(read(&study.to_string()) >= 2, "{study}");
    }
    let changes = || prop::collection::vec((any::<Index>(), invalid_value()), 1..3);
    cases(
        12_000,
        || (0..studies.len(), changes()),
        |(which, changes)| {
            let mut study = studies[which].clone();
            for (place, by) in changes {
                let mut k = place.index(count(&study));
                replace(&mut study, &mut k, &by);
            }
            let text = study.to_string();
            memory_limit(&text, read(&text))
        },
    );
}

#[test]
fn a_study_that_is_cut_doubled_or_nested_is_read_or_refused() {
    let texts = studies().map(|study| study.to_string());
    let input = || (0..texts.len(), any::<[Index; 3]>(), 0..5_u8, 1..3_000_usize);
    cases(8_000, input, |(which, places, how, depth)| {
        let text = &texts[which];
        let [from, to, at] = places.map(|place| place.index(text.len()));
        let (from, to) = (from.min(to), from.max(to));
        let (head, rest) = text.split_at(at); // all of it is ASCII
        let changed = match how {
            0 => head.to_owned(),
            1 => format!("{}{}", &text[..from], &text[to..]),
            2 => format!("{head}{}{rest}", &text[from..to]),
            3 => format!("{head}{}{rest}", "[".repeat(depth)),
            _ => format!("{head}{}{rest}", "\\u001b".repeat(depth)),
        };
        memory_limit(&changed, read(&changed))
    });
}

#[test]
fn long_lists_of_seeds_and_values_are_refused_quickly() {
    let seeds: Vec<u32> = (0..1_000_000).collect();
    let study = json!({"scenario": "evacuation", "seeds": seeds}).to_string();
    read(&study);
    let study = json!({"scenario": "evacuation", "grid": {"viscosity": seeds}}).to_string();
    assert_eq!(read(&study), 0);
}
