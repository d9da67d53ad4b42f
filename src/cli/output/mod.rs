//! The output files of a run: checks, trajectories, the recording and the page.

mod page;

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use super::arguments::{OutputOptions, RecordOptions, TrajectoryOptions};
use super::failure::Failure;
use super::interrupt::Interrupt;
use super::reported::names;
use super::results;
use super::terminal::talk;
use super::values::{ids, is_page, region};
use page::PageOfRun;

use engine::clock::Clock;
use engine::simulation::Simulation;
use output::page::EmbeddedViewer;
use output::recording::{
    DebugAgents, Destination, Recorder, RecordingError, RecordingOptions, Viewer, record_moment,
};
use output::trajectory::{Format, Trajectory, frames_between, journal};
use runs::drive::{End, Observer, Run};
use runs::identity::Identity;
use runs::outputs::{Manner, Outputs};
use scenario::Scenario;

/// Rejects outputs that cannot be written, before any file is touched.
pub fn check(
    mut outputs: Outputs,
    options: &OutputOptions,
    scenario: &Scenario,
) -> Result<(), Failure> {
    let (record, trajectory) = (&options.record, &options.trajectory);
    for path in &trajectory.files {
        let format = Format::of(path)?;
        outputs.writes("--trajectory", path, Manner::InPlace);
        if format == Format::Sqlite {
            // SQLite's journal, which exists during every transaction.
            let journal = journal(path).map_err(|error| Failure::Output(error.to_string()))?;
            outputs.writes("--trajectory", &journal, Manner::Beside);
        }
    }
    if !trajectory.files.is_empty() {
        frames_between(&scenario.scene.clock, trajectory.fps)?;
    }
    let (clock, end) = (&scenario.scene.clock, scenario.duration_secs);
    if clock.frame_at(record.record_from) > clock.frame_at(end) {
        return Err(Failure::Input(format!(
            "--record-from {}: the run ends at {end} s, so nothing would be recorded; give an earlier time, \
             or a later end with --until",
            record.record_from
        )));
    }
    for path in &record.save {
        outputs.writes("--save", path, Manner::InPlace);
    }
    if let (Some(folder), [recording, page]) = (&record.page_viewer, kinds(record)?) {
        if recording.is_none() || page.is_none() {
            let problem =
                "--page-viewer needs a recording and a page: --save FILE.rrd --save FILE.html";
            return Err(Failure::Input(problem.to_owned()));
        }
        EmbeddedViewer::in_package(folder)?;
    }
    kinds(record)?;
    if let Some(path) = &options.checkpoint.checkpoint {
        outputs.writes("--checkpoint", path, Manner::Whole);
    }
    options.files.add_to(&mut outputs, &names(scenario));
    Ok(outputs.check()?)
}

/// The recording and the page of `--save`.
fn kinds(record: &RecordOptions) -> Result<[Option<&Path>; 2], Failure> {
    let of = |wanted: bool| {
        let mut files = record.save.iter().filter(|path| is_page(path) == wanted);
        match (files.next(), files.next()) {
            (Some(one), Some(other)) => Err(Failure::Input(format!(
                "--save {} and {}: a run has one recording (.rrd) and one page (.html)",
                one.display(),
                other.display()
            ))),
            (one, _) => Ok(one.map(PathBuf::as_path)),
        }
    };
    Ok([of(false)?, of(true)?])
}

/// The recording and the page of a run, if they are requested.
pub fn recordings(
    record: &RecordOptions,
    run: &mut Run,
    interrupt: &Interrupt,
) -> Result<Vec<Box<dyn Observer<Failure> + Send>>, Failure> {
    let debug = debug_agents(record, &run.scenario)?;
    let mut all: Vec<Box<dyn Observer<Failure> + Send>> = Vec::new();
    if let Some(to) = destination(record, interrupt)? {
        let view = run.scenario.view.region;
        let farthest = view.min.amax().max(view.max.amax());
        // Half the distance between two numbers of single precision.
        let off = 0.5 * f64::from(f32::EPSILON) * farthest;
        if off > COARSE {
            talk(&format!(
                "note: the plan lies up to {farthest:.0} m from the origin: places in the recording have single \
                 precision and are off by up to {:.0} mm; move the plan to the origin",
                1000.0 * off
            ));
        }
        all.push(Box::new(Recording::create(
            to,
            (record, debug.clone()),
            run,
        )?));
    }
    if let [_, Some(path)] = kinds(record)? {
        all.push(Box::new(PageOfRun::create(path, (record, debug), run)?));
    }
    Ok(all)
}

/// Places in recordings that are off by more than this, meters, are worth a note.
const COARSE: f64 = 0.001;

/// Which frames are recorded.
struct RecordedFrames {
    every: u64,
    from: u64,
}

impl RecordedFrames {
    fn new(record: &RecordOptions, simulation: &Simulation) -> Self {
        Self {
            every: record.record_every,
            from: simulation.frame().clock.frame_at(record.record_from),
        }
    }

    /// Whether the current frame is. The last frame of a run always is, so that a recording ends as the results say.
    fn now(&self, simulation: &Simulation, then: ControlFlow<End>) -> bool {
        let frame = simulation.frame().clock.frame();
        frame >= self.from && (then.is_break() || frame.is_multiple_of(self.every))
    }
}

/// Opens the trajectory files.
pub fn trajectories(
    options: &TrajectoryOptions,
    run: &mut Run,
) -> Result<Vec<Trajectory>, Failure> {
    let (view, fps) = (run.scenario.view.region, options.fps);
    let files = options.files.iter();
    let opened = files.map(|path| Trajectory::create(path, &mut run.simulation, view, fps));
    Ok(opened.collect::<Result<_, _>>()?)
}

impl Observer<Failure> for Trajectory {
    fn observe(&mut self, run: &Run, _: f64, _: ControlFlow<End>) -> Result<(), Failure> {
        Ok(self.log(&run.simulation)?)
    }

    fn finish(self: Box<Self>) -> Result<(), Failure> {
        Ok(Self::finish(*self)?)
    }
}

/// The recording of a run.
pub struct Recording {
    recorder: Recorder,
    due: RecordedFrames,
    /// Number of frames recorded so far.
    recorded: u64,
    /// The clock at the last frame, and whether it was said why the run ended there.
    last: Clock,
    ended: bool,
}

impl Recording {
    fn create(
        to: Destination,
        (record, debug): (&RecordOptions, DebugAgents),
        run: &mut Run,
    ) -> Result<Self, Failure> {
        run.simulation.request_density_until(u64::MAX);
        let view = RecordingOptions::of(&run.scenario, debug, record.record_from);
        Ok(Self {
            recorder: Recorder::create(to, &run.simulation, &view)?,
            due: RecordedFrames::new(record, &run.simulation),
            recorded: 0,
            last: *run.simulation.frame().clock,
            ended: false,
        })
    }
}

impl Observer<Failure> for Recording {
    fn observe(&mut self, run: &Run, ms: f64, then: ControlFlow<End>) -> Result<(), Failure> {
        self.last = *run.simulation.frame().clock;
        if self.due.now(&run.simulation, then) {
            self.recorder.log(&run.simulation, ms)?;
            self.recorded += 1;
        }
        if then.is_break() {
            self.ended = true;
            let end = format!("The run ends: {}.", run.reason());
            self.recorder.note(&self.last, &end)?;
            let json = results::json(run).to_string();
            let text = results::document(run, false).text();
            self.recorder.results(&text, &json)?;
        }
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> Result<(), Failure> {
        if !self.ended {
            let end = "The run ends with an error.";
            // The recording's own error is reported when it is finished.
            self.recorder.note(&self.last, end).ok();
        }
        if self.recorded == 0 {
            talk("note: no frame was recorded: the run ended before the time of --record-from");
        }
        match self.recorder.finish() {
            // Closing the viewer is not an error.
            Err(gone @ RecordingError::ViewerGone { .. }) => {
                talk(&format!("note: {gone}"));
                Ok(())
            }
            finished => Ok(finished?),
        }
    }
}

/// The viewer of `--connect` or `--spawn`, if one is requested.
pub fn viewer(connect: Option<&str>, spawn: bool) -> Result<Option<Viewer>, Failure> {
    let Some(text) = connect else {
        return Ok(spawn.then_some(Viewer::Spawned));
    };
    let address = text.parse().map(Viewer::At);
    address
        .map(Some)
        .map_err(|error| Failure::Input(format!("--connect {text}: {error}")))
}

/// The destination of the recording, if one is requested.
fn destination(
    record: &RecordOptions,
    interrupt: &Interrupt,
) -> Result<Option<Destination>, Failure> {
    let viewer = viewer(record.connect.as_deref(), record.spawn)?;
    let [file, _] = kinds(record)?;
    let file = file.map(Path::to_owned);
    let asked = file.is_some() || viewer.is_some();
    Ok(asked.then_some(Destination {
        file,
        viewer,
        interrupted: interrupt.flag(),
    }))
}

/// Records one evaluated frame, with the forces on some agents.
pub fn save_moment(
    path: &Path,
    scenario: &Scenario,
    simulation: &Simulation,
    ids: Vec<u32>,
) -> Result<(), Failure> {
    if is_page(path) {
        return page::save_moment(path, scenario, simulation, ids);
    }
    let now = simulation.frame().clock.time();
    let run = Identity::of_run(scenario);
    let id = Identity::of("inspect", format_args!("{run} {now} {ids:?}"));
    let mut options = RecordingOptions::of(scenario, DebugAgents::Ids(ids), now);
    options.id = id.to_string(); // a viewer would merge it with a recording of the run
    options.opens_at = Some(now);
    options.ends_at = now;
    Ok(record_moment(path, simulation, &options)?)
}

fn debug_agents(record: &RecordOptions, scenario: &Scenario) -> Result<DebugAgents, Failure> {
    if let Some(text) = &record.debug_region {
        let region = region(text).map(DebugAgents::Region);
        return region.map_err(|reason| Failure::Input(format!("--debug-region {text}: {reason}")));
    }
    let ids = match record.debug_agents.as_deref() {
        None => return Ok(DebugAgents::Ids(scenario.debug_agents.clone())),
        Some("all") => return Ok(DebugAgents::All),
        Some("none") => return Ok(DebugAgents::None),
        Some(text) => ids(text)?,
    };
    if let Some(id) = ids.iter().find(|&&id| u64::from(id) >= scenario.entering) {
        let entering = scenario.entering;
        return Err(Failure::Input(format!(
            "--debug-agents {id}: never enters: {entering} agents enter until {} s, with ids from 0",
            scenario.duration_secs
        )));
    }
    Ok(DebugAgents::Ids(ids))
}
