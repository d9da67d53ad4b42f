//! The shipped scenarios, and profiles and groups as files give them.

use sandbox::engine::math::Vector;
use sandbox::engine::scene::{Goal, Region};
use sandbox::scenario::catalog::{self, Parameters};
use sandbox::scenario::measurements::Measurement;
use sandbox::scenario::{SHIPPED, Scenario, Setting};

fn shipped(name: &str, settings: &[&str]) -> Scenario {
    let settings: Vec<Setting> = settings.iter().map(|s| s.parse().unwrap()).collect();
    Scenario::shipped(name, &settings).unwrap()
}

fn parse(text: &str) -> Scenario {
    Scenario::parse(text, "f.json", &[]).unwrap()
}

#[test]
fn every_shipped_scenario_describes_itself_and_shows_a_dozen_agents() {
    for file in SHIPPED {
        let scenario = shipped(file.name, &[]);
        assert_eq!(scenario.name, file.name);
        assert_eq!(scenario.description, file.description());
        assert!(!scenario.description.is_empty());
        assert_eq!(scenario.debug_agents.len(), 12);
        let agents = &scenario.scene.agents;
        assert!(
            agents
                .iter()
                .all(|a| scenario.scene.walls.obstacle_at(a.position).is_none())
        );
    }
}

#[test]
fn the_evacuation_has_400_people_and_one_door() {
    let scenario = shipped("evacuation", &[]);
    assert_eq!(scenario.profile_name, "sph");
    assert_eq!(scenario.scene.agents.len(), 400);
    assert_eq!(scenario.scene.agents[399].position, Vector::new(19.5, 19.5));
    assert!(
        scenario
            .scene
            .agents
            .iter()
            .all(|a| a.goal == Vector::new(22.0, 10.0))
    );
    assert_eq!(scenario.scene.groups.len(), 1);
    assert_eq!(scenario.scene.groups[0].removal_radius, Some(0.5));
    assert!(scenario.stop.when_empty);
    assert_eq!(scenario.stop.idle_secs, Some(60.0));
    let names: Vec<String> = scenario
        .measurements
        .iter()
        .flat_map(Measurement::names)
        .collect();
    assert_eq!(
        names,
        [
            "density_mean_15s",
            "density_std_15s",
            "flow_per_s",
            "evacuated"
        ]
    );
    let ring = &scenario.scene.walls.obstacles()[0];
    assert!((ring.area() - (22.0 * 22.0 - 400.0 - 0.8)).abs() < 1e-12);
}

#[test]
fn the_crossing_is_symmetric_and_free_where_people_walk() {
    let scenario = shipped("crossing", &[]);
    assert_eq!(scenario.profile_name, "rvo->sph");
    assert_eq!(scenario.scene.agents.len(), 224);
    let walls = &scenario.scene.walls;
    for x in -250..200 {
        for y in -50..80 {
            let p = Vector::new(0.1 * f64::from(x) + 0.05, 0.1 * f64::from(y) + 0.05);
            let mirrored = Vector::new(p.x, 16.0 - p.y);
            let solid = walls.obstacle_at(p).is_some();
            assert_eq!(solid, walls.obstacle_at(mirrored).is_some(), "{p}");
            let corridor = p.x < 0.0 && p.y > 4.0;
            let vertical = p.x > -12.0 && p.x < -8.0;
            let room = p.x > 0.0 && p.x < 14.0 && p.y > 0.0;
            let exit = p.x > 14.0 && p.y > 7.6;
            if corridor || vertical || room || exit {
                assert!(!solid, "{p}");
            }
        }
    }
    assert!(walls.obstacle_at(Vector::new(14.5, 7.5)).is_some());
    assert!(walls.obstacle_at(Vector::new(-0.5, 3.5)).is_some());
    let [corridor, stream] = &scenario.scene.sources[..] else {
        panic!("two sources");
    };
    let starts: Vec<Vector> = corridor.grid.positions(1, 0).collect();
    assert_eq!(starts.len(), 8);
    assert_eq!(starts[0], Vector::new(-19.5, 4.5));
    assert_eq!((corridor.every, stream.every), (2.0, 1.0));
    let starts: Vec<Vector> = stream.grid.positions(1, 0).collect();
    assert_eq!(starts.len(), 4);
    let Goal::Offset(offset) = stream.goal else {
        panic!("each to a goal below");
    };
    assert_eq!(starts[0] + offset, Vector::new(-11.5, -4.0));
    let group =
        |source: &sandbox::engine::scene::Source| &scenario.scene.groups[usize::from(source.group)];
    assert!(group(corridor).counted && !group(stream).counted);
    assert_eq!(group(stream).removal_radius, Some(0.5));
}

#[test]
fn the_concert_has_a_hundred_rows_of_a_hundred_people_and_a_push() {
    let scenario = shipped("concert", &[]);
    assert!(scenario.scene.agents.is_empty());
    let rows = &scenario.scene.sources[0];
    assert_eq!(
        (rows.grid.len(), rows.times, rows.every),
        (100, Some(100), 1.0)
    );
    assert_eq!(rows.grid.jitter, 0.2);
    let paper = Parameters::of([("viscosity", 5.0), ("goal_scale", 0.1)]).unwrap();
    let group = &scenario.scene.groups[0];
    assert_eq!(Ok(group.blend.clone()), catalog::named("sph", &paper));
    assert_eq!(group.removal_radius, None);
    let push = &scenario.scene.pushes[0];
    assert_eq!((push.at, push.lasting), (150.0, 0.5));
    assert!(push.region.contains(Vector::new(55.0, 10.0)));
    assert_eq!(push.change.goal_scale, Some(1.0));
    assert!(push.change.ignore_contact && push.change.ignore_sph);
    assert_eq!(scenario.duration_secs, 180.0);
}

#[test]
fn the_plaza_has_50_000_people_in_queues_and_in_streams() {
    let scenario = shipped("plaza", &[]);
    assert_eq!(scenario.profile_name, "rvo->sph");
    let agents = &scenario.scene.agents;
    assert!((49_500..50_500).contains(&agents.len()));
    // Each lane is 14 m high; queues begin at x = 139.2 m, streams 50 m before that.
    let within = |x: [f64; 2], y: f64| {
        let inside = agents.iter().filter(|agent| {
            (x[0]..x[1]).contains(&agent.position.x) && (y..y + 15.0).contains(&agent.position.y)
        });
        inside.count() as f64
    };
    for lane in 0..10 {
        let y = 15.0 * f64::from(lane);
        let queue = within([139.2, 199.5], y) / (60.3 * 14.0);
        let stream = within([88.0, 138.0], y) / (50.0 * 14.0);
        assert!((4.0..6.0).contains(&queue), "{queue} P/m²");
        assert!((0.45..2.1).contains(&stream), "{stream} P/m²");
    }
}

#[test]
fn settings_apply_to_every_profile_and_to_nested_values() {
    let scenario = shipped(
        "concert",
        &[
            "viscosity=0",
            "profile=rvo->sph",
            "rest_density_max=4",
            "sources.0.rows=300",
            "events.0.goal_scale=2",
        ],
    );
    let blend = &scenario.scene.groups[0].blend;
    assert_eq!(blend.sph.rest_density_max, 4.0);
    assert!(
        blend
            .steps()
            .iter()
            .all(|step| step.profile.viscosity.is_none())
    );
    assert_eq!(scenario.profile_name, "rvo->sph");
    assert_eq!(scenario.scene.sources[0].grid.rows, 300);
    assert_eq!(scenario.scene.pushes[0].change.goal_scale, Some(2.0));
    assert_eq!(scenario.document["parameters"]["viscosity"], 0);
}

#[test]
fn profiles_of_a_blend_have_their_own_tolerances() {
    let scenario = parse(
        r#"{"profile": {"blend": [
            {"at_density": 2, "profile": {"base": "sf", "parameters": {"avoidance_tolerance": 0.001}}},
            {"at_density": 4, "profile": {"base": "sf+sph", "parameters": {"avoidance_tolerance": 0.01}}},
            {"at_density": 6, "profile": "sf"}
        ]}, "agents": [{"position": [0, 0]}], "goal": [1, 0]}"#,
    );
    let steps = scenario.scene.groups[0].blend.steps();
    let social = steps.iter().map(|step| step.profile.navigation.social());
    let tolerances: Vec<f64> = social
        .map(|social| social.unwrap().avoidance_tolerance)
        .collect();
    assert_eq!(tolerances, [0.001, 0.01, 0.0]);
}

#[test]
fn a_blend_written_in_full_equals_the_named_blend() {
    let scenario = parse(
        r#"{"profile": {"name": "sf->sph", "blend": [
            {"at_density": 2, "profile": "sf"},
            {"at_density": 4, "profile": {"navigation": "goal", "name": "sph", "parameters": {"gas_constant": 100}}}
        ]}, "goal": [0, 0], "agents": [{"position": [1, 1]}]}"#,
    );
    let softer = Parameters::of([("gas_constant", 100.0)]).unwrap();
    let blend = &scenario.scene.groups[0].blend;
    assert_eq!(Ok(blend.clone()), catalog::named("sf->sph", &softer));
    assert_eq!(scenario.profile_name, "sf->sph");
}

#[test]
fn scenario_wide_parameters_override_those_of_profiles() {
    let scenario = parse(
        r#"{"profile": {"base": "sph", "parameters": {"viscosity": 1, "goal_scale": 3}},
            "parameters": {"viscosity": 2},
            "goal": [0, 0], "agents": [{"position": [1, 1]}]}"#,
    );
    let expected = Parameters::of([("viscosity", 2.0), ("goal_scale", 3.0)]).unwrap();
    let blend = scenario.scene.groups[0].blend.clone();
    assert_eq!(Ok(blend), catalog::named("sph", &expected));
}

#[test]
fn agents_with_equal_behavior_share_a_group_and_keep_their_own_values() {
    let scenario = parse(
        r#"{"goal": [9, 9], "agents": [
            {"position": [0, 0]},
            {"position": [1, 0], "velocity": [1, -1], "radius": 0.3, "mass": 2, "mean_density": 3, "goal": [5, 5]},
            {"position": [2, 0], "profile": "sf"},
            {"position": [3, 0], "profile": "sf", "remove_within": 0.5, "counted": false},
            {"position": [4, 0], "profile": "sf"}
        ]}"#,
    );
    let agents = &scenario.scene.agents;
    let groups: Vec<u16> = agents.iter().map(|agent| agent.group).collect();
    assert_eq!(groups, [0, 0, 1, 2, 1]);
    assert_eq!(agents[0].goal, Vector::new(9.0, 9.0));
    assert_eq!(
        (agents[0].radius, agents[0].mass, agents[0].mean_density),
        (None, None, None)
    );
    assert_eq!(agents[1].goal, Vector::new(5.0, 5.0));
    assert_eq!(agents[1].velocity, Vector::new(1.0, -1.0));
    assert_eq!((agents[1].radius, agents[1].mass), (Some(0.3), Some(2.0)));
    assert_eq!(agents[1].mean_density, Some(3.0));
    let third = &scenario.scene.groups[2];
    assert_eq!((third.removal_radius, third.counted), (Some(0.5), false));
    let all = Region {
        min: Vector::new(-1.0, -1.0),
        max: Vector::new(10.0, 10.0),
    };
    assert_eq!(scenario.view.region, all);
}

#[test]
fn what_is_written_reads_back_and_lists_of_numbers_stay_together() {
    for shipped in SHIPPED {
        let scenario = Scenario::shipped(shipped.name, &[]).unwrap();
        let written = scenario.to_text();
        let again = Scenario::parse(&written, "f", &[]).unwrap();
        assert_eq!(again.document, scenario.document);
        let is_number = |line: &str| line.trim().trim_end_matches(',').parse::<f64>().is_ok();
        assert!(!written.lines().any(is_number));
        assert!(written.lines().all(|line| line.chars().count() < 120));
    }
}
