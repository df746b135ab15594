//! What an element draws, in the numbers of the file.

use core::f64::consts::SQRT_2;

use dvp_core::shape::{PathRing, Segment};
use svgtypes::{Length, LengthUnit, PointsParser};
use usvg::roxmltree::Node;
use usvg::tiny_skia_path::PathSegment;

use super::losses::Losses;
use super::path_data;

/// A shape in the units of its element.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Figure {
    Ellipse {
        center: [f64; 2],
        radii: [f64; 2],
        is_circle: bool,
    },
    /// `radii` those of its corners.
    Rectangle {
        corner: [f64; 2],
        size: [f64; 2],
        radii: [f64; 2],
    },
    /// `class` is the attribute.
    Polygon {
        points: Vec<[f64; 2]>,
        class: Option<String>,
    },
    /// Also lines and polylines.
    Path {
        rings: Vec<PathRing<f64>>,
        class: Option<String>,
    },
}

impl Figure {
    /// What `path` draws: as its element says, or if that is unknown as usvg understood it. Curves that are neither arcs nor
    /// cubics become cubics within `tolerance`.
    pub(super) fn of(path: &usvg::Path, element: Option<Node<'_, '_>>, tolerance: f64, losses: &mut Losses) -> Self {
        let own = element.and_then(|element| Self::of_element(path, element, tolerance, losses));
        own.unwrap_or_else(|| Self::Path { rings: resolved_rings(path), class: None })
    }

    fn of_element(path: &usvg::Path, element: Node<'_, '_>, tolerance: f64, losses: &mut Losses) -> Option<Self> {
        let bounds = path.data().bounds();
        // What usvg resolved, as the best numbers where those of the file have units.
        let [left, top, right, bottom] = [bounds.left(), bounds.top(), bounds.right(), bounds.bottom()].map(f64::from);
        let center = [0.5 * (left + right), 0.5 * (top + bottom)];
        let size = [right - left, bottom - top];
        let class = element.attribute("class").map(str::to_owned);
        match element.tag_name().name() {
            "circle" => {
                let numbers = plain(element, ["cx", "cy", "r"]);
                let [x, y, radius] = numbers.unwrap_or([center[0], center[1], 0.5 * size[0]]);
                Some(Self::Ellipse { center: [x, y], radii: [radius; 2], is_circle: true })
            }
            "ellipse" => {
                let has_both = element.has_attribute("rx") && element.has_attribute("ry");
                let numbers = plain(element, ["cx", "cy", "rx", "ry"]).filter(|_| has_both);
                let [x, y, rx, ry] = numbers.unwrap_or([center[0], center[1], 0.5 * size[0], 0.5 * size[1]]);
                Some(Self::Ellipse { center: [x, y], radii: [rx, ry], is_circle: false })
            }
            "rect" => {
                let numbers = plain(element, ["x", "y", "width", "height"]);
                let [x, y, width, height] = numbers.unwrap_or([left, top, size[0], size[1]]);
                let radii = corner_radii(element, [width, height])?;
                Some(Self::Rectangle { corner: [x, y], size: [width, height], radii })
            }
            "line" => {
                let [x, y, to_x, to_y] = plain(element, ["x1", "y1", "x2", "y2"])?;
                Some(Self::Path { rings: vec![PathRing::polyline(vec![[x, y], [to_x, to_y]])], class })
            }
            "polyline" => {
                let points = points(element)?;
                Some(Self::Path { rings: vec![PathRing::polyline(points)], class })
            }
            "polygon" => Some(Self::Polygon { points: points(element)?, class }),
            "path" => {
                let (rings, is_broken) = path_data::rings(element.attribute("d")?, tolerance);
                if is_broken {
                    losses.add("path data: read up to its first error");
                }
                Some(Self::Path { rings, class })
            }
            _ => None,
        }
    }

    /// How many lines and curves it has.
    pub(super) fn segment_count(&self) -> usize {
        match self {
            Self::Ellipse { .. } => 1,
            Self::Rectangle { .. } => 4,
            Self::Polygon { points, .. } => points.len(),
            Self::Path { rings, .. } => rings.iter().map(|ring| ring.segments.len()).sum(),
        }
    }

    /// The outline; `tolerance` as in [`Self::of`].
    pub(super) fn rings(&self, tolerance: f64) -> Vec<PathRing<f64>> {
        match self {
            Self::Ellipse { center: [x, y], radii: [rx, ry], .. } => {
                let half = format!("A{rx} {ry} 0 0 1");
                let data = format!("M{} {y} {half} {} {y} {half} {} {y} Z", x + rx, x - rx, x + rx);
                path_data::rings(&data, tolerance).0
            }
            Self::Rectangle { corner, size, radii } => vec![rectangle(*corner, *size, *radii)],
            Self::Polygon { points, .. } => vec![PathRing::polygon(points.clone())],
            Self::Path { rings, .. } => rings.clone(),
        }
    }
}

/// Attributes that are plain numbers or pixels, 0 if missing; none if one has another unit.
fn plain<const N: usize>(element: Node<'_, '_>, names: [&str; N]) -> Option<[f64; N]> {
    let mut numbers = [0.0; N];
    for (number, name) in numbers.iter_mut().zip(names) {
        if let Some(text) = element.attribute(name) {
            let length: Length = text.trim().parse().ok()?;
            *number = matches!(length.unit, LengthUnit::None | LengthUnit::Px).then_some(length.number)?;
        }
    }
    Some(numbers)
}

/// The radii of a rectangle's corners; none if they have units.
fn corner_radii(element: Node<'_, '_>, [width, height]: [f64; 2]) -> Option<[f64; 2]> {
    let [rx, ry] = plain(element, ["rx", "ry"])?;
    let given = |name: &str, value: f64| (element.has_attribute(name) && value >= 0.0).then_some(value);
    let (rx, ry) = (given("rx", rx), given("ry", ry));
    let (rx, ry) = (rx.or(ry).unwrap_or(0.0), ry.or(rx).unwrap_or(0.0));
    Some([rx.min(0.5 * width), ry.min(0.5 * height)])
}

fn points(element: Node<'_, '_>) -> Option<Vec<[f64; 2]>> {
    Some(PointsParser::from(element.attribute("points")?).map(|(x, y)| [x, y]).collect())
}

/// A rectangle from its upper left corner, around by +x.
fn rectangle([x, y]: [f64; 2], [width, height]: [f64; 2], [rx, ry]: [f64; 2]) -> PathRing<f64> {
    let (right, bottom) = (x + width, y + height);
    if rx <= 0.0 || ry <= 0.0 {
        return PathRing::polygon(vec![[x, y], [right, y], [right, bottom], [x, bottom]]);
    }
    let ends = [
        [[right - rx, y], [right, y + ry]],
        [[right, bottom - ry], [right - rx, bottom]],
        [[x + rx, bottom], [x, bottom - ry]],
        [[x, y + ry], [x + rx, y]],
    ];
    let corners = [[right, y], [right, bottom], [x, bottom], [x, y]];
    let mut ring = PathRing::default();
    for ([from, to], corner) in ends.into_iter().zip(corners) {
        ring.points.extend([from, to]);
        let arc = if (rx - ry).abs() <= f64::EPSILON * rx {
            // A quarter of a circle: tan(pi / 8).
            Segment::Arc { bulge: SQRT_2 - 1.0 }
        } else {
            // A quarter of an ellipse; the cubic strays 2.7e-4 of the radii from it.
            let share = 4.0 / 3.0 * (SQRT_2 - 1.0);
            let toward = |end: [f64; 2]| [0, 1].map(|axis| end[axis] + share * (corner[axis] - end[axis]));
            Segment::Cubic { controls: [toward(from), toward(to)] }
        };
        ring.segments.extend([arc, Segment::Line]);
    }
    ring
}

/// The rings of a path as usvg has it.
fn resolved_rings(path: &usvg::Path) -> Vec<PathRing<f64>> {
    let mut data = String::new();
    let mut push = |command: char, points: &[usvg::tiny_skia_path::Point]| {
        data.push(command);
        points.iter().for_each(|point| data.push_str(&format!("{} {} ", point.x, point.y)));
    };
    for segment in path.data().segments() {
        match segment {
            PathSegment::MoveTo(to) => push('M', &[to]),
            PathSegment::LineTo(to) => push('L', &[to]),
            PathSegment::QuadTo(control, to) => push('Q', &[control, to]),
            PathSegment::CubicTo(first, second, to) => push('C', &[first, second, to]),
            PathSegment::Close => push('Z', &[]),
        }
    }
    path_data::rings(&data, 0.0).0
}
