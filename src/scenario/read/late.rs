//! Notes on events, closures and measurements that begin after the end of a run, on agents that never start walking in
//! it, and on runs in which nobody can leave.

use serde_json::Value;

use crate::error::numbers::brief;
use crate::error::quote::shown;
use engine::agents::NewAgent;
use engine::entrance::Entrance;
use engine::journeys::{Kind, Place};
use engine::math::Vector;
use engine::random::Purpose;
use engine::scene::Scene;

/// Lists, and the keys of their elements that say when something begins, or people go on.
const BEGIN: [(&str, &str); 5] = [
    ("events", "at_secs"),
    ("interventions", "at_secs"),
    ("sources", "start_secs"),
    ("entrances", "from_secs"),
    ("waiting_areas", "until_secs"),
];
/// The same for what is measured.
const MEASURED: [&str; 3] = ["at_secs", "from_secs", "start_secs"];
/// The measurement of the flow until a time.
const FLOW_UNTIL: [&str; 2] = ["flow_until", "until_secs"];
/// Most agents are not faster than this quantile of their speeds.
const FASTEST: f64 = 0.999;
/// Nearly no agent waits for a shorter time than this quantile.
const SHORTEST: f64 = 0.001;
/// Most places in the note.
const MOST_NAMED: usize = 4;

/// A note on what begins after `last`, in a run that ends at `end`, seconds. Both are the same unless the run is
/// shorter than its scenario.
pub fn note(document: &Value, end: f64, last: f64) -> Option<String> {
    let after = times(document).into_iter().filter(|(_, at)| *at > last);
    let late: Vec<(String, f64)> = after.collect();
    let (place, at) = late.first()?;
    let others = late.iter().skip(1).map(|(place, _)| place.as_str());
    let mut named: Vec<String> = others.take(MOST_NAMED - 1).map(str::to_owned).collect();
    if late.len() > MOST_NAMED {
        named.push(format!("{} more", late.len() - MOST_NAMED));
    }
    let (at, end) = (brief(*at), brief(end));
    let mut note = format!("{place}: {at} s is after the end of the run, {end} s");
    if !named.is_empty() {
        note += "; so are ";
        note += &named.join(", ");
    }
    Some(note)
}

/// A note on the agents that enter, but have not started walking by `last`, in a run that ends at `end`, seconds.
pub fn idle(scene: &Scene, [end, last]: [f64; 2]) -> Option<String> {
    let wait = |agent: &NewAgent, id: u32| {
        let traits = &scene.groups[usize::from(agent.group)].traits;
        let drawn = || {
            let premovement = traits.premovement.as_ref()?;
            Some(premovement.draw(scene.seed, Purpose::Premovement, id))
        };
        agent.premovement.or_else(drawn).unwrap_or(0.0)
    };
    let initial = scene.agents.iter().zip(0..);
    let idle = initial.filter(|&(agent, id)| wait(agent, id) >= last && end > 0.0);
    let count = idle.count();
    let sources = scene.sources.iter();
    let begun = sources.map(|one| (&one.name, one.group, Some(one.start)));
    let entrances = scene.entrances.iter();
    let arrived = entrances.map(|one| (&one.name, one.group, one.arrivals.first()));
    // Those who come after the end have a note of their own.
    let later = begun.chain(arrived).filter_map(|(name, group, first)| {
        let first = first.filter(|&first| first <= last)?;
        let traits = &scene.groups[usize::from(group)].traits;
        let premovement = traits.premovement.as_ref()?;
        (premovement.share_up_to(last - first) <= 0.0).then_some(name)
    });
    let named = later.map(|name| format!("all of {}", shown(name)));
    let some = (count > 0).then(|| format!("{count} of the {} at the start", scene.agents.len()));
    let who: Vec<String> = some.into_iter().chain(named).collect();
    (!who.is_empty()).then(|| {
        let (who, end) = (who.join(", "), brief(end));
        format!("premovement_secs: agents that never start walking before the end of the run, {end} s: {who}")
    })
}

/// Notes on entrances with more agents than arrive before `last`, in a run that ends at `end`, seconds.
pub fn missed(scene: &Scene, [end, last]: [f64; 2]) -> Vec<String> {
    let note = |(k, entrance): (u32, &Entrance)| {
        let planned = entrance.arrivals.planned()?;
        let mut before = None;
        let mut times = (0..planned)
            .map_while(|arrival| {
                before = entrance.arrivals.time(arrival, before, scene.seed, k);
                before
            })
            .peekable();
        let mut arrived = 0;
        while times.next_if(|&time| time <= last).is_some() {
            arrived += 1;
        }
        let until = match times.peek().is_none() {
            true => "`until_secs`".to_owned(),
            false => format!("the end of the run, {} s", brief(end)),
        };
        // Entrances that begin after the end have a note of their own.
        let begins = entrance.arrivals.first().is_some_and(|first| first <= last);
        (arrived < planned && begins).then(|| {
            format!(
                "entrances[{k}]: {arrived} of the {planned} agents of `{}` arrive before {until}",
                shown(&entrance.name)
            )
        })
    };
    let entrances = (0..).zip(&scene.entrances);
    entrances.filter_map(note).collect()
}

/// Notes on waiting areas in which people wait for longer than the run, which ends at `end`, seconds.
pub fn kept(scene: &Scene, [end, last]: [f64; 2]) -> Vec<String> {
    let note = |place: &Place| {
        let Kind::Waiting(waiting) = &place.kind else {
            return None;
        };
        let lasting = waiting.lasting.as_ref()?.quantile(SHORTEST);
        (lasting >= last && last > 0.0).then(|| {
            format!(
                "waiting_areas: agents wait in `{}` for {} s, and the run ends at {} s",
                shown(&place.name),
                brief(lasting),
                brief(end)
            )
        })
    };
    scene.journeys.places.iter().filter_map(note).collect()
}

/// A note if no agent is so near to the exit or goal at which it leaves that it gets there before `last`, in a run that
/// ends at `end`, seconds. Agents walk straight there for this.
pub fn short(scene: &Scene, [end, last]: [f64; 2]) -> Option<String> {
    if last == 0.0 {
        return Some(
            "duration_secs: in 0 s no agent walks: the run has its first frame only".to_owned(),
        );
    }
    let is_all = scene.sources.is_empty() && scene.entrances.is_empty() && last > 0.0;
    let needs = |agent: &NewAgent| {
        let group = &scene.groups[usize::from(agent.group)];
        // In a building, the agent's place on the level to which it walks.
        let levels = scene.levels.as_ref();
        let beside = |to: Vector| {
            let p = agent.position;
            levels.map_or(p, |levels| levels.on_level_of(to, p))
        };
        let distance = match group.journey {
            Some(journey) => {
                let stages = &scene.journeys.journeys[usize::from(journey)].stages;
                let numbers = stages.iter().flat_map(|stage| &stage.places);
                let places = numbers.map(|&place| &scene.journeys.places[usize::from(place)]);
                let exits = places.filter(|place| place.is_exit());
                let distances = exits.filter_map(|exit| {
                    let [end, _] = exit.line()?;
                    let from = beside(end);
                    Some((exit.nearest_point(from) - from).norm())
                });
                distances.reduce(f64::min)?
            }
            None => (agent.goal - beside(agent.goal)).norm() - group.removal_radius?,
        };
        let speeds = group.traits.preferred_speed.as_ref();
        let drawn = speeds.map(|speed| speed.quantile(FASTEST));
        let own = agent.preferred_speed.or(drawn);
        let speed = own.unwrap_or(scene.preferred_speed);
        Some(distance / speed)
    };
    let needed: Option<Vec<f64>> = scene.agents.iter().map(needs).collect();
    let least = needed.filter(|_| is_all)?.into_iter().reduce(f64::min)?;
    if least.is_infinite() {
        return Some("preferred_speed: all agents have 0 m/s: none leaves".to_owned());
    }
    (least > last).then(|| {
        let (end, least) = (brief(end), least.ceil());
        format!(
            "duration_secs: nobody can leave within {end} s: those nearest to their exit walk for {least} s or more; \
             durations are in seconds"
        )
    })
}

/// The times at which something begins, seconds, with their places.
fn times(document: &Value) -> Vec<(String, f64)> {
    let mut times = Vec::new();
    for (list, key) in BEGIN {
        for (k, element) in elements(&document[list]) {
            let at = element[key].as_f64();
            times.extend(at.map(|at| (format!("{list}[{k}].{key}"), at)));
        }
    }
    for (k, exit) in elements(&document["exits"]) {
        for (l, closed) in elements(&exit["closed_secs"]) {
            let from = closed[0].as_f64();
            times.extend(from.map(|from| (format!("exits[{k}].closed_secs[{l}]"), from)));
        }
    }
    for (k, measurement) in elements(&document["measurements"]) {
        for (kind, keys) in measurement.as_object().into_iter().flatten() {
            let own = (kind == FLOW_UNTIL[0]).then_some(FLOW_UNTIL[1]);
            let found = MEASURED.into_iter().chain(own).filter_map(|key| {
                let at = keys[key].as_f64()?;
                Some((format!("measurements[{k}].{kind}.{key}"), at))
            });
            times.extend(found);
        }
    }
    times
}

fn elements(list: &Value) -> impl Iterator<Item = (usize, &Value)> {
    list.as_array().into_iter().flatten().enumerate()
}
