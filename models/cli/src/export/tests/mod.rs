#![expect(clippy::float_cmp, reason = "numbers exact by construction")]

mod efd;
mod formats;
mod masks;
mod measure;
mod table;

use dvp_core::render::EdgeProfile;
use dvp_core::shape::{AnyShape, Circle, Polygon as PolygonShape};
use dvp_core::{ImageSize, Object, Pose, Scene};

use super::*;

/// A picture of 10 x 10 pixels, whose scene units are 10 pixels long.
fn size() -> ImageSize {
    ImageSize::new(10, 10).unwrap()
}

/// An object of `color` whose polygons have these rings, px.
fn polygons(rings: &[&[[f32; 2]]], color: [f32; 3]) -> Object<f32> {
    let rings = rings.iter().map(|ring| ring.iter().map(|vertex| vertex.map(|x| x / 10.0)).collect()).collect();
    let shape = AnyShape::Polygon(PolygonShape::new(rings).unwrap());
    Object { shape, pose: Pose::identity(), paint: color.into(), confidence: 1.0 }
}

/// The upright box from `low` to `high`, px.
fn corners([left, top]: [f32; 2], [right, bottom]: [f32; 2]) -> [[f32; 2]; 4] {
    [[left, top], [right, top], [right, bottom], [left, bottom]]
}

/// A square from 2 to 8 with a square hole from 4 to 6: both turn the same way, which must not matter.
fn frame() -> Object<f32> {
    polygons(&[&corners([2.0, 2.0], [8.0, 8.0]), &corners([4.0, 4.0], [6.0, 6.0])], [1.0, 0.0, 0.2])
}

/// A disk, px.
fn disk(center: [f32; 2], radius: f32) -> Object<f32> {
    let pose = Pose { translation: center.map(|x| x / 10.0), scale: 1.0, rotation: 0.0 };
    let shape = AnyShape::Circle(Circle { radius: radius / 10.0 });
    Object { shape, pose, paint: [0.0, 0.0, 1.0].into(), confidence: 1.0 }
}

fn scene(objects: Vec<Object<f32>>) -> Scene<f32> {
    Scene {
        objects,
        edge: EdgeProfile::area(),
        compositing: dvp_core::scene::Compositing::Over,
        ..Scene::empty([1.0; 3])
    }
}

fn measured(objects: Vec<Object<f32>>) -> Vec<MeasuredObject> {
    let numbers: Vec<u32> = (1..).take(objects.len()).collect();
    measure(&scene(objects), &[], None, &numbers, size()).unwrap()
}

fn picture(objects: Vec<Object<f32>>) -> MeasuredPicture {
    let found = Found { size: size(), objects: measured(objects) };
    MeasuredPicture::new("a b.png".to_owned(), "a b".to_owned(), Ok(found))
}

fn failed() -> MeasuredPicture {
    MeasuredPicture::new("x.png".to_owned(), "x".to_owned(), Err("x.png: no \"image\"".to_owned()))
}

/// Whether two numbers agree to `digits` after the point.
fn close(a: f64, b: f64, digits: i32) -> bool {
    (a - b).abs() < 0.5 * 10_f64.powi(-digits)
}
