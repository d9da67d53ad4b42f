//! `sandbox draw`: pictures and animations of a run, without a viewer, and the curve of the people who leave.
//!
//! A run is a scenario, which is simulated until then, a trajectory file or a recording:
//! [`Frames`](super::frames::Frames).

mod arguments;
mod egress;
mod look;
mod paths;
mod places;
mod simulated;

pub use arguments::DrawOptions;

use std::path::{Path, PathBuf};

use serde_json::json;

use super::arguments::{SceneOptions, TrackOptions, use_threads};
use super::failure::Failure;
use super::frames::{Run, of_level, recorded, tracked};
use super::inputs::in_order;
use super::interrupt::Interrupt;
use super::moment;
use super::page::PageOptions;
use super::terminal::tell;
use super::values::is_page;
use super::watch::bar;
use look::{Look, NONE};
use output::drawing::Drawing;
use output::picture::{Paths, Picture, Trails};
use output::plot::{Animation, PAPER_DPI, Print};
use runs::outputs::{Manner, Outputs};
use scenario::trajectories;

/// The width of pictures without another one, millimeters: two columns of a paper.
const WIDTH_MM: f64 = 180.0;
/// The resolution of animations without another one, pixels per inch.
const ANIMATION_DPI: f64 = 100.0;
/// The longest time between two points of a path, seconds.
const TRAIL_STEP: f64 = 0.1;
/// The most frames of an animation.
const MOST_FRAMES: f64 = 100_000.0;
/// The fastest GIFs: its times are hundredths of a second, and programs show shorter ones than two more slowly.
const FASTEST_GIF: f64 = 50.0;

/// The moments to draw: one, or several for an animation.
struct Times {
    from: f64,
    count: u32,
    fps: f64,
    is_animation: bool,
}

impl Times {
    fn of(options: &DrawOptions, out: &Path) -> Result<Self, Failure> {
        let (Some(from), Some(to)) = (options.from, options.to) else {
            return Ok(Self {
                from: options.at,
                count: 1,
                fps: options.fps,
                is_animation: false,
            });
        };
        in_order(("--from", from), ("--to", to))?;
        let count = ((to - from) * options.fps).round();
        if !(1.0..=MOST_FRAMES).contains(&count) {
            return Err(Failure::Input(format!(
                "--from {from} --to {to} --fps {} are {count} frames; an animation has 1 to {MOST_FRAMES}",
                options.fps
            )));
        }
        if extension(out) == "gif" && options.fps > FASTEST_GIF {
            return Err(Failure::Input(format!(
                "--fps {}: a GIF has at most {FASTEST_GIF} frames per second",
                options.fps
            )));
        }
        Ok(Self {
            from,
            count: count as u32,
            fps: options.fps,
            is_animation: true,
        })
    }

    fn at(&self, k: u32) -> f64 {
        self.from + f64::from(k) / self.fps
    }
}

pub fn run(options: &DrawOptions) -> Result<(), Failure> {
    let program = &options.scene.program;
    use_threads(program.threads)?;
    let mut outputs = Outputs::new(program.force);
    let out = options.out.clone().unwrap_or_else(|| {
        let stem = Path::new(&options.run).file_stem().unwrap_or_default();
        Path::new(stem).with_added_extension("svg")
    });
    if is_page(&out) {
        return super::page::run(&page(options, out)?);
    }
    if let Some(folder) = &options.page_viewer {
        let (folder, file) = (folder.display(), out.display());
        let reason = format!("--page-viewer {folder}: is for pages, and {file} is a picture");
        return Err(Failure::Input(reason));
    }
    if options.egress {
        check_format(&out, false)?;
        return egress::draw(options, &out, outputs);
    }
    let times = Times::of(options, &out)?;
    check_format(&out, times.is_animation)?;
    if times.is_animation {
        Animation::check(&out)?;
    }
    let (mut run, paths) = open(options, &times, &mut outputs)?;
    outputs.writes("--out", &out, Manner::File);
    outputs.check()?;
    check_times(&run, &times)?;
    rayon::scope(|_| draw(options, (&mut run, paths), &times, &out))?;
    let (file, count, crowd) = (out.display().to_string(), times.count, run.frames.crowd());
    let (from, time, people) = (times.from, crowd.time, crowd.len());
    let mut result = json!({"file": file, "time_secs": time, "agents": people});
    let mut text = format!("{file}: {people} agents at {time:.2} s\n");
    if times.is_animation {
        result["frames"] = json!(count);
        text = format!("{file}: {count} frames from {from:.2} s to {time:.2} s\n");
    }
    if !run.places.is_empty() {
        result["places"] = places::json(&run.places);
        text.push_str(&places::text(&run.places));
    }
    tell(program.json, || result, || text)
}

/// The options of a page: it plays all of a recording or of trajectories, in the colors of the file.
fn page(options: &DrawOptions, out: PathBuf) -> Result<PageOptions, Failure> {
    let given = [
        ("--at", options.at != 0.0),
        ("--from", options.from.is_some()),
        ("--color", options.color.is_some()),
        ("--range", options.range.is_some()),
        ("--trails", options.trails.is_some()),
        ("--field", options.field.is_some()),
        ("--paths", !options.paths.is_empty()),
        ("--egress", options.egress),
        ("--width", options.width.is_some()),
        ("--dpi", options.dpi.is_some()),
        ("--paper", options.paper.is_some()),
    ];
    if let Some((option, _)) = given.iter().find(|(_, is_given)| *is_given) {
        let file = out.display();
        return Err(Failure::Input(format!(
            "{option} is for pictures, and {file} is a page: leave it out, or give a file in .svg, .png or .pdf"
        )));
    }
    let scene = &options.scene;
    let run = PathBuf::from(&options.run);
    let extension = extension(&run);
    if extension == "json" || extension.is_empty() {
        return Err(Failure::Input(format!(
            "{}: a page is made of a run: sandbox run {} --save {}",
            options.run,
            options.run,
            out.display()
        )));
    }
    refuse_settings(options, scene)?;
    Ok(PageOptions {
        run,
        out: Some(out),
        geometry: scene.geometry.clone(),
        tracks: TrackOptions {
            unit: options.tracks.unit.clone(),
            level: options.tracks.level.clone(),
        },
        trajectory_fps: options.trajectory_fps,
        page_viewer: options.page_viewer.clone(),
        program: scene.program,
    })
}

/// The extension of a path in lowercase; empty without one.
fn extension(path: &Path) -> String {
    let extension = path.extension().unwrap_or_default();
    extension.to_string_lossy().to_ascii_lowercase()
}

/// Rejects pictures of one moment as videos, and animations as drawings.
fn check_format(out: &Path, is_animation: bool) -> Result<(), Failure> {
    let extension = extension(out);
    let problem = match (extension.as_str(), is_animation) {
        ("svg" | "pdf", true) => "is no format of animations; use .gif, .png, .mp4 or .webm",
        ("gif" | "mp4" | "webm", false) => {
            "is a format of animations; give --from and --to, or use .svg, .png or .pdf"
        }
        _ => return Ok(()),
    };
    Err(Failure::Input(format!(
        "--out {}: .{extension} {problem}",
        out.display()
    )))
}

/// Opens the run, with the routes that are asked for.
fn open(
    options: &DrawOptions,
    times: &Times,
    outputs: &mut Outputs,
) -> Result<(Run, Vec<Paths>), Failure> {
    let path = Path::new(&options.run);
    let run = match extension(path).as_str() {
        "rrd" => {
            refuse_settings(options, &options.scene)?;
            outputs.reads("the recording", path);
            recorded::open(path, options.tracks.level.as_deref())?
        }
        _ if trajectories::has_ending(path) => {
            refuse_settings(options, &options.scene)?;
            let read = options.tracks.reading(options.trajectory_fps);
            let plan = options.scene.geometry.as_deref();
            tracked::open(path, &read, plan, &[color(options, false)], outputs)?
        }
        _ => return simulate(options, times, outputs),
    };
    Ok((run, Vec::new()))
}

fn simulate(
    options: &DrawOptions,
    times: &Times,
    outputs: &mut Outputs,
) -> Result<(Run, Vec<Paths>), Failure> {
    if options.tracks.unit.is_some() || options.trajectory_fps.is_some() {
        let reason = "--unit and --trajectory-fps are for trajectory files, not for scenarios";
        return Err(Failure::Input(reason.to_owned()));
    }
    let until = times.at(times.count - 1);
    let scenario = moment::scenario(&options.run, (&options.scene, until), 0, outputs)?;
    let level = options.tracks.level.as_deref();
    let drawing = Drawing::named(&scenario, level).map_err(of_level)?;
    let typed = options.paths.iter();
    let parsed = typed.map(|text| paths::paths(text, &scenario, drawing.as_ref()));
    let paths = parsed.collect::<Result<Vec<_>, _>>()?;
    let option = match times.is_animation {
        true => format!("--to {}", options.to.unwrap_or(until)),
        false => format!("--at {}", options.at),
    };
    Ok((simulated::open(&scenario, drawing, (until, option))?, paths))
}

/// Rejects settings of scenarios for runs that are not simulated.
fn refuse_settings(options: &DrawOptions, scene: &SceneOptions) -> Result<(), Failure> {
    let given = [
        ("--profile", scene.profile.is_some()),
        ("--seed", scene.changes.seed.is_some()),
        ("--preset", scene.preset.is_some()),
        ("--time-step", scene.time_step.is_some()),
        ("--set", !scene.changes.set.is_empty()),
        ("--paths", !options.paths.is_empty()),
    ];
    match given.iter().find(|(_, is_given)| *is_given) {
        Some((option, _)) => Err(Failure::Input(format!(
            "{option} needs a scenario; {} holds a run that is over",
            options.run
        ))),
        None => Ok(()),
    }
}

/// Rejects times that a file does not have.
fn check_times(run: &Run, times: &Times) -> Result<(), Failure> {
    let Some([first, last]) = run.times else {
        return Ok(());
    };
    let (from, to) = (times.from, times.at(times.count - 1));
    let slack = 0.5;
    // Without --at, the first frame is drawn.
    let is_default = !times.is_animation && from == 0.0;
    if is_default || (from >= first - slack && to <= last + slack) {
        return Ok(());
    }
    Err(Failure::Input(format!(
        "no frames from {from} s to {to} s; there are frames from {first:.2} s to {last:.2} s"
    )))
}

/// What colors agents; `has_colors`: if walls are colored by the force on them, agents are not by default.
fn color(options: &DrawOptions, has_colors: bool) -> &str {
    let is_plain = has_colors || !options.paths.is_empty() || options.field.is_some();
    match &options.color {
        Some(name) => name,
        None if is_plain => NONE,
        None => "density",
    }
}

fn print(options: &DrawOptions, is_animation: bool) -> Print {
    let by_default = if is_animation {
        ANIMATION_DPI
    } else {
        PAPER_DPI
    };
    let dpi = options.dpi.unwrap_or(by_default);
    let paper = options.paper.map(Print::paper);
    let width = options.width.map(|width| width.points(dpi));
    Print {
        width: width
            .or(paper.and_then(|paper| paper.width))
            .or(Print::paper(WIDTH_MM).width),
        dpi,
        titles: options.paper.is_none(),
    }
}

/// Draws all moments.
fn draw(
    options: &DrawOptions,
    (run, mut paths): (&mut Run, Vec<Paths>),
    times: &Times,
    out: &Path,
) -> Result<(), Failure> {
    let print = print(options, times.is_animation);
    let mut trails = options.trails.map(Trails::new);
    let before = trails.as_ref().map_or(0.0, |trails| trails.secs);
    let start = (times.from - before).max(0.0);
    approach(run, &mut trails, [start, times.from])?;
    let color = color(options, run.body_mass.is_some());
    let mut look = Look::new(run, color, options.field.as_deref(), options.range)?;
    // A signal ends an animation after a frame, and removes what is written of it.
    let (mut animation, mut interrupt) = (None, None);
    let length = u64::from(if times.is_animation { times.count } else { 0 });
    let progress = bar(length, "{bar:30} {pos} of {len} frames, {left} left");
    for k in 0..times.count {
        if k > 0 {
            approach(run, &mut trails, [times.at(k - 1), times.at(k)])?;
        }
        let picture = Picture {
            simulation: run.frames.simulation(),
            coloring: look.coloring(run)?,
            field: look.field(run),
            trails: trails.as_ref(),
            observed: &run.observed,
            labels: &run.labels,
            paths: std::mem::take(&mut paths),
            body_mass: run.body_mass,
            drawing: run.drawing.as_ref(),
            ..Picture::of_scene(
                (run.frames.scene(), run.frames.crowd()),
                run.title.clone(),
                run.view,
            )
        };
        if !times.is_animation {
            return Ok(picture.save(out, &print)?);
        }
        let image = picture.sheet(&print).image(&print)?;
        paths = picture.paths;
        let animation = match &mut animation {
            Some(animation) => animation,
            none => {
                let length = (times.count, times.fps);
                let unheard = |error: std::io::Error| Failure::Output(error.to_string());
                interrupt = Some(Interrupt::listen().map_err(unheard)?);
                none.insert(Animation::create(out, &image, length, &print)?)
            }
        };
        animation.add(image)?;
        if let Some(exit_code) = interrupt.as_ref().and_then(Interrupt::exit_code) {
            let time = times.at(k);
            return Err(Failure::Stopped { time, exit_code });
        }
        progress.inc(1);
    }
    Ok(animation.map_or(Ok(()), Animation::finish)?)
}

/// Goes to the second of two times, and adds to the paths where people are from the first one on.
fn approach(
    run: &mut Run,
    trails: &mut Option<Trails>,
    [from, to]: [f64; 2],
) -> Result<(), Failure> {
    if let Some(trails) = trails {
        let steps = ((to - from) / TRAIL_STEP - 1e-6).ceil().max(1.0);
        for k in 0..steps as u32 {
            let time = from + (to - from) * f64::from(k) / steps;
            run.frames.go_to(time)?;
            trails.add(run.frames.crowd());
        }
    }
    run.frames.go_to(to)?;
    if let Some(trails) = trails {
        trails.add(run.frames.crowd());
    }
    Ok(())
}
