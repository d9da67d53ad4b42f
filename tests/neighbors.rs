//! Neighbor lists and searches, compared with brute force.

use crate::common::vector;
use rand::Rng;
use sandbox::engine::agents::{Agents, NewAgent};
use sandbox::engine::geometry::{Polygon, Walls};
use sandbox::engine::math::Vector;
use sandbox::engine::neighbors::{
    BLOCK, CLUSTER, FOLLOWED, Grid, Neighbors, Ranges, Run, SKIN, STRIP, Shifts,
};
use sandbox::engine::random::{Purpose, stream};

fn crowd(count: u32, side: f64) -> Agents {
    let mut agents = Agents::default();
    for id in 0..count {
        let mut rng = stream(7, Purpose::Placement, id, 0);
        let position = vector(rng.random_range(0.0..side), rng.random_range(0.0..side));
        agents.enter(NewAgent::at(position, Vector::zeros(), 0), 7);
    }
    agents
}

fn listed(agents: &mut Agents) -> Neighbors {
    let mut neighbors = Neighbors::default();
    let ranges = Ranges {
        support: 1.0,
        avoidance: Some(5.0),
        sight: None,
        wide: Some(5.0),
        longest_step: 0.036,
        drift: 0.5 * SKIN,
        margin: 0.5 * SKIN,
        follow: false,
        period: None,
        ..Ranges::default()
    };
    neighbors.sort(agents, ranges);
    neighbors.list_agents();
    neighbors
}

fn near(neighbors: &Neighbors, i: usize) -> Vec<usize> {
    neighbors.near().near(i).map(|(j, _)| j).collect()
}

#[test]
fn lists_hold_all_near_agents_once_in_ascending_order() {
    for (count, side) in [(0, 1.0), (1, 1.0), (300, 6.0), (300, 300.0), (300, 0.1)] {
        let mut agents = crowd(count, side);
        let neighbors = listed(&mut agents);
        for i in 0..agents.len() {
            let found = near(&neighbors, i);
            assert!(found.is_sorted_by(|a, b| a < b) && found.contains(&i));
            for j in 0..agents.len() {
                let distance = (agents.position[i] - agents.position[j]).norm();
                assert!(distance >= 1.0 + SKIN || found.contains(&j));
            }
        }
    }
}

#[test]
fn lists_hold_few_agents_beyond_the_reach_of_a_cluster() {
    let mut agents = crowd(8000, 40.0);
    let neighbors = listed(&mut agents);
    let listed: usize = (0..8000).map(|i| near(&neighbors, i).len()).sum();
    let area = listed as f64 / 8000.0 / 5.0;
    // At 5 agents per m², eight agents in a row 1.14 m high take up 1.40 m. With 1.14 m added on all sides that
    // is 12.6 m²; partly covered cells add 0.5 m² on average.
    assert!(area < 13.3, "{area} m²");
}

#[test]
fn clusters_hold_all_agents_once_in_order() {
    for (count, side) in [(0, 1.0), (1, 1.0), (300, 6.0), (300, 300.0), (300, 0.1)] {
        let mut agents = crowd(count, side);
        let neighbors = listed(&mut agents);
        let blocks = (0..agents.len().div_ceil(BLOCK)).map(|b| neighbors.near().block(b));
        let members: Vec<usize> = blocks
            .flat_map(|block| block.clusters())
            .inspect(|(agents, _)| assert!(agents.len() <= CLUSTER))
            .flat_map(|(agents, _)| agents)
            .collect();
        assert_eq!(members, (0..agents.len()).collect::<Vec<_>>());
    }
}

#[test]
fn no_neighbor_is_missed_until_the_lists_are_stale() {
    let mut agents = crowd(400, 12.0);
    let mut neighbors = listed(&mut agents);
    for step in 1..=2 {
        assert!(!neighbors.are_stale());
        for (i, r) in agents.position.iter_mut().enumerate() {
            let angle = i as f64;
            *r += vector(angle.cos(), angle.sin()) * 0.05;
        }
        neighbors.moved(0.05 * f64::from(step), Vec::new());
        for i in 0..agents.len() {
            let r_i = agents.position[i];
            let around: Vec<usize> = neighbors
                .around(i, &agents.position, 5.0)
                .flat_map(|run| run.indices())
                .collect();
            let near = near(&neighbors, i);
            let mut runs = Vec::new();
            let alone = i..i + 1;
            neighbors.around_cluster(alone, &agents.position, 5.0, &mut runs);
            for j in (0..agents.len()).filter(|&j| j != i) {
                let distance = (r_i - agents.position[j]).norm();
                assert!(distance >= 1.0 || near.contains(&j));
                assert!(distance >= 5.0 || around.contains(&j));
                assert!(distance >= 5.0 || runs.iter().any(|run| run.indices().contains(&j)));
            }
        }
        // Lists rebuilt on the old cells are valid as long as before.
        neighbors.list_agents();
    }
    neighbors.moved(0.1 + 1e-6, Vec::new());
    assert!(neighbors.are_stale());
}

#[test]
fn all_agents_around_a_cluster_are_found_once() {
    for (count, side) in [(1, 1.0), (300, 6.0), (300, 60.0), (300, 3000.0)] {
        let mut agents = crowd(count, side);
        let neighbors = listed(&mut agents);
        let mut runs = Vec::new();
        let blocks = (0..agents.len().div_ceil(BLOCK)).map(|b| neighbors.near().block(b));
        for (cluster, _) in blocks.flat_map(|block| block.clusters()) {
            for radius in [0.5, 2.7, 5.0] {
                neighbors.around_cluster(cluster.clone(), &agents.position, radius, &mut runs);
                let found: Vec<usize> = runs.iter().flat_map(Run::indices).collect();
                assert!(found.is_sorted_by(|a, b| a < b));
                for (i, j) in cluster
                    .clone()
                    .flat_map(|i| (0..agents.len()).map(move |j| (i, j)))
                {
                    let offset = agents.position[i] - agents.position[j];
                    assert!(offset.norm() >= radius || found.contains(&j));
                    // Agents that are found do not seem near when coordinates wrap.
                    let wrapped = 2.0 * neighbors.extent() - offset.amax() - SKIN;
                    assert!(!found.contains(&j) || wrapped > radius + SKIN, "{offset}");
                }
            }
        }
    }
}

#[test]
fn no_listed_agent_seems_near_when_coordinates_wrap() {
    for (count, side) in [(300, 6.0), (300, 40.0), (300, 60.0), (40, 300.0)] {
        let mut agents = crowd(count, side);
        let neighbors = listed(&mut agents);
        for i in 0..agents.len() {
            for j in near(&neighbors, i) {
                let offset = (agents.position[i] - agents.position[j]).abs();
                let wrapped = 2.0 * neighbors.extent() - offset.max() - SKIN;
                assert!(wrapped > 1.0 + SKIN, "{offset}");
            }
        }
    }
}

#[test]
fn an_agent_far_from_the_others_has_no_neighbors() {
    let mut agents = crowd(50, 5.0);
    agents.enter(NewAgent::at(vector(1e9, -1e9), Vector::zeros(), 0), 0);
    let neighbors = listed(&mut agents);
    let far = agents.index_of(50).unwrap();
    assert_eq!(near(&neighbors, far), [far]);
}

#[test]
fn strange_sizes_and_extents_make_small_grids() {
    for height in [0.0, 5e-324, 1e-300, 1.14] {
        for positions in [
            vec![Vector::zeros()],
            vec![Vector::zeros(), Vector::new(9.0, 1e9)],
            vec![Vector::zeros(), Vector::new(f64::INFINITY, 1e9)],
            vec![Vector::new(f64::NAN, 0.0); 3],
        ] {
            let mut grid = Grid::default();
            let mut order = Vec::new();
            grid.rebuild(&positions, height, None, &mut order);
            assert_eq!(order.len(), positions.len());
            assert!(grid.cells() <= 1024);
        }
    }
}

/// Moves agents to where `place` maps their places at the sort.
fn move_to(neighbors: &mut Neighbors, agents: &mut Agents, place: impl Fn(Vector) -> Vector) {
    let sorted_at = neighbors.sorted_at().to_vec();
    agents.position = sorted_at.iter().map(|&p| place(p)).collect();
    let routes = agents.position.iter().zip(&sorted_at);
    let farthest = routes.map(|(p, q)| (p - q).norm()).fold(0.0, f64::max);
    let mut strips = neighbors.take_strips();
    let some = agents.position.chunks(STRIP).zip(sorted_at.chunks(STRIP));
    for (strip, (positions, starts)) in strips.iter_mut().zip(some) {
        *strip = Shifts::of(positions, starts);
    }
    neighbors.moved(farthest, strips);
}

#[test]
fn lists_that_follow_a_crowd_miss_nobody_however_it_moves() {
    let mut rng = stream(3, Purpose::Placement, 0, 0);
    let (mut kept, mut late) = (0, 0);
    for round in 0..300 {
        // A full square, or two halves with a gap between them, or few agents far apart.
        let (count, side) = [(1500, 20.0), (600, 12.0), (300, 60.0)][round % 3];
        let gap: f64 = [0.0, 2.5, 4.0][round / 3 % 3];
        let mut agents = crowd(count, side);
        for p in &mut agents.position {
            p.x += if p.x > 0.5 * side { gap } else { 0.0 };
        }
        let mut neighbors = Neighbors::default();
        let ranges = Ranges {
            support: 1.0,
            longest_step: 0.036,
            drift: FOLLOWED,
            margin: 0.5 * SKIN,
            follow: true,
            wide: (round % 2 == 0).then_some(3.0),
            ..Ranges::default()
        };
        neighbors.sort(&mut agents, ranges);
        neighbors.list_agents();
        let mut random = |most: f64| rng.random_range(-most..=most);
        let (drift, shear) = (vector(random(0.6), random(0.6)), random(0.006));
        let toward = random(if gap > 3.0 { 0.5 } else { 0.04 });
        let noise = random(0.03);
        move_to(&mut neighbors, &mut agents, |p| {
            let side = if p.x > 0.5 * side { -toward } else { toward };
            let wave = noise * (7.0 * p.x).sin();
            p + drift + vector(shear * p.y + side + wave, -wave)
        });
        if neighbors.are_stale() {
            continue;
        }
        kept += 1;
        let at = neighbors.sorted_at();
        let moved = agents.position.iter().zip(at).map(|(p, q)| (p - q).norm());
        late += usize::from(moved.fold(0.0, f64::max) > 0.5 * SKIN);
        for i in 0..agents.len() {
            let found = near(&neighbors, i);
            // Also in the cells, where social forces, walking laws and causes of standstills look for others.
            let (p, positions) = (agents.position[i], &agents.position);
            let runs = neighbors.around(i, positions, 3.0);
            let around: Vec<usize> = runs.flat_map(|run| run.indices()).collect();
            let (mut inside, mut of_cluster) = (Vec::new(), Vec::new());
            let corner = vector(2.0, 2.0);
            neighbors.inside(i..i + 1, [p - corner, p + corner], positions, &mut inside);
            neighbors.around_cluster(i..i + 1, positions, 3.0, &mut of_cluster);
            let has = |runs: &[Run], j: usize| runs.iter().any(|run| run.indices().contains(&j));
            for j in 0..agents.len() {
                let distance = (agents.position[i] - agents.position[j]).norm();
                assert!(
                    distance >= 1.0 || found.contains(&j),
                    "round {round}: {i} {j}"
                );
                if i % 37 > 0 || distance >= 3.0 {
                    continue;
                }
                assert!(
                    around.contains(&j) && has(&of_cluster, j),
                    "round {round}: {i} {j}"
                );
                let offset = (agents.position[j] - p).abs();
                assert!(
                    offset.max() > 2.0 || round % 2 > 0 || has(&inside, j),
                    "round {round}: {i} {j}"
                );
            }
        }
    }
    assert!(kept > 30 && late > 20, "{kept} {late}: nothing was tested");
}

#[test]
fn lists_follow_a_crowd_that_moves_as_one_and_no_pair_that_parts() {
    let mut agents = crowd(2000, 20.0);
    let mut neighbors = Neighbors::default();
    let ranges = Ranges {
        support: 1.0,
        drift: FOLLOWED,
        margin: 0.5 * SKIN,
        follow: true,
        ..Ranges::default()
    };
    neighbors.sort(&mut agents, ranges);
    move_to(&mut neighbors, &mut agents, |p| {
        p + vector(0.9 * FOLLOWED, 0.0)
    });
    assert!(!neighbors.are_stale());
    move_to(&mut neighbors, &mut agents, |p| {
        p + vector(1.1 * FOLLOWED, 0.0)
    });
    assert!(neighbors.are_stale());
    // One half walks along the other.
    let along = |shift: f64| move |p: Vector| p + vector(if p.y > 10.0 { shift } else { 0.0 }, 0.0);
    move_to(&mut neighbors, &mut agents, along(0.9 * SKIN));
    assert!(!neighbors.are_stale());
    move_to(&mut neighbors, &mut agents, along(1.1 * SKIN));
    assert!(neighbors.are_stale());
}

#[test]
fn lists_of_walls_have_those_in_reach_in_order_and_no_others() {
    for (squares, spacing) in [(0, 1.0), (2, 6.0), (60, 2.0), (150, 1.3)] {
        // Turned squares, row by row.
        let corner = |k: usize, q: usize| {
            let center = vector((k % 10) as f64, (k / 10) as f64) * spacing;
            let angle = k as f64 + 0.5 * std::f64::consts::PI * q as f64;
            center + vector(angle.cos(), angle.sin()) * 0.3
        };
        let square = |k: usize| Polygon::new((0..4).map(|q| corner(k, q)).collect()).unwrap();
        let walls = Walls::new((0..squares).map(square).collect());
        for count in [5, 400] {
            let mut agents = crowd(count, 30.0);
            for p in &mut agents.position {
                *p -= vector(6.0, 6.0); // some are far outside
            }
            let mut neighbors = Neighbors::default();
            let ranges = Ranges {
                support: 1.0,
                avoidance: Some(5.0),
                drift: 0.07,
                ..Ranges::default()
            };
            neighbors.sort(&mut agents, ranges);
            neighbors.list_walls(&agents, &walls);
            for (i, &p) in agents.position.iter().enumerate() {
                let within = |reach: f64| -> Vec<u32> {
                    let all = 0..walls.len() as u32;
                    let distance = |&k: &u32| (walls.wall(k).nearest_point(p).point - p).norm();
                    all.filter(|k| distance(k) < reach).collect()
                };
                assert_eq!(neighbors.near_walls(i), within(1.07));
                assert_eq!(neighbors.far_walls(i), within(5.07));
            }
        }
    }
}
