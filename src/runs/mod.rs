//! Runs: a scenario from its first frame to its last. The drive loop shows every evaluated frame to its
//! observers, a checkpoint holds a run that can be resumed to the same bits, and a summary holds what a run
//! found.

pub mod drive;

pub mod outputs;

pub mod checkpoint;

pub mod summary;
