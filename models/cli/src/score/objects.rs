//! Objects against objects: the measures of the field's benchmarks.
//!
//! In: two [`Parts`], of what was drawn and of what was found. Out: an [`ObjectScore`], and of many pictures their [`ObjectTotals`].
//!
//! | column | measure |
//! |---|---|
//! | ARI-FG | adjusted Rand index of the pixels that the truth gives to an object (`multi_object_datasets`) |
//! | ARI | of all pixels, the background a label as others |
//! | OCA | share of pictures with the right number of objects |
//! | OOA | share of pairs of overlapping objects whose order is right, weighted by how much of the picture depends on it |
//! | IoU, F1 | of whole objects, hidden parts too: mean over the true ones, 0 for those without a partner |
//! | classes | mean over the classes of the share of their pixels that are given to an object of that class |
//!
//! *Source*: OCA, OOA, IoU and F1 as at `FudanVI/compositional-scene-representation-toolbox`, with partners of the largest sum of IoU; the
//! accuracy of classes as at `monniert/dti-sprites` without the background, except that pixels of objects that were not found or have
//! no class count as wrong there, where that program leaves them out.

use dvp_core::ImageView;
use dvp_core::matching::{CostMatrix, Hungarian};
use dvp_core::metric::{RandIndexScratch, adjusted_rand_index};

use super::ScoreError;
use super::classes::Confusion;

/// What is in a picture.
#[derive(Clone, Debug, Default)]
pub struct Parts {
    /// Which object each pixel shows: 0 for the background, k for object k, from 1.
    pub labels: Vec<u32>,
    /// Which pixels every object covers, also where others hide it: objects x pixels, in the order of painting; none if not known.
    pub whole: Option<Vec<bool>>,
    /// Whether the order of `whole` is that of painting.
    pub ordered: bool,
    /// The class of object 1, 2, ...; none where it is not known. Objects beyond its length have none.
    pub classes: Vec<Option<u32>>,
}

impl Parts {
    /// How many objects are seen.
    #[must_use]
    pub fn seen(&self) -> usize {
        let mut labels: Vec<u32> = self.labels.iter().copied().filter(|&label| label > 0).collect();
        labels.sort_unstable();
        labels.dedup();
        labels.len()
    }

    /// The whole mask of object `k`, from 0.
    fn mask(&self, k: usize) -> Option<&[bool]> {
        self.whole.as_deref()?.chunks_exact(self.labels.len().max(1)).nth(k)
    }

    /// Whole masks that are known.
    fn masks(&self) -> usize {
        self.whole.as_ref().map_or(0, |whole| whole.len() / self.labels.len().max(1))
    }

    /// The class of what a label names.
    fn class(&self, label: u32) -> Option<u32> {
        let object = usize::try_from(label).ok()?.checked_sub(1)?;
        self.classes.get(object).copied().flatten()
    }
}

/// A sum and what it is divided by.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Share {
    /// The sum.
    pub sum: f64,
    /// The weight of its terms.
    pub weight: f64,
}

impl Share {
    /// Adds another one.
    pub fn add(&mut self, other: Self) {
        self.sum += other.sum;
        self.weight += other.weight;
    }

    /// The mean; none without weight.
    #[must_use]
    pub fn mean(&self) -> Option<f64> {
        (self.weight > 0.0).then(|| self.sum / self.weight)
    }
}

/// The scores of one picture.
#[derive(Clone, Debug, PartialEq)]
pub struct ObjectScore {
    /// Adjusted Rand index of the pixels of true objects.
    pub ari_foreground: f64,
    /// Adjusted Rand index of all pixels.
    pub ari: f64,
    /// True objects that are seen.
    pub true_objects: usize,
    /// Found objects that are seen.
    pub found_objects: usize,
    /// Intersection over union of whole objects; without weight if the truth does not tell them.
    pub iou: Share,
    /// Twice the intersection over the sum of areas, of the same pairs.
    pub f1: Share,
    /// Pairs of overlapping objects in the right order.
    pub order: Share,
    /// Pixels of true classes by found classes.
    pub classes: Confusion,
}

/// Scores what was found in a picture.
///
/// # Errors
/// [`ScoreError::Metric`] if the label maps are not of one length.
pub fn score_objects(image: ImageView<'_, f32>, truth: &Parts, found: &Parts) -> Result<ObjectScore, ScoreError> {
    let mut scratch = RandIndexScratch::default();
    let inside = || truth.labels.iter().zip(&found.labels).filter(|(truth, _)| **truth > 0);
    let [true_inside, found_inside]: [Vec<u32>; 2] =
        [inside().map(|(truth, _)| *truth).collect(), inside().map(|(_, found)| *found).collect()];
    let ari = adjusted_rand_index(&found.labels, &truth.labels, &mut scratch)?;
    let ari_foreground = adjusted_rand_index(&found_inside, &true_inside, &mut scratch)?;
    let mut classes = Confusion::default();
    for (&truth_label, &found_label) in inside().filter(|_| !truth.classes.is_empty()) {
        if let Some(class) = truth.class(truth_label) {
            classes.add(class, found.class(found_label), 1);
        }
    }
    let mut score = ObjectScore {
        ari_foreground,
        ari,
        true_objects: truth.seen(),
        found_objects: found.seen(),
        iou: Share::default(),
        f1: Share::default(),
        order: Share::default(),
        classes,
    };
    if truth.whole.is_some() {
        score_whole(image, truth, found, &mut score)?;
    }
    Ok(score)
}

/// What two masks share, and the areas of both.
fn overlap(a: &[bool], b: &[bool]) -> [f64; 3] {
    let count = |masks: &mut dyn Iterator<Item = bool>| masks.filter(|is| *is).map(|_| 1.0).sum::<f64>();
    [count(&mut a.iter().zip(b).map(|(a, b)| *a && *b)), count(&mut a.iter().copied()), count(&mut b.iter().copied())]
}

/// Scores whole objects and their order. True objects that are not seen are left out.
fn score_whole(
    image: ImageView<'_, f32>,
    truth: &Parts,
    found: &Parts,
    score: &mut ObjectScore,
) -> Result<(), ScoreError> {
    let colors: Vec<Option<[f64; 3]>> = (0..truth.masks()).map(|k| color(image, &truth.labels, k)).collect();
    let objects: Vec<usize> = (0..truth.masks()).filter(|&k| colors[k].is_some()).collect();
    let columns = found.masks();
    let mut pairs = Vec::new();
    for &object in &objects {
        for column in 0..columns {
            pairs.push(match (truth.mask(object), found.mask(column)) {
                (Some(a), Some(b)) => overlap(a, b),
                _ => [0.0, 1.0, 1.0],
            });
        }
    }
    let costs: Vec<f64> = pairs.iter().map(|&[both, a, b]| 1.0 - both / (a + b - both).max(1.0)).collect();
    let mut solver = Hungarian::default();
    let mut partners = vec![None; objects.len()];
    if columns > 0 && !objects.is_empty() {
        let costs = CostMatrix::new(objects.len(), columns, &costs)?;
        partners.clone_from(&solver.solve(costs)?.column_of);
    }
    for (row, partner) in partners.iter().enumerate() {
        let [both, a, b] = partner.map_or([0.0, 1.0, 1.0], |column| pairs[row * columns + column]);
        score.iou.add(Share { sum: both / (a + b - both).max(1.0), weight: 1.0 });
        score.f1.add(Share { sum: 2.0 * both / (a + b).max(1.0), weight: 1.0 });
    }
    if !found.ordered {
        return Ok(());
    }
    for (row, &object) in objects.iter().enumerate() {
        for (later_row, &later) in objects.iter().enumerate().skip(row + 1) {
            let (Some(a), Some(b), Some(one), Some(other)) =
                (truth.mask(object), truth.mask(later), colors[object], colors[later])
            else {
                continue;
            };
            let [both, ..] = overlap(a, b);
            let difference: f64 = one.iter().zip(other).map(|(one, other)| (one - other).powi(2)).sum();
            let is_right = matches!((partners[row], partners[later_row]), (Some(a), Some(b)) if a < b);
            let weight = both * difference;
            score.order.add(Share { sum: if is_right { weight } else { 0.0 }, weight });
        }
    }
    Ok(())
}

/// The mean color of the pixels that show object `k`, from 0; none if it is not seen.
fn color(image: ImageView<'_, f32>, labels: &[u32], k: usize) -> Option<[f64; 3]> {
    let pixels = labels.iter().enumerate().filter(|&(_, &label)| label as usize == k + 1);
    let (sum, count) = pixels.fold(([0.0; 3], 0.0), |(mut sum, count), (pixel, _)| {
        sum.iter_mut().zip(image.pixel(pixel)).for_each(|(sum, value)| *sum += f64::from(value));
        (sum, count + 1.0)
    });
    (count > 0.0).then(|| sum.map(|value: f64| value / count))
}
