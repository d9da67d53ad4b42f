//! Places near walls, and the paths through them.

use sandbox::engine::agents::REFERENCE_RADIUS;
use sandbox::engine::geometry::{Polygon, Walls};
use sandbox::engine::math::{Vector, perpendicular};

/// The radius of an average body: no agent stands closer to a wall.
const BODY: f64 = REFERENCE_RADIUS;
/// Thickness of the walls beside the doorway, meters.
const PARTITION: f64 = 0.2;
/// Half the width of the doorway (§6.1), meters.
const HALF_DOOR: f64 = 0.4;
/// Everything is rotated by this angle (radians) and shifted by this vector (meters), so that no wall lies along a grid
/// or a row of particles.
const TURN: f64 = 0.3;
const MOVE: [f64; 2] = [0.377, 0.531];
/// The fractional parts of its multiples fill [0, 1) evenly.
const GOLDEN: f64 = 0.618_033_988_749_894_9;

/// A place of an agent.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// The x value of its curves, meters; see [`Case::axis`].
    pub along: f64,
    /// r_i, meters.
    pub position: Vector,
}

/// Obstacles and a path. The obstacles extend beyond the reach of an agent on the path.
#[derive(Debug, Clone)]
pub struct Case {
    /// Its name.
    pub name: &'static str,
    /// What [`Place::along`] means.
    pub axis: &'static str,
    /// The obstacles.
    pub walls: Walls,
    /// The places of the agent, in order.
    pub places: Vec<Place>,
    /// The direction of an endless straight wall: no force may act along it.
    pub tangent: Option<Vector>,
}

/// The cases, each with `count` places.
pub fn cases(count: usize) -> Vec<Case> {
    let straight = |name, thickness: f64| Case {
        name,
        axis: "distance [m]",
        walls: walls(&[&rectangle([-2.2, 3.2], [-thickness, 0.0])]),
        places: distances(count),
        tangent: Some(turned([1.0, 0.0])),
    };
    let passed = |name, obstacles: &[&[[f64; 2]]], corners: &[[f64; 2]]| Case {
        name,
        axis: "way along the path [m]",
        walls: walls(obstacles),
        places: path(corners, count),
        tangent: None,
    };
    let round_corner = [[-1.0, BODY], [BODY, BODY], [BODY, -1.0]];
    let into_corner = [[1.2, BODY], [BODY, BODY], [BODY, 1.2]];
    let (other_side, beside) = (-0.1 - BODY, BODY - HALF_DOOR);
    let round_end = [
        [-1.0, BODY],
        [BODY, BODY],
        [BODY, other_side],
        [-1.0, other_side],
    ];
    let solid = rectangle([-2.4, 0.0], [-2.4, 0.0]);
    let inner_corner = [
        [-2.2, -2.2],
        [2.4, -2.2],
        [2.4, 0.0],
        [0.0, 0.0],
        [0.0, 2.4],
        [-2.2, 2.4],
    ];
    let post = |y| rectangle([0.0, PARTITION], y);
    let (left, right) = (post([HALF_DOOR, 2.8]), post([-2.8, -HALF_DOOR]));
    let doorway: [&[[f64; 2]]; 2] = [&left, &right];
    let barrier = rectangle([-0.6, 0.6], [0.0, 0.05]);
    let behind_it = rectangle([-2.8, 2.8], [-2.4, -0.3]);
    let from_the_side = [[-BODY, -1.4], [-BODY, beside], [1.2, beside]];
    vec![
        straight("straight wall", 2.2),
        passed("convex corner", &[&solid], &round_corner),
        passed("concave corner", &[&inner_corner], &into_corner),
        straight("wall of 10 cm", 0.1),
        straight("wall of 1 cm", 0.01),
        passed(
            "end of a wall of 10 cm",
            &[&rectangle([-2.2, 0.0], [-0.1, 0.0])],
            &round_end,
        ),
        passed("doorway, middle", &doorway, &[[-1.0, 0.0], [1.2, 0.0]]),
        passed("doorway, from the side", &doorway, &from_the_side),
        passed(
            "barrier before a wall",
            &[&barrier, &behind_it],
            &[[-1.4, 0.05 + BODY], [1.4, 0.05 + BODY]],
        ),
    ]
}

fn rectangle(x: [f64; 2], y: [f64; 2]) -> [[f64; 2]; 4] {
    [[x[0], y[0]], [x[1], y[0]], [x[1], y[1]], [x[0], y[1]]]
}

fn turned([x, y]: [f64; 2]) -> Vector {
    let along = Vector::new(TURN.cos(), TURN.sin());
    along * x + perpendicular(along) * y
}

fn placed(point: [f64; 2]) -> Vector {
    turned(point) + Vector::from(MOVE)
}

fn walls(obstacles: &[&[[f64; 2]]]) -> Walls {
    let obstacle = |corners: &&[[f64; 2]]| {
        let corners = corners.iter().map(|&corner| placed(corner));
        Polygon::new(corners.collect()).ok()
    };
    Walls::new(obstacles.iter().filter_map(obstacle).collect())
}

/// From 2 cm to 1 m in front of a wall, each place at another position along it.
fn distances(count: usize) -> Vec<Place> {
    let place = |k: usize| {
        let along = 0.02 + 0.98 * k as f64 / count as f64;
        let position = placed([(k as f64 * GOLDEN).fract(), along]);
        Place { along, position }
    };
    (0..count).map(place).collect()
}

/// Places at equal distances along straight lines between `corners`.
fn path(corners: &[[f64; 2]], count: usize) -> Vec<Place> {
    let corners: Vec<Vector> = corners.iter().map(|&corner| placed(corner)).collect();
    let routes: Vec<Vector> = corners.windows(2).map(|ends| ends[1] - ends[0]).collect();
    let length: f64 = routes.iter().map(|way| way.norm()).sum();
    let place = |k: usize| {
        let along = length * (k as f64 + 0.5) / count as f64;
        let (mut left, mut position) = (along, corners[0]);
        for way in &routes {
            let part = (left / way.norm()).clamp(0.0, 1.0);
            position += way * part;
            left -= way.norm() * part;
        }
        Place { along, position }
    };
    (0..count).map(place).collect()
}
