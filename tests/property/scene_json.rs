//! Scene JSON: what is written is read back exactly, and reader and schema agree on what a scene is.

use alloc::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use dvp::format::{Place, SceneJson};
use dvp_core::scene::{ColorRamp, ColorStop, Paint, RampKind};
use dvp_core::{Efd, ImageSize, Real, Scene};
use dvp_fit::{Bank, Doubts};
use dvp_tests::scene_strategy::{any_scene, any_scene_json, single};
use dvp_tests::strategy::color;
use jsonschema::Validator;
use proptest::collection::vec;
use proptest::option;
use proptest::prelude::*;
use proptest::sample::Index;
use proptest::strategy::ValueTree as _;
use proptest::test_runner::TestRunner;
use serde_json::{Value, json};

fn schema() -> Value {
    let path = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../models/cli/schema/scene-3.schema.json");
    serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap()
}

static SCHEMA: LazyLock<Validator> = LazyLock::new(|| {
    let schema = schema();
    assert!(jsonschema::draft202012::meta::is_valid(&schema), "the schema itself is one");
    jsonschema::validator_for(&schema).unwrap()
});

fn place() -> Place {
    Place::file(Path::new("scene.json"))
}

/// As many prototypes as random scenes refer to.
fn bank() -> Bank<f64> {
    let disk = Efd::new(vec![[1.0, 0.0, 0.0, -1.0]]);
    Bank::new((0..9).map(|index| (index.to_string(), disk.clone())).collect())
}

/// What the reader says of a text, all checks included.
fn read(text: &str) -> Result<SceneJson, String> {
    let place = place();
    let json = SceneJson::parse(text.as_bytes(), &place).map_err(|error| error.to_string())?;
    json.to_scene(Some(&bank()), &place).map_err(|error| error.to_string())?;
    json.size(&place).map_err(|error| error.to_string())?;
    Ok(json)
}

fn ramp() -> impl Strategy<Value = ColorRamp<f64>> {
    let point = || prop::array::uniform2(-2.0..2.0);
    let kind = prop_oneof![
        prop::array::uniform2(point()).prop_map(RampKind::Linear),
        prop::array::uniform3(point()).prop_map(RampKind::Radial),
    ];
    (kind, vec((-0.5..1.5, color()), 1..4)).prop_map(|(kind, mut stops)| {
        stops.sort_by(|(a, _), (b, _)| f64::total_cmp(a, b));
        let stops = stops.into_iter().map(|(offset, color)| ColorStop { offset, color });
        ColorRamp { kind, stops: stops.collect() }
    })
}

/// A scene some of whose objects are painted with ramps.
fn any_ramped_scene() -> impl Strategy<Value = Scene<f64>> {
    (any_scene(), vec(option::of(ramp()), 4)).prop_map(|(mut scene, ramps)| {
        for (object, ramp) in scene.objects.iter_mut().zip(ramps) {
            object.paint = ramp.map_or_else(|| object.paint.clone(), Paint::Ramp);
        }
        scene
    })
}

/// The text's structure of any scene, some of whose objects are painted with ramps.
fn any_ramped_json() -> impl Strategy<Value = SceneJson> {
    (any_scene_json(), any_ramped_scene()).prop_map(|(mut json, scene)| {
        let painted = SceneJson::from_scene(&scene, ImageSize::new(1, 1).unwrap()).unwrap().objects;
        for (object, painted) in json.objects.iter_mut().zip(painted) {
            (object.color, object.ramp) = (painted.color, painted.ramp);
        }
        json
    })
}

/// Scene to text and back, twice.
fn assert_round_trip<T: Real>(scene: &Scene<T>) {
    let (place, size) = (place(), ImageSize::new(640, 480).unwrap());
    let json = SceneJson::from_scene(scene, size).unwrap();
    let text = json.to_line(&place).unwrap();
    let again = SceneJson::parse(text.as_bytes(), &place).unwrap();
    assert_eq!(again, json);
    let back: Scene<T> = again.to_scene(None, &place).unwrap();
    assert_eq!(&back, scene, "{text}");
    assert_eq!(SceneJson::from_scene(&back, size).unwrap().to_line(&place).unwrap(), text);
}

proptest! {
    #[test]
    fn scenes_of_every_kind_come_back_exactly(scene in any_ramped_scene()) {
        assert_round_trip(&scene);
        let mut short = single(&scene);
        short.objects.iter_mut().zip(&scene.objects).for_each(|(short, object)| short.paint = object.paint.cast());
        assert_round_trip(&short);
    }

    #[test]
    fn what_is_known_comes_back_exactly_and_is_valid(json in any_ramped_json()) {
        let text = json.to_line(&place()).unwrap();
        let back = read(&text);
        prop_assert_eq!(back.as_ref(), Ok(&json));
        prop_assert_eq!(back.unwrap().to_line(&place()).unwrap(), text.clone());
        let value: Value = serde_json::from_str(&text).unwrap();
        prop_assert!(SCHEMA.is_valid(&value), "{}: {:?}", text, SCHEMA.validate(&value).err());
    }

    #[test]
    fn reader_and_schema_agree_on_broken_documents(json in any_ramped_json(), at in any::<Index>(), how in any::<Index>()) {
        let mut value = serde_json::to_value(&json).unwrap();
        let pointers = pointers(&value);
        let pointer = at.get(&pointers);
        let how = how.get(&DAMAGE);
        damage(&mut value, pointer, how);
        let (read, valid) = (read(&value.to_string()), SCHEMA.is_valid(&value));
        prop_assert_eq!(read.is_ok(), valid, "{:?} at {}: {:?} {}", how, pointer, read, value);
    }
}

/// How a document is broken, or not.
#[derive(Debug)]
enum Damage {
    /// The value becomes another one.
    Become(&'static str),
    /// A field or entry is taken out.
    Remove,
    /// A field that nobody knows is added, or an entry of no known kind.
    Add,
}

const DAMAGE: [Damage; 11] = [
    Damage::Become("null"),
    Damage::Become("true"),
    Damage::Become("\"wings\""),
    Damage::Become("[]"),
    Damage::Become("{}"),
    Damage::Become("[1,2,3]"),
    Damage::Become("0.5"),
    Damage::Become("1000000000"),
    Damage::Become("-1000000000"),
    Damage::Remove,
    Damage::Add,
];

/// Where every value of a document stands.
fn pointers(value: &Value) -> Vec<String> {
    let mut found = vec![String::new()];
    let children: Vec<(String, &Value)> = match value {
        Value::Array(entries) => entries.iter().enumerate().map(|(k, entry)| (k.to_string(), entry)).collect(),
        Value::Object(fields) => fields.iter().map(|(name, field)| (name.clone(), field)).collect(),
        _ => Vec::new(),
    };
    for (name, child) in children {
        found.extend(pointers(child).into_iter().map(|rest| format!("/{name}{rest}")));
    }
    found
}

fn damage(value: &mut Value, pointer: &str, how: &Damage) {
    if !pointer.contains("/known") {
        forget_numbers(value);
    }
    // The cut must not lie before the offset, which a schema cannot say.
    if let ("/edge/offset", Some(edge)) = (pointer, value["edge"].as_object_mut()) {
        edge.remove("cut");
    }
    match how {
        // The number of segments depends on that of the points, which a schema cannot say.
        Damage::Become("[]") if pointer.ends_with("/segments") => {}
        // Offsets never fall, which a schema cannot say.
        Damage::Become("0.5" | "1000000000" | "-1000000000")
            if pointer.contains("/stops/") && pointer.ends_with("/offset") => {}
        Damage::Become(other) => *value.pointer_mut(pointer).unwrap() = serde_json::from_str(other).unwrap(),
        Damage::Add => match value.pointer_mut(pointer).unwrap() {
            Value::Object(fields) => drop(fields.insert("wings".to_owned(), true.into())),
            Value::Array(entries) => entries.push(true.into()),
            other => *other = json!([other.clone()]),
        },
        Damage::Remove => {
            let Some((parent, name)) = pointer.rsplit_once('/') else { return };
            match value.pointer_mut(parent).unwrap() {
                Value::Object(fields) => drop(fields.remove(name)),
                // As above.
                Value::Array(_) if parent.ends_with("/points") || parent.ends_with("/segments") => {}
                Value::Array(entries) => drop(entries.remove(name.parse().unwrap())),
                _ => {}
            }
        }
    }
}

/// A shape that changes loses the numbers whose deviations are known, which a schema cannot say.
fn forget_numbers(value: &mut Value) {
    for object in value["objects"].as_array_mut().unwrap() {
        if let Some(deviations) = object.pointer_mut("/known/deviations").and_then(Value::as_object_mut) {
            deviations.remove("numbers");
        }
    }
}

#[test]
fn documents_are_broken_in_ways_that_matter() {
    let mut runner = TestRunner::deterministic();
    let (mut refused, mut taken) = (0, 0);
    for _ in 0..16 {
        let json = any_ramped_json().new_tree(&mut runner).unwrap().current();
        let value = serde_json::to_value(&json).unwrap();
        for pointer in pointers(&value) {
            for how in &DAMAGE {
                let mut broken = value.clone();
                damage(&mut broken, &pointer, how);
                let (read, valid) = (read(&broken.to_string()), SCHEMA.is_valid(&broken));
                assert_eq!(read.is_ok(), valid, "{how:?} at {pointer}: {read:?} {broken}");
                *(if valid { &mut taken } else { &mut refused }) += 1;
            }
        }
    }
    assert!(refused > 1000 && taken > 1000, "{refused} refused, {taken} taken");
}

/// Every name that a schema gives a field, and every value that it gives a field to choose from.
fn words(schema: &Value, found: &mut BTreeSet<String>) {
    match schema {
        Value::Object(fields) => {
            for (name, field) in fields {
                match (name.as_str(), field) {
                    ("properties", Value::Object(properties)) => found.extend(properties.keys().cloned()),
                    ("const", value) => drop(found.insert(value.to_string())),
                    ("enum", Value::Array(values)) => found.extend(values.iter().map(Value::to_string)),
                    _ => {}
                }
                words(field, found);
            }
        }
        Value::Array(entries) => entries.iter().for_each(|entry| words(entry, found)),
        _ => {}
    }
}

/// Every name of a field of a document, and every text and version in it.
fn words_used(value: &Value, found: &mut BTreeSet<String>) {
    match value {
        Value::Object(fields) => {
            for (name, field) in fields {
                found.insert(name.clone());
                words_used(field, found);
            }
        }
        Value::Array(entries) => entries.iter().for_each(|entry| words_used(entry, found)),
        value => drop(found.insert(value.to_string())),
    }
}

#[test]
fn all_that_the_schema_names_is_written() {
    let (mut named, mut used) = (BTreeSet::new(), BTreeSet::new());
    words(&schema(), &mut named);
    let mut runner = TestRunner::deterministic();
    for _ in 0..512 {
        let json = any_ramped_json().new_tree(&mut runner).unwrap().current();
        words_used(&serde_json::to_value(&json).unwrap(), &mut used);
    }
    // Defaults, which are left out, and doubts of earlier programs.
    used.extend(["squared_distance", "even_odd", "ambiguity", "faint"].map(|word| format!("\"{word}\"")));
    let missing: Vec<&String> = named.difference(&used).collect();
    assert!(missing.is_empty(), "{missing:?}");
    assert!(Doubts::default().named().iter().all(|(name, _)| named.contains(&format!("\"{name}\""))));
}

#[test]
fn doubts_of_earlier_programs_are_read() {
    let of = |doubt: &str| {
        let known = format!("{{\"stop\": \"converged\", \"doubts\": [\"{doubt}\"]}}");
        format!("{{\"version\": 3, \"background\": [0, 0, 0], \"objects\": [], \"known\": {known}}}")
    };
    for doubt in ["ambiguity", "faint", "pose"] {
        assert!(SCHEMA.is_valid(&serde_json::from_str(&of(doubt)).unwrap()) && read(&of(doubt)).is_ok(), "{doubt}");
    }
    assert!(read(&of("color")).is_err());
}

#[test]
fn a_number_that_is_not_finite_is_not_written() {
    let size = ImageSize::new(8, 8).unwrap();
    for background in [f64::NAN, f64::INFINITY] {
        let mut json = SceneJson::from_scene(&Scene::empty([0.0; 3]), size).unwrap();
        json.background = Some([background, 0.0, 0.0]);
        assert!(json.to_line(&place()).is_err());
    }
}

#[test]
fn the_example_of_the_readme_is_a_scene() {
    let readme = include_str!("../../README.md");
    let examples: Vec<&str> = readme.split("```json\n").skip(1).filter_map(|rest| rest.split("```").next()).collect();
    assert!(!examples.is_empty(), "the README shows a scene");
    for example in examples {
        assert!(SCHEMA.is_valid(&serde_json::from_str(example).unwrap()), "{example}");
        read(example).unwrap();
    }
}
