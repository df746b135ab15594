//! Large pictures: the time of one fit, unknown shapes, no options.
//!
//! `scale/4096_50`: 4096 x 4096 with 50 objects, `scale/1024_200`: 1024 x 1024 with 200, `scale/1024_0`: an empty one. Drawn by
//! resvg: area coverage, painter's order, some objects in front of others.

#![expect(clippy::expect_used, reason = "a bench that cannot set up its work must stop")]

use core::fmt::Write;
use core::hint::black_box;
use core::time::Duration;

use criterion::{Criterion, criterion_group, criterion_main};
use dvp_core::{Image, Real};
use dvp_fit::picture::{Known, PictureScratch, fit_picture};
use dvp_fit::{FitOptions, Fitter};
use dvp_tests::draw_svg::draw_svg;

/// Ellipses, turned rectangles and triangles by a fixed sequence of numbers, on a jittered grid.
fn svg(side: u32, objects: u32) -> String {
    let mut state = 12345_u32;
    let mut next = |below: u32| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) % below
    };
    let columns = (1..).find(|n| n * n >= objects).unwrap_or(1);
    let cell = side / columns.max(1);
    let mut text = format!("<svg xmlns='http://www.w3.org/2000/svg' width='{side}' height='{side}'>");
    let _ = write!(text, "<rect width='{side}' height='{side}' fill='#f4f0e8'/>");
    for i in 0..objects {
        let [x, y] = [i % columns, i / columns].map(|at| at * cell + cell / 4 + next(cell / 2));
        let size = cell / 5 + next(cell / 5);
        let (color, turn) = (next(0x00ff_ffff) & 0x00df_dfdf, next(360));
        let (wide, high) = (size, size * 2 / 3);
        let shape = match i % 3 {
            0 => format!("<ellipse rx='{wide}' ry='{high}'"),
            1 => format!("<rect x='-{wide}' y='-{high}' width='{}' height='{}'", 2 * wide, 2 * high),
            _ => format!("<path d='M -{wide} -{high} L {wide} -{high} L 0 {wide} Z'"),
        };
        let _ = write!(text, "{shape} transform='translate({x} {y}) rotate({turn})' fill='#{color:06x}'/>");
    }
    text + "</svg>"
}

fn picture(side: u32, objects: u32) -> Image<f32> {
    let drawn = draw_svg(&svg(side, objects)).expect("a picture");
    Image::from_planar(drawn.size(), drawn.data().iter().map(|v| v.as_f32()).collect()).expect("an image")
}

fn scale(criterion: &mut Criterion) {
    let fitter = Fitter::new(FitOptions::default()).expect("a fitter");
    let mut group = criterion.benchmark_group("scale");
    group.sample_size(10).measurement_time(Duration::from_secs(10));
    for (side, objects) in [(4096, 50), (1024, 200), (1024, 0)] {
        let image = picture(side, objects);
        let (mut scratch, known) = (PictureScratch::default(), Known::default());
        group.bench_function(format!("{side}_{objects}"), |bencher| {
            bencher.iter(|| {
                let fit = fit_picture(&fitter, black_box(image.view()), &known, &mut scratch).expect("a fit");
                black_box(fit.scene.objects.len())
            });
        });
    }
}

criterion_group!(benches, scale);
criterion_main!(benches);
