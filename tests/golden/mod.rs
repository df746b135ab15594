//! The golden tests; a module per concern.

mod efd;
mod fit;
mod hard_geometry;
mod hidden;
mod loss;
mod matching;
mod metric;
mod noise;
mod optim;
mod prototypes;
mod render_contour;
mod scene;
mod scene_pairs;
mod symmetry;
mod triangles;
