//! How dark thin lines are, and so how wide.
//!
//! A line that is narrower than a pixel shows as much as a wider one of a lighter color, and a window across it does not tell them apart. But from
//! window to window its middle moves, and the narrower it is, the more often a single pixel has all of it. The color that makes windows side by side
//! those of one smooth band is the line's.

use alloc::vec::Vec;

#[cfg(not(feature = "std"))]
use num_traits::Float as _;

use dvp_core::image::{coverage, distance, misfit};
use dvp_core::sort;

use super::Color;
use super::chain::{Chain, Mark, median};
use super::cross::{Canvas, LONGEST};
use super::ink::MOST;
use crate::tuning;

/// Windows on both sides of one that say where the middle of a line is in it.
const REACH: usize = 3;
/// Their weights for the middle: the parabola of least squares through seven (Savitzky and Golay, 1964).
const MIDDLE: [f64; 2 * REACH + 1] =
    [-2.0 / 21.0, 3.0 / 21.0, 6.0 / 21.0, 7.0 / 21.0, 6.0 / 21.0, 3.0 / 21.0, -2.0 / 21.0];
/// Least square sum of the steps to them.
const SQUARES: f64 = 28.0;
/// Windows of a line that are asked at most, about.
const MOST_VIEWS: usize = 32;
/// Places in a pixel's side at which a band is looked at.
const PLACES: usize = 4;
/// How often the stretch that the middle of a band may lie in is halved, from a pixel on.
const HALVINGS: usize = 10;
/// How much darker one color is than the next that is tried first: less than what makes it another one, `THIN_TOLERANCE`.
const STEP: f64 = 1.12;
/// Steps at most: as much darker as no picture of 8 bits tells.
const MOST_TRIED: f64 = 64.0;
/// How often the stretch that the best of them leaves open is made a third shorter.
const THIRDS: usize = 8;

/// A window with what its neighbors say of the line in it.
struct View {
    /// How much of the line's color pixels show, over what it lies on.
    shares: [f64; LONGEST],
    count: usize,
    /// Middle of the line, pixels from the first one, and by how much it moves to the next window.
    middle: f64,
    slope: f64,
    /// How much of all pixels the line covers, of its neighbors' too.
    mass: f64,
    /// How far these are apart, windows.
    apart: f64,
}

/// The windows of a chain that lie on one color.
struct Band {
    /// That color, and the one which the chain has.
    side: Color,
    color: Color,
    views: Vec<View>,
    /// The color that leaves least, as a share of the chain's, and most that any may leave that is not clearly worse.
    best: f64,
    most: f64,
    /// Whether all that leave about as little are like it.
    is_told: bool,
}

/// What is known of the color of a line.
struct Line<'a> {
    chain: &'a mut Chain,
    /// What it lies on.
    side: Color,
    /// Its color, and the index of that in the list of colors.
    color: Color,
    index: usize,
    /// The colors that its windows leave open, bits of the list, and whether they tell which it is.
    open: u128,
    is_told: bool,
    /// How wide it is in this color, pixels.
    width: f64,
}

/// Gives chains the color that makes them smooth, where their own clearly does not. Windows of lines along the picture's axes, and of short ones, leave
/// several open: such a line has the color of one that shows as much, whose windows tell it, or else that which explains most lines that show as much.
/// New colors are put last.
#[inline(never)]
pub(super) fn settle(canvas: &Canvas<'_>, chains: &mut [Vec<Chain>; 2], colors: &mut Vec<Color>, palette: &[Color]) {
    let mut chains: Vec<&mut Chain> = chains.iter_mut().flatten().collect();
    sort::descending(&mut chains, |chain| chain.marks.len() as f64);
    let mut lines: Vec<Line<'_>> = Vec::new();
    let mut bands = Vec::new();
    for chain in chains {
        let index = chain.colors.trailing_zeros() as usize;
        let Some(ground) = chain.ground() else { continue };
        let (side, color, width) = (palette[ground as usize], colors[index], median(&chain.widths()));
        let band = Band::of(canvas, chain, ground, color, palette);
        let mut line = Line { chain, side, color, index, open: u128::MAX, is_told: false, width };
        if let Some(band) = band.as_ref().filter(|band| !band.may_be_of(color) && colors.len() < MOST) {
            let index = colors.iter().position(|&color| band.may_be_of(color)).unwrap_or(colors.len());
            if index == colors.len() {
                colors.push(mixed(band.side, band.color, band.best));
            }
            line.give(canvas, (index, colors[index]), palette);
        }
        lines.push(line);
        bands.push(band);
    }
    for (line, band) in lines.iter_mut().zip(&bands) {
        let Some(band) = band else { continue };
        let bit = |(index, color): (usize, &Color)| u128::from(band.may_be_of(*color)) << index;
        line.open = colors.iter().enumerate().map(bit).sum();
        line.is_told = band.is_told;
    }
    for k in 0..lines.len() {
        if let Some(color) = likelier(&lines, k, canvas, [palette, colors]) {
            lines[k].give(canvas, color, palette);
        }
    }
}

/// A color that is likelier for line `k` than its own, with the index of it, for what other lines have that show as much.
fn likelier(
    lines: &[Line<'_>],
    k: usize,
    canvas: &Canvas<'_>,
    [palette, colors]: [&[Color]; 2],
) -> Option<(usize, Color)> {
    let line = &lines[k];
    if line.is_told {
        return None;
    }
    // How wide it would be in each color; another line shows as much if it is as wide in its own.
    let width = |&color: &Color| share_on_way(color, [line.side, line.color]).map(|share| line.width / share);
    let widths: Vec<Option<f64>> = colors.iter().map(width).collect();
    let shows_as_much = |other: &&Line<'_>| {
        widths[other.index].is_some_and(|width| (width - other.width).abs() <= tuning::THIN_TOLERANCE * other.width)
    };
    let alike: Vec<&Line<'_>> = lines.iter().filter(shows_as_much).collect();
    let mut told = alike.iter().filter(|other| other.is_told).map(|other| (other.index, other.color));
    if let Some(color) = told.find(|&color| line.may_have(canvas, color, palette)) {
        return Some(color);
    }
    let explained = |(index, color): (usize, Color)| -> usize {
        let explained = alike.iter().filter(|other| other.index == index || other.may_be_darker(index, color));
        explained.map(|other| other.chain.marks.len()).sum()
    };
    let own = explained((line.index, line.color));
    let mut others: Vec<(usize, Color)> = alike.iter().map(|other| (other.index, other.color)).collect();
    others.sort_unstable_by_key(|&(index, _)| index);
    others.dedup_by_key(|&mut (index, _)| index);
    let others = others.into_iter().map(|color| (explained(color), color));
    let likelier = others.filter(|&(explained, color)| explained > own && line.may_have(canvas, color, palette));
    likelier.rev().max_by_key(|&(explained, _)| explained).map(|(_, color)| color)
}

impl Line<'_> {
    /// Gives the line a color, and its windows what they are in it.
    fn give(&mut self, canvas: &Canvas<'_>, (index, color): (usize, Color), palette: &[Color]) {
        for mark in &mut self.chain.marks {
            if let Some([center, width, _]) = canvas.measure(mark.along, &mark.cross, color, palette) {
                mark.place(center, width);
            }
        }
        self.chain.colors = 1 << index;
        (self.index, self.color, self.width) = (index, color, median(&self.chain.widths()));
    }

    /// Whether its windows leave open that it has a color that is farther from what it lies on.
    fn may_be_darker(&self, index: usize, color: Color) -> bool {
        let is_open = !self.is_told && self.open >> index & 1 == 1;
        is_open && distance(color, self.side) > distance(self.color, self.side)
    }

    /// Whether a color explains all its windows, which do not tell another one.
    fn may_have(&self, canvas: &Canvas<'_>, (index, color): (usize, Color), palette: &[Color]) -> bool {
        let mut marks = self.chain.marks.iter();
        self.open >> index & 1 == 1
            && marks.all(|mark| {
                let measured = canvas.measure(mark.along, &mark.cross, color, palette);
                measured.is_some_and(|[_, _, misfit]| misfit <= canvas.noise)
            })
    }
}

/// How far a color is on the way from one to the other, or beyond it; none if it is beside.
fn share_on_way(color: Color, [from, to]: [Color; 2]) -> Option<f64> {
    let share = coverage(color, from, to);
    (share > 0.0 && misfit(color, from, to, share) <= tuning::LEAST_CONTRAST).then_some(share)
}

/// Two colors mixed.
fn mixed(from: Color, to: Color, share: f64) -> Color {
    [0, 1, 2].map(|c| from[c] + share * (to[c] - from[c]))
}

impl Band {
    /// Windows of a chain on one color, with as many beside them as say where its middle is; none if there are few.
    fn of(canvas: &Canvas<'_>, chain: &Chain, side: u16, color: Color, palette: &[Color]) -> Option<Self> {
        let ground = palette[side as usize];
        let shares = |mark: &Mark| {
            let [from, to] = mark.cross.run;
            let mut shares = [0.0; LONGEST];
            for (share, at) in shares.iter_mut().zip(from..to) {
                *share = coverage(canvas.color(mark.along, mark.cross.line, at), ground, color);
            }
            shares
        };
        // How much all pixels of a window show, and their middle.
        let seen = |mark: &Mark| {
            let shares = shares(mark);
            let all: f64 = shares.iter().sum();
            let at: f64 = shares.iter().enumerate().map(|(k, share)| share * (k as f64 + 0.5)).sum();
            [all, at / all + mark.cross.run[0] as f64]
        };
        let all: Vec<[f64; 2]> = chain.marks.iter().map(seen).collect();
        let count = all.len();
        let moves: f64 = all.windows(2).map(|pair| (pair[1][1] - pair[0][1]).abs()).sum();
        // The windows that are looked at together see a line move by a pixel, if it is long enough for several such.
        let needed = (count as f64 / (moves * 2.0 * REACH as f64)).ceil();
        let apart = if needed * 4.0 * REACH as f64 <= count as f64 { needed as usize } else { 1 };
        let is_of_it = |mark: &Mark| is_even(mark) && mark.cross.sides[0] == side;
        let is_next = |from: &Mark, mark: &Mark| {
            is_of_it(from)
                && is_of_it(mark)
                && mark.along == from.along
                && mark.cross.line.abs_diff(from.cross.line) == apart
        };
        let first = (0..count.saturating_sub(2 * REACH * apart)).step_by(count / MOST_VIEWS + 1);
        let views = first.filter_map(|first| {
            let at = |k: usize| first + k * apart;
            if !(0..2 * REACH).all(|k| is_next(&chain.marks[at(k)], &chain.marks[at(k + 1)])) {
                return None;
            }
            let here = &chain.marks[at(REACH)];
            let [from, to] = here.cross.run;
            let (mut middle, mut slope, mut mass) = (0.0, 0.0, 0.0);
            for (k, weight) in MIDDLE.iter().enumerate() {
                let [shown, place] = all[at(k)];
                middle += weight * (place - from as f64);
                slope += (k as f64 - REACH as f64) * place / (SQUARES * apart as f64);
                mass += shown / MIDDLE.len() as f64;
            }
            Some(View { shares: shares(here), count: to - from, middle, slope, mass, apart: apart as f64 })
        });
        let views: Vec<View> = views.collect();
        if views.len() < tuning::SHADE_LEAST || views.iter().any(|view| view.mass <= 0.0) {
            return None;
        }
        let mut band = Self { side: ground, color, views, best: 1.0, most: f64::INFINITY, is_told: false };
        band.tell();
        Some(band)
    }

    /// Mean square of what windows differ, of the middle one, from a band whose color has `share` of the chain's over what it lies on.
    fn misfit(&self, share: f64) -> f64 {
        let contrast = distance(self.side, self.color);
        let of_view = |view: &View| {
            let bands = view.bands(share);
            let off = |k: usize| {
                let covered = bands.map(|[from, to]| (to.min(k as f64 + 1.0) - from.max(k as f64)).max(0.0));
                let covered = covered.iter().sum::<f64>() / PLACES as f64;
                (contrast * (view.shares[k] - share * covered)).powi(2)
            };
            (0..view.count).map(off).sum::<f64>()
        };
        median(&self.views.iter().map(of_view).collect::<Vec<_>>())
    }

    /// Whether a color on the way between the two, give or take what makes a color of its own, makes the band about as smooth as one can.
    fn may_be_of(&self, color: Color) -> bool {
        share_on_way(color, [self.side, self.color]).is_some_and(|share| self.misfit(share) <= self.most)
    }

    /// Looks for the color that leaves least: between what is seen and what no channel can be beyond.
    fn tell(&mut self) {
        let seen = self.views.iter().flat_map(|view| view.shares).fold(0.0, f64::max);
        let room = (0..3).map(|c| match self.color[c] - self.side[c] {
            step if step > 0.0 => (1.0 - self.side[c]) / step,
            step if step < 0.0 => -self.side[c] / step,
            _ => f64::INFINITY,
        });
        let most = room.fold(f64::INFINITY, f64::min);
        let steps = ((most / seen).ln() / STEP.ln()).ceil().clamp(0.0, MOST_TRIED) as i32;
        let tried = (0..=steps).map(|k| (seen * STEP.powi(k)).min(most)).map(|share| (share, self.misfit(share)));
        let tried: Vec<(f64, f64)> = tried.collect();
        let Some(&(near, _)) = tried.iter().min_by(|a, b| a.1.total_cmp(&b.1)) else { return };
        let [mut low, mut high] = [near / STEP, (near * STEP).min(most)];
        for _ in 0..THIRDS {
            let [first, second] = [1.0, 2.0].map(|thirds| low + thirds / 3.0 * (high - low));
            if self.misfit(first) <= self.misfit(second) {
                high = second;
            } else {
                low = first;
            }
        }
        // What leaves more than this leaves clearly more.
        self.best = 0.5 * (low + high);
        self.most = tuning::SHADE_CLEARLY * self.misfit(self.best).max(tuning::SHADE_FLOOR);
        let is_other = |share: f64| (share / self.best - 1.0).abs() > tuning::THIN_TOLERANCE;
        self.is_told = tried.iter().all(|&(share, misfit)| !is_other(share) || misfit > self.most);
    }
}

impl View {
    /// From where to where the line reaches at places across the window, if its color has `share` of the chain's.
    fn bands(&self, share: f64) -> [[f64; 2]; PLACES] {
        let reach = 0.5 * self.mass / share;
        let at = |middle: f64, line: f64| -> [[f64; 2]; PLACES] {
            core::array::from_fn(|place| {
                let middle = middle + self.slope * (line + (place as f64 + 0.5) / PLACES as f64 - 0.5);
                [middle - reach, middle + reach]
            })
        };
        // What pixels say of the middle of a band is not quite where it is: by as much as they would be off here.
        let told = |[from, to]: [f64; 2]| {
            let (first, last) = (from.floor(), (to - 1.0).floor());
            if last < first {
                return first + 0.5;
            }
            // The pixels at both ends count by what is covered of them, those between as they are.
            let (before, behind) = (first + 1.0 - from, to - last - 1.0);
            let between = 0.5 * ((last + 1.0).powi(2) - (first + 1.0).powi(2));
            (before * (first + 0.5) + between + behind * (last + 1.5)) / (to - from)
        };
        // It lies within a pixel of that, and what pixels say moves with it, if not as fast.
        let [mut low, mut high] = [self.middle - 0.5, self.middle + 0.5];
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            let said = MIDDLE.iter().enumerate().map(|(k, weight)| {
                let bands = at(middle, (k as f64 - REACH as f64) * self.apart);
                weight * bands.map(told).iter().sum::<f64>() / PLACES as f64
            });
            if said.sum::<f64>() < self.middle {
                low = middle;
            } else {
                high = middle;
            }
        }
        at(0.5 * (low + high), 0.0)
    }
}

/// Whether a window has one color on both sides, and one line in it.
fn is_even(mark: &Mark) -> bool {
    mark.cross.sides[0] == mark.cross.sides[1] && !mark.is_shared
}

impl Chain {
    /// The palette's color of what it lies on.
    fn ground(&self) -> Option<u16> {
        self.marks.iter().find(|mark| is_even(mark)).map(|mark| mark.cross.sides[0])
    }
}
