//! Who enters, and who passes the lines of exits, doors and waypoints.

use engine::journeys::{ChangeKind, Kind, Place};
use engine::math::Vector;
use engine::scene::Scene;
use engine::simulation::Simulation;
use output::document::Block;
use output::table::Table;
use scenario::Scenario;
use scenario::quote::shown;

/// Lines are sampled this often, and walls are looked for this far from them, meters.
const STEP: f64 = 0.01;
const BESIDE: f64 = 0.02;

/// The people who enter, by group, and those who pass places, so far.
pub struct Passages {
    /// The agents of each group that have entered.
    pub entered: Vec<u32>,
    /// The agents that had entered in the last frame.
    known: u32,
    /// For each place: the agents that have passed it, and when the first and the last one had, seconds.
    passed: Vec<(u32, Option<[f64; 2]>)>,
}

impl Passages {
    /// No people yet.
    pub fn new(scenario: &Scenario) -> Self {
        let scene = &scenario.scene;
        Self {
            entered: vec![0; scene.groups.len()],
            known: 0,
            passed: vec![(0, None); scene.journeys.places.len()],
        }
    }

    /// Sees an evaluated frame. Call it in every frame.
    pub fn see(&mut self, simulation: &Simulation) {
        let frame = simulation.frame();
        let (agents, time) = (frame.agents, frame.clock.time());
        if agents.entered() > self.known {
            // New agents have the highest ids.
            for i in agents.present().filter(|&i| agents.id[i] >= self.known) {
                if let Some(count) = self.entered.get_mut(usize::from(agents.group[i])) {
                    *count += 1;
                }
            }
            self.known = agents.entered();
        }
        for (place, state) in self.passed.iter_mut().zip(&simulation.progress().places) {
            if state.passed > place.0 {
                let first = place.1.map_or(time, |[first, _]| first);
                *place = (state.passed, Some([first, time]));
            }
        }
    }

    /// The lines that people pass: their free widths, when they are open, and who passes them. Nothing without lines.
    pub fn table(&self, scene: &Scene) -> Option<Block> {
        let places = scene.journeys.places.iter().enumerate();
        let row = |(k, place): (usize, &Place)| {
            let (people, times) = self.passed.get(k).copied().unwrap_or_default();
            let width = free_width(scene, place.line()?);
            let between = times.map(|[first, last]| last - first);
            let lasts = between.filter(|&lasts| people > 1 && lasts > 0.0 && width > 0.0);
            Some(Row {
                name: shown(&place.name),
                kind: place.kind.name(),
                width,
                open: open(scene, k, &place.kind),
                most: match &place.kind {
                    Kind::Exit(exit) => exit.most_per_sec,
                    _ => None,
                },
                people,
                times,
                flow: lasts.map(|lasts| f64::from(people - 1) / lasts / width),
            })
        };
        let rows: Vec<Row> = places.filter_map(row).collect();
        let mut begun = Table::of(&rows)
            .column("place", |row| row.name.as_str())
            .column("kind", |row| row.kind)
            .fixed("free width [m]", 2, |row| row.width)
            .column("open [s]", |row| row.open.as_str());
        if rows.iter().any(|row| row.most.is_some()) {
            begun = begun.column("at most [P/s]", |row| row.most);
        }
        let table = begun
            .column("people", |row| row.people)
            .fixed("first [s]", 1, |row| row.times.map(|[first, _]| first))
            .fixed("last [s]", 1, |row| row.times.map(|[_, last]| last))
            .fixed("P/(m s)", 2, |row| row.flow)
            .table();
        let caption = "Free width: the length of the line without walls on it or flush with it. Open: by timetable and \
                       events. At most: the limit `most_per_sec` of an exit. P/(m s): the people after the first \
                       one, per meter of free width and second between the first and the last one. Waypoints count \
                       the people who have them as a stage.";
        (!rows.is_empty()).then(|| Block::Table(table, caption.to_owned()))
    }
}

/// A row of the table.
struct Row {
    name: String,
    kind: &'static str,
    width: f64,
    open: String,
    most: Option<f64>,
    people: u32,
    times: Option<[f64; 2]>,
    flow: Option<f64>,
}

/// The length of a line without the parts that have walls on them or beside them, meters.
fn free_width(scene: &Scene, [a, b]: [Vector; 2]) -> f64 {
    let length = (b - a).norm();
    let count = (length / STEP).ceil().max(1.0);
    let across = Vector::new(a.y - b.y, b.x - a.x) * (BESIDE / length.max(STEP));
    let is_free = |k: &usize| {
        let p = a + (b - a) * ((*k as f64 + 0.5) / count);
        let mut sides = [p - across, p + across].into_iter();
        sides.all(|side| scene.walls.obstacle_at(side).is_none())
    };
    length * (0..count as usize).filter(is_free).count() as f64 / count
}

/// When a place is open.
fn open(scene: &Scene, k: usize, kind: &Kind) -> String {
    if !matches!(kind, Kind::Exit(_) | Kind::Door(_)) {
        return "always".to_owned();
    }
    let all = scene.journeys.changes.iter();
    let changes = all.filter(|change| usize::from(change.place) == k);
    let mut spans: Vec<[Option<f64>; 2]> = vec![[Some(0.0), None]];
    for change in changes {
        match (change.kind, spans.last_mut()) {
            (ChangeKind::Close, Some(last)) if last[1].is_none() => last[1] = Some(change.at),
            (ChangeKind::Open, Some([_, Some(closed)])) if *closed < change.at => {
                spans.push([Some(change.at), None]);
            }
            (ChangeKind::Open, Some(last)) => last[1] = None,
            _ => {}
        }
    }
    spans.retain(|[from, to]| from != to);
    let text = |[from, to]: &[Option<f64>; 2]| match (from, to) {
        (Some(0.0), None) => "always".to_owned(),
        (Some(from), Some(to)) => format!("{from} to {to}"),
        (from, _) => format!("from {}", from.unwrap_or_default()),
    };
    match spans.is_empty() {
        true => "never".to_owned(),
        false => spans.iter().map(text).collect::<Vec<_>>().join(", "),
    }
}
