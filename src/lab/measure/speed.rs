//! Velocities from positions.

use rayon::prelude::*;

use crate::engine::math::Vector;
use crate::output::trajectory::read::Tracks;

/// Default number of recorded frames that a velocity looks back and ahead, common among PedPy's users.
pub const FRAMES: i64 = 5;

/// The velocity of every row, m/s: a central difference from `reach` recorded frames before to `reach` after. If one
/// of the two frames is missing, a one-sided difference; if both are missing, `None`. A frame also counts as missing
/// if the person is absent in between: no motion is measured across gaps.
pub fn velocities(tracks: &Tracks, reach: i64) -> Vec<Option<Vector>> {
    let frames = reach.saturating_mul(tracks.step);
    let people = (0..tracks.ids.len()).into_par_iter();
    let of_people: Vec<Vec<Option<Vector>>> = people
        .map(|p| {
            let rows = tracks.rows_of(p);
            let frame: Vec<i64> = rows
                .iter()
                .map(|&row| tracks.frame_of(row as usize))
                .collect();
            // The row is as many rows away as frames: no frame is missing in between.
            let at = |k: Option<usize>, offset: i64, here: i64| {
                let k = k.filter(|&k| frame.get(k) == Some(&here.saturating_add(offset)))?;
                Some((frame[k], tracks.position[rows[k] as usize]))
            };
            let reach = reach as usize;
            (0..rows.len())
                .map(|k| {
                    let here = (frame[k], tracks.position[rows[k] as usize]);
                    let before = at(k.checked_sub(reach), -frames, frame[k]);
                    let after = at(Some(k + reach), frames, frame[k]);
                    before.or(after)?;
                    let (from, to) = (before.unwrap_or(here), after.unwrap_or(here));
                    Some((to.1 - from.1) / ((to.0 - from.0) as f64 / tracks.fps))
                })
                .collect()
        })
        .collect();
    let mut velocities = vec![None; tracks.len()];
    for (p, own) in of_people.into_iter().enumerate() {
        for (&row, velocity) in tracks.rows_of(p).iter().zip(own) {
            velocities[row as usize] = velocity;
        }
    }
    velocities
}
