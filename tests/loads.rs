//! Forces on people and walls in newtons: pairs, lattices, rows against a wall, and the balance of momentum.

use crate::common::simulated::{go_on, measured, start};
use crate::common::{
    blend, blend_with, breakdown, evaluated, on_threads, person, rectangle, room, scene, vector,
};
use sandbox::analysis::body_forces::{BODY_MASS, BodyForces, Pressed, WIDTH, pressed};
use sandbox::analysis::evaluated::Evaluated;
use sandbox::analysis::local::KERNEL;
use sandbox::analysis::wall_forces::Outlines;
use sandbox::engine::agents::NewAgent;
use sandbox::engine::geometry::Walls;
use sandbox::engine::kernel;
use sandbox::engine::math::Vector;
use sandbox::engine::profile::Term;
use sandbox::engine::simulation::Simulation;
use sandbox::runs::summary::Summary;
use sandbox::scenario::catalog::Parameters;
use serde_json::{Value, json};

/// A pressed person of another size.
fn of_size(position: Vector, radius: f64) -> NewAgent {
    NewAgent {
        radius: Some(radius),
        mass: Some((radius / 0.24).powi(2)),
        mean_density: Some(0.5), // far below the density: pressure acts
        ..person(position, position)
    }
}

fn close(found: f64, expected: f64, tolerance: f64) {
    let off = (found - expected).abs();
    assert!(
        off <= tolerance * expected.abs().max(1e-12),
        "{found}, expected {expected}"
    );
}

#[test]
fn a_pair_presses_with_equal_newtons_whatever_the_masses() {
    let mut scene = scene(Vec::new(), blend("sph"));
    let (a, b) = (vector(0.0, 0.0), vector(0.3, 0.2));
    scene.agents = vec![of_size(a, 0.25), of_size(b, 0.22)];
    let simulation = evaluated(scene);
    let virials = simulation.virials();
    let mut newtons = Vec::new();
    for id in 0..2 {
        let i = simulation.frame().agents.index_of(id).unwrap();
        let of = breakdown(&simulation, id);
        let terms = of.profiles[0].accelerations.clone();
        let acceleration =
            terms.get(Term::PressureAgents).unwrap() + terms.get(Term::ContactAgents).unwrap();
        assert!(terms.get(Term::PressureAgents).unwrap().norm() > 1.0);
        assert!(terms.get(Term::ContactAgents).unwrap().norm() > 1.0);
        // The only partner: r ⊗ a.
        let arm = if id == 0 { a - b } else { b - a };
        let expected = [
            arm.x * acceleration.x,
            arm.x * acceleration.y,
            arm.y * acceleration.y,
        ];
        (0..3).for_each(|k| close(virials[i][k], expected[k], 1e-12));
        newtons.push(acceleration * (of.mass * BODY_MASS));
    }
    assert!((newtons[0] + newtons[1]).norm() < 1e-9 * newtons[0].norm());
    // Both are pressed along the line between them: σ = ρ/2 · r f, force = σ · 0.5 m.
    let h = KERNEL.support_radius;
    let distance = (a - b).norm();
    let density = kernel::density(0.0, h) + kernel::density(distance * distance, h);
    for person in pressed(&Evaluated::new(&simulation), BODY_MASS) {
        let stress = 0.5 * density * distance * newtons[0].norm();
        close(person.force, stress * WIDTH, 1e-9);
        let [xx, _, yy] = person.stress;
        close(-(xx + yy), stress, 1e-9);
    }
}

#[test]
fn in_a_hexagonal_lattice_in_contact_the_stress_is_that_of_its_bonds() {
    // Bonds of length d that press with f make a pressure of √3 f/d in all directions.
    let (d, radius, stiffness) = (0.4, 0.24, 100.0);
    let parameters =
        Parameters::of([("gas_constant", 0.0), ("agent_stiffness", stiffness)]).unwrap();
    let mut scene = scene(Vec::new(), blend_with("sph", &parameters));
    let rows = (-9_i32..=9).flat_map(|row| (-9_i32..=9).map(move |column| (column, row)));
    let places = rows.map(|(column, row)| {
        let shift = if row % 2 == 0 { 0.0 } else { 0.5 };
        vector(
            (f64::from(column) + shift) * d,
            f64::from(row) * d * 0.75_f64.sqrt(),
        )
    });
    scene.agents = places.map(|p| person(p, p)).collect();
    let simulation = evaluated(scene);
    let force = stiffness * (2.0 * radius - d) * BODY_MASS;
    let expected = 3_f64.sqrt() * force / d;
    let people = pressed(&Evaluated::new(&simulation), BODY_MASS);
    let center = people
        .iter()
        .find(|person| person.position.norm() < 1e-9)
        .unwrap();
    let [xx, xy, yy] = center.stress;
    close(-xx, expected, 0.01);
    close(-yy, expected, 0.01);
    assert!(xy.abs() < 1e-9 * expected);
    close(center.force, expected * WIDTH, 0.01);
}

/// A row of three people who walk against a wall, with nothing but goal forces and contact.
fn row(measurements: Value) -> Value {
    let agents = (0..3).map(|k| {
        json!({"position": [-0.3 - 0.45 * f64::from(k), 5.1], "goal": [100, 5.1], "radius": 0.24,
               "mass": 1.0 + 0.2 * f64::from(k)})
    });
    json!({
        "duration_secs": 20, "profile": "sph", "parameters": {"gas_constant": 0},
        "navigation": "straight", "precision": "double",
        "obstacles": [[[0, 0], [1, 0], [1, 10], [0, 10]]],
        "agents": agents.collect::<Vec<_>>(), "measurements": measurements,
    })
}

#[test]
fn a_row_that_pushes_against_a_wall_presses_it_with_the_sum_of_its_pushes() {
    let mut simulation = start(&row(json!([])), &[]);
    go_on(&mut simulation, 20.0);
    simulation.evaluate().unwrap();
    // Each person pushes with 1.4 m/s / 0.5 s times the mass of an average person, whatever its own mass.
    let push = 1.4 / 0.5 * BODY_MASS;
    let outlines = Outlines::new(simulation.frame().walls);
    let forces = outlines.forces(&Evaluated::new(&simulation), BODY_MASS);
    close(forces.iter().sum(), 3.0 * push, 1e-6);
    // All of it is on one cell, so that the mean over 1 m is the same number.
    let most = outlines.per_meter(&forces).into_iter().fold(0.0, f64::max);
    close(most, 3.0 * push, 1e-6);
    // The first in the row is pressed between the wall and the second by 3 and 2 pushes.
    let people = pressed(&Evaluated::new(&simulation), BODY_MASS);
    assert!(people[0].force > people[1].force && people[1].force > people[2].force);
}

#[test]
fn the_measurement_of_a_wall_finds_the_steady_force_and_its_place() {
    let window = json!({"from_secs": 15, "body_mass_kg": 80});
    let summary = measured(row(
        json!([{"wall_forces": window}, {"body_forces": window}]),
    ));
    let metric = |name: &str| summary.metric(name).unwrap();
    close(
        metric("wall_force_max_n_per_m"),
        3.0 * 1.4 / 0.5 * 80.0,
        1e-3,
    );
    assert_eq!(metric("wall_force_max_x_m"), 0.0);
    close(metric("wall_force_max_y_m"), 5.1, 1e-9);
    assert_eq!(metric("wall_force_above_3000_n_per_m_secs"), 0.0);
    close(
        metric("body_force_max_stress_n_per_m"),
        metric("body_force_max_n") / WIDTH,
        1e-12,
    );
    assert_eq!(metric("body_force_above_6227_n_agents"), 0.0);
    assert_eq!(summary.data["body_force"].as_array().unwrap().len(), 3);
    let parts = summary.data["wall_force"].as_array().unwrap();
    let most = parts
        .iter()
        .map(|part| part["max_n_per_m"].as_f64().unwrap());
    assert_eq!(most.fold(0.0, f64::max), metric("wall_force_max_n_per_m"));
}

/// People at rest in a room, denser than their rest density, some of them at walls and in a corner.
fn crowd_at_rest() -> Simulation {
    let parameters = Parameters::of([("gas_constant", 20.0)]).unwrap();
    let mut scene = scene(vec![room(3.0, 0.8)], blend_with("sph", &parameters));
    for k in 0..36 {
        let jitter = vector(f64::from(k * 7 % 5), f64::from(k * 11 % 7)) * 0.01;
        let place = vector(f64::from(k % 6), f64::from(k / 6)) * 0.5 + vector(0.2, 0.2) + jitter;
        scene
            .agents
            .push(of_size(place, 0.215 + 0.001 * f64::from(k)));
    }
    evaluated(scene)
}

#[test]
fn what_walls_take_is_the_change_of_momentum() {
    let mut simulation = crowd_at_rest();
    let mut on_people = Vector::zeros();
    simulation.each_wall_push(|i, _, push| {
        on_people += push * simulation.frame().agents.mass[i];
    });
    assert!(on_people.norm() > 1.0);
    let momentum = |simulation: &Simulation| -> Vector {
        let agents = simulation.frame().agents;
        let all = agents.mass.iter().zip(&agents.velocity);
        all.map(|(&mass, &velocity)| velocity * mass).sum()
    };
    let (before, step) = (momentum(&simulation), simulation.frame().clock.time_step());
    simulation.integrate().unwrap();
    assert_eq!(simulation.outcome().clamped.count, 0);
    assert_eq!(simulation.outcome().contained.count, 0);
    let change = (momentum(&simulation) - before) / step;
    assert!(
        (change - on_people).norm() < 1e-10 * on_people.norm(),
        "{change}, {on_people}"
    );
}

#[test]
fn means_over_a_meter_keep_the_total_and_go_around_corners() {
    let walls = Walls::new(vec![
        rectangle([0.0, 3.0], [0.0, 2.0]),
        rectangle([5.0, 5.2], [0.0, 0.2]),
    ]);
    let outlines = Outlines::new(&walls);
    let cells = outlines.cells();
    let length = |k: usize| (cells[k].ends[1] - cells[k].ends[0]).norm();
    let uniform: Vec<f64> = (0..cells.len()).map(|k| 7.0 * length(k)).collect();
    let means = outlines.per_meter(&uniform);
    for (k, mean) in means.iter().enumerate() {
        // The second outline is 0.8 m long and counts as 1 m.
        let expected = if cells[k].wall < 4 { 7.0 } else { 7.0 * 0.8 };
        close(*mean, expected, 1e-12);
    }
    // A single force near a corner is seen within half a meter on both sides of it.
    let mut single = vec![0.0; cells.len()];
    single[0] = 100.0;
    let means = outlines.per_meter(&single);
    let total: f64 = (0..cells.len()).map(|k| means[k] * length(k)).sum();
    close(total, 100.0, 1e-9);
    let seen: Vec<u32> = (0..cells.len())
        .filter(|&k| means[k] > 0.0)
        .map(|k| cells[k].wall)
        .collect();
    assert!(
        seen.contains(&0) && seen.contains(&3) && !seen.contains(&1),
        "{seen:?}"
    );
    close(means.into_iter().fold(0.0, f64::max), 100.0, 1e-12);
}

#[test]
fn scenes_without_pressure_and_contact_press_on_nobody() {
    let summary = measured(json!({
        "duration_secs": 2, "profile": "sph",
        "parameters": {"gas_constant": 0, "agent_stiffness": 0, "wall_stiffness": 0},
        "obstacles": [[[1, -1], [2, -1], [2, 1], [1, 1]]],
        "agents": [{"position": [0, 0], "goal": [5, 0]}, {"position": [0.3, 0], "goal": [5, 0]}],
        "measurements": [{"body_forces": {}}, {"wall_forces": {}}],
    }));
    assert_eq!(summary.metric("body_force_max_n"), Some(0.0));
    assert_eq!(summary.metric("wall_force_max_n_per_m"), Some(0.0));
}

#[test]
fn forces_and_exposure_are_the_same_on_any_number_of_threads() {
    let document = json!({
        "duration_secs": 3, "profile": "sph", "seed": 5,
        "obstacles": [[[6, 0], [7, 0], [7, 6], [6, 6]]],
        "grids": [{"min": [0, 0], "max": [6, 6], "columns": 14, "rows": 14, "jitter": 0.1, "goal": [9, 3]}],
        "measurements": [
            {"body_forces": {"every_secs": 0.5}}, {"wall_forces": {"every_secs": 0.1}}, {"exposure": {}},
            {"crowd_pressure": {}}, {"service_levels": {}}],
    });
    let run = |threads| -> Summary { on_threads(threads, || measured(document.clone())) };
    let (one, four) = (run(1), run(4));
    assert!(one.metric("wall_force_max_n_per_m").unwrap() > 10.0);
    assert_eq!(one, four);
}

#[test]
fn a_person_who_was_elsewhere_in_between_was_pressed_twice() {
    let person = Pressed {
        agent: 3,
        position: Vector::zeros(),
        stress: [-1400.0, 0.0, -1400.0],
        force: 700.0,
    };
    let mut seen = BodyForces::default();
    for (time, people) in [
        (0.0, &[person][..]),
        (1.0, &[person]),
        (2.0, &[]),
        (3.0, &[person]),
    ] {
        seen.add(time, people);
    }
    // Two samples in a row are one interval.
    assert_eq!(seen.above(), [(1, 1.0), (0, 0.0), (0, 0.0)]);
    assert_eq!(seen.peak.unwrap().1, 0.0);
}
