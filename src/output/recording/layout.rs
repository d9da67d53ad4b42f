//! The layout that a recording opens with: views of the crowd and of single agents, plots, texts.

use rerun::EntityPath;
use rerun::blueprint::components::{LoopMode, PanelState, PlayState};
use rerun::blueprint::{
    Blueprint, BlueprintPanel, ContainerLike, Horizontal, SelectionPanel, Tabs, TextDocumentView,
    TextLogView, TimePanel, TimeSeriesView, Vertical,
};
use rerun::external::re_log_types::TimeInt;

use super::views::{Property, View};
use super::{
    RecordingOptions, SIM_TIME, bars, crowd, events, focus, moment, places, text, wall_forces,
};
use crate::analysis::round::brief;
use crate::engine::math::Vector;
use crate::engine::scene::Region;

/// Length of the loop that plays first, seconds.
const LOOP: f64 = 10.0;
/// The loop begins before the opening moment if less than this is left of the run, seconds.
const SHORTEST_LOOP: f64 = 2.0;

/// The usual size of the viewer without its panels, pixels, and the height of a view's title.
const WINDOW: [f64; 2] = [1300.0, 800.0];
const TITLE: f64 = 24.0;
/// An arrangement is clearly better than another if it shows the crowd this many times as large.
const CLEARLY: f64 = 1.15;

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
    /// The entities with the lengths of ways, which are hidden at first.
    pub fields: Vec<EntityPath>,
    /// Whether walls are colored by the force on them.
    pub has_wall_forces: bool,
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
            fields: Vec::new(),
            has_wall_forces: false,
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
    let agents = followed(all, opening, content);
    let root = match content.kind {
        Kind::Moment => moment(agents, content),
        _ => {
            let arrangement = Arrangement::of(&options.view);
            let crowds = crowds(all, options, arrangement, content);
            let rest = rest(all, (options, arrangement), agents, content);
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

/// The positions of the two views of the whole crowd.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Arrangement {
    /// Side by side above the rest.
    Columns,
    /// One above the other, above the rest: for wide plans.
    Wide,
    /// Side by side, left of the rest: for tall plans.
    Tall,
}

impl Arrangement {
    /// The arrangement in which this part of the plane is largest, but columns unless another is clearly better.
    fn of(view: &Region) -> Self {
        let shown = bars::with_bar(view);
        let scale = |other: &Self| {
            let extent = shown.max - shown.min;
            Vector::from(other.panel()).component_div(&extent).min()
        };
        let better = |other: &Self| scale(other) > CLEARLY * scale(&Self::Columns);
        let mut others = [Self::Wide, Self::Tall].into_iter();
        others.find(better).unwrap_or(Self::Columns)
    }

    /// The heights of the views of the whole crowd and of the rest.
    fn row_shares(self) -> [f32; 2] {
        match self {
            Self::Wide => [13.0, 8.0],
            _ => [11.0, 10.0],
        }
    }

    /// The usual width and height of a view of the whole crowd, pixels.
    fn panel(self) -> [f64; 2] {
        let [width, height] = WINDOW;
        let [crowds, rest] = self.row_shares().map(f64::from);
        let above = height * crowds / (crowds + rest);
        match self {
            Self::Columns => [0.5 * width, above - TITLE],
            Self::Wide => [width, 0.5 * above - TITLE],
            Self::Tall => [0.25 * width, height - TITLE],
        }
    }
}

/// The usual width and height of a view of the whole crowd, pixels.
pub fn panel(view: &Region) -> [f64; 2] {
    Arrangement::of(view).panel()
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
    let density = format!("Density {} P/m²", range(options.density_range));
    let density = View::of_crowd(&density, content)
        .with(bars::DENSITY)
        .add(properties, &shown);
    let speed = format!("Speed {} m/s", range(options.speed_range));
    let speed = View::of_crowd(&speed, content)
        .with(bars::SPEED)
        .colored_by(crowd::SPEED_COLORS)
        .add(properties, &shown);
    let mut beside = speed;
    if content.has_stages {
        let stage = View::of_crowd("Stage of the journey", content)
            .colored_by(crowd::STAGE_COLORS)
            .add(properties, &options.view);
        beside = Tabs::new([stage, beside]).into();
    }
    match arrangement {
        Arrangement::Wide => Vertical::new([density, beside]).into(),
        _ => Horizontal::new([density, beside]).into(),
    }
}

/// The views of the followed agents, the one of the opening moment first; each with its view and its name.
fn followed(
    properties: &mut Vec<Property>,
    opening: Opening,
    content: &Content,
) -> Vec<(String, ContainerLike)> {
    let first = match opening {
        Opening::Whole(first) => first.unwrap_or(0),
        _ => 0,
    };
    let mut order: Vec<usize> = (0..content.followed.len()).collect();
    order.sort_by_key(|&k| k != first);
    let names = order.into_iter().map(|k| &content.followed[k]);
    let view = |name: &String| {
        let title = match name.parse::<u32>() {
            Ok(id) => format!("Forces on agent {id}"),
            Err(_) => "Forces on the densest agent".to_owned(),
        };
        let view = View::of_crowd(&title, content)
            .following(&focus::entity(name))
            .dimmed()
            .add(properties, &focus::region());
        (name.clone(), view)
    };
    names.map(view).collect()
}

/// The followed agents with their forces over time, all debug agents, plots and texts.
fn rest(
    properties: &mut Vec<Property>,
    (options, arrangement): (&RecordingOptions, Arrangement),
    agents: Vec<(String, ContainerLike)>,
    content: &Content,
) -> ContainerLike {
    let others = [plots(content), texts(content)];
    if agents.is_empty() {
        return Horizontal::new(others).into();
    }
    let beside = |(name, view): (String, ContainerLike)| {
        let series = plot(
            "Accelerations [m/s²]",
            &format!("/{}", focus::forces(&name)),
        );
        let both = Horizontal::new([view, series]);
        both.with_name(in_words(&name)).into()
    };
    let mut tabs: Vec<ContainerLike> = agents.into_iter().map(beside).collect();
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

/// The name of a followed agent's tab.
fn in_words(name: &str) -> String {
    match name.parse::<u32>() {
        Ok(id) => format!("Agent {id}"),
        Err(_) => "Densest agent".to_owned(),
    }
}

/// Each agent beside the table of its forces.
fn moment(agents: Vec<(String, ContainerLike)>, content: &Content) -> ContainerLike {
    let beside = |(name, view): (String, ContainerLike)| {
        let table =
            TextDocumentView::new("Numbers").with_origin(format!("/{}", moment::entity(&name)));
        let beside = Horizontal::new([view, table.into()]).with_column_shares([5.0, 4.0]);
        beside.with_name(in_words(&name)).into()
    };
    let mut tabs: Vec<ContainerLike> = agents.into_iter().map(beside).collect();
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
    let places = || {
        let of = |what: &str| format!("/stats/places/{what}");
        let present = (content.has_waiting)
            .then(|| plot("Agents in queues and waiting areas", &of(places::PRESENT)));
        let passed = plot("Agents that have passed exits", &of(places::PASSED));
        let plots = present.into_iter().chain([passed]);
        Vertical::new(plots).with_name("Places").into()
    };
    let places = content.has_journeys.then(places);
    let time = plot("Computing time", "/stats/time");
    let series = format!("/{}", wall_forces::SERIES);
    let forces = (content.has_wall_forces).then(|| plot("Force on walls", &series));
    let first = places.into_iter().chain(forces);
    Tabs::new(first.chain([motion, crowd, time])).into()
}

fn texts(content: &Content) -> ContainerLike {
    let document = |name: &str, entity: &str| -> ContainerLike {
        let view = TextDocumentView::new(name);
        view.with_origin(format!("/{entity}")).into()
    };
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plans_of_any_shape_fill_most_of_their_views() {
        for (aspect, expected) in [
            (0.25, Some(Arrangement::Tall)),
            (0.7, None),
            (1.0, Some(Arrangement::Columns)),
            (2.0, Some(Arrangement::Columns)),
            (3.5, None),
            (5.0, Some(Arrangement::Wide)),
            (8.0, Some(Arrangement::Wide)),
        ] {
            let (min, max) = (Vector::zeros(), Vector::new(10.0 * aspect, 10.0));
            let view = Region { min, max };
            let chosen = Arrangement::of(&view);
            assert!(
                expected.is_none_or(|one| one == chosen),
                "{aspect}: {chosen:?}"
            );
            let extent = bars::with_bar(&view).max;
            let filled = |arrangement: Arrangement| {
                let parts = extent.component_div(&Vector::from(arrangement.panel()));
                parts.min() / parts.max()
            };
            assert!(filled(chosen) > 0.45, "{aspect}: {}", filled(chosen));
            assert!(filled(Arrangement::Columns) > 0.45 || chosen != Arrangement::Columns);
        }
    }
}
