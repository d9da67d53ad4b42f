//! Reads recordings back, as far as needed to check them.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{Read, Seek, SeekFrom};
use std::path::Path;

use rerun::external::arrow::array::{ArrayRef, AsArray as _};
use rerun::external::arrow::compute::cast;
use rerun::external::arrow::datatypes::{DataType, Float64Type};
use rerun::external::re_log_encoding::{Decodable as _, StreamFooter};
use rerun::{
    ChunkStore, ChunkStoreConfig, ComponentIdentifier, EntityPath, StoreKind, TimelineName,
};

use super::FRAME;
use super::error::RecordingError;

/// A recording in memory.
pub struct Recording {
    store: ChunkStore,
}

impl Recording {
    /// Reads the file at `path`.
    ///
    /// # Errors
    /// The file cannot be read, or is not a recording.
    pub fn read(path: &Path) -> Result<Self, RecordingError> {
        let unreadable = |reason: String| RecordingError::Unreadable {
            path: path.to_owned(),
            reason,
        };
        let mut file = File::open(path).map_err(|error| unreadable(error.to_string()))?;
        let stores = ChunkStore::from_rrd_reader(&ChunkStoreConfig::DEFAULT, &mut file)
            .map_err(|error| unreadable(error.to_string()))?;
        let mut stores = stores.into_iter();
        let store = stores.find(|(id, _)| id.kind() == StoreKind::Recording);
        let (_, store) = store.ok_or_else(|| unreadable("it holds no recording".to_owned()))?;
        Ok(Self { store })
    }

    /// The names of its timelines.
    pub fn timelines(&self) -> BTreeSet<String> {
        let chunks = self.store.iter_physical_chunks();
        let timelines = chunks.flat_map(|chunk| chunk.timelines().keys());
        timelines.map(|name| name.to_string()).collect()
    }

    /// The names of its entities.
    pub fn entities(&self) -> BTreeSet<String> {
        let chunks = self.store.iter_physical_chunks();
        chunks
            .map(|chunk| chunk.entity_path().to_string())
            .collect()
    }

    /// The pairs in a component of an entity, by frame: positions or vectors.
    pub fn pairs(&self, entity: &str, component: &str) -> Vec<(i64, Vec<[f64; 2]>)> {
        let pair = |values: &[f64]| -> Vec<[f64; 2]> {
            values.chunks_exact(2).map(|xy| [xy[0], xy[1]]).collect()
        };
        let rows = self.rows(entity, component).into_iter();
        rows.filter_map(|(frame, row)| {
            let coordinates = row.as_fixed_size_list_opt()?.values();
            Some((frame, pair(&numbers(coordinates)?)))
        })
        .collect()
    }

    /// The numbers in a component of an entity, by frame.
    pub fn numbers(&self, entity: &str, component: &str) -> Vec<(i64, Vec<f64>)> {
        let rows = self.rows(entity, component).into_iter();
        rows.filter_map(|(frame, row)| Some((frame, numbers(&row)?)))
            .collect()
    }

    /// The temporal rows of a component, by frame.
    fn rows(&self, entity: &str, component: &str) -> Vec<(i64, ArrayRef)> {
        let Ok(component) = ComponentIdentifier::try_new(component) else {
            return Vec::new();
        };
        let entity = EntityPath::from(entity);
        let mut rows = Vec::new();
        for chunk in self.store.iter_physical_chunks() {
            let frames = chunk.timelines().get(&TimelineName::from_static_str(FRAME));
            let Some(frames) = frames.filter(|_| *chunk.entity_path() == entity) else {
                continue;
            };
            for (row, &frame) in frames.times_raw().iter().enumerate() {
                if let Some(Ok(values)) = chunk.component_batch_raw(component, row) {
                    rows.push((frame, values));
                }
            }
        }
        rows.sort_by_key(|&(frame, _)| frame);
        rows
    }
}

fn numbers(array: &ArrayRef) -> Option<Vec<f64>> {
    let numbers = cast(array, &DataType::Float64).ok()?;
    let numbers = numbers.as_primitive_opt::<Float64Type>()?;
    Some(numbers.values().to_vec())
}

/// Checks that the file ends like a recording that was closed. Reads only its last bytes.
pub fn check_footer(path: &Path) -> Result<(), RecordingError> {
    let incomplete = |reason: String| RecordingError::Incomplete {
        path: path.to_owned(),
        reason,
    };
    let last_bytes = || -> std::io::Result<(Vec<u8>, u64)> {
        let mut file = File::open(path)?;
        let size = StreamFooter::ENCODED_SIZE_BYTES as u64;
        let start = file.seek(SeekFrom::End(-i64::try_from(size).unwrap_or(0)))?;
        let mut bytes = Vec::new();
        file.read_to_end(&mut bytes)?;
        Ok((bytes, start))
    };
    let (bytes, start) = last_bytes().map_err(|error| incomplete(error.to_string()))?;
    let footer =
        StreamFooter::from_rrd_bytes(&bytes).map_err(|error| incomplete(error.to_string()))?;
    let index_fits = footer.entries.iter().all(|entry| {
        let span = &entry.rrd_footer_byte_span_from_start_excluding_header;
        span.start + span.len <= start
    });
    if footer.entries.is_empty() || !index_fits {
        return Err(incomplete("its index is missing".to_owned()));
    }
    Ok(())
}
