//! Everything as one HTML page that needs no other file.

use core::fmt::Write as _;

use super::renderers::Rendered;
use super::report::{Report, renderers_csv};
use crate::command::html::{END, begin, escaped, inline, table};

/// What the page tells.
pub(super) struct Page<'a> {
    pub(super) command: String,
    pub(super) machine: String,
    pub(super) images: usize,
    pub(super) seconds: f64,
    pub(super) report: &'a Report,
    pub(super) renderers: &'a [Rendered],
    /// SVG.
    pub(super) charts: &'a [String],
}

impl Page<'_> {
    pub(super) fn to_html(&self) -> String {
        let mut html = begin("dvp: speed against accuracy", "Speed against accuracy");
        html += &format!(
            "<p><code>{}</code><br>{}; one thread; {} images; {:.0} s in all.</p>\n",
            escaped(&self.command),
            escaped(&self.machine),
            self.images,
            self.seconds
        );
        html += "<ul>\n";
        for line in self.report.budgets() {
            // A string takes all that is written to it.
            let _ = writeln!(html, "<li>{}</li>", escaped(&line));
        }
        html += "</ul>\n";
        let captions = [
            "Numbers beside marks: steps of joint Levenberg-Marquardt or of Adam, for segment-free the most harmonics. Pale \
             marks: f64. The solid line is the Pareto front of what starts from the image alone; the dashed one that of \
             methods which were given a scene near the truth, and cannot be compared with the others. Bars are quartiles over \
             images. Hollow marks are published figures, on other hardware.",
            "As above, by which object owns which pixel. No error at all is drawn at the lower edge.",
            "Vertices with 64 harmonics, harmonics with 64 vertices, how far from an outline the soft edge is looked at; the fine \
             image has 1024 vertices, 64 harmonics and no cut. Exact and hard paint other edges by design.",
        ];
        for (svg, caption) in self.charts.iter().zip(captions) {
            let _ = writeln!(html, "<figure>{}<figcaption>{caption}</figcaption></figure>", inline(svg));
        }
        html += "<h2>Methods</h2>\n";
        html += &table(&self.report.cells());
        html += "<h2>Renderers</h2>\n";
        let csv = renderers_csv(self.renderers);
        html += &table(&csv.lines().map(|line| line.split(',').map(str::to_owned).collect()).collect::<Vec<_>>());
        html + END
    }
}
