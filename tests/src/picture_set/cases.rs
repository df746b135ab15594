//! The cases of the picture set, and their pictures as files beside their truth.

use std::fs;
use std::path::Path;

use dvp::format::{BitDepth, Place, SCENES_FILE, SceneJson, encode_png};
use dvp::spoil::{add_noise, blurred, jpeg};
use dvp_core::Scene;
use image::imageops::{FilterType, resize};
use image::{DynamicImage, GrayImage, RgbImage};

use super::drawn::{draw_enlarged, draw_with_labels};
use super::random::{cropped, crowd, mds_hr, paint_mds_hr, twins};

type Failure = Box<dyn core::error::Error>;

/// Seed of the MDS-HR scenes; picture i of a family has this seed plus i.
const SEED: u64 = 20_000;

/// Where the pictures of a case come from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Source {
    /// The SVGs of a folder beside the suite; truth: label maps.
    Svg(&'static str),
    /// Squares of this side with this many objects, as SVG; truth: label maps.
    Crowd(u32, usize),
    /// This many images of MDS-HR; truth: scenes.
    MdsHr(usize),
    /// This many pairs of one shape and color at this distance; truth: scenes.
    Twins(usize, f32),
    /// This many objects cropped by 30 to 70 %; truth: scenes.
    Cropped(usize),
}

/// What happens to the pictures before they are fitted.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Finish {
    /// PNG of 8 bits; with alpha where the picture is transparent.
    Png,
    /// Gaussian noise.
    Noise(f64),
    /// JPEG of this quality.
    Jpeg(u8),
    /// Gaussian blur, pixels.
    Blur(f64),
    /// Gray, with alpha where the picture is transparent.
    Gray,
    /// 16 bits per channel.
    SixteenBits,
    /// GIF: a palette of at most 256 colors.
    Palette,
    /// Drawn four times as large and scaled down with Lanczos' filter, which leaves faint rims along edges.
    ScaledDown,
}

/// Pictures of one kind, and what a fit without options must reach on them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Case {
    /// What the table says.
    pub name: &'static str,
    /// Where the pictures come from.
    pub source: Source,
    /// What happens to them.
    pub finish: Finish,
    /// Whether the fit is given the shapes of MDS-HR.
    pub bank: bool,
    /// Least mean ARI.
    pub ari: Option<f64>,
    /// Least share of pictures with the right number of visible objects.
    pub exact: Option<f64>,
}

const fn drawn(name: &'static str, source: Source, finish: Finish) -> Case {
    Case { name, source, finish, bank: false, ari: Some(0.98), exact: Some(0.95) }
}

const fn random(
    name: &'static str,
    source: Source,
    finish: Finish,
    bank: bool,
    ari: Option<f64>,
    exact: Option<f64>,
) -> Case {
    Case { name, source, finish, bank, ari, exact }
}

/// All cases.
pub const CASES: &[Case] = &[
    drawn("flat", Source::Svg("flat"), Finish::Png),
    drawn("occlusion", Source::Svg("occlusion"), Finish::Png),
    drawn("translucent", Source::Svg("translucent"), Finish::Png),
    drawn("rings and holes", Source::Svg("rings"), Finish::Png),
    drawn("thin", Source::Svg("thin"), Finish::Png),
    drawn("3 px", Source::Svg("tiny"), Finish::Png),
    drawn("touching", Source::Svg("touching"), Finish::Png),
    drawn("empty", Source::Svg("empty"), Finish::Png),
    drawn("cells", Source::Svg("cells"), Finish::Png),
    drawn("coins", Source::Svg("coins"), Finish::Png),
    drawn("sprites", Source::Svg("sprites"), Finish::Png),
    drawn("gray", Source::Svg("gray"), Finish::Gray),
    drawn("alpha", Source::Svg("alpha"), Finish::Png),
    drawn("cropped by the border", Source::Svg("cropped"), Finish::Png),
    // Who is in front of a twin of its own color cannot be seen: the count alone is asked for.
    Case { ari: None, ..drawn("twins", Source::Svg("twins"), Finish::Png) },
    drawn("crowd of 30", Source::Crowd(256, 30), Finish::Png),
    drawn("crowd of 80", Source::Crowd(384, 80), Finish::Png),
    drawn("crowd of 200", Source::Crowd(640, 200), Finish::Png),
    drawn("flat, 16 bits", Source::Svg("flat"), Finish::SixteenBits),
    drawn("flat, palette", Source::Svg("flat"), Finish::Palette),
    drawn("flat, scaled down", Source::Svg("flat"), Finish::ScaledDown),
    drawn("occlusion, scaled down", Source::Svg("occlusion"), Finish::ScaledDown),
    drawn("flat, blur 0.8 px", Source::Svg("flat"), Finish::Blur(0.8)),
    drawn("flat, blur 1.5 px", Source::Svg("flat"), Finish::Blur(1.5)),
    drawn("flat, noise 0.01", Source::Svg("flat"), Finish::Noise(0.01)),
    drawn("flat, noise 0.03", Source::Svg("flat"), Finish::Noise(0.03)),
    drawn("flat, noise 0.05", Source::Svg("flat"), Finish::Noise(0.05)),
    drawn("flat, JPEG 50", Source::Svg("flat"), Finish::Jpeg(50)),
    drawn("occlusion, noise 0.03", Source::Svg("occlusion"), Finish::Noise(0.03)),
    drawn("occlusion, JPEG 50", Source::Svg("occlusion"), Finish::Jpeg(50)),
    random("MDS-HR", Source::MdsHr(50), Finish::Png, false, Some(0.993), Some(0.98)),
    random("MDS-HR, noise 0.01", Source::MdsHr(50), Finish::Noise(0.01), false, None, Some(0.98)),
    random("MDS-HR, noise 0.03", Source::MdsHr(50), Finish::Noise(0.03), false, None, Some(0.96)),
    random("MDS-HR, noise 0.05", Source::MdsHr(50), Finish::Noise(0.05), false, None, Some(0.92)),
    random("MDS-HR, JPEG 50", Source::MdsHr(50), Finish::Jpeg(50), false, None, Some(0.95)),
    random("MDS-HR twins 0.15", Source::Twins(40, 0.15), Finish::Png, false, None, Some(0.95)),
    random("MDS-HR twins 0.10", Source::Twins(40, 0.10), Finish::Png, false, None, Some(0.85)),
    random("MDS-HR cropped", Source::Cropped(40), Finish::Png, false, Some(0.98), None),
    random("MDS-HR, bank", Source::MdsHr(50), Finish::Png, true, Some(0.999), Some(0.98)),
    random("MDS-HR, noise 0.01, bank", Source::MdsHr(50), Finish::Noise(0.01), true, None, Some(0.98)),
    random("MDS-HR, noise 0.03, bank", Source::MdsHr(50), Finish::Noise(0.03), true, None, Some(0.96)),
    random("MDS-HR, noise 0.05, bank", Source::MdsHr(50), Finish::Noise(0.05), true, None, Some(0.92)),
    random("MDS-HR, JPEG 50, bank", Source::MdsHr(50), Finish::Jpeg(50), true, None, Some(0.95)),
    random("MDS-HR twins 0.15, bank", Source::Twins(40, 0.15), Finish::Png, true, None, Some(0.95)),
    random("MDS-HR twins 0.10, bank", Source::Twins(40, 0.10), Finish::Png, true, None, Some(0.85)),
    random("MDS-HR cropped, bank", Source::Cropped(40), Finish::Png, true, Some(0.98), None),
];

impl Case {
    /// Writes the pictures and their truth as a data set.
    ///
    /// # Errors
    /// A sentence with the source that is at fault.
    pub fn write(&self, folder: &Path) -> Result<(), Failure> {
        fs::create_dir_all(folder)?;
        match self.source {
            Source::Svg(name) => {
                let sources = Path::new(env!("CARGO_MANIFEST_DIR")).join("pictures").join(name);
                let mut paths: Vec<_> =
                    fs::read_dir(sources)?.map(|entry| entry.map(|e| e.path())).collect::<Result<_, _>>()?;
                paths.retain(|path| path.extension().is_some_and(|ending| ending == "svg"));
                paths.sort();
                for (path, seed) in paths.iter().zip(0..) {
                    let stem = path.file_stem().unwrap_or_default().to_string_lossy();
                    let text = fs::read_to_string(path)?;
                    self.finish.write_drawn(folder, &stem, &text, seed).map_err(|error| format!("{stem}: {error}"))?;
                }
                Ok(())
            }
            Source::Crowd(side, count) => (0..2).try_for_each(|seed| {
                self.finish.write_drawn(folder, &format!("crowd-{seed}"), &crowd(side, count, seed), seed)
            }),
            Source::MdsHr(count) => self.write_scenes(folder, count, |seed| Ok(mds_hr(SEED, seed - SEED))),
            Source::Twins(count, gap) => self.write_scenes(folder, count, |seed| Ok(twins(gap, seed))),
            Source::Cropped(count) => self.write_scenes(folder, count, cropped),
        }
    }

    fn write_scenes(
        &self,
        folder: &Path,
        count: usize,
        scene: impl Fn(u64) -> Result<Scene<f32>, Failure>,
    ) -> Result<(), Failure> {
        let mut lines = String::new();
        for (seed, index) in (SEED..).zip(0..count) {
            let scene = scene(seed)?;
            let image = paint_mds_hr(&scene)?;
            let mut json = SceneJson::from_scene(&scene, image.size())?;
            json.id = Some(index as u64);
            lines.push_str(&(json.to_line(&Place::file(folder))? + "\n"));
            let picture = image::load_from_memory(&encode_png(image.view(), BitDepth::Eight)?)?;
            self.finish.write_picture(folder, &format!("{index:05}"), picture, seed)?;
        }
        fs::write(folder.join(SCENES_FILE), lines)?;
        Ok(())
    }
}

impl Finish {
    /// Writes what an SVG shows, as STEM.png or, for a palette, STEM.gif, and its label map beside it.
    ///
    /// # Errors
    /// A sentence, if the text is no SVG of ours or a file cannot be written.
    pub fn write_drawn(self, folder: &Path, stem: &str, text: &str, seed: u64) -> Result<(), Failure> {
        let mut drawn = draw_with_labels(text)?;
        if self == Self::ScaledDown {
            let (width, height) = drawn.picture.dimensions();
            drawn.picture = resize(&draw_enlarged(text, 4)?, width, height, FilterType::Lanczos3);
        }
        drawn.labels.save(folder.join(format!("{stem}.labels.png")))?;
        let opaque = drawn.picture.pixels().all(|pixel| pixel.0[3] == u8::MAX);
        let picture = DynamicImage::from(drawn.picture);
        let picture = if opaque { picture.to_rgb8().into() } else { picture };
        self.write_picture(folder, stem, picture, seed)
    }

    fn write_picture(self, folder: &Path, stem: &str, picture: DynamicImage, seed: u64) -> Result<(), Failure> {
        let png = folder.join(format!("{stem}.png"));
        let noisy = |sigma| {
            let mut picture: RgbImage = picture.to_rgb8();
            add_noise(&mut picture, sigma, seed);
            picture
        };
        match self {
            Finish::Png | Finish::ScaledDown => picture.save(png)?,
            Finish::Noise(sigma) => noisy(sigma).save(png)?,
            Finish::Blur(sigma_px) => blurred(&picture.to_rgb8(), sigma_px).save(png)?,
            Finish::Gray if picture.color().has_alpha() => picture.to_luma_alpha8().save(png)?,
            Finish::Gray => GrayImage::save(&picture.to_luma8(), png)?,
            Finish::SixteenBits => picture.to_rgb16().save(png)?,
            Finish::Palette => picture.to_rgba8().save(folder.join(format!("{stem}.gif")))?,
            // The content decides what a file is: scenes name their pictures .png.
            Finish::Jpeg(quality) => fs::write(png, jpeg(&picture.to_rgb8(), quality)?)?,
        }
        Ok(())
    }
}
