//! The routes to a place or a point, as `--paths` names them.

use std::sync::Arc;

use serde_json::json;

use crate::cli::failure::Failure;
use engine::math::Vector;
use engine::routes::{Destination, Routes};
use output::drawing::Drawing;
use output::picture::Paths;
use scenario::quote::shown;
use scenario::{Scenario, WayFinding, suggestion};

/// The routes to the place or point that `text` names; a point of a building lies on the only level of `drawing`.
pub fn paths(text: &str, scenario: &Scenario, drawing: Option<&Drawing>) -> Result<Paths, Failure> {
    let refused = |reason: String| Failure::Input(format!("--paths {}: {reason}", shown(text)));
    let scene = &scenario.scene;
    let places = &scene.journeys.places;
    let place = places.iter().position(|place| place.name == text);
    let point = point(text);
    if place.is_none() && point.is_none() {
        return Err(refused(unknown(text, scenario)));
    }
    let Some(routes) = &scene.routes else {
        let straight = scenario.document["navigation"] == json!(WayFinding::Straight);
        let reason = match straight {
            true => "`navigation` is `straight`, so agents follow no routes; set it to `paths`",
            false => "the scenario has neither walls nor journeys, so agents walk straight",
        };
        return Err(refused(reason.to_owned()));
    };
    let on_level = drawing.map_or(Some(Vector::zeros()), Drawing::to_plane);
    let Some(to_plane) = on_level.or(place.map(|_| Vector::zeros())) else {
        return Err(refused(
            "a point of a building lies on a level: add --level NAME".to_owned(),
        ));
    };
    let (name, to) = match (place, point) {
        (Some(k), _) => {
            let name = format!("{} {}", places[k].kind.name(), places[k].name);
            (name, Destination::Place(k as u16))
        }
        (None, point) => {
            let point = point.unwrap_or_default();
            (
                format!("({}, {})", point.x, point.y),
                Destination::Goal(point + to_plane),
            )
        }
    };
    let is_known = routes.leads_to(to);
    let (routes, to) = match is_known {
        true => (Arc::clone(routes), to),
        // No agent goes there, so the scene has no path map to it.
        false => {
            let goals: Vec<_> = place.map(|k| places[k].goals.clone()).into_iter().collect();
            let points = point.iter().map(|point| point + to_plane).collect();
            let extra = Routes::new(routes.floor.clone(), &goals, points)
                .map_err(|error| refused(format!("{error}; give a point that is")))?;
            let to = place.map_or(to, |_| Destination::Place(0));
            (Arc::new(extra), to)
        }
    };
    Ok(Paths {
        name,
        routes,
        to,
        place: place.map(|k| k as u16),
        is_known,
    })
}

/// Two numbers separated by a comma.
fn point(text: &str) -> Option<Vector> {
    let (x, y) = text.split_once(',')?;
    let [x, y] = [x, y].map(|number| number.trim().parse::<f64>().ok());
    let point = Vector::new(x?, y?);
    (point.x.is_finite() && point.y.is_finite()).then_some(point)
}

fn unknown(text: &str, scenario: &Scenario) -> String {
    let names = || {
        let places = scenario.scene.journeys.places.iter();
        places.map(|place| place.name.as_str())
    };
    let near = suggestion(text, names());
    let places: Vec<String> = names().map(|name| format!("`{}`", shown(name))).collect();
    let known = match places.as_slice() {
        [] => "the scenario has no places; give a point as X,Y".to_owned(),
        known => format!("there are {}, or give a point as X,Y", known.join(", ")),
    };
    format!("no such place{near}; {known}")
}
