//! Whatever a file says, reading it ends in a scenario or in an error.

mod common;

use common::documents::{count, nasty, replace};
use proptest::prelude::*;
use sandbox::scenario::{SHIPPED, Scenario, Setting};
use sandbox::simulation::Simulation;
use serde_json::Value;

/// JSON of any shape.
fn any_json() -> impl Strategy<Value = Value> {
    let key = prop_oneof![
        "[a-z_]{0,5}".boxed(),
        prop::sample::select(vec![
            "profile",
            "blend",
            "agents",
            "grids",
            "position",
            "parameters"
        ])
        .prop_map(str::to_owned)
        .boxed(),
    ];
    nasty().prop_recursive(5, 40, 6, move |inner| {
        prop_oneof![
            prop::collection::vec(inner.clone(), 0..6).prop_map(Value::from),
            prop::collection::btree_map(key.clone(), inner, 0..6)
                .prop_map(|entries| entries.into_iter().collect::<Value>()),
        ]
    })
}

/// Reads `text`; what is read without an error must run, or stop with a reason.
fn read(text: &str, settings: &[Setting]) {
    match Scenario::parse(text, "f.json", settings) {
        Ok(scenario) if scenario.scene.agents.len() < 500 => {
            if let Ok(mut simulation) = Simulation::new(scenario.scene) {
                let _ = simulation.step().and_then(|()| simulation.step());
            }
        }
        Ok(_) => {}
        Err(error) => assert!(!error.to_string().is_empty()),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn any_text_is_read_or_refused(text in any::<String>()) {
        read(&text, &[]);
    }

    #[test]
    fn any_json_is_read_or_refused(document in any_json()) {
        read(&document.to_string(), &[]);
    }

    #[test]
    fn a_shipped_scenario_with_values_exchanged_is_read_or_refused(
        which in 0..SHIPPED.len(),
        changes in prop::collection::vec((any::<prop::sample::Index>(), nasty()), 1..3),
    ) {
        let mut document: Value = serde_json::from_str(SHIPPED[which].text).unwrap();
        for (index, value) in changes {
            let mut k = index.index(count(&document));
            replace(&mut document, &mut k, &value);
        }
        read(&document.to_string(), &[]);
    }

    #[test]
    fn any_setting_is_taken_or_refused(key in "[a-z_.0-9]{0,12}", value in nasty()) {
        for key in [key.as_str(), "profile", "sources.0.rows", "events.0.region", "seed"] {
            if let Ok(setting) = format!("{key}={value}").parse::<Setting>() {
                read(SHIPPED[2].text, &[setting]);
            }
        }
    }
}
