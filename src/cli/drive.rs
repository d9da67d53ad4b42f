//! Runs a scenario to its end, with a progress bar, output files and a report.

use std::path::Path;

use indicatif::{ProgressBar, ProgressStyle};

use super::arguments::{
    OutputOptions, ProgramOptions, RecordOptions, ResumeOptions, RunOptions, Source,
};
use super::checkpoint::{Checkpoints, Moment};
use super::interrupt::Interrupt;
use super::output::{Output, check, laid_open};
use super::report::Report;
use super::trajectory::Trajectories;
use super::{Failure, memory, say, scenario, setting, talk, use_threads};
use crate::analysis::stability::{FITTED, Mode, Scheme};
use crate::engine::clock::{Clock, SHORTEST_TIME_STEP};
use crate::engine::scene::Scene;
use crate::engine::simulation::{EventKind, Simulation};
use crate::lab::machine::main_memory;
use crate::runs::checkpoint::Checkpoint;
use crate::runs::drive::{Then, drive, unless_over};
use crate::runs::outputs::Outputs;
use crate::scenario::measurements::Metrics;
use crate::scenario::quote::shown;
use crate::scenario::{Scenario, Setting, in_units};

/// `sandbox evacuation|crossing|concert|plaza|run`.
pub fn run(source: &Source, options: &RunOptions) -> Result<(), Failure> {
    use_threads(options.scene.program.threads)?;
    let writing = memory::of_writing(&options.output);
    let until = options.output.until.map(|secs| ("--until", secs));
    let mut outputs = Outputs::new(options.scene.program.force);
    let scenario = scenario(source, &options.scene, until, writing, &mut outputs)?;
    check(outputs, &options.output, &scenario)?;
    warn_of_the_step(&scenario.scene);
    let mut simulation = Simulation::new(scenario.scene.clone())?;
    let metrics = Metrics::new(&scenario.measurements, &mut simulation);
    // A resumed run goes to the scenario's own end, if it can get there.
    let is_cut = until.is_some() && options.output.checkpoint.checkpoint.is_some();
    let resumable = is_cut.then(|| {
        let mut inputs = Outputs::new(true);
        super::scenario(source, &options.scene, None, writing, &mut inputs).ok()
    });
    let run = Run {
        scenario,
        resumable: resumable.flatten(),
        simulation,
        metrics,
    };
    run.go_on(&options.scene.program, &options.output)
}

/// `sandbox resume`.
pub fn resume(options: &ResumeOptions) -> Result<(), Failure> {
    use_threads(options.program.threads)?;
    fits_into_memory(&options.file)?;
    let checkpoint = Checkpoint::read(&options.file)?;
    if !checkpoint.is_of_this_engine() {
        talk(&format!(
            "note: {} was written by another version of the engine; the results may differ from those of \
             that version",
            options.file.display()
        ));
    }
    let until = options.output.until.map(|secs| {
        let text = format!("duration_secs={secs}");
        setting(&text).map(|setting| setting.typed_as(format!("--until {secs}")))
    });
    let until: Option<Setting> = until.transpose()?;
    let file = options.file.display().to_string();
    let draft = checkpoint.draft(until.as_slice())?;
    let need = *draft.need();
    let writing = memory::of_writing(&options.output);
    memory::check(&file, &need, writing)?;
    let scenario = draft.scenario()?;
    memory::check(&file, &need.with_lists(&scenario.scene), writing)?;
    let resumable = until.is_some().then(|| checkpoint.scenario(&[]).ok());
    let (simulation, metrics) = checkpoint.resume(&scenario)?;
    refuse_the_past(options, simulation.frame().clock)?;
    let mut outputs = Outputs::new(options.program.force);
    outputs.goes_on_with("the checkpoint", &options.file, "--checkpoint");
    check(outputs, &options.output, &scenario)?;
    let run = Run {
        scenario,
        resumable: resumable.flatten(),
        simulation,
        metrics,
    };
    run.go_on(&options.program, &options.output)
}

/// Rejects an end before the checkpoint's time.
fn refuse_the_past(options: &ResumeOptions, clock: &Clock) -> Result<(), Failure> {
    match options.output.until {
        Some(until) if clock.frame_at(until) < clock.frame() => Err(Failure::Input(format!(
            "--until {until}: the checkpoint {} was written at {:.2} s; give a later time",
            options.file.display(),
            clock.time()
        ))),
        _ => Ok(()),
    }
}

/// Rejects a checkpoint file that is larger than main memory. The memory that its run needs is checked after
/// reading it.
fn fits_into_memory(file: &Path) -> Result<(), Failure> {
    let length = file.metadata().map_or(0, |about| about.len());
    match main_memory() {
        Some(there) if length > there => Err(Failure::Input(format!(
            "{}: {} do not fit into this machine's {} of memory; resume it on a larger machine",
            file.display(),
            in_units(length),
            in_units(there),
        ))),
        _ => Ok(()),
    }
}

/// A run, from where its simulation is to its end.
struct Run {
    scenario: Scenario,
    /// What checkpoints hold, where `--until` cuts the scenario short.
    resumable: Option<Scenario>,
    simulation: Simulation,
    metrics: Metrics,
}

impl Run {
    fn go_on(self, program: &ProgramOptions, options: &OutputOptions) -> Result<(), Failure> {
        let Self {
            scenario,
            resumable,
            mut simulation,
            mut metrics,
        } = self;
        let scenario = &scenario;
        let duration = scenario.duration_secs;
        let last_frame = simulation.frame().clock.frame_at(duration);
        let interrupt = Interrupt::listen().map_err(|error| Failure::Output(error.to_string()))?;
        let resumable = resumable.as_ref().unwrap_or(scenario);
        let mut checkpoints = Checkpoints::create(&options.checkpoint, &mut simulation);
        let mut output = Output::create(&options.record, scenario, &mut simulation, &interrupt)?;
        let mut trajectories =
            Trajectories::create(&options.trajectory, scenario, &mut simulation)?;
        let mut interrupted = None;
        let progress = Progress::new(duration);

        // On a thread of the pool, parallel work starts without handing it over to the pool first.
        let driven = rayon::scope(|_| {
            drive(&mut simulation, duration, |simulation, ms| {
                metrics.observe(simulation);
                progress.show(simulation);
                output.log(simulation, ms)?;
                trajectories.log(simulation)?;
                let then = unless_over(simulation, scenario);
                if then == Then::GoOn {
                    interrupted = interrupt.exit_code();
                }
                let is_last = then == Then::Stop || simulation.frame().clock.frame() >= last_frame;
                let moment = match interrupted {
                    Some(_) => Moment::Interrupted,
                    None if is_last => Moment::Last,
                    None => Moment::Underway,
                };
                checkpoints.write(resumable, simulation, &metrics, moment);
                Ok::<Then, Failure>(interrupted.map_or(then, |_| Then::Stop))
            })
        });
        progress.finish();
        // Close all files first, so that they are kept even if the run failed.
        let (recorded, traced) = (output.finish(), trajectories.finish());
        let saved = recorded.and(traced).and(checkpoints.finish());
        driven.map_err(|failure| failure.laid_open(&mut simulation))?;
        report_oddities(&simulation);
        report_absent(&options.record, &simulation);
        let report = Report::new(scenario, &simulation, &metrics, interrupted.is_some());
        say(report.render(program.json))?;
        saved?;
        interrupted.map_or(Ok(()), |exit_code| {
            let time = simulation.frame().clock.time();
            Err(Failure::Interrupted { time, exit_code })
        })
    }
}

/// Warns if the time step is longer than the stability limit of a crowd at rest, if that is known for the integrator.
fn warn_of_the_step(scene: &Scene) {
    let Some(scheme) = Scheme::of(scene.integrator) else {
        return;
    };
    let mode = Mode::of(scene);
    let (step, largest) = (scene.clock.time_step(), mode.largest_step(scheme, &FITTED));
    if step > largest {
        let automatic = mode.time_step(scheme);
        let advice = if automatic >= SHORTEST_TIME_STEP {
            format!("--time-step auto uses {automatic}")
        } else {
            "no allowed step is short enough: lower the stiffness or raise the masses".to_owned()
        };
        talk(&format!(
            "warning: time_step_secs {step} is {:.1} times {largest:.4}, the largest step at which a crowd comes to \
             rest; {advice}",
            step / largest,
        ));
    }
}

/// Prints notes on displaced agents, stopped moves, clamped speeds and pushes without agents.
fn report_oddities(simulation: &Simulation) {
    let outcome = simulation.outcome();
    if !outcome.displaced.is_empty() {
        let count = outcome.displaced.len();
        let (agent, obstacle) = outcome.displaced[0];
        talk(&format!(
            "note: {count} agent(s) entered inside an obstacle or outside of the walkable area and were moved \
             to the nearest free point (the first: agent {agent}, obstacle {obstacle})"
        ));
    }
    if outcome.contained_moves > 0 {
        talk(&format!(
            "note: {} move(s) would have crossed a wall and were stopped there",
            outcome.contained_moves
        ));
    }
    if outcome.clamped_speeds > 0 {
        let frame = simulation.frame();
        let (count, most) = (outcome.clamped_speeds, simulation.scene().max_speed);
        let frames = frame.clock.frame();
        talk(&format!(
            "note: speeds were clamped to {most} m/s {count} time(s) in {frames} frames"
        ));
    }
    for event in simulation.events() {
        if event.kind == EventKind::PushBegan(0) {
            let name = shown(&event.name);
            talk(&format!(
                "note: no agents were in the region of \"{name}\" when it began"
            ));
        }
    }
}

/// Prints the agents of `--debug-agents` that never entered.
fn report_absent(record: &RecordOptions, simulation: &Simulation) {
    let entered = simulation.frame().agents.entered();
    let asked = laid_open(record).ok().flatten().unwrap_or_default();
    let absent: Vec<String> = asked
        .iter()
        .filter(|&&id| id >= entered)
        .map(u32::to_string)
        .collect();
    if !absent.is_empty() {
        talk(&format!(
            "note: --debug-agents: {} never entered: only {entered} agents entered, with ids from 0",
            absent.join(", ")
        ));
    }
}

/// A progress bar on stderr, shown only if stderr is a terminal.
pub struct Progress {
    bar: ProgressBar,
}

impl Progress {
    pub fn new(duration: f64) -> Self {
        let bar = ProgressBar::new((duration * 10.0).ceil() as u64);
        let template = "{bar:30} {msg}, {eta} left";
        if let Ok(style) = ProgressStyle::with_template(template) {
            bar.set_style(style);
        }
        Self { bar }
    }

    pub fn show(&self, simulation: &Simulation) {
        let frame = simulation.frame();
        if frame.clock.is_coarse() && !self.bar.is_hidden() {
            let (time, agents) = (frame.clock.time(), frame.agents.len());
            self.bar.set_position((time * 10.0) as u64);
            self.bar
                .set_message(format!("t = {time:.1} s, {agents} agents"));
        }
    }

    pub fn finish(&self) {
        self.bar.finish_and_clear();
    }
}
