//! An addition to Fig. 7: the wave over space and time for several k, and its speed against linear theory.

use super::concert::{RUN, SPEEDS, Seen, Variant};
use super::save;
use crate::analysis::wave::{self, SpaceTime, Wave};
use crate::analysis::sound;
use crate::lab::reproduce::error::ReproduceError;
use crate::lab::reproduce::product::Product;
use crate::output::colors::ColorMap;
use crate::output::plot::{Axis, Cells, ColorBar, Corner, LINES, Mark, Panel, Point, Sheet, Style};

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
    cases: |_| Ok(SPEEDS.iter().map(|(_, variant)| variant.case()).collect()),
    write: |_, results, store| {
        let of = |(k, variant): (f64, Variant)| Ok((k, variant, variant.seen(results)?));
        let runs: Result<Vec<_>, ReproduceError> = SPEEDS.into_iter().map(of).collect();
        let runs = runs?;
        let speeds: Vec<Speed> = runs
            .iter()
            .map(|(k, _, seen)| Speed::of(*k, seen))
            .collect();
        store.write("waves.csv", csv(&speeds).as_bytes())?;
        save(&sheet(&runs, &speeds), store, "waves")
    },
};

/// The wave of one concert, and the speeds of linear theory.
#[derive(Debug, Clone)]
struct Speed {
    /// k.
    gas_constant: f64,
    /// The measured wave; `None` if no wave stands out.
    wave: Option<Wave>,
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
    /// Measures one run.
    fn of(gas_constant: f64, seen: &Seen) -> Self {
        let with = |modulus| sound::speed_with_contacts(gas_constant, AGENT_STIFFNESS, modulus);
        Self {
            gas_constant,
            wave: wave::measure(&seen.diagram, &RUN),
            fluid: sound::speed_of_fluid(gas_constant),
            contacts: seen.contacts.map(|contacts| contacts.per_agent),
            with_contacts: seen.contacts.map(|contacts| with(contacts.modulus)),
            all_touching: with(sound::touching_modulus(REACH)),
        }
    }
}

/// The diagrams, and the speed against k as the last panel.
fn sheet(runs: &[(f64, Variant, Seen)], speeds: &[Speed]) -> Sheet {
    let map = ColorMap::inferno([0.0, FASTEST]);
    let mut panels: Vec<Panel> = runs
        .iter()
        .zip(speeds)
        .map(|((_, _, seen), speed)| diagram(&seen.diagram, speed, &map))
        .collect();
    panels.push(against_gas_constant(speeds));
    Sheet {
        title: "The shockwave over place and time, and its speed against linear theory".to_owned(),
        columns: 3,
        panel_size: [215.0, 190.0],
        shared_axes: false,
        row_titles: Vec::new(),
        bar: Some(ColorBar {
            label: "mean speed, |y| ≤ 8 m [m/s]".to_owned(),
            map,
        }),
        panels,
    }
}

/// One run: the mean speed, the fitted crests, and the crest of linear theory.
fn diagram(seen: &SpaceTime, speed: &Speed, map: &ColorMap) -> Panel {
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
    if let Some(wave) = &speed.wave {
        title = format!("k = {}: {}", speed.gas_constant, summary(wave));
        marks.extend(crests(wave, speed));
    }
    Panel {
        title,
        x: Axis::linear("x [m]", x),
        y: Axis::linear("t [s]", [first, last]),
        marks,
        bar: None,
        legend: Some(Corner::UpperRight),
    }
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
    let ends = [RUN.source, RUN.obstacle];
    let line = |ridge: &wave::Ridge| ends.map(|x| [x, ridge.time_at(x)]).to_vec();
    let fitted = Style::full(LINES[5], 1.0, "fitted");
    let mut marks = vec![Mark::Line(line(&wave.arriving), fitted.clone())];
    if let Some(returning) = &wave.returning {
        let style = Style {
            label: String::new(),
            ..fitted
        };
        marks.push(Mark::Line(line(returning), style));
    }
    if let Some(theory) = speed.with_contacts {
        let begin = wave.arriving.time_at(RUN.source);
        let crossing = (RUN.obstacle - RUN.source) / theory;
        let there = [[RUN.source, begin], [RUN.obstacle, begin + crossing]];
        let back = [there[1], [RUN.source, begin + 2.0 * crossing]];
        let style = Style::broken(LINES[2], 1.0, "theory, discs in contact");
        marks.push(Mark::Line(vec![there[0], there[1], back[1]], style));
    }
    marks
}

/// Measured and theoretical values as CSV; values that do not exist are empty.
fn csv(speeds: &[Speed]) -> String {
    let mut text =
        "gas_constant,arriving_m_per_s,arriving_error,returning_m_per_s,returning_error,\
        amplitude_m_per_s,amplitude_error,reflection,reflection_error,contacts_per_agent,\
        fluid_m_per_s,with_contacts_m_per_s,all_touching_m_per_s\n"
            .to_owned();
    let number = |value: Option<f64>| value.map_or(String::new(), |v| format!("{v:.4}"));
    for speed in speeds {
        let wave = speed.wave.as_ref();
        let estimates = [
            wave.map(|w| w.arriving.speed),
            wave.and_then(|w| w.returning.as_ref()).map(|r| r.speed),
            wave.map(|w| w.amplitude),
            wave.and_then(|w| w.reflection),
        ];
        text += &speed.gas_constant.to_string();
        for estimate in estimates {
            let (value, error) = (estimate.map(|e| e.value), estimate.map(|e| e.error));
            text += &format!(",{},{}", number(value), number(error));
        }
        for value in [
            speed.contacts,
            Some(speed.fluid),
            speed.with_contacts,
            Some(speed.all_touching),
        ] {
            text += &format!(",{}", number(value));
        }
        text.push('\n');
    }
    text
}

fn against_gas_constant(speeds: &[Speed]) -> Panel {
    let curve = |values: &dyn Fn(&Speed) -> Option<f64>| -> Vec<[f64; 2]> {
        let point = |speed: &Speed| Some([speed.gas_constant, values(speed)?]);
        speeds.iter().filter_map(point).collect()
    };
    let points = |estimate: &dyn Fn(&Wave) -> Option<wave::Estimate>| -> Vec<Point> {
        let point = |speed: &Speed| {
            let estimate = estimate(speed.wave.as_ref()?)?;
            Some(Point {
                x: speed.gas_constant,
                y: estimate.value,
                error: estimate.error,
            })
        };
        speeds.iter().filter_map(point).collect()
    };
    let there = points(&|wave| Some(wave.arriving.speed));
    let back = points(&|wave| wave.returning.as_ref().map(|ridge| ridge.speed));
    let marks = vec![
        Mark::Line(
            curve(&|speed| Some(speed.fluid)),
            Style::broken(LINES[6], 1.0, "√(k/2)"),
        ),
        Mark::Line(
            curve(&|speed| Some(speed.all_touching)),
            Style::broken(LINES[2], 1.0, "all discs touching"),
        ),
        Mark::Line(
            curve(&|speed| speed.with_contacts),
            Style::full(LINES[2], 1.0, "discs in contact"),
        ),
        Mark::Points(there, Style::full(LINES[0], 2.4, "to the stage")),
        Mark::Points(back, Style::broken(LINES[1], 2.4, "back")),
    ];
    Panel {
        title: "speed against k, and linear theory".to_owned(),
        x: Axis::log("k", [40.0, 1000.0]),
        y: Axis::log("wave speed [m/s]", [4.0, 30.0]),
        marks,
        bar: None,
        legend: Some(Corner::UpperLeft),
    }
}
