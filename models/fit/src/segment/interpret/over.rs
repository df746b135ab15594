//! The reading under `over` compositing: every region shows one object, but where a translucent object passes in front of
//! others.
//!
//! A translucent object of opacity f and color c shows f c + (1 - f) g over the background g and f c + (1 - f) b over an
//! object b: what it shows moves by (1 - f) (b - g). So a region between two others that is off the color of one by a part
//! of what the other is off the background is their overlap, and both f and c are known.

use alloc::vec::Vec;

use dvp_core::Real;
use dvp_core::image::distance;
use dvp_core::render::Compositing;

use super::{Border, Cover, MAX_COVER, MIN_BORDER, Reading, Stacking, is_color, slack, within_unit};
use crate::segment::region::Region;
use crate::tuning::{CROSSING_CONTACT, OVERLAP_COLOR, SHADOW_CONTRAST};

/// What shows through a translucent object, at least and at most.
const THROUGH: [f64; 2] = [0.06, 0.94];

/// An overlap of region `top` over region `bottom`.
#[derive(Clone, Copy, Debug)]
struct Shadow<T> {
    top: u32,
    bottom: u32,
    /// Share of the bottom that shows through.
    through: T,
    off: T,
}

impl<T: Real> Reading<T> {
    /// Reads the prepared regions as stacked.
    pub(crate) fn read_over(&mut self, regions: &[Region<T>]) {
        self.start(Compositing::Over, regions.len());
        self.overlaps.clear();
        self.overlaps.resize(regions.len(), None);
        let mut through = alloc::vec![T::zero(); regions.len()];
        for (i, through) in through.iter_mut().enumerate() {
            if let Some(shadow) = self.shadow(regions, i) {
                self.overlaps[i] = Some(([shadow.top, shadow.bottom, 0], 2));
                *through = shadow.through;
            }
        }
        self.drop_chained_overlaps();
        for i in 0..regions.len() {
            let Some((members, len)) = self.overlaps[i] else { continue };
            self.join_singles(i, &members[..usize::from(len)]);
        }
        self.name_stacked(regions);
        self.make_translucent(regions, &through);
        self.cover_overlaps(regions);
        self.find_borders(regions);
    }

    /// The translucent overlap that region `i` is, if it lies between two others and shows what opacity foretells.
    #[expect(clippy::cast_possible_truncation, reason = "an image has at most 2^28 regions")]
    fn shadow(&self, regions: &[Region<T>], i: usize) -> Option<Shadow<T>> {
        if self.classes[i] == self.ground {
            return None;
        }
        let total = self.contacts_of_overlap(i)?;
        let mut best: Option<Shadow<T>> = None;
        for (a, _) in self.contacts_of(i) {
            for (b, _) in self.contacts_of(i) {
                let [top, bottom, own] = [a, b, i].map(|k| self.classes[k]);
                let distinct = top != bottom && ![top, bottom].iter().any(|c| [own, self.ground].contains(c));
                let between = self.contact(a, b);
                if !distinct || f64::from(between) > CROSSING_CONTACT * f64::from(total) {
                    continue;
                }
                let colors = [regions[i].color, regions[a].color, regions[b].color];
                if let Some((through, off)) = self.opacity(colors, slack(regions, &[i, a, b]))
                    && best.is_none_or(|held| off < held.off)
                {
                    best = Some(Shadow { top: a as u32, bottom: b as u32, through, off });
                }
            }
        }
        best
    }

    /// What shows through `top` if `mixed` is its overlap over `bottom`, and how far from that `mixed` is.
    fn opacity(&self, [mixed, top, bottom]: [[T; 3]; 3], slack: T) -> Option<(T, T)> {
        let ground = self.background;
        if distance(bottom, ground) < T::of(SHADOW_CONTRAST) {
            return None;
        }
        let (mut dot, mut square) = (T::zero(), T::zero());
        for c in 0..3 {
            dot += (mixed[c] - top[c]) * (bottom[c] - ground[c]);
            square += (bottom[c] - ground[c]) * (bottom[c] - ground[c]);
        }
        let through = dot / square;
        let foretold: [T; 3] = core::array::from_fn(|c| top[c] + through * (bottom[c] - ground[c]));
        let off = distance(mixed, foretold);
        let translucent = through >= T::of(THROUGH[0]) && through <= T::of(THROUGH[1]);
        let fits = translucent && off <= T::of(OVERLAP_COLOR) + slack && is_color(self.own_color(top, through));
        fits.then_some((through, off))
    }

    /// The color of a translucent object that shows `seen` over the background.
    fn own_color(&self, seen: [T; 3], through: T) -> [T; 3] {
        let share = T::one() / (T::one() - through);
        core::array::from_fn(|c| (seen[c] - through * self.background[c]) * share)
    }

    fn contact(&self, a: usize, b: usize) -> u32 {
        self.contacts_of(a).find(|&(j, _)| j == b).map_or(0, |(_, n)| n)
    }

    /// An overlap of regions that are overlaps themselves explains nothing.
    fn drop_chained_overlaps(&mut self) {
        for i in 0..self.overlaps.len() {
            if let Some(([top, bottom, _], _)) = self.overlaps[i]
                && (self.overlaps[top as usize].is_some() || self.overlaps[bottom as usize].is_some())
            {
                self.overlaps[i] = None;
            }
        }
    }

    /// Numbers the objects, largest first: one per region that is neither background nor overlap, and one per hole.
    #[expect(clippy::cast_possible_truncation, reason = "an image has at most 2^28 regions")]
    fn name_stacked(&mut self, regions: &[Region<T>]) {
        let mut named = alloc::vec![None; regions.len()];
        for at in 0..self.order.len() {
            let i = self.order[at] as usize;
            if self.classes[i] == self.ground && self.hole(regions, i).is_none() {
                self.covers[i] = Cover::of(&[]);
            } else if self.overlaps[i].is_none() {
                let root = self.sets.root(i as u32) as usize;
                let object = *named[root].get_or_insert_with(|| {
                    self.colors.push(regions[i].color);
                    self.colors.len() as u32 - 1
                });
                self.covers[i] = Cover::of(&[object]);
            }
        }
        self.confidences.resize(self.colors.len(), T::one());
    }

    /// Gives the objects on top of overlaps their opacity and color: the mean over their overlaps.
    fn make_translucent(&mut self, regions: &[Region<T>], through: &[T]) {
        let mut sums = alloc::vec![(T::zero(), T::zero()); self.colors.len()];
        for i in 0..regions.len() {
            if let Some(([top, _, _], _)) = self.overlaps[i]
                && let [object] = *self.covers[top as usize].members()
            {
                let sum = &mut sums[object as usize];
                let weight = T::of_usize(regions[i].pixels);
                *sum = (sum.0 + weight * through[i], sum.1 + weight);
            }
        }
        for (object, &(sum, weight)) in sums.iter().enumerate() {
            if weight > T::zero() {
                let through = sum / weight;
                self.confidences[object] = T::one() - through;
                self.colors[object] = within_unit(self.own_color(self.colors[object], through));
            }
        }
    }

    /// Covers of overlaps of two, and of regions where one more translucent object passes in front of such an overlap.
    fn cover_overlaps(&mut self, regions: &[Region<T>]) {
        for i in 0..regions.len() {
            if let Some((members, _)) = self.overlaps[i] {
                let [top, bottom] =
                    [members[0], members[1]].map(|m| self.covers[m as usize].members().first().copied());
                if let (Some(top), Some(bottom)) = (top, bottom) {
                    self.covers[i] = Cover::of(&[top, bottom]);
                    self.border(top, bottom).front = Some(top);
                }
            }
        }
        for i in 0..regions.len() {
            let single = self.overlaps[i].is_none() && self.classes[i] != self.ground;
            if let Some(cover) = single.then(|| self.triple(regions, i)).flatten() {
                self.covers[i] = cover;
            }
        }
    }

    /// A cover of two beside region `i`, and a translucent object beside it that together show its color.
    fn triple(&self, regions: &[Region<T>], i: usize) -> Option<Cover> {
        let pairs = self.contacts_of(i).filter(|&(j, _)| self.overlaps[j].is_some());
        for (j, _) in pairs {
            let below = self.covers[j];
            let tops = self.contacts_of(i).filter_map(|(k, _)| self.overlaps[k].map(|(members, _)| members[0]));
            for top in tops {
                let [object] = *self.covers[top as usize].members() else { continue };
                let (opacity, color) = (self.confidences[object as usize], self.colors[object as usize]);
                if below.members().contains(&object) || usize::from(below.len) >= MAX_COVER {
                    continue;
                }
                let below_color = regions[j].color;
                let foretold = core::array::from_fn(|c| below_color[c] + opacity * (color[c] - below_color[c]));
                if distance(regions[i].color, foretold) <= T::of(2.0 * OVERLAP_COLOR) + slack(regions, &[i, j]) {
                    let mut members = below.members().to_vec();
                    members.push(object);
                    return Some(Cover::of(&members));
                }
            }
        }
        None
    }

    /// The border between two objects, made if it is new.
    fn border(&mut self, a: u32, b: u32) -> &mut Border {
        let objects = [a.min(b), a.max(b)];
        let at = match self.borders.binary_search_by_key(&objects, |border| border.objects) {
            Ok(at) => at,
            Err(at) => {
                self.borders.insert(at, Border { objects, pixels: 0, front: None });
                at
            }
        };
        &mut self.borders[at]
    }

    /// Lists which objects touch. What lies inside another object is in front of it.
    fn find_borders(&mut self, regions: &[Region<T>]) {
        for at in 0..self.contacts.len() {
            let ([a, b], pixels) = self.contacts[at];
            let [a, b] = [a as usize, b as usize];
            let ([x], [y]) = (self.covers[a].members(), self.covers[b].members()) else { continue };
            let (x, y) = (*x, *y);
            if x == y {
                continue;
            }
            let around = |i: usize| self.hole(regions, i).or_else(|| self.lies_inside(regions, i));
            let front = match (around(a) == Some(b), around(b) == Some(a)) {
                (true, false) => Some(x),
                (false, true) => Some(y),
                _ => None,
            };
            let border = self.border(x, y);
            border.pixels += pixels;
            border.front = border.front.or(front);
        }
        self.borders.retain(|border| border.front.is_some() || border.pixels >= MIN_BORDER);
    }

    /// Makes the objects one, the first; returns what was before.
    pub(crate) fn join(&mut self, objects: &[u32]) -> Stacking {
        let before = Stacking { covers: self.covers.clone(), borders: self.borders.clone() };
        let renamed = |member: u32| objects.first().copied().filter(|_| objects.contains(&member)).unwrap_or(member);
        for cover in &mut self.covers {
            if cover.members().iter().any(|member| objects.contains(member)) {
                let mut members: Vec<u32> = cover.members().iter().copied().map(renamed).collect();
                members.dedup();
                *cover = Cover::of(&members);
            }
        }
        self.borders.clear();
        for border in &before.borders {
            let [a, b] = border.objects.map(renamed);
            if a != b {
                let joined = self.border(a, b);
                joined.pixels += border.pixels;
                joined.front = joined.front.or(border.front.map(renamed));
            }
        }
        before
    }

    /// Undoes [`Self::join`].
    pub(crate) fn restore(&mut self, before: Stacking) {
        self.covers = before.covers;
        self.borders = before.borders;
    }
}
