//! rustsim-crowd's social forces. Only this module names rustsim_crowd.

#[cfg(feature = "compare")]
pub use present::entries;

#[cfg(feature = "compare")]
mod present {
    use std::time::Instant;

    use rayon::ThreadPool;
    use rustsim_crowd::social_force::{self, Params};
    use rustsim_crowd::{Pedestrian, Scratch, WallSegment, recommended_cell_size};

    use crate::engine::simulation::Simulation;
    use crate::lab::bench::compare::{Description, Entry, WIDE};
    use crate::lab::bench::timing::{Contender, pool};

    /// The time step of this engine, seconds.
    const TIME_STEP: f64 = 0.02;

    type Step = fn(&mut [Pedestrian], &[WallSegment], &Params, f64, &mut Scratch);

    /// Its step functions: addition to its name, function, and whether it uses all threads.
    const STEPS: [(&str, Step, bool); 3] = [
        ("", social_force::step_scratch, false),
        (", SIMD", social_force::step_scratch_simd, false),
        (", rayon", social_force::step_scratch_par, true),
    ];

    /// Its entries, with its default radius and with the paper's.
    pub fn entries(crowd: &Simulation, threads: usize) -> Result<Vec<Entry>, String> {
        let own = Params::default();
        // Its radius is 8 B + 1 m.
        let wide = Params {
            b_ped: (WIDE - 1.0) / 8.0,
            ..own
        };
        let mut entries = Vec::new();
        for params in [own, wide] {
            for (name, step, parallel) in STEPS {
                let threads = if parallel { threads } else { 1 };
                let pool = pool(threads).map_err(|error| error.to_string())?;
                let description = Description {
                    engine: format!("rustsim-crowd 0.0.1{name}"),
                    model: "social force, circular, no contact",
                    radius: social_force::neighbor_cutoff(&params),
                    precision: "f64",
                    time_step: TIME_STEP,
                    threads,
                };
                entries.push((description, walking(crowd, params, step, pool)));
            }
        }
        Ok(entries)
    }

    /// The crowd of `start`, which takes steps on request.
    fn walking(
        crowd: &Simulation,
        params: Params,
        step: Step,
        pool: ThreadPool,
    ) -> Contender<'static> {
        let (scene, agents) = (crowd.scene(), crowd.frame().agents);
        let person = |i: usize| {
            let (r, v, goal) = (agents.position[i], agents.velocity[i], agents.goal[i]);
            let speed = scene.preferred_speed;
            Pedestrian::new(r.into(), v.into(), agents.radius[i], speed, goal.into())
        };
        let cell = recommended_cell_size(social_force::neighbor_cutoff(&params));
        let mut people: Vec<Pedestrian> = (0..agents.len()).map(person).collect();
        let mut scratch = Scratch::with_capacity(agents.len(), cell);
        let params = Params {
            max_speed: scene.max_speed,
            ..params
        };
        Box::new(move |steps| {
            let begin = Instant::now();
            pool.install(|| {
                (0..steps).for_each(|_| step(&mut people, &[], &params, TIME_STEP, &mut scratch))
            });
            Ok(1e3 * begin.elapsed().as_secs_f64() / steps as f64)
        })
    }
}

#[cfg(not(feature = "compare"))]
use crate::engine::simulation::Simulation;

/// Says how to include rustsim-crowd.
#[cfg(not(feature = "compare"))]
pub fn entries(_: &Simulation, _: usize) -> Result<Vec<super::Entry>, String> {
    let how = "`cargo build --release --features compare` brings it in";
    Err(format!("this program was built without it; {how}"))
}
