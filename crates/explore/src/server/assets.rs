//! The page's files, built into the program.

/// A file of the page.
pub(super) struct Asset {
    pub(super) path: &'static str,
    pub(super) kind: &'static str,
    pub(super) text: &'static str,
}

macro_rules! assets {
    ($($name:literal: $kind:literal),+ $(,)?) => {
        &[$(Asset {
            path: concat!("/", $name),
            kind: $kind,
            text: include_str!(concat!("../../page/", $name)),
        }),+]
    };
}

/// All files but the page itself.
pub(super) static ASSETS: &[Asset] = assets![
    "style.css": "text/css; charset=utf-8",
    "icon.svg": "image/svg+xml",
    "app.js": "text/javascript; charset=utf-8",
    "charts.js": "text/javascript; charset=utf-8",
    "engine.js": "text/javascript; charset=utf-8",
    "files.js": "text/javascript; charset=utf-8",
    "fit.js": "text/javascript; charset=utf-8",
    "form.js": "text/javascript; charset=utf-8",
    "numbers.js": "text/javascript; charset=utf-8",
    "plots.js": "text/javascript; charset=utf-8",
    "row.js": "text/javascript; charset=utf-8",
    "scenes.js": "text/javascript; charset=utf-8",
    "story.js": "text/javascript; charset=utf-8",
    "transport.js": "text/javascript; charset=utf-8",
];

/// The page.
pub(super) const PAGE: &str = include_str!("../../page/index.html");
