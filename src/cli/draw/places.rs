//! What a floor plan names.

use serde_json::{Value, json};

use output::table::Table;
use scenario::floor_plan::{Form, Place};

/// The rows of the table: name, kind, form, size, and the rectangle around the place.
pub fn text(places: &[Place]) -> String {
    let low = |place: &Place| place.extent()[0];
    let high = |place: &Place| place.extent()[1];
    let table = Table::of(places)
        .column("place", |place| place.name.as_str())
        .column("kind", |place| place.kind.word())
        .column("size", size)
        .fixed("from x [m]", 2, move |place| low(place).x)
        .fixed("y [m]", 2, move |place| low(place).y)
        .fixed("to x [m]", 2, move |place| high(place).x)
        .fixed("y [m]", 2, move |place| high(place).y)
        .table();
    format!("\n{}", table.text())
}

/// The same as JSON.
pub fn json(places: &[Place]) -> Value {
    let json = |place: &Place| {
        let form = match place.form {
            Form::Area => "area",
            Form::Line => "line",
            Form::Point => "point",
        };
        let corners = place.extent().map(<[f64; 2]>::from);
        json!({
            "name": place.name, "kind": place.kind.word(), "form": form, "size": place.size(), "extent": corners,
        })
    };
    places.iter().map(json).collect()
}

fn size(place: &Place) -> String {
    let size = place.size();
    match place.form {
        Form::Area => format!("{size:.1} m²"),
        Form::Line => format!("{size:.2} m"),
        Form::Point => "a point".to_owned(),
    }
}
