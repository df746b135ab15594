use alloc::vec;
use alloc::vec::Vec;

use super::{ExactArea, ExactRecord};
use crate::dims::ImageSize;
use crate::render::tile::{ChunkState, CoverageModel, LANES, Tile, Window};
use crate::shape::{Outline, Rings};

/// Coverage of the pixels of a small image, and the gradient of the vertices for a gradient of 1 in each pixel. The
/// outline counts from the upper left corner of the image.
fn cover(outline: &[[f64; 2]], width: usize, height: usize) -> (Vec<f64>, Vec<[f64; 2]>) {
    cover_rings(Rings::one(outline), width, height)
}

/// As [`cover`], of several rings.
fn cover_rings(rings: Rings<'_, f64>, width: usize, height: usize) -> (Vec<f64>, Vec<[f64; 2]>) {
    let size = ImageSize::new(width, height).unwrap();
    let vertices_px: Vec<_> = rings.vertices.iter().map(|&[x, y]| [x - 0.5, y - 0.5]).collect();
    let (mut coverage, mut grad) = (vec![0.0; width * height], vec![[0.0; 2]; vertices_px.len()]);
    let rings_px = Rings { vertices: &vertices_px, ..rings };
    let Some(window) = Window::around(&vertices_px, 0.5, size) else { return (coverage, grad) };
    let (mut tile, mut record) = (Tile::default(), ExactRecord::default());
    tile.reset(window, size, 1, true);
    ExactArea.cover(rings_px, size, &mut tile, &mut record, true).unwrap();
    for chunk in 0..window.rows * window.chunks {
        for lane in 0..LANES {
            let column = window.left() + chunk % window.chunks * LANES + lane;
            if column < width {
                coverage[(window.top + chunk / window.chunks) * width + column] = match tile.states[chunk] {
                    ChunkState::Empty => 0.0,
                    ChunkState::Mixed => tile.coverage[chunk][lane],
                    ChunkState::Full => 1.0,
                };
                tile.grad[chunk][lane] = 1.0;
            }
        }
    }
    ExactArea.cover_vjp(rings_px, size, &mut tile, &mut record, &mut grad);
    (coverage, grad)
}

#[track_caller]
fn assert_close(found: &[f64], expected: &[f64]) {
    assert_eq!(found.len(), expected.len());
    for (k, (f, e)) in found.iter().zip(expected).enumerate() {
        assert!((f - e).abs() < 1e-12, "value {k}: {found:?} instead of {expected:?}");
    }
}

#[test]
fn rectangle_covers_shares() {
    // x from 0.5 to 2.25, y from 0.25 to 1.5: row shares 0.75 and 0.5, column shares 0.5, 1, 0.25.
    let mut outline = [[0.5, 0.25], [2.25, 0.25], [2.25, 1.5], [0.5, 1.5]];
    let expected = [0.375, 0.75, 0.1875, 0.25, 0.5, 0.125];
    assert_close(&cover(&outline, 3, 2).0, &expected);
    outline.reverse();
    assert_close(&cover(&outline, 3, 2).0, &expected);
}

#[test]
fn diagonal_halves_pixels() {
    // The triangle under the diagonal of a 2 x 2 image.
    assert_close(&cover(&[[0.0, 0.0], [2.0, 2.0], [0.0, 2.0]], 2, 2).0, &[0.5, 0.0, 1.0, 0.5]);
}

#[test]
fn wide_rectangle_fills_chunks() {
    // 50 columns are four chunks; x from 10.5 to 40.25 leaves the chunk of columns 16 to 31 full.
    let (coverage, _) = cover(&[[10.5, 0.0], [40.25, 0.0], [40.25, 1.0], [10.5, 1.0]], 50, 1);
    let expected: Vec<f64> = (0..50)
        .map(|column| match column {
            10 => 0.5,
            11..=39 => 1.0,
            40 => 0.25,
            _ => 0.0,
        })
        .collect();
    assert_close(&coverage, &expected);
}

#[test]
fn outside_parts_are_cut() {
    // A rectangle that overhangs on all sides but the right, at x = 1.5.
    let outline = [[-1e6, -7.0], [1.5, -7.0], [1.5, 1e8], [-1e6, 1e8]];
    assert_close(&cover(&outline, 3, 2).0, &[1.0, 0.5, 0.0, 1.0, 0.5, 0.0]);
    assert_close(&cover(&[[5.0, 0.0], [9.0, 0.0], [9.0, 2.0]], 3, 2).0, &[0.0; 6]);
    assert_close(&cover(&[[-5.0, 0.0], [-1.0, 0.0], [-1.0, 2.0]], 3, 2).0, &[0.0; 6]);
}

#[test]
fn overlap_is_outside() {
    // Twice around a unit square: winding number 2, even.
    let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];
    let twice: Vec<_> = square.iter().chain(&square).copied().collect();
    assert_close(&cover(&twice, 1, 1).0, &[0.0]);
    // Once around a 3 x 3 square, then in the same sense around its middle pixel.
    let outer = [[0.0, 0.0], [3.0, 0.0], [3.0, 3.0], [0.0, 3.0], [0.0, 0.0]];
    let inner = [[1.0, 1.0], [2.0, 1.0], [2.0, 2.0], [1.0, 2.0], [1.0, 1.0]];
    let loops: Vec<_> = outer.into_iter().chain(inner).collect();
    assert_close(&cover(&loops, 3, 3).0, &[1.0, 1.0, 1.0, 1.0, 0.0, 1.0, 1.0, 1.0, 1.0]);
}

/// Squares by their corners, one ring each; those marked are drawn the other way round.
fn squares(corners: &[([f64; 2], [f64; 2], bool)]) -> Outline<f64> {
    let mut outline = Outline::default();
    for &([left, top], [right, bottom], reversed) in corners {
        let mut ring = [[left, top], [right, top], [right, bottom], [left, bottom]];
        if reversed {
            ring.reverse();
        }
        outline.push_ring(ring);
    }
    outline
}

#[test]
fn thin_frames_cover_their_area_whichever_way_they_are_drawn() {
    // A frame of 1/8 px around a hole of 1/2 px inside of one pixel: 0.75^2 - 0.5^2 = 0.3125; its outer sides sum to 4 x 0.75
    // of gain, those of the hole to 4 x 0.5 of loss, half of each for each vertex and axis.
    for (outer, inner) in [(false, false), (false, true), (true, false), (true, true)] {
        let frame = [([1.125, 1.125], [1.875, 1.875], outer), ([1.25, 1.25], [1.75, 1.75], inner)];
        let outline = squares(&frame);
        let (coverage, grad) = cover_rings(outline.rings(), 3, 3);
        let mut expected = [0.0; 9];
        expected[4] = 0.3125;
        assert_close(&coverage, &expected);
        for (k, (vertex, grad)) in outline.vertices.iter().zip(&grad).enumerate() {
            let outward = if k < 4 { 0.375 } else { -0.25 };
            assert_close(grad, &vertex.map(|x| if x > 1.5 { outward } else { -outward }));
        }
    }
}

#[test]
fn nested_rings_take_turns() {
    // 6 x 6, a hole of 4 x 4 and an island of 2 x 2 in it, all drawn the same way round, shifted by half a pixel: one pixel
    // holds a corner of each border, 1/4 apart from the next.
    let rings = [([0.5, 0.5], [6.5, 6.5], false), ([0.75, 0.75], [4.5, 4.5], false), ([1.25, 1.25], [2.5, 2.5], false)];
    let expected: f64 = 36.0 - 3.75 * 3.75 + 1.25 * 1.25;
    for turn in 0..3 {
        let mut rings = rings;
        rings.rotate_left(turn);
        let coverage = cover_rings(squares(&rings).rings(), 8, 8).0;
        assert!((coverage.iter().sum::<f64>() - expected).abs() < 1e-12);
        // Pixel (0, 0) holds [0.5, 1]^2 without [0.75, 1]^2, pixel (1, 1) the island's [1.25, 2]^2.
        assert_close(&[coverage[0], coverage[9]], &[0.25 - 0.0625, 0.5625]);
    }
}

#[test]
fn holes_that_touch_cut_no_seams() {
    // The hole has the left half of the object, three sides in common with it, and both are drawn the same way round.
    let halves = [([0.25, 0.25], [2.75, 2.75], false), ([0.25, 0.25], [1.5, 2.75], false)];
    let coverage = cover_rings(squares(&halves).rings(), 3, 3).0;
    assert_close(&coverage, &[0.0, 0.375, 0.5625, 0.0, 0.5, 0.75, 0.0, 0.375, 0.5625]);
    // A hole as large as the object leaves nothing, and a third ring of that size covers it again.
    let square = ([0.25, 0.25], [2.75, 2.75], false);
    for reversed in [false, true] {
        let hole = (square.0, square.1, reversed);
        assert_close(&cover_rings(squares(&[square, hole]).rings(), 3, 3).0, &[0.0; 9]);
        let again = cover_rings(squares(&[square, hole, square]).rings(), 3, 3).0;
        assert_close(&again, &cover_rings(squares(&[square]).rings(), 3, 3).0);
    }
}

#[test]
fn rings_of_few_vertices_change_nothing() {
    let mut outline = squares(&[([0.5, 0.5], [2.5, 2.5], false), ([1.0, 1.25], [1.75, 2.0], false)]);
    let (expected, _) = cover_rings(outline.rings(), 3, 3);
    outline.push_ring([[1.5, 1.5]]);
    outline.push_ring([[0.7, 0.2], [2.2, 2.9]]);
    outline.push_ring([[1.0, 1.0]; 3]);
    // A ring of no vertices, in the middle and at the end.
    let end = outline.vertices.len();
    outline.breaks.extend([end, end]);
    outline.breaks.insert(0, 4);
    let (coverage, grad) = cover_rings(outline.rings(), 3, 3);
    assert_close(&coverage, &expected);
    assert!(grad.as_flattened().iter().all(|g| g.is_finite()));
}

#[test]
fn degenerate_outlines_cover_nothing() {
    assert_close(&cover(&[[0.5, 0.5]], 2, 1).0, &[0.0; 2]);
    assert_close(&cover(&[[0.5, 0.5], [1.5, 0.7]], 2, 1).0, &[0.0; 2]);
    assert_close(&cover(&[[0.5, 0.5]; 5], 2, 1).0, &[0.0; 2]);
}

#[test]
fn rectangle_gradient_is_edge_length() {
    // Moving the right edge of x 0.5..2.25, y 0.25..1.5 right gains its length 1.25, half of it by each end.
    let (_, grad) = cover(&[[0.5, 0.25], [2.25, 0.25], [2.25, 1.5], [0.5, 1.5]], 3, 2);
    assert_close(grad.as_flattened(), &[-0.625, -0.875, 0.625, -0.875, 0.625, 0.875, -0.625, 0.875]);
}

#[test]
fn grid_aligned_square_keeps_its_area_when_shifted() {
    // All edges lie on the pixel grid, where coverage has kinks: the one-sided derivatives must still cancel.
    let mut outline = [[1.0, 1.0], [1.0, 3.0], [3.0, 3.0], [3.0, 1.0]];
    for _ in 0..2 {
        let (_, grad) = cover(&outline, 5, 5);
        let left: f64 = grad.iter().zip(&outline).filter(|(_, v)| v[0] < 2.0).map(|(g, _)| g[0]).sum();
        let right: f64 = grad.iter().zip(&outline).filter(|(_, v)| v[0] > 2.0).map(|(g, _)| g[0]).sum();
        assert_close(&[left, right], &[-2.0, 2.0]);
        outline.reverse();
    }
}
