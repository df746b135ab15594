//! Images of few colors, of painted outlines and of noise, with and without a bank: a fit with finite numbers.
#![no_main]

use std::sync::LazyLock;

use arbitrary::{Arbitrary, Result, Unstructured};
use dvp_core::render::{ContourRenderer, Renderer};
use dvp_core::shape::mdshr_bank;
use dvp_core::{Image, ImageSize, Shape as _};
use dvp_fit::{Bank, FitOptions, Fitter};
use dvp_fuzz::{Painting, size};
use libfuzzer_sys::fuzz_target;

/// A picture as planar data.
struct Input {
    size: ImageSize,
    data: Vec<f32>,
}

impl std::fmt::Debug for Input {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { size, data } = self;
        write!(f, "Image::from_planar(ImageSize::new({}, {}).unwrap(), ", size.width(), size.height())?;
        write!(f, "vec!{data:?}).unwrap()")
    }
}

impl<'a> Arbitrary<'a> for Input {
    fn arbitrary(u: &mut Unstructured<'a>) -> Result<Self> {
        let size = if u.arbitrary()? {
            let painting = Painting::arbitrary(u)?;
            let (mut data, mut scratch) = (vec![0.0; 3 * painting.size.pixels()], Default::default());
            let painted = ContourRenderer::default().render(&painting.drawing, painting.size, &mut scratch, &mut data);
            if painted.is_ok() && data.iter().all(|v| v.is_finite()) {
                return Ok(Self { size: painting.size, data });
            }
            painting.size
        } else {
            size(u, 24)?
        };
        let levels = u.int_in_range(1..=255_u8)?;
        let data = (0..3 * size.pixels()).map(|_| Ok(f32::from(u.arbitrary::<u8>()? % levels) / 255.0));
        Ok(Self { size, data: data.collect::<Result<_>>()? })
    }
}

static FITTERS: LazyLock<[Fitter<f32>; 2]> = LazyLock::new(|| {
    let prototypes = mdshr_bank(8).prototypes().iter().map(|efd| (String::new(), efd.clone())).collect();
    let banks = [None, Some(Bank::new(prototypes))];
    banks.map(|bank| Fitter::new(FitOptions::default().with_bank(bank)).expect("the built-in bank"))
});

fuzz_target!(|input: Input| {
    let image = Image::from_planar(input.size, input.data).expect("finite, 3 values per pixel");
    for fitter in FITTERS.iter() {
        let Ok(fit) = fitter.fit(image.view(), &mut Default::default()) else { continue };
        assert!(fit.loss.is_finite() && !fit.bits.is_nan());
        assert!(fit.scene.background.iter().all(|v| v.is_finite()));
        for object in &fit.scene.objects {
            let pose = &object.pose;
            let numbers = pose.translation.iter().chain([&pose.scale, &pose.rotation, &object.confidence]);
            let (color, mut shape) = (object.color(), Vec::new());
            object.shape.numbers(&mut shape);
            let numbers = numbers.chain(&color).chain(&shape);
            assert!(numbers.into_iter().all(|v| v.is_finite()), "{object:?}");
        }
    }
});
