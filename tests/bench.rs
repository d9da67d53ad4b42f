//! The benchmarks: what they report, and that computing more than needed changes only the run time.
//!
//! No test here checks how long something takes.

use std::path::Path;

use crate::common;
use crate::common::program;
use crate::common::reports::{assert_is_complete, quick, rows};
use crate::common::{blend, block, room, scene, vector};
use sandbox::engine::simulation::{Simulation, Stage};
use sandbox::lab::bench::{BENCHMARKS, Crowd, Plan, Report, SKIPS, everything};
use sandbox::lab::machine::{Machine, Resident, main_memory};
use sandbox::scenario::catalog::NAMES;
use serde_json::Value;

fn measure(name: &str, plan: &Plan) -> Report {
    let benchmark = BENCHMARKS.iter().find(|benchmark| benchmark.name == name);
    benchmark.unwrap().measure(plan, &|_| ()).unwrap()
}

#[test]
fn every_report_has_the_machine_and_the_spread_of_every_time() {
    for (name, keys, times) in [
        (
            "scaling",
            &[
                "agents",
                "frames",
                "ratio_to_10000",
                "resident_bytes_per_agent",
            ][..],
            &["ns_per_agent_frame", "ms_per_frame"][..],
        ),
        (
            "stages",
            &["crowd", "profile", "agents", "stages_ms"],
            &["ms_per_frame", "measurements_ms"],
        ),
        (
            "threads",
            &["agents", "threads", "efficiency"],
            &["ms_per_frame", "speed_up"],
        ),
        (
            "skips",
            &["scenario", "profile", "skip", "nothing_to_skip"],
            &["with_skip_ms"],
        ),
    ] {
        assert_is_complete(&measure(name, &quick()), name, keys, times);
    }
}

#[test]
fn ratios_have_the_stated_baseline() {
    let scaling = rows(&measure("scaling", &quick()));
    let agents: Vec<_> = scaling
        .iter()
        .map(|row| row["agents"].as_u64().unwrap())
        .collect();
    // The crowd at rest, and five crowds that walk.
    assert_eq!(agents[..3], [1_000, 3_000, 10_000]);
    assert_eq!(agents[3..], [10_000; 5]);
    let median = |row: &Value| row["ns_per_agent_frame"]["median"].as_f64().unwrap();
    for (k, row) in scaling.iter().enumerate() {
        let per_frame = row["ms_per_frame"]["median"].as_f64().unwrap();
        let per_agent = 1e6 * per_frame / row["agents"].as_f64().unwrap();
        assert!((per_agent / median(row) - 1.0).abs() < 1e-12);
        let ratio = median(row) / median(&scaling[k.max(2)]);
        assert_eq!(row["ratio_to_10000"].as_f64().unwrap(), ratio);
        if k >= 2 {
            let ratio = median(row) / median(&scaling[2]);
            assert_eq!(row["ratio_to_rest"].as_f64().unwrap(), ratio);
        }
        let step = if row["crowd"].as_str().unwrap().contains("fast") {
            50.0
        } else {
            20.0
        };
        let factor = row["real_time_factor"].as_f64().unwrap();
        assert!((factor * per_frame / step - 1.0).abs() < 1e-12);
        let share = row["sorts_and_lists"].as_f64().unwrap();
        assert!((0.0..1.0).contains(&share));
    }
    let threads = rows(&measure("threads", &quick()));
    assert_eq!(threads[0]["threads"], 1);
    let counts: Vec<u64> = threads
        .iter()
        .map(|row| row["threads"].as_u64().unwrap())
        .collect();
    let [doubled @ .., all] = counts.as_slice() else {
        panic!("no rows");
    };
    assert_eq!(*all, Machine::here().hardware_threads as u64);
    let powers = (0..).map(|k| 1_u64 << k).take_while(|count| count < all);
    assert!(powers.eq(doubled.iter().copied()), "{counts:?}");
    assert_eq!(threads[0]["speed_up"]["maximum"], 1.0);
    for row in threads {
        let threads = row["threads"].as_f64().unwrap();
        let speed_up = row["speed_up"]["median"].as_f64().unwrap();
        assert_eq!(row["efficiency"].as_f64().unwrap(), speed_up / threads);
    }
}

#[test]
fn without_a_measured_baseline_there_is_no_ratio() {
    let plan = Plan {
        largest: 3_000,
        ..quick()
    };
    let rows = rows(&measure("scaling", &plan));
    assert_eq!(rows.len(), 2);
    assert_eq!(rows[1]["ratio_to_rest"], 1.0);
    assert!(rows.iter().all(|row| row["ratio_to_10000"].is_null()));
}

#[test]
fn a_skip_is_measured_only_where_there_is_something_to_skip() {
    let rows = rows(&measure("skips", &quick()));
    assert_eq!(rows.len() % SKIPS.len(), 0);
    let mut measured: Vec<(String, String, String)> = Vec::new();
    for row in &rows {
        let known = row["nothing_to_skip"].is_null();
        assert_eq!(known, !row["ratio"].is_null(), "{row}");
        assert_eq!(known, !row["without_skip_ms"].is_null(), "{row}");
        if known {
            let text = |key: &str| row[key].as_str().unwrap().to_owned();
            measured.push((text("scenario"), text("profile"), text("skip")));
        }
    }
    let has = |scenario: &str, profile: &str, skip: &str| {
        let wanted = [scenario, profile, skip].map(str::to_owned);
        measured.contains(&wanted.into())
    };
    assert!(has("evacuation", "sf", "density") && !has("evacuation", "sph", "density"));
    assert!(has("concert", "sph", "far walls") && !has("evacuation", "sf", "far walls"));
    assert!(has("concert", "sph", "arrivals") && !has("crossing", "rvo->sph", "arrivals"));
    assert!(has("crossing", "rvo->sph", "RVO by blend") && !has("crossing", "sf", "RVO by blend"));
    for skip in &SKIPS {
        assert!(
            measured.iter().any(|(.., name)| name == skip.name),
            "{}",
            skip.name
        );
    }
}

#[test]
fn computing_everything_does_not_change_the_motion() {
    for name in NAMES {
        let mut scene = scene(vec![room(8.0, 1.0)], blend(name));
        scene.agents = block(vector(1.0, 1.0), 12, 12, 0.45, vector(9.0, 4.0));
        let mut needed = Simulation::new(scene.clone()).unwrap();
        let mut paying = Simulation::new(scene).unwrap();
        let needs = *needed.needs();
        needed.pay_for(&needs);
        paying.pay_for(&everything());
        assert_ne!(
            paying.needs(),
            needed.needs(),
            "{name}: something to pay for"
        );
        for frame in 0..100 {
            needed.step().unwrap();
            paying.step().unwrap();
            assert_eq!(motion(&needed), motion(&paying), "{name}, frame {frame}");
        }
        let skipped = |simulation: &Simulation| -> Vec<Stage> {
            let spent: Vec<Stage> = simulation
                .stages()
                .ms_per_frame()
                .map(|(stage, _)| stage)
                .collect();
            Stage::ALL
                .into_iter()
                .filter(|stage| !spent.contains(stage))
                .collect()
        };
        // The scene has no sources, pushes, journeys, path maps and models of one's own.
        assert_eq!(
            skipped(&paying),
            [
                Stage::Schedule,
                Stage::Journeys,
                Stage::Routes,
                Stage::OwnModel
            ],
            "{name}: everything was computed"
        );
        assert!(skipped(&needed).len() > 1, "{name}");
    }
}

/// The ids of all agents, with the bits of their positions and velocities.
fn motion(simulation: &Simulation) -> Vec<(u32, [u64; 4])> {
    let numbers = |(id, bits): (u32, [u64; 5])| (id, [bits[0], bits[1], bits[2], bits[3]]);
    common::bits(simulation).into_iter().map(numbers).collect()
}

#[test]
fn results_are_replaced_only_with_force() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("results");
    let out = out.to_str().unwrap();
    let run = |more: &[&str]| {
        let arguments = ["bench", "threads", "--quick", "--json", "--out", out];
        program::run(&[&arguments[..], more].concat())
    };
    let first = run(&[]);
    assert_eq!(first.status.code(), Some(0));
    let printed = program::json(&first);
    let file = Path::new(out).join("threads.json");
    let read = || serde_json::from_slice::<Value>(&std::fs::read(&file).unwrap()).unwrap();
    assert_eq!(read(), printed);
    for extension in ["md", "csv", "svg", "png"] {
        let picture = file.with_extension(extension);
        assert!(picture.exists(), "{extension}");
    }
    let second = run(&[]);
    assert_eq!(second.status.code(), Some(2));
    let said = program::stderr(&second);
    assert!(
        said.contains("threads.json") && said.contains("--force"),
        "{said}"
    );
    assert_eq!(read(), printed);
    assert_eq!(run(&["--force", "--repeats", "4"]).status.code(), Some(0));
    assert_eq!(read()["repeats"], 4);
}

#[test]
fn a_crowd_is_as_large_and_as_dense_as_was_asked_for() {
    for agents in [1, 2, 1000, 3000] {
        let scene = Crowd::concert(agents).scene().unwrap();
        assert_eq!(scene.agents.len(), agents as usize);
    }
    let mut simulation = Crowd::concert(3000).settled(0).unwrap();
    simulation.evaluate().unwrap();
    let mut densities = simulation.frame().fields.density.clone();
    densities.sort_by(f64::total_cmp);
    let median = densities[1500];
    assert!((median - 5.0).abs() < 0.25, "{median} P/m²");
}

#[test]
fn streams_go_both_routes() {
    let scene = Crowd::streams(100, "sf").scene().unwrap();
    let to_the_right = scene.agents.iter().filter(|a| a.goal.x > a.position.x);
    assert_eq!(to_the_right.count(), 50);
    let scene = Crowd::walkers(100, 2.0, "sph").scene().unwrap();
    assert!(scene.agents.iter().all(|a| a.goal.x > a.position.x));
}

#[test]
fn memory_is_read_in_bytes_or_not_at_all() {
    let status = "Name:\tsandbox\nVmHWM:\t    2048 kB\nVmRSS:\t    1024 kB\n";
    let memory = Resident::parse(status).unwrap();
    assert_eq!((memory.now, memory.peak), (1 << 20, 1 << 21));
    assert_eq!(Resident::parse("VmRSS:\t 1024 kB\n"), None);
}

#[test]
fn a_process_may_use_no_more_memory_than_the_machine_has() {
    let bytes = main_memory().unwrap();
    assert!(bytes > 1 << 26 && bytes <= Machine::here().memory_bytes);
}
