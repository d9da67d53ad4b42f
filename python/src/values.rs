//! Arrays as bytes, which NumPy reads without another copy.

use pyo3::prelude::*;
use pyo3::types::{PyByteArray, PyDict};
use sandbox::engine::math::Vector;
use sandbox::output::trajectory::{Column, Columns};

use crate::error;

/// A new array of `count` values of `SIZE` bytes, which `value` gives.
pub fn array<const SIZE: usize>(
    py: Python<'_>,
    count: usize,
    value: impl Fn(usize) -> [u8; SIZE],
) -> PyResult<Bound<'_, PyByteArray>> {
    PyByteArray::new_with(py, count * SIZE, |bytes| {
        let (places, _) = bytes.as_chunks_mut::<SIZE>();
        for (k, place) in places.iter_mut().enumerate() {
            *place = value(k);
        }
        Ok(())
    })
}

/// The two components of a vector, as bytes.
pub fn vector(of: Vector) -> [u8; 16] {
    let mut bytes = [0; 16];
    let (x, y) = bytes.split_at_mut(8);
    x.copy_from_slice(&of.x.to_ne_bytes());
    y.copy_from_slice(&of.y.to_ne_bytes());
    bytes
}

/// A column: the name of its NumPy type, its values, and the names that they stand for, if they do.
pub type Values<'py> = (&'static str, Bound<'py, PyByteArray>, Option<Vec<String>>);

/// The values of a column.
pub fn column(py: Python<'_>, column: Column) -> PyResult<Values<'_>> {
    Ok(match column {
        Column::Counts(values) => {
            let bytes = array(py, values.len(), |k| values[k].to_ne_bytes())?;
            ("uint64", bytes, None)
        }
        Column::Numbers(values) => {
            let bytes = array(py, values.len(), |k| values[k].to_ne_bytes())?;
            ("float64", bytes, None)
        }
        Column::Names { codes, names } => {
            let bytes = array(py, codes.len(), |k| codes[k].to_ne_bytes())?;
            ("int32", bytes, Some(names))
        }
    })
}

/// Columns by name.
pub fn dictionary(py: Python<'_>, columns: Columns) -> PyResult<Bound<'_, PyDict>> {
    let all = PyDict::new(py);
    for (name, values) in columns.into_values() {
        all.set_item(name, column(py, values)?)?;
    }
    Ok(all)
}

/// The names of the columns, all if none are given.
pub fn columns(wanted: Option<Vec<String>>) -> PyResult<Vec<&'static str>> {
    let all = Columns::all().map(|(name, _)| name);
    let Some(wanted) = wanted else {
        return Ok(all.collect());
    };
    let all: Vec<&str> = all.collect();
    if let Some(unknown) = wanted.iter().find(|name| !all.contains(&name.as_str())) {
        let known = all.join(", ");
        return Err(error(format!(
            "columns: no column `{unknown}`; there are {known}"
        )));
    }
    let is_wanted = |name: &&str| wanted.iter().any(|wanted| wanted == name);
    Ok(all.into_iter().filter(is_wanted).collect())
}
