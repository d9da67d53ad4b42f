//! Local density, exposure, alarms, levels of service, crowd pressure, delays.

use std::f64::consts::PI;

use crate::common::simulated::{after, measured, scenario, start};
use crate::common::vector;
use sandbox::analysis::evaluated::Evaluated;
use sandbox::analysis::exposure::Exposure;
use sandbox::analysis::local::{KERNEL, Local, People};
use sandbox::analysis::service::{QUEUE, WALKWAY, densities, level};
use sandbox::analysis::site::Site;
use sandbox::engine::kernel;
use sandbox::engine::math::Vector;
use sandbox::engine::simulation::{Fault, Simulation};
use sandbox::runs::checkpoint::Checkpoint;
use sandbox::runs::drive::{Observer, Run};
use sandbox::runs::summary::Summary;
use sandbox::scenario::floor_plan::parse_wkt;
use serde_json::{Value, json};

fn places(columns: i32, rows: i32, spacing: f64) -> impl Iterator<Item = Vector> {
    let all = (0..rows).flat_map(move |row| (0..columns).map(move |column| (column, row)));
    all.map(move |(column, row)| vector(f64::from(column) + 0.5, f64::from(row) + 0.5) * spacing)
}

fn at_rest(places: impl Iterator<Item = Vector>) -> People {
    People::new(
        (0..)
            .zip(places)
            .map(|(k, p)| (k, p, Some(Vector::zeros()))),
    )
}

/// The people of an evaluated frame with their surroundings and pressures, by id.
fn local(simulation: &Simulation) -> Vec<Local> {
    Evaluated::new(simulation).people(true).to_vec()
}

#[test]
fn a_lone_person_and_a_lattice_have_the_density_of_the_kernel() {
    let open = Site::new(Vec::new());
    let alone = at_rest(std::iter::once(vector(3.0, 4.0)));
    let [alone] = alone.local(&alone.at(&open), true)[..] else {
        panic!("one person");
    };
    assert!((alone.density - 4.0 / (5.0 * PI)).abs() < 1e-12);
    assert_eq!(alone.pressure, Some(0.0));
    for spacing in [0.4, 0.5, 0.8] {
        let people = at_rest(places(21, 21, spacing));
        let all = people.local(&people.at(&open), false);
        let center = all[all.len() / 2].density * spacing * spacing;
        assert!((center - 1.0).abs() < 0.01, "{spacing} m: {center}");
    }
}

#[test]
fn the_kernel_has_the_second_moment_of_a_gaussian_of_one_meter() {
    let (h, steps) = (KERNEL.support_radius, 20_000);
    let ring = |k: i32| {
        let r = (f64::from(k) + 0.5) * h / f64::from(steps);
        2.0 * PI * r * kernel::density(r * r, h) * r * r
    };
    let moment = (0..steps).map(ring).sum::<f64>() * h / f64::from(steps);
    assert!((moment - 1.0).abs() < 1e-6, "{moment} m²");
}

#[test]
fn a_uniform_crowd_is_as_dense_at_walls_as_elsewhere_and_a_wall_hides_the_next_room() {
    let plan =
        "MULTIPOLYGON (((0 0, 6 0, 6 6, 0 6, 0 0)), ((6.1 0, 12.1 0, 12.1 6, 6.1 6, 6.1 0)))";
    let site = Site::new(parse_wkt(plan).unwrap().solids().unwrap());
    let beyond = places(8, 8, 0.25).map(|p| p + vector(6.1, 2.0));
    let people = at_rest(places(12, 12, 0.5).chain(beyond));
    for person in &people.local(&people.at(&site), false)[..144] {
        let off = person.density / 4.0 - 1.0;
        assert!(off.abs() < 0.03, "{}: {off}", person.position);
    }
}

#[test]
fn pressure_is_density_times_the_weighted_variance_of_the_velocities() {
    let velocity = |k: usize| vector((k * 7 % 5) as f64 - 2.0, (k * 11 % 3) as f64) * 0.3;
    let positions: Vec<Vector> = places(9, 7, 0.45)
        .enumerate()
        .map(|(k, p)| p + vector((k * 13 % 7) as f64, (k * 5 % 11) as f64) * 0.02)
        .collect();
    let known = |k: usize| (k % 6 != 4).then(|| velocity(k));
    let people = positions.iter().enumerate();
    let people = People::new(people.map(|(k, &p)| (k as u32, p, known(k))));
    let found = people.local(&people.at(&Site::new(Vec::new())), true);
    for person in &found {
        let weights = positions
            .iter()
            .map(|p| kernel::density((p - person.position).norm_squared(), KERNEL.support_radius));
        let weights: Vec<f64> = weights.collect();
        let density: f64 = weights.iter().sum();
        let of: Vec<(f64, Vector)> = weights
            .into_iter()
            .enumerate()
            .filter_map(|(k, weight)| Some((weight, known(k)?)))
            .collect();
        let total: f64 = of.iter().map(|(weight, _)| weight).sum();
        let mean = of.iter().map(|(weight, v)| v * *weight).sum::<Vector>() / total;
        let squares = of
            .iter()
            .map(|(weight, v)| weight * (v - mean).norm_squared());
        let pressure = density * squares.sum::<f64>() / total;
        assert!((person.density - density).abs() < 1e-12 * density);
        assert!((person.pressure.unwrap() - pressure).abs() < 1e-12);
    }
    let still = People::new(
        (0..)
            .zip(positions)
            .map(|(k, p)| (k, p, Some(vector(1.0, 2.0)))),
    );
    let still = still.local(&still.at(&Site::new(Vec::new())), true);
    assert!(still.iter().all(|person| person.pressure.unwrap() < 1e-12));
}

#[test]
fn in_a_period_shorter_than_the_kernel_people_count_as_often_as_they_are_seen() {
    let agents = [[0.2, 0.5], [1.1, 0.7], [2.9, 0.4]];
    let document = |periodic: bool| {
        let laps = if periodic { 0..1 } else { -3..4 };
        let shifted =
            |lap: i32| agents.map(|[x, y]| json!({"position": [x + 3.0 * f64::from(lap), y]}));
        let agents: Vec<Value> = laps.flat_map(shifted).collect();
        let mut document = json!({"profile": "sph", "agents": agents, "duration_secs": 1});
        match periodic {
            true => document["periodic"] = json!({"axis": "x", "length": 3}),
            false => document["goal"] = json!([100, 0]),
        }
        document
    };
    let evaluated = |document: &Value| -> Simulation {
        let mut simulation = start(document, &[]);
        simulation.evaluate().unwrap();
        simulation
    };
    let rings = local(&evaluated(&document(true)));
    let row = local(&evaluated(&document(false)));
    for (k, person) in rings.iter().enumerate() {
        let same = row[3 * 3 + k];
        assert_eq!(person.position, same.position);
        assert!((person.density - same.density).abs() < 1e-12, "{k}");
    }
}

#[test]
fn levels_of_service_change_at_the_areas_of_fruin() {
    for (areas, rounded) in [
        (&WALKWAY, [0.31, 0.43, 0.72, 1.08, 2.15]),
        (&QUEUE, [0.83, 1.08, 1.54, 3.59, 5.38]),
    ] {
        for (k, (density, rounded)) in densities(areas).into_iter().zip(rounded).enumerate() {
            assert!((density - rounded).abs() < 0.005, "{density}");
            assert_eq!(level(density * 0.999, areas), k);
            assert_eq!(level(density * 1.001, areas), k + 1);
        }
    }
}

#[test]
fn exposure_adds_times_and_alarms_last_while_one_person_is_in_the_crowd() {
    let person = |number, density, speed| Local {
        number,
        position: Vector::zeros(),
        speed,
        density,
        pressure: None,
    };
    let mut seen = Exposure::default();
    let now = seen.add([person(0, 4.5, Some(0.1)), person(7, 6.5, None)].iter());
    assert_eq!(now.map(|dense| dense.people), [2, 1, 1]);
    seen.add([person(0, 3.9, Some(0.1)), person(7, 5.5, Some(0.3))].iter());
    seen.add([person(0, 1.0, Some(1.0))].iter());
    seen.add([person(0, 4.2, Some(0.1))].iter());
    // Four samples are three intervals, and the first one stands for none.
    let exposed = seen.exposed(0.5);
    assert_eq!(exposed.map(|of| of.people), [2, 1, 1, 1]);
    assert_eq!(exposed.map(|of| of.person_secs), [1.0, 0.5, 0.0, 1.0]);
    assert_eq!(exposed.map(|of| of.longest_secs), [0.5, 0.5, 0.0, 1.0]);
    assert_eq!(
        seen.alarms.map(|alarm| alarm.spell.longest()),
        [1.0, 1.0, 0.0]
    );
    assert_eq!(seen.alarms.map(|alarm| alarm.people), [2, 1, 1]);
    let area = 1.0 / 4.5 + 1.0 / 6.5;
    assert!((seen.alarms[0].area - area).abs() < 1e-12);
    let people: Vec<u32> = seen.of_people(0.5).map(|one| one.agent).collect();
    assert_eq!(people, [0, 7]);
}

/// A standing crowd with a spacing of 0.4 m: 6.25 P/m² in the middle, less at the rim.
fn standing() -> Value {
    json!({
        "duration_secs": 10, "profile": "sph", "parameters": {"gas_constant": 0},
        "agents": places(12, 12, 0.4).map(|p| json!({"position": [p.x, p.y], "goal": [p.x, p.y], "radius": 0.19}))
            .collect::<Vec<_>>(),
        "measurements": [{"exposure": {}}, {"service_levels": {}}, {"crowd_pressure": {}},
                         {"exposure": {"name": "late", "from_secs": 4, "until_secs": 6, "every_secs": 0.5,
                                       "region": [[0, 0], [0.5, 0.5]]}}],
    })
}

#[test]
fn a_standing_crowd_is_exposed_all_the_time_wherever_it_is_dense() {
    let mut simulation = start(&standing(), &[]);
    simulation.evaluate().unwrap();
    let people = local(&simulation);
    let above = |density: f64| people.iter().filter(|one| one.density > density).count() as f64;
    assert!(above(4.0) > above(5.0) && above(5.0) > above(6.0) && above(6.0) > 10.0);
    let summary = measured(standing());
    let metric = |name: &str| summary.metric(name).unwrap();
    // Samples at 0, 1, …, 10 s are 10 s.
    for density in [4.0, 5.0, 6.0] {
        let of = |what: &str| metric(&format!("exposure_above_{density}_{what}"));
        assert_eq!(of("agents"), above(density));
        assert_eq!(of("person_secs"), 10.0 * above(density));
        assert_eq!([of("longest_secs"), of("alarm_secs")], [10.0; 2]);
        assert_eq!(of("most_agents"), above(density));
    }
    assert_eq!(metric("exposure_slow_person_secs"), 10.0 * 144.0);
    assert_eq!(metric("late_slow_agents"), 1.0);
    assert!((metric("late_slow_person_secs") - 2.0).abs() < 1e-12);
    let shares = |kind: &str| {
        "abcdef"
            .chars()
            .map(|l| metric(&format!("service_{kind}_{l}")))
            .sum::<f64>()
    };
    assert!((shares("walkway") - 1.0).abs() < 1e-12 && (shares("queue") - 1.0).abs() < 1e-12);
    assert!((metric("service_queue_f") - above(densities(&QUEUE)[4]) / 144.0).abs() < 1e-12);
    assert_eq!(metric("crowd_pressure_max_per_s2"), 0.0);
    assert_eq!(metric("crowd_pressure_above_0.02_agents"), 0.0);
    assert_eq!(summary.data["exposure"].as_array().unwrap().len(), 144);
}

#[test]
fn durations_end_with_the_run_or_the_window_however_they_are_sampled() {
    // One person above 4 P/m² in the middle of others, who all stand.
    for (until, every, from, to) in [
        (4.0, 0.5, 0.0, 4.0),
        (4.0, 1.0, 0.0, 4.0),
        (4.0, 0.02, 0.0, 4.0),
        (4.0, 0.5, 1.0, 3.0),
        (4.0, 0.5, 2.0, 9.0),
        (3.0, 0.4, 0.0, 9.0),
        (0.2, 1.0, 0.0, 9.0),
    ] {
        let mut document = standing();
        document["duration_secs"] = json!(until);
        document["measurements"] =
            json!([{"exposure": {"from_secs": from, "until_secs": to, "every_secs": every}}]);
        let summary = measured(document);
        let metric = |name: &str| summary.metric(&format!("exposure_{name}")).unwrap();
        let secs = f64::min(until, to) - from;
        let least = secs - every + 1e-9; // a part of an interval is not seen
        for name in [
            "above_4_alarm_secs",
            "above_4_longest_secs",
            "slow_longest_secs",
        ] {
            let is_right = (least..=secs + 1e-9).contains(&metric(name));
            assert!(
                is_right,
                "{name}: {} s of {secs} s, every {every} s",
                metric(name)
            );
        }
        assert!((metric("slow_person_secs") - 144.0 * metric("slow_longest_secs")).abs() < 1e-6);
        assert_eq!(metric("slow_agents"), 144.0);
    }
}

/// Pushing people before a wall and a journey, with every measurement that has a state.
fn busy() -> Value {
    json!({
        "duration_secs": 8, "profile": "sph", "seed": 3,
        "walkable_area": [[[[0, 0], [8, 0], [8, 6], [0, 6]]]],
        "exits": [{"name": "door", "line": [[8, 2.5], [8, 3.5]]}],
        "journeys": [{"name": "out", "stages": [{"nearest": ["door"]}]}],
        "grids": [{"min": [0.3, 0.3], "max": [7.7, 5.7], "columns": 13, "rows": 9, "jitter": 0.1, "journey": "out"}],
        "measurements": [{"egress": {}}, {"exposure": {}}, {"service_levels": {"every_secs": 0.3}},
                         {"crowd_pressure": {}}, {"body_forces": {"every_secs": 0.2}},
                         {"wall_forces": {"every_secs": 0.2}}, {"walks": {}},
                         {"jitter": {"from_secs": 0, "until_secs": 8}}],
    })
}

#[test]
fn a_run_that_resumes_in_a_sampled_frame_measures_the_same_bits() {
    let drive = |run: &mut Run| {
        run.drive::<Fault, dyn Observer<Fault>>(&mut [], || false)
            .unwrap();
    };
    let whole = scenario(&busy(), &[]).unwrap();
    let mut run = Run::new(whole.clone()).unwrap();
    for _ in 0..200 {
        run.simulation.evaluate().unwrap();
        run.metrics.observe(&run.simulation);
        run.simulation.integrate().unwrap();
    }
    // Frame 200, at 4 s: all measurements take a sample.
    run.simulation.evaluate().unwrap();
    run.metrics.observe(&run.simulation);
    let checkpoint = Checkpoint::of(&whole, &run.simulation, &run.metrics);
    let mut resumed = checkpoint.resume(whole).unwrap();
    drive(&mut run);
    drive(&mut resumed);
    let (run, resumed) = (Summary::of(&run), Summary::of(&resumed));
    assert_eq!(run, resumed);
    for name in ["body_force_max_n", "wall_force_max_n_per_m", "delay_secs"] {
        assert!(run.metric(name).is_some_and(|value| value > 0.0), "{name}");
    }
}

#[test]
fn a_delay_is_the_time_beyond_free_walking_on_the_shortest_way() {
    // An L: 10 m along x, then 10 m along y.
    let document = json!({
        "duration_secs": 60, "profile": "sph", "stop": {"when_empty": true},
        "walkable_area": [[[[0, 0], [12, 0], [12, 12], [10, 12], [10, 2], [0, 2]]]],
        "exits": [{"name": "end", "line": [[10, 12], [12, 12]]}],
        "journeys": [{"name": "on", "stages": [{"nearest": ["end"]}]}],
        "agents": [{"position": [1, 1], "journey": "on", "preferred_speed": 1.0},
                   {"position": [11, 4], "journey": "on", "premovement_secs": 20}],
        "measurements": [{"egress": {}}],
    });
    let mut run = Run::new(scenario(&document, &[]).unwrap()).unwrap();
    run.drive::<Fault, dyn Observer<Fault>>(&mut [], || false)
        .unwrap();
    let results = run.metrics.results(&run.simulation);
    let metric = |name: &str| {
        results
            .iter()
            .find(|m| m.name == name)
            .unwrap()
            .value
            .unwrap()
    };
    // Each loses about half a second while it starts (τ = 0.5 s); the first one also keeps clear of the corner.
    assert_eq!(metric("finished"), 2.0);
    let (mean, longest) = (metric("delay_secs"), metric("longest_delay_secs"));
    assert!((0.4..1.5).contains(&mean), "{mean}");
    assert!((mean..2.0).contains(&longest), "{longest}");
}

#[test]
fn people_in_a_run_have_the_density_that_trajectories_of_them_have() {
    let document = json!({
        "duration_secs": 3, "profile": "sph", "goal": [9, 3],
        "obstacles": [[[6, 0], [7, 0], [7, 6], [6, 6]], [[2, 2], [2.2, 2], [2.2, 4], [2, 4]]],
        "grids": [{"min": [0, 0], "max": [6, 6], "columns": 12, "rows": 12, "jitter": 0.1}],
    });
    let mut simulation = after(&document, &[], 3.0);
    simulation.evaluate().unwrap();
    let in_run = local(&simulation);
    let site = Site::new(simulation.scene().walls.obstacles().to_vec());
    let people = People::of(simulation.frame().agents, None);
    assert_eq!(people.local(&people.at(&site), true), in_run);
    assert!(in_run.iter().any(|person| person.density > 4.0));
}
