//! The key `seeds`: a number of seeds, or a list of them.

use std::collections::HashSet;

use serde::de::{Deserialize, Deserializer, Error, Unexpected};
use serde_untagged::UntaggedEnumVisitor;

use scenario::Problem;

/// The seeds as written.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Seeds {
    /// The seeds 1, 2, … up to this number.
    Count(u64),
    /// These seeds.
    List(Vec<u64>),
    /// As many seeds from this one on; 0 follows the largest one. A file cannot say this.
    From {
        /// The first seed.
        first: u64,
        /// The number of seeds.
        count: u64,
    },
}

impl Seeds {
    /// As many seeds as these, from `first` on.
    pub(crate) fn from(&self, first: u64) -> Self {
        let count = match self {
            Self::Count(count) | Self::From { count, .. } => *count,
            Self::List(list) => list.len() as u64,
        };
        Self::From { first, count }
    }

    /// All seeds, after validation; at most `most` are allowed.
    pub(crate) fn all(&self, most: usize) -> Result<Vec<u64>, Problem> {
        let (count, least) = match self {
            Self::Count(count) | Self::From { count, .. } => (*count, "must be at least 1"),
            Self::List(list) => (list.len() as u64, "must not be empty"),
        };
        if count == 0 {
            return Err(Problem::new("seeds", least));
        }
        if count > most as u64 {
            return Err(Problem::new("seeds", format!("must be at most {most}")));
        }
        let list = match self {
            Self::Count(count) => return Ok((1..=*count).collect()),
            Self::From { first, .. } => {
                return Ok((0..count).map(|k| first.wrapping_add(k)).collect());
            }
            Self::List(list) => list,
        };
        let mut seen = HashSet::new();
        match list.iter().position(|seed| !seen.insert(seed)) {
            Some(k) => {
                let reason = format!("{} is given twice", list[k]);
                Err(Problem::new(format!("seeds[{k}]"), reason))
            }
            None => Ok(list.clone()),
        }
    }
}

impl<'de> Deserialize<'de> for Seeds {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        const EXPECTED: &str = "how many seeds, or a list of them";
        let negative = |count| Error::invalid_value(Unexpected::Signed(count), &EXPECTED);
        UntaggedEnumVisitor::new()
            .expecting(EXPECTED)
            .u64(|count| Ok(Self::Count(count)))
            .i64(|count| Err(negative(count)))
            .seq(|list| list.deserialize().map(Self::List))
            .deserialize(deserializer)
    }
}
