use alloc::vec;
use alloc::vec::Vec;

use super::{BACKGROUND, HardMask, HardScratch, object_index};
use crate::dims::ImageSize;
use crate::render::{Compositing, RenderError, TileRenderer};
use crate::scene::Drawing;
use crate::shape::{Outline, Rings};

/// Rows of '.' and '#'; the outline counts from the upper left corner of the image, whose shorter side is its height.
fn picture(outline: &[[f32; 2]], width: usize, height: usize) -> Vec<alloc::string::String> {
    picture_of_rings(Rings::one(outline), width, height)
}

/// As [`picture`], of several rings.
fn picture_of_rings(rings: Rings<'_, f32>, width: usize, height: usize) -> Vec<alloc::string::String> {
    let size = ImageSize::new(width, height).unwrap();
    let unit = f32::from(u16::try_from(size.unit_px()).unwrap());
    let vertices: Vec<_> = rings.vertices.iter().map(|v| v.map(|x| x / unit)).collect();
    let mut drawing = Drawing::default();
    drawing.push_rings(Rings { vertices: &vertices, ..rings }, [1.0; 3], 1.0);
    let renderer = TileRenderer { coverage: HardMask, compositing: Compositing::Over };
    let mut mask = vec![0.0; size.pixels()];
    renderer.object_coverage(&drawing, size, &mut HardScratch::default(), &mut mask).unwrap();
    mask.chunks(width).map(|row| row.iter().map(|&v| if v > 0.5 { '#' } else { '.' }).collect()).collect()
}

#[test]
fn triangle_takes_the_centers_it_holds() {
    // The hypotenuse runs from (0, 0) to (8, 4): at the row centers 0.5, 1.5, ... it is at x = 1, 3, 5, 7, so that the
    // centers up to 0.5, 2.5, 4.5 and 6.5 lie to its left.
    let rows = picture(&[[0.0, 0.0], [8.0, 4.0], [0.0, 4.0]], 8, 4);
    assert_eq!(rows, ["#.......", "###.....", "#####...", "#######."]);
}

#[test]
fn wide_rectangle_crosses_chunks() {
    // Sides on pixel centers: the left and upper ones are inside, the right and lower ones outside.
    let rows = picture(&[[2.5, 0.5], [36.5, 0.5], [36.5, 2.5], [2.5, 2.5]], 40, 4);
    let inside: alloc::string::String =
        (0..40).map(|column| if (2..36).contains(&column) { '#' } else { '.' }).collect();
    assert_eq!(rows[..2], [inside.clone(), inside]);
    assert!(rows[2..].iter().all(|row| !row.contains('#')));
}

#[test]
fn doubly_wound_core_is_outside() {
    let outer = [[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0], [0.0, 0.0]];
    let inner = [[1.0, 1.0], [3.0, 1.0], [3.0, 3.0], [1.0, 3.0], [1.0, 1.0]];
    let loops: Vec<_> = outer.into_iter().chain(inner).collect();
    assert_eq!(picture(&loops, 4, 4), ["####", "#..#", "#..#", "####"]);
}

#[test]
fn rings_take_turns() {
    let square = |low: f32, high: f32| [[low, low], [high, low], [high, high], [low, high]];
    let mut outline = Outline::default();
    outline.push_ring(square(0.0, 6.0));
    outline.push_ring([[3.5, 0.0], [3.5, 6.0]]);
    outline.push_ring([[2.0, 2.5]]);
    outline.push_ring(square(1.0, 5.0));
    outline.push_ring(square(2.0, 4.0).into_iter().rev());
    // The second object begins where this ring ends; a ring without vertices stands between.
    outline.breaks.push(outline.vertices.len());
    let rows = picture_of_rings(outline.rings(), 7, 6);
    assert_eq!(rows, ["######.", "#....#.", "#.##.#.", "#.##.#.", "#....#.", "######."]);
}

#[test]
fn index_names_the_topmost_confident_object() {
    let coverage = [1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 1.0, 0.0, 1.0, 1.0, 1.0, 1.0];
    let mut index = [9; 4];
    object_index(&coverage, &[1.0, 0.75, 0.25], &mut index).unwrap();
    assert_eq!(index, [1, 2, 2, BACKGROUND]);
    let refused = object_index(&coverage, &[1.0, 1.0], &mut index).unwrap_err();
    assert_eq!(refused, RenderError::Length { what: "coverage", expected: 8, len: 12 });
}
