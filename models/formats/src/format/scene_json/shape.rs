//! The kinds of shapes as they stand in a file, under the names that `Shape::number_names` in the core gives their numbers.

use serde::{Deserialize, Serialize};

use super::object::is_zero;
use super::strict::{maps_only, present};

/// A shape as it stands in a file. Lengths are in the frame of the shape, which an object's translation, scale and rotation
/// carry to scene units: where they are left out, these are scene units (the shorter image side is 1).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(remote = "Self", tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
#[non_exhaustive]
pub enum ShapeJson {
    /// A disk around the origin.
    Circle {
        /// From the center to the boundary; above 0.
        radius: f64,
    },
    /// An ellipse around the origin.
    Ellipse {
        /// Half the axis along x, half the axis along y; above 0.
        radii: [f64; 2],
    },
    /// A rectangle around the origin.
    Rectangle {
        /// Width, along x, and height, along y; above 0.
        size: [f64; 2],
        /// Radius of the quarter circles at the corners, as far as the sides leave room; 0 for sharp corners.
        #[serde(default, skip_serializing_if = "is_zero")]
        corner_radius: f64,
    },
    /// A polygon of equal sides and angles around the origin, its first corner on +x.
    RegularPolygon {
        /// Number of sides, at least 3.
        sides: usize,
        /// From the center to the corners; above 0.
        radius: f64,
    },
    /// A star around the origin, its first point on +x.
    Star {
        /// Number of points, at least 3.
        points: usize,
        /// From the center to the points; above 0.
        radius: f64,
        /// From the center to the corners between the points; above 0.
        inner_radius: f64,
    },
    /// What lies inside of an odd number of closed polygons.
    Polygon {
        /// The corners of each polygon.
        rings: Vec<Vec<[f64; 2]>>,
    },
    /// What rings of lines, arcs and cubics fill.
    Path {
        /// The rings; open ones are closed by a straight line.
        rings: Vec<RingJson>,
        /// What they fill.
        #[serde(default, skip_serializing_if = "FillJson::is_even_odd")]
        fill: FillJson,
    },
    /// What a pen covers along lines, arcs and cubics.
    Stroke {
        /// The lines, open or closed. One without length is a dot.
        rings: Vec<RingJson>,
        /// Of the pen; above 0.
        width: f64,
        /// How open lines end.
        cap: CapJson,
        /// How segments meet at corners.
        join: JoinJson,
        /// Of miters, most distance from the tip to the inner corner per width; beyond it a bevel. 4 if missing.
        #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
        miter_limit: Option<f64>,
    },
    /// Elliptic Fourier descriptors.
    Efd {
        /// Rows (a, b, c, d), n from 1.
        efd: Vec<[f64; 4]>,
        /// The angle is known modulo 2 pi / symmetry; 0 for a disk. Follows from the descriptors: written, not read back.
        #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
        symmetry: Option<usize>,
    },
    /// A shape of a bank.
    Prototype {
        /// Index into the bank.
        prototype: usize,
        /// As of [`Self::Efd`]; may be missing where there is a bank.
        #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
        efd: Option<Vec<[f64; 4]>>,
        /// As of [`Self::Efd`].
        #[serde(default, deserialize_with = "present", skip_serializing_if = "Option::is_none")]
        symmetry: Option<usize>,
    },
}

/// What rings fill, by how often they wind around it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FillJson {
    /// What an odd number of turns goes around.
    #[default]
    EvenOdd,
    /// What turns go around that do not cancel.
    NonZero,
}

impl FillJson {
    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde passes references")]
    fn is_even_odd(&self) -> bool {
        *self == Self::EvenOdd
    }
}

/// How an open line ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum CapJson {
    /// Where its last point is.
    Butt,
    /// With a half disk around its last point.
    Round,
    /// Half a width further.
    Square,
}

/// How two segments of a stroke meet at a corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum JoinJson {
    /// The outer sides go on until they meet.
    Miter,
    /// A sector of a disk around the corner.
    Round,
    /// A straight line joins the ends of the outer sides.
    Bevel,
}

/// A closed ring, or an open line, of segments.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(remote = "Self", deny_unknown_fields)]
#[non_exhaustive]
pub struct RingJson {
    /// Where the segments meet: segment k leads from point k to point k + 1.
    pub points: Vec<[f64; 2]>,
    /// As many as points in a closed ring, whose last segment leads back to the first point; one less in an open one.
    pub segments: Vec<SegmentJson>,
}

/// How a path leads from one point to the next. The smooth ones leave in the direction in which the segment before them
/// arrives; the first of a closed ring in that of the last.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(remote = "Self", tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
#[non_exhaustive]
pub enum SegmentJson {
    /// Straight.
    Line {},
    /// Along a circle.
    Arc {
        /// tan(sweep / 4), the sweep in radians and positive if the arc turns from +x to +y: 0 for a straight line, 1 for a
        /// half circle.
        bulge: f64,
    },
    /// Along the circle that continues the direction.
    SmoothArc {},
    /// A cubic Bézier curve.
    Cubic {
        /// Its two control points.
        controls: [[f64; 2]; 2],
    },
    /// A cubic Bézier curve that continues the direction.
    SmoothCubic {
        /// Distance of the first control point from the start.
        handle: f64,
        /// The second control point.
        control: [f64; 2],
    },
}

maps_only!(ShapeJson, RingJson, SegmentJson);
