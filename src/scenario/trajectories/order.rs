//! The order of columns without names: usually id, frame, x, y; in some archives frame, id, x, y.

use super::line::number;
use super::tracks::{Contents, Entry, TOO_FAST, Tracks};
use super::{FRAME_RATES, Unit};
use engine::math::Vector;

/// The number of columns of `obsmat.txt` of ETH and UCY: frame, id, x, z, y, and the velocity along x, z and y.
const OBSMAT: usize = 8;
/// Paths that turn so much less, by the median cosine of the angle between two steps, are the paths of people.
const STRAIGHTER: f64 = 0.3;
/// The most by which steps and velocities of the same person differ, relative.
const AGREE: f64 = 0.3;

/// The last five columns of each row, as long as all rows have eight numbers.
#[derive(Default)]
pub struct Wide {
    rows: Vec<[f64; 5]>,
    is_narrow: bool,
}

impl Wide {
    /// Adds the columns of a row.
    pub fn add(&mut self, cells: &[&str]) {
        if self.is_narrow {
            return;
        }
        let last = cells.get(OBSMAT - 5..).unwrap_or_default();
        let numbers: Vec<f64> = last.iter().filter_map(|cell| number(cell)).collect();
        match numbers[..] {
            [a, b, c, d, e] if cells.len() == OBSMAT => self.rows.push([a, b, c, d, e]),
            _ => {
                self.rows = Vec::new();
                self.is_narrow = true;
            }
        }
    }
}

/// Takes the columns as those of `obsmat.txt` if there are eight, z and its velocity are 0, and the velocities are
/// those of the positions in this order. The velocities also say the frame rate.
pub fn read_obsmat(contents: &mut Contents, wide: &Wide) {
    let is_flat = wide
        .rows
        .iter()
        .all(|&[z, _, _, z_velocity, _]| [z, z_velocity] == [0.0; 2]);
    if wide.is_narrow || !is_flat {
        return;
    }
    let row = |(entry, &[_, y, x_velocity, _, y_velocity]): (&Entry, &[f64; 5])| {
        let position = Vector::new(entry.position.x, y);
        let (id, frame) = (entry.frame, entry.id);
        let velocity = Vector::new(x_velocity, y_velocity);
        (
            Entry {
                id,
                frame,
                position,
                ..*entry
            },
            velocity,
        )
    };
    let mut rows: Vec<(Entry, Vector)> = contents.entries.iter().zip(&wide.rows).map(row).collect();
    rows.sort_by_key(|(entry, _)| (entry.id, entry.frame));
    let step = |pair: &[(Entry, Vector)]| {
        let [(from, v), (to, w)] = [pair[0], pair[1]];
        let (way, frames) = (
            to.position - from.position,
            to.frame.saturating_sub(from.frame),
        );
        let is_step = from.id == to.id && frames > 0 && way != Vector::zeros();
        is_step.then_some((way, 0.5 * (v + w) * frames as f64))
    };
    let steps: Vec<(Vector, Vector)> = rows.windows(2).filter_map(step).collect();
    let rates = steps
        .iter()
        .map(|(way, velocity)| velocity.dot(way) / way.norm_squared());
    let Some(fps) = median(rates.collect()).filter(|fps| FRAME_RATES.contains(fps)) else {
        return;
    };
    let agrees =
        |(way, velocity): &&(Vector, Vector)| (velocity / fps - way).norm() <= AGREE * way.norm();
    if 2 * steps.iter().filter(agrees).count() <= steps.len() {
        return;
    }
    let whole = fps.round().max(1.0);
    let fps = match (fps / whole - 1.0).abs() < 0.02 {
        true => whole,
        false => fps,
    };
    contents.entries = rows.into_iter().map(|(entry, _)| entry).collect();
    contents.is_unnamed = false;
    contents.unit = contents.unit.or(Some(Unit::Meter));
    contents.fps = contents.fps.or(Some(fps));
    contents.notes.push(format!(
        "its eight columns are taken as frame, id, x, z, y and velocities, as in obsmat.txt, whose velocities are \
         those at {fps} frames per second"
    ));
}

impl Tracks {
    /// The tracks with ids and frames in the other order, and a note, if people move as people only in this one.
    pub(super) fn frame_first(&self, contents: &mut Contents) -> Option<Self> {
        let speed = self.median_speed();
        if speed <= TOO_FAST || !swap(contents) {
            return None;
        }
        let other = Self::of_sorted(contents, self.fps);
        let [own, others] = [self, &other].map(straightness);
        let slower = other.median_speed();
        let is_plausible = slower <= TOO_FAST && others >= own;
        if 2.0 * slower < speed && (is_plausible || others > own + STRAIGHTER) {
            contents.notes.push(format!(
                "its columns are taken as frame, id, x, y: people walk at {slower:.2} m/s then, and at {speed:.2} m/s \
                 if the first column is the id; a line `# id frame x/m y/m` above them names the columns"
            ));
            return Some(other);
        }
        swap(contents);
        None
    }
}

/// Swaps ids and frames, and sorts again. Returns whether that is possible.
fn swap(contents: &mut Contents) -> bool {
    let frames = -super::tracks::LAST_FRAME..=super::tracks::LAST_FRAME;
    if contents
        .entries
        .iter()
        .any(|entry| !frames.contains(&entry.id))
    {
        return false;
    }
    for entry in &mut contents.entries {
        std::mem::swap(&mut entry.id, &mut entry.frame);
    }
    contents.order();
    true
}

/// The median cosine of the angle between two successive steps of a person; −1 without steps.
fn straightness(tracks: &Tracks) -> f64 {
    let cosines = (0..tracks.ids.len()).flat_map(|p| {
        tracks.rows_of(p).windows(3).filter_map(|rows| {
            let [a, b, c] = [0, 1, 2].map(|k| tracks.position[rows[k] as usize]);
            let (first, second) = (b - a, c - b);
            let lengths = first.norm() * second.norm();
            (lengths > 0.0).then(|| first.dot(&second) / lengths)
        })
    });
    // To so many digits that rounding decides nothing.
    median(cosines.collect()).map_or(-1.0, |cosine| (1e6 * cosine).round() / 1e6)
}

/// The median; `None` of no values.
pub fn median(mut values: Vec<f64>) -> Option<f64> {
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}
