//! A run live in a Rerun viewer, beside the page.

use output::recording::{Address, DebugAgents, Recorder, RecordingError, RecordingOptions, Viewer};
use runs::drive::Run;

/// The recording of a run in a viewer. A run that is set back begins another recording there.
pub struct Beside {
    viewer: Option<Address>,
    recorder: Option<Recorder>,
    /// The latest frame of the recording.
    frame: Option<u64>,
    /// Why the viewer does not show the run.
    pub warning: Option<String>,
}

impl Beside {
    /// A recording that has not begun; `None`: there is no viewer.
    pub fn new(viewer: Option<Address>) -> Self {
        Self {
            viewer,
            recorder: None,
            frame: None,
            warning: None,
        }
    }

    /// The viewer, for a fork of the run.
    pub fn viewer(&self) -> Option<Address> {
        self.viewer.clone()
    }

    /// Adds the current frame, which must be evaluated; `is_back`: the run was set back to it.
    pub fn show(&mut self, run: &Run, is_back: bool, ms_per_frame: f64) {
        if self.warning.is_some() {
            return;
        }
        if let Err(error) = self.shown(run, is_back, ms_per_frame) {
            self.recorder = None;
            self.warning = Some(format!("the run is not shown in Rerun: {error}"));
        }
    }

    fn shown(&mut self, run: &Run, is_back: bool, ms: f64) -> Result<(), RecordingError> {
        let Some(address) = &self.viewer else {
            return Ok(());
        };
        if is_back && let Some(before) = self.recorder.take() {
            before.finish()?;
            self.frame = None;
        }
        let simulation = &run.simulation;
        let clock = simulation.frame().clock;
        if self.frame == Some(clock.frame()) {
            return Ok(());
        }
        let recorder = match &mut self.recorder {
            Some(recorder) => recorder,
            none => {
                let debug = DebugAgents::Ids(run.scenario.debug_agents.clone());
                let options = RecordingOptions::of(&run.scenario, debug, clock.time());
                let viewer = Viewer::At(address.clone());
                none.insert(Recorder::create(viewer, simulation, &options)?)
            }
        };
        recorder.log(simulation, ms)?;
        recorder.check_viewer()?;
        self.frame = Some(clock.frame());
        Ok(())
    }
}

impl Drop for Beside {
    fn drop(&mut self) {
        // The run is closed: an error has no reader.
        self.recorder.take().map(Recorder::finish);
    }
}
