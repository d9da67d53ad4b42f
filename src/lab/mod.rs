//! The lab: experiments of many runs. The paper's tables and figures ([`reproduce`]), studies over settings and seeds
//! ([`sweep`]), run time on this [`machine`] ([`mod@bench`]), hard cases and the largest stable time step ([`stress`]),
//! run time against
//! error ([`accuracy`]), and small cases with known answers ([`mod@verify`]). [`measure`] finds densities, fields, fundamental diagrams and flows of
//! any trajectory.

pub mod error;

pub mod jobs;

pub mod machine;

pub mod measure;

pub mod sweep;

pub mod reproduce;

pub mod bench;

pub mod stress;

pub mod accuracy;

pub mod verify;
