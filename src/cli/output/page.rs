//! The page of a run.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use super::{RecordedFrames, kinds};
use crate::cli::arguments::RecordOptions;
use crate::cli::failure::Failure;
use crate::cli::results as report;
use engine::breakdown::Breakdown;
use engine::simulation::Simulation;
use output::drawing::{Drawing, Drawn};
use output::events::Events;
use output::html::escape;
use output::page::{EmbeddedViewer, Moment, Page, PageOptions};
use output::picture::{Crowd, Picture};
use output::recording::{DebugAgents, RecordingOptions};
use output::results::{reproducible, results, section};
use runs::drive::{End, Observer, Run};
use scenario::Scenario;

/// The page of a run while it is being written.
pub struct PageOfRun {
    page: Page,
    due: RecordedFrames,
    debug: DebugAgents,
    events: Events,
    drawing: Option<Drawing>,
    /// The Rerun viewer, and the recording that it shows, which is complete before the page is.
    viewer: Option<(EmbeddedViewer, PathBuf)>,
    /// The results; `None` until the run has ended.
    results: Option<String>,
}

impl PageOfRun {
    /// Opens the page at a path.
    pub fn create(
        path: &Path,
        (record, debug): (&RecordOptions, DebugAgents),
        run: &mut Run,
    ) -> Result<Self, Failure> {
        run.simulation.request_density_until(u64::MAX);
        let packaged = record
            .page_viewer
            .as_deref()
            .map(EmbeddedViewer::in_package);
        let opened = packaged.transpose()?;
        let [recording, _] = kinds(record)?;
        let viewer = opened.zip(recording.map(Path::to_owned));
        let options = PageOptions {
            has_viewer: viewer.is_some(),
            ..options(&run.scenario, &debug, record.record_from)
        };
        let (page, drawing) = create(path, (&run.scenario, &run.simulation), &options)?;
        Ok(Self {
            page,
            due: RecordedFrames::new(record, &run.simulation),
            debug,
            events: Events::new(run.scenario.entering),
            drawing,
            viewer,
            results: None,
        })
    }
}

impl Observer<Failure> for PageOfRun {
    fn observe(&mut self, run: &Run, _: f64, then: ControlFlow<End>) -> Result<(), Failure> {
        if self.due.now(&run.simulation, then) {
            let new = self.events.new_lines(&run.simulation);
            let crowd = Crowd::of(&run.simulation, self.drawing.as_ref());
            let events = (self.events.evacuated, new);
            let moment = Moment::of(&run.simulation, &crowd, events, &self.debug);
            self.page.add(&moment)?;
        }
        if then.is_break() {
            let report = reproducible(report::json(run));
            self.results = Some(results(&report, Some(&run.scenario)));
        }
        Ok(())
    }

    fn finish(mut self: Box<Self>) -> Result<(), Failure> {
        if let Some((viewer, recording)) = &self.viewer {
            self.page.embed(viewer, recording)?;
        }
        let failed = || section("Outcome", "<p>The run ended with an error.</p>\n");
        Ok(self.page.finish(&self.results.unwrap_or_else(failed))?)
    }
}

/// A page with the plan of a scenario, and how the levels of a building lie in it.
fn create(
    path: &Path,
    (scenario, simulation): (&Scenario, &Simulation),
    options: &PageOptions,
) -> Result<(Page, Option<Drawing>), Failure> {
    let (drawn, nobody) = (Drawn::of(scenario), Crowd::default());
    let picture = Picture {
        simulation: Some(simulation),
        ..Picture::of(&drawn, &nobody, String::new())
    };
    let page = Page::create(path, &picture, options)?;
    Ok((page, drawn.drawing))
}

/// The options of a page that begins at the time `from`.
fn options(scenario: &Scenario, debug: &DebugAgents, from: f64) -> PageOptions {
    let recording = RecordingOptions::of(scenario, debug.clone(), from);
    PageOptions {
        title: recording.title,
        description: recording.description,
        density_range: recording.density_range,
        speed_range: recording.speed_range,
        opens_at: recording.opens_at,
        ..PageOptions::of(&scenario.scene, *debug != DebugAgents::None)
    }
}

/// Writes a page of one evaluated frame, with the forces on some agents, the first of which is followed.
pub fn save_moment(
    path: &Path,
    scenario: &Scenario,
    simulation: &Simulation,
    ids: Vec<u32>,
) -> Result<(), Failure> {
    let agents = simulation.frame().agents;
    let of = |&id: &u32| Breakdown::of(simulation, agents.index_of(id)?);
    let agents = ids.iter().filter_map(of);
    let elements = agents.map(|agent| format!("<pre>{}</pre>\n", escape(&agent.to_string())));
    let numbers: String = elements.collect();
    let follows = ids.first().copied();
    let debug = DebugAgents::Ids(ids);
    let now = simulation.frame().clock.time();
    let options = PageOptions {
        follows,
        ..options(scenario, &debug, now)
    };
    let (mut page, drawing) = create(path, (scenario, simulation), &options)?;
    let crowd = Crowd::of(simulation, drawing.as_ref());
    page.add(&Moment::of(simulation, &crowd, (0, Vec::new()), &debug))?;
    let title = format!("Forces at {now:.2} s");
    Ok(page.finish(&section(&title, &numbers))?)
}
