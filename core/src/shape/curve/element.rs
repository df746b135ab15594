//! Boundaries as the elements that drawing programs know, and as paths.

use alloc::vec::Vec;

use super::{Boundary, Piece, sweep};
use crate::geometry::Vec2;
use crate::real::Real;
use crate::shape::{Path, PathRing, Segment};

/// A step of a drawing program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PathElement<T> {
    /// A ring begins here.
    Move([T; 2]),
    /// Straight on to here.
    Line([T; 2]),
    /// Along an ellipse.
    Arc {
        /// Half its axes.
        radii: [T; 2],
        /// From +x to the first of them, radians, +x to +y positive.
        rotation: T,
        /// How far around, radians of its parameter, at most pi; +x to +y positive.
        sweep: T,
        /// Where it ends.
        to: [T; 2],
    },
    /// Along a cubic: two control points and the end.
    Cubic([[T; 2]; 3]),
    /// Straight back to where the ring began, if the end is not there.
    Close,
}

/// Cubics to a whole ellipse where there is no element of its own: they stray by 4e-6 of the larger radius.
const CUBICS: usize = 8;

impl<T: Real> Boundary<T> {
    /// The exact boundary as elements, ring by ring. Lines that close a ring are left to [`PathElement::Close`].
    pub fn elements(&self) -> impl Iterator<Item = PathElement<T>> {
        self.rings().flat_map(|ring| {
            let mut elements = Vec::with_capacity(2 * ring.len() + 2);
            elements.extend(ring.first().map(|piece| PathElement::Move(piece.from().to_array())));
            for (k, piece) in ring.iter().enumerate() {
                match *piece {
                    Piece::Line { .. } if k + 1 == ring.len() => {}
                    Piece::Line { to, .. } => elements.push(PathElement::Line(to.to_array())),
                    Piece::Arc { from, to, bulge } => elements.extend(halves(from, to, bulge)),
                    Piece::Ellipse { center, axes } => elements.extend([-axes[0], axes[0]].map(|end| {
                        let sweep = T::of(core::f64::consts::PI) * axes[0].cross(axes[1]).signum();
                        let radii = axes.map(Vec2::length);
                        PathElement::Arc { radii, rotation: axes[0].angle(), sweep, to: (center + end).to_array() }
                    })),
                    Piece::Cubic([_, first, second, to]) => {
                        elements.push(PathElement::Cubic([first, second, to].map(Vec2::to_array)));
                    }
                }
            }
            elements.push(PathElement::Close);
            elements
        })
    }

    /// The boundary as a path of closed rings: the same lines, arcs and cubics; circles as two half circles, and other
    /// ellipses as cubics that stray from them by less than 5e-6 of the larger radius.
    #[must_use]
    pub fn to_path(&self) -> Path<T> {
        let rings = self.rings().map(|ring| {
            let mut path = PathRing::default();
            for piece in ring {
                match *piece {
                    Piece::Ellipse { center, axes } => push_ellipse(center, axes, &mut path),
                    _ => path.points.push(piece.from().to_array()),
                }
                match *piece {
                    Piece::Line { .. } => path.segments.push(Segment::Line),
                    Piece::Arc { bulge, .. } => path.segments.push(Segment::Arc { bulge }),
                    Piece::Cubic([_, first, second, _]) => {
                        path.segments.push(Segment::Cubic { controls: [first.to_array(), second.to_array()] });
                    }
                    Piece::Ellipse { .. } => {}
                }
            }
            path
        });
        Path { rings: rings.collect(), fill: self.fill }
    }
}

/// An arc as one element, or two of half its sweep if that is more than half a turn.
fn halves<T: Real>(from: Vec2<T>, to: Vec2<T>, bulge: T) -> impl Iterator<Item = PathElement<T>> {
    let sweep = sweep(bulge);
    let piece = Piece::Arc { from, to, bulge };
    let half = T::of(0.5);
    // chord = 2 radius sin(sweep / 2).
    let radius = ((to - from).length() * half / (sweep * half).sin()).abs();
    let is_long = bulge.abs() > T::one();
    let count = if is_long { 2 } else { 1 };
    let middle = is_long.then(|| piece.point(half));
    middle.into_iter().chain(core::iter::once(to)).map(move |to| {
        let sweep = sweep / T::of_usize(count);
        if radius.is_finite() {
            PathElement::Arc { radii: [radius; 2], rotation: T::zero(), sweep, to: to.to_array() }
        } else {
            PathElement::Line(to.to_array())
        }
    })
}

/// Appends a whole ellipse.
fn push_ellipse<T: Real>(center: Vec2<T>, axes: [Vec2<T>; 2], path: &mut PathRing<T>) {
    if axes[1] == axes[0].perp() || axes[1] == -axes[0].perp() {
        let bulge = axes[0].cross(axes[1]).signum();
        path.points.extend([axes[0], -axes[0]].map(|end| (center + end).to_array()));
        path.segments.extend([Segment::Arc { bulge }; 2]);
        return;
    }
    let angle = T::of(core::f64::consts::TAU) / T::of_usize(CUBICS);
    // Handles of 4/3 tan(angle / 4) times the derivative touch the ellipse in the middle too.
    let handle = T::of(4.0 / 3.0) * (angle * T::of(0.25)).tan();
    let place = |direction: Vec2<T>| axes[0] * direction.x + axes[1] * direction.y;
    for k in 0..CUBICS {
        let [start, end] = [k, k + 1].map(|k| Vec2::from_angle(angle * T::of_usize(k % CUBICS)));
        let controls = [start + start.perp() * handle, end - end.perp() * handle];
        path.points.push((center + place(start)).to_array());
        path.segments.push(Segment::Cubic { controls: controls.map(|point| (center + place(point)).to_array()) });
    }
}
