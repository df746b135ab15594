//! Everything as one HTML page that needs no other file.

use maud::html;

use super::renderers::Rendered;
use super::report::{Report, renderer_cells};
use crate::command::report::{Run, drawing, page, table};

/// What the page tells.
pub(super) struct Page<'a> {
    pub(super) run: Run,
    pub(super) report: &'a Report,
    pub(super) renderers: &'a [Rendered],
    /// SVG.
    pub(super) charts: &'a [String],
}

/// What the charts show, in their order.
const CAPTIONS: [&str; 3] = [
    "Numbers beside marks: steps of joint Levenberg-Marquardt or of Adam, for segment-free the most harmonics. Pale \
     marks: f64. The solid line is the Pareto front of what starts from the image alone; the dashed one that of \
     methods which were given a scene near the truth, and cannot be compared with the others. Bars are quartiles over \
     images. Hollow marks are published figures, on other hardware.",
    "As above, by which object owns which pixel. No error at all is drawn at the lower edge.",
    "Vertices with 64 harmonics, harmonics with 64 vertices, how far from an outline the soft edge is looked at; the fine \
     image has 1024 vertices, 64 harmonics and no cut. Exact and hard paint other edges by design.",
];

impl Page<'_> {
    pub(super) fn to_html(&self) -> String {
        let body = html! {
            (self.run.paragraph("one thread; "))
            ul { @for line in self.report.budgets() { li { (line) } } }
            @for (svg, caption) in self.charts.iter().zip(CAPTIONS) {
                figure { (drawing(svg)) figcaption { (caption) } }
            }
            h2 { "Methods" }
            (table(&self.report.cells()))
            h2 { "Renderers" }
            (table(&renderer_cells(self.renderers)))
        };
        page("dvp: speed against accuracy", "Speed against accuracy", &body)
    }
}
