//! Random scenes of every kind of shape, edge and background, and what a fit might know of them.

use alloc::collections::BTreeMap;
use core::f64::consts::PI;

use dvp::format::{
    CompletionJson, DeviationsJson, DoubtJson, INVISIBLE, ObjectKnownJson, SceneJson, SceneKnownJson, StopJson,
};
use dvp_core::render::{Compositing, EdgeLaw, EdgeProfile};
use dvp_core::scene::Paint;
use dvp_core::shape::Shape as _;
use dvp_core::{ImageSize, Object, Pose, Real, Scene};
use dvp_fit::Doubts;
use proptest::collection::{btree_map, vec};
use proptest::option;
use proptest::prelude::*;
use proptest::sample::{select, subsequence};

use crate::shape_strategy::shape;
use crate::strategy::color;

/// Numbers as they come out of a fit, and those that are left out of files.
fn coordinate() -> impl Strategy<Value = f64> {
    prop_oneof![6 => -2.0..2.0, 1 => select(vec![0.0, -0.0, 1.0, 1e-300, -1e-9, 1000.0])]
}

fn object() -> impl Strategy<Value = Object<f64>> {
    let pose =
        (prop::array::uniform2(coordinate()), prop_oneof![Just(1.0), 0.01..2.0], prop_oneof![Just(0.0), -PI..PI]);
    let pose = pose.prop_map(|(translation, scale, rotation)| Pose { translation, scale, rotation });
    (shape(), pose, color(), prop_oneof![Just(1.0), 0.0..1.0]).prop_map(|(shape, pose, color, confidence)| Object {
        shape,
        pose,
        paint: Paint::Flat(color),
        confidence,
    })
}

fn edge() -> impl Strategy<Value = EdgeProfile<f64>> {
    let law = select(vec![EdgeLaw::SquaredDistance, EdgeLaw::Distance]);
    prop_oneof![
        Just(EdgeProfile::reference()),
        Just(EdgeProfile::area()),
        (1e-6..1.0).prop_map(EdgeProfile::distance),
        (law, 0.0..0.4, 1e-6..1.0, 0.6..2.0).prop_map(|(law, offset, sigma, cut)| EdgeProfile {
            law,
            offset,
            sigma,
            cut
        }),
    ]
}

/// A scene of up to three objects of any kind.
pub fn any_scene() -> impl Strategy<Value = Scene<f64>> {
    let compositing = select(vec![Compositing::Blend, Compositing::Over]);
    (color(), any::<bool>(), vec(object(), 0..4), edge(), compositing).prop_map(
        |(background, transparent, objects, edge, compositing)| Scene {
            background,
            transparent,
            objects,
            edge,
            compositing,
        },
    )
}

/// The scene in single precision.
#[must_use]
pub fn single(scene: &Scene<f64>) -> Scene<f32> {
    let EdgeProfile { law, offset, sigma, cut } = scene.edge;
    let object = |object: &Object<f64>| Object {
        shape: object.shape.cast(),
        pose: Pose {
            translation: object.pose.translation.map(f64::as_f32),
            scale: object.pose.scale.as_f32(),
            rotation: object.pose.rotation.as_f32(),
        },
        paint: Paint::Flat(object.color().map(f64::as_f32)),
        confidence: object.confidence.as_f32(),
    };
    Scene {
        background: scene.background.map(f64::as_f32),
        transparent: scene.transparent,
        objects: scene.objects.iter().map(object).collect(),
        edge: if law == EdgeLaw::Area {
            EdgeProfile::area()
        } else {
            EdgeProfile { law, offset: offset.as_f32(), sigma: sigma.as_f32(), cut: cut.as_f32() }
        },
        compositing: scene.compositing,
    }
}

fn doubt() -> impl Strategy<Value = DoubtJson> {
    let share = || 0.0..=1.0;
    let completion = prop_oneof![
        Just(CompletionJson::Prototype {}),
        (0_usize..9).prop_map(|order| CompletionJson::Rotation { order }),
        Just(CompletionJson::Mirror {}),
        Just(CompletionJson::Straight {}),
        Just(CompletionJson::Other {}),
    ];
    prop_oneof![
        (0_usize..9).prop_map(|order| DoubtJson::Symmetry { order }),
        share().prop_map(|visible| DoubtJson::Cropped { visible }),
        (share(), completion).prop_map(|(share, completion)| DoubtJson::Hidden { share, completion }),
        share().prop_map(|visible| DoubtJson::Merged { other: 0, visible }),
        (0_usize..9, 1.0..4.0).prop_map(|(prototype, ratio)| DoubtJson::Twin { prototype, ratio }),
    ]
}

/// What may be known of an object whose shape has numbers of these names.
fn object_known(names: Vec<String>) -> impl Strategy<Value = ObjectKnownJson> {
    let size = || 0.0..0.1;
    let numbers = btree_map(select(names), size(), 0..3);
    let deviations = (
        option::of(prop::array::uniform2(size())),
        option::of(size()),
        option::of(size()),
        option::of(prop::array::uniform3(size())),
        numbers,
    )
        .prop_map(|(translation, scale, rotation, color, numbers): (_, _, _, _, BTreeMap<_, _>)| {
            let mut deviations = DeviationsJson::default();
            (deviations.translation, deviations.scale, deviations.rotation) = (translation, scale, rotation);
            (deviations.color, deviations.numbers) = (color, numbers);
            deviations
        });
    (option::of(deviations), option::of(-0.5..1.0), option::of(0.0..=1.0), vec(doubt(), 0..3)).prop_map(
        |(deviations, marginal_gain, expected_iou, doubts)| {
            let mut known = ObjectKnownJson::default();
            (known.deviations, known.marginal_gain, known.doubts) = (deviations, marginal_gain, doubts);
            known.expected_iou = expected_iou;
            known
        },
    )
}

fn scene_known() -> impl Strategy<Value = SceneKnownJson> {
    let stops = [
        StopJson::Converged,
        StopJson::StepLimit,
        StopJson::Stalled,
        StopJson::Empty,
        StopJson::NotFlat,
        StopJson::NoBetterThanFlat,
        StopJson::Other,
    ];
    let names: Vec<String> = Doubts::default().named().into_iter().map(|(name, _)| name.to_owned()).collect();
    let names = [names, vec![INVISIBLE.to_owned()]].concat();
    let count = names.len();
    (
        select(stops.to_vec()),
        option::of(0.0..=1.0),
        option::of(0.0..0.2),
        option::of(-1e3..1e6),
        subsequence(names, 0..=count),
    )
        .prop_map(|(stop, unexplained, noise, bits, doubts)| {
            let mut known = SceneKnownJson::new(stop);
            (known.unexplained, known.noise, known.bits, known.doubts) = (unexplained, noise, bits, doubts);
            known
        })
}

/// The text's structure of a scene of any kind, with what a fit might know of it.
///
/// # Panics
/// If a scene cannot be written.
#[expect(clippy::expect_used, reason = "a scene that cannot be written fails the test")]
pub fn any_scene_json() -> impl Strategy<Value = SceneJson> {
    let known = |object: &Object<f64>| option::of(object_known(object.shape.number_names()));
    let parts = any_scene().prop_flat_map(move |scene| {
        let known: Vec<_> = scene.objects.iter().map(known).collect();
        (Just(scene), known, scene_known(), option::of(0_u64..1000), (1_usize..5000, 1_usize..5000))
    });
    parts.prop_map(|(scene, objects_known, known, id, (width, height))| {
        let size = ImageSize::new(width, height).expect("a size");
        let mut json = SceneJson::from_scene(&scene, size).expect("every kind is written");
        json.objects.iter_mut().zip(objects_known).for_each(|(object, known)| object.known = known);
        (json.id, json.known) = (id, Some(known));
        json
    })
}
