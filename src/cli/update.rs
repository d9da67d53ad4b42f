//! `--update`: inserts tables into a document at marked places.

use std::fs;
use std::io::{self, Write};
use std::path::Path;

use super::Failure;
use crate::lab::reproduce::put_between;
use crate::runs::outputs::{Manner, Outputs, write_whole};
use crate::scenario::input;

/// Checks before a long computation that the file can be updated and that no result replaces it.
pub fn check(file: &Path, out: &Path) -> Result<(), Failure> {
    let place = fs::canonicalize(file).map_err(|error| failed(file, &error))?;
    let mut outputs = Outputs::new(true);
    outputs.writes("--update", file, Manner::Whole);
    outputs.check()?;
    let results = fs::canonicalize(out).ok();
    if results.is_some() && place.parent() == results.as_deref() {
        return Err(Failure::Input(format!(
            "--update {}: lies in the folder of --out {}, whose files are replaced; give another folder",
            file.display(),
            out.display()
        )));
    }
    Ok(())
}

/// Inserts texts at the places of a file that are marked with their names.
pub fn update<'a>(
    file: &Path,
    texts: impl Iterator<Item = (&'a str, &'a str)>,
) -> Result<(), Failure> {
    let put = || {
        let mut document = input::text(file)?;
        for (name, text) in texts {
            if let Some(changed) = put_between(&document, name, text) {
                document = changed;
            }
        }
        write_whole(file, |whole| whole.write_all(document.as_bytes()))
    };
    put().map_err(|error| failed(file, &error))
}

fn failed(file: &Path, error: &io::Error) -> Failure {
    Failure::Output(format!("cannot write {}: {error}", file.display()))
}
