//! Pairs of scenes that the reference implementation was run on, with its answers.

use alloc::collections::BTreeMap;

use dvp_core::scene::rotation_from_pair;
use dvp_core::{Efd, Object, Pose, Scene};
use dvp_tests::golden::{committed, shared};
use serde::Deserialize;

#[derive(Deserialize)]
pub(crate) struct ObjectRecord {
    translation: [f64; 2],
    scale: f64,
    pub(crate) rotation_vec: [f64; 2],
    color: [f64; 3],
    confidence: f64,
    efd: Vec<[f64; 4]>,
}

#[derive(Deserialize)]
pub(crate) struct SceneRecord {
    background: [f64; 3],
    pub(crate) objects: Vec<ObjectRecord>,
}

impl SceneRecord {
    pub(crate) fn scene(&self) -> Scene<f64> {
        let object = |record: &ObjectRecord| {
            let pose = Pose {
                translation: record.translation,
                scale: record.scale,
                rotation: rotation_from_pair(record.rotation_vec),
            };
            Object::of_efd(pose, record.color, record.confidence, Efd::new(record.efd.clone()), None)
        };
        Scene { objects: self.objects.iter().map(object).collect(), ..Scene::empty(self.background) }
    }
}

/// Gradients with respect to the reference's parameters; its scale is stored twice, each half of the gradient.
#[derive(Deserialize)]
pub(crate) struct GradRecord {
    pub(crate) t: Vec<[f64; 2]>,
    pub(crate) s: Vec<[f64; 2]>,
    pub(crate) r: Vec<[f64; 2]>,
    pub(crate) c: Vec<[f64; 3]>,
    pub(crate) f: Vec<[f64; 1]>,
    pub(crate) b: [f64; 3],
    pub(crate) e: Vec<Vec<[f64; 4]>>,
}

#[derive(Deserialize)]
pub(crate) struct PairRecord {
    #[serde(rename = "true")]
    pub(crate) truth: SceneRecord,
    pub(crate) pred: SceneRecord,
    pub(crate) n_true: usize,
    pub(crate) match_true: Vec<usize>,
    pub(crate) match_pred_order: Vec<usize>,
    pub(crate) terms: BTreeMap<String, f64>,
    pub(crate) total: f64,
    pub(crate) grad: GradRecord,
}

#[derive(Deserialize)]
pub(crate) struct BatchRecord {
    pub(crate) terms: BTreeMap<String, f64>,
    pub(crate) total: f64,
}

#[derive(Deserialize)]
pub(crate) struct PairFile {
    pub(crate) pairs: Vec<PairRecord>,
    #[serde(default)]
    pub(crate) batch_values: BTreeMap<String, BatchRecord>,
}

/// The committed pairs, and all 64 if the folder with them is there.
pub(crate) fn all() -> Vec<PairFile> {
    let mut files = vec![committed("scene_loss.json").unwrap()];
    files.extend(shared("fixtures/d_scene_loss.json").unwrap());
    files
}
