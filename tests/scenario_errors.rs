//! Broken scenarios and their exact error messages.

use std::collections::BTreeMap;

use sandbox::scenario::quote::{printable, shown};
use sandbox::scenario::{Problem, Scenario, Setting, SettingError};
use serde::Deserialize;
use serde_json::{Value, json};

/// A small scenario with one object of each kind; the tests break it.
const WHOLE: &str = r#"{
  "seed": 1, "goal": [9, 5], "profile": "sph",
  "obstacles": [[[0, 0], [1, 0], [1, 1]]],
  "agents": [{"position": [2, 2]}],
  "grids": [{"min": [3, 3], "max": [5, 5], "columns": 2, "rows": 2}],
  "sources": [{"min": [0, 5], "max": [0, 9], "columns": 1, "rows": 4, "every_secs": 1}],
  "events": [{"at_secs": 1, "for_secs": 1, "region": [[0, 0], [5, 5]]}],
  "measurements": [{"density": {"at_secs": 5}}, {"evacuated": {}}],
  "view": {"region": [[0, 0], [9, 9]]}
}"#;

/// `WHOLE` with the value at a JSON pointer replaced or inserted.
fn with(pointer: &str, value: Value) -> String {
    let mut document: Value = serde_json::from_str(WHOLE).unwrap();
    let (parent, key) = pointer.rsplit_once('/').unwrap();
    match document.pointer_mut(parent).unwrap() {
        Value::Object(object) => object.insert(key.to_owned(), value),
        Value::Array(list) => Some(std::mem::replace(
            &mut list[key.parse::<usize>().unwrap()],
            value,
        )),
        _ => panic!("nothing can be put into {parent}"),
    };
    document.to_string()
}

fn message(text: &str, settings: &[&str]) -> String {
    let settings: Result<Vec<Setting>, _> = settings.iter().map(|s| s.parse()).collect();
    match settings.map(|settings| Scenario::parse(text, "f.json", &settings)) {
        Ok(Ok(_)) => "no error".to_owned(),
        Ok(Err(error)) => error.to_string(),
        Err(error) => error.to_string(),
    }
}

/// A value, its place in `WHOLE`, and the expected message.
#[derive(Deserialize)]
struct Broken {
    at: String,
    put: Value,
    message: String,
}

#[test]
fn every_broken_value_is_reported_with_its_place_and_reason() {
    assert_eq!(message(WHOLE, &[]), "no error");
    let cases: BTreeMap<String, Vec<Broken>> =
        serde_json::from_str(include_str!("data/broken_scenarios.json")).unwrap();
    assert!(cases.values().map(Vec::len).sum::<usize>() >= 60);
    let wrong = cases.into_values().flatten().filter_map(|broken| {
        let Broken { at, put, .. } = &broken;
        let said = message(&with(at, put.clone()), &[]);
        let expected = format!("f.json: {}", broken.message);
        (said != expected).then(|| format!("{put} at {at}:\n{said}\nexpected:\n{expected}"))
    });
    let wrong: Vec<String> = wrong.collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
}

/// Broken texts and the expected messages.
const BROKEN_TEXTS: &[[&str; 2]] = &[
    [
        "",
        "f.json: line 1, column 0: the file is empty: a scenario is an object, {…}",
    ],
    [
        "{\"seed\": 1,}",
        "f.json: line 1, column 12: a comma before a closing bracket; remove it",
    ],
    [
        "{\n  \"duration_secs\": 1e999\n}",
        "f.json: line 2, column 24: number out of range: the largest is 1.7e308",
    ],
    [
        "{\"seed\": NaN}",
        "f.json: line 1, column 10: `NaN` is no number of JSON: leave the key out for its default",
    ],
    [
        "{\"seed\": 1, \"seed\": 2}",
        "f.json: line 1, column 18: key `seed` is given twice; remove one",
    ],
    ["[]", "f.json: invalid type: a list, expected an object"],
    ["null", "f.json: invalid type: null, expected an object"],
    [
        "{} {}",
        "f.json: line 1, column 4: more text after the end of the scenario; remove it",
    ],
];

#[test]
fn broken_texts_are_reported_with_line_and_column() {
    for [text, expected] in BROKEN_TEXTS {
        assert_eq!(message(text, &[]), *expected, "{text}");
    }
}

/// Broken settings and the expected messages.
const BROKEN_SETTINGS: &[[&str; 2]] = &[
    [
        "viscosity=-1",
        "--set viscosity=-1: must be at least 0 and at most 1e9, not -1",
    ],
    [
        "viscosity=much",
        r#"--set viscosity=much: invalid type: text "much", expected a number"#,
    ],
    [
        "viscosity=1e999",
        r#"--set viscosity=1e999: invalid type: text "1e999", expected a number"#,
    ],
    [
        "viscocity=1",
        "unknown setting `viscocity`; did you mean `viscosity`? (`sandbox list --settings` shows them all)",
    ],
    ["viscosity", "a setting has the form key=value"],
    [
        "=5",
        "unknown setting `` (`sandbox list --settings` shows them all)",
    ],
    [
        "seed=x",
        r#"--set seed=x: invalid type: text "x", expected a whole number from 0 to 2^64 - 1"#,
    ],
    [
        "profile=fs",
        "--set profile=fs: unknown profile `fs`; did you mean `sf`? (known profiles: sf, rvo, sf+sph, rvo+sph, sph, \
         sf->sph, rvo->sph, walk+sph, steer+sph, legs, legs+sph)",
    ],
    [
        "profile={\"base\": \"sf\", \"parameters\": {\"candidates\": 0}}",
        "--set profile={\"base\": \"sf\", \"parameters\": {\"candidates\": 0}}: parameters.candidates: must be at \
         least 1 and at most 1e6, not 0",
    ],
    [
        "rest_density_min=6",
        "f.json with --set rest_density_min=6: profile: rest_density_min 6 is above rest_density_max 5; set both",
    ],
    [
        "sources.0.rows=0",
        "--set sources.0.rows=0: must be at least 1 and at most 2^32 - 1, not 0",
    ],
    [
        "sources.1.rows=0",
        "--set sources.1.rows=0: sources has no element `1`: there are 1, counted from 0",
    ],
    [
        "sources.0.rwos=5",
        "--set sources.0.rwos=5: unknown key `rwos`; did you mean `rows`?",
    ],
    [
        "profile.base=sf",
        "--set profile.base=sf: profile is neither an object nor a list",
    ],
    [
        "goal=[1]",
        "--set goal=[1]: must be a point [x, y] in meters",
    ],
    ["name=", "--set name=: must not be empty"],
];

#[test]
fn an_invalid_setting_is_named() {
    for [setting, expected] in BROKEN_SETTINGS {
        assert_eq!(message(WHOLE, &[setting]), *expected, "{setting}");
    }
}

#[test]
fn a_mistake_in_the_file_is_not_blamed_on_the_settings() {
    assert_eq!(
        message(&with("/max_speed", 0.into()), &["seed=7", "viscosity=5"]),
        "f.json: max_speed: must be above 0 and at most 100, not 0"
    );
}

#[test]
fn a_missing_file_is_named() {
    let error = Scenario::load("no/such.json".as_ref(), &[]).unwrap_err();
    assert!(error.to_string().starts_with("no/such.json: No such file"));
    let error = Scenario::shipped("concerto", &[]).unwrap_err();
    assert_eq!(
        error.to_string(),
        "unknown scenario `concerto`; the built-in scenarios are evacuation, crossing, concert, plaza"
    );
}

#[test]
fn what_is_repeated_is_short_and_harmless() {
    let long = "k".repeat(100_000);
    let cut = format!("{}… (100000 characters)", "k".repeat(80));
    for (document, expected) in [
        (
            json!({ &long: 1 }),
            format!("{cut}: unknown key `{cut}`, expected one of `name`, "),
        ),
        (
            json!({ "stop": { "a`, expected `\u{1b}": 1 } }),
            "stop.a`, expected `\\u{1b}: unknown key `a`, expected `\\u{1b}`, expected ".to_owned(),
        ),
        (
            json!({ "max_speed": long }),
            format!("max_speed: invalid type: text \"{cut}\", expected a number"),
        ),
    ] {
        let said = message(&document.to_string(), &[]);
        let expected = format!("f.json: {expected}");
        assert!(said.starts_with(&expected), "{said}");
    }
    let problem = Problem {
        path: format!("a.\u{7}{long}"),
        reason: "no".to_owned(),
    };
    let said = problem.to_string();
    assert!(said.len() < 200 && said.starts_with("a.\\u{7}kkk"));
}

#[test]
fn slips_of_the_finger_are_recognized() {
    for (given, meant) in [
        ("duration", "; did you mean `duration_secs`?"),
        ("viscosty", "; did you mean `viscosity`?"),
        ("zebra", ""),
        (&"k".repeat(90), ""),
    ] {
        let error = format!("{given}=1").parse::<Setting>().unwrap_err();
        let SettingError::UnknownKey { suggestion, .. } = error else {
            panic!("{error}");
        };
        assert_eq!(suggestion, meant, "{given}");
    }
}

#[test]
fn text_is_repeated_as_it_is_unless_it_is_long_or_a_terminal_obeys_it() {
    for text in ["", "sf->sph", "Zürich 群", "\"a\" `b`"] {
        assert_eq!(shown(text), text);
    }
    assert_eq!(shown("\u{1b}[31m\n\u{9b}"), "\\u{1b}[31m\\n\\u{9b}");
    assert_eq!(shown("a\u{202e}b"), "a\\u{202e}b");
    let long = "ä".repeat(100_000);
    let expected = format!("{}… (100000 characters)", "ä".repeat(80));
    assert_eq!(shown(&long), expected);
    assert_eq!(shown(&"a".repeat(80)), "a".repeat(80));
}

#[test]
fn lines_of_a_printable_text_stay_lines() {
    assert_eq!(printable("a\n\u{7}b\r\n"), "a\n\\u{7}b\\r\n");
}

#[test]
fn a_value_of_the_file_that_a_setting_replaces_must_be_valid_too() {
    for (pointer, value, setting, place) in [
        (
            "/duration_secs",
            json!("%s"),
            "duration_secs=9",
            "duration_secs",
        ),
        (
            "/duration_secs",
            json!(-1),
            "duration_secs=9",
            "duration_secs",
        ),
        ("/seed", json!([1]), "seed=2", "seed"),
        ("/profile", json!(5), "profile=sf", "profile"),
        (
            "/integrator",
            json!("nothing"),
            "integrator=midpoint",
            "integrator",
        ),
        (
            "/grids/0/rows",
            json!("many"),
            "grids.0.rows=2",
            "grids[0].rows",
        ),
        (
            "/parameters",
            json!({"viscosity": "thick"}),
            "viscosity=2",
            "parameters.viscosity",
        ),
    ] {
        let text = with(pointer, value);
        let alone = message(&text, &[]);
        assert!(alone.starts_with(&format!("f.json: {place}: ")), "{alone}");
        assert_eq!(message(&text, &[setting]), alone, "{setting}");
        assert_eq!(message(&text, &["seed=7", setting]), alone, "{setting}");
    }
    // What a setting adds, and what no setting replaces.
    for (pointer, value, setting) in [
        ("/duration_secs", Value::Null, "duration_secs=9"),
        (
            "/walkable_area",
            json!("no such file"),
            "walkable_area=[[[[0,0],[20,0],[20,20],[0,20]]]]",
        ),
        ("/sources/0/times", json!(2), "sources.0.times=3"),
    ] {
        assert_eq!(
            message(&with(pointer, value), &[setting]),
            "no error",
            "{setting}"
        );
    }
    let text = with(
        "/sources",
        json!([{"min": [0, 5], "max": [0, 9], "columns": 1, "rows": 4}]),
    );
    assert!(message(&text, &[]).contains("missing key `every_secs`"));
}
