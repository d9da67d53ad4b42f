//! Velocities from positions.

use rayon::prelude::*;

use engine::math::Vector;
use scenario::trajectories::Tracks;

/// Default number of recorded frames that a velocity looks back and ahead, common among PedPy's users.
pub const FRAMES: i64 = 5;

/// The velocity of every row, m/s: a central difference from `reach` recorded frames before to `reach` after; of a
/// person with another step than the others over the same time. If one of the two frames is missing, a one-sided
/// difference; if both are missing, `None`. A frame also counts as missing if the person is absent in between: no
/// motion is measured across gaps.
pub fn velocities(tracks: &Tracks, reach: i64) -> Vec<Option<Vector>> {
    let computed = (0..tracks.ids.len()).into_par_iter().map(|p| {
        let rows = tracks.rows_of(p).iter().map(|&row| row as usize);
        let timed = rows.map(|row| (tracks.frame_of(row), tracks.position[row]));
        let states: Vec<(i64, Vector)> = timed.collect();
        let gap = |pair: &[(i64, Vector)]| tracks.is_gap(p, pair[1].0 - pair[0].0);
        // The number of gaps before each state: without one, a state is as many rows away as frames.
        let gaps = states.windows(2).scan(0, |gaps, pair| {
            *gaps += u32::from(gap(pair));
            Some(*gaps)
        });
        let gaps: Vec<u32> = std::iter::once(0).chain(gaps).collect();
        let frames = reach.saturating_mul(tracks.step) as f64;
        let rows = (frames / tracks.step_of(p) as f64).round().max(1.0) as usize;
        let velocity = |(k, here): (usize, &(i64, Vector))| {
            let at = |other: Option<usize>| {
                let other = other.filter(|&other| gaps.get(other) == Some(&gaps[k]))?;
                states.get(other)
            };
            let (before, after) = (at(k.checked_sub(rows)), at(k.checked_add(rows)));
            before.or(after)?;
            let (from, to) = (before.unwrap_or(here), after.unwrap_or(here));
            Some((to.1 - from.1) / ((to.0 - from.0) as f64 / tracks.fps))
        };
        states.iter().enumerate().map(velocity).collect()
    });
    let of_people: Vec<Vec<Option<Vector>>> = computed.collect();
    let mut velocities = vec![None; tracks.len()];
    for (p, own) in of_people.into_iter().enumerate() {
        for (&row, velocity) in tracks.rows_of(p).iter().zip(own) {
            velocities[row as usize] = velocity;
        }
    }
    velocities
}
