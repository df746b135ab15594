//! Which objects cover each flat region: background, one object, or the overlap of two or three.
//!
//! Under `blend` compositing an overlap shows the mean of the colors of its objects, so a region whose color is the mean
//! of two or three others it lies between is their overlap and no object of its own.

use alloc::vec::Vec;

use dvp_core::Real;

use super::region::Region;
use super::transition::Transition;

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

/// The reading of all regions.
#[derive(Clone, Debug, Default)]
pub(crate) struct Reading<T> {
    pub(crate) background: [T; 3],
    /// Per region.
    pub(crate) covers: Vec<Cover>,
    /// Per object.
    pub(crate) colors: Vec<[T; 3]>,
    contacts: Vec<([u32; 2], u32)>,
    classes: Vec<u32>,
    order: Vec<u32>,
    overlaps: Vec<Option<([u32; MAX_COVER], u8)>>,
    parents: Vec<u32>,
}

/// Colors closer than this in every channel are one color (two rounding errors of 8 bits).
const SAME_COLOR: f64 = 0.008;
/// How exactly an overlap shows the mean of its colors.
const MEAN_COLOR: f64 = 0.006;
/// An overlap touches the background at most with this share of its contacts (outlines cross in points).
const BACKGROUND_CONTACT: f64 = 0.34;

fn distance<T: Real>(a: [T; 3], b: [T; 3]) -> T {
    (a[0] - b[0]).abs().max((a[1] - b[1]).abs()).max((a[2] - b[2]).abs())
}

fn mean<T: Real>(colors: &[[T; 3]]) -> [T; 3] {
    let share = T::one() / T::of_usize(colors.len().max(1));
    core::array::from_fn(|c| colors.iter().map(|color| color[c]).sum::<T>() * share)
}

impl<T: Real> Reading<T> {
    /// Reads `regions`; false if there is none.
    pub(crate) fn read(&mut self, regions: &[Region<T>], transitions: &[Transition<T>]) -> bool {
        self.covers.clear();
        self.colors.clear();
        if regions.is_empty() {
            return false;
        }
        self.count_contacts(transitions);
        self.classify(regions);
        let background = self.choose_background(regions);
        self.overlaps.clear();
        self.overlaps.resize(regions.len(), None);
        for i in 0..regions.len() {
            if self.classes[i] != background {
                self.overlaps[i] = self.pair_overlap(regions, i, background);
            }
        }
        for i in 0..regions.len() {
            if self.classes[i] != background && self.overlaps[i].is_none() {
                self.overlaps[i] = self.triple_overlap(regions, i, background);
            }
        }
        self.name_objects(regions, background);
        true
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
                    && distance(regions[j as usize].color, regions[i].color) <= T::of(SAME_COLOR)
            });
            self.classes[i] = same.unwrap_or(i as u32);
        }
    }

    fn choose_background(&mut self, regions: &[Region<T>]) -> u32 {
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
        self.background = regions[best.1 as usize].color;
        best.1
    }

    /// The two regions whose mean color region `i` shows and between which it lies.
    #[expect(clippy::cast_possible_truncation, reason = "an image has at most 2^28 regions")]
    fn pair_overlap(&self, regions: &[Region<T>], i: usize, background: u32) -> Option<([u32; MAX_COVER], u8)> {
        let (mut total, mut ground) = (0, 0);
        for (j, n) in self.contacts_of(i) {
            total += n;
            ground += if self.classes[j] == background { n } else { 0 };
        }
        if f64::from(ground) > BACKGROUND_CONTACT * f64::from(total) {
            return None;
        }
        let mut best: Option<(T, [u32; MAX_COVER])> = None;
        for (a, _) in self.contacts_of(i) {
            for (b, _) in self.contacts_of(i) {
                let classes = [self.classes[a], self.classes[b], self.classes[i], background];
                let distinct = classes[0] != classes[1] && !classes[2..].contains(&classes[0]);
                if a >= b || !distinct || classes[2..].contains(&classes[1]) {
                    continue;
                }
                let off = distance(regions[i].color, mean(&[regions[a].color, regions[b].color]));
                if off <= T::of(MEAN_COLOR) && best.is_none_or(|(o, _)| off < o) {
                    best = Some((off, [a as u32, b as u32, 0]));
                }
            }
        }
        best.map(|(_, members)| (members, 2))
    }

    /// The three regions whose mean color region `i` shows, taken from the overlaps it touches.
    fn triple_overlap(&self, regions: &[Region<T>], i: usize, background: u32) -> Option<([u32; MAX_COVER], u8)> {
        let mut members: [u32; 8] = [0; 8];
        let mut count = 0;
        for (j, _) in self.contacts_of(i) {
            let Some((pair, 2)) = self.overlaps[j] else { continue };
            for &member in &pair[..2] {
                let class = self.classes[member as usize];
                let seen = members[..count].iter().any(|&m| self.classes[m as usize] == class);
                if !seen && count < members.len() && class != background {
                    members[count] = member;
                    count += 1;
                }
            }
        }
        let mut best: Option<(T, [u32; MAX_COVER])> = None;
        for a in 0..count {
            for b in a + 1..count {
                for c in b + 1..count {
                    let triple = [members[a], members[b], members[c]];
                    let off = distance(regions[i].color, mean(&triple.map(|m| regions[m as usize].color)));
                    if off <= T::of(MEAN_COLOR) && best.is_none_or(|(o, _)| off < o) {
                        best = Some((off, triple));
                    }
                }
            }
        }
        best.map(|(_, members)| (members, 3))
    }

    /// Numbers the objects: single regions of one color that share an overlap are one object.
    #[expect(clippy::cast_possible_truncation, reason = "an image has at most 2^28 regions")]
    fn name_objects(&mut self, regions: &[Region<T>], background: u32) {
        self.parents.clear();
        self.parents.extend(0..regions.len() as u32);
        for i in 0..regions.len() {
            let Some((members, len)) = self.overlaps[i] else { continue };
            for &member in &members[..usize::from(len)] {
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
                        let (low, high) = (self.top(other), self.top(member));
                        self.parents[low.max(high) as usize] = low.min(high);
                    }
                }
            }
        }
        self.covers.resize(regions.len(), Cover::default());
        // Largest first, so that object 0 is the largest.
        for at in 0..self.order.len() {
            let i = self.order[at];
            if self.classes[i as usize] == background {
                self.covers[i as usize] = Cover::of(&[]);
            } else if self.overlaps[i as usize].is_none() {
                let top = self.top(i);
                let known = self.order[..at].iter().copied().find(|&j| {
                    self.overlaps[j as usize].is_none()
                        && self.classes[j as usize] != background
                        && self.parents[j as usize] == top
                });
                self.parents[i as usize] = top;
                self.covers[i as usize] = match (known, self.host(regions, i as usize)) {
                    (Some(j), _) => self.covers[j as usize],
                    (None, Some((host, color))) => {
                        self.colors.push(color);
                        Cover::of(&[host, self.colors.len() as u32 - 1])
                    }
                    (None, None) => {
                        self.colors.push(regions[i as usize].color);
                        Cover::of(&[self.colors.len() as u32 - 1])
                    }
                };
            }
        }
        for i in 0..regions.len() {
            if let Some((members, len)) = self.overlaps[i] {
                let mut objects = [0; MAX_COVER];
                for (object, &member) in objects.iter_mut().zip(&members[..usize::from(len)]) {
                    *object = self.covers[member as usize].members().first().copied().unwrap_or(0);
                }
                self.covers[i] = Cover::of(&objects[..usize::from(len)]);
            }
        }
    }

    /// The object that region `i` lies inside, if it touches nothing else, and the color that makes `i` the mean of both.
    fn host(&self, regions: &[Region<T>], i: usize) -> Option<(u32, [T; 3])> {
        let mut contacts = self.contacts_of(i);
        let (outer, _) = contacts.next()?;
        let alone = contacts.next().is_none() && regions[i].border == 0;
        let [host] = *self.covers[outer].members() else { return None };
        let two = T::of(2.0);
        let color: [T; 3] = core::array::from_fn(|c| two * regions[i].color[c] - regions[outer].color[c]);
        // Two rounding errors of 8 bits.
        let slack = T::of(0.006);
        let possible = color.iter().all(|&v| v >= -slack && v <= T::one() + slack);
        (alone && possible).then(|| (host, color.map(|v| v.max(T::zero()).min(T::one()))))
    }

    fn top(&self, mut i: u32) -> u32 {
        while self.parents[i as usize] != i {
            i = self.parents[i as usize];
        }
        i
    }
}
