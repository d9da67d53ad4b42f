//! Journeys, of the present and of the former kind.

use std::collections::{BTreeMap, BTreeSet};

use serde_json::{Value, json};

use super::fields::{Notes, Object};
use super::places::Places;
use crate::error::{Problem, Under};

/// The name of the journey of people without one, in scenarios with checkpoints.
const ALL_CHECKPOINTS: &str = "all checkpoints";
/// The keys of journeys.
const JOURNEY: [&str; 4] = ["id", "name", "color", "sequence"];
const FORMER: [&str; 5] = ["id", "name", "color", "stages", "transitions"];
/// How often people go round where their stages form a circle without an exit.
const ROUNDS: usize = 50;
/// Most routes of a journey from a distribution.
const MOST_ROUTES: usize = 1000;
/// How the web app names distributions.
const DISTRIBUTION: &str = "jps-distributions_";

/// The name of a journey, and how many people take it in proportion to the others.
type Share = (String, f64);

/// The journeys of a scenario.
#[derive(Debug, Default)]
pub struct Routes {
    /// The list of a scenario.
    pub journeys: Vec<Value>,
    /// The journeys from each distribution.
    shares: BTreeMap<String, Vec<Share>>,
    /// The journey of people who stand on the floor from the start and have no other.
    default: Option<String>,
}

impl Routes {
    /// The journeys of a document.
    pub fn read(root: &Object, places: &Places, notes: &mut Notes) -> Result<Self, Problem> {
        let mut routes = Self::default();
        match root.says("journeys_v2") {
            true => routes.add_present(root, places, notes)?,
            false => routes.add_former(root, places, notes)?,
        }
        let distributions = root.elements("distributions")?;
        let is_free = |id: &str| !routes.shares.contains_key(id);
        let without: Vec<&str> = distributions
            .iter()
            .map(|(id, _)| *id)
            .filter(|id| is_free(id))
            .collect();
        if !without.is_empty() && !places.checkpoints.is_empty() {
            let passed = places.checkpoints.iter().map(|id| places.stage(id));
            let stages: Vec<Value> = passed.chain([places.nearest_exit()]).collect();
            routes.add(ALL_CHECKPOINTS, stages);
            routes.default = Some(ALL_CHECKPOINTS.to_owned());
            notes.add(format!(
                "distributions without a journey pass all checkpoints in order, then the nearest exit: {}",
                without.join(", ")
            ));
        }
        Ok(routes)
    }

    /// The journeys from a distribution; `None` is the way to the nearest exit. `enters`: people enter during the run.
    pub fn from(&self, distribution: &str, enters: bool) -> Vec<(Option<&str>, f64)> {
        let default = self.default.as_deref().filter(|_| !enters);
        match self.shares.get(distribution) {
            Some(shares) => shares
                .iter()
                .map(|(name, weight)| (Some(name.as_str()), *weight))
                .collect(),
            None => vec![(default, 1.0)],
        }
    }

    fn add(&mut self, name: &str, stages: Vec<Value>) {
        self.journeys.push(json!({"name": name, "stages": stages}));
    }

    /// Journeys with one sequence each; the distributions have the weights.
    fn add_present(
        &mut self,
        root: &Object,
        places: &Places,
        notes: &mut Notes,
    ) -> Result<(), Problem> {
        let mut names: BTreeMap<&str, String> = BTreeMap::new();
        let mut taken = BTreeSet::new();
        for journey in root.list("journeys_v2")? {
            journey.note_unknown(&JOURNEY, notes);
            let id = journey
                .word("id")?
                .ok_or_else(|| journey.problem("id", "is missing"))?;
            let sequence = known(
                journey.words("sequence")?,
                places,
                &format!("journey {id}"),
                notes,
            );
            if sequence.is_empty() {
                continue;
            }
            let own = journey.word("name")?.filter(|name| !name.is_empty());
            let name = own.filter(|&name| !taken.contains(name)).unwrap_or(id);
            if !taken.insert(name) {
                return Err(journey.problem("id", "another journey has this id"));
            }
            self.add(name, stages(&sequence, places));
            names.insert(id, name.to_owned());
        }
        for (id, distribution) in root.elements("distributions")? {
            let mut shares = Vec::new();
            for weight in distribution.list("journey_weights")? {
                let journey = weight.word("journey_id")?.unwrap_or_default();
                let share = weight.number("weight", 0.0)?.unwrap_or(0.0);
                match names.get(journey) {
                    Some(name) if share > 0.0 => shares.push((name.clone(), share)),
                    Some(_) => {}
                    None => notes.add(format!(
                        "distributions.{id}: there is no journey {journey}; its weight is left out"
                    )),
                }
            }
            if !shares.is_empty() {
                self.shares.insert(id.to_owned(), shares);
            }
        }
        Ok(())
    }

    /// Journeys whose stages are connected by transitions, with percentages where they split.
    fn add_former(
        &mut self,
        root: &Object,
        places: &Places,
        notes: &mut Notes,
    ) -> Result<(), Problem> {
        for journey in root.list("journeys")? {
            journey.note_unknown(&FORMER, notes);
            let id = journey
                .word("id")?
                .ok_or_else(|| journey.problem("id", "is missing"))?;
            let listed = journey.words("stages")?;
            let (starts, inner): (Vec<&str>, Vec<&str>) = listed
                .iter()
                .partition(|stage| stage.starts_with(DISTRIBUTION));
            let graph = Graph::read(root, id, &starts, &inner)?;
            let mut known_paths: Vec<(Vec<&str>, String)> = Vec::new();
            for start in starts {
                for (path, weight) in graph.paths(start).under(&format!("journeys.{id}"))? {
                    let path = known(path, places, &format!("journey {id}"), notes);
                    if path.is_empty() {
                        continue;
                    }
                    let found = known_paths.iter().find(|(known, _)| *known == path);
                    let name = match found {
                        Some((_, name)) => name.clone(),
                        None => {
                            let name = match known_paths.len() {
                                0 => id.to_owned(),
                                others => format!("{id} route {}", others + 1),
                            };
                            self.add(&name, stages(&path, places));
                            known_paths.push((path, name.clone()));
                            name
                        }
                    };
                    self.shares
                        .entry(start.to_owned())
                        .or_default()
                        .push((name, weight));
                }
            }
        }
        Ok(())
    }
}

/// The stages that exist, up to the first exit.
fn known<'a>(ids: Vec<&'a str>, places: &Places, journey: &str, notes: &mut Notes) -> Vec<&'a str> {
    let mut known = Vec::new();
    for id in ids {
        let is_exit = places.exits.contains_key(id);
        if is_exit || places.checkpoints.iter().any(|checkpoint| checkpoint == id) {
            known.push(id);
        } else {
            notes.add(format!(
                "{journey}: there is no checkpoint or exit {id}; it is left out"
            ));
        }
        if is_exit {
            break;
        }
    }
    known
}

fn stages(ids: &[&str], places: &Places) -> Vec<Value> {
    ids.iter().map(|id| places.stage(id)).collect()
}

/// The connections between the stages of a journey, with weights.
struct Graph<'a>(BTreeMap<&'a str, Vec<(&'a str, f64)>>);

impl<'a> Graph<'a> {
    /// The transitions of a journey; without any, its stages follow each other.
    fn read(
        root: &Object<'a>,
        id: &str,
        starts: &[&'a str],
        inner: &[&'a str],
    ) -> Result<Self, Problem> {
        let mut graph = Self(BTreeMap::new());
        for transition in root.list("transitions")? {
            if transition.word("journey_id")? == Some(id)
                && let (Some(from), Some(to)) = (transition.word("from")?, transition.word("to")?)
            {
                graph.connect(from, to);
            }
        }
        if graph.0.is_empty() {
            for pair in inner.windows(2) {
                graph.connect(pair[0], pair[1]);
            }
            for start in starts {
                inner
                    .iter()
                    .take(1)
                    .for_each(|first| graph.connect(start, first));
            }
        }
        let routing = root.object("waypoint_routing")?;
        for (node, targets) in &mut graph.0 {
            let node = routing
                .as_ref()
                .and_then(|routing| routing.object(node).transpose());
            let Some(journey) = node
                .transpose()?
                .map(|node| node.object(id))
                .transpose()?
                .flatten()
            else {
                continue;
            };
            for destination in journey.list("destinations")? {
                let target = destination.word("target")?;
                let percentage = destination.number("percentage", 0.0)?.unwrap_or(0.0);
                let found = targets.iter_mut().find(|(known, _)| Some(*known) == target);
                if let Some((_, weight)) = found {
                    *weight = percentage;
                }
            }
        }
        Ok(graph)
    }

    fn connect(&mut self, from: &'a str, to: &'a str) {
        let targets = self.0.entry(from).or_default();
        if !targets.iter().any(|(known, _)| *known == to) {
            targets.push((to, 1.0));
        }
    }

    /// All routes from a distribution with the parts of the people that take them. People who have no stage before
    /// them but those that they have passed go round in circles.
    ///
    /// # Errors
    /// There are too many routes.
    fn paths(&self, start: &'a str) -> Result<Vec<(Vec<&'a str>, f64)>, Problem> {
        let mut found = Vec::new();
        let mut open = vec![(vec![start], 1.0)];
        while let Some((path, part)) = open.pop() {
            if found.len() + open.len() > MOST_ROUTES {
                let reason = format!("splits into more than {MOST_ROUTES} routes from {start}");
                return Err(Problem::new("", reason));
            }
            let last = path[path.len() - 1];
            let targets = self.0.get(last).map_or(&[][..], Vec::as_slice);
            let ahead: Vec<_> = targets
                .iter()
                .filter(|(to, weight)| !path.contains(to) && *weight > 0.0)
                .collect();
            let sum: f64 = ahead.iter().map(|(_, weight)| weight).sum();
            if ahead.is_empty() {
                let again = targets.iter().find(|(_, weight)| *weight > 0.0);
                let from = again.and_then(|(to, _)| path.iter().position(|stage| stage == to));
                let circle = from.map_or(&[][..], |from| &path[from..]);
                let circles = circle.iter().cycle().take(ROUNDS * circle.len());
                found.push((path[1..].iter().chain(circles).copied().collect(), part));
                continue;
            }
            for (to, weight) in ahead {
                let longer = path.iter().copied().chain([*to]).collect();
                open.push((longer, part * weight / sum));
            }
        }
        found.reverse();
        Ok(found)
    }
}
