//! Rows of files with columns.

/// A row: what names it, and its values. It is the line of a text, and the id and the frame in a database.
pub(super) type Row<K> = (K, Vec<f64>);
/// The id and the frame of a row in a database.
pub(super) type Key = (i64, i64);
