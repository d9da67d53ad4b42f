//! Lists of entries, in as little memory as their numbers need.

use super::targets::Entry;
use crate::math::bytes_of;

/// Entries one list after the other; the last of each list is marked.
#[derive(Debug, Clone)]
pub enum Lists {
    /// Target and borders; all numbers fit into 16 bits.
    Short(Vec<[u16; 3]>),
    /// Target and borders.
    Long(Vec<[u32; 3]>),
}

/// Marks the last entry of a list, in the number of its target.
const LAST_SHORT: u16 = 1 << 15;
const LAST_LONG: u32 = 1 << 31;

impl Lists {
    /// Empty lists, for entries whose numbers of targets and borders are below `targets` and `borders`.
    pub fn new(targets: usize, borders: usize) -> Self {
        let is_small = targets <= usize::from(LAST_SHORT) && borders <= 1 + usize::from(u16::MAX);
        match is_small {
            true => Self::Short(Vec::new()),
            false => Self::Long(Vec::new()),
        }
    }

    /// The number of entries in all lists.
    pub fn len(&self) -> usize {
        match self {
            Self::Short(all) => all.len(),
            Self::Long(all) => all.len(),
        }
    }

    /// Adds a list.
    pub fn add(&mut self, entries: &[Entry]) {
        let numbers = entries.iter().map(|entry| {
            let [right, left] = entry.borders;
            [entry.target, right, left]
        });
        match self {
            Self::Short(all) => {
                all.extend(numbers.map(|numbers| numbers.map(|number| number as u16)));
                all.last_mut()
                    .into_iter()
                    .for_each(|[target, ..]| *target |= LAST_SHORT);
            }
            Self::Long(all) => {
                all.extend(numbers);
                all.last_mut()
                    .into_iter()
                    .for_each(|[target, ..]| *target |= LAST_LONG);
            }
        }
    }

    /// Entry `k`, and whether it is the last of its list.
    #[inline]
    pub fn get(&self, k: usize) -> Option<(Entry, bool)> {
        let (target, borders, is_last) = match self {
            Self::Short(all) => {
                let &[target, right, left] = all.get(k)?;
                let borders = [right, left].map(u32::from);
                let number = u32::from(target & !LAST_SHORT);
                (number, borders, target & LAST_SHORT != 0)
            }
            Self::Long(all) => {
                let &[target, right, left] = all.get(k)?;
                (target & !LAST_LONG, [right, left], target & LAST_LONG != 0)
            }
        };
        Some((Entry { target, borders }, is_last))
    }

    /// The entries of the list that begins with entry `first`, with their numbers; empty beyond the last entry.
    #[inline]
    pub fn from(&self, first: usize) -> impl Iterator<Item = (usize, Entry)> {
        let mut next = Some(first);
        std::iter::from_fn(move || {
            let k = next?;
            let (entry, is_last) = self.get(k)?;
            next = (!is_last).then_some(k + 1);
            Some((k, entry))
        })
    }

    /// The entries of all lists.
    pub fn all(&self) -> impl Iterator<Item = Entry> {
        (0..self.len()).filter_map(|k| self.get(k).map(|(entry, _)| entry))
    }

    /// Releases unused memory.
    pub fn shrink(&mut self) {
        match self {
            Self::Short(all) => all.shrink_to_fit(),
            Self::Long(all) => all.shrink_to_fit(),
        }
    }

    /// The memory that it takes, bytes.
    pub fn bytes(&self) -> usize {
        match self {
            Self::Short(all) => bytes_of(all),
            Self::Long(all) => bytes_of(all),
        }
    }
}
