//! The Rerun viewer in a page, from an installed package of Python: for the whole recording, beside the page's own
//! plan.

use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use super::PageError;
use super::file::Part;

/// The version of the package: that of recordings.
const VERSION: &str = "0.36.3";
/// Recordings are compressed in pieces of this many bytes, so that they need not fit into memory.
const PIECE: u64 = 8 << 20;
/// What the script needs: compiling the viewer, and its script as a module.
pub const ALLOWED: &str = " 'wasm-unsafe-eval' blob:; connect-src blob: data:";

/// The viewer of an installed package.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct EmbeddedViewer {
    script: PathBuf,
    program: PathBuf,
}

impl EmbeddedViewer {
    /// The viewer in the folder of the package `rerun_notebook`.
    ///
    /// # Errors
    /// The folder has none, or one of another version.
    pub fn in_package(folder: &Path) -> Result<Self, PageError> {
        let missing = |reason: String| PageError::NoViewer {
            folder: folder.to_owned(),
            reason,
        };
        let [script, program] =
            ["widget.js", "re_viewer_bg.wasm"].map(|name| folder.join("static").join(name));
        for file in [&script, &program] {
            if !file.is_file() {
                return Err(missing(format!("there is no {}", file.display())));
            }
        }
        let about = folder.with_file_name(format!("rerun_notebook-{VERSION}.dist-info"));
        match about.is_dir() {
            true => Ok(Self { script, program }),
            false => Err(missing(format!(
                "it is not version {VERSION}: there is no {}",
                about.display()
            ))),
        }
    }

    /// The viewer and a recording as parts of a page, one after the other.
    pub(super) fn parts(
        &self,
        recording: &Path,
        mut write: impl FnMut(Part) -> Result<(), PageError>,
    ) -> Result<(), PageError> {
        for (class, path, piece) in [
            ("rerun-script", self.script.as_path(), u64::MAX),
            ("rerun-program", &self.program, u64::MAX),
            ("recording", recording, PIECE),
        ] {
            let unread = |error: io::Error| PageError::Unread {
                path: path.to_owned(),
                cause: error.to_string(),
            };
            let mut file = File::open(path).map_err(unread)?;
            loop {
                let mut bytes = Vec::new();
                file.by_ref()
                    .take(piece)
                    .read_to_end(&mut bytes)
                    .map_err(unread)?;
                if bytes.is_empty() {
                    break;
                }
                write(Part::Bytes(class, bytes))?;
            }
        }
        Ok(())
    }
}
