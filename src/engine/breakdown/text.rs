//! Text output of a breakdown.

use std::fmt::{self, Display, Formatter, Write};

use super::{Alternative, Breakdown, Doing};

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
        self.write_route(f)?;
        self.write_route_choice(f)?;
        self.write_visit(f)?;
        self.write_choice(f)?;
        self.write_accelerations(f)?;
        self.write_states(f)?;
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
    /// The lines about the agent's way and journey; empty without both.
    pub fn route_and_visit(&self) -> String {
        let mut text = String::new();
        // Writing to a string cannot fail.
        self.write_route(&mut text).ok();
        self.write_route_choice(&mut text).ok();
        self.write_visit(&mut text).ok();
        text
    }

    fn write_route(&self, f: &mut impl Write) -> fmt::Result {
        let Some(way) = &self.way else {
            return Ok(());
        };
        let end = way.corners.last().copied().unwrap_or(way.next);
        let length = match way.length {
            Some(length) => format!("{length:.2} m"),
            None => "straight".to_owned(),
        };
        writeln!(
            f,
            "  way: {length} to {}, over {} corner(s); next {}, heading {}",
            vector(end),
            way.corners.len().saturating_sub(1),
            vector(way.next),
            vector(way.heading)
        )
    }

    fn write_route_choice(&self, f: &mut impl Write) -> fmt::Result {
        let Some(choice) = &self.route_choice else {
            return Ok(());
        };
        match choice.by_time {
            true => writeln!(
                f,
                "  quickest route: {}; compared again at {:.2} s, changed {} times",
                choice.reason, choice.again_at_secs, choice.changes
            )?,
            false => writeln!(
                f,
                "  routes out of the room: {}; changed {} times",
                choice.reason, choice.changes
            )?,
        }
        for way in &choice.routes {
            let flow = way.flow_per_sec.map_or(String::new(), |flow| {
                format!(", {} ahead at {flow:.2} P/s", way.ahead)
            });
            let total = way.total_secs.map(|total| format!("{total:6.2} s"));
            let through = way.through_secs;
            let through = through.map(|secs| format!(", through after {secs:.2} s"));
            let closed = way.closed.map(|closed| closed.to_string());
            let before = total.or(closed).map_or(String::new(), |said| said + ": ");
            writeln!(
                f,
                "    {before}{:.2} m to {}{flow}{}{}{}",
                way.length,
                way.through,
                through.unwrap_or_default(),
                if way.shortest { "; the shortest" } else { "" },
                if way.taken { "; taken" } else { "" },
            )?;
        }
        Ok(())
    }

    fn write_visit(&self, f: &mut impl Write) -> fmt::Result {
        if let Some(from) = self.walks_from_secs {
            writeln!(f, "  does not walk before {from:.2} s")?;
        }
        let Some(visit) = &self.visit else {
            return Ok(());
        };
        let place = &visit.place;
        let doing = match &visit.doing {
            Doing::Walking => format!("walks to `{place}`"),
            Doing::Waiting {
                since_secs,
                lift: Some(lift),
                ..
            } => format!("waits for the lift `{lift}` in `{place}` since {since_secs:.2} s"),
            Doing::Waiting {
                since_secs,
                until_secs,
                lift: None,
            } => {
                let until = until_secs.map_or("it is released".to_owned(), |t| format!("{t:.2} s"));
                format!("waits in `{place}` since {since_secs:.2} s until {until}")
            }
            Doing::Queued { since_secs, ahead } => {
                format!("stands in `{place}` since {since_secs:.2} s with {ahead} ahead")
            }
            Doing::Served {
                since_secs,
                until_secs,
            } => {
                format!(
                    "is served at `{place}` until {until_secs:.2} s, there since {since_secs:.2} s"
                )
            }
            Doing::Finished => format!("has ended its journey at `{place}`"),
        };
        let (journey, stage, stages) = (&visit.journey, visit.stage, visit.stages);
        let waited = visit.waited_secs;
        writeln!(
            f,
            "  journey `{journey}`, stage {stage} of {stages}: {doing}; waited {waited:.2} s before"
        )?;
        let Some(why) = &visit.why else {
            return Ok(());
        };
        for alternative in &why.alternatives {
            writeln!(f, "    {alternative}")?;
        }
        let again = why.looks_again_secs;
        let again = again.map_or(String::new(), |t| format!("; looks again at {t:.2} s"));
        let (choice, reason) = (&why.choice, why.reason);
        writeln!(f, "    now it would choose `{choice}`: {reason}{again}")
    }

    fn write_choice(&self, f: &mut Formatter) -> fmt::Result {
        let Some(choice) = &self.choice else {
            return Ok(());
        };
        writeln!(
            f,
            "  headings: motivation {}, time gap × {:.3}",
            choice.motivation, choice.gap_factor
        )?;
        for heading in &choice.headings {
            let ends_at = match (heading.ends_at_agent, heading.ends_at_wall) {
                (Some(agent), _) => format!(", up to agent {agent}"),
                (_, Some(wall)) => format!(", up to wall {wall}"),
                _ => String::new(),
            };
            writeln!(
                f,
                "   {} {:>4.0}°: room for {:.3} m/s, utility {:.3} m/s{ends_at}",
                if heading.followed { '>' } else { ' ' },
                heading.angle,
                heading.room,
                heading.utility,
            )?;
        }
        Ok(())
    }

    fn write_states(&self, f: &mut Formatter) -> fmt::Result {
        for state in &self.states {
            let value = |(name, value): &(&str, f64)| format!("{name} {value:.4}");
            let values: Vec<String> = state.values.iter().map(value).collect();
            writeln!(f, "  state of `{}`: {}", state.force, values.join(", "))?;
            for (name, value) in &state.vectors {
                writeln!(f, "    {name:<18} {}", vector(*value))?;
            }
        }
        Ok(())
    }

    fn write_accelerations(&self, f: &mut Formatter) -> fmt::Result {
        for share in &self.profiles {
            let (name, weight) = (&share.name, share.weight);
            writeln!(f, "  {name} × {weight:.4}: accelerations, m/s²")?;
            for (name, value) in share.accelerations.listed() {
                writeln!(f, "    {name:<18} {}", vector(value.into()))?;
            }
        }
        for force in &self.own_forces {
            writeln!(f, "  {:<20} {}", force.name, vector(force.acceleration))?;
        }
        let total = vector(self.acceleration);
        writeln!(f, "    {:<18} {total}", "total (weighted)")
    }
}

impl Display for Alternative {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        write!(f, "`{}`: ", self.place)?;
        if !self.open {
            write!(f, "closed, ")?;
        }
        match self.length {
            Some(length) => write!(f, "{length:.2} m")?,
            None => write!(f, "no way")?,
        }
        write!(f, ", {} agent(s) bound for it", self.bound)?;
        if let Some(weight) = self.weight {
            write!(f, ", weight {weight}")?;
        }
        if let Some(closed) = &self.route_closed {
            write!(f, ", the way is {closed}")?;
        }
        let Some(times) = &self.expected else {
            return Ok(());
        };
        write!(f, ", {} of them nearer", times.ahead)?;
        if let Some(flow) = times.flow_per_sec {
            write!(f, " at {flow:.2} P/s")?;
        }
        write!(
            f,
            "; walking {:.1} s or waiting {:.1} s, onward {:.1} s: {:.1} s",
            times.walking_secs, times.waiting_secs, times.onward_secs, times.total_secs
        )
    }
}
