//! The page for a browser.

use super::{Scene, document};
use crate::hanging::PredictError;

/// The page without a scene. `viewer/` builds it.
const TEMPLATE: &str = include_str!("page.html");
/// What the JSON of the scene replaces in the template.
const SCENE: &str = "__HANGPOSE_SCENE__";
/// What the title replaces in the template.
const TITLE: &str = "__HANGPOSE_TITLE__";

/// The page that shows a scene: HTML that needs nothing else.
///
/// The releases that it shows are simulated anew, so the object and the supporter must be those of the prediction.
pub fn page(scene: &Scene) -> Result<String, PredictError> {
    // No text of the JSON ends the script that holds it.
    let json = document::document(scene)?.to_string().replace('<', "\\u003c");
    let title = escaped(&format!("{} on {}", scene.object_name, scene.supporter_name));
    // The title comes first: the JSON may contain anything.
    Ok(TEMPLATE.replacen(TITLE, &title, 1).replacen(SCENE, &json, 1))
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}
