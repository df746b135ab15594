//! Image scores against scipy, labelings against scikit-learn, and, if they are there, the reference's masks,
//! indices and scores of 16 scenes.

use std::fs::File;
use std::path::PathBuf;

use dvp_core::loss::{ImagePair, Loss, Ssim};
use dvp_core::metric::{MaskOverlap, Ownership, RandIndexScratch, Scores, Tally, adjusted_rand_index};
use dvp_core::render::PixelLoss;
use dvp_core::{Image, ImageSize, ImageView, Real};
use dvp_tests::golden::{committed, shared};
use serde::Deserialize;

#[derive(Deserialize)]
struct SmallFile {
    images: Vec<SmallImages>,
    labelings: Vec<SmallLabelings>,
}

#[derive(Deserialize)]
struct SmallImages {
    width: usize,
    height: usize,
    image: Vec<f64>,
    target: Vec<f64>,
    ssim: f64,
    mae: f64,
    mse: f64,
}

#[derive(Deserialize)]
struct SmallLabelings {
    a: Vec<u32>,
    b: Vec<u32>,
    ari: f64,
}

fn assert_small_image<T: Real>(case: &SmallImages, tolerance: f64) {
    let size = ImageSize::new(case.width, case.height).unwrap();
    let [image, target] = [&case.image, &case.target].map(|v| v.iter().map(|&v| T::of(v)).collect::<Vec<T>>());
    let pair = ImagePair::new(ImageView::new(size, &image).unwrap(), ImageView::new(size, &target).unwrap()).unwrap();
    let ssim = Ssim::default().similarity(pair, &mut Default::default()).unwrap().as_f64();
    let mae = PixelLoss::Mae.value(pair, &mut ()).unwrap().as_f64();
    let mse = PixelLoss::Mse.value(pair, &mut ()).unwrap().as_f64();
    for (ours, theirs) in [(ssim, case.ssim), (mae, case.mae), (mse, case.mse)] {
        assert!((ours - theirs).abs() < tolerance, "{ours}, reference {theirs}");
    }
}

#[test]
fn small_images_and_labelings() {
    let file: SmallFile = committed("metric.json").unwrap();
    assert!(!file.images.is_empty() && !file.labelings.is_empty());
    for case in &file.images {
        assert_small_image::<f64>(case, 1e-12);
        assert_small_image::<f32>(case, 1e-6);
    }
    for case in &file.labelings {
        let ours = adjusted_rand_index(&case.a, &case.b, &mut RandIndexScratch::default()).unwrap();
        assert!((ours - case.ari).abs() < 1e-12, "{ours}, reference {}", case.ari);
    }
}

#[derive(Deserialize)]
struct ScoreFile {
    aggregate_as_in_test_ipynb: ScoreRecord,
    per_pair: Vec<ScoreRecord>,
}

#[derive(Deserialize)]
struct ScoreRecord {
    mae: f64,
    mse: f64,
    ssim: f64,
    iou: f64,
    ari: f64,
}

fn assert_scores(name: &str, ours: &Scores, theirs: &ScoreRecord) {
    let table = [
        ("MAE", ours.mae, theirs.mae),
        ("MSE", ours.mse, theirs.mse),
        ("IoU", ours.iou, theirs.iou),
        ("ARI", ours.ari, theirs.ari),
    ];
    // In single precision, flat areas leave noise in variances that SSIM divides by 9e-4: up to 4e-4 on these images.
    assert!((ours.ssim - theirs.ssim).abs() < 5e-4, "{name}, SSIM: {}, reference {}", ours.ssim, theirs.ssim);
    for (metric, ours, theirs) in table {
        // The reference works in single precision.
        assert!((ours - theirs).abs() < 2e-6, "{name}, {metric}: {ours}, reference {theirs}");
    }
}

const SIDE: usize = 128;
const PIXELS: usize = SIDE * SIDE;
const OBJECTS: usize = 4;

/// An array of the fixtures, cut into one slice per scene.
fn array<V: npyz::Deserialize + Clone>(name: &str, per_scene: usize) -> Vec<Vec<V>> {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../shared/fixtures").join(name);
    let values: Vec<V> = npyz::NpyFile::new(File::open(path).unwrap()).unwrap().into_vec().unwrap();
    values.chunks_exact(per_scene).map(<[V]>::to_vec).collect()
}

/// Ownership from the reference's masks, pixel by pixel with the objects side by side.
fn ownership(mask: &[bool]) -> Ownership {
    let coverage: Vec<f32> =
        (0..OBJECTS).flat_map(|k| mask.iter().skip(k).step_by(OBJECTS).map(|&on| f32::from(u8::from(on)))).collect();
    let mut owned = Ownership::default();
    owned.fill(PIXELS, &coverage, &[1.0; OBJECTS]).unwrap();
    owned
}

#[test]
fn indices_and_scores_of_the_reference() {
    let Some(file) = shared::<ScoreFile>("fixtures/f_metrics.json").unwrap() else { return };
    let size = ImageSize::new(SIDE, SIDE).unwrap();
    let owned = |name: &str| -> Vec<Ownership> {
        let masks = array::<bool>(&format!("e_{name}_mask.npy"), PIXELS * OBJECTS);
        let owned: Vec<Ownership> = masks.iter().map(|mask| ownership(mask)).collect();
        let indices = array::<i8>(&format!("e_{name}_index.npy"), PIXELS);
        assert_eq!(owned.len(), indices.len());
        for (owned, index) in owned.iter().zip(&indices) {
            // The reference numbers objects in an order of its own; the background is 0 in both.
            let index: Vec<u32> = index.iter().map(|&label| u32::try_from(label).unwrap()).collect();
            assert!(owned.index().iter().zip(&index).all(|(&ours, &theirs)| (ours == 0) == (theirs == 0)));
            let ari = adjusted_rand_index(owned.index(), &index, &mut RandIndexScratch::default()).unwrap();
            assert!((ari - 1.0).abs() < 1e-12);
        }
        owned
    };
    let (truly_owned, owned) = (owned("target"), owned("perturbed"));
    let images = |name: &str| -> Vec<Image<f32>> {
        let images = array::<f32>(&format!("a_{name}_image.npy"), PIXELS * 3);
        images.iter().map(|data| Image::from_interleaved(size, data).unwrap()).collect()
    };
    let (targets, images) = (images("target"), images("perturbed"));
    let mut tally = Tally::default();
    for (k, (image, target)) in images.iter().zip(&targets).enumerate() {
        let pair = ImagePair::new(image.view(), target.view()).unwrap();
        let scores = tally.add(pair, &owned[k], &truly_owned[k]).unwrap();
        assert_scores(&format!("pair {k}"), &scores, &file.per_pair[k]);
    }
    assert!(tally.images() >= 8);
    if tally.images() == file.per_pair.len() {
        assert_scores("all pairs", &tally.scores().unwrap(), &file.aggregate_as_in_test_ipynb);
    }
    // Masks are there for all scenes, also where images are not.
    let (mut overlap, mut rand_index) = (MaskOverlap::default(), 0.0);
    for (k, (a, b)) in owned.iter().zip(&truly_owned).enumerate() {
        overlap.add(a.union(), b.union());
        let ari = adjusted_rand_index(a.index(), b.index(), &mut RandIndexScratch::default()).unwrap();
        assert!((ari - file.per_pair[k].ari).abs() < 2e-6);
        rand_index += ari / 16.0;
    }
    assert!((overlap.iou() - file.aggregate_as_in_test_ipynb.iou).abs() < 2e-6);
    assert!((rand_index - file.aggregate_as_in_test_ipynb.ari).abs() < 2e-6);
}
