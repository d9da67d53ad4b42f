//! The file of a page: a thread compresses parts and writes them.

use std::fs::File;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread::JoinHandle;

use miniz_oxide::deflate::compress_to_vec;
use serde_json::Value;

use super::block::Block;
use figures::html;

/// The most parts that wait; the run waits when there are more.
const QUEUE: usize = 1;
/// The level of compression of people, from 0 to 10: higher levels make the concert at most 3 % smaller and take twice
/// as long.
const PEOPLE: u8 = 6;
/// That of time series.
const LEVEL: u8 = 9;
/// That of other files.
const FAST: u8 = 5;

/// A part of a page.
pub enum Part {
    /// The people of some frames, the forces on some of them if the page has any, and the time series.
    Frames(Box<[Block]>, Value),
    /// Bytes for a script, as an element of a class.
    Bytes(&'static str, Vec<u8>),
    /// HTML.
    Text(String),
}

/// A page could not be written.
#[derive(Debug, thiserror::Error)]
pub enum PageError {
    /// A folder has no viewer.
    #[error(
        "{}: no viewer for pages: {reason}; `pip install rerun-notebook==0.36.3` installs the package \
         `rerun_notebook`, whose folder is needed",
        folder.display()
    )]
    NoViewer {
        /// The folder.
        folder: PathBuf,
        /// What is wrong with it.
        reason: String,
    },
    /// A file for the page cannot be read.
    #[error("cannot read {}: {cause}", path.display())]
    Unread {
        /// The file.
        path: PathBuf,
        /// The reason.
        cause: String,
    },
    /// The file cannot be written.
    #[error("cannot write {}: {cause}; {}", path.display(), kept(path))]
    Unwritten {
        /// The file.
        path: PathBuf,
        /// The reason.
        cause: String,
    },
}

fn kept(path: &Path) -> &'static str {
    match path.metadata() {
        Ok(about) if about.len() > 0 => "it opens, but ends early",
        _ => "nothing is in it",
    }
}

/// A file that is being written.
pub struct PageFile {
    path: PathBuf,
    /// `None` once the thread has been asked to end.
    parts: Option<SyncSender<Part>>,
    thread: Option<JoinHandle<io::Result<()>>>,
}

impl PageFile {
    /// Creates the file, replacing an existing one.
    pub fn create(path: &Path) -> Result<Self, PageError> {
        let (parts, queue) = sync_channel(QUEUE);
        let begin = || {
            let file = File::create(path)?;
            let thread = std::thread::Builder::new().name("page".to_owned());
            thread.spawn(move || write_all(&queue, file))
        };
        let thread = begin().map_err(|error| unwritten(path, &error))?;
        Ok(Self {
            path: path.to_owned(),
            parts: Some(parts),
            thread: Some(thread),
        })
    }

    /// Adds a part. Errors of earlier parts are reported here or by [`finish`](Self::finish).
    pub fn write(&mut self, part: Part) -> Result<(), PageError> {
        let parts = self.parts.as_ref();
        match parts.is_some_and(|parts| parts.send(part).is_ok()) {
            true => Ok(()),
            false => self.finish(),
        }
    }

    /// Waits until all parts are written.
    pub fn finish(&mut self) -> Result<(), PageError> {
        self.parts = None;
        let gone = || Err(io::Error::other("the thread that writes has failed"));
        self.thread
            .take()
            .map(|thread| thread.join().unwrap_or_else(|_| gone()))
            .unwrap_or(Ok(()))
            .map_err(|error| unwritten(&self.path, &error))
    }
}

fn unwritten(path: &Path, error: &io::Error) -> PageError {
    PageError::Unwritten {
        path: path.to_owned(),
        cause: error.to_string(),
    }
}

fn write_all(queue: &Receiver<Part>, mut file: File) -> io::Result<()> {
    for part in queue {
        let text = match part {
            Part::Text(text) => text,
            Part::Bytes(class, bytes) => html::bytes(class, &compress_to_vec(&bytes, FAST)),
            Part::Frames(blocks, series) => {
                let named = ["crowd", "forces"].into_iter().zip(blocks);
                let blocks = named.map(|(name, block)| {
                    html::bytes(name, &compress_to_vec(&block.bytes(), PEOPLE))
                });
                // The series come last: a part that is cut off is not read.
                let series = compress_to_vec(series.to_string().as_bytes(), LEVEL);
                blocks.chain([html::bytes("series", &series)]).collect()
            }
        };
        file.write_all(text.as_bytes())?;
    }
    Ok(())
}
