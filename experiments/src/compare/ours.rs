//! This engine, with the settings of the others.

use std::time::Instant;

use sandbox::engine::math::Vector;
use sandbox::engine::pairs::Precision;
use sandbox::engine::simulation::Simulation;
use sandbox::lab::bench::Crowd;
use sandbox::lab::bench::timing::{failed, ms_per_frame, pool};
use sandbox::lab::error::LabError;

use super::setting::{Description, Family, Setting, Turn, Walk, mean_distance};
use super::{WIDE, crowd};

/// Social forces and velocity obstacles within the paper's radius on one thread and on all, and with the radii and
/// threads of the others. Those that another setting is compared with at all sizes are measured at all sizes.
pub fn settings(others: &[Setting], all: usize) -> Result<Vec<Setting>, LabError> {
    let mut wanted = Vec::new();
    for family in [Family::SocialForce, Family::VelocityObstacles] {
        wanted.push((family, WIDE, 1, true));
        wanted.push((family, WIDE, all, false));
    }
    wanted.extend(others.iter().map(|other| {
        let Description {
            family,
            radius,
            threads,
            ..
        } = other.description;
        (family, radius, threads, other.all_sizes)
    }));
    wanted.sort_by(|a, b| {
        let order = a.0.cmp(&b.0).then(b.1.total_cmp(&a.1));
        order.then(a.2.cmp(&b.2)).then(b.3.cmp(&a.3))
    });
    wanted.dedup_by(|b, a| (a.0, a.1, a.2) == (b.0, b.1, b.2));
    let known = wanted
        .into_iter()
        .filter_map(|(family, radius, threads, all_sizes)| {
            let own = own_crowd(1, family.profile()?, radius);
            Some(setting(own, family, threads, all_sizes))
        });
    known.collect()
}

fn own_crowd(agents: u32, profile: &'static str, radius: f64) -> Crowd {
    let mut crowd = crowd(agents, profile);
    crowd.parameters.push(("avoidance_radius", radius));
    crowd
}

/// A setting with the parameters of `one`, a crowd of one agent.
fn setting(
    one: Crowd,
    family: Family,
    threads: usize,
    all_sizes: bool,
) -> Result<Setting, LabError> {
    let scene = one.scene()?;
    let mut parameters = one.parameters.iter();
    let radius = parameters.find(|(name, _)| *name == "avoidance_radius");
    let radius = radius.map_or(WIDE, |&(_, radius)| radius);
    let description = Description {
        engine: "sandbox".to_owned(),
        family,
        model: match family {
            Family::SocialForce => "social force, elliptical",
            _ => "RVO, 250 candidates",
        },
        radius,
        precision: match scene.precision {
            Precision::Double => "f64",
            Precision::Mixed => "mixed",
        },
        time_step: scene.clock.time_step(),
        threads,
    };
    Ok(Setting {
        description,
        stride: scene.clock.coarse_every().into(),
        all_sizes,
        start: Box::new(move |start| {
            let agents = start.frame().agents.len() as u32;
            let own = Crowd {
                agents,
                ..one.clone()
            };
            walk(Simulation::new(own.scene()?).map_err(failed)?, threads)
        }),
    })
}

fn walk(mut simulation: Simulation, threads: usize) -> Result<Walk, LabError> {
    let pool = pool(threads)?;
    let first = positions(&simulation);
    Ok(Box::new(move |steps| {
        let begin = Instant::now();
        pool.install(|| ms_per_frame(&mut simulation, steps))?;
        let seconds = begin.elapsed().as_secs_f64();
        let moved = mean_distance(&first, positions(&simulation).into_iter());
        Ok(Turn { seconds, moved })
    }))
}

/// Positions in the order of ids: the engine sorts its agents.
fn positions(simulation: &Simulation) -> Vec<Vector> {
    let agents = simulation.frame().agents;
    let mut places: Vec<_> = agents.id.iter().zip(&agents.position).collect();
    places.sort_by_key(|(id, _)| **id);
    places.into_iter().map(|(_, place)| *place).collect()
}
