//! A run that is played: at the speed asked for, set back, changed from outside. It lives on a thread of its own.

use std::ops::RangeInclusive;
use std::sync::Arc;
use std::time::{Duration, Instant};

use engine::breakdown::Breakdown;
use engine::math::Vector;
use engine::simulation::Added;
use output::drawing::{Drawing, Drawn};
use output::events::Events;
use output::page::{Live, Moment, PageOptions};
use output::picture::{Crowd, Picture};
use output::recording::{Address, DebugAgents};
use runs::drive::Run;
use runs::notes;
use scenario::Scenario;
use serde_json::{Value, json};

use crate::answer::Refusal;
use crate::beside::Beside;
use crate::doors::Doors;
use crate::feed::Feed;
use crate::pace::Pace;
use crate::snapshots::{Snapshot, Snapshots};

/// The most pictures per second that pages get.
const PICTURES: f64 = 30.0;
/// The longest time between two looks at what is asked for.
const SLICE: Duration = Duration::from_millis(20);
/// The speeds, seconds of the run per second.
const SPEEDS: RangeInclusive<f64> = 0.001..=1e6;

/// A run that is played.
pub struct Player {
    run: Run,
    live: Arc<Live>,
    drawing: Option<Drawing>,
    events: Events,
    doors: Doors,
    snapshots: Snapshots,
    feed: Arc<Feed>,
    beside: Beside,
    /// The time that the latest frame took, milliseconds.
    ms_per_frame: f64,
    /// The person whose forces pages show.
    followed: Option<u32>,
    /// The frame in which the scenario ended: who plays on then goes beyond it.
    ended: Option<u64>,
    /// The time from which on queues are observed, seconds.
    observed_from: f64,
    fault: Option<String>,
    /// The number of the frame that pages got last.
    sent: Option<u64>,
    /// The frame to which the run moves as fast as it can, before it is shown again.
    target: Option<u64>,
    pace: Pace,
    shown: Instant,
    warnings: Vec<String>,
}

impl Player {
    /// A run of a scenario in its first frame, which leaves its frames in `feed`, and shows them in `viewer`, too.
    ///
    /// # Errors
    /// An agent cannot enter, or a number is not finite.
    pub fn new(
        scenario: Scenario,
        feed: Arc<Feed>,
        viewer: Option<Address>,
    ) -> Result<Self, Refusal> {
        let run = Run::new(scenario).map_err(Refusal::impossible)?;
        let first = Snapshot {
            frame: run.simulation.frame().clock.frame(),
            events: Events::new(run.scenario.entering),
            doors: Doors::default(),
            run,
        };
        Self::of(first, Snapshots::default(), feed, viewer)
    }

    fn of(
        first: Snapshot,
        snapshots: Snapshots,
        feed: Arc<Feed>,
        viewer: Option<Address>,
    ) -> Result<Self, Refusal> {
        let mut run = first.run;
        // Densities depend on those before, so every frame needs them.
        run.simulation.request_density_until(u64::MAX);
        run.simulation.evaluate().map_err(Refusal::impossible)?;
        let (live, drawing) = page(&run);
        let time = run.simulation.frame().clock.time();
        let mut player = Self {
            events: first.events,
            run,
            live: Arc::new(live),
            drawing,
            doors: first.doors,
            snapshots,
            feed,
            beside: Beside::new(viewer),
            ms_per_frame: 0.0,
            followed: None,
            ended: None,
            observed_from: time,
            fault: None,
            sent: None,
            target: None,
            pace: Pace::at(time),
            shown: Instant::now(),
            warnings: Vec::new(),
        };
        player.observe();
        player.warn();
        player.show(false);
        player.tell();
        Ok(player)
    }

    /// The plan as it is now: closed doors look different.
    pub fn scene(&self) -> Value {
        page(&self.run).0.scene().clone()
    }

    /// The code of its frames.
    pub fn live(&self) -> Arc<Live> {
        self.live.clone()
    }

    /// The run, evaluated.
    pub fn run(&self) -> &Run {
        &self.run
    }

    /// How long the run has nothing to do; `None`: until it is asked for something.
    pub fn idle(&self) -> Option<Duration> {
        if self.target.is_some() {
            return Some(Duration::ZERO);
        }
        if !self.pace.playing {
            return None;
        }
        let clock = self.run.simulation.frame().clock;
        let next = clock.time_at(clock.frame() + 1);
        let left = match self.pace.speed {
            Some(speed) => (next - self.pace.due()) / speed,
            None => 0.0,
        };
        Some(Duration::try_from_secs_f64(left.max(0.0)).unwrap_or_default())
    }

    /// Computes the frames that are due, for at most a short while.
    pub fn play(&mut self) {
        let start = Instant::now();
        let target = self.target;
        while start.elapsed() < SLICE && self.is_due() {
            if !self.step() {
                break;
            }
        }
        let clock = self.run.simulation.frame().clock;
        self.pace.reach(clock.time());
        if let Some(target) = target {
            // After a fault it ends here.
            if clock.frame() >= target || self.target.is_none() {
                self.target = None;
                self.pace.begin(clock.time());
                self.warn();
                self.show(true);
            }
        } else if self.shown.elapsed().as_secs_f64() >= 1.0 / PICTURES || !self.pace.playing {
            self.show(false);
        }
        self.tell();
    }

    fn is_due(&self) -> bool {
        let clock = self.run.simulation.frame().clock;
        match self.target {
            Some(target) => clock.frame() < target,
            None => self.pace.playing && clock.time_at(clock.frame() + 1) <= self.pace.due() + 1e-9,
        }
    }

    /// Computes the next frame; whether there is one.
    fn step(&mut self) -> bool {
        let start = Instant::now();
        let simulation = &mut self.run.simulation;
        let moved = simulation.integrate().map(drop);
        if let Err(fault) = moved.and_then(|()| simulation.evaluate().map(drop)) {
            self.fault = Some(fault.to_string());
            self.target = None;
            self.stop();
            return false;
        }
        self.ms_per_frame = 1000.0 * start.elapsed().as_secs_f64();
        self.observe();
        if self.run.end.is_some() && self.ended.is_none() {
            self.ended = Some(self.run.simulation.frame().clock.frame());
            if self.target.is_none() {
                self.stop();
            }
            return self.target.is_some();
        }
        true
    }

    /// Lets everything that observes see the current frame.
    fn observe(&mut self) {
        self.run.measure();
        self.doors.observe(&self.run.simulation);
        match self.snapshots.add(&self.run, &self.events, &self.doors) {
            Ok(true) => self.warn(),
            Ok(false) => {}
            Err(problem) => self.fault = Some(problem),
        }
    }

    fn stop(&mut self) {
        self.pace.playing = false;
        self.warn();
    }

    fn warn(&mut self) {
        let own = self.run.scenario.notes.iter().cloned();
        self.warnings = own.chain(notes::of(&self.run)).collect();
    }

    fn warnings(&self) -> Vec<&String> {
        self.warnings.iter().chain(&self.beside.warning).collect()
    }

    /// Leaves the current frame for pages.
    fn show(&mut self, is_back: bool) {
        let simulation = &self.run.simulation;
        let new = self.events.new_lines(simulation);
        let crowd = Crowd::of(simulation, self.drawing.as_ref());
        let debug = DebugAgents::Ids(self.followed.into_iter().collect());
        let moment = Moment::of(simulation, &crowd, (self.events.evacuated, new), &debug);
        self.feed.add(self.live.coded(&moment), is_back);
        self.beside.show(&self.run, is_back, self.ms_per_frame);
        self.shown = Instant::now();
        self.sent = Some(simulation.frame().clock.frame());
    }

    /// Tells pages the state.
    fn tell(&self) {
        self.feed.set_state(self.state());
    }

    /// What pages show beside people.
    pub fn state(&self) -> Value {
        let simulation = &self.run.simulation;
        let frame = simulation.frame();
        let end = self.ended == Some(frame.clock.frame());
        let doors = self.doors.now(&self.run, self.observed_from);
        json!({
            "playing": self.pace.playing, "speed": self.pace.speed, "time": frame.clock.time(),
            "frame": frame.clock.frame(), "end": end.then(|| self.run.reason()), "fault": self.fault,
            "people": frame.agents.count_present(), "behind": self.pace.playing && self.pace.behind,
            "rate": self.pace.rate.filter(|_| self.pace.playing), "doors": doors,
            "done": simulation.interventions().len(), "warnings": self.warnings(), "seeks": self.target.is_some(),
            "followed": self.followed,
        })
    }

    /// Plays or stops.
    pub fn set_playing(&mut self, playing: bool) {
        if playing && self.fault.is_none() {
            self.pace.playing = true;
            self.pace.begin(self.run.simulation.frame().clock.time());
        } else {
            self.stop();
            // A page that stops shows the frame in which the run stops.
            let frame = self.run.simulation.frame().clock.frame();
            if self.target.is_none() && self.sent != Some(frame) {
                self.show(false);
            }
        }
        self.tell();
    }

    /// Sets the speed: seconds of the run per second; `None`: as fast as it can.
    ///
    /// # Errors
    /// The speed is out of range.
    pub fn set_speed(&mut self, speed: Option<f64>) -> Result<(), Refusal> {
        if speed.is_some_and(|speed| !SPEEDS.contains(&speed)) {
            let [least, most] = [SPEEDS.start(), SPEEDS.end()];
            return Err(Refusal::wrong(format!(
                "speed: give a number from {least} to {most}, or null for as fast as possible"
            )));
        }
        self.pace.speed = speed;
        self.pace.begin(self.run.simulation.frame().clock.time());
        self.tell();
        Ok(())
    }

    /// Whether the run is in a frame that pages show: not on its way to another time.
    ///
    /// # Errors
    /// It is.
    fn check_shown(&self) -> Result<(), Refusal> {
        let message = "the run is on its way to another time; wait until it is there";
        let seeks = self.target.map(|_| Refusal::with(409, message));
        seeks.map_or(Ok(()), Err)
    }

    /// The run, evaluated, in a frame that pages show.
    ///
    /// # Errors
    /// It is on its way to another time.
    pub fn shown(&self) -> Result<&Run, Refusal> {
        self.check_shown()?;
        Ok(&self.run)
    }

    /// Stops, and computes some frames.
    ///
    /// # Errors
    /// The run is on its way to another time.
    pub fn step_by(&mut self, frames: u64) -> Result<(), Refusal> {
        self.check_shown()?;
        self.stop();
        for _ in 0..frames {
            if !self.step() {
                break;
            }
            self.show(false);
        }
        self.tell();
        Ok(())
    }

    /// Goes to a time, back or on, and stops there: to the frame nearest to it.
    ///
    /// # Errors
    /// The time is not within the run, or an earlier frame is not known.
    pub fn go_to(&mut self, secs: f64) -> Result<(), Refusal> {
        let clock = *self.run.simulation.frame().clock;
        if !(0.0..=1e7).contains(&secs) {
            return Err(Refusal::wrong("to: give a time in seconds, from 0 on"));
        }
        self.stop();
        let frame = clock.frame_at(secs);
        if frame < clock.frame() {
            let known = self.snapshots.back_to(frame).map_err(Refusal::failed)?;
            let back = known.ok_or_else(|| Refusal::wrong("to: the run began later"))?;
            self.run = back.run;
            self.events = back.events;
            self.doors = back.doors;
            self.ended = None;
            self.observed_from = self.run.simulation.frame().clock.time();
            self.fault = None;
        }
        self.target = Some(frame);
        self.tell();
        Ok(())
    }

    /// Shows the forces on a person from now on.
    pub fn follow(&mut self, id: Option<u32>) {
        self.followed = id;
        if self.target.is_none() {
            self.show(false);
        }
        self.tell();
    }

    /// Does what an element of the list `interventions` says, at the beginning of the next frame, which is computed at
    /// once, to show it.
    ///
    /// # Errors
    /// A key or a name is unknown, a number is out of range, or the action is not possible.
    pub fn intervene(&mut self, keys: &Value) -> Result<Added, Refusal> {
        self.check_shown()?;
        let (keys, off_floor) = self.on_floor(keys);
        if !off_floor.is_empty() && keys["add"]["positions"] == json!([]) {
            return Ok(Added {
                without_room: off_floor,
                ..Added::default()
            });
        }
        let action = self.run.scenario.action(&keys)?;
        let done = self.run.intervene(action);
        let mut added = done.map_err(Refusal::impossible)?;
        for place in off_floor {
            // The places of the others are counted without those before them.
            let later = added.without_room.partition_point(|&other| other < place);
            added.without_room[later..]
                .iter_mut()
                .for_each(|other| *other += 1);
            added.without_room.insert(later, place);
        }
        self.step();
        self.show(false);
        self.tell();
        Ok(added)
    }

    /// An intervention without the people who would enter outside of the floor, and their places in the list. In a
    /// building all are left.
    fn on_floor(&self, keys: &Value) -> (Value, Vec<usize>) {
        let mut left = keys.clone();
        let scene = self.run.simulation.scene();
        let add = &keys["add"];
        let Some(positions) = add["positions"]
            .as_array()
            .filter(|_| scene.levels.is_none())
        else {
            return (left, Vec::new());
        };
        let is_off = |place: &Value| {
            let [x, y] = [0, 1].map(|axis| place[axis].as_f64());
            let place = x.zip(y).map(|(x, y)| Vector::new(x, y));
            place.is_some_and(|place| scene.walls.obstacle_at(place).is_some())
        };
        let off: Vec<usize> = (0..positions.len())
            .filter(|&k| is_off(&positions[k]))
            .collect();
        for list in ["positions", "goals", "velocities"] {
            let is_whole = |list: &&Vec<Value>| list.len() == positions.len();
            if let Some(whole) = add[list].as_array().filter(is_whole) {
                let on = whole.iter().enumerate().filter(|(k, _)| !off.contains(k));
                left["add"][list] = on.map(|(_, value)| value.clone()).collect();
            }
        }
        (left, off)
    }

    /// A copy of the run in the same frame, for another page.
    ///
    /// # Errors
    /// A measurement cannot be copied, or the run is on its way to another time.
    pub fn fork(&self, feed: Arc<Feed>) -> Result<Self, Refusal> {
        let run = self.shown()?.fork().map_err(Refusal::failed)?;
        let now = Snapshot {
            frame: run.simulation.frame().clock.frame(),
            run,
            events: self.events.clone(),
            doors: self.doors.clone(),
        };
        Self::of(now, self.snapshots.clone(), feed, self.beside.viewer())
    }

    /// The forces on a person, as `sandbox inspect --json` has them.
    ///
    /// # Errors
    /// The person is not there, or the run is on its way to another time.
    pub fn person(&self, id: u32) -> Result<Value, Refusal> {
        let simulation = &self.shown()?.simulation;
        let present = simulation.present(id);
        let i = present.map_err(|why| Refusal::with(404, format!("person {id}: {why}")))?;
        let breakdown = Breakdown::of(simulation, i)
            .ok_or_else(|| Refusal::with(404, "the frame has no densities"))?;
        serde_json::to_value(&breakdown).map_err(Refusal::failed)
    }

    /// The digest of the state, with its time and frame.
    ///
    /// # Errors
    /// The run is on its way to another time.
    pub fn digest(&self) -> Result<Value, Refusal> {
        let simulation = &self.shown()?.simulation;
        let clock = simulation.frame().clock;
        Ok(json!({
            "state_sha256": simulation.digest(), "time": clock.time(), "frame": clock.frame(),
        }))
    }
}

/// The page of a run, and how the levels of a building lie in it.
fn page(run: &Run) -> (Live, Option<Drawing>) {
    let scenario = &run.scenario;
    let (drawn, nobody) = (Drawn::of(scenario), Crowd::default());
    let picture = Picture {
        simulation: Some(&run.simulation),
        ..Picture::of(&drawn, &nobody, String::new())
    };
    let options = PageOptions {
        title: scenario.name.clone(),
        description: scenario.description.clone(),
        density_range: scenario.view.density_range,
        speed_range: scenario.view.speed_range,
        ..PageOptions::of(&scenario.scene, true)
    };
    (Live::new(&picture, &options), drawn.drawing)
}
