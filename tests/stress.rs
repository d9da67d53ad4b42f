//! Hard cases: no panics, only finite numbers, no agent passes through a wall, and clamped values are reported.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use crate::common;
use crate::common::{blend, blend_with, block, person, rectangle, scene, vector};
use sandbox::engine::agents::NewAgent;
use sandbox::engine::breakdown::Breakdown;
use sandbox::engine::simulation::{Fault, Simulation};
use sandbox::lab::sweep::Study;
use sandbox::runs::drive::{Observer, Run};
use sandbox::runs::summary::Summary;
use sandbox::scenario::catalog::{NAMES, Parameters};
use sandbox::scenario::measurements::Watched;
use sandbox::scenario::{Scenario, Setting};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/stress")
}

/// The names of all files of `scenarios/stress`.
fn names() -> BTreeSet<String> {
    let files = fs::read_dir(folder())
        .unwrap()
        .map(|file| file.unwrap().path());
    files
        .map(|path| path.file_stem().unwrap().to_str().unwrap().to_owned())
        .collect()
}

/// A file of `scenarios/stress` with some settings.
fn scenario(name: &str, settings: &[&str]) -> Scenario {
    let settings: Vec<Setting> = settings.iter().map(|s| s.parse().unwrap()).collect();
    Scenario::load(&folder().join(format!("{name}.json")), &settings).unwrap()
}

/// Runs a file of `scenarios/stress` with some settings, and checks that no agent passes a wall and all is finite.
fn survives(name: &str, settings: &[&str]) -> Summary {
    let measured = [
        r#"measurements.+={"integrity": {}}"#,
        r#"measurements.+={"closest": {}}"#,
        r#"measurements.+={"evacuated": {}}"#,
    ];
    let scenario = scenario(name, &[settings, &measured].concat());
    let mut run = Run::new(scenario).unwrap();
    let driven = run.drive::<Fault, dyn Observer<Fault>>(&mut [], || false);
    let summary = Summary::of(&run);
    assert!(driven.is_ok(), "{name} {settings:?}: {driven:?}");
    for fault in ["agents_through_walls", "non_finite_frames"] {
        assert_eq!(
            summary.metric(fault),
            Some(0.0),
            "{name} {settings:?}: {fault}"
        );
    }
    summary
}

#[test]
fn every_file_belongs_to_one_of_the_two_studies() {
    let mut found = BTreeSet::new();
    for study in ["stress_hard", "stress_jitter"] {
        let study = Study::built_in(study, None, None).unwrap();
        assert!(study.cells.iter().all(|cell| cell.label().is_some()));
        found.extend(
            study
                .cells
                .iter()
                .map(|cell| cell.case.scenario().unwrap().name),
        );
    }
    assert_eq!(found, names());
}

#[test]
fn four_hundred_people_in_twenty_square_metres_push_each_other_apart() {
    let found = survives("packed", &[]);
    assert_eq!(found.agents, 400);
    assert!(
        found.metric("closest_centers") < Some(0.5),
        "they began deep in each other"
    );
    assert!(found.clamped_speeds > 0);
}

#[test]
fn sixty_people_on_one_point_come_apart() {
    let found = survives("one_point", &[]);
    assert_eq!(
        (found.agents, found.metric("closest_centers")),
        (60, Some(0.0))
    );
    let mut simulation = Simulation::new(scenario("one_point", &[]).scene).unwrap();
    common::run(&mut simulation, 250);
    let positions = &simulation.frame().agents.position;
    for (i, a) in positions.iter().enumerate() {
        assert!(positions[..i].iter().all(|b| (a - b).norm() > 0.05));
    }
}

#[test]
fn two_identical_agents_stay_together_and_cause_no_fault() {
    let found = survives("two_as_one", &[]);
    assert_eq!(
        (found.agents, found.metric("closest_centers")),
        (3, Some(0.0))
    );
}

#[test]
fn agents_that_start_inside_walls_are_moved_out_and_counted() {
    let found = survives("inside_walls", &[]);
    // Two stand exactly on an edge and on a corner.
    assert_eq!((found.agents, found.displaced_agents), (11, 9));
}

#[test]
fn no_agent_passes_the_walls_of_a_corridor_narrower_than_a_person() {
    survives("narrow_corridor", &[]);
}

#[test]
fn a_thousand_people_pass_a_doorway_of_thirty_centimeters_slowly() {
    let found = survives("narrow_door", &[]);
    assert_eq!(found.agents, 1000);
    assert!(found.metric("evacuated") < Some(50.0));
}

#[test]
fn no_agent_is_pressed_through_a_corner_of_five_degrees() {
    survives("wedge", &[]);
    survives("wedge", &["goal_scale=100"]);
}

#[test]
fn a_wall_of_ten_thousand_edges_holds() {
    survives("many_edges", &[]);
    assert!(scenario("many_edges", &[]).scene.walls.len() > 9_900);
}

#[test]
fn a_wall_of_one_centimeter_holds_a_pressing_crowd() {
    survives("thin_wall", &[]);
    // Without contact and SPH, only containment holds the agents.
    let bare = ["gas_constant=0", "wall_stiffness=0", "duration_secs=5"];
    assert!(survives("thin_wall", &bare).contained_moves > 1000);
}

#[test]
fn very_small_and_very_large_agents_can_stand_together() {
    survives("radii", &[]);
    survives("radii", &["profile=sf"]);
}

#[test]
fn the_density_a_million_meters_away_is_that_at_the_origin() {
    let far = survives("far_away", &[]);
    assert_eq!(far.contained_moves, 0);
    let density = |shift: f64| {
        let mut scene = scenario("far_away", &[]).scene;
        let home = vector(999_980.0, -999_980.0) * shift;
        let obstacles = scene.walls.obstacles().iter().map(|polygon| {
            let points = polygon.points().iter().map(|p| p - home).collect();
            sandbox::engine::geometry::Polygon::new(points).unwrap()
        });
        scene.walls = sandbox::engine::geometry::Walls::new(obstacles.collect());
        for agent in &mut scene.agents {
            agent.position -= home;
            agent.goal -= home;
        }
        let mut simulation = Simulation::new(scene).unwrap();
        common::run(&mut simulation, 50);
        simulation.evaluate().unwrap();
        let density = &simulation.frame().fields.density;
        density.iter().sum::<f64>() / density.len() as f64
    };
    let (far, home) = (density(0.0), density(1.0));
    assert!((far / home - 1.0).abs() < 1e-4, "{far} {home}");
}

#[test]
fn a_stiff_gas_and_stiff_contacts_oscillate_but_pass() {
    for name in ["stiff_gas", "stiff_contact"] {
        assert!(survives(name, &[]).clamped_speeds > 1000, "{name}");
    }
}

#[test]
fn time_steps_of_half_a_second_take_no_agent_through_a_thin_wall() {
    let found = survives("long_step", &[]);
    assert!(found.contained_moves > 100);
    let fast = ["time_step_secs=1", "max_speed=100", "preferred_speed=100"];
    survives("long_step", &fast);
}

#[test]
fn a_full_room_admits_all_agents_of_its_sources() {
    let found = survives("full_room", &[]);
    assert_eq!(found.agents, 144 + 13 * 25);
}

#[test]
fn goals_inside_an_obstacle_are_rarely_reached() {
    let found = survives("goals_inside", &[]);
    assert_eq!(found.agents, 260);
    assert!(found.metric("evacuated") <= Some(20.0), "{found:?}");
}

#[test]
fn a_crowd_at_rest_stays_at_rest_for_a_hundred_thousand_frames() {
    let found = survives("soak", &["duration_secs=2000"]);
    assert_eq!(found.frames, 100_000);
    assert_eq!(found.contained_moves, 0);
    assert!(
        found.metric("speed_at_end_m_per_s") < Some(1e-3),
        "{found:?}"
    );
}

#[test]
fn every_hard_case_passes_with_every_profile_wall_method_and_integrator() {
    for name in names() {
        for profile in NAMES {
            let profile = format!("profile={profile}");
            survives(&name, &["duration_secs=0.3", &profile]);
        }
        for setting in [
            "wall_method=exact",
            "wall_method=union",
            "integrator=forward-euler",
            "integrator=velocity-verlet",
            "integrator=midpoint",
            "neighbor_lists=coarse",
            "precision=double",
            "gas_constant=1e9",
            "support_radius=0.05",
        ] {
            survives(&name, &["duration_secs=0.5", setting]);
        }
    }
}

#[test]
fn an_agent_that_passes_through_a_wall_is_found() {
    let wall = rectangle([1.0, 1.01], [-9.0, 9.0]);
    let walled = Simulation::new(scene(vec![wall], blend("sph"))).unwrap();
    let mut free = scene(Vec::new(), blend("sph"));
    free.agents = vec![person(vector(0.0, 0.0), vector(9.0, 0.0))];
    let mut free = Simulation::new(free).unwrap();
    // The walls are those of the first simulation, through which the agent of the second one walks.
    let mut watched = Watched::default();
    watched.observe(&walled);
    assert_eq!(watched.agents_through_walls(&free), 0);
    for _ in 0..200 {
        free.evaluate().unwrap();
        watched.observe(&free);
        free.integrate().unwrap();
    }
    assert_eq!(watched.agents_through_walls(&free), 1);
}

#[test]
fn a_fault_gives_the_breakdown_of_its_agent() {
    for profile in ["sph", "sf", "rvo->sph"] {
        let huge = Parameters::of([
            ("gas_constant", 1e308),
            ("agent_stiffness", 1e308),
            ("wall_stiffness", 1e308),
        ])
        .unwrap();
        let mut scene = scene(
            vec![rectangle([2.1, 3.0], [0.0, 9.0])],
            blend_with(profile, &huge),
        );
        scene.agents = block(vector(0.0, 0.0), 6, 6, 0.3, vector(9.0, 0.0));
        let heavy = NewAgent {
            mass: Some(1e-6),
            ..person(vector(0.01, 0.01), vector(9.0, 0.0))
        };
        scene.agents.push(heavy);
        let mut simulation = Simulation::new(scene).unwrap();
        let fault = simulation.step().unwrap_err();
        let Fault::NotFinite { agent, .. } = fault else {
            panic!("{profile}: {fault}");
        };
        let breakdown = Breakdown::of_fault(&mut simulation, &fault).unwrap();
        assert_eq!(breakdown.id, agent);
        assert!(breakdown.density.is_finite() && breakdown.density > 0.0);
        let text = breakdown.to_string();
        assert!(text.contains(&format!("agent {agent}: position")), "{text}");
        assert!(text.contains("contact_agents"), "{text}");
        assert!(text.contains("total (weighted)"), "{text}");
    }
}
