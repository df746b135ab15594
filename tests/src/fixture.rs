//! Reference numbers too large to commit: the folder `shared` beside the workspace, where there is one.

use core::panic::Location;
use std::fs::File;
use std::io::{BufReader, Write as _};
use std::path::{Path, PathBuf};

use dvp_core::scene::rotation_from_pair;
use dvp_core::{Efd, Object, Pose, Scene};
use serde::Deserialize;

/// The folder `shared` beside the workspace root; `None` where it is missing, which is said on stderr with the place in the
/// tests that is skipped.
///
/// It is not said by `eprintln`, whose text the test runner shows for failed tests alone: a test that compares nothing
/// passes, and nobody would know.
#[must_use]
#[track_caller]
pub fn shared() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../shared");
    if folder.is_dir() {
        return Some(folder);
    }
    let place = Location::caller();
    // Where stderr is closed nobody reads it.
    let _ = writeln!(
        std::io::stderr(),
        "SKIPPED {}:{}: no folder {}, its numbers are not compared",
        place.file(),
        place.line(),
        folder.display()
    );
    None
}

/// The values of an .npy file of f32, in C order, and its dimensions.
///
/// # Panics
/// If the file is missing or holds something else.
#[must_use]
#[expect(clippy::expect_used, reason = "a fixture that is there but unreadable fails the test")]
pub fn read_npy(path: &Path) -> (Vec<usize>, Vec<f32>) {
    let file = BufReader::new(File::open(path).expect("fixture opens"));
    let npy = npyz::NpyFile::new(file).expect("fixture is npy");
    let dims = npy.shape().iter().map(|&n| usize::try_from(n).expect("dimension fits")).collect();
    (dims, npy.into_vec().expect("fixture holds f32"))
}

/// A scene as the fixtures write it: the rotation as the pair (sine, cosine), of any length.
#[derive(Clone, Debug, Deserialize)]
pub struct FixtureScene {
    /// RGB.
    pub background: [f64; 3],
    /// Hidden objects (confidence 0) included.
    pub objects: Vec<FixtureObject>,
}

/// An object of a [`FixtureScene`].
#[derive(Clone, Debug, Deserialize)]
pub struct FixtureObject {
    /// Scene units.
    pub translation: [f64; 2],
    /// Scene units per unit of the outline.
    pub scale: f64,
    /// (sine, cosine), not of unit length.
    pub rotation_vec: [f64; 2],
    /// RGB.
    pub color: [f64; 3],
    /// 0 hides.
    pub confidence: f64,
    /// Rows (a_n, b_n, c_n, d_n); missing in `mdshr`.
    #[serde(default)]
    pub efd: Vec<[f64; 4]>,
    /// Index into the tables of `mdshr`.
    pub shape: Option<usize>,
}

impl FixtureScene {
    /// The scene in the reference's edge profile and compositing; `tables` are the shapes of `mdshr`.
    #[must_use]
    pub fn to_scene(&self, tables: &[Vec<[f64; 4]>]) -> Scene<f64> {
        let objects = self.objects.iter().map(|object| {
            let pose = Pose {
                translation: object.translation,
                scale: object.scale,
                rotation: rotation_from_pair(object.rotation_vec),
            };
            Object::of_efd(
                pose,
                object.color,
                object.confidence,
                Efd::new(object.shape.map_or_else(|| object.efd.clone(), |shape| tables[shape].clone())),
                object.shape,
            )
        });
        Scene { objects: objects.collect(), ..Scene::empty(self.background) }
    }
}

/// The scenes of `fixtures/<name>`.
///
/// # Panics
/// If the file is missing or holds something else.
#[must_use]
#[expect(clippy::expect_used, reason = "a fixture that is there but unreadable fails the test")]
pub fn fixture_scenes(shared: &Path, name: &str) -> Vec<FixtureScene> {
    #[derive(Deserialize)]
    struct Scenes {
        scenes: Vec<FixtureScene>,
    }
    let file = File::open(shared.join("fixtures").join(name)).expect("fixture opens");
    let scenes: Scenes = serde_json::from_reader(BufReader::new(file)).expect("fixture holds scenes");
    scenes.scenes
}

/// The first `count` true scenes of `mdshr/val`, with their shapes filled in.
///
/// # Panics
/// If a file is missing or holds something else.
#[must_use]
#[expect(clippy::expect_used, reason = "a fixture that is there but unreadable fails the test")]
pub fn mdshr_val(shared: &Path, count: usize) -> Vec<Scene<f64>> {
    #[derive(Deserialize)]
    struct Tables {
        order: Vec<String>,
        heart: Vec<[f64; 4]>,
        square: Vec<[f64; 4]>,
        ellipse: Vec<[f64; 4]>,
    }
    let folder = shared.join("mdshr");
    let file = File::open(folder.join("efd_tables.json")).expect("tables open");
    let tables: Tables = serde_json::from_reader(BufReader::new(file)).expect("tables are read");
    assert_eq!(tables.order, ["heart", "square", "ellipse"]);
    let tables = [tables.heart, tables.square, tables.ellipse];
    let lines = std::fs::read_to_string(folder.join("val/scenes.jsonl")).expect("scenes open");
    let scenes = lines.lines().take(count);
    scenes.map(|line| serde_json::from_str::<FixtureScene>(line).expect("a scene").to_scene(&tables)).collect()
}
