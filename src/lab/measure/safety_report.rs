//! Quantities for safety engineers, for readers and programs.

use serde_json::{Value, json};

use super::{Departures, Measured, Safety};
use analysis::crowd_pressure::BEFORE_ACCIDENT;
use analysis::exposure::{Alarm, DENSITIES, Exposed, SLOW};
use analysis::service::LEVELS;
use output::document::Block;
use output::table::Table;

/// For readers.
pub fn blocks(measured: &Measured) -> Vec<Block> {
    let (safety, departures) = (&measured.safety, &measured.departures);
    let exposures = format!(
        "Exposure and alarms, a sample every {:.2} s; thresholds are from the literature, not safety limits. Densities \
         are means over √5 m, not the SPH density over 1 m.",
        safety.secs,
    );
    let service = "Level of service (Fruin 1971), shares of person-seconds in %; planning values, not safety limits.";
    let mut blocks = vec![
        Block::Table(exposure(safety), exposures),
        Block::Table(levels(safety), service.to_owned()),
    ];
    if let Some((person, time)) = safety.pressures.peak {
        let place = person.position;
        blocks.push(Block::Text(format!(
            "Crowd pressure: at most {:.4} 1/s² at ({:.2}, {:.2}) m, {time:.2} s, {:.2} P/m²; mean {:.4} 1/s²; {}.",
            person.pressure.unwrap_or_default(),
            place.x,
            place.y,
            person.density,
            safety.pressures.mean().unwrap_or_default(),
            threshold(safety),
        )));
    }
    blocks.push(Block::Text(left(departures)));
    blocks
}

/// Who was above the pressure at which crowd turbulence began once: it is known only for packed crowds.
fn threshold(safety: &Safety) -> String {
    if !is_packed(safety) {
        let packed = DENSITIES[DENSITIES.len() - 1];
        return format!(
            "nobody was above {packed} P/m²: thresholds of the literature are for packed crowds, and say nothing here"
        );
    }
    format!(
        "above {BEFORE_ACCIDENT} 1/s² (measured before the accident at Mina in 2006, not a safety limit): {} people at \
         once, {:.2} s at a stretch",
        safety.pressures.people,
        safety.pressures.spell.longest() * safety.secs,
    )
}

/// Whether somebody was above the highest of [`DENSITIES`].
pub fn is_packed(safety: &Safety) -> bool {
    let exposed = safety.exposure.exposed(safety.secs);
    exposed[DENSITIES.len() - 1].people > 0
}

/// The times at which people had left, in one line.
fn left(departures: &Departures) -> String {
    let &Departures { people, left, .. } = departures;
    let time = |time: Option<f64>| time.map_or("–".to_owned(), |time| format!("{time:.2} s"));
    let [half, most, all] = [
        departures.t50_secs,
        departures.t95_secs,
        departures.t100_secs,
    ]
    .map(time);
    format!(
        "Last seen before the last frame: {left} of {people} people, 50 % by {half}, 95 % by {most}, all by {all}."
    )
}

/// One row per density, and one for standing.
fn exposure(safety: &Safety) -> Table {
    let alarms = safety.exposure.alarms.map(Some).into_iter().chain([None]);
    let above = DENSITIES.map(|density| format!("above {density} P/m²"));
    let names = above.into_iter().chain([format!("below {SLOW} m/s")]);
    let exposed = safety.exposure.exposed(safety.secs);
    let rows: Vec<(String, Exposed, Option<Alarm>)> = names
        .zip(exposed)
        .zip(alarms)
        .map(|((name, exposed), alarm)| (name, exposed, alarm))
        .collect();
    let secs = safety.secs;
    Table::of(&rows)
        .column("", |row| row.0.as_str())
        .column("people", |row| row.1.people as usize)
        .fixed("person-seconds", 1, |row| row.1.person_secs)
        .fixed("longest of one [s]", 1, |row| row.1.longest_secs)
        .fixed("largest area [m²]", 2, |row| row.2.map(|alarm| alarm.area))
        .fixed("most at once", 0, |row| {
            row.2.map(|alarm| f64::from(alarm.people))
        })
        .fixed("longest alarm [s]", 1, |row| {
            row.2.map(|alarm| alarm.spell.longest() * secs)
        })
        .table()
}

/// Two rows: walkways and queues.
fn levels(safety: &Safety) -> Table {
    let shares = safety.levels.shares().unwrap_or_default();
    let rows: Vec<(&str, [f64; 6])> = ["walkway", "queue"].into_iter().zip(shares).collect();
    let columns = Table::of(&rows).column("", |row| row.0);
    let levels = LEVELS.into_iter().enumerate();
    levels
        .fold(columns, |columns, (k, level)| {
            let head = level.to_uppercase().to_string();
            columns.fixed(&head, 1, move |row| 100.0 * row.1[k])
        })
        .table()
}

/// As a JSON object.
pub fn json(measured: &Measured) -> Value {
    let safety = &measured.safety;
    let secs = safety.secs;
    let exposed = safety.exposure.exposed(secs);
    let pairs = exposed.iter().zip(&safety.exposure.alarms);
    let dense = pairs.zip(DENSITIES).map(|((exposed, alarm), density)| {
        json!({
            "above_per_m2": density,
            "exposed": exposed,
            "largest_area_m2": alarm.area,
            "most_people": alarm.people,
            "longest_alarm_secs": alarm.spell.longest() * secs,
        })
    });
    let shares = safety.levels.shares();
    let pressures = &safety.pressures;
    json!({
        "note": "thresholds are from the literature, not safety limits",
        "sample_every_secs": secs,
        "dense": dense.collect::<Vec<_>>(),
        "slow": {"below_m_per_s": SLOW, "exposed": exposed[DENSITIES.len()]},
        "service_walkway": shares.map(|[walkway, _]| walkway),
        "service_queue": shares.map(|[_, queue]| queue),
        "crowd_pressure": pressures.peak.map(|(person, time)| json!({
            "max_per_s2": person.pressure,
            "time_secs": time,
            "x": person.position.x,
            "y": person.position.y,
            "density": person.density,
            "mean_per_s2": pressures.mean(),
            "most_people_above_0.02": pressures.people,
            "longest_above_0.02_secs": pressures.spell.longest() * secs,
        })),
        "departures": measured.departures,
    })
}
