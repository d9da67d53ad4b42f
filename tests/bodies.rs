//! New agents: their bodies, their start positions and their random numbers.

use crate::common::{blend_with, breakdown, evaluated, person, rectangle, scene, vector};
use rand::Rng;
use sandbox::engine::agents::{Agents, NewAgent};
use sandbox::engine::breakdown::Breakdown;
use sandbox::engine::math::Vector;
use sandbox::engine::placement::Grid;
use sandbox::engine::profile::Term;
use sandbox::engine::random::{Purpose, stream};
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::Scenario;
use sandbox::scenario::catalog::Parameters;

#[test]
fn bodies_depend_on_seed_and_id_and_stay_in_the_papers_range() {
    let crowd = |seed| {
        let mut agents = Agents::default();
        for x in 0..1000 {
            let somebody = NewAgent::at(Vector::new(f64::from(x), 0.0), Vector::zeros(), 0);
            agents.enter(somebody, seed);
        }
        agents
    };
    let agents = crowd(1);
    assert_eq!(agents.radius, crowd(1).radius);
    assert_ne!(agents.radius, crowd(2).radius);
    for (radius, mass) in agents.radius.iter().zip(&agents.mass) {
        assert!((0.215..=0.265).contains(radius));
        assert!((mass - (radius / 0.24).powi(2)).abs() < 1e-15);
    }
    let mean = agents.radius.iter().sum::<f64>() / 1000.0;
    assert!((mean - 0.24).abs() < 0.002);
}

#[test]
fn arranging_moves_every_quantity_and_drops_who_is_not_named() {
    let mut agents = Agents::default();
    for x in 0..4 {
        let somebody = NewAgent::at(Vector::new(f64::from(x), 0.0), Vector::zeros(), x as u16);
        agents.enter(somebody, 0);
    }
    let radius = agents.radius.clone();
    agents.arrange(&[3, 1]);
    assert_eq!(agents.id, [3, 1]);
    assert_eq!(agents.group, [3, 1]);
    assert_eq!(agents.radius, [radius[3], radius[1]]);
    assert_eq!(agents.entered(), 4);
    assert_eq!(agents.index_of(1), Some(1));
    assert_eq!(agents.index_of(0), None);
}

#[test]
fn agents_stand_at_the_centres_of_the_cells() {
    let grid = Grid {
        min: Vector::new(0.0, 0.0),
        max: Vector::new(20.0, 20.0),
        columns: 20,
        rows: 20,
        jitter: 0.0,
    };
    let positions: Vec<Vector> = grid.positions(1, 0).collect();
    assert_eq!(positions.len(), 400);
    assert_eq!(positions[0], Vector::new(0.5, 0.5));
    assert_eq!(positions[399], Vector::new(19.5, 19.5));
}

#[test]
fn a_row_is_a_grid_of_one_column_and_jitter_stays_in_bounds() {
    let row = Grid {
        min: Vector::new(0.0, -50.0),
        max: Vector::new(0.0, 50.0),
        columns: 1,
        rows: 100,
        jitter: 0.2,
    };
    for (k, p) in row.positions(1, 0).enumerate() {
        assert!(p.x.abs() <= 0.2);
        assert!((p.y - (k as f64 - 49.5)).abs() <= 0.2);
    }
    assert_ne!(row.positions(1, 0).next(), row.positions(2, 0).next());
    assert_ne!(row.positions(1, 0).next(), row.positions(1, 100).next());
}

#[test]
fn every_key_has_its_own_stream_and_repeats_it() {
    let draw =
        |seed, purpose, agent, frame| -> u64 { stream(seed, purpose, agent, frame).random() };
    let base = draw(1, Purpose::Body, 2, 3);
    assert_eq!(base, draw(1, Purpose::Body, 2, 3));
    for other in [
        draw(2, Purpose::Body, 2, 3),
        draw(1, Purpose::Placement, 2, 3),
        draw(1, Purpose::Body, 3, 3),
        draw(1, Purpose::Body, 2, 4),
    ] {
        assert_ne!(base, other);
    }
}

fn masses(keys: &str) -> [Vec<u64>; 3] {
    let text = format!(
        r#"{{"goal": [50, 5], "grids": [{{"min": [0, 0], "max": [9, 9], "columns": 9, "rows": 9, "jitter": 0.2,
            "preferred_speed": {{"uniform": [1, 2]}}{keys}}}]}}"#
    );
    let scene = Scenario::parse(&text, "f", &[]).unwrap().scene;
    let simulation = Simulation::new(scene).unwrap();
    let agents = simulation.frame().agents;
    [&agents.mass, &agents.radius, &agents.preferred_speed]
        .map(|values| values.iter().map(|value| value.to_bits()).collect())
}

#[test]
fn masses_are_drawn_apart_from_all_other_traits() {
    let [of_radius, radii, speeds] = masses("");
    let [ones, ..] = masses(r#", "mass": 1"#);
    assert!(ones.iter().all(|&mass| f64::from_bits(mass) == 1.0));
    let drawn = masses(r#", "mass": {"uniform": [0.9, 1.1]}"#);
    assert_eq!(drawn[1..], [radii, speeds]);
    assert_ne!(drawn[0], of_radius);
    let values = drawn[0].iter().map(|&mass| f64::from_bits(mass));
    assert!(values.clone().all(|mass| (0.9..=1.1).contains(&mass)));
    assert!(values.fold(0.0, f64::max) > 1.05);
}

#[test]
fn a_part_of_the_radius_counts_in_contacts() {
    let terms = |parameters: &Parameters| {
        let wall = rectangle([-3.0, 3.0], [-1.0, 0.0]);
        let mut scene = scene(vec![wall], blend_with("sf", parameters));
        scene.agents = [0.0, 0.3]
            .map(|x| person(vector(x, 0.1), vector(9.0, 9.0)))
            .to_vec();
        let simulation = evaluated(scene);
        let [own, other] = [0, 1].map(|id| breakdown(&simulation, id));
        let push = |of: &Breakdown| {
            of.profiles[0]
                .accelerations
                .get(Term::ContactAgents)
                .unwrap()
        };
        assert!((push(&own) + push(&other)).norm() < 1e-12);
        own
    };
    let whole = terms(&Parameters::default());
    for (scale, wall_scale) in [(1.0_f64, 1.0_f64), (0.9, 0.5), (0.5, 0.9), (0.7, 0.3)] {
        let part = terms(
            &Parameters::of([("contact_scale", scale), ("wall_contact_scale", wall_scale)])
                .unwrap(),
        );
        let own = part.profiles[0].accelerations.clone();
        let agents = -1000.0 * (0.48 * scale - 0.3).max(0.0);
        let wall = 1000.0 * (0.24 * wall_scale - 0.1).max(0.0);
        assert!((own.get(Term::ContactAgents).unwrap() - vector(agents, 0.0)).norm() < 1e-9);
        assert!((own.get(Term::ContactWalls).unwrap() - vector(0.0, wall)).norm() < 1e-9);
        let of_whole = whole.profiles[0].accelerations.clone();
        assert_eq!(
            own.get(Term::SocialAgents),
            of_whole.get(Term::SocialAgents)
        );
        assert_eq!((part.mass, part.radius), (whole.mass, whole.radius));
    }
}
