//! Results with their definitions.

use output::document::Block;
use output::table::Table;
use runs::summary::Summary;
use scenario::measurements::{
    GAP, HEADWAY, HighestDensity, LongestQueue, Measurement, Quantity, SLOW, STUCK_AFTER,
};

/// What readers of all values must know.
pub const DENSITY: &str = "\
    Exposure, levels of service and crowd pressure use ρ_i, the density of measurements: a kernel with a support \
    radius of √5 m over the person and all that it sees. docs/reference/measurements.md has the formulas, sources and \
    limits. A dash stands for a value that a run has not.";

/// A result of a run, in words.
pub struct Fact {
    pub name: String,
    pub value: String,
    pub meaning: String,
}

impl Fact {
    fn new(name: &str, value: String, meaning: impl Into<String>) -> Self {
        Self {
            name: name.to_owned(),
            value,
            meaning: meaning.into(),
        }
    }
}

/// A number that every run has: its name, unit and definition, and its value.
type Number = (&'static str, &'static str, fn(&Summary) -> Option<f64>);

/// The name of the highest density.
const HIGHEST: &str = "highest density [P/m²]";

/// The numbers of every run.
pub const NUMBERS: [Number; 8] = [
    ("entered", "agents that entered", |run| {
        Some(f64::from(run.agents))
    }),
    ("left", "agents that reached their goal or exit", |run| {
        Some(run.arrived as f64)
    }),
    ("remain", "agents that are there at the end", |run| {
        Some(run.remaining as f64)
    }),
    (
        "50 % out [s]",
        "when half of the agents that entered had left",
        |run| run.t50_secs,
    ),
    (
        "95 % out [s]",
        "when 95 % of the agents that entered had left",
        |run| run.t95_secs,
    ),
    (
        "all out [s]",
        "when all agents that entered had left",
        |run| run.t100_secs,
    ),
    (
        HIGHEST,
        "the highest SPH density at an agent: the kernel of the model (Eq. 13) with a support radius of 1 m over the \
         agent itself and the agents and walls around it; a person of mass 1 has 1.27 P/m² alone. \
         Observed in every coarse frame",
        |run| Some(run.highest_density.as_ref()?.density_per_m2),
    ),
    ("stuck", "agents at the end that make no headway", |run| {
        Some(run.stuck as f64)
    }),
];

/// A table of facts.
pub fn table(facts: &[Fact]) -> Table {
    Table::of(facts)
        .column("result", |fact| fact.name.as_str())
        .column("value", |fact| fact.value.as_str())
        .column("definition", |fact| fact.meaning.as_str())
        .table()
}

/// What is asked first about a run.
pub fn overview(run: &Summary, reason: &str) -> Vec<Fact> {
    let number = |&(name, meaning, value): &Number| {
        let digits = if name.contains('[') { 2 } else { 0 };
        let value = value(run).map(|value| format!("{value:.digits$}"));
        Fact::new(name, value.unwrap_or_else(|| "–".to_owned()), meaning)
    };
    let mut facts = vec![Fact::new(
        "end",
        format!("{:.2} s: {reason}", run.time_secs),
        "when and why the run ended",
    )];
    for one in &NUMBERS {
        facts.push(number(one));
        if one.0 == HIGHEST {
            facts.extend(run.highest_density.as_ref().map(place_of_highest));
        }
    }
    let queues = run.longest_queues.iter().enumerate();
    facts.extend(queues.flat_map(|(k, queue)| of_queue(queue, k == 0)));
    facts
}

/// The level of a place, if it lies in a building.
fn on_level(level: Option<&str>) -> String {
    level.map_or(String::new(), |level| format!(" on {level}"))
}

fn place_of_highest(highest: &HighestDensity) -> Fact {
    let ([x, y], secs) = (highest.at, highest.at_secs);
    let large = highest
        .of_large()
        .map_or(String::new(), |large| format!("; {large}"));
    Fact::new(
        "its place and time",
        format!(
            "({x:.2}, {y:.2}) m{}, {secs:.2} s",
            on_level(highest.level.as_deref())
        ),
        format!("place of the agent with the highest density, and when it had it first{large}"),
    )
}

/// The facts about a queue; those of the first have their definitions.
fn of_queue(queue: &LongestQueue, is_first: bool) -> impl Iterator<Item = Fact> {
    let before = &queue.before;
    let meaning = match is_first {
        true => format!(
            "most people at one time whose way leads there and who are slower than {SLOW} of their preferred speed, \
             from there up to the first gap of {GAP} m along their routes, without those who have just started; of a \
             queue with a line, those who have joined it"
        ),
        false => "the same".to_owned(),
    };
    let most = Fact::new(
        &format!("longest queue before {before}"),
        format!("{} people at {:.0} s", queue.agents, queue.at_secs),
        meaning,
    );
    let outside = queue.outside.as_ref().map(|outside| {
        Fact::new(
            &format!("outside of the line of {before}"),
            format!("{} people at {:.0} s", outside.agents, outside.at_secs),
            format!(
                "most people at one time around its line when it was full; {} stood there, {:.0} s each on average",
                outside.people, outside.mean_secs
            ),
        )
    });
    let density = queue.density_per_m2.map(|density| {
        let packed = queue
            .packed()
            .map_or(String::new(), |packed| format!("; {packed}"));
        let whose = match queue.outside {
            Some(_) => " who stand outside of the line",
            None => "",
        };
        Fact::new(
            &format!("density of those who wait before {before}"),
            format!("{density:.1} P/m²"),
            format!(
                "the highest median of the SPH densities at five or more of them{whose}{packed}"
            ),
        )
    });
    [Some(most), outside, density].into_iter().flatten()
}

/// Who is stuck, by the likely cause.
pub fn stuck(run: &Summary) -> Vec<Block> {
    let rule = format!(
        "Agents are stuck if their way became shorter by less than {HEADWAY} m in their last {STUCK_AFTER} s of \
         walking. Agents that wait, queue or never leave their goal do not count."
    );
    if run.stuck == 0 {
        return vec![Block::text(format!(
            "No agent was stuck at the end. {rule}"
        ))];
    }
    let table = Table::of(&run.stuck_because)
        .column("agents", |group| group.agents)
        .column("likely cause", |group| group.cause.as_str())
        .column("one of them", |group| group.agent)
        .column("its place [m]", |group| {
            let level = on_level(group.level.as_deref());
            format!("({:.2}, {:.2}){level}", group.at[0], group.at[1])
        })
        .fixed("for [s]", 0, |group| group.for_secs)
        .table();
    vec![Block::Table(table, rule)]
}

/// The values of a measurement in words, with their definitions.
pub fn measured(measurement: &Measurement, run: &Summary) -> Vec<Fact> {
    let fact = |quantity: Quantity| {
        let value = match run.metrics.get(&quantity.name) {
            Some(value) if value.is_u64() => value.to_string(),
            Some(value) => value
                .as_f64()
                .map_or("–".to_owned(), |value| format!("{value:.3}")),
            None => "–".to_owned(),
        };
        let unit = if value == "–" { "" } else { quantity.unit };
        Fact {
            value: format!("{value} {unit}").trim_end().to_owned(),
            name: quantity.name,
            meaning: quantity.meaning,
        }
    };
    measurement.quantities().into_iter().map(fact).collect()
}
