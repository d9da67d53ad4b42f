//! `sandbox draw RUN -o FILE.html`: a page of a recording or of trajectories.

use std::path::{Path, PathBuf};

use clap::Args;
use serde_json::{Value, json};

use super::arguments::{ProgramOptions, TrackOptions, use_threads};
use super::failure::Failure;
use super::frames::{Run, recorded, tracked};
use super::terminal::tell;
use super::values::{frame_rate, page};
use super::watch::bar;
use output::page::{EmbeddedViewer, Moment, Page, PageOptions as Content};
use output::picture::{Crowd, Picture};
use output::results::{pairs, reproducible, results, section};
use runs::outputs::{Manner, Outputs};
use scenario::trajectories::endings;

/// Where densities come from, in words.
const DENSITIES: &str =
    "the column `density` of the file, or else the SPH kernel with a support radius of 1 m";

#[derive(Args)]
pub struct PageOptions {
    #[arg(
        value_name = "RUN",
        help = format!("A recording (.rrd) or trajectories ({}), of the sandbox, JuPedSim or others", endings())
    )]
    pub run: PathBuf,
    /// The page [default: the run's name with .html, in the working directory]
    #[arg(short, long, value_name = "FILE", value_parser = page())]
    pub out: Option<PathBuf>,
    /// Floor plan of a trajectory file (WKT, GeoJSON, JuPedSim XML), or `none` [default: that of the file]
    #[arg(long, value_name = "FILE|none")]
    pub geometry: Option<PathBuf>,
    #[command(flatten)]
    pub tracks: TrackOptions,
    /// Frame rate of a trajectory file that does not have it
    #[arg(long, value_name = "N", value_parser = frame_rate)]
    pub trajectory_fps: Option<f64>,
    /// Put the Rerun viewer and the recording into the page, too: the folder of the Python package `rerun_notebook`
    /// 0.36.3
    #[arg(long, value_name = "DIR")]
    pub page_viewer: Option<PathBuf>,
    #[command(flatten)]
    pub program: ProgramOptions,
}

pub fn run(options: &PageOptions) -> Result<(), Failure> {
    use_threads(options.program.threads)?;
    let mut outputs = Outputs::new(options.program.force);
    let out = options.out.clone().unwrap_or_else(|| {
        let stem = options.run.file_stem().unwrap_or_default();
        Path::new(stem).with_added_extension("html")
    });
    let mut run = open(options, &mut outputs)?;
    outputs.writes("--out", &out, Manner::InPlace);
    outputs.check()?;
    let viewer = options
        .page_viewer
        .as_deref()
        .map(EmbeddedViewer::in_package)
        .transpose()?
        .map(|viewer| (viewer, options.run.as_path()));
    let frames = rayon::scope(|_| write(&mut run, &out, viewer.as_ref()))?;
    let file = out.display().to_string();
    let bytes = out.metadata().map_or(0, |about| about.len());
    let [first, last] = run.times.unwrap_or_default();
    tell(
        options.program.json,
        || json!({"file": file, "frames": frames, "from_secs": first, "to_secs": last, "bytes": bytes}),
        || {
            format!(
                "{file}: {frames} frames from {first:.2} s to {last:.2} s, {:.1} MB\n",
                bytes as f64 * 1e-6
            )
        },
    )
}

fn open(options: &PageOptions, outputs: &mut Outputs) -> Result<Run, Failure> {
    let path = options.run.as_path();
    let extension = path.extension().unwrap_or_default().to_ascii_lowercase();
    if extension == "rrd" {
        outputs.reads("the recording", path);
        let given = [
            ("--geometry", options.geometry.is_some()),
            ("--unit", options.tracks.unit.is_some()),
            ("--trajectory-fps", options.trajectory_fps.is_some()),
        ];
        if let Some((option, _)) = given.iter().find(|(_, is_given)| *is_given) {
            let problem = format!("{option} is for trajectory files, not for recordings");
            return Err(Failure::Input(problem));
        }
        return recorded::open(path, options.tracks.level.as_deref());
    }
    if options.page_viewer.is_some() {
        let problem = "--page-viewer is for recordings: the Rerun viewer shows no trajectory files";
        return Err(Failure::Input(problem.to_owned()));
    }
    let read = options.tracks.reading(options.trajectory_fps);
    let plan = options.geometry.as_deref();
    tracked::open(path, &read, plan, &["density", "speed"], outputs)
}

/// Writes the page; returns the number of frames.
fn write(
    run: &mut Run,
    out: &Path,
    viewer: Option<&(EmbeddedViewer, &Path)>,
) -> Result<usize, Failure> {
    let scenario = run.scenario.as_ref();
    let description = scenario.map_or("", |scenario| scenario.description.as_str());
    let content = Content {
        title: run.title.clone(),
        description: description.to_owned(),
        density_range: run.density_range,
        speed_range: run.speed_range,
        has_viewer: viewer.is_some(),
        opens_at: scenario.and_then(|scenario| scenario.view.opens_at_secs),
        ..Content::watched()
    };
    let nobody = Crowd::default();
    let picture = Picture {
        observed: &run.observed,
        labels: &run.labels,
        drawing: run.drawing.as_ref(),
        ..Picture::of_scene((run.frames.scene(), &nobody), String::new(), run.view)
    };
    let mut page = Page::create(out, &picture, &content)?;
    let times = run.frames.times().to_vec();
    let progress = bar(
        times.len() as u64,
        "{bar:30} {pos} of {len} frames, {left} left",
    );
    for &time in &times {
        run.frames.go_to(time)?;
        let column = |name| -> Result<Vec<f64>, Failure> {
            Ok(run.frames.column(name)?.unwrap_or_default())
        };
        let (density, speed) = (column("density")?, column("speed")?);
        page.add(&Moment::watched(run.frames.crowd(), density, speed))?;
        progress.inc(1);
    }
    if let Some((viewer, recording)) = viewer {
        page.embed(viewer, recording)?;
    }
    page.finish(&found(run, times.len()))?;
    Ok(times.len())
}

/// The results of the run if the file has them, else what the file says about itself.
fn found(run: &Run, frames: usize) -> String {
    let text = run.report.as_deref();
    let report = text.and_then(|text| serde_json::from_str::<Value>(text).ok());
    if let Some(report) = report {
        return results(&reproducible(report), run.scenario.as_ref());
    }
    let [first, last] = run.times.unwrap_or_default();
    let facts = [
        ("frames", frames.to_string()),
        ("first frame [s]", format!("{first:.3}")),
        ("last frame [s]", format!("{last:.3}")),
        ("densities", DENSITIES.to_owned()),
    ];
    let rows = facts.map(|(name, value)| (name.to_owned(), value));
    let table = section("Trajectories", &pairs(&rows).html());
    format!("<section class=\"results\">\n{table}</section>\n")
}
