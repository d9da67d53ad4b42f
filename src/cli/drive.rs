//! Runs a scenario to its end, with a progress bar, output files and a report.

use std::path::Path;

use super::arguments::{
    OutputOptions, ProgramOptions, ResumeOptions, RunOptions, setting, use_threads,
};
use super::checkpoint::Checkpoints;
use super::failure::Failure;
use super::inputs::scenario;
use super::interrupt::Interrupt;
use super::output::{check, recordings, trajectories};
use super::reported::{Typed, Watch, complete, findings};
use super::terminal::{talk, tell};
use super::watch::Progress;
use super::{memory, notes, results};
use lab::machine::main_memory;
use lab::report::Watched;
use runs::case::Source;
use runs::checkpoint::Checkpoint;
use runs::drive::{End, Observer, Run};
use runs::notes::of_step;
use runs::outputs::Outputs;
use scenario::{Scenario, Setting, in_units};

/// `sandbox evacuation|crossing|concert|plaza|run`.
pub fn run(source: &Source, options: &RunOptions) -> Result<(), Failure> {
    use_threads(options.scene.program.threads)?;
    let writing = memory::of_writing(&options.output);
    let until = options.output.until.map(|secs| ("--until", secs));
    let mut outputs = Outputs::new(options.scene.program.force);
    let mut whole = scenario(source, &options.scene, until, writing, &mut outputs)?;
    check(outputs, &options.output, &whole)?;
    let is_reported = options.output.files.are_given();
    // A checkpoint has the scenario's own measurements, with which it is resumed.
    if is_reported && options.output.checkpoint.checkpoint.is_none() {
        complete(&mut whole)?;
    }
    if let Some(warning) = of_step(&whole.scene) {
        talk(&format!("warning: {warning}"));
    }
    let watched = is_reported.then(|| Watched::new(&whole, &[]));
    let run = Run::new(whole)?;
    let typed = Typed {
        source,
        scene: &options.scene,
        until: options.output.until,
        at: &[],
    };
    // A resumed run goes to the scenario's own end, if the whole scenario is valid.
    let is_cut = until.is_some() && options.output.checkpoint.checkpoint.is_some();
    let resumable = is_cut.then(|| {
        let mut inputs = Outputs::new(true);
        scenario(source, &options.scene, None, writing, &mut inputs).ok()
    });
    let started = Started {
        run,
        resumable: resumable.flatten(),
        report: watched.map(|watched| (watched, typed)),
    };
    go_on(started, &options.scene.program, &options.output)
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
    let typed = options.output.until.map(|secs| {
        let text = format!("duration_secs={secs}");
        setting(&text).map(|setting| setting.typed_as(format!("--until {secs}")))
    });
    let until: Option<Setting> = typed.transpose()?;
    let draft = checkpoint.draft(until.as_slice())?;
    let (scenario, _) = draft.within(main_memory(), memory::of_writing(&options.output))?;
    let resumable = until.is_some().then(|| checkpoint.scenario(&[]).ok());
    let run = checkpoint.resume(scenario).map_err(|error| {
        let file = options.file.display();
        Failure::Input(format!("{file}: {error}; run the scenario again"))
    })?;
    let clock = run.simulation.frame().clock;
    if let Some(until) = options.output.until
        && clock.frame_at(until) < clock.frame()
    {
        return Err(Failure::Input(format!(
            "--until {until}: the checkpoint {} was written at {:.2} s; give a later time",
            options.file.display(),
            clock.time()
        )));
    }
    let mut outputs = Outputs::new(options.program.force);
    outputs.reads_and_replaces("the checkpoint", &options.file, "--checkpoint");
    check(outputs, &options.output, &run.scenario)?;
    let started = Started {
        run,
        resumable: resumable.flatten(),
        report: None,
    };
    go_on(started, &options.program, &options.output)
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

/// A run that goes on to its end.
struct Started<'a> {
    run: Run,
    /// The whole scenario, which checkpoints hold, if `--until` cuts it short.
    resumable: Option<Scenario>,
    /// What a report needs, if one is asked for and the run begins now.
    report: Option<(Watched, Typed<'a>)>,
}

/// Runs to the end.
fn go_on(
    started: Started,
    program: &ProgramOptions,
    options: &OutputOptions,
) -> Result<(), Failure> {
    let Started {
        mut run,
        resumable,
        mut report,
    } = started;
    let interrupt = Interrupt::listen().map_err(|error| Failure::Output(error.to_string()))?;
    let checkpoints = Checkpoints::create(&options.checkpoint, resumable, &mut run);
    let progress = Progress::new(run.scenario.duration_secs);
    let mut observers: Vec<Box<dyn Observer<Failure> + Send + '_>> = vec![Box::new(progress)];
    if let Some((watched, _)) = &mut report {
        Watched::prepare(&mut run.simulation);
        observers.push(Box::new(Watch(watched)));
    }
    observers.extend(recordings(&options.record, &mut run, &interrupt)?);
    for trajectory in trajectories(&options.trajectory, &mut run)? {
        observers.push(Box::new(trajectory));
    }
    if let Some(checkpoints) = checkpoints {
        observers.push(Box::new(checkpoints));
    }
    // On a thread of the pool, parallel work starts without handing it over to the pool first.
    let interrupted = || interrupt.exit_code().is_some();
    let driven = rayon::scope(|_| run.drive(&mut observers, interrupted));
    // Close all files first, so that they are kept even if the run failed.
    let finished: Vec<_> = observers.into_iter().map(Observer::finish).collect();
    let end = driven.map_err(|failure| failure.with_forces(&mut run.simulation))?;
    notes::print(&run);
    notes::print_absent(&options.record, &run.simulation);
    tell(
        program.json,
        || results::json(&run),
        || results::document(&run, options.verbose).text(),
    )?;
    finished.into_iter().collect::<Result<(), _>>()?;
    if options.files.are_given() {
        options.files.save(&match &report {
            Some((watched, typed)) => findings(&run, watched, typed)?,
            // The beginning was not seen: as on the terminal.
            None => results::findings(&run, results::document(&run, false))?,
        })?;
    }
    match interrupt.exit_code() {
        Some(exit_code) if end == End::Interrupted => {
            let time = run.simulation.frame().clock.time();
            Err(Failure::Interrupted { time, exit_code })
        }
        _ => Ok(()),
    }
}
