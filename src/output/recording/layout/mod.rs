//! The layout that a recording opens with: views of the crowd and of single agents, plots, texts.

pub mod blueprint;
mod views;

use rerun::EntityPath;
use rerun::blueprint::components::{LoopMode, PanelState, PlayState};
use rerun::blueprint::{
    Blueprint, BlueprintPanel, ContainerLike, Horizontal, SelectionPanel, Spatial3DView, Tabs,
    TextDocumentView, TextLogView, TimePanel, TimeSeriesView, Vertical,
};
use rerun::external::re_log_types::TimeInt;

use super::arrangement::Arrangement;
use super::building;
use super::debug::{focus, moment};
use super::frame::colored_lines::ColoredLines;
use super::frame::{SIM_TIME, crowd, events, stats};
use super::options::RecordingOptions;
use super::scene::bars;
use super::text;
use analysis::round::brief;
use views::{Property, View};

/// Length of the loop that plays first, seconds.
const LOOP: f64 = 10.0;
/// The loop begins before the opening moment if less than this is left of the run, seconds.
const SHORTEST_LOOP: f64 = 2.0;

/// The state of a recording, on which its layout depends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Opening {
    /// No data yet: the viewer is paused at the start.
    Empty,
    /// The viewer follows the incoming data.
    Live,
    /// The recording is complete: a loop from `opens_at` plays, and this followed agent's view is in front. The layout
    /// is sent last, because the viewer cannot jump to a time that it has not read yet.
    Whole(Option<usize>),
}

/// The kind of data shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// A simulation.
    Run,
    /// One moment of a simulation: single agents and tables of their forces.
    Moment,
    /// A measured crowd, without energy or computing time.
    Measurement,
}

/// The content of a recording.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Content {
    /// Its subject.
    pub kind: Kind,
    /// Whether agents visit places.
    pub has_journeys: bool,
    /// Whether the agents of some journey have more than one stage.
    pub has_stages: bool,
    /// Whether there are queues or waiting areas.
    pub has_waiting: bool,
    /// The entities with the lengths of routes, which are hidden at first.
    pub fields: Vec<EntityPath>,
    /// The layers of colored lines.
    pub lines: Vec<&'static ColoredLines>,
    /// Whether it is a building.
    pub has_levels: bool,
    /// Whether the walkable area has an outside.
    pub has_outside: bool,
    /// The names of the followed agents.
    pub followed: Vec<String>,
}

impl Content {
    /// A crowd on a plane.
    pub fn new(kind: Kind, has_outside: bool) -> Self {
        Self {
            kind,
            has_journeys: false,
            has_stages: false,
            has_waiting: false,
            has_levels: false,
            fields: Vec::new(),
            lines: Vec::new(),
            has_outside,
            followed: Vec::new(),
        }
    }
}

/// The blueprint, and the properties of its views that it has no setters for.
pub fn layout(
    options: &RecordingOptions,
    opening: Opening,
    content: &Content,
) -> (Blueprint, Vec<Property>) {
    let mut properties = Vec::new();
    let all = &mut properties;
    let root = match content.kind {
        Kind::Moment => moment(all, opening, content),
        _ => {
            let arrangement = Arrangement::of(&options.view);
            let crowds = crowds(all, options, arrangement, content);
            let rest = rest(all, (options, arrangement), opening, content);
            match arrangement {
                Arrangement::Tall => Horizontal::new([crowds, rest]).into(),
                _ => Vertical::new([crowds, rest])
                    .with_row_shares(arrangement.row_shares())
                    .into(),
            }
        }
    };
    let blueprint = Blueprint::new(root)
        .with_auto_views(false)
        .with_auto_layout(false)
        .with_blueprint_panel(BlueprintPanel::from_state(PanelState::Collapsed))
        .with_selection_panel(SelectionPanel::from_state(PanelState::Expanded))
        .with_time_panel(time_panel(options, opening));
    (blueprint, properties)
}

/// The whole crowd by density, and by speed or stage.
fn crowds(
    properties: &mut Vec<Property>,
    options: &RecordingOptions,
    arrangement: Arrangement,
    content: &Content,
) -> ContainerLike {
    let shown = bars::with_bar(&options.view);
    let range = |[first, last]: [f64; 2]| format!("{}–{}", brief(first), brief(last));
    let density_title = format!("Density {} P/m²", range(options.density_range));
    let density = View::of_crowd(&density_title, content)
        .with(bars::DENSITY)
        .add(properties, &shown);
    let speed_title = format!("Speed {} m/s", range(options.speed_range));
    let mut beside = View::of_crowd(&speed_title, content)
        .with(bars::SPEED)
        .colored_by(crowd::SPEED_COLORS)
        .add(properties, &shown);
    if content.has_stages {
        let stage = View::of_crowd("Stage of the journey", content)
            .colored_by(crowd::STAGE_COLORS)
            .add(properties, &options.view);
        beside = Tabs::new([stage, beside]).into();
    }
    if content.has_levels {
        let building = Spatial3DView::new("Building")
            .with_origin(format!("/{}", building::ENTITY))
            .with_contents([format!("+ /{}/**", building::ENTITY)]);
        beside = Tabs::new([building.into(), beside]).into();
    }
    match arrangement {
        Arrangement::Wide => Vertical::new([density, beside]).into(),
        _ => Horizontal::new([density, beside]).into(),
    }
}

/// A tab for each followed agent, the one of the opening moment first: its view beside what `beside` shows of the agent
/// with this name.
fn followed(
    properties: &mut Vec<Property>,
    opening: Opening,
    content: &Content,
    beside: fn(&str) -> ContainerLike,
) -> Vec<ContainerLike> {
    let first = match opening {
        Opening::Whole(first) => first.unwrap_or(0),
        _ => 0,
    };
    let mut order: Vec<usize> = (0..content.followed.len()).collect();
    order.sort_by_key(|&k| k != first);
    let tab = |k: usize| {
        let name = &content.followed[k];
        let (title, tab) = match name.parse::<u32>() {
            Ok(id) => (format!("agent {id}"), format!("Agent {id}")),
            Err(_) => ("the densest agent".to_owned(), "Densest agent".to_owned()),
        };
        let view = View::of_crowd(&format!("Forces on {title}"), content)
            .following(&focus::entity(name))
            .dimmed()
            .add(properties, &focus::region());
        let halves = Horizontal::new([view, beside(name)]);
        let both = match content.kind {
            Kind::Moment => halves.with_column_shares([5.0, 4.0]),
            _ => halves,
        };
        both.with_name(tab).into()
    };
    order.into_iter().map(tab).collect()
}

/// The followed agents with their forces over time, all debug agents, plots and texts.
fn rest(
    properties: &mut Vec<Property>,
    (options, arrangement): (&RecordingOptions, Arrangement),
    opening: Opening,
    content: &Content,
) -> ContainerLike {
    let others = [plots(content), texts(content)];
    if content.followed.is_empty() {
        return Horizontal::new(others).into();
    }
    let mut tabs = followed(properties, opening, content, |name| {
        let forces = format!("/{}", focus::forces(name));
        plot("Accelerations [m/s²]", &forces)
    });
    let everywhere = View::of_crowd("All debug agents", content)
        .with("world/debug")
        .dimmed()
        .add(properties, &options.view);
    tabs.push(everywhere);
    let agents = Tabs::new(tabs).into();
    if arrangement == Arrangement::Tall {
        return Vertical::new([agents, Horizontal::new(others).into()]).into();
    }
    let [plots, texts] = others;
    Horizontal::new([agents, plots, texts])
        .with_column_shares([9.0, 4.0, 4.0])
        .into()
}

/// Each agent beside the table of its forces.
fn moment(properties: &mut Vec<Property>, opening: Opening, content: &Content) -> ContainerLike {
    let mut tabs = followed(properties, opening, content, |name| {
        document("Numbers", &moment::entity(name))
    });
    tabs.push(texts(content));
    Tabs::new(tabs).into()
}

/// A blueprint of rerun 0.36 cannot set the current time, but a playing loop starts at its own start, so the loop
/// begins at `opens_at`.
fn time_panel(options: &RecordingOptions, opening: Opening) -> TimePanel {
    let panel = TimePanel::new()
        .with_state(PanelState::Collapsed)
        .with_timeline(SIM_TIME);
    if opening == Opening::Live {
        return panel.with_play_state(PlayState::Following);
    }
    let latest = (options.ends_at - SHORTEST_LOOP).max(options.begins_at);
    let start = options.opens_at.unwrap_or(options.begins_at).min(latest);
    let end = (start + LOOP).min(options.ends_at);
    if opening == Opening::Empty || end <= start {
        return panel.with_play_state(PlayState::Paused);
    }
    let [start, end] = [start, end].map(TimeInt::from_secs);
    panel
        .with_time_selection(start..=end)
        .with_loop_mode(LoopMode::Selection)
        .with_play_state(PlayState::Playing)
}

fn plot(name: &str, origin: &str) -> ContainerLike {
    TimeSeriesView::new(name).with_origin(origin).into()
}

fn plots(content: &Content) -> ContainerLike {
    let stack = |name: &str, plots: [ContainerLike; 2]| Vertical::new(plots).with_name(name).into();
    let density = plot("Density", "/stats/density");
    let motion = stack(
        "Density and speed",
        [density, plot("Mean speed", "/stats/speed")],
    );
    let agents = plot("Agents", "/stats/crowd");
    if content.kind == Kind::Measurement {
        return Tabs::new([motion, agents]).into();
    }
    let energy = plot("Kinetic energy", "/stats/energy");
    let crowd = stack("Agents and energy", [agents, energy]);
    let of_places = || {
        let of = |what: &str| format!("/stats/places/{what}");
        let present = (content.has_waiting)
            .then(|| plot("Agents in queues and waiting areas", &of(stats::PRESENT)));
        let passed = plot("Agents that have passed exits", &of(stats::PASSED));
        let plots = present.into_iter().chain([passed]);
        Vertical::new(plots).with_name("Places").into()
    };
    let places = content.has_journeys.then(of_places);
    let time = plot("Computing time", "/stats/time");
    let charts = content.lines.iter();
    let lines = charts.map(|of| plot(of.title, &format!("/{}", of.series)));
    Tabs::new(places.into_iter().chain(lines).chain([motion, crowd, time])).into()
}

fn document(name: &str, entity: &str) -> ContainerLike {
    let view = TextDocumentView::new(name);
    view.with_origin(format!("/{entity}")).into()
}

fn texts(content: &Content) -> ContainerLike {
    let events = || TextLogView::new("Events").with_origin(format!("/{}", events::ENTITY));
    match content.kind {
        Kind::Run => Tabs::new([
            document("Scenario", text::DOCUMENT),
            events().into(),
            document("Results", text::RESULTS),
        ])
        .into(),
        Kind::Moment => document("Scenario", text::DOCUMENT),
        Kind::Measurement => document("Measurement", text::DOCUMENT),
    }
}
