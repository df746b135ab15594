//! From the shapes of a text to shapes with every number checked.

use dvp_core::shape::{
    AnyShape, Cap, Circle, Ellipse, FillRule, Join, MOST_CORNERS, Path, PathRing, Polygon, Prototype, Rectangle,
    RegularPolygon, Segment, Star, Stroke,
};
use dvp_core::{Efd, Real};
use dvp_fit::Bank;

use super::super::error::FormatError;
use super::check::{Checker, MAX_COORDINATE, REACH};
use super::{CapJson, FillJson, JoinJson, RingJson, SegmentJson, ShapeJson};

/// Most harmonics of a shape.
const MAX_HARMONICS: usize = 1024;
/// Largest bulge of an arc, whose circle is half as many times as large as its chord, and limit of a miter.
const MAX_RATIO: f64 = 1e6;
/// SVG's own.
const MITER_LIMIT: f64 = 4.0;

impl ShapeJson {
    /// How many points it has, control points and corners included.
    pub(super) fn point_count(&self) -> usize {
        match self {
            Self::RegularPolygon { sides, .. } => *sides,
            Self::Star { points, .. } => points.saturating_mul(2),
            Self::Polygon { rings } => rings.iter().map(Vec::len).sum(),
            Self::Path { rings, .. } | Self::Stroke { rings, .. } => {
                rings.iter().map(|ring| ring.points.len() + 2 * ring.curve_count()).sum()
            }
            Self::Efd { efd, .. } | Self::Prototype { efd: Some(efd), .. } => efd.len(),
            Self::Circle { .. } | Self::Ellipse { .. } | Self::Rectangle { .. } | Self::Prototype { .. } => 1,
        }
    }

    /// How many curves its paths have, with one for every point where a stroke has a round join or cap.
    pub(super) fn curve_count(&self) -> usize {
        match self {
            Self::Path { rings, .. } => rings.iter().map(RingJson::curve_count).sum(),
            Self::Stroke { rings, cap, join, .. } => {
                let is_round = matches!(cap, CapJson::Round) || matches!(join, JoinJson::Round);
                let round = |ring: &RingJson| if is_round { ring.points.len() } else { 0 };
                rings.iter().map(|ring| ring.curve_count() + round(ring)).sum()
            }
            _ => 0,
        }
    }
}

impl RingJson {
    fn curve_count(&self) -> usize {
        self.segments.iter().filter(|segment| !matches!(segment, SegmentJson::Line {})).count()
    }
}

impl Checker<'_> {
    /// The shape of the object at `field`.
    pub(super) fn shape<T: Real>(
        &self,
        field: &str,
        shape: &ShapeJson,
        bank: Option<&Bank<T>>,
    ) -> Result<AnyShape<T>, FormatError> {
        let length = |name: &str, value: f64| self.above_zero(&format!("{field}.{name}"), value, MAX_COORDINATE);
        Ok(match *shape {
            ShapeJson::Circle { radius } => Circle { radius: length("radius", radius)? }.into(),
            ShapeJson::Ellipse { radii: [x, y] } => {
                Ellipse { radii: [length("radii[0]", x)?, length("radii[1]", y)?] }.into()
            }
            ShapeJson::Rectangle { size: [x, y], corner_radius } => Rectangle {
                size: [length("size[0]", x)?, length("size[1]", y)?],
                corner_radius: self.within(&format!("{field}.corner_radius"), corner_radius, [0.0, MAX_COORDINATE])?,
            }
            .into(),
            ShapeJson::RegularPolygon { sides, radius } => RegularPolygon {
                sides: self.count(&format!("{field}.sides"), sides, [3, MOST_CORNERS])?,
                radius: length("radius", radius)?,
            }
            .into(),
            ShapeJson::Star { points, radius, inner_radius } => Star {
                points: self.count(&format!("{field}.points"), points, [3, MOST_CORNERS])?,
                radius: length("radius", radius)?,
                inner_radius: length("inner_radius", inner_radius)?,
            }
            .into(),
            ShapeJson::Polygon { ref rings } => self.polygon(&format!("{field}.rings"), rings)?.into(),
            ShapeJson::Path { ref rings, fill } => Path {
                rings: self.rings(&format!("{field}.rings"), rings)?,
                fill: match fill {
                    FillJson::EvenOdd => FillRule::EvenOdd,
                    FillJson::NonZero => FillRule::NonZero,
                },
            }
            .into(),
            ShapeJson::Stroke { ref rings, width, cap, join, miter_limit } => Stroke {
                rings: self.rings(&format!("{field}.rings"), rings)?,
                width: length("width", width)?,
                cap: match cap {
                    CapJson::Butt => Cap::Butt,
                    CapJson::Round => Cap::Round,
                    CapJson::Square => Cap::Square,
                },
                join: self.join(&format!("{field}.miter_limit"), join, miter_limit)?,
            }
            .into(),
            ShapeJson::Efd { ref efd, .. } => self.efd_rows(&format!("{field}.efd"), efd)?.into(),
            ShapeJson::Prototype { prototype: index, ref efd, .. } => {
                let efd = self.prototype(&format!("{field}.efd"), efd.as_deref(), index, bank)?;
                Prototype { index, efd }.into()
            }
        })
    }

    fn count(&self, field: &str, count: usize, [low, high]: [usize; 2]) -> Result<usize, FormatError> {
        if (low..=high).contains(&count) {
            Ok(count)
        } else {
            self.wrong(field, format!("is {count}, must be from {low} to {high}"))
        }
    }

    /// Refuses lists that are shorter than `least`; `what` they hold, in the plural.
    fn no_shorter<V>(&self, field: &str, list: &[V], least: usize, what: &str) -> Result<(), FormatError> {
        if list.len() < least {
            return self.wrong(field, format!("has {} {what}, needs at least {least}", list.len()));
        }
        Ok(())
    }

    pub(super) fn points<T: Real>(&self, field: &str, points: &[[f64; 2]]) -> Result<Vec<[T; 2]>, FormatError> {
        let points = points.iter().enumerate();
        points.map(|(k, &point)| self.all_within(&format!("{field}[{k}]"), point, REACH)).collect()
    }

    fn polygon<T: Real>(&self, field: &str, rings: &[Vec<[f64; 2]>]) -> Result<Polygon<T>, FormatError> {
        self.no_shorter(field, rings, 1, "rings")?;
        let rings = rings.iter().enumerate().map(|(i, ring)| {
            let field = format!("{field}[{i}]");
            self.no_shorter(&field, ring, 3, "corners")?;
            self.points(&field, ring)
        });
        Ok(Polygon { rings: rings.collect::<Result<_, _>>()? })
    }

    fn join<T: Real>(&self, field: &str, join: JoinJson, limit: Option<f64>) -> Result<Join<T>, FormatError> {
        match (join, limit) {
            (JoinJson::Miter, limit) => {
                Ok(Join::Miter { limit: self.within(field, limit.unwrap_or(MITER_LIMIT), [0.0, MAX_RATIO])? })
            }
            (JoinJson::Round, None) => Ok(Join::Round),
            (JoinJson::Bevel, None) => Ok(Join::Bevel),
            (_, Some(_)) => self.wrong(field, "is for the join \"miter\" only"),
        }
    }

    fn rings<T: Real>(&self, field: &str, rings: &[RingJson]) -> Result<Vec<PathRing<T>>, FormatError> {
        self.no_shorter(field, rings, 1, "rings")?;
        let mut checked = Vec::with_capacity(rings.len());
        for (i, ring) in rings.iter().enumerate() {
            let field = format!("{field}[{i}]");
            let ring = self.ring(&field, ring)?;
            // Alone, so that the refusal can name the ring.
            let path = Path::new(vec![ring]).or_else(|error| self.wrong(field, format!("is no ring: {error}")))?;
            checked.extend(path.rings);
        }
        Ok(checked)
    }

    fn ring<T: Real>(&self, field: &str, ring: &RingJson) -> Result<PathRing<T>, FormatError> {
        self.no_shorter(&format!("{field}.points"), &ring.points, 1, "points")?;
        let (points, segments) = (ring.points.len(), ring.segments.len());
        if segments != points && segments + 1 != points {
            return self.wrong(
                format!("{field}.segments"),
                format!(
                    "has {segments} entries, must have {points} in a closed ring of {points} points, {} in an open one",
                    points - 1
                ),
            );
        }
        let segments = ring.segments.iter().enumerate();
        let segments = segments.map(|(k, &segment)| self.segment(&format!("{field}.segments[{k}]"), segment));
        Ok(PathRing {
            points: self.points(&format!("{field}.points"), &ring.points)?,
            segments: segments.collect::<Result<_, _>>()?,
        })
    }

    fn segment<T: Real>(&self, field: &str, segment: SegmentJson) -> Result<Segment<T>, FormatError> {
        Ok(match segment {
            SegmentJson::Line {} => Segment::Line,
            SegmentJson::Arc { bulge } => {
                Segment::Arc { bulge: self.within(&format!("{field}.bulge"), bulge, [-MAX_RATIO, MAX_RATIO])? }
            }
            SegmentJson::SmoothArc {} => Segment::SmoothArc,
            SegmentJson::Cubic { controls: [first, second] } => {
                let field = format!("{field}.controls");
                Segment::Cubic {
                    controls: [self.all_within(&field, first, REACH)?, self.all_within(&field, second, REACH)?],
                }
            }
            SegmentJson::SmoothCubic { handle, control } => Segment::SmoothCubic {
                handle: self.within(&format!("{field}.handle"), handle, REACH)?,
                control: self.all_within(&format!("{field}.control"), control, REACH)?,
            },
        })
    }

    /// The descriptors of a prototype, from the bank where the text leaves them out.
    fn prototype<T: Real>(
        &self,
        field: &str,
        rows: Option<&[[f64; 4]]>,
        index: usize,
        bank: Option<&Bank<T>>,
    ) -> Result<Efd<T>, FormatError> {
        match (rows, bank) {
            (Some(rows), _) => self.efd_rows(field, rows),
            (None, None) => self.wrong(
                field,
                format!("is missing, and there is no bank to take prototype {index} from; name one with --bank"),
            ),
            (None, Some(bank)) => match bank.prototypes.get(index) {
                Some((_, efd)) => Ok(efd.clone()),
                None => self.wrong(
                    field,
                    format!(
                        "is missing, and the bank has only {} prototypes: no number {index}",
                        bank.prototypes.len()
                    ),
                ),
            },
        }
    }

    pub(super) fn efd_rows<T: Real>(&self, field: &str, rows: &[[f64; 4]]) -> Result<Efd<T>, FormatError> {
        if rows.is_empty() || rows.len() > MAX_HARMONICS {
            return self.wrong(field, format!("has {} rows, must have 1 to {MAX_HARMONICS}", rows.len()));
        }
        let rows = rows.iter().enumerate();
        let rows = rows.map(|(n, &row)| self.all_within(&format!("{field}[{n}]"), row, REACH));
        Ok(Efd::new(rows.collect::<Result<_, _>>()?))
    }
}
