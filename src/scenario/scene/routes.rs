//! Routes around walls: the floor of a scene, and the path maps to its goals.

use std::collections::BTreeSet;
use std::sync::Arc;

use crate::error::Problem;
use crate::error::quote::shown;
use crate::file::File;
use crate::floor_plan::{Rings, free, outlines};
use crate::keys::goals::WayFinding;
use crate::scene::doors;
use crate::scene::origin::{Items, Member, Origins};
use crate::scene::places;
use crate::scene::reached::{Distances, Reached};
use crate::scene::widest::{Widest, passable};
use engine::agents::RADIUS_RANGE;
use engine::entrance::ScheduledAgent;
use engine::geometry::Area;
use engine::journeys::{Kind, Place};
use engine::math::{Vector, bounds};
use engine::routes::{Door, Floor, Goal as WayGoal, Rooms, Routes, WIDEST, WayError};
use engine::scene::{Goal, Scene};

/// The floor of a scene without walkable area reaches this far beyond everything in it, meters.
const MARGIN: f64 = 5.0;
/// The most goals with a path map.
const MOST_GOALS: usize = 1000;

/// Where an agent starts, and where it wants to go first.
pub struct Start {
    pub place: Vector,
    pub member: Member,
    pub to: To,
}

/// Where an agent wants to go first.
#[derive(Clone, Copy, PartialEq)]
pub enum To {
    /// A goal.
    Goal { goal: Vector },
    /// The first stage of a journey.
    Journey(u16),
    /// In a direction, without end.
    Away,
}

/// Adds the path maps to a scene that is otherwise complete, unless agents walk straight, and leaves of its places what
/// people can reach. `behind` are the floors behind exits and entrances. Adds notes about places that no agent can
/// choose, and exits off the floor.
pub fn add(
    (keys, items): (&File, &Items),
    scene: &mut Scene,
    behind: &Rings,
    notes: &mut Vec<String>,
) -> Result<(), Problem> {
    let distances = Distances::new(&items.origins(keys, scene));
    let places = scene.journeys.places.iter();
    let found = places.map(|place| distances.reached(place, &scene.walls));
    let reached: Vec<Reached> = found.collect();
    for (place, reached) in scene.journeys.places.iter_mut().zip(&reached) {
        place.goals.clone_from(&reached.goals);
    }
    scene.routes = routes(items.origins(keys, scene), &reached, behind, notes)?;
    if scene.routes.is_some() {
        distances.check(&scene.journeys.places, &reached)?;
    }
    Ok(())
}

/// The path maps of a scene; `None` if agents walk straight.
fn routes(
    origins: Origins,
    reached: &[Reached],
    behind: &Rings,
    notes: &mut Vec<String>,
) -> Result<Option<Arc<Routes>>, Problem> {
    let Origins { keys, scene, .. } = origins;
    let has_journeys = scene.groups.iter().any(|group| group.journey.is_some());
    check_navigation(keys, scene, has_journeys)?;
    let is_straight = keys.navigation == WayFinding::Straight;
    if is_straight || (scene.walls.is_empty() && !has_journeys) {
        return Ok(None);
    }
    let starts = starts(scene);
    let goals = goals(&starts);
    if goals.len() > MOST_GOALS {
        if floor_of(scene, &starts, 0.0)?.corners.is_empty() {
            return Ok(None);
        }
        let reason = format!(
            "agents walk to more than {MOST_GOALS} different goals, and walls can stand between; give agents a common \
             goal, or set `navigation` to `straight`"
        );
        return Err(Problem::new("goal", reason));
    }
    let places = if has_journeys || !keys.doors.is_empty() {
        &scene.journeys.places[..]
    } else {
        &[]
    };
    if goals.is_empty() && places.is_empty() {
        return Ok(None);
    }
    let prepared = Prepared {
        scene,
        origins,
        starts: &starts,
        places,
        reached,
        goals: &goals,
        width: passable(&origins).unwrap_or_default(),
        is_given: keys.min_passage_width.is_some(),
        widest: Widest::all(scene, &origins),
    };
    let mut routes = prepared.routes(prepared.width)?;
    if scene.by_time() || !keys.doors.is_empty() {
        let rooms = prepared.rooms(&routes)?;
        routes.divide(rooms);
    }
    prepared.check_goals(&routes)?;
    let stops = prepared.check_journeys(&routes, notes)?;
    notes.extend(doors::notes(places, &routes.floor, behind));
    notes.extend(doors::doubled(places));
    prepared.check_bodies(&routes.floor, &stops, notes)?;
    // Where nothing can stand between a place of the floor and a goal, agents walk straight.
    let is_needed =
        has_journeys || !keys.doors.is_empty() || scene.levels.is_some() || routes.bend();
    Ok(is_needed.then(|| Arc::new(routes)))
}

/// Refuses exits to which nobody walks, and with `straight` what needs `paths`.
fn check_navigation(keys: &File, scene: &Scene, has_journeys: bool) -> Result<(), Problem> {
    if !keys.exits.is_empty() && !scene.groups.is_empty() && !has_journeys {
        let reason =
            "no agent walks to an exit: all have goals; remove `goal`, or give agents a `journey`";
        return Err(Problem::new("exits", reason));
    }
    if keys.navigation == WayFinding::Straight {
        for (key, is_given) in [
            ("route_choice", scene.by_time()),
            ("doors", !keys.doors.is_empty()),
            ("levels", scene.levels.is_some()),
        ] {
            if is_given {
                let reason = "needs `navigation` `paths`; remove it, or `navigation`";
                return Err(Problem::new(key, reason));
            }
        }
        let reason = "`straight` leads to goals only; journeys and exits need `paths`";
        if has_journeys {
            return Err(Problem::new("navigation", reason));
        }
    }
    Ok(())
}

/// The floor of a scene that has no path maps, for goals that agents get later; `width`: the least of passages.
pub fn floor(scene: &Scene, width: f64) -> Result<Routes, Problem> {
    let floor = floor_of(scene, &starts(scene), width)?;
    Routes::new(floor, &[], Vec::new()).map_err(unusable)
}

fn floor_of(scene: &Scene, starts: &[Start], width: f64) -> Result<Floor, Problem> {
    let areas = areas(scene, starts)?;
    let floor = match &scene.levels {
        Some(levels) => Floor::on_levels(&areas, width, levels.clone()),
        None => Floor::new(&areas, width),
    };
    floor.map_err(unusable)
}

/// The goals that may need path maps: all of them.
fn goals(starts: &[Start]) -> Vec<Vector> {
    let mut seen = BTreeSet::new();
    let goals = starts.iter().filter_map(|start| match start.to {
        To::Goal { goal } => Some(goal),
        To::Journey(_) | To::Away => None,
    });
    let is_new = |goal: &Vector| seen.insert([goal.x, goal.y].map(f64::to_bits));
    goals.filter(is_new).collect()
}

/// What routes are computed from.
pub struct Prepared<'a> {
    pub scene: &'a Scene,
    pub origins: Origins<'a>,
    pub starts: &'a [Start],
    pub places: &'a [Place],
    /// What people can reach of each place.
    pub reached: &'a [Reached],
    pub goals: &'a [Vector],
    /// Narrower passages are closed, meters.
    pub width: f64,
    /// Whether the file gives this width.
    pub is_given: bool,
    /// The widest bodies.
    pub widest: Vec<Widest>,
}

impl Prepared<'_> {
    /// The floor on which passages narrower than `width` meters are closed.
    pub fn floor(&self, width: f64) -> Result<Floor, Problem> {
        floor_of(self.scene, self.starts, width)
    }

    /// The routes through passages of at least `width` meters.
    pub fn routes(&self, width: f64) -> Result<Routes, Problem> {
        let floor = self.floor(width)?;
        doors::check(self.places, &floor)?;
        let goals = self.places.iter().map(|place| place.goals.clone());
        let places: Vec<_> = goals.collect();
        Routes::new(floor, &places, self.goals.to_vec()).map_err(|error| match error {
            WayError::NotOnFloor(point) => self.not_on_floor(point),
            error => unusable(error),
        })
    }

    /// The rooms of the floor of `routes`, with routes to the same goals.
    fn rooms(&self, routes: &Routes) -> Result<Rooms, Problem> {
        let lines_of_doors = self.places.iter().zip(0..).filter_map(|(place, number)| {
            let Kind::Door(door) = &place.kind else {
                return None;
            };
            Some(Door {
                line: doors::up_to_walls(door.line, &self.scene.walls),
                place: number,
                one_way: door.one_way,
            })
        });
        let doors: Vec<Door> = lines_of_doors.collect();
        let goals = routes
            .goals()
            .iter()
            .map(|&goal| vec![WayGoal::Point(goal)]);
        let places = self.places.iter().map(|place| place.goals.clone());
        let goals: Vec<_> = places.chain(goals).collect();
        let areas = areas(self.scene, self.starts)?;
        let floor = (&areas[..], self.scene.levels.as_ref());
        let mut widths = [WIDEST, f64::INFINITY].into_iter();
        loop {
            let widest = widths.next().unwrap_or(f64::INFINITY);
            let rooms =
                Rooms::new(floor, [self.width, widest], &doors, &goals).map_err(|error| {
                    let of_doors = match error {
                        WayError::Crossing(at) => doors::crossing(self.places, at),
                        _ => None,
                    };
                    of_doors.unwrap_or_else(|| unusable(error))
                })?;
            let lost = doors.iter().position(|door| !rooms.has_door(door.place));
            match lost {
                None => return Ok(rooms),
                Some(_) if widest.is_finite() => {}
                Some(k) => {
                    let name = shown(&self.places[usize::from(doors[k].place)].name);
                    let reason = format!(
                        "people can walk around `{name}`: it does not lie between two parts of the floor; draw it from \
                         wall to wall across a passage"
                    );
                    return Err(Problem::new(format!("doors[{k}].line"), reason));
                }
            }
        }
    }

    fn not_on_floor(&self, point: Vector) -> Problem {
        let lies = "lies in an obstacle or outside of the walkable area; move it onto the floor";
        let has_point = |place: &Place| {
            place.goals.iter().any(|goal| match *goal {
                WayGoal::Point(p) => p == point,
                WayGoal::Line([a, _]) => a == point,
            })
        };
        if let Some(k) = self.places.iter().position(has_point) {
            let reason = format!("`{}` {lies}", shown(&self.places[k].name));
            return Problem::new(places::key(self.places, k), reason);
        }
        let is_goal = |start: &&Start| matches!(start.to, To::Goal { goal } if goal == point);
        let member = self.starts.iter().find(is_goal).map(|start| start.member);
        let key = member.map_or("goal".to_owned(), |member| self.origins.goal_key(member));
        let of = member.map_or(String::new(), |of| self.origins.name(of));
        let reason = format!(
            "({}, {}), the goal of {of}, {lies}, or set `navigation` to `straight`",
            point.x, point.y
        );
        Problem::new(key, reason)
    }
}

fn unusable(error: WayError) -> Problem {
    if let WayError::Join(_) = error {
        let reason = format!("{error}: it must be an edge of both, without gaps and walls");
        return Problem::new("joins", reason);
    }
    let reason = format!(
        "no routes can be found: {error}; mend the plan, or set `navigation` to `straight`"
    );
    Problem::new("walkable_area", reason)
}

/// The starts of all agents that enter, with the places to which agents in obstacles are moved.
fn starts(scene: &Scene) -> Vec<Start> {
    let free = |p: Vector| {
        let inside = scene.walls.obstacle_at(p).is_some();
        let free = inside.then(|| scene.walls.free_point_near(p)).flatten();
        free.unwrap_or(p)
    };
    let mut starts: Vec<Start> = Vec::new();
    let mut add = |place: Vector, member: Member, goal: Vector| {
        let group = &scene.groups[usize::from(member.group)];
        starts.push(Start {
            place: free(place),
            member,
            to: match (group.journey, group.direction) {
                (Some(journey), _) => To::Journey(journey),
                (None, Some(_)) => To::Away,
                (None, None) => To::Goal { goal },
            },
        });
    };
    let later = |group: u16| Member { agent: None, group };
    for (k, agent) in scene.agents.iter().enumerate() {
        let member = Member {
            agent: Some(k),
            group: agent.group,
        };
        add(agent.position, member, agent.goal);
    }
    for source in &scene.sources {
        for start in source.grid.positions(scene.seed, 0) {
            let goal = match source.goal {
                Goal::Point(goal) => goal,
                Goal::Offset(offset) => start + offset,
            };
            add(start, later(source.group), goal);
        }
    }
    for ScheduledAgent { agent, .. } in &scene.scheduled {
        add(agent.position, later(agent.group), agent.goal);
    }
    for entrance in &scene.entrances {
        let nobody = std::iter::empty();
        let parts = entrance.free(RADIUS_RANGE[0], &scene.walls, nobody);
        for [from, to] in parts {
            let middle = entrance.at(0.5 * (from + to));
            add(middle, later(entrance.group), entrance.goal);
        }
    }
    starts
}

/// The floor: the walkable area, or a rectangle around everything, without obstacles.
fn areas(scene: &Scene, starts: &[Start]) -> Result<Vec<Area>, Problem> {
    let (floors, bodies) = outlines(scene.walls.obstacles());
    let corners = scene.walls.iter().map(|wall| wall.start);
    let ends = starts.iter().flat_map(|start| match start.to {
        To::Goal { goal } => [start.place, goal],
        To::Journey(_) | To::Away => [start.place; 2],
    });
    let goals = scene.journeys.places.iter().flat_map(|place| &place.goals);
    let places = goals.flat_map(|goal| match *goal {
        WayGoal::Point(p) => [p; 2],
        WayGoal::Line(ends) => ends,
    });
    let [low, high] = bounds(corners.chain(ends).chain(places)).unwrap_or_default();
    let margin = Vector::repeat(MARGIN);
    let (low, high) = (low - margin, high + margin);
    let rectangle = vec![
        low,
        Vector::new(high.x, low.y),
        high,
        Vector::new(low.x, high.y),
    ];
    let everything: [Rings; 1] = [vec![rectangle]];
    let floors = if floors.is_empty() {
        &everything[..]
    } else {
        &floors
    };
    free(floors, &bodies).map_err(|error| Problem::new("obstacles", error.to_string()))
}
