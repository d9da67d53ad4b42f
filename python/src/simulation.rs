//! A run, frame by frame. Between calls, its current frame is evaluated: positions, densities and forces match.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyBytes, PyDict, PyTuple};
use sandbox::cli::json_report;
use sandbox::engine::breakdown::Breakdown;
use sandbox::engine::frame::Frame;
use sandbox::engine::scene::Action;
use sandbox::engine::simulation::{Added, Fault};
use sandbox::engine::stability;
use sandbox::output::recording::{DebugAgents, Recorder, RecordingOptions};
use sandbox::output::trajectory::{Collected, Columns, frames_between, walkable_area};
use sandbox::runs::checkpoint::Checkpoint;
use sandbox::runs::drive::Run;
use sandbox::scenario::Scenario;

use crate::events::Watch;
use crate::given::{Given, check_memory};
use crate::model::{GivenModel, Raised, arrays_of};
use crate::values::{array, columns, dictionary, vector};
use crate::{check_process, error};

/// Why a simulation does not go on.
enum Stop {
    Fault(Fault),
    Recording(PyErr),
}

impl From<Fault> for Stop {
    fn from(fault: Fault) -> Self {
        Self::Fault(fault)
    }
}

/// A run, frame by frame.
#[pyclass(module = "sandbox_crowds._native")]
pub struct Native {
    run: Run,
    collected: Option<Collected>,
    /// The agents of the current frame by id, once they have been asked for.
    order: Option<Vec<u32>>,
    /// What the function of a model has raised.
    raised: Raised,
    /// The recording, and the number of frames from one recorded to the next.
    recording: Option<(Recorder, u64)>,
    watch: Option<Watch>,
    /// Whether the current frame has been evaluated and observed: not after an exception in a model.
    is_seen: bool,
}

#[pymethods]
impl Native {
    /// `collect`: frames per second of trajectories in memory, and their columns; all if there are none.
    #[new]
    fn new(
        py: Python<'_>,
        given: Given,
        collect: Option<(f64, Option<Vec<String>>)>,
        model: Option<GivenModel>,
    ) -> PyResult<Self> {
        check_process()?;
        py.detach(|| rayon::scope(|_| Self::begun(given, collect, model)))
    }

    /// Simulates `frames` frames, or as many as end within `seconds`, and returns their number. `to_end`: not beyond
    /// the end of the run.
    fn advance(
        &mut self,
        py: Python<'_>,
        frames: u64,
        seconds: f64,
        to_end: bool,
    ) -> PyResult<u64> {
        check_process()?;
        let most = Duration::try_from_secs_f64(seconds).unwrap_or_default();
        self.order = None;
        let advanced = py.detach(|| {
            // On a thread of the pool, parallel work starts without handing it over to the pool first.
            rayon::scope(|_| {
                let start = Instant::now();
                let mut done = 0;
                while done < frames && !(to_end && self.run.end.is_some()) {
                    self.step()?;
                    if let Err(problem) = self.log() {
                        return Err(Stop::Recording(problem));
                    }
                    done += 1;
                    if start.elapsed() >= most {
                        break;
                    }
                }
                Ok(done)
            })
        });
        advanced.map_err(|stop| match stop {
            Stop::Fault(fault) => self.laid_open(fault),
            Stop::Recording(problem) => problem,
        })
    }

    /// The number of the current frame.
    #[getter]
    fn frame(&self) -> u64 {
        self.now().clock.frame()
    }

    /// Seconds.
    #[getter]
    fn time(&self) -> f64 {
        self.now().clock.time()
    }

    /// Seconds.
    #[getter]
    fn time_step(&self) -> f64 {
        self.now().clock.time_step()
    }

    /// Seconds.
    #[getter]
    fn duration(&self) -> f64 {
        self.run.scenario.duration_secs
    }

    /// The longest step that is safely stable, seconds; `None` if there is no formula for the integrator.
    #[getter]
    fn stable_step(&self) -> Option<f64> {
        stability::time_step(self.run.simulation.scene())
    }

    /// Why the run ends here.
    #[getter]
    fn end(&self) -> Option<String> {
        self.run.end.map(|_| self.run.reason())
    }

    /// The current number of agents.
    #[getter]
    fn agents(&self) -> usize {
        self.now().agents.count_present()
    }

    #[getter]
    fn name(&self) -> &str {
        &self.run.scenario.name
    }

    /// The names of the groups.
    #[getter]
    fn groups(&self) -> Vec<&str> {
        let groups = self.run.simulation.scene().groups.iter();
        groups.map(|group| &*group.name).collect()
    }

    /// The scenario with all settings, as JSON.
    #[getter]
    fn document(&self) -> String {
        self.run.scenario.to_text()
    }

    /// What was changed to make the scenario run.
    #[getter]
    fn notes(&self) -> Vec<String> {
        self.run.scenario.notes.clone()
    }

    /// What `sandbox run --json` reports.
    fn report(&self) -> String {
        json_report(&self.run).to_string()
    }

    /// The SHA-256 of the state.
    fn digest(&self) -> String {
        self.run.simulation.digest()
    }

    /// The walkable area as WKT.
    fn area(&self, py: Python<'_>) -> PyResult<String> {
        check_process()?;
        let run = &self.run;
        let area = py.detach(|| match &self.collected {
            Some(collected) => collected.area(),
            None => walkable_area(&run.simulation, run.scenario.view.region),
        });
        area.map_err(error)
    }

    /// The ids of all agents, ascending: uint32.
    fn ids<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyByteArray>> {
        let order = self.order();
        let ids = &self.now().agents.id;
        array(py, order.len(), |k| ids[order[k] as usize].to_ne_bytes())
    }

    /// The positions by id: pairs of float64.
    fn positions<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyByteArray>> {
        let order = self.order();
        let positions = &self.now().agents.position;
        array(py, order.len(), |k| vector(positions[order[k] as usize]))
    }

    /// The velocities by id: pairs of float64.
    fn velocities<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyByteArray>> {
        let order = self.order();
        let velocities = &self.now().agents.velocity;
        array(py, order.len(), |k| vector(velocities[order[k] as usize]))
    }

    /// The densities by id: float64.
    fn densities<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyByteArray>> {
        let order = self.order();
        let densities = &self.now().fields.density;
        array(py, order.len(), |k| {
            densities[order[k] as usize].to_ne_bytes()
        })
    }

    /// All quantities of all agents in the current frame, as columns.
    fn table<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        check_process()?;
        let simulation = &self.run.simulation;
        let mut columns = Columns::new(simulation.scene(), |_| true);
        py.detach(|| columns.add(simulation, simulation.frame().clock.frame()));
        dictionary(py, columns)
    }

    /// The trajectories, which are then no longer kept; `None` if there are none.
    fn take_trajectory<'py>(&mut self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyDict>>> {
        let taken = self.collected.take().map(Collected::into_columns);
        taken.map(|columns| dictionary(py, columns)).transpose()
    }

    /// Gives agents new goals, meters.
    fn set_goals(&mut self, py: Python<'_>, goals: Vec<(u32, [f64; 2])>) -> PyResult<()> {
        check_process()?;
        py.detach(|| {
            let goals = goals.into_iter().map(|(id, goal)| (id, goal.into()));
            self.intervened(Action::Goals(goals.collect())).map(drop)
        })
    }

    /// Does what an element of the list `interventions`, as JSON, says. Returns the ids of people who enter, and the
    /// places in the list of those without room.
    fn intervene(&mut self, py: Python<'_>, keys: &str) -> PyResult<(Vec<u32>, Vec<usize>)> {
        check_process()?;
        py.detach(|| {
            let keys = serde_json::from_str(keys).map_err(error)?;
            let action = self.run.scenario.action(&keys).map_err(error)?;
            let added = self.intervened(action)?;
            Ok((added.ids, added.without_room))
        })
    }

    /// The scenario up to now, with what was done, as JSON.
    fn played(&self) -> String {
        self.run.played().to_string()
    }

    /// An independent copy in the same frame.
    fn fork(&self, py: Python<'_>) -> PyResult<Self> {
        check_process()?;
        let run = py.detach(|| self.run.fork()).map_err(error)?;
        Ok(Self {
            run,
            collected: None,
            order: None,
            raised: self.raised.clone(),
            recording: None,
            watch: self.watch.clone(),
            is_seen: self.is_seen,
        })
    }

    /// The state as the bytes of a checkpoint.
    fn save<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        check_process()?;
        let Run {
            scenario,
            simulation,
            metrics,
            ..
        } = &self.run;
        let bytes = py.detach(|| Checkpoint::of(scenario, simulation, metrics).bytes());
        Ok(PyBytes::new(py, &bytes.map_err(error)?))
    }

    /// A simulation that goes on from saved bytes.
    #[staticmethod]
    fn restored(py: Python<'_>, saved: Vec<u8>, model: Option<GivenModel>) -> PyResult<Self> {
        check_process()?;
        py.detach(|| {
            let checkpoint = Checkpoint::parse(&saved, Path::new("saved")).map_err(error)?;
            if !checkpoint.is_of_this_engine() {
                return Err(error(
                    "saved: it is of another version of the program, which may go on to other bits",
                ));
            }
            let mut scenario = checkpoint.scenario(&[]).map_err(error)?;
            let raised = with_model(&mut scenario, model)?;
            let run = checkpoint.resume(scenario).map_err(error)?;
            rayon::scope(|_| Self::of(run, None, raised))
        })
    }

    /// Begins a recording for the Rerun viewer: this frame, and from now on one of `every` frames. `debug`: the agents
    /// whose forces it shows; the scenario's if there are none.
    fn record(&mut self, path: PathBuf, every: u64, debug: Option<Vec<u32>>) -> PyResult<()> {
        check_process()?;
        self.finish_recording()?;
        let scenario = &self.run.scenario;
        let ids = debug.unwrap_or_else(|| scenario.debug_agents.clone());
        let now = self.now().clock.time();
        let options = RecordingOptions::of(scenario, DebugAgents::Ids(ids), now);
        let recorder = Recorder::create(path.as_path(), &self.run.simulation, &options);
        self.recording = Some((recorder.map_err(error)?, every));
        self.log()
    }

    /// Ends the recording, if there is one.
    fn finish_recording(&mut self) -> PyResult<()> {
        let Some((recorder, _)) = self.recording.take() else {
            return Ok(());
        };
        recorder.finish().map_err(error)
    }

    /// What a model gets of the current frame: see `_model.py`.
    fn model_frame<'py>(&self, py: Python<'py>, reach: f64) -> PyResult<Bound<'py, PyTuple>> {
        arrays_of(py, &self.now(), reach)?.into_pyobject(py)
    }

    /// What happened since the last call, which began to watch: rows of those who entered, left, were removed and
    /// crossed lines, and the ids of those who got stuck.
    fn take_events<'py>(
        &mut self,
        py: Python<'py>,
    ) -> PyResult<([Bound<'py, PyBytes>; 4], Vec<u32>)> {
        check_process()?;
        let run = &self.run;
        Ok(self
            .watch
            .get_or_insert_with(|| Watch::begin(run))
            .take(py, run))
    }

    /// The names of the places.
    #[getter]
    fn places(&self) -> Vec<&str> {
        let places = self.run.simulation.scene().journeys.places.iter();
        places.map(|place| &*place.name).collect()
    }

    /// Every force on an agent, as JSON.
    fn inspect(&self, id: u32) -> PyResult<String> {
        let simulation = &self.run.simulation;
        let i = simulation.present(id);
        let i = i.map_err(|why| error(format!("agent {id}: {why}")))?;
        match Breakdown::of(simulation, i) {
            Some(breakdown) => serde_json::to_string(&breakdown).map_err(error),
            None => Err(error("the frame has no densities")),
        }
    }
}

impl Native {
    fn begun(
        given: Given,
        collect: Option<(f64, Option<Vec<String>>)>,
        model: Option<GivenModel>,
    ) -> PyResult<Self> {
        let mut scenario = given.scenario()?;
        let raised = with_model(&mut scenario, model)?;
        let columns = match collect {
            Some((fps, wanted)) => Some((fps, columns(wanted)?)),
            None => None,
        };
        if let Some((fps, columns)) = &columns {
            if !(fps.is_finite() && *fps > 0.0) {
                return Err(error(format!("fps={fps}: give a number above 0")));
            }
            let every = frames_between(&scenario.scene.clock, *fps);
            every.map_err(|reason| error(format!("fps: {reason}")))?;
            check_memory(&scenario, *fps, columns.len())?;
        }
        let mut run = Run::new(scenario).map_err(error)?;
        let collected = columns.map(|(fps, names)| {
            let columns = Columns::new(run.simulation.scene(), |name| names.contains(&name));
            let view = run.scenario.view.region;
            let collected = Collected::new(&mut run.simulation, view, fps, columns);
            collected.map_err(|reason| error(format!("fps: {reason}")))
        });
        let collected = collected.transpose()?;
        Self::of(run, collected, raised)
    }

    /// A run in its current frame, which is evaluated.
    fn of(mut run: Run, collected: Option<Collected>, raised: Raised) -> PyResult<Self> {
        // Densities depend on those before, so every frame needs them.
        run.simulation.request_density_until(u64::MAX);
        let mut new = Self {
            run,
            collected,
            order: None,
            raised,
            recording: None,
            watch: None,
            is_seen: false,
        };
        new.evaluate().map_err(|fault| new.laid_open(fault))?;
        Ok(new)
    }

    fn intervened(&mut self, action: Action) -> PyResult<Added> {
        self.run.intervene(action).map_err(error)
    }

    fn now(&self) -> Frame<'_> {
        self.run.simulation.frame()
    }

    /// Adds the current frame to the recording, if it is due.
    fn log(&mut self) -> PyResult<()> {
        if let Some((recorder, every)) = &mut self.recording
            && self
                .run
                .simulation
                .frame()
                .clock
                .frame()
                .is_multiple_of(*every)
        {
            recorder.log(&self.run.simulation, 0.0).map_err(error)?;
        }
        Ok(())
    }

    fn step(&mut self) -> Result<(), Fault> {
        if !self.is_seen {
            self.evaluate()?;
        }
        self.run.simulation.integrate()?;
        self.is_seen = false;
        self.evaluate()
    }

    fn evaluate(&mut self) -> Result<(), Fault> {
        self.run.simulation.evaluate()?;
        self.is_seen = true;
        self.run.measure();
        if let Some(watch) = &mut self.watch {
            watch.observe(&self.run.simulation);
        }
        if let Some(collected) = &mut self.collected {
            collected.log(&self.run.simulation);
        }
        Ok(())
    }

    /// The indices of all agents by id.
    fn order(&mut self) -> Vec<u32> {
        let new = || {
            let agents = self.run.simulation.frame().agents;
            // Ids are small numbers: no need to compare them.
            let mut places = vec![u32::MAX; agents.entered() as usize];
            for i in agents.present() {
                places[agents.id[i] as usize] = i as u32;
            }
            places.retain(|&place| place != u32::MAX);
            places
        };
        self.order.get_or_insert_with(new).clone()
    }

    /// The error of a fault, with the forces on the agent concerned.
    fn laid_open(&mut self, fault: Fault) -> PyErr {
        if let Some(raised) = self.raised.take() {
            return raised;
        }
        match Breakdown::of_fault(&mut self.run.simulation, &fault) {
            Some(agent) => error(format!("{fault}\n{agent}")),
            None => error(fault),
        }
    }
}

/// Gives a scenario a model of one's own.
fn with_model(scenario: &mut Scenario, model: Option<GivenModel>) -> PyResult<Raised> {
    let Some(given) = model else {
        return Ok(Raised::default());
    };
    given.check(&scenario.scene)?;
    let (model, raised) = given.model();
    scenario.scene.set_model(model);
    Ok(raised)
}
