//! Views of the plane, and their properties that rerun's blueprint has no setters for.

use rerun::blueprint::components::{BackgroundKind, VisualBounds2D as Bounds};
use rerun::blueprint::{
    ContainerLike, Spatial2DView, VisualizableArchetype as _, Visualizer,
    VisualizerComponentMapping,
};
use rerun::external::re_sdk_types::blueprint::archetypes::{
    Background, EntityBehavior, VisualBounds2D,
};
use rerun::{AsComponents, EntityPath, Points2D};

use super::Content;
use crate::recording::draw::color;
use crate::recording::frame::crowd;
use crate::recording::scene::obstacles;
use engine::scene::Region;
use figures::colors::Rgb;

/// Color of the crowd where it is only the background.
const DIM: Rgb = [72, 77, 95];

/// A view property without a setter: its entity and its value.
pub type Property = (EntityPath, Box<dyn AsComponents>);

/// A view of the crowd.
pub struct View<'a> {
    name: String,
    origin: String,
    contents: Vec<String>,
    crowd: Option<Visualizer>,
    content: &'a Content,
}

impl<'a> View<'a> {
    /// The crowd colored by density, with walls, places and routes.
    pub fn of_crowd(name: &str, content: &'a Content) -> Self {
        let mut contents = vec![
            "+ /world/geometry/**".to_owned(),
            format!("+ /{}", crowd::ENTITY),
        ];
        contents.extend((!content.fields.is_empty()).then(|| "+ /world/routes/**".to_owned()));
        let lines = content.lines.iter();
        contents.extend(lines.map(|of| format!("+ /{}", of.entity)));
        Self {
            name: name.to_owned(),
            origin: "/".to_owned(),
            contents,
            crowd: None,
            content,
        }
    }

    /// With an entity and those below it.
    pub fn with(mut self, entity: &str) -> Self {
        self.contents.push(format!("+ /{entity}/**"));
        self
    }

    /// Seen from a moving entity, with those below it.
    pub fn following(mut self, entity: &str) -> Self {
        self.origin = format!("/{entity}");
        self.with(entity)
    }

    /// The crowd with the colors of a component.
    pub fn colored_by(mut self, component: &str) -> Self {
        let colors = Points2D::descriptor_colors().component;
        let mapping = VisualizerComponentMapping::new_source_component(colors, component);
        let points = Points2D::update_fields().visualizer();
        self.crowd = Some(points.with_mappings(vec![mapping.into()]));
        self
    }

    /// The crowd in a single dark color, so that arrows stand out.
    pub fn dimmed(mut self) -> Self {
        let points = Points2D::update_fields().with_colors([color(DIM)]);
        self.crowd = Some(points.visualizer());
        self
    }

    /// The view, showing this part of the plane, as y up and relative to its origin.
    pub fn add(self, properties: &mut Vec<Property>, shown: &Region) -> ContainerLike {
        let mut plane = Spatial2DView::new(self.name)
            .with_origin(self.origin)
            .with_contents(self.contents);
        if let Some(crowd) = self.crowd {
            plane = plane.with_overrides(crowd::ENTITY, [crowd]);
        }
        let view = ContainerLike::from(plane);
        let ContainerLike::View(own) = &view else {
            return view;
        };
        let path = own.blueprint_path();
        let properties_of = |name: &str| path.join(&EntityPath::from(name));
        // The picture is flipped: y up in meters is y down on the screen.
        let bounds = VisualBounds2D::new(Bounds(rerun::datatypes::Range2D {
            x_range: [shown.min.x, shown.max.x].into(),
            y_range: [-shown.max.y, -shown.min.y].into(),
        }));
        properties.push((properties_of("VisualBounds2D"), Box::new(bounds)));
        let ground = match self.content.has_outside {
            true => obstacles::OUTSIDE,
            false => obstacles::GROUND,
        };
        let background = Background::new(BackgroundKind::SolidColor).with_color(color(ground));
        properties.push((properties_of("Background"), Box::new(background)));
        let mut behave = |entity: &EntityPath, behavior: EntityBehavior| {
            let overrides = properties_of("ViewContents/overrides").join(entity);
            let own = overrides.join(&EntityPath::from("visualizers"));
            properties.push((own, Box::new(behavior)));
        };
        // The image would swallow clicks.
        let silent = EntityBehavior::new().with_interactive(false);
        behave(&EntityPath::from(obstacles::ENTITY), silent);
        for entity in &self.content.fields {
            behave(entity, EntityBehavior::new().with_visible(false));
        }
        view
    }
}
