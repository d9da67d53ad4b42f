//! Moments in whole numbers, and the frames that are compressed together.

use serde_json::{Value, json};

use super::block::{Block, Body};
use super::moment::Moment;
use super::options::PageOptions;
use super::{ACCELERATION, DENSITY, POSITION, RADIUS, SPEED};
use engine::math::Vector;

/// The most frames that are compressed together, and the number of persons, summed over frames, that ends a block.
const MOST_FRAMES: u32 = 256;
const ROWS: usize = 1 << 20;

/// How moments of a scene become numbers.
#[derive(Debug, Clone)]
pub struct Code {
    origin: Vector,
    has_trips: bool,
    /// The number of columns of forces.
    forces: usize,
    /// The number of time series.
    series: usize,
}

/// A moment in whole numbers.
#[derive(Debug, Clone)]
pub struct Coded {
    time: f64,
    people: Vec<(i64, Body)>,
    /// The values of all columns, person by person.
    values: Vec<i32>,
    forces: Vec<(i64, Vec<i32>)>,
    series: Vec<Option<f64>>,
    events: Vec<Value>,
}

impl Code {
    /// The code of a page with positions from `origin` on.
    pub fn new(origin: Vector, options: &PageOptions) -> Self {
        Self {
            origin,
            has_trips: !options.places.is_empty(),
            forces: 2 * options.terms.len(),
            series: options.series.len(),
        }
    }

    /// The names of the columns of people.
    pub fn columns(&self) -> Vec<&'static str> {
        let mut columns = vec!["x", "y", "density", "speed"];
        if self.has_trips {
            columns.extend(["trip", "place"]);
        }
        columns
    }

    /// A moment in this code.
    pub fn of(&self, moment: &Moment) -> Coded {
        let crowd = moment.crowd;
        let mut values = Vec::with_capacity(crowd.id.len() * self.columns().len());
        let mut people = Vec::with_capacity(crowd.id.len());
        for (k, (&id, position)) in crowd.id.iter().zip(&crowd.position).enumerate() {
            values.extend([0, 1].map(|axis| whole(position[axis] - self.origin[axis], POSITION)));
            values.push(known(moment.density.get(k).copied(), DENSITY));
            values.push(known(moment.speed.get(k).copied(), SPEED));
            if self.has_trips {
                values.extend(moment.trips.get(k).copied().unwrap_or_default());
            }
            let group = moment.groups.get(k).copied().unwrap_or(0);
            let body = [whole(crowd.radius[k], RADIUS).unsigned_abs(), group.into()];
            people.push((id, body));
        }
        let components = |terms: &Vec<Vector>| -> Vec<i32> {
            let all = terms.iter().flat_map(|term| [term.x, term.y]);
            all.map(|value| whole(value, ACCELERATION)).collect()
        };
        let forces = moment.forces.iter();
        let series = moment.series.iter();
        let events = moment.events.iter();
        Coded {
            time: crowd.time,
            people,
            values,
            forces: forces
                .map(|(id, terms)| ((*id).into(), components(terms)))
                .collect(),
            series: series
                .map(|value| value.filter(|value| value.is_finite()).map(rounded))
                .collect(),
            events: events
                .map(|line| json!([line.time, line.text, line.level == "WARN"]))
                .collect(),
        }
    }
}

impl Coded {
    /// The number of people.
    pub fn people(&self) -> usize {
        self.people.len()
    }

    /// Moves what happened before into this moment: for a page that does not show the moment before.
    pub fn take_events(&mut self, before: &Self) {
        let own = std::mem::replace(&mut self.events, before.events.clone());
        self.events.extend(own);
    }
}

/// Frames that are compressed together.
pub struct Frames {
    crowd: Block,
    /// Without forces, it is not written.
    forces: Block,
    has_forces: bool,
    times: Vec<f64>,
    series: Vec<Vec<Option<f64>>>,
    events: Vec<Value>,
}

impl Frames {
    /// No frames.
    pub fn new(code: &Code) -> Self {
        Self {
            crowd: Block::new(code.columns().len()),
            forces: Block::new(code.forces),
            has_forces: code.forces > 0,
            times: Vec::new(),
            series: vec![Vec::new(); code.series],
            events: Vec::new(),
        }
    }

    /// Adds a moment, later than those before.
    pub fn add(&mut self, coded: &Coded) {
        self.begin_with(coded);
        self.times.push(coded.time);
        for (values, &value) in self.series.iter_mut().zip(&coded.series) {
            values.push(value);
        }
        self.events.extend(coded.events.iter().cloned());
    }

    /// Adds the last moment of the frames before, which is not shown twice: people move on from there.
    pub fn begin_with(&mut self, coded: &Coded) {
        self.crowd.begin_frame();
        let width = coded.values.len() / coded.people.len().max(1);
        for (&(id, body), values) in coded.people.iter().zip(coded.values.chunks(width.max(1))) {
            self.crowd.add(id, body, values.iter().copied());
        }
        self.forces.begin_frame();
        for (id, values) in &coded.forces {
            self.forces.add(*id, [0, 0], values.iter().copied());
        }
    }

    /// Whether they are enough for one part of a page.
    pub fn is_full(&self) -> bool {
        self.crowd.rows() >= ROWS || self.crowd.frames() >= MOST_FRAMES
    }

    /// Whether nothing has been added since the last part.
    pub fn is_empty(&self) -> bool {
        self.times.is_empty() && self.events.is_empty()
    }

    /// The people, the forces on some of them if the page has any, and the time series; nothing is left.
    pub fn take(&mut self) -> (Vec<Block>, Value) {
        let take = |block: &mut Block| {
            let next = block.next();
            std::mem::replace(block, next)
        };
        let mut blocks = vec![take(&mut self.crowd)];
        let forces = take(&mut self.forces);
        if self.has_forces {
            blocks.push(forces);
        }
        let values: Vec<_> = self.series.iter_mut().map(std::mem::take).collect();
        let times = std::mem::take(&mut self.times);
        let events = std::mem::take(&mut self.events);
        let series = json!({"times": times, "series": values, "events": events});
        (blocks, series)
    }
}

/// The nearest whole number of units. `as` saturates, and NaN is 0.
fn whole(value: f64, unit: f64) -> i32 {
    (value / unit).round() as i32
}

/// One more than the nearest whole number of units; 0 if the value is unknown.
fn known(value: Option<f64>, unit: f64) -> i32 {
    let value = value.filter(|value| value.is_finite());
    value.map_or(0, |value| whole(value, unit).saturating_add(1))
}

/// With five significant digits.
fn rounded(value: f64) -> f64 {
    format!("{value:.4e}").parse().unwrap_or(value)
}
