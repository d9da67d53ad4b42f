//! The key `seeds`: a number of seeds, or a list of them.

use std::collections::HashSet;
use std::fmt;

use serde::de::value::SeqAccessDeserializer;
use serde::de::{Deserialize, Deserializer, Error, SeqAccess, Unexpected, Visitor};

use crate::scenario::Problem;

/// The seeds as written.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::lab) enum Seeds {
    /// The seeds 1, 2, … up to this number.
    Count(u64),
    /// These seeds.
    List(Vec<u64>),
}

impl Seeds {
    /// All seeds, after validation; at most `most` are allowed.
    pub(in crate::lab) fn all(&self, most: usize) -> Result<Vec<u64>, Problem> {
        let (count, least) = match self {
            Self::Count(count) => (*count, "must be at least 1"),
            Self::List(list) => (list.len() as u64, "must not be empty"),
        };
        if count == 0 {
            return Err(Problem::new("seeds", least));
        }
        if count > most as u64 {
            return Err(Problem::new("seeds", format!("must be at most {most}")));
        }
        let Self::List(list) = self else {
            return Ok((1..=count).collect());
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
        deserializer.deserialize_any(SeedsVisitor)
    }
}

struct SeedsVisitor;

impl<'de> Visitor<'de> for SeedsVisitor {
    type Value = Seeds;

    fn expecting(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str("how many seeds, or a list of them")
    }

    fn visit_u64<E>(self, count: u64) -> Result<Seeds, E> {
        Ok(Seeds::Count(count))
    }

    fn visit_i64<E: Error>(self, count: i64) -> Result<Seeds, E> {
        Err(E::invalid_value(Unexpected::Signed(count), &self))
    }

    fn visit_seq<A: SeqAccess<'de>>(self, items: A) -> Result<Seeds, A::Error> {
        Vec::deserialize(SeqAccessDeserializer::new(items)).map(Seeds::List)
    }
}
