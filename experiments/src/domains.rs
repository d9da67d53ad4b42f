//! How crowds would divide among processes: the balance of the parts, the agents that parts read from each other, how
//! long a cut holds, and a model of the time of a frame.
//!
//! Crowds, cuts, halos and the time on one thread are simulated and measured; the time on many processes is a model. No
//! process sends anything.

mod crowds;
mod cut;
mod drift;
mod halo;
mod network;
mod picture;
mod traffic;

use sandbox::analysis::statistics::Range;
use sandbox::engine::math::Vector;
use sandbox::engine::neighbors::SKIN;
use sandbox::engine::simulation::{Simulation, Stage};
use sandbox::lab::bench::timing::{ms_of, ms_per_frame, pool};
use sandbox::lab::bench::{Benchmark, Plan, Timings};
use sandbox::lab::error::LabError;
use sandbox::output::table::Table;
use serde::Serialize;
use serde_json::json;

use self::crowds::Kind;
use self::cut::{Cut, Way};
use self::drift::{Drift, follow};
use self::halo::Field;
use self::network::{Load, Modeled, NETWORKS};
use self::traffic::Traffic;

/// The experiment.
pub const BENCHMARK: Benchmark = Benchmark {
    name: "domains",
    about: "how crowds would divide among processes: balance, halos, drift, and a model of the time of a frame",
    run,
};

/// The numbers of parts, as long as a part has `FEWEST` agents on average.
const PARTS: [usize; 5] = [4, 16, 64, 256, 1024];
const FEWEST: usize = 100;
/// How long a cut is held, seconds.
const HELD: u64 = 10;
/// Agents × frames per repeat of the time on one thread; the number of frames is clamped to `FRAMES`.
const AGENT_FRAMES: u64 = 1_000_000;
const FRAMES: [u64; 2] = [5, 100];

/// The results for one crowd and cut.
#[derive(Serialize)]
struct Row {
    crowd: String,
    agents: usize,
    /// Agents closer than this read each other, with the margin of the lists, meters.
    reach: f64,
    parts: usize,
    cut: &'static str,
    /// A frame of the whole crowd on one thread.
    ms_per_frame: Range,
    /// The number of agents in the largest part, divided by the mean.
    agents_ratio: f64,
    /// The largest number of pairs of near agents in a part, divided by the mean.
    pairs_ratio: f64,
    /// The largest work of a part, divided by the mean; estimated from agents, pairs and RVO.
    work_ratio: f64,
    /// Agents of other parts that a part reads.
    halo_mean: f64,
    halo_largest: u32,
    /// Parts that a part reads from.
    neighbors_mean: f64,
    neighbors_most: u32,
    /// Bytes per agent of a halo and frame.
    bytes: Traffic,
    /// Kilobytes into the part with the largest halo, in a coarse frame with new lists.
    kilobytes_most: f64,
    /// How the balance drifts; `None` for crowds at rest.
    drift: Option<Drift>,
    model: Vec<Modeled>,
}

fn run(plan: &Plan, say: &dyn Fn(&str)) -> Result<Timings, LabError> {
    let mut rows = Vec::new();
    for kind in Kind::all(plan) {
        rows.append(&mut measure(&kind, plan, say)?);
    }
    Ok(Timings {
        table: table(&rows),
        sheet: picture::sheet(&rows),
        rows: json!(rows),
        notes: notes(),
    })
}

fn notes() -> Vec<String> {
    let bytes = Traffic::of_columns(false);
    let networks = NETWORKS.map(|network| {
        format!(
            "{} {:.1} µs and {} GB/s",
            network.name,
            1e6 * network.latency,
            1e-9 * network.bandwidth
        )
    });
    vec![
        "Block: the crowd of `scaling`, at rest. Streams: 4 P/m², sph, half of the agents walk to the right and half \
         to the left. Concert from 150 s and plaza from 10 s on, as shipped. Halo: agents of other parts in reach, \
         plus the margin of the lists. Work: the measured time of RVO goes to the agents on which it acts, the rest \
         to agents or pairs, whichever gives a part more."
            .to_owned(),
        format!(
            "Cuts are held for the seconds in the head of the table; then the agents of the largest part over the \
             mean. An agent of a halo takes {} bytes per frame, and {} in a frame with new lists; with RVO, {} in a \
             coarse frame with new lists.",
            bytes.usual(),
            bytes.most(),
            Traffic::of_columns(true).most()
        ),
        format!(
            "The speed-ups are a model, not measured: the time on one thread × the largest share of the work, plus two \
             exchanges and one global maximum. Assumed latency and bandwidth: {}.",
            networks.join("; ")
        ),
    ]
}

/// The numbers of parts for a crowd.
fn counts(agents: usize) -> impl Iterator<Item = usize> {
    let large = move |&parts: &usize| parts == PARTS[0] || agents >= FEWEST * parts;
    PARTS.into_iter().filter(large)
}

fn measure(kind: &Kind, plan: &Plan, say: &dyn Fn(&str)) -> Result<Vec<Row>, LabError> {
    say(&format!("{}: simulates it", kind.name()));
    let mut simulation = kind.start(plan)?;
    let agents = simulation.frame().agents.len();
    say(&format!("{}: {agents} agents on one thread", kind.name()));
    let (ms_per_frame, rvo) = alone(&mut simulation, plan)?;
    let crowd = Positions::of(&simulation, rvo);
    let weights = crowd.weights();
    let (mut rows, mut cuts) = (Vec::new(), Vec::new());
    for parts in counts(crowd.positions.len()) {
        say(&format!("{}: {parts} parts", kind.name()));
        for way in Way::ALL {
            let cut = way.cut(&crowd.positions, &weights, parts);
            let row = crowd.row(&cut, parts);
            rows.push(Row {
                crowd: kind.name(),
                cut: way.name(),
                ms_per_frame,
                ..row
            });
            cuts.push((cut, parts));
        }
    }
    if kind.moves() {
        let seconds = plan.choose(HELD, 1);
        say(&format!("{}: holds the cuts for {seconds} s", kind.name()));
        let drifts = follow(&mut simulation, &cuts, seconds)?;
        for (row, drift) in rows.iter_mut().zip(drifts) {
            row.drift = Some(drift);
        }
    }
    for row in &mut rows {
        row.model = row.modeled();
    }
    Ok(rows)
}

/// Milliseconds per frame on one thread, and the share of RVO in them.
fn alone(simulation: &mut Simulation, plan: &Plan) -> Result<(Range, f64), LabError> {
    let clock = *simulation.frame().clock;
    let agents = simulation.frame().agents.len() as u32;
    let frames = plan.frames(agents, AGENT_FRAMES, FRAMES);
    // Whole coarse steps: RVO runs once in each.
    let frames = frames.next_multiple_of(u64::from(clock.coarse_every()));
    simulation.reset_stages();
    let times = pool(1)?.install(|| {
        let times = (0..plan.repeats).map(|_| ms_per_frame(simulation, frames));
        times.collect::<Result<Vec<f64>, _>>()
    });
    let stages = simulation.stages();
    let rvo = ms_of(stages, Stage::Rvo) / stages.total_ms_per_frame();
    Ok((Range::of(&times?), rvo))
}

/// A crowd at one moment.
struct Positions {
    positions: Vec<Vector>,
    field: Field,
    reach: f64,
    /// Agents in reach of each agent, without the margin.
    pairs: Vec<u32>,
    /// Whether RVO acts on each agent. Empty without RVO.
    avoids: Vec<bool>,
    /// The share of RVO in the time of a frame.
    rvo: f64,
    traffic: Traffic,
}

impl Positions {
    fn of(simulation: &Simulation, rvo: f64) -> Self {
        let (scene, needs) = (simulation.scene(), simulation.needs());
        let agents = simulation.frame().agents;
        let ranges = scene.ranges(needs, agents);
        let widest = agents.radius.iter().copied().fold(0.0, f64::max);
        let acts = ranges.interaction(widest);
        let acts = acts.max(ranges.wide.unwrap_or_default());
        let field = Field::new(&agents.position, acts + SKIN);
        Self {
            pairs: field.neighbors(acts),
            avoids: agents.avoidance.iter().map(Option::is_some).collect(),
            rvo,
            positions: agents.position.clone(),
            field,
            reach: acts + SKIN,
            traffic: Traffic::of_columns(needs.rvo),
        }
    }

    /// The work of each agent: the share of RVO is that of the agents on which it acts; half of the rest is equal, and
    /// half is that of the pairs.
    fn weights(&self) -> Vec<f64> {
        let agents = self.positions.len() as f64;
        let pairs: u64 = self.pairs.iter().map(|&count| u64::from(count)).sum();
        let avoiding = self.avoids.iter().filter(|&&avoids| avoids).count();
        let per_pair = agents / pairs.max(1) as f64;
        let per_avoiding = agents / avoiding.max(1) as f64;
        let weight = |(i, &count): (usize, &u32)| {
            let usual = 0.5 + 0.5 * f64::from(count) * per_pair;
            let avoids = self.avoids.get(i).is_some_and(|&avoids| avoids);
            (1.0 - self.rvo) * usual + self.rvo * per_avoiding * f64::from(u8::from(avoids))
        };
        self.pairs.iter().enumerate().map(weight).collect()
    }

    /// The results for one cut, without drift and model.
    fn row(&self, cut: &Cut, parts: usize) -> Row {
        let part_of = cut.parts(&self.positions);
        let [mut agents, mut pairs, mut avoiding] = [0; 3].map(|zero| vec![zero; parts]);
        for (&part, &count) in part_of.iter().zip(&self.pairs) {
            agents[part as usize] += 1;
            pairs[part as usize] += u64::from(count);
        }
        for (&part, &avoids) in part_of.iter().zip(&self.avoids) {
            avoiding[part as usize] += u64::from(avoids);
        }
        let halos = self.field.halos(&part_of, parts);
        let mean = |counts: &[u32]| {
            let sum: u64 = counts.iter().map(|&count| u64::from(count)).sum();
            sum as f64 / parts as f64
        };
        let largest = |counts: &[u32]| counts.iter().copied().max().unwrap_or_default();
        let halo_largest = largest(&halos.agents);
        Row {
            crowd: String::new(),
            agents: self.positions.len(),
            reach: self.reach,
            parts,
            cut: "",
            ms_per_frame: Range::of(&[]),
            agents_ratio: ratio(&agents),
            pairs_ratio: ratio(&pairs),
            work_ratio: work([&agents, &pairs, &avoiding], self.rvo),
            halo_mean: mean(&halos.agents),
            halo_largest,
            neighbors_mean: mean(&halos.neighbors),
            neighbors_most: largest(&halos.neighbors),
            bytes: self.traffic,
            kilobytes_most: 1e-3 * f64::from(halo_largest) * self.traffic.most() as f64,
            drift: None,
            model: Vec::new(),
        }
    }
}

/// Some counts over their mean.
fn relative(counts: &[u64]) -> impl Iterator<Item = f64> {
    let sum = counts.iter().sum::<u64>().max(1) as f64;
    let length = counts.len() as f64;
    counts.iter().map(move |&count| count as f64 * length / sum)
}

/// The largest of some counts over their mean.
fn ratio(counts: &[u64]) -> f64 {
    relative(counts).fold(0.0, f64::max)
}

/// The work of the part with the most over the mean. The time of RVO is divided by the agents on which it acts, the
/// rest by agents or pairs, whichever gives the part more: a bound for every mix of the two.
fn work([agents, pairs, avoiding]: [&[u64]; 3], rvo: f64) -> f64 {
    let parts = relative(agents)
        .zip(relative(pairs))
        .zip(relative(avoiding));
    let work =
        parts.map(|((agents, pairs), avoiding)| (1.0 - rvo) * agents.max(pairs) + rvo * avoiding);
    work.fold(0.0, f64::max)
}

impl Row {
    /// The part with the most work reads the largest halo.
    fn modeled(&self) -> Vec<Modeled> {
        let load = Load {
            parts: self.parts,
            share: self.work_ratio / self.parts as f64,
            halo: f64::from(self.halo_largest),
            traffic: self.bytes,
        };
        let alone = self.ms_per_frame.median;
        let modeled = NETWORKS.iter();
        modeled.map(|network| network.model(alone, &load)).collect()
    }
}

fn table(rows: &[Row]) -> Table {
    let held = rows.iter().find_map(|row| row.drift);
    let held = held.map_or(HELD, |drift| drift.seconds);
    let mut table = Table::of(rows)
        .column("crowd", |row| row.crowd.as_str())
        .column("agents", |row| row.agents)
        .column("parts", |row| row.parts)
        .column("cut", |row| row.cut)
        .fixed("agents max/mean", 2, |row| row.agents_ratio)
        .fixed("pairs", 2, |row| row.pairs_ratio)
        .fixed("work", 2, |row| row.work_ratio)
        .fixed("after 1 s", 2, |row| row.drift.map(|d| d.after_a_second))
        .fixed(&format!("{held} s"), 2, |row| {
            row.drift.map(|d| d.at_the_end)
        })
        .fixed("change parts [%/s]", 1, |row| {
            row.drift.map(|d| 100.0 * d.changes_per_second)
        })
        .fixed("halo mean", 0, |row| row.halo_mean)
        .column("max", |row| f64::from(row.halo_largest))
        .column("parts read max", |row| f64::from(row.neighbors_most))
        .fixed("kB max", 1, |row| row.kilobytes_most)
        .fixed("ms, one thread", 2, |row| row.ms_per_frame.median);
    for (k, network) in NETWORKS.iter().enumerate() {
        let name = format!("speed-up, {}", network.name);
        table = table.fixed(&name, 1, |row| row.model.get(k).map(|m| m.speed_up));
    }
    table.table()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_of_equal_counts_have_ratio_one() {
        assert_eq!(ratio(&[5, 5, 5]), 1.0);
        assert_eq!(ratio(&[0, 0, 6]), 3.0);
        assert_eq!(ratio(&[0, 0]), 0.0);
    }

    #[test]
    fn work_is_a_bound_for_every_mix_of_agents_and_pairs() {
        let (agents, pairs): ([u64; 3], [u64; 3]) = ([4, 2, 6], [90, 20, 10]);
        let bound = work([&agents, &pairs, &[0; 3]], 0.0);
        for share in [0.0, 0.2, 0.5, 0.9, 1.0] {
            let mixed = relative(&agents).zip(relative(&pairs));
            let mixed = mixed.map(|(agents, pairs)| (1.0 - share) * agents + share * pairs);
            assert!(mixed.fold(0.0, f64::max) <= bound);
        }
    }

    #[test]
    fn work_of_rvo_is_where_agents_avoid() {
        let equal = [3; 4];
        assert_eq!(work([&equal, &equal, &[0, 0, 7, 0]], 1.0), 4.0);
        assert_eq!(work([&equal, &equal, &[0, 0, 7, 0]], 0.5), 2.5);
    }

    #[test]
    fn parts_have_enough_agents() {
        assert!(counts(10_000).eq([4, 16, 64]));
        assert!(counts(1).eq([4]));
    }
}
