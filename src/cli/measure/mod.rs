//! `sandbox measure`: densities, speeds and flows in trajectories.

mod arguments;

pub use arguments::MeasureOptions;

use std::path::{Path, PathBuf};

use super::arguments::use_threads;
use super::documents::add_folder;
use super::failure::Failure;
use super::inputs::{FPS, in_order, site, tracks};
use super::terminal::talk;
use super::watch::bar;
use analysis::site::Site;
use engine::boundary::WallMethod;
use lab::measure::{
    Behind, CellLimit, Kernel, MOST_HIDDEN, Measured, MomentRecorder, Options, Report, Results,
    STREAMED, check, measure, names, speed,
};
use output::recording::check_enabled;
use runs::outputs::{Manner, Outputs};
use scenario::trajectories::Tracks;

pub fn run(options: &MeasureOptions) -> Result<(), Failure> {
    check_enabled()?;
    use_threads(options.program.threads)?;
    options.print.apply();
    let folder = folder(options);
    if let (Some(from), Some(until)) = (options.from, options.until) {
        in_order(("--from", from), ("--until", until))?;
    }
    check_outputs(options, &folder)?;
    let read = options.tracks.reading(options.fps);
    let tracks = tracks(&options.trajectory, &read, FPS)?;
    let site = site(&options.trajectory, options.geometry.as_deref(), &tracks)?;
    let what = what(options, &tracks);
    check(&tracks, &site, &what)?;
    let measured = recorded(&folder, (&tracks, &site), &what)?;
    report_oddities(&measured);
    let report = Report {
        tracks: &tracks,
        options: &what,
        measured: &measured,
    };
    let found = report.findings(&site)?;
    options
        .files
        .give(&found, options.program.json, Some(&folder))
}

/// The folder of the results. By default it lies in the current folder, not beside the data.
fn folder(options: &MeasureOptions) -> PathBuf {
    let by_default = || {
        let mut name = options
            .trajectory
            .file_stem()
            .unwrap_or_default()
            .to_owned();
        name.push("-measured");
        name.into()
    };
    options.out.clone().unwrap_or_else(by_default)
}

/// Measures, and writes the rows and a recording of them to the folder meanwhile.
fn recorded(
    folder: &Path,
    (tracks, site): (&Tracks, &Site),
    what: &Options,
) -> Result<Measured, Failure> {
    let mut results = Results::create(folder)?;
    let mut recording = MomentRecorder::create(folder, (tracks, site), what)?;
    if !recording.has_own_ids {
        talk("note: in the recording ids are replaced by numbers in their order, from 0");
    }
    let [x, y] = recording.origin.into();
    if [x, y] != [0.0; 2] {
        talk(&format!(
            "note: in the recording places are those of the file less ({x}, {y}) m: so far from the origin its single \
             precision is too coarse"
        ));
    }
    let template = "{bar:30} {pos} of {len} rows, {left} left";
    let progress = bar(tracks.len() as u64, template);
    let measured = measure(tracks, site, what, |moments| {
        let rows: usize = moments.iter().map(|moment| moment.people.len()).sum();
        progress.inc(rows as u64);
        results.add(moments)?;
        Ok::<(), Failure>(recording.add(moments)?)
    });
    drop(progress);
    let measured = measured?;
    results.finish()?;
    recording.finish()?;
    let (folder, streamed) = (folder.display(), STREAMED.join(", "));
    talk(&format!("note: written to {folder}: {streamed}"));
    Ok(measured)
}

/// Rejects results that cannot be written or would replace an input.
fn check_outputs(options: &MeasureOptions, folder: &Path) -> Result<(), Failure> {
    let mut outputs = Outputs::new(options.program.force);
    outputs.reads("the trajectories", &options.trajectory);
    if let Some(plan) = &options.geometry {
        outputs.reads("--geometry", plan);
    }
    outputs.writes("--out", folder, Manner::Folder);
    for name in STREAMED {
        outputs.writes("--out", &folder.join(name), Manner::Beside);
    }
    add_folder(&mut outputs, folder, &names());
    options.files.add_to(&mut outputs, &names());
    Ok(outputs.check()?)
}

fn what(options: &MeasureOptions, tracks: &Tracks) -> Options {
    let walls = match options.wall_method.as_str() {
        "exact" => WallMethod::Exact,
        "representative" => WallMethod::Representative,
        _ => WallMethod::Union,
    };
    let reach = options.speed_window.map(|secs| {
        let reach = (0.5 * secs / tracks.interval()).round().max(1.0);
        (reach as i64).min(i64::from(u32::MAX))
    });
    Options {
        kernel: Kernel {
            support_radius: options.support_radius,
            walls,
        },
        behind: match options.behind_walls.as_str() {
            "rest" => Behind::Rest(options.rest_density_max),
            _ => Behind::Same,
        },
        speed_reach: reach.unwrap_or(speed::FRAMES),
        times: [
            options.from.unwrap_or(f64::NEG_INFINITY),
            options.until.unwrap_or(f64::INFINITY),
        ],
        cell: options.cell,
        cells: CellLimit {
            cut_off: options.voronoi_cutoff.0,
            quad_segments: options.voronoi_segments,
        },
        regions: options.region.clone(),
        lines: options.line.clone(),
        flow_of: options.flow_of,
        sample_every: options.sample_every,
    }
}

/// Prints notes on unusual rows and crossings.
fn report_oddities(measured: &Measured) {
    let overview = &measured.overview;
    let (inside, deepest) = overview.inside;
    if inside > 0 {
        talk(&format!(
            "note: {inside} of {} rows are outside of the walkable area, by {deepest:.2} m at most; they \
             count, with the walls as seen from the nearest walkable point, or without walls if it is farther than h",
            overview.rows
        ));
    }
    if overview.crammed > 0 {
        let (rows, most) = (overview.crammed, 100.0 * MOST_HIDDEN);
        talk(&format!(
            "note: in {rows} rows walls hide more than {most} % of the kernel; {most} % are used"
        ));
    }
    for (k, crossings) in measured.crossings.iter().enumerate() {
        if crossings.across_gaps > 0 {
            talk(&format!(
                "note: line {}: {} person(s) crossed it during a gap in their trajectory; these crossings \
                 do not count",
                k + 1,
                crossings.across_gaps
            ));
        }
    }
}
