//! Rooms and streets, as lists of polygons for the key `obstacles`.

use std::f64::consts::FRAC_PI_2;

/// A corner, meters.
type Corner = [f64; 2];

/// Half the width of the doorway, meters.
const HALF_DOOR: f64 = 0.4;
/// Straight segments per quarter circle.
const PIECES: u32 = 6;

/// The room of §6.1, [0, 20]², with its door of 0.8 m in the middle of the right wall.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Room {
    /// Thickness of its walls, meters.
    pub thickness: f64,
    /// Corner radius of the doorway, meters, at most half the thickness; 0 for square corners.
    pub rounding: f64,
}

impl Room {
    /// Its walls as one obstacle.
    pub fn obstacles(&self) -> Vec<Vec<Corner>> {
        let (low, high) = (-self.thickness, 20.0 + self.thickness);
        let mut corners = vec![[low, low], [high, low]];
        corners.extend(self.jamb(-1.0));
        corners.extend([[20.0, 0.0], [0.0, 0.0], [0.0, 20.0], [20.0, 20.0]]);
        corners.extend(self.jamb(1.0).into_iter().rev());
        corners.extend([[high, high], [low, high]]);
        vec![corners]
    }

    /// The goal, 1 m beyond the outer face of the wall.
    pub fn goal(&self) -> Corner {
        [21.0 + self.thickness, 10.0]
    }

    /// One side of the doorway, from outside to inside; `side` is −1 below and 1 above.
    fn jamb(&self, side: f64) -> Vec<Corner> {
        let y = 10.0 + side * HALF_DOOR;
        if self.rounding == 0.0 {
            return vec![[20.0 + self.thickness, y], [20.0, y]];
        }
        let r = self.rounding;
        let arc = |x: f64, from: f64| {
            (0..=PIECES).map(move |k| {
                let angle = from + FRAC_PI_2 * f64::from(k) / f64::from(PIECES);
                [x + r * angle.cos(), y + side * r * (1.0 - angle.sin())]
            })
        };
        let outer = arc(20.0 + self.thickness - r, 0.0);
        let inner = arc(20.0 + r, FRAC_PI_2);
        let mut corners: Vec<Corner> = outer.collect();
        // Where the arcs meet, a single corner is enough.
        corners.extend(inner.skip(usize::from(self.thickness == 2.0 * r)));
        corners
    }
}

/// A guess of the geometry around the room in §6.2.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Crossing {
    /// Two walled streets that cross 8 m before the room.
    Streets,
    /// No walls but the room's.
    Open,
    /// The streets cross just before the room.
    Near,
}

impl Crossing {
    /// All guesses, with descriptions.
    pub const ALL: [(Self, &'static str); 3] = [
        (
            Self::Streets,
            "walled streets, crossing at x = −12 … −8 m (shipped)",
        ),
        (Self::Open, "no walls but the room's, crossing there"),
        (Self::Near, "walled streets, crossing at x = −5 … −1 m"),
    ];

    /// x of the left and right side of the vertical street, meters.
    pub fn stream(self) -> [f64; 2] {
        match self {
            Self::Streets | Self::Open => [-12.0, -8.0],
            Self::Near => [-5.0, -1.0],
        }
    }

    /// Its obstacles.
    pub fn obstacles(self) -> Vec<Vec<Corner>> {
        match self {
            Self::Streets => streets(self.stream()),
            Self::Open => open(),
            Self::Near => streets(self.stream()),
        }
    }
}

/// The lower half of a scene and its mirror image about y = 8 m.
fn mirrored(lower: Vec<Vec<Corner>>) -> Vec<Vec<Corner>> {
    let upper = lower.iter().map(|corners| {
        let mirror = |&[x, y]: &Corner| [x, 16.0 - y];
        corners.iter().map(mirror).collect()
    });
    let upper: Vec<Vec<Corner>> = upper.collect();
    lower.into_iter().chain(upper).collect()
}

fn streets([left, right]: [f64; 2]) -> Vec<Vec<Corner>> {
    // Left of the vertical street, and right of it including the room's wall; each 1 m thick.
    let street = vec![
        [-20.0, 4.0],
        [-20.0, 3.0],
        [left - 1.0, 3.0],
        [left - 1.0, -4.0],
        [left, -4.0],
        [left, 4.0],
    ];
    let mut room = vec![[right, -4.0]];
    if right + 1.0 < -1.0 {
        room.extend([
            [right + 1.0, -4.0],
            [right + 1.0, 3.0],
            [-1.0, 3.0],
            [-1.0, -1.0],
        ]);
    } else {
        room.extend([[0.0, -4.0], [0.0, -1.0]]);
    }
    room.extend(room_from(-1.0));
    room.push([right, 4.0]);
    mirrored(vec![street, room])
}

/// The lower half of the room's wall, from its outer lower right corner to the entrance.
fn room_from(outer: f64) -> [Corner; 6] {
    [
        [15.0, outer],
        [15.0, 7.6],
        [14.0, 7.6],
        [14.0, 0.0],
        [0.0, 0.0],
        [0.0, 4.0],
    ]
}

fn open() -> Vec<Vec<Corner>> {
    let mut room = vec![[-1.0, -1.0]];
    room.extend(room_from(-1.0));
    room.push([-1.0, 4.0]);
    mirrored(vec![room])
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    use crate::engine::geometry::Polygon;
    use crate::engine::math::Vector;
    use crate::lab::reproduce::Case;

    const SHIPPED: Room = Room {
        thickness: 1.0,
        rounding: 0.0,
    };

    fn area(corners: &[Corner]) -> f64 {
        let pairs = corners.iter().zip(corners.iter().cycle().skip(1));
        let twice: f64 = pairs.map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum();
        (twice / 2.0).abs()
    }

    fn simple(obstacles: &[Vec<Corner>]) {
        for corners in obstacles {
            let points: Vec<Vector> = corners.iter().map(|&c| c.into()).collect();
            Polygon::new(points).unwrap();
        }
    }

    #[test]
    fn a_room_is_a_ring_with_a_gap_and_rounding_takes_four_corners_off() {
        let square = SHIPPED.obstacles();
        assert!((area(&square[0]) - (22.0 * 22.0 - 400.0 - 0.8)).abs() < 1e-9);
        for rounding in [0.3, 0.5] {
            let round = Room {
                rounding,
                ..SHIPPED
            }
            .obstacles();
            simple(&round);
            let taken = area(&square[0]) - area(&round[0]);
            let circle = 4.0 * (1.0 - PI / 4.0) * rounding * rounding;
            assert!((taken - circle).abs() < 0.05 * circle, "{taken} {circle}");
        }
        let thin = Room {
            thickness: 0.1,
            rounding: 0.0,
        };
        simple(&thin.obstacles());
        assert_eq!(thin.goal(), [21.1, 10.0]);
    }

    #[test]
    fn what_is_built_here_is_what_is_shipped() {
        let corners = |case: Case| {
            let document = case.scenario().unwrap().document;
            let obstacles: Vec<Vec<Corner>> =
                serde_json::from_value(document["obstacles"].clone()).unwrap();
            obstacles
        };
        let shipped = corners(Case::shipped("evacuation"));
        assert!((area(&shipped[0]) - area(&SHIPPED.obstacles()[0])).abs() < 1e-9);
        let shipped = corners(Case::shipped("crossing"));
        let built = Crossing::Streets.obstacles();
        let total = |all: &[Vec<Corner>]| all.iter().map(|c| area(c)).sum::<f64>();
        assert!((total(&shipped) - total(&built)).abs() < 1e-9);
        for (guess, _) in Crossing::ALL {
            simple(&guess.obstacles());
        }
    }
}
