//! Trajectories that the tests measure.

use std::fmt::Write;
use std::path::PathBuf;

use sandbox::analysis::crossing::Passages;
use sandbox::engine::boundary::WallMethod;
use sandbox::lab::measure::{
    Behind, CellLimit, Kernel, MeasureError, Measured, Moment, Options, Site, measure,
};
use sandbox::scenario::trajectories::{ReadError, ReadOptions, Tracks, read};

/// Writes a file with this name and text; returns its folder and its path.
pub fn file(name: &str, text: &str) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, text).unwrap();
    (folder, path)
}

/// Reads a file with this name and text; the folder is removed from error messages.
pub fn read_as(name: &str, text: &str, options: &ReadOptions) -> Result<Tracks, String> {
    let (folder, path) = file(name, text);
    let folder = format!("{}/", folder.path().display());
    read(&path, options).map_err(|error: ReadError| error.to_string().replace(&folder, ""))
}

/// Trajectories of the rows `id frame x y` in meters, at `fps` frames per second.
pub fn tracks(fps: f64, rows: &[(i64, i64, f64, f64)]) -> Tracks {
    let mut text = format!("# framerate: {fps}\n# id frame x/m y/m\n");
    for (id, frame, x, y) in rows {
        writeln!(text, "{id} {frame} {x} {y}").unwrap();
    }
    read_as("rows.txt", &text, &ReadOptions::default()).unwrap()
}

/// What `sandbox measure` measures without options, but without regions and lines.
pub fn options() -> Options {
    Options {
        kernel: Kernel {
            support_radius: 1.0,
            walls: WallMethod::Union,
        },
        behind: Behind::Same,
        speed_reach: 5,
        times: [f64::NEG_INFINITY, f64::INFINITY],
        cell: 0.25,
        cells: CellLimit::default(),
        regions: Vec::new(),
        lines: Vec::new(),
        flow_of: Passages::Parts([0.1, 0.9]),
        sample_every: 1.0,
    }
}

/// Measures trajectories; also returns all frames.
pub fn measured(tracks: &Tracks, site: &Site, options: &Options) -> (Measured, Vec<Moment>) {
    let mut all = Vec::new();
    let measured = measure(tracks, site, options, |moments: &[Moment]| {
        all.extend_from_slice(moments);
        Ok::<(), MeasureError>(())
    });
    (measured.unwrap(), all)
}

/// Five people in a row, as in the files of the pushes: the first one is at `from`, and they look against y. From 0.4 s
/// after the first frame on they walk at 0.5 m/s for 1 s, each 0.16 s after the one behind.
pub fn file_of_a_row([x, from]: [f64; 2]) -> String {
    let mut text = "id,frame,x,y\n".to_owned();
    for person in 0..5 {
        for frame in 0..=100 {
            let walked = f64::from(frame) / 25.0 - 0.4 - 0.16 * f64::from(person);
            let y = from - 0.4 * f64::from(person) - 0.5 * walked.clamp(0.0, 1.0);
            text += &format!("{person},{frame},{x},{y}\n");
        }
    }
    text
}
