//! The narrowings of floors.

use sandbox::engine::geometry::{Area, Ring};
use sandbox::engine::math::direction;
use sandbox::engine::routes::{Floor, Narrowings};

use crate::common::vector;

/// A room of 10 m × 10 m with a door of `width` meters in its right wall, 0.2 m thick, and a room behind.
fn floor(width: f64) -> Floor {
    let half = 0.5 * width;
    let outline = vec![
        vector(0.0, 0.0),
        vector(10.0, 0.0),
        vector(10.0, 5.0 - half),
        vector(10.2, 5.0 - half),
        vector(10.2, 0.0),
        vector(20.0, 0.0),
        vector(20.0, 10.0),
        vector(10.2, 10.0),
        vector(10.2, 5.0 + half),
        vector(10.0, 5.0 + half),
        vector(10.0, 10.0),
        vector(0.0, 10.0),
    ];
    let area = Area {
        exterior: Ring::new(outline).unwrap(),
        holes: Vec::new(),
    };
    Floor::new(&[area], 0.0).unwrap()
}

#[test]
fn a_door_is_the_next_narrowing_of_those_who_walk_to_it() {
    for width in [0.7, 1.2, 3.0] {
        let narrowings = Narrowings::of(&floor(width).mesh, 6.0);
        let p = vector(6.0, 5.0);
        let next = narrowings.next(p, vector(1.0, 0.0), 9.0).unwrap();
        assert!((next.distance - 4.0).abs() < 1e-9 && (next.width - width).abs() < 1e-9);
        assert_eq!(narrowings.next(p, vector(-1.0, 0.0), 9.0), None);
        assert_eq!(narrowings.next(p, vector(1.0, 0.0), 3.9), None);
        let aside = direction(vector(4.0, 0.5 * width + 0.05));
        assert_eq!(narrowings.next(p, aside, 4.5), None);
    }
}
