//! When exits and doors open and close and waiting areas are released, by closing times and events.

use crate::error::quote::shown;
use crate::error::{Problem, Under};
use crate::file::{Event, File};
use engine::journeys::{Change, ChangeKind, Journeys, Kind, Place};

/// The changes of `places` in the order of their times. `number` gives the number of a place by its name.
pub fn changes(
    keys: &File,
    places: &[Place],
    number: impl Fn(&str) -> Result<u16, Problem>,
) -> Result<Vec<Change>, Problem> {
    let mut changes = Vec::new();
    let numbered_exits = keys.exits.iter().enumerate();
    let exits = numbered_exits.map(|(k, exit)| ("exits", k, &exit.name, &exit.closed_secs));
    let numbered_doors = keys.doors.iter().enumerate();
    let doors = numbered_doors.map(|(k, door)| ("doors", k, &door.name, &door.closed_secs));
    for (list, k, name, closed_secs) in exits.chain(doors) {
        let place = number(name)?;
        let closures = united(closed_secs).under(&format!("{list}[{k}]"))?;
        changes.extend(closures.into_iter().flat_map(|[from, until]| {
            let kinds = [(from, ChangeKind::Close), (until, ChangeKind::Open)];
            kinds.map(|(at, kind)| Change { at, place, kind })
        }));
    }
    for (k, event) in keys.events.iter().enumerate() {
        let key = format!("events[{k}]");
        if let Some(change) = change(event, places, &number).under(&key)? {
            accept(&change, &changes, event).under(&key)?;
            changes.push(change);
        }
    }
    changes.sort_by(|a, b| a.at.total_cmp(&b.at));
    Ok(changes)
}

/// Closures in the order of their times; those that overlap or touch as one.
fn united(closed_secs: &[[f64; 2]]) -> Result<Vec<[f64; 2]>, Problem> {
    for (n, [from, until]) in closed_secs.iter().enumerate() {
        if until <= from {
            let reason = match until == from {
                true => format!("it begins and ends at {from} s; give a later end"),
                false => format!("it ends at {until} s, before it begins at {from} s"),
            };
            return Err(Problem::new(format!("closed_secs[{n}]"), reason));
        }
    }
    let mut sorted = closed_secs.to_vec();
    sorted.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let mut united: Vec<[f64; 2]> = Vec::new();
    for [from, until] in sorted {
        match united.last_mut() {
            Some(last) if from <= last[1] => last[1] = last[1].max(until),
            _ => united.push([from, until]),
        }
    }
    Ok(united)
}

/// The change by an event, if it is one.
fn change(
    event: &Event,
    places: &[Place],
    number: impl Fn(&str) -> Result<u16, Problem>,
) -> Result<Option<Change>, Problem> {
    let mut given = [
        ("open", &event.open, ChangeKind::Open),
        ("close", &event.close, ChangeKind::Close),
        ("release", &event.release, ChangeKind::Release),
    ]
    .into_iter()
    .filter(|(_, name, _)| name.is_some());
    let Some((key, Some(name), kind)) = given.next() else {
        return Ok(None);
    };
    let place = number(name).under(key)?;
    let (fits, wanted) = match (&places[usize::from(place)].kind, kind) {
        (Kind::Waiting(_), _) => (kind == ChangeKind::Release, "a waiting area"),
        (Kind::Exit(_), _) => (kind != ChangeKind::Release, "an exit"),
        (Kind::Door(_), _) => (kind != ChangeKind::Release, "a door"),
        (Kind::Queue(_), _) => (false, "a queue"),
        (Kind::Line(_) | Kind::Disk { .. }, _) => (false, "a waypoint"),
    };
    if !fits {
        let reason = format!(
            "`{}` is {wanted}; exits and doors can open and close, and waiting areas can be released",
            shown(name)
        );
        return Err(Problem::new(key, reason));
    }
    Ok(Some(Change {
        at: event.at_secs,
        place,
        kind,
    }))
}

/// Rejects a change by an event if the opposite change happens at the same time.
fn accept(change: &Change, others: &[Change], event: &Event) -> Result<(), Problem> {
    let is_opposite = |other: &Change| {
        other.place == change.place && other.at == change.at && other.kind != change.kind
    };
    if !others.iter().any(is_opposite) {
        return Ok(());
    }
    let name = event.open.as_ref().or(event.close.as_ref());
    let reason = format!(
        "`{}` opens and closes at {} s; remove one of the two, or give another time",
        shown(name.map_or("", String::as_str)),
        change.at
    );
    Err(Problem::new("", reason))
}

/// Notes on events that open what is open: they do not close it before.
pub fn idle(keys: &File, journeys: &Journeys) -> Vec<String> {
    let note = |(k, event): (usize, &Event)| {
        let name = event.open.as_ref()?;
        let mut places = journeys.places.iter();
        let place = places.position(|place| place.name == *name)?;
        let changes = journeys.changes.iter();
        let mut before =
            changes.filter(|one| usize::from(one.place) == place && one.at < event.at_secs);
        let last = before.next_back().map_or(ChangeKind::Open, |one| one.kind);
        (last == ChangeKind::Open).then(|| {
            format!(
                "events[{k}]: `{}` is open already at {} s: the event has no effect; `closed_secs` closes it before",
                shown(name),
                event.at_secs
            )
        })
    };
    keys.events.iter().enumerate().filter_map(note).collect()
}
