//! Output files: how they are written, and a check of all of them before the computation starts.
//!
//! Recordings, trajectories and pages of runs grow while the run goes on, and are written in place. All other files are
//! written atomically: under a temporary name in the same folder, then renamed, so that a failure leaves an existing
//! file as it was, and no half of a new one. In both cases symbolic links are followed, devices and FIFOs are never
//! replaced, and new files get permissions from the umask.

use std::fs::{self, File, Metadata, Permissions};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

use tempfile::{NamedTempFile, TempPath};

/// A chain of more symbolic links than this counts as a cycle.
const MOST_LINKS: usize = 40;

/// The way an output is written, which determines its check.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Manner {
    /// The file is opened and truncated.
    InPlace,
    /// The file is replaced atomically, see [`write_whole`].
    Whole,
    /// The same, but devices and FIFOs are written in place, see [`write_file`].
    File,
    /// The file is one of several in a folder, or goes with another file. Checked only if it exists.
    Beside,
    /// A folder, created if missing.
    Folder,
}

/// Why a file cannot be written.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum OutputsError {
    /// The file exists and must not be replaced.
    #[error("{0}: already exists; use --force to replace it")]
    Exists(String),
    /// Two options name the same file.
    #[error("{0} and {1} are the same file; use a different file for each")]
    Shared(String, String),
    /// An option names an input file.
    #[error(
        "{0} and {1} are the same file; an input is never replaced, not even with --force: write to another file"
    )]
    Input(String, String),
    /// The folder of a file does not exist.
    #[error("{0}: the folder {1} does not exist: make it")]
    NoFolder(String, String),
    /// The file cannot be written, with the system's message.
    #[error("{0}: cannot be written: {1}")]
    Unwritable(String, String),
}

/// All files that a command reads and writes.
#[derive(Debug, Clone, Default)]
pub struct Outputs {
    force: bool,
    inputs: Vec<Input>,
    outputs: Vec<Output>,
}

#[derive(Debug, Clone)]
struct Input {
    name: String,
    path: PathBuf,
    /// The option that may replace this file.
    replaced_by: Option<&'static str>,
}

#[derive(Debug, Clone)]
struct Output {
    option: &'static str,
    path: PathBuf,
    manner: Manner,
    /// Whether it may replace an existing file.
    force: bool,
}

impl Output {
    /// Its name in messages.
    fn name(&self) -> String {
        format!("{} {}", self.option, self.path.display())
    }

    /// Why it cannot be written.
    fn unwritable(&self, error: &io::Error) -> OutputsError {
        let place = followed(&self.path).unwrap_or_else(|_| self.path.clone());
        let folder = folder_of(&place);
        match error.kind() {
            ErrorKind::NotFound if !folder.exists() => {
                OutputsError::NoFolder(self.name(), folder.display().to_string())
            }
            _ => OutputsError::Unwritable(self.name(), error.to_string()),
        }
    }
}

impl Outputs {
    /// No files yet. Existing files may be replaced only with `force`.
    pub fn new(force: bool) -> Self {
        Self {
            force,
            ..Self::default()
        }
    }

    /// Adds an input; messages call it `name`, followed by its path.
    pub fn reads(&mut self, name: &str, path: &Path) {
        self.inputs.push(Input {
            name: format!("{name} {}", path.display()),
            path: path.to_owned(),
            replaced_by: None,
        });
    }

    /// Adds an input that is read completely before anything is written. `option` may replace it, even without
    /// `force`.
    pub fn reads_and_replaces(&mut self, name: &str, path: &Path, option: &'static str) {
        self.reads(name, path);
        if let Some(input) = self.inputs.last_mut() {
            input.replaced_by = Some(option);
        }
    }

    /// Adds an output file of `option`.
    pub fn writes(&mut self, option: &'static str, path: &Path, manner: Manner) {
        self.outputs.push(Output {
            option,
            path: path.to_owned(),
            manner,
            force: self.force,
        });
    }

    /// Whether the files that are added from now on may replace existing ones.
    pub fn may_replace(&mut self, force: bool) {
        self.force = force;
    }

    /// Checks that all outputs can be written, and leaves everything unchanged: existing files are opened but not
    /// truncated; missing files and folders are created and removed.
    ///
    /// # Errors
    /// An output cannot be written, is the same file as another output or an input (also through links or other
    /// spellings), or exists without `force`.
    pub fn check(&self) -> Result<(), OutputsError> {
        let mut trial = Trial::default();
        let mut existed = Vec::with_capacity(self.outputs.len());
        for output in &self.outputs {
            let tried = trial.attempt(output);
            existed.push(tried.map_err(|error| output.unwritable(&error))?);
        }
        // The trial files still exist, so every output has an identity.
        let files: Vec<_> = self.outputs.iter().map(|o| identity(&o.path)).collect();
        let inputs: Vec<_> = self.inputs.iter().map(|i| identity(&i.path)).collect();
        for (k, (output, file)) in self.outputs.iter().zip(&files).enumerate() {
            let same = |other: &Option<_>| file.is_some() && other == file;
            if let Some(first) = files[..k].iter().position(same) {
                let first = self.outputs[first].name();
                return Err(OutputsError::Shared(first, output.name()));
            }
            let mut may_replace = false;
            for (input, _) in self.inputs.iter().zip(&inputs).filter(|(_, f)| same(f)) {
                may_replace = input.replaced_by == Some(output.option);
                if !may_replace {
                    return Err(OutputsError::Input(output.name(), input.name.clone()));
                }
            }
            let is_folder = output.manner == Manner::Folder;
            if existed[k] && !is_folder && !may_replace && !output.force {
                return Err(OutputsError::Exists(output.name()));
            }
        }
        Ok(())
    }
}

/// The files and folders that a check created; removed on drop.
#[derive(Default)]
struct Trial {
    files: Vec<PathBuf>,
    folders: Vec<PathBuf>,
}

impl Trial {
    /// Checks one output. Returns whether it existed.
    fn attempt(&mut self, output: &Output) -> io::Result<bool> {
        let path = &output.path;
        match (output.manner, metadata(path)?) {
            (Manner::Folder, there) => {
                self.make_folder(path)?;
                try_folder(path)?;
                return Ok(there.is_some());
            }
            (Manner::Beside, None) => return Ok(false),
            (_, None) => {
                let place = followed(path)?;
                File::create_new(&place)?;
                self.files.push(place);
                return Ok(false);
            }
            (manner, Some(about)) => {
                refuse(&about, manner == Manner::Whole)?;
                if manner == Manner::Whole || (manner == Manner::File && about.is_file()) {
                    try_folder(folder_of(&fs::canonicalize(path)?))?;
                }
                // Opening a FIFO would wait for its reader.
                if about.is_file() {
                    File::options().append(true).open(path)?;
                }
            }
        }
        Ok(true)
    }

    /// Creates a folder and its missing parents.
    fn make_folder(&mut self, folder: &Path) -> io::Result<()> {
        let mut missing: Vec<&Path> = folder.ancestors().collect();
        missing.retain(|folder| !folder.as_os_str().is_empty() && !folder.exists());
        for folder in missing.into_iter().rev() {
            // `a/..` exists as soon as `a` does.
            if !folder.exists() {
                fs::create_dir(folder)?;
                self.folders.push(folder.to_owned());
            }
        }
        Ok(())
    }
}

impl Drop for Trial {
    fn drop(&mut self) {
        for file in &self.files {
            fs::remove_file(file).ok();
        }
        for folder in self.folders.iter().rev() {
            fs::remove_dir(folder).ok();
        }
    }
}

/// Writes a file atomically: under a temporary name in the same folder, then renamed. The target of a symbolic link
/// is replaced, not the link. The permissions of an existing file are kept.
///
/// # Errors
/// The file cannot be written, or is a folder, a device or a FIFO. An existing file is then unchanged.
pub fn write_whole(path: &Path, write: impl FnOnce(&mut File) -> io::Result<()>) -> io::Result<()> {
    metadata(path)?.map_or(Ok(()), |about| refuse(&about, true))?;
    let (replacement, mut file) = Replacement::begin(path)?;
    write(&mut file)?;
    replacement.keep()
}

/// Writes a file atomically, as [`write_whole`] does; a device or a FIFO in place.
///
/// # Errors
/// The file cannot be written, or is a folder. An existing file is then unchanged.
pub fn write_file(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let (replacement, mut file) = Replacement::begin(path)?;
    file.write_all(bytes)?;
    replacement.keep()
}

/// A file that is written under a temporary name, until it is kept. A device or a FIFO is written in place.
pub struct Replacement {
    path: PathBuf,
    temporary: Option<(TempPath, Option<Permissions>)>,
}

impl Replacement {
    /// Begins to replace a file, which may be missing. Returns the new one, to be written.
    ///
    /// # Errors
    /// It cannot be written, or is a folder.
    pub fn begin(path: &Path) -> io::Result<(Self, File)> {
        let about = metadata(path)?;
        about
            .as_ref()
            .map_or(Ok(()), |about| refuse(about, false))?;
        if about.as_ref().is_some_and(|about| !about.is_file()) {
            let replacement = Self {
                path: path.to_owned(),
                temporary: None,
            };
            return Ok((replacement, File::create(path)?));
        }
        let place = followed(path)?;
        let suffix = place
            .extension()
            .map(|ending| format!(".{}", ending.display()));
        let new = temporary_in(folder_of(&place), suffix.as_deref().unwrap_or_default())?;
        let (file, temporary) = new.into_parts();
        let replacement = Self {
            path: place,
            temporary: Some((temporary, about.map(|about| about.permissions()))),
        };
        Ok((replacement, file))
    }

    /// Where the file is written until then, for other programs.
    pub fn written_at(&self) -> &Path {
        self.temporary.as_ref().map_or(&self.path, |(at, _)| at)
    }

    /// Renames the file, which is complete.
    ///
    /// # Errors
    /// The system refuses.
    pub fn keep(self) -> io::Result<()> {
        let Some((temporary, permissions)) = self.temporary else {
            return Ok(());
        };
        if let Some(permissions) = permissions {
            // Not every file system supports permissions.
            fs::set_permissions(&temporary, permissions).ok();
        }
        Ok(temporary.persist(&self.path)?)
    }
}

/// Checks that a file can be created in `folder`.
///
/// # Errors
/// It cannot.
pub fn try_folder(folder: &Path) -> io::Result<()> {
    temporary_in(folder, "").map(|_| ())
}

/// A temporary file with a unique name, which ends in `suffix`, and the default permissions. Errors do not contain its
/// name.
fn temporary_in(folder: &Path, suffix: &str) -> io::Result<NamedTempFile> {
    let mut options = File::options();
    let new = options.read(true).write(true).create_new(true);
    let mut name = tempfile::Builder::new();
    name.suffix(suffix).make_in(folder, |path| new.open(path))
}

/// Resolves symbolic links; the file at the end may be missing.
///
/// # Errors
/// The links form a cycle, or cannot be read.
pub fn followed(path: &Path) -> io::Result<PathBuf> {
    let mut place = path.to_owned();
    for _ in 0..MOST_LINKS {
        match fs::symlink_metadata(&place) {
            Ok(about) if about.is_symlink() => {
                place = folder_of(&place).join(fs::read_link(&place)?);
            }
            _ => return Ok(place),
        }
    }
    Err(io::Error::other("its symbolic links form a cycle"))
}

/// The folder that a file is in.
pub fn folder_of(path: &Path) -> &Path {
    let folder = path.parent().filter(|one| !one.as_os_str().is_empty());
    folder.unwrap_or(Path::new("."))
}

/// The metadata of a file, if it exists.
fn metadata(path: &Path) -> io::Result<Option<Metadata>> {
    match fs::metadata(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(None),
        about => about.map(Some),
    }
}

/// Rejects folders and, for a file that is replaced `whole`, anything but regular files: a rename would replace a
/// device.
fn refuse(about: &Metadata, whole: bool) -> io::Result<()> {
    let reason = match about.is_dir() {
        true => "it is a folder",
        false if !whole || about.is_file() => return Ok(()),
        false => "it is a device or a FIFO, and would be replaced by a file",
    };
    Err(io::Error::other(reason))
}

/// An identity that is equal for two paths to the same file. `None` for missing files, folders and character devices
/// such as /dev/null, which several outputs may share.
#[cfg(unix)]
fn identity(path: &Path) -> Option<(u64, u64)> {
    use std::os::unix::fs::{FileTypeExt, MetadataExt};
    let about = fs::metadata(path).ok()?;
    let is_shared = about.is_dir() || about.file_type().is_char_device();
    (!is_shared).then(|| (about.dev(), about.ino()))
}

#[cfg(not(unix))]
fn identity(path: &Path) -> Option<PathBuf> {
    let place = fs::canonicalize(path).ok()?;
    (!place.is_dir()).then_some(place)
}
