//! rustsim-crowd's social forces. Only this module names rustsim_crowd.

#[cfg(feature = "compare")]
pub use present::settings;

#[cfg(feature = "compare")]
mod present {
    use std::time::Instant;

    use rustsim_crowd::social_force::{self, Params};
    use rustsim_crowd::{Pedestrian, Scratch, WallSegment, recommended_cell_size};
    use sandbox::engine::math::Vector;
    use sandbox::engine::simulation::Simulation;
    use sandbox::lab::bench::timing::pool;
    use sandbox::lab::error::LabError;

    use crate::compare::WIDE;
    use crate::compare::setting::{Description, Family, Setting, Turn, Walk, mean_distance};

    /// The time step that its own tests use, seconds.
    const TIME_STEP: f64 = 0.05;

    type Step = fn(&mut [Pedestrian], &[WallSegment], &Params, f64, &mut Scratch);

    /// A step function.
    #[derive(Clone, Copy)]
    struct Method {
        /// Addition to the engine's name.
        name: &'static str,
        step: Step,
        parallel: bool,
        /// Whether it is measured at all sizes. The fastest on one thread is.
        all_sizes: bool,
    }

    const METHODS: [Method; 3] = [
        Method {
            name: "",
            step: social_force::step_scratch,
            parallel: false,
            all_sizes: false,
        },
        Method {
            name: ", SIMD",
            step: social_force::step_scratch_simd,
            parallel: false,
            all_sizes: true,
        },
        Method {
            name: ", rayon",
            step: social_force::step_scratch_par,
            parallel: true,
            all_sizes: false,
        },
    ];

    /// Its settings, with its default radius and with the paper's.
    pub fn settings(threads: usize) -> Result<Vec<Setting>, String> {
        let own = Params::default();
        // Its radius is 8 B + 1 m.
        let wide = Params {
            b_ped: (WIDE - 1.0) / 8.0,
            ..own
        };
        let setting = |params: Params, method: Method| {
            let threads = if method.parallel { threads } else { 1 };
            Setting {
                description: Description {
                    engine: format!("rustsim-crowd 0.0.1{}", method.name),
                    family: Family::SocialForce,
                    model: "social force, circular",
                    radius: social_force::neighbor_cutoff(&params),
                    precision: "f64",
                    time_step: TIME_STEP,
                    threads,
                },
                stride: 1,
                all_sizes: method.all_sizes && params == wide,
                start: Box::new(move |crowd| walk(crowd, params, method.step, threads)),
            }
        };
        let settings = [wide, own].into_iter();
        let settings = settings.flat_map(|params| METHODS.map(|method| setting(params, method)));
        Ok(settings.collect())
    }

    fn walk(
        crowd: &Simulation,
        params: Params,
        step: Step,
        threads: usize,
    ) -> Result<Walk, LabError> {
        let (scene, agents) = (crowd.scene(), crowd.frame().agents);
        let person = |i: usize| {
            let (r, v, goal) = (agents.position[i], agents.velocity[i], agents.goal[i]);
            let speed = scene.preferred_speed;
            Pedestrian::new(r.into(), v.into(), agents.radius[i], speed, goal.into())
        };
        let cell = recommended_cell_size(social_force::neighbor_cutoff(&params));
        let mut people: Vec<Pedestrian> = (0..agents.len()).map(person).collect();
        let mut scratch = Scratch::with_capacity(agents.len(), cell);
        let first: Vec<Vector> = agents.position.to_vec();
        let params = Params {
            max_speed: scene.max_speed,
            ..params
        };
        let pool = pool(threads)?;
        Ok(Box::new(move |steps| {
            let begin = Instant::now();
            pool.install(|| {
                (0..steps).for_each(|_| step(&mut people, &[], &params, TIME_STEP, &mut scratch))
            });
            let seconds = begin.elapsed().as_secs_f64();
            let moved = mean_distance(&first, people.iter().map(|person| person.pos.into()));
            Ok(Turn { seconds, moved })
        }))
    }
}

/// Says how to include rustsim-crowd.
#[cfg(not(feature = "compare"))]
pub fn settings(_: usize) -> Result<Vec<super::setting::Setting>, String> {
    let how = "`cargo build --release -p experiments --features compare` brings it in";
    Err(format!("this program was built without it; {how}"))
}
