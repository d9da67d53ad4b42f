//! Tests of the command-line program, its outputs and its studies.

mod common;

mod accuracy;
mod accuracy_walls;
mod backlogs;
mod bad_days;
mod bench;
mod calibrate;
mod checkpoint;
mod checkpoint_robustness;
mod cli;
mod cli_geometry;
mod command_lines;
mod draw;
