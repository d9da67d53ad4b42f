//! What becomes of a cut that is held while the crowd moves.

use sandbox::engine::agents::Agents;
use sandbox::engine::simulation::Simulation;
use sandbox::lab::bench::timing::ms_per_frame;
use sandbox::lab::error::LabError;
use serde::Serialize;

use super::cut::Cut;
use super::ratio;

/// The drift of one cut.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Drift {
    /// How long the cut is held, seconds.
    pub seconds: u64,
    /// Agents of the largest part over the mean, after one second.
    pub after_a_second: f64,
    /// The same at the end.
    pub at_the_end: f64,
    /// The share of the agents that are in another part than a second ago, on average.
    pub changes_per_second: f64,
}

/// No part: the agent had not entered yet.
const NOWHERE: u32 = u32::MAX;

/// A cut that is held.
struct Held<'a> {
    cut: &'a Cut,
    parts: usize,
    /// The part of each agent at the last look, by id.
    part_of: Vec<u32>,
    /// Looks at agents that were there at the look before, and those that had changed their part.
    looks: u64,
    changes: u64,
}

impl Held<'_> {
    /// Looks where the agents are; returns the agents of the largest part over the mean.
    fn look(&mut self, agents: &Agents) -> f64 {
        let mut counts = vec![0; self.parts];
        self.part_of.resize(agents.entered() as usize, NOWHERE);
        for (&id, part) in agents.id.iter().zip(self.cut.parts(&agents.position)) {
            counts[part as usize] += 1;
            let before = std::mem::replace(&mut self.part_of[id as usize], part);
            self.looks += u64::from(before != NOWHERE);
            self.changes += u64::from(before != NOWHERE && before != part);
        }
        ratio(&counts)
    }
}

/// Holds `cuts`, each with its number of parts, for some seconds of the simulation.
///
/// # Errors
/// The simulation fails.
pub fn follow(
    simulation: &mut Simulation,
    cuts: &[(Cut, usize)],
    seconds: u64,
) -> Result<Vec<Drift>, LabError> {
    let held = cuts.iter().map(|&(ref cut, parts)| Held {
        cut,
        parts,
        part_of: Vec::new(),
        looks: 0,
        changes: 0,
    });
    let mut held: Vec<Held> = held.collect();
    let look = |held: &mut [Held], simulation: &Simulation| -> Vec<f64> {
        let agents = simulation.frame().agents;
        held.iter_mut().map(|held| held.look(agents)).collect()
    };
    look(&mut held, simulation);
    let frames = simulation.frame().clock.frame_at(1.0);
    let mut ratios = Vec::new();
    for _ in 0..seconds {
        ms_per_frame(simulation, frames)?;
        ratios.push(look(&mut held, simulation));
    }
    let (first, last) = (ratios.first(), ratios.last());
    let drifts = held.iter().enumerate().map(|(k, held)| Drift {
        seconds,
        after_a_second: first.map_or(f64::NAN, |ratios| ratios[k]),
        at_the_end: last.map_or(f64::NAN, |ratios| ratios[k]),
        changes_per_second: held.changes as f64 / held.looks.max(1) as f64,
    });
    Ok(drifts.collect())
}

#[cfg(test)]
mod tests {
    use super::super::cut::Way;
    use super::*;
    use sandbox::engine::math::Vector;
    use sandbox::lab::bench::Crowd;

    /// Two seconds of a crowd in four rectangles, at rest or on its way to the right.
    fn drift(ahead: f64) -> Drift {
        let crowd = Crowd {
            density: 1.0,
            ..Crowd::streams(300, "sph")
        };
        let mut scene = crowd.scene().unwrap();
        for agent in &mut scene.agents {
            agent.goal = agent.position + Vector::new(ahead, 0.0);
        }
        let positions: Vec<Vector> = scene.agents.iter().map(|agent| agent.position).collect();
        let cuts = [(Way::Rectangles.cut(&positions, &[], 4), 4)];
        let mut simulation = Simulation::new(scene).unwrap();
        follow(&mut simulation, &cuts, 2).unwrap()[0]
    }

    #[test]
    fn walking_agents_change_parts_and_agents_at_rest_hardly_do() {
        let (resting, walking) = (drift(0.0), drift(100.0));
        assert!(resting.changes_per_second < 0.01, "{resting:?}");
        // The crowd is 17 m wide and walks about a meter per second across the border in its middle.
        assert!(walking.changes_per_second > 0.02, "{walking:?}");
        assert!(walking.at_the_end > walking.after_a_second, "{walking:?}");
    }
}
