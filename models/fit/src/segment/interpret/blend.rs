//! The reading under `blend` compositing: an overlap shows the mean of the colors of its objects, so a region whose color is
//! the mean of two or three others it lies between is their overlap and no object of its own.

use dvp_core::Real;
use dvp_core::image::distance;
use dvp_core::render::Compositing;

use super::{Cover, MAX_COVER, Reading, is_color, mean, mixed_in, slack, within_unit};
use crate::segment::region::Region;
use crate::tuning::MEAN_COLOR;

impl<T: Real> Reading<T> {
    /// Reads the prepared regions as blended.
    pub(crate) fn read_blend(&mut self, regions: &[Region<T>]) {
        self.start(Compositing::Blend, regions.len());
        self.overlaps.clear();
        self.overlaps.resize(regions.len(), None);
        for i in 0..regions.len() {
            if self.classes[i] != self.ground {
                self.overlaps[i] = self.pair_overlap(regions, i);
            }
        }
        for i in 0..regions.len() {
            if self.classes[i] != self.ground && self.overlaps[i].is_none() {
                self.overlaps[i] = self.triple_overlap(regions, i);
            }
        }
        self.name_blended(regions);
        self.confidences.resize(self.colors.len(), T::one());
    }

    /// The two regions whose mean color region `i` shows and between which it lies.
    #[expect(clippy::cast_possible_truncation, reason = "an image has at most 2^28 regions")]
    fn pair_overlap(&self, regions: &[Region<T>], i: usize) -> Option<([u32; MAX_COVER], u8)> {
        self.contacts_of_overlap(i)?;
        let mut best: Option<(T, [u32; MAX_COVER])> = None;
        for (a, _) in self.contacts_of(i) {
            for (b, _) in self.contacts_of(i) {
                let classes = [self.classes[a], self.classes[b], self.classes[i], self.ground];
                let distinct = classes[0] != classes[1] && !classes[2..].contains(&classes[0]);
                if a >= b || !distinct || classes[2..].contains(&classes[1]) {
                    continue;
                }
                let off = distance(regions[i].color, mean(&[regions[a].color, regions[b].color]));
                let tolerance = T::of(MEAN_COLOR) + slack(regions, &[a, b, i]);
                if off <= tolerance && best.is_none_or(|(o, _)| off < o) {
                    best = Some((off, [a as u32, b as u32, 0]));
                }
            }
        }
        best.map(|(_, members)| (members, 2))
    }

    /// The three regions whose mean color region `i` shows, taken from the overlaps it touches.
    fn triple_overlap(&self, regions: &[Region<T>], i: usize) -> Option<([u32; MAX_COVER], u8)> {
        let mut members: [u32; 8] = [0; 8];
        let mut count = 0;
        for (j, _) in self.contacts_of(i) {
            let Some((pair, 2)) = self.overlaps[j] else { continue };
            for &member in &pair[..2] {
                let class = self.classes[member as usize];
                let seen = members[..count].iter().any(|&m| self.classes[m as usize] == class);
                if !seen && count < members.len() && class != self.ground {
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
                    let [x, y, z] = triple.map(|m| m as usize);
                    let tolerance = T::of(MEAN_COLOR) + slack(regions, &[x, y, z, i]);
                    if off <= tolerance && best.is_none_or(|(o, _)| off < o) {
                        best = Some((off, triple));
                    }
                }
            }
        }
        best.map(|(_, members)| (members, 3))
    }

    /// Numbers the objects: single regions of one color that share an overlap are one object.
    #[expect(clippy::cast_possible_truncation, reason = "an image has at most 2^28 regions")]
    fn name_blended(&mut self, regions: &[Region<T>]) {
        for i in 0..regions.len() {
            let Some((members, len)) = self.overlaps[i] else { continue };
            self.join_singles(i, &members[..usize::from(len)]);
        }
        // What covers the regions of a set, by its root.
        let mut named = alloc::vec![Cover::default(); regions.len()];
        // Largest first, so that object 0 is the largest.
        for at in 0..self.order.len() {
            let i = self.order[at];
            if self.classes[i as usize] == self.ground {
                self.covers[i as usize] = Cover::of(&[]);
            } else if self.overlaps[i as usize].is_none() {
                let root = self.sets.root(i) as usize;
                if !named[root].known {
                    named[root] = match self.host(regions, i as usize) {
                        Some((host, color)) => {
                            self.colors.push(color);
                            Cover::of(&[host, self.colors.len() as u32 - 1])
                        }
                        None => {
                            self.colors.push(regions[i as usize].color);
                            Cover::of(&[self.colors.len() as u32 - 1])
                        }
                    };
                }
                self.covers[i as usize] = named[root];
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
        let outer = self.lies_mostly_inside(regions, i)?;
        let [host] = *self.covers[outer].members() else { return None };
        let color = mixed_in(regions[i].color, regions[outer].color);
        is_color(color).then(|| (host, within_unit(color)))
    }
}
