//! Entrances: lines through which agents come in.

use crate::error::Problem;
use crate::keys::people::{Arriving, Ends, Entrance};
use crate::scene::people::Population;
use engine::agents::RADIUS_RANGE;
use engine::entrance::{Arrivals, Entrance as Line, Flow};
use engine::math::Vector;

/// The part of all agents for which an entrance must be wide enough.
pub const NEARLY_ALL: f64 = 0.9999;

impl Entrance {
    fn arrivals(&self) -> Result<Arrivals, Problem> {
        let flow = match (self.per_sec, &self.at_secs) {
            (Some(per_sec), None) => Flow {
                per_sec,
                from: self.from_secs.unwrap_or(0.0),
                until: self.until_secs.unwrap_or(f64::INFINITY),
                number: self.number,
                first: 0,
                waited: 0.0,
            },
            (None, Some(times)) => {
                for (key, is_given) in [
                    ("arrivals", self.arrivals == Arriving::Poisson),
                    ("from_secs", self.from_secs.is_some()),
                    ("until_secs", self.until_secs.is_some()),
                    ("number", self.number.is_some()),
                ] {
                    if is_given {
                        let reason = "is for `per_sec`; `at_secs` has the time of each arrival";
                        return Err(Problem::new(key, reason));
                    }
                }
                let mut times = times.clone();
                times.sort_by(f64::total_cmp);
                return Ok(Arrivals::At(times));
            }
            _ => {
                return Err(Problem::new(
                    "",
                    "needs `per_sec` or `at_secs`, and not both",
                ));
            }
        };
        if flow.until <= flow.from {
            let reason = format!(
                "{} is not after from_secs {}; raise it, or lower from_secs",
                flow.until, flow.from
            );
            return Err(Problem::new("until_secs", reason));
        }
        Ok(match self.arrivals {
            Arriving::Constant => Arrivals::Constant(flow),
            Arriving::Poisson => Arrivals::Poisson(flow),
        })
    }
}

impl Population<'_> {
    /// Adds an entrance.
    pub fn entrance(&mut self, given: &Entrance, place: &str) -> Result<(), Problem> {
        let name = given.name.as_deref().unwrap_or(place).to_owned();
        let (group, target) = self.people(&name, &given.people, None)?;
        let widest = match &self.scene.groups[usize::from(group)].traits.radius {
            Some(radius) => radius.quantile(NEARLY_ALL),
            None => RADIUS_RANGE[1],
        };
        let Ends(ends) = given.line;
        let line: [Vector; 2] = ends.map(Into::into);
        if line[0] == line[1] {
            let reason = "its ends are the same point; move one";
            return Err(Problem::new("line", reason));
        }
        let entrance = Line {
            line,
            goal: target.goal_from((line[0] + line[1]) * 0.5),
            arrivals: given.arrivals()?,
            group,
            name,
        };
        let nobody = std::iter::empty();
        if entrance.free(widest, &self.scene.walls, nobody).is_empty() {
            let reason = format!(
                "no agent with a radius of {widest:.3} m can stand on it: obstacles are too near, or it lies outside \
                 of the walkable area; move or lengthen it"
            );
            return Err(Problem::new("line", reason));
        }
        self.scene.entrances.push(entrance);
        Ok(())
    }
}
