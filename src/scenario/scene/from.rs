//! The people of `from` in a scene.

use crate::error::{Problem, Under};
use crate::keys::from::{FROM, FromData, Person};
use crate::scene::people::Population;
use crate::scene::target::Target;
use engine::agents::NewAgent;
use engine::entrance::ScheduledAgent;

impl Population<'_> {
    /// Adds the people of `from`.
    pub fn add_data(&mut self, given: &FromData) -> Result<(), Problem> {
        for (k, person) in given.people().iter().enumerate() {
            person.check().under(&format!("people[{k}]"))?;
        }
        self.check_floor(given.people())?;
        let name = given.name.as_deref().unwrap_or(FROM);
        let (group, target) = self.people(name, &given.all, None)?;
        let agent = |person: &Person| agent(person, &target, group);
        let people = given.people().iter();
        let (there, mut later): (Vec<&Person>, Vec<&Person>) =
            people.partition(|person| person.enters() <= 0.0);
        if self.scene.period.is_some() && !later.is_empty() {
            let reason = format!(
                "in a periodic scene none come in, and {} people appear after the start; set `until_secs` to `at_secs`",
                later.len()
            );
            return Err(Problem::new("", reason));
        }
        later.sort_by(|a, b| a.enters().total_cmp(&b.enters()));
        let mut faster = 0;
        for person in &there {
            let id = self.scene.agents.len() as u32;
            let mut slowed = self.scene.slowed(agent(person), id);
            slowed.mean_density = given.mean_density;
            faster += usize::from(slowed.velocity != person.velocity());
            self.scene.agents.push(slowed);
        }
        if faster > 0 {
            self.notes.push(format!(
                "{faster} of {} people of `{FROM}` are faster at the start than `max_speed` allows, and are slowed to \
                 it",
                there.len()
            ));
        }
        let scheduled = |person: &Person| ScheduledAgent {
            at: person.enters(),
            agent: agent(person),
        };
        self.scene
            .scheduled
            .extend(later.into_iter().map(scheduled));
        Ok(())
    }

    /// Checks that no agent begins in a wall: data and walls would not belong together.
    fn check_floor(&self, people: &[Person]) -> Result<(), Problem> {
        let walls = &self.scene.walls;
        let place = |person: &Person| match self.scene.period {
            Some(period) => period.wrapped(person.position()).0,
            None => person.position(),
        };
        let within = |person: &&Person| walls.obstacle_at(place(person)).is_some();
        let Some(first) = people.iter().find(within) else {
            return Ok(());
        };
        let reason = format!(
            "{first} is in an obstacle or outside of the walkable area, as {} of {} people are; mend the walls, or \
             choose `unit`, the origin and `until_secs` to fit them",
            people.iter().filter(within).count(),
            people.len()
        );
        Err(Problem::new("", reason))
    }
}

fn agent(person: &Person, target: &Target, group: u16) -> NewAgent {
    let position = person.position();
    NewAgent {
        velocity: person.velocity(),
        ..NewAgent::at(position, target.goal_from(position), group)
    }
}
