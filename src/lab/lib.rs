//! The lab: experiments of many runs. The paper's tables and figures ([`reproduce`]), studies over settings and seeds
//! ([`sweep`]), results with the errors asked for ([`mod@estimate`]), run time on this [`machine`]
//! ([`mod@bench`]), hard cases and the largest stable time step ([`stress`]), run time against error ([`accuracy`]),
//! cases with known answers and scenes of experiments ([`suite`]), and the search for parameters that reproduce them
//! ([`calibrate`]). [`measure`] computes densities, fields, fundamental diagrams and flows of any trajectory;
//! [`differences`] compares two results, [`egress`] shows how people leave, and [`report`] makes the document that is
//! handed in. Their pictures share [`gallery`] and
//! [`mod@curves`].

#![warn(missing_docs, clippy::unwrap_used)]

pub mod error;

pub mod gallery;

pub mod jobs;

pub mod machine;

pub mod measure;

pub mod differences;

pub mod egress;

pub mod curves;

pub mod sweep;

pub mod suite;

pub mod model;

pub mod estimate;

pub mod reproduce;

pub mod bench;

pub mod stress;

pub mod accuracy;

pub mod calibrate;

pub mod report;
