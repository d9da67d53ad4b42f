//! What people can reach of places: the parts of lines and areas that their bodies do not fit to are no goals.

use crate::error::Problem;
use crate::error::quote::{shown, to_centimeters};
use crate::scene::origin::Origins;
use crate::scene::widest::{SIDEWAYS, Widest, passable};
use engine::geometry::{LineAmongWalls, Walls};
use engine::journeys::{Kind, Place};
use engine::math::Vector;
use engine::routes::Goal;

/// What people can reach of a place.
pub struct Reached {
    /// The points and lines to which they walk.
    pub goals: Vec<Goal>,
    /// Points on each part, of which routes lead from all or none.
    pub stands: Vec<Vector>,
    /// Whether they can reach some of it.
    pub is_any: bool,
}

/// The least distances of the centers of bodies from walls, meters.
#[derive(Clone, Copy)]
pub struct Distances {
    /// Half of the width of the widest body.
    body: f64,
    /// Half of the width of the narrowest passage.
    gap: f64,
}

impl Distances {
    pub fn new(origins: &Origins) -> Self {
        let gap = 0.5 * passable(origins).unwrap_or_default();
        let widest = Widest::all(origins.scene, origins).into_iter();
        Self {
            body: widest.map(|widest| 0.5 * widest.alone).fold(gap, f64::max),
            gap,
        }
    }

    /// With turned shoulders.
    fn sideways(self) -> Self {
        Self {
            body: SIDEWAYS * self.body,
            gap: SIDEWAYS * self.gap,
        }
    }

    /// What people can reach of a place. Those who can reach nothing walk with turned shoulders.
    pub fn reached(self, place: &Place, walls: &Walls) -> Reached {
        let found = [self, self.sideways()].map(|distances| distances.parts(place, walls));
        let [upright, sideways] = found;
        let mut reached = match upright.is_any {
            true => upright,
            false => sideways,
        };
        match &place.kind {
            Kind::Waiting(waiting) => {
                reached.stands.extend(&waiting.spots);
                reached.is_any = true;
            }
            Kind::Disk { at, within } => {
                let least = self.sideways().body;
                let mut near = Vec::new();
                walls.near(*at, least, &mut near);
                let distance = |&k: &u32| (walls.wall(k).nearest_point(*at).point - at).norm();
                reached.is_any = near.iter().map(distance).all(|away| away + within >= least);
            }
            _ => {}
        }
        if reached.goals.is_empty() {
            reached.goals.clone_from(&place.goals);
        }
        reached
    }

    fn parts(self, place: &Place, walls: &Walls) -> Reached {
        let (mut goals, mut stands) = (Vec::new(), Vec::new());
        for goal in &place.goals {
            match *goal {
                Goal::Point(point) => {
                    goals.push(goal.clone());
                    stands.push(point);
                }
                Goal::Line(ends) => {
                    let clear =
                        LineAmongWalls::new(ends, walls, self.body).clear(self.body, self.gap);
                    stands.extend(clear.middles);
                    match clear.parts {
                        None => goals.push(goal.clone()),
                        Some(parts) => goals.extend(parts.into_iter().map(Goal::Line)),
                    }
                }
            }
        }
        Reached {
            goals,
            is_any: !stands.is_empty(),
            stands,
        }
    }

    /// Refuses the first exit or waypoint that nobody can reach.
    pub fn check(self, places: &[Place], reached: &[Reached]) -> Result<(), Problem> {
        let [mut exits, mut waypoints] = [0, 0];
        for (place, reached) in places.iter().zip(reached) {
            let (list, count) = match place.kind {
                Kind::Exit(_) => ("exits", &mut exits),
                Kind::Line(_) | Kind::Disk { .. } => ("waypoints", &mut waypoints),
                _ => continue,
            };
            if !reached.is_any {
                let reason = format!(
                    "nobody can get to `{}`: it is nearer than {} m to walls, where no body fits; move it away from \
                     them",
                    shown(&place.name),
                    to_centimeters(self.sideways().body),
                );
                return Err(Problem::new(format!("{list}[{count}]"), reason));
            }
            *count += 1;
        }
        Ok(())
    }
}
