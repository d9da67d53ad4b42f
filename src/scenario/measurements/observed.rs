//! Where measurements are taken, as pictures and recordings show it.

use std::fmt;

use super::Measurement;
use crate::keys::shapes::Corners;
use engine::math::Vector;
use engine::scene::Region;

/// Where a measurement observes people.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Observed {
    /// A rectangle.
    Region(Region),
    /// A line between two points, meters.
    Line([Vector; 2]),
}

impl Observed {
    /// The region that the key `key` gives, if it does.
    pub(super) fn region(key: &'static str, region: Option<Corners>) -> Vec<(&'static str, Self)> {
        let region = region.map(|corners| (key, Self::Region(corners.into())));
        region.into_iter().collect()
    }

    /// The smallest rectangle around it.
    pub(crate) fn bounds(&self) -> Region {
        match *self {
            Self::Region(region) => region,
            Self::Line([start, end]) => Region {
                min: start.inf(&end),
                max: start.sup(&end),
            },
        }
    }

    /// Its outline, closed, or the line, meters.
    pub fn outline(&self) -> Vec<Vector> {
        match self {
            Self::Line(ends) => ends.to_vec(),
            Self::Region(region) => {
                let corners = region.corners();
                corners.into_iter().chain([corners[0]]).collect()
            }
        }
    }
}

impl fmt::Display for Observed {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let (kind, [from, to]) = match *self {
            Self::Region(Region { min, max }) => ("the rectangle", [min, max]),
            Self::Line(ends) => ("the line", ends),
        };
        write!(
            f,
            "{kind} from ({}, {}) to ({}, {}) m",
            from.x, from.y, to.x, to.y
        )
    }
}

impl Measurement {
    /// The line and the regions that it observes; the first with the words that the names of its values begin with, the
    /// others without a name.
    pub fn observed(&self) -> Vec<(String, Observed)> {
        let common = common_words(&self.names());
        let place = |(k, (key, place)): (usize, (&'static str, Observed))| {
            let kind = key.split('.').next().unwrap_or(key).replace('_', " ");
            let name = match (k, common.is_empty()) {
                (0, true) => kind,
                (0, false) => common.clone(),
                _ => String::new(),
            };
            (name, place)
        };
        let places = self.places().into_iter().enumerate();
        places.map(place).collect()
    }
}

/// The words that all names begin with, without underscores; of a single name all words.
fn common_words(names: &[String]) -> String {
    let mut names = names.iter().map(|name| name.split('_'));
    let mut common: Vec<&str> = names.next().into_iter().flatten().collect();
    for other in names {
        let equal = common.iter().zip(other).take_while(|(a, b)| *a == b);
        common.truncate(equal.count());
    }
    common.join(" ")
}
