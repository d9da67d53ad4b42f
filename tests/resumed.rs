//! A resumed run is the same run, wherever it is cut: in every coarse frame, in the other frames, and twice in a row.
//! The whole state is compared, byte by byte, so that a difference shows before it moves anybody.
//!
//! Some 500 cuts; more with `BAD_INPUT_TIMES=20 cargo test --release --test engine -- resumed`.

use std::collections::BTreeMap;
use std::ops::Range;

use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use rayon::ThreadPool;
use sandbox::engine::neighbors::ListPolicy;
use sandbox::engine::pairs::Precision;
use sandbox::engine::scene::{Integrator, Scene};
use sandbox::engine::simulation::Simulation;
use sandbox::scenario::Scenario;
use serde_json::Value;

use crate::common::busy::{hall, one, ring};

/// Random scenes.
const SCENES: u64 = 16;
/// The frames of each scene that are cut.
const WINDOW: u64 = 120;
/// Cuts between coarse frames, per scene.
const OTHERS: usize = 8;

fn scene(document: &Value) -> Scene {
    let scenario = Scenario::parse(&document.to_string(), "f.json", &[]);
    scenario.unwrap_or_else(|error| panic!("{error}")).scene
}

/// A random scene, with any integrator, precision and policy for the lists of neighbors.
fn random(rng: &mut ChaCha8Rng) -> Scene {
    let document = if rng.random_ratio(1, 8) {
        ring(rng)
    } else {
        let most = one(rng, &[60, 120, 250]);
        hall(rng, most)
    };
    Scene {
        integrator: one(rng, &Integrator::ALL),
        precision: one(rng, &[Precision::Mixed, Precision::Double]),
        neighbor_lists: one(rng, &[ListPolicy::Complete, ListPolicy::Coarse]),
        ..scene(&document)
    }
}

/// One, two and three threads.
fn pools() -> Vec<ThreadPool> {
    let pool = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build();
    (1..=3).map(|threads| pool(threads).unwrap()).collect()
}

fn bytes(simulation: &Simulation) -> Vec<u8> {
    postcard::to_stdvec(&simulation.state()).unwrap()
}

/// A run that is not interrupted.
struct Whole {
    name: String,
    scene: Scene,
    /// Whether all densities are requested, as recordings and trajectories do.
    is_observed: bool,
    /// The states of the evaluated frames, and their digests.
    frames: BTreeMap<u64, (Vec<u8>, String)>,
}

impl Whole {
    fn start(&self) -> Simulation {
        self.watched(Simulation::new(self.scene.clone()).unwrap())
    }

    fn watched(&self, mut simulation: Simulation) -> Simulation {
        if self.is_observed {
            simulation.request_density_until(u64::MAX);
        }
        simulation
    }

    /// Runs to the end of some frames and keeps their states.
    fn keep(&mut self, simulation: &mut Simulation, frames: Range<u64>) {
        while simulation.frame().clock.frame() < frames.end {
            simulation.evaluate().unwrap();
            let frame = simulation.frame().clock.frame();
            if frames.contains(&frame) {
                let state = (bytes(simulation), simulation.digest());
                self.frames.insert(frame, state);
            }
            simulation.integrate().unwrap();
        }
    }

    fn resumed(&self, state: &[u8]) -> Simulation {
        let state = postcard::from_bytes(state).unwrap();
        self.watched(Simulation::resumed(self.scene.clone(), state).unwrap())
    }

    /// Evaluates the current frame and compares it with that of this run.
    fn compare(&self, simulation: &mut Simulation, how: &str) {
        let frame = simulation.frame().clock.frame();
        simulation.evaluate().unwrap();
        let (state, digest) = &self.frames[&frame];
        assert_eq!(&simulation.digest(), digest, "{how}, frame {frame}");
        assert!(
            &bytes(simulation) == state,
            "{how}, frame {frame}: the state differs"
        );
    }

    /// Goes on for some frames and compares each with that of this run.
    fn go_on(&self, simulation: &mut Simulation, frames: u64, how: &str) {
        self.compare(simulation, how);
        for _ in 0..frames {
            simulation.integrate().unwrap();
            self.compare(simulation, how);
        }
    }

    /// Resumes at a frame, runs for some frames, and resumes again.
    fn check(&self, pools: &[ThreadPool], frame: u64, rng: &mut ChaCha8Rng) {
        let [first, second] = [(); 2].map(|()| rng.random_range(1..=6));
        let [one, other] = [(); 2].map(|()| &pools[rng.random_range(0..pools.len())]);
        let how = format!("{}, cut at frame {frame}", self.name);
        let mut resumed = self.resumed(&self.frames[&frame].0);
        let state = one.install(|| {
            self.go_on(&mut resumed, first, &how);
            bytes(&resumed)
        });
        let mut again = self.resumed(&state);
        let how = format!("{how} and at frame {}", frame + first);
        other.install(|| self.go_on(&mut again, second, &how));
    }
}

/// Cuts a random scene; returns the number of cuts.
fn cut(seed: u64, pools: &[ThreadPool]) -> u64 {
    let rng = &mut ChaCha8Rng::seed_from_u64(seed);
    let mut whole = Whole {
        name: format!("seed {seed}"),
        scene: random(rng),
        is_observed: rng.random(),
        frames: BTreeMap::new(),
    };
    let begin = one(rng, &[0, 20, 101, 200]);
    let mut simulation = whole.start();
    let mut forks = Vec::new();
    let cuts: Vec<u64> = (0..OTHERS)
        .map(|_| begin + rng.random_range(0..WINDOW))
        .collect();
    while simulation.frame().clock.frame() < begin + WINDOW + 12 {
        let frame = simulation.frame().clock.frame();
        let is_cut = cuts.contains(&frame);
        if is_cut {
            forks.push((simulation.clone(), "forked before the evaluation"));
            // The state of a frame that is not evaluated.
            forks.push((
                whole.resumed(&bytes(&simulation)),
                "cut before the evaluation",
            ));
        }
        simulation.evaluate().unwrap();
        if is_cut {
            forks.push((simulation.clone(), "forked after the evaluation"));
            if whole.is_observed {
                let mut twice = simulation.clone();
                twice.evaluate_with_density().unwrap();
                forks.push((twice, "evaluated twice"));
            }
        }
        whole.keep(&mut simulation, begin.max(frame)..frame + 1);
    }
    for (mut fork, how) in forks {
        whole.go_on(&mut fork, 7, &format!("{}, {how}", whole.name));
    }
    let window = begin..begin + WINDOW;
    let coarse = u64::from(whole.scene.clock.coarse_every());
    let frames: Vec<u64> = window
        .filter(|frame| frame.is_multiple_of(coarse) || cuts.contains(frame))
        .collect();
    for &frame in &frames {
        whole.check(pools, frame, rng);
    }
    2 * frames.len() as u64
}

#[test]
fn a_run_resumed_at_any_frame_has_the_states_of_an_uninterrupted_run() {
    let times: u64 = std::env::var("BAD_INPUT_TIMES").map_or(1, |times| times.parse().unwrap());
    let pools = pools();
    let start = std::time::Instant::now();
    let cuts: u64 = (0..SCENES * times).map(|seed| cut(seed, &pools)).sum();
    println!("{cuts} cuts in {:.1} s", start.elapsed().as_secs_f64());
}

/// Scenes that resumed to another run in coarse frames: three people in a queue with corners, and 80 people on journeys
/// whose goals change.
const REPORTED: [&str; 2] = [
    include_str!("data/resume_queue.json"),
    include_str!("data/resume_journeys.json"),
];

#[test]
fn scenes_with_queues_and_changing_goals_resume_in_every_coarse_frame() {
    let pools = pools();
    for text in REPORTED {
        let mut whole = Whole {
            name: "reported".to_owned(),
            scene: scene(&serde_json::from_str(text).unwrap()),
            is_observed: false,
            frames: BTreeMap::new(),
        };
        let mut simulation = whole.start();
        whole.keep(&mut simulation, 400..760);
        for frame in (400..=740).step_by(5) {
            whole.check(&pools, frame, &mut ChaCha8Rng::seed_from_u64(frame));
        }
    }
}
