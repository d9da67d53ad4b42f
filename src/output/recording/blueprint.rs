//! The layout that a recording opens with: two views of the crowd, a view of the debug agents, plots, text.

use rerun::blueprint::components::{
    BackgroundKind, LoopMode, PanelState, PlayState, VisualBounds2D as Bounds,
};
use rerun::blueprint::{
    Blueprint, BlueprintActivation, BlueprintPanel, ContainerLike, Horizontal, SelectionPanel,
    Spatial2DView, Tabs, TextDocumentView, TextLogView, TimePanel, TimeSeriesView, Vertical,
    VisualizableArchetype as _, Visualizer, VisualizerComponentMapping,
};
use rerun::external::re_log_types::{BlueprintActivationCommand, LogMsg, StoreKind, TimeInt};
use rerun::external::re_sdk_types::blueprint::archetypes::{
    Background, EntityBehavior, VisualBounds2D,
};
use rerun::{AsComponents, Color, EntityPath, Points2D, RecordingStream, RecordingStreamBuilder};

use super::error::Cause;
use super::{
    APPLICATION, DebugAgents, RecordingOptions, SIM_TIME, crowd, geometry, places, text,
    wall_forces,
};
use crate::engine::scene::Region;

/// Length of the loop that plays first, seconds.
const LOOP: f64 = 10.0;
const BACKGROUND: [u8; 3] = [22, 23, 29];
/// Light enough to show agents at rest, which are black.
const SPEED_BACKGROUND: [u8; 3] = [72, 75, 88];
/// Color of the crowd where it is only the background.
const DIM: [u8; 3] = [64, 68, 84];

/// A view property without a setter in rerun's blueprint: its entity and its value.
type Property = (EntityPath, Box<dyn AsComponents>);

/// The state of a recording, on which its layout depends.
#[derive(Debug, Clone, Copy)]
pub enum Opening {
    /// No data yet: the viewer is paused at the start.
    Empty,
    /// The viewer follows the incoming data.
    Live,
    /// The recording is complete: a loop from `opens_at` plays. The debug view shows this region, or, if `None`, the
    /// region of the crowd views. The layout is sent last, because the viewer cannot jump to a time that it has not
    /// read yet.
    Whole(Option<Region>),
}

/// The kind of data shown.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Content {
    /// A simulation.
    Run(Journeys),
    /// A measured crowd, without energy or computing time.
    Measurement,
}

/// What a recording has of journeys, ways and forces on walls.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Journeys {
    /// Do agents visit places?
    pub begin: bool,
    /// The entities with the lengths of ways, which are hidden at first.
    pub fields: Vec<EntityPath>,
    /// Are walls colored by the force on them?
    pub wall_forces: bool,
}

/// Sends the default blueprint.
pub fn send(
    stream: &RecordingStream,
    options: &RecordingOptions,
    opening: Opening,
    content: &Content,
) -> Result<(), Cause> {
    let (blueprint, properties) = layout(options, opening, content);
    let (memory, storage) = RecordingStreamBuilder::new(APPLICATION)
        .send_properties(false)
        .memory()?;
    let activation = BlueprintActivation {
        make_active: true,
        make_default: true,
    };
    blueprint.send(&memory, activation)?;
    let own = |message: &LogMsg| {
        message.store_id().kind() == StoreKind::Blueprint
            && !matches!(message, LogMsg::BlueprintActivationCommand(_))
    };
    let mut messages: Vec<LogMsg> = storage.take().into_iter().filter(own).collect();
    let Some(id) = messages.first().map(|message| message.store_id().clone()) else {
        return Ok(());
    };
    let (extra, extra_storage) = RecordingStreamBuilder::from_store_id(&id)
        .send_properties(false)
        .memory()?;
    extra.set_time_sequence("blueprint", 0);
    for (entity, value) in &properties {
        extra.log(entity.clone(), value.as_ref())?;
    }
    let is_data = |message: &LogMsg| matches!(message, LogMsg::ArrowMsg(..));
    messages.extend(extra_storage.take().into_iter().filter(is_data));
    let activation = BlueprintActivationCommand {
        blueprint_id: id,
        make_active: true,
        make_default: true,
    };
    stream.send_blueprint(messages, activation);
    Ok(())
}

fn layout(
    options: &RecordingOptions,
    opening: Opening,
    content: &Content,
) -> (Blueprint, Vec<Property>) {
    let geometry = "+ /world/geometry/**";
    let agents = format!("+ /{}", crowd::ENTITY);
    let none = Journeys::default();
    let journeys = match content {
        Content::Run(journeys) => journeys,
        Content::Measurement => &none,
    };
    let hidden = journeys.fields.as_slice();
    let ways = (!hidden.is_empty()).then_some("+ /world/ways/**");
    let pressed = (journeys.wall_forces).then(|| format!("+ /{}", wall_forces::ENTITY));
    let ways = || ways.into_iter().chain(pressed.as_deref());
    let crowd = |name: &str| {
        Spatial2DView::new(name)
            .with_origin("/")
            .with_contents([geometry, agents.as_str()].into_iter().chain(ways()))
    };
    let by_density = crowd("Density 0–8 P/m²").into();
    let by_speed = crowd("Speed 0–1.8 m/s")
        .with_overrides(crowd::ENTITY, [colors_of(crowd::SPEED_COLORS)])
        .into();
    let mut properties = Vec::new();
    let all = &mut properties;
    add_properties(all, &by_density, (&options.view, BACKGROUND), hidden);
    add_properties(all, &by_speed, (&options.view, SPEED_BACKGROUND), hidden);
    let mut beside: ContainerLike = by_speed;
    if journeys.begin {
        let by_stage = crowd("Stage of the journey")
            .with_overrides(crowd::ENTITY, [colors_of(crowd::STAGE_COLORS)])
            .into();
        add_properties(all, &by_stage, (&options.view, BACKGROUND), hidden);
        beside = Tabs::new([by_stage, beside]).into();
    }
    let mut below = Vec::new();
    if options.debug != DebugAgents::None {
        let forces = Spatial2DView::new("Forces")
            .with_origin("/")
            .with_contents(
                [geometry, agents.as_str(), "+ /world/debug/**"]
                    .into_iter()
                    .chain(ways()),
            )
            .with_overrides(crowd::ENTITY, [dim_colors()])
            .into();
        let shown = match opening {
            Opening::Whole(Some(focus)) => focus,
            _ => options.view,
        };
        add_properties(&mut properties, &forces, (&shown, BACKGROUND), hidden);
        below.push(forces);
    }
    below.extend([plots(content), texts(content)]);
    let root = Vertical::new([
        Horizontal::new([by_density, beside]).into(),
        Horizontal::new(below).into(),
    ])
    .with_row_shares([3.0, 2.0]);
    let blueprint = Blueprint::new(root)
        .with_auto_views(false)
        .with_auto_layout(false)
        .with_blueprint_panel(BlueprintPanel::from_state(PanelState::Collapsed))
        .with_selection_panel(SelectionPanel::from_state(PanelState::Collapsed))
        .with_time_panel(time_panel(options, opening));
    (blueprint, properties)
}

/// A blueprint of rerun 0.36 cannot set the current time, but a playing loop starts at its own start, so the loop
/// begins at `opens_at`.
fn time_panel(options: &RecordingOptions, opening: Opening) -> TimePanel {
    let panel = TimePanel::new()
        .with_state(PanelState::Collapsed)
        .with_timeline(SIM_TIME);
    let start = options.opens_at;
    let end = (start + LOOP).min(options.ends_at);
    if matches!(opening, Opening::Live) {
        return panel.with_play_state(PlayState::Following);
    }
    if matches!(opening, Opening::Empty) || end <= start {
        return panel.with_play_state(PlayState::Paused);
    }
    let [start, end] = [start, end].map(TimeInt::from_secs);
    panel
        .with_time_selection(start..=end)
        .with_loop_mode(LoopMode::Selection)
        .with_play_state(PlayState::Playing)
}

/// The crowd's points with the colors of a component.
fn colors_of(component: &str) -> Visualizer {
    let colors = Points2D::descriptor_colors().component;
    let mapping = VisualizerComponentMapping::new_source_component(colors, component);
    Points2D::update_fields()
        .visualizer()
        .with_mappings(vec![mapping.into()])
}

/// The crowd's points in a single dark color, so that arrows stand out.
fn dim_colors() -> Visualizer {
    let [r, g, b] = DIM;
    Points2D::update_fields()
        .with_colors([Color::from_rgb(r, g, b)])
        .visualizer()
}

fn plots(content: &Content) -> ContainerLike {
    let plot = |name: &str, origin: &str| TimeSeriesView::new(name).with_origin(origin).into();
    let both = |name: &str, plots: [ContainerLike; 2]| Vertical::new(plots).with_name(name).into();
    let density = plot("Density", "/stats/density");
    let motion = both(
        "Density and speed",
        [density, plot("Mean speed", "/stats/speed")],
    );
    let agents = plot("Agents", "/stats/crowd");
    let Content::Run(journeys) = content else {
        return Tabs::new([motion, agents]).into();
    };
    let energy = plot("Kinetic energy", "/stats/energy");
    let crowd = both("Agents and energy", [agents, energy]);
    let places = || {
        let of = |what: &str| format!("/stats/places/{what}");
        let present = plot("Agents in queues and waiting areas", &of(places::PRESENT));
        let passed = plot("Agents that have passed exits", &of(places::PASSED));
        both("Places", [present, passed])
    };
    let places = journeys.begin.then(places);
    let time = plot("Computing time", "/stats/time");
    let series = format!("/{}", wall_forces::SERIES);
    let forces = (journeys.wall_forces).then(|| plot("Force on walls", &series));
    let first = places.into_iter().chain(forces);
    Tabs::new(first.chain([motion, crowd, time])).into()
}

fn texts(content: &Content) -> ContainerLike {
    let document = |name: &str| -> ContainerLike {
        let origin = format!("/{}", text::DOCUMENT);
        TextDocumentView::new(name).with_origin(origin).into()
    };
    if *content == Content::Measurement {
        return document("Measurement");
    }
    Tabs::new([
        document("Scenario"),
        TextLogView::new("Events").with_origin("/log").into(),
    ])
    .into()
}

/// Sets zoom and background, makes the obstacle image ignore clicks, which it would otherwise swallow, and hides
/// entities until their eye icon is clicked.
fn add_properties(
    properties: &mut Vec<Property>,
    view: &ContainerLike,
    (shown, [r, g, b]): (&Region, [u8; 3]),
    hidden: &[EntityPath],
) {
    let ContainerLike::View(view) = view else {
        return;
    };
    // The picture is flipped: y up in meters is y down on the screen.
    let bounds = VisualBounds2D::new(Bounds(rerun::datatypes::Range2D {
        x_range: [shown.min.x, shown.max.x].into(),
        y_range: [-shown.max.y, -shown.min.y].into(),
    }));
    let background = Background::new(BackgroundKind::SolidColor);
    let background = background.with_color(Color::from_rgb(r, g, b));
    let obstacles = format!("ViewContents/overrides/{}/visualizers", geometry::OBSTACLES);
    let silent = EntityBehavior::new().with_interactive(false);
    let own: [(&str, Box<dyn AsComponents>); 3] = [
        ("VisualBounds2D", Box::new(bounds)),
        ("Background", Box::new(background)),
        (&obstacles, Box::new(silent)),
    ];
    let path = view.blueprint_path();
    properties.extend(own.map(|(name, value)| (path.join(&EntityPath::from(name)), value)));
    for entity in hidden {
        let overrides = path.join(&EntityPath::from("ViewContents/overrides"));
        let own = overrides
            .join(entity)
            .join(&EntityPath::from("visualizers"));
        let behavior = EntityBehavior::new().with_visible(false);
        properties.push((own, Box::new(behavior)));
    }
}
