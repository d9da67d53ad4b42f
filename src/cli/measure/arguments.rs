//! The options of `sandbox measure`.

use std::path::PathBuf;

use clap::Args;
use clap::builder::PossibleValuesParser;

use crate::analysis::crossing::{Line, Passages};
use crate::engine::scene::Region;

use super::super::arguments::{PrintOptions, ProgramOptions};
use super::super::values::{
    cut_off, frame_rate, length, line, moment, passages, positive_seconds, region, segments,
};

/// The radius of Voronoi cells, meters.
#[derive(Debug, Clone, Copy)]
pub struct CutOff(pub Option<f64>);
