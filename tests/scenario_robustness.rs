//! Whatever a file says, reading it ends in a scenario or in an error.

use proptest::prelude::*;
use sandbox::scenario::{SHIPPED, Scenario, Setting};
use sandbox::simulation::Simulation;
use serde_json::{Value, json};

/// Values that break something somewhere.
fn nasty() -> impl Strategy<Value = Value> {
    prop_oneof![
        Just(Value::Null),
        any::<bool>().prop_map(Value::from),
        any::<i64>().prop_map(Value::from),
        any::<f64>().prop_map(Value::from),
        (-3..30i64).prop_map(Value::from),
        "[a-z>-]{0,6}".prop_map(Value::from),
        prop::sample::select(vec![
            json!({}),
            json!([]),
            json!([[]]),
            json!([0, 0]),
            json!(1e308),
            json!(5e-324),
            json!(u64::MAX),
            json!(u32::MAX),
            json!("sf->sph"),
            json!({"base": "rvo"}),
            json!({"blend": [{"at_density": 1e308, "profile": {"navigation": "goal"}}]}),
        ]),
    ]
}

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

/// Every value in `document`, the whole one first.
fn count(document: &Value) -> usize {
    let inside = match document {
        Value::Array(list) => list.iter().map(count).sum(),
        Value::Object(object) => object.values().map(count).sum(),
        _ => 0,
    };
    1 + inside
}

/// Replaces value number `k` in the order of [`count`].
fn replace(document: &mut Value, k: &mut usize, by: &Value) {
    if *k == 0 {
        *document = by.clone();
    }
    *k = k.wrapping_sub(1);
    match document {
        Value::Array(list) => list.iter_mut().for_each(|value| replace(value, k, by)),
        Value::Object(object) => object.values_mut().for_each(|value| replace(value, k, by)),
        _ => {}
    }
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
