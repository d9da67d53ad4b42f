//! The files that the program writes: one way to write each, and the trial of all of them before anything is
//! computed.
//!
//! A file is written in place (recordings, trajectories, tables, pictures), or whole: under a temporary name
//! beside it, and renamed (checkpoints, finished cases). Either way symbolic links are followed, devices and
//! FIFOs are never replaced, and the umask decides who may read a new file.

use std::fs::{self, File, Metadata};
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

/// Longer chains of symbolic links are circles.
const MOST_LINKS: usize = 40;

/// How an output is written, which decides how it is tried.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Manner {
    /// The file is opened and truncated.
    InPlace,
    /// The file is replaced by a whole one, see [`write_whole`].
    Whole,
    /// The file is one of several in a folder, or beside another: only an existing one is tried.
    Beside,
    /// The folder is made if there is none.
    Folder,
}

/// Why a file is not written.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum OutputsError {
    /// The file is there, and must not be replaced.
    #[error("{0}: exists already; give --force to replace it")]
    Exists(String),
    /// Two options have the same file.
    #[error("{0} and {1} are one file; give each a file of its own")]
    Shared(String, String),
    /// An option has the file of an input.
    #[error(
        "{output} and {input} are one file; an input is never replaced, not even with --force: write to another file"
    )]
    Input {
        /// The option with its file.
        output: String,
        /// The input with its file.
        input: String,
    },
    /// The file cannot be written.
    #[error("{output}: cannot be written: {reason}")]
    Unwritable {
        /// The option with its file.
        output: String,
        /// What the system says.
        reason: String,
    },
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
    /// The option that may go on with this file.
    goes_on: Option<&'static str>,
}

#[derive(Debug, Clone)]
struct Output {
    option: &'static str,
    path: PathBuf,
    manner: Manner,
}

impl Output {
    /// As messages call it.
    fn name(&self) -> String {
        format!("{} {}", self.option, self.path.display())
    }
}

impl Outputs {
    /// Of a command that replaces existing files only with `force`.
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
            goes_on: None,
        });
    }

    /// Adds an input that is read whole before anything is written; `option` may replace it, also without
    /// force.
    pub fn goes_on_with(&mut self, name: &str, path: &Path, option: &'static str) {
        self.reads(name, path);
        if let Some(input) = self.inputs.last_mut() {
            input.goes_on = Some(option);
        }
    }

    /// Adds an output, which `option` names.
    pub fn writes(&mut self, option: &'static str, path: &Path, manner: Manner) {
        self.outputs.push(Output {
            option,
            path: path.to_owned(),
            manner,
        });
    }

    /// Tries all outputs and leaves everything as it was: existing files are opened, not truncated; missing
    /// files and folders are made and removed.
    ///
    /// # Errors
    /// An output cannot be written, is the file of another output or of an input (also through symbolic and
    /// hard links and other spellings), or exists and `force` is not given.
    pub fn check(&self) -> Result<(), OutputsError> {
        let mut trial = Trial::default();
        let mut existed = Vec::with_capacity(self.outputs.len());
        for output in &self.outputs {
            let tried = trial.attempt(output);
            existed.push(tried.map_err(|error| OutputsError::Unwritable {
                output: output.name(),
                reason: error.to_string(),
            })?);
        }
        // By now every file is there that will be, so that each has an identity.
        let files: Vec<_> = self.outputs.iter().map(|o| identity(&o.path)).collect();
        let inputs: Vec<_> = self.inputs.iter().map(|i| identity(&i.path)).collect();
        for (k, (output, file)) in self.outputs.iter().zip(&files).enumerate() {
            let same = |other: &Option<_>| file.is_some() && other == file;
            if let Some(first) = files[..k].iter().position(same) {
                let first = self.outputs[first].name();
                return Err(OutputsError::Shared(first, output.name()));
            }
            let mut goes_on = false;
            for (input, _) in self.inputs.iter().zip(&inputs).filter(|(_, f)| same(f)) {
                goes_on = input.goes_on == Some(output.option);
                if !goes_on {
                    return Err(OutputsError::Input {
                        output: output.name(),
                        input: input.name.clone(),
                    });
                }
            }
            let is_folder = output.manner == Manner::Folder;
            if existed[k] && !is_folder && !goes_on && !self.force {
                return Err(OutputsError::Exists(output.name()));
            }
        }
        Ok(())
    }
}

/// What a trial has made, to be removed again.
#[derive(Default)]
struct Trial {
    files: Vec<PathBuf>,
    folders: Vec<PathBuf>,
}

impl Trial {
    /// Tries one output. Was it there before?
    fn attempt(&mut self, output: &Output) -> io::Result<bool> {
        let path = &output.path;
        let there = match fs::metadata(path) {
            Err(error) if error.kind() == ErrorKind::NotFound => None,
            about => Some(about?),
        };
        match (output.manner, there) {
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
                refuse_folder(&about)?;
                if manner == Manner::Whole {
                    refuse_device(&about)?;
                    try_folder(folder_of(&fs::canonicalize(path)?))?;
                }
                // To open a FIFO is to wait for its reader.
                if about.is_file() {
                    File::options().append(true).open(path)?;
                }
            }
        }
        Ok(true)
    }

    /// Makes a folder and those that it is in.
    fn make_folder(&mut self, folder: &Path) -> io::Result<()> {
        let mut missing: Vec<&Path> = folder.ancestors().collect();
        missing.retain(|folder| !folder.as_os_str().is_empty() && !folder.exists());
        for folder in missing.into_iter().rev() {
            // `a/..` is there as soon as `a` is.
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

/// Writes a file whole or not at all: under a temporary name beside it, and renamed. A symbolic link stays, and
/// what it leads to is replaced; an existing file's permissions are kept.
///
/// # Errors
/// It cannot be written, or is a folder, a device or a FIFO. A file of before is as it was.
pub fn write_whole(path: &Path, write: impl FnOnce(&mut File) -> io::Result<()>) -> io::Result<()> {
    let permissions = match fs::metadata(path) {
        Err(error) if error.kind() == ErrorKind::NotFound => None,
        about => {
            let about = about?;
            refuse_folder(&about)?;
            refuse_device(&about)?;
            Some(about.permissions())
        }
    };
    let place = followed(path)?;
    let mut temporary = temporary_in(folder_of(&place))?;
    write(temporary.as_file_mut())?;
    if let Some(permissions) = permissions {
        // Not every file system has them.
        temporary.as_file().set_permissions(permissions).ok();
    }
    temporary.persist(&place)?;
    Ok(())
}

/// Makes a file in `folder` and removes it.
///
/// # Errors
/// It cannot be made.
pub fn try_folder(folder: &Path) -> io::Result<()> {
    temporary_in(folder).map(|_| ())
}

/// A file with a name of its own and the permissions of any new file; errors do not name it.
fn temporary_in(folder: &Path) -> io::Result<tempfile::NamedTempFile> {
    let mut new = File::options();
    let new = new.read(true).write(true).create_new(true);
    tempfile::Builder::new().make_in(folder, |path| new.open(path))
}

/// Where `path` leads, through symbolic links to a file that may be missing.
///
/// # Errors
/// Links go in a circle, or cannot be read.
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
    Err(io::Error::other("its symbolic links go in a circle"))
}

/// The folder that a file is in.
pub fn folder_of(path: &Path) -> &Path {
    let folder = path
        .parent()
        .filter(|folder| !folder.as_os_str().is_empty());
    folder.unwrap_or(Path::new("."))
}

fn refuse_folder(about: &Metadata) -> io::Result<()> {
    match about.is_dir() {
        true => Err(io::Error::other("it is a folder")),
        false => Ok(()),
    }
}

/// A device that is replaced by a file is lost.
fn refuse_device(about: &Metadata) -> io::Result<()> {
    match about.is_file() {
        true => Ok(()),
        false => Err(io::Error::other(
            "it is a device or a FIFO, and would be replaced by a file",
        )),
    }
}

/// What two paths have in common that lead to the same file; none of a missing file, nor of a device that
/// many may write to, like /dev/null.
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
