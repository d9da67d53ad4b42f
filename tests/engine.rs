//! Tests of the model, the numerics and the parsing of scenarios, in one program: linking one per file would take
//! longer than running them.

#![recursion_limit = "256"] // a scenario with every key, in `json!`

mod common;

mod architecture;
mod blending;
mod bodies;
mod calibrated;
mod cma_es;
mod conservation;
mod containment;
mod convergence;
mod crowds;
mod determinism;
mod distributions;
mod enclosures;
mod entrances;
mod errands;
mod exposure;
mod floor_plan;
mod floor_plan_areas;
mod floor_plan_pieces;
mod floor_plan_robustness;
mod floor_plan_unions;
mod forces;
mod geometry;
mod geometry_robustness;
mod identifiability;
mod journeys;
mod kernel;
mod loads;
mod lone_agents;
mod math;
mod measurements;
mod needs;
mod neighbor_lists;
mod neighbors;
mod periodic;
mod periodic_scenarios;
mod precision;
mod queues;
mod reference_states;
mod runs;
mod rvo;
mod rvo_contact;
mod scenario_errors;
mod scenario_robustness;
mod scenario_schema;
mod scenario_settings;
mod scenario_shipped;
mod schedule;
mod simulation;
mod skips;
mod social;
mod sound;
mod statistics;
mod walking;
mod walking_profiles;
mod walls;
mod wave;
mod way_extremes;
mod way_field;
mod way_finding;
mod way_oracles;
mod ways;
