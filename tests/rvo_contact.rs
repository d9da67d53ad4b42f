//! Times to contact, compared with motion in small steps. Those with walls are the ones that `rvo` compares the search
//! with.

use rand::Rng;
use sandbox::engine::forces::rvo::time_to_contact;
use sandbox::engine::geometry::Wall;
use sandbox::engine::math::{Vector, perpendicular};
use sandbox::engine::random::{Purpose, stream};

/// The time when two discs meet, from the roots of |offset − velocity t|² = reach².
pub fn meeting(offset: Vector, velocity: Vector, reach: f64) -> f64 {
    if offset.norm() <= reach || velocity.norm() == 0.0 {
        return f64::INFINITY;
    }
    let a = velocity.x * velocity.x + velocity.y * velocity.y;
    let b = -2.0 * (offset.x * velocity.x + offset.y * velocity.y);
    let c = offset.x * offset.x + offset.y * offset.y - reach * reach;
    let roots = [-1.0, 1.0].map(|sign| (-b + sign * (b * b - 4.0 * a * c).sqrt()) / (2.0 * a));
    let future = roots.into_iter().filter(|&time| time >= 0.0);
    future.fold(f64::INFINITY, f64::min)
}

/// The time when a disc meets a wall, in coordinates of the wall: s along it and d in front of it.
pub fn meeting_wall(wall: &Wall, position: Vector, velocity: Vector, radius: f64) -> f64 {
    let way = wall.end - wall.start;
    let length = (way.x * way.x + way.y * way.y).sqrt();
    let coordinates = |v: Vector| {
        let s = (v.x * way.x + v.y * way.y) / length;
        let d = (v.x * way.y - v.y * way.x) / length;
        (s, d)
    };
    let ((s, d), (ds, dd)) = (coordinates(position - wall.start), coordinates(velocity));
    let mut first = f64::INFINITY;
    let time = (radius - d) / dd;
    if dd < 0.0 && time >= 0.0 && s + ds * time >= 0.0 && s + ds * time <= length {
        first = time;
    }
    for end in [wall.start, wall.end] {
        first = first.min(meeting(end - position, velocity, radius));
    }
    first
}

/// Random numbers in [−1, 1).
fn numbers(seed: u32) -> impl FnMut() -> f64 {
    let mut rng = stream(9, Purpose::Candidates, seed, 0);
    move || rng.random_range(-1.0..1.0)
}

/// The first time, in small steps, at which `distance` is at most `reach`.
fn stepped(reach: f64, distance: impl Fn(f64) -> f64) -> f64 {
    (0..20_000)
        .map(|step| f64::from(step) * 1e-3)
        .find(|&time| distance(time) <= reach)
        .unwrap_or(f64::INFINITY)
}

/// Asserts that both methods find the same contact time. The stepped search may miss a grazing contact.
fn assert_agree(exact: f64, stepped: f64, reach: f64, distance: impl Fn(f64) -> f64) {
    let grazing = exact.is_finite() && distance(exact + 1e-3) > reach - 1e-5;
    let late = exact > 19.99 && stepped.is_infinite();
    assert!(
        (exact - stepped).abs() <= 1.001e-3 || exact == stepped || grazing || late,
        "{exact} {stepped}"
    );
}

#[test]
fn the_time_to_contact_is_found_in_small_steps_too() {
    for seed in 0..500 {
        let mut next = numbers(seed);
        let offset = Vector::new(next(), next()) * 5.0;
        let velocity = Vector::new(next(), next()) * 3.0;
        let reach = 0.5 * (1.1 + next()) / 2.0;
        let distance = |time: f64| (offset - velocity * time).norm();
        if distance(0.0) > reach {
            let exact = time_to_contact(offset, velocity, reach);
            assert_agree(exact, stepped(reach, distance), reach, distance);
        }
    }
}

#[test]
fn the_time_to_a_wall_is_found_in_small_steps_too() {
    let mut sides = [0; 3];
    for seed in 0..3000 {
        let mut next = numbers(seed);
        let start = Vector::new(next(), next()) * 3.0;
        let wall = Wall::new(start, start + Vector::new(next(), next()) * 4.0, 0, 0);
        let velocity = Vector::new(next(), next()) * 3.0;
        let position = Vector::new(next(), next()) * 5.0;
        let distance = |time: f64| {
            let p = position + velocity * time;
            let fraction = (p - wall.start).dot(&wall.tangent) / wall.length();
            (p - wall.start - (wall.end - wall.start) * fraction.clamp(0.0, 1.0)).norm()
        };
        if wall.faces(position) && distance(0.0) > 0.24 {
            let exact = meeting_wall(&wall, position, velocity, 0.24);
            assert_agree(exact, stepped(0.24, distance), 0.24, distance);
            if exact.is_finite() {
                let along = (position + velocity * exact - wall.start).dot(&wall.tangent);
                let part = usize::from(along >= 0.0) + usize::from(along > wall.length());
                sides[part] += 1;
            }
        }
    }
    assert!(sides.iter().all(|&count| count > 5), "{sides:?}");
}

#[test]
fn what_touches_already_or_moves_away_is_never_met() {
    let ahead = Vector::new(1.0, 0.0);
    assert_eq!(time_to_contact(ahead, ahead, 1.0), f64::INFINITY);
    assert_eq!(time_to_contact(ahead, -ahead, 0.5), f64::INFINITY);
    assert_eq!(time_to_contact(ahead, Vector::zeros(), 0.5), f64::INFINITY);
    assert_eq!(time_to_contact(ahead, ahead, 0.5), 0.5);
    let passing = perpendicular(ahead) * 0.500_1 + ahead;
    assert_eq!(time_to_contact(passing, ahead, 0.5), f64::INFINITY);
}
