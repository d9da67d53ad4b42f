//! Changes values in JSON documents.

use proptest::prelude::*;
use serde_json::{Value, json};

/// Values that are invalid in many places.
pub fn invalid_value() -> impl Strategy<Value = Value> {
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

/// The number of values in `document`, including `document` itself.
pub fn count(document: &Value) -> usize {
    let inside = match document {
        Value::Array(list) => list.iter().map(count).sum(),
        Value::Object(object) => object.values().map(count).sum(),
        _ => 0,
    };
    1 + inside
}

/// Replaces value number `k`, counted from 0 in depth-first order.
pub fn replace(document: &mut Value, k: &mut usize, by: &Value) {
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
