//! What happened since it was last asked for: who entered, left, was removed, crossed a line or got stuck.

use pyo3::prelude::*;
use pyo3::types::PyBytes;
use sandbox::engine::math::Vector;
use sandbox::engine::routes::side;
use sandbox::engine::simulation::Simulation;
use sandbox::runs::drive::Run;

/// No place.
const NONE: i32 = -1;

/// One thing that happened to an agent.
#[derive(Clone, Copy)]
struct Row {
    id: u32,
    time: f64,
    position: Vector,
    /// The number of the place, or [`NONE`].
    place: i32,
    /// 1 from the left of a line to its right, −1 the other way, else 0.
    direction: i32,
}

impl Row {
    /// A row without a place.
    fn at(id: u32, time: f64, position: Vector) -> Self {
        Self {
            id,
            time,
            position,
            place: NONE,
            direction: 0,
        }
    }

    /// The bytes of `EVENT` in `_simulation.py`.
    fn bytes(&self) -> [u8; 40] {
        let mut bytes = [0; 40];
        let parts: [&[u8]; 6] = [
            &i64::from(self.id).to_ne_bytes(),
            &self.time.to_ne_bytes(),
            &self.position.x.to_ne_bytes(),
            &self.position.y.to_ne_bytes(),
            &self.place.to_ne_bytes(),
            &self.direction.to_ne_bytes(),
        ];
        let mut at = 0;
        for part in parts {
            bytes[at..at + part.len()].copy_from_slice(part);
            at += part.len();
        }
        bytes
    }
}

/// Observes a simulation, frame by frame.
#[derive(Clone)]
pub struct Watch {
    /// By id; NaN for agents that are absent.
    before: Vec<Vector>,
    entered: Vec<Row>,
    crossed: Vec<Row>,
    /// The number of arrivals and removals that were reported.
    reported: [usize; 2],
    stuck: Vec<u32>,
}

impl Watch {
    /// Begins in the current frame, in which nothing has happened yet.
    pub fn begin(run: &Run) -> Self {
        let mut watch = Self {
            before: Vec::new(),
            entered: Vec::new(),
            crossed: Vec::new(),
            reported: counts(&run.simulation),
            stuck: run.metrics.stuck_ids(&run.simulation),
        };
        watch.observe(&run.simulation);
        watch.entered.clear();
        watch
    }

    /// Observes the current frame, which follows the one observed before.
    pub fn observe(&mut self, simulation: &Simulation) {
        let frame = simulation.frame();
        let (agents, time) = (frame.agents, frame.clock.time());
        let absent = Vector::repeat(f64::NAN);
        let before = std::mem::take(&mut self.before);
        self.before.resize(agents.entered() as usize, absent);
        let lines: Vec<(i32, [Vector; 2])> = (0..)
            .zip(&simulation.scene().journeys.places)
            .filter_map(|(number, place)| Some((number, place.line()?)))
            .collect();
        for i in agents.present() {
            let (id, position) = (agents.id[i], agents.position[i]);
            self.before[id as usize] = position;
            let row = |place, direction| Row {
                id,
                time,
                position,
                place,
                direction,
            };
            let Some(&from) = before.get(id as usize) else {
                self.entered.push(row(NONE, 0));
                continue;
            };
            for &(number, line) in &lines {
                if let Some(direction) = crossed([from, position], line) {
                    self.crossed.push(row(number, direction));
                }
            }
        }
        self.entered.sort_by_key(|row| row.id);
    }

    /// All since it was last asked for: those who entered, left, were removed and crossed lines, as rows of bytes; and
    /// the ids of those who are stuck and were not.
    pub fn take<'py>(
        &mut self,
        py: Python<'py>,
        run: &Run,
    ) -> ([Bound<'py, PyBytes>; 4], Vec<u32>) {
        let outcome = run.simulation.outcome();
        let arrivals = outcome.arrivals[self.reported[0]..].iter();
        let left = arrivals.map(|arrival| Row {
            place: arrival.trip.map_or(NONE, |trip| i32::from(trip.exit)),
            ..Row::at(arrival.id, arrival.time, arrival.position)
        });
        let left = left.collect();
        let removals = outcome.removed[self.reported[1]..].iter();
        let removed = removals.map(|one| Row::at(one.id, one.time, one.position));
        let removed = removed.collect();
        self.reported = counts(&run.simulation);
        let entered = std::mem::take(&mut self.entered);
        let mut crossed = std::mem::take(&mut self.crossed);
        crossed.sort_by(|a, b| a.time.total_cmp(&b.time).then(a.id.cmp(&b.id)));
        let rows = [entered, left, removed, crossed].map(|rows| {
            let bytes: Vec<u8> = rows.iter().flat_map(Row::bytes).collect();
            PyBytes::new(py, &bytes)
        });
        let stuck = run.metrics.stuck_ids(&run.simulation);
        let known = std::mem::replace(&mut self.stuck, stuck);
        let new = self.stuck.iter().filter(|id| !known.contains(id));
        (rows, new.copied().collect())
    }
}

fn counts(simulation: &Simulation) -> [usize; 2] {
    let outcome = simulation.outcome();
    [outcome.arrivals.len(), outcome.removed.len()]
}

/// In which direction a move crosses a line, if it does.
fn crossed([from, to]: [Vector; 2], [a, b]: [Vector; 2]) -> Option<i32> {
    let low = a.inf(&b) - (to - from).abs();
    let high = a.sup(&b) + (to - from).abs();
    let is_near = low.x <= to.x && low.y <= to.y && to.x <= high.x && to.y <= high.y;
    if !is_near {
        return None;
    }
    let [start, end] = [from, to].map(|p| side(a, b, p) > 0.0);
    let [left, right] = [a, b].map(|p| side(from, to, p) > 0.0);
    (start != end && left != right).then_some(if start { 1 } else { -1 })
}
