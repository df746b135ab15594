//! The grid that a drawing lies on.

use alloc::vec::Vec;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use super::classes::Class;
use super::places::LIMIT;
use crate::ruler::Ruler;
use crate::tuning;

/// Steps across a picture, the most common first: of the usual canvases of icons, flags and logos.
const COUNTS: [u32; 14] = [24, 16, 32, 20, 48, 64, 36, 72, 40, 100, 128, 256, 512, 30];

/// Whole steps, halves, quarters.
pub(super) const LEVELS: usize = 3;

/// Places at the multiples of a step, of its half and of its quarter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Grid {
    /// The step, pixels.
    pub(super) step: f64,
    /// Bits for a number being a place of each level, and which one; at last for it being none.
    pub(super) bits: [f64; LEVELS + 1],
}

impl Grid {
    /// The place of a level that is nearest to a value.
    pub(super) fn nearest(&self, level: usize, value: f64) -> f64 {
        let step = self.step_of(level);
        (value / step).round() * step
    }

    fn step_of(&self, level: usize) -> f64 {
        self.step / f64::from(1_u32 << level)
    }

    /// A grid of levels that are taken so often.
    fn new(step: f64, uses: [f64; LEVELS + 1], ruler: &Ruler) -> Self {
        let all: f64 = uses.iter().sum();
        let mut grid = Self { step, bits: uses.map(|uses| (all / uses).log2()) };
        for level in 0..LEVELS {
            let step = grid.step_of(level);
            let is_told = step >= LEAST_STEP * LIMIT;
            grid.bits[level] += if is_told { (ruler.extent / step).max(1.0).log2() } else { f64::INFINITY };
        }
        grid
    }

    /// Bits of a class, and the level it is on; `LEVELS` if it is on none.
    fn price(&self, class: &Class, ruler: &Ruler) -> (f64, usize) {
        let mut best = (self.bits[LEVELS] + ruler.number(class.sigma), LEVELS);
        for level in 0..LEVELS {
            let miss = (class.value - self.nearest(level, class.value)) / class.sigma;
            let bits = self.bits[level] + ruler.misfit(miss * miss);
            if bits < best.0 {
                best = (bits, level);
            }
        }
        best
    }

    /// The value of a class, on the grid if that is told with fewer bits.
    pub(super) fn snap(&self, class: &Class, ruler: &Ruler) -> f64 {
        let (_, level) = self.price(class, ruler);
        if level < LEVELS { self.nearest(level, class.value) } else { class.value }
    }

    /// The grid that makes the description of all classes shortest, if it makes it shorter.
    pub(super) fn infer(classes: &[Vec<Class>; 3], ruler: &Ruler) -> Option<Self> {
        let all = || classes.iter().flatten();
        let free: f64 = all().map(|class| ruler.number(class.sigma)).sum();
        let priced = COUNTS.iter().enumerate().map(|(rank, &count)| {
            let step = ruler.extent / f64::from(count);
            let mut grid = Self::new(step, [4.0, 2.0, 1.0, 1.0], ruler);
            // How often each level is used, from what it is used for.
            for _ in 0..ROUNDS {
                let mut uses = [1.0; LEVELS + 1];
                all().for_each(|class| uses[grid.price(class, ruler).1] += 1.0);
                grid = Self::new(step, uses, ruler);
            }
            let told = (all().count() as f64 + 1.0).log2() * 0.5 * LEVELS as f64 + 2.0 * (rank as f64 + 1.0).log2();
            (all().map(|class| grid.price(class, ruler).0).sum::<f64>() + told, grid)
        });
        let (bits, grid) = priced.min_by(|a, b| a.0.total_cmp(&b.0))?;
        (bits + tuning::TIES_BITS < free).then_some(grid)
    }
}

/// Places closer than this many times what a number may move by are none: more than a quarter of all numbers would get to one.
const LEAST_STEP: f64 = 8.0;

/// Rounds after which the uses of the levels do not change any more.
const ROUNDS: usize = 3;
