//! What an engineer asks first about a run.

use engine::scene::{Group, Scene};
use runs::drive::Run;
use runs::summary::Summary;
use scenario::measurements::{HEADWAY, LongestQueue, STUCK_AFTER, StuckGroup};
use scenario::quote::shown;

/// The most entries of a list.
const MOST: usize = 3;

/// What was run, and how it ended.
pub fn beginning(run: &Run, summary: &Summary) -> String {
    let (scenario, profile) = (shown(&summary.scenario), shown(&summary.profile));
    let motivation = motivation(&run.scenario.scene);
    let Summary {
        seed,
        time_secs,
        frames,
        agents,
        arrived,
        remaining,
        removed,
        ..
    } = summary;
    let reason = run.reason();
    let removed = match removed {
        0 => String::new(),
        some => format!(" {some} were removed."),
    };
    format!(
        "{scenario} ({profile}{motivation}), seed {seed}: {time_secs:.2} s in {frames} frames\n\
         It ended: {reason}. {agents} agents entered, {arrived} left, {remaining} remain.{removed}"
    )
}

/// The motivation of the people, if a walking law reads it: ", motivation 0", with the zones that raise it.
fn motivation(scene: &Scene) -> String {
    let reads = |group: &&Group| {
        let law = group.blend.walking_law().and_then(|law| law.headings());
        law.is_some_and(|law| law.gap.longest() > 1.0 || law.gap.shortest() < 1.0)
    };
    let values = scene.groups.iter().filter(reads).map(|one| one.motivation);
    let Some([low, high]) = values.fold(None, |ends: Option<[f64; 2]>, value| {
        let [low, high] = ends.unwrap_or([value; 2]);
        Some([low.min(value), high.max(value)])
    }) else {
        return String::new();
    };
    let raised = scene.journeys.zones.iter().map(|zone| zone.motivation);
    let zones = match raised.fold(0.0, f64::max) {
        most if most > low => format!(", {most} in zones"),
        _ => String::new(),
    };
    match low == high {
        true => format!(", motivation {low}{zones}"),
        false => format!(", motivation {low} to {high}{zones}"),
    }
}

/// The people out, the times that they took, the highest density, the longest queues and the agents that are stuck.
pub fn facts(summary: &Summary) -> Vec<(String, String)> {
    let left = (summary.arrived > 0).then(|| times_out(summary));
    let stuck = match summary.stuck {
        0 => "none".to_owned(),
        stuck => format!(
            "{stuck} of {}: they made less than {HEADWAY} m of headway in {STUCK_AFTER} s of walking",
            summary.remaining
        ),
    };
    let queues = summary.longest_queues.iter().map(queue).collect();
    let lines = [
        ("left", left),
        ("left by exit", left_by_exit(summary)),
        ("highest density", Some(highest_density(summary))),
        ("longest queue", Some(listed(queues, "none"))),
        ("stuck", Some(stuck)),
    ];
    let given = lines
        .into_iter()
        .filter_map(|(name, value)| Some((name, value?)));
    let all = given.chain(stuck_because(&summary.stuck_because).map(|cause| ("", cause)));
    all.map(|(name, value)| (name.to_owned(), value)).collect()
}

/// The agents that left by each exit, and elsewhere; `None` without exits.
fn left_by_exit(summary: &Summary) -> Option<String> {
    let exits = summary.places.iter().filter(|place| place.kind == "exit");
    let shares = exits.map(|exit| {
        let percent = exit.share.map_or(0.0, |share| 100.0 * share);
        format!("{} {} ({percent:.0} %)", shown(&exit.name), exit.passed)
    });
    let mut by_exit: Vec<String> = shares.collect();
    let at_exits: f64 = summary.places.iter().filter_map(|exit| exit.share).sum();
    let elsewhere = ((1.0 - at_exits) * summary.arrived as f64).round();
    if elsewhere > 0.0 && !by_exit.is_empty() {
        let percent = 100.0 * (1.0 - at_exits);
        by_exit.push(format!("at goals {elsewhere} ({percent:.0} %)"));
    }
    (!by_exit.is_empty()).then(|| by_exit.join(", "))
}

/// The highest density, with its place and time.
fn highest_density(summary: &Summary) -> String {
    let none = match summary.agents {
        0 => "none: no agents entered",
        _ => "not computed by this profile",
    };
    let Some(highest) = &summary.highest_density else {
        return none.to_owned();
    };
    let ([x, y], secs, density) = (highest.at, highest.at_secs, highest.density_per_m2);
    let large = highest
        .of_large()
        .map_or(String::new(), |large| format!(", {large}"));
    let level = on_level(highest.level.as_deref());
    format!("{density:.2} P/m² at ({x:.2}, {y:.2}){level} after {secs:.2} s (SPH density{large})")
}

/// The level of a place, if it lies in a building.
fn on_level(level: Option<&str>) -> String {
    level.map_or(String::new(), |level| format!(" on `{}`", shown(level)))
}

/// The most people in a queue.
fn queue(queue: &LongestQueue) -> String {
    let (before, agents, secs) = (shown(&queue.before), queue.agents, queue.at_secs);
    let density = queue.density_per_m2.map_or(String::new(), |density| {
        format!(", at up to {density:.1} P/m²")
    });
    let Some(outside) = queue.outside else {
        return format!("{agents} before {before} after {secs:.0} s{density}");
    };
    // The density of a queue with a line is that of those outside of it.
    format!(
        "{agents} before {before} after {secs:.0} s (up to {} outside of its line, at {:.0} s{density}; {:.0} s each \
         on average)",
        outside.agents, outside.at_secs, outside.mean_secs
    )
}

/// When 50 %, 95 % and all agents had left.
fn times_out(summary: &Summary) -> String {
    let parts = [
        ("50 %", summary.t50_secs),
        ("95 %", summary.t95_secs),
        ("all", summary.t100_secs),
    ];
    let times = parts.map(|(part, secs)| match secs {
        Some(secs) => format!("{part} at {secs:.2} s"),
        None => format!("{part} not by the end"),
    });
    times.join(", ")
}

/// The first entries of a list.
fn listed(entries: Vec<String>, none: &str) -> String {
    match entries.len() {
        0 => none.to_owned(),
        count if count > MOST => format!(
            "{}, and {} more: --json lists them",
            entries[..MOST].join(", "),
            count - MOST
        ),
        _ => entries.join(", "),
    }
}

/// The agents that are stuck, by the likely cause.
fn stuck_because(groups: &[StuckGroup]) -> impl Iterator<Item = String> {
    let causes = groups.iter().take(MOST).map(|group| {
        let StuckGroup {
            cause,
            agents,
            agent,
            at: [x, y],
            level,
            for_secs,
        } = group;
        let level = on_level(level.as_deref());
        format!("{agents}: {cause} (agent {agent} at ({x:.2}, {y:.2}){level}, for {for_secs:.0} s)")
    });
    let more = groups.len().saturating_sub(MOST);
    causes.chain((more > 0).then_some(format!("and {more} more causes: --json lists them")))
}
