//! Text output of a breakdown.

use std::fmt::{self, Display, Formatter};

use super::Breakdown;

fn vector([x, y]: [f64; 2]) -> String {
    format!("({x:>10.4}, {y:>10.4})")
}

impl Display for Breakdown {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        writeln!(
            f,
            "agent {}: position {} m, velocity {} m/s, radius {:.4} m, mass {:.4}",
            self.id,
            vector(self.position),
            vector(self.velocity),
            self.radius,
            self.mass
        )?;
        writeln!(
            f,
            "  density {:.4} P/m² ({:.4} agents + {:.4} walls), mean {:.4}, rest {:.4}, pressure {:.4}",
            self.density,
            self.density_from_agents,
            self.density_from_walls,
            self.mean_density,
            self.rest_density,
            self.pressure
        )?;
        if let Some(way) = &self.way {
            let (next, heading) = (vector(way.next), vector(way.heading));
            writeln!(
                f,
                "  way: {:.2} m to its goal {}, next {next}, heading {heading}",
                way.length,
                vector(self.goal)
            )?;
        }
        self.write_accelerations(f)?;
        for wall in &self.walls {
            writeln!(
                f,
                "  wall {}: nearest point {} m, hidden area {:.5} m², density {:.5} P/m²",
                wall.wall,
                vector(wall.nearest_point),
                wall.hidden_area,
                wall.density
            )?;
        }
        let near = self.neighbors.iter();
        let near = near.map(|neighbor| format!("{} ({:.3} m)", neighbor.id, neighbor.distance));
        let near: Vec<String> = near.collect();
        writeln!(f, "  {} neighbors: {}", near.len(), near.join(", "))
    }
}

impl Breakdown {
    fn write_accelerations(&self, f: &mut Formatter) -> fmt::Result {
        for share in &self.profiles {
            let (name, weight) = (&share.name, share.weight);
            writeln!(f, "  {name} × {weight:.4}: accelerations, m/s²")?;
            for (term, value) in share.accelerations.listed() {
                if let Some(value) = value {
                    writeln!(f, "    {:<18} {}", term.name(), vector(value.into()))?;
                }
            }
        }
        for force in &self.own_forces {
            writeln!(f, "  {:<20} {}", force.name, vector(force.acceleration))?;
        }
        let total = vector(self.acceleration);
        writeln!(f, "    {:<18} {total}", "total (weighted)")
    }
}
