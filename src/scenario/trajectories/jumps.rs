//! Ids that are used again: jumps that no person makes.

use super::tracks::{Contents, Tracks};

/// Nobody is faster, m/s: the fastest sprint is 12.4 m/s.
const FASTEST: f64 = 12.5;
/// Tracking errs by decimeters; farther than this, meters, another person is meant.
const FARTHEST: f64 = 1.0;
/// If more moves than this part are jumps, something else is wrong with the file.
const MOST: f64 = 0.05;

impl Tracks {
    /// The tracks with a new person after each jump, if jumps are rare, and a note; `None` without jumps. `contents`
    /// are those of the tracks.
    pub(super) fn parted(&self, contents: &mut Contents) -> Option<(Option<Self>, String)> {
        let all = (0..self.ids.len()).flat_map(|p| self.moves(p).map(move |rows| (p, rows)));
        let jumps: Vec<(usize, [usize; 2])> = all.filter(|(_, rows)| self.is_jump(*rows)).collect();
        let &(p, [from, to]) = jumps.first()?;
        let (count, moves) = (jumps.len(), self.len() - self.ids.len());
        let [start, end] = [from, to].map(|row| self.time(self.frame_of(row)));
        let way = (self.position[to] - self.position[from]).norm();
        let about = format!(
            "{count} jump(s) that no person makes, the first by person {} by {way:.2} m from {start:.2} to {end:.2} s",
            self.ids[p]
        );
        if count as f64 > MOST * moves as f64 && count > 1 {
            let note =
                format!("{about}; check the unit, the frame rate and the order of the columns");
            return Some((None, note));
        }
        let mut unused = self.unused_ids();
        let mut own_ids = self.own_ids.clone();
        for (p, [_, to]) in jumps {
            let id = unused.next()?;
            own_ids.insert(id, self.ids[p]);
            let rows = self.rows_of(p).iter().map(|&row| row as usize);
            rows.filter(|&row| row >= to)
                .for_each(|row| contents.entries[row].id = id);
        }
        contents.order();
        let mut parts = Self::of_sorted(contents, self.fps);
        let first = own_ids.keys().next().copied().unwrap_or_default();
        parts.own_ids = own_ids;
        let note = format!(
            "{about}: an id is used again; what follows a jump counts as another person, with a new id from {first} on"
        );
        Some((Some(parts), note))
    }

    fn is_jump(&self, [from, to]: [usize; 2]) -> bool {
        let way = (self.position[to] - self.position[from]).norm();
        let secs = self.time(self.frame_of(to) - self.frame_of(from));
        way > FARTHEST && way > FASTEST * secs
    }

    /// Ids that nobody has: those after the last, then others from 0 on.
    fn unused_ids(&self) -> impl Iterator<Item = i64> + '_ {
        let last = self.ids.last().copied().unwrap_or(0);
        let after = last.saturating_add(1).max(0)..=i64::MAX;
        let all = after.chain(0..=i64::MAX);
        all.filter(|id| self.ids.binary_search(id).is_err())
    }
}
