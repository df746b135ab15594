//! Which way of compositing the soft pixels between regions speak for.

use alloc::vec::Vec;

use dvp_core::Real;

use super::{MAX_COVER, Reading, is_color, mixed_in};
use crate::segment::region::Region;

/// Soft pixels that speak for a way to read the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Evidence {
    /// Around regions that show the mean of two or three colors beside them.
    pub(crate) mean: u32,
    /// Between two objects that have no mean color between them.
    pub(crate) direct: u32,
    /// Around regions that lie inside another: both ways of reading explain those.
    pub(crate) inside: u32,
}

/// What the soft pixels between two regions say of compositing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Touch {
    Mean,
    Direct,
    Inside,
}

impl<T: Real> Reading<T> {
    /// What the regions say of compositing; to be asked after [`Self::read_blend`].
    pub(crate) fn evidence(&self, regions: &[Region<T>]) -> Evidence {
        let mut evidence = Evidence::default();
        for &([a, b], pixels) in &self.contacts {
            match self.touch(regions, a as usize, b as usize) {
                Some(Touch::Mean) => evidence.mean += pixels,
                Some(Touch::Direct) => evidence.direct += pixels,
                Some(Touch::Inside) => evidence.inside += pixels,
                None => {}
            }
        }
        evidence
    }

    /// What two regions that touch say of compositing.
    fn touch(&self, regions: &[Region<T>], a: usize, b: usize) -> Option<Touch> {
        let single = |i: usize| self.classes[i] != self.ground && self.overlaps[i].is_none();
        if self.overlaps[a].is_some() || self.overlaps[b].is_some() {
            return Some(Touch::Mean);
        }
        if self.hole(regions, a).is_some() || self.hole(regions, b).is_some() {
            return Some(Touch::Direct);
        }
        if !single(a) || !single(b) || self.classes[a] == self.classes[b] {
            return None;
        }
        let inside =
            |i: usize| self.lies_mostly_inside(regions, i).map(|outer| [regions[i].color, regions[outer].color]);
        match inside(a).or_else(|| inside(b)) {
            // What no color mixed with the host's can show lies on top of it.
            Some([color, host]) if is_color(mixed_in(color, host)) => Some(Touch::Inside),
            Some(_) => Some(Touch::Direct),
            None => (!self.mix_somewhere(a, b)).then_some(Touch::Direct),
        }
    }

    /// Pairs of regions that speak for one object hiding the other; to be asked after [`Self::read_blend`].
    pub(crate) fn direct_pairs(&self, regions: &[Region<T>]) -> Vec<[u32; 2]> {
        let direct = |&[a, b]: &[u32; 2]| self.touch(regions, a as usize, b as usize) == Some(Touch::Direct);
        self.contacts.iter().map(|(pair, _)| *pair).filter(direct).collect()
    }

    /// Whether some region shows the mean of the colors of regions `a` and `b`.
    fn mix_somewhere(&self, a: usize, b: usize) -> bool {
        let shows = |overlap: &([u32; MAX_COVER], u8), class: u32| {
            overlap.0[..usize::from(overlap.1)].iter().any(|&member| self.classes[member as usize] == class)
        };
        let mut overlaps = self.overlaps.iter().flatten();
        overlaps.any(|overlap| shows(overlap, self.classes[a]) && shows(overlap, self.classes[b]))
    }
}
