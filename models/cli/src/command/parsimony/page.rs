//! All of it as one HTML page that needs no other file.

use core::fmt::Write as _;

use super::summary::{Summary, cells, price_cells};
use crate::command::html::{END, begin, escaped, inline, table};

/// What the page tells.
pub(super) struct Page<'a> {
    pub(super) command: String,
    pub(super) machine: String,
    pub(super) images: usize,
    pub(super) seconds: f64,
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
        let mut html = begin("dvp: no more than a scene needs", "No more than a scene needs");
        html += &format!(
            "<p><code>{}</code><br>{}; {} images; {:.0} s in all.</p>\n",
            escaped(&self.command),
            escaped(&self.machine),
            self.images,
            self.seconds
        );
        html += "<p>Asked for and not met:</p><ul>\n";
        for line in self.misses {
            // A string takes all that is written to it.
            let _ = writeln!(html, "<li>{}</li>", escaped(line));
        }
        let _ = writeln!(html, "</ul>\n<h2>Methods</h2>\n<p>{METHODS}</p>");
        html += &table(&cells(self.methods));
        let _ = writeln!(html, "<figure>{}</figure>\n<h2>Prices</h2>\n<p>{PRICES}</p>", inline(self.chart));
        html += &table(&price_cells(self.prices));
        html + END
    }
}
