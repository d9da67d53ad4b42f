//! The pictures and the recording of measurements.

use std::path::Path;

use crate::cli::{Failure, talk};
use crate::lab::measure::{Measured, Moment, MomentRecorder, Options, Site, pictures};
use crate::output::trajectory::read::Tracks;

const RECORDING: &str = "measured.rrd";

/// The names of the files that can be written.
pub fn names() -> impl Iterator<Item = String> {
    let pictures = pictures::STEMS.into_iter().flat_map(|stem| {
        let name = |kind| format!("{stem}.{kind}");
        ["svg", "png"].map(name)
    });
    [RECORDING.to_owned()].into_iter().chain(pictures)
}

/// Draws the measurements.
pub fn save_pictures(folder: &Path, measured: &Measured, site: &Site) -> Result<(), Failure> {
    let saved = pictures::save(folder, measured, site);
    saved.map_err(|error| Failure::Output(error.to_string()))
}

/// The recording of the measurements.
pub struct Recording<'a>(MomentRecorder<'a>);

impl<'a> Recording<'a> {
    pub fn create(
        folder: &Path,
        tracks: &'a Tracks,
        site: &Site,
        options: &Options,
    ) -> Result<Self, Failure> {
        let path = folder.join(RECORDING);
        let title = folder.file_name().unwrap_or_default().to_string_lossy();
        let recorder = MomentRecorder::create(&path, (tracks, site), &title, options)?;
        if !recorder.has_own_ids() {
            talk("note: in the recording ids are replaced by numbers in their order, from 0");
        }
        Ok(Self(recorder))
    }

    pub fn add(&mut self, moments: &[Moment]) -> Result<(), Failure> {
        Ok(self.0.add(moments)?)
    }

    pub fn finish(self) -> Result<(), Failure> {
        Ok(self.0.finish()?)
    }
}
