//! The flow of people across a line, with density and speed before it.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::window::walkable_area;
use super::{Measure, Observed, Quantity};
use crate::error::Problem;
use crate::keys::shapes::{Corners, Point, wide_region};
use crate::trajectories::Tracks;
use analysis::crossing::{Balance, Line, Passages};
use analysis::evaluated::Evaluated;
use engine::clock::Clock;
use engine::math::Vector;
use engine::scene::{Region, Scene};
use engine::simulation::Simulation;

/// Values by their names, and data with their name.
type Measured = (Vec<(String, Option<f64>)>, (String, Value));

/// The name of the values if none is given.
const NAME: &str = "line";
/// The part of the passages that counts if none is given.
const PART: [f64; 2] = [0.1, 0.9];
/// Time between the frames in which density and speed are measured, seconds. Speeds are means from one before to one
/// after.
const EVERY_SECS: f64 = 0.2;

/// The flow of people across a line, in either direction, between two parts of all passages; density and speed in a
/// region in the same time. A person who sways back and forth passes once.
#[derive(Debug, Clone, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LineFlow {
    /// The beginning of the names of its values. Default: `line`.
    #[schemars(length(min = 1))]
    name: Option<String>,
    /// The ends of the line, meters. The second one does not belong to it.
    line: [Point; 2],
    /// The region: lower left and upper right corner, meters.
    pub(super) region: Option<Corners>,
    /// Which passages count, as parts of all: from the first 10 % to the first 90 % if missing.
    #[schemars(inner(range(min = 0, max = 1)))]
    part: Option<[f64; 2]>,
}

/// An agent on its way.
#[derive(Debug, Clone, Copy, Serialize, Deserialize)]
struct Track {
    /// Its position in the last frame, meters.
    last: Vector,
    /// Its positions in the last two frames in which density was measured, the latest last, meters.
    sampled: [Option<Vector>; 2],
    balance: Balance,
}

/// The agents in the region at one time.
#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
struct Sample {
    /// Seconds.
    time: f64,
    agents: u32,
    /// Those whose speed is known.
    moving: u32,
    /// The sum of their speeds, m/s.
    speeds: f64,
}

/// What was seen so far.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct Seen {
    /// By id.
    tracks: Vec<Option<Track>>,
    /// Times of the passages, seconds, ascending.
    times: Vec<f64>,
    samples: Vec<Sample>,
    /// How many arrivals were seen.
    arrivals: usize,
    /// The line's continuations to the next walls, which follow from the scene.
    #[serde(skip)]
    beside: Option<[Line; 2]>,
}

impl LineFlow {
    fn name(&self) -> &str {
        self.name.as_deref().unwrap_or(NAME)
    }

    fn line(&self) -> Line {
        let [start, end] = self.line.map(Vector::from);
        Line { start, end }
    }

    /// The times of the first and the last passage that count, and the flow between them, P/s.
    fn flow(&self, times: &[f64]) -> Option<([f64; 2], f64)> {
        let flow = Passages::Parts(self.part.unwrap_or(PART)).flow(times)?;
        Some((flow.secs, flow.flow_per_s))
    }
}

impl Measure for LineFlow {
    type Seen = Seen;

    fn places(&self) -> Vec<(&'static str, Observed)> {
        let line = (
            "line_flow.line",
            Observed::Line(self.line.map(Vector::from)),
        );
        let region = Observed::region("line_flow.region", self.region);
        std::iter::once(line).chain(region).collect()
    }

    fn check(&self) -> Result<(), Problem> {
        let problem = |key: &str, reason: &str| Err(Problem::new(key, reason));
        if self.line().length() == 0.0 {
            return problem("line_flow.line", "both ends are the same point");
        }
        if self.part.is_some_and(|[first, last]| first >= last) {
            return problem("line_flow.part", "the first part must be below the second");
        }
        self.region.map_or(Ok(()), |corners| {
            wide_region("line_flow.region", corners).map(|_| ())
        })
    }

    fn quantities(&self) -> Vec<Quantity> {
        let [first, last] = self.part.unwrap_or(PART).map(|part| 100.0 * part);
        let part = format!("from the first {first} % to {last} % of the passages");
        let flow = format!("passages per second {part}");
        let density = format!("people in the region / its walkable area, mean {part}");
        let speed = format!("mean speed in the region {part}");
        let at_line = [
            (
                "passages",
                "agents",
                "passages of the line in the whole run, in either direction",
            ),
            ("flow_per_s", "P/s", &flow),
        ];
        let in_region = [
            ("density_per_m2", "P/m²", density.as_str()),
            ("speed_m_per_s", "m/s", &speed),
        ];
        let mut all = Quantity::all(self.name(), &at_line);
        if self.region.is_some() {
            all.extend(Quantity::all(self.name(), &in_region));
        }
        all
    }

    fn observe(&self, seen: &mut Seen, evaluated: &Evaluated) {
        let simulation = evaluated.simulation;
        let frame = simulation.frame();
        let agents = frame.agents;
        let arrivals = &simulation.outcome().arrivals;
        let new = &arrivals[seen.arrivals..];
        seen.arrivals = arrivals.len();
        let moment = Moment {
            clock: frame.clock,
            scene: simulation.scene(),
            entered: agents.entered() as usize,
        };
        let gone = new.iter().map(|arrival| (arrival.id, arrival.position));
        let there = agents.present().map(|i| (agents.id[i], agents.position[i]));
        self.see(seen, &moment, gone, there);
    }

    fn values(&self, seen: &Seen, simulation: &Simulation) -> Vec<Option<f64>> {
        self.results(seen, simulation.scene())
    }

    fn data(&self, seen: &Seen) -> Option<(String, Value)> {
        Some((self.name().to_owned(), json!(seen.times)))
    }
}

/// A frame, apart from the people.
struct Moment<'a> {
    clock: &'a Clock,
    scene: &'a Scene,
    /// Above all ids.
    entered: usize,
}

/// The line in a scene, with its continuations to the next walls.
struct Crossing<'a> {
    line: Line,
    beside: [Line; 2],
    scene: &'a Scene,
}

impl Crossing<'_> {
    /// Moves a track to its next position. Returns after which part of the move it passed the line, if it did.
    fn passed(&self, track: &mut Track, position: Vector) -> Option<f64> {
        // A move across the end of the period is seen at both ends.
        let last = std::mem::replace(&mut track.last, position);
        let way = self.scene.walked(last, position);
        let leaving = self.line.crossed(last, last + way);
        let crossed = leaving.or_else(|| self.line.crossed(position - way, position));
        if let Some((part, is_forward)) = crossed {
            return track.balance.passes(is_forward).then_some(part);
        }
        let mut beside = self.beside.iter();
        if let Some((_, is_forward)) = beside.find_map(|line| line.crossed(last, last + way)) {
            track.balance.goes_around(is_forward);
        }
        None
    }
}

impl LineFlow {
    /// The values, by their names, and the data for people in `tracks` from the time `at` in it, seconds, on. They are
    /// measured as in a run of `scene` that begins at `at`.
    pub fn of_tracks(&self, tracks: &Tracks, at: f64, scene: &Scene) -> Measured {
        let times: Vec<[f64; 2]> = (0..tracks.ids.len()).map(|p| tracks.times_of(p)).collect();
        let last = times.iter().map(|[_, last]| *last).fold(at, f64::max);
        let mut clock = scene.clock;
        let mut seen = Seen::default();
        for frame in 0..=clock.frame_at(last - at) {
            clock.go_to(frame);
            let time = at + clock.time();
            let is_there = |&p: &usize| {
                let ([first, last], near) = (times[p], tracks.rounding());
                (first - near..=last + near).contains(&time)
            };
            let people = (0..times.len()).filter(is_there);
            let there = people.map(|p| (p as u32, tracks.place_at(p, time)));
            let moment = Moment {
                clock: &clock,
                scene,
                entered: times.len(),
            };
            self.see(&mut seen, &moment, std::iter::empty(), there);
        }
        let measured = Quantity::paired(self.quantities(), self.results(&seen, scene));
        let values = measured.map(|(one, value)| (one.name, value)).collect();
        (values, (self.name().to_owned(), json!(seen.times)))
    }

    /// Sees people in a frame: those who have left since the frame before, and those who are there.
    fn see(
        &self,
        seen: &mut Seen,
        moment: &Moment,
        gone: impl Iterator<Item = (u32, Vector)>,
        there: impl Iterator<Item = (u32, Vector)>,
    ) {
        let Moment { clock, scene, .. } = *moment;
        let (now, step) = (clock.time(), clock.time_step());
        let line = self.line();
        let before = seen.times.len();
        seen.tracks.resize(moment.entered, None);
        let beside = *seen.beside.get_or_insert_with(|| line.beside(&scene.walls));
        let crossing = Crossing {
            line,
            beside,
            scene,
        };
        let time_of = |part: f64| now - step + step * part;
        for (id, position) in gone {
            if let Some(mut track) = seen.tracks[id as usize].take() {
                let passed = crossing.passed(&mut track, position);
                seen.times.extend(passed.map(time_of));
            }
        }
        let every = clock.frame_at(EVERY_SECS).max(1);
        let is_due = clock.frame().is_multiple_of(every);
        let region = self.region.map(Region::from);
        let is_inside = |p: Vector| region.is_some_and(|region| region.contains(p));
        let mut sample = Sample {
            time: now,
            ..Sample::default()
        };
        for (id, position) in there {
            let track = seen.tracks[id as usize].get_or_insert(Track {
                last: position,
                sampled: [None; 2],
                balance: Balance::default(),
            });
            let passed = crossing.passed(track, position);
            seen.times.extend(passed.map(time_of));
            if is_due {
                sample.agents += u32::from(is_inside(position));
                if let [Some(first), Some(middle)] = track.sampled
                    && is_inside(middle)
                    && let Some(before) = seen.samples.last_mut()
                {
                    let way = crossing.scene.walked(first, position);
                    before.moving += 1;
                    before.speeds += way.norm() / (2.0 * every as f64 * step);
                }
                track.sampled = [track.sampled[1], Some(position)];
            }
        }
        seen.times[before..].sort_by(f64::total_cmp);
        if is_due && region.is_some() {
            seen.samples.push(sample);
        }
    }

    fn results(&self, seen: &Seen, scene: &Scene) -> Vec<Option<f64>> {
        let flow = self.flow(&seen.times);
        let ends = flow.map_or([f64::NAN; 2], |(ends, _)| ends);
        let all = seen.samples.iter();
        let samples = all.filter(|sample| (ends[0]..=ends[1]).contains(&sample.time));
        let (mut count, mut agents, mut moving, mut speeds) = (0.0, 0.0, 0.0, 0.0);
        for sample in samples {
            count += 1.0;
            agents += f64::from(sample.agents);
            moving += f64::from(sample.moving);
            speeds += sample.speeds;
        }
        let mut values = vec![Some(seen.times.len() as f64), flow.map(|(_, flow)| flow)];
        if let Some(region) = self.region {
            let area = || walkable_area(region.into(), scene);
            values.extend([
                (count > 0.0).then(|| agents / (count * area())),
                (moving > 0.0).then(|| speeds / moving),
            ]);
        }
        values
    }
}
