//! Crowds: agents that stand anywhere in an area at the start.

use crate::error::{Problem, Under};
use crate::floor_plan::{free, outlines, rings};
use crate::keys::people::{Crowd, Spacing};
use crate::keys::shapes::Outline;
use crate::scene::crossed;
use crate::scene::off_floor::OFF;
use crate::scene::people::Population;
use crate::scene::surroundings;
use engine::agents::{NewAgent, RADIUS_RANGE};
use engine::geometry::Area;
use engine::math::{Vector, bounds};
use engine::packing::{self, Body, Space};
use engine::period::Period;
use engine::random::{self, Purpose};
use engine::scene::Region;

/// The most parts of an area whose agents a note counts.
const MOST_COUNTS: usize = 4;
/// Crowds are noted if less than this part of their area is free floor.
const MOSTLY_OFF: f64 = 0.25;
/// Walls are looked for in areas of which more than this part is free floor; others wind around them.
const MOSTLY_FREE: f64 = 0.5;
/// The share of radii that may be smaller than assumed.
const RARE: f64 = 1e-6;

/// A note if walls divide the free area of the crowd `name`, whose agents stand at `places`.
fn divided(areas: &[Area], places: &[Vector], name: &str) -> Option<String> {
    if areas.len() < 2 {
        return None;
    }
    let there = |area: &Area| places.iter().filter(|&&p| area.contains(p)).count();
    let mut counts: Vec<usize> = areas.iter().map(there).filter(|&one| one > 0).collect();
    counts.sort_unstable_by(|a, b| b.cmp(a));
    (counts.len() > 1).then(|| {
        let parts = counts.len();
        let mut counts: Vec<String> = counts.iter().take(MOST_COUNTS).map(usize::to_string).collect();
        counts.extend((parts > MOST_COUNTS).then(|| "…".to_owned()));
        let counts = counts.join(", ");
        format!(
            "{name}.area: walls divide it into {parts} parts, with {counts} agents; draw it within one room if they \
             should stand in one"
        )
    })
}

impl Population<'_> {
    /// Adds the agents of crowd `index`.
    pub fn crowd(&mut self, given: &Crowd, index: u32, place: &str) -> Result<(), Problem> {
        let areas = self.free_area(&given.area).under("area")?;
        let size: f64 = areas.iter().map(Area::area).sum();
        let number = match (given.number, given.density) {
            (Some(number), None) => number as usize,
            (None, Some(density)) => (density * size).round() as usize,
            _ => {
                return Err(Problem::new(
                    "",
                    "needs `number` or `density`, and not both",
                ));
            }
        };
        self.note_bodies();
        let name = given.name.as_deref().unwrap_or(place);
        let (group, target) = self.people(name, &given.people, None)?;
        let traits = &self.scene.groups[usize::from(group)].traits;
        let (seed, first) = (self.scene.seed, self.scene.agents.len() as u32);
        let space = Space::new(&areas, &self.scene.walls, self.scene.period);
        let radius = traits.radius.as_ref();
        let least = radius.map_or(RADIUS_RANGE[0], |radius| radius.quantile(RARE));
        // A few of too many agents are enough to find out how many fit.
        let tried = number.min(space.capacity(least));
        let radii = (first..).take(tried).map(|id| traits.radius_of(seed, id));
        let radii: Vec<f64> = radii.collect();
        let found = match given.spacing {
            Spacing::Random => {
                let mut random = random::stream(seed, Purpose::Crowd, index, 0);
                packing::scattered(&space, &self.bodies, &radii, &mut random)
            }
            Spacing::Grid => packing::lattice(&space, &self.bodies, &radii),
        };
        let all = |places: Vec<Vector>| match tried < number {
            true => Err(tried),
            false => Ok(places),
        };
        let places = found.and_then(all).map_err(|fitting| {
            let crowded = self.too_many(given.spacing, &areas, fitting);
            Problem::new("", format!("{number} agents do not fit: {crowded}"))
        })?;
        self.note_area(&given.area, &areas, &places, place)?;
        let agents = places.into_iter().zip(radii);
        self.scene
            .agents
            .extend(agents.map(|(place, radius)| NewAgent {
                radius: Some(radius),
                ..NewAgent::at(place, target.goal_from(place), group)
            }));
        Ok(())
    }

    /// How many agents fit into `areas`, and what to change.
    fn too_many(&self, spacing: Spacing, areas: &[Area], fitting: usize) -> String {
        let (at, advice) = match spacing {
            Spacing::Random => ("at random places ", ", or set `spacing` to `grid`"),
            Spacing::Grid => ("", ""),
        };
        let inside = |body: &&Body| areas.iter().any(|area| area.contains(body.place));
        let others = match self.bodies.iter().filter(inside).count() {
            0 => String::new(),
            others => format!(", beside {others} others that start there"),
        };
        let size: f64 = areas.iter().map(Area::area).sum();
        format!(
            "about {fitting} stand {at}side by side in the {size:.1} m² of floor of the area{others}; use fewer, a \
             larger area or a smaller `radius`{advice}"
        )
    }

    /// Adds notes on an area that walls divide, that is hardly free, or that lies off the floor in part. `free` are its
    /// free parts, and agents stand at `places`.
    fn note_area(
        &mut self,
        drawn: &Outline,
        free: &[Area],
        places: &[Vector],
        place: &str,
    ) -> Result<(), Problem> {
        let whole = surroundings::area(drawn.rings()).under("area")?.area();
        let size: f64 = free.iter().map(Area::area).sum();
        self.notes.extend(match free.len() {
            1 if size > MOSTLY_FREE * whole => {
                crossed::note(&self.scene.walls, drawn, places, place)
            }
            _ => divided(free, places, place),
        });
        self.notes.extend(match size < MOSTLY_OFF * whole {
            true => Some(format!(
                "{place}.area: {size:.1} m² of its {whole:.1} m² are free floor, and all its agents start there; \
                 check that it is where it should be"
            )),
            false => crossed::beyond(self.file, drawn, place),
        });
        Ok(())
    }

    /// The part of an area outside of all obstacles and inside of the walkable area as it is given, without the floors
    /// behind exits, and inside of the period.
    fn free_area(&self, given: &Outline) -> Result<Vec<Area>, Problem> {
        let area = surroundings::area(given.rings())?;
        let own = rings(&[area]);
        let (mut floors, mut bodies) = outlines(self.scene.walls.obstacles());
        bodies.extend(self.behind.iter().cloned());
        if let Some(period) = &self.scene.period {
            let corners = bounds(own.iter().flatten().copied()).unwrap_or_default();
            let [min, max] = period.clipped(corners);
            floors.push(vec![Region { min, max }.corners().to_vec()]);
        }
        floors.insert(0, own);
        let areas = free(&floors, &bodies).map_err(|error| Problem::new("", error.to_string()))?;
        match areas.is_empty() {
            false => Ok(areas),
            true => Err(Problem::new("", OFF)),
        }
    }

    /// Notes the bodies of the agents that have been added since.
    pub fn note_bodies(&mut self) {
        let scene = &self.scene;
        let new = scene.agents.iter().enumerate().skip(self.bodies.len());
        self.bodies.extend(new.map(|(id, agent)| {
            let traits = &scene.groups[usize::from(agent.group)].traits;
            let wrapped = |period: Period| period.wrapped(agent.position).0;
            let drawn = || traits.radius_of(scene.seed, id as u32);
            Body {
                place: scene.period.map_or(agent.position, wrapped),
                radius: agent.radius.unwrap_or_else(drawn),
            }
        }));
    }
}
