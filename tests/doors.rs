//! Exits through which no person fits are refused with the place; people pass all others.

use nalgebra::Rotation2;
use sandbox::engine::math::Vector;
use serde_json::{Value, json};

use crate::common::simulated::{after, scenario};

type Line = [[f64; 2]; 2];

/// A hall of 6 × 10 m turned by `angle`, with three people near an exit on this line and an obstacle.
fn hall(angle: f64, exit: Line, obstacle: &[[f64; 2]]) -> Value {
    let turned = |p: [f64; 2]| -> [f64; 2] { (Rotation2::new(angle) * Vector::from(p)).into() };
    let all = |points: &[[f64; 2]]| points.iter().map(|&p| turned(p)).collect::<Vec<_>>();
    let people = [[4.0, 7.0], [4.0, 8.0], [4.5, 9.0]];
    let mut hall = json!({
        "walkable_area": [[all(&[[0.0, 0.0], [6.0, 0.0], [6.0, 10.0], [0.0, 10.0]])]],
        "exits": [{"name": "east", "line": all(&exit)}],
        "agents": people.map(|p| json!({"position": turned(p)}))
    });
    if !obstacle.is_empty() {
        hall["obstacles"] = json!([all(obstacle)]);
    }
    hall
}

/// The number of agents that have left after 12 s, or the error.
fn left(hall: &Value) -> Result<usize, String> {
    scenario(hall, &[])?;
    Ok(after(hall, &[], 12.0).outcome().arrivals.len())
}

#[test]
fn people_pass_an_exit_that_reaches_beyond_the_floor_or_it_is_refused_where_the_floor_ends() {
    let ends = [8.6, 9.3, 10.0, 10.2, 10.9, 11.0, 12.5, 20.0];
    let lines = ends.map(|end| [[6.0, 8.0], [6.0, end]]);
    let beyond = [[[6.0, 5.0], [6.0, 16.0]], [[6.0, -11.0], [6.0, 9.5]]];
    let mut refused = 0;
    for angle in [0.0, 0.7, 2.3] {
        for line in lines.iter().chain(&beyond) {
            for line in [*line, [line[1], line[0]]] {
                match left(&hall(angle, line, &[])) {
                    Ok(count) => assert_eq!(count, 3, "{line:?}"),
                    Err(error) => {
                        assert!(
                            error.contains("exits[0].line: no person can pass `east`"),
                            "{error}"
                        );
                        let is_upper = line[0][1].max(line[1][1]) > 10.0;
                        let end = if is_upper {
                            "at (6, 10); end it there"
                        } else {
                            "at (6, 0); end it there"
                        };
                        assert!(angle != 0.0 || error.contains(end), "{error}");
                        refused += 1;
                    }
                }
            }
        }
    }
    assert_eq!(refused, 3 * 2 * 4, "those with their middle off the floor");
}

#[test]
fn an_exit_behind_an_obstacle_is_refused_unless_a_person_fits_beside_it() {
    let exit = [[6.0, 7.0], [6.0, 8.2]];
    for (covered, fits) in [(1.1, false), (1.0, false), (0.65, true), (0.3, true)] {
        let [from, to] = [6.5, 7.0 + covered];
        let obstacle = [[5.5, from], [6.5, from], [6.5, to], [5.5, to]];
        match scenario(&hall(0.0, exit, &obstacle), &[]).map(drop) {
            Ok(()) => assert!(fits, "{covered} m"),
            Err(error) => {
                let end = format!("meets an obstacle, at (6, {to})");
                assert!(!fits && error.contains(&end), "{error}");
            }
        }
    }
}

#[test]
fn lines_of_the_least_length_are_long_enough_wherever_they_lie() {
    for k in 0..1000 {
        let y = f64::from(k) * 0.009;
        let length =
            |length: f64| scenario(&hall(0.0, [[3.0, y], [3.0, y + length]], &[]), &[]).map(drop);
        assert_eq!(length(0.3), Ok(()), "{y}");
        let error = length(0.29).unwrap_err();
        assert!(
            error.contains("exits[0].line: 0.29 m long; no person fits through"),
            "{error}"
        );
    }
}
