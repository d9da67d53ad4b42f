//! What every run observes beside its measurements: the highest density, the longest queues, the times to leave.

use sandbox::engine::simulation::Fault;
use sandbox::runs::checkpoint::Checkpoint;
use sandbox::runs::drive::{Observer, Run};
use sandbox::runs::summary::Summary;
use sandbox::scenario::measurements::Measurement;
use serde_json::{Value, json};

use crate::common::simulated::{measured, scenario};
use crate::common::whole::documents;

fn drive(run: &mut Run) {
    let observers: &mut [Box<dyn Observer<Fault>>] = &mut [];
    run.drive(observers, || false).unwrap();
}

/// 30 people in a room of 8 m × 6 m that walk to an exit of 1 m in its right wall.
fn room() -> Value {
    json!({
        "duration_secs": 60, "profile": "steer+sph", "stop": {"when_empty": true},
        "walkable_area": [[[[0, 0], [8, 0], [8, 6], [0, 6]]]],
        "exits": [{"name": "door", "line": [[8, 2.5], [8, 3.5]]}],
        "journeys": [{"name": "out", "stages": ["door"]}],
        "crowds": [{"area": [[1, 1], [6, 1], [6, 5], [1, 5]], "number": 30, "journey": "out"}],
    })
}

#[test]
fn the_highest_density_is_that_of_all_coarse_frames() {
    let mut run = Run::new(scenario(&room(), &[]).unwrap()).unwrap();
    let mut most = (0.0, 0.0);
    while run.end.is_none() {
        run.simulation.evaluate().unwrap();
        let frame = run.simulation.frame();
        if frame.clock.is_coarse() {
            for i in frame.agents.present() {
                if frame.fields.density[i] > most.0 {
                    most = (frame.fields.density[i], frame.clock.time());
                }
            }
        }
        run.measure();
        run.simulation.integrate().unwrap();
    }
    let highest = run.metrics.highest_density().unwrap();
    assert_eq!((highest.density_per_m2, highest.at_secs), most);
}

#[test]
fn a_profile_without_densities_has_no_highest_one_and_computes_none_for_it() {
    let mut document = room();
    document["profile"] = json!("sf");
    let run = Run::new(scenario(&document, &[]).unwrap()).unwrap();
    assert!(!run.simulation.needs().density);
    document["duration_secs"] = json!(5);
    assert_eq!(measured(document).highest_density, None);
}

#[test]
fn people_before_a_closed_door_are_its_queue() {
    let mut document = room();
    document["exits"][0]["closed_secs"] = json!([[0, 60]]);
    document["duration_secs"] = json!(30);
    document["profile"] = json!("sph");
    document["crowds"][0]["number"] = json!(20);
    let summary = measured(document);
    assert_eq!(summary.longest_queues.len(), 1, "{summary:?}");
    let queue = &summary.longest_queues[0];
    assert_eq!((queue.before.as_str(), queue.agents), ("door", 20));
    assert!(queue.at_secs <= 30.0);
}

#[test]
fn people_who_walk_freely_are_no_queue() {
    let mut document = room();
    document["crowds"] = json!([]);
    document["agents"] = json!([
        {"position": [1, 3], "journey": "out"}, {"position": [5, 3], "journey": "out"}
    ]);
    let summary = measured(document);
    assert_eq!(summary.arrived, 2);
    assert_eq!(summary.longest_queues, []);
}

#[test]
fn the_times_to_leave_are_those_of_the_agents_that_entered() {
    let mut run = Run::new(scenario(&room(), &[]).unwrap()).unwrap();
    drive(&mut run);
    let times: Vec<f64> = run
        .simulation
        .outcome()
        .arrivals
        .iter()
        .map(|one| one.time)
        .collect();
    assert_eq!(times.len(), 30);
    let summary = Summary::of(&run);
    let of = [summary.t50_secs, summary.t95_secs, summary.t100_secs];
    // Of 30 people, the 15th, the 29th (28.5) and the last.
    assert_eq!(of, [14, 28, 29].map(|k| Some(times[k])));
    let mut document = room();
    document["duration_secs"] = json!(0.5 * (times[14] + times[15]));
    let cut = measured(document);
    assert_eq!((cut.t50_secs, cut.t95_secs), (Some(times[14]), None));
}

#[test]
fn a_resumed_run_has_the_overview_of_an_uninterrupted_one() {
    let whole = scenario(&room(), &[]).unwrap();
    let mut run = Run::new(whole.clone()).unwrap();
    while run.simulation.frame().clock.time() < 4.0 {
        run.simulation.evaluate().unwrap();
        run.measure();
        run.simulation.integrate().unwrap();
    }
    run.simulation.evaluate().unwrap();
    run.measure();
    let checkpoint = Checkpoint::of(&whole, &run.simulation, &run.metrics);
    let mut resumed = checkpoint.resume(whole).unwrap();
    drive(&mut run);
    drive(&mut resumed);
    let summary = Summary::of(&run);
    assert!(summary.highest_density.is_some() && !summary.longest_queues.is_empty());
    assert_eq!(summary, Summary::of(&resumed));
}

#[test]
fn wished_waits_are_no_delay() {
    let document = |waits: f64| {
        json!({
            "duration_secs": 120, "profile": "sph", "stop": {"when_empty": true},
            "walkable_area": [[[[0, 0], [20, 0], [20, 4], [0, 4]]]],
            "exits": [{"name": "end", "line": [[20, 1], [20, 3]]}],
            "waiting_areas": [{"name": "seats", "area": [[8, 1], [12, 1], [12, 3], [8, 3]], "for_secs": waits}],
            "journeys": [{"name": "on", "stages": ["seats", "end"]}],
            "agents": [{"position": [1, 2], "journey": "on"}],
            "measurements": [{"egress": {}}],
        })
    };
    let [short, long] = [5.0, 25.0].map(|waits| measured(document(waits)));
    let value = |summary: &Summary, name: &str| summary.metric(name).unwrap();
    for (summary, waits) in [(&short, 5.0), (&long, 25.0)] {
        // Waits end in coarse frames.
        assert!(
            (value(summary, "wished_secs") - waits).abs() < 0.2,
            "{summary:?}"
        );
        assert_eq!(value(summary, "wished_secs"), value(summary, "waited_secs"));
    }
    let delays = [&short, &long].map(|summary| value(summary, "delay_secs"));
    assert!((delays[0] - delays[1]).abs() < 0.3, "{delays:?}");
}

#[test]
fn every_value_has_a_definition_and_the_page_has_all_of_them() {
    let page = include_str!("../docs/reference/measurements.md");
    let all = Measurement::all_quantities();
    // Snapshots and run times have data, no values.
    let kinds: Vec<&str> = all.iter().map(|(name, _)| name.as_str()).collect();
    let schema = sandbox::scenario::schema();
    let routes = schema["$defs"]["Measurement"]["oneOf"].as_array().unwrap();
    for way in routes {
        let kind = way["required"][0].as_str().unwrap();
        assert!(
            kinds.contains(&kind) || ["snapshot", "frame_time"].contains(&kind),
            "{kind}"
        );
    }
    for (kind, quantities) in &all {
        for one in quantities {
            assert!(one.meaning.len() > 12, "{one:?}");
            let row = format!(
                "| `{kind}` | `{}` | {} | {} |",
                one.name, one.unit, one.meaning
            );
            assert!(
                page.contains(&row),
                "docs/reference/measurements.md lacks {row}"
            );
        }
    }
}

/// The document with lines whose flow has no region: they have fewer values.
fn without_regions_before_lines(document: &Value) -> Value {
    let mut document = document.clone();
    let measurements = document["measurements"].as_array_mut();
    for flow in measurements.into_iter().flatten() {
        let keys = flow.get_mut("line_flow").and_then(Value::as_object_mut);
        keys.map(|keys| keys.remove("region"));
    }
    document
}

#[test]
fn every_measurement_has_as_many_values_as_quantities() {
    let whole = documents();
    let plain = whole.each_ref().map(without_regions_before_lines);
    for document in whole.into_iter().chain(plain) {
        // `results` panics at a value too few or too many.
        let mut run = Run::new(scenario(&document, &[]).unwrap()).unwrap();
        run.simulation.evaluate().unwrap();
        run.measure();
        let quantities = run
            .scenario
            .measurements
            .iter()
            .flat_map(Measurement::quantities);
        let names: Vec<String> = quantities.map(|quantity| quantity.name).collect();
        let results = run.metrics.results(&run.simulation).into_iter();
        assert_eq!(results.map(|metric| metric.name).collect::<Vec<_>>(), names);
    }
}
