//! The marks of agents and their paths, and the legend.

use super::paths::{BORDER, LEAST_WAIT, waited};
use super::{Coloring, Field, Frame, Picture, xy};
use crate::drawing::Drawing;
use crate::scenery::WALKING;
use engine::journeys::Status;
use engine::simulation::Simulation;
use figures::colors::Rgb;
use figures::plot::{BLACK, Disc, Mark, Style, label_lines};

/// The color of agents in pictures of routes, and of those without a value.
pub const FAINT: Rgb = [150, 154, 162];
const TRAIL: Rgb = [104, 116, 142];
/// The width of paths, and with many people, points.
const TRAIL_WIDTH: f64 = 0.6;
const THIN: f64 = 0.3;
/// With more people paths are thin.
const MANY: usize = 1000;
/// The radius of agents in pictures of a field, as a fraction of their own.
const SMALL: f64 = 0.4;
/// Colors of more than this lightness, from 0 to 255, have black dots on them.
const LIGHT: f64 = 120.0;

/// The activities of the people in a picture, in their order.
fn doings(picture: &Picture) -> Vec<(&'static str, Rgb)> {
    match picture.simulation {
        Some(simulation) => {
            let present = simulation.frame().agents.present();
            present.map(|i| doing(simulation, i)).collect()
        }
        None => vec![("walking", WALKING); picture.crowd.len()],
    }
}

/// The activity of agent `i`.
fn doing(simulation: &Simulation, i: usize) -> (&'static str, Rgb) {
    let (agents, clock) = (simulation.frame().agents, simulation.frame().clock);
    if agents
        .walks_from
        .get(i)
        .is_some_and(|&from| clock.time() < from)
    {
        return ("does not walk yet", [120, 150, 190]);
    }
    let trip = agents.trip.get(i).and_then(Option::as_ref);
    match trip.map(|trip| trip.status) {
        Some(Status::Waiting { .. }) => ("waiting", [200, 130, 0]),
        Some(Status::Queued { .. }) => ("in a queue", [170, 80, 140]),
        Some(Status::Finished | Status::Outside { .. }) => ("has ended its journey", FAINT),
        Some(Status::Walking) | None => ("walking", WALKING),
    }
}

impl Coloring {
    fn color(&self, i: usize) -> Rgb {
        let value = self.values.get(i).copied().unwrap_or(f64::NAN);
        match value.is_nan() {
            true => FAINT,
            false => self.bar.map.color(value as f32),
        }
    }
}

impl Field {
    /// Black or white, to be seen on the color at a place.
    fn contrast(&self, [x, y]: [f64; 2]) -> Rgb {
        let cells = &self.cells;
        let [low, high] = cells.extent;
        let rows = cells.values.len() / cells.columns.max(1);
        let part = |at: f64, k: usize, count: usize| {
            let part = (at - low[k]) / (high[k] - low[k]);
            ((part * count as f64).max(0.0) as usize).min(count.saturating_sub(1))
        };
        let k = part(y, 1, rows) * cells.columns + part(x, 0, cells.columns);
        let value = cells.values.get(k).copied().flatten();
        let color = value.map_or([255; 3], |value| cells.map.color(value as f32));
        let [r, g, b] = color.map(f64::from);
        match 0.3 * r + 0.59 * g + 0.11 * b > LIGHT {
            true => BLACK,
            false => [255; 3],
        }
    }
}

/// The agents of a picture; `faint`: in a picture of routes.
pub fn agents(picture: &Picture, faint: bool) -> Option<Mark> {
    let (crowd, doings) = (picture.crowd, doings(picture));
    let disc = |i: usize| {
        let (center, radius) = (xy(crowd.position[i]), crowd.radius[i]);
        let (radius, color) = match (&picture.field, &picture.coloring) {
            _ if faint => (radius, FAINT),
            (Some(field), _) => (SMALL * radius, field.contrast(center)),
            (None, Some(coloring)) => (radius, coloring.color(i)),
            (None, None) => (radius, doings[i].1),
        };
        Disc {
            center,
            radius,
            color,
        }
    };
    let shown = (0..crowd.len()).filter(|&i| picture.shows(i));
    let discs: Vec<Disc> = shown.map(disc).collect();
    (!discs.is_empty()).then_some(Mark::Discs(discs))
}

/// The paths of the last seconds.
pub fn trails(picture: &Picture) -> Vec<Mark> {
    let Some(trails) = picture.trails else {
        return Vec::new();
    };
    let many = picture.crowd.len() > MANY;
    let style = Style::full(TRAIL, if many { THIN } else { TRAIL_WIDTH }, "");
    let lines = trails.lines().map(|one| one.into_iter().map(xy).collect());
    lines.map(|line| Mark::Line(line, style.clone())).collect()
}

/// The line above a picture: the time and the number of agents, unless it has its own.
pub fn summary(picture: &Picture) -> String {
    if let Some(heading) = &picture.heading {
        return heading.clone();
    }
    let count = (0..picture.crowd.len())
        .filter(|&i| picture.shows(i))
        .count();
    let ending = if count == 1 { "" } else { "s" };
    let level = picture.drawing.and_then(Drawing::only_level);
    let on_level = level.map_or(String::new(), |name| format!(" on {name}"));
    format!(
        "{:.2} s, {count} agent{ending}{on_level}",
        picture.crowd.time
    )
}

/// An entry of the legend.
pub struct Entry {
    pub text: String,
    look: Look,
}

enum Look {
    Agent(Rgb),
    Dot(Rgb),
    Line(Style),
    /// Another line of the entry before.
    Rest,
}

impl Entry {
    /// The entry in lines whose texts are at most `most` points wide, if words are.
    pub fn lines(self, most: f64) -> impl Iterator<Item = Self> {
        let lines = label_lines(&self.text, most).into_iter();
        let looks = std::iter::once(self.look).chain(std::iter::repeat_with(|| Look::Rest));
        lines.zip(looks).map(|(text, look)| Self { text, look })
    }

    /// Its sample, which begins at a place.
    pub fn sample(&self, [x, y]: [f64; 2], frame: &Frame) -> Vec<Mark> {
        let at = |points: f64| [x + frame.meters(points), y];
        match &self.look {
            Look::Agent(color) => vec![Mark::dots([at(8.0)], Style::full(*color, 3.0, ""))],
            Look::Dot(color) => vec![Mark::dots([at(8.0)], Style::full(*color, 1.7, ""))],
            Look::Line(style) => vec![Mark::Line(vec![at(0.0), at(11.0)], style.clone())],
            Look::Rest => Vec::new(),
        }
    }
}

/// The entries of the legend.
pub fn legend(picture: &Picture, has_paths: bool) -> Vec<Entry> {
    let entry = |text: &str, look| Entry {
        text: text.to_owned(),
        look,
    };
    if has_paths {
        let by_time = picture.scene.by_time() && picture.scene.rooms().is_some();
        let way = if by_time {
            "quickest way now"
        } else {
            "shortest way"
        };
        let words = format!("people wait {LEAST_WAIT} s or more");
        let waits = entry(&words, Look::Line(waited(LEAST_WAIT)));
        let shown = [
            entry("agent", Look::Agent(FAINT)),
            entry(way, Look::Line(Style::full(BLACK, 0.9, ""))),
            entry(
                "border of the same next corner",
                Look::Line(Style::full(BORDER, 0.6, "")),
            ),
            entry("corner", Look::Dot(BORDER)),
        ];
        return shown.into_iter().chain(by_time.then_some(waits)).collect();
    }
    let path = picture.trails.map(|trails| {
        let text = format!("path of the last {} s", trails.secs);
        entry(&text, Look::Line(Style::full(TRAIL, TRAIL_WIDTH, "")))
    });
    if let Some(coloring) = &picture.coloring {
        let has_unknown = coloring.values.iter().any(|value| value.is_nan());
        let unknown = has_unknown.then(|| entry("no data", Look::Agent(FAINT)));
        return unknown.into_iter().chain(path).collect();
    }
    if picture.field.is_some() {
        return path.into_iter().collect();
    }
    let mut entries = Vec::new();
    for seen in doings(picture) {
        if !entries.contains(&seen) {
            entries.push(seen);
        }
    }
    entries.sort_by_key(|(text, _)| std::cmp::Reverse(*text));
    if let [(text, _)] = &mut entries[..]
        && picture.scene.journeys.places.is_empty()
    {
        *text = "agent";
    }
    let shown = entries.into_iter();
    shown
        .map(|(text, color)| entry(text, Look::Agent(color)))
        .chain(path)
        .collect()
}
