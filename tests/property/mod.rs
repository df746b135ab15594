//! The property tests; a module per concern.

mod compositing;
mod contour;
mod cross_render;
mod edge;
mod efd;
mod exact;
mod fit;
mod geometry;
mod hard;
mod loss;
mod matching;
mod metric;
mod optim;
mod prototypes;
mod refine;
mod render_contour;
mod rgba;
mod rings;
mod scene;
mod scene_json;
mod scene_refine;
mod shape;
mod split;
mod svg;
mod symmetry;
mod triangles;
