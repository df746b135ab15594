//! Clip paths and masks to regions.

use alloc::rc::Rc;

use dvp_core::Pose;
use dvp_core::scene::Region;
use dvp_core::shape::{Polygon, ShapeError};
use kurbo::{Affine, Point};
use usvg::{ClipPath, Group, Mask, MaskType, Node};

use super::error::SvgError;
use super::place::{Placed, array};
use super::walk::{Layer, Walk, affine_of};

/// Rings with less area than this, squared pixels, are left out: what rounding leaves where edges coincide.
const LEAST_AREA_PX: f64 = 1e-6;

/// Masks of less than this share hide, those of more than its complement show.
const CLEAR: f64 = 2e-3;

/// Shares of red, green and blue in what masks are measured by.
const LUMINANCE: [f64; 3] = [0.2125, 0.7154, 0.0721];

impl Walk<'_> {
    /// The part of `region` that the clip path and the mask of a group leave.
    pub(super) fn narrowed(
        &mut self,
        group: &Group,
        region: Option<Rc<Region>>,
    ) -> Result<Option<Rc<Region>>, SvgError> {
        let affine = affine_of(group.abs_transform());
        let mut region = region;
        if let Some(clip) = group.clip_path() {
            let own = self.clip_region(clip, affine)?;
            region = Some(Rc::new(common(region.as_deref(), own)?));
        }
        if let Some(mask) = group.mask() {
            match self.mask_region(mask, affine)? {
                Some(own) => region = Some(Rc::new(common(region.as_deref(), own)?)),
                None => self.losses.add("mask that is neither black nor white: not applied"),
            }
        }
        Ok(region)
    }

    fn clip_region(&mut self, clip: &ClipPath, affine: Affine) -> Result<Region, SvgError> {
        let mut region = self.clip_children(clip.root(), affine * affine_of(clip.transform()))?;
        if let Some(further) = clip.clip_path() {
            region = region.intersection(&self.clip_region(further, affine)?)?;
        }
        Ok(region)
    }

    fn clip_children(&mut self, group: &Group, affine: Affine) -> Result<Region, SvgError> {
        let mut region = Region::default();
        for child in group.children() {
            let own = match child {
                Node::Group(group) => {
                    let inside = self.clip_children(group, affine)?;
                    match group.clip_path() {
                        None => inside,
                        Some(clip) => {
                            let base = affine * affine_of(group.abs_transform());
                            inside.intersection(&self.clip_region(clip, base)?)?
                        }
                    }
                }
                Node::Path(path) if path.is_visible() => {
                    let sketch = self.sketch(path, affine)?;
                    let Some((placed, _)) = self.fill_of(path, &sketch) else { continue };
                    Region::of(&placed, self.tolerance())?
                }
                _ => continue,
            };
            region = region.union(&own)?;
        }
        Ok(region)
    }

    /// Where a mask shows; none if it shows anything by half.
    fn mask_region(&mut self, mask: &Mask, affine: Affine) -> Result<Option<Region>, SvgError> {
        let mut region = Region::default();
        if !self.mask_children(mask.root(), affine, mask.kind(), &mut region)? {
            return Ok(None);
        }
        let rect = mask.rect();
        let [left, top, right, bottom] = [rect.left(), rect.top(), rect.right(), rect.bottom()].map(f64::from);
        let corners = [(left, top), (right, top), (right, bottom), (left, bottom)];
        let corners = corners.map(|corner| array(Affine::scale(self.px) * affine * Point::from(corner))).to_vec();
        let limits: Placed = (Polygon::new(vec![corners])?.into(), Pose::identity());
        region = region.intersection(&Region::of(&limits, self.tolerance())?)?;
        match mask.mask() {
            None => Ok(Some(region)),
            Some(further) => match self.mask_region(further, affine)? {
                None => Ok(None),
                Some(further) => Ok(Some(region.intersection(&further)?)),
            },
        }
    }

    /// Paints into a mask; false if anything is shown by half.
    fn mask_children(
        &mut self,
        group: &Group,
        affine: Affine,
        kind: MaskType,
        region: &mut Region,
    ) -> Result<bool, SvgError> {
        let is_plain = group.opacity().get() >= 1.0
            && group.filters().is_empty()
            && group.mask().is_none()
            && group.clip_path().is_none();
        if !is_plain {
            return Ok(false);
        }
        for child in group.children() {
            match child {
                Node::Group(group) => {
                    if !self.mask_children(group, affine, kind, region)? {
                        return Ok(false);
                    }
                }
                Node::Path(path) if path.is_visible() => {
                    let sketch = self.sketch(path, affine)?;
                    let layers = [self.fill_of(path, &sketch), self.stroke_of(path, &sketch)?];
                    for layer in layers.into_iter().flatten() {
                        if !paint(&layer, kind, self.tolerance(), region)? {
                            return Ok(false);
                        }
                    }
                }
                Node::Path(_) => (),
                Node::Image(_) | Node::Text(_) => return Ok(false),
            }
        }
        Ok(true)
    }
}

/// Adds what shows, takes out what hides; false if it does something between.
fn paint((placed, coat): &Layer, kind: MaskType, tolerance: f64, region: &mut Region) -> Result<bool, SvgError> {
    let luminance: f64 = coat.paint.color().iter().zip(LUMINANCE).map(|(value, share)| value * share).sum();
    let is_opaque = coat.opacity > 1.0 - CLEAR;
    let own = Region::of(placed, tolerance)?;
    if is_opaque && (kind == MaskType::Alpha || luminance > 1.0 - CLEAR) {
        *region = region.union(&own)?;
    } else if is_opaque && luminance < CLEAR {
        *region = region.difference(&own)?;
    } else {
        return Ok(false);
    }
    Ok(true)
}

fn common(outer: Option<&Region>, own: Region) -> Result<Region, SvgError> {
    match outer {
        None => Ok(own),
        Some(outer) => Ok(outer.intersection(&own)?),
    }
}

/// A shape inside of a region, with whether it was cut; none if nothing is left. `px` scene units per pixel.
pub(super) fn cut(
    placed: Placed,
    region: &Rc<Region>,
    tolerance: f64,
    px: f64,
) -> Result<Option<(Placed, bool)>, ShapeError> {
    let own = Region::of(&placed, tolerance)?;
    let Some(bounds) = own.bounds() else { return Ok(None) };
    if region.contains(bounds) {
        return Ok(Some((placed, false)));
    }
    Ok(own.intersection(region)?.to_placed(LEAST_AREA_PX * px * px)?.map(|placed| (placed, true)))
}
