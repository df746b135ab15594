//! Pixels: fitted, refined, compared.

use dvp_core::loss::{ImagePair, Loss as _};
use dvp_core::render::PixelLoss;
use dvp_fit::paint::Canvas;
use dvp_fit::picture::{Known, PictureScratch, fit_picture};
use dvp_fit::scene_refine::SceneRefine;
use dvp_fit::{FitOptions, Fitter};
use dvp_formats::format::{self, BitDepth, SceneJson, to_byte};
use js_sys::Function;
use serde::Serialize;
use wasm_bindgen::prelude::*;

use crate::WebError;
use crate::drawing::{Drawing, bank_of, place, size_of};

/// Most pixels of a picture, as for the command: 2^24, a square of 4096, for which the fit takes about 1 GiB.
pub(crate) const MOST_PIXELS: usize = 1 << 24;

/// A picture.
#[wasm_bindgen]
#[derive(Debug)]
pub struct Picture {
    picture: format::Picture<f32>,
}

/// What a fit gives, as JSON.
#[derive(Serialize)]
struct Fitted {
    /// The scene, with what the fit knows of it.
    scene: SceneJson,
    /// Mean absolute error against the picture, channels from 0 to 1.
    mae: f32,
    /// Per object, row by row: covariance of (x, y, log scale, rotation, log stretch), null where nothing is known; or empty.
    covariance: Vec<[Option<f32>; 25]>,
}

/// What a refinement gives, as JSON.
#[derive(Serialize)]
struct Refined {
    scene: SceneJson,
    start_loss: f32,
    loss: f32,
    steps: usize,
    numbers: usize,
}

/// How far a drawing is from a picture.
#[wasm_bindgen]
#[derive(Clone, Debug)]
pub struct Comparison {
    /// Mean absolute error over pixels and channels, [0, 1].
    pub mae: f32,
    differences: Vec<u8>,
}

#[wasm_bindgen]
impl Comparison {
    /// Per pixel, row by row: the largest difference of a channel, in steps of 1/255.
    #[wasm_bindgen(getter)]
    #[must_use]
    pub fn differences(&self) -> Vec<u8> {
        self.differences.clone()
    }
}

#[wasm_bindgen]
impl Picture {
    /// A picture of red, green, blue, alpha per pixel, row by row, colors not multiplied by alpha, as `ImageData` holds them.
    /// `coded` says whether a coder of photographs has changed its pixels: whether the file was a JPEG.
    ///
    /// # Errors
    /// [`WebError::Size`] without pixels, [`WebError::Pixels`] for more than 2^24, [`WebError::Image`] if there are not four values
    /// per pixel.
    #[wasm_bindgen(constructor)]
    pub fn new(rgba: &[u8], width: u32, height: u32, coded: bool) -> Result<Self, WebError> {
        let size = size_of(width, height)?;
        let picture = format::Picture::translucent(size, rgba, BitDepth::Eight)?;
        Ok(Self { picture: picture.with_coded(coded) })
    }

    /// Whether a pixel lets through what is behind the picture.
    #[wasm_bindgen(getter)]
    #[must_use]
    pub fn transparent(&self) -> bool {
        self.picture.transparent
    }

    /// What `dvp fit` finds, as JSON: `scene` (version 3, with what the fit knows of it), `mae`, `covariance`. `max_objects` is the most
    /// objects that are kept, those that matter most; `bank` is `mdshr`, the text of a bank, or empty for unknown shapes.
    ///
    /// # Errors
    /// [`WebError::Fit`] for options out of range, [`WebError::Format`] for a text that is no bank.
    pub fn fit(&self, max_objects: u32, bank: &str) -> Result<String, WebError> {
        let options = FitOptions::default().with_bank(bank_of(bank)?).with_max_objects(max_objects as usize);
        let picture = &self.picture;
        let known = Known::default().with_matte(picture.transparent.then_some(picture.matte)).with_coded(picture.coded);
        let fitter = Fitter::new(options)?;
        let fit = fit_picture(&fitter, picture.image.view(), &known, &mut PictureScratch::default())?;
        let number = |value: f32| value.is_finite().then_some(value);
        let covariance = fit.covariance.iter().map(|block| block.map(number)).collect();
        let scene = SceneJson::from_fit(&fit, picture)?;
        // Checks that every number is finite.
        scene.to_line(&place())?;
        Ok(serde_json::to_string(&Fitted { scene, mae: fit.loss, covariance })?)
    }

    /// Moves every number of a drawing to where it explains the picture best, through the renderer, in at most `max_steps` steps.
    /// `on_step(step, loss, scene)` is called for the start and after each, with the mean squared error and the scene as JSON. Returns JSON: `scene`,
    /// `start_loss`, `loss`, `steps`, `numbers` (how many could move).
    ///
    /// # Errors
    /// [`WebError::Sizes`] for a drawing of another size, [`WebError::Fit`] for one that cannot be drawn.
    pub fn refine(&self, drawing: &Drawing, max_steps: u32, on_step: &Function) -> Result<String, WebError> {
        self.check(drawing)?;
        let settings = SceneRefine::default().with_max_steps(max_steps as usize);
        let size = drawing.size;
        let mut start = drawing.scene.clone();
        if start.transparent {
            // A transparent picture is compared over its matte.
            start.background = self.picture.matte;
        }
        let line = |scene: &_| SceneJson::from_scene(scene, size).and_then(|json| json.to_line(&place()));
        let refined = settings.fit_watched(self.picture.image.view(), &start, &mut |step| {
            // Who watches may miss a step; the result holds them all.
            if let Ok(json) = line(step.scene) {
                let (number, loss) = (JsValue::from(step.step), JsValue::from(step.loss));
                let _ = on_step.call3(&JsValue::NULL, &number, &loss, &JsValue::from(json));
            }
        })?;
        let scene = SceneJson::from_scene(&refined.scene, size)?;
        scene.to_line(&place())?;
        let (start_loss, loss, numbers) = (refined.start_loss, refined.loss, refined.number_count);
        Ok(serde_json::to_string(&Refined { scene, start_loss, loss, steps: refined.steps, numbers })?)
    }

    /// How far a drawing is from the picture, pixel by pixel; of a transparent one over the color that stands for what is behind.
    ///
    /// # Errors
    /// [`WebError::Sizes`] for a drawing of another size, [`WebError::Fit`] for one that cannot be painted.
    pub fn compare(&self, drawing: &Drawing) -> Result<Comparison, WebError> {
        self.check(drawing)?;
        let mut scene = drawing.scene.clone();
        if self.picture.transparent && scene.transparent {
            scene.background = self.picture.matte;
        }
        let mut canvas = Canvas::default();
        let (painted, _) = canvas.paint(&scene, drawing.size)?;
        let image = &self.picture.image;
        let mae = PixelLoss::Mae.value(ImagePair::new(painted.view(), image.view())?, &mut ())?;
        let [red, green, blue] = [0, 1, 2].map(|channel| {
            let (own, other) = (painted.view().channel(channel), image.view().channel(channel));
            own.iter().zip(other).map(|(a, b)| (a - b).abs()).collect::<Vec<f32>>()
        });
        let largest = red.iter().zip(&green).zip(&blue).map(|((&r, &g), &b)| to_byte(r.max(g).max(b)));
        Ok(Comparison { mae, differences: largest.collect() })
    }
}

impl Picture {
    fn check(&self, drawing: &Drawing) -> Result<(), WebError> {
        let [drawing, picture] = [drawing.size, self.picture.image.size()];
        if drawing == picture {
            return Ok(());
        }
        let [drawing, picture] = [drawing, picture].map(|size| [size.width(), size.height()]);
        Err(WebError::Sizes { drawing, picture })
    }
}
