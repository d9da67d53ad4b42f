//! Tests of the command-line program, its outputs and its studies.

mod common;

mod accuracy;
mod accuracy_walls;
mod bad_days;
mod bench;
mod checkpoint;
mod checkpoint_robustness;
mod cli;
mod cli_geometry;
mod command_lines;
mod interrupts;
mod killed;
mod live;
mod manual;
mod measure_cli;
mod measure_density;
mod measure_flow;
mod messages;
mod outputs;
mod plot;
mod read;
mod recording;
mod reproduction;
mod scenario_geometry;
mod stability;
mod stress;
mod study_robustness;
mod sweep;
mod sweep_program;
mod sweep_study;
mod tables;
mod trajectory;
mod trajectory_area;
mod trajectory_formats;
mod trajectory_robustness;
