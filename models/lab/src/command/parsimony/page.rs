//! All of it as one HTML page that needs no other file.

use maud::html;

use super::summary::{Summary, cells, price_cells};
use crate::command::report::{Run, drawing, page, table};

/// What the page tells.
pub(super) struct Page<'a> {
    pub(super) run: Run,
    pub(super) methods: &'a [Summary],
    pub(super) prices: &'a [Summary],
    /// What is asked for and not met.
    pub(super) misses: &'a [String],
    /// SVG.
    pub(super) chart: &'a str,
}

/// How to read the tables.
const METHODS: &str = "In brackets: the true scene, by the same law. Shapes by bank: the choice among its shapes; free: \
    written out, true shapes with the fewest harmonics that pay, once for all objects that have them (unshared: against a true \
    scene that writes each of them). count, of 0: share of the images with and without objects in which the number found is \
    right; surplus, missing: objects per image without a partner of an IoU of 0.5 or more; painted: objects with those of little \
    confidence. with rest: bits of the scene and of what it leaves of the image, over the same of the true scene. The numbers of \
    other programs are coordinates of paths, of which the first is the background; they see 8 bits, the methods float pixels.";
const PRICES: &str = "Segment-and-fit with one price set to nothing: of an object, of a harmonic, of the boundary between two \
    regions (of pictures with noise), and without asking objects of the mean color of two others to pay. Twins are two objects of one \
    shape and color whose outlines cross. Bits and rest are \
    counted at the usual prices.";

impl Page<'_> {
    pub(super) fn to_html(&self) -> String {
        let body = html! {
            (self.run.paragraph(""))
            p { "Asked for and not met:" }
            ul { @for line in self.misses { li { (line) } } }
            h2 { "Methods" }
            p { (METHODS) }
            (table(&cells(self.methods)))
            figure { (drawing(self.chart)) }
            h2 { "Prices" }
            p { (PRICES) }
            (table(&price_cells(self.prices)))
        };
        page("dvp: no more than a scene needs", "No more than a scene needs", &body)
    }
}
