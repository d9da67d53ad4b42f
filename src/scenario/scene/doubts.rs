//! Notes on scenarios that are valid but doubtful: a plan in another unit, journeys without end, no agents. Others are
//! in `units.rs`, `eclipsed.rs`, `leaving.rs`, `through_walls.rs`, `jamming.rs` and `crossed.rs`.

use std::collections::BTreeSet;
use std::f64::consts::TAU;

use crate::error::quote::shown;
use crate::file::File;
use crate::keys::catalog;
use crate::keys::limits::LONGEST_TIME;
use crate::keys::people::Spacing;
use crate::keys::places::Exit;
use crate::keys::profiles::ProfileChoice;
use crate::measurements::Measurement;
use crate::scene::journeys::TO_EXIT;
use crate::scene::levels::steep;
use crate::scene::{changes, eclipsed, jamming, leaving, through_walls, units};
use engine::entrance::Entrance;
use engine::forces::legs::Legs;
use engine::geometry::Walls;
use engine::journeys::{Change, ChangeKind, Choice, Kind, Place, Zone};
use engine::math::{Vector, bounds};
use engine::routes::nearest_on;
use engine::scene::{Group, Scene};

/// Floors with a longer side are doubtful, meters.
const LONG: f64 = 300.0;
/// Floors with a longer side and fewer people per square meter are doubtful, too. Small empty rooms are not: a single
/// agent shows how the model walks.
const SIDE_IF_EMPTY: f64 = 100.0;
const EMPTY: f64 = 0.01;
/// Agents enter on the line of an exit if theirs is nearer, meters.
const AT_EXIT: f64 = 0.1;

/// Exits begin, end or lead through walls that are nearer, meters.
const AT_WALL: f64 = 1.0;
/// The line of an exit is looked at in this many parts.
const PARTS: u32 = 20;

/// The most unused places that a note names.
const NAMED: usize = 3;

/// Groups of which this share walks are walking groups.
const SOME: f64 = 0.05;
/// From this number of agents on, a note says how they choose their routes.
const CROWD: u64 = 100;

/// The notes on a complete scene that at most `entering` agents enter, whose file has its end at `last`, seconds.
pub fn notes(keys: &File, scene: &Scene, entering: u64, last: f64) -> Vec<String> {
    if entering == 0 {
        let none = match scene.entrances.first() {
            Some(entrance) => format!(
                "no agents enter: no times, rate or number of the entrance `{}` let any in",
                shown(&entrance.name)
            ),
            None => {
                "no agents enter: add `crowds`, `grids`, `agents`, `sources`, `entrances` or `from`"
                    .to_owned()
            }
        };
        return vec![none];
    }
    let floor = floor(keys, &scene.walls, entering).into_iter();
    floor
        .chain(units::notes(keys, scene, last))
        .chain(eclipsed::notes(scene))
        .chain(through_walls::note(scene))
        .chain(jamming::note(scene, entering))
        .chain(endless(scene))
        .chain(leaving::notes(keys, scene))
        .chain(coincident(scene))
        .chain(peaks(keys))
        .chain(spectra(keys))
        .chain(at_exits(scene))
        .chain(unused(scene))
        .chain(closed(scene, last))
        .chain(changes::idle(keys, &scene.journeys))
        .chain(afloat(keys, scene))
        .chain(unheeded(keys, scene))
        .chain(on_legs(keys, scene))
        .chain(crowded(keys, scene, entering))
        .chain(steep(&keys.levels, scene.levels.as_deref()))
        .collect()
}

/// A note on crowds on a floor plan with several ways, whose agents take the shortest one because neither the file nor
/// a journey says how they choose.
fn crowded(keys: &File, scene: &Scene, entering: u64) -> Option<String> {
    let is_open = keys.route_choice.is_none();
    let rings = scene.walls.obstacles().iter().flat_map(|one| one.rings());
    // Levels have a choice of stairs if their joins are more than lead once to each of them.
    let is_wide = match &scene.levels {
        Some(levels) => levels.joins().len() / 2 >= levels.all().len(),
        None => keys.walkable_area.is_some() && rings.count() > 1,
    };
    let exits = scene.groups.iter().any(|group| {
        let to = group
            .journey
            .map(|k| &scene.journeys.journeys[usize::from(k)]);
        to.is_some_and(|to| to.name == TO_EXIT[0] && to.stages[0].places.len() > 1)
    });
    let looks = scene.groups.iter().any(|group| {
        let mut stages = leaving::stages(scene, group);
        stages.any(|stage| stage.choice == Choice::Quickest)
    });
    let is_floor = keys.walkable_area.is_some() || scene.levels.is_some();
    let has_choice = !looks && is_floor && scene.routes.is_some() && (is_wide || exits);
    (is_open && has_choice && entering >= CROWD).then(|| {
        "all agents take the shortest way, however many wait there; with `route_choice` `quickest` they take the way \
         of the least time (`shortest` in the file hides this note)"
            .to_owned()
    })
}

/// Notes on motivations that no walking law reads, and on zones that change nothing. The motivation of the whole
/// scenario describes its people, whatever their profile.
fn unheeded(keys: &File, scene: &Scene) -> Vec<String> {
    let zones = &scene.journeys.zones;
    let is_idle = |zone: &&Zone| zone.speed_factor == 1.0 && zone.motivation == 0.0;
    let idle = zones.iter().filter(is_idle).map(|zone| {
        let name = shown(&zone.name);
        format!("zone `{name}`: changes nothing; give it a `speed_factor` or a `motivation`")
    });
    let mut notes: Vec<String> = idle.collect();
    let is_own = |group: &Group| group.motivation != keys.motivation;
    let profile = keys.profile.as_ref();
    let is_own_profile = profile.is_some_and(|choice| !is_of_the_paper(choice));
    let is_given = (is_own_profile && keys.motivation > 0.0)
        || scene.groups.iter().any(is_own)
        || zones.iter().any(|zone| zone.motivation > 0.0);
    let mut laws = scene
        .profiles()
        .filter_map(|profile| profile.walking?.headings().copied());
    if is_given && !laws.any(|law| law.gap.hurry_share != 0.0) {
        notes.push(
            "`motivation` has no effect: no profile has the walking law `headings` with a `hurry_share`; \
             `steer+sph` has it"
                .to_owned(),
        );
    }
    notes
}

/// Whether a profile is one of the paper, which know no motivation.
fn is_of_the_paper(choice: &ProfileChoice) -> bool {
    matches!(choice, ProfileChoice::Named(name) if catalog::NAMES.contains(&name.0.as_str()))
}

/// A note if agents with legs walk to a goal before the run ends: the law describes crowds that stand.
fn on_legs(keys: &File, scene: &Scene) -> Option<String> {
    let end = keys.duration_secs.unwrap_or(f64::INFINITY);
    let walks = |group: &Group, own: Option<f64>, is_sent: bool| {
        let waits = own.or_else(|| Some(group.traits.premovement.as_ref()?.quantile(SOME)));
        Legs::among(group.blend.forces()).is_some() && is_sent && waits.unwrap_or(0.0) < end
    };
    let is_sent = |group: &Group| {
        group.journey.is_some() || group.removal_radius.is_some() || group.direction.is_some()
    };
    let mut groups = scene.groups.iter();
    let group = groups.find(|group| walks(group, None, is_sent(group)));
    let group = group.or_else(|| {
        let mut agents = scene.agents.iter();
        let walker = agents.find(|agent| {
            let group = &scene.groups[usize::from(agent.group)];
            walks(group, agent.premovement, agent.goal != agent.position)
        })?;
        Some(&scene.groups[usize::from(walker.group)])
    })?;
    Some(format!(
        "{}: people with legs walk to a goal (profile `{}`); legs are a law of crowds that stand and sway, not of \
         walks and evacuations",
        shown(&group.name),
        shown(&group.blend.name)
    ))
}

/// A note on a floor that is so large or empty that its unit may not be meters. Its size is that of the plan, without
/// the floors behind exits and entrances.
fn floor(keys: &File, walls: &Walls, entering: u64) -> Option<String> {
    let of_levels = keys.levels.iter().flat_map(|level| &level.walkable_area);
    // In the plane, levels lie side by side.
    let whole = keys.walkable_area.iter().flatten();
    let of_floor = whole.filter(|_| keys.levels.is_empty());
    let rings = of_floor.chain(of_levels).flatten();
    let corners = rings.flat_map(|ring| ring.0.iter().map(|&corner| corner.into()));
    let [low, high] = bounds(corners)?;
    let extent = high - low;
    let unbounded = walls.obstacles().iter().filter(|one| one.is_unbounded());
    let outlines: Vec<&[Vector]> = unbounded.flat_map(|one| one.rings()).collect();
    let solids = walls.obstacles().iter().filter(|one| !one.is_unbounded());
    let twice = |ring: &[Vector]| -> f64 {
        let ends = ring.iter().cycle().skip(1);
        ring.iter().zip(ends).map(|(a, b)| a.perp(b)).sum()
    };
    // The outlines of floors and of the solids in them run in opposite senses.
    let outer: f64 = outlines.iter().map(|ring| twice(ring)).sum();
    let size = 0.5 * outer.abs() - solids.map(|solid| solid.area()).sum::<f64>();
    let density = entering as f64 / size.max(f64::MIN_POSITIVE);
    let is_empty = extent.max() > SIDE_IF_EMPTY && density < EMPTY;
    (extent.max() > LONG || is_empty).then(|| {
        format!(
            "walkable_area: {:.0} m × {:.0} m for {entering} agent(s): check that the unit is meters",
            extent.x, extent.y
        )
    })
}

/// A note on agents that start at the same point as another.
fn coincident(scene: &Scene) -> Option<String> {
    let mut positions: Vec<Vector> = scene.agents.iter().map(|agent| agent.position).collect();
    positions.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let pairs = positions.windows(2).filter(|pair| pair[0] == pair[1]);
    let same: Vec<Vector> = pairs.map(|pair| pair[0]).collect();
    let first = same.first()?;
    Some(format!(
        "{} agent(s) start exactly where another one does, the first at ({}, {}): are two groups on one spot?",
        same.len(),
        first.x,
        first.y
    ))
}

/// Notes on the largest forces of runs that begin with crowds at random places.
fn peaks(keys: &File) -> Vec<String> {
    let mut crowds = keys.crowds.iter();
    let is_random = crowds.any(|crowd| crowd.spacing == Spacing::Random);
    let measured = keys.measurements.iter().enumerate().filter(|_| is_random);
    let note = |(k, given): (usize, &Measurement)| {
        let key = given.about().peaks_from_start?;
        Some(format!(
            "measurements[{k}].{key}: crowds start at random places, where forces are larger than after the first \
             steps; give `from_secs` of a few seconds, so that the start does not count"
        ))
    };
    measured.filter_map(note).collect()
}

/// Notes on spectra of times too short for the frequencies that they are to show.
fn spectra(keys: &File) -> Vec<String> {
    let note = |(k, given): (usize, &Measurement)| {
        let (samples, wanted) = given.about().spectrum?;
        let ends = [samples.until_secs, keys.duration_secs];
        let end = ends.into_iter().flatten().reduce(f64::min)?;
        let secs = end - samples.from_secs;
        let lowest = 2.0 * TAU / secs;
        (secs > 0.0 && lowest > wanted).then(|| {
            format!(
                "measurements[{k}].oscillation: in {secs} s peaks are found from {lowest:.2} rad/s on, and `band` \
                 begins at {wanted}: measure for at least {:.0} s",
                (2.0 * TAU / wanted).ceil()
            )
        })
    };
    let given = keys.measurements.iter().enumerate();
    given.filter_map(note).collect()
}

/// Notes on entrances whose agents walk to an exit on whose line they enter.
fn at_exits(scene: &Scene) -> Vec<String> {
    let journeys = &scene.journeys;
    let entrances = scene.entrances.iter().enumerate();
    let note = |(k, entrance): (usize, &Entrance)| {
        let journey = scene.groups[usize::from(entrance.group)].journey?;
        let first = journeys.journeys[usize::from(journey)].stages.first()?;
        let numbers = first.places.iter();
        let mut places = numbers.map(|&place| &journeys.places[usize::from(place)]);
        let middle = 0.5 * (entrance.line[0] + entrance.line[1]);
        let exit = places.find(|place| {
            let line = place.line().filter(|_| place.is_exit());
            line.is_some_and(|[a, b]| (nearest_on(middle, a, b) - middle).norm() < AT_EXIT)
        })?;
        Some(format!(
            "entrances[{k}].line: agents enter on the line of the exit `{}` and walk to it; give them another exit, or \
             move the line",
            shown(&exit.name)
        ))
    };
    entrances.filter_map(note).collect()
}

/// A note on journeys that no agents take, and on places that no agents walk to.
fn unused(scene: &Scene) -> Option<String> {
    let journeys = &scene.journeys;
    let used: BTreeSet<u16> = scene.groups.iter().filter_map(|one| one.journey).collect();
    let taken = used.iter().map(|&one| &journeys.journeys[usize::from(one)]);
    let stages = taken.flat_map(|journey| &journey.stages);
    let stops = journeys.lifts.iter().flat_map(|lift| &lift.stops);
    let places: BTreeSet<u16> = stages
        .flat_map(|stage| stage.places.iter().copied())
        .chain(stops.map(|stop| stop.place))
        .collect();
    let given =
        journeys.journeys.iter().enumerate().filter(|(k, journey)| {
            !used.contains(&(*k as u16)) && !TO_EXIT.contains(&&*journey.name)
        });
    let idle = given.map(|(_, journey)| format!("the journey `{}`", shown(&journey.name)));
    let others = journeys
        .places
        .iter()
        .enumerate()
        .filter(|(k, place)| !places.contains(&(*k as u16)) && !matches!(place.kind, Kind::Door(_)))
        .map(|(_, place)| format!("the {} `{}`", place.kind.name(), shown(&place.name)));
    let names: Vec<String> = idle.chain(others).collect();
    if names.is_empty() {
        return None;
    }
    let (named, others) = names.split_at(names.len().min(NAMED));
    let more = match others.len() {
        0 => String::new(),
        count => format!(" and {count} more"),
    };
    Some(format!(
        "no agents use {}{more}; give it to a crowd or a journey, or remove it",
        named.join(", ")
    ))
}

/// Notes on doors and exits that are closed for the whole run.
fn closed(scene: &Scene, last: f64) -> Vec<String> {
    let journeys = &scene.journeys;
    let places = || journeys.places.iter().zip(0..);
    let doors = places().filter(|(place, _)| matches!(place.kind, Kind::Door(_)));
    let exits = places().filter(|(place, _)| place.is_exit());
    let note = |list: &str, (k, (place, number)): (usize, (&Place, u16))| {
        let changes = journeys.changes.iter().filter(|one| one.place == number);
        let first: Vec<&Change> = changes.take_while(|one| one.at < last).collect();
        let starts_closed = |one: &&Change| one.at <= 0.0 && one.kind == ChangeKind::Close;
        let opens = |one: &&Change| one.kind == ChangeKind::Open;
        // Until the longest time there is: until it is opened by hand.
        let by_hand = journeys
            .changes
            .iter()
            .any(|one| one.place == number && one.at >= LONGEST_TIME);
        let is_closed = !by_hand && first.iter().any(starts_closed) && !first.iter().any(opens);
        is_closed.then(|| {
            format!(
                "{list}[{k}]: `{}` is closed for the whole run: people to whose goal no other way leads wait before \
                 it; check the times, or draw a wall in its place",
                shown(&place.name)
            )
        })
    };
    let doors = doors.enumerate().filter_map(|door| note("doors", door));
    let exits = exits.enumerate().filter_map(|exit| note("exits", exit));
    doors.chain(exits).collect()
}

/// Notes on exits that are far from all walls of a floor plan.
fn afloat(keys: &File, scene: &Scene) -> Vec<String> {
    let is_free = |end: Vector| {
        let mut near = Vec::new();
        scene.walls.near(end, AT_WALL, &mut near);
        near.is_empty()
    };
    let exits = keys.exits.iter().enumerate().filter(|(_, exit)| {
        let [a, b] = exit.line.map(Vector::from);
        let mut points = (0..=PARTS).map(|k| a.lerp(&b, f64::from(k) / f64::from(PARTS)));
        keys.walkable_area.is_some() && points.all(is_free)
    });
    let note = |(k, exit): (usize, &Exit)| {
        format!(
            "exits[{k}]: `{}` is at no wall, so people leave in the middle of the floor: draw it at a wall",
            shown(&exit.name)
        )
    };
    exits.map(note).collect()
}

/// Notes on the journeys after which agents stay on the floor, unless they end in waiting areas.
fn endless(scene: &Scene) -> Vec<String> {
    let used: BTreeSet<u16> = scene.groups.iter().filter_map(|one| one.journey).collect();
    let note = |journey: u16| {
        let journey = &scene.journeys.journeys[usize::from(journey)];
        let mut last = journey.stages.last()?.places.iter();
        let stays =
            |kind: &Kind| matches!(kind, Kind::Line(_) | Kind::Disk { .. } | Kind::Queue(_));
        let place = last.find_map(|&place| {
            let place = &scene.journeys.places[usize::from(place)];
            stays(&place.kind).then_some(place)
        })?;
        Some(format!(
            "journey `{}`: agents that have passed its last place, the {} `{}`, stand there until the end of the run; \
             add an exit as last stage if they should leave",
            shown(&journey.name),
            place.kind.name(),
            shown(&place.name),
        ))
    };
    used.into_iter().filter_map(note).collect()
}
