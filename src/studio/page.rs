//! The page: the viewer of pages, and what is added to it here.

use output::html::{END, Head};
use output::page::{BODY, SCRIPT, STYLE};

const OWN_STYLE: &str = include_str!("page/studio.css");
const OWN_BODY: &str = include_str!("page/studio.html");
const OWN_SCRIPT: &str = concat!(
    include_str!("page/server.js"),
    include_str!("page/live.js"),
    include_str!("page/play.js"),
    include_str!("page/tools.js"),
    include_str!("page/brushes.js"),
    include_str!("page/doors.js"),
    include_str!("page/shapes.js"),
    include_str!("page/sheet.js"),
    include_str!("page/hand.js"),
    include_str!("page/pencils.js"),
    include_str!("page/draw.js"),
    include_str!("page/schema.js"),
    include_str!("page/forms.js"),
    include_str!("page/elements.js"),
    include_str!("page/start.js"),
);
/// Beside what is in the page, it asks its own server.
const ALLOWED: &str = "; connect-src 'self'; base-uri 'none'; form-action 'none'";

/// The whole page.
pub fn text() -> String {
    let script = format!("{SCRIPT}{OWN_SCRIPT}");
    let style = format!("{STYLE}{OWN_STYLE}");
    let head = Head {
        title: "sandbox studio",
        style: &style,
        script: &script,
        allowed: ALLOWED,
    };
    let viewer = BODY.replace("{title}", "").replace("{description}", "");
    head.text() + &OWN_BODY.replace("{viewer}", &viewer) + END
}
