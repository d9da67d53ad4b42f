//! An addition to Fig. 7: the wave over space and time for several k, and its speed against linear theory.

use super::super::product::{Needs, Product};
use crate::error::LabError;
use crate::gallery::points;
use crate::sweep::Gathered;
use analysis::sound;
use analysis::statistics::Estimate;
use analysis::wave::{Ridge, Wave};
use output::colors::ColorMap;
use output::plot::{Axis, Cells, ColorBar, Corner, LINES, Mark, Panel, Sheet, Style};
use output::table::Table;
use scenario::measurements::WaveData;

/// K^ag of the baseline (§5.5).
const AGENT_STIFFNESS: f64 = 50.0;
/// D_i + D_j of average agents, meters (§5.6).
const REACH: f64 = 0.48;
/// The mean speed at the end of the color range, m/s.
const FASTEST: f32 = 0.8;

/// The diagrams.
pub const PRODUCT: Product = Product {
    name: "waves",
    about: "space-time diagrams of the shockwave for five k, and its speed against linear theory",
    in_all: true,
    studies: &["shockwave"],
    needs: Needs::Labeled(&LABELS),
    tables: &["waves"],
    has_figure: true,
    find: |product, studies| {
        let study = &studies[0];
        let pairs = LABELS.into_iter().zip(GAS_CONSTANTS);
        let speeds = pairs.map(|(label, k)| Speed::of(study, label, k));
        let runs: Vec<Speed> = speeds.collect::<Result<_, _>>()?;
        let findings = product.figure(sheet(&runs));
        Ok(findings.with_table(product.name, &table(&runs))?)
    },
};

/// The runs, by increasing k.
const LABELS: [&str; 5] = ["k = 50", "k = 100", "baseline", "k = 400", "k = 800"];
/// Their k.
const GAS_CONSTANTS: [f64; 5] = [50.0, 100.0, 200.0, 400.0, 800.0];

/// The wave of one concert, and the speeds of linear theory.
#[derive(Debug, Clone)]
struct Speed {
    /// k.
    gas_constant: f64,
    /// The space-time diagram, the places of push and obstacle, and the wave; no wave if none stands out.
    seen: WaveData,
    /// √(k/2), m/s.
    fluid: f64,
    /// Mean number of contacts of an agent before the push.
    contacts: Option<f64>,
    /// √(k/2 + K^ag M) with the contacts of this crowd before the push, m/s.
    with_contacts: Option<f64>,
    /// The same if every disc just touches six others, m/s.
    all_touching: f64,
}

impl Speed {
    /// The results of one run.
    fn of(study: &Gathered, label: &str, gas_constant: f64) -> Result<Self, LabError> {
        let (_, result) = study.labeled(label)?;
        let with = |modulus| sound::speed_with_contacts(gas_constant, AGENT_STIFFNESS, modulus);
        let data = result.summary.data(WaveData::NAME);
        let seen = data.ok_or_else(|| LabError::missing(label, "wave"))?;
        Ok(Self {
            gas_constant,
            seen,
            fluid: sound::speed_of_fluid(gas_constant),
            contacts: result.summary.metric("contacts_per_agent"),
            with_contacts: result.summary.metric("contact_modulus_m2").map(with),
            all_touching: with(sound::touching_modulus(REACH)),
        })
    }
}

/// The diagrams, and the speed against k as the last panel.
fn sheet(speeds: &[Speed]) -> Sheet {
    let map = ColorMap::inferno([0.0, FASTEST]);
    let mut panels: Vec<Panel> = speeds.iter().map(|speed| diagram(speed, &map)).collect();
    panels.push(against_gas_constant(speeds));
    let title = "The shockwave over place and time, and its speed against linear theory";
    Sheet {
        bar: Some(ColorBar::new("mean speed, |y| ≤ 8 m [m/s]", &map)),
        ..Sheet::new(title, 3, [215.0, 190.0], panels)
    }
}

/// One run: the mean speed, the fitted crests, and the crest of linear theory.
fn diagram(speed: &Speed, map: &ColorMap) -> Panel {
    let seen = &speed.seen.diagram;
    let (first, last) = match seen.times[..] {
        [first, .., last] => (first, last),
        _ => (0.0, 1.0),
    };
    let x = seen.strip.x;
    let mut marks = vec![Mark::Cells(Cells {
        extent: [[x[0], first], [x[1], last]],
        columns: seen.strip.bins(),
        values: seen.speed.clone(),
        map: map.clone(),
    })];
    let mut title = format!("k = {}: no wave", speed.gas_constant);
    if let Some(wave) = &speed.seen.wave {
        title = format!("k = {}: {}", speed.gas_constant, summary(wave));
        marks.extend(crests(wave, speed));
    }
    let (x, y) = (
        Axis::linear("x [m]", x),
        Axis::linear("t [s]", [first, last]),
    );
    Panel::new(&title, x, y, marks).with_legend(Corner::UpperRight)
}

fn summary(wave: &Wave) -> String {
    let there = wave.arriving.speed;
    let mut text = format!("{:.2} ± {:.2} m/s there", there.value, there.error);
    if let Some(back) = wave.returning.as_ref().map(|ridge| ridge.speed) {
        text += &format!(", {:.2} ± {:.2} back", back.value, back.error);
    }
    text
}

/// Lines along the crests, and those of linear theory with the same start.
fn crests(wave: &Wave, speed: &Speed) -> Vec<Mark> {
    let run = speed.seen.run;
    let ends = [run.source, run.obstacle];
    let fitted = |ridge: &Ridge, label| {
        let line = ends.map(|x| [x, ridge.time_at(x)]);
        Mark::line(line, Style::full(LINES[5], 1.0, label))
    };
    let mut marks = vec![fitted(&wave.arriving, "fitted")];
    marks.extend(wave.returning.iter().map(|ridge| fitted(ridge, "")));
    if let Some(theory) = speed.with_contacts {
        let begin = wave.arriving.time_at(run.source);
        let crossing = (run.obstacle - run.source) / theory;
        let path = [
            [run.source, begin],
            [run.obstacle, begin + crossing],
            [run.source, begin + 2.0 * crossing],
        ];
        let style = Style::broken(LINES[2], 1.0, "theory, discs in contact");
        marks.push(Mark::line(path, style));
    }
    marks
}

type Of = fn(&Wave) -> Option<Estimate>;
const ARRIVING: Of = |wave| Some(wave.arriving.speed);
const RETURNING: Of = |wave| Some(wave.returning.as_ref()?.speed);

/// One line per k: the measured wave, and the speeds of linear theory.
fn table(speeds: &[Speed]) -> Table {
    let estimates: [(&str, [&str; 2], Of); 4] = [
        ("arriving", ["_m_per_s", "_error"], ARRIVING),
        ("returning", ["_m_per_s", "_error"], RETURNING),
        ("amplitude", ["_m_per_s", "_error"], |wave| {
            Some(wave.amplitude)
        }),
        ("reflection", ["", "_error"], |wave| wave.reflection),
    ];
    let mut table = Table::of(speeds).column("gas_constant", |speed| speed.gas_constant);
    for (name, suffixes, of) in estimates {
        table = table.spread(name, 4, suffixes, |speed| {
            speed.seen.wave.as_ref().and_then(of)
        });
    }
    table
        .column("contacts_per_agent", |speed| speed.contacts)
        .column("fluid_m_per_s", |speed| speed.fluid)
        .column("with_contacts_m_per_s", |speed| speed.with_contacts)
        .column("all_touching_m_per_s", |speed| speed.all_touching)
        .table()
}

fn against_gas_constant(speeds: &[Speed]) -> Panel {
    let curve = |values: fn(&Speed) -> Option<f64>, style| {
        let point = |speed: &Speed| Some([speed.gas_constant, values(speed)?]);
        Mark::line(speeds.iter().filter_map(point), style)
    };
    let measured = |estimate: Of, style| {
        let wave = |speed: &Speed| estimate(speed.seen.wave.as_ref()?);
        Mark::Points(points(speeds, |of| Some(of.gas_constant), wave), style)
    };
    let touching = Style::broken(LINES[2], 1.0, "all discs touching");
    let in_contact = Style::full(LINES[2], 1.0, "discs in contact");
    let marks = vec![
        curve(|of| Some(of.fluid), Style::broken(LINES[6], 1.0, "√(k/2)")),
        curve(|of| Some(of.all_touching), touching),
        curve(|of| of.with_contacts, in_contact),
        measured(ARRIVING, Style::full(LINES[0], 2.4, "to the stage")),
        measured(RETURNING, Style::broken(LINES[1], 2.4, "back")),
    ];
    let x = Axis::log("k", [40.0, 1000.0]);
    let y = Axis::log("wave speed [m/s]", [4.0, 30.0]);
    Panel::new("speed against k, and linear theory", x, y, marks).with_legend(Corner::UpperLeft)
}
