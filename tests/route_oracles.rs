//! What corners see, and the lengths of routes, against brute force on a thousand random plans.

use std::collections::BTreeSet;
use std::f64::consts::PI;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::prelude::*;
use sandbox::engine::math::Vector;
use sandbox::engine::routes::{Bend, Destination, Floor, Goal, Next, PathMap, Routes, Turn};

use crate::common::floors::Plan;
use crate::common::taut::Web;
use crate::common::visibility::{Sector, Sights};

/// The number of plans.
const PLANS: u64 = 1000;
/// Nearer to the limits of what a corner sees, rounding may decide, radians.
const CLOSE: f64 = 1e-5;

/// Calls `check` for all plans, and returns the sum of its results.
fn on_all_plans(check: impl Fn(&mut ChaCha8Rng, &Plan) -> usize + Sync) -> usize {
    let checked = (0..PLANS).into_par_iter().map(|seed| {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let plan = Plan::random(&mut rng);
        check(&mut rng, &plan)
    });
    checked.sum()
}

/// The turn of a way that ends in the direction `way` from a corner: `Some(None)` if routes to there do not bend at the
/// corner, and `None` if rounding decides.
fn turn(sector: &Sector, way: Vector) -> Option<Option<Turn>> {
    let angle = sector.angle_to(way, 1e-6);
    let limits = [sector.angle - PI, PI, sector.angle];
    let is_close = |limit: &f64| (angle - limit).abs() < CLOSE;
    // Along a wall, rounding decides nothing.
    if limits[..2].iter().any(is_close) {
        return None;
    }
    let first = (angle < limits[0]).then_some(Turn::First);
    let last = (limits[1] < angle && angle < limits[2] + CLOSE).then_some(Turn::Last);
    Some(first.or(last))
}

/// The sector at each corner of the floor.
fn sectors(floor: &Floor, sights: &Sights, plan: &Plan) -> Vec<Sector> {
    let bends = sights.bends.iter();
    let sharp = bends.filter(|bend| bend.angle > PI + CLOSE).count();
    let all = sharp..=sights.bends.len();
    assert!(all.contains(&floor.corners.len()), "{plan:?}");
    let at = |place: Vector| {
        let is_here = |bend: &&Sector| (bend.place - place).norm() < 1e-9;
        let here = sights.bends.iter().find(is_here);
        *here.unwrap_or_else(|| panic!("{place} in {plan:?}"))
    };
    let corners = floor.corners.iter();
    corners.map(|corner| at(corner.place)).collect()
}

#[test]
fn straight_routes_between_corners_agree_with_brute_force() {
    let checked = on_all_plans(|_, plan| {
        let areas = plan.areas();
        let (floor, sights) = (Floor::new(&areas, 0.0).unwrap(), Sights::new(&areas));
        let sectors = sectors(&floor, &sights, plan);
        let routes =
            (0..2 * sectors.len()).flat_map(|to| floor.before(to).map(move |from| (from, to)));
        let found: BTreeSet<(usize, usize)> = routes.collect();
        let mut checked = 0;
        for (i, p) in sectors.iter().enumerate() {
            for (j, q) in sectors.iter().enumerate().filter(|(j, _)| *j != i) {
                let turns = [turn(p, q.place - p.place), turn(q, p.place - q.place)];
                let [Some(here), Some(there)] = turns else {
                    continue;
                };
                if sights.is_close_call(p.place, q.place) {
                    continue;
                }
                checked += 1;
                let sees = sights.sees_bend(p.place, q) && sights.sees_bend(q.place, p);
                for before in Turn::BOTH {
                    for after in Turn::BOTH {
                        let bends = [(i, before.other()), (j, after)];
                        let [from, to] = bends.map(|(corner, turn)| {
                            Bend {
                                corner: corner as u32,
                                turn,
                            }
                            .index()
                        });
                        let expected = sees && here == Some(before) && there == Some(after);
                        let is_found = found.contains(&(from, to));
                        assert_eq!(
                            is_found, expected,
                            "{:?} to {:?} in {plan:?}",
                            p.place, q.place
                        );
                    }
                }
            }
        }
        checked
    });
    assert!(checked > 500_000, "{checked}");
}

#[test]
fn what_corners_see_agrees_with_brute_force() {
    let checked = on_all_plans(|rng, plan| {
        let areas = plan.areas();
        let (floor, sights) = (Floor::new(&areas, 0.0).unwrap(), Sights::new(&areas));
        let sectors = sectors(&floor, &sights, plan);
        let points: Vec<Vector> = (0..8).filter_map(|_| plan.free(rng, 1e-4)).collect();
        let mut checked = 0;
        for index in 0..2 * sectors.len() {
            let bend = Bend::of_index(index);
            let sector = &sectors[bend.corner as usize];
            let mut seen = vec![false; points.len()];
            let mut enter = |t: u32, p: usize, holds: bool| {
                seen[p] |= holds && floor.mesh.contains(t, points[p])
            };
            floor.look_from(
                bend,
                |t, view| {
                    (0..points.len()).for_each(|k| enter(t, k, view.holds(points[k])));
                    true
                },
                |_, _, _| (),
            );
            for (&p, seen) in points.iter().zip(seen) {
                let Some(turn) = turn(sector, p - sector.place) else {
                    continue;
                };
                if !sights.is_close_call(p, sector.place) {
                    checked += 1;
                    let expected = turn == Some(bend.turn) && sights.sees_bend(p, sector);
                    assert_eq!(
                        seen, expected,
                        "{p} and {bend:?} at {:?} in {plan:?}",
                        sector.place
                    );
                }
            }
        }
        checked
    });
    assert!(checked > 200_000, "{checked}");
}

/// A goal of a plan, and its line.
fn goal(rng: &mut ChaCha8Rng, plan: &Plan, sights: &Sights) -> Option<(Goal, [Vector; 2])> {
    let a = plan.free(rng, 0.02)?;
    let ends =
        (0..5).map(|_| a + Vector::new(rng.random_range(-3.0..3.0), rng.random_range(-3.0..3.0)));
    let ends: Vec<Vector> = ends.collect();
    let b = ends
        .into_iter()
        .find(|&b| plan.is_free(b, 1e-3) && sights.sees(a, b));
    Some(match b.filter(|_| rng.random_bool(0.5)) {
        Some(b) => (Goal::Line([a, b]), [a, b]),
        None => (Goal::Point(a), [a, a]),
    })
}

fn length(floor: &Floor, map: &PathMap, p: Vector) -> Option<f64> {
    Some(map.way(floor, p, floor.locate(p)?, None)?.length)
}

#[test]
fn lengths_agree_with_a_visibility_graph_by_brute_force() {
    let checked = on_all_plans(|rng, plan| {
        let areas = plan.areas();
        let (floor, sights) = (Floor::new(&areas, 0.0).unwrap(), Sights::new(&areas));
        let Some((goal, line)) = goal(rng, plan, &sights) else {
            return 0;
        };
        let map = PathMap::new(&floor, &[goal], 0.0).unwrap();
        let starts: Vec<Vector> = (0..10).filter_map(|_| plan.free(rng, 1e-4)).collect();
        for (&p, expected) in starts.iter().zip(sights.lengths(line, &starts)) {
            let found = length(&floor, &map, p).unwrap_or(f64::INFINITY);
            let agrees = found == expected || (found - expected).abs() < 1e-6;
            assert!(
                agrees,
                "{found} instead of {expected} m from {p} to {line:?} in {plan:?}"
            );
        }
        starts.len()
    });
    assert!(checked > 9000, "{checked}");
}

#[test]
fn routes_cross_no_wall_and_no_taut_string_is_shorter() {
    let counts = (0..300_u64).into_par_iter().map(|seed| {
        let mut rng = ChaCha8Rng::seed_from_u64(seed);
        let plan = Plan::random(&mut rng);
        let ends: Vec<Vector> = (0..4).filter_map(|_| plan.free(&mut rng, 0.02)).collect();
        let [goal, starts @ ..] = &ends[..] else {
            return [0; 3];
        };
        let areas = plan.areas();
        let (floor, sights) = (Floor::new(&areas, 0.0).unwrap(), Sights::new(&areas));
        let routes = Routes::new(floor, &[vec![Goal::Point(*goal)]], Vec::new()).unwrap();
        let web = Web::new(&plan, 0.45, &ends);
        let mut counts = [0; 3];
        for (k, &p) in starts.iter().enumerate() {
            let Some(way) = routes.way(p, Destination::Place(0)) else {
                assert_eq!(web.length(k + 1, 0), None, "no way from {p} in {plan:?}");
                continue;
            };
            let mut points = vec![p];
            points.extend(routes.course(p, Destination::Place(0)));
            let pairs = || points.windows(2);
            let length: f64 = pairs().map(|pair| (pair[1] - pair[0]).norm()).sum();
            assert!((length - way.length).abs() < 1e-9, "{points:?} in {plan:?}");
            assert!(
                pairs().all(|pair| sights.sees(pair[0], pair[1])),
                "{points:?} in {plan:?}"
            );
            counts[0] += 1;
            // Webs do not reach through narrow slits.
            if let Some(taut) = web.length(k + 1, 0) {
                assert!(
                    length < taut + 1e-6,
                    "{length} m, but {taut} m from {p} in {plan:?}"
                );
                counts[1] += 1;
                counts[2] += usize::from((length - taut).abs() < 1e-3);
            }
        }
        counts
    });
    let add = |a: [usize; 3], b: [usize; 3]| [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
    let [routes, taut, equal] = counts.reduce(|| [0; 3], add);
    // On the other side of a body, a taut string can be longer.
    assert!(
        routes > 800 && taut > 800 && 100 * equal > 90 * taut,
        "{routes}, {taut}, {equal}"
    );
}

#[test]
fn a_least_width_below_all_gaps_changes_no_length_and_leaves_no_place_without_a_next_corner() {
    let checked: usize = (0..PLANS)
        .into_par_iter()
        .map(|seed| {
            let mut rng = ChaCha8Rng::seed_from_u64(seed);
            let most = rng.random_range(0..12);
            let plan = Plan::with_gaps(&mut rng, most, 0.41);
            let areas = plan.areas();
            let goals: Vec<Goal> = plan
                .free(&mut rng, 0.01)
                .map(Goal::Point)
                .into_iter()
                .collect();
            let points: Vec<Vector> = (0..50).filter_map(|_| plan.free(&mut rng, 1e-4)).collect();
            let routes = [0.0, 0.4].map(|width| {
                let floor = Floor::new(&areas, width).unwrap();
                let map = PathMap::new(&floor, &goals, 0.0).unwrap();
                let way = |&p: &Vector| map.way(&floor, p, floor.locate(p)?, None);
                points.iter().map(way).collect::<Vec<_>>()
            });
            for ((p, open), narrow) in points.iter().zip(&routes[0]).zip(&routes[1]) {
                let (open, narrow) = (open.unwrap(), narrow.unwrap());
                assert!(
                    !matches!(narrow.next, Next::Out(_)),
                    "{p}: {narrow:?} in {plan:?}"
                );
                let (long, short) = (narrow.length, open.length);
                assert!(
                    (long - short).abs() < 1e-9,
                    "{p}: {long} instead of {short} in {plan:?}"
                );
            }
            points.len()
        })
        .sum();
    assert!(checked > 45_000, "{checked}");
}
