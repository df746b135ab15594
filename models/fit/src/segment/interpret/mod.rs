//! Which objects cover each flat region: background, one object, or the overlap of several.
//!
//! There are two ways to read a picture. `blend`: objects mix, and an overlap shows the mean of its colors. `over`: objects
//! hide what is behind them, so every region shows one object, or a translucent one over others. [`Reading::prepare`] does
//! what both share and [`Reading::evidence`] tells which of the two the regions speak for.

mod blend;
mod evidence;
mod over;

use alloc::vec::Vec;

use dvp_core::Real;
use dvp_core::geometry::DisjointSets;
use dvp_core::image::distance;
use dvp_core::render::Compositing;

use super::color::SAME_COLOR;
use super::region::Region;
use super::transition::Transition;
use crate::tuning::{BACKGROUND_CONTACT, HOLE_CONTACT, MIN_BORDER, MOSTLY_INSIDE};
pub(crate) use evidence::Evidence;

/// The most objects one region may be covered by.
pub(crate) const MAX_COVER: usize = 3;

/// Objects that cover a region, ascending.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Cover {
    objects: [u32; MAX_COVER],
    len: u8,
    /// Whether the region was understood at all.
    pub(crate) known: bool,
}

impl Cover {
    fn of(members: &[u32]) -> Self {
        let mut cover = Self { known: true, ..Self::default() };
        for &member in members.iter().take(MAX_COVER) {
            cover.objects[usize::from(cover.len)] = member;
            cover.len += 1;
        }
        let len = usize::from(cover.len);
        cover.objects[..len].sort_unstable();
        cover
    }

    pub(crate) fn members(&self) -> &[u32] {
        &self.objects[..usize::from(self.len)]
    }

    /// The one object in `self` but not in `other`, if `self` is `other` plus one.
    pub(crate) fn beyond(&self, other: &Self) -> Option<u32> {
        if !self.known || !other.known || self.len != other.len + 1 {
            return None;
        }
        let mut extra = self.members().iter().filter(|member| !other.members().contains(member));
        let first = extra.next()?;
        extra.next().is_none().then_some(*first)
    }
}

/// Two objects that touch without mixing: one of them hides a part of the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Border {
    /// The lower index first.
    pub(crate) objects: [u32; 2],
    /// Soft pixels between the two.
    pub(crate) pixels: u32,
    /// Which of the two is in front, once known.
    pub(crate) front: Option<u32>,
}

/// What covers what, as it was before two objects were joined.
#[derive(Clone, Debug)]
pub(crate) struct Stacking {
    covers: Vec<Cover>,
    borders: Vec<Border>,
}

/// The reading of all regions.
#[derive(Clone, Debug, Default)]
pub(crate) struct Reading<T> {
    pub(crate) compositing: Compositing,
    pub(crate) background: [T; 3],
    /// Per region.
    pub(crate) covers: Vec<Cover>,
    /// Per object.
    pub(crate) colors: Vec<[T; 3]>,
    /// Per object; below 1 for translucent ones.
    pub(crate) confidences: Vec<T>,
    /// Ascending by objects.
    pub(crate) borders: Vec<Border>,
    /// Class of the background.
    ground: u32,
    contacts: Vec<([u32; 2], u32)>,
    classes: Vec<u32>,
    order: Vec<u32>,
    overlaps: Vec<Option<([u32; MAX_COVER], u8)>>,
    /// Regions of one object.
    sets: DisjointSets,
}

/// Twice the standard deviation of a difference between the colors of regions that noise has left in doubt.
fn slack<T: Real>(regions: &[Region<T>], compared: &[usize]) -> T {
    T::of(2.0) * compared.iter().map(|&i| regions[i].doubt * regions[i].doubt).sum::<T>().sqrt()
}

fn mean<T: Real>(colors: &[[T; 3]]) -> [T; 3] {
    let share = T::one() / T::of_usize(colors.len().max(1));
    core::array::from_fn(|c| colors.iter().map(|color| color[c]).sum::<T>() * share)
}

/// The color whose mean with `host` is `color`.
fn mixed_in<T: Real>(color: [T; 3], host: [T; 3]) -> [T; 3] {
    core::array::from_fn(|c| color[c] + color[c] - host[c])
}

/// Whether all channels are in [0, 1], but for two rounding errors of 8 bits.
fn is_color<T: Real>(color: [T; 3]) -> bool {
    let slack = T::of(0.006);
    color.iter().all(|&v| v >= -slack && v <= T::one() + slack)
}

fn within_unit<T: Real>(color: [T; 3]) -> [T; 3] {
    color.map(|v| v.max(T::zero()).min(T::one()))
}

impl<T: Real> Reading<T> {
    /// Takes in `regions`; false if there is none. [`Self::read_blend`] or [`Self::read_over`] must follow.
    pub(crate) fn prepare(&mut self, regions: &[Region<T>], transitions: &[Transition<T>]) -> bool {
        self.covers.clear();
        self.colors.clear();
        if regions.is_empty() {
            return false;
        }
        self.count_contacts(transitions);
        self.classify(regions);
        self.choose_background(regions);
        true
    }

    /// Forgets the objects of an earlier reading.
    #[expect(clippy::cast_possible_truncation, reason = "an image has at most 2^28 regions")]
    fn start(&mut self, compositing: Compositing, regions: usize) {
        self.compositing = compositing;
        self.covers.clear();
        self.covers.resize(regions, Cover::default());
        self.colors.clear();
        self.confidences.clear();
        self.borders.clear();
        self.sets.reset(regions as u32);
    }

    /// The region around region `i`, if `i` shows the background through a hole of it.
    ///
    /// Other objects may reach into the hole; a gap between objects is no hole of the largest of them.
    fn hole(&self, regions: &[Region<T>], i: usize) -> Option<usize> {
        if self.classes[i] != self.ground || regions[i].border > 0 {
            return None;
        }
        let outer = self.main_contact(i, HOLE_CONTACT)?;
        let [l, t, r, b] = regions[i].bounds;
        let [left, top, right, bottom] = regions[outer].bounds;
        (left < l && top < t && right > r && bottom > b).then_some(outer)
    }

    /// The one other region that region `i` touches, if it does not touch the border of the image either.
    fn lies_inside(&self, regions: &[Region<T>], i: usize) -> Option<usize> {
        let mut contacts = self.contacts_of(i);
        let (outer, _) = contacts.next()?;
        (contacts.next().is_none() && regions[i].border == 0).then_some(outer)
    }

    /// The region that region `i` lies inside, even if it reaches out of it a little, as one object drawn over another may.
    fn lies_mostly_inside(&self, regions: &[Region<T>], i: usize) -> Option<usize> {
        let outer = self.main_contact(i, MOSTLY_INSIDE)?;
        (regions[i].border == 0).then_some(outer)
    }

    /// The region that region `i` touches most, if with at least this share of its contacts.
    fn main_contact(&self, i: usize, least_share: f64) -> Option<usize> {
        let (other, most) = self.contacts_of(i).max_by_key(|&(_, pixels)| pixels)?;
        let total: u32 = self.contacts_of(i).map(|(_, pixels)| pixels).sum();
        (f64::from(most) >= least_share * f64::from(total)).then_some(other)
    }

    /// Soft pixels around region `i`; none if too many of them lie beside the background for it to be an overlap.
    fn contacts_of_overlap(&self, i: usize) -> Option<u32> {
        let (mut total, mut ground) = (0, 0);
        for (j, n) in self.contacts_of(i) {
            total += n;
            ground += if self.classes[j] == self.ground { n } else { 0 };
        }
        (f64::from(ground) <= BACKGROUND_CONTACT * f64::from(total)).then_some(total)
    }

    /// Contacts of region `i`: (other region, number of soft pixels between).
    fn contacts_of(&self, i: usize) -> impl Iterator<Item = (usize, u32)> + '_ {
        self.contacts.iter().filter_map(move |&([a, b], n)| {
            if a as usize == i {
                Some((b as usize, n))
            } else if b as usize == i {
                Some((a as usize, n))
            } else {
                None
            }
        })
    }

    /// Whether the object ends where another one does, or overlaps with one.
    pub(crate) fn meets_another(&self, object: u32) -> bool {
        let members = |region: u32| self.covers[region as usize].members();
        let ends = |own: u32, other: u32| {
            members(own).contains(&object) && !members(other).is_empty() && !members(other).contains(&object)
        };
        let shared = |cover: &Cover| cover.members().len() > 1 && cover.members().contains(&object);
        self.contacts.iter().any(|&([a, b], pixels)| pixels >= MIN_BORDER && (ends(a, b) || ends(b, a)))
            || self.borders.iter().any(|border| border.objects.contains(&object))
            || self.covers.iter().any(shared)
    }

    fn count_contacts(&mut self, transitions: &[Transition<T>]) {
        self.contacts.clear();
        for transition in transitions {
            // Neighbors in reading order mostly share their pair: the last few entries are looked at first.
            match self.contacts.iter_mut().rev().find(|(pair, _)| *pair == transition.pair) {
                Some((_, count)) => *count += 1,
                None => self.contacts.push((transition.pair, 1)),
            }
        }
    }

    #[expect(clippy::cast_possible_truncation, reason = "an image has at most 2^28 regions")]
    fn classify(&mut self, regions: &[Region<T>]) {
        self.order.clear();
        self.order.extend(0..regions.len() as u32);
        self.order.sort_unstable_by_key(|&i| core::cmp::Reverse(regions[i as usize].pixels));
        self.classes.clear();
        self.classes.resize(regions.len(), 0);
        // The class of a region is the largest region of that color.
        for at in 0..self.order.len() {
            let i = self.order[at] as usize;
            let same = self.order[..at].iter().copied().find(|&j| {
                self.classes[j as usize] == j
                    && distance(regions[j as usize].color, regions[i].color)
                        <= T::of(SAME_COLOR) + slack(regions, &[j as usize, i])
            });
            self.classes[i] = same.unwrap_or(i as u32);
        }
    }

    fn choose_background(&mut self, regions: &[Region<T>]) {
        let weight = |class: u32| -> usize {
            let members = regions.iter().zip(&self.classes).filter(|(_, c)| **c == class);
            members.map(|(region, _)| if region.border > 0 { region.pixels + 4 * region.border } else { 0 }).sum()
        };
        let mut best = (0, self.order[0]);
        for &i in &self.order {
            if self.classes[i as usize] == i {
                let score = weight(i);
                if score > best.0 {
                    best = (score, i);
                }
            }
        }
        self.ground = best.1;
        self.background = regions[best.1 as usize].color;
    }

    /// Single regions of one color that touch overlap `i` and show one of its `members` are one object.
    fn join_singles(&mut self, i: usize, members: &[u32]) {
        for &member in members {
            for at in 0..self.contacts.len() {
                let ([a, b], _) = self.contacts[at];
                let other = if a as usize == i {
                    b
                } else if b as usize == i {
                    a
                } else {
                    continue;
                };
                let single = self.overlaps[other as usize].is_none();
                if single && self.classes[other as usize] == self.classes[member as usize] {
                    self.sets.unite(other, member);
                }
            }
        }
    }
}
