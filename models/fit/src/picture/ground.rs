//! The color that transparent pictures are put over.
//!
//! A fit sees colors, not alpha. Over a color that the picture does not show itself, everything visible stands out, and soft edges
//! are right: over one color, a pixel changes with alpha as it changes with coverage.

use alloc::vec::Vec;

/// Levels of a channel of the colors that are considered.
const LEVELS: [f64; 3] = [1.0, 0.0, 0.5];

/// What the alpha of a picture lets through.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ground {
    /// Nothing: every pixel is opaque.
    Opaque,
    /// Pixels are put over this color.
    Matte([f64; 3]),
    /// Everything: no pixel shows anything.
    Invisible,
}

impl Ground {
    /// Of pixels (red, green, blue, alpha), colors not multiplied by alpha, [0, 1]: the color with levels of 0, 1/2 or 1 that is farthest from the nearest of
    /// theirs. Pixels less than half as opaque as the most opaque ones have no say: few steps of color are left of them, and
    /// some programs leave none.
    pub fn of(pixels: impl Iterator<Item = [f64; 4]> + Clone) -> Self {
        let alphas = pixels.clone().map(|[.., alpha]| alpha);
        if alphas.clone().all(|alpha| alpha >= 1.0) {
            return Self::Opaque;
        }
        let most = alphas.fold(0.0, f64::max);
        if most <= 0.0 {
            return Self::Invisible;
        }
        // Each with its squared distance from the nearest color of the picture.
        let mut candidates: Vec<([f64; 3], f64)> = Vec::new();
        for red in LEVELS {
            for green in LEVELS {
                candidates.extend(LEVELS.map(|blue| ([red, green, blue], f64::INFINITY)));
            }
        }
        let mut last = None;
        for [red, green, blue, alpha] in pixels {
            let color = [red, green, blue];
            if 2.0 * alpha >= most && last != Some(color) {
                last = Some(color);
                for (candidate, nearest) in &mut candidates {
                    *nearest = nearest.min(candidate.iter().zip(color).map(|(a, b)| (a - b) * (a - b)).sum());
                }
            }
        }
        let farthest = candidates.into_iter().reduce(|best, other| if other.1 > best.1 { other } else { best });
        Self::Matte(farthest.map_or([1.0; 3], |(color, _)| color))
    }

    /// The color of a pixel (red, green, blue, alpha) over it; white where nothing is visible.
    #[must_use]
    pub fn under(self, [red, green, blue, alpha]: [f64; 4]) -> [f64; 3] {
        let matte = match self {
            Self::Opaque => return [red, green, blue],
            Self::Matte(matte) => matte,
            Self::Invisible => [1.0; 3],
        };
        let over = |color: f64, matte: f64| color * alpha + matte * (1.0 - alpha);
        [over(red, matte[0]), over(green, matte[1]), over(blue, matte[2])]
    }
}
