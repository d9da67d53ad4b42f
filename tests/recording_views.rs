//! What a recording shows: followed agents, the first moment, colors, events, measurements, single moments.

use std::collections::BTreeSet;
use std::fs;

use sandbox::engine::breakdown::Breakdown;
use sandbox::engine::math::Vector;
use sandbox::engine::scene::Region;
use sandbox::engine::simulation::Simulation;
use sandbox::output::colors::ColorMap;
use sandbox::output::recording::{DebugAgents, RecordingOptions, record_moment};

use crate::common::program::{run_json, text};
use crate::common::recorded::{acceleration, options, record, recorded, scene};
use crate::common::recording::Recording;

const CROWD: &str = "/world/agents";

/// The values of a time series.
fn series(recording: &Recording, entity: &str) -> Vec<f64> {
    let rows = recording.numbers(entity, "Scalars:scalars").into_iter();
    rows.flat_map(|(_, values)| values).collect()
}

#[test]
fn a_followed_agent_is_in_the_middle_of_its_view_with_the_names_of_its_forces() {
    let (recording, truth) = record("sph", DebugAgents::Ids(vec![7, 24, 9999]), true, 30);
    for id in [7, 24] {
        let entity = format!("/focus/{id}");
        let places = recording.coordinates(&entity, "Transform3D:translation");
        assert_eq!(places.len(), 30);
        for ((_, place), agents) in places.iter().zip(&truth) {
            let position = agents[&id].0;
            // A view has y down.
            let place = Vector::new(place[0], -place[1]);
            assert!((place - position).norm() < 1e-5);
        }
    }
    assert!(
        recording
            .coordinates("/focus/9999", "Transform3D:translation")
            .is_empty()
    );
    let forces = "/focus/24/here/forces";
    let names = recording.static_texts(forces, "SeriesLines:names");
    assert_eq!(names[0], "total");
    assert!(names.contains(&"pressure agents".to_owned()), "{names:?}");
    let values = recording.numbers(forces, "Scalars:scalars");
    let arrows = recording.pairs(forces, "Arrows2D:vectors");
    let labels = recording.texts(forces, "Points2D:labels");
    assert_eq!((values.len(), arrows.len(), labels.len()), (30, 30, 30));
    for ((values, arrows), labels) in values.iter().zip(&arrows).zip(&labels) {
        assert_eq!(values.1.len(), names.len(), "a line for each term");
        let known: Vec<f64> = values
            .1
            .iter()
            .copied()
            .filter(|&value| value > 0.0)
            .collect();
        let drawn: Vec<Vector> = arrows
            .1
            .iter()
            .map(|&arrow| acceleration(arrow.into()))
            .collect();
        assert_eq!(known.len(), drawn.len());
        for (value, arrow) in known.iter().zip(&drawn) {
            assert!((value - arrow.norm()).abs() < 1e-4 * (1.0 + value));
        }
        let sum: Vector = drawn[1..].iter().sum();
        assert!((sum - drawn[0]).norm() < 1e-3 * (1.0 + sum.norm()));
        assert!(labels.1.len() <= drawn.len() && labels.1.iter().all(|name| names.contains(name)));
    }
}

#[test]
fn a_recording_opens_at_the_moment_of_the_highest_density_unless_a_time_is_given() {
    let asked = options(DebugAgents::Ids(vec![9999, 24, 3]));
    let found = RecordingOptions {
        opens_at: None,
        ..asked.clone()
    };
    let first = |recording: &Recording| {
        let lines = recording.texts("/log", "TextLog:text").into_iter();
        let mut lines = lines.filter(|(_, text)| text[0] == "Look here first.");
        lines.next().unwrap().0
    };
    let (recording, _) = recorded(&found, 60);
    let densities = series(&recording, "/stats/density/max");
    let highest = densities.iter().copied().fold(0.0, f64::max);
    let frame = first(&recording);
    assert_eq!(densities[frame as usize], highest);
    assert!(frame > 10, "the crowd gathers first: {frame}");
    let text = &recording.static_texts("/info/scenario", "TextDocument:text")[0];
    let time = (frame as f64 * 0.02 * 100.0).round() / 100.0;
    assert!(text.contains(&format!("t = {time} s")), "{text}");
    let late = RecordingOptions {
        opens_at: Some(100.0),
        ..asked.clone()
    };
    let (recording, _) = recorded(&late, 60);
    assert_eq!(first(&recording), frame, "the run ends before");
    let (recording, _) = recorded(&asked, 20);
    assert_eq!(first(&recording), 5, "0.1 s");
}

#[test]
fn of_many_debug_agents_the_densest_one_is_followed() {
    let everywhere = Region {
        min: Vector::repeat(-9.0),
        max: Vector::repeat(9.0),
    };
    for debug in [DebugAgents::All, DebugAgents::Region(everywhere)] {
        let found = RecordingOptions {
            opens_at: None,
            ..options(debug)
        };
        let (recording, _) = recorded(&found, 60);
        let densities = series(&recording, "/stats/density/max");
        let highest = densities.iter().copied().fold(0.0, f64::max);
        let frame = densities
            .iter()
            .position(|&density| density == highest)
            .unwrap();
        let own = recording.coordinates("/focus/densest", "Transform3D:translation");
        let own = &own[frame].1;
        let crowd = &recording.pairs(CROWD, "Points2D:positions")[frame].1;
        let is_it = |[x, y]: &[f64; 2]| (x - own[0]).abs() + (y + own[1]).abs() < 1e-5;
        let followed = crowd.iter().position(is_it).unwrap();
        let density = recording.numbers(CROWD, "agent:density")[frame].1[followed];
        assert!(density > 0.8 * highest, "{density} of {highest}");
    }
}

#[test]
fn colors_and_color_bars_follow_the_ranges_of_the_options() {
    let ranged = RecordingOptions {
        speed_range: [0.2, 0.4],
        density_range: [1.0, 3.0],
        ..options(DebugAgents::None)
    };
    let (recording, _) = recorded(&ranged, 30);
    for (values, colors, map) in [
        (
            "agent:speed",
            "agent:speed_colors",
            ColorMap::bright_inferno([0.2, 0.4]),
        ),
        (
            "agent:density",
            "Points2D:colors",
            ColorMap::viridis([1.0, 3.0]),
        ),
    ] {
        let [first, last] = map.range();
        let mut seen = [0, 0];
        let values = recording.numbers(CROWD, values).into_iter();
        let colors = recording.numbers(CROWD, colors).into_iter();
        for ((_, values), (_, colors)) in values.zip(colors) {
            assert_eq!(values.len(), colors.len());
            for (value, color) in values.into_iter().zip(colors) {
                let [r, g, b] = map.color(value as f32).map(f64::from);
                let expected = ((r * 256.0 + g) * 256.0 + b) * 256.0 + 255.0;
                // Values have three digits.
                let is_below = value < 0.99 * f64::from(first);
                if is_below || value > 1.01 * f64::from(last) {
                    seen[usize::from(is_below)] += 1;
                    assert_eq!(color, expected, "{value}");
                }
            }
        }
        assert!(seen[0] > 10, "{seen:?}");
    }
    let texts = |entity: &str| recording.static_texts(entity, "Points2D:labels");
    assert_eq!(
        texts("/world/legend/density"),
        ["1", "1.5", "2", "2.5", "3", "P/m²"]
    );
    let speeds = texts("/world/legend/speed");
    assert!(
        ["0.2", "0.3", "0.4", "m/s"]
            .iter()
            .all(|text| speeds.contains(&(*text).to_owned()))
    );
}

#[test]
fn the_log_counts_arrivals_by_tens_and_has_the_end_of_the_run() {
    let (recording, simulation) = recorded(&options(DebugAgents::None), 500);
    let arrived = simulation.outcome().arrivals.len();
    assert!(arrived >= 10, "{arrived}");
    let lines: Vec<(i64, String)> = recording
        .texts("/log", "TextLog:text")
        .into_iter()
        .map(|(frame, mut text)| (frame, text.remove(0)))
        .collect();
    let told = lines
        .iter()
        .filter(|(_, text)| text.ends_with("agents have arrived"));
    let told: Vec<_> = told.collect();
    assert_eq!(told.len(), arrived / 10);
    let evacuated = series(&recording, "/stats/crowd/evacuated");
    for (k, (frame, text)) in told.into_iter().enumerate() {
        let count = 10 * (k + 1);
        assert_eq!(*text, format!("{count} agents have arrived"));
        assert!(evacuated[*frame as usize] >= count as f64);
        assert!(evacuated[*frame as usize - 1] < count as f64);
    }
    assert!(lines.contains(&(499, "The end.".to_owned())), "{lines:?}");
}

#[test]
fn what_is_measured_is_outlined_with_its_name() {
    let line = vec![Vector::new(1.0, 0.0), Vector::new(1.0, 3.0)];
    let measured = RecordingOptions {
        measured: vec![("door".to_owned(), line)],
        ..options(DebugAgents::None)
    };
    let (recording, _) = recorded(&measured, 1);
    let names = recording.static_texts("/world/geometry/measured/names", "Points2D:labels");
    assert_eq!(names, ["measured: door"]);
    assert!(!recording.entities().contains("/world/geometry/sources"));
}

#[test]
fn the_recording_of_a_moment_has_a_table_for_each_agent() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("moment.rrd");
    let mut simulation = Simulation::new(scene("sph")).unwrap();
    simulation.request_density_until(u64::MAX);
    simulation.evaluate().unwrap();
    let options = options(DebugAgents::Ids(vec![24, 3]));
    record_moment(path.as_path(), &simulation, &options).unwrap();
    let recording = Recording::read(&path);
    for id in [24, 3] {
        let i = simulation.frame().agents.index_of(id).unwrap();
        let breakdown = Breakdown::of(&simulation, i).unwrap();
        let entity = format!("/info/agents/{id}");
        let table = &recording.static_texts(&entity, "TextDocument:text")[0];
        let density = format!("| density ρ, P/m² | {:.4} |", breakdown.density);
        let [x, y] = breakdown.acceleration;
        let total = format!("| **total (weighted)** | {x:.4} | {y:.4} |");
        let neighbors = format!("Neighbors within the kernel: {}", breakdown.neighbors.len());
        for words in [density, total, neighbors, "| pressure_agents |".to_owned()] {
            assert!(table.contains(&words), "{words}: {table}");
        }
    }
    let layout = Recording::layout(&path);
    for name in ["Agent 24", "Forces on agent 3", "Numbers"] {
        assert!(layout.contains(name), "{name}: {layout:?}");
    }
    assert!(!layout.contains("Mean speed"));
}

#[test]
fn recordings_of_a_run_and_of_its_moments_are_not_merged_by_a_viewer() {
    let folder = tempfile::tempdir().unwrap();
    let scenario = folder.path().join("two.json");
    let document = r#"{"goal": [9, 1], "duration_secs": 1, "agents": [{"position": [1, 1]}, {"position": [3, 1]}]}"#;
    fs::write(&scenario, document).unwrap();
    let id = |arguments: &[&str]| {
        let path = folder.path().join("a.rrd");
        let save = ["--save", text(&path), "--force", "--json"];
        run_json(&[&arguments[..1], &[text(&scenario)], &arguments[1..], &save].concat());
        Recording::read(&path).id()
    };
    let inspect = |agent: &str, at: &str| id(&["inspect", "--agent", agent, "--at", at]);
    let of_run = id(&["run"]);
    let all = [
        of_run.clone(),
        inspect("0", "0.5"),
        inspect("1", "0.5"),
        inspect("0", "0.6"),
    ];
    assert_eq!(all.iter().collect::<BTreeSet<_>>().len(), 4, "{all:?}");
    assert_eq!(id(&["run"]), of_run);
    assert_eq!(inspect("0", "0.5"), all[1]);
}
