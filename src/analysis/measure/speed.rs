//! Velocities from positions.

use rayon::prelude::*;

use crate::engine::math::Vector;
use crate::output::trajectory::read::Tracks;

/// How many recorded frames a velocity looks back and ahead, if nobody says otherwise: as PedPy's users do.
pub const FRAMES: i64 = 5;

/// The velocity of every row, m/s: how far the person gets from `reach` recorded frames before to as many
/// after, by the time between; where one of the two is missing, from there to the row itself or on from
/// it; `None` where both are. Frames in which the person is missing are missing: no motion is measured
/// across.
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
            // So many rows away and so many frames: nothing is missing in between.
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
