//! Outlines with names: where agents enter and push, and where a crowd is or was measured.

use rerun::RecordingStream;

use super::names::Names;
use crate::recording::draw::{Look, log_lines};
use crate::recording::error::Cause;
use crate::recording::options::RecordingOptions;
use crate::scenery::{self, closed, named};
use analysis::crossing::Line;
use engine::math::Vector;
use engine::scene::{Region, Scene};
use figures::colors::Rgb;

const SOURCE: Look = ([0, 170, 200], 1.0, 3.0);
const PUSH: Look = ([230, 110, 90], 1.0, 3.0);
/// The outlines that a run measures.
const MEASURED: Look = ([200, 196, 150], 1.0, 3.0);
/// The regions and lines at which a real crowd was measured.
const REGION: Look = ([255, 200, 60], 1.25, 7.0);
const LINE: Look = ([255, 110, 200], 1.25, 7.0);
/// The color of texts.
const TEXT: Rgb = [200, 200, 200];
/// The length of a dash and of the gap after it, as a fraction of the longest side of the visible region.
const DASH: f64 = 0.008;

/// Outlines with names, which may be empty.
type Named = Vec<(String, Vec<Vector>)>;

/// Regions and lines, which count from 1 in their order.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Marked<'a> {
    /// Rectangles, meters.
    pub regions: &'a [Region],
    /// Lines, meters.
    pub lines: &'a [Line],
}

impl Marked<'_> {
    /// Logs them, and adds their names.
    pub(in crate::recording) fn log(
        &self,
        stream: &RecordingStream,
        names: &mut Names,
    ) -> Result<(), Cause> {
        let outlines = self.regions.iter().map(|region| closed(&region.corners()));
        let numbered = (1..).zip(outlines);
        let regions = numbered.map(|(k, outline)| (format!("region {k}"), outline));
        log_named(
            (stream, names),
            "measured_regions",
            REGION,
            regions.collect(),
        )?;
        let lines = (1..)
            .zip(self.lines.iter().map(|line| vec![line.start, line.end]))
            .map(|(k, line)| (format!("line {k}"), line));
        log_named((stream, names), "measured_lines", LINE, lines.collect())
    }
}

/// Logs the outlines of sources and pushes, and dashed those of measurements; adds their names, and the texts of the
/// options.
pub fn log(
    stream: &RecordingStream,
    scene: &Scene,
    options: &RecordingOptions,
    names: &mut Names,
) -> Result<(), Cause> {
    let sources = scene.sources.iter().map(|source| {
        let (min, max) = (source.grid.min, source.grid.max);
        let outline = closed(&Region { min, max }.corners());
        (named("source", &source.name), outline)
    });
    log_named((stream, names), "sources", SOURCE, sources.collect())?;
    let all = scene.pushes.iter();
    let pushes = all.map(|push| (named("push", &push.name), closed(&push.region.corners())));
    log_named((stream, names), "pushes", PUSH, pushes.collect())?;
    // Texts lie in their rooms; names of measurements find other places.
    let observed = options.measured.iter().map(|(name, _)| name.as_str());
    for text in scenery::own_texts(scene, observed, &options.labels) {
        names.add_within("names", text, TEXT);
    }
    let mut measured = scenery::observed_once(scene, &options.measured);
    for (name, _) in measured.iter_mut().filter(|(name, _)| !name.is_empty()) {
        name.insert_str(0, "measured: ");
    }
    names.add_outlines("measured", MEASURED.0, &measured);
    let dash = DASH * (options.view.max - options.view.min).max();
    let dashed = measured
        .iter()
        .flat_map(|(_, outline)| dashes(outline, dash));
    log_lines(stream, "measured", MEASURED, dashed)
}

/// Logs outlines, and adds their names.
fn log_named(
    (stream, names): (&RecordingStream, &mut Names),
    entity: &str,
    look: Look,
    named: Named,
) -> Result<(), Cause> {
    names.add_outlines(entity, look.0, &named);
    let outlines = named.into_iter().map(|(_, outline)| outline);
    log_lines(stream, entity, look, outlines)
}

/// Dashes of this length along a line, with gaps as long between them.
fn dashes(line: &[Vector], length: f64) -> Vec<Vec<Vector>> {
    let mut all = Vec::new();
    for ends in line.windows(2) {
        let way = ends[1] - ends[0];
        // An odd number of parts, so that every corner has a dash.
        let parts = ((way.norm() / length / 2.0).floor() as u32).min(500) * 2 + 1;
        let at = |part: u32| ends[0] + way * (f64::from(part) / f64::from(parts));
        let dashes = (0..parts).step_by(2);
        all.extend(dashes.map(|part| vec![at(part), at(part + 1)]));
    }
    all
}
