//! Reads recordings back, as far as needed to check them.

use std::collections::BTreeSet;
use std::fs::File;
use std::path::Path;

use rerun::external::arrow::array::{ArrayRef, AsArray as _};
use rerun::external::arrow::compute::cast;
use rerun::external::arrow::datatypes::{DataType, Float64Type};
use rerun::{
    ChunkStore, ChunkStoreConfig, Component, ComponentIdentifier, EntityPath, StoreKind,
    TimelineName,
};

/// A recording in memory.
pub struct Recording {
    store: ChunkStore,
}

impl Recording {
    pub fn read(path: &Path) -> Self {
        let mut file = File::open(path).unwrap();
        let stores = ChunkStore::from_rrd_reader(&ChunkStoreConfig::DEFAULT, &mut file).unwrap();
        let mut stores = stores.into_iter();
        let store = stores.find(|(id, _)| id.kind() == StoreKind::Recording);
        let (_, store) = store.unwrap();
        Self { store }
    }

    /// Its id: a viewer merges recordings with the same one.
    pub fn id(&self) -> String {
        self.store.id().recording_id().to_string()
    }

    /// The first value of a static component.
    pub fn of_static<C: Component>(&self, entity: &str, component: &str) -> C {
        let component = ComponentIdentifier::try_new(component).unwrap();
        let entity = EntityPath::from(entity);
        let chunks = self.store.iter_physical_chunks();
        let mut own = chunks.filter(|chunk| chunk.is_static() && *chunk.entity_path() == entity);
        let found = own.find_map(|chunk| chunk.component_mono::<C>(component, 0));
        found.unwrap().unwrap()
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

    /// The names of the views and containers of its layout.
    pub fn layout(path: &Path) -> BTreeSet<String> {
        let mut file = File::open(path).unwrap();
        let stores = ChunkStore::from_rrd_reader(&ChunkStoreConfig::DEFAULT, &mut file).unwrap();
        let layouts = stores.into_iter();
        let layouts = layouts.filter(|(id, _)| id.kind() == StoreKind::Blueprint);
        let names = [
            "ViewBlueprint:display_name",
            "ContainerBlueprint:display_name",
        ];
        let mut found = BTreeSet::new();
        for (_, store) in layouts {
            for chunk in store.iter_physical_chunks() {
                for name in names {
                    let name = ComponentIdentifier::try_new(name).unwrap();
                    let rows = 0..chunk.num_rows();
                    let values = rows.filter_map(|row| chunk.component_batch_raw(name, row)?.ok());
                    found.extend(values.flat_map(|values| strings(&values)));
                }
            }
        }
        found
    }

    /// The texts in a component of an entity, by frame.
    pub fn texts(&self, entity: &str, component: &str) -> Vec<(i64, Vec<String>)> {
        let rows = self.rows(entity, component).into_iter();
        rows.map(|(frame, row)| (frame, strings(&row))).collect()
    }

    /// The texts in a static component.
    pub fn static_texts(&self, entity: &str, component: &str) -> Vec<String> {
        let row = self.static_row(entity, component);
        row.map(|texts| strings(&texts)).unwrap_or_default()
    }

    /// The pairs in a static component.
    pub fn static_pairs(&self, entity: &str, component: &str) -> Vec<[f64; 2]> {
        let row = self.static_row(entity, component);
        let values = row.and_then(|row| numbers(row.as_fixed_size_list_opt()?.values()));
        pairs(&values.unwrap_or_default())
    }

    /// What was logged last in a static component.
    fn static_row(&self, entity: &str, component: &str) -> Option<ArrayRef> {
        let component = ComponentIdentifier::try_new(component).unwrap();
        let entity = EntityPath::from(entity);
        let chunks = self.store.iter_physical_chunks();
        let own = chunks.filter(|chunk| chunk.is_static() && *chunk.entity_path() == entity);
        let rows = own.filter_map(|chunk| {
            let row = chunk.num_rows().checked_sub(1)?;
            let values = chunk.component_batch_raw(component, row)?.ok()?;
            Some((chunk.row_ids().last(), values))
        });
        rows.max_by_key(|(id, _)| *id).map(|(_, values)| values)
    }

    /// The coordinates in a component of an entity, by frame.
    pub fn coordinates(&self, entity: &str, component: &str) -> Vec<(i64, Vec<f64>)> {
        let rows = self.rows(entity, component).into_iter();
        rows.filter_map(|(frame, row)| {
            Some((frame, numbers(row.as_fixed_size_list_opt()?.values())?))
        })
        .collect()
    }

    /// The pairs in a component of an entity, by frame: positions or vectors.
    pub fn pairs(&self, entity: &str, component: &str) -> Vec<(i64, Vec<[f64; 2]>)> {
        let rows = self.coordinates(entity, component).into_iter();
        rows.map(|(frame, values)| (frame, pairs(&values)))
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
            let frames = chunk
                .timelines()
                .get(&TimelineName::from_static_str("frame"));
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

fn pairs(values: &[f64]) -> Vec<[f64; 2]> {
    values.chunks_exact(2).map(|xy| [xy[0], xy[1]]).collect()
}

fn strings(array: &ArrayRef) -> Vec<String> {
    let texts = array.as_string_opt::<i32>().into_iter().flatten();
    texts.flatten().map(str::to_owned).collect()
}

fn numbers(array: &ArrayRef) -> Option<Vec<f64>> {
    let numbers = cast(array, &DataType::Float64).ok()?;
    let numbers = numbers.as_primitive_opt::<Float64Type>()?;
    Some(numbers.values().to_vec())
}
