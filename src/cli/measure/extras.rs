//! What a program has that was built with pictures and recordings.

use std::path::Path;

use crate::cli::Failure;
use crate::measure::{Measured, Moment, Options, Site};
use crate::trajectory::read::Tracks;

#[cfg(feature = "recording")]
const RECORDING: &str = "measured.rrd";

/// The names of the files that may be written.
pub fn names() -> impl Iterator<Item = String> {
    #[cfg(feature = "recording")]
    let recording = Some(RECORDING.to_owned());
    #[cfg(not(feature = "recording"))]
    let recording: Option<String> = None;
    #[cfg(feature = "plot")]
    let stems = crate::measure::pictures::STEMS;
    #[cfg(not(feature = "plot"))]
    let stems: [&str; 0] = [];
    let pictures = stems.into_iter().flat_map(|stem| {
        let name = |kind| format!("{stem}.{kind}");
        ["svg", "png"].map(name)
    });
    recording.into_iter().chain(pictures)
}

/// Draws what was measured.
#[cfg(feature = "plot")]
pub fn save_pictures(folder: &Path, measured: &Measured, site: &Site) -> Result<(), Failure> {
    let saved = crate::measure::pictures::save(folder, measured, site);
    saved.map_err(|error| Failure::Output(error.to_string()))
}

/// A program without the feature `plot` draws nothing.
#[cfg(not(feature = "plot"))]
pub fn save_pictures(_: &Path, _: &Measured, _: &Site) -> Result<(), Failure> {
    Ok(())
}

#[cfg(feature = "recording")]
pub use with_recording::Recording;

#[cfg(feature = "recording")]
mod with_recording {
    use super::*;
    use crate::cli::talk;
    use crate::measure::MomentRecorder;

    /// The recording of what is measured.
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
}

#[cfg(not(feature = "recording"))]
pub use without_recording::Recording;

#[cfg(not(feature = "recording"))]
mod without_recording {
    use super::*;

    /// A program built without the feature `recording` writes none.
    pub struct Recording;

    impl Recording {
        pub fn create(_: &Path, _: &Tracks, _: &Site, _: &Options) -> Result<Self, Failure> {
            Ok(Self)
        }

        pub fn add(&mut self, _: &[Moment]) -> Result<(), Failure> {
            Ok(())
        }

        pub fn finish(self) -> Result<(), Failure> {
            Ok(())
        }
    }
}
