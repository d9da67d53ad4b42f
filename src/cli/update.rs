//! Texts put into a document that has places for them.

use std::fs;
use std::io;
use std::path::Path;

use super::Failure;
use crate::reproduce::{put_between, write_whole};

/// Is the file there? Better told before hours of computing than after.
pub fn check(file: &Path) -> Result<(), Failure> {
    fs::metadata(file)
        .map(|_| ())
        .map_err(|error| failed(file, &error))
}

/// Puts texts into the places that a file has for them.
pub fn update<'a>(
    file: &Path,
    texts: impl Iterator<Item = (&'a str, &'a str)>,
) -> Result<(), Failure> {
    let put = || {
        let target = fs::canonicalize(file)?; // not in the place of a link
        let mut document = fs::read_to_string(&target)?;
        for (name, text) in texts {
            if let Some(changed) = put_between(&document, name, text) {
                document = changed;
            }
        }
        write_whole(&target, document.as_bytes())
    };
    put().map_err(|error| failed(file, &error))
}

fn failed(file: &Path, error: &io::Error) -> Failure {
    Failure::Output(format!("cannot write {}: {error}", file.display()))
}
